//! The machines as they truly are.
//!
//! Referred to the motor here once more from the same figures as the scenes, but by own arithmetic [Huang 1987 ch. 1,
//! Wang 1989 §1-3].

use driveline::commissioning::TestSettings;
use driveline::configure::Machine as _;
use driveline_firmware::scenes::blooming_mill::BloomingMill;
use driveline_firmware::scenes::commission::{HELD, HOIST, MILL, SPINDLE};
use driveline_firmware::scenes::hoist::Hoist;
use driveline_firmware::scenes::spindle::{self, Spindle};

use super::truth::Truth;
use crate::drivetrains;
use driveline_solver::plant::{Chain, Plant, PlantError, Shaft, Start};

/// A machine to be commissioned.
#[derive(Clone)]
pub struct Case {
    pub name: String,
    /// The plant at the start.
    pub plant: Plant,
    /// Data of the test.
    pub settings: TestSettings,
    /// Counts of the encoder on a turn.
    pub counts: u32,
    /// Eccentricity of the encoder: amplitude and phase (rad).
    pub eccentricity: [f64; 2],
    /// Standard deviation of the motor's torque from its command, white, in every tick (N m).
    pub torque_noise: f64,
    /// Rated torque (N m).
    pub rated_torque: f64,
    /// Which shaft's torque must stay below half of rated.
    pub shaft: usize,
    /// Values to identify.
    pub truth: Truth,
}

/// The machines.
///
/// # Errors
/// A figure of a plant that is out of range, which only a changed scene can bring.
fn cases() -> Result<Vec<Case>, PlantError> {
    Ok(vec![crane()?, mill()?, tool()?])
}

/// The hoist with a quarter of its load. The rope's torque is behind the gear: its loss is dry friction to the motor.
fn crane() -> Result<Case, PlantError> {
    let travel = 0.8 / (2.0 * 2.0 * 31.5);
    let square: f64 = travel * travel;
    let (rope, damping, mass) = (2.9e6 * square, 3.6e3 * square, 3_000.0 * square);
    let (shaft, efficiency) = (5.0e4, 0.94);
    let chain = Chain::motor(0.62)
        .shaft(Shaft::elastic(shaft).damping(2.0), 0.08)
        .efficiency(efficiency)
        .shaft(Shaft::rope(rope).damping(damping), mass)
        .load(HELD)
        .start(Start::Given { twists: vec![HELD / shaft, HELD / rope], speeds: vec![0.0; 3] });
    Ok(Case {
        name: "hoist".into(),
        plant: chain.build()?,
        settings: HOIST,
        counts: 8192,
        eccentricity: [1.5e-3, 0.7],
        torque_noise: 0.01 * Hoist::<10_000>::RATING.torque.0,
        rated_torque: Hoist::<10_000>::RATING.torque.0,
        shaft: 1,
        truth: Truth::of(&[0.62, 0.08, mass], &[shaft, rope], &[2.0, damping])
            .friction(0.5 * HELD * (1.0 / efficiency - efficiency), 0.0)
            .weight(0.5 * HELD * (1.0 / efficiency + efficiency))
            .eccentricity([1.5e-3, 0.7]),
    })
}

/// The blooming mill without a bar.
fn mill() -> Result<Case, PlantError> {
    let friction = 0.05 * BloomingMill::RATING.torque.0;
    let chain = Chain::motor(1.1e5)
        .shaft(Shaft::elastic(1.2e9).damping(3.0e5), 1.0e4)
        .shaft(Shaft::elastic(2.2e8).damping(1.0e5).gap(0.010), 2.2e4)
        .coulomb(friction)
        .start(Start::Rest);
    Ok(Case {
        name: "mill".into(),
        plant: chain.build()?,
        settings: MILL,
        counts: 32_768,
        eccentricity: [0.4e-3, -2.0],
        torque_noise: 0.01 * BloomingMill::RATING.torque.0,
        rated_torque: BloomingMill::RATING.torque.0,
        shaft: 1,
        truth: Truth::of(&[1.1e5, 1.0e4, 2.2e4], &[1.2e9, 2.2e8], &[3.0e5, 1.0e5])
            .friction(friction, 0.0)
            .gap(0.010)
            .eccentricity([0.4e-3, -2.0]),
    })
}

/// The spindle in the air, with a little drag in its bearings.
fn tool() -> Result<Case, PlantError> {
    let stiffness = drivetrains::spindle::stiffness();
    let drag = 0.002;
    let chain =
        Chain::motor(0.012).viscous(drag).shaft(Shaft::elastic(stiffness).damping(0.3), 0.004).start(Start::Rest);
    Ok(Case {
        name: "spindle".into(),
        plant: chain.build()?,
        settings: SPINDLE,
        counts: spindle::COUNTS,
        eccentricity: [0.1e-3, 2.2],
        torque_noise: 0.01 * Spindle::RATING.torque.0,
        rated_torque: Spindle::RATING.torque.0,
        shaft: 0,
        truth: Truth::of(&[0.012, 0.004], &[stiffness], &[0.3]).friction(0.0, drag).eccentricity([0.1e-3, 2.2]),
    })
}

/// The machine of a name.
///
/// # Errors
/// A sentence: no such machine, or a plant that cannot be.
pub fn named(name: &str) -> Result<Case, String> {
    let cases = cases().map_err(|error| format!("the plant of a scene: {error}"))?;
    let names: Vec<String> = cases.iter().map(|case| format!("`{}`", case.name)).collect();
    let found = cases.into_iter().find(|case| case.name == name);
    found.ok_or_else(|| format!("there is no machine `{name}` to be commissioned; there are {}", names.join(", ")))
}
