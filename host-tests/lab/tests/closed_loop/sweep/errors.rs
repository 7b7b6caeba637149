//! The two-mass steps over stiff and extreme machines, against an exact motion of own arithmetic.

use driveline_lab::sweep::{Cause, Place, Reference, STEPS, errors, growths, places};

/// Most ticks that a place is run for.
const LONGEST: u64 = 20_000;

/// A sweep of omega T, inertia ratio and damping: whatever is beyond its bound has a cause that is known.
#[test]
fn every_failure_is_explained() {
    for place in places() {
        for (outcome, step) in errors(&place, LONGEST).iter().zip(STEPS) {
            assert_ne!(outcome.cause, Some(Cause::Unexplained), "{step:?} at {place:?}: {outcome:?}");
        }
    }
}

/// The exact step in `f64` is within rounding of the truth everywhere; in `f32` nothing of it is off by more than a
/// thousandth; in fixed point the same holds where a tick moves at least 1e-4 of a swing and the inertias are within a
/// factor of a thousand.
#[test]
fn the_exact_step_holds_everywhere() {
    for place in places() {
        let [single, fixed, double, ..] = errors(&place, LONGEST);
        assert_eq!(double.cause, None, "{place:?}: {double:?}");
        // 20 000 ticks, each with a rounding of 6e-8 that repeats: 1.2e-3.
        assert!(single.error < 1.2e-3, "{place:?}: {single:?}");
        let ordinary = (1e-3..=1e3).contains(&place.inertia_ratio) && place.slowest() > 0.9e-4;
        // Likewise 20 000 ticks of half of 2^-28, of bases up to fifty times what moves.
        assert!(!ordinary || fixed.error < 2e-3, "{place:?}: {fixed:?}");
    }
}

/// Where the design chooses the semi-implicit step, its error is within the 1 % that it is chosen by, `f64` and `f32`
/// alike.
#[test]
fn the_semi_implicit_step_keeps_its_word() {
    for place in places() {
        let [_, _, _, single, _, double] = errors(&place, LONGEST);
        for outcome in [single, double] {
            assert!(matches!(outcome.cause, None | Some(Cause::NotChosen)), "{place:?}: {outcome:?}");
        }
    }
}

/// No damped machine swings up, whatever the number; nor does an undamped one in `f64`, or by the semi-implicit step.
#[test]
fn stored_coefficients_do_not_grow() {
    for place in places() {
        for (index, (growth, step)) in growths(&place).iter().zip(STEPS).enumerate() {
            let known = matches!(growth.cause, None | Some(Cause::NotChosen | Cause::Refused));
            // Rounded coefficients of an undamped pair: f32 and fixed, exact step.
            let undamped = place.damping == 0.0 && index < 2 && growth.cause == Some(Cause::Coefficients);
            assert!(known || undamped, "{step:?} at {place:?}: {growth:?}");
        }
    }
}

/// Undamped, from rest under a load torque: `tau_s = tau_L (J_m/J)(1 - cos omega t)`, the load's speed by the momentum.
#[test]
fn the_reference_meets_the_closed_form() {
    for omega_t in [1e-4, 0.03, 1.0, 40.0] {
        let place = Place { omega_t, inertia_ratio: 3.0, damping: 0.0 };
        let machine = place.machine();
        let share = machine.motor_inertia / machine.total_inertia();
        let mut reference = Reference::new(&place, 2.0);
        for tick in 1..=1000 {
            reference.tick(0.0);
            let angle = omega_t * f64::from(tick);
            let truth = reference.state();
            let torque = 2.0 * share * (1.0 - angle.cos());
            // Each tick turns by omega T with an error of some roundings of it.
            let limit = 1e-15 * f64::from(tick) * omega_t.max(1.0) * 4.0;
            assert!((truth.shaft_torque - torque).abs() < limit, "{angle}: {} {torque}", truth.shaft_torque);
            let momentum = machine.motor_inertia * truth.motor_speed + machine.load_inertia * truth.load_speed;
            let impulse = -2.0 * 1e-4 * f64::from(tick);
            assert!((momentum - impulse).abs() < 1e-12 * impulse.abs());
        }
    }
}
