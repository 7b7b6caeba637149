//! Constants of the composed governor's parts that are shapes: barred ranges, torque curves, and the slew round another
//! limit.

use super::convert::{get, or_stop};
use super::governor_parts::{LIMIT, RAMP, Values, all_finite, between, in_fixed, least_step};
use super::{Bases, Error, Format};
use crate::design::{BarredSpeeds, TorqueCurve};
use crate::governor::{BarredConfig, CurveConfig, CurvePiece, SlewConfig, SpeedRange};
use crate::number::{Coefficient, Fixed};

const SLEW: &str =
    "the slew of the torque must be positive and finite, and within a tick at most twice the base of the torque";
const CURVE: &str = "the torque curve must lie within twice the bases in fixed point, and its slopes within 2 bases of \
    the torque per base of the speed";
const BARRED: &str = "the barred ranges must be as many as the governor has and lie within twice the base of the speed";

const fn slew(rate: f64, period: f64, format: &Format) -> Values<1, 0> {
    let step = rate * period / format.bases.torque;
    if step * format.unit >= least_step(format) && all_finite(&[step]) {
        Ok(([step], []))
    } else {
        Err(Error::Value(SLEW))
    }
}

const fn piece<const K: usize>(curve: &TorqueCurve<K>, k: usize, format: &Format) -> Values<2, 1> {
    let points = curve.points();
    let Bases { torque, speed, .. } = format.bases;
    let [at, most] = points[k];
    let slope = if k + 1 < K {
        let [next, then] = points[k + 1];
        (then - most) / (next - at)
    } else {
        0.0
    };
    Ok(([at / speed, most / torque], [slope * speed / (torque * format.widened)]))
}

const fn range<const K: usize>(barred: &BarredSpeeds<K>, k: usize, format: &Format) -> Values<2, 0> {
    let ranges = barred.ranges();
    if k >= ranges.len() {
        return Err(Error::Value(BARRED));
    }
    let ([low, high], speed) = (ranges[k], format.bases.speed);
    Ok(([0.5 * (low + high) / speed, 0.5 * (high - low) / speed], []))
}

const fn quick(rate: f64, period: f64, format: &Format) -> Values<1, 0> {
    let step = rate * period / format.bases.speed;
    if step * format.unit >= least_step(format) && all_finite(&[step]) {
        Ok(([step], []))
    } else {
        Err(Error::Value(RAMP))
    }
}

macro_rules! float_arrays {
    ($float:ident) => {
        impl<const K: usize> BarredConfig<$float, K> {
            /// The constants as floats.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(barred: &BarredSpeeds<K>, quick_ramp: f64, period: f64, bases: Bases) -> Self {
                or_stop!(Self::try_new(barred, quick_ramp, period, bases))
            }

            /// The constants as floats.
            ///
            /// # Errors
            /// [`Error::Value`] for other than `K` ranges, or a quick ramp [rad/s2] that is not positive and finite.
            pub const fn try_new(
                barred: &BarredSpeeds<K>,
                quick_ramp: f64,
                period: f64,
                _: Bases,
            ) -> Result<Self, Error> {
                let format = Format::FLOAT;
                let ([step], []) = get!(quick(quick_ramp, period, &format));
                let mut ranges = [SpeedRange { middle: 0.0, half: 0.0 }; K];
                let mut k = 0;
                while k < K {
                    let ([middle, half], []) = get!(range(barred, k, &format));
                    ranges[k] = SpeedRange { middle: middle as $float, half: half as $float };
                    k += 1;
                }
                Ok(BarredConfig { ranges, quick: step as $float })
            }
        }

        impl<const K: usize> CurveConfig<$float, K> {
            /// The constants as floats; `min` is the smallest torque, zero or below [N m].
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(curve: &TorqueCurve<K>, min: f64, bases: Bases) -> Self {
                or_stop!(Self::try_new(curve, min, bases))
            }

            /// The constants as floats; `min` is the smallest torque, zero or below [N m].
            ///
            /// # Errors
            /// [`Error::Value`] for a least torque above zero or not finite.
            pub const fn try_new(curve: &TorqueCurve<K>, min: f64, _: Bases) -> Result<Self, Error> {
                let format = Format::FLOAT;
                let ([min, _], []) = get!(between(min, 1.0, &format));
                let mut pieces = [CurvePiece::<$float> { speed: 0.0, torque: 0.0, slope: 0.0 }; K];
                let mut k = 0;
                while k < K {
                    let ([speed, torque], [slope]) = get!(piece(curve, k, &format));
                    pieces[k] = CurvePiece { speed: speed as $float, torque: torque as $float, slope: slope as $float };
                    k += 1;
                }
                Ok(CurveConfig { pieces, min: min as $float })
            }
        }

        impl<L: Copy> SlewConfig<$float, L> {
            /// The constants as floats: torque per time [N m/s], the other limit, and the period of a tick \[s\].
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(rate: f64, limit: L, period: f64, bases: Bases) -> Self {
                or_stop!(Self::try_new(rate, limit, period, bases))
            }

            /// The constants as floats.
            ///
            /// # Errors
            /// [`Error::Value`] for a rate that is not positive and finite.
            pub const fn try_new(rate: f64, limit: L, period: f64, _: Bases) -> Result<Self, Error> {
                let ([step], []) = get!(slew(rate, period, &Format::FLOAT));
                Ok(SlewConfig { step: step as $float, limit })
            }
        }
    };
}

float_arrays!(f32);
float_arrays!(f64);

impl<const K: usize> BarredConfig<Fixed, K> {
    /// The constants in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(barred: &BarredSpeeds<K>, quick_ramp: f64, period: f64, bases: Bases) -> Self {
        or_stop!(Self::try_new(barred, quick_ramp, period, bases))
    }

    /// The constants in fixed point.
    ///
    /// # Errors
    /// [`Error::Value`] for other than `K` ranges, one beyond twice the base of the speed, or a quick ramp [rad/s2]
    /// that is not positive and finite.
    pub const fn try_new(barred: &BarredSpeeds<K>, quick_ramp: f64, period: f64, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let format = Format::fixed(bases);
        let ([quick], []) = get!(in_fixed(quick(quick_ramp, period, &format), RAMP));
        let mut ranges = [SpeedRange { middle: Fixed::from_bits(0), half: Fixed::from_bits(0) }; K];
        let mut k = 0;
        while k < K {
            let ([middle, half], []) = get!(in_fixed(range(barred, k, &format), BARRED));
            ranges[k] = SpeedRange { middle, half };
            k += 1;
        }
        Ok(BarredConfig { ranges, quick })
    }
}

impl<const K: usize> CurveConfig<Fixed, K> {
    /// The constants in fixed point; `min` is the smallest torque, zero or below [N m].
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(curve: &TorqueCurve<K>, min: f64, bases: Bases) -> Self {
        or_stop!(Self::try_new(curve, min, bases))
    }

    /// The constants in fixed point; `min` is the smallest torque, zero or below [N m].
    ///
    /// # Errors
    /// [`Error`] for a least torque above zero, a point beyond twice its base, or a slope of 2 bases of the torque per
    /// base of the speed or more.
    pub const fn try_new(curve: &TorqueCurve<K>, min: f64, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let format = Format::fixed(bases);
        let ([min, _], []) = get!(in_fixed(between(min, bases.torque, &format), LIMIT));
        let mut pieces =
            [CurvePiece { speed: Fixed::from_bits(0), torque: Fixed::from_bits(0), slope: Coefficient::ZERO }; K];
        let mut k = 0;
        while k < K {
            let ([speed, torque], [slope]) = get!(in_fixed(piece(curve, k, &format), CURVE));
            pieces[k] = CurvePiece { speed, torque, slope };
            k += 1;
        }
        Ok(CurveConfig { pieces, min })
    }
}

impl<L: Copy> SlewConfig<Fixed, L> {
    /// The constants in fixed point: torque per time [N m/s], the other limit, and the period of a tick \[s\].
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(rate: f64, limit: L, period: f64, bases: Bases) -> Self {
        or_stop!(Self::try_new(rate, limit, period, bases))
    }

    /// The constants in fixed point.
    ///
    /// # Errors
    /// [`Error::Value`] for a rate that is not positive and finite, or twice the base of the torque in a tick.
    pub const fn try_new(rate: f64, limit: L, period: f64, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let ([step], []) = get!(in_fixed(slew(rate, period, &Format::fixed(bases)), SLEW));
        Ok(SlewConfig { step, limit })
    }
}
