//! The flexible rotor: three planes, two speeds, one correction.

use driveline::configure::HasVibration as _;
use driveline::configure::Machine as _;
use driveline_firmware::Words;
use driveline_firmware::scene::panel_keys::Key;
use driveline_firmware::scenes::flexible::{self as scene, Flexible};
use nalgebra::Complex;

use super::error::BalancingError;
use super::machine::{Drivetrain, Machine};
use super::operator::{Hand, Operator};
use super::outcome::{Claim, Outcome};
use super::trials::Trials;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::plant::{Chain, Shaft};
use driveline_solver::rotor::{
    Bearing, Direction, Disc, Faulty, FlexibleRotor, Material, Modal, Model, Polar, Transducer, Whirl,
};

/// The unbalance as it is found, and the trial weights [kg m, degrees].
const FOUND: [(f64, f64); 3] = [(1.8e-4, 35.0), (4.2e-4, 250.0), (2.5e-4, 160.0)];
const TRIAL: [(f64, f64); 3] = [(3e-4, 0.0), (4e-4, 90.0), (3e-4, 45.0)];
/// Time for the whirl of a run-up to die down (s): seven times 1/(1 % of 135 rad/s).
const SETTLE: f64 = 5.0;
/// Vibrations of the rotor that run in time, of 52; the other ones' share of the steady vibration is stated by the
/// tests.
const KEPT: usize = 16;
/// White noise of the sensors, as a share of the larger vibration as it is found.
const NOISE: f64 = 0.05;
/// Run-out of the shaft under the sensors (m).
const RUN_OUT: f64 = 1.5e-6;

/// Three discs on a shaft of 1.2 m.
fn model() -> Result<Model, BalancingError> {
    let bearing = Bearing::isotropic(4e6, 2500.0);
    let end = Disc::of(0.28, 0.05, 0.05, Material::STEEL);
    Ok(FlexibleRotor::uniform(12, 1.2, 0.05, Material::STEEL)
        .disc(3, end)
        .disc(6, Disc::of(0.32, 0.05, 0.07, Material::STEEL))
        .disc(9, end)
        .bearing(0, bearing)
        .bearing(12, bearing)
        .station(3)
        .station(6)
        .station(9)
        .sensor(1, Direction::X)
        .sensor(11, Direction::X)
        .build()?)
}

fn machine(words: Words, model: &Model, found: &[Complex<f64>], seed: u64) -> Result<Machine, BalancingError> {
    let plant = Chain::motor(0.4).shaft(Shaft::elastic(9.0e3).damping(3.0), 1.05).viscous(0.06).build()?;
    let drivetrain = Drivetrain {
        plant,
        rotor: 1,
        load: 0.0,
        torque: 0.0,
        ripple: vec![(1.0, 2.0), (6.0, 4.0)],
        rated: Flexible::RATING.speed.0,
        torque_noise: 0.01 * Flexible::RATING.torque.0,
    };
    let mut whirl = Whirl::new(Modal::of(model)?.lowest(KEPT), 1.0 / f64::from(Flexible::RATE_HZ));
    whirl.set_unbalance(found)?;
    let mut amplitude = 0.0_f64;
    for speed in scene::SPEEDS {
        amplitude = model.response(speed, found)?.iter().map(|x| x.norm()).fold(amplitude, f64::max);
    }
    let sensor = |seed: u64, share: f64, phase: f64, run_out: f64| {
        Faulty::new(Transducer::Displacement, seed)
            .error(share, f64::to_radians(phase))
            .noise(NOISE * amplitude)
            .run_out(1.0, RUN_OUT, run_out)
            .run_out(2.0, 0.5 * RUN_OUT, 1.0)
            .range(Flexible::VIBRATION_LIMIT)
    };
    let sensors = [sensor(2 * seed + 1, 0.05, 10.0, 0.3), sensor(2 * seed + 2, -0.05, -10.0, 2.2)];
    Ok(Machine::new(drivetrain, whirl, sensors, Units::new(words, Flexible::BASES), Flexible::VIBRATION_BASE))
}

/// Balances the rotor with a drive; `seed` is that of everything that is left to chance.
pub fn run(words: Words, drive: &mut dyn Ticks, seed: u64) -> Result<Outcome, BalancingError> {
    let model = model()?;
    let [found, weights] = [FOUND, TRIAL].map(|list| list.map(|(size, angle)| Polar::degrees(size, angle)));
    let mut operator = Operator::new(machine(words, &model, &found, seed)?, drive);
    operator.bring_to(scene::SLOW_ROLL, SETTLE)?;
    operator.read()?;
    operator.press(Key::RunOut, 0)?;
    let left = |speed: f64, unbalance: &[Complex<f64>]| -> Result<f64, BalancingError> {
        Ok(rms(&model, speed, unbalance)? / rms(&model, speed, &found)?)
    };
    let trials = Trials {
        model: &model,
        speeds: &scene::SPEEDS,
        settle: SETTLE,
        weights,
        // weights that are set exactly
        hand: Hand::new(0.0, 0.0, seed),
        stages: 2,
        measure: &|unbalance| scene::SPEEDS.iter().try_fold(0.0, |most, &speed| Ok(left(speed, unbalance)?.max(most))),
    };
    let (stages, now) = trials.balance(&mut operator, found)?;
    let claim = |&speed: &f64| {
        let rpm = (speed * 30.0 / std::f64::consts::PI).round();
        let name = format!("vibration left at {rpm} r/min, as a share");
        Ok(Claim { name, measured: left(speed, &now)?, limit: 0.05 })
    };
    let claims = scene::SPEEDS.iter().map(claim).collect::<Result<Vec<_>, BalancingError>>()?;
    let rows = ["1062 r/min, node 1", "1062 r/min, node 11", "1614 r/min, node 1", "1614 r/min, node 11"];
    let measure = "larger share of the vibration that is left";
    Ok(super::scene::outcome("flexible", measure, rows.map(str::to_owned).to_vec(), stages, claims, operator))
}

/// Root mean square of the sensors' amplitudes at a speed, by the full solver.
fn rms(model: &Model, speed: f64, unbalance: &[Complex<f64>]) -> Result<f64, BalancingError> {
    let vibration = model.response(speed, unbalance)?;
    Ok((vibration.iter().map(|x| x.norm_sqr()).sum::<f64>() / vibration.len() as f64).sqrt())
}
