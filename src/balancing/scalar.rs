//! Real and complex numbers of the calculations off the tick.

use nalgebra::RealField;

/// `f32` or `f64`: the same functions on the controller and on the host.
pub trait Scalar: RealField + Copy {
    /// Relative distance from the optimum at which a search ends.
    const CLOSE: f64;
    /// Words that a number takes in a record, one or two.
    const WORDS: usize;
    /// The number as words; unused words are zero.
    fn to_words(self) -> [u32; 2];
    /// The number that has these words.
    fn from_words(words: [u32; 2]) -> Self;
}

impl Scalar for f32 {
    const CLOSE: f64 = 1e-4;
    const WORDS: usize = 1;

    fn to_words(self) -> [u32; 2] {
        [self.to_bits(), 0]
    }

    fn from_words([word, _]: [u32; 2]) -> Self {
        f32::from_bits(word)
    }
}

impl Scalar for f64 {
    const CLOSE: f64 = 1e-10;
    const WORDS: usize = 2;

    fn to_words(self) -> [u32; 2] {
        [(self.to_bits() >> 32) as u32, self.to_bits() as u32]
    }

    fn from_words([high, low]: [u32; 2]) -> Self {
        f64::from_bits(u64::from(high) << 32 | u64::from(low))
    }
}

/// A vibration, a weight or an influence coefficient: amplitude and phase as a complex number.
///
/// ```
/// use driveline::balancing::Complex;
/// // 8 g m at 90 degrees and 6 g m at 0 are 10 g m
/// let sum = Complex::from_polar(8e-3, 90.0_f64.to_radians()) + Complex::new(6e-3, 0.0);
/// assert!((sum.norm() - 10e-3).abs() < 1e-15);
/// ```
pub type Complex<T> = nalgebra::Complex<T>;

pub(crate) fn real<T: Scalar>(value: f64) -> T {
    nalgebra::convert(value)
}

/// Amplitude, without overflow on the way. That of `libm` in `f32` calculates in `f64`.
pub(crate) fn size<T: Scalar>(z: Complex<T>) -> T {
    let (re, im) = (z.re.abs(), z.im.abs());
    let (most, least) = if re < im { (im, re) } else { (re, im) };
    if most > T::zero() {
        let ratio = least / most;
        most * (T::one() + ratio * ratio).sqrt()
    } else {
        // zero, or NaN
        most + least
    }
}

/// Square of the amplitude.
pub(crate) fn square<T: Scalar>(z: Complex<T>) -> T {
    z.re * z.re + z.im * z.im
}

pub(crate) fn zero<T: Scalar>() -> Complex<T> {
    Complex { re: T::zero(), im: T::zero() }
}

/// Whether both parts are numbers.
pub(crate) fn given<T: Scalar>(z: Complex<T>) -> bool {
    z.re.is_finite() && z.im.is_finite()
}

/// Random numbers of a fixed seed.
#[cfg(test)]
pub(crate) mod noise {
    use super::Complex;

    /// Marsaglia's xorshift64 (Journal of Statistical Software 8, 14, 2003).
    pub(crate) struct Noise(u64);

    impl Noise {
        pub(crate) fn new(seed: u64) -> Self {
            Noise(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
        }

        /// Even in -0.5..0.5.
        pub(crate) fn even(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        }

        pub(crate) fn complex(&mut self) -> Complex<f64> {
            Complex { re: self.even(), im: self.even() }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Scalar;

    /// The words of IEEE 754: 1.5 has the exponent's bias, 127 or 1023, and half of the fraction.
    #[test]
    fn numbers_are_their_words() {
        assert_eq!((1.5_f32.to_words(), f32::from_words([0x3fc0_0000, 0])), ([0x3fc0_0000, 0], 1.5));
        assert_eq!((1.5_f64.to_words(), f64::from_words([0x3ff8_0000, 0])), ([0x3ff8_0000, 0], 1.5));
        // with a unit in the last place
        assert_eq!((1.5 + f64::EPSILON).to_words(), [0x3ff8_0000, 1]);
        assert_eq!(f64::from_words([0x3ff8_0000, 1]), 1.5 + f64::EPSILON);
    }
}
