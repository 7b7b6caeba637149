//! Damage by the tick's rainflow count against the four-point rule on the torque itself, without classes.

use driveline::fatigue::{Rainflow, TorqueClasses, WoehlerLine};
use driveline::fluctuation::Fluctuation;
use driveline::sample::Estimate;
use driveline_solver::noise::Noise;

/// Miner's elementary rule with a slope of 5.
const LINE: WoehlerLine = WoehlerLine { knee: 100.0, cycles: 2e6, slope: 5.0, below: 5.0 };

/// Error of the damage of a drawn torque, relative: a swing that rings down after each of 200 jumps of the load. Its
/// peaks lie within the classes' limit of 200 N m.
pub(super) fn error<const CLASSES: usize>(noise: &mut Noise) -> f64 {
    let config = TorqueClasses::<f32>::new::<CLASSES>(200.0);
    let mut count = Rainflow::<CLASSES>::default();
    let decay = 0.02 + 0.1 * (1.0 + noise.uniform());
    let (mut points, mut level) = (vec![0.0], 0.0);
    for _ in 0..200 {
        let to = 60.0 * noise.uniform();
        let jump: f64 = level - to;
        level = to;
        for tick in 1..=120 {
            let angle = f64::from(tick) * 0.35;
            let torque = level + jump * (-decay * angle).exp() * angle.cos();
            let estimate = Estimate { shaft_torque: torque as f32, ..Estimate::default() };
            count.measure(&config, 0, 0.0, &estimate);
            reversal(&mut points, torque);
        }
    }
    let counts = count.counts(&config);
    // beyond the classes the damage is too small
    if counts.exceeds_classes() { f64::NAN } else { (counts.damage(&LINE) / by_rule(points) - 1.0).abs() }
}

/// Adds a torque to the series of reversals.
fn reversal(points: &mut Vec<f64>, torque: f64) {
    if let [.., before, last] = points[..]
        && (last - before) * (torque - last) >= 0.0
    {
        points.pop();
    }
    points.push(torque);
}

/// The damage: closed cycles, and each range of the residue as half a cycle.
fn by_rule(points: Vec<f64>) -> f64 {
    let of = |range: f64| LINE.damage(0.5 * range.abs());
    let (mut left, mut damage) = (Vec::new(), 0.0);
    for point in points {
        left.push(point);
        while let [.., a, b, c, d] = left[..]
            && (c - b).abs() <= (b - a).abs()
            && (c - b).abs() <= (d - c).abs()
        {
            damage += of(c - b);
            left.drain(left.len() - 3..left.len() - 1);
        }
    }
    damage + left.windows(2).map(|pair| 0.5 * of(pair[1] - pair[0])).sum::<f64>()
}
