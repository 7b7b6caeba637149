//! Several quantities of one kind over time.

use crate::report::svg::{Anchor, Scale, Svg, trace};

const WIDTH: f64 = 1080.0;
const HEIGHT: f64 = 300.0;
const FRAME: [f64; 4] = [74.0, 14.0, WIDTH - 14.0, HEIGHT - 46.0];

/// One line: its name, its class in the style, its values at the common times.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Name.
    pub name: String,
    /// Style class, `s0` and on.
    pub class: String,
    /// Values.
    pub values: Vec<f64>,
}

/// Draws lines over time \[s\]; `quantity` is what stands at the axis. `marks` are times of events.
pub fn lines(time: &[f64], drawn: &[Line], quantity: &str, marks: &[f64]) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let ends = (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(ends.0, ends.1, FRAME[0], FRAME[2]);
    let y = Scale::linear(drawn.iter().flat_map(|line| line.values.iter().copied()), FRAME[3], FRAME[1]);
    for (place, label) in x.ticks(9.0) {
        svg.line("grid", place, FRAME[1], place, FRAME[3]);
        svg.text("tick", place, FRAME[3] + 17.0, Anchor::Middle, &label);
    }
    for (place, label) in y.ticks(6.0) {
        svg.line("grid", FRAME[0], place, FRAME[2], place);
        svg.text("tick", FRAME[0] - 8.0, place + 4.0, Anchor::End, &label);
    }
    for &mark in marks {
        if let Some(place) = x.place(mark) {
            svg.line("mark", place, FRAME[3], place, FRAME[3] + 5.0);
        }
    }
    for line in drawn {
        svg.trace(&format!("curve {}", line.class), &trace(time, &line.values, x, y, 1_000));
    }
    svg.text("axis", FRAME[2], FRAME[3] + 38.0, Anchor::End, "time, s");
    svg.upright("axis", 14.0, (FRAME[1] + FRAME[3]) / 2.0, quantity);
    svg.finish(&format!("{quantity} over time"))
}
