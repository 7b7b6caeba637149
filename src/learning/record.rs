//! Learnt parameters as a part of the record in flash.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What the learners have found: a field of one's own [`Parameters`](crate::parameters::Parameters), or all of them.
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
