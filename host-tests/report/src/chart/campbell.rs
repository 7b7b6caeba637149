//! The Campbell diagram: natural frequencies and excitation orders over speed.

use crate::svg::{Anchor, Axes, Scale, Svg};

const WIDTH: f64 = 1080.0;
const HEIGHT: f64 = 420.0;
const FRAME: [f64; 4] = [70.0, 18.0, WIDTH - 120.0, HEIGHT - 46.0];

/// An order: frequency over speed, and its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Ray {
    /// Name, as `mesh 21`.
    pub name: String,
    /// Hz per rad/s of the motor.
    pub slope: f64,
}

/// Where a ray meets a natural frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// Speed of the motor (rad/s).
    pub speed: f64,
    /// Hz.
    pub frequency: f64,
    /// Whether it is flagged.
    pub flagged: bool,
    /// Tooltip.
    pub title: String,
}

/// Draws natural frequencies (Hz) level, rays rising, the running range (rad/s) as a band, and the crossings.
pub fn campbell(natural: &[f64], rays: &[Ray], running: Option<(f64, f64)>, crossings: &[Crossing]) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    // up to a quarter more than the greatest speed; without a running range, to where the lowest mode meets its last
    // order
    let fastest = match running {
        Some((_, greatest)) => 1.25 * greatest,
        None => 1.1 * crossings.iter().map(|crossing| crossing.speed).fold(1.0, f64::max),
    };
    let in_reach = |frequency: &&f64| rays.iter().any(|ray| ray.slope * fastest >= **frequency);
    let highest = natural.iter().filter(in_reach).copied().fold(0.0, f64::max);
    let top = if highest > 0.0 { 1.15 * highest } else { 1.1 * natural.first().copied().unwrap_or(1.0) };
    let x = Scale::exactly(0.0, fastest, FRAME[0], FRAME[2]);
    let y = Scale::exactly(0.0, top, FRAME[3], FRAME[1]);
    let at = |speed: f64| x.place(speed).unwrap_or(FRAME[0]);
    if let Some((least, greatest)) = running {
        svg.rect("strip", at(least), FRAME[1], at(greatest) - at(least), FRAME[3] - FRAME[1], 0.0);
    }
    let axes = Axes { x, y, frame: FRAME };
    axes.draw(&mut svg, ["speed of the motor, rad/s", "frequency, Hz"], [9.0, 6.0]);
    axes.begin(&mut svg);
    for &frequency in natural.iter().filter(|frequency| **frequency <= top) {
        if let Some(place) = y.place(frequency) {
            svg.path("curve truth", &[(FRAME[0], place), (FRAME[2], place)]);
        }
    }
    for ray in rays {
        // to the right edge or the top, whichever it meets first
        let end = (top / ray.slope).min(fastest);
        let (px, py) = (at(end), y.place(ray.slope * end).unwrap_or(FRAME[1]));
        svg.path("curve s0", &[(at(0.0), FRAME[3]), (px, py)]);
        if end < fastest {
            svg.text("number", px, FRAME[1] - 5.0, Anchor::Middle, &ray.name);
        } else {
            svg.text("marked", px + 6.0, py + 4.0, Anchor::Start, &ray.name);
        }
    }
    for crossing in crossings.iter().filter(|crossing| crossing.speed <= fastest && crossing.frequency <= top) {
        let class = if crossing.flagged { "point failed" } else { "point plain" };
        if let Some(place) = y.place(crossing.frequency) {
            svg.marker(class, 0, at(crossing.speed), place, &crossing.title);
        }
    }
    axes.end(&mut svg);
    svg.finish("Campbell diagram")
}
