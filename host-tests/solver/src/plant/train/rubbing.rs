//! Dry friction in a mechanism that is driven forwards: a torque by the angle of its crank.

use std::f64::consts::TAU;

use super::linkage::Orders;
use super::source::Source;

/// Share of the steepest slope below which a way stands still.
const DWELL: f64 = 1e-9;

/// Dry friction (N or N m) along a way by the angle of a coordinate that turns forwards: of a slider on its guide, of a
/// rocker in its pivot. A torque `-F |y'(phi)|`, from dead centre to dead centre.
#[must_use]
pub fn rubbing(way: &Orders, friction: f64) -> Vec<Source> {
    const COUNT: i32 = 4096;
    let slope = way.slope();
    let angle = |i: i32| TAU * f64::from(i) / f64::from(COUNT);
    let steepest = (0..COUNT).map(|i| slope.at(angle(i)).abs()).fold(0.0, f64::max);
    let sign = |i: i32| Some(slope.at(angle(i))).filter(|slope| slope.abs() > DWELL * steepest).map(f64::signum);
    let moving: Vec<(i32, f64)> = (0..COUNT).filter_map(|i| Some((i, sign(i)?))).collect();
    let centre = |(from, to): (f64, f64), before: f64| {
        let halves = (0..60).fold((from, to), |(low, high), _| {
            let middle = 0.5 * (low + high);
            if slope.at(middle) * before > 0.0 { (middle, high) } else { (low, middle) }
        });
        halves.1
    };
    // the last place is before the first one of the next turn
    let first = moving.first().map(|&(i, sign)| (i + COUNT, sign));
    let next = moving.iter().copied().skip(1).chain(first);
    let turns = moving.iter().zip(next).filter(|(one, other)| one.1 != other.1);
    let centres: Vec<(f64, f64)> = turns
        .map(|(&(at, before), (after, sign))| (centre((angle(at), angle(after)), before).rem_euclid(TAU), sign))
        .collect();
    let ends = centres.iter().skip(1).chain(centres.first());
    let strokes = centres.iter().zip(ends).map(|(&(from, sign), &(end, _))| Source::Stroke {
        torque: slope.times(-friction * sign),
        from,
        to: if end > from { end } else { end + TAU },
        turns: 1,
    });
    strokes.collect()
}
