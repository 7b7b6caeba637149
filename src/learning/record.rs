//! What learners have found, and how far it may be from the data sheet.

/// What the learners have found. With the feature `parameters` it is a field of one's own `Parameters`, or all of them.
///
/// ```
/// use driveline::learning::{GearLoss, GearLossConfig, Learnt};
/// const CONFIG: GearLossConfig = GearLossConfig::new(300.0, 150.0, [0.8, 0.99], 0.01);
/// // from flash: where it is out of bounds, as on another machine, it is moved to the end: 80 % have 0.36/1.64
/// let kept = Learnt { friction: 0.9, ..Learnt::default() };
/// let most = 0.36 / 1.64;
/// assert!((GearLoss::new(&CONFIG, kept.friction).friction() - most).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Learnt {
    /// Friction of the gear per shaft torque.
    pub friction: f32,
    /// Eccentricity of the encoder: coefficients of cosine and sine (2^-32 turn).
    pub eccentricity: [i32; 2],
    /// Torque at the shaft over the reported one, less one, and where none is reported (N m).
    pub torque: [f32; 2],
    /// Inertia of the motor over that of the data sheet, less one.
    pub inertia: f32,
}

/// How far parameters may be from the data sheet, for [`Machine::LEARNING`](crate::configure::Machine::LEARNING).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearningBounds {
    /// Smallest and largest efficiency of the gear.
    pub efficiency: [f64; 2],
    /// Smallest and largest inertia of the motor over that of the data sheet.
    pub motor_inertia: [f64; 2],
    /// Largest eccentricity of the encoder (rad).
    pub eccentricity: f64,
}

impl LearningBounds {
    /// For a gear of this efficiency: from a sixth of its loss to two and a half of it, a motor within a quarter, a
    /// tenth of a degree.
    #[must_use]
    pub const fn of(efficiency: f64) -> Self {
        // of a gear without losses nothing is found: the range of one that loses 1 %
        let loss = if efficiency < 0.99 { 1.0 - efficiency } else { 0.01 };
        let most = if loss < 0.36 { 2.5 * loss } else { 0.9 };
        LearningBounds {
            efficiency: [1.0 - most, 1.0 - loss / 6.0],
            motor_inertia: [0.75, 1.25],
            eccentricity: 0.1 * core::f64::consts::PI / 180.0,
        }
    }

    /// Whether a value is within a range; one that is not a number is not.
    pub(crate) const fn holds(range: [f64; 2], value: f32) -> bool {
        value >= range[0] as f32 && value <= range[1] as f32
    }
}

#[cfg(feature = "parameters")]
mod stored {
    use super::Learnt;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    impl Serialize for Learnt {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            (self.friction, self.eccentricity, self.torque, self.inertia).serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Learnt {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let (friction, eccentricity, torque, inertia) = Deserialize::deserialize(deserializer)?;
            Ok(Learnt { friction, eccentricity, torque, inertia })
        }
    }
}
