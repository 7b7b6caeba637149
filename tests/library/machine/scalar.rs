//! Elementary functions against 60-digit arithmetic, and the square root against the processor's.

use driveline::math::{atan2, exp, exp_m1, hypot, ln, sin_cos, sqrt};

use crate::references::data;

fn rows(key: &str) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<String>> = serde_json::from_value(data("elementary.json")[key].clone()).unwrap();
    rows.iter().map(|row| row.iter().map(|x| x.parse().unwrap()).collect()).collect()
}

/// Difference in units of the last place of the expected value.
fn ulps(found: f64, expected: f64) -> f64 {
    let next = f64::from_bits(expected.abs().to_bits() + 1);
    (found - expected).abs() / (next - expected.abs())
}

fn worst(key: &str, limit: f64, apart: impl Fn(&[f64]) -> f64) {
    let worst = rows(key).iter().map(|row| apart(row)).fold(0.0, f64::max);
    println!("{key}: {worst} ulp of the rounded value");
    assert!(worst <= limit, "{key}: {worst} ulp");
}

/// The expected values are themselves rounded: a correct rounding is at 0 ulp, the next number at 1.
#[test]
fn functions_meet_sixty_digits() {
    worst("sqrt", 0.0, |row| ulps(sqrt(row[0]), row[1]));
    // Less than 1 ulp from the truth is at most 1 ulp from its rounding.
    worst("sin_cos", 1.0, |row| ulps(sin_cos(row[0]).0, row[1]).max(ulps(sin_cos(row[0]).1, row[2])));
    worst("exp", 1.0, |row| ulps(exp(row[0]), row[1]));
    worst("exp_m1", 1.0, |row| ulps(exp_m1(row[0]), row[1]));
    // Two halvings with a root each, or a sum with the exponent's share: some three roundings.
    worst("ln", 3.0, |row| ulps(ln(row[0]), row[1]));
    worst("atan2", 3.0, |row| ulps(atan2(row[0], row[1]), row[2]));
}

/// IEEE 754 asks for a correctly rounded square root: the standard library's is the processor's.
#[test]
fn square_root_is_the_processors() {
    // A linear congruential sequence [Knuth, TAOCP 2, §3.3.4] runs through all exponents, subnormal ones too.
    let mut bits = 0x1234_5678_9ABC_DEF1_u64;
    for _ in 0..200_000 {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = f64::from_bits(bits >> 1);
        if x.is_finite() {
            assert_eq!(sqrt(x).to_bits(), x.sqrt().to_bits(), "{x:e}");
        }
    }
    // Squares and their neighbours: the hard cases of rounding.
    for n in 1..50_000_u64 {
        let square = (n * n) as f64;
        for x in [square, f64::from_bits(square.to_bits() - 1), f64::from_bits(square.to_bits() + 1)] {
            assert_eq!(sqrt(x).to_bits(), x.sqrt().to_bits(), "{x:e}");
        }
    }
    assert!(sqrt(-1.0).is_nan() && sqrt(f64::NAN).is_nan());
    assert_eq!(sqrt(0.0), 0.0);
    assert_eq!(sqrt(f64::INFINITY), f64::INFINITY);
}

#[test]
fn edges() {
    assert_eq!(exp(710.0), f64::INFINITY);
    assert_eq!(exp(-746.0), 0.0);
    assert_eq!(exp(0.0), 1.0);
    assert_eq!(exp_m1(-1e3), -1.0);
    assert_eq!(ln(0.0), f64::NEG_INFINITY);
    assert!(ln(-1.0).is_nan() && sin_cos(f64::INFINITY).0.is_nan());
    assert_eq!(atan2(0.0, -1.0), core::f64::consts::PI);
    assert_eq!(atan2(-1.0, 0.0), -core::f64::consts::FRAC_PI_2);
    // 3, 4, 5, where the squares would overflow: a quotient, a root and a product round.
    assert!(ulps(hypot(3e200, -4e200), 5e200) <= 2.0);
}

const COMPILED: [f64; 8] = [
    sqrt(2.0),
    sin_cos(1234.5).0,
    sin_cos(1234.5).1,
    exp(-3.75),
    exp_m1(1e-5),
    ln(0.3),
    atan2(-0.4, -0.7),
    hypot(0.1, 0.2),
];

#[test]
fn compile_time_and_run_time_give_the_same_bits() {
    use std::hint::black_box as b;
    let run = [
        sqrt(b(2.0)),
        sin_cos(b(1234.5)).0,
        sin_cos(b(1234.5)).1,
        exp(b(-3.75)),
        exp_m1(b(1e-5)),
        ln(b(0.3)),
        atan2(b(-0.4), b(-0.7)),
        hypot(b(0.1), b(0.2)),
    ];
    assert_eq!(COMPILED.map(f64::to_bits), run.map(f64::to_bits));
}
