//! The library's measurement of the speed's fluctuation over a recorded angle.

use driveline::fluctuation::{CycleConfig, Fluctuation, Waveform, WaveformConfig};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle, Error};

use super::signals::turned;
use super::window::{Windowed, Windows};

/// Bins of a cycle: enough for the highest order there is, and for a cycle of 16 turns.
const BINS: usize = 64;

/// The windows of an angle \[rad\] from `start` \[s\] on, its samples a `period` apart.
///
/// # Errors
/// A cycle, or a number of cycles, that the library refuses.
pub fn measure(angle: &[f64], [start, period]: [f64; 2], windows: Windows) -> Result<Vec<Windowed>, Error> {
    let cycle = CycleConfig::try_new(Cycle { turns: windows.turns, cycles: 1 }, period, Bases::SI)?;
    let config = WaveformConfig::try_new::<BINS>(cycle, windows.cycles)?;
    let mut waveform = Waveform::<f64, BINS>::default();
    let (mut found, mut last) = (Vec::new(), angle.first().copied().unwrap_or(0.0));
    for (sample, &angle) in angle.iter().enumerate() {
        let estimate = Estimate { motor_speed: (angle - last) / period, ..Estimate::default() };
        last = angle;
        waveform.measure(&config, turned(angle), 0.0, &estimate);
        if let Some(window) = waveform.take() {
            let ripple = window.ripple(&config, windows.orders);
            let (until, cycles) = (start + sample as f64 * period, windows.cycles);
            // what whole ticks leave over is no doubt
            found.push(Windowed { until, cycles, ripple, doubt: None });
        }
    }
    Ok(found)
}
