//! The belt conveyor's full plant: motor with gear and drum, the strand, belt and load with their resistance to motion.

use driveline::configure::Machine as _;
use driveline_firmware::scenes::belt_conveyor::{self as scene, BeltConveyor};

use super::facts;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, PlantError, Shaft};

/// Travel of the belt per angle of the motor (m/rad).
const TRAVEL: f64 = 0.8 / (2.0 * 20.0);

/// Resistance to motion of the loaded belt at the motor (N m): 2 % of the weight of 60 t.
const RESISTANCE: f64 = 0.02 * 60_000.0 * 9.80665 * TRAVEL;

/// Stiffness and damping of the strand at the motor.
const STIFFNESS: f64 = 6.0e5 * TRAVEL * TRAVEL;
const DAMPING: f64 = 4.0e3 * TRAVEL * TRAVEL;

/// The strand's pull at the motor (N m).
fn strand(plant: &Body) -> f64 {
    plant.shaft_torque(1)
}

/// The conveyor and its run.
pub fn machine() -> Result<Machine, PlantError> {
    let plant = Chain::motor(1.6)
        .shaft(Shaft::elastic(8.0e4).damping(20.0), 0.2)
        .shaft(Shaft::elastic(STIFFNESS).damping(DAMPING), 60_000.0 * TRAVEL * TRAVEL)
        .coulomb(RESISTANCE)
        .program(LoadProgram::table(&[(20.0, 0.0), (25.0, 0.3 * RESISTANCE)]))
        .build()?;
    let rating = BeltConveyor::RATING;
    Ok(Machine {
        summary: "A belt conveyor of 400 m: a soft start under load, more load, a stop.",
        facts: facts::of_design::<BeltConveyor>(scene::COUNTS),
        notes: vec!["The shaft torque is the carrying strand's pull, at the motor."],
        chosen: ("semi-implicit", BeltConveyor::RATE_HZ),
        scenarios: vec![Scenario {
            actions: vec![
                (0.5, Action::Release),
                (0.5, Action::Setpoint(rating.speed.0)),
                (32.0, Action::Setpoint(0.0)),
            ],
            duration: 48.0,
            marks: vec![(0.5, "soft start"), (20.0, "a third more load"), (32.0, "stop")],
            ..Scenario::of("soft start, more load, stop", plant)
        }],
        load: 2,
        shaft_torque: strand,
        load_torque: |plant| plant.load_torque(2),
        ..facts::scene::<BeltConveyor>(scene::SCENE, scene::COUNTS)
    })
}
