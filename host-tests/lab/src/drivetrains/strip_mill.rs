//! The strip mill's full plant: four masses on three shafts, and strips that bite and leave.

use driveline::configure::Machine as _;
use driveline_firmware::scenes::strip_mill::{self, StripMill};

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, PlantError, Shaft};

/// Rolling torque (N m).
const ROLLING: f64 = 1.2e5;

/// Time in which the strip fills the gap between the rolls (s): 50 mm of contact and a wedge of a head of 50 mm, at 2
/// m/s.
const BITE: f64 = 0.05;

/// The rolls' node and the spindles' shaft.
const ROLLS: usize = 3;
const SPINDLES: usize = 2;

fn spindles(plant: &Body) -> f64 {
    plant.shaft_torque(SPINDLES)
}

/// The stand and its runs.
pub fn machine() -> Result<Machine, PlantError> {
    departing(&Departure::NONE)
}

/// The stand as it is.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let stand = |program: LoadProgram| {
        Chain::motor(3000.0 * by.motor_inertia)
            .shaft(Shaft::elastic(6.0e7 * by.stiffness).damping(1.0e4 * by.damping), 300.0)
            .shaft(Shaft::elastic(5.0e7 * by.stiffness).damping(1.0e4 * by.damping), 400.0)
            .shaft(Shaft::elastic(6.0e6 * by.stiffness).damping(4.0e3 * by.damping), 2500.0 * by.load_inertia)
            .coulomb(4.0e3)
            .program(program)
            .build()
    };
    Ok(Machine {
        summary: "A strip mill's stand of 2.4 MW: strips bite and leave.",
        facts: facts::of_design::<StripMill>(strip_mill::COUNTS),
        notes: vec!["The shaft torque is the spindles', between pinion stand and rolls."],
        chosen: ("semi-implicit", StripMill::RATE_HZ),
        scenarios: vec![Scenario {
            name: "two strips",
            plant: stand(LoadProgram::table(&[
                (4.0, 0.0),
                (4.0 + BITE, ROLLING),
                (6.0, ROLLING),
                (6.0 + BITE, 0.0),
                (7.0, 0.0),
                (7.0 + BITE, 0.7 * ROLLING),
            ]))?
            .into(),
            held: 0.0,
            actions: vec![(0.1, Action::Release), (0.1, Action::Setpoint(StripMill::RATING.speed.0))],
            duration: 9.0,
            counted: true,
            marks: vec![(0.1, "run-up"), (4.0, "bite"), (6.0, "out"), (7.0, "thinner strip")],
            law: None,
        }],
        load: ROLLS,
        shaft_torque: spindles,
        load_torque: |plant| plant.load_torque(ROLLS),
        ..facts::scene::<StripMill>(strip_mill::SCENE, strip_mill::COUNTS)
    })
}
