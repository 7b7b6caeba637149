//! What in-run balancing asks of a head, and how far it may go.

use core::fmt;

use super::{Complex, Scalar};

/// How far a machine may be moved while it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InRunConfig<T, const PLANES: usize> {
    /// A weight in any plane that changes the vibration by less than `bound - 1` of it.
    pub probe: T,
    /// The largest weight that each plane's head can set.
    pub limits: [T; PLANES],
    /// The largest change of a weight in one move.
    pub step: T,
    /// The multiple of where it began that the vibration must not exceed, above 1.
    pub bound: T,
    /// The share of where it began that is good enough, below 1.
    pub target: T,
    /// Forgetting factor per move, 0 to 1.
    pub forgetting: T,
    /// Standard deviation of a reading as a share of the initial vibration, unless the reading's own variance is
    /// larger. What the readings change by themselves is added as it is seen.
    pub noise: T,
}

/// The next action on the weights.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub enum Action<T: Scalar, const PLANES: usize> {
    /// Set these weights, wait for a steady reading and give it. The same weights again ask for another reading.
    Set([Complex<T>; PLANES]),
    /// Within the target, or nothing left to gain: leave the weights.
    Hold,
    /// Abort: set these weights, the best so far, and look for the cause.
    Abort([Complex<T>; PLANES], AbortReason),
}

/// Why in-run balancing was aborted.
///
/// ```
/// use driveline::balancing::{AbortReason, Action, Complex, InRun, InRunConfig};
/// const CONFIG: InRunConfig<f64, 1> =
///     InRunConfig { probe: 0.01, limits: [1.0], step: 2.0, bound: 1.3, target: 0.04, forgetting: 0.8, noise: 0.005 };
/// let rest = Complex::new(0.0, 0.0);
/// let mut rule = InRun::<f64, 1, 1>::new(CONFIG, 1, [rest])?;
/// // a sensor that has come off
/// let action = rule.advise(&[Complex::new(f64::NAN, 0.0)], 0.0);
/// assert_eq!(action, Action::Abort([rest], AbortReason::NoReading));
/// assert_eq!(AbortReason::NoReading.to_string(), "a reading is missing or not a number");
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AbortReason {
    /// The vibration rose above its bound.
    Diverging,
    /// Eight moves brought nothing.
    Stalled,
    /// A reading is missing or not a number.
    NoReading,
    /// The weights change the readings by no more than these change by themselves.
    Unidentified,
}

impl fmt::Display for AbortReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AbortReason::Diverging => "the vibration rose above its bound",
            AbortReason::Stalled => "eight moves brought nothing",
            AbortReason::NoReading => "a reading is missing or not a number",
            AbortReason::Unidentified => "the weights change the readings by no more than these change by themselves",
        })
    }
}
