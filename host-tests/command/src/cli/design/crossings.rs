//! Where a loop's response crosses the unit circle and the negative real axis, and the poles of the closed loop.

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;
use serde::Serialize;

use super::linear::Linear;
use super::responses::short;

/// A crossing of the loop's response: of the unit circle, or of the negative real axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Crossing {
    /// Frequency (Hz).
    pub hz: f64,
    /// Of the unit circle: the phase to -180 degrees (degrees), and the dead time more that has as much (ms).
    pub phase_margin: Option<f64>,
    /// As above.
    pub delay_margin: Option<f64>,
    /// Of the negative real axis: the gain that is missing to 1 (dB).
    pub gain_margin: Option<f64>,
}

/// A pole of the closed loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pole {
    /// In the plane of z.
    pub re: f64,
    /// As above.
    pub im: f64,
    /// Natural frequency (Hz), of `ln(z)` over a tick.
    pub hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

/// Crossings of the unit circle and of the negative real axis, in the order of their frequency.
pub fn crossings(response: impl Fn(f64) -> Complex<f64>, frequencies: &[f64], open: &[Complex<f64>]) -> Vec<Crossing> {
    let mut found = Vec::new();
    let is_low = |value: Complex<f64>| value.norm() < 1.0;
    let is_below = |value: Complex<f64>| value.im < 0.0;
    for (ends, values) in frequencies.windows(2).zip(open.windows(2)) {
        let of = |side: &dyn Fn(Complex<f64>) -> bool| {
            let (mut low, mut high) = (ends[0], ends[1]);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if side(response(middle)) == side(values[0]) { low = middle } else { high = middle }
            }
            let at = 0.5 * (low + high);
            (at, response(at))
        };
        let none = Crossing { hz: 0.0, phase_margin: None, delay_margin: None, gain_margin: None };
        if is_low(values[0]) != is_low(values[1]) {
            let (at, value) = of(&is_low);
            let (phase, lag) = ((-value).arg(), value.arg() + PI);
            found.push(Crossing {
                hz: short(at / TAU),
                phase_margin: Some(short(phase.to_degrees())),
                delay_margin: Some(short(1e3 * lag / at)),
                ..none
            });
        }
        if is_below(values[0]) != is_below(values[1]) {
            let (at, value) = of(&is_below);
            // a change of sign through the positive axis, or through a pole, is none
            if value.re < 0.0 && value.im.abs() < 1e-3 * -value.re {
                found.push(Crossing {
                    hz: short(at / TAU),
                    gain_margin: Some(short(-20.0 * value.norm().log10())),
                    ..none
                });
            }
        }
    }
    found
}

/// Poles of the closed loop, the slowest first.
pub fn poles(linear: &Linear, period: f64) -> Vec<Pole> {
    let mut poles = linear.poles().unwrap_or_default();
    // a speed loop leaves the angle free
    let free = (0..poles.len()).min_by(|&a, &b| (poles[a] - 1.0).norm().total_cmp(&(poles[b] - 1.0).norm()));
    if let Some(free) = free {
        poles.swap_remove(free);
    }
    // a conjugate is no other pole, and a delay's poles at 0 have no frequency
    poles.retain(|pole| pole.im >= 0.0 && pole.norm() > 1e-6);
    let pole = |pole: Complex<f64>| {
        let s = pole.ln() / period;
        Pole {
            re: short(pole.re),
            im: short(pole.im),
            hz: short(s.norm() / TAU),
            damping_ratio: short(-s.re / s.norm()),
        }
    };
    let mut poles: Vec<Pole> = poles.into_iter().map(pole).collect();
    poles.sort_by(|a, b| a.hz.total_cmp(&b.hz));
    poles
}
