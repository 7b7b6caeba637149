//! A rig for a bench: a 200 W servo motor turns a disc over a thin steel rod.
//!
//! The motor is of the size that makers' lists give (0.64 N m, 3000 r/min, 1.9 N m for a moment, 0.28 kg cm2, encoder
//! outputs of 2500 lines), on it half a coupling of 0.04 kg cm2. The rod is 5 mm thick and 150 mm long; the disc, of
//! steel, 100 mm wide and 10 mm thick. Its drive controls the current and takes the torque as a voltage of +-10 V, here
//! for +-1.27 N m: at that the rod is stressed by 52 MPa. Two velocity sensors stand on the disc's bearings, and the
//! disc has holes for weights in two planes. All can be bought or turned; it is no machine that exists.

use driveline::configure::{HasVibration, Machine, Rating};
use driveline::design::{Disturbance, Encoder, Tolerance};
use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Section, ShearModulus, stepped};
use driveline::observer;
use driveline::settings::{PhasorSettings, Screening};

use crate::panel::trial_weights::{Goal, TrialWeights};
use crate::scene::on_axis::OnAxis;
use crate::scene::table::variants;

/// The rod.
pub const ROD: [Section; 1] = [Section::solid(Length(0.150), Diameter(0.005))];

/// Motor and half coupling, rod, disc. The damping is a hundredth of critical.
pub struct TestRig;

impl Machine for TestRig {
    const CHAIN: Chain =
        Chain::motor(Inertia(3.2e-5)).shaft(stepped(&ROD, ShearModulus::STEEL), Damping(6.0e-4)).rotor(Inertia(7.7e-4));
    /// 3000 r/min; 10 V are the largest torque that is commanded.
    const RATING: Rating = Rating { torque: 0.64, speed: 314.0, torque_limit: 1.27 };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 10_000;
    /// The torque of a drive of that size is known to 2 % of rated in a tick.
    const DISTURBANCE: Disturbance = Disturbance {
        torque_accuracy: 0.02 * Self::RATING.torque,
        load_torque_step: 0.3 * Self::RATING.torque,
        within: 1.0,
    };
    /// Its drive controls the current with 1 kHz, as servo drives of that size do.
    const TOLERANCE: Tolerance = Tolerance { lag: 1.0 / (core::f64::consts::TAU * 1_000.0), ..Tolerance::USUAL };
    const RAMP: f64 = Self::RATING.speed / 3.0;
    /// Two thirds over the largest torque; 1/128 turn, more than that torque moves the motor before the observer has
    /// followed; two counts; 15 ms without an angle.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

impl HasVibration for TestRig {
    /// Eight blocks of twelve turns.
    const PHASORS: PhasorSettings = PhasorSettings { turns: 12, ..PhasorSettings::DIRECT };
    /// Of velocity [m/s].
    const VIBRATION_LIMIT: f64 = 0.02;
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 10_000;

/// Speed that the button starts [rad/s].
pub const SPEED: f64 = 100.0;

/// Good enough.
pub struct Quiet;

impl Goal for Quiet {
    /// A velocity that goes with grade G 1 \[m/s\].
    const GOOD: f32 = 1.0e-3;
}

/// What makes weights of readings; on a board it is beside the tick.
pub type Adviser = TrialWeights<Quiet, 2, 2>;

/// Two masses, on an axis.
pub type TwoMass<N> = OnAxis<TestRig, N, observer::TwoMassObserver<N>>;

variants! {
    f32: "two-mass": TwoMass for TestRig;
}
