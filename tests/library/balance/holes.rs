//! Weights for real holes against all that could have been chosen.

use std::f64::consts::TAU;

use driveline::balancing::{Complex, CorrectionMethod, Error, Holes};

use crate::noise::Noise;

/// The best of every pair of holes, with every pair of weights.
fn exhaustive(angles: &[f64], weights: &[f64], target: Complex<f64>) -> f64 {
    let mut all = weights.to_vec();
    all.push(0.0);
    let mut best = target.norm();
    for a in angles {
        for b in angles {
            for x in &all {
                // one hole takes one weight
                for y in all.iter().filter(|y| a != b || **y == 0.0) {
                    best = best.min((target - Complex::from_polar(*x, *a) - Complex::from_polar(*y, *b)).norm());
                }
            }
        }
    }
    best
}

#[test]
fn as_good_as_any_choice() {
    let mut noise = Noise::new(9);
    let angles: Vec<f64> = (0..12).map(|hole| f64::from(hole) * TAU / 12.0 + 0.1).collect();
    let weights = [1.0, 2.0, 3.0, 5.0, 8.0, 13.0];
    for trial in 0..200 {
        let target = Complex::from_polar(0.5 + 12.0 * noise.even(), TAU * noise.even());
        let mode = if trial % 2 == 0 { CorrectionMethod::Adding } else { CorrectionMethod::Removing };
        let fitted = Holes { angles: &angles, weights: &weights, method: mode }.fit(target).unwrap();
        let sign = if mode == CorrectionMethod::Adding { 1.0 } else { -1.0 };
        let sum: Complex<f64> = fitted.holes.iter().map(|(hole, w)| Complex::from_polar(sign * w, angles[*hole])).sum();
        assert!((sum - fitted.sum).norm() < 1e-12);
        assert!(fitted.holes.iter().all(|(_, w)| *w == 0.0 || weights.contains(w)));
        let best = exhaustive(&angles, &weights, target * sign);
        let got = (target - fitted.sum).norm();
        // rounding of sums of two weights of up to 13
        assert!((got - best).abs() < 1e-12, "{got} {best}");
    }
}

proptest::proptest! {
    /// Any holes and weights: as good as the best of all pairs, and no worse for a hole or a weight more.
    #[test]
    fn more_to_choose_from_is_never_worse(
        angles in proptest::collection::vec(0.0..360.0_f64, 1..7),
        weights in proptest::collection::vec(0.1..5.0_f64, 1..5),
        hole in 0.0..360.0_f64,
        more in 0.1..5.0_f64,
        wanted in (0.1..8.0_f64, 0.0..360.0_f64),
    ) {
        let wanted = Complex::from_polar(wanted.0, wanted.1.to_radians());
        let angles: Vec<f64> = angles.iter().map(|angle| angle.to_radians()).collect();
        let left = |angles: &[f64], weights: &[f64]| {
            let fitted = Holes { angles, weights, method: CorrectionMethod::Adding }.fit(wanted);
            fitted.map_or(f64::INFINITY, |fitted| (wanted - fitted.sum).norm())
        };
        let few = left(&angles, &weights);
        // rounding, 2^-52 of the weights, 64 times over
        let rounding = 1e-12;
        proptest::prop_assert!(few.is_infinite() || (few - exhaustive(&angles, &weights, wanted)).abs() < rounding);
        proptest::prop_assert!(left(&[&angles[..], &[hole.to_radians()]].concat(), &weights) <= few + rounding);
        proptest::prop_assert!(left(&angles, &[&weights[..], &[more]].concat()) <= few + rounding);
    }
}

/// Four uneven holes, and a fifth that used to keep the search from the best pair of the four.
#[test]
fn a_fifth_hole_is_no_harm() {
    let four: Vec<f64> = [0.0, 100.0, 200.0, 300.0].iter().map(|degrees: &f64| degrees.to_radians()).collect();
    let five = [&four[..], &[310_f64.to_radians()]].concat();
    let weights = [1.0, 2.0, 3.0, 5.0];
    for degrees in 0..360 {
        let wanted = Complex::from_polar(2.5, f64::from(degrees).to_radians());
        let left = |angles: &[f64]| {
            let fitted = Holes { angles, weights: &weights, method: CorrectionMethod::Adding }.fit(wanted).unwrap();
            (wanted - fitted.sum).norm()
        };
        assert!(left(&five) <= left(&four) + 1e-12, "{degrees}");
    }
}

#[test]
fn holes_that_cannot_be_are_refused() {
    for (angles, weights) in [([0.0, 1.0], [1.0, -1.0]), ([0.0, f64::NAN], [1.0, 2.0])] {
        let holes = Holes { angles: &angles, weights: &weights, method: CorrectionMethod::Adding };
        assert_eq!(holes.fit(Complex::new(1.0, 0.0)), Err(Error::Setting { index: 1 }));
    }
}
