//! A 60-2 wheel whose teeth are up to 0.1 degree beside their places: its errors are learnt as it coasts, and delta is
//! then right within 2 %.

use core::f64::consts::TAU;

use driveline::fluctuation::{Ripple, ToothErrors, ToothWindow, ToothedWheel, ToothedWheelConfig};
use driveline::settings::Wheel;

use super::motion::{Motion, Part};

/// A clock of 4 MHz: a count is 39 urad at 157 rad/s.
const CLOCK: f64 = 4e6;

/// Turns that the errors are learnt over: fewer average less of the clock's rounding, more take so long at 60 rad/s
/// that the coast is no longer a steady one.
const LEARNT: u32 = 16;

/// Orders that are looked at, which are all that there are: with twice as many the clock's rounding, which a steady
/// speed repeats in every turn, makes 2.1 % of such a delta at 60 rad/s.
const ORDERS: usize = 4;

/// A tenth of a degree.
const TENTH: f64 = 0.1 / 360.0 * TAU;

fn config<const PLACES: usize>(turns: u32, cycles: u32) -> ToothedWheelConfig {
    ToothedWheelConfig::new::<PLACES>(Wheel { places: 60, missing: 2, turns, clock: CLOCK }, cycles)
}

/// Even random numbers in +-1, from a linear congruential generator (Knuth, TAOCP 2, 3.3.4, table 1, line 26).
fn errors(seed: u64) -> [f64; 60] {
    let mut state = seed;
    core::array::from_fn(|_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}

/// The wheel along a motion until a window is finished.
fn window<const PLACES: usize>(
    motion: &mut Motion,
    config: &ToothedWheelConfig,
    errors: &[f64; 60],
) -> ToothWindow<PLACES> {
    let mut wheel = ToothedWheel::<PLACES>::default();
    // The next tooth is well ahead.
    let mut count = (motion.phi / TAU * 60.0).floor() as i64 + 2;
    loop {
        let place = count.rem_euclid(60);
        if place < 58 {
            let angle = count as f64 / 60.0 * TAU + errors[place as usize] * TENTH;
            // Up to the tooth by Newton's method: the time to it is what is left over the speed.
            for _ in 0..6 {
                let speed = motion.motor()[0];
                motion.advance((angle - motion.phi) / speed);
            }
            // The clock wraps every 4 minutes; begin near its end.
            wheel.tooth(config, ((motion.time * CLOCK) as u64).wrapping_add(0xfff0_0000) as u32);
        }
        count += 1;
        if let Some(window) = wheel.take() {
            return window;
        }
    }
}

/// Learns over a coast by 10 % of the speed a second, and measures over 32 turns, a second at rated speed: with what
/// was learnt, and without.
fn measured<const PLACES: usize>(
    parts: &[Part],
    turns: u32,
    speed: f64,
    ramp: f64,
    seed: u64,
) -> (Ripple, Ripple, Motion) {
    let config = config::<PLACES>(turns, 32 / turns);
    let wheel = errors(seed);
    let mut coasting = Motion::new(speed, -0.1 * speed, f64::from(turns), &[]);
    let few = ToothedWheelConfig { cycles: LEARNT / turns, ..config };
    let learnt = window::<PLACES>(&mut coasting, &few, &wheel).errors(&few);
    for (place, &error) in learnt.radians().iter().enumerate() {
        // Less the error of the first tooth, where the cycle begins. A count of the clock is 39 urad at 157 rad/s, and
        // a tooth and the first are each off by half of one at most.
        let tooth = place % 60;
        let own = if tooth < 58 { (wheel[tooth] - wheel[0]) * TENTH / f64::from(turns) } else { 0.0 };
        assert!((f64::from(error) - own).abs() < 4e-5, "{place}: {error} {own}");
    }
    let mut motion = Motion::new(speed, ramp, f64::from(turns), parts);
    let taken = window::<PLACES>(&mut motion, &config, &wheel);
    (taken.ripple(&config, &learnt, ORDERS), taken.ripple(&config, &ToothErrors::NONE, ORDERS), motion)
}

#[test]
fn delta_is_right_to_a_fiftieth() {
    let small = [Part { n: 1.0, amplitude: 0.6e-3, phase: 0.7 }, Part { n: 2.0, amplitude: 0.5e-3, phase: -1.1 }];
    let large = [Part { n: 1.0, amplitude: 0.03, phase: 0.7 }, Part { n: 3.0, amplitude: 0.02, phase: 2.0 }];
    for (speed, ramp) in [(157.0, 0.0), (157.0, 15.7), (60.0, 0.0), (157.0, -15.7)] {
        for seed in 1..6 {
            for parts in [&small, &large] {
                let (ripple, raw, motion) = measured::<60>(parts, 1, speed, ramp, seed);
                let (swing, ..) = motion.swing();
                let delta = |ripple: &Ripple| (ripple.motor.max.speed - ripple.motor.min.speed) / ripple.speed.mean;
                assert!((delta(&ripple) / swing - 1.0).abs() < 0.02, "{speed} {ramp}: {} {swing}", delta(&ripple));
                // Without what was learnt a small one is lost in the wheel's errors.
                assert!(swing > 0.01 || (delta(&raw) / swing - 1.0).abs() > 0.1, "{} {swing}", delta(&raw));
                for part in parts.iter() {
                    let amplitude = ripple.speed.order(part.n as usize).amplitude() / ripple.speed.mean;
                    assert!((amplitude / part.amplitude - 1.0).abs() < 0.02, "{amplitude} {part:?}");
                }
                assert!((ripple.acceleration - ramp).abs() < 0.02, "{ripple:?}");
            }
        }
    }
}

/// Half orders: the cycle is two turns, and begins with either.
#[test]
fn a_four_stroke_cycle_has_half_orders() {
    let parts = [Part { n: 1.0, amplitude: 2e-3, phase: 0.7 }, Part { n: 2.0, amplitude: 3e-3, phase: -1.1 }];
    let (ripple, _, _) = measured::<120>(&parts, 2, 157.0, 0.0, 3);
    for part in parts {
        let amplitude = ripple.speed.order(part.n as usize).amplitude() / ripple.speed.mean;
        assert!((amplitude / part.amplitude - 1.0).abs() < 0.02, "{amplitude} {part:?}");
    }
}

/// A tooth that is missed, or one too many, voids the window, and the gap is found again.
#[test]
fn a_tooth_too_few_or_too_many_costs_a_window_and_no_more() {
    let config = config::<60>(1, 4);
    for fault in 0..2 {
        let mut wheel = ToothedWheel::<60>::default();
        let mut seen = Vec::new();
        for tooth in 0..60_u32 * 20 {
            if tooth % 60 >= 58 || (fault == 0 && tooth == 300 + 17) {
                continue;
            }
            wheel.tooth(&config, tooth * 1000);
            if fault == 1 && tooth == 300 + 17 {
                wheel.tooth(&config, tooth * 1000 + 400);
            }
            if let Some(window) = wheel.take() {
                seen.push((tooth, window.ripple(&config, &ToothErrors::NONE, 4).motor.delta));
            }
        }
        // The first window would have been from the third turn's beginning to the seventh's.
        assert!(seen.len() >= 2 && seen[0].0 > 420, "{seen:?}");
        assert!(seen.iter().all(|&(_, delta)| delta < 1e-9), "{seen:?}");
    }
}

#[test]
fn a_wheel_that_cannot_be_is_refused() {
    let good = Wheel { places: 60, missing: 2, turns: 1, clock: CLOCK };
    let refused = |wheel, cycles| ToothedWheelConfig::try_new::<60>(wheel, cycles).unwrap_err().to_string();
    assert!(refused(Wheel { missing: 0, ..good }, 8).contains("missing tooth"));
    assert!(refused(Wheel { missing: 30, ..good }, 8).contains("missing tooth"));
    assert!(refused(Wheel { turns: 2, ..good }, 8).contains("as the table"));
    assert!(refused(Wheel { clock: f64::NAN, ..good }, 8).contains("clock"));
    assert!(refused(good, 0).contains("at least 1 cycle"));
}
