//! Truth, estimate and error over time: three quantities below each other on one time axis.

use crate::format;
use crate::svg::{Anchor, Axes, Scale, Svg, trace};
use crate::trajectory::{Signal, Trajectory};

const WIDTH: f64 = 1080.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = WIDTH - 24.0;
const TOP: f64 = 34.0;
/// Heights of a quantity's plot, of its error strip, and of the gaps after each.
const PLOT: f64 = 150.0;
const STRIP: f64 = 50.0;
const GAP: f64 = 10.0;
const NEXT: f64 = 34.0;

/// Draws a trajectory; each line is cut into `stretches` that keep their extremes.
pub fn course(trajectory: &Trajectory, stretches: usize) -> String {
    let block = PLOT + GAP + STRIP + NEXT;
    let mut svg = Svg::new(WIDTH, TOP + 3.0 * block + 6.0);
    let ends = (trajectory.time.first().copied().unwrap_or(0.0), trajectory.time.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(ends.0, ends.1, LEFT, RIGHT);
    let bottom = TOP + 2.0 * block + PLOT + GAP + STRIP;
    marks(&mut svg, trajectory, x, bottom);
    let quantities = [
        ("Shaft torque", "N m", &trajectory.shaft_torque),
        ("Load speed", "rad/s", &trajectory.load_speed),
        ("Load torque", "N m", &trajectory.load_torque),
    ];
    for (index, (name, unit, signal)) in quantities.into_iter().enumerate() {
        let top = TOP + index as f64 * block;
        panel(&mut svg, (name, unit), signal, (&trajectory.time, x), top, stretches);
    }
    for (place, label) in x.ticks(9.0) {
        svg.text("tick", place, bottom + 16.0, Anchor::Middle, &label);
    }
    svg.text("axis", RIGHT, bottom + 31.0, Anchor::End, "time, s");
    svg.finish(&format!("{}, {}: truth, estimate and error over time", trajectory.variant, trajectory.situation))
}

fn marks(svg: &mut Svg, trajectory: &Trajectory, x: Scale, bottom: f64) {
    let mut free = LEFT;
    for mark in &trajectory.marks {
        let Some(place) = x.place(mark.time) else {
            continue;
        };
        svg.line("mark", place, TOP - 8.0, place, bottom);
        // A label that would run into the one before it is left out; the line stays.
        let width = crate::svg::text_width(&mark.label, 11.0);
        let start = place.min(RIGHT - width);
        if start >= free {
            svg.text("marked", start, TOP - 14.0, Anchor::Start, &mark.label);
            free = start + width + 10.0;
        }
    }
}

fn panel(svg: &mut Svg, named: (&str, &str), signal: &Signal, along: (&[f64], Scale), top: f64, stretches: usize) {
    let ((name, unit), (time, x)) = (named, along);
    let y = Scale::linear(shown(signal), top + PLOT, top);
    grid(svg, y, top, top + PLOT, 4.0);
    let axes = Axes { x, y, frame: [LEFT, top, RIGHT, top + PLOT] };
    axes.begin(svg);
    svg.trace("truth", &trace(time, &signal.truth, x, y, stretches));
    svg.trace("estimate", &trace(time, &signal.estimate, x, y, stretches));
    axes.end(svg);
    svg.upright("axis", 16.0, top + PLOT / 2.0, &format!("{name}, {unit}"));

    let error = signal.error();
    let size = error.iter().filter(|error| error.is_finite()).fold(0.0, |size: f64, error| size.max(error.abs()));
    let most = if size > 0.0 { size } else { 1.0 };
    let (from, to) = (top + PLOT + GAP + STRIP, top + PLOT + GAP);
    let strip = Scale::exactly(-most * 1.05, most * 1.05, from, to);
    svg.rect("strip", LEFT, to, RIGHT - LEFT, STRIP, 0.0);
    svg.line("zero", LEFT, (from + to) / 2.0, RIGHT, (from + to) / 2.0);
    svg.trace("error", &trace(time, &error, x, strip, stretches));
    if size > 0.0 {
        svg.text("tick", LEFT - 8.0, to + 10.0, Anchor::End, &format!("±{}", format::significant(size)));
    }
    svg.text("tick", LEFT - 8.0, from - 3.0, Anchor::End, "error");
}

/// The values that set a plot's height: the truth, and the estimate as far as it stays within one height of it. An
/// estimate that diverges leaves the plot at its edge and does not flatten the truth.
fn shown(signal: &Signal) -> Vec<f64> {
    let finite = || signal.truth.iter().copied().filter(|value| value.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let height = if high > low { high - low } else { high.abs().max(1e-9) };
    if low > high {
        return signal.estimate.clone();
    }
    let near = |value: &f64| value.clamp(low - height, high + height);
    let estimate = signal.estimate.iter().filter(|value| value.is_finite());
    [low, high].into_iter().chain(estimate.map(near)).collect()
}

fn grid(svg: &mut Svg, y: Scale, top: f64, bottom: f64, wanted: f64) {
    for (place, label) in y.ticks(wanted) {
        svg.line("grid", LEFT, place, RIGHT, place);
        svg.text("tick", LEFT - 8.0, place + 4.0, Anchor::End, &label);
    }
    svg.line("edge", LEFT, top, LEFT, bottom);
}
