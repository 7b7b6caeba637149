//! A machine tool's spindle with a torsional resonance of 800 Hz.
//!
//! A motor spindle of 22 kW (70 N m up to 3000 r/min, 12 000 r/min at most), rotor 0.012 kg m2, drives the tool's side, 0.004 kg m2 with drawbar, holder and a
//! face mill, over a shaft whose stiffness follows from its diameters: 46 mm on 360 mm of length and a taper to 60 mm
//! on 120 mm, bored by 22 mm for the drawbar. That is the size that makers of such spindles give; they are not those of one machine. The encoder is a sine encoder of 512 lines,
//! interpolated 1024 times.

use core::marker::PhantomData;

use driveline::design::{
    Disturbance, Encoder, LoadCycle, ObserverChoice, ObserverSelection, Rate, Requirement, RigidDesign,
    SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Match, Section, ShearModulus, TwoMass, stepped};
use driveline::number::Fixed;
use driveline::observer::{self, RigidConfig, TwoMassConfig};
use driveline::settings::{Bases, Screening, SpeedLoopSettings};

use crate::scene::governed::governed;

/// The shaft between rotor and tool.
pub const SHAFT: [Section; 2] = [
    Section::solid(Length(0.360), Diameter(0.046)).bored(Diameter(0.022)),
    Section::tapered(Length(0.120), Diameter(0.046), Diameter(0.060)).bored(Diameter(0.022)),
];

/// The machine.
pub const CHAIN: Chain =
    Chain::motor(Inertia(0.012)).shaft(stepped(&SHAFT, ShearModulus::STEEL), Damping(0.3)).rotor(Inertia(0.004));

/// Two masses: the machine has no more.
pub const MACHINE: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed [rad/s], 3000 r/min.
pub const RATED_SPEED: f64 = 314.0;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 70.0;

/// Largest torque [N m].
pub const TORQUE_LIMIT: f64 = 110.0;

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 524_288;

/// Of the load torques that cuts bring about, half of rated torque in 10 s as a random walk: noise and lag are least together so.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.5 * RATED_TORQUE, within: 10.0 };

/// The observer.
pub const OBSERVER: TwoMassDesign = MACHINE.observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// The observer that takes the shaft for rigid.
pub const RIGID: RigidDesign = CHAIN.rigid().observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// What it needs for a tool that hits the work within 3 ms, three times a second; twelve samples on a swing are too few for the semi-implicit step.
pub const SELECTION: ObserverSelection = MACHINE.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: 0.66 * RATED_TORQUE,
        change: 0.64 * RATED_TORQUE,
        rise: 0.003,
        every: 0.3,
        reverses: false,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::Exact));

/// The load's share of the inertia.
pub const LOAD_SHARE: f64 = MACHINE.load_inertia / (MACHINE.motor_inertia + MACHINE.load_inertia);

/// The speed loop: a fortieth of the antiresonance, 17 Hz.
pub const LOOP: SpeedLoopDesign =
    MACHINE.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.025, damping: 1.0, shaft_damping: 0.03 });

/// The governor: rated speed in half a second.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: 2.0 * RATED_SPEED };

/// Bases of fixed point. That of the torque is forty times the largest, for the gains: a radian of innovation is much with such an encoder.
pub const BASES: Bases = Bases::new(&MACHINE, 40.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Plausibility limits of a sample. In 6 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 256.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 167,
};

/// The spindle with a number and an observer.
pub struct Spindle<N, O>(PhantomData<(N, O)>);

governed! { Spindle, "spindle", 10000;
    "rigid": RigidObserver, RigidConfig(&RIGID, LOAD_SHARE);
    "exact": TwoMassObserver, TwoMassConfig(&OBSERVER);
}
