//! Error against cost: a point for each part, the front of those that nothing beats marked and named.

use super::front;
use super::label::Labels;
use crate::svg::{Axes, Scale, Svg};

/// A point of the plot.
#[derive(Clone, Debug)]
pub struct Dot {
    pub cost: f64,
    pub error: f64,
    /// Its group, whose points beat one another: a colour.
    pub group: usize,
    /// Marker.
    pub shape: usize,
    pub name: String,
}

/// Which dots are on the front of their group.
pub fn fronts(dots: &[Dot]) -> Vec<bool> {
    let mut on = vec![false; dots.len()];
    for group in dots.iter().map(|dot| dot.group) {
        let own: Vec<usize> = (0..dots.len()).filter(|&at| dots[at].group == group).collect();
        let points: Vec<(f64, f64)> = own.iter().map(|&at| (dots[at].cost, dots[at].error)).collect();
        front(&points).into_iter().for_each(|at| on[own[at]] = true);
    }
    on
}

/// The dots on two logarithmic axes, of a size; those on a front are named where there is room.
pub fn scatter(dots: &[Dot], axes: [&str; 2], [width, height]: [f64; 2], title: &str) -> String {
    let frame = [58.0, 26.0, width - 12.0, height - 44.0];
    let x = Scale::logarithmic(dots.iter().map(|dot| dot.cost), frame[0], frame[2]);
    let y = Scale::logarithmic(dots.iter().map(|dot| dot.error), frame[3], frame[1]);
    let mut svg = Svg::new(width, height);
    svg.text("name", frame[0], 15.0, crate::svg::Anchor::Start, title);
    Axes { x, y, frame }.draw(&mut svg, axes, [4.0, 4.0]);
    svg.line("edge", frame[0], frame[3], frame[2], frame[3]);
    svg.line("edge", frame[0], frame[1], frame[0], frame[3]);
    let (on, mut labels) = (fronts(dots), Labels::default());
    let place = |dot: &Dot| x.place(dot.cost).zip(y.place(dot.error));
    for (dot, on) in dots.iter().zip(&on) {
        let Some((px, py)) = place(dot) else { continue };
        labels.point(px, py);
        let class = format!("point {} s{}", if *on { "on" } else { "off" }, dot.group);
        svg.marker(&class, dot.shape, px, py, &dot.name);
    }
    for (dot, _) in dots.iter().zip(&on).filter(|(_, on)| **on) {
        let at = place(dot).and_then(|at| labels.place(&dot.name, 10.0, at, frame));
        if let Some((px, py, anchor)) = at {
            svg.text("number", px, py, anchor, &dot.name);
        }
    }
    svg.finish(title)
}
