//! A dual-mass vibrating screen that runs up through its resonances.
//!
//! A screen box of 8 t with its charge, for a deck of 2.4 m by 6 m, stands on springs on a frame of 5 t, and that on springs on the ground, so that the
//! ground feels little. Two unbalanced shafts that turn against each other shake the box along a line at 45 degrees: 40 kg m together give 5 mm to either side
//! at 970 r/min, five times gravity, as makers have it for such screens. A motor of 30 kW on the ground (295 N m, 1.2 kg m2) turns them through a cardan shaft of
//! 60 mm by 1 m. The figures are not those of one machine.
//!
//! On the way up the machine passes both resonances of its springs, where a motor that is too weak would stay: what it gives goes into the
//! swing (Sommerfeld's effect). The governor bars both ranges and passes them by a quick ramp. At speed gravity pulls on the
//! unbalance once a turn, and the box gives and takes energy twice a turn.

use core::marker::PhantomData;

use driveline::design::{
    BarredSpeeds, Disturbance, Encoder, LoadCycle, ObserverChoice, ObserverSelection, Rate, Requirement,
    SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign, USUAL_MARGIN,
};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::governor::{
    Barred, BarredConfig, Gains, SpeedGovernor, SpeedGovernorConfig, SymmetricLimit, SymmetricLimitConfig,
};
use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Match, Section, ShearModulus, TwoMass};
use driveline::math::sqrt;
use driveline::number::Fixed;
use driveline::observer::{self, TwoMassConfig};
use driveline::settings::{Bases, Screening};

use crate::scene::assembled::Parts;

/// Mass of the box with its charge, and of the frame [kg].
pub const MASSES: [f64; 2] = [8000.0, 5000.0];

/// Stiffness of the springs between box and frame, and between frame and ground [N/m].
pub const SPRINGS: [f64; 2] = [2.4e6, 4.0e6];

/// Mass times radius of both unbalances [kg m].
pub const UNBALANCE: f64 = 40.0;

/// Inertia of both exciter shafts with their unbalances [kg m2].
pub const EXCITER: f64 = 8.5;

/// The motor, the cardan shaft, and the exciter. The box swings freely at speed and takes `S^2/2M` off its inertia on the mean over a turn.
pub const CHAIN: Chain = Chain::motor(Inertia(1.2))
    .shaft(Section::solid(Length(1.0), Diameter(0.060)).stiffness(ShearModulus::STEEL), Damping(13.0))
    .rotor(Inertia(EXCITER - UNBALANCE * UNBALANCE / (2.0 * MASSES[0])));

/// Two masses: the machine has no more that turn.
pub const MACHINE: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed [rad/s], 970 r/min.
pub const RATED_SPEED: f64 = 101.6;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 295.0;

/// Largest torque [N m].
pub const TORQUE_LIMIT: f64 = 2.0 * RATED_TORQUE;

/// Ticks a second.
pub const RATE_HZ: u32 = 4_000;

/// Counts of the encoder on a turn: a sine encoder of 512 lines, interpolated 1024 times. One of 2048 lines is too coarse to follow the box's push from
/// behind the shaft.
pub const COUNTS: u32 = 524_288;

/// Resonances of box and frame on their springs [rad/s], each a critical speed: the roots of
/// `w^4 - (k1/m1 + (k1 + k2)/m2) w^2 + k1 k2/(m1 m2)`.
pub const CRITICAL: [f64; 2] = {
    let ([box_mass, frame], [main, lower]) = (MASSES, SPRINGS);
    let half = 0.5 * (main / box_mass + (main + lower) / frame);
    let root = sqrt(half * half - main * lower / (box_mass * frame));
    [sqrt(half - root), sqrt(half + root)]
};

/// What the governor does not let the machine dwell at: 10 % about either.
pub const BARRED: BarredSpeeds<2> = BarredSpeeds::new(&CRITICAL, &[1.0], USUAL_MARGIN, RATED_SPEED);

/// Of the load torque, what the box gives and takes at 32 Hz has to be followed: a thousand newton metres within milliseconds.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 4.0 * RATED_TORQUE, within: 0.05 };

/// The observer.
pub const OBSERVER: TwoMassDesign = MACHINE.observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// What it needs for the box's push: at speed `S^2 w^2/2M` either way, twice a turn.
pub const SELECTION: ObserverSelection = MACHINE.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: 2.0 * RATED_TORQUE,
        change: UNBALANCE * UNBALANCE * RATED_SPEED * RATED_SPEED / MASSES[0],
        rise: 0.5 * core::f64::consts::PI / RATED_SPEED,
        every: 0.5 * core::f64::consts::PI / RATED_SPEED,
        reverses: true,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::Exact));

/// The speed loop: a tenth of the antiresonance, without damping of the shaft.
pub const LOOP: SpeedLoopDesign = SpeedLoopDesign {
    damping: 0.0,
    ..MACHINE.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.03 })
};

/// Rated speed in five seconds [rad/s2].
pub const RAMP: f64 = RATED_SPEED / 5.0;

/// Through a barred range as fast as the motor can: nine tenths of its largest torque on all that turns [rad/s2].
pub const QUICK_RAMP: f64 = 0.9 * TORQUE_LIMIT / (MACHINE.motor_inertia + MACHINE.load_inertia);

/// Bases of fixed point. That of the torque is a thousand times the largest, for the gains: a radian of innovation is much with such an encoder. What is left of
/// resolution is 2 mN m.
pub const BASES: Bases = Bases::new(&MACHINE, 1000.0 * TORQUE_LIMIT, 2.0 * RATED_SPEED);

/// Plausibility limits of a sample. In 20 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 256.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 50,
};

/// How the screen passes its resonances.
pub mod with {
    /// By a quick ramp.
    pub struct Quick;
    /// As any other speed; for comparison, in no image.
    pub struct Plain;
}

/// The screen with a number and a governor.
pub struct VibratingScreen<N, G>(PhantomData<(N, G)>);

macro_rules! variant {
    ($with:ident, $number:ident, $name:literal, $shape:ty, $set_point:expr, $bases:expr) => {
        impl Parts for VibratingScreen<$number, with::$with> {
            type Number = $number;
            type Observer = observer::TwoMassObserver<$number>;
            type Governor = SpeedGovernor<$number, $shape, (), SymmetricLimit>;
            const NAME: &'static str = concat!("vibrating-screen/", $name, "/4000");
            const RATE_HZ: u32 = RATE_HZ;
            const CONFIG: &'static ConfigOf<Drive<$number, Self::Observer, (), Self::Governor>> = &Config {
                limits: Limits::<$number>::new(&SCREENING, $bases),
                observer: TwoMassConfig::<$number>::new(&OBSERVER, $bases),
                fluctuation: (),
                governor: SpeedGovernorConfig {
                    filter: (),
                    gains: Gains::<$number>::of_speed_loop(&LOOP, RAMP, $bases),
                    shape: $set_point,
                    compensation: (),
                    limit: SymmetricLimitConfig::<$number>::new(TORQUE_LIMIT, $bases),
                    sequence: (),
                },
                balancer: (),
            };
        }
    };
}

const PERIOD: f64 = 1.0 / RATE_HZ as f64;

variant!(
    Quick,
    f32,
    "f32/exact",
    Barred<2>,
    BarredConfig::<f32, 2>::new(&BARRED, QUICK_RAMP, PERIOD, Bases::SI),
    Bases::SI
);
variant!(
    Quick,
    Fixed,
    "fixed/exact",
    Barred<2>,
    BarredConfig::<Fixed, 2>::new(&BARRED, QUICK_RAMP, PERIOD, BASES),
    BASES
);
variant!(Plain, f32, "f32/plain", (), (), Bases::SI);
