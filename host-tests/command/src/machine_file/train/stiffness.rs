//! Whether a train is too stiff for a run of its length.

use driveline_solver::plant::Place;
use driveline_solver::plant::train::Motion;

/// Product of the fastest rate of a train and the length of its run, at most: a minute's work for the second
/// integrator, whose roundings gather beyond it.
const STIFFEST: f64 = 1e6;

/// Where a train is too stiff for a run of so many seconds: the place, what was found and what was expected.
pub(crate) fn too_stiff(motion: &Motion, time: f64) -> Option<(Place, String, String)> {
    if time == 0.0 {
        return None;
    }
    let over = motion.rate() * time / STIFFEST;
    if over <= 1.0 {
        return None;
    }
    let short = format!("a run of at most {:.1e} s", time / over);
    match motion.stiffest().filter(|part| 2.0 * part.rate >= motion.rate()) {
        Some(part) => {
            let (parameter, value, inertia) = (part.parameter, part.value, part.inertia);
            let share = if parameter == "stiffness" { over * over } else { over };
            Some((
                part.odd,
                format!("a {parameter} of {value:.1e} on an inertia of {inertia:.1e}, a rate of {:.1e} 1/s", part.rate),
                format!(
                    "a {parameter} of at most {:.1e}, an inertia of at least {:.1e}, or {short}",
                    value / share,
                    inertia * share
                ),
            ))
        }
        None => Some((Place::Node(0), format!("a train whose parts move at up to {:.1e} 1/s", motion.rate()), short)),
    }
}
