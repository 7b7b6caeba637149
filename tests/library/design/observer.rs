//! Observers of two masses and of a rigid machine.

use driveline::design::{Disturbance, Encoder, Error, Rate};
use driveline::machine::{Damping, Inertia, Rigid, Stiffness, TwoMass};
use serde_json::Value;

use super::number;
use crate::references::data;

const DISTURBANCE: Disturbance = Disturbance { torque_accuracy: 0.5, load_torque_step: 50.0, within: 0.05 };

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

fn apart(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

#[test]
fn observers_meet_seventy_digits() {
    for case in data("observers.json")["cases"].as_array().unwrap() {
        let at = |key: &str| number(&case[key]);
        let machine = TwoMass::new(Inertia(at("J_motor")), Inertia(at("J_load")), Stiffness(at("k")), Damping(at("d")));
        let disturbance = Disturbance {
            torque_accuracy: at("torque_accuracy"),
            load_torque_step: at("load_torque_step"),
            within: at("within"),
        };
        let found =
            machine.try_observer(Rate::every(at("period")), Encoder::counts(at("counts") as u32), disturbance).unwrap();

        // Each row of the transition against its largest element, states in units of their own motion in a tick.
        let t = at("period");
        let s = [1.0, t, 1.0, t, t * t / at("J_load").min(at("J_motor"))];
        let mut transition: f64 = 0.0;
        for i in 0..5 {
            let expected = numbers(&case["F"][i]);
            let largest = (0..5).map(|j| (expected[j] / s[j]).abs()).fold(0.0, f64::max);
            for j in 0..5 {
                transition = transition.max((found.transition.0[i][j] - expected[j]).abs() / s[j] / largest);
            }
        }
        let input = found.input.iter().zip(numbers(&case["B"])).take(4).map(|(b, e)| apart(*b, e)).fold(0.0, f64::max);
        let gain = found.gains.iter().zip(numbers(&case["gain"])).map(|(k, e)| apart(*k, e)).fold(0.0, f64::max);
        let sd = &found.standard_deviation;
        let deviation = [sd.motor_angle, sd.motor_speed, sd.twist, sd.load_speed, sd.load_torque]
            .iter()
            .zip(numbers(&case["posterior_std"]))
            .map(|(s, e)| apart(*s, e))
            .fold(apart(sd.shaft_torque, at("shaft_torque_std")), f64::max)
            .max(apart(found.innovation, at("innovation_std")));
        let radius = apart(found.spectral_radius, at("spectral_radius"));
        println!(
            "{}: F {transition:.1e} B {input:.1e} K {gain:.1e} deviations {deviation:.1e} radius {radius:.1e} chosen \
                {:?} {:.2e}",
            case["id"], found.chosen, found.semi_implicit.fidelity.error_bound
        );
        // Ten roundings of 1.1e-16 for the transition; sines of up to two radians add as much.
        assert!(transition < 3e-15 && input < 1e-14);
        // The Riccati equation magnifies the roundings of F by the number of ticks that the filter looks back on, some
        // hundreds: 1e-13. What the gains are stored in, f32 or 32-bit fixed point, keeps 6e-8.
        assert!(gain < 1e-12 && deviation < 1e-12);
        assert!(radius < 1e-13);
        for pole in case["poles"].as_array().unwrap() {
            let pole = numbers(pole);
            let near = found.poles.iter().map(|p| (p.0 - pole[0]).hypot(p.1 - pole[1])).fold(f64::INFINITY, f64::min);
            // Five poles within a few hundredths of 1: they move by many times a change in the gains.
            assert!(near < 1e-11, "{pole:?}, {near:e}");
        }
    }
}

/// With torque noise away, the steady gains of a rigid machine follow from the load torque's walk alone: the poles of
/// such a triple integrator lie at `w exp(+-i pi/3)` and `w`, on a circle [Anderson and Moore, Optimal Filtering, §4].
#[test]
fn rigid_observer_has_the_poles_of_a_triple_integrator() {
    let (inertia, t, counts) = (0.75, 1.0e-4, 8192_u32);
    let quiet = Disturbance { torque_accuracy: 1e-9, load_torque_step: 50.0, within: 0.05 };
    let design = Rigid::new(Inertia(inertia)).observer(Rate::hz(10_000), Encoder::counts(counts), quiet);
    // Continuous equivalent: q/(J^2 s^6) = -r, q the walk's intensity, r the measurement's variance times T.
    let r = (core::f64::consts::TAU / f64::from(counts)).powi(2) / 12.0 * t;
    let w = (50.0_f64.powi(2) / 0.05 / inertia.powi(2) / r).powf(1.0 / 6.0);
    for pole in design.poles {
        let s = (pole.0.hypot(pole.1).ln() / t).hypot(pole.1.atan2(pole.0) / t);
        println!("{s} {w}");
        // A sampled filter differs from the continuous one by powers of w T = 0.05; the first drops out on the circle.
        assert!(apart(s, w) < (w * t).powi(2));
    }
}

#[test]
fn errors_name_the_parameter() {
    let rate = Rate::hz(1000);
    let encoder = Encoder::lines(1024);
    let machine = |k, d| TwoMass::new(Inertia(1.0), Inertia(1.0), Stiffness(k), Damping(d));
    let design = |m: TwoMass, r, e, d| m.try_observer(r, e, d).unwrap_err();
    let cases = [
        (design(machine(0.0, 0.0), rate, encoder, DISTURBANCE), Error::Unobservable),
        (design(machine(1e8, 1.0), rate, encoder, DISTURBANCE), Error::SampleRate),
        (design(machine(1e4, 0.0), Rate::hz(0), encoder, DISTURBANCE), Error::Period),
        (design(machine(1e4, 0.0), rate, Encoder::lines(0), DISTURBANCE), Error::EncoderLines),
        (
            design(machine(1e4, 0.0), rate, encoder, Disturbance { torque_accuracy: 0.0, ..DISTURBANCE }),
            Error::TorqueAccuracy,
        ),
        (
            design(machine(1e4, 0.0), rate, encoder, Disturbance { load_torque_step: f64::NAN, ..DISTURBANCE }),
            Error::LoadTorqueStep,
        ),
        (design(machine(1e4, 0.0), rate, encoder, Disturbance { within: -1.0, ..DISTURBANCE }), Error::Within),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
        assert_eq!(found.to_string(), expected.message());
    }
    // A stiff shaft with a strong damper: above half the rate, but it leaves nothing to follow.
    assert!(machine(1e8, 1e4).try_observer(rate, encoder, DISTURBANCE).is_ok());
}

/// An encoder so fine, beside a load torque so rough, that a variance of the speed is lost in roundings: the design is
/// refused where its deviation would be no number.
#[test]
fn a_deviation_that_is_no_number_is_refused() {
    let design = |lines| {
        let disturbance = Disturbance { torque_accuracy: 10.0, load_torque_step: 1e5, within: 0.1 };
        Rigid::new(Inertia(1e-4)).try_observer(Rate::hz(1000), Encoder::lines(lines), disturbance)
    };
    assert_eq!(design(1 << 21), Err(Error::NotConverged));
    let coarse = design(1 << 11).unwrap();
    assert!(coarse.standard_deviation.iter().all(|deviation| deviation.is_finite()), "{coarse:?}");
}
