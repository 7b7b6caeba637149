//! The plate mill's full plant: motor, pinion stand, and a spindle with its roll on either side of it; set up here once
//! more from the same figures as the scene.

use driveline::configure::Machine as _;
use driveline_firmware::scenes::plate_mill::{self as scene, PlateMill};

use super::facts;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::train::{Coordinate, Link, Source, Train};
use driveline_solver::plant::{LoadProgram, PlantError};

const STAND: usize = 1;
const UPPER: usize = 2;
const LOWER: usize = 3;

/// Links of the spindles.
const SPINDLES: [usize; 2] = [1, 2];

/// Rolling torque (N m), and the upper roll's share of it: a plate that is hotter on top bends down, and loads the
/// rolls unequally.
const ROLLING: f64 = 0.8 * 3.82e5;
const UPPER_SHARE: f64 = 0.54;

/// A plate that fills the bite within 60 ms and leaves it within 60 ms.
fn plate(share: f64) -> Source {
    let torque = -share * ROLLING;
    Source::Program(LoadProgram::table(&[(3.0, 0.0), (3.06, torque), (4.2, torque), (4.26, 0.0)]))
}

/// The mill and its run.
pub fn machine() -> Result<Machine, PlantError> {
    // friction of the roll bearings: 5 % of rated torque at rated speed
    let friction = 0.025 * PlateMill::RATING.torque.0 / PlateMill::RATING.speed.0;
    let motion = Train::new()
        .coordinate(Coordinate::new(3.0e4))
        .coordinate(Coordinate::new(3.0e3))
        .coordinate(Coordinate::new(1.52e4).viscous(friction).source(plate(UPPER_SHARE)))
        .coordinate(Coordinate::new(1.44e4).viscous(friction).source(plate(1.0 - UPPER_SHARE)))
        .link(Link::shaft(0, STAND, 4.0e9).damping(4.0e5))
        .link(Link::shaft(STAND, UPPER, 1.1e8).damping(2.8e4))
        .link(Link::shaft(STAND, LOWER, 1.4e8).damping(3.6e4))
        .build()?;
    Ok(Machine {
        summary: "A plate mill's stand with an upper and a lower spindle, a branched train: run-up and a plate.",
        facts: facts::of_design::<PlateMill>(32_768),
        notes: vec![
            "The shaft torque is the sum of both spindles'; the load speed is the upper roll's, which swings against \
                the lower one.",
        ],
        chosen: ("exact", PlateMill::RATE_HZ),
        scenarios: vec![Scenario {
            actions: vec![(0.1, Action::Release), (0.1, Action::Setpoint(PlateMill::RATING.speed.0))],
            duration: 5.5,
            marks: vec![(0.1, "run-up"), (3.0, "bite"), (4.2, "out")],
            ..Scenario::of("run-up, a plate", Body::train(motion, &[]))
        }],
        load: UPPER,
        shaft_torque: |plant| SPINDLES.iter().map(|&spindle| plant.shaft_torque(spindle)).sum(),
        load_torque: |plant| [UPPER, LOWER].iter().map(|&roll| plant.load_torque(roll)).sum(),
        ..facts::scene::<PlateMill>(scene::SCENE, 32_768)
    })
}
