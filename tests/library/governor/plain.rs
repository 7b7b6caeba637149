//! A plain configuration of a governor, for the tests of the tick as well.

use driveline::governor::{Gains, SpeedGovernorConfig};
use driveline::number::Number;

/// A governor without a run sequence and without a filter of the speed.
pub fn plain<N: Number, S, F, L>(
    gains: Gains<N>,
    shape: S,
    compensation: F,
    limit: L,
) -> SpeedGovernorConfig<N, S, F, L, (), ()> {
    SpeedGovernorConfig { gains, shape, compensation, limit, sequence: (), filter: () }
}
