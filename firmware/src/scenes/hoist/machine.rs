//! The hoist's machine, and its family over load and rope.

use driveline::configure::{HasLoadAndRope, Machine, Rating};
use driveline::design::{
    Disturbance, Encoder, SpeedLoopDesign, SpeedLoopTuning, Spread, StepChoice, Tolerance, TwoMassDesign,
};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, Length, LinearDamping, Mass, Match, Ratio, Speed, Stiffness,
    Torque, TwoMass,
};
use driveline::settings::{Bases, Gear, Screening};

/// The machine, from the motor to the hook, at a tick rate. Two masses stand for it with the chain's first resonance
/// and antiresonance.
///
/// Held by the gearbox's friction at the largest load, about 80 N m, the motor turns by 1.6 mrad on its own shaft, two
/// counts of the encoder: the play is eight.
pub struct Hoist<const RATE_HZ: u32>;

/// Travel of the load per angle of the motor (m/rad): half the drum's diameter, two falls, the gear.
pub const TRAVEL: f64 = 0.8 / 2.0 / 2.0 / 31.5;

/// From an empty hook to a tenth over the largest load.
impl<const RATE_HZ: u32> HasLoadAndRope<5, 4> for Hoist<RATE_HZ> {
    const LOADS: [f64; 5] = [13_000.0, 6_000.0, 2_700.0, 1_200.0, 500.0];
    const ROPES: [f64; 4] = [30.0, 17.0, 9.0, 5.0];
    /// Within 6 dB and 30 degrees at each point, so that a swing decays 1.3 times as fast as under a plain loop: the
    /// least for the heaviest load on the longest rope.
    const SWING_DAMPING: [[f64; 4]; 5] = [
        [0.26, 0.29, 0.35, 0.39],
        [0.29, 0.35, 0.45, 0.59],
        [0.35, 0.45, 0.59, 0.65],
        [0.45, 0.59, 0.65, 0.65],
        [0.65, 0.65, 0.65, 0.65],
    ];
}

impl<const RATE_HZ: u32> Machine for Hoist<RATE_HZ> {
    const CHAIN: Chain = Chain::motor(Inertia(0.62))
        .shaft(Stiffness(5.0e4), Damping(2.0))
        .rotor(Inertia(0.08))
        .gear(Ratio(31.5), Efficiency(0.94))
        .drum(Diameter(0.8))
        .damped_rope(Falls(2), Stiffness(2.9e6), LinearDamping(3.6e3))
        .lengths(Length(5.0), Length(12.0), Length(30.0))
        .lifted(Mass(12_000.0))
        .loads(Mass(500.0), Mass(13_000.0));
    /// 1480 r/min.
    const RATING: Rating = Rating { torque: Torque(750.0), speed: Speed(155.0), torque_limit: Torque(1_350.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = RATE_HZ;
    const DISTURBANCE: Disturbance = Self::RATING.hoisting(Self::RATE);
    /// At 1 kHz `Reduced` overrules the design, which chooses the exact step there, to show the cost.
    const OBSERVER: TwoMassDesign =
        Self::TWO_MASS.observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE).with_step(StepChoice::SemiImplicit);
    const TUNING: SpeedLoopTuning = SpeedLoopTuning::USUAL;
    /// An empty hook of 0.5 t to 13 t, on 30 m to 5 m of rope where the chain has 12 m.
    const TOLERANCE: Tolerance = Tolerance {
        load_inertia: Spread::between(0.5 / 12.0, 13.0 / 12.0),
        stiffness: Spread::between(12.0 / 30.0, 12.0 / 5.0),
        torque: Spread::within(0.03),
        // At a tenth a point between light loads on a short rope would be unstable in a corner.
        damping: Spread::between(0.2, 2.0),
        ..Tolerance::USUAL
    };
    const RAMP: f64 = Self::RATING.speed.0 / 2.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    /// In 15 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

/// The hoist for an observer that cuts it by the textbook: everything before the rope, everything behind it, the rope
/// between.
pub struct CutAtRope<const RATE_HZ: u32>;

impl<const RATE_HZ: u32> Machine for CutAtRope<RATE_HZ> {
    const CHAIN: Chain = Hoist::<RATE_HZ>::CHAIN;
    const RATING: Rating = Hoist::<RATE_HZ>::RATING;
    const ENCODER: Encoder = Hoist::<RATE_HZ>::ENCODER;
    const RATE_HZ: u32 = RATE_HZ;
    const TWO_MASS: TwoMass = Self::CHAIN.reduce(Match::TextbookShaft(1));
    const GEAR: Gear = Hoist::<RATE_HZ>::GEAR;
    const DISTURBANCE: Disturbance = Hoist::<RATE_HZ>::DISTURBANCE;
    const SPEED_LOOP: SpeedLoopDesign = Hoist::<RATE_HZ>::SPEED_LOOP;
    const TOLERANCE: Tolerance = Hoist::<RATE_HZ>::TOLERANCE;
    const RAMP: f64 = Hoist::<RATE_HZ>::RAMP;
    const BASES: Bases = Hoist::<RATE_HZ>::BASES;
    const SCREENING: Screening = Hoist::<RATE_HZ>::SCREENING;
}
