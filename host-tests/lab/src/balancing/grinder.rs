//! The surface grinder: a drive with all four parts, each checked in one run.
//!
//! The wheel runs up and idles, then it cuts. The panel shows the fluctuation; after that the head balances the wheel,
//! which goes on cutting. The drive's estimates are compared with the plant in every tick from the start on.

use std::f64::consts::{E, TAU};

use driveline::configure::HasVibration as _;
use driveline::configure::Machine as _;
use driveline_firmware::Words;
use driveline_firmware::scenes::surface_grinder::{self as scene, SurfaceGrinder};
use nalgebra::Complex;
use serde::Serialize;

use super::error::BalancingError;
use super::four_parts::{Told, claim, deviations, mean, observed, whole_turns};
use super::in_run::{Course, HeadRun};
use super::machine::{Drivetrain, Machine, Seen};
use super::operator::Operator;
use super::outcome::{Claim, Outcome, Vector};
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::noise::Noise;
use driveline_solver::plant::{Chain, Shaft};
use driveline_solver::rotor::{Bearing, Direction, Faulty, Modal, Model, Polar, RigidRotor, Transducer, Whirl};

/// Rated speed (rad/s).
const SPEED: f64 = SurfaceGrinder::RATING.speed.0;
/// Torque of coolant and air, which is there from the start, and mean torque of the cut beside it (N m).
const IDLE: f64 = 0.1 * SurfaceGrinder::RATING.torque.0;
const CUT: f64 = 0.4 * SurfaceGrinder::RATING.torque.0;
/// Swing of the cut once and twice a turn, as a share of its mean.
const SWING: [f64; 2] = [0.8, 0.3];
/// Time for speed and whirl to settle at first, and for the speed after the cut has begun (s).
const SETTLE: [f64; 2] = [1.5, 3.0];
/// Mass of spindle, wheel and housings (kg).
const MASS: f64 = 140.0;
/// Where head and wheel are, from the centre of gravity (m).
const WHEEL: f64 = 0.25;
/// Longest wait for a window of turns (s): three windows.
const PATIENCE: f64 = 3.0 * 32.0 * TAU / SPEED;

/// Stiffness of the coupling (N m/rad); with its damping of 3.6 N m s/rad half of the energy of a swing at the
/// resonance of 110 rad/s is lost in each, by 2 pi c omega/k.
const COUPLING: f64 = 4.9e3;

/// Random: the rotor, its unbalance, its sensors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GrinderStart {
    /// Unbalance of the wheel (kg m), and its angle (degrees).
    pub unbalance: Vector,
    /// Stiffness of the front and the rear bearing with their housings (N/m).
    pub stiffness: [f64; 2],
    /// Damping of both (N s/m).
    pub damping: f64,
    /// Sensors' errors: share and phase (degrees).
    pub sensors: [(f64, f64); 2],
    /// Seed of the noise.
    pub seed: u64,
}

impl GrinderStart {
    /// The start of a number, spread as those of the grinding spindle: unbalance of 10 to 95 % of the head's capacity
    /// at any angle, stiffness from half to twice, damping likewise, sensors off by up to 5 % and 10 degrees.
    #[must_use]
    pub fn random(number: u64) -> Self {
        let mut source = Noise::new(number.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(54_321));
        // the first few numbers of near seeds are alike
        for _ in 0..16 {
            source.normal();
        }
        let mut unit = || source.uniform();
        let factor = |x: f64| 2f64.powf(x);
        GrinderStart {
            unbalance: Vector { size: scene::CAPACITY * (0.525 + 0.425 * unit()), angle: 180.0 * unit() },
            stiffness: [8.0e6 * factor(unit()), 6.0e6 * factor(unit())],
            damping: 4.0e3 * factor(unit()),
            sensors: [(0.05 * unit(), 10.0 * unit()), (0.05 * unit(), 10.0 * unit())],
            seed: number,
        }
    }

    /// Spindle, wheel and housings: 140 kg.
    fn model(&self) -> Result<Model, BalancingError> {
        let bearing = |stiffness: f64| Bearing::anisotropic([stiffness, 0.8 * stiffness], [self.damping; 2]);
        Ok(RigidRotor::new(MASS, 1.9, 6.0)
            .bearing(0.12, bearing(self.stiffness[0]))
            .bearing(-0.25, bearing(self.stiffness[1]))
            .station(WHEEL)
            .sensor(0.12, Direction::X)
            .sensor(-0.25, Direction::X)
            .build()?)
    }
}

/// Balances a grinder from a start with a drive, and compares what each part of the drive does with the plant.
///
/// # Errors
/// Why it could not be balanced.
pub fn grinder(words: Words, drive: &mut dyn Ticks, start: &GrinderStart) -> Result<(Course, Outcome), BalancingError> {
    let model = start.model()?;
    let found = Polar::degrees(start.unbalance.size, start.unbalance.angle);
    let mut operator = Operator::new(machine(words, &model, found, start)?, drive).with_head(found);
    operator.machine.keep();
    operator.bring_to(SPEED, SETTLE[0])?;
    let begun = operator.machine.seen().len();
    let swing = |share: f64| share * CUT;
    operator.machine.set_torque(CUT, vec![(1.0, swing(SWING[0])), (2.0, swing(SWING[1]))]);
    operator.wait(SETTLE[1])?;

    let told = Told::ask(&mut operator, PATIENCE)?;
    let run = HeadRun { model: &model, mass: MASS, speed: SPEED };
    let (course, stages) = run.watch(&mut operator, found)?;

    let seen = operator.machine.seen();
    let window = &seen[told.from..told.to];
    let peak = seen.iter().map(|tick| tick.truth[2].abs()).fold(0.0, f64::max);
    let [motor_speed, _, shaft_torque] = deviations(seen);
    let mut claims = vec![
        // so that a turn's extremes show its delta to 6 %
        claim("error of the motor speed, rms, as a share of rated", motor_speed / SPEED, 2e-4),
        // as the report holds every drivetrain with a tight shaft to
        claim("error of the shaft torque, rms, as a share of its peak", shaft_torque / peak, 0.02),
    ];
    claims.extend(observed(seen, SPEED));
    let period = 1.0 / f64::from(SurfaceGrinder::RATE_HZ);
    claims.extend(told.claims(seen, period, 0.37));
    claims.extend(governed(&seen[begun..told.from], &whole_turns(window)));
    claims.extend(course.claims());
    let rows = ["front bearing", "rear bearing"].map(str::to_owned).to_vec();
    let measure = "share of the vibration that is left";
    Ok((course, super::scene::outcome("surface-grinder", measure, rows, stages, claims, operator)))
}

/// The same from the start that `seed` gives.
pub(super) fn run(words: Words, drive: &mut dyn Ticks, seed: u64) -> Result<Outcome, BalancingError> {
    Ok(grinder(words, drive, &GrinderStart::random(seed))?.1)
}

fn machine(words: Words, model: &Model, found: Complex<f64>, start: &GrinderStart) -> Result<Machine, BalancingError> {
    let plant = Chain::motor(0.5 + 0.02).shaft(Shaft::elastic(COUPLING).damping(3.6), 1.9).build()?;
    let drivetrain = Drivetrain {
        plant,
        rotor: 1,
        load: IDLE / (SPEED * SPEED),
        torque: 0.0,
        ripple: Vec::new(),
        rated: SPEED,
        torque_noise: 0.01 * SurfaceGrinder::RATING.torque.0,
    };
    let mut whirl = Whirl::new(Modal::of(model)?, 1.0 / f64::from(SurfaceGrinder::RATE_HZ));
    whirl.set_unbalance(&[found])?;
    // The noise is 20 dB below the vibration as it is found.
    let response = model.response(SPEED, &[found])?;
    let velocity = response.iter().map(|x| x.norm()).fold(0.0, f64::max) * SPEED;
    let noise = 0.1 * velocity / 2f64.sqrt();
    let sensor = |(share, phase): (f64, f64), seed: u64| {
        Faulty::new(Transducer::Velocity, seed)
            .error(share, phase.to_radians())
            .noise(noise)
            .range(SurfaceGrinder::VIBRATION_LIMIT)
    };
    let [front, rear] = start.sensors;
    let sensors = [sensor(front, 2 * start.seed + 1), sensor(rear, 2 * start.seed + 2)];
    let units = Units::new(words, SurfaceGrinder::BASES);
    Ok(Machine::new(drivetrain, whirl, sensors, units, SurfaceGrinder::VIBRATION_BASE)
        .with_encoder(scene::COUNTS)
        .with_noise(start.seed))
}

/// What is claimed of the governor: `after` are the ticks from the beginning of the cut on, `turns` those after the
/// speed has settled.
fn governed(after: &[Seen], turns: &[&[Seen]]) -> Vec<Claim> {
    let held = turns.iter().map(|turn| mean(turn, 1)).sum::<f64>() / turns.len() as f64;
    let least = whole_turns(after).iter().map(|turn| mean(turn, 0)).fold(f64::INFINITY, f64::min);
    // J s^2 + k_p s + k_i with a double pole at w dips by T/(J w e) under a step T of the load.
    let bandwidth = 0.2 * (COUPLING / 1.9).sqrt();
    let dip = CUT / ((0.52 + 1.9) * bandwidth * E);
    vec![
        // The integral leaves nothing; a turn in the mean begins and ends within a tick, of 816.
        claim("mean speed off its setpoint while it cuts, as a share", (held / SPEED - 1.0).abs(), 1e-4),
        // A tenth for the coupling, which the closed form leaves out.
        claim(
            "dip of the speed as the cut begins, off that of a rigid machine",
            ((SPEED - least) / dip - 1.0).abs(),
            0.1,
        ),
    ]
}
