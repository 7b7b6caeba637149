//! The semi-implicit step against the closed forms of its poles.

use driveline::design::{SemiImplicitStep, StepChoice};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

fn machine(w: f64, zeta: f64) -> TwoMass {
    // Reduced inertia 0.5: k = 0.5 w^2, d = 2 zeta w 0.5.
    TwoMass::new(Inertia(1.0), Inertia(1.0), Stiffness(0.5 * w * w), Damping(zeta * w))
}

/// Undamped, the semi-implicit step turns by `2 asin(w T/2)` per tick, without losing a swing.
#[test]
fn undamped_poles() {
    let t = 1e-3;
    for angle in [1e-3, 0.05, 0.3, 1.0, 1.9] {
        let semi = SemiImplicitStep::new(&machine(angle / t, 0.0), t).fidelity;
        // The angle of a pole next to 1 loses the digits that it is small by.
        let limit = 1e-14 / angle;
        assert!((semi.frequency_error - (2.0 * (0.5 * angle).asin() / angle - 1.0)).abs() < limit);
        assert!(semi.damping_error.abs() < limit && semi.stable);
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

/// Halving the tick halves the error: it is of first order.
#[test]
fn orders_of_convergence() {
    let shaft = machine(100.0, 0.02);
    let semi = |t| SemiImplicitStep::new(&shaft, t).fidelity.error_bound;
    let t = 5e-4;
    // The next order of the expansion is w T = 5 % of the first.
    assert!((semi(t) / semi(0.5 * t) - 2.0).abs() < 0.1);
}

/// A slow shaft takes the cheap step at a high rate, and the exact one at a low rate.
#[test]
fn the_error_chooses_the_step() {
    let crane = machine(core::f64::consts::TAU * 3.0, 0.02);
    let choose = |t| StepChoice::choose(&SemiImplicitStep::new(&crane, t), StepChoice::THRESHOLD);
    assert_eq!(choose(1e-4), StepChoice::SemiImplicit);
    assert_eq!(choose(1e-2), StepChoice::Exact);
}
