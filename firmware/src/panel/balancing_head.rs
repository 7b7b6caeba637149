//! A panel that balances while the rotor turns, with a head that moves its correction: the library's in-run balancing.

use core::marker::PhantomData;

use driveline::balancing::{AbortReason, Action, Complex, InRun, InRunConfig, Phasor};

use crate::scene::balanced::{Adviser, CHANNELS, Measured};
use crate::scene::panel_keys::{DONE, Key, refused};

/// The balancing head of a scene.
pub trait Head {
    /// Its limits, and its cautiousness.
    const CONFIG: InRunConfig<f32, 1>;
}

/// The rotor's identified influence, and the position of the head.
pub struct HeadPanel<H> {
    head: PhantomData<H>,
    in_run: Option<InRun<f32, CHANNELS, 1>>,
    place: Complex<f32>,
    reading: [Phasor; CHANNELS],
}

const ZERO: Complex<f32> = Complex { re: 0.0, im: 0.0 };

impl<H: Head> HeadPanel<H> {
    /// Takes a reading at the present place and chooses the next; a halt sends the head to the best place so far.
    fn step(&mut self, measured: &Measured) -> u32 {
        let Some(in_run) = &mut self.in_run else { return refused(1) };
        self.reading = measured.readings.map(|reading| reading.phasor);
        let variance = measured.readings.iter().fold(0.0, |most: f32, reading| most.max(reading.variance));
        match in_run.advise_at(&self.reading.map(Complex::from), variance, measured.speed) {
            Action::Set([place]) => {
                self.place = place;
                DONE
            }
            Action::Hold => DONE,
            Action::Abort([place], halt) => {
                self.place = place;
                refused(match halt {
                    AbortReason::Diverging => 4,
                    AbortReason::Stalled => 5,
                    AbortReason::NoReading => 6,
                    AbortReason::Unidentified => 7,
                })
            }
        }
    }
}

impl<H: Head> Adviser for HeadPanel<H> {
    fn new() -> Self {
        HeadPanel {
            head: PhantomData,
            in_run: InRun::new(H::CONFIG, CHANNELS, [ZERO]).ok(),
            place: ZERO,
            reading: [Phasor::default(); CHANNELS],
        }
    }

    fn ask(&mut self, key: Key, value: u32, measured: Option<Measured>) -> u32 {
        let row = self.reading.get(value as usize).copied().unwrap_or_default();
        match key {
            Key::Step => measured.map_or(refused(2), |measured| self.step(&measured)),
            Key::HeadRe => self.place.re.to_bits(),
            Key::HeadIm => self.place.im.to_bits(),
            Key::RowRe => row.re.to_bits(),
            Key::RowIm => row.im.to_bits(),
            _ => refused(3),
        }
    }
}

/// A head beside another panel of weights, which keeps all keys but those of the head.
impl<A: Adviser, H: Head> Adviser for (A, HeadPanel<H>) {
    fn new() -> Self {
        (A::new(), HeadPanel::new())
    }

    fn ask(&mut self, key: Key, value: u32, measured: Option<Measured>) -> u32 {
        match key {
            Key::Step | Key::HeadRe | Key::HeadIm => self.1.ask(key, value, measured),
            _ => self.0.ask(key, value, measured),
        }
    }
}
