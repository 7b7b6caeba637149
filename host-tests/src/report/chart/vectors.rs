//! Vibrations or unbalances as arrows in a polar plot, as a balancer draws them.

use crate::report::format;
use crate::report::svg::{Anchor, Svg};

const SIZE: f64 = 380.0;
const MIDDLE: f64 = SIZE / 2.0;
const RADIUS: f64 = 145.0;
const TOP: f64 = 26.0;

/// An arrow: its size and angle [degrees], its class in the style, and what a pointer is told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrow {
    /// Size.
    pub size: f64,
    /// Angle [degrees], from the right, anticlockwise.
    pub angle: f64,
    /// Style class, `s0` to `s5`.
    pub class: String,
    /// A sentence.
    pub title: String,
}

/// Draws arrows from one point. `title` stands over them; `unit` belongs to the circles' numbers, which are `scale`
/// times the sizes.
#[must_use]
pub fn vectors(title: &str, unit: &str, scale: f64, arrows: &[Arrow]) -> String {
    let mut svg = Svg::new(SIZE, SIZE + TOP);
    svg.text("name", 8.0, 16.0, Anchor::Start, title);
    let largest = arrows.iter().map(|arrow| arrow.size * scale).filter(|size| size.is_finite()).fold(0.0, f64::max);
    let step = round_step(largest / 3.0);
    let rings = (largest / step).ceil().clamp(1.0, 6.0);
    let place = |size: f64, angle: f64| {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let radius = size / (rings * step) * RADIUS;
        (MIDDLE + radius * cosine, TOP + MIDDLE - radius * sine)
    };
    for ring in 1..=rings as usize {
        let circle: Vec<(f64, f64)> = (0..=72).map(|k| place(ring as f64 * step, f64::from(k) * 5.0)).collect();
        svg.path("ring", &circle);
        let (x, y) = place(ring as f64 * step, 75.0);
        svg.text("number", x + 2.0, y - 2.0, Anchor::Start, &format::significant_short(ring as f64 * step));
    }
    for angle in [0.0, 90.0, 180.0, 270.0] {
        let (x, y) = place(rings * step, angle);
        svg.line("grid", MIDDLE, TOP + MIDDLE, x, y);
        let (x, y) = place(rings * step * 1.09, angle);
        svg.text("tick", x, y + 4.0, Anchor::Middle, &format!("{angle}°"));
    }
    for arrow in arrows {
        let (size, class) = (arrow.size * scale, format!("curve {}", arrow.class));
        let tip = place(size, arrow.angle);
        svg.path(&class, &[(MIDDLE, TOP + MIDDLE), tip]);
        svg.marker(&format!("point {}", arrow.class), 0, tip.0, tip.1, &arrow.title);
    }
    svg.text("axis", SIZE - 8.0, SIZE + TOP - 6.0, Anchor::End, unit);
    let told: Vec<&str> = arrows.iter().map(|arrow| arrow.title.as_str()).collect();
    svg.finish(&format!("{title}: {}", told.join(", ")))
}

/// 1, 2 or 5 times a power of ten, at least as large.
fn round_step(rough: f64) -> f64 {
    if !(rough > 0.0 && rough.is_finite()) {
        return 1.0;
    }
    let decade = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|&step| step >= rough).unwrap_or(rough)
}

#[cfg(test)]
mod tests {
    use super::{Arrow, vectors};

    #[test]
    fn any_sizes_give_a_plot() {
        for size in [0.0, 1e-9, 3.0, 1e300, f64::NAN, f64::INFINITY, -1.0] {
            let arrow = Arrow { size, angle: 30.0, class: "s0".into(), title: "it".into() };
            let plot = vectors("one", "mm", 1e3, &[arrow.clone(), Arrow { size: 1.0, ..arrow }]);
            assert!(plot.starts_with("<svg") && !plot.contains("NaN") && !plot.contains("inf"));
        }
    }
}
