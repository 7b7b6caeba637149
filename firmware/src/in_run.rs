//! A panel that balances while the rotor turns, with a head whose masses move: learnt from its own steps, starting
//! from nothing.
//!
//! A step moves the head by `dw`, and the readings change by `dv = a dw`. The influence `a` is learnt from each step
//! by recursive least
//! squares with forgetting [Åström and Wittenmark 1995, Adaptive Control, § 2.2], so a rotor that changes is followed.
//! The first steps
//! are small; one that changed the readings by no more than their own error is followed by one that is four times as
//! long. After that each
//! step goes to where the vibration is least by what is known. A step that made it worse than a set multiple of the
//! first reading is taken
//! back, and what was learnt is forgotten; the third such step ends the procedure.

use driveline::balance::{Complex, Phasor, Reading};

use crate::balanced::{Adviser, CHANNELS};
use crate::panel::{DONE, Key, refused};

/// What the head can do, and how boldly it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// The largest correction [kg m].
    pub capacity: f32,
    /// The first step [kg m].
    pub probe: f32,
    /// Share of an older step's weight that a newer one leaves it.
    pub forgetting: f32,
    /// A vibration of more than this many times the first is taken back.
    pub bound: f32,
}

/// How far a change of the readings has to be beyond its own standard deviation to be believed.
const SIGNIFICANT: f32 = 4.0;
/// How much longer a step is that follows one that showed nothing.
const LONGER: f32 = 4.0;
/// Steps that may be taken back.
const SETBACKS: u32 = 3;

const ZERO: Complex<f32> = Complex { re: 0.0, im: 0.0 };

/// What is known of the rotor, and where the head is.
pub struct InRun<H> {
    head: core::marker::PhantomData<H>,
    /// Where the head was sent [kg m].
    place: Complex<f32>,
    /// Reading and place before.
    before: Option<([Phasor; CHANNELS], Complex<f32>)>,
    influence: [Complex<f32>; CHANNELS],
    /// How little the influence is known: its variance over that of a reading; infinite at first.
    doubt: f32,
    /// Mean square of the first reading.
    first: f32,
    /// The least mean square so far, and its place.
    best: (f32, Complex<f32>),
    probe: f32,
    setbacks: u32,
    reading: [Phasor; CHANNELS],
}

/// The head of a scene.
pub trait HasHead {
    /// Its limits.
    const HEAD: Head;
}

impl<H: HasHead> InRun<H> {
    /// Takes a reading at the present place and chooses the next.
    fn step(&mut self, reading: [Reading; CHANNELS]) -> u32 {
        let now = reading.map(|reading| reading.phasor);
        let size = square(&now);
        let variance = reading.iter().map(|reading| reading.variance).sum::<f32>();
        self.reading = now;
        if self.setbacks >= SETBACKS {
            return refused(3);
        }
        let Some((before, from)) = self.before else {
            (self.first, self.best) = (size, (size, self.place));
            self.before = Some((now, self.place));
            self.place = self.held(self.place + Complex { re: self.probe, im: 0.0 });
            return DONE;
        };
        if size < self.best.0 {
            self.best = (size, self.place);
        }
        let moved = self.place - from;
        let mut change = [ZERO; CHANNELS];
        for ((change, now), before) in change.iter_mut().zip(now).zip(before) {
            *change = Complex::from(now.less(before));
        }
        self.before = Some((now, self.place));
        if size > H::HEAD.bound * H::HEAD.bound * self.first {
            return self.take_back();
        }
        let changed = change.iter().map(|change| square_of(*change)).sum::<f32>();
        let unknown = !(self.doubt < f32::INFINITY);
        // two readings have made the change
        if unknown && !(changed > SIGNIFICANT * SIGNIFICANT * 2.0 * variance) {
            self.probe *= LONGER;
            self.place = self.held(self.place + Complex { re: self.probe, im: 0.0 });
            return DONE;
        }
        self.learn(moved, &change);
        self.place = self.held(self.place + self.to_least(&now));
        DONE
    }

    fn take_back(&mut self) -> u32 {
        self.setbacks += 1;
        self.place = self.best.1;
        self.doubt = f32::INFINITY;
        self.influence = [ZERO; CHANNELS];
        self.probe *= 1.0 / LONGER;
        if self.setbacks >= SETBACKS { refused(3) } else { DONE }
    }

    /// Recursive least squares of one column.
    fn learn(&mut self, moved: Complex<f32>, change: &[Complex<f32>; CHANNELS]) {
        let length = square_of(moved);
        if !(length > 0.0) {
            return;
        }
        let forgetting = H::HEAD.forgetting;
        // the limit of doubt/(forgetting + doubt length) as the doubt grows beyond bounds
        let gain =
            if self.doubt < f32::INFINITY { self.doubt / (forgetting + self.doubt * length) } else { 1.0 / length };
        for (a, change) in self.influence.iter_mut().zip(change) {
            let surprise = *change - *a * moved;
            *a += surprise * moved.conj() * gain;
        }
        // the same as doubt (1 - gain length)/forgetting, which is 0 times infinity at first
        self.doubt =
            if self.doubt < f32::INFINITY { self.doubt * (1.0 - gain * length) / forgetting } else { 1.0 / length };
    }

    /// The step that makes the readings least by what is known.
    fn to_least(&self, now: &[Phasor; CHANNELS]) -> Complex<f32> {
        let (mut along, mut length) = (ZERO, 0.0);
        for (a, now) in self.influence.iter().zip(now) {
            along += a.conj() * Complex::from(*now);
            length += square_of(*a);
        }
        if length > 0.0 { -along * (1.0 / length) } else { ZERO }
    }

    /// A place within the head's capacity.
    fn held(&self, place: Complex<f32>) -> Complex<f32> {
        let (size, capacity) = (square_of(place), H::HEAD.capacity);
        if !(size > capacity * capacity) {
            // what is no number moves nothing
            return if size >= 0.0 { place } else { self.best.1 };
        }
        place * (capacity / Phasor { re: place.re, im: place.im }.amplitude())
    }
}

fn square_of(z: Complex<f32>) -> f32 {
    z.re * z.re + z.im * z.im
}

fn square(phasors: &[Phasor; CHANNELS]) -> f32 {
    phasors.iter().map(|phasor| phasor.square()).sum()
}

impl<H: HasHead> Adviser for InRun<H> {
    fn new() -> Self {
        InRun {
            head: core::marker::PhantomData,
            place: ZERO,
            before: None,
            influence: [ZERO; CHANNELS],
            doubt: f32::INFINITY,
            first: 0.0,
            best: (f32::INFINITY, ZERO),
            probe: H::HEAD.probe,
            setbacks: 0,
            reading: [Phasor::default(); CHANNELS],
        }
    }

    fn ask(&mut self, key: Key, value: u32, reading: Option<[Reading; CHANNELS]>) -> u32 {
        let row = self.reading.get(value as usize).copied().unwrap_or_default();
        match key {
            Key::Step => reading.map_or(refused(0), |reading| self.step(reading)),
            Key::HeadRe => self.place.re.to_bits(),
            Key::HeadIm => self.place.im.to_bits(),
            Key::RowRe => row.re.to_bits(),
            Key::RowIm => row.im.to_bits(),
            _ => refused(2),
        }
    }
}
