//! The fan's full plant: motor, coupling, impeller, and a torque that grows with the square of the speed.

use driveline::configure::Machine as _;
use driveline_firmware::scenes::fan::{self, Fan};

use super::facts::{self, fact};
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Law, Machine, Scenario};
use driveline_solver::plant::{Chain, PlantError, Shaft};

/// Torque of the air at rated speed (N m): nine tenths of rated torque.
const AIR: f64 = 261.0;

fn coupling(plant: &Body) -> f64 {
    plant.shaft_torque(0)
}

fn air(fan: &Body) -> f64 {
    let speed = fan.speed(1);
    AIR * speed * speed.abs() / (Fan::RATING.speed.0 * Fan::RATING.speed.0)
}

/// The fan and its run.
pub fn machine() -> Result<Machine, PlantError> {
    let plant = Chain::motor(0.35).shaft(Shaft::elastic(1.2e5).damping(8.0), 4.5).coulomb(4.0).build()?;
    let torque_noise = 0.01 * Fan::RATING.torque.0;
    let two = Fan::TWO_MASS;
    Ok(Machine {
        summary: "A fan of 45 kW: the smallest drive, one mass and a speed loop.",
        facts: vec![
            fact("inertia", format!("{:.2} kg m²", Fan::CHAIN.rigid().inertia)),
            fact("resonance left out", format!("{:.0} Hz", two.resonance() / core::f64::consts::TAU)),
            fact("torque noise", format!("{torque_noise:.1} N m rms in every tick, white")),
            fact("encoder", format!("{} counts a turn", fan::COUNTS)),
        ],
        notes: vec!["The shaft torque is the coupling's."],
        chosen: ("rigid", Fan::RATE_HZ),
        scenarios: vec![Scenario {
            name: "run-up, slower, faster",
            plant: plant.into(),
            held: 0.0,
            actions: vec![
                (0.1, Action::Release),
                (0.1, Action::Setpoint(Fan::RATING.speed.0)),
                (14.0, Action::Setpoint(0.6 * Fan::RATING.speed.0)),
                (22.0, Action::Setpoint(0.9 * Fan::RATING.speed.0)),
            ],
            duration: 30.0,
            counted: true,
            marks: vec![(0.1, "run-up"), (14.0, "slower"), (22.0, "faster")],
            law: Some(Law { node: 1, torque: air }),
        }],
        load: 1,
        shaft_torque: coupling,
        load_torque: |plant| plant.load_torque(1),
        ..facts::scene::<Fan>(fan::SCENE, fan::COUNTS)
    })
}
