//! The tilting drive of a 300 t oxygen converter: four motors on one bull gear, with backlash.
//!
//! Four motors of 110 kW at 600 r/min turn four pinion trains of 690 on one bull gear. They are alike, and so are their
//! trains, so one equivalent motor of four times the inertia and torque stands for them; their motion against each
//! other is not in this scene. Vessel, steel and lining of 850 t turn at a radius of gyration of 3.8 m (1.2e7 kg m2);
//! trunnion and torque bar give 3.5 GN m/rad; the gap is that of four worn trains, 0.43 mrad at the trunnion, 0.3 rad
//! at the motors. A steel bath of this size needs some third of rated torque on either side of its dead centre. Figures
//! are of the size that makers give for such drives, not those of one machine. Losses are taken for dry friction of the
//! load.
//!
//! | variant | governs |
//! |---|---|
//! | `slack` | backlash take-up and active damping of the shaft |
//! | `plain` | by a plain speed loop |

use driveline::configure::{HasBacklash, Machine, Rating};
use driveline::design::{BacklashTakeUpTuning, BacklashTuning, Disturbance, Encoder, SpeedLoopDesign, SpeedLoopTuning};
use driveline::governor::{SpeedGovernor, SymmetricLimit};
use driveline::machine::{Chain, Damping, Efficiency, Gap, Inertia, Match, Ratio, Speed, Stiffness, Torque, TwoMass};
use driveline::observer::BacklashObserver;
use driveline::settings::{Bases, Screening};

use crate::scene::composed::GovernedBy;
use crate::scene::table::variants;

/// Motor turns per turn of the trunnion.
pub const RATIO: f64 = 690.0;

/// The machine, from the motors to the vessel: motors and brakes; pinions, gears and bull gear; the trunnion.
pub struct Converter;

impl Machine for Converter {
    const CHAIN: Chain = Chain::motor(Inertia(4.0 * 9.0))
        .shaft(Stiffness(2.0e5), Damping(15.0))
        .rotor(Inertia(4.0))
        .gear(Ratio(RATIO), Efficiency(1.0))
        .shaft(Stiffness(3.6e9), Damping(1.0e7))
        .backlash(Gap(0.3 / RATIO))
        .rotor(Inertia(1.2e7));
    /// All four motors; 600 r/min.
    const RATING: Rating =
        Rating { torque: Torque(4.0 * 1_750.0), speed: Speed(62.8), torque_limit: Torque(2.0 * 4.0 * 1_750.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
    /// Cut at the trunnion: what is before the gap, and what is behind it.
    const TWO_MASS: TwoMass = Self::CHAIN.reduce(Match::TextbookCut(1));
    /// The mass between motors and bull gear is not in the model: its share of the torque counts as an error of it.
    const DISTURBANCE: Disturbance =
        Disturbance { torque_accuracy: 0.02 * Self::RATING.torque.0, ..Self::RATING.disturbance() };
    /// The gap differs between the four trains and wears: an observer that trusts it less is better over tolerances,
    /// and as good on the machine as described.
    const BACKLASH_TUNING: BacklashTuning = BacklashTuning { wander: 0.8, hold: 0.3, ..BacklashTuning::USUAL };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.3, damping: 1.0, shaft_damping: 0.2 };
    /// The design's proportional and integral gains, without its damping.
    const SPEED_LOOP: SpeedLoopDesign =
        SpeedLoopDesign { damping: 0.0, ..Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING) };
    /// The setpoint follows the operator's lever: rated speed in a fifth of a second, which is more than the motors
    /// can.
    const RAMP: f64 = 5.0 * Self::RATING.speed.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 2.0 * Self::RATING.speed.0);
    /// In 30 ms the motor turns by less than half a turn.
    const SCREENING: Screening = Screening {
        setpoint: 1.5 * Self::RATING.speed.0,
        max_coast: Self::RATE_HZ / 34,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

/// A tenth of rated torque in the gap, a quarter of it within a period of the shaft, and as much damping as the
/// observer's lag allows with 6 dB.
impl HasBacklash for Converter {
    const TAKING_UP: BacklashTakeUpTuning = BacklashTakeUpTuning {
        impact: 0.2 * Self::RATING.torque.0,
        torque: 0.1 * Self::RATING.torque.0,
        rise: 0.25 * Self::RATING.torque.0,
        fall: f64::INFINITY,
        max_torque: Self::RATING.torque_limit.0,
        damping: 0.03,
    };
}

/// A plain speed loop.
pub type Plain<N> = GovernedBy<N, BacklashObserver, SpeedGovernor>;
/// With backlash take-up.
pub type Slack<N> =
    GovernedBy<N, BacklashObserver, SpeedGovernor<(), (), driveline::governor::BacklashTakeUp<SymmetricLimit>>>;

variants! {
    "plain": Plain for Converter;
    "slack": Slack for Converter;
}
