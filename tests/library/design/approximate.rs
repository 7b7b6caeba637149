//! Cheaper steps against the closed forms of their poles.

use driveline::design::{ApproximateStep, SemiImplicitStep, StepChoice};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use serde_json::Value;

fn machine(w: f64, zeta: f64) -> TwoMass {
    // Reduced inertia 0.5: k = 0.5 w^2, d = 2 zeta w 0.5.
    TwoMass::new(Inertia(1.0), Inertia(1.0), Stiffness(0.5 * w * w), Damping(zeta * w))
}

/// Undamped, the semi-implicit step turns by `2 asin(w T/2)`, the trapezoidal one by `2 atan(w T/2)` per tick, neither
/// losing a swing; forward Euler's poles are `1 +- i w T`.
#[test]
fn undamped_poles() {
    let t = 1e-3;
    for angle in [1e-3, 0.05, 0.3, 1.0, 1.9] {
        let shaft = machine(angle / t, 0.0);
        let semi = SemiImplicitStep::new(&shaft, t).fidelity;
        let tustin = ApproximateStep::tustin(&shaft, t).fidelity;
        let euler = ApproximateStep::forward_euler(&shaft, t).fidelity;
        // The angle of a pole next to 1 loses the digits that it is small by.
        let limit = 1e-14 / angle;
        assert!((semi.frequency_error - (2.0 * (0.5 * angle).asin() / angle - 1.0)).abs() < limit);
        assert!((tustin.frequency_error - (2.0 * (0.5 * angle).atan() / angle - 1.0)).abs() < limit);
        assert!(semi.damping_error.abs() < limit && tustin.damping_error.abs() < limit);
        assert!(semi.stable && tustin.stable && !euler.stable);
        assert!((euler.spectral_radius - 1.0_f64.hypot(angle)).abs() < 1e-15);
        assert_eq!(euler.error_bound, f64::INFINITY);
    }
    // The semi-implicit step's limit is w T = 2.
    assert!(!SemiImplicitStep::new(&machine(2.01 / t, 0.0), t).fidelity.stable);
}

/// Damped: the semi-implicit poles have the product `1 - c` and the sum `2 - c - (w T)^2`, c = 2 zeta w T.
#[test]
fn damped_poles() {
    let t = 1e-3;
    for (angle, zeta) in [(0.1_f64, 0.05), (0.5, 0.3), (0.2, 0.7)] {
        let fidelity = SemiImplicitStep::new(&machine(angle / t, zeta), t).fidelity;
        let c = 2.0 * zeta * angle;
        let (size, half) = ((1.0 - c).sqrt(), 1.0 - 0.5 * (c + angle * angle));
        let (decay, turn) = (-size.ln(), (half / size).acos());
        let whole = decay.hypot(turn);
        // asin, acos and logarithms near 1 lose two digits.
        assert!((fidelity.frequency_error - (whole / angle - 1.0)).abs() < 1e-13);
        assert!((fidelity.damping_error - (decay / whole - zeta)).abs() < 1e-13);
    }
}

#[test]
fn forward_euler_meets_the_reference() {
    let path = format!("{}/tests/data/discretisation.json", env!("CARGO_MANIFEST_DIR"));
    let file: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let case = file["cases"].as_array().unwrap().iter().find(|c| c["id"] == "B03_mill_undamped_Ts0.001").unwrap();
    let at = |key: &str| case[key].as_f64().unwrap();
    let mill = TwoMass::new(
        Inertia(at("J_motor_kg_m2")),
        Inertia(at("J_load_kg_m2")),
        Stiffness(at("k_Nm_rad")),
        Damping(0.0),
    );
    let euler = ApproximateStep::forward_euler(&mill, at("Ts_s"));
    let expected = case["elastic"]["spectral_radius_forward_euler"].as_f64().unwrap();
    assert!((euler.fidelity.spectral_radius - expected).abs() < 1e-14);
}

/// Halving the tick halves the semi-implicit error (it is of first order) and quarters the trapezoidal one.
#[test]
fn orders_of_convergence() {
    let shaft = machine(100.0, 0.02);
    let semi = |t| SemiImplicitStep::new(&shaft, t).fidelity.error_bound;
    let tustin = |t| ApproximateStep::tustin(&shaft, t).fidelity.error_bound;
    let t = 5e-4;
    // The next order of the expansion is w T = 5 % of the first.
    assert!((semi(t) / semi(0.5 * t) - 2.0).abs() < 0.1);
    assert!((tustin(t) / tustin(0.5 * t) - 4.0).abs() < 0.2);
}

/// A slow shaft takes the cheap step at a high rate, and the exact one at a low rate.
#[test]
fn the_error_chooses_the_step() {
    let crane = machine(core::f64::consts::TAU * 3.0, 0.02);
    let choose = |t| StepChoice::choose(&SemiImplicitStep::new(&crane, t), StepChoice::THRESHOLD);
    assert_eq!(choose(1e-4), StepChoice::SemiImplicit);
    assert_eq!(choose(1e-2), StepChoice::Exact);
}
