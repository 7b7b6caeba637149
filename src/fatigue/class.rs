//! Classes of the torque.

use crate::number::{Fixed, Number};

/// Equal classes of the torque, from minus a limit to the limit. What is beyond counts in the outermost, with the
/// damage of that one: [`Counts::exceeds_classes`](super::Counts::exceeds_classes).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueClasses<N: Classed> {
    pub(super) scale: N::Scale,
    /// Width of a class (N m).
    pub(super) width: f64,
    /// Base of torques (N m); 1 for floats.
    pub(super) base: f64,
    /// Time between two ticks (s); 1 where it is left in ticks.
    pub(super) period: f64,
}

impl<N: Classed> TorqueClasses<N> {
    /// Width of a class (N m).
    pub const fn width(&self) -> f64 {
        self.width
    }

    /// The same with the time between two ticks (s).
    #[must_use]
    pub const fn with_period(self, period: f64) -> Self {
        TorqueClasses { period, ..self }
    }
}

/// Sorting into classes, beside the operations of [`Number`].
pub trait Classed: Number {
    /// Factor from a torque to quarters of a class.
    type Scale: Copy + PartialEq + core::fmt::Debug;

    /// The torque in quarters of a class above the lowest class, rounded down, within the classes; a NaN has none.
    fn quarters<const CLASSES: usize>(self, scale: Self::Scale) -> i32;
}

const LIMIT: &str = "the limit of the torque's classes must be positive and finite (N m), in fixed point at least \
    1/512 and at most 8 bases";
pub(super) const COUNT: &str = "the classes of the torque must be a power of two from 4 to 128";

const fn checked(limit: f64, classes: usize) -> f64 {
    assert!(limit > 0.0 && limit.is_finite(), "{}", LIMIT);
    assert!(classes.is_power_of_two() && classes >= 4 && classes <= 128, "{}", COUNT);
    2.0 * limit / classes as f64
}

macro_rules! classed {
    ($float:ident) => {
        impl Classed for $float {
            type Scale = $float;

            // A cast rounds towards zero, down within the classes; it saturates, and takes a NaN for zero.
            #[inline(always)]
            fn quarters<const CLASSES: usize>(self, scale: $float) -> i32 {
                let quarters = self * scale + const { (2 * CLASSES) as $float };
                (quarters as i32).clamp(0, const { 4 * CLASSES as i32 - 1 })
            }
        }

        impl TorqueClasses<$float> {
            /// `CLASSES` classes between `-limit` and `limit` (N m).
            ///
            /// # Panics
            /// At compile time in a constant: for a limit that is not positive and finite, or a number of classes that
            /// is no power of two from 4 to 128.
            #[must_use]
            pub const fn new<const CLASSES: usize>(limit: f64) -> Self {
                let width = checked(limit, CLASSES);
                TorqueClasses { scale: (4.0 / width) as $float, width, base: 1.0, period: 1.0 }
            }
        }
    };
}

classed!(f32);
classed!(f64);

/// Binary places of the factor to quarters of a class in fixed point; 2^28 are a base, and a class is 2^13 of them at
/// least.
const PLACES: u32 = 42;

impl Classed for Fixed {
    type Scale = i32;

    #[inline(always)]
    fn quarters<const CLASSES: usize>(self, scale: i32) -> i32 {
        let half = const { 2 * CLASSES as i32 };
        let quarters = ((i64::from(self.to_bits()) * i64::from(scale)) >> 32) as i32 >> (PLACES - 32);
        // clamped before it is shifted: one instruction
        quarters.clamp(-half, half - 1).wrapping_add(half)
    }
}

impl TorqueClasses<Fixed> {
    /// `CLASSES` classes between `-limit` and `limit` (N m), of torques with this base (N m).
    ///
    /// # Panics
    /// At compile time in a constant: for a limit below 1/512 of the base or beyond eight bases, or a number of classes
    /// that is no power of two from 4 to 128.
    #[must_use]
    pub const fn new<const CLASSES: usize>(limit: f64, base: f64) -> Self {
        let width = checked(limit, CLASSES);
        let scale = base / width * 65_536.0;
        assert!(scale >= 1.0 && scale <= i32::MAX as f64 && limit <= 8.0 * base, "{}", LIMIT);
        TorqueClasses { scale: (scale + 0.5) as i32, width, base, period: 1.0 }
    }
}
