//! What a number type makes of values and coefficients in `f64`.

use core::marker::PhantomData;

use super::convert::{fixed, per_unit, positive};
use super::settled::{settled, unit_single};
use super::{Bases, Error, Format};
use crate::number::{Coefficient, Fixed, INNOVATION_RANGE, TURN_SHIFT};

/// Conversion to a number.
pub(super) struct To<N>(PhantomData<N>);

macro_rules! float {
    ($float:ident, |$pair:ident| $settled:expr) => {
        impl To<$float> {
            pub(super) const fn format(_: Bases) -> Result<Format, Error> {
                Ok(Format::FLOAT)
            }

            /// A number, finite.
            pub(super) const fn number(value: f64, sentence: &'static str) -> Result<$float, Error> {
                if (value as $float).is_finite() { Ok(value as $float) } else { Err(Error::Value(sentence)) }
            }

            pub(super) const fn numbers<const K: usize>(
                values: [f64; K],
                sentence: &'static str,
            ) -> Result<[$float; K], Error> {
                let mut out = [0.0; K];
                each!(k, 0..K, {
                    out[k] = get!(Self::number(values[k], sentence));
                });
                Ok(out)
            }

            /// A number within the headroom.
            pub(super) const fn exactly(value: f64, sentence: &'static str) -> Result<$float, Error> {
                Self::number(value, sentence)
            }

            /// A positive number.
            pub(super) const fn positive(value: f64, sentence: &'static str) -> Result<$float, Error> {
                Ok(get!(positive(value, sentence)) as $float)
            }

            /// An angle (2^-32 turn).
            pub(super) const fn angle(value: f64, sentence: &'static str) -> Result<$float, Error> {
                Self::number(value, sentence)
            }

            /// The turn of a tick (2^-32 turn), as `less_turn` takes it.
            pub(super) const fn turn(value: f64, sentence: &'static str) -> Result<$float, Error> {
                Self::number(value, sentence)
            }

            /// The gain that brings a gear to rest.
            pub(super) const fn stiction(value: f64) -> $float {
                value as $float
            }

            pub(super) const fn coefficient(value: f64, sentence: &'static str) -> Result<$float, Error> {
                let [coefficient] = get!(Self::coefficients([value], sentence));
                Ok(coefficient)
            }

            pub(super) const fn coefficients<const K: usize>(
                values: [f64; K],
                sentence: &'static str,
            ) -> Result<[$float; K], Error> {
                let mut out = [0.0; K];
                each!(k, 0..K, {
                    out[k] = values[k] as $float;
                    if !out[k].is_finite() {
                        return Err(Error::Coefficient(sentence));
                    }
                });
                Ok(out)
            }

            /// The coefficients of the twist's free motion.
            pub(super) const fn pair($pair: [f64; 4], sentence: &'static str) -> Result<[$float; 4], Error> {
                get!(Self::coefficients($pair, sentence));
                Self::coefficients($settled, sentence)
            }
        }
    };
}

float!(f32, |pair| {
    let [a, b, c, d] = pair;
    let rounded = [a as f32 as f64, b as f32 as f64, c as f32 as f64, d as f32 as f64];
    settled(pair, rounded, [unit_single(a), unit_single(b), unit_single(c), unit_single(d)])
});
float!(f64, |pair| pair);

impl To<Fixed> {
    pub(super) const fn format(bases: Bases) -> Result<Format, Error> {
        get!(bases.check());
        Ok(Format::fixed(bases))
    }

    /// A number within twice its base.
    pub(super) const fn number(value: f64, sentence: &'static str) -> Result<Fixed, Error> {
        if value.abs() <= 2.0 { Ok(Fixed::from_f64(value)) } else { Err(Error::Value(sentence)) }
    }

    pub(super) const fn numbers<const K: usize>(values: [f64; K], sentence: &'static str) -> Result<[Fixed; K], Error> {
        let mut out = [Fixed::from_bits(0); K];
        each!(k, 0..K, {
            out[k] = get!(Self::number(values[k], sentence));
        });
        Ok(out)
    }

    /// A number within the headroom.
    pub(super) const fn exactly(value: f64, _: &'static str) -> Result<Fixed, Error> {
        Ok(Fixed::from_f64(value))
    }

    /// A positive number within twice its base.
    pub(super) const fn positive(value: f64, sentence: &'static str) -> Result<Fixed, Error> {
        per_unit(value, sentence)
    }

    /// An angle (2^-32 turn).
    pub(super) const fn angle(value: f64, sentence: &'static str) -> Result<Fixed, Error> {
        if value > INNOVATION_RANGE { Err(Error::Value(sentence)) } else { Ok(Fixed::from_bits(value as i32)) }
    }

    /// The turn of a tick (2^-32 turn), as `less_turn` takes it.
    pub(super) const fn turn(value: f64, sentence: &'static str) -> Result<Fixed, Error> {
        Ok(Fixed::from_bits(get!(Self::angle(value, sentence)).to_bits() >> TURN_SHIFT))
    }

    pub(super) const fn stiction(_: f64) {}

    pub(super) const fn coefficient(value: f64, sentence: &'static str) -> Result<Coefficient, Error> {
        let [coefficient] = get!(fixed([value], sentence));
        Ok(coefficient)
    }

    pub(super) const fn coefficients<const K: usize>(
        values: [f64; K],
        sentence: &'static str,
    ) -> Result<[Coefficient; K], Error> {
        fixed(values, sentence)
    }

    /// The coefficients of the twist's free motion: settled times what the operand is widened by, and back.
    pub(super) const fn pair(pair: [f64; 4], sentence: &'static str) -> Result<[Coefficient; 4], Error> {
        let [a, b, c, d] = get!(fixed(pair, sentence));
        let (wide, unit) = (4.0, 4.0 / 4_294_967_296.0);
        let rounded = [wide * a.to_f64(), wide * b.to_f64(), wide * c.to_f64(), wide * d.to_f64()];
        let exact = [wide * pair[0], wide * pair[1], wide * pair[2], wide * pair[3]];
        let [a, b, c, d] = settled(exact, rounded, [unit; 4]);
        fixed([a / wide, b / wide, c / wide, d / wide], sentence)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest angle, 2^26 - 1, is in range.
    #[test]
    fn an_angle_in_fixed_point() {
        let angle = |value: f64| To::<Fixed>::angle(value, "beyond").map(Fixed::to_bits);
        assert_eq!(angle(INNOVATION_RANGE), Ok(67_108_863));
        assert_eq!(angle(67_108_864.0), Err(Error::Value("beyond")));
    }

    /// A turn of the pair, its poles on the unit circle, over four: of the neighbours of the nearest coefficients, in
    /// units of 2^-32, none has a determinant between that of the pair taken and one.
    #[test]
    fn a_pair_in_fixed_point_does_not_grow() {
        const UNIT: f64 = 1.0 / 4_294_967_296.0;
        // determinant of 1 + N, less one
        let growth = |quarters: [f64; 4]| {
            let [a, b, c, d] = quarters.map(|quarter| 4.0 * quarter);
            a + d + (a * d - b * c)
        };
        for step in 1..20 {
            let (sine, cosine) = (0.15 * f64::from(step)).sin_cos();
            let exact = [cosine - 1.0, -sine, sine, cosine - 1.0].map(|value| value / 4.0);
            let found = To::<Fixed>::pair(exact, "beyond").unwrap().map(Coefficient::to_f64);
            let limit = growth(exact);
            assert!(growth(found) <= limit, "{step}: {found:?}");
            let nearest = exact.map(|value| (value / UNIT).round() * UNIT);
            for k in 0..81 {
                let offsets = [k % 3, k / 3 % 3, k / 9 % 3, k / 27];
                let other = core::array::from_fn(|i| nearest[i] + (f64::from(offsets[i]) - 1.0) * UNIT);
                assert!(growth(other) <= growth(found) || growth(other) > limit, "{step}: {other:?} {found:?}");
            }
            assert!((0..4).all(|i| (found[i] - nearest[i]).abs() <= UNIT), "{step}: {found:?}");
        }
    }
}
