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
    /// A sum of many numbers: a float itself; in fixed point of twice the width.
    type Total: Copy + Default + PartialEq + core::fmt::Debug;
    /// `total` and the number.
    fn added_to(self, total: Self::Total) -> Self::Total;
    /// A total in the SI unit, or per unit of its base: for calculations between the ticks.
    fn total_to_real(total: Self::Total) -> f64;
}

impl Summed for Fixed {
    type Total = i64;

    #[inline(always)]
    fn added_to(self, total: i64) -> i64 {
        total.wrapping_add(i64::from(self.to_bits()))
    }

    fn total_to_real(total: i64) -> f64 {
        total as f64 / 268_435_456.0
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

            fn total_to_real(total: Self) -> f64 {
                total.into()
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
    /// Sum of the squares of their distances from the bin's middle [2^-12 bin2].
    pub second: u32,
    /// Sum of the motor's torque.
    pub torque: N::Total,
}
