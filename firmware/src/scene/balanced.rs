//! A governed drive whose rotor is balanced, as a scene: two vibration channels on the tick, and a panel between ticks.

use driveline::angle::Synchronous;
use driveline::balancing::{Phasors, Reading, ReadingFault};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::observer::Observer;

use crate::scene::governed::advance;
use crate::scene::panel_keys::{DONE, Key, MEASURING, refused};
use crate::scene::{Input, Output, Scene};

/// Vibration channels.
pub const CHANNELS: usize = 2;

/// Edges of a reading: eight blocks.
pub const EDGES: usize = 9;

/// The measurement of a balanced scene.
pub type Measurement<N> = Phasors<N, CHANNELS, EDGES>;

/// The constants of a balanced drive.
pub type Constants<N, O> = ConfigOf<BalancedDrive<N, O>>;

/// The drive of a balanced scene.
pub type BalancedDrive<N, O> = Drive<N, O, (), SpeedLoop<N>, Measurement<N>>;

/// The parts and constants of one variant of a balanced scene.
pub trait Variant: 'static {
    /// What it calculates with.
    type Number: Synchronous + 'static;
    /// What it estimates with.
    type Observer: Observer<Self::Number>;
    /// What its panel does with readings.
    type Adviser: Adviser;
    /// Scene, number, observer and rate.
    const NAME: &'static str;
    /// Ticks a second.
    const RATE_HZ: u32;
    /// What a vibration of one is in the unit of the sensors: 1 for floats, the base in fixed point.
    const UNIT: f32;
    /// The drive's constants.
    const CONFIG: &'static Constants<Self::Number, Self::Observer>;
}

/// A complete reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Of both channels, in the unit of the sensors.
    pub readings: [Reading; CHANNELS],
    /// Speed of the rotor over it \[rad/s\].
    pub speed: f32,
}

/// What makes weights of readings.
pub trait Adviser {
    /// Nothing known yet.
    fn new() -> Self;
    /// Answers a key that is not about the measurement itself; `measured` is the last reading, where it is complete
    /// and good.
    fn ask(&mut self, key: Key, value: u32, measured: Option<Measured>) -> u32;
}

/// A drive with its constants, and its panel.
pub struct Balanced<V: Variant> {
    // By reference: folded into the code, the constants cost more instructions than loaded from a table.
    config: &'static Constants<V::Number, V::Observer>,
    drive: BalancedDrive<V::Number, V::Observer>,
    adviser: V::Adviser,
}

impl<V: Variant> Scene for Balanced<V> {
    const NAME: &'static str = V::NAME;
    const RATE_HZ: u32 = V::RATE_HZ;

    fn new() -> Self {
        // An incremental encoder counts from where it was switched on.
        Balanced { config: V::CONFIG, drive: Drive::new(V::CONFIG, 0), adviser: V::Adviser::new() }
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        let output = advance(&mut self.drive, self.config, input);
        self.drive.vibration(self.config, &input.vibration.map(<V::Number as driveline::number::Number>::from_word));
        output
    }

    fn panel(&mut self, asked: [u32; 2]) -> u32 {
        let [key, value] = asked;
        match Key::of(key) {
            None => 0,
            Some(Key::Begin) => {
                self.drive.balancer_mut().begin();
                DONE
            }
            Some(Key::State) => state::<V>(self.drive.balancer()),
            Some(key) => self.adviser.ask(key, value, reading::<V>(self.drive.balancer()).ok()),
        }
    }
}

/// What a measurement has read.
///
/// # Errors
/// Why it is no reading, or not yet.
pub fn reading<V: Variant>(measurement: &Measurement<V::Number>) -> Result<Measured, ReadingFault> {
    let read = |channel| {
        let reading = measurement.reading(&V::CONFIG.balancer, channel)?;
        let (phasor, variance) = (reading.phasor.scaled(V::UNIT), reading.variance * V::UNIT * V::UNIT);
        Ok(Reading { phasor, variance, ..reading })
    };
    let readings: [Reading; CHANNELS] = [read(0)?, read(1)?];
    // a reading has eight ticks on a turn at least
    let speed = core::f32::consts::TAU * V::RATE_HZ as f32 / readings[0].ticks;
    Ok(Measured { readings, speed })
}

/// The answer to [`Key::State`].
pub fn state<V: Variant>(measurement: &Measurement<V::Number>) -> u32 {
    match reading::<V>(measurement) {
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
