//! An eccentric punch press: 800 kN at 69 strokes a minute, a flywheel on the motor's shaft, crank and slider behind a gear of 14.
//!
//! An 18.5 kW, six-pole motor at 970 r/min (182 N m; makers' tables give 0.3 kg m2 for frame size 200) carries a flywheel of 4.5 kg m2 (0.62 m
//! by 40 mm of steel). Gear wheel and crank disc have 40 kg m2, the eccentric shaft of 0.16 m by 0.32 m has 16 MN m/rad (G pi d^4/(32 l)
//! [Wang 1989 (1-16)]); the crank has a radius of 80 mm, the rod 0.7 m, slider and upper die 2.5 t. A stroke blanks thick plate by a die with
//! shear, over 40 degrees before the bottom, and takes some 9 kJ of the 26 kJ that the flywheel holds. The figures are of the size of a C-frame
//! press of 80 t; they are not those of one machine.
//!
//! The slider's mass makes the inertia at the motor swing: the observer has it as J(phi), by a table of constants. The crank's angle is
//! known from its top: the press starts there. The motor's encoder has 2048 sine periods on a turn, each interpolated to 64 counts, as
//! drives of this kind have it.
//!
//! | variant | governs | measures |
//! |---|---|---|
//! | `plain` | by a plain speed loop, which fights the ripple | nothing |
//! | `mean` | on the speed without its ripple, so that the flywheel does the stroke's work | the fluctuation over the stroke; advises a flywheel |

use core::marker::PhantomData;

use driveline::design::{
    Actuator, CrankedDesign, Disturbance, Encoder, GovernorDesign, LoadFeedForward, Rate, SpeedLoopDesign,
    SpeedLoopTuning,
};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::fluctuation::{
    Balance, CycleConfig, CycleMean, CycleMeanConfig, Fluctuation, Flywheel, Ripple, Series, Summed, Waveform,
    WaveformConfig, Window,
};
use driveline::governor::{
    CycleAverage, Gains, Governor, SpeedGovernor, SpeedGovernorConfig, SpeedLoop, SpeedLoopConfig, SymmetricLimit,
    SymmetricLimitConfig,
};
use driveline::machine::{
    Chain, CrankSlider, Cranked, Damping, Efficiency, Inertia, Length, Mass, Match, Ratio, Stiffness, TwoMass,
};
use driveline::number::{Fixed, Number};
use driveline::observer::{self, CrankConfig};
use driveline::settings::{Bases, Cycle, Screening, SpeedLoopSettings};

use crate::scene::governed::advance;
use crate::scene::{Input, Output, Scene};

/// Turns of the motor to one of the crank.
pub const RATIO: u32 = 14;

/// Inertia of motor and flywheel \[kg m2\].
pub const FLYWHEEL: f64 = 0.3 + 4.5;

/// Crank, rod and slider, on the crank's shaft.
pub const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.08), Length(0.7), Inertia(40.0), Mass(2_500.0));

/// The machine as the observer has it.
pub const MACHINE: Cranked = Cranked::new(Inertia(FLYWHEEL), &RAM, 1, RATIO);

/// The machine with its shaft and the crank drive's mean inertia, for the governors.
pub const CHAIN: Chain = Chain::motor(Inertia(FLYWHEEL))
    .gear(Ratio(RATIO as f64), Efficiency(1.0))
    .shaft(Stiffness(1.6e7), Damping(2_100.0))
    .rotor(RAM.mean_inertia());

/// The same referred to the motor.
pub const REDUCED: TwoMass = CHAIN.reduce(Match::TextbookCut(0));

/// Rated speed of the motor [rad/s]: 69 strokes a minute.
pub const RATED_SPEED: f64 = 101.6;

/// Rated torque of the motor [N m].
pub const RATED_TORQUE: f64 = 182.0;

/// Largest torque of the motor [N m].
pub const TORQUE_LIMIT: f64 = 364.0;

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;

/// Time between two ticks \[s\].
pub const PERIOD: f64 = 1.0 / RATE_HZ as f64;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 2048 * 64;

/// The punch comes and goes within hundredths of a second: of what was tried, the least error in the shaft's torque. A quicker observer is noisy.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 1_000.0, within: 3.0 };

/// The observer.
pub const OBSERVER: CrankedDesign = MACHINE.observer(Rate::hz(RATE_HZ), Encoder::counts(COUNTS), DISTURBANCE);

/// A speed loop as any other drive has it: three hundredths of the antiresonance, 3 Hz.
pub const LOOP: SpeedLoopDesign = SpeedLoopDesign {
    damping: 0.0,
    ..REDUCED.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.03, damping: 1.0, shaft_damping: 0.04 })
};

/// The governor: rated speed in two seconds.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 2.0 };

/// Bases of fixed point: the shaft carries five times the motor's largest torque, and the observer's gains want a base of this size.
pub const BASES: Bases = Bases::rigid(10_000.0, 1.34 * RATED_SPEED);

/// Plausibility limits of a sample. In 25 ms the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 128.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 40,
};

/// Where the crank is when the press is switched on: at its top, half a turn from the outer dead centre [2^-32 turn].
pub const TOP: u32 = 1 << 31;

/// A stroke: a turn of the crank.
pub const STROKE: Cycle = Cycle { turns: RATIO, cycles: 1 };

/// The longest stroke that the press is governed in by its mean \[s\]: at four fifths of rated speed.
pub const LONGEST_STROKE: f64 = core::f64::consts::TAU * RATIO as f64 / (0.8 * RATED_SPEED);

/// The governor on the speed without its ripple. That is renewed from a whole stroke: a gain of 1.5 J over the stroke's time crosses over at 1.5/T,
/// where `(1 - e^-sT)(1/sT + 1/2)` has lost little, and the integral takes three strokes. `tests/governor` has the loop's margin.
pub const OVER_STROKE: GovernorDesign = REDUCED.governor(
    Rate::hz(RATE_HZ),
    Actuator { delay: 0.0, lag: LONGEST_STROKE / 6.75 },
    4.5,
    LoadFeedForward::NONE,
);

/// Segments of the stroke, at whose ends the mean is renewed.
pub const SEGMENTS: usize = 64;

/// Bins of the waveform.
pub const BINS: usize = 128;

/// Strokes in a window of the waveform.
pub const STROKES: u32 = 4;

/// Highest order of the waveform: a punch over a ninth of the stroke has orders beyond, which are a thousandth of delta.
pub const HIGHEST: usize = 16;

/// The inertia at the motor over the stroke, from the top on \[kg m2\].
pub static INERTIA: [f64; 64] = {
    let mut table = [0.0; 64];
    let mut k = 0;
    while k < 64 {
        table[k] = MACHINE.inertia((0.5 + k as f64 / 64.0) * core::f64::consts::TAU).inertia;
        k += 1;
    }
    table
};

/// What the press is tried with.
pub mod with {
    /// A plain speed loop.
    pub struct Plain;
    /// A governor on the speed without its ripple, and the measurement of the fluctuation.
    pub struct Mean;
}

/// Keys of the panel.
pub mod panel {
    /// Advise a flywheel for a permissible delta, as the bits of `f32`: answers [`DONE`], or [`NOT_YET`] where no window of strokes is
    /// finished, or [`NONE`] where no flywheel does it. The other keys answer for this advice.
    pub const ADVISE: u32 = 1;
    /// Mean speed [rad/s], as the bits of `f32`.
    pub const MEAN: u32 = 2;
    /// Delta by the arithmetic mean.
    pub const DELTA: u32 = 3;
    /// Swing of the kinetic energy over the stroke, with J(phi) \[J\].
    pub const ENERGY_SWING: u32 = 4;
    /// Inertia that is missing at the motor \[kg m2\].
    pub const MISSING: u32 = 5;

    /// Answer: done.
    pub const DONE: u32 = 1;
    /// Answer: there is nothing to advise from.
    pub const NOT_YET: u32 = 2;
    /// Answer: no flywheel does it.
    pub const NONE: u32 = 3;
}

/// The parts and constants of one variant of the press.
pub trait Variant: Sized + 'static {
    /// What it calculates with.
    type Number: Number + 'static;
    /// What it measures with.
    type Fluctuation: Fluctuation<Self::Number, Config: 'static>;
    /// What it governs with.
    type Governor: Governor<Self::Number, Config: 'static>;
    /// What its panel keeps.
    type Notes: Default;
    /// Scene, number, variant and rate.
    const NAME: &'static str;
    /// The drive's constants.
    const CONFIG: &'static Constants<Self>;
    /// What the panel does between two ticks.
    fn panel(_drive: &mut PressDrive<Self>, _notes: &mut Self::Notes, _asked: [u32; 2]) -> u32 {
        0
    }
}

/// The constants of a variant.
pub type Constants<V> = ConfigOf<PressDrive<V>>;

/// The drive of a variant.
pub type PressDrive<V> = Drive<
    <V as Variant>::Number,
    observer::CrankObserver<<V as Variant>::Number>,
    <V as Variant>::Fluctuation,
    <V as Variant>::Governor,
>;

/// The press with a number and what it is tried with.
pub struct Of<N, W>(PhantomData<(N, W)>);

/// The press: its drive with its constants.
///
/// While the governor is not released, [`Input::reference`] is the torque that the drive holds.
pub struct PunchPress<V: Variant> {
    // By reference: folded into the code, the constants cost more instructions than loaded from a table.
    config: &'static Constants<V>,
    drive: PressDrive<V>,
    notes: V::Notes,
}

impl<V: Variant> Scene for PunchPress<V> {
    const NAME: &'static str = V::NAME;
    const RATE_HZ: u32 = RATE_HZ;

    fn new() -> Self {
        let mut drive: PressDrive<V> = Drive::new(V::CONFIG, 0);
        drive.observer_mut().home(&V::CONFIG.observer, TOP);
        PunchPress { config: V::CONFIG, drive, notes: V::Notes::default() }
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        advance(&mut self.drive, self.config, input)
    }

    fn panel(&mut self, asked: [u32; 2]) -> u32 {
        V::panel(&mut self.drive, &mut self.notes, asked)
    }
}

/// What the panel of a press knows: the strokes that were finished last, and the last advice.
pub struct Notes<N: Summed> {
    window: Option<Window<N, BINS>>,
    advice: Option<(Ripple, Flywheel)>,
}

impl<N: Summed> Default for Notes<N> {
    fn default() -> Self {
        Notes { window: None, advice: None }
    }
}

impl<N: Summed> Notes<N> {
    fn answer(&mut self, config: &WaveformConfig, asked: [u32; 2]) -> u32 {
        let [key, value] = asked;
        let told =
            |tell: fn(&(Ripple, Flywheel)) -> f64| self.advice.as_ref().map_or(0, |a| (tell(a) as f32).to_bits());
        match key {
            panel::ADVISE => self.advise(config, f64::from(f32::from_bits(value))),
            panel::MEAN => told(|(ripple, _)| ripple.mean),
            panel::DELTA => told(|(_, flywheel)| flywheel.delta),
            panel::ENERGY_SWING => told(|(_, flywheel)| flywheel.energy_swing),
            panel::MISSING => told(|(_, flywheel)| flywheel.missing),
            _ => 0,
        }
    }

    fn advise(&mut self, config: &WaveformConfig, permissible: f64) -> u32 {
        let Some(window) = &self.window else { return panel::NOT_YET };
        let ripple = window.ripple(config, HIGHEST);
        // The motor's torque does not follow the speed within a stroke: the governor does not see it.
        let balance = Balance { inertia: Series::from_samples(&INERTIA), slope: 0.0 };
        self.advice = ripple.flywheel(&config.cycle, &balance, permissible).map(|flywheel| (ripple, flywheel));
        if self.advice.is_some() { panel::DONE } else { panel::NONE }
    }
}

/// What the `mean` variant measures with.
pub type Measured<N> = (CycleMean<N, SEGMENTS>, Waveform<N, BINS>);

/// What it governs with.
pub type OnMean<N> = SpeedGovernor<N, (), (), SymmetricLimit, (), CycleAverage<N>>;

macro_rules! variants {
    ($number:ident, $text:literal, $bases:expr) => {
        impl Variant for Of<$number, with::Plain> {
            type Number = $number;
            type Fluctuation = ();
            type Governor = SpeedLoop<$number>;
            type Notes = ();
            const NAME: &'static str = concat!("punch-press/", $text, "/plain/10000");
            const CONFIG: &'static Constants<Self> = &Config {
                limits: Limits::<$number>::new(&SCREENING, $bases),
                observer: CrankConfig::<$number>::new(&OBSERVER, $bases),
                fluctuation: (),
                governor: SpeedLoopConfig::<$number>::new(&LOOP, SETTINGS, $bases),
                balancer: (),
            };
        }

        impl Variant for Of<$number, with::Mean> {
            type Number = $number;
            type Fluctuation = Measured<$number>;
            type Governor = OnMean<$number>;
            type Notes = Notes<$number>;
            const NAME: &'static str = concat!("punch-press/", $text, "/mean/10000");
            const CONFIG: &'static Constants<Self> = &Config {
                limits: Limits::<$number>::new(&SCREENING, $bases),
                observer: CrankConfig::<$number>::new(&OBSERVER, $bases),
                fluctuation: (
                    CycleMeanConfig::<$number>::new::<SEGMENTS>(STROKE, PERIOD, $bases),
                    WaveformConfig::new::<BINS>(CycleConfig::new(STROKE, PERIOD, $bases), STROKES),
                ),
                governor: SpeedGovernorConfig {
                    gains: Gains::<$number>::new(&OVER_STROKE, SETTINGS.ramp, $bases),
                    shape: (),
                    compensation: (),
                    limit: SymmetricLimitConfig::<$number>::new(TORQUE_LIMIT, $bases),
                    sequence: (),
                    filter: (),
                },
                balancer: (),
            };

            fn panel(drive: &mut PressDrive<Self>, notes: &mut Self::Notes, asked: [u32; 2]) -> u32 {
                if let Some(window) = drive.fluctuation_mut().1.take() {
                    notes.window = Some(window);
                }
                notes.answer(&Self::CONFIG.fluctuation.1, asked)
            }
        }
    };
}

variants!(f32, "f32", Bases::SI);
variants!(Fixed, "fixed", BASES);
