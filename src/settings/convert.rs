//! Coefficients of one number type from those of `f64`.

use crate::number::{Coefficient, Fixed};

/// A constant that a number type cannot hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// A coefficient outside the range of fixed point.
    Coefficient(&'static str),
    /// A value out of the range of its base.
    Value(&'static str),
}

impl Error {
    /// The sentence that names the constant.
    pub const fn message(self) -> &'static str {
        match self {
            Error::Coefficient(sentence) | Error::Value(sentence) => sentence,
        }
    }
}

messages!(Error);

/// Coefficients in fixed point; the error names their parameter.
pub(super) const fn fixed<const K: usize>(values: [f64; K], sentence: &'static str) -> Result<[Coefficient; K], Error> {
    let mut out = [Coefficient::ZERO; K];
    let mut k = 0;
    while k < K {
        match Coefficient::from_f64(values[k]) {
            Some(coefficient) => out[k] = coefficient,
            None => return Err(Error::Coefficient(sentence)),
        }
        k += 1;
    }
    Ok(out)
}

/// A positive value per unit of its base, which does not round to zero; the error names it.
pub(super) const fn per_unit(value: f64, sentence: &'static str) -> Result<Fixed, Error> {
    let fixed = Fixed::from_f64(value);
    if value <= 2.0 && fixed.to_bits() > 0 { Ok(fixed) } else { Err(Error::Value(sentence)) }
}

/// A positive value that a float holds, and not as zero; the error names it.
pub(super) const fn positive(value: f64, sentence: &'static str) -> Result<f64, Error> {
    if value as f32 > 0.0 && (value as f32).is_finite() { Ok(value) } else { Err(Error::Value(sentence)) }
}

/// `new` and `try_new` of constants in each number, with the bases behind their own arguments. The body is that of
/// `try_new`, with [`To`] of the number and the format that the bases give it.
macro_rules! constants {
    (
        $(#[$doc:meta])* impl[$($generic:tt)*] $name:ident[$($rest:tt)*],
        $new:ident, $try_new:ident($($argument:ident: $type:ty),*), |$format:ident| $body:block
    ) => {
        constants! {
            @one f32, [$(#[$doc])*] [$($generic)*] $name [$($rest)*] $new $try_new ($($argument: $type,)*) $format $body
        }
        constants! {
            @one f64, [$(#[$doc])*] [$($generic)*] $name [$($rest)*] $new $try_new ($($argument: $type,)*) $format $body
        }
        constants! {
            @one $crate::number::Fixed,
            [$(#[$doc])*] [$($generic)*] $name [$($rest)*] $new $try_new ($($argument: $type,)*) $format $body
        }
    };
    (
        @one $number:ty, [$($doc:tt)*] [$($generic:tt)*] $name:ident [$($rest:tt)*]
        $new:ident $try_new:ident ($($argument:ident: $type:ty,)*) $format:ident $body:block
    ) => {
        impl<$($generic)*> $name<$number $($rest)*> {
            /// The constants in this number. Floats are in SI units and leave the bases aside.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the error of the `try_` form.
            pub const fn $new($($argument: $type,)* bases: $crate::settings::Bases) -> Self {
                $crate::settings::convert::or_stop!(Self::$try_new($($argument,)* bases))
            }

            /// The constants in this number. Floats are in SI units and leave the bases aside.
            ///
            /// # Errors
            $($doc)*
            pub const fn $try_new(
                $($argument: $type,)* bases: $crate::settings::Bases
            ) -> Result<Self, $crate::settings::Error> {
                #[allow(dead_code)]
                type Number = $number;
                #[allow(dead_code)]
                type To = $crate::settings::to::To<$number>;
                let $format = $crate::settings::convert::get!(To::format(bases));
                $body
            }
        }
    };
}

/// Unwraps a result in a `const fn` that returns one.
macro_rules! get {
    ($result:expr) => {
        match $result {
            Ok(value) => value,
            Err(error) => return Err(error),
        }
    };
}

/// Unwraps a result in a `const fn` that stops the compilation with the error's sentence.
macro_rules! or_stop {
    ($result:expr) => {
        match $result {
            Ok(value) => value,
            Err(error) => error.stop(),
        }
    };
}

pub(super) use {constants, get, or_stop};
