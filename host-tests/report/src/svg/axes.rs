//! The axes of a plot: grid, ticks and names, and where the page's viewer finds what is drawn between them.

use std::fmt::Write;

use super::{Anchor, Scale, Svg};

/// Two axes and the frame that they stand in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// Common axis, from left to right.
    pub x: Scale,
    /// Axis of the values, from the bottom to the top.
    pub y: Scale,
    /// Left, top, right, bottom.
    pub frame: [f64; 4],
}

impl Axes {
    /// Draws grid and ticks, about so many along and across, and the names of the axes.
    pub fn draw(&self, svg: &mut Svg, [along, across]: [&str; 2], ticks: [f64; 2]) {
        let [left, top, right, bottom] = self.frame;
        svg.body.push_str(r#"<g class="axes">"#);
        for (place, label) in self.x.ticks(ticks[0]) {
            svg.line("grid", place, top, place, bottom);
            svg.text("tick", place, bottom + 17.0, Anchor::Middle, &label);
        }
        for (place, label) in self.y.ticks(ticks[1]) {
            svg.line("grid", left, place, right, place);
            svg.text("tick", left - 8.0, place + 4.0, Anchor::End, &label);
        }
        svg.body.push_str("</g>");
        if !along.is_empty() {
            svg.text("axis", right, bottom + 38.0, Anchor::End, along);
        }
        svg.upright("axis", 14.0, (top + bottom) / 2.0, across);
    }

    /// Begins what is drawn between the axes. The viewer reads values off it, and zooms it.
    pub fn begin(&self, svg: &mut Svg) {
        let [left, top, right, bottom] = self.frame;
        let (x, y) = (self.x.ends(), self.y.ends());
        // Writing to a `String` cannot fail.
        let _ = write!(
            svg.body,
            r#"<g class="plot" data-frame="[{left},{top},{right},{bottom}]" data-x="[{x}]" data-y="[{y}]">"#
        );
    }

    /// Ends it.
    pub fn end(&self, svg: &mut Svg) {
        svg.body.push_str("</g>");
    }
}
