//! The drive of a machine file, composed at run time as a project of `cargo driveline new` is by the compiler: the same
//! parts and constants, so the same bits.

use std::error::Error;

use driveline::design::{BacklashTuning, ObserverChoice};
use driveline::drive::{Composition, Config, ConfigOf, Drive, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::number::Fixed;
use driveline::observer::{
    BacklashConfig, BacklashObserver, GearedConfig, GearedObserver, LoadGearConfig, LoadGearObserver, RigidConfig,
    RigidObserver, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver,
};
use driveline::settings::{Bases, Gear, LoadGear, SpeedLoopSettings};
use driveline_firmware::Words;
use driveline_firmware::scene::composed::OverWords;
use driveline_firmware::scene::{Input, Output, Scene};

use crate::machine_file::MachineFile;
use crate::machine_file::designs::Designs;

/// The observers of a file's drive by their names on the command line.
pub const OBSERVERS: [(&str, ObserverChoice); 4] = [
    ("two-mass", ObserverChoice::Exact),
    ("semi-implicit", ObserverChoice::SemiImplicit),
    ("rigid", ObserverChoice::Rigid),
    ("backlash", ObserverChoice::Backlash),
];

/// The observer of a name.
///
/// # Errors
/// All names.
pub fn observer(name: &str) -> Result<ObserverChoice, String> {
    let found = OBSERVERS.iter().find(|(known, _)| *known == name);
    found.map(|(_, observer)| *observer).ok_or_else(|| OBSERVERS.map(|(name, _)| name).join(", "))
}

/// The name of an observer.
pub fn name(observer: ObserverChoice) -> &'static str {
    OBSERVERS.iter().find(|(_, known)| *known == observer).map_or("", |(name, _)| name)
}

/// The drive of a machine with its dampers, at rest, and the bases of its number.
///
/// # Errors
/// A sentence: constants that the number does not hold, no gap for its observer.
pub fn start(
    machine: &MachineFile,
    designs: &Designs,
    observer: ObserverChoice,
    number: Words,
) -> Result<(Box<dyn Scene>, Bases), String> {
    let Designs { two, rigid, speed_loop, .. } = designs;
    let is_fixed = matches!(number, Words::Fixed);
    let (gear, behind) = machine.drive_gears(two, is_fixed)?;
    let rating = machine.rating();
    let bases = if is_fixed { rating.bases(&designs.two_masses, rigid, &gear, speed_loop) } else { Bases::SI };
    let parts = Parts { machine, designs, observer, bases, gear, behind };
    let drive = if is_fixed { parts.fixed() } else { parts.single() };
    Ok((drive.map_err(|error| error.to_string())?, bases))
}

/// Parts of a drive.
struct Parts<'a> {
    machine: &'a MachineFile,
    designs: &'a Designs,
    observer: ObserverChoice,
    bases: Bases,
    gear: Gear,
    behind: LoadGear,
}

/// A drive of an observer; a gear without a loss is left out.
macro_rules! driven {
    (@ $of:ident, $number:ty, $observer:ty, $config:expr) => {
        Observed::<Drive<$number, $observer, SpeedLoop>>::boxed(Config {
            limits: $of.0,
            observer: $config,
            fluctuation: (),
            governor: $of.1,
            balancer: (),
        })
    };
    ($self:ident, $of:ident, $number:ty, $observer:ident, $config:expr) => {{
        let (config, period) = ($config?, 1.0 / f64::from($self.machine.control.rate_hz));
        let losses = $self.machine.chain.losses();
        let before = || GearedConfig::<$number, _>::try_new(config, &$self.gear, period, $self.bases);
        macro_rules! behind {
            ($of_motor:expr) => {
                LoadGearConfig::<$number, _>::try_new($of_motor, &$self.behind, period, $self.bases)?
            };
        }
        match [losses.behind, losses.before].map(|shares| shares != [1.0; 2]) {
            [false, false] => driven!(@ $of, $number, $observer, config),
            [false, true] => driven!(@ $of, $number, GearedObserver<$observer>, before()?),
            [true, false] => driven!(@ $of, $number, LoadGearObserver<$observer>, behind!(config)),
            [true, true] => driven!(@ $of, $number, LoadGearObserver<GearedObserver<$observer>>, behind!(before()?)),
        }
    }};
}

macro_rules! number {
    ($name:ident, $number:ty) => {
        fn $name(&self) -> Result<Box<dyn Scene>, Box<dyn Error>> {
            let (Designs { two, two_masses, rigid, speed_loop, ramp, .. }, bases) = (self.designs, self.bases);
            let (rate, encoder, disturbance) = self.machine.tuning();
            let rating = self.machine.rating();
            // in the words of a project, whose sum may differ in the last digit
            let is_chain = self.machine.dampers.is_empty() && self.machine.train.is_none();
            let ramp = if is_chain { self.machine.ramp(self.machine.chain.total_inertia()) } else { *ramp };
            let settings = SpeedLoopSettings { torque_limit: rating.torque_limit.0, ramp };
            let of = (
                Limits::<$number>::try_new(&rating.screening(encoder, rate), bases)?,
                SpeedLoopConfig::<$number>::try_new(speed_loop, settings, bases)?,
            );
            Ok(match self.observer {
                ObserverChoice::Exact => {
                    driven!(self, of, $number, TwoMassObserver, TwoMassConfig::<$number>::try_new(two_masses, bases))
                }
                ObserverChoice::SemiImplicit => {
                    let config = SemiImplicitConfig::<$number>::try_new(two_masses, bases);
                    driven!(self, of, $number, SemiImplicitObserver, config)
                }
                ObserverChoice::Rigid => {
                    let share = two.load_inertia / two.total_inertia();
                    driven!(self, of, $number, RigidObserver, RigidConfig::<$number>::try_new(rigid, share, bases))
                }
                ObserverChoice::Backlash => {
                    let design = two.try_backlash_observer(rate, encoder, disturbance, BacklashTuning::USUAL)?;
                    let config = BacklashConfig::<$number>::try_new(&design, bases);
                    driven!(self, of, $number, BacklashObserver, config)
                }
            })
        }
    };
}

impl Parts<'_> {
    number!(single, f32);
    number!(fixed, Fixed);
}

/// A drive with its constants.
struct Observed<D: Composition> {
    drive: D,
    config: ConfigOf<D>,
}

impl<D: Composition<Config: Clone + 'static> + Clone + 'static> Observed<D> {
    fn boxed(config: ConfigOf<D>) -> Box<dyn Scene> {
        Box::new(Self { drive: D::new(&config, 0), config })
    }
}

impl<D: Composition<Config: Clone + 'static> + Clone + 'static> Scene for Observed<D> {
    fn tick(&mut self, input: &Input) -> Output {
        self.drive.advance(&self.config, input)
    }

    fn missed(&mut self, input: &Input, ticks: u32) -> u32 {
        self.drive.make_up_before(&self.config, input, ticks)
    }

    fn copy(&self) -> Option<Box<dyn Scene>> {
        Some(Box::new(Self { drive: self.drive.clone(), config: self.config.clone() }))
    }
}
