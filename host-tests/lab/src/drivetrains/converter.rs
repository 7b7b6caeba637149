//! The converter's full plant and its run.
//!
//! Three inertias at the motors: the four motors as one, their trains with the bull gear, the vessel. Referred to the
//! motors by own arithmetic from the same figures as the scene [Huang 1987 ch. 1].

use driveline::configure::Machine as _;
use driveline_firmware::scenes::converter::Converter;

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, PlantError, Shaft, Start};

const RATIO: f64 = 690.0;
const LOAD: usize = 2;
const TRUNNION: usize = 1;

/// Friction of trunnion bearings and gears (N m): a tenth of rated torque.
const FRICTION: f64 = 700.0;
/// Torque of the bath on either side of its dead centre (N m): a third of rated torque.
const BATH: f64 = 2_400.0;

fn trunnion_torque(plant: &Body) -> f64 {
    plant.shaft_torque(TRUNNION)
}

/// The converter and its run: tilting out of the slack, over the dead centre, back, and a stop.
pub fn machine() -> Result<Machine, PlantError> {
    departing(&Departure::NONE)
}

/// The converter as it is.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let square = RATIO * RATIO;
    let trunnion = Shaft::elastic(3.6e9 / square * by.stiffness).damping(1.0e7 / square * by.damping).gap(0.3 * by.gap);
    let plant = Chain::motor(36.0 * by.motor_inertia)
        .shaft(Shaft::elastic(2.0e5 * by.stiffness).damping(15.0 * by.damping), 4.0)
        .shaft(trunnion, 1.2e7 / square * by.load_inertia)
        .coulomb(FRICTION)
        .program(LoadProgram::table(&[(1.0, 0.0), (2.0, BATH), (3.0, BATH), (5.0, -BATH), (6.5, -BATH), (8.5, 0.0)]))
        .start(Start::Slack)
        .build()?;
    let tilting = Scenario {
        actions: vec![
            (0.1, Action::Release),
            (0.1, Action::Setpoint(Converter::RATING.speed.0)),
            (5.5, Action::Setpoint(-Converter::RATING.speed.0)),
            (9.0, Action::Setpoint(0.0)),
        ],
        duration: 11.0,
        marks: vec![(0.1, "tilting"), (4.0, "dead centre"), (5.5, "back"), (9.0, "stop")],
        ..Scenario::of("tilting through the backlash, over the dead centre and back", plant)
    };
    Ok(Machine {
        summary: "A converter's tilting drive, four motors as one, with backlash in its gear.",
        facts: Vec::new(),
        notes: vec!["The shaft torque is that of the trunnion, at the motors."],
        chosen: ("slack", 10_000),
        scenarios: vec![tilting],
        load: LOAD,
        shaft_torque: trunnion_torque,
        load_torque: |plant| plant.load_torque(LOAD),
        ..facts::scene::<Converter>(driveline_firmware::scenes::converter::SCENE, 8192)
    })
}
