//! The hoist's full plant and its runs.
//!
//! Referred to the motor here once more, from the same figures as the scene but by own arithmetic
//! [Huang 1987 ch. 1, Wang 1989 §1-3], so that an error of the library's reduction would show.

use driveline::configure::Machine as _;
use driveline_firmware::scenes::hoist::Hoist;

use super::departure::Departure;
use super::facts;
use super::scenario::{Action, Machine, Scenario};
use crate::closed_loop::sensors::Encoder;
use driveline_solver::plant::{Chain, LoadProgram, Plant, PlantError, Shaft, Start};

/// Gravity [m/s2], the standard value of ISO 80000-3.
const GRAVITY: f64 = 9.80665;

const MASS: f64 = 12_000.0;
const DIAMETER: f64 = 0.8;
const FALLS: f64 = 2.0;
const RATIO: f64 = 31.5;
const ROPE: f64 = 2.9e6;
const ROPE_DAMPING: f64 = 3.6e3;
const EFFICIENCY: f64 = 0.94;
const MOTOR_SHAFT: f64 = 5.0e4;

/// Speed at which the slack rope is taken up [rad/s].
const CREEP: f64 = 10.0;

/// Travel of the load per angle of the motor [m/rad].
const TRAVEL: f64 = DIAMETER / (2.0 * FALLS * RATIO);
/// Torque of the weight at the motor [N m].
const WEIGHT: f64 = MASS * GRAVITY * TRAVEL;
/// The nodes of load and brake drum, and the rope's shaft.
const LOAD: usize = 2;
const DRUM: usize = 1;
const ROPE_SHAFT: usize = 1;

/// The chain up to the load, which hangs on a rope that comes taut at `slack` [rad of the motor].
fn chain(slack: f64, by: &Departure) -> Chain {
    let square = TRAVEL * TRAVEL;
    let rope = Shaft::rope(ROPE * square * by.stiffness / by.rope).damping(ROPE_DAMPING * square / by.rope);
    Chain::motor(0.62 * by.motor_inertia)
        .shaft(Shaft::elastic(MOTOR_SHAFT * by.stiffness).damping(2.0), 0.08)
        .efficiency(EFFICIENCY + by.efficiency)
        .shaft(rope.gap(slack), MASS * square * by.load)
}

/// The load on its rope as the brake holds it: the rope carries the weight, and the drive is about to.
fn hanging(program: LoadProgram, by: &Departure) -> Result<Plant, PlantError> {
    let weight = WEIGHT * by.load;
    let rope = ROPE * TRAVEL * TRAVEL * by.stiffness / by.rope;
    chain(0.0, by)
        .load(weight)
        .program(program)
        .start(Start::Given {
            twists: vec![weight / (MOTOR_SHAFT * by.stiffness), weight / rope],
            speeds: vec![0.0; 3],
        })
        .build()
}

/// The brake opens 0.2 s after the start.
const RELEASE: [(f64, Action); 3] =
    [(0.0, Action::Brake(DRUM, 2_000.0)), (0.2, Action::Release), (0.2, Action::Brake(DRUM, 0.0))];

/// The hoist and its runs.
///
/// Half a load more is picked up within a second, as slings let it be; that it came at once is shown beside, and not
/// counted: the load would gain 10 % of rated speed before a motor on a 3 Hz rope had moved by one count of its
/// encoder, whatever the observer.
///
/// # Errors
/// A figure of the plant that is out of range, which only a changed scene can bring.
pub fn machine() -> Result<Machine, PlantError> {
    let by = &Departure::NONE;
    let hoisting = (0.2, Action::Setpoint(Hoist::<10_000>::RATING.speed));
    let pretensioned = Scenario {
        name: "pretensioned start, half a load more, lowering",
        plant: hanging(LoadProgram::table(&[(4.0, 0.0), (5.0, 0.5 * WEIGHT)]), by)?.into(),
        held: WEIGHT,
        actions: [&RELEASE[..], &[hoisting, (6.0, Action::Setpoint(-Hoist::<10_000>::RATING.speed))]].concat(),
        duration: 12.0,
        counted: true,
        marks: vec![(0.2, "brake opens"), (4.0, "half a load more"), (6.0, "reversal")],
        law: None,
    };
    let slack = Scenario {
        name: "slack-rope start",
        // On the ground: what holds the load until the rope carries its weight, and is its weight once it is lifted.
        plant: chain(0.0, by).coulomb(WEIGHT).start(Start::Rest).build()?.into(),
        held: 0.0,
        actions: vec![
            (0.0, Action::Setpoint(CREEP)),
            (0.1, Action::Release),
            (4.0, Action::Setpoint(Hoist::<10_000>::RATING.speed)),
        ],
        duration: 8.0,
        counted: true,
        marks: vec![(0.1, "creep"), (4.0, "hoist")],
        law: None,
    };
    let sudden = Scenario {
        name: "half a load more at once",
        plant: hanging(LoadProgram::steps(&[(4.0, 0.5 * WEIGHT)]), by)?.into(),
        held: WEIGHT,
        actions: [&RELEASE[..], &[hoisting]].concat(),
        duration: 6.0,
        counted: false,
        marks: vec![(0.2, "brake opens"), (4.0, "half a load more")],
        law: None,
    };
    Ok(with(vec![pretensioned, slack, sudden]))
}

/// The hoist as it is: one lift with the weight on the hook known, up at rated speed and down at half of it.
///
/// # Errors
/// A figure of the plant that is out of range.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let up = Hoist::<10_000>::RATING.speed;
    let lift = Scenario {
        name: "a lift",
        plant: hanging(LoadProgram::steps(&[]), by)?.into(),
        held: WEIGHT * by.load,
        actions: [&RELEASE[..], &[(0.2, Action::Setpoint(up)), (3.0, Action::Setpoint(-0.5 * up))]].concat(),
        duration: 8.0,
        counted: true,
        marks: vec![(0.2, "brake opens"), (3.0, "reversal")],
        law: None,
    };
    Ok(with(vec![lift]))
}

/// The machine with these runs.
fn with(scenarios: Vec<Scenario>) -> Machine {
    let torque_noise = 0.01 * Hoist::<10_000>::RATING.torque;
    Machine {
        name: driveline_firmware::scenes::hoist::SCENE,
        summary: "A 12 t crane hoist, observed and governed from the motor's angle and torque alone: the firmware \
                  of every variant runs in QEMU, tick by tick against a full solver of the whole machine.",
        facts: facts::of_hoist(torque_noise),
        notes: vec![
            "The shaft torque is the rope's pull at the motor, behind the gear's loss.",
            "The textbook cut, the modal truncation and the match of resonance and antiresonance give equal estimates \
                of this hoist within the noise: its motor shaft is stiff and its rope soft. With shafts of similar \
                stiffness they differ; `cargo driveline modes` shows by how much.",
        ],
        chosen: ("reduced", 10_000),
        scenarios,
        encoder: Encoder::new(8192),
        torque_noise,
        load: LOAD,
        shaft_torque: |plant| plant.torque_behind_gear(ROPE_SHAFT),
        load_torque: |plant| plant.load_torque(LOAD),
        told_brake: None,
        told_friction: 0.0,
        rated_speed: Hoist::<10_000>::RATING.speed,
        bases: Hoist::<10_000>::BASES,
    }
}
