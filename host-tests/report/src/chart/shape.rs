//! A mode shape: how far each mass of the chain turns, referred to the motor.

use crate::format;
use crate::svg::{Anchor, Scale, Svg};

const WIDTH: f64 = 380.0;
const LEFT: f64 = 22.0;
const RIGHT: f64 = WIDTH - 22.0;
const TOP: f64 = 34.0;
const HEIGHT: f64 = 130.0;

/// A mass of the chain: its name, and its share of the total inertia for the size of its disc.
#[derive(Clone, Debug, PartialEq)]
pub struct Station {
    pub name: String,
    /// Share of the total inertia.
    pub share: f64,
}

/// Draws a shape, scaled so that its largest amplitude is one.
pub fn mode_shape(stations: &[Station], shape: &[f64], title: &str) -> String {
    let mut svg = Svg::new(WIDTH, TOP + HEIGHT + 34.0);
    let count = stations.len().min(shape.len());
    let most = shape.iter().filter(|value| value.is_finite()).fold(0.0, |most: f64, value| most.max(value.abs()));
    let most = if most > 0.0 { most } else { 1.0 };
    let x = Scale::exactly(-0.4, count as f64 - 0.6, LEFT, RIGHT);
    let y = Scale::exactly(-1.15, 1.15, TOP + HEIGHT, TOP);
    svg.text("name", LEFT, 18.0, Anchor::Start, title);
    let zero = y.place(0.0).unwrap_or(TOP);
    svg.line("edge", LEFT, zero, RIGHT, zero);
    let points: Vec<(f64, f64)> =
        (0..count).filter_map(|index| x.place(index as f64).zip(y.place(shape[index] / most))).collect();
    svg.path("shape", &points);
    for (station, &(px, py)) in stations.iter().zip(&points) {
        svg.line("stem", px, zero, px, py);
        // The area of a disc is as its share; the smallest can still be seen.
        let radius = (3.0 + 9.0 * station.share.clamp(0.0, 1.0).sqrt()).min(12.0);
        svg.rect("disc", px - radius, py - radius, 2.0 * radius, 2.0 * radius, radius);
    }
    // Neighbouring names stand on two lines where they are too long for one.
    let room = (RIGHT - LEFT) / count.max(1) as f64;
    for (index, (station, &(px, _))) in stations.iter().zip(&points).enumerate() {
        let letters = ((room * if count > 4 { 1.9 } else { 0.95 }) / 6.2).max(4.0) as usize;
        let name: String = station.name.chars().take(letters).collect();
        let line = if count > 4 { (index % 2) as f64 * 13.0 } else { 0.0 };
        svg.text("tick", px, TOP + HEIGHT + 16.0 + line, Anchor::Middle, &name);
    }
    let values: Vec<String> = shape.iter().map(|value| format::significant(value / most)).collect();
    svg.finish(&format!("{title}: {}", values.join(", ")))
}
