//! Curves over a common axis: a Campbell diagram, an amplitude over the speed, a course over time.

use crate::svg::{Anchor, Scale, Svg, text_width, trace};

const WIDTH: f64 = 1080.0;
const FRAME: [f64; 4] = [78.0, 30.0, WIDTH - 24.0, 400.0];
const HEIGHT: f64 = FRAME[3] + 46.0;

/// A curve: its class in the style (`truth`, `s0` to `s5`), and its values over the common axis; what is not finite
/// breaks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Style class.
    pub class: String,
    pub values: Vec<f64>,
}

/// Curves over a common axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// Text for a screen reader.
    pub label: String,
    /// Name and unit of the common axis.
    pub along: String,
    /// Name and unit of the values.
    pub across: String,
    /// Places on the common axis, increasing.
    pub places: Vec<f64>,
    pub curves: Vec<Curve>,
    /// Places that are marked, with a word.
    pub marks: Vec<(f64, String)>,
    /// Single points: place, value, style class, and the tooltip.
    pub points: Vec<(f64, f64, String, String)>,
    /// Whether the values are drawn by their logarithm.
    pub logarithmic: bool,
}

impl Lines {
    /// Draws them.
    #[must_use]
    pub fn draw(&self) -> String {
        let mut svg = Svg::new(WIDTH, HEIGHT);
        let [left, top, right, bottom] = FRAME;
        let ends = (self.places.first().copied().unwrap_or(0.0), self.places.last().copied().unwrap_or(1.0));
        let x = Scale::exactly(ends.0, ends.1, left, right);
        let all = self.curves.iter().flat_map(|curve| curve.values.iter().copied());
        let all = all.chain(self.points.iter().map(|point| point.1)).filter(|value| value.is_finite());
        let y = if self.logarithmic {
            Scale::logarithmic(all, bottom, top)
        } else {
            Scale::linear(all.chain([0.0]), bottom, top)
        };
        for (place, label) in x.ticks(9.0) {
            svg.line("grid", place, top, place, bottom);
            svg.text("tick", place, bottom + 17.0, Anchor::Middle, &label);
        }
        for (place, label) in y.ticks(6.0) {
            svg.line("grid", left, place, right, place);
            svg.text("tick", left - 8.0, place + 4.0, Anchor::End, &label);
        }
        self.draw_marks(&mut svg, x);
        for curve in &self.curves {
            svg.trace(&format!("curve {}", curve.class), &trace(&self.places, &curve.values, x, y, 2_000));
        }
        for (place, value, class, title) in &self.points {
            if let Some((px, py)) = x.place(*place).zip(y.place(*value)) {
                svg.marker(&format!("point {class}"), 0, px, py, title);
            }
        }
        svg.text("axis", right, bottom + 38.0, Anchor::End, &self.along);
        svg.upright("axis", 14.0, (top + bottom) / 2.0, &self.across);
        svg.finish(&self.label)
    }

    fn draw_marks(&self, svg: &mut Svg, x: Scale) {
        let [left, top, right, bottom] = FRAME;
        let mut free = left;
        for (place, word) in &self.marks {
            let Some(place) = x.place(*place) else { continue };
            svg.line("mark", place, top - 8.0, place, bottom);
            // A word that would run into the one before it is left out; the line stays.
            let width = text_width(word, 11.0);
            let start = place.min(right - width);
            if start >= free {
                svg.text("marked", start, top - 14.0, Anchor::Start, word);
                free = start + width + 10.0;
            }
        }
    }
}

/// A curve over time that a legend names.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub name: String,
    /// Style class, `s0` and on.
    pub class: String,
    /// Values at the common times.
    pub values: Vec<f64>,
}

/// Draws lines over time (s); `quantity` is what stands at the axis. `marks` are times of events.
pub fn over_time(time: &[f64], drawn: &[Line], quantity: &str, marks: &[f64]) -> String {
    let curve = |line: &Line| Curve { class: line.class.clone(), values: line.values.clone() };
    Lines {
        label: format!("{quantity} over time"),
        along: "time, s".to_owned(),
        across: quantity.to_owned(),
        places: time.to_vec(),
        curves: drawn.iter().map(curve).collect(),
        marks: marks.iter().map(|&mark| (mark, String::new())).collect(),
        ..Lines::default()
    }
    .draw()
}
