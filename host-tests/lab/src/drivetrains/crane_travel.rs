//! The crane's full plant: motors and bridge as one mass, the load on a spring of `m g/l`, travelling resistance and
//! wind.

use driveline::configure::Machine as _;
use driveline_firmware::scene::no_load::panel;
use driveline_firmware::scenes::crane_travel::{self as scene, CraneTravel};

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, PlantError, Shaft};

/// Gravity (m/s2), the standard value of ISO 80000-3.
const GRAVITY: f64 = 9.80665;

/// Travel per angle of the motors (m/rad).
const TRAVEL: f64 = 0.5 / (2.0 * 30.0);

const LOAD: f64 = 15_000.0;
const BRIDGE: f64 = 25_000.0;

/// Stiffness of the load's swing, at the motors (N m/rad).
const PENDULUM: f64 = LOAD * GRAVITY / 10.0 * TRAVEL * TRAVEL;

/// Travelling resistance at the motors (N m), 6 per mille of the weight.
const RESISTANCE: f64 = 0.006 * (LOAD + BRIDGE) * GRAVITY * TRAVEL;

/// Its known part: commissioning identified it to within a tenth.
const TOLD: f64 = 0.9 * RESISTANCE;

/// Wind on the load at the motors (N m): 300 N.
const WIND: f64 = 300.0 * TRAVEL;

/// Unknown part of the travelling resistance (N m).
fn unknown(plant: &Body) -> f64 {
    match plant.motor_speed() {
        // At rest its reported torque is the motor's.
        0.0 => plant.load_torque(0) - plant.load_torque(0).clamp(-TOLD, TOLD),
        speed => plant.load_torque(0) - TOLD * speed.signum(),
    }
}

/// Torque from the inertias of motors and bridge to the outside: the force of the load's swing, and the unknown
/// resistance.
fn push(plant: &Body) -> f64 {
    plant.shaft_torque(0) + unknown(plant)
}

fn resistance(plant: &Body) -> f64 {
    unknown(plant) + plant.load_torque(1)
}

/// The crane and its run.
pub fn machine() -> Result<Machine, PlantError> {
    departing(&Departure::NONE)
}

/// A run for the learners with an empty hook: a step of the speed on 67 m there and back, then a short way there. The
/// travelling resistance is that of the lighter crane.
pub fn empty_hook(by: &Departure) -> Result<Scenario, PlantError> {
    let speeds = [(SLOW, 33.0), (FAST, 33.0), (SLOW, 35.0), (-SLOW, 37.0), (-FAST, 33.0), (-SLOW, 35.0), (SLOW, 37.0)];
    learning("empty hook", panel::NO_LOAD, scene::HOOK, &speeds, by)
}

/// The same with a test weight, there and back.
pub fn test_weight(by: &Departure) -> Result<Scenario, PlantError> {
    let speeds = [(SLOW, 33.0), (FAST, 33.0), (SLOW, 35.0), (-SLOW, 37.0), (-FAST, 33.0), (-SLOW, 35.0)];
    learning("test weight", panel::TEST_WEIGHT, scene::HOOK + scene::WEIGHT, &speeds, by)
}

/// Speeds of the runs for the learners (rad/s).
const SLOW: f64 = 0.35 * CraneTravel::RATING.speed.0;
const FAST: f64 = 0.9 * CraneTravel::RATING.speed.0;

/// A run for the learners with a mass on the rope (kg) that a key of the panel names, at speeds (rad/s) for a time (s).
fn learning(
    name: &'static str,
    key: u32,
    mass: f64,
    speeds: &[(f64, f64)],
    by: &Departure,
) -> Result<Scenario, PlantError> {
    let square = TRAVEL * TRAVEL;
    let plant = Chain::motor((0.2 + BRIDGE * square) * by.motor_inertia)
        .coulomb(RESISTANCE * (mass + BRIDGE) / (LOAD + BRIDGE))
        .shaft(Shaft::elastic(PENDULUM * mass / LOAD / by.rope), mass * square)
        .build()?;
    let mut actions = vec![(0.1, Action::Release), (0.1, Action::Panel(key, 1.0))];
    let mut time = 0.2;
    for (speed, lasts) in speeds {
        actions.push((time, Action::Setpoint(*speed)));
        time += lasts;
    }
    actions.extend([(time, Action::Panel(key, 0.0)), (time, Action::Setpoint(0.0))]);
    Ok(Scenario { actions, duration: time + 15.0, ..Scenario::of(name, plant) })
}

/// The crane as it is.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let square = TRAVEL * TRAVEL;
    let plant = Chain::motor((0.2 + BRIDGE * square) * by.motor_inertia)
        .coulomb(RESISTANCE)
        .shaft(Shaft::elastic(PENDULUM * by.load / by.rope), LOAD * square * by.load)
        .program(LoadProgram::table(&[(16.0, 0.0), (18.0, WIND), (24.0, WIND), (26.0, 0.0)]))
        .build()?;
    Ok(Machine {
        summary: "A bridge crane of 16 t travels with its load swinging.",
        facts: facts::of_design::<CraneTravel>(scene::COUNTS),
        notes: vec![
            "The drive has nine tenths of the travelling resistance, as identified in commissioning. The unknown tenth \
                adds to the shaft torque, otherwise the force of the swinging load, and to the load torque, otherwise \
                the wind: from the motor's side, resistance before and behind the swing cannot be distinguished.",
            "The load is a mass on a spring of m g/l, as for small angles.",
        ],
        chosen: ("semi-implicit", CraneTravel::RATE_HZ),
        scenarios: vec![Scenario {
            actions: vec![
                (0.1, Action::Release),
                (0.1, Action::Setpoint(CraneTravel::RATING.speed.0)),
                (28.0, Action::Setpoint(0.4 * CraneTravel::RATING.speed.0)),
            ],
            duration: 40.0,
            marks: vec![(0.1, "travel"), (16.0, "gust"), (28.0, "slower")],
            ..Scenario::of("travel, a gust, slower", plant)
        }],
        load: 1,
        shaft_torque: push,
        load_torque: resistance,
        told_friction: TOLD,
        ..facts::scene::<CraneTravel>(scene::SCENE, scene::COUNTS)
    })
}
