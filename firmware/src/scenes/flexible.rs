//! A flexible rotor of three discs between two bearings, balanced in three planes at two speeds, below and above its
//! first critical.
//!
//! The shaft is 1.2 m long and 50 mm thick, its discs weigh 90 kg. Two displacement sensors look at the shaft beside
//! the bearings; they see its run-out too, which a slow roll shows. The first forward critical lies at 1293 r/min,
//! between the two speeds.

use driveline::balancing::Steadiness;
use driveline::configure::{HasVibration, Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning};
use driveline::machine::{Chain, Damping, Inertia, Speed, Stiffness, Torque};
use driveline::observer;
use driveline::settings::{Bases, PhasorSettings, Screening};

use crate::panel::trial_weights::{Goal, TrialWeights};
use crate::scene::balanced::Balanced;
use crate::scene::table::variants;

/// Motor, coupling, rotor.
pub struct Flexible;

impl Machine for Flexible {
    const CHAIN: Chain = Chain::motor(Inertia(0.4)).shaft(Stiffness(9.0e3), Damping(3.0)).rotor(Inertia(1.05));
    const RATING: Rating = Rating { torque: Torque(60.0), speed: Speed(180.0), torque_limit: Torque(150.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    /// 149 on a turn of the higher speed.
    const RATE_HZ: u32 = 4_000;
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 0.3 * Self::RATING.torque.0, within: 2.0, ..Self::RATING.disturbance() };
    /// Soft: a steady speed is what counts, and a stiff one would stir it with the encoder's counts.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.05, damping: 1.0, shaft_damping: 0.05 };
    const RAMP: f64 = Self::RATING.speed.0 / 3.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

impl HasVibration for Flexible {
    /// Eight blocks of four turns.
    const PHASORS: PhasorSettings = PhasorSettings {
        turns: 4,
        steadiness: Steadiness { floor: 2e-7, ..Steadiness::USUAL },
        ..PhasorSettings::DIRECT
    };
    /// Of displacement (m).
    const VIBRATION_LIMIT: f64 = 2.0e-4;
}

/// The two speeds (rad/s), 1062 and 1614 r/min.
pub const SPEEDS: [f64; 2] = [1062.0 * core::f64::consts::PI / 30.0, 1614.0 * core::f64::consts::PI / 30.0];

/// Speed of the slow roll (rad/s), 150 r/min.
pub const SLOW_ROLL: f64 = 5.0 * core::f64::consts::PI;

/// Good enough.
pub struct Quiet;

impl Goal for Quiet {
    /// A twentieth of the vibration as it is found (m).
    const GOOD: f32 = 2.0e-7;
}

/// Two masses; three planes at two speeds by trial weights.
pub type TwoMass<N> = Balanced<Flexible, N, observer::TwoMassObserver, TrialWeights<Quiet, 4, 3>>;

variants! {
    "two-mass": TwoMass for Flexible;
}
