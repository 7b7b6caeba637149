//! A flexible rotor of three discs between two bearings, balanced in three planes at two speeds, below and above its
//! first critical.
//!
//! The shaft is 1.2 m long and 50 mm thick, its discs weigh 90 kg. Two displacement sensors look at the shaft beside
//! the bearings; they see its
//! run-out too, which a slow roll shows. The first forward critical lies at 1293 r/min, between the two speeds.

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

/// Motor, coupling, rotor.
pub const CHAIN: Chain = Chain::motor(Inertia(0.4)).shaft(Stiffness(9.0e3), Damping(3.0)).rotor(Inertia(1.05));

/// The machine as the controller sees it.
pub const TWO: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Ticks a second: 149 on a turn of the higher speed.
pub const RATE_HZ: u32 = 4_000;

/// The two speeds [rad/s], 1062 and 1614 r/min.
pub const SPEEDS: [f64; 2] = [1062.0 * core::f64::consts::PI / 30.0, 1614.0 * core::f64::consts::PI / 30.0];

/// Speed of the slow roll [rad/s], 150 r/min.
pub const SLOW_ROLL: f64 = 5.0 * core::f64::consts::PI;

/// Rated speed [rad/s].
pub const RATED_SPEED: f64 = 180.0;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 60.0;

/// Largest torque [N m].
pub const TORQUE_LIMIT: f64 = 150.0;

/// Largest displacement that the sensors read [m].
pub const VIBRATION_LIMIT: f64 = 2.0e-4;

/// Displacement that a fixed-point one is [m].
pub const VIBRATION_BASE: f64 = 4.0e-4;

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
const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 3.0 };
const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / 8192.0,
    max_coast: RATE_HZ / 67,
};
/// Eight blocks of four turns.
const MEASURED: PhasorSettings =
    PhasorSettings { turns: 4, steadiness: Steadiness { floor: 2e-7, ..Steadiness::USUAL }, ..PhasorSettings::DIRECT };

/// Good enough.
pub struct Quiet;

impl Goal for Quiet {
    /// A twentieth of the vibration as it is found \[m\].
    const GOOD: f32 = 2.0e-7;
}

/// The rotor with a number.
pub struct Flexible<N>(PhantomData<N>);

impl Variant for Flexible<f32> {
    type Number = f32;
    type Observer = observer::TwoMassObserver<f32>;
    type Adviser = TrialWeights<Quiet, 4, 3>;
    const NAME: &'static str = "flexible/f32/two-mass/4000";
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

impl Variant for Flexible<Fixed> {
    type Number = Fixed;
    type Observer = observer::TwoMassObserver<Fixed>;
    type Adviser = TrialWeights<Quiet, 4, 3>;
    const NAME: &'static str = "flexible/fixed/two-mass/4000";
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
