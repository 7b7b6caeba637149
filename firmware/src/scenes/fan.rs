//! A fan: motor, coupling, impeller. The smallest drive: one mass, nothing that the controller could feel beside it.
//!
//! A 45 kW, four-pole motor at 1480 r/min (290 N m; makers' tables give 0.3 to 0.4 kg m2 for frame size 225) on a flexible coupling of 0.12 MN m/rad,
//! as catalogues have it for that torque, and the impeller of a radial fan of 0.9 m. It takes 40 s to run up.

use core::marker::PhantomData;

use driveline::design::{
    Disturbance, Encoder, LoadCycle, ObserverChoice, ObserverSelection, Rate, Requirement, RigidDesign,
    SpeedLoopDesign, SpeedLoopTuning,
};
use driveline::drive::{Config, ConfigOf, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{Chain, Damping, Inertia, Match, Rigid, Stiffness, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{self, RigidConfig};
use driveline::settings::{Bases, Screening, SpeedLoopSettings};

use crate::scene::governed::governed;

/// The machine.
pub const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(1.2e5), Damping(8.0)).rotor(Inertia(4.5));

/// What the drive takes it for.
pub const MACHINE: Rigid = CHAIN.rigid();

/// What it leaves out: only the speed loop is designed with it.
pub const REDUCED: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed [rad/s].
pub const RATED_SPEED: f64 = 155.0;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 290.0;

/// Largest torque [N m].
pub const TORQUE_LIMIT: f64 = 435.0;

/// Ticks a second: a fan needs no more.
pub const RATE_HZ: u32 = 1_000;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 4096;

/// The load follows the speed, which takes seconds.
pub const OBSERVER: RigidDesign = MACHINE.observer(
    Rate::hz(RATE_HZ),
    Encoder::lines(COUNTS / 4),
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.2 * RATED_TORQUE, within: 10.0 },
);

/// What it needs: torques that change within a tenth of a second do not shake the coupling.
pub const SELECTION: ObserverSelection = REDUCED.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: RATED_TORQUE,
        change: 0.5 * RATED_TORQUE,
        rise: 0.1,
        every: 5.0,
        reverses: false,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::Rigid));

/// The load's share of the inertia, which the coupling accelerates.
pub const LOAD_SHARE: f64 = 4.5 / MACHINE.inertia;

/// A slow speed loop, a hundredth of the antiresonance.
pub const LOOP: SpeedLoopDesign =
    REDUCED.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.01, damping: 1.0, shaft_damping: 0.02 });

/// The governor.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 10.0 };

/// Bases of fixed point.
pub const BASES: Bases = Bases::rigid(2.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Plausibility limits of a sample. In 15 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 67,
};

/// The fan with a number and an observer.
pub struct Fan<N, O>(PhantomData<(N, O)>);

governed! { Fan, "fan", 1000;
    "rigid": RigidObserver, RigidConfig(&OBSERVER, LOAD_SHARE);
}
