//! Ways to carry an observer through the gap, on the host in `f64`: what the library's own is compared with.
//!
//! All share the design's gains and noise; what differs is what they do about the gap.

mod constant;
mod live;
mod luenberger;
mod model;
mod several;

pub use constant::{Constant, Gap};
pub use live::Live;
pub use several::Several;

use super::case::Case;
use super::score::{Estimator, Library, Rigid};
use driveline::number::Fixed;

/// Time in which the load of one mass wanders as far as the case has it (s).
const WITHIN: f64 = 0.2;
/// Radius of Luenberger's poles over the resonance: the best of 0.5 to 4 by steps of half an octave.
const RADIUS: f64 = 2.0;

/// A way to deal with the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Approach {
    /// One mass, its load lively: it follows the shaft's torque as if it were the load's.
    Rigid,
    /// One shaft that is always in contact, its poles placed.
    Luenberger,
    /// One shaft that is always in contact.
    Ignore,
    /// The same with a gap position that is estimated as a random walk on top of the twist.
    Additive,
    /// The gap's law in the prediction; in the gap only the motor is corrected.
    Switch,
    /// The gap's law in the prediction; in the gap only the motor is corrected, and a run of innovations to one side is
    /// taken for the impact.
    Resynchronise,
    /// The gap's law in the prediction, the gains of contact throughout.
    Keep,
    /// A Kalman filter with a running covariance, linear about its most probable regime.
    Live,
    /// The same, with the mean of both regimes' laws over the twist's uncertainty.
    LiveMean,
    /// Three Kalman filters (left, free, right) weighed by their innovations and mixed in every tick.
    Three,
    /// The library's: gains by the time since contact, in `f64`.
    Library,
    /// The same in `f32`.
    LibrarySingle,
    /// The same in fixed point.
    LibraryFixed,
}

impl Approach {
    /// All of them, in the order of the table.
    pub const ALL: [Approach; 13] = [
        Approach::Rigid,
        Approach::Luenberger,
        Approach::Ignore,
        Approach::Additive,
        Approach::Switch,
        Approach::Resynchronise,
        Approach::Keep,
        Approach::Live,
        Approach::LiveMean,
        Approach::Three,
        Approach::Library,
        Approach::LibrarySingle,
        Approach::LibraryFixed,
    ];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Approach::Rigid => "one mass, its load within 0.2 s",
            Approach::Luenberger => "Luenberger, gap ignored",
            Approach::Ignore => "gap ignored",
            Approach::Additive => "gap ignored, its position estimated on top",
            Approach::Switch => "gain switched with the regime",
            Approach::Resynchronise => "gain switched, resynchronised at the impact",
            Approach::Keep => "gain of contact kept through the gap",
            Approach::Live => "live covariance",
            Approach::LiveMean => "live covariance, mean law",
            Approach::Three => "three hypotheses weighed by innovations",
            Approach::Library => "gains by time since contact, f64",
            Approach::LibrarySingle => "gains by time since contact, f32",
            Approach::LibraryFixed => "gains by time since contact, fixed",
        }
    }

    /// An estimator for a machine, at rest.
    pub fn estimator(self, case: &Case) -> Box<dyn Estimator> {
        match self {
            Approach::Rigid => Box::new(Rigid::new(case, WITHIN)),
            Approach::Luenberger => match Constant::luenberger(case, RADIUS) {
                Some(observer) => Box::new(observer),
                None => Approach::Ignore.estimator(case),
            },
            Approach::Ignore => Box::new(Constant::new(case, Gap::Ignored)),
            Approach::Additive => Box::new(Constant::new(case, Gap::Additive)),
            Approach::Switch => Box::new(Constant::new(case, Gap::Switched)),
            Approach::Resynchronise => Box::new(Constant::new(case, Gap::Resynchronised)),
            Approach::Keep => Box::new(Constant::new(case, Gap::Kept)),
            Approach::Live => Box::new(Live::new(case, 0.0)),
            Approach::LiveMean => Box::new(Live::new(case, 2.0)),
            Approach::Three => Box::new(Several::new(case)),
            Approach::Library => Box::new(Library::double(case)),
            Approach::LibrarySingle => Box::new(Library::<f32>::single(case)),
            Approach::LibraryFixed => Box::new(Library::<Fixed>::fixed(case)),
        }
    }
}
