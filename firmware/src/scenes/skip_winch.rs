//! A mine's skip winch with an emergency brake.
//!
//! A 250 kW motor at 600 r/min (4 kN m) lifts a skip of 5 t at 4.2 m/s behind a gear of 15 and a drum of 2 m. The rope
//! is 150 m long and 36 mm thick, with 58 MN of E A by ropemakers' tables. So the skip hangs on 0.39 MN/m and swings at
//! 1.4 Hz. The brake's disc sits on the motor's shaft, and holds twice the weight: it stops the descending skip with
//! 4.4 m/s2. The figures are of the size of a small shaft's winch, not those of one machine.
//!
//! When the supply fails the brake closes and the inverter is off; the drive's input is the brake's torque plus the
//! motor's, and it goes on estimating: the rope's force matters most then.
//!
//! Otherwise the inverter stays on through an emergency (stop category 1 of IEC 60204-1). A winch that stops faster
//! than its skip falls throws it into a slack rope, and the skip falls back into it. The emergency stop is run with two
//! governors, on an observer with a slack rope:
//!
//! - `slack` estimates with the observer of backlash, whose gap is the slack rope. It keeps the rope taut, takes it up
//!   at the approach speed, and damps the oscillation.
//! - `plain` estimates with the observer of backlash and governs by a plain speed loop.
//! - `semi-implicit` estimates with two masses, a rope that pushes, and governs by the speed loop with its damping.
//! - `rigid` estimates with one mass and governs by the speed loop with its damping.

use driveline::configure::{Machine, Rating};
use driveline::design::{
    BacklashTakeUpDesign, BacklashTakeUpTuning, BacklashTuning, Disturbance, Encoder, RigidDesign, SpeedLoopDesign,
    SpeedLoopTuning, Spread, Tolerance,
};
use driveline::governor::{SpeedGovernor, SymmetricLimit};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Gap, Inertia, LinearDamping, Mass, Ratio, Speed, Stiffness, Torque,
    TwoMass,
};
use driveline::observer::{self, BacklashObserver, GearedObserver};
use driveline::settings::{Bases, Gear, Screening};

use crate::scene::composed::{Governed, GovernedBy};
use crate::scene::table::variants;

/// The machine, from the motor with the brake's disc to the skip.
pub struct SkipWinch;

impl Machine for SkipWinch {
    const CHAIN: Chain = Chain::motor(Inertia(20.0))
        .shaft(Stiffness(6.0e5), Damping(60.0))
        .gear(Ratio(15.0), Efficiency(0.94))
        .rotor(Inertia(1500.0))
        .drum(Diameter(2.0))
        .damped_rope(Falls(1), Stiffness(3.9e5), LinearDamping(1.3e3))
        .lifted(Mass(5_000.0));
    const RATING: Rating = Rating { torque: Torque(4_000.0), speed: Speed(62.8), torque_limit: Torque(7_000.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 2_000;
    /// The skip's weight stays what it is on its way. The gear's loss is known to a few per cent alone, for seconds on
    /// end: the motor's motion says more of the rope than the torque does.
    const DISTURBANCE: Disturbance = Disturbance {
        torque_accuracy: 0.2 * Self::RATING.torque.0,
        load_torque_step: 0.005 * Self::RATING.torque.0,
        within: 100.0,
    };
    /// The observer that takes the rope for rigid has to follow the rope's vibration as if it were the load's doing.
    const RIGID_OBSERVER: RigidDesign = Self::CHAIN.rigid().observer(
        Self::RATE,
        Self::ENCODER,
        Disturbance { within: 1.0, ..Self::RATING.disturbance() },
    );
    const TUNING: SpeedLoopTuning = SpeedLoopTuning::USUAL;
    /// The observer that takes the rope for rigid needs three tenths of the rope's damping.
    const TOLERANCE: Tolerance = Tolerance { damping: Spread::between(0.3, 2.0), ..Tolerance::USUAL };
    const RAMP: f64 = Self::RATING.speed.0 / 4.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    /// In 40 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 25, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

/// Torque of the brake at the motor (N m): twice the weight's.
pub const BRAKE_TORQUE: f64 = 6_540.0;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8192;

/// The winch in an emergency, on a rope that can go slack: a shaft with a gap, pulled on one flank, and so far from the
/// other that it is never met.
pub struct SkipOnRope;

impl Machine for SkipOnRope {
    const CHAIN: Chain = SkipWinch::CHAIN;
    const RATING: Rating = SkipWinch::RATING;
    const ENCODER: Encoder = SkipWinch::ENCODER;
    const RATE_HZ: u32 = SkipWinch::RATE_HZ;
    const TWO_MASS: TwoMass = SkipWinch::TWO_MASS.with_gap(Gap(15.0));
    const GEAR: Gear = SkipWinch::GEAR;
    /// A brake's torque is known to 5 %. An observer that trusts it more lags behind the rope's swing, and the damping
    /// by its twist rate has less than 6 dB.
    const DISTURBANCE: Disturbance =
        Disturbance { torque_accuracy: 0.05 * Self::RATING.torque.0, within: 100.0, ..Self::RATING.disturbance() };
    /// Searching gains for the instant at which the rope tightens: the slack follows from the skip's flight, to 0.15
    /// rad within a period of the oscillation.
    const BACKLASH_TUNING: BacklashTuning = BacklashTuning { wander: 0.01, ..BacklashTuning::USUAL };
    /// The design's proportional and integral gains, without its damping.
    const SPEED_LOOP: SpeedLoopDesign = SpeedLoopDesign { damping: 0.0, ..SkipWinch::SPEED_LOOP };
    const TOLERANCE: Tolerance = SkipWinch::TOLERANCE;
    /// The setpoint of the emergency stop: from rated speed in an eighth of a second, which is more than motor and
    /// brake can.
    const RAMP: f64 = 8.0 * Self::RATING.speed.0;
    const BASES: Bases = SkipWinch::BASES;
    /// Motor and brake pull together.
    const SCREENING: Screening =
        Screening { torque: Self::RATING.torque_limit.0 + 1.05 * BRAKE_TORQUE, ..SkipWinch::SCREENING };
    /// While the rope is slack, rated torque holds the drum to the skip's speed, also against the brake. A tight rope's
    /// torque rises by as much within a period of the swing, which is damped as far as the observer's lag allows with 6
    /// dB.
    const TAKING_UP: BacklashTakeUpTuning = BacklashTakeUpTuning {
        impact: 0.2 * Self::RATING.torque.0,
        torque: Self::RATING.torque.0,
        rise: Self::RATING.torque.0,
        fall: f64::INFINITY,
        max_torque: Self::RATING.torque_limit.0,
        damping: 0.25,
    };
    const TAKE_UP: BacklashTakeUpDesign = SkipWinch::TWO_MASS.take_up(Self::RATE, Self::TAKING_UP);
}

/// One mass behind the gear.
pub type Rigid<N> = Governed<N, GearedObserver<observer::RigidObserver>>;
/// Two masses behind the gear, semi-implicit step: the design's choice.
pub type SemiImplicit<N> = Governed<N, GearedObserver<observer::SemiImplicitObserver>>;
/// A plain speed loop.
pub type Plain<N> = GovernedBy<N, GearedObserver<BacklashObserver>, SpeedGovernor>;
/// With take-up of the slack rope.
pub type Slack<N> = GovernedBy<
    N,
    GearedObserver<BacklashObserver>,
    SpeedGovernor<(), (), driveline::governor::BacklashTakeUp<SymmetricLimit>>,
>;

variants! {
    "rigid": Rigid for SkipWinch;
    "semi-implicit": SemiImplicit for SkipWinch;
    "plain": Plain for SkipOnRope;
    "slack": Slack for SkipOnRope;
}
