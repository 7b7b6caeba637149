//! The converter's full plant with its four motors on the bull gear, and its run.
//!
//! Six inertias on their own shafts: four motors, the bull gear, the vessel; a shaft with a gap for each motor's train,
//! and the trunnion. [Derived; heading: Huang 1987 ch. 12.]

use driveline::configure::{HasLoadSharing as _, Machine as _};
use driveline_firmware::scenes::converter_ring::{self as scene, ConverterRing, MOTORS};

use super::facts::{self, fact};
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::noise::Noise;
use driveline_solver::plant::train::{Coordinate, Friction, Link, Source, Train};
use driveline_solver::plant::{LoadProgram, PlantError};

const RATIO: f64 = 690.0;
const BULL_GEAR: usize = MOTORS;
const VESSEL: usize = MOTORS + 1;
const TRUNNION: usize = MOTORS;

/// Friction of trunnion bearings and gears (N m at the motors): a tenth of rated torque.
const FRICTION: f64 = 700.0;
/// Torque of the bath on either side of its dead centre, and of a skull at the mouth (N m at the motors).
const BATH: f64 = 2_400.0;
const SKULL: f64 = 6_600.0;

/// When the speed reverses; when all motors carry the skull (s).
pub const REVERSAL: [f64; 2] = [4.0, 7.3];
/// See [`REVERSAL`].
pub const HEAVY: [f64; 2] = [8.9, 9.2];

/// What is particular to each of the four drives, over what is told: inertia, stiffness, gap and torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinion {
    /// Of the motor's inertia.
    pub inertia: f64,
    /// Of the train's stiffness and damping.
    pub stiffness: f64,
    pub gap: f64,
    /// Of the motor's torque.
    pub torque: f64,
}

impl Pinion {
    /// As told.
    pub const NOMINAL: Pinion = Pinion { inertia: 1.0, stiffness: 1.0, gap: 1.0, torque: 1.0 };

    /// Four drives within their tolerances, evenly spread: inertia 5 %, stiffness 20 %, gap 50 %, torque 1 %.
    #[must_use]
    pub fn drawn(seed: u64) -> [Pinion; MOTORS] {
        let mut noise = Noise::new(seed);
        let mut within = |tolerance: f64| 1.0 + tolerance * noise.uniform();
        [(); MOTORS].map(|()| Pinion {
            inertia: within(0.05),
            stiffness: within(0.2),
            gap: within(0.5),
            torque: within(0.01),
        })
    }
}

/// Torque of a pinion's shaft, at the motor (N m).
pub fn pinion(plant: &Body, motor: usize) -> f64 {
    plant.shaft_torque(motor)
}

fn trunnion(plant: &Body) -> f64 {
    plant.shaft_torque(TRUNNION) / RATIO
}

/// The drive at rest in the middle of its gaps.
pub fn ring(pinions: &[Pinion; MOTORS]) -> Result<Body, PlantError> {
    let mut train = Train::new();
    for pinion in pinions {
        train = train.coordinate(Coordinate::new(9.0 * pinion.inertia));
    }
    let load =
        [(0.9, 0.0), (1.8, BATH), (5.2, BATH), (6.2, -BATH), (6.6, -BATH), (7.0, 0.0), (7.3, 0.0), (8.1, -SKULL)];
    let load = [&load[..], &[(9.2, -SKULL), (9.8, 0.0)]].concat();
    let load: Vec<(f64, f64)> = load.into_iter().map(|(time, torque)| (time, -torque * RATIO)).collect();
    train = train
        .coordinate(Coordinate::new(4.0 * RATIO * RATIO))
        .coordinate(Coordinate::new(1.2e7).source(Source::Program(LoadProgram::table(&load))))
        .friction(Friction::ground(VESSEL, FRICTION * RATIO));
    for (motor, pinion) in pinions.iter().enumerate() {
        let shaft = Link::geared(motor, BULL_GEAR, RATIO, 5.0e4 * pinion.stiffness);
        train = train.link(shaft.damping(3.75 * pinion.stiffness).gap(0.3 * pinion.gap));
    }
    let motion = train.link(Link::shaft(BULL_GEAR, VESSEL, 3.6e9).damping(1.0e7)).build()?;
    let gains = pinions.map(|pinion| pinion.torque);
    Ok(Body::train(motion, &[(BULL_GEAR, RATIO), (VESSEL, RATIO)]).with_motors(&gains))
}

/// The converter and its run: tilting out of the gaps, over the dead centre, back, a skull that all four motors carry,
/// and a stop.
pub fn machine() -> Result<Machine, PlantError> {
    with(&[Pinion::NOMINAL; MOTORS])
}

/// The same with four drives that differ.
pub fn with(pinions: &[Pinion; MOTORS]) -> Result<Machine, PlantError> {
    let mut facts = facts::of_design::<ConverterRing>(8192);
    facts.push(fact("torque bias", format!("{:.0} N m of preload at each pinion", ConverterRing::SHARING.preload)));
    let tilting = Scenario {
        actions: vec![
            (0.1, Action::Release),
            (0.1, Action::Setpoint(ConverterRing::RATING.speed.0)),
            (REVERSAL[0], Action::Setpoint(-ConverterRing::RATING.speed.0)),
            (9.8, Action::Setpoint(0.0)),
        ],
        duration: 10.8,
        marks: vec![(0.1, "tilting"), (3.0, "dead centre"), (REVERSAL[0], "reversal"), (7.3, "skull"), (9.8, "stop")],
        ..Scenario::of("tilting, a reversal under the bias, a load that all motors share", ring(pinions)?)
    };
    Ok(Machine {
        summary: "A converter's tilting drive with its four motors: load sharing and a torque bias against backlash.",
        facts,
        notes: vec![
            "The shaft torque is that of the trunnion, at the motors.",
            "The observer stands on the mean of four angles. The full plant has four trains with a gap each.",
        ],
        chosen: ("biased", ConverterRing::RATE_HZ),
        scenarios: vec![tilting],
        load: VESSEL,
        shaft_torque: trunnion,
        load_torque: |plant| plant.load_torque(VESSEL),
        ..facts::scene::<ConverterRing>(scene::SCENE, 8192)
    })
}
