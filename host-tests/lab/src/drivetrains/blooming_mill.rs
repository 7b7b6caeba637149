//! The blooming mill's full plant and its runs.
//!
//! Three inertias: motor, pinion stand, rolls; the gap in the spindles. Set up here once more from the same figures as
//! the scene, since direct drive refers nothing.

use driveline::configure::Machine as _;
use driveline_firmware::scene::no_load::panel;
use driveline_firmware::scenes::blooming_mill::BloomingMill;

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, Plant, PlantError, Shaft, Start};

/// The rolls and the spindles.
const LOAD: usize = 2;
const SPINDLES: usize = 1;

/// Friction of the roll bearings and the pinion stand (N m): 5 % of rated torque.
const FRICTION: f64 = 0.05 * BloomingMill::RATING.torque.0;

/// Rolling torque of a middle pass (N m).
pub const ROLLING: f64 = 0.55 * BloomingMill::RATING.torque.0;

fn spindle_torque(plant: &Body) -> f64 {
    plant.shaft_torque(SPINDLES)
}

/// The chain with a rolling torque over time.
fn chain(program: LoadProgram, by: &Departure) -> Result<Plant, PlantError> {
    Chain::motor(1.1e5 * by.motor_inertia)
        .shaft(Shaft::elastic(1.2e9 * by.stiffness).damping(3.0e5 * by.damping), 1.0e4)
        .shaft(
            Shaft::elastic(2.2e8 * by.stiffness).damping(1.0e5 * by.damping).gap(0.010 * by.gap),
            2.2e4 * by.load_inertia,
        )
        .coulomb(FRICTION)
        .program(program)
        .start(Start::Rest)
        .build()
}

/// The mill and its run: two passes with reversals as fast as the motor can.
///
/// An ingot fills the bite within 60 ms (0.1 m of contact at 1.6 m/s) and leaves it within 60 ms.
pub fn machine() -> Result<Machine, PlantError> {
    departing(&Departure::NONE)
}

/// A run for the learners with the spindles uncoupled: motor and pinion stand, with half of the friction, three steps
/// of the speed in either direction. Spindle heads of a thousandth of the rolls' inertia stay.
pub fn uncoupled(by: &Departure) -> Result<Scenario, PlantError> {
    let [slow, fast] = [0.3, 0.9].map(|share| share * BloomingMill::RATING.speed.0);
    let there = [slow, fast, slow];
    let back = there.map(|speed| -speed);
    let speeds = [&there[..], &back, &there, &back, &[slow]].concat();
    let plant = Chain::motor(1.1e5 * by.motor_inertia)
        .shaft(Shaft::elastic(1.2e9 * by.stiffness).damping(3.0e5 * by.damping), 1.0e4)
        .coulomb(0.5 * FRICTION)
        .shaft(Shaft::elastic(2.2e5).damping(1.0e2), 22.0)
        .start(Start::Rest)
        .build()?;
    let mut actions = vec![(0.1, Action::Release), (0.1, Action::Panel(panel::NO_LOAD, 1.0))];
    actions.extend((0..).zip(&speeds).map(|(k, speed)| (0.2 + 2.5 * f64::from(k), Action::Setpoint(*speed))));
    let end = 0.2 + 2.5 * speeds.len() as f64;
    actions.extend([(end, Action::Panel(panel::NO_LOAD, 0.0)), (end, Action::Setpoint(0.0))]);
    Ok(Scenario { actions, duration: end + 1.0, ..Scenario::of("spindles uncoupled", plant) })
}

/// The mill as it is.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let slow = 0.5 * BloomingMill::RATING.speed.0;
    let passes = Scenario {
        name: "two passes with a reversal between",
        plant: chain(
            LoadProgram::table(&[
                (1.2, 0.0),
                (1.26, ROLLING),
                (2.2, ROLLING),
                (2.26, 0.0),
                (3.6, 0.0),
                (3.66, -ROLLING),
                (4.6, -ROLLING),
                (4.66, 0.0),
            ]),
            by,
        )?
        .into(),
        held: 0.0,
        actions: vec![
            (0.1, Action::Release),
            (0.1, Action::Setpoint(slow)),
            (2.5, Action::Setpoint(-slow)),
            (4.9, Action::Setpoint(slow)),
        ],
        duration: 6.0,
        counted: true,
        marks: vec![(1.2, "bite"), (2.2, "out"), (2.5, "reversal"), (3.6, "bite"), (4.6, "out"), (4.9, "reversal")],
        law: None,
    };
    Ok(Machine {
        summary: "A reversing blooming mill with a gap in its spindles: two passes, and reversals as fast as the motor \
            can.",
        facts: Vec::new(),
        notes: vec!["The shaft torque is that of the spindles."],
        chosen: ("slack", 10_000),
        scenarios: vec![passes],
        load: LOAD,
        shaft_torque: spindle_torque,
        load_torque: |plant| plant.load_torque(LOAD),
        ..facts::scene::<BloomingMill>(driveline_firmware::scenes::blooming_mill::SCENE, 32_768)
    })
}
