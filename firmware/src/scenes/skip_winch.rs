//! A mine's skip winch with an emergency brake.
//!
//! A 250 kW motor at 600 r/min (4 kN m) lifts a skip of 5 t at 4.2 m/s: gear 15, drum 2 m, 150 m of rope of 36 mm (58 MN of E A, as ropemakers' tables have it), so
//! that the skip hangs on 0.39 MN/m and swings at 1.4 Hz. The brake's disc sits on the motor's shaft, and holds twice the weight: it stops the descending
//! skip with 4.4 m/s2. The figures are of the size of a small shaft's winch, not those of one machine.
//!
//! When the supply fails the brake closes and the inverter is off; the drive is told the brake's torque with the motor's and goes on estimating, since that is
//! when the rope's force matters most.
//!
//! Otherwise the inverter stays on through an emergency (stop category 1 of IEC 60204-1). A winch that stops faster than its skip falls throws it into a slack
//! rope, and the skip falls back into it. So the emergency is tried with two governors, on an observer that knows a slack rope:
//!
//! | variant | estimates | governs |
//! |---|---|---|
//! | `slack` | with the observer of backlash, whose gap is the slack rope | keeps the rope from going slack, takes it up gently, damps the swing |
//! | `plain` | with the observer of backlash | by a plain speed loop |
//! | `semi-implicit` | with two masses, a rope that pushes | by the speed loop with its damping |
//! | `rigid` | with one mass | by the speed loop with its damping |

use core::marker::PhantomData;

use driveline::design::{
    BacklashDesign, BacklashTakeUpDesign, BacklashTakeUpTuning, BacklashTuning, Disturbance, Encoder, LoadCycle,
    ObserverChoice, ObserverSelection, Rate, Requirement, RigidDesign, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::governor::{
    BacklashTakeUp, BacklashTakeUpConfig, Gains, SpeedGovernor, SpeedGovernorConfig, SpeedLoop, SpeedLoopConfig,
    SymmetricLimit, SymmetricLimitConfig,
};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Gap, Inertia, LinearDamping, Mass, Match, Ratio, Stiffness, TwoMass,
};
use driveline::number::Fixed;
use driveline::observer::{self, BacklashConfig, GearedConfig, GearedObserver, RigidConfig, SemiImplicitConfig};
use driveline::settings::{Bases, Gear, Screening, SpeedLoopSettings};

use crate::scene::assembled::Parts;
use crate::scene::governed::governed;

/// Efficiency of the gear.
pub const EFFICIENCY: Efficiency = Efficiency(0.94);

/// The machine, from the motor with the brake's disc to the skip.
pub const CHAIN: Chain = Chain::motor(Inertia(20.0))
    .shaft(Stiffness(6.0e5), Damping(60.0))
    .gear(Ratio(15.0), EFFICIENCY)
    .rotor(Inertia(1500.0))
    .drum(Diameter(2.0))
    .damped_rope(Falls(1), Stiffness(3.9e5), LinearDamping(1.3e3))
    .lifted(Mass(5_000.0));

/// Two masses with the chain's first resonance and antiresonance.
pub const REDUCED: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed of the motor [rad/s].
pub const RATED_SPEED: f64 = 62.8;

/// Rated torque of the motor [N m].
pub const RATED_TORQUE: f64 = 4_000.0;

/// Largest torque of the motor [N m].
pub const TORQUE_LIMIT: f64 = 7_000.0;

/// Torque of the brake at the motor [N m]: twice the weight's.
pub const BRAKE_TORQUE: f64 = 6_540.0;

/// Ticks a second.
pub const RATE_HZ: u32 = 2_000;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8192;

/// The gear's loss, and eight counts of play while its friction holds it.
pub const GEAR: Gear = Gear {
    efficiency: EFFICIENCY.0,
    inertia: REDUCED.motor_inertia,
    deadband: 8.0 * core::f64::consts::TAU / COUNTS as f64,
};

/// The load hardly changes on its way.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.5 * RATED_TORQUE, within: 100.0 };

/// The observer.
pub const OBSERVER: TwoMassDesign = REDUCED.observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// The observer that takes the rope for rigid. It has to follow the rope's vibration as if it were the load's doing.
pub const RIGID: RigidDesign =
    CHAIN.rigid().observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), Disturbance { within: 1.0, ..DISTURBANCE });

/// What it needs when the brake closes within 0.3 s.
pub const SELECTION: ObserverSelection = REDUCED.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: 1.8 * RATED_TORQUE,
        change: BRAKE_TORQUE,
        rise: 0.3,
        every: 5.0,
        reverses: false,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::SemiImplicit));

/// The load's share of the inertia.
pub const LOAD_SHARE: f64 = REDUCED.load_inertia / (REDUCED.motor_inertia + REDUCED.load_inertia);

/// The speed loop.
pub const LOOP: SpeedLoopDesign = REDUCED.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning::USUAL);

/// The governor: rated speed in four seconds.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 4.0 };

/// Bases of fixed point.
pub const BASES: Bases = Bases::new(&REDUCED, 2.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Plausibility limits of a sample. In 40 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 25,
};

/// The winch with a number and an observer.
pub struct SkipWinch<N, O>(PhantomData<(N, O)>);

governed! { SkipWinch, "skip-winch", 2000, behind GEAR;
    "rigid": RigidObserver, RigidConfig(&RIGID, LOAD_SHARE);
    "semi-implicit": SemiImplicitObserver, SemiImplicitConfig(&OBSERVER);
}

/// The rope as a shaft with a gap: pulled on one flank, and so far from the other that it is never met \[rad\].
pub const ROPE_GAP: f64 = 15.0;

/// Limits of what a sample can be, where motor and brake pull together.
pub const ROPE_SCREENING: Screening = Screening { torque: TORQUE_LIMIT + 1.05 * BRAKE_TORQUE, ..SCREENING };

/// Two masses on a rope that can go slack.
pub const ON_ROPE: TwoMass = REDUCED.with_gap(Gap(ROPE_GAP));

/// How the observer looks for the moment in which the rope tightens: a slack rope's length is known from the flight of the skip, to 0.15 rad within a period of
/// the swing.
pub const SEARCH: BacklashTuning = BacklashTuning { wander: 0.01, hold: 0.6 };

/// The observer of a rope that can go slack.
pub const SLACK_ROPE: BacklashDesign =
    ON_ROPE.backlash_observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE, SEARCH);

/// The setpoint of the emergency stop: from rated speed in an eighth of a second, which is more than motor and brake
/// can \[rad/s2\].
pub const EMERGENCY_RAMP: f64 = 8.0 * RATED_SPEED;

/// The plain speed loop: the design's proportional and integral gains, without its damping.
pub const PLAIN: SpeedLoopDesign = SpeedLoopDesign { damping: 0.0, ..LOOP };

/// Design of backlash take-up. While the rope is slack, rated torque holds the drum to the skip's speed, also against the brake. A tight rope's torque rises by
/// as much within a period of the swing, which is damped as far as motor and drum, as heavy as the skip, can.
pub const TAKING_UP: BacklashTakeUpTuning = BacklashTakeUpTuning {
    impact: 0.2 * RATED_TORQUE,
    torque: RATED_TORQUE,
    rise: RATED_TORQUE,
    max_torque: TORQUE_LIMIT,
    damping: 0.7,
};

/// The taking up of slack.
pub const TAKE_UP: BacklashTakeUpDesign = REDUCED.take_up(Rate::hz(RATE_HZ), TAKING_UP);

/// What the emergency stop is tried with.
pub mod with {
    /// A slack rope taken up.
    pub struct Slack;
    /// A plain speed loop.
    pub struct Plain;
}

macro_rules! rope {
    ($with:ident, $number:ident, $name:literal, $limit:ty, $config:expr, $bases:expr) => {
        impl Parts for SkipWinch<$number, with::$with> {
            type Number = $number;
            type Observer = GearedObserver<observer::BacklashObserver<$number>>;
            type Governor = SpeedGovernor<$number, (), (), $limit>;
            const NAME: &'static str = concat!("skip-winch/", $name, "/2000");
            const RATE_HZ: u32 = RATE_HZ;
            const CONFIG: &'static ConfigOf<Drive<$number, Self::Observer, (), Self::Governor>> = &Config {
                limits: Limits::<$number>::new(&ROPE_SCREENING, $bases),
                observer: GearedConfig::<$number, _>::new(
                    BacklashConfig::<$number>::new(&SLACK_ROPE, $bases),
                    &GEAR,
                    1.0 / RATE_HZ as f64,
                    $bases,
                ),
                fluctuation: (),
                governor: SpeedGovernorConfig {
                    filter: (),
                    gains: Gains::<$number>::of_speed_loop(&PLAIN, EMERGENCY_RAMP, $bases),
                    shape: (),
                    compensation: (),
                    limit: $config,
                    sequence: (),
                },
                balancer: (),
            };
        }
    };
}

const SINGLE: SymmetricLimitConfig<f32> = SymmetricLimitConfig::<f32>::new(TORQUE_LIMIT, Bases::SI);
const FIXED: SymmetricLimitConfig<Fixed> = SymmetricLimitConfig::<Fixed>::new(TORQUE_LIMIT, BASES);

rope!(Plain, f32, "f32/plain", SymmetricLimit, SINGLE, Bases::SI);
rope!(Plain, Fixed, "fixed/plain", SymmetricLimit, FIXED, BASES);
rope!(Slack, f32, "f32/slack", BacklashTakeUp<f32, SymmetricLimit>, BacklashTakeUpConfig::<f32, _>::new(&TAKE_UP, SINGLE, Bases::SI), Bases::SI);
rope!(
    Slack,
    Fixed,
    "fixed/slack",
    BacklashTakeUp<Fixed, SymmetricLimit>,
    BacklashTakeUpConfig::<Fixed, _>::new(&TAKE_UP, FIXED, BASES),
    BASES
);
