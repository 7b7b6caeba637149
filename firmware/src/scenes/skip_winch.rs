//! A mine's skip winch with an emergency brake.
//!
//! A 250 kW motor at 600 r/min (4 kN m) lifts a skip of 5 t at 4.2 m/s: gear 15, drum 2 m, 150 m of rope of 36 mm (58 MN of E A, as ropemakers' tables have it), so
//! that the skip hangs on 0.39 MN/m and swings at 1.4 Hz. The brake's disc sits on the motor's shaft, and holds twice the weight: it stops the descending
//! skip with 4.4 m/s2. The figures are of the size of a small shaft's winch, not those of one machine.
//!
//! When the brake closes the inverter is off; the drive is told the brake's torque with the motor's and goes on estimating, since that is when the rope's force matters
//! most.

use core::marker::PhantomData;

use driveline::constants::{Bases, Gear, Screening, SpeedLoopSettings};
use driveline::design::{
    Aim, Disturbance, Duty, Encoder, Need, ObserverChoice, Rate, RigidDesign, SpeedLoopDesign, SpeedLoopTuning,
    TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Match, Ratio, Stiffness, TwoMass,
};
use driveline::number::Fixed;
use driveline::observer::{self, GearedConfig, RigidConfig, SemiImplicitConfig};

use crate::governed::governed;

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
    play: 8.0 * core::f64::consts::TAU / COUNTS as f64,
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
pub const NEED: Need = REDUCED.need(
    &Duty {
        speed: RATED_SPEED,
        torque: 1.8 * RATED_TORQUE,
        change: BRAKE_TORQUE,
        rise: 0.3,
        every: 5.0,
        reverses: false,
    },
    &Aim::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(NEED.chosen, ObserverChoice::SemiImplicit));

/// The load's share of the inertia.
pub const LOAD_SHARE: f64 = REDUCED.load_inertia / (REDUCED.motor_inertia + REDUCED.load_inertia);

/// The speed loop.
pub const LOOP: SpeedLoopDesign = REDUCED.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning::USUAL);

/// The governor: rated speed in four seconds.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 4.0 };

/// Bases of fixed point.
pub const BASES: Bases = Bases::new(&REDUCED, 2.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Limits of what a sample can be. In 40 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    reference: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    standstill: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    missed: RATE_HZ / 25,
};

/// The winch with a number and an observer.
pub struct SkipWinch<N, O>(PhantomData<(N, O)>);

governed! { SkipWinch, "skip-winch", 2000, behind GEAR;
    "rigid": Rigid, RigidConfig(&RIGID, LOAD_SHARE);
    "semi-implicit": SemiImplicit, SemiImplicitConfig(&OBSERVER);
}
