//! A drive that is switched on to a machine that spins, or whose machine has changed its speed unseen, catches it at
//! every rate.

use driveline::fault::Faults;
use driveline::number::Number;
use driveline::sample::Sample;

use super::rig::{DriveOf, RATED_SPEED, Scaled, Seen, check, for_every_variant};
use crate::hoist::Variant;

/// A machine that turns steadily and without torque, and a drive that believes it at rest. At 1 kHz it turns by 0.155
/// rad a tick, three times the innovation limit: no correction that needs an innovation within the limit would ever
/// catch it.
fn caught<V: Variant<Number: Scaled>>() {
    for speed in [RATED_SPEED, -RATED_SPEED, 30.0] {
        let mut drive = DriveOf::<V>::new(V::CONFIG, 0);
        let turn = speed / f64::from(V::RATE_HZ) / core::f64::consts::TAU * 4_294_967_296.0;
        let missed = V::RATE_HZ / 67;
        let mut last = 0;
        let ticks = V::RATE_HZ / 2;
        for tick in 1..=ticks {
            let angle = (turn * f64::from(tick)) as i64 as u32;
            let sample = Sample { angle, torque: V::Number::ZERO, setpoint: V::Number::of_speed(speed) };
            let command = Seen::new(drive.tick(V::CONFIG, &sample), drive.estimate(V::CONFIG));
            check(V::NAME, V::CONFIG.governor.torque_limit, &command);
            if command.faults != Faults::NONE {
                last = tick;
            }
            if tick == ticks {
                // Within the rated speed's thousandth; no encoder's counts here, so nothing but the poles is left.
                let error = command.estimate.motor_speed.speed() - speed;
                assert!(error.abs() < 1e-3 * RATED_SPEED, "{} at {speed}: off by {error}", V::NAME);
            }
        }
        // The observer follows its poles, a swing of 0.1 s at the longest, and on the way may leave the innovation
        // limit once: 20 ms later the angle is lost, and caught by the next two.
        assert!(last <= V::RATE_HZ / 10 + missed + 2, "{} at {speed}: flagged until tick {last}", V::NAME);
    }
}

#[test]
fn a_spinning_machine_is_caught_at_every_rate() {
    for_every_variant!(1000, caught);
    for_every_variant!(4000, caught);
    for_every_variant!(10000, caught);
}
