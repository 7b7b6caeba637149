//! A reversing blooming mill: 7 MW at 50 r/min, direct drive, spindles with a gap of 10 mrad.
//!
//! The motor turns a pinion stand, which turns two rolls of 1150 mm by 2800 mm through slipper spindles. The rolls'
//! inertia follows from their size (steel, 23 t each, two of 3.8 t m2, and as much again for spindles and couplings at
//! their ends); the spindles' stiffness from two shafts of 0.55 m by 5 m side by side, softened by a quarter in their
//! heads (G pi d^4/(32 l) [Wang 1989 (1-16)]); the gap is 2 mm of worn slipper at a radius of 0.2 m. The motor's
//! inertia, its overload of 2.5 times rated torque and the first resonance of 12 to 16 Hz are of the size that is
//! published for such stands. They are not those of one machine.
//!
//! | variant | estimates | governs |
//! |---|---|---|
//! | `slack` | with the observer of backlash | takes up slack gently and damps the spindles |
//! | `backlash` | with the observer of backlash | by a plain speed loop |
//! | `exact` | with the two-mass observer, which takes the gap for closed | by a plain speed loop |

use core::marker::PhantomData;

use driveline::design::{
    BacklashDesign, BacklashTakeUpDesign, BacklashTakeUpTuning, BacklashTuning, Disturbance, Encoder, Rate,
    SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::governor::{
    BacklashTakeUp, BacklashTakeUpConfig, Gains, SpeedGovernor, SpeedGovernorConfig, SpeedLoop, SpeedLoopConfig,
    SymmetricLimit, SymmetricLimitConfig,
};
use driveline::machine::{Chain, Damping, Gap, Inertia, Match, Stiffness, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{self, BacklashConfig, TwoMassConfig};
use driveline::settings::{Bases, Screening, SpeedLoopSettings};

use crate::scene::assembled::Parts;
use crate::scene::expected::{Expected, Expects};
use crate::scene::governed::Variant;

/// The gap of the spindles \[rad\].
pub const GAP: f64 = 10.0e-3;

/// The machine, from the motor to the rolls.
pub const CHAIN: Chain = Chain::motor(Inertia(1.1e5))
    .shaft(Stiffness(1.2e9), Damping(3.0e5))
    .rotor(Inertia(1.0e4))
    .shaft(Stiffness(2.2e8), Damping(1.0e5))
    .backlash(Gap(GAP))
    .rotor(Inertia(2.2e4));

/// Rated speed of the motor [rad/s], 50 r/min.
pub const RATED_SPEED: f64 = 5.24;

/// Rated torque of the motor [N m].
pub const RATED_TORQUE: f64 = 1.34e6;

/// Largest torque of the motor [N m].
pub const TORQUE_LIMIT: f64 = 2.5 * RATED_TORQUE;

/// Two masses, cut at the spindles: what is before the gap, and what is behind it.
pub const MACHINE: TwoMass = CHAIN.reduce(Match::TextbookCut(1));

/// The encoder: 8192 lines, as direct drives have.
pub const ENCODER: Encoder = Encoder::lines(8192);

/// How the observer is tuned: the drive knows its torque to 1 % of rated in a tick, and the rolling torque may come and
/// go by as much as rated within a second.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: RATED_TORQUE, within: 5.0 };

/// Bases of fixed point: twice the motor's largest torque, and twice rated speed.
pub const BASES: Bases = Bases::new(&MACHINE, 2.0 * TORQUE_LIMIT, 2.0 * RATED_SPEED);

/// Plausibility limits of a sample: two thirds over the largest torque; 1/128 turn; two counts; a quarter of a second,
/// in which the motor turns by less than half a turn.
pub const fn screening(rate_hz: u32) -> Screening {
    Screening {
        torque: 1.67 * TORQUE_LIMIT,
        setpoint: 1.5 * RATED_SPEED,
        innovation: core::f64::consts::TAU / 128.0,
        frozen_turn: 2.0 * core::f64::consts::TAU / 32_768.0,
        max_coast: rate_hz / 4,
    }
}

/// The governor reverses as fast as the motor can: rated speed in a quarter of a second takes nine tenths of its
/// largest torque.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: 4.0 * RATED_SPEED };

/// The speed follows within a tenth of a second. The motor outweighs the rolls five times, so its torque can damp the
/// spindles but little.
pub const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.12, damping: 1.0, shaft_damping: 0.1 };

/// The plain speed loop at a rate: the design's proportional and integral gains, without its damping.
pub const fn speed_loop(rate_hz: u32) -> SpeedLoopDesign {
    SpeedLoopDesign { damping: 0.0, ..MACHINE.speed_loop(Rate::hz(rate_hz), TUNING) }
}

/// How slack is taken up: half of rated torque in the gap, and three times rated torque within a period of the
/// spindles, which is as much as their swing allows.
pub const TAKING_UP: BacklashTakeUpTuning = BacklashTakeUpTuning {
    impact: 0.9 * RATED_TORQUE,
    torque: 0.5 * RATED_TORQUE,
    rise: 3.0 * RATED_TORQUE,
    max_torque: TORQUE_LIMIT,
    damping: 0.1,
};

/// The taking up of slack at a rate.
pub const fn take_up(rate_hz: u32) -> BacklashTakeUpDesign {
    MACHINE.take_up(Rate::hz(rate_hz), TAKING_UP)
}

/// The observer of two masses at a rate.
pub const fn two_mass(rate_hz: u32) -> TwoMassDesign {
    MACHINE.observer(Rate::hz(rate_hz), ENCODER, DISTURBANCE)
}

/// The observer of backlash at a rate.
pub const fn backlash(rate_hz: u32) -> BacklashDesign {
    MACHINE.backlash_observer(Rate::hz(rate_hz), ENCODER, DISTURBANCE, BacklashTuning::USUAL)
}

/// What the mill is tried with.
pub mod with {
    /// Two masses and the gap, slack taken up.
    pub struct Slack;
    /// Two masses and the gap.
    pub struct Backlash;
    /// Two masses, the gap taken for closed.
    pub struct Exact;
}

/// The mill with a number, an observer and a rate.
pub struct BloomingMill<N, O, const RATE_HZ: u32>(PhantomData<(N, O)>);

macro_rules! variant {
    ($with:ident, $text:literal, $number:ident, $observer:ty, $design:ident, $config:expr, $limits:expr, $governor:expr) => {
        // Generic over the rate: the compiler designs only those that an image holds.
        impl<const R: u32> Variant for BloomingMill<$number, with::$with, R> {
            type Number = $number;
            type Observer = $observer;
            const NAME: &'static str = match R {
                10_000 => concat!("blooming-mill/", $text, "/10000"),
                _ => panic!("the blooming mill runs at 10000 ticks a second"),
            };
            const RATE_HZ: u32 = R;
            const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, (), SpeedLoop<$number>>> =
                &Config { limits: $limits, observer: $config, fluctuation: (), governor: $governor, balancer: () };

            fn expected() -> Option<Expected> {
                Some($design(R).expected())
            }
        }
    };
}

macro_rules! single {
    ($with:ident, $text:literal, $observer:ident, $design:ident, $config:expr) => {
        variant!(
            $with,
            $text,
            f32,
            observer::$observer<f32>,
            $design,
            $config,
            Limits::<f32>::new(&screening(R), Bases::SI),
            SpeedLoopConfig::<f32>::new(&speed_loop(R), SETTINGS, Bases::SI)
        );
    };
}

macro_rules! fixed {
    ($with:ident, $text:literal, $observer:ident, $design:ident, $config:expr) => {
        variant!(
            $with,
            $text,
            Fixed,
            observer::$observer<Fixed>,
            $design,
            $config,
            Limits::<Fixed>::new(&screening(R), BASES),
            SpeedLoopConfig::<Fixed>::new(&speed_loop(R), SETTINGS, BASES)
        );
    };
}

single!(Backlash, "f32/backlash", BacklashObserver, backlash, BacklashConfig::<f32>::new(&backlash(R), Bases::SI));
single!(Exact, "f32/exact", TwoMassObserver, two_mass, TwoMassConfig::<f32>::new(&two_mass(R), Bases::SI));
fixed!(Backlash, "fixed/backlash", BacklashObserver, backlash, BacklashConfig::<Fixed>::new(&backlash(R), BASES));
fixed!(Exact, "fixed/exact", TwoMassObserver, two_mass, TwoMassConfig::<Fixed>::new(&two_mass(R), BASES));

/// The governor that takes up slack.
pub type Governor<N> = SpeedGovernor<N, (), (), BacklashTakeUp<N, SymmetricLimit>>;

macro_rules! slack {
    ($number:ident, $text:literal, $bases:expr) => {
        impl Parts for BloomingMill<$number, with::Slack, 10_000> {
            type Number = $number;
            type Observer = observer::BacklashObserver<$number>;
            type Governor = Governor<$number>;
            const NAME: &'static str = concat!("blooming-mill/", $text, "/slack/10000");
            const RATE_HZ: u32 = 10_000;
            const CONFIG: &'static ConfigOf<Drive<$number, Self::Observer, (), Self::Governor>> = &Config {
                limits: Limits::<$number>::new(&screening(10_000), $bases),
                observer: BacklashConfig::<$number>::new(&backlash(10_000), $bases),
                fluctuation: (),
                governor: SpeedGovernorConfig {
                    filter: (),
                    gains: Gains::<$number>::of_speed_loop(&speed_loop(10_000), SETTINGS.ramp, $bases),
                    shape: (),
                    compensation: (),
                    limit: BacklashTakeUpConfig::<$number, _>::new(
                        &take_up(10_000),
                        SymmetricLimitConfig::<$number>::new(SETTINGS.torque_limit, $bases),
                        $bases,
                    ),
                    sequence: (),
                },
                balancer: (),
            };

            fn expected() -> Option<Expected> {
                Some(backlash(10_000).expected())
            }
        }
    };
}

slack!(f32, "f32", Bases::SI);
slack!(Fixed, "fixed", BASES);
