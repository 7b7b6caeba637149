//! S-N (Wöhler) curves: cycles to failure against the torque's amplitude.

use crate::math::{exp, ln};

/// An S-N (Wöhler) curve, straight on logarithmic scales with a knee.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("S-N curve", "Wöhler"))]
pub struct WoehlerLine {
    /// Amplitude at the knee (N m), half of a cycle's range.
    pub knee: f64,
    /// Cycles to failure there.
    pub cycles: f64,
    /// Slope k above the knee: half the amplitude lasts 2^k times as long.
    pub slope: f64,
    /// Slope below it: the same for Miner's elementary rule, `2 k - 1` for Haibach's; infinite where nothing below the
    /// knee does damage.
    pub below: f64,
}

impl WoehlerLine {
    /// Damage of a cycle of this amplitude (N m); NaN for a curve whose numbers are none.
    #[must_use]
    pub const fn damage(&self, amplitude: f64) -> f64 {
        let share = amplitude / self.knee;
        if share <= 0.0 {
            return 0.0;
        }
        let slope = if share < 1.0 { self.below } else { self.slope };
        exp(slope * ln(share)) / self.cycles
    }
}
