//! A fan: motor, coupling, impeller. The smallest drive: one mass.
//!
//! A 45 kW, four-pole motor at 1480 r/min has 290 N m, and 0.3 to 0.4 kg m2 by makers' tables for frame size 225. The
//! coupling has 0.12 MN m/rad, as catalogues have it for that torque; the impeller is that of a radial fan of 0.9 m.
//! The setpoint takes 10 s to rated speed.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning};
use driveline::machine::{Chain, Damping, Inertia, Speed, Stiffness, Torque};
use driveline::observer;
use driveline::settings::{Bases, Screening};

use crate::scene::composed::Governed;
use crate::scene::table::variants;

/// Motor, coupling, impeller.
pub struct Fan;

impl Machine for Fan {
    const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(1.2e5), Damping(8.0)).rotor(Inertia(4.5));
    const RATING: Rating = Rating { torque: Torque(290.0), speed: Speed(155.0), torque_limit: Torque(435.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    /// A fan needs no more.
    const RATE_HZ: u32 = 1_000;
    /// The impeller's, which the coupling accelerates.
    const LOAD_SHARE: f64 = 4.5 / Self::CHAIN.rigid().inertia;
    /// The load follows the speed, which takes seconds.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 0.2 * Self::RATING.torque.0, ..Self::RATING.disturbance() };
    /// A slow speed loop, a hundredth of the antiresonance.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.01, damping: 1.0, shaft_damping: 0.02 };
    const RAMP: f64 = Self::RATING.speed.0 / 10.0;
    const BASES: Bases = Bases::rigid(2.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    /// In 15 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 4096;

/// One mass.
pub type Rigid<N> = Governed<N, observer::RigidObserver>;

variants! {
    "rigid": Rigid for Fan;
}
