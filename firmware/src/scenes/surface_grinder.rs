//! A surface grinder whose drive has all four parts: it observes, measures the fluctuation, governs and balances.
//!
//! A 22 kW, eight-pole motor at 735 r/min (286 N m; makers' tables give 0.5 kg m2 for frame size 225) turns a vertical
//! spindle with a wheel of segments, 500 mm in diameter, through a soft rubber coupling of 400 N m. Its half at the
//! motor has 0.02 kg m2; 4.9 kN m/rad and a relative damping of a half are assumed. Chuck, segments and spindle have
//! 1.9 kg m2. The motor's encoder has 2048 sine periods on a turn, each interpolated to 64 counts. The figures are of
//! the size of such machines; they are not those of one.
//!
//! One segment stands proud of the others: the torque of the cut swings once and twice a turn, on either side of the
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

use driveline::balancing::{InRunConfig, Steadiness};
use driveline::configure::{HasVibration, Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopDesign, SpeedLoopTuning};
use driveline::drive::ConfigOf;
use driveline::fluctuation::{Drivetrain, Interleaved, Ranked, Summed};
use driveline::governor::{SpeedGovernor, SymmetricLimit};
use driveline::machine::{Chain, Damping, Inertia, Stiffness};
use driveline::observer::SemiImplicitObserver;
use driveline::settings::{PhasorSettings, Screening};

use crate::panel::balancing_head::{Head, HeadPanel};
use crate::scene::balanced::{BalancedDrive, Panel, Sampled, SensorUnit};
use crate::scene::composed::{Beside, Composed};
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// Motor, coupling, spindle with its wheel.
pub struct SurfaceGrinder;

impl Machine for SurfaceGrinder {
    const CHAIN: Chain = Chain::motor(Inertia(0.52)).shaft(Stiffness(4.9e3), Damping(3.6)).rotor(Inertia(1.9));
    /// 735 r/min.
    const RATING: Rating = Rating { torque: 286.0, speed: 77.0, torque_limit: 572.0 };
    const ENCODER: Encoder = Encoder::counts(COUNTS);
    /// 816 on a turn.
    const RATE_HZ: u32 = 10_000;
    /// The cut's torque swings by a third of rated once a turn, either way. Of the values tried, from 1 ms to 5 s, the
    /// smallest errors of shaft torque and load speed; 0.1 s to 0.3 s differ by a twentieth.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: Self::RATING.torque, within: 0.2, ..Self::RATING.disturbance() };
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
    /// Eight blocks of eight turns, 5.2 s.
    const PHASORS: PhasorSettings = PhasorSettings {
        steadiness: Steadiness { drift: 0.1, scatter: 0.1, floor: 1.0e-3, ..Steadiness::USUAL },
        ..PhasorSettings::DIRECT
    };
    /// Of velocity \[m/s\].
    const VIBRATION_LIMIT: f64 = 0.02;
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 2048 * 64;

/// Bins of the waveform. At rated speed a turn has 816 ticks almost exactly, which fall on the same angles in each turn
/// and do not average out: with 16 bins the second order is off by 0.5 % of the first, with 32 by 0.1 %.
pub const BINS: usize = 32;

/// Highest order of the waveform: the cut swings once and twice a turn, and through the coupling an error of a higher
/// order would grow with its square.
pub const HIGHEST: usize = 2;

/// The largest correction of the head \[kg m\].
pub const CAPACITY: f64 = 2.0e-2;

/// The balancing head.
pub struct TheHead;

impl Head for TheHead {
    /// As the grinding spindle's: the first step is a fiftieth of the capacity, a fifth of any unbalance worth
    /// balancing.
    const CONFIG: InRunConfig<f32, 1> = InRunConfig {
        probe: CAPACITY as f32 / 50.0,
        limits: [CAPACITY as f32],
        step: 2.0 * CAPACITY as f32,
        bound: 1.3,
        target: 0.01,
        forgetting: 0.7,
        noise: 0.005,
    };
}

/// The measurement of the fluctuation over a turn: each turn's extremes, and the mean waveform of 32 turns.
pub type TurnFluctuation<N> = Interleaved<N, BINS>;
/// The governor, composed of parts.
pub type TheGovernor<N> = SpeedGovernor<N, (), (), SymmetricLimit>;
/// The drive with all four parts.
pub type WholeDrive<N> = BalancedDrive<N, SemiImplicitObserver<N>, TurnFluctuation<N>, TheGovernor<N>>;

/// The drive with its panel.
pub type Whole<N> = Composed<WholeDrive<N>, Desk>;
/// The drive alone.
pub type Tick<N> = Composed<WholeDrive<N>, Sampled>;

variants! {
    "whole": Whole for SurfaceGrinder;
    "tick": Tick for SurfaceGrinder;
}

/// Keys of the panel beside those of the [balancing](crate::scene::panel_keys), whose numbers end before these. The
/// answers are the bits of `f32`, 0 where there is none yet.
pub mod panel {
    /// Keeps the waveform of the last finished turns; answers [`DONE`], or [`NOT_YET`] where there is none.
    pub const TAKE: u32 = 64;
    /// Delta of the motor by the waveform that was kept.
    pub const MOTOR_DELTA: u32 = 65;
    /// Delta of the wheel by the same, through the coupling.
    pub const LOAD_DELTA: u32 = 66;
    /// Cosine of the motor's order `value`, from 1 on \[rad/s\].
    pub const COSINE: u32 = 67;
    /// Its sine.
    pub const SINE: u32 = 68;
    /// Delta of the motor in the last finished turn, by its extremes.
    pub const MOTOR_EXTREMES: u32 = 69;
    /// Delta of the wheel, by the same.
    pub const LOAD_EXTREMES: u32 = 70;

    /// Answer: done.
    pub const DONE: u32 = 1;
    /// Answer: no finished turns, or none that a waveform can be taken from.
    pub const NOT_YET: u32 = 2;
}

/// Coupling and masses, for the load side of the waveform.
const DRIVETRAIN: Drivetrain = {
    let machine = SurfaceGrinder::TWO_MASS;
    Drivetrain {
        motor_inertia: machine.motor_inertia,
        load_inertia: machine.load_inertia,
        stiffness: machine.stiffness,
        damping: machine.damping,
    }
};

/// State of the panel: the balancing, and the waveform that was kept.
pub struct Desk {
    balancing: Panel<SurfaceGrinder, HeadPanel<TheHead>>,
    /// Delta of motor and wheel.
    deltas: [f32; 2],
    /// Cosine and sine of the motor's orders \[rad/s\].
    orders: [[f32; 2]; HIGHEST],
}

impl<N: SensorUnit + Summed + Ranked> Beside<WholeDrive<N>> for Desk {
    fn start(drive: &mut WholeDrive<N>, config: &ConfigOf<WholeDrive<N>>) -> Self {
        Desk { balancing: Panel::start(drive, config), deltas: [0.0; 2], orders: [[0.0; 2]; HIGHEST] }
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
        let [key, value] = asked;
        let [cosine, sine] = self.orders.get(value.wrapping_sub(1) as usize).copied().unwrap_or_default();
        let extremes = || drive.fluctuation().extremes().reading(&config.fluctuation.cycle);
        let number = match key {
            panel::TAKE => return self.take(drive, config),
            panel::MOTOR_DELTA => self.deltas[0],
            panel::LOAD_DELTA => self.deltas[1],
            panel::COSINE => cosine,
            panel::SINE => sine,
            panel::MOTOR_EXTREMES => extremes().map_or(0.0, |turn| turn.motor.delta as f32),
            panel::LOAD_EXTREMES => extremes().map_or(0.0, |turn| turn.load.delta as f32),
            _ => return self.balancing.panel(drive, config, asked),
        };
        number.to_bits()
    }
}

impl Desk {
    #[inline(never)]
    fn take<N: SensorUnit + Summed + Ranked>(
        &mut self,
        drive: &mut WholeDrive<N>,
        config: &ConfigOf<WholeDrive<N>>,
    ) -> u32 {
        let config = &config.fluctuation;
        let Some(window) = drive.fluctuation_mut().waveform_mut().take() else { return panel::NOT_YET };
        let Ok(ripple) = window.ripple(config, HIGHEST) else { return panel::NOT_YET };
        let load = ripple.load_side(&config.cycle, &DRIVETRAIN, &window.motor_torque(config, HIGHEST)).load;
        self.deltas = [ripple.motor.delta as f32, load.delta as f32];
        for (kept, order) in self.orders.iter_mut().zip(&ripple.speed.orders) {
            *kept = [order.cos as f32, order.sin as f32];
        }
        panel::DONE
    }
}
