//! A typical indicator diagram, for an engine whose own was not measured.

use core::f64::consts::PI;

use super::WorkingCycle;
use crate::machine::error::positive;
use crate::machine::{CrankSlider, Error};
use crate::math::{exp, ln};

/// Pressure of the crankcase: the standard atmosphere (Pa).
const CRANKCASE: f64 = 101_325.0;

/// The cycle with combustion at constant volume: polytropic compression from the charge pressure, a rise to the peak
/// pressure at the dead centre, polytropic expansion, and charge pressure for the rest of the cycle \[derived\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Indicator {
    /// Compression ratio, above 1.
    pub compression: f64,
    /// Polytropic exponent of compression and expansion, above 1: about 1.3.
    pub exponent: f64,
    /// Charge pressure, absolute (Pa).
    pub charge: f64,
    /// Peak pressure, absolute (Pa), above that of the compression alone.
    pub peak: f64,
}

impl Indicator {
    /// Whether all is in its range.
    ///
    /// # Errors
    /// [`Error::Indicator`].
    pub const fn check(&self) -> Result<(), Error> {
        let ratios = self.compression > 1.0 && self.exponent > 1.0 && positive(self.charge) && positive(self.peak);
        // infinite and not-a-number ratios have no finite compression pressure
        if ratios && self.peak > self.charge * exp(self.exponent * ln(self.compression)) {
            Ok(())
        } else {
            Err(Error::Indicator)
        }
    }

    /// Pressure above the crankcase's (Pa) at `M` equidistant crank angles over a cycle, the first at the firing dead
    /// centre: the input of [`CrankSlider::gas_torque`]. The crankcase has the standard atmosphere.
    ///
    /// The orders err by `h^2/12` of the torque's kink at the firing dead centre, h the step: 4e-5 of the mean torque
    /// for a diesel's four strokes in 1440 steps.
    #[must_use]
    pub const fn sample<const M: usize>(&self, crank: &CrankSlider, cycle: WorkingCycle) -> [f64; M] {
        let mut pressure = [self.charge - CRANKCASE; M];
        each!(j, 0..M, {
            let whole = cycle.angle();
            let angle = whole * (j as f64 / M as f64);
            let volume = 1.0 + (self.compression - 1.0) * crank.travel(angle).travel / (2.0 * crank.radius.0);
            if angle < PI {
                pressure[j] = self.peak * exp(-self.exponent * ln(volume)) - CRANKCASE;
            } else if angle > whole - PI {
                pressure[j] = self.charge * exp(self.exponent * ln(self.compression / volume)) - CRANKCASE;
            }
        });
        pressure
    }
}
