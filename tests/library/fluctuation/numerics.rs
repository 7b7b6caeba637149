//! That nothing drifts, and what standing still and turning back do.

use core::f64::consts::TAU;

use driveline::fluctuation::{CycleConfig, Extremes, Fluctuation, Waveform, WaveformConfig};
use driveline::number::{Fixed, Number};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle};
use proptest::prelude::*;

use super::rig::{BINS, InDouble, PERIOD};
use crate::noise::Noise;

fn at<N: Number>(speed: N) -> Estimate<N> {
    Estimate { motor_speed: speed, load_speed: speed, ..Estimate::default() }
}

proptest! {
    /// Cycles are counted in whole numbers: after any run of steps forwards, whatever the ratio, there are as many as
    /// the turned angle has, exactly. A segment takes 40 ticks or more: what a cycle's end brings takes 30.
    #[test]
    fn cycles_are_counted_exactly(
        turns in 1..200_u32, cycles in 1..200_u32, seed in any::<u64>(), share in 0.001..0.025_f64,
    ) {
        prop_assume!(turns <= 16 * cycles);
        let cycle = CycleConfig::new(Cycle { turns, cycles }, PERIOD, Bases::SI);
        let mut extremes = Extremes::<f32>::default();
        // The first tick finds the place, at the beginning of the cycle; the first end begins the first cycle. Where
        // that is the first end of a segment as well, it is not sure, and the second one does.
        let (mut total, mut noise) = (0_u128, Noise::new(seed));
        extremes.measure(&cycle, 0, 0.0, &at(1.0));
        for _ in 0..20_000 {
            let step = (f64::from(cycle.length) * share * noise.even()) as u32;
            total += u128::from(step);
            extremes.measure(&cycle, total as u32, 0.0, &at(1.0));
        }
        // What the last end brought is done while the machine stands.
        for _ in 0..40 {
            extremes.measure(&cycle, total as u32, 0.0, &at(1.0));
        }
        let passed = total * u128::from(cycles) / (u128::from(turns) << 32);
        let before = if cycle.last_segment == 0 { 2 } else { 1 };
        prop_assert_eq!(u128::from(extremes.cycles()), passed.saturating_sub(before));
    }

    /// Any angles at all: no panic, and every reading is finite or none.
    #[test]
    fn any_angle_is_taken(angles in prop::collection::vec(any::<u32>(), 1..400), ratio in (1..40_u32, 1..40_u32)) {
        prop_assume!(ratio.0 <= 16 * ratio.1);
        let cycle = CycleConfig::new(Cycle { turns: ratio.0, cycles: ratio.1 }, PERIOD, Bases::SI);
        let config = WaveformConfig::new::<BINS>(cycle, 1);
        let mut parts = <(Extremes<Fixed>, Waveform<BINS, Fixed>)>::default();
        for angle in angles {
            parts.measure(&(cycle, config), angle, Fixed::ONE, &at(Fixed::from_bits(angle as i32 >> 4)));
            if let Some(window) = parts.1.take() {
                let _ = window.ripple(&config, 16);
            }
            let _ = parts.0.reading(&cycle);
        }
    }
}

/// A motor that turns by a fixed part of 2^-64 turn a tick, with a ripple of its own in the angle.
struct Turning {
    phase: u64,
    step: u64,
    ripple: Vec<u32>,
    speeds: Vec<f32>,
}

impl Turning {
    fn new(speed: f64) -> Self {
        let ripple = |k: u32| {
            let angle = 0.002 * (TAU * f64::from(k) / 4096.0 - 0.4).sin();
            (angle / TAU * 4_294_967_296.0).round() as i64 as u32
        };
        Turning {
            phase: 0,
            step: (speed * PERIOD / TAU * 18_446_744_073_709_551_616.0) as u64,
            ripple: (0..4096).map(ripple).collect(),
            speeds: (0..4096)
                .map(|k| (speed * (1.0 + 0.002 * (TAU * f64::from(k) / 4096.0 - 0.4).cos())) as f32)
                .collect(),
        }
    }

    /// Angle and speed of the next tick.
    fn next(&mut self) -> (u32, f32) {
        self.phase = self.phase.wrapping_add(self.step);
        let index = (self.phase >> 52) as usize;
        (((self.phase >> 32) as u32).wrapping_add(self.ripple[index]), self.speeds[index])
    }

    /// The mean speed, exactly (rad/s).
    fn speed(&self) -> f64 {
        self.step as f64 / 18_446_744_073_709_551_616.0 * TAU / PERIOD
    }
}

/// Mean and phase of one window before and one after so many ticks. The mean is what the step is, and the phase has not
/// moved: what differs is the rounding of one window of 16 turns, 6,700 ticks.
fn drift(ticks: u64) -> ([f64; 2], [f64; 2]) {
    let cycle = CycleConfig::new(Cycle::TURN, PERIOD, Bases::SI);
    let config = (cycle, WaveformConfig::new::<BINS>(cycle, 16));
    let mut turning = Turning::new(150.0);
    let speed = turning.speed();
    let mut parts = <(Extremes<f32>, Waveform<BINS>)>::default();
    let mut ends = Vec::new();
    for tick in 0..ticks {
        let (angle, speed) = turning.next();
        parts.measure(&config, angle, 100.0, &at(speed));
        if let Some(window) = parts.1.take()
            && (tick < 10_000 || tick > ticks - 10_000)
        {
            ends.push(window.ripple(&config.1, 4).unwrap().in_double());
        }
    }
    let (first, last) = (ends.first().unwrap(), ends.last().unwrap());
    let of = |ripple: &driveline::fluctuation::Ripple| [ripple.mean / speed - 1.0, ripple.speed.order(1).phase()];
    let reading = parts.0.reading(&cycle).unwrap().in_double();
    assert!((reading.mean / speed - 1.0).abs() < 1e-6, "{reading:?}");
    (of(first), of(last))
}

fn no_drift(ticks: u64) {
    let (first, last) = drift(ticks);
    // The ripple's table has 4096 steps to the turn, each of 3 urad at most: of a turn of 16 that is 3e-8.
    assert!(first[0].abs() < 1e-6 && last[0].abs() < 1e-6, "{first:?} {last:?}");
    assert!((first[1] - last[1]).abs() < 1e-3, "{first:?} {last:?}");
}

#[test]
fn nothing_drifts_in_a_million_ticks() {
    no_drift(1_000_000);
}

/// A day and four hours at 10 kHz; half a minute of a host.
#[test]
#[ignore = "half a minute"]
fn nothing_drifts_in_a_thousand_million_ticks() {
    no_drift(1_000_000_000);
    println!("measured: 1e9 ticks without drift");
}

#[test]
fn at_a_standstill_and_to_and_fro_there_is_no_cycle() {
    let cycle = CycleConfig::new(Cycle::TURN, PERIOD, Bases::SI);
    let config = (cycle, WaveformConfig::new::<BINS>(cycle, 1));
    let mut parts = <(Extremes<f64>, Waveform<BINS, f64>)>::default();
    let mut feed = |angle: u32, speed: f64| {
        parts.measure(&config, angle, 0.0, &at(speed));
        (parts.0.reading(&cycle), parts.1.take())
    };
    for _ in 0..20_000 {
        assert_eq!(feed(5, 0.0), (None, None));
    }
    // Across the end of the cycle and back, a thousand times: ends are passed, but never a cycle.
    for k in 0..100_000_u32 {
        let swing = (TAU * f64::from(k) / 100.0).sin();
        let (reading, window) = feed((swing * 5e8) as i64 as u32, 10.0 * swing);
        assert!(reading.is_none() && window.is_none(), "{k}");
    }
    // Forwards, and then backwards: the first cycle in the new direction is the first whole one.
    let mut seen = Vec::new();
    for k in 0..3000_i64 {
        let angle = if k < 1500 { k } else { 3000 - k } * 10_000_000;
        let speed = if k < 1500 { 1.0 } else { -1.0 } * 10_000_000.0 / 4_294_967_296.0 * TAU / PERIOD;
        let (reading, window) = feed(angle as u32, speed);
        if let Some(window) = window {
            seen.push(window.ripple(&config.1, 4).unwrap().mean / speed);
        }
        if let Some(reading) = reading {
            let sign = if k < 1500 || reading.mean > 0.0 { 1.0 } else { -1.0 };
            assert!((reading.mean * sign / speed.abs() - 1.0).abs() < 1e-6, "{k}: {reading:?}");
        }
    }
    // Two forwards, from the end that the last swing comes to, and one back: the cycle in which a window is taken is
    // left out, and the one that is turned back in.
    assert!(seen.len() == 3 && seen.iter().all(|relative| (relative - 1.0).abs() < 1e-6), "{seen:?}");
}
