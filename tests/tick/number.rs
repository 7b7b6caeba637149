//! Operations of the numbers.

use driveline::number::{Coefficient, Fixed, Magnitude};
use driveline::observer::Gap;

fn fixed(bits: i32) -> Fixed {
    Fixed::from_bits(bits)
}

#[test]
fn a_fixed_number_knows_its_flank() {
    for (number, flank) in [(5, 1000), (0, 1000), (-1, -1000), (i32::MIN, -1000), (i32::MAX, 1000)] {
        assert_eq!(fixed(number).flank(fixed(1000)), fixed(flank), "{number}");
    }
    for (one, other) in [(7, 3), (-7, -3), (i32::MAX, 1), (i32::MIN, -1)] {
        assert!(!fixed(one).opposes(fixed(one)), "{one}");
        assert!(!fixed(one).opposes(fixed(other)) && fixed(one).opposes(fixed(-other)), "{one} {other}");
    }
}

/// Four times x^2/travel: the share of the tick has 12 binary places, and the travel loses its last 12.
#[test]
fn how_far_a_motion_has_passed_a_flank() {
    for side in [1, -1] {
        for (number, travel) in [(1 << 26, 1 << 27), (3 << 22, 1 << 27), (1 << 27, 1 << 27), (1 << 24, 3 << 24)] {
            let (x, full) = (f64::from(number), f64::from(travel));
            let passed = f64::from(fixed(side * number).passed(fixed(side * travel)).to_bits());
            // a place of the share, and the travel's divisor of at least 2^15 that is one too large
            let error = 4.0 * x * (1.0 / 4096.0 + x / full / 32_768.0);
            assert!(
                (passed - f64::from(side) * 4.0 * x * x / full).abs() <= 1.01 * error,
                "{number} {travel}: {passed}"
            );
        }
    }
}

/// No travel is divided by zero, however short; what has passed is on the motion's side.
#[test]
fn a_short_travel_has_passed_something() {
    for travel in [1000, 4500, 8000, 20_000] {
        assert!(fixed(travel).passed(fixed(travel)).to_bits() > 0, "{travel}");
        assert!(fixed(-travel).passed(fixed(-travel)).to_bits() < 0, "-{travel}");
    }
}

/// A factor as a plain number, in three types: its size, the factor of a size, and a change by half.
fn plain<T: Magnitude + Copy + PartialEq + core::fmt::Debug>(quarter: T, of: impl Fn(f64) -> T) {
    assert_eq!(of(-0.25).magnitude(), quarter.magnitude());
    assert_eq!(of(0.125).magnitude() / quarter.magnitude(), 0.5);
    assert_eq!((T::of(0.25), T::of(-0.125)), (quarter, of(-0.125)));
    assert_eq!((quarter.scaled(1.5), of(-0.25).scaled(0.5)), (of(0.375), of(-0.125)));
    assert_eq!((quarter.scaled(1.0), quarter.scaled(0.0)), (quarter, of(0.0)));
}

#[test]
fn a_factor_is_scaled_as_a_plain_number() {
    plain(0.25_f32, |value| value as f32);
    plain(0.25_f64, |value| value);
    plain(Coefficient::from_f64(0.25).unwrap(), |value| Coefficient::from_f64(value).unwrap());
    // at the end of its range beyond it
    assert_eq!(Coefficient::of(0.75), Coefficient::from_bits(i32::MAX));
    assert_eq!(Coefficient::of(-0.25).scaled(2.0), Coefficient::of(-0.5));
}
