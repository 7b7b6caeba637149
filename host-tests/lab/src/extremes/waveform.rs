//! The speed fluctuation of a known waveform, with few ticks to the turn and a coarse encoder.

use std::f64::consts::TAU;

use driveline::fluctuation::{CycleConfig, Extremes, Fluctuation, Waveform, WaveformConfig};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle};

use super::solver::said;
use super::{Cases, Found};

pub(super) fn add(all: &mut Cases) {
    all.subject("delta of 1e-4, few ticks a turn", "delta, relative", "closed form of the waveform");
    for ticks in [3.3, 8.2, 13.7, 24.9, 47.1, 50.3, 60.0, 97.3, 300.7, 1000.3] {
        all.case(format!("waveform, {ticks} ticks a turn"), || waveform(1e-4, ticks, 4_294_967_296.0, 64));
        all.case(format!("extremes, {ticks} ticks a turn"), || extremes(1e-4, ticks));
    }
    for counts in [500.0, 8192.0, 131_072.0] {
        all.case(format!("waveform, 97.3 ticks a turn, {counts} counts"), || waveform(1e-4, 97.3, counts, 128));
    }
}

/// Speed over its mean by the angle: two orders, the largest less the least `delta`.
fn speed(delta: f64, angle: f64) -> f64 {
    1.0 + 0.4 * delta * (angle - 0.7).cos() + 0.17 * delta * (2.0 * angle + 1.1).cos()
}

/// Delta on a fine grid.
fn truth(delta: f64) -> f64 {
    let grid = || (0..20_000).map(|k| speed(delta, f64::from(k) / 20_000.0 * TAU));
    grid().fold(f64::MIN, f64::max) - grid().fold(f64::MAX, f64::min)
}

/// The angle a tick later, at a mean of so many ticks a turn.
fn next(delta: f64, ticks: f64, mut angle: f64) -> f64 {
    let step = TAU / ticks / 8.0;
    for _ in 0..8 {
        angle += step * speed(delta, angle + 0.5 * step * speed(delta, angle));
    }
    angle
}

/// A waveform of 64 bins and four orders. Off by more than 5 % and more than three of the deviations beside it is wrong.
pub fn waveform(delta: f64, ticks: f64, counts: f64, cycles: u32) -> Result<Found, String> {
    let config = WaveformConfig::new::<64>(CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI), cycles);
    let mut waveform = Waveform::<64, f64>::default();
    let mut angle = 0.3;
    for _ in 0..(ticks * f64::from(cycles + 8)) as u32 {
        angle = next(delta, ticks, angle);
        let turned = ((angle / TAU * counts).floor() / counts).fract() * 4_294_967_296.0;
        waveform.measure(&config, turned as u32, 0.0, &Estimate { motor_speed: 1.0, ..Estimate::default() });
        if let Some(window) = waveform.take() {
            let found = window.ripple(&config, 4).map_err(said)?.motor;
            let truth = truth(delta);
            let error = (found.delta / truth - 1.0).abs();
            return Ok(Found { error, limit: (3.0 * found.deviation / truth).max(0.05) });
        }
    }
    Err("no window of the waveform".to_owned())
}

/// The extremes of a cycle, by the true speed.
pub fn extremes(delta: f64, ticks: f64) -> Result<Found, String> {
    let config = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
    let mut extremes = Extremes::<f64>::default();
    let rated = TAU / ticks / 1e-4;
    let mut angle = 0.3;
    for _ in 0..(ticks * 12.0) as u32 {
        angle = next(delta, ticks, angle);
        let estimate = Estimate { motor_speed: rated * speed(delta, angle), ..Estimate::default() };
        extremes.measure(&config, ((angle / TAU).fract() * 4_294_967_296.0) as u32, 0.0, &estimate);
    }
    let reading = extremes.reading(&config).ok_or("no reading of the cycle")?;
    Ok(Found { error: (reading.motor.delta / truth(delta) - 1.0).abs(), limit: 0.05 })
}
