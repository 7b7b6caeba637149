//! The speed loop against its own specification: the poles asked for. Its margins are in `closed_loop.rs`.

use driveline::design::{
    Error, Matrix, Rate, SpeedLoopDesign, SpeedLoopTuning, discretise, eigenvalues, spectral_radius,
};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

fn rig(damping: f64) -> TwoMass {
    // Saarakkala and Hinkkanen 2015: two equal masses, 60 Hz antiresonance, 84 Hz resonance.
    TwoMass::new(Inertia(0.005), Inertia(0.005), Stiffness(700.0), Damping(damping))
}

/// Characteristic polynomial of the undamped machine in continuous time, with the designed gains, against the product
/// of the two quadratics that were asked for.
#[test]
fn gains_place_the_poles() {
    for (load, tuning) in [
        (0.005, SpeedLoopTuning::USUAL),
        (0.05, SpeedLoopTuning { bandwidth: 0.7, damping: 0.8, shaft_damping: 0.3 }),
        (0.001, SpeedLoopTuning { bandwidth: 0.2, damping: 1.2, shaft_damping: 0.5 }),
        // above the resonance
        (0.0027, SpeedLoopTuning { bandwidth: 4.0, damping: 1.0, shaft_damping: 0.03 }),
        (0.05, SpeedLoopTuning { bandwidth: 3.5, damping: 0.8, shaft_damping: 0.1 }),
    ] {
        let machine = TwoMass::new(Inertia(0.005), Inertia(load), Stiffness(700.0), Damping(0.0));
        let design = machine.speed_loop(Rate::hz(20_000), tuning);
        let jm = machine.motor_inertia;
        let (kp, ki, kv) = (design.proportional / jm, design.integral / jm, design.damping / jm);
        let (wa2, wr2) = (700.0 / load, 700.0 * (1.0 / 0.005 + 1.0 / load));
        let found = [kp + kv, ki + wr2, kp * wa2, ki * wa2];
        let (w1, w2) = (tuning.bandwidth * wa2.sqrt(), design.shaft_frequency);
        let (a, b) = (2.0 * tuning.damping * w1, 2.0 * tuning.shaft_damping * w2);
        let expected = [a + b, w1 * w1 + w2 * w2 + a * b, a * w2 * w2 + b * w1 * w1, (w1 * w2).powi(2)];
        for (f, e) in found.iter().zip(expected) {
            // Some ten roundings, and a difference of k_p in k_v.
            assert!((f / e - 1.0).abs() < 1e-13, "{found:?} {expected:?}");
        }
    }
}

/// Spectral radius of the closed loop of `[w_m, twist, w_l, integral, torque]`, built from the general exponential, the
/// torque one tick late.
fn radius(machine: &TwoMass, design: &SpeedLoopDesign) -> f64 {
    let (jm, jl, k, d) = (machine.motor_inertia, machine.load_inertia, machine.stiffness, machine.damping);
    let a = Matrix([[-d / jm, -k / jm, d / jm], [1.0, 0.0, -1.0], [d / jl, k / jl, -d / jl]]);
    let (f, g) = discretise::<3, 1, 4>(&a, &Matrix([[1.0 / jm], [0.0], [0.0]]), design.period).unwrap();
    let (p, i, v) = (design.proportional, design.integral * design.period, design.damping);
    let mut loop_ = Matrix::<5, 5>::ZERO;
    for row in 0..3 {
        loop_.0[row][..3].copy_from_slice(&f.0[row]);
        loop_.0[row][4] = g.0[row][0];
    }
    loop_.0[3] = [i, 0.0, 0.0, 1.0, 0.0];
    loop_.0[4] = [-(p + i + v), 0.0, v, -1.0, 0.0];
    spectral_radius(&eigenvalues(&loop_))
}

/// The loop built here from the exponential has the radius that the design tells.
#[test]
fn the_closed_loop_has_the_radius_that_the_design_tells() {
    for damping in [0.01, 0.2] {
        for tuning in [SpeedLoopTuning::USUAL, SpeedLoopTuning { bandwidth: 0.6, damping: 0.8, shaft_damping: 0.5 }] {
            let machine = rig(damping);
            let design = machine.speed_loop(Rate::hz(4000), tuning);
            assert!((radius(&machine, &design) - design.spectral_radius).abs() < 1e-9);
        }
    }
}

#[test]
fn errors_name_the_parameter() {
    let design = |rate, tuning| rig(0.01).try_speed_loop(Rate::hz(rate), tuning).unwrap_err();
    let usual = SpeedLoopTuning::USUAL;
    // from the antiresonance to the resonance
    for bandwidth in [1.0, 1.2, 2.0_f64.sqrt(), f64::INFINITY] {
        assert_eq!(design(4000, SpeedLoopTuning { bandwidth, ..usual }), Error::Bandwidth);
    }
    assert_eq!(design(4000, SpeedLoopTuning { damping: 0.0, ..usual }), Error::DampingRatio);
    assert_eq!(design(0, usual), Error::Period);
    // 200 ticks a second cannot damp 84 Hz.
    assert_eq!(design(200, usual), Error::SpeedLoopUnstable);
    assert_eq!(Error::SpeedLoopUnstable.to_string(), Error::SpeedLoopUnstable.message());
}

/// A member's loop has the active damping that its family states, and no more bandwidth than it may; what is no ratio
/// and no bandwidth is refused with its own sentence.
#[test]
fn a_limited_loop_has_the_active_damping_that_is_stated() {
    let machine = rig(0.01);
    let of = |bandwidth: f64, ratio: f64| machine.try_limited_speed_loop(Rate::hz(20_000), bandwidth, ratio);
    let slow = 0.2 * machine.antiresonance();
    for ratio in [0.05, 0.1, 0.25, 0.5] {
        let design = of(slow, ratio).unwrap();
        // forty halvings of six decades: to 1e-11 in the damping ratio, a few times that in the gains
        assert!((design.damping / design.proportional / ratio - 1.0).abs() < 1e-9, "{ratio}: {design:?}");
        assert!((design.bandwidth / slow - 1.0).abs() < 1e-15);
    }
    let fast = of(10.0 * slow, 0.1).unwrap();
    assert!((fast.bandwidth / machine.antiresonance() - SpeedLoopTuning::USUAL.bandwidth).abs() < 1e-15);
    let tuning = SpeedLoopTuning::of(&machine);
    assert_eq!(fast, machine.speed_loop(Rate::hz(20_000), tuning));
    for ratio in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(of(slow, ratio), Err(Error::TwistGain), "{ratio}");
        assert!(Error::TwistGain.to_string().starts_with("the gain on the twist rate must be above zero"));
    }
    for bandwidth in [-1.0, 0.0, f64::NAN] {
        assert_eq!(of(bandwidth, 0.1), Err(Error::Bandwidth), "{bandwidth}");
    }
}
