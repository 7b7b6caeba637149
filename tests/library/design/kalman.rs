//! Steady-state gains against a doubling in 100-digit arithmetic (`kalman_gains.json`).

use driveline::design::{Kalman, Matrix};
use serde_json::Value;

use super::{matrix, number};
use crate::references::data;

fn diagonal<const N: usize>(value: &Value) -> Matrix<N, N> {
    Matrix::diagonal(&core::array::from_fn(|i| number(&value[i])))
}

/// Largest relative difference of the elements.
fn apart<const R: usize, const C: usize>(a: &Matrix<R, C>, b: &Matrix<R, C>) -> f64 {
    a.0.iter().flatten().zip(b.0.iter().flatten()).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

fn meets<const M: usize>(case: &Value) {
    let f = matrix::<4, 4>(&case["F"]);
    let found = Kalman::<4, M>::design(&f, &matrix(&case["H"]), &diagonal(&case["Q_diag"]), &diagonal(&case["R_diag"]))
        .unwrap();
    let radius = case["spectral_radius"].as_f64().unwrap();
    let errors = [
        apart(&found.gain, &matrix(&case["K_filter"])),
        apart(&f.times(&found.gain), &matrix(&case["K_predictor"])),
        apart(&found.prior, &matrix(&case["P_prior"])),
        apart(&found.posterior, &matrix(&case["P_posterior"])),
        apart(&found.innovation, &matrix(&case["innovation_cov_S"])),
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
