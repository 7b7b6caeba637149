//! Nothing depends on the absolute angle: a shift of all angles gives the same bits, whatever wraps on the way.

use driveline::drive::Drive;

use super::rig::{DriveOf, RATED_SPEED, Rig, Scaled, Seen, for_every_variant};
use crate::hoist::Variant;

/// A run from rest, recorded, is played to drives that were switched on at other angles. One of the bases is where a
/// year at rated speed ends: 155 rad/s for 31,557,600 s are 778 million turns and a fraction, and the fraction is all
/// that the drive can know.
#[test]
fn a_shift_of_all_angles_gives_the_same_bits() {
    fn test<V: Variant<Number: Scaled>>() {
        let year = (RATED_SPEED * 31_557_600.0 / core::f64::consts::TAU).fract() * 4_294_967_296.0;
        for base in [1, 1 << 31, u32::MAX, 0x7fff_ffff, year as u32] {
            let mut rig = Rig::<V>::at_rest();
            let mut shifted = DriveOf::<V>::new(V::CONFIG, base);
            let mut wraps = 0;
            for tick in 0..V::RATE_HZ {
                let mut sample = rig.sample();
                let (before, mut seen) = (rig.drive.angle(), sample);
                // A jump and a frozen encoder too, long enough to be lost.
                match tick * 100 / V::RATE_HZ {
                    50..52 => seen.angle = seen.angle.wrapping_add(1 << 30),
                    60..64 => seen.angle = before,
                    _ => {}
                }
                let command = rig.tick(|sample| *sample = seen);
                sample = seen;
                sample.angle = sample.angle.wrapping_add(base);
                let there = Seen::new(shifted.tick(V::CONFIG, &sample), shifted.estimate(V::CONFIG));
                assert_eq!(there, command, "{} by {base} in tick {tick}", V::NAME);
                wraps += u32::from(sample.angle < before.wrapping_add(base) && command.faults.is_none());
            }
            // 77.5 rad/s2 for a second are 6.2 turns, of which the lag of the loop behind its ramp takes less than one;
            // one in each of the two faults does not count.
            assert!(wraps >= 3, "{}: {wraps}", V::NAME);
        }
    }
    for_every_variant!(10000, test);
}

/// A base that jumps between two ticks, the drive's own angle with it, changes nothing either: so the state holds no
/// other angle.
#[test]
fn a_jump_of_the_base_under_a_running_drive_gives_the_same_bits() {
    fn test<V: Variant<Number: Scaled>>() {
        let mut rig = Rig::<V>::lifting(RATED_SPEED);
        let held = V::Number::of_torque(700.0);
        let (mut here, mut there) = (rig.drive, rig.drive);
        let far = here.angle().wrapping_add(0x9234_5678);
        // Against the brake the angle is taken as it comes.
        let (angle, _) = (here.angle(), here.hold(V::CONFIG, rig.drive.angle(), held));
        there.hold(V::CONFIG, far, held);
        for _ in 0..V::RATE_HZ / 10 {
            let mut sample = rig.sample();
            rig.tick(|_| {});
            let a = here.tick(V::CONFIG, &sample);
            sample.angle = sample.angle.wrapping_sub(angle).wrapping_add(far);
            assert_eq!(there.tick(V::CONFIG, &sample), a, "{}", V::NAME);
        }
    }
    for_every_variant!(10000, test);
}

/// A thousand turns at rated speed, then a thousand back: the residual has not grown, the angle is the encoder's.
#[test]
fn many_turns_leave_no_residual() {
    fn test<V: Variant<Number: Scaled>>() {
        let mut drive: DriveOf<V> = Drive::new(V::CONFIG, 0);
        let step = RATED_SPEED / f64::from(V::RATE_HZ) / core::f64::consts::TAU * 4_294_967_296.0;
        let ticks = 1000 * (4_294_967_296.0 / step) as u64;
        let mut early = None;
        for tick in 1..=ticks {
            let angle = ((step * tick as f64) as u64 >> 19 << 19) as u32;
            let sample = driveline::sample::Sample {
                angle,
                torque: V::Number::of_torque(0.0),
                setpoint: V::Number::of_speed(RATED_SPEED),
            };
            drive.tick(V::CONFIG, &sample);
            let error = (drive.estimate(V::CONFIG).motor_speed.speed() - RATED_SPEED).abs();
            // The largest error over a stretch of 10 turns, early and at the end.
            let turn = (tick as f64 * step / 4_294_967_296.0) as u32;
            match turn {
                100..110 => early = Some(early.map_or(error, |e: f64| e.max(error))),
                990.. => {
                    let early = early.unwrap();
                    assert!(error <= 1.5 * early && early < 0.01 * RATED_SPEED, "{}: {error} {early}", V::NAME);
                }
                _ => {}
            }
        }
    }
    for_every_variant!(10000, test);
}
