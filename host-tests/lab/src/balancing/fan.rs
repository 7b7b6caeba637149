//! The fan: two planes, trial weights, one correction and one trim.

use driveline::configure::HasVibration as _;
use driveline::configure::Machine as _;
use driveline_firmware::Words;
use driveline_firmware::scene::panel_keys::{Key, next};
use driveline_firmware::scenes::balanced_fan::BalancedFan;
use nalgebra::Complex;

use super::error::BalancingError;
use super::machine::{Drivetrain, Machine};
use super::operator::{Hand, Operator};
use super::outcome::{Claim, Outcome, Stage, Vector};
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
    let mut hand = Hand::new(0.03, 2.0, 77 + seed);
    let mut operator = Operator::new(machine(words, &model, &found, seed)?, drive);
    let mut now = found;
    let mut stages = Vec::new();

    loop {
        match operator.ask(Key::Next, 0)? {
            next::BASELINE => {
                measure(&mut operator)?;
                operator.press(Key::Baseline, 0)?;
                stages.push(stage("as found", &mut operator, &model, &now)?);
            }
            step @ (next::CORRECTION | next::TRIM) => {
                // one correction and one trim, whatever the procedure would go on to
                if stages.len() == 3 {
                    break;
                }
                operator.press(Key::Solve, 0)?;
                for (plane, u) in now.iter_mut().enumerate() {
                    *u += hand.set(operator.complex([Key::AddRe, Key::AddIm], plane as u32)?);
                }
                set(&mut operator, &now)?;
                operator.press(Key::Placed, 0)?;
                measure(&mut operator)?;
                operator.press(Key::Verified, 0)?;
                let name = if step == next::TRIM { "trimmed" } else { "corrected" };
                stages.push(stage(name, &mut operator, &model, &now)?);
            }
            trial @ next::TRIAL.. => {
                let (plane, weight) = (trial - next::TRIAL, Polar::degrees(TRIAL, 45.0));
                let mut with = now;
                if let Some(u) = with.get_mut(plane as usize) {
                    *u += hand.set(weight);
                }
                set(&mut operator, &with)?;
                measure(&mut operator)?;
                operator.tell_weight(weight)?;
                operator.press(Key::Trial, plane)?;
            }
            _ => break,
        }
    }
    let claim = |name: &str, stage: usize, limit: f64| {
        let measured = stages.get(stage).map_or(f64::NAN, |stage: &Stage| stage.measure);
        Claim { name: name.to_owned(), measured, limit }
    };
    let claims = vec![claim("grade after one correction, from G 16", 1, 2.5), claim("grade after one trim", 2, 1.0)];
    Ok(super::scene::outcome("balanced-fan", "grade G, mm/s", rows(), stages, claims, operator))
}

fn rows() -> Vec<String> {
    ["motor side", "far side"].map(str::to_owned).to_vec()
}

/// To speed, and a reading of both channels.
fn measure(operator: &mut Operator<'_>) -> Result<(), BalancingError> {
    operator.bring_to(BalancedFan::RATING.speed.0, SETTLE)?;
    operator.read()?;
    operator.press(Key::Row, 0)
}

/// To standstill, and other weights.
fn set(operator: &mut Operator<'_>, unbalance: &[Complex<f64>]) -> Result<(), BalancingError> {
    operator.bring_to(0.0, 0.5)?;
    Ok(operator.machine.whirl().set_unbalance(unbalance)?)
}

fn stage(
    name: &str,
    operator: &mut Operator<'_>,
    model: &Model,
    unbalance: &[Complex<f64>],
) -> Result<Stage, BalancingError> {
    let mut read = Vec::new();
    for row in 0..2 {
        read.push(Vector::of(operator.complex([Key::RowRe, Key::RowIm], row)?));
    }
    Ok(Stage {
        name: name.to_owned(),
        unbalance: unbalance.iter().map(|&u| Vector::of(u)).collect(),
        vibration: model.response(BalancedFan::RATING.speed.0, unbalance)?.into_iter().map(Vector::of).collect(),
        read,
        measure: grade(unbalance),
        time: operator.machine.time(),
    })
}
