//! Weights for real holes against all that could have been chosen.

use std::f64::consts::TAU;

use driveline::balance::{Complex, Holes, Mode, Refusal};

use crate::noise::Noise;

/// The best of every pair of holes within a quarter turn, with every pair of weights.
fn exhaustive(angles: &[f64], weights: &[f64], target: Complex<f64>) -> f64 {
    let mut all = weights.to_vec();
    all.push(0.0);
    let mut best = target.norm();
    for a in angles {
        for b in angles.iter().filter(|b| (a - *b).cos() > -1e-6) {
            for x in &all {
                // one hole takes one weight
                for y in all.iter().filter(|_| a != b) {
                    best = best.min((target - Complex::from_polar(*x, *a) - Complex::from_polar(*y, *b)).norm());
                }
            }
        }
    }
    best
}

#[test]
fn nearly_as_good_as_any_choice() {
    let mut noise = Noise::new(9);
    let angles: Vec<f64> = (0..12).map(|hole| f64::from(hole) * TAU / 12.0 + 0.1).collect();
    let weights = [1.0, 2.0, 3.0, 5.0, 8.0, 13.0];
    let (mut off, mut least) = (0.0, 0.0);
    for trial in 0..200 {
        let target = Complex::from_polar(0.5 + 12.0 * noise.even(), TAU * noise.even());
        let mode = if trial % 2 == 0 { Mode::Adding } else { Mode::Removing };
        let fitted = Holes { angles: &angles, weights: &weights, mode }.fit(target).unwrap();
        let sign = if mode == Mode::Adding { 1.0 } else { -1.0 };
        let sum: Complex<f64> = fitted.holes.iter().map(|(hole, w)| Complex::from_polar(sign * w, angles[*hole])).sum();
        assert!((sum - fitted.sum).norm() < 1e-12);
        assert!(fitted.holes.iter().all(|(_, w)| *w == 0.0 || weights.contains(w)));
        let best = exhaustive(&angles, &weights, target * sign);
        let got = (target - fitted.sum).norm();
        assert!(got >= best - 1e-12 && got <= best + 1.0, "{got} {best}");
        off += got;
        least += best;
    }
    // The search rounds about the exact split; all pairs of all weights, twice as far apart, may meet by chance a little nearer.
    assert!(off < 1.25 * least, "{off} {least}");
}

#[test]
fn a_weight_that_fits_is_taken_as_it_is_and_one_between_is_split() {
    let angles: Vec<f64> = (0..8).map(|hole| f64::from(hole) * TAU / 8.0).collect();
    let weights = [10.0, 20.0, 30.0, 40.0];
    let holes = Holes { angles: &angles, weights: &weights, mode: Mode::Adding };
    let fitted = holes.fit(Complex::from_polar(20.0, TAU / 8.0)).unwrap();
    assert!((fitted.sum - Complex::from_polar(20.0, TAU / 8.0)).norm() < 1e-12);
    // between two holes: 30 in each makes 60 cos 22.5 degrees
    let wanted = Complex::from_polar(60.0 * (TAU / 16.0).cos(), TAU / 16.0);
    let fitted = holes.fit(wanted).unwrap();
    assert_eq!(fitted.holes, [(0, 30.0), (1, 30.0)]);
    assert!((fitted.sum - wanted).norm() < 1e-12);
    // drilled out on the other side
    let drilled = Holes { mode: Mode::Removing, ..holes }.fit(Complex::from_polar(20.0, TAU / 8.0)).unwrap();
    assert_eq!(drilled.holes.iter().find(|(_, w)| *w > 0.0), Some(&(5, 20.0)));
    assert_eq!(holes.fit(Complex::new(500.0, 0.0)), Err(Refusal::TooHeavy { plane: 0 }));
    assert_eq!(Holes { weights: &[], ..holes }.fit(wanted), Err(Refusal::NothingToFit));
    assert_eq!(Holes { weights: &[1.0, -1.0], ..holes }.fit(wanted), Err(Refusal::Setting { index: 1 }));
    assert_eq!(Holes { angles: &[0.0, f64::NAN], ..holes }.fit(wanted), Err(Refusal::Setting { index: 1 }));
    // too light to be worth a weight: none
    assert_eq!(holes.fit(Complex::new(1.0, 0.0)).unwrap().sum, Complex::new(0.0, 0.0));
}
