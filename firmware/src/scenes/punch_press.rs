//! An eccentric punch press: 800 kN at 69 strokes a minute, a flywheel on the motor's shaft, crank and slider behind a
//! gear of 14.
//!
//! An 18.5 kW, six-pole motor at 970 r/min (182 N m; makers' tables give 0.3 kg m2 for frame size 200) carries a
//! flywheel of 4.5 kg m2 (0.62 m by 40 mm of steel). Gear wheel and crank disc have 40 kg m2, the eccentric shaft of
//! 0.16 m by 0.32 m has 16 MN m/rad (G pi d^4/(32 l) [Wang 1989 §1-3]); the crank has a radius of 80 mm, the rod 0.7
//! m, slider and upper die 2.5 t. A stroke blanks thick plate by a die with shear, over 40 degrees before the bottom,
//! and takes some 9 kJ of the 26 kJ that the flywheel holds. The figures are of the size of a C-frame press of 80 t;
//! they are not those of one machine.
//!
//! The slider's mass makes the inertia at the motor swing: the observer has it as J(phi), by a table of constants. The
//! crank's angle is known from its top: the press starts there. The motor's encoder has 2048 sine periods on a turn,
//! each interpolated to 64 counts, as drives of this kind have it.
//!
//! | variant | governs | measures |
//! |---|---|---|
//! | `plain` | by a plain speed loop, which fights the ripple | nothing |
//! | `mean` | on the speed without its ripple, so that the flywheel does the stroke's work | the fluctuation over the stroke; advises a flywheel |
//! | `guarded` | as `plain`, and stops at a force of the punch | the force; the mesh of the motor's pinion |

use driveline::configure::{GainSource, HasGearMesh, HasMechanism, Machine, Rating, Units};
use driveline::design::{
    Actuator, Disturbance, Encoder, ForceAccuracy, GovernorDesign, LoadFeedForward, LoadStep, SpeedLoopDesign,
    SpeedLoopTuning, Supervision,
};
use driveline::drive::{ConfigOf, Drive};
use driveline::fault::Faults;
use driveline::fluctuation::{
    Balance, CycleMean, Flywheel, FourierSeries, GearMesh, Sideband, Summed, Waveform, WaveformConfig, Window,
};
use driveline::governor::{CycleAverage, SpeedGovernor, SpeedLoop, Supervised, SymmetricLimit};
use driveline::machine::{
    Chain, CrankSlider, Damping, DrivenMechanism, Efficiency, Inertia, Length, Mass, Match, Mechanism, Ratio, Speed,
    Stiffness, Torque, TwoMass,
};
use driveline::number::{Fixed, Number};
use driveline::observer::{self, ForceLimit, ForceLimitConfig};
use driveline::settings::{Bases, Cycle, Screening};

use crate::scene::composed::{Beside, Composed, OverWords as _};
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// Turns of the motor to one of the crank.
pub const RATIO: u32 = 14;

/// Inertia of motor and flywheel (kg m2).
pub const FLYWHEEL: f64 = 0.3 + 4.5;

/// Crank, rod and slider, on the crank's shaft.
pub const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.08), Length(0.7), Inertia(40.0), Mass(2_500.0));

/// The machine with its shaft and the crank drive's mean inertia, for the governors.
pub struct PunchPress;

impl Machine for PunchPress {
    const CHAIN: Chain = Chain::motor(Inertia(FLYWHEEL))
        .gear(Ratio(RATIO as f64), Efficiency(1.0))
        .shaft(Stiffness(1.6e7), Damping(2_100.0))
        .rotor(RAM.mean_inertia());
    const RATING: Rating = Rating { torque: Torque(182.0), speed: Speed(101.6), torque_limit: Torque(364.0) };
    const ENCODER: Encoder = Encoder::counts(COUNTS);
    const RATE_HZ: u32 = 10_000;
    /// Referred to the motor.
    const TWO_MASS: TwoMass = Self::CHAIN.reduce(Match::TextbookCut(0));
    /// The punch comes and goes within hundredths of a second: of the values tried, the smallest error of the shaft
    /// torque. A quicker observer is noisy.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 1_000.0, within: 3.0, ..Self::RATING.disturbance() };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.03, damping: 1.0, shaft_damping: 0.04 };
    /// As any other drive has it: three hundredths of the antiresonance, 3 Hz.
    const SPEED_LOOP: SpeedLoopDesign =
        SpeedLoopDesign { damping: 0.0, ..Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING) };
    /// On the speed without its ripple.
    const GAINS: GainSource = GainSource::Governor(over_stroke());
    const RAMP: f64 = Self::RATING.speed.0 / 2.0;
    /// The shaft carries five times the motor's largest torque, and the observer's gains want a base of this size.
    const BASES: Bases = Bases::rigid(10_000.0, 1.34 * Self::RATING.speed.0);
    /// In 25 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 40, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
    /// The punch up to the force at which the press stops, over a quarter of its way.
    const LOAD_STEP: LoadStep = LoadStep { torque: 2_600.0, rise: 0.024 };
    /// The punch is the work: it comes through the eccentric shaft. What it takes of the speed is the flywheel's.
    const SUPERVISION: Supervision = Supervision {
        change: 4_000.0,
        load_torque: [-4_000.0, 4_000.0],
        shaft_torque: 6_000.0,
        ..Supervision::of(
            &Self::RATING,
            Self::MECHANISM_OBSERVER.rigid.innovation_response(&Self::LOAD_STEP),
            &Self::TOLERANCE,
            Self::ENCODER,
            &Self::LOAD_STEP,
            Self::RAMP,
            Self::PERIOD,
        )
        .within(&Self::SCREENING)
    };
    const CYCLE: Cycle = STROKE;
    const CYCLES: u32 = 4;
}

/// As the observer has it.
impl HasMechanism for PunchPress {
    const DRIVEN: DrivenMechanism = DrivenMechanism::new(Inertia(FLYWHEEL), &Mechanism::slider_crank(&RAM), 1, RATIO);
}

/// A pinion of 20 teeth on the motor's shaft, a wheel of 280 on the crank's.
impl HasGearMesh<2> for PunchPress {
    const TEETH: u32 = 20;
    const MESH: [Sideband; 2] = [Sideband::MESH, Sideband::of_motor(1)];
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 2048 * 64;

/// Crank angle when the press is switched on: half a turn from the top dead centre (2^-32 turn).
pub const TOP: u32 = 1 << 31;

/// A stroke: a turn of the crank.
pub const STROKE: Cycle = Cycle { turns: RATIO, cycles: 1 };

/// The longest stroke that the press is governed in by its mean (s): at four fifths of rated speed.
pub const LONGEST_STROKE: f64 = core::f64::consts::TAU * RATIO as f64 / (0.8 * PunchPress::RATING.speed.0);

/// The governor on the speed without its ripple. That is renewed from a whole stroke: a gain of 1.5 J over the stroke's
/// time crosses over at 1.5/T, where `(1 - e^-sT)(1/sT + 1/2)` has lost little, and the integral takes three strokes.
/// `tests/governor` has the loop's margin.
pub const fn over_stroke() -> GovernorDesign {
    PunchPress::TWO_MASS.governor(
        PunchPress::RATE,
        Actuator { delay: 0.0, lag: LONGEST_STROKE / 6.75 },
        4.5,
        LoadFeedForward::NONE,
    )
}

/// Segments of the stroke, at whose ends the mean is renewed.
pub const SEGMENTS: usize = 64;

/// Bins of the waveform.
pub const BINS: usize = 128;

/// Highest order of the waveform: a punch over a ninth of the stroke has orders beyond, which are a thousandth of
/// delta.
pub const HIGHEST: usize = 16;

/// The inertia at the motor over the stroke, from the top on (kg m2).
pub static INERTIA: [f64; 64] = {
    let mut table = [0.0; 64];
    let mut k = 0;
    while k < 64 {
        table[k] = PunchPress::DRIVEN.point(128 + 4 * k).inertia;
        k += 1;
    }
    table
};

/// Keys of the panel.
pub mod panel {
    /// Advise a flywheel for a permissible delta, as the bits of `f32`: answers [`DONE`], or [`NOT_YET`] where no
    /// window of strokes is finished, or [`NONE`] where no flywheel does it. The other keys refer to this flywheel.
    pub const ADVISE: u32 = 1;
    /// Mean speed (rad/s), as the bits of `f32`.
    pub const MEAN: u32 = 2;
    /// Delta by the arithmetic mean.
    pub const DELTA: u32 = 3;
    /// Swing of the kinetic energy over the stroke, with J(phi) (J).
    pub const ENERGY_SWING: u32 = 4;
    /// Inertia that is missing at the motor (kg m2).
    pub const MISSING: u32 = 5;
    /// The force of the punch at this moment (N), as the bits of `f32`.
    pub const FORCE: u32 = 6;
    /// Amplitude of a line of the mesh in the motor's angle (rad), as the bits of `f32`; 0 before the first reading.
    pub const MESH: u32 = 7;

    /// Answer: done.
    pub const DONE: u32 = 1;
    /// Answer: no data for a flywheel.
    pub const NOT_YET: u32 = 2;
    /// Answer: no flywheel suffices.
    pub const NONE: u32 = 3;
}

/// The drive of a press that is governed by a plain speed loop.
pub type PlainDrive<N> = Drive<N, observer::MechanismObserver, SpeedLoop>;
/// The drive of a press that is governed on the mean over a stroke, with the measurement of the fluctuation.
pub type MeanDrive<N> = Drive<
    N,
    observer::MechanismObserver,
    SpeedGovernor<(), (), SymmetricLimit, (), CycleAverage>,
    (CycleMean<SEGMENTS>, Waveform<BINS>),
>;

/// The drive of a press that stops at a force, with the mesh of its gear.
pub type GuardedDrive<N> = Drive<N, observer::ToolObserver, Supervised<SpeedLoop>, GearMesh<2, 9>>;

/// A plain speed loop.
pub type Plain<N> = Composed<PlainDrive<N>, FromTop>;
/// A governor on the speed without its ripple, and the measurement of the fluctuation.
pub type Mean<N> = Composed<MeanDrive<N>, Notes<N>>;
/// A plain speed loop with a guard.
pub type Guarded<N> = Composed<GuardedDrive<N>, Guard<N>>;

variants! {
    "plain": Plain for PunchPress;
    "mean": Mean for PunchPress;
    "guarded": Guarded for PunchPress;
}

/// A crank that starts at its top.
pub struct FromTop;

impl<N: Number> Beside<PlainDrive<N>> for FromTop {
    fn start(drive: &mut PlainDrive<N>, config: &ConfigOf<PlainDrive<N>>) -> Self {
        drive.observer_mut().home(&config.observer, TOP);
        FromTop
    }
}

impl<N: Summed<Real = f32>> Beside<MeanDrive<N>> for Notes<N> {
    fn start(drive: &mut MeanDrive<N>, config: &ConfigOf<MeanDrive<N>>) -> Self {
        drive.observer_mut().home(&config.observer, TOP);
        Notes { window: None, advice: None }
    }

    fn panel(
        &mut self,
        drive: &mut MeanDrive<N>,
        config: &mut &'static ConfigOf<MeanDrive<N>>,
        asked: [u32; 2],
    ) -> u32 {
        if let Some(window) = drive.fluctuation_mut().1.take() {
            self.window = Some(window);
        }
        self.answer(&config.fluctuation.1, asked)
    }
}

/// State of a press's panel: the last finished strokes, and the last flywheel.
pub struct Notes<N: Summed> {
    window: Option<Window<N, BINS>>,
    advice: Option<(f32, Flywheel)>,
}

impl<N: Summed<Real = f32>> Notes<N> {
    fn answer(&mut self, config: &WaveformConfig, asked: [u32; 2]) -> u32 {
        let [key, value] = asked;
        let told = |tell: fn(&(f32, Flywheel)) -> f64| self.advice.as_ref().map_or(0, |a| (tell(a) as f32).to_bits());
        match key {
            panel::ADVISE => self.advise(config, f64::from(f32::from_bits(value))),
            panel::MEAN => told(|(mean, _)| f64::from(*mean)),
            panel::DELTA => told(|(_, flywheel)| flywheel.delta),
            panel::ENERGY_SWING => told(|(_, flywheel)| flywheel.energy_swing),
            panel::MISSING => told(|(_, flywheel)| flywheel.missing),
            _ => 0,
        }
    }

    #[inline(never)]
    fn advise(&mut self, config: &WaveformConfig, permissible: f64) -> u32 {
        let Some(window) = &self.window else { return panel::NOT_YET };
        let Ok(ripple) = window.ripple(config, HIGHEST) else { return panel::NONE };
        // The motor's torque does not follow the speed within a stroke: the governor does not see it.
        let balance = Balance { inertia: FourierSeries::from_samples(&INERTIA), slope: 0.0 };
        self.advice = ripple.flywheel(&config.cycle, &balance, permissible).map(|flywheel| (ripple.mean, flywheel));
        if self.advice.is_some() { panel::DONE } else { panel::NONE }
    }
}

/// The force at which the press stops (N): a fourth above the rated 800 kN.
pub const LIMIT: f64 = 1e6;
/// Idle torque of bearings and gibs at the motor (N m), as the mean over a stroke without plate at rated speed has it.
const IDLE: f64 = 20.0;

/// A number in which the force is limited.
pub trait Limited: Units + 'static {
    /// The limit, judged at a quarter of the largest leverage or more.
    const LIMIT: &'static ForceLimitConfig<Self>;
}

impl Limited for f32 {
    const LIMIT: &'static ForceLimitConfig<f32> =
        &ForceLimitConfig::<f32>::new(&PunchPress::MECHANISM_OBSERVER, LIMIT, IDLE, 0.25, Bases::SI);
}

impl Limited for Fixed {
    const LIMIT: &'static ForceLimitConfig<Fixed> =
        &ForceLimitConfig::<Fixed>::new(&PunchPress::MECHANISM_OBSERVER, LIMIT, IDLE, 0.25, PunchPress::BASES);
}

/// Watches the force of the punch, and keeps the lines of the mesh.
pub struct Guard<N> {
    limit: ForceLimit<N>,
    mesh: [f32; 2],
}

impl<N: Limited> Beside<GuardedDrive<N>> for Guard<N> {
    fn start(drive: &mut GuardedDrive<N>, config: &ConfigOf<GuardedDrive<N>>) -> Self {
        drive.observer_mut().home(&config.observer, TOP);
        Guard { limit: ForceLimit::default(), mesh: [0.0; 2] }
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut GuardedDrive<N>, config: &ConfigOf<GuardedDrive<N>>, input: &Input) -> Output {
        let output = drive.advance(config, input);
        let leverage = drive.observer().leverage(&config.observer);
        if self.limit.is_exceeded(N::LIMIT, leverage, &drive.estimate(config)) {
            drive.governor_mut().stop(Faults::SHAFT_OVERLOAD);
        }
        output
    }

    fn panel(
        &mut self,
        drive: &mut GuardedDrive<N>,
        config: &mut &'static ConfigOf<GuardedDrive<N>>,
        [key, value]: [u32; 2],
    ) -> u32 {
        if let Some((line, Ok(reading))) = drive.fluctuation_mut().take(&config.fluctuation)
            && let Some(kept) = self.mesh.get_mut(line)
        {
            *kept = reading.phasor.amplitude();
        }
        match key {
            panel::FORCE => (force(drive, config) as f32).to_bits(),
            panel::MESH => self.mesh.get(value as usize).map_or(0, |amplitude| amplitude.to_bits()),
            _ => 0,
        }
    }
}

/// Force of the punch at this moment (N).
#[inline(never)]
fn force<N: Limited>(drive: &GuardedDrive<N>, config: &ConfigOf<GuardedDrive<N>>) -> f64 {
    const ACCURACY: ForceAccuracy = ForceAccuracy { idle: 1.0, relative: 0.01, angle: 1e-3 };
    let estimate = drive.estimate(config).si::<PunchPress>();
    let angle = f64::from(drive.observer().crank_angle(&config.observer)) / 4_294_967_296.0 * core::f64::consts::TAU;
    PunchPress::MECHANISM_OBSERVER.tool_force(
        angle,
        estimate.motor_speed.into(),
        f64::from(estimate.load_torque) - IDLE,
        &ACCURACY,
    )[1]
}
