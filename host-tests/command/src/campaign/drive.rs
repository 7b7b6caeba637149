//! A drive that a campaign runs.

use driveline::design::ObserverChoice;
use driveline_firmware::Words;
use driveline_firmware::scene::Scene;
use driveline_firmware::scenes::Row;

use super::file_drive;
use super::plain::PlainLoop;
use super::scenes::CampaignScene;
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;

/// A drive that a campaign runs.
#[derive(Clone, Copy, Debug)]
pub enum Drive {
    /// A variant of the scene.
    Variant(&'static Row),
    /// A machine file's drive with an observer, at this many ticks a second.
    File(ObserverChoice, u32),
    /// The [`PlainLoop`] with the scene's gains, at this many ticks a second.
    Plain(u32),
}

/// Name of the plain loop.
const PLAIN: &str = "plain";

impl Drive {
    /// The design's choice in `f32`, the variant with this number, observer and rate, or `plain`. Of a machine file the
    /// choice over its tolerances, the name of an observer, or `plain`.
    pub fn named(scene: &CampaignScene, machine: &Machine, name: Option<&str>) -> Result<Self, String> {
        let (observer, rate) = machine.chosen;
        if scene.file().is_some() {
            let name = name.unwrap_or(observer);
            if name == PLAIN {
                return Ok(Self::Plain(rate));
            }
            let found = file_drive::observer(name).map(|observer| Self::File(observer, rate));
            return found.map_err(|observers| {
                format!("there is no drive `{name}` for a machine file; expected {observers} or {PLAIN}")
            });
        }
        let usual = format!("f32/{observer}/{rate}");
        match name.unwrap_or(&usual) {
            PLAIN => Ok(Self::Plain(rate)),
            name => {
                let own = |row: &'static Row| row.name.strip_prefix(machine.name)?.strip_prefix('/');
                let found = scene.variants().iter().find(|row| own(row) == Some(name));
                found.map(Self::Variant).ok_or_else(|| {
                    let all: Vec<&str> = scene.variants().iter().filter_map(own).collect();
                    format!("`{}` has no drive `{name}`; expected {} or plain", machine.name, all.join(", "))
                })
            }
        }
    }

    /// Its name, after that of its scene.
    pub fn name(&self, scene: &str) -> String {
        match self {
            Self::Variant(row) => row.name.to_owned(),
            Self::File(observer, _) => format!("{scene}/{}", file_drive::name(*observer)),
            Self::Plain(_) => format!("{scene}/{PLAIN}"),
        }
    }

    /// What the loop of a machine file's drive lacks of the usual margins; `None` of the others.
    pub fn lacks(&self, scene: &CampaignScene) -> Option<String> {
        let designs = &scene.file()?.designs;
        let lack = match self {
            Self::File(ObserverChoice::Rigid, _) => designs.rigid_lacks,
            Self::File(..) => designs.two_masses_lack,
            Self::Variant(_) | Self::Plain(_) => None,
        };
        lack.map(|lack| lack.to_string())
    }

    /// Whether learners find its machine.
    pub fn learns(&self) -> bool {
        matches!(self, Self::Variant(row) if row.name.split('/').nth(2) == Some("learnt"))
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
    pub fn start(&self, scene: &CampaignScene, machine: &Machine) -> Result<OnHost<Box<dyn Scene>>, String> {
        Ok(OnHost(match (self, scene.file()) {
            (Self::Variant(row), _) => row.start(),
            (Self::File(observer, _), Some(file)) => file.start(*observer)?,
            (Self::File(..), None) => return Err(format!("`{}` is no machine file", scene.name)),
            (Self::Plain(_), _) => {
                Box::new(PlainLoop::new(scene.speed_loop, scene.torque_limit, scene.ramp, machine.bases))
            }
        }))
    }
}
