//! The scenes that campaigns are run of, with their tolerances.
//!
//! The tolerances are those of a class of machine. Those of inertias, stiffness and torque are those for which
//! speed loops are designed, [`driveline::design::Tolerance::USUAL`]; nothing is calibrated.

use core::f64::consts::PI;

use driveline::configure::Machine as Designed;
use driveline::design::{SpeedLoopDesign, Spread, Tolerance as Usual};
use driveline_firmware::scenes::blooming_mill::{self, BloomingMill};
use driveline_firmware::scenes::crane_travel::{self, CraneTravel};
use driveline_firmware::scenes::hoist::{self, Hoist};
use driveline_firmware::scenes::spindle::{self, Spindle};
use driveline_firmware::scenes::strip_mill::{self, StripMill};
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
    /// A scene with ratings, ramp and speed loop of the design that its firmware is built from.
    const fn of<M: Designed>(
        name: &'static str,
        departing: fn(&Departure) -> Result<Machine, PlantError>,
        tolerances: [&'static [Tolerance]; 2],
        lines: f64,
        free: (f64, f64),
    ) -> Self {
        CampaignScene {
            name,
            departing,
            tolerances,
            lines,
            rated_torque: M::RATING.torque,
            torque_limit: M::RATING.torque_limit,
            ramp: M::RAMP,
            speed_loop: M::SPEED_LOOP,
            free,
        }
    }

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
    CampaignScene::of::<Hoist<10_000>>(hoist::SCENE, drivetrains::hoist::departing, [CRANE, LIFTS], 2048.0, (6.1, 8.0)),
    CampaignScene::of::<StripMill>(
        strip_mill::SCENE,
        drivetrains::strip_mill::departing,
        [MILL, &[]],
        4096.0,
        (7.1, 9.0),
    ),
    CampaignScene::of::<Spindle>(
        spindle::SCENE,
        drivetrains::spindle::departing,
        [MACHINE_TOOL, &[]],
        512.0,
        (1.503, 1.56),
    ),
    CampaignScene::of::<BloomingMill>(
        blooming_mill::SCENE,
        drivetrains::blooming_mill::departing,
        [MILL, GAP],
        8192.0,
        (5.8, 6.6),
    ),
    CampaignScene::of::<CraneTravel>(
        crane_travel::SCENE,
        drivetrains::crane_travel::departing,
        [CRANE, SWINGS],
        1024.0,
        (32.0, 40.0),
    ),
];
