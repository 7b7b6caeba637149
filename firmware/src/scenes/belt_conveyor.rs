//! A belt conveyor of 400 m with a soft start.
//!
//! A 75 kW, four-pole motor has 485 N m, and 1.6 kg m2 with its coupling and brake disc. It turns a drum of 0.8 m
//! behind a gear of 20 and moves the belt at 3.1 m/s. Belt, load and idlers of 60 t hang on the carrying strand, whose
//! elasticity from the drum to the load's middle is 0.6 MN/m. The figures are of the size that makers give for a
//! steel-cord conveyor of that length, not those of one machine. The gear's loss is part of the resistance to motion.
//!
//! A belt must not be jerked: the strand swings at 0.5 Hz, and a slack strand leaves the drum. So the setpoint reaches
//! rated speed in 12 s, and the speed loop damps the swing.
//!
//! | variant | starts by |
//! |---|---|
//! | `semi-implicit`, `rigid` | a slow ramp of the setpoint, with two masses or one |
//! | `eased` | its torque limit, which a torque slew approaches; it stops by its resistance to motion |

use driveline::configure::{HasSlew, Machine, Rating};
use driveline::design::{Disturbance, Encoder, RigidDesign, SpeedLoopDesign};
use driveline::governor::{Slew, SpeedGovernor, TorqueRange};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Ratio, Speed, Stiffness, Torque,
};
use driveline::observer::{RigidObserver, SemiImplicitObserver};

use crate::scene::composed::{Governed, GovernedBy};
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
    const RATING: Rating = Rating { torque: Torque(485.0), speed: Speed(155.0), torque_limit: Torque(730.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 1_000;
    /// The resistance to motion hardly changes while the belt runs.
    const DISTURBANCE: Disturbance = Disturbance { within: 100.0, ..Self::RATING.disturbance() };
    /// The observer that takes the belt for rigid must follow the belt's swing as a change of the load torque, or the
    /// speed loop would excite the swing.
    const RIGID_OBSERVER: RigidDesign =
        Self::CHAIN.rigid().observer(Self::RATE, Self::ENCODER, Disturbance { within: 1.0, ..Self::DISTURBANCE });
    /// The soft start.
    const RAMP: f64 = Self::RATING.speed.0 / 12.0;
}

/// The same conveyor, whose start the torque shapes: the setpoint is there within an eighth of a second, and the motor
/// gives its largest torque until the belt is up to speed. It does not brake.
pub struct TorqueStart;

impl Machine for TorqueStart {
    const CHAIN: Chain = BeltConveyor::CHAIN;
    const RATING: Rating = BeltConveyor::RATING;
    const ENCODER: Encoder = BeltConveyor::ENCODER;
    const RATE_HZ: u32 = BeltConveyor::RATE_HZ;
    const DISTURBANCE: Disturbance = BeltConveyor::DISTURBANCE;
    /// The design's proportional and integral gains, without its damping.
    const SPEED_LOOP: SpeedLoopDesign = SpeedLoopDesign { damping: 0.0, ..BeltConveyor::SPEED_LOOP };
    const RAMP: f64 = 8.0 * Self::RATING.speed.0;
}

/// Dynamic factor of the strand that the start is allowed.
pub const ALLOWED: f64 = 1.2;

impl HasSlew for TorqueStart {
    const SLEW: f64 = Self::TWO_MASS.slew_for_factor(Torque(Self::RATING.torque_limit.0), ALLOWED);
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8_192;

/// One mass: the belt taken for rigid.
pub type Rigid<N> = Governed<N, RigidObserver>;
/// Two masses, semi-implicit step: the design's choice.
pub type SemiImplicit<N> = Governed<N, SemiImplicitObserver>;
/// The torque limit, approached by the slew.
pub type Eased<N> = GovernedBy<N, SemiImplicitObserver, SpeedGovernor<(), (), Slew<TorqueRange>>>;
/// The torque limit at once; for comparison, in no image.
pub type AtOnce<N> = GovernedBy<N, SemiImplicitObserver, SpeedGovernor<(), (), TorqueRange>>;

variants! {
    "rigid": Rigid for BeltConveyor;
    "semi-implicit": SemiImplicit for BeltConveyor;
    "eased": Eased for TorqueStart;
}
