//! A bridge crane's travelling drive with a swinging load.
//!
//! 25 t of bridge and trolley and 15 t of load on 10 m of rope travel at 1.25 m/s on wheels of 0.5 m behind gears of 30; two motors of 11 kW count as one of 147 N m
//! at 150 rad/s. Masses, speed and power are of the size that makers give for a crane of 16 t and 25 m of span. The load swings at 0.16 Hz, and what
//! the motor feels of it is the shaft of this drive: a spring of `m g/l`, for angles up to 15 degrees within 0.4 % of the frequency.
//!
//! The travelling resistance, 6 per mille of the weight with the gears' loss in it, lies in front of the swinging load. Of the torque that the drive is told it is taken
//! off as far as it is known. To the observer the rest is a part of the shaft torque and of the load torque alike, which changes nothing else while it is
//! constant.

use core::marker::PhantomData;

use driveline::design::{
    Disturbance, Encoder, LoadCycle, ObserverChoice, ObserverSelection, Rate, Requirement, RigidDesign,
    SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{Chain, Diameter, Efficiency, Inertia, Length, Mass, Match, Ratio, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{self, RigidConfig, SemiImplicitConfig};
use driveline::settings::{Bases, Screening, SpeedLoopSettings};

use crate::scene::governed::governed;

/// The machine, from the motors to the load.
pub const CHAIN: Chain = Chain::motor(Inertia(0.2))
    .gear(Ratio(30.0), Efficiency(1.0))
    .drum(Diameter(0.5))
    .driven(Mass(25_000.0))
    .swinging(Mass(15_000.0), Length(10.0));

/// Two masses: the machine has no more.
pub const MACHINE: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed of the motors [rad/s].
pub const RATED_SPEED: f64 = 150.0;

/// Rated torque of both motors [N m].
pub const RATED_TORQUE: f64 = 147.0;

/// Largest torque of both motors [N m].
pub const TORQUE_LIMIT: f64 = 290.0;

/// Ticks a second.
pub const RATE_HZ: u32 = 1_000;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 4096;

/// The torque is known to 3 %, as much for what is not known of the travelling resistance as for noise. What wanders is the wind, by a twentieth of rated torque in
/// 100 s: noise and lag are least together so.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.03 * RATED_TORQUE, load_torque_step: 0.05 * RATED_TORQUE, within: 100.0 };

/// The observer.
pub const OBSERVER: TwoMassDesign = MACHINE.observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// The observer that takes the load for fixed to the trolley.
pub const RIGID: RigidDesign = CHAIN.rigid().observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// What it needs for a start within a second.
pub const SELECTION: ObserverSelection = MACHINE.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: 0.4 * RATED_TORQUE,
        change: 0.4 * RATED_TORQUE,
        rise: 1.0,
        every: 12.0,
        reverses: true,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::SemiImplicit));

/// The load's share of the inertia.
pub const LOAD_SHARE: f64 = MACHINE.load_inertia / (MACHINE.motor_inertia + MACHINE.load_inertia);

/// The speed loop: seven tenths of the pendulum's frequency, and its swing well damped.
pub const LOOP: SpeedLoopDesign =
    MACHINE.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.7, damping: 1.0, shaft_damping: 0.5 });

/// The governor: rated speed in six seconds.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 6.0 };

/// Bases of fixed point.
pub const BASES: Bases = Bases::new(&MACHINE, 2.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Plausibility limits of a sample. In 15 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 67,
};

/// The drive with a number and an observer.
pub struct CraneTravel<N, O>(PhantomData<(N, O)>);

governed! { CraneTravel, "crane-travel", 1000;
    "rigid": RigidObserver, RigidConfig(&RIGID, LOAD_SHARE);
    "semi-implicit": SemiImplicitObserver, SemiImplicitConfig(&OBSERVER);
}
