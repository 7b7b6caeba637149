//! The bins of a cycle.

use super::CycleConfig;
use crate::number::{Fixed, Number};

/// Constants of [`super::Waveform`]. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WaveformConfig {
    /// The cycle.
    pub cycle: CycleConfig,
    /// Cycles in a window; fewer where they last too long.
    pub cycles: u32,
    /// Bins per 2^-32 turn [2^-50].
    pub scale: i32,
    /// Bins in a segment of the cycle.
    pub per_segment: u32,
}

/// Sums of many numbers, beside the operations of [`Number`].
pub trait Summed: Number {
    /// A sum of many numbers: a float itself; in fixed point two words, the lower one first. As one number of twice the
    /// width it would leave a gap in a bin, and emptying the bins would take a store for each of their fields.
    type Total: Copy + Default + PartialEq + core::fmt::Debug;
    /// `total` and the number.
    fn added_to(self, total: Self::Total) -> Self::Total;
    /// A total in the SI unit, or per unit of its base: for calculations between the ticks.
    fn total_to_real(total: Self::Total) -> Self::Real;
}

impl Summed for Fixed {
    type Total = [u32; 2];

    #[inline(always)]
    fn added_to(self, [low, high]: [u32; 2]) -> [u32; 2] {
        let total = u64::from(high) << 32 | u64::from(low);
        let total = total.wrapping_add_signed(i64::from(self.to_bits()));
        [total as u32, (total >> 32) as u32]
    }

    fn total_to_real([low, high]: [u32; 2]) -> f32 {
        (u64::from(high) << 32 | u64::from(low)) as i64 as f32 * (1.0 / 268_435_456.0)
    }
}

macro_rules! summed {
    ($float:ident) => {
        impl Summed for $float {
            type Total = $float;

            #[inline(always)]
            fn added_to(self, total: Self) -> Self {
                total + self
            }

            fn total_to_real(total: Self) -> Self {
                total
            }
        }
    };
}

summed!(f32);
summed!(f64);

/// Content of a bin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bin<N: Summed> {
    /// Ticks.
    pub ticks: u32,
    /// Sum of their distances from the bin's middle [2^-10 bin].
    pub first: i32,
    /// Sum of the squares of their distances from the bin's middle [2^-16 bin2]; without meaning beyond 2^18 ticks.
    pub second: u32,
    /// Sum of the motor's torque.
    pub torque: N::Total,
}
