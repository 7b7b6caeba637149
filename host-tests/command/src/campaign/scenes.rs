//! What a campaign is run of: a machine file, or a scene that has the tolerances of a class of machines and its own.

use driveline::configure::Machine as Designed;
use driveline::design::{Actuator, SpeedLoopDesign};
use driveline_firmware::scenes::Row;
use driveline_solver::plant::PlantError;

use super::drive::Drive;
use super::file::FileCase;
use crate::machine_file::MachineFile;
use crate::machine_file::class::Class;
use crate::machine_file::factor::Tolerance;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::scenario::{Machine, Scenario};

/// A scene that campaigns are run of.
#[derive(Clone, Copy, Debug)]
pub struct CampaignScene {
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

/// A scene of the firmware.
#[derive(Clone, Copy, Debug)]
pub struct Firmware {
    pub departing: fn(&Departure) -> Result<Machine, PlantError>,
    /// The runs in which its learners find the machine, with known loads or without load.
    pub preparation: fn(&Departure) -> Result<Vec<Scenario>, PlantError>,
    /// The class that motor, inverter and encoder have their tolerances from.
    pub class: Class,
    pub tolerances: &'static [Tolerance],
    pub variants: &'static [Row],
}

impl Firmware {
    /// No learners, no preparation.
    pub fn unprepared(_: &Departure) -> Result<Vec<Scenario>, PlantError> {
        Ok(Vec::new())
    }
}

/// Where a scene's machine comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    Scene(Firmware),
    File(&'static FileCase),
}

impl CampaignScene {
    /// A machine file as a scene. It is kept to the end of the program.
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
    pub fn departing(&self, by: &Departure) -> Result<Machine, PlantError> {
        match self.source {
            Source::Scene(scene) => (scene.departing)(by),
            Source::File(case) => case.departing(by),
        }
    }

    /// The runs before that of a draw, in which a drive's learners find its machine; none of a drive without learners.
    pub fn preparation(&self, drive: &Drive, by: &Departure) -> Result<Vec<Scenario>, PlantError> {
        match self.source {
            Source::Scene(scene) if drive.learns() => (scene.preparation)(by),
            Source::Scene(_) | Source::File(_) => Ok(Vec::new()),
        }
    }

    /// The variants of its firmware; none of a file.
    pub const fn variants(&self) -> &'static [Row] {
        match self.source {
            Source::Scene(scene) => scene.variants,
            Source::File(_) => &[],
        }
    }

    /// The file that it comes from.
    pub const fn file(&self) -> Option<&'static FileCase> {
        match self.source {
            Source::Scene(..) => None,
            Source::File(case) => Some(case),
        }
    }

    /// A scene with ratings, ramp and speed loop of the design that its firmware is built from; see the fields.
    pub const fn of<M: Designed>(name: &'static str, scene: Firmware, lines: f64, free: (f64, f64)) -> Self {
        CampaignScene {
            name,
            source: Source::Scene(scene),
            actuator: M::ACTUATOR,
            lines,
            rated_torque: M::RATING.torque.0,
            torque_limit: M::RATING.torque_limit.0,
            ramp: M::RAMP,
            speed_loop: M::SPEED_LOOP,
            free,
            resonance: M::TWO_MASS.resonance(),
        }
    }

    pub fn tolerances(&self) -> Vec<Tolerance> {
        match self.source {
            Source::Scene(scene) => scene.class.drive().into_iter().chain(scene.tolerances.iter().copied()).collect(),
            Source::File(case) => case.machine.tolerances.clone(),
        }
    }
}
