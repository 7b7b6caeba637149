//! The speed loop: its limits, its anti-windup, and its bumpless transfer.

use driveline::design::{Rate, SpeedLoopDesign, SpeedLoopTuning};
use driveline::fault::Faults;
use driveline::governor::{Governor, SpeedLoop, SpeedLoopConfig};
use driveline::number::{Fixed, Number};
use driveline::sample::Estimate;
use driveline::settings::{Bases, SpeedLoopSettings};
use proptest::prelude::*;

use super::rig::{BASES, DriveOf, RATED_SPEED, REDUCED, Rig, Scaled, TORQUE_LIMIT, WEIGHT, for_every_variant};
use crate::hoist::Variant;

fn design() -> SpeedLoopDesign {
    REDUCED.speed_loop(Rate::hz(10_000), SpeedLoopTuning::USUAL)
}

fn settings(ramp: f64) -> SpeedLoopSettings {
    SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp }
}

proptest! {
    /// Any estimate within twice the bases, any setpoint: the torque is within its limit, and away from the limits it
    /// is the closed form in `f64`, to what `f32` and fixed point resolve.
    #[test]
    fn the_torque_is_the_laws(
        errors in prop::collection::vec((-8.0..8.0_f64, -4.0..4.0_f64, -40.0..40.0_f64), 1..200),
    ) {
        let exact_config = SpeedLoopConfig::<f64>::new(&design(), settings(1e9), Bases::SI);
        let mut exact = SpeedLoop::<(), _>::default();
        let single_config = SpeedLoopConfig::<f32>::new(&design(), settings(1e9), Bases::SI);
        let mut single = SpeedLoop::<(), _>::default();
        // In fixed point a ramp crosses no more than twice the base in a tick.
        let ramp = 1.9 * BASES.speed * 1e4;
        let fixed_config = SpeedLoopConfig::<Fixed>::new(&design(), settings(ramp), BASES);
        let mut fixed = SpeedLoop::<(), _>::default();
        for (error, slip, speed) in errors {
            let (motor, load, setpoint) = (speed, speed - slip, speed + error);
            let now = Estimate { motor_speed: motor, load_speed: load, ..Estimate::default() };
            exact.set_setpoint(setpoint);
            let wanted = exact.command(&exact_config, &now);
            let now = Estimate { motor_speed: motor as f32, load_speed: load as f32, ..Estimate::default() };
            single.set_setpoint(setpoint as f32);
            let by_single = f64::from(single.command(&single_config, &now));
            let of = Fixed::of_speed;
            let now = Estimate { motor_speed: of(motor), load_speed: of(load), ..Estimate::default() };
            fixed.set_setpoint(of(setpoint));
            let by_fixed = fixed.command(&fixed_config, &now).torque();
            // Gains of ten and a few roundings of 1000 N m in f32; of a base of 2700 N m over 2^28, times the gains'
            // 32, in fixed point.
            prop_assert!((by_single - wanted).abs() < 0.01, "{by_single} {wanted}");
            prop_assert!((by_fixed - wanted).abs() < 0.01, "{by_fixed} {wanted}");
            prop_assert!([by_single, by_fixed, wanted].iter().all(|torque| torque.abs() <= TORQUE_LIMIT));
        }
    }

    /// In fixed point no estimate and no setpoint, whatever their bits, turn the torque's sign by overflow: far off the
    /// setpoint and without slip the torque is at its limit, on the side of the error.
    #[test]
    fn an_error_that_saturates_keeps_its_sign(
        motor in -(1 << 29)..1 << 29_i32, setpoint in -(1 << 29)..1 << 29_i32, ticks in 1..200,
    ) {
        let config = SpeedLoopConfig::<Fixed>::new(&design(), settings(1.9 * BASES.speed * 1e4), BASES);
        let speed = Fixed::from_bits(motor);
        let now = Estimate { motor_speed: speed, load_speed: speed, ..Estimate::default() };
        let mut governor = SpeedLoop::<(), _>::default();
        // The setpoint's ramp first.
        let mut torque = Fixed::ZERO;
        for _ in 0..ticks + 3 {
            governor.set_setpoint(Fixed::from_bits(setpoint));
            torque = governor.command(&config, &now);
        }
        // An error of 0.25 of the base gives 10.5 * 52 = 546 N m at once.
        let error = i64::from(setpoint) - i64::from(motor);
        if error.abs() > 1 << 26 {
            prop_assert_eq!(torque.torque() > 0.0, error > 0);
            prop_assert!(torque.torque().abs() > 540.0, "{}", torque.torque());
        }
    }
}

/// From the brake to the governor: the first torque is the held one, but for what the first step of the ramp asks for.
#[test]
fn from_hold_to_tick_there_is_no_jolt() {
    fn test<V: Variant<Number: Scaled>>() {
        for held in [WEIGHT, -300.0, 0.0] {
            let mut drive = DriveOf::<V>::new(V::CONFIG, 0);
            for _ in 0..100 {
                let command = drive.hold(V::CONFIG, 12_345, V::Number::of_torque(held));
                assert_eq!((command.torque, command.faults), (V::Number::of_torque(held), Faults::NONE));
                // It stands, and the shaft carries the torque: to the numbers' resolution, 1e-6 of the base.
                let now = drive.estimate(V::CONFIG);
                assert!((now.shaft_torque.torque() - held).abs() < 1e-6 * BASES.torque, "{} {now:?}", V::NAME);
                assert_eq!((now.motor_speed, now.load_speed), (V::Number::ZERO, V::Number::ZERO));
            }
            let step = RATED_SPEED / 2.0 / f64::from(V::RATE_HZ);
            let design = REDUCED.speed_loop(Rate::hz(V::RATE_HZ), SpeedLoopTuning::USUAL);
            let asked = (design.proportional + design.integral / f64::from(V::RATE_HZ)) * step;
            let sample = driveline::sample::Sample {
                angle: 12_345,
                torque: V::Number::of_torque(held),
                setpoint: V::Number::of_speed(RATED_SPEED),
            };
            let torque = drive.tick(V::CONFIG, &sample).torque.torque();
            assert!((torque - held - asked).abs() < 1e-5 * BASES.torque, "{}: {torque} {held} {asked}", V::NAME);
        }
        // A torque that cannot be is not held.
        for bad in [V::Number::from_word(0x7fc0_0000), V::Number::from_word(0x8000_0000)] {
            let mut drive = DriveOf::<V>::new(V::CONFIG, 0);
            let command = drive.hold(V::CONFIG, 0, bad);
            let nothing = bad == V::Number::ZERO;
            assert!(nothing || (command.faults, command.torque) == (Faults::SETPOINT, V::Number::ZERO), "{bad:?}");
        }
    }
    for_every_variant!(10000, test);
    for_every_variant!(1000, test);
}

/// In closed loop with the machine: on a ramp within its torque the speed follows without overshoot beyond what a
/// weight that drops onto the hook at the end leaves, and the torque never passes its limit (which every tick of the
/// rig checks).
#[test]
fn a_run_up_ends_at_the_set_point() {
    fn test<V: Variant<Number: Scaled>>() {
        let mut rig = Rig::<V>::at_rest();
        let mut top = 0.0_f64;
        for _ in 0..4 * V::RATE_HZ {
            rig.tick(|_| {});
            top = top.max(rig.plant.speed(0));
        }
        // Critically damped, with a zero: a ramp's end overshoots by the ramp times the loop's own time, 1/w1 = 0.16 s
        // at 77.5 rad/s2.
        let late = 77.5 / REDUCED.speed_loop(Rate::hz(V::RATE_HZ), SpeedLoopTuning::USUAL).bandwidth;
        assert!(top - RATED_SPEED < late, "{}: {top}", V::NAME);
        assert!((rig.plant.speed(0) - RATED_SPEED).abs() < 0.01 * RATED_SPEED, "{}", V::NAME);
    }
    for_every_variant!(10000, test);
}
