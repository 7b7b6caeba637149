//! The spindle's full plant: rotor and tool on a shaft of given diameters, and cuts that come and go.

use core::f64::consts::PI;

use driveline::configure::Machine as _;
use driveline_firmware::scenes::spindle::{self, Spindle};

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, PlantError, Shaft};

/// Shear modulus of steel (Pa).
const STEEL: f64 = 79.3e9;

/// Torque of the cut (N m).
const CUT: f64 = 45.0;

/// Stiffness of the shaft from its diameters (N m/rad), by Simpson's rule along the taper [Wang 1989 §1-3].
pub fn stiffness() -> f64 {
    let bore = 0.022_f64.powi(4);
    let straight = 0.360 / (0.046_f64.powi(4) - bore);
    let pieces = 1000;
    let taper: f64 = (0..=pieces)
        .map(|j| {
            let d = 0.046 + (0.060 - 0.046) * f64::from(j) / f64::from(pieces);
            let weight = if j == 0 || j == pieces { 1.0 } else { 2.0 + 2.0 * f64::from(j % 2) };
            weight / (d.powi(4) - bore)
        })
        .sum();
    STEEL * PI / 32.0 / (straight + taper * 0.120 / (3.0 * f64::from(pieces)))
}

fn shaft(plant: &Body) -> f64 {
    plant.shaft_torque(0)
}

/// The spindle and its runs.
pub fn machine() -> Result<Machine, PlantError> {
    departing(&Departure::NONE)
}

/// The spindle as it is.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let spindle_with = |program: LoadProgram| {
        let shaft = Shaft::elastic(stiffness() * by.stiffness).damping(0.3 * by.damping);
        Chain::motor(0.012 * by.motor_inertia).shaft(shaft, 0.004 * by.load_inertia).program(program).build()
    };
    let run_up = vec![(0.01, Action::Release), (0.01, Action::Setpoint(Spindle::RATING.speed.0))];
    // The tool hits a shoulder within three milliseconds, cuts less as the feed takes it through a corner, and leaves
    // as fast.
    let face = [(0.8, 0.0), (0.803, CUT), (1.2, CUT), (1.3, 0.6 * CUT), (1.5, 0.6 * CUT), (1.503, 0.0)];
    // Four teeth at 50 turns a second: a ripple of a fifth of the cut at 200 Hz.
    let teeth = (0..400).map(|j| {
        let time = 0.9 + f64::from(j) * 0.0025;
        (time, CUT * if j % 2 == 0 { 0.9 } else { 1.1 })
    });
    let milling: Vec<(f64, f64)> =
        [(0.8, 0.0), (0.82, CUT), (0.89, CUT)].into_iter().chain(teeth).chain([(1.92, 0.0)]).collect();
    Ok(Machine {
        summary: "A machine tool's spindle with a shaft of 800 Hz: run-up and cuts.",
        facts: facts::of_design::<Spindle>(spindle::COUNTS),
        notes: vec![
            "The observer of one mass is chosen: over the tolerances its errors are smaller than those of two masses \
                in every draw. With white noise of 1 % in the torque an oscillation of 800 Hz is hardly observable at \
                the motor, and it is small beside the step of the cut, which any observer follows a millisecond late.",
            "The run with four teeth does not count: a ripple of 200 Hz is above the bandwidth of an observer with \
                acceptable noise.",
        ],
        chosen: ("rigid", Spindle::RATE_HZ),
        scenarios: vec![
            Scenario {
                actions: run_up.clone(),
                duration: 1.8,
                marks: vec![(0.01, "run-up"), (0.8, "cut"), (1.5, "out")],
                ..Scenario::of("run-up and a face cut", spindle_with(LoadProgram::table(&face))?)
            },
            Scenario {
                name: "milling with four teeth",
                plant: spindle_with(LoadProgram::table(&milling))?.into(),
                held: 0.0,
                actions: run_up,
                duration: 2.1,
                counted: false,
                marks: vec![(0.01, "run-up"), (0.8, "cut"), (1.9, "out")],
                law: None,
            },
        ],
        load: 1,
        shaft_torque: shaft,
        load_torque: |plant| plant.load_torque(1),
        ..facts::scene::<Spindle>(spindle::SCENE, spindle::COUNTS)
    })
}
