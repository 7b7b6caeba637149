//! A governed drive whose rotor is balanced, as a scene: two vibration channels on the tick, and a panel between ticks.

use core::marker::PhantomData;

use driveline::angle::Synchronous;
use driveline::balancing::{Phasors, PhasorsConfig, Reading, ReadingFault};
use driveline::configure::{HasVibration, VibrationNumber};
use driveline::drive::{ConfigOf, Drive};
use driveline::fluctuation::Fluctuation;
use driveline::governor::{Governor, SpeedLoop};
use driveline::number::Part;
use driveline::observer::Observer;

use crate::scene::composed::{Beside, Composed, OverWords};
use crate::scene::panel_keys::{DONE, Key, MEASURING, refused};
use crate::scene::{Input, Output};

/// Vibration channels.
pub const CHANNELS: usize = 2;

/// Edges of a reading: eight blocks.
pub const EDGES: usize = 9;

/// The measurement of a balanced scene.
pub type Measurement<N = f32> = Phasors<CHANNELS, EDGES, N>;

/// The drive of a balanced scene: a speed loop and no measurement of the fluctuation, unless it names others.
pub type BalancedDrive<N, O, G = SpeedLoop, F = ()> = Drive<N, O, G, F, Measurement>;

/// A scene whose rotor is balanced: the machine, the number, the observer, and what its panel does with readings.
pub type Balanced<M, N, O, A> = Composed<BalancedDrive<N, O>, Panel<M, A>>;

/// A complete reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Of both channels, in the unit of the sensors.
    pub readings: [Reading; CHANNELS],
    /// Speed of the rotor over it (rad/s).
    pub speed: f32,
}

/// From readings to weights.
pub trait Adviser {
    /// Nothing known yet.
    fn new() -> Self;
    /// Answers a key that is not about the measurement itself; `measured` is the last reading, where it is complete
    /// and good.
    fn ask(&mut self, key: Key, value: u32, measured: Option<Measured>) -> u32;
}

/// A tick with its vibration, and no panel.
pub struct Sampled;

impl<N: Synchronous, D: OverWords<Number = N, Balancer = Measurement<N>>> Beside<D> for Sampled {
    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {
        Sampled
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        let output = drive.advance(config, input);
        drive.vibration(config, &input.vibration.map(N::from_word));
        output
    }
}

/// The panel of a scene that is balanced.
pub struct Panel<M, A> {
    adviser: A,
    machine: PhantomData<M>,
}

impl<M, N, O, G, F, A> Beside<BalancedDrive<N, O, G, F>> for Panel<M, A>
where
    M: HasVibration,
    N: VibrationNumber,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    F: Part<N, State: Fluctuation<N>>,
    A: Adviser,
{
    fn start(_: &mut BalancedDrive<N, O, G, F>, _: &ConfigOf<BalancedDrive<N, O, G, F>>) -> Self {
        Panel { adviser: A::new(), machine: PhantomData }
    }

    #[inline(always)]
    fn tick(
        &mut self,
        drive: &mut BalancedDrive<N, O, G, F>,
        config: &ConfigOf<BalancedDrive<N, O, G, F>>,
        input: &Input,
    ) -> Output {
        Sampled.tick(drive, config, input)
    }

    fn panel(
        &mut self,
        drive: &mut BalancedDrive<N, O, G, F>,
        config: &mut &'static ConfigOf<BalancedDrive<N, O, G, F>>,
        asked: [u32; 2],
    ) -> u32 {
        let [key, value] = asked;
        match Key::of(key) {
            None => 0,
            Some(Key::Begin) => {
                drive.balancer_mut().begin();
                DONE
            }
            Some(Key::State) => state::<M, N>(&config.balancer, drive.balancer()),
            Some(key) => self.adviser.ask(key, value, reading::<M, N>(&config.balancer, drive.balancer()).ok()),
        }
    }
}

/// Readings of a measurement.
///
/// # Errors
/// Why it is no reading, or not yet.
pub fn reading<M: HasVibration, N: VibrationNumber>(
    config: &PhasorsConfig<N, CHANNELS>,
    measurement: &Measurement<N>,
) -> Result<Measured, ReadingFault> {
    let unit = N::vibration_unit::<M>();
    let read = |channel| {
        let reading = measurement.reading(config, channel)?;
        let (phasor, variance) = (reading.phasor.scaled(unit), reading.variance * unit * unit);
        Ok(Reading { phasor, variance, ..reading })
    };
    let readings: [Reading; CHANNELS] = [read(0)?, read(1)?];
    // a reading has eight ticks on a turn at least
    let speed = core::f32::consts::TAU * M::RATE_HZ as f32 / readings[0].ticks;
    Ok(Measured { readings, speed })
}

/// The answer to [`Key::State`].
pub fn state<M: HasVibration, N: VibrationNumber>(
    config: &PhasorsConfig<N, CHANNELS>,
    measurement: &Measurement<N>,
) -> u32 {
    match reading::<M, N>(config, measurement) {
        Ok(_) => DONE,
        Err(ReadingFault::Incomplete { .. }) => MEASURING,
        Err(doubt) => refused(number(&doubt)),
    }
}

/// The reasons why something measured is no reading, in the order of their numbers.
pub const DOUBTS: [&str; 8] = [
    "no such channel",
    "passed its zero backwards",
    "too few ticks on a turn",
    "clipped",
    "the speed moved",
    "drifting",
    "scattered",
    "samples missing",
];

fn number(doubt: &ReadingFault) -> u32 {
    match doubt {
        ReadingFault::NoChannel => 0,
        ReadingFault::Backwards { .. } => 1,
        ReadingFault::TooFast => 2,
        ReadingFault::Clipped => 3,
        ReadingFault::SpeedMoved { .. } => 4,
        ReadingFault::Drifting { .. } => 5,
        ReadingFault::Missing { .. } => 7,
        _ => 6,
    }
}
