//! The fan: two planes, trial weights, one correction and one trim.

use driveline::configure::HasVibration as _;
use driveline::configure::Machine as _;
use driveline_firmware::Words;
use driveline_firmware::scenes::balanced_fan::BalancedFan;
use nalgebra::Complex;

use super::error::BalancingError;
use super::machine::{Drivetrain, Machine};
use super::operator::{Hand, Operator};
use super::outcome::{Claim, Outcome, Stage};
use super::trials::Trials;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::plant::{Chain, Shaft};
use driveline_solver::rotor::{Bearing, Direction, Faulty, Modal, Model, Polar, RigidRotor, Transducer, Whirl};

/// Mass of the rotor (kg), its moments of inertia about the axis and about a diameter (kg m2).
const ROTOR: [f64; 3] = [180.0, 11.0, 8.5];
/// Planes and bearings, from the centre of gravity (m).
const PLANE: f64 = 0.28;
const BEARING: f64 = 0.45;
/// Grade that it is found in.
const FOUND: f64 = 16.0;
/// Trial weights (kg m): 1.4 times what is permitted in a plane in grade 6.3.
const TRIAL: f64 = 5e-3;
/// Time that the speed is given to settle (s).
const SETTLE: f64 = 2.0;

/// The fan's rotor on its pedestals, which are softer along `y` than along `x`.
fn model() -> Result<Model, BalancingError> {
    let pedestal = Bearing::anisotropic([1.1e7, 0.8e7], [9.0e3, 8.0e3]);
    let [mass, polar, diametral] = ROTOR;
    Ok(RigidRotor::new(mass, polar, diametral)
        .bearing(-BEARING, pedestal)
        .bearing(BEARING, pedestal)
        .station(-PLANE)
        .station(PLANE)
        .sensor(-BEARING, Direction::X)
        .sensor(BEARING, Direction::X)
        .build()?)
}

/// Permissible unbalance of a plane in a grade (kg m): each carries half the rotor.
fn permissible(grade: f64) -> f64 {
    0.5 * ROTOR[0] * grade * 1e-3 / BalancedFan::RATING.speed.0
}

/// The grade that the worse of the planes is in.
fn grade(unbalance: &[Complex<f64>]) -> f64 {
    unbalance.iter().map(|u| u.norm() / permissible(1.0)).fold(0.0, f64::max)
}

fn machine(words: Words, model: &Model, found: &[Complex<f64>], seed: u64) -> Result<Machine, BalancingError> {
    let plant = Chain::motor(1.3).shaft(Shaft::elastic(6.0e4).damping(12.0), 11.0).viscous(0.1).build()?;
    let drivetrain = Drivetrain {
        plant,
        rotor: 1,
        load: 0.9 * BalancedFan::RATING.torque.0 / BalancedFan::RATING.speed.0.powi(2),
        // ten blades, and a misaligned coupling
        torque: 0.0,
        ripple: vec![(10.0, 40.0), (2.0, 30.0)],
        rated: BalancedFan::RATING.speed.0,
        torque_noise: 0.01 * BalancedFan::RATING.torque.0,
    };
    let mut whirl = Whirl::new(Modal::of(model)?, 1.0 / f64::from(BalancedFan::RATE_HZ));
    whirl.set_unbalance(found)?;
    // The noise is 20 dB below the vibration as it is found.
    let amplitude = model.response(BalancedFan::RATING.speed.0, found)?.iter().map(|x| x.norm()).fold(0.0, f64::max);
    let noise = 0.1 * amplitude * BalancedFan::RATING.speed.0 / 2f64.sqrt();
    let sensor = |seed: u64, share: f64, phase: f64| {
        Faulty::new(Transducer::Velocity, seed)
            .error(share, f64::to_radians(phase))
            .noise(noise)
            .range(BalancedFan::VIBRATION_LIMIT)
    };
    let sensors = [sensor(2 * seed + 1, 0.05, 10.0), sensor(2 * seed + 2, -0.05, -10.0)];
    Ok(Machine::new(drivetrain, whirl, sensors, Units::new(words, BalancedFan::BASES), BalancedFan::VIBRATION_BASE))
}

/// Balances the fan with a drive; `seed` is that of everything that is left to chance.
pub fn run(words: Words, drive: &mut dyn Ticks, seed: u64) -> Result<Outcome, BalancingError> {
    let model = model()?;
    let mut chance = driveline_solver::noise::Noise::new(1000 + seed);
    let mut angle = || Polar::degrees(permissible(FOUND), 180.0 * chance.normal());
    let found = [angle(), angle()];
    let mut operator = Operator::new(machine(words, &model, &found, seed)?, drive);
    let trials = Trials {
        model: &model,
        speeds: &[BalancedFan::RATING.speed.0],
        settle: SETTLE,
        weights: [Polar::degrees(TRIAL, 45.0); 2],
        hand: Hand::new(0.03, 2.0, 77 + seed),
        stages: 3,
        measure: &|unbalance| Ok(grade(unbalance)),
    };
    let (stages, _) = trials.balance(&mut operator, found)?;
    let claim = |name: &str, stage: usize, limit: f64| {
        let measured = stages.get(stage).map_or(f64::NAN, |stage: &Stage| stage.measure);
        Claim { name: name.to_owned(), measured, limit }
    };
    let claims = vec![claim("grade after one correction, from G 16", 1, 2.5), claim("grade after one trim", 2, 1.0)];
    let rows = ["motor side", "far side"].map(str::to_owned).to_vec();
    Ok(super::scene::outcome("balanced-fan", "grade G, mm/s", rows, stages, claims, operator))
}
