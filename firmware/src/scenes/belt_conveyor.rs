//! A belt conveyor of 400 m with a soft start.
//!
//! A 75 kW, four-pole motor has 485 N m, and 1.6 kg m2 with its coupling and brake disc. It turns a drum of 0.8 m
//! behind a gear of 20 and moves the belt at 3.1 m/s. Belt, load and idlers of 60 t hang on the carrying strand, whose
//! elasticity from the drum to the load's middle is 0.6 MN/m. The figures are of the size that makers give for a
//! steel-cord conveyor of that length, not those of one machine. The gear's loss is part of the resistance to motion.
//!
//! A belt must not be jerked: the strand swings at 0.5 Hz, and a slack strand leaves the drum. So the setpoint reaches
//! rated speed in 12 s, and the speed loop damps the swing.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, RigidDesign};
use driveline::machine::{Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Ratio, Stiffness};
use driveline::observer::{RigidObserver, SemiImplicitObserver};

use crate::scene::composed::Governed;
use crate::scene::table::variants;

/// Motor, gear, drum, belt.
pub struct BeltConveyor;

impl Machine for BeltConveyor {
    const CHAIN: Chain = Chain::motor(Inertia(1.6))
        .shaft(Stiffness(8.0e4), Damping(20.0))
        .rotor(Inertia(0.2))
        .gear(Ratio(20.0), Efficiency(1.0))
        .drum(Diameter(0.8))
        .damped_rope(Falls(1), Stiffness(6.0e5), LinearDamping(4.0e3))
        .driven(Mass(60_000.0));
    const RATING: Rating = Rating { torque: 485.0, speed: 155.0, torque_limit: 730.0 };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 1_000;
    /// The resistance to motion hardly changes while the belt runs.
    const DISTURBANCE: Disturbance = Disturbance { within: 100.0, ..Self::RATING.disturbance() };
    /// The observer that takes the belt for rigid must follow the belt's swing as a change of the load torque, or the
    /// speed loop would excite the swing.
    const RIGID_OBSERVER: RigidDesign =
        Self::CHAIN.rigid().observer(Self::RATE, Self::ENCODER, Disturbance { within: 1.0, ..Self::DISTURBANCE });
    /// The soft start.
    const RAMP: f64 = Self::RATING.speed / 12.0;
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8_192;

/// One mass: the belt taken for rigid.
pub type Rigid<N> = Governed<N, RigidObserver<N>>;
/// Two masses, semi-implicit step: the design's choice.
pub type SemiImplicit<N> = Governed<N, SemiImplicitObserver<N>>;

variants! {
    "rigid": Rigid for BeltConveyor;
    "semi-implicit": SemiImplicit for BeltConveyor;
}
