//! Coefficients of one number type from those of `f64`.

use super::Error;
use crate::number::{Coefficient, Fixed};

/// Coefficients in fixed point; the error names their parameter.
pub(super) const fn fixed<const K: usize>(values: [f64; K], sentence: &'static str) -> Result<[Coefficient; K], Error> {
    let mut out = [Coefficient::ZERO; K];
    each!(k, 0..K, {
        match Coefficient::from_f64(values[k]) {
            Some(coefficient) => out[k] = coefficient,
            None => return Err(Error::Coefficient(sentence)),
        }
    });
    Ok(out)
}

/// A positive value per unit of its base, which does not round to zero; the error names it.
pub(super) const fn per_unit(value: f64, sentence: &'static str) -> Result<Fixed, Error> {
    let fixed = Fixed::from_f64(value);
    if value <= 2.0 && fixed.to_bits() > 0 { Ok(fixed) } else { Err(Error::Value(sentence)) }
}

/// A positive value that a float holds with all its digits; the error names it.
pub(super) const fn positive(value: f64, sentence: &'static str) -> Result<f64, Error> {
    if value as f32 >= f32::MIN_POSITIVE && (value as f32).is_finite() {
        Ok(value)
    } else {
        Err(Error::Value(sentence))
    }
}
