//! Arrows on a polar grid: vibrations or weights by amplitude and angle, zero to the right, counted anticlockwise.

use crate::format;
use crate::svg::{Anchor, Svg};

const SIZE: f64 = 330.0;
const MIDDLE: f64 = SIZE / 2.0;
const RADIUS: f64 = 122.0;

/// An arrow from the middle.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// Its class, a colour.
    pub class: &'static str,
    /// Its tooltip, at the head.
    pub name: String,
    /// Length.
    pub amplitude: f64,
    /// Angle (degrees).
    pub degrees: f64,
}

/// Draws arrows, the longest nearly to the rim; `unit` is that of their lengths, `sense` the one in which their angles
/// run, in words.
pub fn polar(title: &str, unit: &str, sense: &str, arrows: &[Arrow]) -> String {
    let mut svg = Svg::new(SIZE, SIZE + 26.0);
    let top = 26.0;
    let most = arrows.iter().map(|arrow| arrow.amplitude).filter(|a| a.is_finite()).fold(0.0, f64::max);
    let most = if most > 0.0 { most } else { 1.0 };
    // rings at a round number, two to five of them
    let decade = 10_f64.powf(most.log10().floor());
    let ring =
        [0.2, 0.5, 1.0, 2.0].map(|part| part * decade).into_iter().find(|ring| most / ring <= 5.0).unwrap_or(most);
    let rings = (most / ring).ceil().max(1.0);
    let place = |amplitude: f64, degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let length = RADIUS * amplitude / (ring * rings);
        (MIDDLE + length * cosine, top + MIDDLE - length * sine)
    };
    svg.text("name", MIDDLE, 16.0, Anchor::Middle, title);
    for n in 1..=rings as u32 {
        let r = RADIUS * f64::from(n) / rings;
        svg.rect("ring", MIDDLE - r, top + MIDDLE - r, 2.0 * r, 2.0 * r, r);
    }
    for spoke in 0..12 {
        let degrees = f64::from(spoke) * 30.0;
        let (x, y) = place(ring * rings, degrees);
        svg.line("grid", MIDDLE, top + MIDDLE, x, y);
        let (x, y) = place(ring * rings * 1.13, degrees);
        svg.text("tick", x, y + 4.0, Anchor::Middle, &format!("{degrees}°"));
    }
    // in the corner, where neither an arrow nor an angle's name is
    let rim = format!("rim {} {unit}", format::significant_short(ring * rings));
    svg.text("marked", SIZE, top + SIZE - 6.0, Anchor::End, rim.trim());
    svg.text("marked", 0.0, top + SIZE - 6.0, Anchor::Start, &format!("↺ {sense}"));
    for arrow in arrows.iter().filter(|arrow| arrow.amplitude.is_finite() && arrow.degrees.is_finite()) {
        let (x, y) = place(arrow.amplitude, arrow.degrees);
        let class = format!("arrow {}", arrow.class);
        svg.path(&class, &[(MIDDLE, top + MIDDLE), (x, y)]);
        let told = format!(
            "{}: {} {unit} at {}°",
            arrow.name,
            format::significant(arrow.amplitude),
            format::significant(arrow.degrees)
        );
        svg.marker(&format!("point {}", arrow.class), 0, x, y, &told);
    }
    let told: Vec<String> =
        arrows.iter().map(|arrow| format!("{} {}", arrow.name, format::significant(arrow.amplitude))).collect();
    svg.finish(&format!("{title}, angles {sense}: {}", told.join(", ")))
}
