//! The vibrating screen's full plant: motor, cardan shaft, exciter; box and frame on springs; unbalances that couple
//! them.

use core::f64::consts::PI;

use driveline::configure::Machine as _;
use driveline_firmware::scenes::vibrating_screen::{self as scene, VibratingScreen};

use super::facts;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::train::{Coordinate, Link, Source, Train, Unbalance};
use driveline_solver::plant::{LoadProgram, PlantError};

/// The exciter among the coordinates; before it the motor, behind it box and frame.
const EXCITER: usize = 1;

pub const BOX: usize = 2;

/// The cardan shaft among the links.
const SHAFT: usize = 0;

/// The springs between box and frame; their elongation is what the one moves against the other.
pub const SPRINGS: usize = 1;

/// Gravity along the throw, at 45 degrees (m/s2); the standard value of ISO 80000-3.
const GRAVITY: f64 = 9.80665 * core::f64::consts::FRAC_1_SQRT_2;

/// Stiffness of the cardan shaft, 60 mm by 1 m of steel (N m/rad).
const STIFFNESS: f64 = 79.3e9 * PI * 0.060 * 0.060 * 0.060 * 0.060 / 32.0;

/// Damping in proportion to the stiffness: 3 % of critical at the upper resonance.
const SPRING_DAMPING: f64 = 1.6e-3;

/// Friction of the charge on the deck (N s/m), and of bearings and oil at the exciter (N m s/rad).
const CHARGE: f64 = 4.0e3;
const BEARINGS: f64 = 1.2;

/// More charge: torque at the exciter (N m).
const MORE: f64 = 100.0;

/// The screen at rest, its unbalances hanging.
#[must_use]
pub fn train() -> Train {
    let charge = LoadProgram::table(&[(7.0, 0.0), (7.5, -MORE), (8.5, -MORE), (9.0, 0.0)]);
    Train::new()
        .coordinate(Coordinate::new(1.2))
        .coordinate(Coordinate::new(8.5).angle(PI).viscous(BEARINGS).source(Source::Program(charge)))
        .coordinate(Coordinate::new(8000.0).viscous(CHARGE))
        .coordinate(Coordinate::new(5000.0))
        .link(Link::shaft(0, EXCITER, STIFFNESS).damping(13.0))
        .link(Link::shaft(BOX, BOX + 1, 2.4e6).damping(2.4e6 * SPRING_DAMPING))
        .link(Link::ground(BOX + 1, 4.0e6).damping(4.0e6 * SPRING_DAMPING))
        .unbalance(Unbalance { turning: EXCITER, way: BOX, moment: 40.0, gravity: GRAVITY })
}

/// The screen and its run.
pub fn machine() -> Result<Machine, PlantError> {
    Ok(Machine {
        summary: "A dual-mass vibrating screen of 30 kW: up through its resonances, more charge, and down again.",
        facts: facts::of_design::<VibratingScreen>(scene::COUNTS),
        notes: vec![
            "The shaft torque is the cardan shaft's. The load torque is the torque of gravity and box on the \
                unbalances, plus friction.",
            "The two masses in the name are box and frame, which move along a line; those that turn are motor and \
                exciter.",
        ],
        chosen: ("exact", VibratingScreen::RATE_HZ),
        scenarios: vec![Scenario {
            actions: vec![
                (0.1, Action::Release),
                (0.1, Action::Setpoint(VibratingScreen::RATING.speed.0)),
                (10.0, Action::Setpoint(0.05 * VibratingScreen::RATING.speed.0)),
            ],
            duration: 15.0,
            marks: vec![(0.1, "run-up"), (7.0, "more charge"), (10.0, "down")],
            ..Scenario::of("up through resonance, more charge, down", Body::train(train().build()?, &[]))
        }],
        load: EXCITER,
        shaft_torque: |plant| plant.shaft_torque(SHAFT),
        load_torque: |plant| plant.load_torque(EXCITER),
        ..facts::scene::<VibratingScreen>(scene::SCENE, scene::COUNTS)
    })
}
