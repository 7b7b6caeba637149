//! Residual unbalance and grades against the cases, and amplitudes alone against the rotor that they were made from.

use std::f64::consts::TAU;

use driveline::balancing::{BalanceTolerance, Complex, Error, GRADES, from_amplitudes, two_planes};
use serde_json::Value;

use crate::noise::Noise;
use crate::references::data;

fn number(case: &Value, key: &str) -> f64 {
    case[key].as_f64().unwrap()
}

/// 1e-12, as the cases state it; g mm are 1e-6 kg m.
#[test]
fn permissible_unbalance_and_its_split() {
    for case in data("balance_tolerance.json")["tolerance_cases"].as_array().unwrap() {
        let tolerance = BalanceTolerance {
            grade: number(case, "G_mm_s"),
            mass: number(case, "mass_kg"),
            speed: number(case, "speed_rpm") * TAU / 60.0,
        };
        let permissible = tolerance.permissible().unwrap() * 1e6;
        assert!((permissible / number(case, "expected_U_per_g_mm") - 1.0).abs() < 1e-12, "{}", case["id"]);
        let passes = tolerance.judge(permissible * 1e-6 * 0.999).unwrap();
        assert!(passes.passed && passes.fulfils == Some(tolerance.grade));
        assert!(!tolerance.judge(permissible * 1e-6 * 1.001).unwrap().passed);
        if case["LA_mm_bearingA_to_cg"].is_number() {
            let (a, b) = (number(case, "LA_mm_bearingA_to_cg") / 1e3, number(case, "LB_mm_cg_to_bearingB") / 1e3);
            let split = tolerance.at_bearings(a, a + b).unwrap().map(|u| u * 1e6);
            let expected =
                ["expected_U_perA_limited_g_mm", "expected_U_perB_limited_g_mm"].map(|key| number(case, key));
            for (got, expected) in split.iter().zip(expected) {
                assert!((got / expected - 1.0).abs() < 1e-12, "{}", case["id"]);
            }
        }
    }
    let rotor = BalanceTolerance { grade: 2.5_f64, mass: 10.0, speed: 100.0 };
    let whole = rotor.permissible().unwrap();
    // 2.5 mm/s over 100 rad/s is 25 um; the shares end at 0.3 and 0.7, overhung at 0.3 and 1.3
    assert!((whole - 2.5e-4).abs() < 1e-18);
    let shares = |from_a| rotor.at_bearings(from_a, 1.0).unwrap().map(|u| (u / whole * 1e3).round() / 1e3);
    assert_eq!(shares(0.1), [0.7, 0.3]);
    // beyond B, beyond A, above a bearing
    assert_eq!((shares(1.2), shares(1.5)), ([0.3, 1.2], [0.5, 1.3]));
    assert_eq!((shares(-0.2), shares(-0.5)), ([1.2, 0.3], [1.3, 0.5]));
    assert_eq!((shares(0.0), shares(1.0)), ([0.7, 0.3], [0.3, 0.7]));
    assert_eq!(rotor.judge(1e3).unwrap().fulfils, None);
    assert_eq!(BalanceTolerance { mass: 0.0, ..rotor }.permissible(), Err(Error::Setting { index: 1 }));
    assert_eq!(rotor.at_bearings(0.3, 0.0), Err(Error::Setting { index: 3 }));
}

#[test]
fn unbalances_resolved_into_two_planes() {
    for case in data("balance_tolerance.json")["two_plane_rigid_cases"].as_array().unwrap() {
        let items = case["items_mass_g_radius_mm_angle_deg_z_mm"].as_array().unwrap().iter().map(|item| {
            let at = |index: usize| item[index].as_f64().unwrap();
            (Complex::from_polar(at(0) * at(1), at(2).to_radians()), at(3))
        });
        let planes = two_planes(items, number(case, "plane_T_z_mm"), number(case, "plane_Tprime_z_mm")).unwrap();
        for (plane, key) in planes.iter().zip(["expected_correction_T_g_mm_deg", "expected_correction_Tprime_g_mm_deg"])
        {
            let expected = &case[key];
            let expected =
                Complex::from_polar(expected[0].as_f64().unwrap(), expected[1].as_f64().unwrap().to_radians());
            assert!((-plane - expected).norm() / expected.norm() < 1e-12, "{}", case["id"]);
        }
    }
    assert_eq!(two_planes([(Complex::new(1.0, 0.0), 0.0)], 1.0, 1.0), Err(Error::Setting { index: 0 }));
}

/// Three or more runs give the weight that takes the vibration away; two give it as one of two.
#[test]
fn amplitudes_alone() {
    let mut noise = Noise::new(12);
    let mut noticed = 0;
    for _ in 0..200 {
        let a = Complex::from_polar(0.1 + noise.even(), TAU * noise.even());
        let v0 = Complex::from_polar(1.0 + 4.0 * noise.even(), TAU * noise.even());
        let trial = 0.5 + 3.0 * noise.even();
        let run = |degrees: f64| {
            let angle = degrees.to_radians();
            (angle, (v0 + a * Complex::from_polar(trial, angle)).norm())
        };
        let truth = -v0 / a;
        let three = from_amplitudes(v0.norm(), trial, &[run(0.0), run(120.0), run(240.0)]).unwrap();
        // the effect is a difference of squares: three digits may go
        assert!((three.weight - truth).norm() / truth.norm() < 1e-9 && three.disagreement < 1e-8 && three.or.is_none());
        let four = from_amplitudes(v0.norm(), trial, &[run(10.0), run(95.0), run(180.0), run(300.0)]).unwrap();
        assert!((four.weight - truth).norm() / truth.norm() < 1e-9);
        let two = from_amplitudes(v0.norm(), trial, &[run(0.0), run(90.0)]).unwrap();
        let off = [two.weight, two.or.unwrap()].map(|w| (w - truth).norm() / truth.norm());
        // where the circles nearly touch, the root of rounding
        assert!(off[0].min(off[1]) < 1e-5, "{off:?}");
        let wrong = [run(0.0), run(120.0), (240_f64.to_radians(), 2.0 * run(240.0).1 + 1.0)];
        let found = from_amplitudes(v0.norm(), trial, &wrong);
        noticed += u32::from(found.is_err() || found.is_ok_and(|found| found.disagreement > 0.1));
    }
    // A wrong amplitude can by chance be that of another rotor: a tenth of the effect's square on either side.
    assert!(noticed >= 180, "{noticed}");
    assert_eq!(from_amplitudes(1.0, 1.0, &[(0.0, 1.1), (0.0, 1.2), (0.0, 1.3)]), Err(Error::TrialAngles));
}

/// A residual of exactly what a grade permits is within it, in both numbers; the next number above is not.
#[test]
fn grades_end_to_the_last_place() {
    for known in GRADES {
        for (mass, speed) in [(12.0, 154.985), (25.0, 314.159), (0.3, 7330.38), (1800.0, 15.7)] {
            let tolerance = BalanceTolerance { grade: known, mass, speed };
            let most = tolerance.permissible().unwrap();
            let verdict = tolerance.judge(most).unwrap();
            assert!(verdict.passed && verdict.fulfils == Some(known), "{known} {verdict:?}");
            let verdict = tolerance.judge(most.next_up()).unwrap();
            assert!(!verdict.passed && verdict.fulfils != Some(known), "{known} {verdict:?}");
            let tolerance = BalanceTolerance { grade: known as f32, mass: mass as f32, speed: speed as f32 };
            let verdict = tolerance.judge(tolerance.permissible().unwrap()).unwrap();
            assert!(verdict.passed && verdict.fulfils == Some(known as f32), "{known} {verdict:?}");
        }
    }
}

/// Runs that contradict each other: their amplitudes' squares are `v0^2 + (1 + d) x^2 + 2 v0 x cos`, by a part d of the
/// effect's square too large.
#[test]
fn runs_that_contradict_each_other_say_by_how_much() {
    let (v0, effect) = (2.0, Complex::from_polar(0.7, 0.4));
    let amplitude = |degrees: f64, d: f64| {
        let alpha = degrees.to_radians();
        let turned = effect * Complex::from_polar(1.0, alpha);
        (alpha, (v0 * v0 + (1.0 + d) * effect.norm_sqr() + 2.0 * v0 * turned.re).sqrt())
    };
    for d in [0.0, 0.03, -0.2] {
        for angles in [&[0.0, 120.0, 240.0][..], &[20.0, 80.0, 200.0, 290.0]] {
            let runs: Vec<(f64, f64)> = angles.iter().map(|angle| amplitude(*angle, d)).collect();
            let found = from_amplitudes(v0, 5.0, &runs).unwrap();
            // some roundings over the effect's share of the amplitude
            assert!((found.disagreement - f64::abs(d)).abs() < 1e-13, "{d} {found:?}");
            let expected = -Complex::new(v0 * 5.0, 0.0) / effect;
            assert!((found.weight - expected).norm() < 1e-13 * expected.norm(), "{found:?} {expected}");
        }
    }
}

/// Two runs a quarter turn apart: the centres of their circles are `v0 sqrt 2` apart, and a reading error may leave the
/// circles apart by a hundredth of that, squared.
#[test]
fn two_circles_that_hardly_meet() {
    let runs = |height: f64| {
        let r = 3.0 * (2.0 * (0.25 + height)).sqrt();
        from_amplitudes(3.0, 1.0, &[(0.0, r), (std::f64::consts::FRAC_PI_2, r)])
    };
    let touching = runs(-0.009).unwrap();
    assert_eq!(touching.or, Some(touching.weight));
    assert_eq!(runs(-0.011), Err(Error::AmplitudesDisagree));
    assert_ne!(runs(1e-3).unwrap().or, Some(runs(1e-3).unwrap().weight));
    // 1.5e-3 rad apart, and half of that
    for (angle, is_found) in [(1.5e-3, true), (0.75e-3, false)] {
        let v = Complex::new(3.0, 0.0) + Complex::new(0.0, 1.0);
        let turned = Complex::new(3.0, 0.0) + Complex::new(0.0, 1.0) * Complex::from_polar(1.0, angle);
        let found = from_amplitudes(3.0, 1.0, &[(0.0, v.norm()), (angle, turned.norm())]);
        assert_eq!(found.is_ok(), is_found, "{angle} {found:?}");
    }
}

/// An effect of less than 1e-6 of the baseline is none: it is the rounding of the amplitudes' squares.
#[test]
fn amplitudes_that_the_trial_hardly_changes_are_refused() {
    for (effect, is_found) in [(1.1e-6, true), (0.9e-6, false)] {
        let run = |degrees: f64| {
            let alpha = degrees.to_radians();
            (alpha, (Complex::new(4.0, 0.0) + Complex::from_polar(4.0 * effect, alpha)).norm())
        };
        let found = from_amplitudes(4.0, 1.0, &[run(0.0), run(120.0), run(240.0)]);
        assert_eq!(found.is_ok(), is_found, "{found:?}");
        assert!(is_found || found == Err(Error::NoEffect { plane: 0 }));
    }
}
