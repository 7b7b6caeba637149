//! Several quantities over one time axis, each in a panel of its own, with levels that must not be passed.

use crate::svg::{Anchor, Axes, Scale, Svg, trace};

const WIDTH: f64 = 1080.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = WIDTH - 24.0;
const TOP: f64 = 12.0;
const PLOT: f64 = 170.0;
const NEXT: f64 = 34.0;

/// One quantity.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    /// Name and unit.
    pub name: &'a str,
    /// Classes of the page's style, each with its values.
    pub series: Vec<(&'a str, &'a [f64])>,
    /// Levels to draw.
    pub levels: Vec<f64>,
}

/// Draws panels below each other; each line is cut into `stretches` that keep their extremes. `label` is what a screen
/// reader says.
pub fn panels(time: &[f64], panels: &[Panel<'_>], stretches: usize, label: &str) -> String {
    let block = PLOT + NEXT;
    let mut svg = Svg::new(WIDTH, TOP + panels.len() as f64 * block + 6.0);
    let ends = (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(1.0));
    let x = Scale::exactly(ends.0, ends.1, LEFT, RIGHT);
    for (index, panel) in panels.iter().enumerate() {
        let (top, bottom) = (TOP + index as f64 * block, TOP + index as f64 * block + PLOT);
        let values = panel.series.iter().flat_map(|(_, values)| values.iter().copied());
        let y = Scale::linear(values.chain(panel.levels.iter().copied()), bottom, top);
        let axes = Axes { x, y, frame: [LEFT, top, RIGHT, bottom] };
        axes.draw(&mut svg, ["", panel.name], [9.0, 4.0]);
        for level in panel.levels.iter().filter_map(|level| y.place(*level)) {
            svg.line("mark", LEFT, level, RIGHT, level);
        }
        svg.line("edge", LEFT, top, LEFT, bottom);
        axes.begin(&mut svg);
        for (class, values) in &panel.series {
            svg.trace(class, &trace(time, values, x, y, stretches));
        }
        axes.end(&mut svg);
    }
    svg.text("axis", RIGHT, TOP + panels.len() as f64 * block, Anchor::End, "time, s");
    svg.finish(label)
}
