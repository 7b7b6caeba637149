//! The tilting drive of a 300 t oxygen converter: four motors on one bull gear, slack in the gear.
//!
//! Four motors of 110 kW at 600 r/min turn four pinion trains of 690 on one bull gear. They are alike, and so are their
//! trains, so one equivalent motor of four times the inertia and torque stands for them; what they might do against
//! each other is not in this scene. Vessel, steel and lining of 850 t turn at a radius of gyration of 3.8 m (1.2e7 kg
//! m2); trunnion and torque bar give 3.5 GN m/rad; the gap is what four worn trains leave, 0.43 mrad at the trunnion,
//! 0.3 rad at the motors. A steel bath of this size needs some third of rated torque on either side of its dead centre.
//! Figures are of the size that makers give for such drives, not those of one machine. Losses are taken for dry
//! friction of the load.
//!
//! | variant | governs |
//! |---|---|
//! | `slack` | takes up slack gently and damps the shaft |
//! | `plain` | by a plain speed loop |

use core::marker::PhantomData;

use driveline::design::{
    BacklashDesign, BacklashTakeUpDesign, BacklashTakeUpTuning, BacklashTuning, Disturbance, Encoder, Rate,
    SpeedLoopDesign, SpeedLoopTuning,
};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::governor::{
    BacklashTakeUp, BacklashTakeUpConfig, Gains, SpeedGovernor, SpeedGovernorConfig, SymmetricLimit,
    SymmetricLimitConfig,
};
use driveline::machine::{Chain, Damping, Efficiency, Gap, Inertia, Match, Ratio, Stiffness, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{BacklashConfig, BacklashObserver};
use driveline::settings::{Bases, Screening};

use crate::scene::assembled::Parts;
use crate::scene::expected::{Expected, Expects};

/// Motor turns per turn of the trunnion.
pub const RATIO: f64 = 690.0;

/// The machine, from the motors to the vessel: motors and brakes; pinions, gears and bull gear; the trunnion.
pub const CHAIN: Chain = Chain::motor(Inertia(4.0 * 9.0))
    .shaft(Stiffness(2.0e5), Damping(15.0))
    .rotor(Inertia(4.0))
    .gear(Ratio(RATIO), Efficiency(1.0))
    .shaft(Stiffness(3.6e9), Damping(1.0e7))
    .backlash(Gap(0.3 / RATIO))
    .rotor(Inertia(1.2e7));

/// Rated speed of the motors [rad/s], 600 r/min.
pub const RATED_SPEED: f64 = 62.8;

/// Rated torque of all four [N m].
pub const RATED_TORQUE: f64 = 4.0 * 1_750.0;

/// Largest torque of all four [N m].
pub const TORQUE_LIMIT: f64 = 2.0 * RATED_TORQUE;

/// Two masses, cut at the trunnion: what is before the gap, and what is behind it.
pub const MACHINE: TwoMass = CHAIN.reduce(Match::TextbookCut(1));

/// The encoder.
pub const ENCODER: Encoder = Encoder::lines(2048);

/// How the observer is tuned: the drive knows its torque to 1 % of rated in a tick, and the load may wander by a third
/// of rated in ten seconds.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.35 * RATED_TORQUE, within: 10.0 };

/// Bases of fixed point: twice the motors' largest torque, and twice rated speed.
pub const BASES: Bases = Bases::new(&MACHINE, 2.0 * TORQUE_LIMIT, 2.0 * RATED_SPEED);

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;

/// Plausibility limits of a sample: two thirds over the largest torque; 1/128 turn; two counts; 30 ms, in which the
/// motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.5 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / 8192.0,
    max_coast: RATE_HZ / 34,
};

/// The setpoint follows the operator's lever: rated speed in a fifth of a second, which is more than the motors can
/// [rad/s2].
pub const RAMP: f64 = 5.0 * RATED_SPEED;

/// A third of the antiresonance.
pub const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.3, damping: 1.0, shaft_damping: 0.2 };

/// The plain speed loop: the design's proportional and integral gains, without its damping.
pub const SPEED_LOOP: SpeedLoopDesign =
    SpeedLoopDesign { damping: 0.0, ..MACHINE.speed_loop(Rate::hz(RATE_HZ), TUNING) };

/// The observer.
pub const OBSERVER: BacklashDesign =
    MACHINE.backlash_observer(Rate::hz(RATE_HZ), ENCODER, DISTURBANCE, BacklashTuning::USUAL);

/// How slack is taken up: a tenth of rated torque in the gap, three tenths of it within a period of the shaft.
pub const TAKING_UP: BacklashTakeUpTuning = BacklashTakeUpTuning {
    impact: 0.2 * RATED_TORQUE,
    torque: 0.1 * RATED_TORQUE,
    rise: 0.3 * RATED_TORQUE,
    max_torque: TORQUE_LIMIT,
    damping: 0.2,
};

/// The taking up of slack.
pub const TAKE_UP: BacklashTakeUpDesign = MACHINE.take_up(Rate::hz(RATE_HZ), TAKING_UP);

/// What the converter is tried with.
pub mod with {
    /// Slack taken up.
    pub struct Slack;
    /// A plain speed loop.
    pub struct Plain;
}

/// The converter with a number and a governor.
pub struct Converter<N, G>(PhantomData<(N, G)>);

macro_rules! variant {
    ($with:ident, $number:ident, $name:literal, $limit:ty, $config:expr, $bases:expr) => {
        impl Parts for Converter<$number, with::$with> {
            type Number = $number;
            type Observer = BacklashObserver<$number>;
            type Governor = SpeedGovernor<$number, (), (), $limit>;
            const NAME: &'static str = concat!("converter/", $name, "/10000");
            const RATE_HZ: u32 = RATE_HZ;
            const CONFIG: &'static ConfigOf<Drive<$number, Self::Observer, (), Self::Governor>> = &Config {
                limits: Limits::<$number>::new(&SCREENING, $bases),
                observer: BacklashConfig::<$number>::new(&OBSERVER, $bases),
                fluctuation: (),
                governor: SpeedGovernorConfig {
                    filter: (),
                    gains: Gains::<$number>::of_speed_loop(&SPEED_LOOP, RAMP, $bases),
                    shape: (),
                    compensation: (),
                    limit: $config,
                    sequence: (),
                },
                balancer: (),
            };

            fn expected() -> Option<Expected> {
                Some(OBSERVER.expected())
            }
        }
    };
}

const SINGLE: SymmetricLimitConfig<f32> = SymmetricLimitConfig::<f32>::new(TORQUE_LIMIT, Bases::SI);
const FIXED: SymmetricLimitConfig<Fixed> = SymmetricLimitConfig::<Fixed>::new(TORQUE_LIMIT, BASES);

variant!(Plain, f32, "f32/plain", SymmetricLimit, SINGLE, Bases::SI);
variant!(Plain, Fixed, "fixed/plain", SymmetricLimit, FIXED, BASES);
variant!(Slack, f32, "f32/slack", BacklashTakeUp<f32, SymmetricLimit>, BacklashTakeUpConfig::<f32, _>::new(&TAKE_UP, SINGLE, Bases::SI), Bases::SI);
variant!(
    Slack,
    Fixed,
    "fixed/slack",
    BacklashTakeUp<Fixed, SymmetricLimit>,
    BacklashTakeUpConfig::<Fixed, _>::new(&TAKE_UP, FIXED, BASES),
    BASES
);
