//! The library's measurement of the speed's fluctuation over a recorded angle.

use std::collections::VecDeque;

use driveline::fluctuation::{CycleConfig, Fluctuation, Waveform, WaveformConfig};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle, Error};

use super::signals::turned;
use super::window::{DIFFER, Windowed, Windows};
use crate::recording::unwrapped;

/// Bins of a cycle: enough for the highest order there is, and for a cycle of 16 turns; so many that samples at nearly
/// the same angles in every turn seldom share one.
const BINS: usize = 256;

/// Cycles of a steady machine whose durations differ by less, as a share.
const EVEN: f64 = 2e-3;

/// Root mean square of the durations' differences from a straight line, over their mean.
fn irregular(ends: &[f64]) -> f64 {
    let durations: Vec<f64> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let count = durations.len() as f64;
    let mean = durations.iter().sum::<f64>() / count;
    let place = |at: usize| at as f64 - 0.5 * (count - 1.0);
    let squares: f64 = (0..durations.len()).map(|at| place(at).powi(2)).sum();
    let along: f64 = durations.iter().enumerate().map(|(at, duration)| place(at) * duration).sum();
    let slope = if squares > 0.0 { along / squares } else { 0.0 };
    let off = |(at, duration): (usize, &f64)| (duration - mean - slope * place(at)).powi(2);
    (durations.iter().enumerate().map(off).sum::<f64>() / count).sqrt() / mean
}

/// The windows of an angle (rad) from `start` (s) on, its samples a `period` apart.
///
/// # Errors
/// A cycle, or a number of cycles, that the library refuses.
pub fn measure(angle: &[f64], [start, period]: [f64; 2], windows: Windows) -> Result<Vec<Windowed>, Error> {
    let cycle = CycleConfig::try_new(Cycle { turns: windows.turns, cycles: 1 }, period, Bases::SI)?;
    let config = WaveformConfig::try_new::<BINS>(cycle, windows.cycles)?;
    let mut waveform = Waveform::<BINS, f64>::default();
    let angle = unwrapped(angle);
    let (mut found, mut last) = (Vec::new(), angle.first().copied().unwrap_or(0.0));
    // when the shaft came into each of the last cycles, in samples
    let mut ends = VecDeque::new();
    for (sample, &angle) in angle.iter().enumerate() {
        let estimate = Estimate { motor_speed: (angle - last) / period, ..Estimate::default() };
        let [before, now] = [last, angle].map(|angle| angle / cycle.angle);
        if now.floor() != before.floor() {
            // forwards at the cycle's beginning, backwards at its end
            let passed = now.floor().max(before.floor());
            ends.push_back(sample as f64 - (now - passed) / (now - before));
        }
        last = angle;
        waveform.measure(&config, turned(angle), 0.0, &estimate);
        if let Some(window) = waveform.take() {
            let ripple = window.ripple(&config, windows.orders);
            let cycles = ripple.as_ref().map_or(windows.cycles, |ripple| ripple.cycles);
            while ends.len() > cycles as usize + 1 {
                ends.pop_front();
            }
            let delta = ripple.as_ref().map_or(0.0, |ripple| ripple.motor.delta);
            let doubt = (irregular(ends.make_contiguous()) > delta.max(EVEN)).then_some(DIFFER);
            found.push(Windowed { until: start + sample as f64 * period, cycles, ripple, doubt });
        }
    }
    Ok(found)
}
