//! The exact step beside others: a row for each, its errors on one logarithmic axis.

use crate::format;
use crate::results::Comparison;
use crate::svg::{Anchor, Scale, Svg};

const WIDTH: f64 = 1080.0;
const LEFT: f64 = 300.0;
const RIGHT: f64 = WIDTH - 90.0;
const ROW: f64 = 30.0;

/// Draws the rms errors of shaft torque (circle) and load speed (diamond) of each step.
pub fn step_errors(rows: &[Comparison]) -> String {
    let bottom = 14.0 + ROW * rows.len() as f64;
    let mut svg = Svg::new(WIDTH, bottom + 46.0);
    let values = rows.iter().flat_map(|row| [row.shaft_torque.rms * 100.0, row.load_speed.rms * 100.0]);
    // An error of a thousandfold is as good as diverged, and would press the others together.
    let x = Scale::logarithmic(values.filter(|&value| value < 1e5), LEFT, RIGHT);
    for (place, label) in x.ticks(8.0) {
        svg.line("grid", place, 8.0, place, bottom);
        svg.text("tick", place, bottom + 17.0, Anchor::Middle, &label);
    }
    svg.line("edge", LEFT, bottom, RIGHT, bottom);
    svg.text("axis", RIGHT, bottom + 38.0, Anchor::End, "rms error, % of peak torque and of rated speed");
    for (index, row) in rows.iter().enumerate() {
        let y = 14.0 + ROW * (index as f64 + 0.5);
        svg.text(
            "row",
            LEFT - 14.0,
            y + 4.0,
            Anchor::End,
            &format!("{} · {} · {}", row.step, row.observer, format::rate(row.rate_hz)),
        );
        svg.line("grid", LEFT, y, RIGHT, y);
        let torque = (row.shaft_torque.rms, 0, "s0", "shaft torque");
        let speed = (row.load_speed.rms, 2, "s1", "load speed");
        let mut diverged = false;
        for (rms, shape, series, name) in [torque, speed] {
            let title = format!("{}, {}: {name} {}", row.step, row.observer, format::percent(rms));
            let drawn = rms.is_finite() && rms < 1e3;
            diverged |= !drawn;
            if let (Some(place), true) = (x.place(rms * 100.0), drawn) {
                svg.marker(&format!("point on {series}"), shape, place, y, &title);
            }
        }
        if diverged {
            svg.text("failed", RIGHT + 10.0, y + 4.0, Anchor::Start, format::DIVERGED);
        }
    }
    svg.finish("Errors of the observer with different steps")
}
