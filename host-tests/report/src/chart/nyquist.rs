//! The frequency response of a loop in the complex plane, with the circle about -1 that it keeps out of.

use crate::svg::{Axes, Scale, Svg, trace};

const WIDTH: f64 = 1080.0;
const FRAME: [f64; 4] = [78.0, 30.0, WIDTH - 24.0, 560.0];
const HEIGHT: f64 = FRAME[3] + 46.0;
/// The part of the plane that is drawn: -1 in its middle, and the same scale on both axes.
const REAL: [f64; 2] = [-3.0, 1.0];
/// Angles that a circle is drawn by.
const CORNERS: usize = 180;

/// A response, its points in the order of the frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Locus {
    /// Style class.
    pub class: String,
    /// Real parts.
    pub real: Vec<f64>,
    /// Imaginary parts.
    pub imaginary: Vec<f64>,
    /// Least distance from -1.
    pub distance: f64,
}

/// Draws responses, each with the circle of its distance, and the unit circle.
pub fn nyquist(loci: &[Locus]) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let [left, top, right, bottom] = FRAME;
    let x = Scale::exactly(REAL[0], REAL[1], left, right);
    let half = 0.5 * (REAL[1] - REAL[0]) * (bottom - top) / (right - left);
    let y = Scale::exactly(-half, half, bottom, top);
    let axes = Axes { x, y, frame: FRAME };
    axes.draw(&mut svg, ["real part", "imaginary part"], [9.0, 6.0]);
    axes.begin(&mut svg);
    let circle = |at: f64, radius: f64| -> [Vec<f64>; 2] {
        let angles = (0..=CORNERS).map(|corner| std::f64::consts::TAU * corner as f64 / CORNERS as f64);
        let (real, imaginary) = angles.map(|angle| (at + radius * angle.cos(), radius * angle.sin())).unzip();
        [real, imaginary]
    };
    let draw = |svg: &mut Svg, class: &str, [real, imaginary]: [&[f64]; 2]| {
        // what leaves the drawn part is no line along its edge
        let inside = |k: usize| (REAL[0]..=REAL[1]).contains(&real[k]) && imaginary[k].abs() <= half;
        let seen = |k: usize| inside(k) || k > 0 && inside(k - 1) || k + 1 < real.len() && inside(k + 1);
        let drawn: Vec<f64> = (0..real.len()).map(|k| if seen(k) { imaginary[k] } else { f64::NAN }).collect();
        svg.trace(class, &trace(real, &drawn, x, y, 4_000));
    };
    let [real, imaginary] = circle(0.0, 1.0);
    draw(&mut svg, "staircase", [&real, &imaginary]);
    for locus in loci {
        let [real, imaginary] = circle(-1.0, locus.distance);
        draw(&mut svg, &format!("mark {}", locus.class), [&real, &imaginary]);
        draw(&mut svg, &format!("curve {}", locus.class), [&locus.real, &locus.imaginary]);
    }
    if let Some((px, py)) = x.place(-1.0).zip(y.place(0.0)) {
        svg.marker("point plain", 5, px, py, "-1");
    }
    axes.end(&mut svg);
    svg.finish("Response of the loop in the complex plane")
}
