//! Test of a gain schedule: margins and tolerances at its points.

use super::Family;
use crate::design::{Error, LoopGears, LoopObserver, SemiImplicitStep, Spread, Tolerance};
use crate::machine::TwoMass;
use crate::math::sqrt;

/// Tests the speed loops at all points of a family's gain schedule.
///
/// The loop of a point must have the margins of [`Machine::ROBUSTNESS`](super::Machine::ROBUSTNESS) there. It must be
/// stable with every machine up to half way to the neighbouring points, by inertia of the load and stiffness in equal
/// ratios, within [`Machine::TOLERANCE`](super::Machine::TOLERANCE) of motor inertia, torque and delay. The margins
/// hold with the gears' losses too, which the observer knows. For a test on the host: it takes as long as a drive's own
/// at each point.
///
/// It gives the largest error of the semi-implicit step over a period of the resonance; above
/// [`StepChoice::THRESHOLD`](crate::design::StepChoice::THRESHOLD) the schedule needs `TwoMassObserver`.
///
/// # Errors
/// The indices of the first point that is refused, by both parameters, and what its speed loop lacks.
pub const fn test_schedule<M: Family<A, B>, const A: usize, const B: usize>() -> Result<f64, (usize, usize, Error)> {
    let gears = LoopGears { losses: M::CHAIN.losses(), friction: M::GEAR.friction(), behind: true };
    let mut largest = 0.0;
    each!(first, 0..A, {
        each!(second, 0..B, {
            let member = &M::MEMBERS[first][second];
            let tolerance = Tolerance {
                load_inertia: half_way::<M, A, B>(first, second, false),
                stiffness: half_way::<M, A, B>(first, second, true),
                ..M::TOLERANCE
            };
            let observer = LoopObserver::Placed(&M::OBSERVERS[first][second]);
            let speed_loop = &M::SPEED_LOOPS[first][second];
            let tested = match member.try_robust(observer, speed_loop, M::ACTUATOR, &tolerance, &M::ROBUSTNESS) {
                Ok(()) => gears.try_robust(member, observer, speed_loop, M::ACTUATOR, &M::ROBUSTNESS),
                tested => tested,
            };
            if let Err(error) = tested {
                return Err((first, second, error));
            }
            let step = SemiImplicitStep::new(member, M::PERIOD).fidelity.error_bound;
            if !(step <= largest) {
                largest = step;
            }
        });
    });
    Ok(largest)
}

/// Factors of load inertia or stiffness up to half way to the neighbours of a point.
const fn half_way<M: Family<A, B>, const A: usize, const B: usize>(
    first: usize,
    second: usize,
    stiffness: bool,
) -> Spread {
    let own = quantity(&M::MEMBERS[first][second], stiffness);
    let mut spread = Spread::NONE;
    each!(i, (first.saturating_sub(1)).., i < A && i <= first + 1, {
        each!(j, (second.saturating_sub(1)).., j < B && j <= second + 1, {
            let ratio = sqrt(quantity(&M::MEMBERS[i][j], stiffness) / own);
            if ratio < spread.min {
                spread.min = ratio;
            }
            if ratio > spread.max {
                spread.max = ratio;
            }
        });
    });
    spread
}

const fn quantity(member: &TwoMass, stiffness: bool) -> f64 {
    if stiffness { member.stiffness } else { member.load_inertia }
}
