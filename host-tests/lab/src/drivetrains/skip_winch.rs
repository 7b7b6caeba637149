//! The skip winch's full plant: motor and disc, drum, skip on a rope that can go slack, and the brake that closes while
//! it turns.

use driveline::configure::Machine as _;
use driveline_firmware::scenes::skip_winch::{self as scene, SkipWinch};

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, PlantError, Shaft, Start};

/// Gravity (m/s2), the standard value of ISO 80000-3.
const GRAVITY: f64 = 9.80665;

/// Travel per angle of the motor (m/rad).
const TRAVEL: f64 = 2.0 / (2.0 * 15.0);

const SKIP: f64 = 5_000.0;
const WEIGHT: f64 = SKIP * GRAVITY * TRAVEL;
const MOTOR_SHAFT: f64 = 6.0e5;
const ROPE: f64 = 3.9e5 * TRAVEL * TRAVEL;
const ROPE_DAMPING: f64 = 1.3e3 * TRAVEL * TRAVEL;

/// When the emergency brake is called for, and how long it takes to close (s).
const EMERGENCY: f64 = 9.0;
const CLOSING: f64 = 0.3;

/// When the brake opens, when a stop is called for while hoisting, and how much later than that the brake is called for
/// once the drive has stopped the winch (s).
const RELEASE: f64 = 0.2;
const STOPPING: f64 = 6.0;
const STOPPED: f64 = 1.8;

/// The rope's pull at the motor (N m), without the gear's loss.
fn rope(plant: &Body) -> f64 {
    plant.torque_behind_gear(1).max(0.0)
}

/// An emergency while hoisting: the setpoint goes to zero at once, and the brake is called for `later` (s).
fn emergency_stop(name: &'static str, plant: Body, weight: f64, later: f64) -> Scenario {
    let mut actions =
        vec![(0.0, Action::Brake(0, 2.0 * WEIGHT)), (RELEASE, Action::Release), (RELEASE, Action::Brake(0, 0.0))];
    // The setpoint comes up within four seconds.
    actions.extend(
        (1..=80).map(|j| {
            (RELEASE + 0.05 * f64::from(j), Action::Setpoint(SkipWinch::RATING.speed.0 * f64::from(j) / 80.0))
        }),
    );
    actions.push((STOPPING, Action::Setpoint(0.0)));
    actions.extend(closing(STOPPING + later));
    Scenario {
        name,
        plant,
        held: weight,
        actions,
        duration: STOPPING + 3.0,
        // The rope goes slack, which the observers of two masses and of one do not know.
        counted: false,
        marks: vec![(RELEASE, "brake opens"), (STOPPING, "emergency"), (STOPPING + later, "brake")],
        law: None,
    }
}

/// The brake's torque comes in twenty steps.
fn closing(at: f64) -> impl Iterator<Item = (f64, Action)> {
    (1..=20)
        .map(move |j| (at + CLOSING * f64::from(j) / 20.0, Action::Brake(0, scene::BRAKE_TORQUE * f64::from(j) / 20.0)))
}

/// The winch and its runs.
pub fn machine() -> Result<Machine, PlantError> {
    departing(&Departure::NONE)
}

/// The winch as it is.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let (mass, weight) = (SKIP * by.load * TRAVEL * TRAVEL, WEIGHT * by.load);
    let [motor_shaft, elastic] = [MOTOR_SHAFT, ROPE].map(|stiffness| stiffness * by.stiffness);
    let hanging = || {
        Chain::motor(20.0 * by.motor_inertia)
            .shaft(Shaft::elastic(motor_shaft).damping(60.0 * by.damping), 1500.0 / (15.0 * 15.0))
            .efficiency(0.94 + by.efficiency)
            .shaft(Shaft::rope(elastic).damping(ROPE_DAMPING * by.damping), mass)
            .load(weight)
            // As the brake holds it: the rope carries the weight.
            .start(Start::Given { twists: vec![weight / motor_shaft, weight / elastic], speeds: vec![0.0; 3] })
            .build()
    };
    let release = [(0.0, Action::Brake(0, 2.0 * WEIGHT)), (RELEASE, Action::Release), (RELEASE, Action::Brake(0, 0.0))];
    // The inverter goes off, and the brake closes.
    let lower = (RELEASE, Action::Setpoint(-0.9 * SkipWinch::RATING.speed.0));
    let emergency = release.into_iter().chain([lower, (EMERGENCY, Action::Trip)]).chain(closing(EMERGENCY)).collect();
    let hoist = vec![
        release[0],
        release[1],
        release[2],
        (RELEASE, Action::Setpoint(SkipWinch::RATING.speed.0)),
        (8.0, Action::Setpoint(0.3 * SkipWinch::RATING.speed.0)),
    ];
    Ok(Machine {
        summary: "A mine's skip hoist: hoisting, and emergencies: the brake alone while it lowers; drive and brake \
            while it hoists.",
        facts: facts::of_design::<SkipWinch>(scene::COUNTS),
        notes: vec![
            "The shaft torque is the rope's pull at the motor, behind the gear's loss.",
            "The brake's torque is reported to the drive exactly; excess brake torque would appear as shaft torque. \
                The run with the inverter off ends shortly before standstill.",
            "In an emergency while hoisting the rope goes slack. Compare the peaks of `slack` and `plain` there. The \
                errors do not count: the observers of two masses and of one model a rope that can push, and with a \
                closed brake the rope is unobservable.",
        ],
        chosen: ("semi-implicit", SkipWinch::RATE_HZ),
        scenarios: vec![
            Scenario {
                held: weight,
                actions: hoist,
                duration: 12.0,
                marks: vec![(RELEASE, "brake opens"), (8.0, "slower")],
                ..Scenario::of("hoisting", hanging()?)
            },
            Scenario {
                held: weight,
                actions: emergency,
                duration: EMERGENCY + STOP,
                marks: vec![(RELEASE, "brake opens"), (EMERGENCY, "emergency")],
                ..Scenario::of("emergency brake while lowering", hanging()?)
            },
            emergency_stop("emergency stop while hoisting", hanging()?.into(), weight, STOPPED),
            emergency_stop("emergency brake while hoisting", hanging()?.into(), weight, 0.0),
        ],
        load: 2,
        shaft_torque: rope,
        load_torque: |plant| plant.load_torque(2),
        told_brake: Some(0),
        ..facts::scene::<SkipWinch>(scene::SCENE, scene::COUNTS)
    })
}

/// From the call for the brake until shortly before the winch stands (s).
const STOP: f64 = 1.05;
