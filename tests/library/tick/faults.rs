//! Each fault in turn, at rated speed under load: exactly the flag that `driveline::drive` documents, nothing poisoned,
//! and the estimates back within a stated time.
//!
//! The time is two tenths of a second. The slowest pole of the hoist's observers has a time constant below 40 ms
//! (`the_recovery_time_is_ten_time_constants` says so from the design), so five of them leave 0.7 % of whatever error
//! the fault left; the estimates must then be as good as before the fault, with half as much again for the other
//! stretch of encoder counts.

use crate::hoist::{CutAtRope, Hoist, Variant};
use driveline::configure::Machine as _;
use driveline::fault::Faults;
use driveline::number::Fixed;
use driveline::sample::Sample;

use super::rig::{RATED_SPEED, REDUCED, Rig, Scaled, TORQUE_LIMIT, for_every_variant};

/// Time in which the estimates recover (s): ten times the slowest observer's time constant, 88 ms.
const RECOVERY: f64 = 0.9;

/// What a float can hold and fixed point cannot.
trait Bad: Scaled {
    fn bad() -> Vec<Self>;
}

impl Bad for f32 {
    fn bad() -> Vec<f32> {
        vec![f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -f32::MAX, f32::from_bits(0x7f80_0001)]
    }
}

impl Bad for Fixed {
    fn bad() -> Vec<Fixed> {
        vec![Fixed::from_bits(i32::MIN), Fixed::from_bits(i32::MAX), Fixed::from_bits(-i32::MAX)]
    }
}

#[test]
fn the_recovery_time_is_ten_time_constants() {
    let rate = 10_000;
    let radii = [
        Hoist::<10_000>::OBSERVER.spectral_radius,
        CutAtRope::<10_000>::OBSERVER.spectral_radius,
        Hoist::<10_000>::RIGID_OBSERVER.spectral_radius,
    ];
    for radius in radii {
        let time_constant = -1.0 / (radius.ln() * f64::from(rate));
        assert!(10.0 * time_constant < RECOVERY, "{radii:?}: {time_constant} s");
    }
}

/// Spoils `ticks` samples of a drive at `speed`, wants `flags` in each of them, none after it, and the estimates back.
#[track_caller]
fn spoil<V>(
    rig: &Rig<V>,
    what: &str,
    ticks: u32,
    flags: impl Fn(u32) -> Faults,
    mut how: impl FnMut(u32, &mut Sample<V::Number>),
) where
    V: Variant<Number: Scaled>,
{
    let mut rig = rig.clone();
    // Half a second, so that both stretches hold the beat of speed and encoder counts.
    let before = rig.clone().healthy(V::RATE_HZ / 2);
    for tick in 0..ticks {
        let command = rig.tick(|sample| how(tick, sample));
        assert_eq!(command.faults, flags(tick), "{} in tick {tick} of {what}", V::NAME);
    }
    rig.healthy((RECOVERY * f64::from(V::RATE_HZ)) as u32);
    let after = rig.healthy(V::RATE_HZ / 2);
    for (state, (before, after)) in before.into_iter().zip(after).enumerate() {
        assert!(after <= 1.5 * before, "{} after {what}, state {state}: {after} against {before}", V::NAME);
    }
}

/// A torque is replaced by the last command, which the machine was given, so that the estimates are those of a drive that
/// was told so; of a set point the last one stands, and so does the torque.
#[test]
fn a_torque_and_a_set_point_that_cannot_be_are_replaced_by_the_last_ones() {
    fn test<V: Variant<Number: Bad>>() {
        let rig = Rig::<V>::lifting(RATED_SPEED);
        for bad in V::Number::bad() {
            for ticks in [1, 1000] {
                spoil(&rig, &format!("torque {bad:?}"), ticks, |_| Faults::TORQUE, |_, sample| sample.torque = bad);
            }
            spoil(&rig, &format!("setpoint {bad:?}"), 1000, |_| Faults::SETPOINT, |_, s| s.setpoint = bad);
            let [mut healthy, mut no_torque, mut no_setpoint] = [rig.clone(), rig.clone(), rig.clone()];
            for _ in 0..100 {
                let expected = healthy.tick(|_| {});
                assert_eq!(no_torque.tick(|sample| sample.torque = bad).estimate, expected.estimate);
                assert_eq!(no_setpoint.tick(|sample| sample.setpoint = bad).torque, expected.torque);
            }
        }
    }
    for_every_variant!(10000, test);
}

#[test]
fn a_torque_at_its_limit_is_believed_and_one_beyond_is_not() {
    fn test<V: Variant<Number: Scaled>>() {
        let rig = Rig::<V>::lifting(RATED_SPEED);
        let limit = 1.67 * TORQUE_LIMIT;
        // To a part in a million, which f32 and fixed point both resolve.
        for (factor, flag) in [(0.999_999, Faults::NONE), (1.000_001, Faults::TORQUE)] {
            for sign in [1.0, -1.0] {
                let torque = V::Number::of_torque(sign * factor * limit);
                assert_eq!(rig.clone().tick(|sample| sample.torque = torque).faults, flag, "{torque:?}");
            }
        }
    }
    for_every_variant!(10000, test);
}

#[test]
fn both_at_once_are_told_apart() {
    fn test<V: Variant<Number: Bad>>() {
        let rig = Rig::<V>::lifting(RATED_SPEED);
        let bad = V::Number::bad()[0];
        let all = Faults::TORQUE | Faults::SETPOINT | Faults::ANGLE_JUMP;
        let how =
            |_, sample: &mut Sample<_>| *sample = Sample { angle: sample.angle ^ 1 << 30, torque: bad, setpoint: bad };
        spoil(&rig, "everything bad", 5, |_| all, how);
    }
    for_every_variant!(10000, test);
}

#[test]
fn an_angle_that_jumps_is_left_out_and_believed_again_when_it_is_back() {
    fn test<V: Variant<Number: Scaled>>() {
        let rig = Rig::<V>::lifting(RATED_SPEED);
        for quarter in [1 << 30, 3 << 30, 2 << 30] {
            for ticks in [1, 5, 140] {
                let jump = |_, sample: &mut Sample<_>| sample.angle = sample.angle.wrapping_add(quarter);
                spoil(&rig, "a jump", ticks, |_| Faults::ANGLE_JUMP, jump);
            }
        }
    }
    for_every_variant!(10000, test);
}

#[test]
fn an_angle_that_has_moved_for_ever_is_lost_after_twenty_milliseconds_and_then_taken_as_it_comes() {
    fn test<V: Variant<Number: Scaled>>() {
        let missed = V::RATE_HZ / 67;
        for quarter in [1 << 30, 3 << 30, 2 << 30] {
            let mut rig = Rig::<V>::lifting(RATED_SPEED);
            let before = rig.clone().healthy(V::RATE_HZ / 10);
            let jump = |sample: &mut Sample<V::Number>| sample.angle = sample.angle.wrapping_add(quarter);
            for _ in 0..=missed {
                assert_eq!(rig.tick(jump).faults, Faults::ANGLE_JUMP, "{}", V::NAME);
            }
            // Lost: one angle to start from, and one that says that nothing but the angle has changed.
            for _ in 0..2 {
                assert_eq!(rig.tick(jump).faults, Faults::ANGLE_JUMP | Faults::ANGLE_LOST, "{}", V::NAME);
            }
            // The governor starts anew: the ramp of two seconds, and as much to settle.
            let settle = 4 * V::RATE_HZ;
            let mut after = [0.0_f64; 4];
            for tick in 0..settle + V::RATE_HZ / 10 {
                let plant = rig.plant.clone();
                let command = rig.tick(jump);
                assert_eq!(command.faults, Faults::NONE, "{} in tick {tick}", V::NAME);
                if tick >= settle {
                    for (after, error) in after.iter_mut().zip(rig.errors(&command, &plant)) {
                        *after = after.max(error.abs());
                    }
                }
            }
            for (before, after) in before.into_iter().zip(after) {
                assert!(after <= 1.5 * before, "{}: {after} against {before}", V::NAME);
            }
        }
    }
    for_every_variant!(10000, test);
}

#[test]
fn an_encoder_that_freezes_at_rated_speed_is_not_taken_for_a_standing_machine() {
    fn test<V: Variant<Number: Scaled>>() {
        let rig = Rig::<V>::lifting(RATED_SPEED);
        // Frozen at the count that was last believed.
        let frozen = rig.drive.angle();
        let missed = V::RATE_HZ / 67;
        // 140 ticks are 0.35 turn: the way home is clear. Half a turn would not be, and then the angle is lost first.
        spoil(&rig, "frozen for 140 ticks", 140, |_| Faults::ANGLE_FROZEN, |_, sample| sample.angle = frozen);
        let mut rig = rig.clone();
        for tick in 0..V::RATE_HZ / 2 {
            let lost = if tick <= missed { Faults::NONE } else { Faults::ANGLE_LOST };
            let command = rig.tick(|sample| sample.angle = frozen);
            assert_eq!(command.faults, Faults::ANGLE_FROZEN | lost, "{} in tick {tick}", V::NAME);
            // Coasting by the exact model of a steady run: rated speed, to the healthy run's own error grown over half
            // a second.
            let speed = command.estimate.motor_speed.speed();
            assert!((speed - RATED_SPEED).abs() < 0.1 * RATED_SPEED, "{} in tick {tick}: {speed}", V::NAME);
        }
        for _ in 0..2 {
            assert_eq!(rig.tick(|_| {}).faults, Faults::ANGLE_JUMP | Faults::ANGLE_LOST, "{}", V::NAME);
        }
        // The shaft was let go under load: while it swings, twist rate or load speed may be beyond their bases.
        for _ in 0..V::RATE_HZ / 5 {
            assert_eq!(rig.tick(|_| {}).faults | Faults::RANGE, Faults::RANGE, "{}", V::NAME);
        }
    }
    for_every_variant!(10000, test);
}

/// Two counts a tick are 15.3 rad/s at 10 kHz: below that a frozen encoder is what a held machine looks like, and the
/// estimate of the load torque shows what it would take to hold it.
#[test]
fn an_encoder_that_freezes_at_creep_speed_looks_like_a_machine_that_is_held() {
    fn test<V: Variant<Number: Scaled>>() {
        let mut rig = Rig::<V>::lifting(5.0);
        let frozen = rig.drive.angle();
        // A quarter of a second, five swings of the observer's poles.
        let before = rig.applied;
        let mut command = rig.tick(|sample| sample.angle = frozen);
        for _ in 0..V::RATE_HZ / 4 {
            command = rig.tick(|sample| sample.angle = frozen);
            // A machine that stops within a tick is hit by more torque than fixed point has a base for, and that may be
            // said.
            assert!(Faults::RANGE.contains(command.faults), "{}: {}", V::NAME, command.faults);
        }
        assert!(command.estimate.motor_speed.speed().abs() < 0.5, "{}: {:?}", V::NAME, command.estimate);
        // A loop that sees 5 rad/s too little gives k_p + k_i t more; the estimates that it damps the shaft by still
        // swing about that, and half of it is enough to be seen.
        let design =
            REDUCED.speed_loop(driveline::design::Rate::hz(V::RATE_HZ), driveline::design::SpeedLoopTuning::USUAL);
        let more = 5.0 * (design.proportional + 0.25 * design.integral);
        let given = (rig.applied - before) / more;
        assert!(given > 0.5 && given < 1.5, "{}: {given} of {more}", V::NAME);
        // Nothing moves, so the load is taken to balance all that the motor gives but for the gear's loss of 6 %,
        // and what is left of the swing.
        let taken = command.estimate.load_torque.torque() / rig.applied;
        assert!(taken > 0.85 && taken < 1.15, "{}: {taken}", V::NAME);
        // Moving again, it is accepted again: lost and found in 20 ms, then settled.
        for _ in 0..V::RATE_HZ / 67 + (RECOVERY * f64::from(V::RATE_HZ)) as u32 {
            rig.tick(|_| {});
        }
        rig.healthy(V::RATE_HZ / 10);
    }
    for_every_variant!(10000, test);
}

/// Noise of +-8 counts is not a fault: it is within the innovation limit of 64 counts.
#[test]
fn a_noisy_angle_raises_no_flag_and_leaves_no_trace() {
    fn test<V: Variant<Number: Scaled>>() {
        let rig = Rig::<V>::lifting(RATED_SPEED);
        let mut random = 1_u32;
        let noise = |_, sample: &mut Sample<_>| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let counts = (random >> 28) as i32 - 8;
            sample.angle = sample.angle.wrapping_add((counts << 19) as u32);
        };
        spoil(&rig, "noise", V::RATE_HZ / 2, |_| Faults::NONE, noise);
    }
    for_every_variant!(10000, test);
}
