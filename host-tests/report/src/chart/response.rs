//! Response at the motor: motor speed per motor torque over frequency, of the whole chain and its reductions.

use crate::svg::{Anchor, Scale, Svg, trace};

const WIDTH: f64 = 1080.0;
const HEIGHT: f64 = 360.0;
const FRAME: [f64; 4] = [70.0, 18.0, WIDTH - 24.0, HEIGHT - 46.0];

/// A curve: its name, its class in the style, and its amplitudes over the common frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    pub name: String,
    /// Style class: `truth` for the whole chain, `s0`, `s1` and so on for reductions.
    pub class: String,
    /// Speed per torque (rad/s per N m) at each frequency.
    pub amplitude: Vec<f64>,
}

/// Draws curves over frequency (Hz), both axes logarithmic.
pub fn response(frequency: &[f64], curves: &[Response]) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    // Undamped peaks have no height: the axis spans what lies between the first and last percent.
    let mut all: Vec<f64> = curves.iter().flat_map(|curve| curve.amplitude.iter().copied()).collect();
    all.retain(|value| value.is_finite() && *value > 0.0);
    all.sort_by(f64::total_cmp);
    let cut = all.len() / 100;
    let x = Scale::logarithmic(frequency.iter().copied(), FRAME[0], FRAME[2]);
    let y =
        Scale::logarithmic(all.iter().copied().skip(cut).take(all.len().saturating_sub(2 * cut)), FRAME[3], FRAME[1]);
    for (place, label) in x.ticks(8.0) {
        svg.line("grid", place, FRAME[1], place, FRAME[3]);
        svg.text("tick", place, FRAME[3] + 17.0, Anchor::Middle, &label);
    }
    for (place, label) in y.ticks(6.0) {
        svg.line("grid", FRAME[0], place, FRAME[2], place);
        svg.text("tick", FRAME[0] - 8.0, place + 4.0, Anchor::End, &label);
    }
    for curve in curves {
        svg.trace(&format!("curve {}", curve.class), &trace(frequency, &curve.amplitude, x, y, 2_000));
    }
    svg.text("axis", FRAME[2], FRAME[3] + 38.0, Anchor::End, "frequency, Hz");
    svg.upright("axis", 14.0, (FRAME[1] + FRAME[3]) / 2.0, "motor speed per torque, rad/s per N m");
    svg.finish("Motor speed per motor torque over frequency")
}
