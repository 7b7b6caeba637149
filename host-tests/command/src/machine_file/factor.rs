//! The factors in which machines of one design differ, and their tolerances.

use core::fmt;

/// Lists the factors with their names and units.
macro_rules! factors {
    ($($(#[$text:meta])* $factor:ident = $name:literal, $key:literal, $unit:literal, $nominal:literal;)+) => {
        /// A quantity in which machines of one design differ.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Factor {
            $($(#[$text])* $factor,)+
        }

        /// Longest delay of the torque that a campaign's actuator has room for (ticks).
const MAX_DELAY: f64 = 3.0;
#[cfg(not(target_family = "wasm"))]
const _: () = assert!(MAX_DELAY == driveline_closed_loop::actuator::MAX_DELAY);

impl Factor {
            /// All.
            pub const ALL: &[Self] = &[$(Self::$factor),+];

            /// Name on the command line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$factor => $name),+ }
            }

            /// Key in a machine file.
            pub const fn key(self) -> &'static str {
                match self { $(Self::$factor => $key),+ }
            }

            pub const fn unit(self) -> &'static str {
                match self { $(Self::$factor => $unit),+ }
            }

            /// Value for the machine that the drive was designed for.
            pub const fn nominal(self) -> f64 {
                match self { $(Self::$factor => $nominal),+ }
            }
        }
    };
}

factors! {
    /// Stiffness of the shafts.
    Stiffness = "stiffness", "stiffness", "of nominal", 1.0;
    MotorInertia = "motor-inertia", "motor_inertia", "of nominal", 1.0;
    LoadInertia = "load-inertia", "load_inertia", "of nominal", 1.0;
    /// Efficiency of the gear, as a difference.
    Efficiency = "efficiency", "efficiency", "added", 0.0;
    /// Gap of the backlash.
    Gap = "gap", "gap", "of nominal", 1.0;
    /// Mass on the hook.
    Load = "load", "load", "of nominal", 1.0;
    /// Length of the rope.
    Rope = "rope", "rope", "of nominal", 1.0;
    /// Torque constant of the motor.
    TorqueConstant = "torque-constant", "torque_constant", "of nominal", 1.0;
    /// Torque at the shaft that the inverter does not report.
    TorqueOffset = "torque-offset", "torque_offset", "of rated torque", 0.0;
    /// Amplitude of the cogging torque.
    Cogging = "cogging", "cogging", "of rated torque", 0.0;
    /// Delay of the torque.
    Delay = "delay", "delay", "ticks", 0.0;
    /// Time constant of the current loop.
    Lag = "lag", "lag", "s", 0.0;
    /// Amplitude of the encoder's error once a turn.
    Eccentricity = "eccentricity", "eccentricity", "rad", 0.0;
    /// Amplitude of the encoder's error once a line.
    Interpolation = "interpolation", "interpolation", "of a line", 0.0;
    /// Standard deviation of the instant at which the encoder is sampled.
    Jitter = "jitter", "jitter", "s", 0.0;
    /// Share of the ticks that do not run.
    MissedTicks = "missed-ticks", "missed_ticks", "of all", 0.0;
    /// Damping of the shafts.
    Damping = "damping", "damping", "of nominal", 1.0;
}

impl Factor {
    /// The factor of a name, or of its key in a machine file.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|factor| factor.name() == name || factor.key() == name)
    }
}

/// The range of a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    pub factor: Factor,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}..{}", self.factor.name(), self.low, self.high)
    }
}

impl Tolerance {
    /// A factor between two values.
    pub const fn new(factor: Factor, low: f64, high: f64) -> Self {
        Self { factor, low, high }
    }

    /// Reads `NAME=LOW..HIGH` or `NAME=VALUE`.
    ///
    /// # Errors
    /// A sentence: no such factor, not two numbers in order, or a range that no machine has.
    pub fn parse(text: &str) -> Result<Self, String> {
        let form = "expected NAME=LOW..HIGH or NAME=VALUE, such as load=0.5..1";
        let (name, range) = text.split_once('=').ok_or_else(|| format!("tolerance `{text}`: {form}"))?;
        let factor = Factor::named(name.trim()).ok_or_else(|| {
            let names: Vec<&str> = Factor::ALL.iter().map(|factor| factor.name()).collect();
            format!("there is no factor `{name}`; there are {}", names.join(", "))
        })?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        let (low, high) = range.split_once("..").unwrap_or((range, range));
        let (Some(low), Some(high)) = (number(low), number(high)) else {
            return Err(format!("tolerance `{text}`: {form}"));
        };
        if low > high {
            return Err(format!("tolerance `{text}`: {low} is above {high}; write the lower value first"));
        }
        let (least, most) = factor.possible();
        if low < least || high > most {
            return Err(format!("tolerance `{text}`: `{name}` lies from {least} to {most}, {}", factor.unit()));
        }
        Ok(Self { factor, low, high })
    }
}

impl Factor {
    /// The range that a single number stands for: a ratio by so much either way, a difference or an offset either way,
    /// an amplitude from none.
    pub const fn about(self, by: f64) -> Tolerance {
        let (low, high) = match self {
            Self::Efficiency | Self::TorqueOffset => (-by, by),
            _ if self.nominal() == 0.0 => (0.0, by),
            _ => (self.nominal() - by, self.nominal() + by),
        };
        Tolerance::new(self, low, high)
    }

    /// Values that a run is possible with.
    pub const fn possible(self) -> (f64, f64) {
        match self {
            Self::Stiffness | Self::MotorInertia | Self::LoadInertia | Self::Load | Self::Rope => (0.01, 100.0),
            Self::Gap | Self::Damping => (0.0, 100.0),
            Self::TorqueConstant => (0.1, 10.0),
            Self::Efficiency => (-0.5, 0.05),
            Self::TorqueOffset => (-1.0, 1.0),
            Self::Cogging | Self::Interpolation | Self::MissedTicks => (0.0, 1.0),
            Self::Delay => (0.0, MAX_DELAY),
            Self::Lag | Self::Jitter => (0.0, 0.1),
            Self::Eccentricity => (0.0, 0.5),
        }
    }
}
