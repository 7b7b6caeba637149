//! A mode shape: how far each mass turns, referred to the motor, with a line for each link.

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

/// Draws a shape, scaled so that its largest amplitude is one. `links` are the two stations that each joins: a branch
/// leaves the station that it is on.
pub fn mode_shape(stations: &[Station], links: &[[usize; 2]], shape: &[f64], title: &str) -> String {
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
    for ends in links.iter().map(|ends| ends.map(|end| points.get(end).copied())) {
        if let [Some(from), Some(to)] = ends {
            svg.path("shape", &[from, to]);
        }
    }
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

#[cfg(test)]
mod tests {
    use super::{Station, mode_shape};

    /// Three pumps on one wheel: a line to each, and none from pump to pump.
    #[test]
    fn a_branch_leaves_the_station_that_it_is_on() {
        let station = |name: &str| Station { name: name.to_owned(), share: 0.25 };
        let stations = ["wheel", "a", "b", "c"].map(station);
        let svg = mode_shape(&stations, &[[0, 1], [0, 2], [0, 3]], &[1.0, -0.2, -0.5, -1.0], "1. 20 Hz");
        let lines: Vec<&str> = svg.split(r#"class="shape" d="M"#).skip(1).collect();
        let wheel = lines[0].split('L').next().unwrap();
        assert!(lines.len() == 3 && lines.iter().all(|line| line.starts_with(wheel)), "{svg}");
    }
}
