//! The elements of a machine as a file names them, and the keys of each.

use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Error, Falls, Gap, Inertia, LinearDamping, Mass, Ratio, Stiffness,
};
use serde::Serialize;

use super::diagnostic::Diagnostic;
use super::quantity::Quantity;
use super::table::Table;

/// The kinds of elements, as a message lists them.
pub const KINDS: &str =
    "\"motor\", \"shaft\", \"rotor\", \"gear\", \"drum\", \"rope\", \"lifted\", \"driven\" or \"backlash\"";

/// One element of a machine, in SI units, each on its own shaft or along the travel of the load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Element {
    /// The motor's own rotor. Every machine begins with it.
    Motor {
        /// Inertia \[kg m2\].
        inertia: f64,
    },
    /// A rotor on the present shaft: a brake drum, a gear wheel, a coupling, a roll.
    Rotor {
        /// Inertia \[kg m2\].
        inertia: f64,
    },
    /// An elastic shaft to the next mass.
    Shaft {
        /// Stiffness \[N m/rad\].
        stiffness: f64,
        /// Damping \[N m s/rad\]; 0 where the file is silent.
        damping: f64,
    },
    /// A gear; what follows turns `ratio` times slower.
    Gear {
        /// Speed of the motor's side over speed of the load's side.
        ratio: f64,
        /// Efficiency; 1 where the file is silent.
        efficiency: f64,
    },
    /// A drum or a pinion: turning becomes travel.
    Drum {
        /// Diameter \[m\].
        diameter: f64,
    },
    /// A rope from the drum to the load.
    Rope {
        /// Falls that carry the load.
        falls: u32,
        /// Stiffness at the load \[N/m\].
        stiffness: f64,
        /// Damping at the load \[N s/m\]; 0 where the file is silent.
        damping: f64,
    },
    /// A mass that hangs: inertia and weight.
    Lifted {
        /// Mass \[kg\].
        mass: f64,
    },
    /// A mass that moves on the level: inertia only.
    Driven {
        /// Mass \[kg\].
        mass: f64,
    },
    /// A backlash in series with the shaft beside it.
    Backlash {
        /// Whole free angle between the flanks \[rad\].
        gap: f64,
    },
}

impl Element {
    /// Reads an `[[element]]` table. The kind says which keys belong to it.
    ///
    /// # Errors
    /// A missing, unknown or wrong key, or a kind that does not exist.
    pub fn read(mut table: Table<'_>) -> Result<Self, Diagnostic> {
        let kind = table.text("kind", KINDS)?;
        let element = match kind {
            "motor" => Self::Motor { inertia: table.number("inertia", Quantity::INERTIA)? },
            "rotor" => Self::Rotor { inertia: table.number("inertia", Quantity::INERTIA)? },
            "shaft" => Self::Shaft {
                stiffness: table.number("stiffness", Quantity::STIFFNESS)?,
                damping: table.number_or("damping", Quantity::DAMPING, 0.0)?,
            },
            "gear" => Self::Gear {
                ratio: table.number("ratio", Quantity::RATIO)?,
                efficiency: table.number_or("efficiency", Quantity::EFFICIENCY, 1.0)?,
            },
            "drum" => Self::Drum { diameter: table.number("diameter", Quantity::DIAMETER)? },
            "rope" => Self::Rope {
                // `FALLS` allows whole numbers up to 64 only.
                falls: table.number("falls", Quantity::FALLS)? as u32,
                stiffness: table.number("stiffness", Quantity::ROPE_STIFFNESS)?,
                damping: table.number_or("damping", Quantity::ROPE_DAMPING, 0.0)?,
            },
            "lifted" => Self::Lifted { mass: table.number("mass", Quantity::MASS)? },
            "driven" => Self::Driven { mass: table.number("mass", Quantity::MASS)? },
            "backlash" => Self::Backlash { gap: table.number("gap", Quantity::GAP)? },
            _ => return Err(table.wrong("kind", KINDS)),
        };
        table.finish()?;
        Ok(element)
    }

    /// The name of its kind, as in the file.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Motor { .. } => "motor",
            Self::Rotor { .. } => "rotor",
            Self::Shaft { .. } => "shaft",
            Self::Gear { .. } => "gear",
            Self::Drum { .. } => "drum",
            Self::Rope { .. } => "rope",
            Self::Lifted { .. } => "lifted",
            Self::Driven { .. } => "driven",
            Self::Backlash { .. } => "backlash",
        }
    }

    /// Puts the element at the end of a chain; a motor begins a new one.
    ///
    /// # Errors
    /// The library's own sentence where the element cannot follow.
    pub fn follow(self, chain: Chain) -> Result<Chain, Error> {
        match self {
            Self::Motor { inertia } => Chain::try_motor(Inertia(inertia)),
            Self::Rotor { inertia } => chain.try_rotor(Inertia(inertia)),
            Self::Shaft { stiffness, damping } => chain.try_shaft(Stiffness(stiffness), Damping(damping)),
            Self::Gear { ratio, efficiency } => chain.try_gear(Ratio(ratio), Efficiency(efficiency)),
            Self::Drum { diameter } => chain.try_drum(Diameter(diameter)),
            Self::Rope { falls, stiffness, damping } => {
                chain.try_damped_rope(Falls(falls), Stiffness(stiffness), LinearDamping(damping))
            }
            Self::Lifted { mass } => chain.try_lifted(Mass(mass)),
            Self::Driven { mass } => chain.try_driven(Mass(mass)),
            Self::Backlash { gap } => chain.try_backlash(Gap(gap)),
        }
    }

    /// The element in the words of the library's builder, as `.rotor(Inertia(0.08))`.
    pub fn rust(self) -> String {
        match self {
            Self::Motor { inertia } => format!("Chain::motor(Inertia({inertia:?}))"),
            Self::Rotor { inertia } => format!(".rotor(Inertia({inertia:?}))"),
            Self::Shaft { stiffness, damping } => {
                format!(".shaft(Stiffness({stiffness:?}), Damping({damping:?}))")
            }
            Self::Gear { ratio, efficiency } => {
                format!(".gear(Ratio({ratio:?}), Efficiency({efficiency:?}))")
            }
            Self::Drum { diameter } => format!(".drum(Diameter({diameter:?}))"),
            Self::Rope { falls, stiffness, damping: 0.0 } => format!(".rope(Falls({falls}), Stiffness({stiffness:?}))"),
            Self::Rope { falls, stiffness, damping } => {
                format!(".damped_rope(Falls({falls}), Stiffness({stiffness:?}), LinearDamping({damping:?}))")
            }
            Self::Lifted { mass } => format!(".lifted(Mass({mass:?}))"),
            Self::Driven { mass } => format!(".driven(Mass({mass:?}))"),
            Self::Backlash { gap } => format!(".backlash(Gap({gap:?}))"),
        }
    }
}
