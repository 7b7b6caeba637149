//! Constants that a number does not hold are refused, in floats as in fixed point.

use crate::hoist::Hoist;
use driveline::configure::Machine as _;
use driveline::design::{
    Disturbance, Encoder, Rate, RigidDesign, SpeedLoopDesign, StepChoice, TorqueCurve, TwoMassDesign,
};
use driveline::governor::{CurveConfig, SpeedLoopConfig};
use driveline::machine::{Chain, Damping, Error as MachineError, Inertia, Match, Rigid, Stiffness};
use driveline::observer::{RigidConfig, SemiImplicitConfig, TwoMassConfig};
use driveline::settings::{Bases, Error, SpeedLoopSettings};

const TWO_MASS: TwoMassDesign = Hoist::<10_000>::OBSERVER;
const RIGID: RigidDesign = Hoist::<10_000>::RIGID_OBSERVER;
const LOOP: SpeedLoopDesign = Hoist::<10_000>::SPEED_LOOP;
const SI: Bases = Bases::SI;

/// Finite in `f64`, and twice what an `f32` can hold.
const LARGE: f64 = 2.0 * f32::MAX as f64;

#[test]
fn observers_whose_gains_a_float_does_not_hold_are_refused() {
    for gain in [f64::NAN, f64::INFINITY, -f64::INFINITY, LARGE * 1e12] {
        for k in 0..5 {
            let mut bad = TWO_MASS;
            bad.gains[k] = gain;
            assert!(matches!(TwoMassConfig::<f32>::try_new(&bad, SI), Err(Error::Coefficient(_))), "{k}: {gain}");
            assert!(matches!(SemiImplicitConfig::<f32>::try_new(&bad, SI), Err(Error::Coefficient(_))), "{k}: {gain}");
        }
        for k in 0..3 {
            let mut bad = RIGID;
            bad.gains[k] = gain;
            assert!(matches!(RigidConfig::<f32>::try_new(&bad, 0.5, SI), Err(Error::Coefficient(_))), "{k}: {gain}");
        }
    }
    let mut bad = TWO_MASS;
    bad.step.n21 = LARGE;
    assert!(matches!(TwoMassConfig::<f32>::try_new(&bad, SI), Err(Error::Coefficient(_))));
    assert!(TwoMassConfig::<f64>::try_new(&bad, SI).is_ok(), "a double holds it");
}

#[test]
fn a_speed_loop_that_a_float_does_not_hold_is_refused() {
    let settings = SpeedLoopSettings { torque_limit: 1_350.0, ramp: 77.5 };
    for bad in [
        SpeedLoopDesign { proportional: f64::NAN, ..LOOP },
        SpeedLoopDesign { proportional: LARGE, ..LOOP },
        SpeedLoopDesign { integral: f64::INFINITY, ..LOOP },
        SpeedLoopDesign { damping: -LARGE, ..LOOP },
        SpeedLoopDesign { proportional: 0.0, ..LOOP },
    ] {
        assert!(matches!(SpeedLoopConfig::<f32>::try_new(&bad, settings, SI), Err(Error::Coefficient(_))), "{bad:?}");
    }
}

#[test]
fn a_torque_curve_that_a_float_does_not_hold_is_refused() {
    // a point, and a slope between two points that it does hold
    for points in [[[0.0, LARGE], [100.0, 50.0]], [[0.0, 0.0], [1e-3, 1e37]]] {
        let curve = TorqueCurve::through(points);
        assert!(CurveConfig::<f32, 2>::try_new(&curve, 0.0, SI).is_err(), "{points:?}");
        assert!(CurveConfig::<f64, 2>::try_new(&curve, 0.0, SI).is_ok(), "{points:?}");
    }
}

#[test]
fn the_semi_implicit_step_against_the_designs_choice_is_to_be_named() {
    let chosen = TWO_MASS.with_step(StepChoice::Exact);
    let refused = SemiImplicitConfig::<f32>::try_new(&chosen, SI).unwrap_err();
    assert!(refused.message().contains("with_step(StepChoice::SemiImplicit)"), "{refused}");
    assert!(SemiImplicitConfig::<f32>::try_new(&chosen.with_step(StepChoice::SemiImplicit), SI).is_ok());
}

/// Machines and disturbances of any size: a design is refused, or its deviations and errors are numbers.
#[test]
fn no_design_has_an_error_that_is_not_a_number() {
    const SIZES: [f64; 7] = [1e-300, 1e-30, 1e-9, 1.0, 1e9, 1e30, 1e300];
    let mut sound = [0; 2];
    for a in SIZES {
        for b in SIZES {
            for c in SIZES {
                let disturbance = Disturbance { torque_accuracy: a, load_torque_step: b, within: 1.0 };
                let rigid = Rigid::try_new(Inertia(c)).unwrap();
                if let Ok(design) = rigid.try_observer(Rate::hz(10_000), Encoder::counts(8192), disturbance) {
                    assert!(design.standard_deviation.iter().all(|deviation| deviation.is_finite()), "{a} {b} {c}");
                    sound[0] += 1;
                }
                let chain = Chain::motor(Inertia(1.0)).shaft(Stiffness(a), Damping(0.0)).rotor(Inertia(b));
                let chain = chain.shaft(Stiffness(c), Damping(0.0)).rotor(Inertia(1.0));
                match chain.try_reduce(Match::ResonanceAntiresonance) {
                    Ok(two) => {
                        let error = two.error;
                        assert!(!error.next_mode.is_nan() && error.worst.is_finite(), "{a} {b} {c}: {error:?}");
                        assert!(error.compliance.is_finite() && error.next_share.is_finite(), "{a} {b} {c}: {error:?}");
                        sound[1] += 1;
                    }
                    Err(error) => assert_eq!(error, MachineError::Reduction),
                }
            }
        }
    }
    assert!(sound.iter().all(|&sound| sound > 20), "{sound:?}");
}
