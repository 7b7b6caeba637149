//! The page of `backlash`: approaches beside each other, a stretch of a course over time, the tables.

use crate::backlash::{Comparison, Row, Stretch};
use driveline_report::format::percent;
use driveline_report::svg::{Anchor, Scale, Svg, trace};
use driveline_report::{Figure, Key, Section, Sheet};

const WIDTH: f64 = 1080.0;
const LEFT: f64 = 330.0;
const RIGHT: f64 = WIDTH - 20.0;
const ROW: f64 = 32.0;
const HEIGHT: f64 = 340.0;

/// The project's limits.
const LIMIT: f64 = 0.06;

/// The page as HTML, one file.
pub fn backlash_page(comparison: &Comparison) -> String {
    let names: Vec<String> =
        comparison.rows.iter().enumerate().map(|(index, row)| format!("{} {}", index + 1, row.approach)).collect();
    let estimates = comparison.stretch.estimates.iter().enumerate();
    let legend = estimates.map(|(index, (name, _))| Key::curve(*name, format!("s{index}")));
    Sheet {
        name: "Through the gap".to_owned(),
        kicker: "observers through backlash".to_owned(),
        summary: format!(
            "Two-mass machines with a gap of {} mrad, {} runs of {} s each, all through the full solver: torque known \
             to 1 % of rated in a tick, {} ticks a second.",
            1e3 * comparison.gap,
            comparison.courses.len(),
            comparison.seconds,
            comparison.rate_hz
        ),
        facts: Vec::new(),
        figures: vec![
            Figure {
                title: "Approaches".to_owned(),
                text: format!(
                    "Error of the shaft torque, rms of its peak, over {} courses: a point a course, a bar for their \
                        mean. The line is the limit, 6 %.",
                    comparison.courses.len()
                ),
                plots: vec![approaches(&comparison.rows)],
                ..Figure::default()
            },
            Figure {
                title: "Half a second of it".to_owned(),
                text: format!("{}: shaft torque as it is, and as four approaches take it.", comparison.stretch.course),
                legend: [Key::curve("truth", "truth")].into_iter().chain(legend).collect(),
                plots: vec![over_time(&comparison.stretch)],
                ..Figure::default()
            },
        ],
        tables: vec![
            Section::new("Means", "Over all runs.", comparison.table()),
            Section::new("Run by run", format!("Shaft torque. {}.", names.join("; ")), comparison.by_course()),
        ],
    }
    .page()
}

fn approaches(rows: &[Row]) -> String {
    let bottom = 14.0 + ROW * rows.len() as f64;
    let mut svg = Svg::new(WIDTH, bottom + 46.0);
    let x = Scale::logarithmic(rows.iter().flat_map(|row| row.each.iter().map(|value| 100.0 * value)), LEFT, RIGHT);
    for (place, label) in x.ticks(8.0) {
        svg.line("grid", place, 8.0, place, bottom);
        svg.text("tick", place, bottom + 17.0, Anchor::Middle, &label);
    }
    if let Some(place) = x.place(100.0 * LIMIT) {
        svg.line("mark", place, 8.0, place, bottom);
    }
    svg.line("edge", LEFT, bottom, RIGHT, bottom);
    svg.text("axis", RIGHT, bottom + 38.0, Anchor::End, "shaft torque, rms error of peak, %");
    for (index, row) in rows.iter().enumerate() {
        let y = 14.0 + ROW * (index as f64 + 0.5);
        svg.text("row", LEFT - 14.0, y + 4.0, Anchor::End, row.approach);
        svg.line("grid", LEFT, y, RIGHT, y);
        for value in &row.each {
            if let Some(place) = x.place(100.0 * value) {
                svg.marker("point off s0", 0, place, y, &format!("{}: {}", row.approach, percent(*value)));
            }
        }
        if let Some(place) = x.place(100.0 * row.shaft_torque) {
            svg.line("truth", place, y - 11.0, place, y + 11.0);
        }
    }
    svg.finish("Approaches to the gap and their errors")
}

fn over_time(stretch: &Stretch) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let (left, top, right, bottom) = (70.0, 18.0, WIDTH - 14.0, HEIGHT - 46.0);
    let ends = (stretch.time.first().copied().unwrap_or(0.0), stretch.time.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(ends.0, ends.1, left, right);
    let y = Scale::linear(stretch.truth.iter().map(|value| 1.3 * value), bottom, top);
    for (place, label) in x.ticks(9.0) {
        svg.text("tick", place, bottom + 17.0, Anchor::Middle, &label);
    }
    for (place, label) in y.ticks(5.0) {
        svg.line("grid", left, place, right, place);
        svg.text("tick", left - 8.0, place + 4.0, Anchor::End, &label);
    }
    let points = stretch.time.len();
    svg.trace("curve truth", &trace(&stretch.time, &stretch.truth, x, y, points));
    for (index, (_, estimate)) in stretch.estimates.iter().enumerate() {
        svg.trace(&format!("curve s{index}"), &trace(&stretch.time, estimate, x, y, points));
    }
    svg.text("axis", right, bottom + 38.0, Anchor::End, "time, s");
    svg.upright("axis", 14.0, (top + bottom) / 2.0, "shaft torque, N m");
    svg.finish("Shaft torque over time as approaches take it")
}
