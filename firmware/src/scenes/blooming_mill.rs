//! A reversing blooming mill: 7 MW at 50 r/min, direct drive, spindles with a gap of 10 mrad.
//!
//! The motor turns a pinion stand, which turns two rolls of 1150 mm by 2800 mm through slipper spindles. The rolls'
//! inertia follows from their size (steel, 23 t each, two of 3.8 t m2, and as much again for spindles and couplings at
//! their ends); the spindles' stiffness from two shafts of 0.55 m by 5 m side by side, softened by a quarter in their
//! heads (G pi d^4/(32 l) [Wang 1989 §1-3]); the gap is 2 mm of worn slipper at a radius of 0.2 m. The motor's
//! inertia, its overload of 2.5 times rated torque and the first resonance of 12 to 16 Hz are of the size that is
//! published for such stands. They are not those of one machine.
//!
//! | variant | estimates | governs |
//! |---|---|---|
//! | `slack` | with the observer of backlash | backlash take-up and active damping of the spindles |
//! | `backlash` | with the observer of backlash | by a plain speed loop |
//! | `learnt` | as `slack`, with torque offset and inertia learnt | as `slack` |
//! | `exact` | with the two-mass observer, which takes the gap for closed | by a plain speed loop |

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopDesign, SpeedLoopTuning};
use driveline::drive::Drive;
use driveline::governor::TakeUpGovernor;
use driveline::machine::{Chain, Damping, Gap, Inertia, Match, Speed, Stiffness, Torque, TwoMass};
use driveline::observer;
use driveline::settings::{Bases, Screening};

use crate::scene::composed::{Composed, Governed, GovernedBy};
use crate::scene::no_load::{NoLoadLearner, NoLoadRun};
use crate::scene::table::variants;

/// The gap of the spindles (rad).
pub const GAP: f64 = 10.0e-3;

/// The machine, from the motor to the rolls.
pub struct BloomingMill;

impl Machine for BloomingMill {
    const CHAIN: Chain = Chain::motor(Inertia(1.1e5))
        .shaft(Stiffness(1.2e9), Damping(3.0e5))
        .rotor(Inertia(1.0e4))
        .shaft(Stiffness(2.2e8), Damping(1.0e5))
        .backlash(Gap(GAP))
        .rotor(Inertia(2.2e4));
    /// 50 r/min.
    const RATING: Rating = Rating { torque: Torque(1.34e6), speed: Speed(5.24), torque_limit: Torque(2.5 * 1.34e6) };
    /// As direct drives have.
    const ENCODER: Encoder = Encoder::lines(8192);
    const RATE_HZ: u32 = 10_000;
    /// Cut at the spindles: what is before the gap, and what is behind it.
    const TWO_MASS: TwoMass = Self::CHAIN.reduce(Match::TextbookCut(1));
    /// The rolling torque may come and go by as much as rated within a second.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: Self::RATING.torque.0, within: 5.0, ..Self::RATING.disturbance() };
    /// The speed follows within a tenth of a second. The motor outweighs the rolls five times, so its torque can damp
    /// the spindles but little.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.12, damping: 1.0, shaft_damping: 0.03 };
    /// The design's proportional and integral gains, without its damping.
    const SPEED_LOOP: SpeedLoopDesign =
        SpeedLoopDesign { damping: 0.0, ..Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING) };
    /// The governor reverses as fast as the motor can: rated speed in a quarter of a second takes nine tenths of its
    /// largest torque.
    const RAMP: f64 = 4.0 * Self::RATING.speed.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 2.0 * Self::RATING.speed.0);
    /// In a quarter of a second the motor turns by less than half a turn.
    const SCREENING: Screening = Screening {
        setpoint: 1.5 * Self::RATING.speed.0,
        max_coast: Self::RATE_HZ / 4,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

/// With the spindles uncoupled, as for a change of the rolls: motor and pinion stand. In a window of 1 s the torque's
/// noise is 0.03 % of rated, and cogging is averaged over some periods.
impl NoLoadRun for BloomingMill {
    const INERTIA: f64 = Self::TWO_MASS.motor_inertia;
    const WINDOW: f64 = 1.0;
}

/// Two masses and the gap.
pub type Backlash<N> = Governed<N, observer::BacklashObserver>;
/// Two masses, the gap taken for closed.
pub type Exact<N> = Governed<N, observer::TwoMassObserver>;
/// Two masses and the gap, with backlash take-up.
pub type Slack<N> = GovernedBy<N, observer::BacklashObserver, TakeUpGovernor>;
/// The same, with torque offset and inertia learnt with the spindles uncoupled.
pub type Learnt<N> = Composed<Drive<N, observer::BacklashObserver, TakeUpGovernor>, NoLoadLearner<N, BloomingMill>>;

variants! {
    "backlash": Backlash for BloomingMill;
    "exact": Exact for BloomingMill;
    "slack": Slack for BloomingMill;
    "learnt": Learnt for BloomingMill;
}
