//! Which frequencies the multisine has, and how large they are.

use core::cell::Cell;
use core::f64::consts::{PI, TAU};

use super::TestConfig;
use super::fit::Fit;
use super::multisine::Line;
use crate::math::{exp, ln, sin_cos, sqrt};

/// Most of a sum of many sines over its root mean square: passed in less than 1e-4 of the time.
const CREST: f64 = 3.9;

/// Peak of a sum of sines of these amplitudes: no more than their sum, and hardly more than `CREST` times their root
/// mean square.
pub(crate) fn peak(amplitudes: impl Iterator<Item = f64>) -> f64 {
    let (sum, square) = amplitudes.fold((0.0, 0.0), |(sum, square), a| (sum + a, square + a * a));
    sum.min(CREST * sqrt(0.5 * square))
}

/// Frequencies (Hz) over the band, by like ratios.
pub(crate) fn over_band<const L: usize>(band: [f64; 2]) -> [f64; L] {
    let step = ln(band[1] / band[0]) / (L.max(2) - 1) as f64;
    let mut hertz = [0.0; L];
    for (k, value) in hertz.iter_mut().enumerate() {
        *value = band[0] * exp(step * k as f64);
    }
    hertz
}

/// Frequencies (Hz) about the resonance and the antiresonance of a fit, and some wide of them; and the time (s)
/// that tells those about the resonance apart.
pub(crate) fn about<const L: usize>(fit: &Fit, band: [f64; 2]) -> ([f64; L], f64) {
    let derived = fit.derived();
    let (low, high) = (derived.antiresonance / TAU, derived.resonance / TAU);
    let wide = L / 4;
    let narrow = (L - wide) / 2;
    let z = derived.damping_ratio.clamp(0.003, 0.1);
    let apart = (high / low.max(f64::MIN_POSITIVE) - 1.0).clamp(0.01, 1.0);
    let ends = [(0.4 * low).max(band[0]), (1.6 * high).min(band[1])];
    let mut hertz = [0.0; L];
    for (k, value) in hertz.iter_mut().enumerate() {
        let place = |k: usize, of: usize| (k as f64 + 0.5) / of as f64;
        *value = if k < wide {
            ends[0] * exp(ln(ends[1] / ends[0]) * place(k, wide))
        } else if k < wide + narrow {
            low * (1.0 + (4.0 * z).max(0.4 * apart) * (2.0 * place(k - wide, narrow) - 1.0))
        } else {
            high * (1.0 + 4.0 * z * (2.0 * place(k - wide - narrow, L - wide - narrow) - 1.0))
        };
    }
    sort(&mut hertz);
    (hertz, 2.0 * narrow as f64 / (8.0 * z * high).max(f64::MIN_POSITIVE))
}

/// Puts numbers in rising order, without the panic of the standard sort for an order that is none.
fn sort<const L: usize>(numbers: &mut [f64; L]) {
    let cells = Cell::from_mut(&mut numbers[..]).as_slice_of_cells();
    for _ in 0..L {
        for (a, b) in cells.iter().zip(cells.iter().skip(1)) {
            if a.get() > b.get() {
                a.swap(b);
            }
        }
    }
}

/// Time (s) over which frequencies can be told apart: half of their mean distance is two lines of the record.
pub(crate) fn time<const L: usize>(hertz: &[f64; L]) -> f64 {
    let mut least = f64::INFINITY;
    for (a, b) in hertz.iter().zip(hertz.iter().skip(2)) {
        least = least.min(b - a);
    }
    4.0 / least.max(f64::MIN_POSITIVE)
}

/// Lines at these frequencies (Hz), moved to whole turns over the record, two apart at least: so the window keeps
/// them apart.
pub(crate) fn lines<const L: usize>(hertz: &[f64; L], blocks: u32, config: &TestConfig) -> [Line; L] {
    let time = f64::from(blocks) * config.block;
    let mut lines = [Line::NONE; L];
    let mut least = 2_u32;
    for (line, hertz) in lines.iter_mut().zip(hertz) {
        let turns = ((hertz * time + 0.5) as u32).max(least);
        least = turns.saturating_add(2);
        let frequency = TAU * f64::from(turns) / time;
        let (sine, cosine) = sin_cos(frequency * config.block);
        *line = Line { frequency, turn: [cosine as f32, sine as f32], ..Line::NONE };
    }
    lines
}

/// Sets the amplitudes (N m), with starts by which they hardly ever meet [Schroeder 1970, IEEE Trans. Inf. Theory
/// 16].
pub(crate) fn set<const L: usize>(lines: &mut [Line; L], amplitude: impl Fn(f64) -> f64) {
    for (k, line) in lines.iter_mut().enumerate() {
        let place = k as f64;
        let (sine, cosine) = sin_cos(-PI * place * place / L as f64);
        let size = amplitude(line.frequency);
        line.amplitude = [(size * cosine) as f32, (size * sine) as f32];
    }
}
