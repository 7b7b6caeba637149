//! A single-stage gear drive whose mesh excites it.
//!
//! A motor of 37 kW at 1475 r/min has 240 N m, and 0.4 kg m2 by makers' tables for frame size 225. Through a coupling
//! and a spur pair it turns a rotary machine at 620 r/min. The pair has 21 and 50 teeth of module 4 mm and 40 mm width,
//! and a contact ratio of 1.6. Its inertias and its mesh stiffness with one and two pairs of teeth in contact are of
//! the size of such a pair. The driven machine has 12 kg m2 on a shaft of 65 mm by 0.8 m. The figures are not those of
//! one machine.
//!
//! The tooth mesh is far above the bandwidth of an observer on the motor: at speed they meet 516 times a second. It
//! is in the full plant, with an error on every second tooth, with backlash and with the wheels' bearings; here the
//! mesh is a shaft of its mean stiffness, and the wheels are a mass that the reduction leaves out. On the way up the
//! mesh passes their resonance.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Inertia, Length, Ratio, Section, ShearModulus, Speed, Stiffness, Torque,
};
use driveline::observer::TwoMassObserver;
use driveline::settings::{Bases, Screening};

use crate::scene::composed::Governed;
use crate::scene::table::variants;

/// Teeth of pinion and wheel.
pub const TEETH: [u32; 2] = [21, 50];

/// Motor turns per turn of the driven machine.
pub const RATIO: f64 = TEETH[1] as f64 / TEETH[0] as f64;

/// Base radii of pinion and wheel (m): half of module times teeth, by the cosine of 20 degrees.
pub const BASE_RADII: [f64; 2] =
    [0.002 * TEETH[0] as f64 * 0.939_692_620_785_908_4, 0.002 * TEETH[1] as f64 * 0.939_692_620_785_908_4];

/// Mean stiffness and damping of the mesh along the line of action [N/m, N s/m].
pub const MESH: [f64; 2] = [5.68e8, 3.56e3];

/// Motor, pinion, wheel, driven machine.
pub struct GearDrive;

impl Machine for GearDrive {
    const CHAIN: Chain = Chain::motor(Inertia(0.4))
        .shaft(Stiffness(5.0e4), Damping(4.0))
        .rotor(Inertia(0.0021))
        .gear(Ratio(RATIO), Efficiency(1.0))
        .shaft(Stiffness(MESH[0] * BASE_RADII[1] * BASE_RADII[1]), Damping(MESH[1] * BASE_RADII[1] * BASE_RADII[1]))
        .rotor(Inertia(0.065))
        .shaft(Section::solid(Length(0.8), Diameter(0.065)).stiffness(ShearModulus::STEEL), Damping(25.0))
        .rotor(Inertia(12.0));
    const RATING: Rating = Rating { torque: Torque(240.0), speed: Speed(154.5), torque_limit: Torque(430.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 4_000;
    /// The load may wander by half of rated torque in 1 s.
    const DISTURBANCE: Disturbance = Disturbance { within: 1.0, ..Self::RATING.disturbance() };
    /// A tenth of the antiresonance.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.1 };
    const RAMP: f64 = Self::RATING.speed.0 / 1.5;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 16.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    /// In 15 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8_192;

/// Two masses, exact step: the design's choice.
pub type Exact<N> = Governed<N, TwoMassObserver>;

variants! {
    "exact": Exact for GearDrive;
}
