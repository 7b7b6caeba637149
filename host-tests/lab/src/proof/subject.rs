//! What is proved about: the designs of a drive, of a machine of the firmware or of a file.

use cargo_driveline::machine_file::MachineFile;
use cargo_driveline::machine_file::designs::Designs;
use driveline::configure::{GainSource, Machine};
use driveline::design::{Actuator, RigidDesign, SpeedLoopDesign, Tolerance, TwoMassDesign};
use driveline::machine::TwoMass;
use driveline::settings::{Bases, Screening};
use driveline_firmware::scenes;

/// The designs of a drive.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// The machine as two masses.
    pub machine: TwoMass,
    /// The observer of two masses, where there is one.
    pub two_mass: Option<TwoMassDesign>,
    /// The observer of one mass.
    pub rigid: RigidDesign,
    /// Share of the inertia on the load side.
    pub load_share: f64,
    /// Bases of fixed point.
    pub bases: Bases,
    /// Plausibility limits of a sample.
    pub screening: Screening,
    /// The speed loop, where it is one of torque control.
    pub speed_loop: Option<SpeedLoopDesign>,
    /// Delay and lag of the torque.
    pub actuator: Actuator,
    /// The tolerances.
    pub tolerance: Tolerance,
}

impl Subject {
    /// Of a machine with an observer of two masses.
    const fn of<M: Machine>() -> Self {
        Self { two_mass: Some(M::OBSERVER), ..Self::of_one_mass::<M>() }
    }

    /// Of a machine with an observer of one mass.
    const fn of_one_mass<M: Machine>() -> Self {
        Self {
            machine: M::TWO_MASS,
            two_mass: None,
            rigid: M::RIGID_OBSERVER,
            load_share: M::LOAD_SHARE,
            bases: M::BASES,
            screening: M::SCREENING,
            speed_loop: match M::GAINS {
                GainSource::SpeedLoop(design) => Some(design),
                GainSource::Governor(_) => None,
            },
            actuator: M::ACTUATOR,
            tolerance: M::TOLERANCE,
        }
    }
}

impl Subject {
    /// Of a machine file, where it has a shaft.
    ///
    /// # Errors
    /// What a drive of this machine lacks.
    pub fn of_file(file: &MachineFile) -> Result<Self, String> {
        let machine = file.two_masses().ok_or("it has no shaft")?;
        let designs = Designs::of(file, &machine).map_err(|error| error.to_string())?;
        let Designs { two_masses, rigid, speed_loop, .. } = designs;
        let (gear, _) = file.drive_gears(&machine, true)?;
        let (rate, encoder, _) = file.tuning();
        Ok(Self {
            machine,
            two_mass: Some(two_masses),
            rigid,
            load_share: machine.load_inertia / machine.total_inertia(),
            bases: file.rating().bases(&two_masses, &rigid, &gear, &speed_loop),
            screening: file.rating().screening(encoder, rate),
            speed_loop: Some(speed_loop),
            actuator: file.actuator(),
            tolerance: file.tolerance(),
        })
    }

    /// Of the firmware's machines, by name.
    pub fn all() -> Vec<(&'static str, Self)> {
        use scenes::*;
        vec![
            ("hoist, 1 kHz", Self::of::<hoist::Hoist<1_000>>()),
            ("hoist, 4 kHz", Self::of::<hoist::Hoist<4_000>>()),
            ("hoist, 10 kHz", Self::of::<hoist::Hoist<10_000>>()),
            ("spindle", Self::of::<spindle::Spindle>()),
            ("strip mill", Self::of::<strip_mill::StripMill>()),
            ("crane travel", Self::of::<crane_travel::CraneTravel>()),
            ("punch press", Self::of_one_mass::<punch_press::PunchPress>()),
            ("blooming mill", Self::of::<blooming_mill::BloomingMill>()),
            ("balanced fan", Self::of::<balanced_fan::BalancedFan>()),
            ("surface grinder", Self::of::<surface_grinder::SurfaceGrinder>()),
            ("test rig", Self::of::<test_rig::TestRig>()),
        ]
    }
}
