//! Error against cost: a point for each variant, the front of those that nothing beats marked and named.

use super::front;
use super::label::Labels;
use crate::format;
use crate::results::Variant;
use crate::svg::{Axes, Scale, Svg};

const WIDTH: f64 = 540.0;
const HEIGHT: f64 = 380.0;
/// Left, top, right, bottom of the plot.
const FRAME: [f64; 4] = [62.0, 18.0, WIDTH - 20.0, HEIGHT - 48.0];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Instructions of a tick, the median.
    Tick,
    /// Instructions of a second, by the most of the run.
    Second,
}

/// Benefit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Error of the shaft torque, rms of its peak.
    ShaftTorque,
    /// Error of the load speed, rms of the rated speed.
    LoadSpeed,
}

impl Cost {
    fn of(self, variant: &Variant) -> f64 {
        match self {
            Self::Tick => variant.instructions.median as f64,
            Self::Second => variant.instructions_per_second(),
        }
    }

    const fn axis(self) -> &'static str {
        match self {
            Self::Tick => "instructions a tick (median; bar to the most of the run)",
            Self::Second => "instructions a second, by the most of the run",
        }
    }
}

impl Quality {
    fn of(self, variant: &Variant) -> f64 {
        match self {
            Self::ShaftTorque => variant.shaft_torque.rms,
            Self::LoadSpeed => variant.load_speed.rms,
        }
    }

    const fn axis(self) -> &'static str {
        match self {
            Self::ShaftTorque => "shaft torque, rms error of peak, %",
            Self::LoadSpeed => "load speed, rms error of rated, %",
        }
    }
}

/// Draws the variants; `series` and `shapes` give each variant its colour and its marker.
pub fn error_against_cost(variants: &[Variant], look: &[(usize, usize)], cost: Cost, quality: Quality) -> String {
    let points: Vec<(f64, f64)> =
        variants.iter().map(|variant| (cost.of(variant), quality.of(variant) * 100.0)).collect();
    let worst = variants.iter().map(|variant| if cost == Cost::Tick { variant.instructions.max as f64 } else { 0.0 });
    let x = Scale::logarithmic(points.iter().map(|point| point.0).chain(worst), FRAME[0], FRAME[2]);
    let y = Scale::logarithmic(points.iter().map(|point| point.1), FRAME[3], FRAME[1]);
    let mut svg = Svg::new(WIDTH, HEIGHT);
    Axes { x, y, frame: FRAME }.draw(&mut svg, [cost.axis(), quality.axis()], [6.0, 6.0]);
    svg.line("edge", FRAME[0], FRAME[3], FRAME[2], FRAME[3]);
    svg.line("edge", FRAME[0], FRAME[1], FRAME[0], FRAME[3]);
    // A diverged result is drawn at the upper edge of a logarithmic axis.
    let place = |(a, b): (f64, f64)| x.place(a).zip(y.place(if b.is_finite() { b } else { f64::MAX }));
    let front = front(&points);
    staircase(&mut svg, &front.iter().filter_map(|&index| place(points[index])).collect::<Vec<_>>());

    let mut labels = Labels::default();
    for (index, variant) in variants.iter().enumerate() {
        let Some((px, py)) = place(points[index]) else {
            continue;
        };
        labels.point(px, py);
        let (series, shape) = look.get(index).copied().unwrap_or((0, 0));
        if cost == Cost::Tick
            && variant.instructions.max > variant.instructions.median
            && let Some(end) = x.place(variant.instructions.max as f64)
        {
            svg.line(&format!("whisker s{series}"), px, py, end, py);
            labels.whisker(px, end, py);
        }
        let on = if front.contains(&index) { "on" } else { "off" };
        let failed = if points[index].1.is_finite() { "" } else { " failed" };
        let title = format!(
            "{}: {} at {} instructions",
            variant.label(),
            format::percent(quality.of(variant)),
            format::significant(cost.of(variant))
        );
        svg.marker(&format!("point {on} s{series}{failed}"), shape, px, py, &title);
    }
    // The front is named first, so that its names find room.
    let others = (0..variants.len()).filter(|index| !front.contains(index));
    for index in front.iter().copied().chain(others) {
        let Some(at) = place(points[index]) else {
            continue;
        };
        let on = front.contains(&index);
        let variant = &variants[index];
        let name = if on {
            format!("{} {}", variant.observer, format::rate(variant.rate_hz))
        } else {
            (index + 1).to_string()
        };
        // a semi-bold letter is a tenth wider
        let (class, size) = if on { ("name", 1.1 * 12.0) } else { ("number", 10.0) };
        if let Some((px, py, anchor)) = labels.place(&name, size, at, FRAME) {
            svg.text(class, px, py, anchor, &name);
        }
    }
    svg.finish(&format!("Error against cost: {} over {}", quality.axis(), cost.axis()))
}

/// The front as a staircase: for a cost between two of its points, the cheaper one applies.
fn staircase(svg: &mut Svg, points: &[(f64, f64)]) {
    let Some((&first, &last)) = points.first().zip(points.last()) else {
        return;
    };
    let mut corners = vec![(first.0, FRAME[1]), first];
    for pair in points.windows(2) {
        corners.push((pair[1].0, pair[0].1));
        corners.push(pair[1]);
    }
    corners.push((FRAME[2], last.1));
    svg.path("staircase", &corners);
}
