//! A rig for a bench: a 200 W servo motor turns a disc over a thin steel rod.
//!
//! The motor is of the size that makers' lists give (0.64 N m, 3000 r/min, 1.9 N m for a moment, 0.28 kg cm2, encoder outputs of 2500 lines), on it half a
//! coupling of 0.04 kg cm2. The rod is 5 mm thick and 150 mm long; the disc, of steel, 100 mm wide and 10 mm thick. Its drive controls the current and
//! takes the torque as a voltage of +-10 V, here for +-1.27 N m: at that the rod is stressed by 52 MPa. Two
//! velocity sensors stand on the disc's bearings, and the disc has holes for weights in two planes. All can be bought or turned; it is no machine that exists.

use driveline::balancing::PhasorsConfig;
use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::drive::{Config, Limits};
use driveline::governor::SpeedLoopConfig;
use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Match, Section, ShearModulus, TwoMass, stepped};
use driveline::observer::{self, TwoMassConfig};
use driveline::settings::{Bases, PhasorSettings, Screening, SpeedLoopSettings};

use crate::panel::trial_weights::{Goal, TrialWeights};
use crate::scene::balanced::{Constants, Variant};

/// The rod.
pub const ROD: [Section; 1] = [Section::solid(Length(0.150), Diameter(0.005))];

/// Motor and half coupling, rod, disc. The damping is a hundredth of critical.
pub const CHAIN: Chain =
    Chain::motor(Inertia(3.2e-5)).shaft(stepped(&ROD, ShearModulus::STEEL), Damping(6.0e-4)).rotor(Inertia(7.7e-4));

/// The machine as the controller sees it.
pub const TWO: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 10_000;

/// Speed that the button starts [rad/s].
pub const SPEED: f64 = 100.0;

/// Rated speed [rad/s], 3000 r/min.
pub const RATED_SPEED: f64 = 314.0;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 0.64;

/// Torque at 10 V, and the largest that is commanded [N m].
pub const TORQUE_LIMIT: f64 = 1.27;

/// Largest velocity that the sensors read [m/s].
pub const VIBRATION_LIMIT: f64 = 0.02;

const RATE: Rate = Rate::hz(RATE_HZ);

/// The observer. A drive of that size knows its torque to 2 % of rated in a tick.
pub const OBSERVER: TwoMassDesign = TWO.observer(
    RATE,
    Encoder::lines(COUNTS / 4),
    Disturbance { torque_accuracy: 0.02 * RATED_TORQUE, load_torque_step: 0.3 * RATED_TORQUE, within: 1.0 },
);

/// The speed loop.
pub const LOOP: SpeedLoopDesign = TWO.speed_loop(RATE, SpeedLoopTuning::USUAL);
/// Rated speed in three seconds.
const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 3.0 };
/// Two thirds over the largest torque; 1/128 turn, which that torque does not move the motor before the observer has followed; two counts; 15 ms without
/// an angle.
const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 67,
};
/// Eight blocks of twelve turns.
const MEASURED: PhasorSettings = PhasorSettings { turns: 12, ..PhasorSettings::DIRECT };

/// Good enough.
pub struct Quiet;

impl Goal for Quiet {
    /// A velocity that goes with grade G 1 \[m/s\].
    const GOOD: f32 = 1.0e-3;
}

/// The rig.
pub struct TestRig;

impl Variant for TestRig {
    type Number = f32;
    type Observer = observer::TwoMassObserver<f32>;
    type Adviser = TrialWeights<Quiet, 2, 2>;
    const NAME: &'static str = "test-rig/f32/two-mass/10000";
    const RATE_HZ: u32 = RATE_HZ;
    const UNIT: f32 = 1.0;
    const CONFIG: &'static Constants<f32, observer::TwoMassObserver<f32>> = &Config {
        limits: Limits::<f32>::new(&SCREENING, Bases::SI),
        observer: TwoMassConfig::<f32>::new(&OBSERVER, Bases::SI),
        fluctuation: (),
        governor: SpeedLoopConfig::<f32>::new(&LOOP, SETTINGS, Bases::SI),
        balancer: PhasorsConfig::<f32, 2>::new(&MEASURED, [VIBRATION_LIMIT; 2]),
    };
}
