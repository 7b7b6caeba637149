//! The test rig: the drive with all four parts in the image of the NUCLEO-G474RE, with the panel of its main loop.
//!
//! The motor runs up without a load. A brake comes on, then the spring of the crank. The panel shows the fluctuation;
//! after that the head balances the disc in-run.

use std::f64::consts::{PI, TAU};
use std::io;

use driveline::configure::HasVibration as _;
use driveline::configure::Machine as _;
use driveline_firmware::Words;
use driveline_firmware::panel::axis_panel::AxisPanel;
use driveline_firmware::scene::panel_keys::Key;
use driveline_firmware::scene::{Constants, Input, Of, Output, Scene as _, Variant as _};
use driveline_firmware::scenes::test_rig::{self as scene, Adviser, TestRig, Whole};

use super::error::BalancingError;
use super::four_parts::{Told, claim, deviations, mean, observed, whole_turns};
use super::grinder::GrinderStart;
use super::in_run::{Course, HeadRun};
use super::machine::{Drivetrain, Machine, Seen};
use super::operator::Operator;
use super::outcome::Claim;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::plant::{Chain, Plant, Shaft};
use driveline_solver::rotor::{Bearing, Direction, Faulty, Modal, Model, Polar, RigidRotor, Transducer, Whirl};

/// The button's speed, at which the rig is run (rad/s).
const SPEED: f64 = scene::SPEED;
/// Motor with half coupling, and disc (kg m2).
const INERTIA: [f64; 2] = [3.2e-5, 7.7e-4];
/// Mass of disc, shaft and half coupling (kg).
const MASS: f64 = 1.0;
/// Torque of the brake, and of the spring once and twice a turn (N m).
const BRAKE: f64 = 0.3 * TestRig::RATING.torque.0;
const SPRING: [f64; 2] = [0.1, 0.03];
/// Time for speed and whirl to settle at first, and after each change (s).
const SETTLE: [f64; 2] = [1.5, 1.0];
/// Longest wait for a window of turns (s): three windows.
const PATIENCE: f64 = 3.0 * 16.0 * TAU / SPEED;
const PERIOD: f64 = 1.0 / TestRig::RATE_HZ as f64;

/// The scene, and the panel of the board's main loop beside it.
struct Rig {
    scene: Whole<f32>,
    panel: AxisPanel<TestRig, Adviser>,
}

impl Ticks for Rig {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        let output = self.scene.tick(input);
        let config = <Of<TestRig, Whole<f32>> as Constants>::CONFIG;
        self.panel.balance(config, &mut self.scene);
        Ok(Output { answer: self.panel.ask(config, &mut self.scene, input.asked), ..output })
    }
}

/// Runs the rig, whose rotor and sensors are spread as the grinder's, and compares what each part of the drive does
/// with the plant.
///
/// # Errors
/// Why it could not be balanced.
pub fn rig(start: &GrinderStart) -> Result<(Course, Vec<Claim>), BalancingError> {
    let model = model(start)?;
    let found = Polar::degrees(start.unbalance.size * UNBALANCE, start.unbalance.angle);
    let mut drive = Rig { scene: Of::<TestRig, Whole<f32>>::start(), panel: AxisPanel::default() };
    let mut operator = Operator::new(machine(&model, found, start)?, &mut drive).with_head(found);
    operator.machine.keep();
    operator.bring_to(SPEED, SETTLE[0])?;
    let braked = operator.machine.seen().len();
    operator.machine.set_torque(BRAKE, Vec::new());
    operator.wait(SETTLE[1])?;
    let swinging = operator.machine.seen().len();
    operator.machine.set_torque(BRAKE, vec![(1.0, SPRING[0]), (2.0, SPRING[1])]);
    operator.wait(SETTLE[1])?;

    let told = Told::ask(&mut operator, PATIENCE)?;
    operator.press(Key::Balance, 1)?;
    let run = HeadRun { model: &model, mass: MASS, speed: SPEED };
    let course = run.watch(&mut operator, found)?.0;

    let seen = operator.machine.seen();
    let window = &seen[told.from..told.to];
    // The run stays far below the rated torque: against the noise that the design predicts, not against the peak.
    let predicted = TestRig::OBSERVER.standard_deviation.shaft_torque;
    let mut claims =
        vec![claim("error of the shaft torque, rms, over the design's", deviations(seen)[2] / predicted, 1.0)];
    claims.extend(observed(seen, TestRig::RATING.speed.0));
    // the load's speed deviates by 0.15 rad/s, its delta is 2.9 rad/s; of the motor as in the grinder
    claims.extend(told.claims(seen, PERIOD, 1.0));
    claims.extend(governed(&seen[braked..swinging], &whole_turns(window))?);
    claims.extend(course.claims());
    Ok((course, claims))
}

/// The grinder's unbalance (kg m), stiffness (N/m) and damping (N s/m) at the rig's scale.
const UNBALANCE: f64 = 1.0e-4 / 2.0e-2;
const STIFFNESS: f64 = 4.0e4 / 8.0e6;
const DAMPING: f64 = 15.0 / 4.0e3;

/// Disc, its shaft and half coupling: 1 kg between two bearings on soft stands.
fn model(start: &GrinderStart) -> Result<Model, BalancingError> {
    let bearing = |stiffness: f64| {
        Bearing::anisotropic([STIFFNESS * stiffness, 0.8 * STIFFNESS * stiffness], [DAMPING * start.damping; 2])
    };
    Ok(RigidRotor::new(MASS, 7.7e-4, 1.5e-3)
        .bearing(0.06, bearing(start.stiffness[0]))
        .bearing(-0.06, bearing(start.stiffness[1]))
        .station(0.02)
        .sensor(0.06, Direction::X)
        .sensor(-0.06, Direction::X)
        .build()?)
}

/// Motor, rod and disc.
fn plant() -> Result<Plant, BalancingError> {
    // G pi d^4/(32 l) of the rod of steel
    let stiffness = 79.3e9 * PI * 0.005_f64.powi(4) / (32.0 * 0.150);
    Ok(Chain::motor(INERTIA[0]).shaft(Shaft::elastic(stiffness).damping(6.0e-4), INERTIA[1]).build()?)
}

/// Dip of the disc's speed under the brake (rad/s), by the design's gains on the plant's true speeds.
fn dip() -> Result<f64, BalancingError> {
    let (mut plant, gains) = (plant()?, TestRig::SPEED_LOOP);
    let (mut integral, mut least) = (0.0, 0.0_f64);
    for _ in 0..TestRig::RATE_HZ {
        let [motor, disc] = [plant.motor_speed(), plant.speed(1)];
        integral += gains.integral * motor * PERIOD;
        plant.set_load_torque(1, BRAKE);
        plant.advance(-gains.proportional * motor - integral - gains.damping * (motor - disc), PERIOD);
        least = least.min(plant.speed(1));
    }
    Ok(-least)
}

fn machine(model: &Model, found: nalgebra::Complex<f64>, start: &GrinderStart) -> Result<Machine, BalancingError> {
    let drivetrain = Drivetrain {
        plant: plant()?,
        rotor: 1,
        load: 0.0,
        torque: 0.0,
        ripple: Vec::new(),
        rated: SPEED,
        torque_noise: 0.02 * TestRig::RATING.torque.0,
    };
    let mut whirl = Whirl::new(Modal::of(model)?, PERIOD);
    whirl.set_unbalance(&[found])?;
    // The noise is 20 dB below the vibration as it is found.
    let response = model.response(SPEED, &[found])?;
    let noise = 0.1 * response.iter().map(|x| x.norm()).fold(0.0, f64::max) * SPEED / 2f64.sqrt();
    let sensor = |(share, phase): (f64, f64), seed: u64| {
        Faulty::new(Transducer::Velocity, seed)
            .error(share, phase.to_radians())
            .noise(noise)
            .range(TestRig::VIBRATION_LIMIT)
    };
    let [front, rear] = start.sensors;
    let sensors = [sensor(front, 2 * start.seed + 1), sensor(rear, 2 * start.seed + 2)];
    let units = Units::new(Words::Single, TestRig::BASES);
    Ok(Machine::new(drivetrain, whirl, sensors, units, 1.0).with_encoder(scene::COUNTS).with_noise(start.seed))
}

/// What is claimed of the governor: `braked` are the ticks from the brake on, `turns` those with the spring.
fn governed(braked: &[Seen], turns: &[&[Seen]]) -> Result<Vec<Claim>, BalancingError> {
    let held = turns.iter().map(|turn| mean(turn, 1)).sum::<f64>() / turns.len() as f64;
    let least = braked.iter().map(|tick| tick.truth[1]).fold(f64::INFINITY, f64::min);
    Ok(vec![
        // The integral leaves nothing; a turn in the mean begins and ends within a tick, of 628.
        claim("mean speed off its setpoint with the spring, as a share", (held / SPEED - 1.0).abs(), 1e-4),
        // A tenth for the observer.
        claim(
            "dip of the disc's speed as the brake comes on, off that by the true speeds",
            ((SPEED - least) / dip()? - 1.0).abs(),
            0.1,
        ),
    ])
}
