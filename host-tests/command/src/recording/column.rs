//! Columns of a recording: quantity and unit, from a heading such as `speed_rpm`, `Torque [N m]` or `theta_load_rad`.

use std::f64::consts::TAU;
use std::fmt;

/// A quantity that a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// Time of the row (s).
    Time,
    /// Time at which a tooth passed a pickup, on the clock of the rows but not of any of them (s).
    ToothTime,
    /// Torque of the motor (N m).
    Torque,
    /// Current of the motor that makes torque (A).
    Current,
    /// Angle of the motor (rad).
    Angle,
    /// Speed of the motor (rad/s).
    Speed,
    /// Angular acceleration of the motor (rad/s2).
    Acceleration,
    /// Angle of the load, at the motor (rad).
    LoadAngle,
    /// Speed of the load, at the motor (rad/s).
    LoadSpeed,
    /// Torque of the shaft, at the motor (N m).
    ShaftTorque,
    /// Load torque, at the motor (N m).
    LoadTorque,
    /// Level of a pickup at a toothed wheel, of which the edges count.
    Teeth,
    /// Level of a pickup at a mark that passes once a turn.
    Mark,
    /// Vibration, in the unit of its column.
    Vibration,
    /// Frequency of a response (rad/s).
    Frequency,
    /// Size of a response in SI units.
    Magnitude,
    /// Phase of a response (rad).
    Phase,
    /// Real part of a response.
    Real,
    /// Imaginary part of a response.
    Imaginary,
}

/// Names, as `--column` takes them.
const NAMES: [(&str, Quantity); 19] = [
    ("time", Quantity::Time),
    ("tooth-time", Quantity::ToothTime),
    ("torque", Quantity::Torque),
    ("current", Quantity::Current),
    ("angle", Quantity::Angle),
    ("speed", Quantity::Speed),
    ("acceleration", Quantity::Acceleration),
    ("load-angle", Quantity::LoadAngle),
    ("load-speed", Quantity::LoadSpeed),
    ("shaft-torque", Quantity::ShaftTorque),
    ("load-torque", Quantity::LoadTorque),
    ("teeth", Quantity::Teeth),
    ("mark", Quantity::Mark),
    ("vibration", Quantity::Vibration),
    ("frequency", Quantity::Frequency),
    ("magnitude", Quantity::Magnitude),
    ("phase", Quantity::Phase),
    ("real", Quantity::Real),
    ("imaginary", Quantity::Imaginary),
];

/// A quantity's kind, its units and their factors to SI. The first of them is the SI unit.
type Units = &'static [(&'static str, f64)];

const TIME: Units = &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6), ("min", 60.0)];
const TORQUE: Units = &[("nm", 1.0), ("knm", 1e3), ("mnm", 1e-3)];
const CURRENT: Units = &[("a", 1.0), ("ma", 1e-3)];
const ANGLE: Units = &[
    ("rad", 1.0),
    ("mrad", 1e-3),
    ("deg", TAU / 360.0),
    ("°", TAU / 360.0),
    ("turns", TAU),
    ("turn", TAU),
    ("rev", TAU),
    ("counts", f64::NAN),
];
const SPEED: Units = &[
    ("rad/s", 1.0),
    ("r/min", TAU / 60.0),
    ("rpm", TAU / 60.0),
    ("1/min", TAU / 60.0),
    ("deg/s", TAU / 360.0),
    ("°/s", TAU / 360.0),
    ("rev/s", TAU),
    ("r/s", TAU),
];
const ACCELERATION: Units = &[("rad/s2", 1.0), ("deg/s2", TAU / 360.0)];
const FREQUENCY: Units = &[("hz", TAU), ("rad/s", 1.0), ("khz", 1e3 * TAU)];
const PHASE: Units = &[("rad", 1.0), ("deg", TAU / 360.0), ("°", TAU / 360.0)];
const SIZE: Units = &[("si", 1.0), ("db", f64::NAN)];
const PART: Units = &[("si", 1.0)];
const LEVEL: Units = &[("0/1", 1.0), ("v", 1.0), ("mv", 1.0)];
/// A sensor's units differ in kind: none is converted.
const VIBRATION: Units = &[
    ("mm/s", 1.0),
    ("m/s2", 1.0),
    ("g", 1.0),
    ("mg", 1.0),
    ("um", 1.0),
    ("µm", 1.0),
    ("v", 1.0),
    ("mv", 1.0),
    ("counts", 1.0),
];

impl Quantity {
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(_, quantity)| *quantity == self).map_or("", |(name, _)| name)
    }

    /// The quantity of a name.
    pub fn named(name: &str) -> Option<Self> {
        NAMES.iter().find(|(known, _)| *known == name).map(|(_, quantity)| *quantity)
    }

    fn units(self) -> Units {
        match self {
            Self::Time | Self::ToothTime => TIME,
            Self::Torque | Self::ShaftTorque | Self::LoadTorque => TORQUE,
            Self::Current => CURRENT,
            Self::Angle | Self::LoadAngle => ANGLE,
            Self::Speed | Self::LoadSpeed => SPEED,
            Self::Acceleration => ACCELERATION,
            Self::Frequency => FREQUENCY,
            Self::Phase => PHASE,
            Self::Magnitude => SIZE,
            Self::Real | Self::Imaginary => PART,
            Self::Teeth | Self::Mark => LEVEL,
            Self::Vibration => VIBRATION,
        }
    }

    /// Whether a heading without a unit is taken as in SI units: quantities that have hardly another one, and those
    /// that are not converted.
    fn has_default(self) -> bool {
        use Quantity::{Imaginary, Magnitude, Mark, Real, Teeth, Time, ToothTime, Vibration};
        matches!(self, Time | ToothTime | Magnitude | Real | Imaginary | Teeth | Mark | Vibration)
    }

    fn of_words(words: &[&str]) -> Option<Self> {
        let any = |list: &[&str]| words.iter().any(|word| list.contains(word));
        // what was asked of the machine, or is left of it, is not what it did
        if any(&["setpoint", "command", "ref", "target", "error"]) {
            return None;
        }
        let load = any(&["load", "l", "2", "second", "theta2", "omega2"]);
        if any(&["frequency", "freq", "f"]) {
            Some(Self::Frequency)
        } else if any(&["phase"]) {
            Some(Self::Phase)
        } else if any(&["magnitude", "mag", "gain", "amplitude"]) {
            Some(Self::Magnitude)
        } else if any(&["real", "re"]) {
            Some(Self::Real)
        } else if any(&["imaginary", "imag", "im"]) {
            Some(Self::Imaginary)
        } else if any(&["time", "t", "timestamp"]) {
            Some(if any(&["teeth", "tooth", "edge"]) { Self::ToothTime } else { Self::Time })
        } else if any(&["current", "iq", "i", "q"]) {
            // another motor's
            (!load).then_some(Self::Current)
        } else if any(&["torque", "tau", "moment"]) {
            Some(match (any(&["shaft", "coupling"]), load) {
                (true, _) => Self::ShaftTorque,
                (_, true) => Self::LoadTorque,
                _ => Self::Torque,
            })
        } else if any(&["angle", "theta", "phi", "position", "pos", "encoder", "theta2"]) {
            Some(if load { Self::LoadAngle } else { Self::Angle })
        } else if any(&["speed", "omega", "velocity", "w", "n", "omega2"]) {
            Some(if load { Self::LoadSpeed } else { Self::Speed })
        } else if any(&["teeth", "tooth", "crank"]) {
            Some(Self::Teeth)
        } else if any(&["mark", "keyphasor"]) {
            Some(Self::Mark)
        } else if any(&["vibration"]) {
            Some(Self::Vibration)
        } else if any(&["acceleration", "accel", "alpha"]) {
            (!load).then_some(Self::Acceleration)
        } else {
            None
        }
    }
}

/// A column that was understood.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its place in a row.
    pub index: usize,
    pub heading: String,
    pub quantity: Quantity,
    /// Factor to SI units; a level in decibels has none.
    pub factor: Option<f64>,
    /// Whether it is in counts of an encoder.
    pub counted: bool,
}

/// Why a heading is of no use.
#[derive(Clone, Debug, PartialEq)]
pub enum Unusable {
    /// It names no quantity: the column is left out.
    Unknown,
    /// What was found and what was expected.
    Fault(String, String),
}

impl Column {
    /// A column by its heading, or by what the user says of it: its quantity, and its unit if it is another than the
    /// heading's. `counts` are those on a turn of the encoder.
    pub fn of(
        index: usize,
        heading: &str,
        said: Option<(Quantity, Option<&str>)>,
        counts: Option<f64>,
    ) -> Result<Self, Unusable> {
        let (name, own) = parted(heading);
        let lower = name.to_lowercase();
        let words = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
        let by_name = || Some((Quantity::of_words(&words.collect::<Vec<_>>())?, None));
        let (quantity, unit) = said.or_else(by_name).ok_or(Unusable::Unknown)?;
        let unit = unit.or(own.as_deref());
        let units = quantity.units();
        let names = || units.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let fault = |found: String| {
            let example = units.first().map_or("", |(name, _)| name).replace('/', "_per_");
            let expected = format!(
                "a unit of {}, one of {}, as in `{}_{example}` or `{} [{}]`",
                quantity.name(),
                names(),
                quantity.name().replace('-', "_"),
                quantity.name(),
                units.first().map_or("", |(name, _)| name)
            );
            Unusable::Fault(found, expected)
        };
        let factor = match unit.map(simplified) {
            None if quantity.has_default() => 1.0,
            None => return Err(fault(format!("the heading `{heading}` without a unit"))),
            Some(unit) => match units.iter().find(|(name, _)| *name == unit) {
                Some((_, factor)) => *factor,
                None => return Err(fault(format!("the unit `{unit}` in the heading `{heading}`"))),
            },
        };
        let counted = factor.is_nan() && quantity != Quantity::Magnitude;
        let factor = match counts {
            _ if !counted => Some(factor).filter(|factor| !factor.is_nan()),
            Some(counts) => Some(TAU / counts),
            None => {
                let found = format!("counts in the heading `{heading}`");
                return Err(Unusable::Fault(found, "--counts, those on a turn".to_owned()));
            }
        };
        Ok(Self { index, heading: heading.to_owned(), quantity, factor, counted })
    }

    /// A value in SI units.
    pub fn value(&self, raw: f64) -> f64 {
        self.factor.map_or_else(|| 10_f64.powf(raw / 20.0), |factor| raw * factor)
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` ({})", self.heading, self.quantity.name())
    }
}

/// A unit without what is written in so many ways: blanks, dots, carets.
fn simplified(unit: &str) -> String {
    let plain: String = unit.to_lowercase().chars().filter(|c| !" *·.^_\u{202f}".contains(*c)).collect();
    plain.replace("per", "/").replace('²', "2").replace("rads2", "rad/s2").replace("rads", "rad/s")
}

/// A heading's name and unit: `speed [r/min]`, `speed (r/min)`, `speed_rpm`, `speed_rad_per_s`.
fn parted(heading: &str) -> (&str, Option<String>) {
    let heading = heading.trim();
    for [open, close] in [['[', ']'], ['(', ')']] {
        if let Some((name, rest)) = heading.split_once(open) {
            return (name, Some(rest.trim_end().trim_end_matches(close).to_owned()));
        }
    }
    let known = |unit: &str| {
        let unit = simplified(unit);
        NAMES.iter().any(|(_, quantity)| quantity.units().iter().any(|(name, _)| *name == unit))
    };
    let ends = heading.match_indices(['_', ' ']).map(|(at, _)| at);
    // the longest ending that is a unit
    for at in ends {
        if known(&heading[at + 1..]) {
            return (&heading[..at], Some(heading[at + 1..].to_owned()));
        }
    }
    (heading, None)
}
