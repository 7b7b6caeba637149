//! The scenes that campaigns are run of, with their tolerances.
//!
//! The tolerances are those of a class of machine. Those of inertias, stiffness and torque are those for which
//! speed loops are designed, [`driveline::design::Tolerance::USUAL`]; nothing is calibrated.

use core::f64::consts::PI;

use driveline::configure::Machine as _;
use driveline::design::{SpeedLoopDesign, Spread, Tolerance as Usual};
use driveline_firmware::scenes::{blooming_mill, crane_travel, hoist, spindle, strip_mill};
use driveline_solver::plant::PlantError;

use super::factor::{Factor, Tolerance};
use crate::drivetrains;
use crate::drivetrains::departure::Departure;
use crate::drivetrains::scenario::Machine;

/// A scene that campaigns are run of.
#[derive(Clone, Copy, Debug)]
pub struct CampaignScene {
    /// Its name.
    pub name: &'static str,
    /// Its machine with one run, departing from the scene's figures.
    pub departing: fn(&Departure) -> Result<Machine, PlantError>,
    /// The tolerances of its class, and its own; those of [`DRAWINGS`] come before them.
    tolerances: [&'static [Tolerance]; 2],
    /// Lines of its encoder.
    pub lines: f64,
    /// Rated torque [N m].
    pub rated_torque: f64,
    /// Largest torque [N m].
    pub torque_limit: f64,
    /// The ramp of the speed setpoint [rad/s2].
    pub ramp: f64,
    /// The gains of its speed loop.
    pub speed_loop: SpeedLoopDesign,
    /// From when to when nothing excites the swing at the end of the run [s]; the run goes on until then.
    pub free: (f64, f64),
}

impl CampaignScene {
    /// Its tolerances.
    pub fn tolerances(&self) -> Vec<Tolerance> {
        [DRAWINGS, self.tolerances[0], self.tolerances[1]].concat()
    }
}

/// A minute of arc [rad].
const ARCMINUTE: f64 = PI / 10_800.0;

/// The range of a ratio for which a loop is designed.
const fn usual(factor: Factor, spread: Spread) -> Tolerance {
    Tolerance::new(factor, spread.min, spread.max)
}

/// A machine by its drawings, a motor and an inverter by their data sheets.
const DRAWINGS: &[Tolerance] = &[
    usual(Factor::MotorInertia, Usual::USUAL.motor_inertia),
    usual(Factor::TorqueConstant, Usual::USUAL.torque),
    Tolerance::new(Factor::TorqueOffset, -0.01, 0.01),
    Tolerance::new(Factor::Cogging, 0.0, 0.005),
    Tolerance::new(Factor::Delay, 0.0, Usual::USUAL.late as f64),
    Tolerance::new(Factor::Interpolation, 0.0, 0.01),
];

/// Cranes: the encoder's disc is centred to 3 arc minutes and read by software.
const CRANE: &[Tolerance] = &[
    Tolerance::new(Factor::Lag, 0.0, Usual::USUAL.lag),
    Tolerance::new(Factor::Eccentricity, 0.0, 3.0 * ARCMINUTE),
    Tolerance::new(Factor::Jitter, 0.0, 1e-6),
];

/// Mills: rolls are ground and changed, a timer latches the encoder, the torque follows with 200 Hz at least.
const MILL: &[Tolerance] = &[
    usual(Factor::Stiffness, Usual::USUAL.stiffness),
    usual(Factor::LoadInertia, Usual::USUAL.load_inertia),
    Tolerance::new(Factor::Lag, 0.0, 1.0 / (2.0 * PI * 200.0)),
    Tolerance::new(Factor::Eccentricity, 0.0, ARCMINUTE),
    Tolerance::new(Factor::Jitter, 0.0, 2e-7),
];

/// Machine tools: tools are changed, the encoder's disc is centred to 20 arc seconds and latched by a timer.
const MACHINE_TOOL: &[Tolerance] = &[
    usual(Factor::Stiffness, Usual::USUAL.stiffness),
    usual(Factor::LoadInertia, Usual::USUAL.load_inertia),
    Tolerance::new(Factor::Lag, 0.0, Usual::USUAL.lag),
    Tolerance::new(Factor::Eccentricity, 0.0, ARCMINUTE / 3.0),
    Tolerance::new(Factor::Jitter, 0.0, 2e-7),
];

/// The hoist's: 0.5 to 13 t on 5 to 30 m of rope, where the design has 12 t on 12 m; the oil is cold or warm.
const LIFTS: &[Tolerance] = &[
    usual(Factor::Stiffness, Usual::USUAL.stiffness),
    Tolerance::new(Factor::Load, 0.5 / 12.0, 13.0 / 12.0),
    Tolerance::new(Factor::Rope, 5.0 / 12.0, 30.0 / 12.0),
    Tolerance::new(Factor::Efficiency, -0.03, 0.03),
];

/// The crane's: load and length of the pendulum, to the accuracy of the drive's constants.
const SWINGS: &[Tolerance] = &[Tolerance::new(Factor::Load, 0.9, 1.1), Tolerance::new(Factor::Rope, 0.9, 1.1)];

/// The spindles' gap, which wears.
const GAP: &[Tolerance] = &[Tolerance::new(Factor::Gap, 0.7, 1.3)];

/// The scenes.
pub const SCENES: [CampaignScene; 5] = [
    CampaignScene {
        name: hoist::SCENE,
        departing: drivetrains::hoist::departing,
        tolerances: [CRANE, LIFTS],
        lines: 2048.0,
        rated_torque: hoist::Hoist::<10_000>::RATING.torque,
        torque_limit: hoist::Hoist::<10_000>::RATING.torque_limit,
        ramp: hoist::Hoist::<10_000>::RAMP,
        speed_loop: hoist::Hoist::<10_000>::SPEED_LOOP,
        free: (6.1, 8.0),
    },
    CampaignScene {
        name: strip_mill::SCENE,
        departing: drivetrains::strip_mill::departing,
        tolerances: [MILL, &[]],
        lines: 4096.0,
        rated_torque: strip_mill::StripMill::RATING.torque,
        torque_limit: strip_mill::StripMill::RATING.torque_limit,
        ramp: strip_mill::StripMill::RAMP,
        speed_loop: strip_mill::StripMill::SPEED_LOOP,
        free: (7.1, 9.0),
    },
    CampaignScene {
        name: spindle::SCENE,
        departing: drivetrains::spindle::departing,
        tolerances: [MACHINE_TOOL, &[]],
        lines: 512.0,
        rated_torque: spindle::Spindle::RATING.torque,
        torque_limit: spindle::Spindle::RATING.torque_limit,
        ramp: spindle::Spindle::RAMP,
        speed_loop: spindle::Spindle::SPEED_LOOP,
        free: (1.503, 1.56),
    },
    CampaignScene {
        name: blooming_mill::SCENE,
        departing: drivetrains::blooming_mill::departing,
        tolerances: [MILL, GAP],
        lines: 8192.0,
        rated_torque: blooming_mill::BloomingMill::RATING.torque,
        torque_limit: blooming_mill::BloomingMill::RATING.torque_limit,
        ramp: blooming_mill::BloomingMill::RAMP,
        speed_loop: blooming_mill::BloomingMill::SPEED_LOOP,
        free: (5.8, 6.6),
    },
    CampaignScene {
        name: crane_travel::SCENE,
        departing: drivetrains::crane_travel::departing,
        tolerances: [CRANE, SWINGS],
        lines: 1024.0,
        rated_torque: crane_travel::CraneTravel::RATING.torque,
        torque_limit: crane_travel::CraneTravel::RATING.torque_limit,
        ramp: crane_travel::CraneTravel::RAMP,
        speed_loop: crane_travel::CraneTravel::SPEED_LOOP,
        free: (32.0, 40.0),
    },
];
