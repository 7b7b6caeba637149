//! The planetary drive's full plant, the set's inertia taken apart by Willis's equation.

use core::f64::consts::PI;

use driveline::configure::Machine as _;
use driveline_firmware::scenes::planetary::{self as scene, PlanetaryDrive};

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, PlantError, Shaft};

/// Friction of the belt at the motor (N m), half of rated torque.
const BELT: f64 = 177.0;

/// Carrier's speed over the sun's [Wang 1989 example 1-4].
const CARRIER: f64 = 20.0 / (20.0 + 90.0);

/// Stiffness and damping of the drum's shaft at the motor.
const STIFFNESS: f64 = 79.3e9 * PI * 0.090 * 0.090 * 0.090 * 0.090 / (32.0 * 1.2) * CARRIER * CARRIER;
const DAMPING: f64 = 120.0 * CARRIER * CARRIER;

/// The torque behind the set's loss (N m).
fn shaft(plant: &Body) -> f64 {
    plant.torque_behind_gear(0)
}

/// The drive and its run.
pub fn machine() -> Result<Machine, PlantError> {
    departing(&Departure::NONE)
}

/// The drive as it is.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let (sun, planet, ring, module) = (20.0, 35.0, 90.0, 0.004);
    // A planet rolls in the held ring.
    let spin = CARRIER * (1.0 - ring / planet);
    let radius = 0.5 * module * (sun + planet);
    let square = CARRIER * CARRIER;
    let set = 0.013_052 + 3.0 * (0.002_706 * spin * spin + 3.7131 * (radius * CARRIER).powi(2)) + 0.0671 * square;
    let plant = Chain::motor((0.5 + set) * by.motor_inertia)
        .efficiency(0.97 + by.efficiency)
        .shaft(Shaft::elastic(STIFFNESS * by.stiffness).damping(DAMPING), 55.0 * square * by.load_inertia)
        .coulomb(BELT)
        .program(LoadProgram::table(&[(6.0, 0.0), (7.0, 0.5 * BELT)]))
        .build()?;
    Ok(Machine {
        summary: "A conveyor's drum behind a planetary set: a start under load, more load, a stop.",
        facts: facts::of_design::<PlanetaryDrive>(scene::COUNTS),
        notes: vec![
            "The shaft torque is that behind the set's loss, at the motor.",
            "By the swings that a rigid observer would miss it would do here; it has to be tuned so lively, lest the \
                speed loop excite the shaft, that its \
             noise costs more.",
        ],
        chosen: ("exact", PlanetaryDrive::RATE_HZ),
        scenarios: vec![Scenario {
            actions: vec![
                (0.1, Action::Release),
                (0.1, Action::Setpoint(PlanetaryDrive::RATING.speed.0)),
                (9.0, Action::Setpoint(0.3 * PlanetaryDrive::RATING.speed.0)),
            ],
            duration: 13.0,
            marks: vec![(0.1, "start"), (6.0, "half as much load more"), (9.0, "slower")],
            ..Scenario::of("start under load, more load, slower", plant)
        }],
        load: 1,
        shaft_torque: shaft,
        load_torque: |plant| plant.load_torque(1),
        ..facts::scene::<PlanetaryDrive>(scene::SCENE, scene::COUNTS)
    })
}
