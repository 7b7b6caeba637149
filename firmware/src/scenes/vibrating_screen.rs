//! A dual-mass vibrating screen that runs up through its resonances.
//!
//! A screen box of 8 t with its charge, for a deck of 2.4 m by 6 m, stands on springs on a frame of 5 t. The frame
//! stands on springs on the ground, so that little reaches the ground. Two unbalanced shafts that turn against each
//! other shake the box along a line at 45 degrees. Together they have 40 kg m, which gives 5 mm to either side at 970
//! r/min: five times gravity, as makers have it for such screens. A motor of 30 kW on the ground (295 N m, 1.2 kg m2)
//! turns them through a cardan shaft of 60 mm by 1 m. The figures are not those of one machine.
//!
//! On the way up the machine passes both resonances of its springs, where a motor that is too weak would stay: what it
//! gives goes into the swing (Sommerfeld's effect). The governor bars both ranges and passes them by a quick ramp. At
//! speed gravity pulls on the unbalance once a turn, and the box gives and takes energy twice a turn.

use driveline::configure::{HasBarredSpeeds, Machine, Rating};
use driveline::design::{BarredSpeeds, Disturbance, Encoder, SpeedLoopDesign, SpeedLoopTuning, USUAL_MARGIN};
use driveline::governor::{Barred, SpeedGovernor};
use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Section, ShearModulus, Speed, Torque};
use driveline::math::sqrt;
use driveline::observer::TwoMassObserver;
use driveline::settings::{Bases, Screening};

use crate::scene::composed::GovernedBy;
use crate::scene::table::variants;

/// Mass of the box with its charge, and of the frame (kg).
pub const MASSES: [f64; 2] = [8000.0, 5000.0];

/// Stiffness of the springs between box and frame, and between frame and ground (N/m).
pub const SPRINGS: [f64; 2] = [2.4e6, 4.0e6];

/// Mass times radius of both unbalances (kg m).
pub const UNBALANCE: f64 = 40.0;

/// Inertia of both exciter shafts with their unbalances (kg m2).
pub const EXCITER: f64 = 8.5;

/// The motor, the cardan shaft, and the exciter. The box swings freely at speed and takes `S^2/2M` off its inertia on
/// average over a turn.
pub struct VibratingScreen;

impl Machine for VibratingScreen {
    const CHAIN: Chain = Chain::motor(Inertia(1.2))
        .shaft(Section::solid(Length(1.0), Diameter(0.060)).stiffness(ShearModulus::STEEL), Damping(13.0))
        .rotor(Inertia(EXCITER - UNBALANCE * UNBALANCE / (2.0 * MASSES[0])));
    /// 970 r/min.
    const RATING: Rating = Rating { torque: Torque(295.0), speed: Speed(101.6), torque_limit: Torque(2.0 * 295.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 4_000;
    /// The observer must follow the box's load torque at 32 Hz: a thousand newton metres within milliseconds.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 4.0 * Self::RATING.torque.0, within: 0.05, ..Self::RATING.disturbance() };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.03 };
    /// A tenth of the antiresonance, without damping of the shaft.
    const SPEED_LOOP: SpeedLoopDesign =
        SpeedLoopDesign { damping: 0.0, ..Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING) };
    const RAMP: f64 = Self::RATING.speed.0 / 5.0;
    /// That of the torque is a thousand times the largest, for the gains: a radian of innovation is much with such an
    /// encoder. What is left of the resolution is 2 mN m.
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 1000.0 * Self::RATING.torque_limit.0, 2.0 * Self::RATING.speed.0);
    /// In 20 ms the motor turns by less than half a turn.
    const SCREENING: Screening = Screening {
        innovation: core::f64::consts::TAU / 256.0,
        max_coast: Self::RATE_HZ / 50,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

/// What the governor does not let the machine dwell at: 10 % about either resonance. It passes through as fast as the
/// motor can.
impl HasBarredSpeeds<2> for VibratingScreen {
    const BARRED: BarredSpeeds<2> = BarredSpeeds::new(&CRITICAL, &[1.0], USUAL_MARGIN, Self::RATING.speed.0);
}

/// Counts of the encoder on a turn: a sine encoder of 512 lines, interpolated 1024 times. One of 2048 lines is too
/// coarse to follow the box's push from behind the shaft.
pub const COUNTS: u32 = 524_288;

/// Resonances of box and frame on their springs (rad/s), each a critical speed: the roots of
/// `w^4 - (k1/m1 + (k1 + k2)/m2) w^2 + k1 k2/(m1 m2)`.
pub const CRITICAL: [f64; 2] = {
    let ([box_mass, frame], [main, lower]) = (MASSES, SPRINGS);
    let half = 0.5 * (main / box_mass + (main + lower) / frame);
    let root = sqrt(half * half - main * lower / (box_mass * frame));
    [sqrt(half - root), sqrt(half + root)]
};

/// The resonances passed by a quick ramp.
pub type Exact<N> = GovernedBy<N, TwoMassObserver, SpeedGovernor<Barred<2>>>;
/// The resonances passed as any other speed; for comparison, in no image.
pub type Plain<N> = GovernedBy<N, TwoMassObserver, SpeedGovernor>;

variants! {
    "exact": Exact for VibratingScreen;
}
