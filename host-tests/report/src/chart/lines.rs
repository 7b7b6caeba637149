//! Curves over a common axis: a Campbell diagram, an amplitude over the speed, a course over time.

use crate::svg::{Anchor, Axes, Scale, Svg, text_width, trace};

const WIDTH: f64 = 1080.0;
const FRAME: [f64; 4] = [78.0, 30.0, WIDTH - 24.0, 400.0];
const HEIGHT: f64 = FRAME[3] + 46.0;

/// Range of values over their size below which they are a ripple.
const RIPPLE: f64 = 0.2;

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
    /// Whether the common axis is drawn by its logarithm.
    pub decades: bool,
    /// Least and most of a value that has a range.
    pub bands: Vec<Band>,
}

/// The range of a value over the common axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// Style class.
    pub class: String,
    /// The least.
    pub least: Vec<f64>,
    /// The most.
    pub most: Vec<f64>,
}

impl Lines {
    /// Draws them.
    #[must_use]
    pub fn draw(&self) -> String {
        let mut svg = Svg::new(WIDTH, HEIGHT);
        let [left, top, right, bottom] = FRAME;
        let ends = (self.places.first().copied().unwrap_or(0.0), self.places.last().copied().unwrap_or(1.0));
        let scale = if self.decades { Scale::exactly_logarithmic } else { Scale::exactly };
        let x = scale(ends.0, ends.1, left, right);
        let all = self.curves.iter().flat_map(|curve| curve.values.iter().copied());
        let all = all.chain(self.bands.iter().flat_map(|band| band.least.iter().chain(&band.most).copied()));
        let all = all.chain(self.points.iter().map(|point| point.1)).filter(|value| value.is_finite());
        let y = if self.logarithmic { Scale::logarithmic(within(all), bottom, top) } else { self.linear(all) };
        let axes = Axes { x, y, frame: FRAME };
        axes.draw(&mut svg, [&self.along, &self.across], [9.0, 6.0]);
        self.draw_marks(&mut svg, x);
        axes.begin(&mut svg);
        for band in &self.bands {
            let place = |values: &[f64], index: usize| x.place(self.places[index]).zip(y.place(values[index]));
            let most = (0..band.most.len()).filter_map(|index| place(&band.most, index));
            let least = (0..band.least.len()).rev().filter_map(|index| place(&band.least, index));
            svg.path(&format!("band {}", band.class), &most.chain(least).collect::<Vec<_>>());
        }
        for curve in &self.curves {
            svg.trace(&format!("curve {}", curve.class), &trace(&self.places, &curve.values, x, y, 2_000));
        }
        for (place, value, class, title) in &self.points {
            if let Some((px, py)) = x.place(*place).zip(y.place(*value)) {
                svg.marker(&format!("point {class}"), 0, px, py, title);
            }
        }
        axes.end(&mut svg);
        svg.finish(&self.label)
    }

    /// With zero on it, unless it would flatten them: a ripple fills its plot, and so does a frequency response.
    fn linear(&self, values: impl Iterator<Item = f64>) -> Scale {
        let values: Vec<f64> = values.collect();
        let ends = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
        let height = ends[1] - ends[0];
        let is_ripple = height > 0.0 && height < RIPPLE * ends[0].abs().max(ends[1].abs());
        let zero = (!self.decades && !is_ripple).then_some(0.0);
        Scale::linear(values.into_iter().chain(zero), FRAME[3], FRAME[1])
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

/// The values between the first and the last hundredth: an undamped peak has no height.
fn within(values: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
    let mut all: Vec<f64> = values.filter(|value| *value > 0.0).collect();
    all.sort_by(f64::total_cmp);
    let cut = if all.len() > 1000 { all.len() / 100 } else { 0 };
    let kept = all.len() - 2 * cut;
    all.into_iter().skip(cut).take(kept)
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

#[cfg(test)]
mod tests {
    use super::over_time;
    use crate::chart::Line;

    /// The height that a wave of so much about 100 takes of its plot (370 units).
    fn height(share: f64) -> f64 {
        let time: Vec<f64> = (0..200).map(f64::from).collect();
        let values = time.iter().map(|at| 100.0 + 100.0 * share * at.sin()).collect();
        let svg = over_time(&time, &[Line { name: "a".into(), class: "s0".into(), values }], "speed", &[]);
        let path = svg.split(r#"d="M"#).nth(1).unwrap().split('"').next().unwrap();
        // a start, then relative steps, in tenths of a unit
        let mut steps = path.split('l').map(|step| step.split(' ').nth(1).unwrap().parse::<f64>().unwrap());
        let mut at = steps.next().unwrap();
        let (mut least, mut most) = (at, at);
        for step in steps {
            at += step;
            (least, most) = (least.min(at), most.max(at));
        }
        (most - least) / 10.0
    }

    #[test]
    fn a_ripple_fills_its_plot() {
        assert!(height(0.02) > 300.0, "{}", height(0.02));
        // what goes through much of its range is seen from zero
        assert!(height(0.5) < 300.0, "{}", height(0.5));
    }
}
