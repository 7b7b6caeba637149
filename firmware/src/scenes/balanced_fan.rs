//! A fan on its own bearings: 180 kg between two pedestals, driven through a coupling at 1480 r/min, balanced in two
//! planes with trial weights.
//!
//! Two velocity sensors stand on the pedestals. The masses are of the size that makers' lists give for a centrifugal
//! fan of 30 kW; they are not those of one machine.

use driveline::balancing::Steadiness;
use driveline::configure::{HasVibration, Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning};
use driveline::machine::{Chain, Damping, Inertia, Speed, Stiffness, Torque};
use driveline::observer;
use driveline::settings::{Bases, PhasorSettings, Screening};

use crate::panel::trial_weights::{Goal, TrialWeights};
use crate::scene::balanced::Balanced;
use crate::scene::table::variants;

/// Motor, coupling, fan.
pub struct BalancedFan;

impl Machine for BalancedFan {
    const CHAIN: Chain = Chain::motor(Inertia(1.3)).shaft(Stiffness(6.0e4), Damping(12.0)).rotor(Inertia(11.0));
    /// 1480 r/min.
    const RATING: Rating = Rating { torque: Torque(190.0), speed: Speed(155.0), torque_limit: Torque(700.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    /// 162 on a turn.
    const RATE_HZ: u32 = 4_000;
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 0.3 * Self::RATING.torque.0, within: 2.0, ..Self::RATING.disturbance() };
    /// Soft: the speed must be steady, and a stiff loop would disturb it by the encoder's counts. The fan outweighs
    /// the motor eight times: without damping by the twist rate the coupling's swing grows where the coupling is softer
    /// and the torque late.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.05, damping: 1.0, shaft_damping: 0.3 };
    const RAMP: f64 = Self::RATING.speed.0 / 4.0;
    /// That of the torque is four times the largest, for the gain on the twist rate.
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 4.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

impl HasVibration for BalancedFan {
    /// Eight blocks of twelve turns, 4 s: the vibration that is left after the correction is no more than the noise.
    const PHASORS: PhasorSettings = PhasorSettings {
        turns: 12,
        steadiness: Steadiness { floor: 2e-3, ..Steadiness::USUAL },
        ..PhasorSettings::DIRECT
    };
    /// Of velocity (m/s).
    const VIBRATION_LIMIT: f64 = 0.05;
}

/// Good enough.
pub struct Quiet;

impl Goal for Quiet {
    /// A velocity that goes with grade G 1 (m/s).
    const GOOD: f32 = 1.0e-4;
}

/// Two masses; two planes by trial weights.
pub type TwoMass<N> = Balanced<BalancedFan, N, observer::TwoMassObserver, TrialWeights<Quiet, 2, 2>>;

variants! {
    "two-mass": TwoMass for BalancedFan;
}
