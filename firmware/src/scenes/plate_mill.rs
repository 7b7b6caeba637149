//! A plate mill's stand whose upper and lower roll have spindles of their own: a branched train.
//!
//! A motor of 6 MW at 150 r/min has 382 kN m and 3e4 kg m2. A coupling of 4 GN m/rad leads to the pinion stand
//! (3e3 kg m2), and from its two pinions a spindle to either work roll. The upper spindle is the longer one, with
//! 110 MN m/rad, the lower one has 140 MN m/rad; the rolls have 1.52e4 and 1.44e4 kg m2 with their backup rolls. The
//! figures are of the size of such a mill, not those of one machine.
//!
//! The observer's two masses are those of the train: total inertia, resonance and antiresonance of its main mode. The
//! rolls' swing against each other is the first mode, but hardly reaches the motor, and is not in the observer: its
//! shaft torque is the sum of both spindles', and how they divide it cannot be found from the motor's angle.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, RigidDesign, SpeedLoopTuning};
use driveline::machine::{Chain, Damping, Inertia, Match, Ratio, Speed, Stiffness, Torque, Train, TwoMass};
use driveline::observer::TwoMassObserver;
use driveline::settings::{Bases, Screening};

use crate::scene::composed::Governed;
use crate::scene::table::variants;

/// Inertia of a pinion's half of the stand that the branch adds (kg m2).
const PINION: Inertia = Inertia(500.0);

/// The upper spindle and its roll, on a pinion.
const UPPER: Chain = Chain::motor(PINION).shaft(Stiffness(1.1e8), Damping(2.8e4)).rotor(Inertia(1.52e4));

/// The lower spindle and its roll, on a pinion.
const LOWER: Chain = Chain::motor(PINION).shaft(Stiffness(1.4e8), Damping(3.6e4)).rotor(Inertia(1.44e4));

/// Motor, pinion stand, the upper and the lower spindle with their rolls.
pub const TRAIN: Train = Train::of(PlateMill::CHAIN).branch(1, Ratio(1.0), UPPER).branch(1, Ratio(1.0), LOWER);

/// The mill.
pub struct PlateMill;

impl Machine for PlateMill {
    /// Motor and pinion stand; the spindles are branches on it.
    const CHAIN: Chain = Chain::motor(Inertia(3.0e4)).shaft(Stiffness(4.0e9), Damping(4.0e5)).rotor(Inertia(2.0e3));
    const RATING: Rating = Rating { torque: Torque(3.82e5), speed: Speed(15.7), torque_limit: Torque(1.75 * 3.82e5) };
    const ENCODER: Encoder = Encoder::lines(8192);
    const RATE_HZ: u32 = 5_000;
    const TWO_MASS: TwoMass = TRAIN.reduce(Match::ResonanceAntiresonance);
    /// The load wanders by half of rated torque in 1 s: a plate fills the bite within tens of milliseconds.
    const DISTURBANCE: Disturbance = Disturbance { within: 1.0, ..Self::RATING.disturbance() };
    const RIGID_OBSERVER: RigidDesign = TRAIN.rigid().observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE);
    /// A tenth of the antiresonance.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.1 };
    const RAMP: f64 = Self::RATING.ramp(TRAIN.total_inertia());
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 4.0 * Self::RATING.torque_limit.0, 2.0 * Self::RATING.speed.0);
    const SCREENING: Screening = Self::RATING.screening(Self::ENCODER, Self::RATE);
}

/// Two masses, exact step.
pub type Exact<N> = Governed<N, TwoMassObserver>;

variants! {
    "exact": Exact for PlateMill;
}
