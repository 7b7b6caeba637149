//! A conveyor's head drum behind a planetary set.
//!
//! Sun 20, planets 35, ring 90 teeth of module 4 mm, three planets, 5.5 to 1: numbers of our own. The arrangement is
//! that of [Wang 1989 example 1-4]. Its motor of 55 kW at 1480 r/min has 355 N m, and 0.5 kg m2 by makers' tables for
//! frame size 250. The drum's shaft is 90 mm thick and 1.2 m long. Drum and its share of the belt have 55 kg m2.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, RigidDesign, SpeedLoopTuning};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Inertia, Length, Mass, Planetary, Section, ShearModulus, Speed, Torque,
};
use driveline::observer::{self, GearedObserver, TwoMassObserver};
use driveline::settings::{Bases, Screening};

use crate::scene::composed::Governed;
use crate::scene::table::variants;

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

/// Motor, planetary set, shaft, drum.
pub struct PlanetaryDrive;

impl Machine for PlanetaryDrive {
    const CHAIN: Chain = Chain::motor(Inertia(0.5))
        .planetary(SET)
        .shaft(Section::solid(Length(1.2), Diameter(0.090)).stiffness(ShearModulus::STEEL), Damping(120.0))
        .rotor(Inertia(55.0));
    const RATING: Rating = Rating { torque: Torque(355.0), speed: Speed(155.0), torque_limit: Torque(600.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 4_000;
    /// The load may wander by half of rated torque in 100 s: noise and lag are least together so.
    const DISTURBANCE: Disturbance = Disturbance { within: 100.0, ..Self::RATING.disturbance() };
    /// The observer that takes the machine for rigid has to follow the shaft's vibration as if it were the load's
    /// doing, or the speed loop would excite it.
    const RIGID_OBSERVER: RigidDesign =
        Self::CHAIN.rigid().observer(Self::RATE, Self::ENCODER, Disturbance { within: 1.0, ..Self::DISTURBANCE });
    /// A tenth of the antiresonance.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.2 };
    const RAMP: f64 = Self::RATING.speed.0 / 4.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    /// In 15 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8_192;

/// One mass behind the gear.
pub type Rigid<N> = Governed<N, GearedObserver<observer::RigidObserver>>;
/// Two masses behind the gear, exact step.
pub type Exact<N> = Governed<N, GearedObserver<TwoMassObserver>>;

variants! {
    "rigid": Rigid for PlanetaryDrive;
    "exact": Exact for PlanetaryDrive;
}
