//! A rig for a bench: a 200 W servo motor turns a disc over a thin steel rod. Its drive has all four parts.
//!
//! The motor is of the size that makers' lists give: 0.64 N m, 1.9 N m for a moment, 3000 r/min, 0.28 kg cm2. Its
//! encoder outputs have 2500 lines; half a coupling of 0.04 kg cm2 sits on its shaft. The rod is 5 mm thick and 150 mm
//! long; the disc, of steel, 100 mm wide and 10 mm thick. Its drive controls the current and takes the torque as a
//! voltage of +-10 V, here for +-1.27 N m: at that the rod is stressed by 52 MPa. Two velocity sensors stand on the
//! disc's bearings, and the disc has holes for weights in two planes. A crank on the disc's face stretches a spring,
//! whose torque swings once and twice a turn. A small balancing head on the disc's shaft can take the place of the
//! weights. All can be bought or turned; it is no machine that exists.

use driveline::balancing::{self, BalancingDesign, Steadiness};
use driveline::configure::{HasVibration, Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning, Tolerance};
use driveline::fluctuation::Interleaved;
use driveline::governor::{ActiveDamping, SpeedGovernor};
use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Section, ShearModulus, Speed, Torque, stepped};
use driveline::observer::TwoMassObserver;
use driveline::settings::{PhasorSettings, Screening};

use crate::panel::balancing_head::SelfBalanced;
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
    const RATING: Rating = Rating { torque: Torque(0.64), speed: Speed(314.0), torque_limit: Torque(1.27) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 10_000;
    /// The torque of a drive of that size is known to 2 % of rated in a tick. The spring swings the load all the time,
    /// as the cut of the surface grinder.
    const DISTURBANCE: Disturbance = Disturbance {
        torque_accuracy: 0.02 * Self::RATING.torque.0,
        load_torque_step: Self::RATING.torque.0,
        within: 0.2,
    };
    /// Its drive controls the current with 1 kHz, as servo drives of that size do.
    const TOLERANCE: Tolerance = Tolerance { lag: 1.0 / (core::f64::consts::TAU * 1_000.0), ..Tolerance::USUAL };
    /// Half as brisk as usual: the motor is so light that it jitters with the noise that the loop feeds it.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.2, ..SpeedLoopTuning::of(&Self::TWO_MASS) };
    const RAMP: f64 = Self::RATING.speed.0 / 3.0;
    /// Two thirds over the largest torque; 1/128 turn, more than that torque moves the motor before the observer has
    /// followed; two counts; 15 ms without an angle.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

impl HasVibration for TestRig {
    /// Eight blocks of twelve turns. Below a tenth of what is good enough, the vibration of a balanced disc may scatter
    /// by more than itself.
    const PHASORS: PhasorSettings = PhasorSettings {
        turns: 12,
        steadiness: Steadiness { floor: 0.1 * Quiet::GOOD, ..Steadiness::USUAL },
        ..PhasorSettings::DIRECT
    };
    /// Of velocity (m/s).
    const VIBRATION_LIMIT: f64 = 0.02;
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 10_000;

/// Speed that the button starts (rad/s).
pub const SPEED: f64 = 100.0;

/// Bins of the waveform, 20 ticks each at the button's speed.
///
/// A turn must have 160 ticks ([`Interleaved`]): the fluctuation is measured up to 3750 r/min.
pub const BINS: usize = 32;

/// Good enough.
pub struct Quiet;

impl Goal for Quiet {
    /// A velocity that goes with grade G 1 (m/s).
    const GOOD: f32 = 1.0e-3;
}

/// The largest correction of the head (kg m): grade G 16 of the disc's 0.62 kg at the button's speed.
pub const CAPACITY: f64 = 1.0e-4;

impl SelfBalanced for TestRig {
    const BALANCING: BalancingDesign = BalancingDesign {
        rotor: balancing::BalanceTolerance { grade: 2.5, mass: 1.0, speed: SPEED as f32 },
        capacity: [CAPACITY as f32],
        travel: 3.0,
        settle: 0.3,
        quiet: 0.0,
    };
}

/// What makes weights in the holes of readings; on a board it is beside the tick, as the head's task.
pub type Adviser = TrialWeights<Quiet, 2, 2>;

/// The drive with all four parts, on an axis.
pub type Whole<N> = OnAxis<TestRig, N, TwoMassObserver, SpeedGovernor<(), ActiveDamping>, Interleaved<BINS>>;

variants! {
    f32: "whole": Whole for TestRig;
}
