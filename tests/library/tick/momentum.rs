//! Coasting keeps momentum: without corrections the mean speed changes by T (tau_m - tau_L)/J a tick and by nothing
//! else, however the shaft swings.

use crate::hoist::Hoist;
use driveline::configure::Machine as _;
use driveline::design::Rate;
use driveline::number::{Fixed, Number};
use driveline::observer::{Observer, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver};
use driveline::settings::Bases;

use super::rig::{BASES, REDUCED, Scaled};

/// Torque of each tick (N m): as much above the load's as below it, so that the shaft swings and no speed meets the
/// rails of fixed point.
fn torque(tick: u32) -> f64 {
    if (tick / 700).is_multiple_of(2) { 1_200.0 } else { -400.0 }
}

/// Coasts from a held torque and compares the mean speed with its closed form; `resolution` is a number's error in a
/// tick (rad/s).
fn coasts<N: Scaled, O: Observer<N>>(config: &O::Config, resolution: impl Fn(f64) -> f64) {
    let held = 400.0;
    let (jm, jl) = (REDUCED.motor_inertia, REDUCED.load_inertia);
    let period = Rate::hz(10_000).period().unwrap();
    let mut observer = O::at_rest(config, 0, N::of_torque(held));
    // What the number makes of the torques is what acts.
    let held = N::of_torque(held).torque();
    let (mut expected, mut swing, mut allowed) = (0.0, 0.0_f64, 0.0);
    for tick in 0..20_000 {
        let torque = N::of_torque(torque(tick));
        let predicted = observer.predict(config, 0, torque);
        observer.coast(predicted, 0);
        expected += period * (torque.torque() - held) / (jm + jl);
        let now = observer.estimate(config);
        let (motor, load) = (now.motor_speed.speed(), now.load_speed.speed());
        let mean = (jm * motor + jl * load) / (jm + jl);
        swing = swing.max((motor - load).abs());
        allowed += resolution(mean);
        assert!((mean - expected).abs() <= allowed, "in tick {tick}: {mean} instead of {expected}, +-{allowed}");
    }
    // The shaft did swing: by far more than what is allowed.
    assert!(swing > 5.0 && allowed < 0.02 * swing, "{swing} {allowed}");
}

/// Two roundings of a speed of up to a few hundred, one of a coefficient, and each is at most half a unit of 2^-24.
fn single(mean: f64) -> f64 {
    2.0 * f64::from(f32::EPSILON) * (mean.abs() + 0.2)
}

/// A unit in the last place of the base, and the coefficient's own half unit of 2^-32 of an accelerating torque of the
/// base.
fn fixed(_: f64) -> f64 {
    BASES.speed * (1.5 / 268_435_456.0)
}

#[test]
fn the_exact_step_keeps_momentum() {
    let design = Hoist::<10_000>::OBSERVER;
    coasts::<f32, TwoMassObserver<f32>>(&TwoMassConfig::<f32>::new(&design, Bases::SI), single);
    coasts::<Fixed, TwoMassObserver<Fixed>>(&TwoMassConfig::<Fixed>::new(&design, BASES), fixed);
}

#[test]
fn the_semi_implicit_step_keeps_momentum() {
    let design = Hoist::<10_000>::OBSERVER;
    coasts::<f32, SemiImplicitObserver<f32>>(&SemiImplicitConfig::<f32>::new(&design, Bases::SI), single);
    coasts::<Fixed, SemiImplicitObserver<Fixed>>(&SemiImplicitConfig::<Fixed>::new(&design, BASES), fixed);
}

/// Nothing acts: nothing moves, to the last bit, for a hundred thousand ticks.
#[test]
fn a_balanced_machine_stays() {
    fn stays<N: Number, O: Observer<N> + PartialEq + Copy + core::fmt::Debug>(config: &O::Config) {
        let start = O::at_rest(config, 0, N::ZERO);
        let mut observer = start;
        for _ in 0..100_000 {
            observer.step(config, 0, N::ZERO);
        }
        assert_eq!(observer, start);
    }
    let design = Hoist::<10_000>::OBSERVER;
    stays::<f32, TwoMassObserver<f32>>(&TwoMassConfig::<f32>::new(&design, Bases::SI));
    stays::<Fixed, TwoMassObserver<Fixed>>(&TwoMassConfig::<Fixed>::new(&design, BASES));
    stays::<f32, SemiImplicitObserver<f32>>(&SemiImplicitConfig::<f32>::new(&design, Bases::SI));
    stays::<Fixed, SemiImplicitObserver<Fixed>>(&SemiImplicitConfig::<Fixed>::new(&design, BASES));
}
