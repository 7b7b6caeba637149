//! The estimate against Kalman's filter in its usual matrices, and single steps made by hand.

use nalgebra::{Matrix3, Vector3};

use super::*;
use crate::balancing::scalar::noise::Noise;

type Two = Estimate<f64, 3, 2>;

const fn re(re: f64) -> Complex<f64> {
    Complex { re, im: 0.0 }
}

fn near(found: Complex<f64>, expected: Complex<f64>) -> bool {
    (found - expected).modulus() < 1e-12
}

/// Kalman's filter in its usual matrices: a row's reading and the coefficients of two planes are its state, the
/// covariance is that of any row (Åström and Wittenmark, 2.3).
struct Filter {
    states: [Vector3<Complex<f64>>; 2],
    covariance: Matrix3<Complex<f64>>,
}

impl Filter {
    fn predict(&mut self, moved: &[Complex<f64>; 2], walk: f64) {
        let mut f = Matrix3::identity();
        (f[(0, 1)], f[(0, 2)]) = (moved[0], moved[1]);
        for state in &mut self.states {
            *state = f * *state;
        }
        self.covariance = f * self.covariance * f.adjoint();
        self.covariance[(0, 0)] += re(walk);
    }

    fn learn(&mut self, reading: &[Complex<f64>], noise: f64) {
        let spread = self.covariance[(0, 0)] + re(noise);
        let gain = self.covariance.column(0) / spread;
        for (state, reading) in self.states.iter_mut().zip(reading) {
            *state += gain * (*reading - state[0]);
        }
        self.covariance -= gain * self.covariance.row(0).clone_owned();
    }
}

#[test]
fn it_is_kalmans_filter() {
    let mut noise = Noise::new(5);
    let mut estimate = Two::new(2);
    assert!(estimate.begin(8.0) && !estimate.begin(8.0));
    let mut filter = Filter { states: [Vector3::zeros(); 2], covariance: Matrix3::zeros() };
    // four deviations are the largest coefficient
    assert_eq!((estimate.deviation(0), estimate.deviation(1)), (2.0, 2.0));
    (filter.covariance[(1, 1)], filter.covariance[(2, 2)]) = (re(4.0), re(4.0));
    let first = [noise.complex(), noise.complex(), noise.complex()];
    estimate.restart(&first, 0.3);
    filter.covariance[(0, 0)] = re(0.3);
    (filter.states[0][0], filter.states[1][0]) = (first[0], first[1]);
    for round in 0..12 {
        let moved = [noise.complex(), noise.complex().scale(0.5)];
        let before = estimate;
        estimate.predict(&moved, 0.02);
        filter.predict(&moved, 0.02);
        let largest = filter.states.iter().map(|state| state[0].modulus()).fold(0.0, f64::max);
        assert!((estimate.level() - largest).abs() < 1e-12);
        assert!((before.level_after(&moved) - largest).abs() < 1e-12);
        let change = filter.states.iter().map(|s| (s[1] * moved[0] + s[2] * moved[1]).modulus()).fold(0.0, f64::max);
        assert!((before.largest_change(&moved) - change).abs() < 1e-12);
        let reading = [noise.complex(), noise.complex(), re(100.0)];
        let innovation = estimate.innovation(&reading, 0.1);
        let beside = [0, 1].map(|row| (reading[row] - filter.states[row][0]).modulus());
        assert!((innovation.largest - beside[0].max(beside[1])).abs() < 1e-12);
        let variance = filter.covariance[(0, 0)].re;
        assert!((innovation.predicted - variance.sqrt()).abs() < 1e-12, "{round}");
        assert!((innovation.deviation - (variance + 0.1).sqrt()).abs() < 1e-12);
        estimate.learn(&innovation);
        filter.learn(&reading, 0.1);
        for plane in 0..2 {
            for row in 0..2 {
                assert!(near(estimate.influence(row, plane), filter.states[row][plane + 1]), "{round}");
            }
            let deviation = filter.covariance[(plane + 1, plane + 1)].re.sqrt();
            assert!((estimate.deviation(plane) - deviation).abs() < 1e-12);
            let size = filter.states.iter().map(|state| state[plane + 1].modulus()).fold(0.0, f64::max);
            assert!((estimate.most(plane) - size - 4.0 * deviation).abs() < 1e-12);
            assert!((estimate.doubt_of(plane) - deviation / size).abs() < 1e-12);
        }
        // half a step: the level after it, and four deviations of its change
        let half = moved.map(|moved| moved.scale(0.5));
        let mut square = 0.0;
        for p in 0..2 {
            for q in 0..2 {
                square += (half[p] * filter.covariance[(p + 1, q + 1)] * half[q].conj()).re;
            }
        }
        let level =
            filter.states.iter().map(|s| (s[0] + s[1] * half[0] + s[2] * half[1]).modulus()).fold(0.0, f64::max);
        assert!((estimate.expected(&moved, 0.5) - level - 4.0 * square.sqrt()).abs() < 1e-11);
    }
    // nothing is learnt from a reading without any spread
    let mut certain = Two::new(2);
    certain.restart(&first, 0.0);
    certain.learn(&certain.innovation(&[re(9.0); 3], 0.0));
    assert_eq!(certain.now[0], first[0]);
}

/// The change minimises `sum |v + a w|^2 + rows sum s_p^2 |w_p|^2`: its derivative by each weight is zero.
#[test]
fn a_cautious_change_is_at_the_least_of_the_expected_square() {
    let mut noise = Noise::new(8);
    let mut estimate = Two::new(2);
    let rows = [noise.complex(), noise.complex(), re(100.0)];
    estimate.restart(&rows, 0.1);
    for row in 0..2 {
        for plane in 0..2 {
            estimate.influence.set(row, plane, noise.complex());
        }
    }
    estimate.covariance.set(0, 0, re(0.04));
    estimate.covariance.set(1, 1, re(0.01));
    let w = estimate.cautious();
    for plane in 0..2 {
        let slope = (0..2).fold(w[plane].scale(2.0 * [0.04, 0.01][plane]), |sum, row| {
            let left = rows[row] + estimate.change(row, &w);
            sum + estimate.influence(row, plane).conj() * left
        });
        assert!(slope.modulus() < 1e-14, "{plane}: {slope}");
    }
}

/// Coefficients of 5 and 2.
fn known(deviations: [f64; 2]) -> Two {
    let mut estimate = Two::new(2);
    estimate.known = true;
    for (plane, deviation) in deviations.into_iter().enumerate() {
        estimate.influence.set(plane, plane, re([5.0, -2.0][plane]));
        estimate.covariance.set(plane, plane, re(deviation * deviation));
    }
    estimate.covariance.set(0, 1, re(0.25));
    estimate
}

/// A fifth of the coefficient is the limit; of planes beyond it the worst is the first; one that no move has
/// confirmed counts as just beyond it.
#[test]
fn the_plane_to_probe() {
    for (deviations, confirmed, plane) in [
        ([0.9, 0.3], [true, true], None),
        ([1.1, 0.3], [true, true], Some(0)),
        ([0.9, 0.5], [true, true], Some(1)),
        ([1.1, 0.5], [true, true], Some(1)),
        ([2.0, 0.5], [true, true], Some(0)),
        ([0.9, 0.3], [true, false], Some(1)),
        ([0.9, 0.3], [false, true], Some(0)),
        ([0.9, 0.3], [false, false], Some(0)),
        ([0.9, 0.5], [false, true], Some(1)),
    ] {
        let estimate = Two { confirmed, ..known(deviations) };
        assert_eq!(estimate.least_known(), plane, "{deviations:?}, {confirmed:?}");
        assert_eq!(estimate.confirmed(), plane.is_none());
    }
    // nothing known: a deviation over rounding, not over zero
    let mut nothing = Two::new(2);
    nothing.begin(4.0);
    assert!((nothing.doubt_of(0) * f64::EPSILON - 1.0).abs() < 1e-12);
}

/// A covariance four times as large; after a resume the deviation and a fifth of the coefficient, or nothing.
#[test]
fn an_influence_is_doubted() {
    let mut estimate = Two { confirmed: [true; 2], ..known([0.6, 0.3]) };
    estimate.doubt(4.0);
    assert!((estimate.deviation(0) - 1.2).abs() < 1e-15 && (estimate.deviation(1) - 0.6).abs() < 1e-15);
    assert_eq!((estimate.covariance.at(0, 1), estimate.confirmed), (re(1.0), [false; 2]));
    let mut estimate = Two { confirmed: [true; 2], ..known([0.75, 0.3]) };
    estimate.distrust();
    // 3, 4, 5
    assert!((estimate.deviation(0) - 1.25).abs() < 1e-12 && (estimate.deviation(1) - 0.5).abs() < 1e-12);
    assert!(estimate.known && estimate.confirmed == [false; 2] && estimate.influence(0, 0) == re(5.0));
    let mut estimate = Two { confirmed: [true, false], ..known([0.75, 0.3]) };
    estimate.distrust();
    assert!(!estimate.known && estimate.influence(0, 0) == re(0.0) && estimate.deviation(1) == 0.0);
}

/// A move confirms what it moves by a third of the longest at least, where it was to be seen and came as predicted;
/// what is more certain than 0.06 of the coefficient is forgotten a little.
#[test]
fn a_move_confirms() {
    let confirm = |moved: [f64; 2], largest: f64, deviation: f64, deviations: [f64; 2]| {
        let mut estimate = known(deviations);
        let innovation = Innovation { rows: [zero(); 3], largest, deviation, predicted: 0.0 };
        estimate.confirm(&moved.map(re), 10.0, &innovation, 0.25);
        (estimate.confirmed, [0, 1].map(|plane| estimate.deviation(plane)))
    };
    let certain = [1.0, 1.0];
    assert_eq!(confirm([1.0, 1.0], 4.9, 3.9, certain).0, [true; 2]);
    assert_eq!(confirm([1.0, 0.31], 4.9, 3.9, certain).0, [true; 2]);
    assert_eq!(confirm([1.0, 0.29], 4.9, 3.9, certain).0, [true, false]);
    assert_eq!(confirm([-0.29, 1.0], 4.9, 3.9, certain).0, [false, true]);
    assert_eq!(confirm([1.0, 1.0], 5.1, 3.9, certain).0, [false; 2]);
    assert_eq!(confirm([1.0, 1.0], 4.9, 4.1, certain).0, [false; 2]);
    // a quarter of the variance is twice the deviation
    for (deviations, then) in [([0.29, 0.13], [0.58, 0.13]), ([0.31, 0.11], [0.31, 0.22])] {
        let found = confirm([0.0, 1.0], 9.0, 9.0, deviations).1;
        assert!((found[0] - then[0]).abs() < 1e-15 && (found[1] - then[1]).abs() < 1e-15, "{found:?}");
    }
}
