//! A grinding spindle with a balancing head: 25 kg at 3000 r/min, balanced while it turns.
//!
//! The head moves two masses round the axis, so that their sum is any correction up to its capacity. Two acceleration
//! sensors stand on the bearing housings. Nothing is known of the spindle at first, neither its unbalance nor what a
//! correction does to it.

use driveline::balancing::{BalancingDesign, Tolerance};
use driveline::configure::{HasVibration, Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning};
use driveline::machine::{Chain, Damping, Inertia, Speed, Stiffness, Torque};
use driveline::observer;
use driveline::settings::{Bases, Screening};

use crate::panel::balancing_head::{HeadPanel, SelfBalanced};
use crate::scene::balanced::BalancedDrive;
use crate::scene::composed::Composed;
use crate::scene::table::variants;

/// Motor, belt, spindle.
pub struct GrindingSpindle;

impl Machine for GrindingSpindle {
    const CHAIN: Chain = Chain::motor(Inertia(0.02)).shaft(Stiffness(1.5e3), Damping(0.2)).rotor(Inertia(0.18));
    /// 3000 r/min.
    const RATING: Rating =
        Rating { torque: Torque(20.0), speed: Speed(100.0 * core::f64::consts::PI), torque_limit: Torque(80.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    /// 80 on a turn.
    const RATE_HZ: u32 = 4_000;
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 0.3 * Self::RATING.torque.0, within: 2.0, ..Self::RATING.disturbance() };
    /// Soft: a steady speed is what counts, and a stiff one would stir it with the encoder's counts.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.05, damping: 1.0, shaft_damping: 0.15 };
    const RAMP: f64 = Self::RATING.speed.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

impl HasVibration for GrindingSpindle {
    /// Of acceleration (m/s2).
    const VIBRATION_LIMIT: f64 = 20.0;
}

/// The largest correction of the head (kg m).
pub const CAPACITY: f64 = 1.5e-3;

impl SelfBalanced for GrindingSpindle {
    const BALANCING: BalancingDesign = BalancingDesign {
        rotor: Tolerance { grade: 2.5, mass: 25.0, speed: Self::RATING.speed.0 as f32 },
        capacity: [CAPACITY as f32],
        travel: 3.0,
        settle: 0.3,
        quiet: 0.0,
    };
}

/// Two masses; balanced while it turns.
pub type TwoMass<N> = Composed<BalancedDrive<N, observer::TwoMassObserver>, HeadPanel<GrindingSpindle>>;

variants! {
    "two-mass": TwoMass for GrindingSpindle;
}
