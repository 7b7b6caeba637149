//! A bridge crane's hoist: 12 t on two falls of rope.
//!
//! A 116 kW, four-pole motor at 1480 r/min drives a 0.8 m drum through a gearbox of 31.5 and lifts 12 t at 0.97 m/s. On the motor's shaft
//! sits the drum of the holding brake. The figures are of the size that makers' tables give for such a hoist (frame size 315
//! motor, 0.6 kg m2; 13 m of two-fall 20 mm rope, about 0.9 MN/m at the load); they are not those of one machine.

use driveline::constants::{Bases, Screening, SpeedLoopSettings};
use driveline::design::{
    Disturbance, Encoder, Rate, RigidDesign, SpeedLoopDesign, SpeedLoopTuning, StepChoice, TwoMassDesign,
};
use driveline::drive::{Config, Limits};
use driveline::governor::SpeedLoopConfig;
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Match, Ratio, Stiffness, TwoMass,
};
use driveline::number::Fixed;
use driveline::observer::{self, RigidConfig, SemiImplicitConfig, TwoMassConfig};

use crate::governed::{Governed, Variant};

/// The machine, from the motor to the hook.
pub const CHAIN: Chain = Chain::motor(Inertia(0.62))
    .shaft(Stiffness(5.0e4), Damping(2.0))
    .rotor(Inertia(0.08))
    .gear(Ratio(31.5), Efficiency(0.94))
    .drum(Diameter(0.8))
    .damped_rope(Falls(2), Stiffness(9.0e5), LinearDamping(2.0e3))
    .lifted(Mass(12_000.0));

/// Rated speed of the motor [rad/s], 1480 r/min.
pub const RATED_SPEED: f64 = 155.0;

/// Rated torque of the motor [N m].
pub const RATED_TORQUE: f64 = 750.0;

/// Largest torque of the motor [N m].
pub const TORQUE_LIMIT: f64 = 1_350.0;

/// Two masses with the chain's first resonance and antiresonance.
pub const REDUCED: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Two masses by the textbook: everything before the rope, everything behind it, the rope between.
pub const CUT: TwoMass = CHAIN.reduce(Match::TextbookShaft(1));

/// The encoder.
pub const ENCODER: Encoder = Encoder::lines(2048);

/// How the observer is tuned: the drive knows its torque to 1 % of rated in a tick, and the load may change by half a load in
/// half a second.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 300.0, within: 0.5 };

/// Bases of fixed point: twice the largest torque in the shaft as in the motor, a third over rated speed.
pub const BASES: Bases = Bases::new(&REDUCED, 2.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Limits of what a sample can be: two thirds over the largest torque; 1/128 turn, which that torque does not move the motor before
/// the observer has followed; two counts; 20 ms.
const fn screening(rate_hz: u32) -> Screening {
    Screening {
        torque: 1.67 * TORQUE_LIMIT,
        reference: 1.2 * RATED_SPEED,
        innovation: core::f64::consts::TAU / 128.0,
        standstill: 2.0 * core::f64::consts::TAU / 8192.0,
        missed: (rate_hz / 50) as u16,
    }
}

/// The governor reaches rated speed in two seconds.
const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 2.0 };

const fn speed_loop(rate_hz: u32) -> SpeedLoopDesign {
    REDUCED.speed_loop(Rate::hz(rate_hz), SpeedLoopTuning::USUAL)
}

/// The observer of two masses at a rate.
pub const fn observer(machine: &TwoMass, rate_hz: u32) -> TwoMassDesign {
    machine.observer(Rate::hz(rate_hz), ENCODER, DISTURBANCE)
}

/// The rigid observer at a rate.
pub const fn rigid(rate_hz: u32) -> RigidDesign {
    CHAIN.rigid().observer(Rate::hz(rate_hz), ENCODER, DISTURBANCE)
}

/// The load's share of the inertia.
const LOAD_SHARE: f64 = REDUCED.load_inertia / (REDUCED.motor_inertia + REDUCED.load_inertia);

macro_rules! config {
    (f32, $rate:expr, $observer:expr) => {
        &Config {
            limits: Limits::<f32>::new(&screening($rate)),
            observer: $observer,
            fluctuation: (),
            governor: SpeedLoopConfig::<f32>::new(&speed_loop($rate), SETTINGS),
            balancer: (),
        }
    };
    (Fixed, $rate:expr, $observer:expr) => {
        &Config {
            limits: Limits::<Fixed>::new(&screening($rate), BASES),
            observer: $observer,
            fluctuation: (),
            governor: SpeedLoopConfig::<Fixed>::new(&speed_loop($rate), SETTINGS, BASES),
            balancer: (),
        }
    };
}

macro_rules! variant {
    ($(#[$doc:meta])* $name:ident, $text:literal, $number:ident, $observer:ident, $rate:literal, $config:expr) => {
        $(#[$doc])*
        pub type $name = Governed<marker::$name>;

        impl Variant for marker::$name {
            type Number = $number;
            type Observer = observer::$observer<$number>;
            const NAME: &'static str = $text;
            const RATE_HZ: u32 = $rate;
            const CONFIG: &'static driveline::drive::ConfigOf<
                $number,
                observer::$observer<$number>,
                (),
                driveline::governor::SpeedLoop<$number>,
            > = config!($number, $rate, $config);
        }
    };
}
variant!(
    /// Rigid, f32, 1000 Hz.
    RigidSingle1000, "hoist/f32/rigid/1000", f32, Rigid, 1000,
    RigidConfig::<f32>::new(&rigid(1000), LOAD_SHARE)
);
variant!(
    /// Textbook cut, f32, 1000 Hz.
    CutSingle1000, "hoist/f32/cut/1000", f32, TwoMass, 1000,
    TwoMassConfig::<f32>::new(&observer(&CUT, 1000))
);
variant!(
    /// Reduced, exact step, f32, 1000 Hz.
    ExactSingle1000, "hoist/f32/exact/1000", f32, TwoMass, 1000,
    TwoMassConfig::<f32>::new(&observer(&REDUCED, 1000))
);
variant!(
    /// Reduced, semi-implicit step, f32, 1000 Hz.
    ReducedSingle1000, "hoist/f32/reduced/1000", f32, SemiImplicit, 1000,
    SemiImplicitConfig::<f32>::new(&observer(&REDUCED, 1000))
);
variant!(
    /// Rigid, fixed, 1000 Hz.
    RigidFixed1000, "hoist/fixed/rigid/1000", Fixed, Rigid, 1000,
    RigidConfig::<Fixed>::new(&rigid(1000), LOAD_SHARE, BASES)
);
variant!(
    /// Textbook cut, fixed, 1000 Hz.
    CutFixed1000, "hoist/fixed/cut/1000", Fixed, TwoMass, 1000,
    TwoMassConfig::<Fixed>::new(&observer(&CUT, 1000), BASES)
);
variant!(
    /// Reduced, exact step, fixed, 1000 Hz.
    ExactFixed1000, "hoist/fixed/exact/1000", Fixed, TwoMass, 1000,
    TwoMassConfig::<Fixed>::new(&observer(&REDUCED, 1000), BASES)
);
variant!(
    /// Reduced, semi-implicit step, fixed, 1000 Hz.
    ReducedFixed1000, "hoist/fixed/reduced/1000", Fixed, SemiImplicit, 1000,
    SemiImplicitConfig::<Fixed>::new(&observer(&REDUCED, 1000), BASES)
);
variant!(
    /// Rigid, f32, 4000 Hz.
    RigidSingle4000, "hoist/f32/rigid/4000", f32, Rigid, 4000,
    RigidConfig::<f32>::new(&rigid(4000), LOAD_SHARE)
);
variant!(
    /// Textbook cut, f32, 4000 Hz.
    CutSingle4000, "hoist/f32/cut/4000", f32, TwoMass, 4000,
    TwoMassConfig::<f32>::new(&observer(&CUT, 4000))
);
variant!(
    /// Reduced, exact step, f32, 4000 Hz.
    ExactSingle4000, "hoist/f32/exact/4000", f32, TwoMass, 4000,
    TwoMassConfig::<f32>::new(&observer(&REDUCED, 4000))
);
variant!(
    /// Reduced, semi-implicit step, f32, 4000 Hz.
    ReducedSingle4000, "hoist/f32/reduced/4000", f32, SemiImplicit, 4000,
    SemiImplicitConfig::<f32>::new(&observer(&REDUCED, 4000))
);
variant!(
    /// Rigid, fixed, 4000 Hz.
    RigidFixed4000, "hoist/fixed/rigid/4000", Fixed, Rigid, 4000,
    RigidConfig::<Fixed>::new(&rigid(4000), LOAD_SHARE, BASES)
);
variant!(
    /// Textbook cut, fixed, 4000 Hz.
    CutFixed4000, "hoist/fixed/cut/4000", Fixed, TwoMass, 4000,
    TwoMassConfig::<Fixed>::new(&observer(&CUT, 4000), BASES)
);
variant!(
    /// Reduced, exact step, fixed, 4000 Hz.
    ExactFixed4000, "hoist/fixed/exact/4000", Fixed, TwoMass, 4000,
    TwoMassConfig::<Fixed>::new(&observer(&REDUCED, 4000), BASES)
);
variant!(
    /// Reduced, semi-implicit step, fixed, 4000 Hz.
    ReducedFixed4000, "hoist/fixed/reduced/4000", Fixed, SemiImplicit, 4000,
    SemiImplicitConfig::<Fixed>::new(&observer(&REDUCED, 4000), BASES)
);
variant!(
    /// Rigid, f32, 10000 Hz.
    RigidSingle10000, "hoist/f32/rigid/10000", f32, Rigid, 10000,
    RigidConfig::<f32>::new(&rigid(10000), LOAD_SHARE)
);
variant!(
    /// Textbook cut, f32, 10000 Hz.
    CutSingle10000, "hoist/f32/cut/10000", f32, TwoMass, 10000,
    TwoMassConfig::<f32>::new(&observer(&CUT, 10000))
);
variant!(
    /// Reduced, exact step, f32, 10000 Hz.
    ExactSingle10000, "hoist/f32/exact/10000", f32, TwoMass, 10000,
    TwoMassConfig::<f32>::new(&observer(&REDUCED, 10000))
);
variant!(
    /// Reduced, semi-implicit step, f32, 10000 Hz.
    ReducedSingle10000, "hoist/f32/reduced/10000", f32, SemiImplicit, 10000,
    SemiImplicitConfig::<f32>::new(&observer(&REDUCED, 10000))
);
variant!(
    /// Rigid, fixed, 10000 Hz.
    RigidFixed10000, "hoist/fixed/rigid/10000", Fixed, Rigid, 10000,
    RigidConfig::<Fixed>::new(&rigid(10000), LOAD_SHARE, BASES)
);
variant!(
    /// Textbook cut, fixed, 10000 Hz.
    CutFixed10000, "hoist/fixed/cut/10000", Fixed, TwoMass, 10000,
    TwoMassConfig::<Fixed>::new(&observer(&CUT, 10000), BASES)
);
variant!(
    /// Reduced, exact step, fixed, 10000 Hz.
    ExactFixed10000, "hoist/fixed/exact/10000", Fixed, TwoMass, 10000,
    TwoMassConfig::<Fixed>::new(&observer(&REDUCED, 10000), BASES)
);
variant!(
    /// Reduced, semi-implicit step, fixed, 10000 Hz.
    ReducedFixed10000, "hoist/fixed/reduced/10000", Fixed, SemiImplicit, 10000,
    SemiImplicitConfig::<Fixed>::new(&observer(&REDUCED, 10000), BASES)
);

mod marker {
    pub struct RigidSingle1000;
    pub struct CutSingle1000;
    pub struct ExactSingle1000;
    pub struct ReducedSingle1000;
    pub struct RigidFixed1000;
    pub struct CutFixed1000;
    pub struct ExactFixed1000;
    pub struct ReducedFixed1000;
    pub struct RigidSingle4000;
    pub struct CutSingle4000;
    pub struct ExactSingle4000;
    pub struct ReducedSingle4000;
    pub struct RigidFixed4000;
    pub struct CutFixed4000;
    pub struct ExactFixed4000;
    pub struct ReducedFixed4000;
    pub struct RigidSingle10000;
    pub struct CutSingle10000;
    pub struct ExactSingle10000;
    pub struct ReducedSingle10000;
    pub struct RigidFixed10000;
    pub struct CutFixed10000;
    pub struct ExactFixed10000;
    pub struct ReducedFixed10000;
}
