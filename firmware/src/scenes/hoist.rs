//! A bridge crane's hoist: 12 t on two falls of rope.
//!
//! A 116 kW, four-pole motor at 1480 r/min drives a 0.8 m drum through a gearbox of 31.5 and lifts 12 t at 0.98 m/s. On the motor's shaft
//! sits the drum of the holding brake. The rope's stiffness at the load is that of the hoist in Huang 1987 (2.87 MN/m for 8.7 t on two
//! falls); inertias and efficiency are of the size that makers' tables give for such a motor (frame size 315, 0.6 kg m2) and a
//! two-stage gearbox. They are not those of one machine.

use core::marker::PhantomData;

use driveline::design::{
    Disturbance, Encoder, Rate, RigidDesign, SpeedLoopDesign, SpeedLoopTuning, StepChoice, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Match, Ratio, Stiffness, TwoMass,
};
use driveline::number::Fixed;
use driveline::observer::{self, GearedConfig, GearedObserver, RigidConfig, SemiImplicitConfig, TwoMassConfig};
use driveline::settings::{Bases, Gear, Screening, SpeedLoopSettings};

use crate::scene::expected::{Expected, Expects};
use crate::scene::governed::Variant;

/// Efficiency of the gearbox.
pub const EFFICIENCY: Efficiency = Efficiency(0.94);

/// The machine, from the motor to the hook.
pub const CHAIN: Chain = Chain::motor(Inertia(0.62))
    .shaft(Stiffness(5.0e4), Damping(2.0))
    .rotor(Inertia(0.08))
    .gear(Ratio(31.5), EFFICIENCY)
    .drum(Diameter(0.8))
    .damped_rope(Falls(2), Stiffness(2.9e6), LinearDamping(3.6e3))
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

/// The gearbox as the observer knows it. Held by its friction at the largest load, about 80 N m, the motor turns by 1.6 mrad on its own shaft,
/// two counts of the encoder: the play is eight.
pub const GEAR: Gear =
    Gear { efficiency: EFFICIENCY.0, inertia: REDUCED.motor_inertia, deadband: 8.0 * core::f64::consts::TAU / 8192.0 };

/// The encoder.
pub const ENCODER: Encoder = Encoder::lines(2048);

/// How the observer is tuned: the drive knows its torque to 1 % of rated in a tick, and the load may wander by 300 N m, two fifths of a load, in
/// 50 s. A livelier load is followed faster and lets more noise through; here the sum of both is least over the scene's runs.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 300.0, within: 50.0 };

/// Bases of fixed point: twice the motor's largest torque, a third over rated speed.
pub const BASES: Bases = Bases::new(&REDUCED, 2.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Plausibility limits of a sample: two thirds over the largest torque; 1/128 turn, which that torque does not move the motor before
/// the observer has followed; two counts; 15 ms, in which it turns by less than half a turn.
pub const fn screening(rate_hz: u32) -> Screening {
    Screening {
        torque: 1.67 * TORQUE_LIMIT,
        setpoint: 1.2 * RATED_SPEED,
        innovation: core::f64::consts::TAU / 128.0,
        frozen_turn: 2.0 * core::f64::consts::TAU / 8192.0,
        max_coast: rate_hz / 67,
    }
}

/// The governor reaches rated speed in two seconds.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 2.0 };

/// The governor at a rate.
pub const fn speed_loop(rate_hz: u32) -> SpeedLoopDesign {
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
pub const LOAD_SHARE: f64 = REDUCED.load_inertia / (REDUCED.motor_inertia + REDUCED.load_inertia);

/// The design chooses the cheap step from 4 kHz on; a change that makes it too coarse stops here. At 1 kHz `Reduced` overrules the
/// design, to show what that costs.
const _: () = {
    assert!(matches!(observer(&REDUCED, 10_000).chosen, StepChoice::SemiImplicit));
    assert!(matches!(observer(&REDUCED, 4_000).chosen, StepChoice::SemiImplicit));
};

/// The observers that the hoist is tried with.
pub mod with {
    /// One mass.
    pub struct Rigid;
    /// Two masses by the textbook, exact step.
    pub struct Cut;
    /// Two masses by resonance and antiresonance, exact step: the design's choice overruled.
    pub struct Exact;
    /// Two masses by resonance and antiresonance, semi-implicit step: the design's choice.
    pub struct Reduced;
}

/// The hoist with a number, an observer and a rate.
pub struct Hoist<N, O, const RATE_HZ: u32>(PhantomData<(N, O)>);

macro_rules! limits_and_governor {
    (f32, $observer:expr) => {
        &Config {
            limits: Limits::<f32>::new(&screening(R), Bases::SI),
            observer: GearedConfig::<f32, _>::new($observer, &GEAR, 1.0 / R as f64, Bases::SI),
            fluctuation: (),
            governor: SpeedLoopConfig::<f32>::new(&speed_loop(R), SETTINGS, Bases::SI),
            balancer: (),
        }
    };
    (Fixed, $observer:expr) => {
        &Config {
            limits: Limits::<Fixed>::new(&screening(R), BASES),
            observer: GearedConfig::<Fixed, _>::new($observer, &GEAR, 1.0 / R as f64, BASES),
            fluctuation: (),
            governor: SpeedLoopConfig::<Fixed>::new(&speed_loop(R), SETTINGS, BASES),
            balancer: (),
        }
    };
}

macro_rules! variant {
    ($with:ident, $text:literal, $number:ident, $observer:ident, $design:expr, $config:expr) => {
        // Generic over the rate: the compiler designs only those that an image holds.
        impl<const R: u32> Variant for Hoist<$number, with::$with, R> {
            type Number = $number;
            type Observer = GearedObserver<observer::$observer<$number>>;
            const NAME: &'static str = match R {
                1_000 => concat!("hoist/", $text, "/1000"),
                4_000 => concat!("hoist/", $text, "/4000"),
                10_000 => concat!("hoist/", $text, "/10000"),
                _ => panic!("the hoist runs at 1000, 4000 or 10000 ticks a second"),
            };
            const RATE_HZ: u32 = R;
            const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, (), SpeedLoop<$number>>> =
                limits_and_governor!($number, $config);

            fn expected() -> Option<Expected> {
                Some($design.expected())
            }
        }
    };
}

variant!(Rigid, "f32/rigid", f32, RigidObserver, rigid(R), RigidConfig::<f32>::new(&rigid(R), LOAD_SHARE, Bases::SI));
variant!(
    Cut,
    "f32/cut",
    f32,
    TwoMassObserver,
    observer(&CUT, R),
    TwoMassConfig::<f32>::new(&observer(&CUT, R), Bases::SI)
);
variant!(
    Exact,
    "f32/exact",
    f32,
    TwoMassObserver,
    observer(&REDUCED, R),
    TwoMassConfig::<f32>::new(&observer(&REDUCED, R), Bases::SI)
);
variant!(
    Reduced,
    "f32/reduced",
    f32,
    SemiImplicitObserver,
    observer(&REDUCED, R),
    SemiImplicitConfig::<f32>::new(&observer(&REDUCED, R), Bases::SI)
);
variant!(Rigid, "fixed/rigid", Fixed, RigidObserver, rigid(R), RigidConfig::<Fixed>::new(&rigid(R), LOAD_SHARE, BASES));
variant!(
    Cut,
    "fixed/cut",
    Fixed,
    TwoMassObserver,
    observer(&CUT, R),
    TwoMassConfig::<Fixed>::new(&observer(&CUT, R), BASES)
);
variant!(
    Exact,
    "fixed/exact",
    Fixed,
    TwoMassObserver,
    observer(&REDUCED, R),
    TwoMassConfig::<Fixed>::new(&observer(&REDUCED, R), BASES)
);
variant!(
    Reduced,
    "fixed/reduced",
    Fixed,
    SemiImplicitObserver,
    observer(&REDUCED, R),
    SemiImplicitConfig::<Fixed>::new(&observer(&REDUCED, R), BASES)
);
