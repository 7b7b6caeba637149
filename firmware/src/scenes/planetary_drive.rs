//! A conveyor's head drum behind a planetary set.
//!
//! The set is that of Wang 1989 example 1-4: sun 20, planets 35, ring 90 teeth of module 4 mm, three planets, 5.5 to 1. Driven by a 55 kW motor at
//! 1480 r/min (355 N m, 0.5 kg m2 by makers' tables for frame size 250) it turns the drum's shaft, of 90 mm diameter and 1.2 m length, and the drum with its
//! share of the belt, 55 kg m2.

use core::marker::PhantomData;

use driveline::design::{
    Disturbance, Encoder, LoadCycle, ObserverChoice, ObserverSelection, Rate, Requirement, RigidDesign,
    SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Inertia, Length, Mass, Match, Planetary, Section, ShearModulus, TwoMass,
};
use driveline::number::Fixed;
use driveline::observer::{self, GearedConfig, RigidConfig, TwoMassConfig};
use driveline::settings::{Bases, Gear, Screening, SpeedLoopSettings};

use crate::scene::governed::governed;

/// The planetary set, its ring held.
pub const SET: Planetary = Planetary {
    sun_teeth: 20,
    ring_teeth: 90,
    module: 0.004,
    planets: 3,
    sun: Inertia(0.013_052),
    planet: Inertia(0.002_706),
    planet_mass: Mass(3.7131),
    carrier: Inertia(0.0671),
    efficiency: Efficiency(0.97),
};

/// The machine.
pub const CHAIN: Chain = Chain::motor(Inertia(0.5))
    .planetary(SET)
    .shaft(Section::solid(Length(1.2), Diameter(0.090)).stiffness(ShearModulus::STEEL), Damping(120.0))
    .rotor(Inertia(55.0));

/// Two masses: the machine has no more.
pub const MACHINE: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed of the motor [rad/s].
pub const RATED_SPEED: f64 = 155.0;

/// Rated torque of the motor [N m].
pub const RATED_TORQUE: f64 = 355.0;

/// Largest torque of the motor [N m].
pub const TORQUE_LIMIT: f64 = 600.0;

/// Ticks a second.
pub const RATE_HZ: u32 = 4_000;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8_192;

/// The set's loss, and eight counts of play while its friction holds it.
pub const GEAR: Gear = Gear {
    efficiency: SET.efficiency.0,
    inertia: MACHINE.motor_inertia,
    deadband: 8.0 * core::f64::consts::TAU / COUNTS as f64,
};

/// The load may wander by half of rated torque in 100 s: noise and lag are least together so.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.5 * RATED_TORQUE, within: 100.0 };

/// The observer.
pub const OBSERVER: TwoMassDesign = MACHINE.observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// The observer that takes the machine for rigid. It has to follow the shaft's vibration as if it were the load's doing, or the speed loop would excite it.
pub const RIGID: RigidDesign =
    CHAIN.rigid().observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), Disturbance { within: 1.0, ..DISTURBANCE });

/// What it needs for a belt that breaks loose within 0.2 s: one mass. The scene overrules it, since a rigid observer has to be tuned so lively, lest the speed
/// loop excite the shaft, that its noise costs more than the second mass.
pub const SELECTION: ObserverSelection = MACHINE.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: 0.78 * RATED_TORQUE,
        change: 0.5 * RATED_TORQUE,
        rise: 0.2,
        every: 4.0,
        reverses: false,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::Rigid));

/// The load's share of the inertia.
pub const LOAD_SHARE: f64 = MACHINE.load_inertia / (MACHINE.motor_inertia + MACHINE.load_inertia);

/// The speed loop: a tenth of the antiresonance.
pub const LOOP: SpeedLoopDesign =
    MACHINE.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.2 });

/// The governor: rated speed in four seconds.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 4.0 };

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
pub struct PlanetaryDrive<N, O>(PhantomData<(N, O)>);

governed! { PlanetaryDrive, "planetary", 4000, behind GEAR;
    "rigid": RigidObserver, RigidConfig(&RIGID, LOAD_SHARE);
    "exact": TwoMassObserver, TwoMassConfig(&OBSERVER);
}
