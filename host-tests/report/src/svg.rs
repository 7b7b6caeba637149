//! A small SVG writer. Colours and type come from the page's style by class, so that a plot follows the reader's
//! light or dark theme; a plotting library would fix them in the plot.

mod axes;
mod scale;
mod trace;

pub use axes::Axes;
pub use scale::Scale;
pub use trace::trace;

use std::fmt::Write;

/// Markers of about ten units across: circle, square, diamond, triangle, inverted triangle, cross.
pub const MARKERS: [&str; 6] = [
    "M-5 0a5 5 0 1 0 10 0a5 5 0 1 0-10 0z",
    "M-4.4-4.4h8.8v8.8h-8.8z",
    "M0-6L6 0L0 6L-6 0z",
    "M0-5.8L5.6 4H-5.6z",
    "M0 5.8L5.6-4H-5.6z",
    "M-5.5-2h3.5v-3.5h4v3.5h3.5v4h-3.5v3.5h-4v-3.5h-3.5z",
];

/// A drawing under construction, in user units of about a pixel.
pub struct Svg {
    width: f64,
    height: f64,
    body: String,
}

/// Where a text is anchored.
#[derive(Clone, Copy, Debug)]
pub enum Anchor {
    /// The text begins at the point.
    Start,
    /// The point is the middle of the text.
    Middle,
    /// The text ends at the point.
    End,
}

impl Svg {
    /// An empty drawing.
    pub const fn new(width: f64, height: f64) -> Self {
        Self { width, height, body: String::new() }
    }

    /// Writes an element; a coordinate that is not finite leaves the element out, so that no `NaN` reaches the page.
    fn element(&mut self, coordinates: &[f64], text: std::fmt::Arguments<'_>) {
        if coordinates.iter().all(|coordinate| coordinate.is_finite()) {
            // Writing to a `String` cannot fail.
            let _ = self.body.write_fmt(text);
        }
    }

    /// A straight line.
    pub fn line(&mut self, class: &str, x1: f64, y1: f64, x2: f64, y2: f64) {
        let text = format_args!(r#"<line class="{class}" x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}"/>"#);
        self.element(&[x1, y1, x2, y2], text);
    }

    /// A rectangle with rounded corners of radius `r`.
    pub fn rect(&mut self, class: &str, x: f64, y: f64, width: f64, height: f64, r: f64) {
        let text = format_args!(
            r#"<rect class="{class}" x="{x:.1}" y="{y:.1}" width="{:.1}" height="{:.1}" rx="{r:.1}"/>"#,
            width.max(0.0),
            height.max(0.0)
        );
        self.element(&[x, y, width, height, r], text);
    }

    pub fn text(&mut self, class: &str, x: f64, y: f64, anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        let text = format_args!(r#"<text class="{class}" x="{x:.1}" y="{y:.1}" text-anchor="{anchor}">{text}</text>"#);
        self.element(&[x, y], text);
    }

    /// A text that reads upwards, its middle at the point.
    pub fn upright(&mut self, class: &str, x: f64, y: f64, text: &str) {
        let text = escape(text);
        let text = format_args!(
            r#"<text class="{class}" transform="translate({x:.1} {y:.1}) rotate(-90)" text-anchor="middle">{text}</text>"#
        );
        self.element(&[x, y], text);
    }

    /// A path through points.
    pub fn path(&mut self, class: &str, points: &[(f64, f64)]) {
        let mut data = String::new();
        for (index, (x, y)) in points.iter().enumerate() {
            let _ = write!(data, "{}{x:.1} {y:.1}", if index == 0 { "M" } else { "L" });
        }
        let flat: Vec<f64> = points.iter().flat_map(|&(x, y)| [x, y]).collect();
        self.element(&flat, format_args!(r#"<path class="{class}" d="{data}"/>"#));
    }

    /// A path in tenths of a unit, as [`trace`] writes it.
    pub fn trace(&mut self, class: &str, data: &str) {
        if !data.is_empty() {
            let _ = write!(self.body, r#"<path class="{class}" transform="scale(.1)" d="{data}"/>"#);
        }
    }

    /// A marker, one of [`MARKERS`], with a tooltip.
    pub fn marker(&mut self, class: &str, shape: usize, x: f64, y: f64, title: &str) {
        let path = MARKERS[shape % MARKERS.len()];
        let title = escape(title);
        let text = format_args!(
            r#"<path class="{class}" transform="translate({x:.1} {y:.1})" d="{path}"><title>{title}</title></path>"#
        );
        self.element(&[x, y], text);
    }

    /// The drawing as an `<svg>` element; `label` is what a screen reader says.
    pub fn finish(self, label: &str) -> String {
        let Self { width, height, body } = self;
        let label = escape(label);
        format!(r#"<svg viewBox="0 0 {width:.0} {height:.0}" role="img" aria-label="{label}">{body}</svg>"#)
    }
}

/// A text made safe between tags and inside quotes; control characters, which XML forbids, are left out.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c if c.is_control() => {}
            c => safe.push(c),
        }
    }
    safe
}

/// Width of a text in units, near enough to keep labels apart: a figure of the widest usual sans-serif is 0.64 of its
/// size, and an average letter less.
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * 0.64
}
