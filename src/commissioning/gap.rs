//! The gap: how far the motor creeps from one flank to the other while friction holds the load.

use super::identified::Figure;
use super::{Reason, TestConfig};
use crate::scalar::sqrt;

/// Pushes against the flanks, by turns; the first only finds a flank.
pub(crate) const PUSHES: usize = 9;

/// Share of the friction that a push may take: it must hold the load.
pub(crate) const PUSH: f64 = 0.5;

/// What was crept from flank to flank, the twists of the shaft under the push included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Crept {
    /// Mean way and its deviation \[rad\].
    pub way: Figure,
    /// Mean torque of the pushes \[N m\].
    pub torque: f64,
}

/// The mean way between pushes; refuses where they did not repeat.
pub(crate) fn crept(pushes: &[(f64, f64); PUSHES], widest: f64, config: &TestConfig) -> Result<Crept, Reason> {
    let (mut sum, mut square, mut count, mut torque) = (0.0, 0.0, 0.0, 0.0);
    let ways = pushes.iter().zip(pushes.iter().skip(1)).skip(1);
    for (&(from, _), &(to, pushed)) in ways {
        let way = (to - from).abs();
        torque += pushed.abs();
        if way >= 0.95 * widest {
            return Err(Reason::LoadNotHeld);
        }
        sum += way;
        square += way * way;
        count += 1.0;
    }
    let mean = sum / count;
    let variance = ((square - count * mean * mean) / (count - 1.0)).max(0.0);
    // Both ends are rounded to a count, and stand: sqrt(2/12) of one, however often.
    let least = 0.41 * config.resolution;
    let deviation = sqrt(variance / count).max(least);
    // Drift: the load crept along.
    let drift = match (pushes.get(1), pushes.last()) {
        (Some((first, _)), Some((last, _))) => ((last - first).abs() - mean).abs(),
        _ => 0.0,
    };
    if drift > (0.2 * mean).max(3.0 * config.resolution) {
        return Err(Reason::GapUnclear);
    }
    Ok(Crept { way: Figure { value: mean, standard_deviation: deviation }, torque: torque / count })
}

/// The gap itself, once the stiffness \[N m/rad\] is known.
pub(crate) fn gap(crept: &Crept, stiffness: f64, config: &TestConfig) -> Result<Figure, Reason> {
    let value = crept.way.value - 2.0 * crept.torque / stiffness;
    let deviation = crept.way.standard_deviation;
    // Ends that are rounded alike each time are off by up to a count.
    if value > 3.0 * deviation + config.resolution {
        Ok(Figure { value, standard_deviation: deviation })
    } else {
        Err(Reason::GapBelowResolution)
    }
}
