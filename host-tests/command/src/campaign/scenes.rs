//! The scenes that campaigns are run of, and machine files as scenes, with their tolerances.
//!
//! The tolerances are those of a class of machines, and the scene's own.

use driveline::configure::Machine as Designed;
use driveline::design::{Actuator, SpeedLoopDesign, Tolerance as Usual};
use driveline_firmware::scenes::blooming_mill::{self, BloomingMill};
use driveline_firmware::scenes::crane_travel::{self, CraneTravel};
use driveline_firmware::scenes::hoist::{self, Hoist};
use driveline_firmware::scenes::spindle::{self, Spindle};
use driveline_firmware::scenes::strip_mill::{self, StripMill};
use driveline_solver::plant::PlantError;

use super::file::FileCase;
use crate::drivetrains;
use crate::drivetrains::departure::Departure;
use crate::drivetrains::scenario::Machine;
use crate::machine_file::MachineFile;
use crate::machine_file::class::{Class, usual};
use crate::machine_file::factor::{Factor, Tolerance};

/// A scene that campaigns are run of.
#[derive(Clone, Copy, Debug)]
pub struct CampaignScene {
    /// Its name.
    pub name: &'static str,
    source: Source,
    /// Delay and lag of the torque that the design has (s).
    pub actuator: Actuator,
    /// Lines of its encoder.
    pub lines: f64,
    /// Rated torque (N m).
    pub rated_torque: f64,
    /// Largest torque (N m).
    pub torque_limit: f64,
    /// The ramp of the speed setpoint (rad/s2).
    pub ramp: f64,
    /// The gains of its speed loop.
    pub speed_loop: SpeedLoopDesign,
    /// From when to when nothing excites the swing at the end of the run (s); the run goes on until then.
    pub free: (f64, f64),
    /// Resonance of its two masses (rad/s).
    pub resonance: f64,
}

/// Where a scene's machine comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// A scene of the firmware: its plant; the class that motor, inverter and encoder have their tolerances from; its
    /// own tolerances.
    Scene(fn(&Departure) -> Result<Machine, PlantError>, Class, &'static [Tolerance]),
    /// A file.
    File(&'static FileCase),
}

impl CampaignScene {
    /// A machine file as a scene. It is kept to the end of the program.
    ///
    /// # Errors
    /// A sentence: what a campaign cannot be run of.
    pub fn of_file(machine: MachineFile) -> Result<Self, String> {
        let case: &'static FileCase = Box::leak(Box::new(FileCase::of(machine)?));
        Ok(CampaignScene {
            name: &case.name,
            source: Source::File(case),
            actuator: case.machine.actuator(),
            lines: f64::from(case.machine.encoder.accuracy.signal_periods),
            rated_torque: case.machine.limits.rated_torque,
            torque_limit: case.machine.limits.torque,
            ramp: case.designs.ramp,
            speed_loop: case.designs.speed_loop,
            free: case.free(),
            resonance: case.designs.two.resonance(),
        })
    }

    /// Its machine with one run, departing from the scene's figures.
    ///
    /// # Errors
    /// A figure of the plant that is out of range.
    pub fn departing(&self, by: &Departure) -> Result<Machine, PlantError> {
        match self.source {
            Source::Scene(departing, ..) => departing(by),
            Source::File(case) => case.departing(by),
        }
    }

    /// The file that it comes from.
    pub const fn file(&self) -> Option<&'static FileCase> {
        match self.source {
            Source::Scene(..) => None,
            Source::File(case) => Some(case),
        }
    }

    /// A scene with ratings, ramp and speed loop of the design that its firmware is built from.
    const fn of<M: Designed>(
        name: &'static str,
        departing: fn(&Departure) -> Result<Machine, PlantError>,
        (class, own): (Class, &'static [Tolerance]),
        lines: f64,
        free: (f64, f64),
    ) -> Self {
        CampaignScene {
            name,
            source: Source::Scene(departing, class, own),
            actuator: M::ACTUATOR,
            lines,
            rated_torque: M::RATING.torque,
            torque_limit: M::RATING.torque_limit,
            ramp: M::RAMP,
            speed_loop: M::SPEED_LOOP,
            free,
            resonance: M::TWO_MASS.resonance(),
        }
    }

    /// Its tolerances.
    pub fn tolerances(&self) -> Vec<Tolerance> {
        match self.source {
            Source::Scene(_, class, own) => class.drive().into_iter().chain(own.iter().copied()).collect(),
            Source::File(case) => case.machine.tolerances.clone(),
        }
    }
}

/// The hoist's: 0.5 to 13 t on 5 to 30 m of rope, where the design has 12 t on 12 m; the oil is cold or warm.
const LIFTS: &[Tolerance] = &[
    usual(Factor::Stiffness, Usual::USUAL.stiffness),
    Tolerance::new(Factor::Load, 0.5 / 12.0, 13.0 / 12.0),
    Tolerance::new(Factor::Rope, 5.0 / 12.0, 30.0 / 12.0),
    Tolerance::new(Factor::Efficiency, -0.03, 0.03),
];

/// The crane's: load and length of the pendulum, to the accuracy of the drive's constants.
const SWINGS: &[Tolerance] = &[Tolerance::new(Factor::Load, 0.9, 1.1), Tolerance::new(Factor::Rope, 0.9, 1.1)];

/// Rolls and tools are changed.
const CHANGED: &[Tolerance] =
    &[usual(Factor::Stiffness, Usual::USUAL.stiffness), usual(Factor::LoadInertia, Usual::USUAL.load_inertia)];

/// The same, and the spindles' gap wears.
const GAP: &[Tolerance] = &[
    usual(Factor::Stiffness, Usual::USUAL.stiffness),
    usual(Factor::LoadInertia, Usual::USUAL.load_inertia),
    usual(Factor::Gap, Usual::USUAL.gap),
];

/// The scenes.
pub const SCENES: [CampaignScene; 5] = [
    CampaignScene::of::<Hoist<10_000>>(
        hoist::SCENE,
        drivetrains::hoist::departing,
        (Class::Crane, LIFTS),
        2048.0,
        (6.1, 8.0),
    ),
    CampaignScene::of::<StripMill>(
        strip_mill::SCENE,
        drivetrains::strip_mill::departing,
        (Class::Mill, CHANGED),
        4096.0,
        (7.1, 9.0),
    ),
    CampaignScene::of::<Spindle>(
        spindle::SCENE,
        drivetrains::spindle::departing,
        (Class::MachineTool, CHANGED),
        512.0,
        (1.503, 1.56),
    ),
    CampaignScene::of::<BloomingMill>(
        blooming_mill::SCENE,
        drivetrains::blooming_mill::departing,
        (Class::Mill, GAP),
        8192.0,
        (5.8, 6.6),
    ),
    CampaignScene::of::<CraneTravel>(
        crane_travel::SCENE,
        drivetrains::crane_travel::departing,
        (Class::Crane, SWINGS),
        1024.0,
        (32.0, 40.0),
    ),
];
