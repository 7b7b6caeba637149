//! The composed governor: its design, its parts, its modes and trips; the generator sets that it governs.

mod barred;
mod design;
mod law;
mod modes;
mod natural_damping;
mod plain;
mod sharing;
mod torque_curve;
mod watch;

use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

use self::plain::plain;

/// Two masses of a generator set.
const SET: TwoMass = TwoMass::new(Inertia(4.4), Inertia(8.0), Stiffness(5.0e4), Damping(66.0));
