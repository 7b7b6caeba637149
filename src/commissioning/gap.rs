//! The gap: how far the motor creeps from one flank to the other while friction holds the load.

use super::figure::Figure;
use super::{Error, TestConfig};
use crate::math::sqrt;

/// Pushes against the flanks, by turns; the first only finds a flank.
pub(crate) const PUSHES: usize = 9;

/// Share of the friction that a push may take: it must hold the load.
pub(crate) const PUSH: f64 = 0.5;

/// Share of a push to which it is eased for its second reading.
pub(crate) const EASED: f64 = 1.0 / 3.0;

/// Where the motor stood against a flank (rad): under the whole push, and under the eased one.
pub(crate) type Push = (f64, f64);

/// The gap: the ways from flank to flank under both torques, carried on to none, since the twist of the shafts grows
/// with the torque.
///
/// The stiffness of the two masses would not do: it is that of the swing, and a machine of more masses is softer at
/// rest.
///
/// # Errors
/// Where friction did not hold the load, where the ways did not repeat, and where the gap is less than three deviations
/// and a count.
pub(crate) fn gap(pushes: &[Push; PUSHES], widest: f64, config: &TestConfig) -> Result<Figure, Error> {
    let (mut sum, mut square, mut way, mut count) = (0.0, 0.0, 0.0, 0.0);
    for (from, to) in pushes.iter().zip(pushes.iter().skip(1)).skip(1) {
        let (whole, eased) = ((to.0 - from.0).abs(), (to.1 - from.1).abs());
        if whole >= 0.95 * widest {
            return Err(Error::LoadNotHeld);
        }
        let free = (eased - EASED * whole) / (1.0 - EASED);
        sum += free;
        square += free * free;
        way += whole;
        count += 1.0;
    }
    let (mean, way) = (sum / count, way / count);
    let variance = ((square - count * mean * mean) / (count - 1.0)).max(0.0);
    // Each end is rounded to a count, alike however often: sqrt(1/12) of one, over both ends and both torques.
    let least = config.resolution * sqrt((1.0 + EASED * EASED) / 6.0) / (1.0 - EASED);
    let deviation = sqrt(variance / count).max(least);
    // Drift: the load crept along.
    let drift = match (pushes.get(1), pushes.last()) {
        (Some(first), Some(last)) => ((last.0 - first.0).abs() - way).abs(),
        _ => 0.0,
    };
    if drift > (0.2 * way).max(3.0 * config.resolution) {
        return Err(Error::GapUnclear);
    }
    if mean > 3.0 * deviation + config.resolution {
        Ok(Figure { value: mean, standard_deviation: deviation })
    } else {
        Err(Error::GapBelowResolution)
    }
}
