//! A grinding spindle with a balancing head: 25 kg at 3000 r/min, balanced while it turns.
//!
//! The head moves two masses round the axis, so that their sum is any correction up to its capacity. Two acceleration
//! sensors stand on the bearing
//! housings. Nothing is known of the spindle at first, neither its unbalance nor what a correction does to it.

use core::marker::PhantomData;

use driveline::balancing::{InRunConfig, PhasorsConfig, Steadiness};
use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::drive::{Config, Limits};
use driveline::governor::SpeedLoopConfig;
use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{self, TwoMassConfig};
use driveline::settings::{Bases, PhasorSettings, Screening, SpeedLoopSettings};

use crate::panel::balancing_head::{Head, HeadPanel};
use crate::scene::balanced::{Constants, Variant};

/// Motor, belt, spindle.
pub const CHAIN: Chain = Chain::motor(Inertia(0.02)).shaft(Stiffness(1.5e3), Damping(0.2)).rotor(Inertia(0.18));

/// The machine as the controller sees it.
pub const TWO: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Ticks a second: 80 on a turn.
pub const RATE_HZ: u32 = 4_000;

/// Rated speed [rad/s], 3000 r/min.
pub const RATED_SPEED: f64 = 100.0 * core::f64::consts::PI;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 20.0;

/// Largest torque [N m].
pub const TORQUE_LIMIT: f64 = 80.0;

/// Largest acceleration that the sensors read [m/s2].
pub const VIBRATION_LIMIT: f64 = 20.0;

/// Acceleration that a fixed-point one is [m/s2].
pub const VIBRATION_BASE: f64 = 40.0;

/// The largest correction of the head [kg m].
pub const CAPACITY: f64 = 1.5e-3;

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
const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 1.0 };
const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / 8192.0,
    max_coast: RATE_HZ / 67,
};
/// Eight blocks of six turns, 1 s.
const MEASURED: PhasorSettings = PhasorSettings {
    turns: 8,
    steadiness: Steadiness { drift: 0.1, scatter: 0.3, floor: 0.4, ..Steadiness::USUAL },
    ..PhasorSettings::DIRECT
};

/// The balancing head.
pub struct TheHead;

impl Head for TheHead {
    /// The first step is a fiftieth of the capacity: an unbalance worth balancing is five times that, and so never
    /// grows by
    /// a fifth.
    const CONFIG: InRunConfig<f32, 1> = InRunConfig {
        probe: CAPACITY as f32 / 50.0,
        limits: [CAPACITY as f32],
        step: 2.0 * CAPACITY as f32,
        bound: 1.3,
        target: 0.01,
        forgetting: 0.7,
        noise: 0.005,
    };
}

/// The spindle with a number.
pub struct GrindingSpindle<N>(PhantomData<N>);

impl Variant for GrindingSpindle<f32> {
    type Number = f32;
    type Observer = observer::TwoMassObserver<f32>;
    type Adviser = HeadPanel<TheHead>;
    const NAME: &'static str = "grinding-spindle/f32/two-mass/4000";
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

impl Variant for GrindingSpindle<Fixed> {
    type Number = Fixed;
    type Observer = observer::TwoMassObserver<Fixed>;
    type Adviser = HeadPanel<TheHead>;
    const NAME: &'static str = "grinding-spindle/fixed/two-mass/4000";
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
