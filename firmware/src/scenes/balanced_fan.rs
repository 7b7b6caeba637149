//! A fan on its own bearings: 180 kg between two pedestals, driven through a coupling at 1480 r/min, balanced in two
//! planes with trial
//! weights.
//!
//! Two velocity sensors stand on the pedestals. The masses are of the size that makers' lists give for a centrifugal
//! fan of 30 kW; they are not
//! those of one machine.

use core::marker::PhantomData;

use driveline::balancing::{PhasorsConfig, Steadiness};
use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::drive::{Config, Limits};
use driveline::governor::SpeedLoopConfig;
use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{self, TwoMassConfig};
use driveline::settings::{Bases, PhasorSettings, Screening, SpeedLoopSettings};

use crate::panel::trial_weights::{Goal, TrialWeights};
use crate::scene::balanced::{Constants, Variant};

/// Motor, coupling, fan.
pub const CHAIN: Chain = Chain::motor(Inertia(1.3)).shaft(Stiffness(6.0e4), Damping(12.0)).rotor(Inertia(11.0));

/// The machine as the controller sees it.
pub const TWO: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Ticks a second: 162 on a turn.
pub const RATE_HZ: u32 = 4_000;

/// Rated speed [rad/s], 1480 r/min.
pub const RATED_SPEED: f64 = 155.0;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 190.0;

/// Largest torque [N m].
pub const TORQUE_LIMIT: f64 = 700.0;

/// Largest velocity that the sensors read [m/s].
pub const VIBRATION_LIMIT: f64 = 0.05;

/// Velocity that a fixed-point one is [m/s].
pub const VIBRATION_BASE: f64 = 0.1;

/// Bases of fixed point.
pub const BASES: Bases = Bases::new(&TWO, 2.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

const RATE: Rate = Rate::hz(RATE_HZ);
const OBSERVER: TwoMassDesign = TWO.observer(
    RATE,
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.3 * RATED_TORQUE, within: 2.0 },
);
/// A soft loop: a steady speed is what counts, and a stiff one would stir it with the encoder's counts.
const GOVERNOR: SpeedLoopDesign =
    TWO.speed_loop(RATE, SpeedLoopTuning { bandwidth: 0.05, damping: 1.0, shaft_damping: 0.05 });
const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 4.0 };
const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / 8192.0,
    max_coast: RATE_HZ / 67,
};
/// Eight blocks of twelve turns, 4 s: the vibration that is left after the correction is no more than the noise.
const MEASURED: PhasorSettings =
    PhasorSettings { turns: 12, steadiness: Steadiness { floor: 2e-3, ..Steadiness::USUAL }, ..PhasorSettings::DIRECT };

/// Good enough.
pub struct Quiet;

impl Goal for Quiet {
    /// A velocity that goes with grade G 1 \[m/s\].
    const GOOD: f32 = 1.0e-4;
}

/// The fan with a number.
pub struct BalancedFan<N>(PhantomData<N>);

impl Variant for BalancedFan<f32> {
    type Number = f32;
    type Observer = observer::TwoMassObserver<f32>;
    type Adviser = TrialWeights<Quiet, 2, 2>;
    const NAME: &'static str = "balanced-fan/f32/two-mass/4000";
    const RATE_HZ: u32 = RATE_HZ;
    const UNIT: f32 = 1.0;
    const CONFIG: &'static Constants<f32, observer::TwoMassObserver<f32>> = &Config {
        limits: Limits::<f32>::new(&SCREENING, Bases::SI),
        observer: TwoMassConfig::<f32>::new(&OBSERVER, Bases::SI),
        fluctuation: (),
        governor: SpeedLoopConfig::<f32>::new(&GOVERNOR, SETTINGS, Bases::SI),
        balancer: PhasorsConfig::<f32, 2>::new(&MEASURED, [VIBRATION_LIMIT; 2]),
    };
}

impl Variant for BalancedFan<Fixed> {
    type Number = Fixed;
    type Observer = observer::TwoMassObserver<Fixed>;
    type Adviser = TrialWeights<Quiet, 2, 2>;
    const NAME: &'static str = "balanced-fan/fixed/two-mass/4000";
    const RATE_HZ: u32 = RATE_HZ;
    const UNIT: f32 = VIBRATION_BASE as f32;
    const CONFIG: &'static Constants<Fixed, observer::TwoMassObserver<Fixed>> = &Config {
        limits: Limits::<Fixed>::new(&SCREENING, BASES),
        observer: TwoMassConfig::<Fixed>::new(&OBSERVER, BASES),
        fluctuation: (),
        governor: SpeedLoopConfig::<Fixed>::new(&GOVERNOR, SETTINGS, BASES),
        balancer: PhasorsConfig::<Fixed, 2>::new(&MEASURED, [VIBRATION_LIMIT / VIBRATION_BASE; 2]),
    };
}
