//! The speed without its ripple, on motions in closed form: what repeats is not seen, what does not repeat is not late.

use core::f64::consts::TAU;

use driveline::fluctuation::{CycleMean, CycleMeanConfig, Fluctuation};
use driveline::number::{Fixed, Number};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle};

use super::motion::{Motion, Part};
use super::rig::PERIOD;

/// A stroke of 14 turns, renewed 64 times.
const STROKE: Cycle = Cycle { turns: 14, cycles: 1 };
const TURNS: f64 = 14.0;
const BASE: f64 = 200.0;
const BASES: Bases = Bases::rigid(100.0, BASE);
const SPEED: f64 = 100.0;

type Mean<N> = CycleMean<64, N>;

trait Built: Number {
    fn config() -> CycleMeanConfig<Self>;
    fn of(speed: f64) -> Self;
    fn to(self) -> f64;
}

macro_rules! built {
    ($number:ident, $bases:expr, $of:expr, $to:expr) => {
        impl Built for $number {
            fn config() -> CycleMeanConfig<$number> {
                CycleMeanConfig::<$number>::new::<64>(STROKE, PERIOD, $bases)
            }
            fn of(speed: f64) -> $number {
                $of(speed)
            }
            fn to(self) -> f64 {
                $to(self)
            }
        }
    };
}
built!(f64, Bases::SI, |speed| speed, |speed| speed);
built!(f32, Bases::SI, |speed| speed as f32, f64::from);
built!(Fixed, BASES, |speed| Fixed::from_f64(speed / BASE), |speed: Fixed| speed.to_f64() * BASE);

/// A ripple of some 20 % from peak to peak, of low and of high orders.
const PARTS: [Part; 4] = [
    Part { n: 1.0, amplitude: 0.06, phase: 0.4 },
    Part { n: 2.0, amplitude: 0.03, phase: -1.0 },
    Part { n: 5.0, amplitude: 0.02, phase: 2.0 },
    Part { n: 14.0, amplitude: 0.01, phase: 0.1 },
];

/// One tick of the motion, its speed as a perfect observer has it.
fn tick<N: Built>(mean: &mut Mean<N>, config: &CycleMeanConfig<N>, motion: &mut Motion) {
    motion.advance(PERIOD);
    let estimate = Estimate { motor_speed: N::of(motion.motor_speed()), ..Estimate::default() };
    mean.measure(config, motion.encoder(), N::ZERO, &estimate);
}

/// The largest deviation from the mean by time, over what the motion is given, once there is one.
fn deviation<N: Built>(speed: f64, ramp: f64, parts: &[Part], ticks: u32) -> (f64, u32) {
    let config = N::config();
    let (mut mean, mut motion) = (Mean::<N>::default(), Motion::new(speed, ramp, TURNS, parts));
    let share = motion.mean_by_time();
    let (mut worst, mut seen) = (0.0_f64, 0);
    for _ in 0..ticks {
        tick(&mut mean, &config, &mut motion);
        if let Some(steady) = mean.steady_speed() {
            seen += 1;
            // It is renewed 64 times a stroke, and as old as that at most.
            let now = motion.speed + motion.ramp * motion.time;
            worst = worst.max((steady.to() / (share * now) - 1.0).abs());
        }
    }
    (worst, seen)
}

/// The ends of the window are a tick's 10 mrad from a stroke apart at most, which shows a ripple of a tenth in the 88
/// rad of a stroke, and half of what the ripple's slope of 0.026 per rad makes of them in the change; two counts of the
/// encoder as well.
#[test]
fn what_repeats_every_cycle_is_not_seen() {
    let bound = (0.1 * 0.01 + 2.0 * 0.77e-3) / (TURNS * TAU) + 0.5 * 0.026 * 0.01;
    for speed in [SPEED, -SPEED, 0.01 * SPEED] {
        let ticks = (3.0 * TURNS * TAU / speed.abs() / PERIOD) as u32;
        let (double, seen) = deviation::<f64>(speed, 0.0, &PARTS, ticks);
        let (single, _) = deviation::<f32>(speed, 0.0, &PARTS, ticks);
        let (fixed, _) = deviation::<Fixed>(speed, 0.0, &PARTS, ticks);
        println!("{speed} rad/s: {double:.2e} {single:.2e} {fixed:.2e} of {bound:.2e}, {seen} of {ticks} ticks");
        // One stroke of the three, and the part of one that the motion begins in, are for the first mean.
        assert!(f64::from(seen) > 1.9 / 3.0 * f64::from(ticks), "{seen}");
        // A hundredth of the speed in fixed point is 2^21 units: their rounding adds 1e-6.
        assert!(double < bound && single < bound + 1e-6 && fixed < bound + 2e-6, "{double} {single} {fixed} {bound}");
    }
}

/// Under a steady acceleration of a tenth of the speed in a second it is late by no more than a segment, in which the
/// speed changes by 1.4 in a thousand; a plain mean over the stroke is late by half of it, 44 in a thousand. With a
/// ripple, half of what the speed gains in a stroke ripples with it.
#[test]
fn what_does_not_repeat_is_not_late() {
    let ramp = 0.1 * SPEED;
    let stroke = TURNS * TAU / SPEED;
    let segment = ramp * stroke / 64.0 / SPEED;
    let (smooth, seen) = deviation::<f32>(SPEED, ramp, &[], 30_000);
    assert!(seen > 20_000 && smooth < 1.05 * segment + 1e-4, "{smooth} {segment}");
    let (rippled, _) = deviation::<f32>(SPEED, ramp, &PARTS, 30_000);
    let bound = segment + 0.12 * ramp * stroke / SPEED;
    println!("smooth {smooth:.2e}, rippled {rippled:.2e} of {bound:.2e}");
    assert!(rippled < bound, "{rippled} {bound}");
}

#[test]
fn there_is_none_where_nothing_is_known() {
    let config = <f32 as Built>::config();
    let mut mean = Mean::<f32>::default();
    let mut motion = Motion::new(SPEED, 0.0, TURNS, &PARTS);
    let until = |mean: &mut Mean<f32>, motion: &mut Motion, there: bool| {
        (0..30_000_u32).find(|_| {
            tick(mean, &config, motion);
            mean.steady_speed().is_some() == there
        })
    };
    // 8796 ticks to the stroke, and 137 to a segment.
    let stroke = (TURNS * TAU / SPEED / PERIOD) as u32;
    let first = until(&mut mean, &mut motion, true).unwrap();
    assert!(first > stroke && first < stroke + 400, "{first}");
    // Single angles that cannot be used are no harm.
    for _ in 0..1000 {
        mean.disturb();
        tick(&mut mean, &config, &mut motion);
        assert!(mean.steady_speed().is_some());
    }
    // Two without a tick between them: the angle is lost, or the drive is held.
    mean.disturb();
    mean.disturb();
    assert!(mean.steady_speed().is_none());
    let again = until(&mut mean, &mut motion, true).unwrap();
    assert!(again > stroke && again < stroke + 400, "{again}");
    // The machine stands: for four segments the mean stands too.
    let (angle, estimate) = (motion.encoder(), Estimate::default());
    let stale = (0..10_000).find(|_| {
        mean.measure(&config, angle, 0.0, &estimate);
        mean.steady_speed().is_none()
    });
    assert!(stale.is_some_and(|ticks| ticks < 6 * stroke / 64), "{stale:?}");
    // And backwards: the way back over a stroke is none of its own.
    let mut back = Motion { speed: -SPEED, phi: motion.phi, ..Motion::new(SPEED, 0.0, TURNS, &PARTS) };
    let turned = until(&mut mean, &mut back, true).unwrap();
    assert!(turned > stroke && turned < stroke + 400, "{turned}");
    let steady = mean.steady_speed().unwrap();
    assert!(steady < 0.0, "{steady}");
    // An angle that is elsewhere.
    mean.measure(&config, back.encoder().wrapping_add(1 << 31), 0.0, &estimate);
    assert!(mean.steady_speed().is_none());
}

/// The first mean is there at the end of the 66th segment at most, however many ticks a segment has, but where a stroke
/// takes more than 2^22 of them, which the division cannot hold. Without a ripple all segments take as long.
#[test]
fn a_mean_takes_a_stroke_of_at_most_four_million_ticks() {
    for (ticks, is_there) in [(137.4, true), (1.02 * 65_536.0, false), (0.98 * 65_536.0, true)] {
        let speed = TURNS * TAU / 64.0 / ticks / PERIOD;
        let config = <f64 as Built>::config();
        let (mut mean, mut motion) = (Mean::<f64>::default(), Motion::new(speed, 0.0, TURNS, &[]));
        // the first segment is the part of one that the motion begins in
        let first = (0..(66.0 * ticks) as u32).find(|_| {
            tick(&mut mean, &config, &mut motion);
            mean.steady_speed().is_some()
        });
        assert_eq!(first.is_some(), is_there, "{ticks}: {first:?}");
    }
}
