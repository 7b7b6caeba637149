//! Gains at the points of a schedule, against the Riccati equation's.

use crate::hoist::Hoist;
use driveline::configure::{Family, Machine};
use driveline::design::{Disturbance, Error, PlacedObserver, Rate};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use nalgebra::{Complex, DMatrix, DVector};

type Known = Hoist<10_000>;

/// By the noise of the torque in a tick, an observer ten times as fast as the scene's.
const LIVELY: Disturbance = Disturbance { torque_accuracy: 7.5, load_torque_step: 300.0, within: 50.0 };

/// The pole of the continuous filter furthest out, 220 rad/s, turns by 0.02 rad in a tick at 10 kHz and by 0.2 rad at
/// 1 kHz; the sampled filter's gains differ by the square of that: 0.05 % and 5 %.
#[test]
fn gains_at_the_points_are_the_kalman_filters() {
    for (rate_hz, limit) in [(10_000, 5e-4), (1_000, 0.05)] {
        for member in [(0, 0), (0, 3), (2, 1), (4, 0), (4, 3)].map(|(i, j)| Known::MEMBERS[i][j]) {
            let scale = member.load_inertia / Known::TWO_MASS.load_inertia;
            let disturbance = Disturbance { load_torque_step: 300.0 * scale, ..LIVELY };
            let rate = Rate::hz(rate_hz);
            let riccati = member.observer(rate, Known::ENCODER, disturbance);
            let placed = member.try_placed_observer(rate, Known::ENCODER, disturbance).unwrap();
            for (k, (placed, riccati)) in placed.gains.iter().zip(riccati.gains).enumerate() {
                assert!((placed / riccati - 1.0).abs() < limit, "{rate_hz} Hz, gain {k}: {placed} {riccati}");
            }
        }
    }
}

/// The poles of `(1 - K C) F`, by nalgebra, are where they were to be placed.
fn poles_lie_where_they_were_placed(machine: &TwoMass, observer: &PlacedObserver) {
    let whole = machine.observer(Known::RATE, Known::ENCODER, Known::DISTURBANCE).transition;
    let f = DMatrix::from_fn(5, 5, |i, j| whole.0[i][j]);
    let k = DVector::from_row_slice(&observer.gains);
    let error = &f - &k * f.row(0);
    for (re, im) in observer.poles {
        // |det(error - z)| is the product of the distances of z from the five poles, next to 1 - 1e-2
        let z = Complex::new(1.0 + re, im);
        let shifted = error.map(|x| Complex::new(x, 0.0)) - DMatrix::identity(5, 5) * z;
        let others = observer.poles.iter().map(|other| (re - other.0).hypot(im - other.1)).filter(|&far| far > 0.0);
        let distance = shifted.determinant().norm() / others.product::<f64>();
        // of poles 1e-3 from one another, from entries with the rounding of 1: 1e-16/(1e-3)^2, with room
        assert!(distance < 1e-7, "{distance:e} from ({re}, {im})");
    }
}

#[test]
fn poles_are_where_they_were_placed() {
    for (member, observer) in Known::MEMBERS.iter().flatten().zip(Known::OBSERVERS.iter().flatten()) {
        poles_lie_where_they_were_placed(member, observer);
    }
}

/// Butterworth's polynomial of odd order has the left roots of `s^10 = 1`; in increments at 10 kHz, `z = 1 + s T`.
#[test]
fn a_bandwidth_is_the_radius_of_five_poles() {
    for bandwidth in [50.0, 200.0, 1_500.0] {
        let observer = Known::TWO_MASS.try_observer_of_bandwidth(Known::RATE, bandwidth).unwrap();
        poles_lie_where_they_were_placed(&Known::TWO_MASS, &observer);
        let roots = (3..8).map(|k| Complex::from_polar(bandwidth, std::f64::consts::PI * f64::from(k) / 5.0));
        for pole in roots.map(|root| 1.0 + root * 1e-4) {
            let nearest = observer.poles.iter().map(|&(re, im)| (Complex::new(1.0 + re, im) - pole).norm());
            // the rounding of 1
            assert!(nearest.fold(1.0, f64::min) < 1e-15, "{bandwidth}: {pole}");
        }
    }
}

/// `|1 + s T|` is 1 where `w T` is twice the sine of 18 degrees, 0.618034: at 10 kHz 6180.34 rad/s.
#[test]
fn a_bandwidth_out_of_range_is_refused() {
    let fastest = Known::TWO_MASS.try_observer_of_bandwidth(Known::RATE, 6_180.0).unwrap();
    let size = fastest.poles.map(|(re, im)| (1.0 + re).hypot(im)).into_iter().fold(0.0, f64::max);
    assert!(size < 1.0 && size > 0.9999, "{size}");
    for bandwidth in [0.0, -1.0, f64::NAN, f64::INFINITY, 6_180.4] {
        let refused = Known::TWO_MASS.try_observer_of_bandwidth(Known::RATE, bandwidth).unwrap_err();
        assert_eq!(refused, Error::ObserverBandwidth, "{bandwidth}");
    }
}

/// In 60 digits the poles of the machines here are within 3e-5 of the bandwidth from two thousandths of the resonance
/// on; without the check those at a hundred-thousandth of it were beyond the unit circle.
#[test]
fn poles_that_rounding_moves_are_refused() {
    let rate = Rate::hz(10_000);
    for machine in [
        TwoMass::new(Inertia(0.4), Inertia(0.5), Stiffness(2e4), Damping(1.0)),
        TwoMass::new(Inertia(1e-3), Inertia(1e-3), Stiffness(1e4), Damping(0.0)),
        TwoMass::new(Inertia(0.01), Inertia(5.0), Stiffness(1e5), Damping(0.0)),
        TwoMass::new(Inertia(5.0), Inertia(0.01), Stiffness(1e5), Damping(0.0)),
    ] {
        let resonance = machine.resonance();
        let place = |share: f64| machine.try_observer_of_bandwidth(rate, share * resonance);
        assert!(place(2e-3).is_ok() && place(0.1).is_ok(), "{machine:?}");
        assert_eq!(place(1e-5).unwrap_err(), Error::ObserverBandwidth, "{machine:?}");
    }
}

/// No faster than the heaviest load's loop, and the gain on the twist rate at most as stated.
#[test]
fn speed_loops_are_limited() {
    let points = Known::MEMBERS.iter().flatten().zip(Known::SPEED_LOOPS.iter().flatten());
    for ((member, design), damping) in points.zip(Known::DAMPING.iter().flatten()) {
        assert!(design.bandwidth <= Known::SPEED_LOOP.bandwidth * (1.0 + 1e-12));
        assert!(design.bandwidth <= 0.4 * member.antiresonance() * (1.0 + 1e-12));
        // the ratio is found to 1e-11
        assert!(design.damping <= (damping + 1e-9) * design.proportional && design.spectral_radius < 1.0);
    }
}
