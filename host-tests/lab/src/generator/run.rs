//! A set and its drive in lock-step.

use std::io;

use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::generator::{RATE_HZ, RATED_SPEED, panel};

use super::set::{Kind, STEPS, Set};
use driveline_closed_loop::sensors::Encoder;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::noise::Noise;
use driveline_solver::plant::PlantError;

/// Actions on a genset and their times (s).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// Speed at which it is found turning (rad/s).
    pub speed: f64,
    /// When the run switch is on.
    pub on: f64,
    /// The panel's choice of constants: 0 with feed-forward, 1 without, 2 with droop.
    pub constants: u32,
    /// Loads, of rated power.
    pub loads: Vec<(f64, f64)>,
    /// When the rack seizes.
    pub seizes: Option<f64>,
    pub duration: f64,
}

/// One tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment {
    /// Time (s).
    pub time: f64,
    /// The generator's frequency over the last period of it, of rated.
    pub frequency: f64,
    /// Torque commanded, of rated.
    pub command: f64,
    /// State, as reported by the panel.
    pub mode: u32,
}

/// Why a run ended early.
#[derive(Debug, thiserror::Error)]
pub enum Broken {
    /// The plant cannot be.
    #[error("the plant of the set: {0}")]
    Plant(#[from] PlantError),
    /// The drive's link.
    #[error("the link to the drive: {0}")]
    Link(#[from] io::Error),
}

/// Standard deviation of the rack's position sensor, of rated torque.
const SENSOR: f64 = 0.002;

/// Ticks in an electrical period of 50 Hz: the mean over it is the frequency that a meter shows.
const ELECTRICAL: usize = RATE_HZ as usize / 50;

/// Runs a program. `spoil` has every input in its hands before the drive does.
pub fn run(
    kind: Kind,
    words: Words,
    program: &Program,
    drive: &mut impl Ticks,
    mut spoil: impl FnMut(f64, &mut Input),
) -> Result<Vec<Moment>, Broken> {
    let constants = kind.constants();
    let units = Units::new(words, constants.bases());
    let mut set = Set::new(kind, program.speed)?;
    let encoder = Encoder::new(8192);
    let mut noise = Noise::new(1);
    let period = 1.0 / f64::from(RATE_HZ);
    let ticks = (program.duration * f64::from(RATE_HZ)).round() as usize;
    let mut angles = [set.generator_angle(); ELECTRICAL];
    let mut moments = Vec::with_capacity(ticks);
    let mut loads = program.loads.iter().peekable();
    for tick in 0..ticks {
        let time = tick as f64 * period;
        let due = |at: f64| at < time + 0.5 * period;
        while let Some((_, share)) = loads.next_if(|(at, _)| due(*at)) {
            set.set_load(*share);
        }
        if program.seizes.is_some_and(due) {
            set.seize();
        }
        let asked = if tick == 0 { [panel::CONSTANTS, program.constants] } else { [panel::MODE, 0] };
        let mut input = Input {
            angle: encoder.read(set.flywheel_angle()),
            torque: units.torque_word(set.told() + SENSOR * constants.rated_torque * noise.normal()),
            setpoint: units.speed_word(RATED_SPEED),
            flags: if due(program.on) { Input::RELEASED } else { 0 },
            asked,
            ..Input::default()
        };
        spoil(time, &mut input);
        let output = drive.tick(&input)?;
        let command = units.torque(output.torque);
        let angle = set.generator_angle();
        let over = f64::from(u32::try_from(tick.min(ELECTRICAL)).unwrap_or(1)) * period;
        let before = angles[if tick < ELECTRICAL { 0 } else { tick % ELECTRICAL }];
        let frequency = if tick == 0 { set.generator_speed() } else { (angle - before) / over };
        angles[tick % ELECTRICAL] = angle;
        moments.push(Moment {
            time,
            frequency: frequency / RATED_SPEED,
            command: command / constants.rated_torque,
            mode: if tick == 0 { 0 } else { output.answer },
        });
        for _ in 0..STEPS {
            set.step(command, period / f64::from(STEPS));
        }
    }
    Ok(moments)
}
