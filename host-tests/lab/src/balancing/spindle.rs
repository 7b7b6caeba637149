//! The grinding spindle: a balancing head, in-run, from nothing known.

use driveline::configure::HasVibration as _;
use driveline::configure::Machine as _;
use driveline_firmware::Words;
use driveline_firmware::scenes::grinding_spindle::{self as scene, GrindingSpindle};
use nalgebra::Complex;
use serde::Serialize;

use super::error::BalancingError;
use super::in_run::{Course, HeadRun};
use super::machine::{Drivetrain, Machine};
use super::operator::Operator;
use super::outcome::{Outcome, Vector};
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::noise::Noise;
use driveline_solver::plant::{Chain, Shaft};
use driveline_solver::rotor::{Bearing, Direction, Faulty, Modal, Model, Polar, RigidRotor, Transducer, Whirl};

/// Time for speed and whirl to settle at first (s).
const SETTLE: f64 = 1.5;
/// Mass of the spindle (kg).
const MASS: f64 = 25.0;
/// Where the head and the wheel are, from the centre of gravity (m).
const WHEEL: f64 = 0.2;

/// Random: the spindle, its unbalance, its sensors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpindleStart {
    /// Unbalance of the wheel (kg m), and its angle (degrees).
    pub unbalance: Vector,
    /// Stiffness of the front and the rear bearing (N/m).
    pub stiffness: [f64; 2],
    /// Damping of both (N s/m).
    pub damping: f64,
    /// Sensors' errors: share and phase (degrees).
    pub sensors: [(f64, f64); 2],
    /// Ripple of the load at once a turn (N m).
    pub ripple: f64,
    /// Seed of the noise.
    pub seed: u64,
}

impl SpindleStart {
    /// The start of a number: unbalance of 10 to 95 % of the head's capacity at any angle, stiffness from half to
    /// twice, damping likewise, sensors off by up to 5 % and 10 degrees.
    #[must_use]
    pub fn random(number: u64) -> Self {
        let mut source = Noise::new(number.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(12_345));
        // the first few numbers of near seeds are alike
        for _ in 0..16 {
            source.normal();
        }
        let mut unit = || source.uniform();
        let factor = |x: f64| 2f64.powf(x);
        SpindleStart {
            unbalance: Vector { size: scene::CAPACITY * (0.525 + 0.425 * unit()), angle: 180.0 * unit() },
            stiffness: [1.5e7 * factor(unit()), 1.0e7 * factor(unit())],
            damping: 3.0e3 * factor(unit()),
            sensors: [(0.05 * unit(), 10.0 * unit()), (0.05 * unit(), 10.0 * unit())],
            ripple: 0.5 * unit(),
            seed: number,
        }
    }

    fn model(&self) -> Result<Model, BalancingError> {
        let bearing = |stiffness: f64| Bearing::anisotropic([stiffness, 0.8 * stiffness], [self.damping; 2]);
        Ok(RigidRotor::new(MASS, 0.18, 0.35)
            .bearing(0.1, bearing(self.stiffness[0]))
            .bearing(-0.15, bearing(self.stiffness[1]))
            .station(WHEEL)
            .sensor(0.1, Direction::X)
            .sensor(-0.15, Direction::X)
            .build()?)
    }
}

/// Balances a spindle from a start with a drive.
///
/// # Errors
/// Why it could not be balanced.
pub fn spindle(words: Words, drive: &mut dyn Ticks, start: &SpindleStart) -> Result<(Course, Outcome), BalancingError> {
    let model = start.model()?;
    let found = Polar::degrees(start.unbalance.size, start.unbalance.angle);
    let mut operator = Operator::new(machine(words, &model, found, start)?, drive).with_head(found);
    operator.bring_to(GrindingSpindle::RATING.speed.0, SETTLE)?;
    let run = HeadRun { model: &model, mass: MASS, speed: GrindingSpindle::RATING.speed.0 };
    let (course, stages) = run.watch(&mut operator, found)?;
    let claims = course.claims();
    let rows = ["front bearing", "rear bearing"].map(str::to_owned).to_vec();
    let measure = "share of the vibration that is left";
    let highest = 1.25 * GrindingSpindle::RATING.speed.0;
    let outcome = super::scene::outcome("grinding-spindle", measure, rows, stages, claims, operator, &model, highest)?;
    Ok((course, outcome))
}

/// The same from the start that `seed` gives.
pub(super) fn run(words: Words, drive: &mut dyn Ticks, seed: u64) -> Result<Outcome, BalancingError> {
    Ok(spindle(words, drive, &SpindleStart::random(seed))?.1)
}

fn machine(words: Words, model: &Model, found: Complex<f64>, start: &SpindleStart) -> Result<Machine, BalancingError> {
    let plant = Chain::motor(0.02).shaft(Shaft::elastic(1.5e3).damping(0.2), 0.18).viscous(0.02).build()?;
    let drivetrain = Drivetrain {
        plant,
        rotor: 1,
        load: 0.5 * GrindingSpindle::RATING.torque.0 / GrindingSpindle::RATING.speed.0.powi(2),
        torque: 0.0,
        ripple: vec![(1.0, start.ripple), (4.0, 1.0)],
        rated: GrindingSpindle::RATING.speed.0,
        torque_noise: 0.01 * GrindingSpindle::RATING.torque.0,
    };
    let mut whirl = Whirl::new(Modal::of(model)?, 1.0 / f64::from(GrindingSpindle::RATE_HZ));
    whirl.set_unbalance(&[found])?;
    // The noise is 20 dB below the vibration as it is found.
    let response = model.response(GrindingSpindle::RATING.speed.0, &[found])?;
    let acceleration = response.iter().map(|x| x.norm()).fold(0.0, f64::max) * GrindingSpindle::RATING.speed.0.powi(2);
    let noise = 0.1 * acceleration / 2f64.sqrt();
    let sensor = |(share, phase): (f64, f64), seed: u64| {
        Faulty::new(Transducer::Acceleration, seed)
            .error(share, phase.to_radians())
            .noise(noise)
            .range(GrindingSpindle::VIBRATION_LIMIT)
    };
    let [front, rear] = start.sensors;
    let sensors = [sensor(front, 2 * start.seed + 1), sensor(rear, 2 * start.seed + 2)];
    Ok(Machine::new(
        drivetrain,
        whirl,
        sensors,
        Units::new(words, GrindingSpindle::BASES),
        GrindingSpindle::VIBRATION_BASE,
    ))
}
