//! The exact step of two masses against its closed form at 400 digits, and the full matrices of `discretisation.json`.

use driveline::design::{ExactStep, Matrix, discretise};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

use super::{matrix, number};
use crate::references::data;

/// Each coefficient in the energy norm, twist in `1/w` and slip in 1, against the size of the whole step. Where the step
/// is not oscillating fast, each keeps its digits by itself: small ones do not drown.
#[test]
fn exact_step_meets_its_closed_form() {
    let mut worst: f64 = 0.0;
    for case in data("exact_step.json")["cases"].as_array().unwrap() {
        let (w2, two_a, t) = (number(&case["w2"]), number(&case["two_a"]), number(&case["period"]));
        let step = ExactStep::from_rates(w2, two_a, t);
        let w = w2.sqrt();
        let coefficients = [
            (step.n11, "n11"),
            (step.n12, "g2"),
            (step.n21, "n21"),
            (step.n22, "n22"),
            (step.g1, "g1"),
            (step.g2, "g2"),
            (step.lag, "lag"),
        ];
        // A step of s moves the slip by at most T and the twist by at most T/w or T^2.
        let reach = if w * t > 1.0 { t / w } else { t * t };
        let sizes = [1.0, 1.0 / w.max(1.0 / t), w.max(1.0 / t), 1.0, reach, t, t];
        let errors = [0, 1, 2, 3, 4, 5, 6].map(|k| {
            let (value, key) = coefficients[k];
            (value - number(&case[key])).abs() / sizes[k]
        });
        let error = errors.iter().copied().fold(0.0, f64::max) / (w * t).max(1.0);
        worst = worst.max(error);
        // The rounding of w T alone turns the angle by 1e-16 w T; the rest is some ten roundings.
        assert!(error < 2e-15, "w T = {}, a T = {}: {errors:?}", w * t, 0.5 * two_a * t);
        // Beyond a quarter turn sines and 1 - cosines pass through zero, where a relative error has no meaning;
        // a decay e^-x magnifies the rounding of its argument by x.
        if w * t > 1.5 || two_a * t > 10.0 {
            continue;
        }
        for (value, key) in coefficients {
            let expected = number(&case[key]);
            let error = if expected == 0.0 { value.abs() } else { (value / expected - 1.0).abs() };
            // Ten to twenty roundings of 1.1e-16 each.
            assert!(error < 3e-15, "{key} at w T = {}, a T = {}: {value:e}, not {expected:e}", w * t, 0.5 * two_a * t);
        }
    }
    println!("exact step: worst energy-norm error over max(1, w T): {worst:e}");
}

fn frobenius<const R: usize, const C: usize>(m: &Matrix<R, C>) -> f64 {
    m.0.iter().flatten().map(|x| x * x).sum::<f64>().sqrt()
}

fn column(m: &Matrix<3, 2>, j: usize, s: &[f64; 3]) -> f64 {
    (0..3).map(|i| (m.0[i][j] * s[i]).powi(2)).sum::<f64>().sqrt()
}

/// Errors of transition and input by the metric of the file, in states of such sizes.
fn errors(f: &Matrix<3, 3>, g: &Matrix<3, 2>, form: &serde_json::Value, s: &[f64; 3]) -> [f64; 2] {
    let (ad, bd) = (matrix::<3, 3>(&form["Ad"]), matrix::<3, 2>(&form["Bd"]));
    let miss = g.plus(-1.0, &bd);
    let input = (0..2).map(|j| column(&miss, j, s) / column(&bd, j, s)).fold(0.0, f64::max);
    [frobenius(&f.plus(-1.0, &ad).scaled(s, s)) / frobenius(&ad.scaled(s, s)), input]
}

/// The general exponential, in both forms, by the error metric of the file.
#[test]
fn discretise_meets_the_reference_matrices() {
    for case in data("discretisation.json")["cases"].as_array().unwrap() {
        let s = [
            number(&case["J_motor_kg_m2"]).sqrt(),
            1.0 / number(&case["k_Nm_rad"]).sqrt(),
            number(&case["J_load_kg_m2"]).sqrt(),
        ];
        for form in ["elastic", "total"] {
            let form = &case[form];
            if form.is_string() {
                continue;
            }
            let (f, g) =
                discretise::<3, 2, 5>(&matrix(&form["A"]), &matrix(&form["B"]), number(&case["Ts_s"])).unwrap();
            let [error_a, error_b] = errors(&f, &g, form, &s);
            let limit = 1e-14 * number(&case["omega_Ts_rad"]).max(1.0);
            println!("{}: A {error_a:e} B {error_b:e}, limit {limit:e}", case["id"]);
            // The limit is the file's own: the rounding of the argument.
            assert!(error_a < limit && error_b < limit);
        }
    }
}

/// The exact step against the same matrices: without friction on either mass they hold the same machine.
#[test]
fn exact_step_meets_the_reference_matrices() {
    for case in data("discretisation.json")["cases"].as_array().unwrap() {
        if number(&case["b_motor_Nms_rad"]) != 0.0 {
            continue;
        }
        let (jm, jl, k) = (number(&case["J_motor_kg_m2"]), number(&case["J_load_kg_m2"]), number(&case["k_Nm_rad"]));
        let machine = TwoMass::new(Inertia(jm), Inertia(jl), Stiffness(k), Damping(number(&case["d_Nms_rad"])));
        let t = number(&case["Ts_s"]);
        let step = ExactStep::new(&machine, t);
        // the shaft's impulse from motor to load, by twist, twist rate and forcing
        let [h_twist, h_slip, h_drive] = [-step.n21, -step.n22, step.lag].map(|each| jm * jl / (jm + jl) * each);
        // States w_m, k delta, w_l; inputs tau_m, tau_L.
        let f = Matrix([
            [1.0 - h_slip / jm, -h_twist / k / jm, h_slip / jm],
            [k * step.n12, 1.0 + step.n11, -k * step.n12],
            [h_slip / jl, h_twist / k / jl, 1.0 - h_slip / jl],
        ]);
        let g = Matrix([
            [(t - h_drive / jm) / jm, -h_drive / jm / jl],
            [k * step.g1 / jm, k * step.g1 / jl],
            [h_drive / jl / jm, -(t - h_drive / jl) / jl],
        ]);
        let s = [jm.sqrt(), 1.0 / k.sqrt(), jl.sqrt()];
        let [error_a, error_b] = errors(&f, &g, &case["elastic"], &s);
        println!("{}: A {error_a:e} B {error_b:e}", case["id"]);
        // A handful of roundings; the file allows 1e-14.
        assert!(error_a < 2e-15 && error_b < 2e-15);
    }
}
