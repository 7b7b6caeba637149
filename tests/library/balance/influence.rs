//! Weights from influence coefficients against published cases with answers of 50 digits, and against what must hold of
//! any answer.

use driveline::balancing::{Aim, Complex, Error, Influence, Objective, Scalar};
use nalgebra::{convert, try_convert};
use serde_json::Value;

use crate::noise::Noise;
use crate::references::data;

type Problem<T> = Influence<T, 8, 4>;
type Rule<T> = Aim<T, 8, 4>;

/// Amplitude and phase in degrees as a complex number, rounded to the number type once.
fn polar<T: Scalar>(value: &Value) -> Complex<T> {
    let (amplitude, degrees) = (value[0].as_f64().unwrap(), value[1].as_f64().unwrap());
    let (sin, cos) = degrees.to_radians().sin_cos();
    Complex { re: convert(amplitude * cos), im: convert(amplitude * sin) }
}

fn polars<T: Scalar>(value: &Value) -> Vec<Complex<T>> {
    value.as_array().unwrap().iter().map(polar).collect()
}

fn double<T: Scalar>(z: Complex<T>) -> Complex<f64> {
    Complex { re: try_convert(z.re).unwrap(), im: try_convert(z.im).unwrap() }
}

fn apart<T: Scalar>(got: &[Complex<T>], expected: &[Complex<f64>]) -> f64 {
    let largest = expected.iter().map(|z| z.norm()).fold(0.0, f64::max);
    got.iter().zip(expected).map(|(a, b)| (double(*a) - b).norm() / largest).fold(0.0, f64::max)
}

/// The coefficients as given, or from the trial runs.
fn problem<T: Scalar>(case: &Value) -> (Problem<T>, Vec<Complex<T>>) {
    let baseline: Vec<Complex<T>> = polars(&case["baseline_vibration_amp_phase_deg"]);
    if let Some(rows) = case["influence_coefficients_amp_phase_deg"].as_array() {
        let planes = rows[0].as_array().unwrap().len();
        let mut problem = Problem::new(rows.len(), planes).unwrap();
        for plane in 0..planes {
            let column: Vec<_> = rows.iter().map(|row| polar(&row[plane])).collect();
            problem.set(plane, &column).unwrap();
        }
        return (problem, baseline);
    }
    // a row of readings, one from each run
    let rows = case["trial_run_readings_amp_phase_deg"].as_array().unwrap();
    let weights: Vec<Complex<T>> = polars(&case["trial_weights_amp_phase_deg"]);
    let mut problem = Problem::new(baseline.len(), weights.len()).unwrap();
    for (plane, weight) in weights.iter().enumerate() {
        let with: Vec<_> = rows.iter().map(|row| polar(&row[plane])).collect();
        problem.learn(plane, &baseline, &with, *weight).unwrap();
    }
    (problem, baseline)
}

fn least_squares<T: Scalar>(tolerance: f64) {
    let cases = data("balancing.json");
    for case in cases["cases"].as_array().unwrap() {
        let (problem, baseline) = problem::<T>(case);
        let found = problem.correct(&baseline, &Rule::default()).unwrap();
        let expected = polars::<f64>(&case["expected_least_squares_weights_amp_phase_deg"]);
        let weights = apart(&found.weights[..expected.len()], &expected);
        assert!(weights < tolerance, "{}: {weights:e}", case["id"]);
        // Residuals over the vibration: those of the square cases are zero.
        let baseline = polars::<f64>(&case["baseline_vibration_amp_phase_deg"]);
        let size = baseline.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let expected = polars::<f64>(&case["expected_least_squares_residual_amp_phase_deg"]);
        for (got, expected) in found.residual.iter().zip(&expected) {
            assert!((double(*got) - expected).norm() / size < tolerance, "{}", case["id"]);
        }
        let rms: f64 = try_convert(found.rms).unwrap();
        assert!((rms - case["expected_least_squares_residual_rms"].as_f64().unwrap()).abs() / size < tolerance);
        let condition: f64 = try_convert(found.condition).unwrap();
        let expected = case["condition_number"].as_f64().unwrap();
        assert!((condition / expected - 1.0).abs() < 10.0 * tolerance, "{}: {condition}", case["id"]);
        let coefficients = case["expected_influence_coefficients_amp_phase_deg"].as_array().unwrap();
        for (row, expected) in coefficients.iter().enumerate() {
            for (plane, expected) in polars::<f64>(expected).iter().enumerate() {
                let got = double(problem.get(row, plane).unwrap());
                assert!((got - expected).norm() / expected.norm() < tolerance, "{}", case["id"]);
            }
        }
        assert!(found.left_out.is_empty() && found.bounds.is_none());
    }
}

/// Tolerance as the cases state it.
#[test]
fn published_cases_by_least_squares_in_f64() {
    least_squares::<f64>(1e-9);
}

/// 1e-5: some 80 units in the last place, for conditions up to 12.
#[test]
fn published_cases_by_least_squares_in_f32() {
    least_squares::<f32>(1e-5);
}

#[test]
fn published_cases_by_min_max() {
    let cases = data("balancing.json");
    let mut seen = 0;
    for case in cases["cases"].as_array().unwrap() {
        let Some(largest) = case["expected_minmax_max_residual"].as_f64() else { continue };
        seen += 1;
        let (problem, baseline) = problem::<f64>(case);
        let aim = Rule { objective: Objective::MinMax, ..Rule::default() };
        let found = problem.correct(&baseline, &aim).unwrap();
        let (below, reached) = found.bounds.unwrap();
        println!(
            "{}: largest residual off by {:e}, proven within {:e}",
            case["id"],
            found.largest / largest - 1.0,
            reached / below - 1.0
        );
        // 1e-6 from the certified optimum
        assert!((found.largest / largest - 1.0).abs() < 1e-6);
        assert!(
            below <= largest * (1.0 + 1e-12) && reached >= largest * (1.0 - 1e-12) && reached - below < 1e-6 * reached
        );
        let expected = polars::<f64>(&case["expected_minmax_weights_amp_phase_deg"]);
        assert!(apart(&found.weights[..expected.len()], &expected) < 1e-6, "{:?}", found.weights);

        let (problem, baseline) = self::problem::<f32>(case);
        let aim = Aim { objective: Objective::MinMax, ..Aim::default() };
        let found = problem.correct(&baseline, &aim).unwrap();
        // single precision proves what it reaches: 1e-2 is what it promises
        assert!((f64::from(found.largest) / largest - 1.0).abs() < 1e-3, "{}", found.largest);
    }
    assert_eq!(seen, 2);
}

fn random(noise: &mut Noise, rows: usize, planes: usize) -> (Problem<f64>, Vec<Complex<f64>>) {
    let mut z = || Complex { re: noise.normal(), im: noise.normal() };
    let mut problem = Problem::new(rows, planes).unwrap();
    for plane in 0..planes {
        let column: Vec<_> = (0..rows).map(|_| z()).collect();
        problem.set(plane, &column).unwrap();
    }
    let v = (0..rows).map(|_| z()).collect();
    (problem, v)
}

/// What must hold: the bounds meet, the limits are kept, and nothing near is better.
#[test]
fn searches_end_at_their_proven_optimum() {
    let mut noise = Noise::new(11);
    for trial in 0..60 {
        let (problem, v) = random(&mut noise, 6, 3);
        let limits = match trial % 3 {
            0 => [None; 4],
            1 => [Some(0.3); 4],
            _ => [Some(0.2), None, Some(0.05), None],
        };
        for objective in [Objective::MinMax, Objective::LeastSquares] {
            let weighting = [1.0, 2.0, 0.5, 1.0, 3.0, 1.0, 1.0, 1.0];
            let aim = Rule { objective, limits, weighting, ..Rule::default() };
            let found = problem.correct(&v, &aim).unwrap();
            for (weight, limit) in found.weights.iter().zip(limits) {
                assert!(limit.is_none_or(|limit| weight.norm() <= limit));
            }
            let value = |weights: &[Complex<f64>]| {
                let residual = problem.predict(&v, weights).unwrap();
                let sizes = residual.iter().zip(weighting).map(|(r, w)| r.norm() * w);
                match objective {
                    Objective::MinMax => sizes.fold(0.0, f64::max),
                    Objective::LeastSquares => sizes.map(|s| s * s).sum::<f64>().sqrt(),
                }
            };
            let reached = value(&found.weights);
            if let Some((below, above)) = found.bounds {
                assert!((above / reached - 1.0).abs() < 1e-12 && above - below <= 1e-6 * above, "{below} {above}");
            }
            for _ in 0..40 {
                let mut near = found.weights;
                for (weight, limit) in near.iter_mut().zip(limits) {
                    *weight += Complex { re: 1e-3 * noise.normal(), im: 1e-3 * noise.normal() };
                    if let Some(limit) = limit.filter(|&limit| weight.norm() > limit) {
                        *weight *= limit / weight.norm();
                    }
                }
                near[3] = Complex { re: 0.0, im: 0.0 };
                assert!(value(&near) >= reached * (1.0 - 1e-6));
            }
        }
    }
}

/// A plane that does what three others do together is found and left out, and the reason says which.
#[test]
fn a_plane_that_is_a_combination_of_three_others() {
    let mut noise = Noise::new(5);
    for exact in [true, false] {
        let (mut problem, v) = random(&mut noise, 8, 4);
        let mix = [Complex::new(0.5, 0.2), Complex::new(-0.8, 0.1), Complex::new(0.3, -0.6)];
        let by = if exact { 0.0 } else { 2e-3 };
        let column: Vec<_> = (0..8)
            .map(|row| {
                let sum: Complex<f64> = (0..3).map(|plane| problem.get(row, plane).unwrap() * mix[plane]).sum();
                sum + Complex::new(by * noise.normal(), by * noise.normal())
            })
            .collect();
        problem.set(3, &column).unwrap();
        let found = problem.correct(&v, &Rule::default()).unwrap();
        let [out] = found.left_out.as_slice() else { panic!("{:?}", found.left_out) };
        assert!(found.weights[out.plane].norm() == 0.0 && found.condition < 50.0, "{}", found.condition);
        assert!(out.own < if exact { 1e-14 } else { 1e-2 }, "{:?}", out);
        // what is left out is the sum of the others, times what `like` says
        for row in 0..8 {
            let same: Complex<f64> = (0..4).map(|plane| problem.get(row, plane).unwrap() * out.like[plane]).sum();
            let left = (problem.get(row, out.plane).unwrap() - same).norm();
            assert!(left < if exact { 1e-12 } else { 2e-2 }, "{left}");
        }
        assert_eq!(out.like.iter().filter(|like| like.norm() > 0.05).count(), 3, "{:?}", out.like);
        // the others do as well without it
        let mut three = Problem::new(8, 3).unwrap();
        let kept: Vec<usize> = (0..4).filter(|&plane| plane != out.plane).collect();
        for (place, &plane) in kept.iter().enumerate() {
            let column: Vec<_> = (0..8).map(|row| problem.get(row, plane).unwrap()).collect();
            three.set(place, &column).unwrap();
        }
        assert!((three.correct(&v, &Rule::default()).unwrap().rms - found.rms).abs() < 1e-12);
    }
}

/// Two planes whose effects differ by 1 in 2e7: refused with the reason by a rule for field readings, solved where
/// asked to.
#[test]
fn nearly_parallel_planes() {
    let mut noise = Noise::new(8);
    let (mut problem, _) = random(&mut noise, 6, 2);
    let column: Vec<_> = (0..6)
        .map(|row| problem.get(row, 0).unwrap() * 1.5 + Complex::new(noise.normal(), noise.normal()) * 1e-7)
        .collect();
    problem.set(1, &column).unwrap();
    let truth = [Complex::new(0.3, -1.0), Complex::new(2.0, 0.5)];
    let v: Vec<_> = problem.predict(&[Complex::new(0.0, 0.0); 6], &truth.map(|w| -w)).unwrap()[..6].to_vec();
    let refused = problem.correct(&v, &Rule::default()).unwrap();
    assert_eq!(refused.left_out.len(), 1);
    assert!((refused.left_out[0].like[1 - refused.left_out[0].plane].norm() - 1.5).abs() < 1.0);
    let solved = problem.correct(&v, &Rule { independence: 0.0, ..Rule::default() }).unwrap();
    assert!(solved.left_out.is_empty() && solved.condition > 1e7, "{}", solved.condition);
    // the condition times rounding, 2e-9, in the weights; none of it in the residual
    assert!(
        apart(&solved.weights[..2], &truth) < 1e-7 && solved.rms < 1e-14,
        "{:e}",
        apart(&solved.weights[..2], &truth)
    );
}

/// Trial weights that stay on: each run is compared with the one before, and the same coefficients come out.
#[test]
fn trial_weights_may_stay() {
    let mut noise = Noise::new(21);
    let (truth, v) = random(&mut noise, 5, 3);
    let mut problem = Problem::new(5, 3).unwrap();
    let mut on = [Complex::new(0.0, 0.0); 3];
    let mut before = v.clone();
    for plane in 0..3 {
        let trial = Complex::new(1.0 + noise.even(), noise.normal());
        on[plane] = trial;
        let with = truth.predict(&v, &on).unwrap()[..5].to_vec();
        problem.learn(plane, &before, &with, trial).unwrap();
        before = with;
    }
    for row in 0..5 {
        for plane in 0..3 {
            assert!((problem.get(row, plane).unwrap() - truth.get(row, plane).unwrap()).norm() < 1e-13);
        }
    }
}

#[test]
fn wrong_use_is_refused_and_loses_nothing() {
    let z = |re: f64, im: f64| Complex { re, im };
    assert_eq!(Problem::<f64>::new(2, 3), Err(Error::MorePlanesThanReadings { planes: 3, readings: 2 }));
    assert_eq!(Problem::<f64>::new(0, 0), Err(Error::Size));
    assert_eq!(Problem::<f64>::new(9, 2), Err(Error::Size));
    let mut problem = Problem::<f64>::new(2, 2).unwrap();
    let (before, with) = ([z(7.2, 1.0), z(3.0, 2.0)], [z(4.9, 0.0), z(4.0, 1.0)]);
    problem.learn(0, &before, &with, z(2.5, 0.0)).unwrap();
    let kept = problem;
    assert_eq!(problem.learn(1, &before, &with, z(0.0, 0.0)), Err(Error::TrialWeightZero { plane: 1 }));
    assert_eq!(problem.learn(0, &before, &with, z(f64::NAN, 0.0)), Err(Error::Weight { plane: 0 }));
    assert_eq!(problem.learn(0, &before, &with[..1], z(1.0, 0.0)), Err(Error::ReadingMissing { row: 1 }));
    assert_eq!(
        problem.learn(0, &before, &[z(1.0, 0.0), z(0.0, f64::INFINITY)], z(1.0, 0.0)),
        Err(Error::Reading { row: 1 })
    );
    assert_eq!(problem.learn(0, &before, &before, z(1.0, 0.0)), Err(Error::NoEffect { plane: 0 }));
    assert_eq!(problem.learn(2, &before, &with, z(1.0, 0.0)), Err(Error::NoPlane { plane: 2 }));
    assert_eq!(problem.correct(&before, &Rule::default()), Err(Error::PlaneUnknown { plane: 1 }));
    assert_eq!(problem, kept);
    problem.learn(1, &before, &[z(1.0, 1.0), z(-2.0, 2.0)], z(1.0, 1.0)).unwrap();
    let mut aim = Rule::default();
    aim.weighting[1] = -1.0;
    assert_eq!(problem.correct(&before, &aim), Err(Error::Setting { index: 1 }));
    aim.weighting[1] = 0.0;
    assert_eq!(problem.correct(&before, &aim), Err(Error::MorePlanesThanReadings { planes: 2, readings: 1 }));
    aim.weighting[1] = 1.0;
    aim.limits[0] = Some(f64::NAN);
    assert_eq!(problem.correct(&before, &aim), Err(Error::Setting { index: 0 }));
    assert_eq!(problem.correct(&before[..1], &Rule::default()), Err(Error::ReadingMissing { row: 1 }));
    assert!(problem.correct(&before, &Rule::default()).unwrap().rms < 1e-14);
    assert_eq!(
        Error::TrialWeightZero { plane: 1 }.to_string(),
        "the trial weight in plane 2 is zero: put a weight there and run again"
    );
}

/// Two trial runs of a plane whose readings do not agree, least squares by hand: `sum conj(w) dv / sum |w|^2`.
#[test]
fn further_trial_runs_count_by_the_squares_of_their_weights() {
    let z = Complex::<f64>::new;
    let before = [z(1.0, 0.5), z(-2.0, 0.25)];
    let trials = [
        (z(0.5, -0.25), [z(1.5, 0.0), z(-1.0, 1.0)]),
        (z(-0.75, 1.0), [z(0.25, 3.0), z(-3.0, 0.0)]),
        (z(2.0, 0.0), [z(2.0, -1.0), z(-2.5, 0.5)]),
    ];
    let mut influence = Influence::<f64, 2, 1>::new(2, 1).unwrap();
    let (mut known, mut sums) = (0.0, [z(0.0, 0.0); 2]);
    for (count, (weight, with)) in trials.iter().enumerate() {
        known = influence.learn_further(0, &before, with, *weight, known).unwrap();
        let all: f64 = trials[..=count].iter().map(|(weight, _)| weight.norm_sqr()).sum();
        assert!((known - all).abs() < 1e-15 * all);
        for (row, sum) in sums.iter_mut().enumerate() {
            *sum += weight.conj() * (with[row] - before[row]);
            let found = influence.get(row, 0).unwrap();
            // a dozen roundings
            assert!((found - *sum / all).norm() < 1e-14, "{count} {row} {found}");
        }
    }
    assert!(influence.get(2, 0).is_none() && influence.get(0, 1).is_none() && influence.get(1, 0).is_some());
}
