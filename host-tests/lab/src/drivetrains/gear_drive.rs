//! The gear drive's full plant: the torsion-lateral gear pair of fourteen coordinates `[Tang 1994 (1.6)]` between motor
//! and driven machine, with a mesh stiffness and a tooth error that follow the pinion's angle.

use core::f64::consts::PI;

use driveline::configure::Machine as _;
use driveline_firmware::scenes::gear_drive::{self as scene, GearDrive};

use super::facts;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::train::{GearBody, GearPair, Motion, Source, Teeth, Train, Variation};
use driveline_solver::plant::{LoadProgram, PlantError};

/// The driven machine and the pinion among the coordinates.
const LOAD: usize = GearPair::COORDINATES - 1;
const PINION: usize = 6;

/// Motor turns per turn of the driven machine.
const RATIO: f64 = 50.0 / 21.0;

/// Rated torque at the driven machine (N m).
const RATED: f64 = GearDrive::RATING.torque.0 * RATIO;

/// Load of the driven machine at rated speed, of rated torque, growing with the square of the speed.
const ROTARY: f64 = 0.4;

/// Error of every second tooth (m): the pitch deviation of grade 5 of ISO 1328-1, `0.3 (m + 0.4 sqrt(d)) + 4` in um, m
/// and d in mm.
pub const TOOTH_ERROR: f64 = 6.3e-6;

/// Load that comes and goes [s, N m].
fn load(program: &mut Vec<(f64, f64)>, from: f64, to: f64, torque: f64) {
    program.extend([(from, 0.0), (from + 0.02, -torque), (to, -torque), (to + 0.02, 0.0)]);
}

/// The pair between its shafts, with a program of torques on the driven machine.
fn pair(error: f64) -> GearPair {
    // A wheel of steel of 40 mm width: mass and inertia about a diameter from its pitch radius.
    let body = |teeth: f64, inertia: f64, support: f64| {
        let pitch_radius = 0.002 * teeth;
        let mass = 7850.0 * PI * pitch_radius * pitch_radius * 0.040;
        let stiffness = [support, support, 0.4 * support, 2e-3 * support, 2e-3 * support];
        GearBody {
            mass,
            inertia,
            tilt_inertia: mass * (0.25 * pitch_radius * pitch_radius + 0.040 * 0.040 / 12.0),
            base_radius: pitch_radius * 20.0_f64.to_radians().cos(),
            pitch_radius,
            stiffness,
            damping: stiffness.map(|k| 4e-6 * k),
        }
    };
    GearPair {
        motor: 0.4,
        input: (5.0e4, 4.0),
        pinion: body(21.0, 0.0021, 3.0e8),
        wheel: body(50.0, 0.065, 4.0e8),
        output: (79.3e9 * PI * 0.065 * 0.065 * 0.065 * 0.065 / (32.0 * 0.8), 25.0),
        load: 12.0,
        pressure_angle: 20.0_f64.to_radians(),
        base_helix: 0.0,
        mesh_stiffness: 5.68e8,
        mesh_damping: 3.56e3,
        variation: Some(Variation::Teeth(Teeth {
            coordinate: PINION,
            count: 21.0,
            contact_ratio: 1.6,
            double: 6.8e8,
            single: 4.0e8,
            leaving: 3.4e8,
            errors: [error, 0.0],
        })),
        gap: 8.0e-5,
        torque: 0.0,
    }
}

/// The drive at rest, with this error on every second tooth (m).
#[must_use]
pub fn train(error: f64) -> Train {
    let mut program = Vec::new();
    load(&mut program, 2.0, 2.5, 0.5 * RATED);
    let speed = GearDrive::RATING.speed.0 / RATIO;
    pair(error)
        .train()
        .source(LOAD, Source::Program(LoadProgram::table(&program)))
        .source(LOAD, Source::Parabola(0.0, 0.0, -ROTARY * RATED / (speed * speed)))
}

/// A motion of the train as the closed loop drives it.
#[must_use]
pub fn body(motion: Motion) -> Body {
    Body::train(motion, &[(LOAD, RATIO)])
}

/// The drive and its run.
pub fn machine() -> Result<Machine, PlantError> {
    Ok(Machine {
        summary: "A single-stage gear drive of 37 kW whose teeth excite it: run-up, a load that comes and goes.",
        facts: facts::of_design::<GearDrive>(scene::COUNTS),
        notes: vec![
            "The shaft torque is that between wheel and driven machine, at the motor.",
            "The full plant turns, moves and tilts in fourteen coordinates, with the pairs of teeth in contact and an \
                error of 6.3 um on every second tooth.",
        ],
        chosen: ("exact", GearDrive::RATE_HZ),
        scenarios: vec![Scenario {
            actions: vec![(0.05, Action::Release), (0.05, Action::Setpoint(GearDrive::RATING.speed.0))],
            duration: 3.0,
            marks: vec![(0.05, "run-up"), (2.0, "load"), (2.5, "off")],
            ..Scenario::of("run-up, a load that comes and goes", body(train(TOOTH_ERROR).build()?))
        }],
        load: LOAD,
        shaft_torque: |plant| plant.shaft_torque(GearPair::OUTPUT) / RATIO,
        load_torque: |plant| plant.load_torque(LOAD),
        ..facts::scene::<GearDrive>(scene::SCENE, scene::COUNTS)
    })
}
