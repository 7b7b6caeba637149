//! The composed governor: its design, its parts, its modes and trips; the generator sets that it governs.

mod barred;
mod design;
mod law;
mod modes;
mod natural_damping;
mod sharing;
mod torque_curve;
mod watch;

use driveline::governor::{Gains, SpeedGovernorConfig};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use driveline::number::Number;

/// Two masses of a generator set.
const SET: TwoMass = TwoMass::new(Inertia(4.4), Inertia(8.0), Stiffness(5.0e4), Damping(66.0));

/// A governor without a run sequence and without a filter of the speed.
fn plain<N: Number, S, F, L>(
    gains: Gains<N>,
    shape: S,
    compensation: F,
    limit: L,
) -> SpeedGovernorConfig<N, S, F, L, (), ()> {
    SpeedGovernorConfig { gains, shape, compensation, limit, sequence: (), filter: () }
}
