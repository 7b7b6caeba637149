//! Vibration from a slice of conversions, as DMA leaves them.

use driveline::fault::Faults;

use super::{PerCount, Scaled};

/// An accelerometer or a velocity pickup on an ADC. A sample is the mean of the slice that was converted during a tick.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdcVibration<N: Scaled> {
    middle: u16,
    most: u16,
    per_count: PerCount<N>,
    last: Option<u32>,
}

impl<N: Scaled> AdcVibration<N> {
    /// Conversions of 0 to `most`, `middle` where nothing vibrates. `per_count` is the worth of 1/256 of a conversion's
    /// count: the mean is that fine.
    pub const fn new(middle: u16, most: u16, per_count: PerCount<N>) -> Self {
        AdcVibration { middle, most, per_count, last: None }
    }

    /// The mean of the conversions of a tick. `transfers` counts the DMA's transfers: an unchanged count means no new
    /// samples.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_MISSING`] where there is no conversion, or the transfers stand still;
    /// [`Faults::VIBRATION_CLIPPED`] where a conversion is at either end of the range: clipped, or a wire that has
    /// broken.
    pub fn mean(&mut self, conversions: &[u16], transfers: u32) -> Result<N, Faults> {
        let stale = self.last == Some(transfers);
        self.last = Some(transfers);
        let at_end = conversions.iter().any(|&conversion| conversion == 0 || conversion >= self.most);
        let sum = conversions.iter().fold(0_u64, |sum, &conversion| sum.saturating_add(conversion as u64));
        // in 1/256 of a count: of 65,535 at most, so that it fits
        let mean = sum.saturating_mul(256).checked_div(conversions.len() as u64).ok_or(Faults::VIBRATION_MISSING)?;
        if stale {
            return Err(Faults::VIBRATION_MISSING);
        }
        if at_end {
            return Err(Faults::VIBRATION_CLIPPED);
        }
        Ok(self.per_count.times((mean as i32).wrapping_sub((self.middle as i32) << 8)))
    }
}
