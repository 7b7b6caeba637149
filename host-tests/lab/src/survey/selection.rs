//! Selection from the survey.

use crate::balancing;
use crate::drivetrains::SCENES;

/// The generator sets' name among the scenes.
pub const GENERATOR: &str = "generator";

/// The commissionings' name among the scenes.
pub const COMMISSIONING: &str = "commissioning";

/// Selected runs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    names: Vec<String>,
}

impl Wanted {
    /// These scenes; everything where none is named.
    pub fn scenes(names: &[String]) -> Result<Self, String> {
        let all = Self::names();
        match names.iter().find(|name| !all.contains(&name.as_str())) {
            Some(name) => {
                let all: Vec<String> = all.iter().map(|name| format!("`{name}`")).collect();
                Err(format!("there is no scene `{name}`; there are {}", all.join(", ")))
            }
            None => Ok(Self { names: names.to_vec() }),
        }
    }

    /// Every scene there is.
    pub fn names() -> Vec<&'static str> {
        let balanced = balancing::scenes().map(|scene| scene.name);
        SCENES.iter().map(|(name, _)| *name).chain([GENERATOR, COMMISSIONING]).chain(balanced).collect()
    }

    /// Whether a scene is wanted.
    pub fn has(&self, scene: &str) -> bool {
        self.names.is_empty() || self.names.iter().any(|name| name == scene)
    }

    /// Whether what belongs to no scene is.
    pub fn everything(&self) -> bool {
        self.names.is_empty()
    }
}
