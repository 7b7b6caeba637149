//! A single-stage gear drive whose mesh excites it.
//!
//! A motor of 37 kW at 1475 r/min (240 N m, 0.4 kg m2 by makers' tables for frame size 225) turns a rotary machine at 620 r/min through a coupling and a spur
//! pair of 21 and 50 teeth of module 4 mm and 40 mm width, whose contact ratio is 1.6. The pair's inertias and its mesh stiffness with one and two pairs of
//! teeth in contact are of the size that Tang 1994 calculates with. The driven machine has 12 kg m2 on a shaft of 65 mm by 0.8 m. The figures are not those of one machine.
//!
//! What the teeth do is far above what an observer on the motor can follow: at speed they meet 516 times a second. It is in the full plant, with an error on
//! every second tooth, with backlash and with the wheels' bearings; here the mesh is a shaft of its mean stiffness, and the wheels are a mass that the reduction leaves out. On
//! the way up the mesh passes their resonance.

use core::marker::PhantomData;

use driveline::design::{
    Disturbance, Encoder, LoadCycle, ObserverChoice, ObserverSelection, Rate, Requirement, SpeedLoopDesign,
    SpeedLoopTuning, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Inertia, Length, Match, Ratio, Section, ShearModulus, Stiffness, TwoMass,
};
use driveline::number::Fixed;
use driveline::observer::{self, TwoMassConfig};
use driveline::settings::{Bases, Screening, SpeedLoopSettings};

use crate::scene::governed::governed;

/// Teeth of pinion and wheel.
pub const TEETH: [u32; 2] = [21, 50];

/// Motor turns per turn of the driven machine.
pub const RATIO: f64 = TEETH[1] as f64 / TEETH[0] as f64;

/// Base radii of pinion and wheel [m]: half of module times teeth, by the cosine of 20 degrees.
pub const BASE_RADII: [f64; 2] =
    [0.002 * TEETH[0] as f64 * 0.939_692_620_785_908_4, 0.002 * TEETH[1] as f64 * 0.939_692_620_785_908_4];

/// Mean stiffness and damping of the mesh along the line of action [N/m, N s/m].
pub const MESH: [f64; 2] = [5.68e8, 3.56e3];

/// The machine: motor, pinion, wheel, driven machine.
pub const CHAIN: Chain = Chain::motor(Inertia(0.4))
    .shaft(Stiffness(5.0e4), Damping(4.0))
    .rotor(Inertia(0.0021))
    .gear(Ratio(RATIO), Efficiency(1.0))
    .shaft(Stiffness(MESH[0] * BASE_RADII[1] * BASE_RADII[1]), Damping(MESH[1] * BASE_RADII[1] * BASE_RADII[1]))
    .rotor(Inertia(0.065))
    .shaft(Section::solid(Length(0.8), Diameter(0.065)).stiffness(ShearModulus::STEEL), Damping(25.0))
    .rotor(Inertia(12.0));

/// Two masses with the chain's first resonance and antiresonance.
pub const REDUCED: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed of the motor [rad/s].
pub const RATED_SPEED: f64 = 154.5;

/// Rated torque of the motor [N m].
pub const RATED_TORQUE: f64 = 240.0;

/// Largest torque of the motor [N m].
pub const TORQUE_LIMIT: f64 = 430.0;

/// Ticks a second.
pub const RATE_HZ: u32 = 4_000;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8_192;

/// The load may wander by half of rated torque in 1 s.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.5 * RATED_TORQUE, within: 1.0 };

/// The observer.
pub const OBSERVER: TwoMassDesign = REDUCED.observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// What it needs for a load that comes within 20 ms.
pub const SELECTION: ObserverSelection = REDUCED.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: 1.5 * RATED_TORQUE,
        change: 0.5 * RATED_TORQUE,
        rise: 0.02,
        every: 0.5,
        reverses: false,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::Exact));

/// The speed loop: a tenth of the antiresonance.
pub const LOOP: SpeedLoopDesign =
    REDUCED.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.1 });

/// The governor: rated speed in a second and a half.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 1.5 };

/// Bases of fixed point.
pub const BASES: Bases = Bases::new(&REDUCED, 16.0 * TORQUE_LIMIT, 1.34 * RATED_SPEED);

/// Plausibility limits of a sample. In 15 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 67,
};

/// The drive with a number and an observer.
pub struct GearDrive<N, O>(PhantomData<(N, O)>);

governed! { GearDrive, "gear-drive", 4000;
    "exact": TwoMassObserver, TwoMassConfig(&OBSERVER);
}
