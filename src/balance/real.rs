//! The numbers that are calculated with off the tick, and what they lack.

use nalgebra::{ComplexField, RealField};

/// `f32` or `f64`: the same functions on the controller and on the host.
pub trait Real: RealField + Copy {
    /// How close to the optimum a search ends, relative: what is left of the digits after a search.
    const CLOSE: f64;
}

impl Real for f32 {
    const CLOSE: f64 = 1e-4;
}

impl Real for f64 {
    const CLOSE: f64 = 1e-10;
}

/// A vibration, a weight or an influence coefficient: amplitude and phase as a complex number.
pub type Complex<T> = nalgebra::Complex<T>;

/// A constant.
pub(crate) fn real<T: Real>(value: f64) -> T {
    nalgebra::convert(value)
}

/// Amplitude, without overflow on the way.
pub(crate) fn size<T: Real>(z: Complex<T>) -> T {
    z.modulus()
}

/// Square of the amplitude.
pub(crate) fn square<T: Real>(z: Complex<T>) -> T {
    z.re * z.re + z.im * z.im
}

/// Zero.
pub(crate) fn zero<T: Real>() -> Complex<T> {
    Complex { re: T::zero(), im: T::zero() }
}

/// Whether both parts are numbers.
pub(crate) fn given<T: Real>(z: Complex<T>) -> bool {
    z.re.is_finite() && z.im.is_finite()
}
