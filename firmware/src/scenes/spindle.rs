//! A machine tool's spindle with a torsional resonance of 800 Hz.
//!
//! A motor spindle of 22 kW gives 70 N m up to 3000 r/min and turns at 12 000 r/min at most. Its rotor of 0.012 kg m2
//! drives 0.004 kg m2 on the tool's side: drawbar, holder and a face mill. The shaft's stiffness follows from its
//! diameters: 46 mm on 360 mm of length and a taper to 60 mm on 120 mm, bored by 22 mm for the drawbar. That is the
//! size that makers of such spindles give; it is not one machine. The sine encoder has 512 lines, each interpolated
//! 1024 times.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning, Spread, Tolerance};
use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Section, ShearModulus, Speed, Torque, stepped};
use driveline::observer::{self, TwoMassObserver};
use driveline::settings::{Bases, Screening};

use crate::scene::composed::Governed;
use crate::scene::table::variants;

/// The shaft between rotor and tool.
pub const SHAFT: [Section; 2] = [
    Section::solid(Length(0.360), Diameter(0.046)).bored(Diameter(0.022)),
    Section::tapered(Length(0.120), Diameter(0.046), Diameter(0.060)).bored(Diameter(0.022)),
];

/// Rotor, shaft, tool.
pub struct Spindle;

impl Machine for Spindle {
    const CHAIN: Chain =
        Chain::motor(Inertia(0.012)).shaft(stepped(&SHAFT, ShearModulus::STEEL), Damping(0.3)).rotor(Inertia(0.004));
    /// 3000 r/min.
    const RATING: Rating = Rating { torque: Torque(70.0), speed: Speed(314.0), torque_limit: Torque(110.0) };
    /// With half of its tolerances: the interpolation is within 1 % of a line, the jitter within 0.2 µs. An observer of
    /// counts alone takes their errors for swings of the shaft.
    const ENCODER: Encoder =
        Encoder::lines(COUNTS / 4).interpolation(LINES, 0.005).jitter(0.1e-6, Self::RATING.speed.0);
    const RATE_HZ: u32 = 10_000;
    /// The tool meets the work within milliseconds: the load torque wanders three times as far as usual. With an
    /// encoder of this accuracy the observer would lag behind it otherwise.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 1.5 * Self::RATING.torque.0, ..Self::RATING.disturbance() };
    /// A fiftieth of the antiresonance, 14 Hz, and next to nothing of the twist rate: a torque that is a tick late and
    /// through a current control of 500 Hz is 130 degrees late at 800 Hz.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.02, damping: 1.0, shaft_damping: 0.006 };
    /// With less than three tenths of its 1 % of damping the shaft would need a lag of the speed.
    const TOLERANCE: Tolerance = Tolerance { damping: Spread::between(0.3, 2.0), ..Tolerance::USUAL };
    /// Rated speed in half a second.
    const RAMP: f64 = 2.0 * Self::RATING.speed.0;
    /// That of the torque is forty times the largest, for the gains: a radian of innovation is much with such an
    /// encoder.
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 40.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    /// In 6 ms the motor turns by less than half a turn.
    const SCREENING: Screening = Screening {
        innovation: core::f64::consts::TAU / 256.0,
        max_coast: Self::RATE_HZ / 167,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

/// Lines of the encoder.
pub const LINES: u32 = 512;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 524_288;

/// One mass: the choice over the tolerances.
pub type Rigid<N> = Governed<N, observer::RigidObserver>;
/// Two masses, exact step: what the load cycle alone asks for.
pub type Exact<N> = Governed<N, TwoMassObserver>;

variants! {
    "rigid": Rigid for Spindle;
    "exact": Exact for Spindle;
}
