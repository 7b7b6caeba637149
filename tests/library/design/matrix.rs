//! Small matrices, their exponential, eigenvalues and Riccati equations, against closed forms; steady-state
//! gains against a doubling in 100-digit arithmetic (`kalman_gains.json`).

use driveline::design::{Error, Kalman, Matrix, discretise, doubling, eigenvalues, exponential, spectral_radius};
use serde_json::Value;

use super::{matrix, number};
use crate::references::data;

fn largest<const R: usize, const C: usize>(m: &Matrix<R, C>) -> f64 {
    m.0.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()))
}

#[test]
fn solve_inverts() {
    // The inverse of Hilbert's matrix of order 4 is whole numbers [Knuth, TAOCP 1, §1.2.3, exercise 45].
    let hilbert = Matrix(core::array::from_fn(|i| core::array::from_fn(|j| 1.0 / (i + j + 1) as f64)));
    let inverse = Matrix([
        [16.0, -120.0, 240.0, -140.0],
        [-120.0, 1200.0, -2700.0, 1680.0],
        [240.0, -2700.0, 6480.0, -4200.0],
        [-140.0, 1680.0, -4200.0, 2800.0],
    ]);
    let found = hilbert.solve(&Matrix::<4, 4>::IDENTITY).unwrap();
    // Condition 1.6e4 times some roundings, of the largest element.
    assert!(largest(&found.plus(-1.0, &inverse)) < 1e-11 * 6480.0);
    // A zero in the first place needs an exchange; a repeated row has no solution.
    assert_eq!(Matrix([[0.0, 2.0], [4.0, 0.0]]).solve(&Matrix([[2.0], [4.0]])), Some(Matrix([[1.0], [1.0]])));
    assert_eq!(Matrix([[1.0, 2.0], [1.0, 2.0]]).solve(&Matrix([[1.0], [1.0]])), None);
    assert_eq!(Matrix([[f64::NAN]]).solve(&Matrix([[1.0]])), None);
}

#[test]
fn products_and_transposes() {
    let a = Matrix([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(a.times(&a.transpose()), Matrix([[14.0, 32.0], [32.0, 77.0]]));
    assert_eq!(a.plus(-2.0, &a), Matrix([[-1.0, -2.0, -3.0], [-4.0, -5.0, -6.0]]));
    assert_eq!(a.norm(), 9.0);
    assert_eq!(Matrix([[1.0, 4.0], [2.0, 3.0]]).symmetric(), Matrix([[1.0, 3.0], [3.0, 3.0]]));
    assert!(Matrix([[f64::NAN, 1.0]]).norm().is_nan());
}

#[test]
fn exponential_has_its_closed_forms() {
    // A rotation: 1000 rad, whose rounding alone is 1000 times 1.1e-16 ...
    for angle in [1e-9, 0.3, 3.0, 1000.0_f64] {
        let turned = exponential(&Matrix([[0.0, -angle], [angle, 0.0]])).unwrap();
        let expected = Matrix([[angle.cos(), -angle.sin()], [angle.sin(), angle.cos()]]);
        assert!(largest(&turned.plus(-1.0, &expected)) < 1e-15 * angle.max(1.0), "{angle}");
    }
    // ... a chain of integrators, of order 6: t^n/n!, exact but for rounding ...
    let mut chain = Matrix::<6, 6>::ZERO;
    for i in 0..5 {
        chain.0[i][i + 1] = 0.5;
    }
    let (found, mut expected) = (exponential(&chain).unwrap(), 1.0);
    for n in 0..6 {
        assert!((found.0[0][n] / expected - 1.0).abs() < 1e-15 * 4.0);
        expected *= 0.5 / (n + 1) as f64;
    }
    // ... decays of very different speed, and what is not a number.
    let decays = exponential(&Matrix::diagonal(&[-1e4, -1.0, 0.0])).unwrap();
    assert!(decays.0[0][0].abs() < 1e-15 && decays.0[2][2] == 1.0);
    assert!((decays.0[1][1] - (-1.0_f64).exp()).abs() < 1e-12);
    assert_eq!(exponential(&Matrix([[f64::NAN]])), None);
    assert_eq!(exponential(&Matrix([[f64::INFINITY]])), None);
}

/// Twist and slip by the general exponential against the closed form at 400 digits: up to 1000 rad a tick and a
/// hundred times critical damping.
#[test]
fn discretise_at_huge_norms() {
    let mut worst: f64 = 0.0;
    for case in data("exact_step.json")["cases"].as_array().unwrap() {
        let at = |key: &str| number(&case[key]);
        let (w2, two_a, t) = (at("w2"), at("two_a"), at("period"));
        let unit = w2.sqrt().max(1.0 / t);
        let (f, _) = discretise::<2, 1, 3>(&Matrix([[0.0, 1.0], [-w2, -two_a]]), &Matrix([[0.0], [1.0]]), t).unwrap();
        let errors = [
            f.0[0][0] - 1.0 - at("n11"),
            (f.0[0][1] - at("g2")) * unit,
            (f.0[1][0] - at("n21")) / unit,
            f.0[1][1] - 1.0 - at("n22"),
        ];
        let size = (w2.sqrt() * t).max(two_a * t).max(1.0);
        worst = worst.max(errors.iter().fold(0.0, |a: f64, e| a.max(e.abs())) / size);
    }
    println!("exponential, energy norm over max(1, w T, 2 a T): {worst:e}");
    // The limit of `discretisation.json`; squaring doubles the rounding as often as the norm halves.
    assert!(worst < 1e-14);
}

fn apart(found: (f64, f64), expected: (f64, f64)) -> f64 {
    (found.0 - expected.0).hypot(found.1 - expected.1)
}

#[test]
fn eigenvalues_have_their_closed_forms() {
    // Diagonal, a rotation, a triangle.
    assert_eq!(eigenvalues(&Matrix::diagonal(&[0.5, -2.0, 3.0])), [(3.0, 0.0), (0.5, 0.0), (-2.0, 0.0)]);
    let (c, s) = (0.9 * 0.3_f64.cos(), 0.9 * 0.3_f64.sin());
    let turned = eigenvalues(&Matrix([[c, -s], [s, c]]));
    assert!(apart(turned[0], (c, -s)) < 1e-15 && apart(turned[1], (c, s)) < 1e-15);
    // A companion matrix of (z^2 + 1)(z - 2)(z + 3)(z - 1/2): z^5 + z^4/2 - 11/2 z^3 + 7/2 z^2 - 13/2 z + 3.
    let mut companion = Matrix::<5, 5>::ZERO;
    companion.0[0] = [-0.5, 5.5, -3.5, 6.5, -3.0];
    for i in 1..5 {
        companion.0[i][i - 1] = 1.0;
    }
    let found = eigenvalues(&companion);
    // Simple roots of a matrix of norm 10: its roundings times a condition below 10.
    for (f, e) in found.iter().zip([(2.0, 0.0), (0.5, 0.0), (0.0, -1.0), (0.0, 1.0), (-3.0, 0.0)]) {
        assert!(apart(*f, e) < 1e-13, "{found:?}");
    }
    assert!((spectral_radius(&found) - 3.0).abs() < 1e-13);
    // A cyclic exchange, which turns unshifted QR in circles: the fifth roots of one.
    let mut cycle = Matrix::<5, 5>::ZERO;
    for i in 0..5 {
        cycle.0[i][(i + 1) % 5] = 1.0;
    }
    for root in eigenvalues(&cycle) {
        assert!((root.0.hypot(root.1) - 1.0).abs() < 1e-14);
        assert!((5.0 * root.1.atan2(root.0)).sin().abs() < 1e-13);
    }
    // A triple root moves by the cube root of a rounding.
    for root in eigenvalues(&Matrix([[1.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])) {
        assert!(apart(root, (1.0, 0.0)) < 1e-5);
    }
    assert!(spectral_radius(&eigenvalues(&Matrix([[f64::NAN, 1.0], [0.0, 1.0]]))).is_nan());
}

/// A slow pole next to 1 keeps the digits of its distance from 1, as a matrix that holds the distance does.
#[test]
fn slow_poles_keep_their_distance_from_one() {
    let found = eigenvalues(&Matrix([[1.0 - 1e-9, 1.0], [0.0, 0.5]]));
    assert!((found[0].0 - (1.0 - 1e-9)).abs() < 2e-16);
}

/// The scalar equation has a closed form: x = a^2 x/(1 + g x) + h.
#[test]
fn scalar_riccati() {
    for (a, g, h) in [(1.0_f64, 1.0, 1e-12), (0.9, 2.0, 3.0), (3.0, 0.5, 0.0), (1.0, 1e6, 1e-6)] {
        let b = 1.0 - a * a - g * h;
        let root = (b * b + 4.0 * g * h).sqrt();
        let expected = if b > 0.0 { 2.0 * h / (b + root) } else { (root - b) / (2.0 * g) };
        let found = doubling(&Matrix([[a]]), &Matrix([[g]]), &Matrix([[h]]));
        match found {
            // Near the edge of stability, h = 1e-12, half the digits are lost by the equation itself.
            Some(found) if h > 0.0 => assert!((found.0[0][0] / expected - 1.0).abs() < 1e-9, "{a} {g} {h}"),
            // Without noise the doubling stays at the other solution, zero.
            Some(found) => assert_eq!(found.0[0][0], 0.0),
            None => panic!("{a} {g} {h} did not converge"),
        }
    }
}

#[test]
fn filters_that_do_not_exist() {
    let one = Matrix([[1.0]]);
    let design = |f: f64, h: f64, q: f64, r: f64| {
        Kalman::<1, 1>::design(&Matrix([[f]]), &Matrix([[h]]), &Matrix([[q]]), &Matrix([[r]])).unwrap_err()
    };
    // A walk that never moves: the gain dies out and nothing is forgotten.
    assert_eq!(design(1.0, 1.0, 0.0, 1.0), Error::NotStabilising);
    // A growing state that is not measured.
    assert_eq!(design(2.0, 0.0, 1.0, 1.0), Error::NotConverged);
    assert_eq!(design(1.0, 1.0, 1.0, 0.0), Error::Noise);
    assert_eq!(design(1.0, 1.0, 1.0, f64::NAN), Error::Noise);
    assert!(Kalman::<1, 1>::design(&one, &one, &one, &one).is_ok());
}

fn diagonal<const N: usize>(value: &Value) -> Matrix<N, N> {
    Matrix::diagonal(&core::array::from_fn(|i| number(&value[i])))
}

/// Largest relative difference of the elements.
fn farthest<const R: usize, const C: usize>(a: &Matrix<R, C>, b: &Matrix<R, C>) -> f64 {
    a.0.iter().flatten().zip(b.0.iter().flatten()).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

fn meets<const M: usize>(case: &Value) {
    let f = matrix::<4, 4>(&case["F"]);
    let found = Kalman::<4, M>::design(&f, &matrix(&case["H"]), &diagonal(&case["Q_diag"]), &diagonal(&case["R_diag"]))
        .unwrap();
    let radius = case["spectral_radius"].as_f64().unwrap();
    let errors = [
        farthest(&found.gain, &matrix(&case["K_filter"])),
        farthest(&f.times(&found.gain), &matrix(&case["K_predictor"])),
        farthest(&found.prior, &matrix(&case["P_prior"])),
        farthest(&found.posterior, &matrix(&case["P_posterior"])),
        farthest(&found.innovation, &matrix(&case["innovation_cov_S"])),
        (found.spectral_radius / radius - 1.0).abs(),
    ];
    println!("{}: gain, predictor, prior, posterior, innovation, radius: {errors:?}", case["id"]);
    // The file's own tolerance for the gains; the covariances are held to the same.
    let limit = case["rel_tol_gain"].as_f64().unwrap();
    assert!(errors.iter().all(|error| *error < limit));
    let known = case["observer_poles_re_im"].as_array().unwrap();
    for pole in found.poles {
        // Poles come in pairs that lie close together: half the digits of the gains remain in the worst case.
        let near =
            known.iter().map(|p| (pole.0 - number(&p[0])).hypot(pole.1 - number(&p[1]))).fold(f64::INFINITY, f64::min);
        assert!(near < 1e-9, "{pole:?}, {known:?}");
    }
}

#[test]
fn gains_meet_the_reference() {
    for case in data("kalman_gains.json")["cases"].as_array().unwrap() {
        match case["H"].as_array().unwrap().len() {
            1 => meets::<1>(case),
            2 => meets::<2>(case),
            outputs => panic!("{outputs} outputs"),
        }
    }
}
