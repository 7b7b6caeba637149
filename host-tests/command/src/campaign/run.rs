//! The run of a draw: the library's own code on the host against the drawn machine.

use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::{Row, find};

use super::draw::Draw;
use super::figure::{Gathering, Outcome, Scale};
use super::file::FileObserver;
use super::plain::PlainLoop;
use super::preparation::preparation;
use super::scenes::CampaignScene;
use crate::closed_loop::actuator::ActuatorErrors;
use crate::closed_loop::encoder_errors::EncoderErrors;
use crate::closed_loop::ticks::{OnHost, Ticks};
use crate::closed_loop::units::Units;
use crate::drivetrains::lockstep::{Imperfections, follow};
use crate::drivetrains::scenario::{Machine, Scenario};

/// A drive that a campaign runs.
#[derive(Clone, Copy, Debug)]
pub enum Drive {
    /// A variant of the scene.
    Variant(&'static Row),
    /// A machine file's drive with an observer, at this many ticks a second.
    File(FileObserver, u32),
    /// The [`PlainLoop`] with the scene's gains, at this many ticks a second.
    Plain(u32),
}

/// Name of the plain loop.
const PLAIN: &str = "plain";

impl Drive {
    /// The design's choice in `f32`, the variant with this number, observer and rate, or `plain`. Of a machine file the
    /// choice over its tolerances, `two-mass`, `rigid` or `plain`.
    ///
    /// # Errors
    /// A sentence: no such variant.
    pub fn named(scene: &CampaignScene, machine: &Machine, name: Option<&str>) -> Result<Self, String> {
        let (observer, rate) = machine.chosen;
        if scene.file().is_some() {
            let name = name.unwrap_or(observer);
            let found = FileObserver::ALL.into_iter().find(|observer| observer.name() == name);
            return match found {
                Some(observer) => Ok(Self::File(observer, rate)),
                None if name == PLAIN => Ok(Self::Plain(rate)),
                None => {
                    Err(format!("there is no drive `{name}` for a machine file; expected two-mass, rigid or plain"))
                }
            };
        }
        let usual = format!("f32/{observer}/{rate}");
        match name.unwrap_or(&usual) {
            PLAIN => Ok(Self::Plain(rate)),
            name => find(&format!("{}/{name}", machine.name)).map(Self::Variant).ok_or_else(|| {
                format!(
                    "`{}` has no drive `{name}`; expected NUMBER/OBSERVER/RATE, such as {usual}, or plain",
                    machine.name
                )
            }),
        }
    }

    /// Its name, after that of its scene.
    pub fn name(&self, scene: &str) -> String {
        match self {
            Self::Variant(row) => row.name.to_owned(),
            Self::File(observer, _) => format!("{scene}/{}", observer.name()),
            Self::Plain(_) => format!("{scene}/{PLAIN}"),
        }
    }

    /// Ticks a second.
    pub const fn rate_hz(&self) -> u32 {
        match self {
            Self::Variant(row) => row.rate_hz,
            Self::File(_, rate) | Self::Plain(rate) => *rate,
        }
    }

    /// The units of its words.
    pub fn units(&self, machine: &Machine) -> Units {
        let words = match self {
            Self::Variant(row) => row.words(),
            Self::File(..) | Self::Plain(_) => Words::Single,
        };
        Units::new(words, machine.bases)
    }

    /// It at rest.
    ///
    /// # Errors
    /// A sentence: constants that `f32` does not hold.
    pub fn start(&self, scene: &CampaignScene, machine: &Machine) -> Result<Box<dyn Ticks>, String> {
        match (self, scene.file()) {
            (Self::Variant(row), _) => Ok(Box::new(OnHost(row.start()))),
            (Self::File(observer, _), Some(file)) => file.start(*observer),
            (Self::File(..), None) => Err(format!("`{}` is no machine file", scene.name)),
            (Self::Plain(_), _) => {
                Ok(Box::new(PlainLoop::new(scene.speed_loop, scene.torque_limit, scene.ramp, machine.bases)))
            }
        }
    }
}

/// Runs a draw. One that swings at the end runs again without noise and errors of the encoder, to find out whether the
/// loop sustains the swing or the sensors do.
///
/// # Errors
/// A sentence: values that no plant can have.
pub fn run(scene: &CampaignScene, drive: &Drive, draw: &Draw) -> Result<Outcome, String> {
    let wrong = |error: &dyn core::fmt::Display| format!("draw {} of `{}`: {error}", draw.number, scene.name);
    let machine = scene.departing(&draw.departure()).map_err(|error| wrong(&error))?;
    let mut scenario = machine.scenarios.first().ok_or_else(|| wrong(&"the machine has no run"))?.clone();
    scenario.duration = scenario.duration.max(scene.free.1);
    let mut imperfections = draw.imperfections(scene.lines, scene.rated_torque);
    imperfections.actuator.delay += scene.actuator.delay * f64::from(drive.rate_hz());
    imperfections.actuator.lag += scene.actuator.lag;
    let prepared = preparation(scene.name, drive, &draw.departure()).map_err(|error| wrong(&error))?;
    let follow = |machine: &Machine, imperfections: &Imperfections| {
        let mut ticking = drive.start(scene, machine).map_err(|error| wrong(&error))?;
        follow_draw(scene, drive, machine, &prepared, &scenario, imperfections, &mut ticking)
            .map_err(|error| wrong(&error))
    };
    let outcome = follow(&machine, &imperfections)?;
    if !outcome.swings() {
        return Ok(outcome);
    }
    let encoder = EncoderErrors::default();
    let actuator = ActuatorErrors { cogging: 0.0, ..imperfections.actuator };
    let quiet = Machine { torque_noise: 0.0, ..scene.departing(&draw.departure()).map_err(|error| wrong(&error))? };
    let quiet = follow(&quiet, &Imperfections { encoder, actuator, ..imperfections })?;
    Ok(outcome.with_sustained(&quiet, scene.free.1 - scene.free.0))
}

fn follow_draw(
    scene: &CampaignScene,
    drive: &Drive,
    machine: &Machine,
    prepared: &[Scenario],
    scenario: &Scenario,
    imperfections: &Imperfections,
    ticking: &mut Box<dyn Ticks>,
) -> std::io::Result<Outcome> {
    let units = drive.units(machine);
    let mut plant = scenario.plant.unrecorded();
    let mut gathering = Gathering::new(Scale {
        torque: scene.rated_torque,
        speed: machine.rated_speed,
        load_inertia: (machine.load..plant.nodes()).map(|node| plant.inertia(node)).sum(),
        free: scene.free,
    });
    let step = scene.ramp / f64::from(drive.rate_hz());
    let mut ramped = 0.0_f64;
    for (before, run) in (1..).zip(prepared) {
        // other noise in each run
        let imperfections = Imperfections { seed: imperfections.seed ^ before, ..*imperfections };
        let mut plant = run.plant.unrecorded();
        follow(machine, run, &units, drive.rate_hz(), &imperfections, ticking, &mut plant, |_, _| {})?;
    }
    let each = |moment: &_, (input, _): (Input, _)| {
        let target = if input.flags & Input::RELEASED == 0 { ramped } else { units.speed(input.setpoint) };
        let change = (target - ramped).clamp(-step, step);
        ramped += change;
        gathering.add(moment, change / step * scene.ramp);
    };
    follow(machine, scenario, &units, drive.rate_hz(), imperfections, ticking, &mut plant, each)?;
    Ok(gathering.outcome())
}
