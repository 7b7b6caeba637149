//! A sweep as maps of error: natural frequency times tick across, inertia ratio up, a map for each damping.

use crate::format;
use crate::svg::{Anchor, Svg};
use crate::sweep::{Slice, values};

const WIDTH: f64 = 362.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = WIDTH - 8.0;
const TOP: f64 = 26.0;
const HEIGHT: f64 = 200.0;

/// Upper bounds of the classes of error; what is above the last has the last class.
pub const CLASSES: [f64; 8] = [1e-14, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2];

/// Class of an error for the style: `q0` the smallest to `q8`.
fn class(error: f64) -> usize {
    CLASSES.iter().position(|&bound| error <= bound).unwrap_or(CLASSES.len())
}

/// Draws one damping of a sweep. Failures are red with a cross, on top of everything.
pub fn heat_map(slice: &Slice<'_>) -> String {
    let across = values(slice.points.iter().map(|point| point.omega_t));
    let up = values(slice.points.iter().map(|point| point.inertia_ratio));
    let mut svg = Svg::new(WIDTH, TOP + HEIGHT + 40.0);
    let (width, height) = ((RIGHT - LEFT) / across.len().max(1) as f64, HEIGHT / up.len().max(1) as f64);
    let title = format!("damping {} of critical", format::significant_short(slice.damping));
    svg.text("row", LEFT, 15.0, Anchor::Start, &title);
    let (failures, total) = (slice.failures(), slice.points.len());
    let (verdict, style) = if failures == 0 {
        (format!("{total} met"), "met")
    } else {
        (format!("{failures} of {total} failed"), "failed")
    };
    svg.text(style, RIGHT, 15.0, Anchor::End, &verdict);
    for point in &slice.points {
        let column = across.iter().position(|&value| value == point.omega_t);
        let row = up.iter().position(|&value| value == point.inertia_ratio);
        let Some((column, row)) = column.zip(row) else {
            continue;
        };
        let (x, y) = (LEFT + column as f64 * width, TOP + HEIGHT - (row + 1) as f64 * height);
        let title = format!(
            "ωT {}, inertia ratio {}: error {}{}",
            format::significant_short(point.omega_t),
            format::significant_short(point.inertia_ratio),
            format::significant(point.error),
            if point.passed { "" } else { ", failed" }
        );
        let style = if point.passed { format!("cell q{}", class(point.error)) } else { "cell failed".to_owned() };
        svg.cell(&style, x + 0.5, y + 0.5, width - 1.0, height - 1.0, &title);
        if !point.passed && width > 6.0 && height > 6.0 {
            let (cx, cy, arm) = (x + width / 2.0, y + height / 2.0, (width.min(height) / 4.0).min(4.0));
            svg.line("cross", cx - arm, cy - arm, cx + arm, cy + arm);
            svg.line("cross", cx - arm, cy + arm, cx + arm, cy - arm);
        }
    }
    // Names at every second or third line of the grid, wherever they fit.
    let stride = |count: usize, room: f64| ((count as f64 * room).ceil() as usize).max(1);
    for (index, value) in across.iter().enumerate().step_by(stride(across.len(), 0.14)) {
        let place = LEFT + (index as f64 + 0.5) * width;
        svg.text("tick", place, TOP + HEIGHT + 15.0, Anchor::Middle, &grid_value(*value));
    }
    for (index, value) in up.iter().enumerate().step_by(stride(up.len(), 0.12)) {
        let place = TOP + HEIGHT - (index as f64 + 0.5) * height;
        svg.text("tick", LEFT - 6.0, place + 4.0, Anchor::End, &grid_value(*value));
    }
    svg.text("axis", RIGHT, TOP + HEIGHT + 33.0, Anchor::End, "ωT, rad");
    svg.upright("axis", 10.0, TOP + HEIGHT / 2.0, "inertia ratio");
    svg.finish(&format!("Error over omega T and inertia ratio, {title}"))
}

fn grid_value(value: f64) -> String {
    let exponent = value.log10();
    if value > 0.0 && (exponent - exponent.round()).abs() < 1e-6 {
        format::power(exponent.round() as i32)
    } else {
        format::significant_short(value)
    }
}
