//! The waveform of the speed, by an encoder of 8192 counts through the real drive, against closed forms: steady and on
//! a ramp, down to a delta of 1/543.

use core::f64::consts::TAU;

use driveline::fluctuation::{Ripple, Window};
use driveline::number::Fixed;
use driveline::settings::Cycle;

use super::motion::{Motion, Part};
use super::rig::{BINS, Built, InDouble, RATED, TORQUE, run};

/// An order once a turn, delta 1/500.
const ONE: [Part; 1] = [Part { n: 1.0, amplitude: 1e-3, phase: 2.1 }];

/// Half order and order of a four-stroke engine, delta 1/543.
const SMALL: [Part; 2] =
    [Part { n: 1.0, amplitude: 0.6e-3, phase: 0.7 }, Part { n: 2.0, amplitude: 0.5e-3, phase: -1.1 }];

/// The same two fifty times as large, delta 1/11.
const LARGE: [Part; 2] = [Part { n: 1.0, amplitude: 0.03, phase: 0.7 }, Part { n: 2.0, amplitude: 0.025, phase: -1.1 }];

/// The first finished window of a drive along a motion.
pub fn window<N: Built>(motion: &mut Motion, cycle: Cycle, cycles: u32, highest: usize) -> (Window<N, BINS>, Ripple) {
    let config = N::constants(cycle, cycles);
    let mut window = None;
    run::<N>(&config, motion, 700_000, |drive| {
        window = drive.fluctuation_mut().1.take();
        window.is_some()
    });
    let window = window.expect("a window within 70 s");
    let ripple = window.ripple(&config.fluctuation.1, highest).unwrap();
    (window, ripple.in_double())
}

/// Of readings in double and in single precision.
fn ripples(of: impl Fn() -> Motion, cycle: Cycle, cycles: u32, highest: usize) -> [(Ripple, Motion); 3] {
    let (mut double, mut single, mut fixed) = (of(), of(), of());
    let (_, in_double) = window::<f64>(&mut double, cycle, cycles, highest);
    let (_, in_single) = window::<f32>(&mut single, cycle, cycles, highest);
    let (_, in_fixed) = window::<Fixed>(&mut fixed, cycle, cycles, highest);
    [(in_double, double), (in_single, single), (in_fixed, fixed)]
}

/// By how far an order's phase is off, wrapped (degrees); the cycle began `turn` turns of the motor later than the
/// motion's.
fn off(ripple: &Ripple, motion: &Motion, part: &Part, turn: u32) -> f64 {
    let backwards = if motion.speed < 0.0 { 0.5 * TAU } else { 0.0 };
    let late = part.n * TAU * f64::from(turn) / motion.turns;
    let off = (ripple.speed.order(part.n as usize).phase() - part.phase + backwards + late).rem_euclid(TAU);
    off.min(TAU - off).to_degrees()
}

/// Compares a ripple of eight orders with the motion: delta, orders, and what is not there. Amplitudes are relative to
/// the mean over the angle, which is W itself. A cycle of several turns begins with any of them, since the drive has
/// had to look for its angle; all orders must agree on it.
#[track_caller]
fn compare(ripple: &Ripple, motion: &Motion, [delta, amplitude, degrees, other]: [f64; 4]) {
    let (swing, most, least) = motion.swing();
    let what = format!("{} rad/s, {} rad/s2: {ripple:?}", motion.speed, motion.ramp);
    let measured = (ripple.motor.max.speed - ripple.motor.min.speed) / ripple.speed.mean.abs();
    assert!((measured / swing - 1.0).abs() < delta, "delta {measured} for {swing}; {what}");
    let mut largest = 0.0_f64;
    let first = |turn: &u32| motion.parts.iter().map(|part| off(ripple, motion, part, *turn)).fold(0.0, f64::max);
    let turn = (0..motion.turns.max(1.0) as u32).min_by(|a, b| first(a).total_cmp(&first(b))).unwrap();
    for n in 1..=8 {
        let order = ripple.speed.order(n);
        let Some(part) = motion.parts.iter().find(|part| part.n as usize == n) else {
            largest = largest.max(order.amplitude() / ripple.speed.mean.abs());
            continue;
        };
        let relative = order.amplitude() / (ripple.speed.mean.abs() * part.amplitude) - 1.0;
        assert!(relative.abs() < amplitude, "order {n} by {relative}; {what}");
        let off = off(ripple, motion, part, turn);
        assert!(off < degrees, "order {n} by {off} degrees; {what}");
    }
    assert!(largest < other * swing, "an order of {largest}; {what}");
    // Near an extreme the speed is flat: where it is, is known to the root of how well its height is.
    let near = |angle: f64, at: f64| {
        let late = f64::from(turn) / motion.turns;
        ((angle / TAU / motion.turns + late - at + 0.5).rem_euclid(1.0) - 0.5).abs()
    };
    if motion.speed > 0.0 {
        assert!(near(ripple.motor.max.angle, most) < 0.02 && near(ripple.motor.min.angle, least) < 0.02, "{what}");
    }
}

/// Speeds and ramps of 10 % of the rated speed a second, up and down, between 75 and 173 rad/s.
const MOTIONS: [(f64, f64); 8] = [
    (157.0, 0.0),
    (157.3, 0.0),
    (110.0, 0.0),
    (172.7, 0.0),
    (75.0, 15.7),
    (95.0, 15.7),
    (172.0, -15.7),
    (178.3, -15.7),
];

/// Delta of 1/500 over 128 turns, 5 s at rated speed: delta within 1 %, the amplitude within 0.5 %, the phase within
/// 0.5 degree. Orders that are not there stay below what the counts' rounding leaves of them: 0.29 counts over some
/// 30,000 samples, times the order, is 1 % of delta for the fourth.
#[test]
fn a_delta_of_a_500th_is_right_to_a_hundredth() {
    for (speed, ramp) in MOTIONS {
        for (ripple, motion) in ripples(|| Motion::new(speed, ramp, 1.0, &ONE), Cycle::TURN, 128, 4) {
            compare(&ripple, &motion, [0.01, 0.005, 0.5, 0.01]);
            assert_eq!(ripple.cycles, 128);
            assert!((ripple.acceleration - ramp).abs() < 0.01, "{ripple:?}");
        }
    }
}

/// Two orders that share such a delta, each of some 0.7 counts or less at the motor: its rounding is then 1 % of each
/// where it was 0.5 %.
#[test]
fn a_delta_of_two_orders_is_right_to_a_hundredth() {
    for (speed, ramp) in MOTIONS {
        for (ripple, motion) in ripples(|| Motion::new(speed, ramp, 2.0, &SMALL), Cycle::FOUR_STROKE, 64, 4) {
            compare(&ripple, &motion, [0.01, 0.01, 0.5, 0.01]);
            assert!((ripple.acceleration - ramp).abs() < 0.01, "{ripple:?}");
        }
    }
}

/// A large ripple is not a small one times fifty: speed and slowness are then inverse to one another and no longer
/// merely opposite.
#[test]
fn a_large_delta_is_right_as_well_at_any_speed_and_backwards() {
    for (speed, ramp) in [(157.0, 0.0), (80.0, 8.0), (20.0, 0.0), (-157.0, 0.0), (-80.0, -8.0)] {
        for (ripple, motion) in ripples(|| Motion::new(speed, ramp, 2.0, &LARGE), Cycle::FOUR_STROKE, 16, 8) {
            compare(&ripple, &motion, [0.005, 0.002, 0.2, 0.005]);
            assert_eq!(ripple.mean.signum(), speed.signum());
        }
    }
}

/// Two turns in three cycles: not a whole number of anything, and no power of two.
#[test]
fn a_cycle_can_be_any_ratio() {
    let cycle = Cycle { turns: 2, cycles: 3 };
    // At 0.1 % of the rated speed: the window ends early, after what its bins can hold.
    for (speed, cycles, limits) in
        [(RATED, 48, [0.005, 0.002, 0.2, 0.005]), (1e-3 * RATED, 1, [0.01, 0.005, 0.5, 0.01])]
    {
        for (ripple, motion) in ripples(|| Motion::new(speed, 0.0, 2.0 / 3.0, &LARGE), cycle, cycles, 8) {
            compare(&ripple, &motion, limits);
        }
    }
}

/// What the bins hold of the angle.
fn angles<N: Built>(window: &Window<N, BINS>) -> Vec<(u32, i32, u32)> {
    window.bins().iter().map(|bin| (bin.ticks, bin.first, bin.second)).collect()
}

/// The bins are integers made from the angle alone, but for the torque.
#[test]
fn every_number_fills_the_same_bins() {
    let of = |()| Motion::new(RATED, 0.0, 2.0, &LARGE);
    let (exact, _) = window::<f64>(&mut of(()), Cycle::FOUR_STROKE, 8, 8);
    let (single, _) = window::<f32>(&mut of(()), Cycle::FOUR_STROKE, 8, 8);
    let (fixed, _) = window::<Fixed>(&mut of(()), Cycle::FOUR_STROKE, 8, 8);
    let torque = single.motor_torque(&f32::constants(Cycle::FOUR_STROKE, 8).fluctuation.1, 8).in_double();
    assert!((torque.mean - TORQUE).abs() < 1e-3, "{torque:?}");
    assert_eq!(angles(&exact), angles(&single));
    assert_eq!(angles(&exact), angles(&fixed));
}
