//! A surface grinder whose drive has all four parts: it observes, measures the fluctuation, governs and balances.
//!
//! A 22 kW, eight-pole motor at 735 r/min has 286 N m, and 0.5 kg m2 by makers' tables for frame size 225. Through a
//! soft rubber coupling of 400 N m it turns a vertical spindle with a wheel of segments, 500 mm in diameter. The
//! coupling's half at the motor has 0.02 kg m2; 4.9 kN m/rad and a relative damping of a half are assumed. Chuck,
//! segments and spindle have 1.9 kg m2. The motor's encoder has 2048 sine periods on a turn, each interpolated to 64
//! counts. The figures are of the size of such machines; they are not those of one.
//!
//! One segment protrudes beyond the others: the torque of the cut swings once and twice a turn, on either side of the
//! coupling's resonance of 17 Hz. The cut acts as a torque alone. A force of it on the spindle once a turn would be
//! balanced with the wheel, and be missing after the cut: a real machine is balanced while it idles.
//!
//! Segments wear unevenly, so the wheel is out of balance. A balancing head in the spindle moves two masses round the
//! axis; two velocity sensors stand on the bearing housings.
//!
//! | variant | has |
//! |---|---|
//! | `whole` | the drive, and a panel that balances and shows the fluctuation |
//! | `tick` | the drive alone: the cost of a tick with all four parts |

use driveline::balancing::{BalanceTolerance, BalancingDesign};
use driveline::configure::{HasVibration, Machine, Rating, VibrationNumber};
use driveline::design::{Disturbance, Encoder, SpeedLoopDesign, SpeedLoopTuning};
use driveline::drive::ConfigOf;
use driveline::fluctuation::{Interleaved, Ranked, Summed};
use driveline::governor::SpeedGovernor;
use driveline::machine::{Chain, Damping, Inertia, Speed, Stiffness, Torque};
use driveline::observer::SemiImplicitObserver;
use driveline::settings::Screening;

use crate::panel::balancing_head::{HeadPanel, SelfBalanced};
use crate::panel::fluctuation::{FluctuationPanel, TAKE};
use crate::scene::balanced::{BalancedDrive, Sampled};
use crate::scene::composed::{Beside, Composed};
use crate::scene::panel_keys::Key;
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// Motor, coupling, spindle with its wheel.
pub struct SurfaceGrinder;

impl Machine for SurfaceGrinder {
    const CHAIN: Chain = Chain::motor(Inertia(0.52)).shaft(Stiffness(4.9e3), Damping(3.6)).rotor(Inertia(1.9));
    /// 735 r/min.
    const RATING: Rating = Rating { torque: Torque(286.0), speed: Speed(77.0), torque_limit: Torque(572.0) };
    const ENCODER: Encoder = Encoder::counts(COUNTS);
    /// 816 on a turn.
    const RATE_HZ: u32 = 10_000;
    /// The cut's torque swings by a third of rated once a turn, either way. Of the values tried, from 1 ms to 5 s, the
    /// smallest errors of shaft torque and load speed; 0.1 s to 0.3 s differ by a twentieth.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: Self::RATING.torque.0, within: 0.2, ..Self::RATING.disturbance() };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.2, damping: 1.0, shaft_damping: 0.03 };
    /// Without active damping: the coupling's own is enough, and an observer that follows the cut would feed noise
    /// into it.
    const SPEED_LOOP: SpeedLoopDesign =
        SpeedLoopDesign { damping: 0.0, ..Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING) };
    /// In 30 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 33, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
    const CYCLES: u32 = 32;
}

impl HasVibration for SurfaceGrinder {
    /// Of velocity (m/s).
    const VIBRATION_LIMIT: f64 = 0.02;
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 2048 * 64;

/// Bins of the waveform. At rated speed a turn has 816 ticks almost exactly, which fall on the same angles in each turn
/// and do not average out: with 16 bins the second order is off by 0.5 % of the first, with 32 by 0.1 %.
pub const BINS: usize = 32;

/// The largest correction of the head (kg m).
pub const CAPACITY: f64 = 2.0e-2;

impl SelfBalanced for SurfaceGrinder {
    const BALANCING: BalancingDesign = BalancingDesign {
        rotor: BalanceTolerance { grade: 2.5, mass: 140.0, speed: Self::RATING.speed.0 as f32 },
        capacity: [CAPACITY as f32],
        travel: 3.0,
        settle: 0.3,
        quiet: 0.0,
    };
}

/// The measurement of the fluctuation over a turn: each turn's extremes, and the mean waveform of 32 turns.
pub type TurnFluctuation = Interleaved<BINS>;
/// The governor, composed of parts.
pub type TheGovernor = SpeedGovernor;
/// The drive with all four parts.
pub type WholeDrive<N> = BalancedDrive<N, SemiImplicitObserver, TheGovernor, TurnFluctuation>;

/// The drive with its panel.
pub type Whole<N> = Composed<WholeDrive<N>, Desk>;
/// The drive alone.
pub type Tick<N> = Composed<WholeDrive<N>, Sampled>;

variants! {
    "whole": Whole for SurfaceGrinder;
    "tick": Tick for SurfaceGrinder;
}

/// State of the panel: the balancing, and the waveform that was kept.
pub struct Desk {
    balancing: HeadPanel<SurfaceGrinder>,
    fluctuation: FluctuationPanel<SurfaceGrinder>,
}

impl<N: VibrationNumber + Summed<Real = f32> + Ranked> Beside<WholeDrive<N>> for Desk {
    fn start(drive: &mut WholeDrive<N>, config: &ConfigOf<WholeDrive<N>>) -> Self {
        Desk { balancing: HeadPanel::start(drive, config), fluctuation: FluctuationPanel::default() }
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut WholeDrive<N>, config: &ConfigOf<WholeDrive<N>>, input: &Input) -> Output {
        Sampled.tick(drive, config, input)
    }

    fn panel(
        &mut self,
        drive: &mut WholeDrive<N>,
        config: &mut &'static ConfigOf<WholeDrive<N>>,
        asked: [u32; 2],
    ) -> u32 {
        let [key, _] = asked;
        let answer = self.balancing.panel(drive, config, asked);
        match (key, Key::of(key)) {
            (TAKE, _) => self.fluctuation.keep(&config.fluctuation, drive.fluctuation_mut().waveform_mut().take()),
            (_, Some(_)) => answer,
            (_, None) => self.fluctuation.number(&config.fluctuation, asked, || *drive.fluctuation().extremes()),
        }
    }
}
