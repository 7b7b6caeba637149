//! The reading of a cycle: mean, extremes and delta.

/// A largest or least speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extreme {
    /// Speed (rad/s).
    pub speed: f64,
    /// Where in the cycle, from 0 to less than the cycle's angle (rad).
    pub angle: f64,
}

/// How far a speed swings in a cycle [Notes ch. 5].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fluctuations {
    /// The largest speed.
    pub max: Extreme,
    /// The least speed.
    pub min: Extreme,
    /// (max + min)/2 (rad/s).
    pub arithmetic_mean: f64,
    /// (max - min) over the mean by time.
    pub delta: f64,
    /// (max - min) over the arithmetic mean.
    pub delta_arithmetic: f64,
}

impl Fluctuations {
    /// From the extremes and the mean by time; a delta over no mean at all is infinite or not a number.
    pub fn of(max: Extreme, min: Extreme, mean: f64) -> Self {
        let arithmetic_mean = 0.5 * (max.speed + min.speed);
        let swing = max.speed - min.speed;
        Fluctuations {
            max,
            min,
            arithmetic_mean,
            delta: swing / mean.abs(),
            delta_arithmetic: swing / arithmetic_mean.abs(),
        }
    }
}

/// One cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// Mean by time (rad/s), of motor and load alike; negative backwards.
    pub mean: f64,
    /// The mean less that of the cycle before (rad/s): the part that is not periodic, which a governor mends and a
    /// flywheel does not.
    pub change: Option<f64>,
    /// How long the cycle took (s).
    pub duration: f64,
    /// The motor.
    pub motor: Fluctuations,
    /// The load.
    pub load: Fluctuations,
}
