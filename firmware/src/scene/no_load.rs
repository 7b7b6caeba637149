//! A drive that learns its torque offset and its inertia in a no-load run, and its torque constant by a test weight.
//!
//! *No-load run*: the motor turns both ways and changes its speed with nothing behind the shaft, a crane with an empty
//! hook or a mill with its spindles uncoupled. The panel names its beginning and its end.
//!
//! Angle and reported torque leave one factor of a drivetrain open: with all inertias, stiffnesses and torques larger
//! by it the motion is the same. So the inertia ratio, identified over described, needs no constant of the observer:
//! the reported torque over the ratio goes in, estimated torques times the ratio come out. They are as the inverter
//! reports them. A torque constant that is off by 5 % leaves 5 % of them in error, and its motion is right.
//!
//! A *test weight* closes that factor. Its inertia is known, and a second run with it finds it in units of the reported
//! torque: the torque constant is the one over the other. Both inertias are then those of the torque at the shaft.
//!
//! Speeds and the governor's gains stay as they are.

use core::marker::PhantomData;

use driveline::configure::{Machine, Units};
use driveline::drive::ConfigOf;
use driveline::learning::{Finding, RunUp, RunUpConfig, TorqueCalibration, TorqueConstant, TorqueConstantConfig};
use driveline::number::{Magnitude, Number};
use driveline::sample::{Estimate, Sample};

use super::composed::{Beside, OverWords, output, sample};
use super::{Input, Output};

/// A machine that learns in no-load runs.
pub trait NoLoadRun: Machine {
    /// Inertia that the motor accelerates without load, by the drawings (kg m2).
    const INERTIA: f64;
    /// Window of steady speed (s).
    const WINDOW: f64;
    /// Inertia ratios that may be found: motor inertia within 10 % and torque constant within 5 % of what was told,
    /// 0.9/1.05 to 1.1/0.95, and 1 % for the finding's own error.
    const RATIO: [f64; 2] = [0.85, 1.17];
    /// Inertia of a test weight at the motor (kg m2), zero without one.
    const TEST_WEIGHT: f64 = 0.0;
    /// Friction that is deducted from the reported torque before the drive has it (N m). With a test weight the drive
    /// knows by how much more or less of the reported torque that should have been.
    const FRICTION: f64 = 0.0;
}

/// Torque constants over told that may be found: within 5 %, and 2 % for the finding's own error.
const GAIN: [f64; 2] = [0.93, 1.07];

/// Keys of the panel, with a value as the bits of `f32`.
pub mod panel {
    /// A no-load run begins; zero ends it.
    pub const NO_LOAD: u32 = 1;
    /// Answers the torque's offset (N m).
    pub const OFFSET: u32 = 2;
    /// The inertia ratio.
    pub const INERTIA: u32 = 3;
    /// A run with the test weight begins, after a no-load run; zero ends it.
    pub const TEST_WEIGHT: u32 = 4;
    /// Answers the torque constant over told.
    pub const GAIN: u32 = 5;
}

/// Ticks between two updates of the learners.
const TICKS: u32 = 10;
/// A change of speed and the settling after it (s), at the most: the load is known to be none.
const PAUSE: f64 = 50.0;

/// What is behind the shaft.
#[derive(Clone, Copy, PartialEq)]
enum Behind {
    Unknown,
    Nothing,
    TestWeight,
}

/// Learners of torque offset and inertia, and what they have found.
pub struct NoLoadLearner<N: Number, M> {
    torque: TorqueConstant,
    run_up: RunUp,
    /// Of the reported torque.
    calibration: TorqueCalibration<N>,
    /// Inertia ratio times torque constant over told, less one.
    excess: N::Coefficient,
    behind: Behind,
    /// Inertia without load per reported torque (kg m2), and whether it has been found.
    inertia: f32,
    found: bool,
    /// Torque constant over told.
    gain: f32,
    /// What the torque constant adds to the friction that was deducted, in the direction of the motion.
    friction: N,
    ticks: u32,
    /// At the last update (rad/s).
    speed: f32,
    /// Of the last tick.
    reported: N,
    /// Sum over the ticks since the last update (N m).
    sum: f32,
    /// Whether the drive has been held since the last update.
    held: bool,
    machine: PhantomData<M>,
}

impl<N: Units<Coefficient: Magnitude>, M: NoLoadRun> NoLoadLearner<N, M> {
    const EVERY: f64 = TICKS as f64 / M::RATE_HZ as f64;
    /// Without load the gear's efficiency has no part.
    const TORQUE: TorqueConstantConfig = TorqueConstantConfig {
        window: (M::WINDOW / Self::EVERY) as u32,
        pause: (PAUSE / Self::EVERY) as u32,
        ..TorqueConstantConfig::new(M::RATING.torque.0, M::RATING.speed.0, [0.5, 1.0], Self::EVERY)
    };
    const RUN_UP: RunUpConfig = RunUpConfig {
        window: (M::WINDOW / Self::EVERY) as u32,
        pause: (PAUSE / Self::EVERY) as u32,
        ..RunUpConfig::new(
            M::RATING.torque.0,
            M::RATING.speed.0,
            [M::RATIO[0] * M::INERTIA, M::RATIO[1] * M::INERTIA],
            Self::EVERY,
        )
    };

    /// From the lightest machine with the smallest weight to the heaviest with the largest, per reported torque. The
    /// weight swings, and is damped. So a window has two periods, and drifts by at most 0.4 % of rated torque: of the
    /// windows and bounds tried, the torque constant was found with the least error, 0.4 % rms.
    const TESTED: RunUpConfig = RunUpConfig {
        range: [
            (M::RATIO[0] * M::INERTIA + M::TEST_WEIGHT / GAIN[1]) as f32,
            (M::RATIO[1] * M::INERTIA + M::TEST_WEIGHT / GAIN[0]) as f32,
        ],
        window: (2.0 * core::f64::consts::TAU / M::TWO_MASS.resonance() / Self::EVERY) as u32,
        torque: 0.4 * M::RATING.torque.0 as f32,
        ..Self::RUN_UP
    };

    fn ratio(&self) -> f32 {
        self.inertia * const { (1.0 / M::INERTIA) as f32 }
    }

    /// Names what is behind the shaft from now on. A test weight counts after a no-load run that has found something.
    fn begin(&mut self, behind: Behind) {
        self.behind = if behind == Behind::TestWeight && !self.found { Behind::Unknown } else { behind };
        self.torque.set_load((self.behind == Behind::Nothing).then_some(0.0));
        self.run_up = RunUp::new(const { &Self::RUN_UP }, self.inertia);
    }

    /// Takes the mean torque since the last update. A loop that creeps into its setpoint accelerates the inertia all
    /// the while, which is no offset.
    fn learn(&mut self, speed: f32) {
        let change = speed - core::mem::replace(&mut self.speed, speed);
        let reported = core::mem::take(&mut self.sum) * const { 1.0 / TICKS as f32 };
        if M::FRICTION > 0.0 {
            let friction = const { M::FRICTION as f32 }.copysign(speed);
            self.friction = N::from_torque::<M>((self.gain - 1.0) * friction);
        }
        if core::mem::take(&mut self.held) {
            self.torque.interrupt();
            self.run_up.interrupt();
            return;
        }
        match self.behind {
            Behind::Unknown => return,
            Behind::Nothing => {
                let accelerating = self.inertia * change * const { (1.0 / Self::EVERY) as f32 };
                self.torque.update(const { &Self::TORQUE }, reported - accelerating, speed);
                if self.run_up.update(const { &Self::RUN_UP }, reported, speed) == Finding::Changed {
                    (self.inertia, self.found) = (self.run_up.inertia(), true);
                }
                let inverse = 1.0 / self.ratio();
                let offset = N::from_torque::<M>(inverse * self.torque.offset());
                self.calibration = TorqueCalibration::new(inverse, offset);
            }
            Behind::TestWeight => {
                if self.run_up.update(const { &Self::TESTED }, reported, speed) == Finding::Changed {
                    let gain = const { M::TEST_WEIGHT as f32 } / (self.run_up.inertia() - self.inertia);
                    if gain >= const { GAIN[0] as f32 } && gain <= const { GAIN[1] as f32 } {
                        self.gain = gain;
                    }
                }
            }
        }
        self.excess = Magnitude::of(self.ratio() * self.gain - 1.0);
    }
}

impl<N, M, D> Beside<D> for NoLoadLearner<N, M>
where
    N: Units<Coefficient: Magnitude>,
    M: NoLoadRun,
    D: OverWords<Number = N>,
{
    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {
        NoLoadLearner {
            torque: TorqueConstant::new(const { &Self::TORQUE }, 1.0, 0.0),
            run_up: RunUp::new(const { &Self::RUN_UP }, M::INERTIA as f32),
            calibration: TorqueCalibration::new(1.0, N::ZERO),
            excess: N::Coefficient::default(),
            behind: Behind::Unknown,
            inertia: M::INERTIA as f32,
            found: false,
            gain: 1.0,
            friction: N::ZERO,
            ticks: 0,
            speed: 0.0,
            reported: N::ZERO,
            sum: 0.0,
            held: true,
            machine: PhantomData,
        }
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        if input.flags & Input::RELEASED == 0 {
            self.held = true;
            return drive.advance(config, input);
        }
        let sample: Sample<N> = sample(input);
        self.reported = sample.torque;
        let torque = self.calibration.torque(sample.torque);
        let command = drive.tick(config, &Sample { torque, ..sample });
        let estimate = drive.estimate(config);
        let scaled = |torque: N| {
            let scaled = torque + torque.times(self.excess);
            if M::FRICTION > 0.0 { scaled + self.friction } else { scaled }
        };
        let (shaft_torque, load_torque) = (scaled(estimate.shaft_torque), scaled(estimate.load_torque));
        output(&command, &Estimate { shaft_torque, load_torque, ..estimate })
    }

    #[inline]
    fn panel(&mut self, drive: &mut D, config: &mut &'static ConfigOf<D>, [key, value]: [u32; 2]) -> u32 {
        self.ticks = self.ticks.wrapping_add(1);
        if self.behind != Behind::Unknown {
            self.sum += self.reported.to_torque::<M>();
        }
        if self.ticks.is_multiple_of(TICKS) {
            self.learn(drive.estimate(config).motor_speed.to_speed::<M>());
        }
        let on = f32::from_bits(value) != 0.0;
        match key {
            panel::NO_LOAD => self.begin(if on { Behind::Nothing } else { Behind::Unknown }),
            panel::TEST_WEIGHT if M::TEST_WEIGHT > 0.0 => {
                self.begin(if on { Behind::TestWeight } else { Behind::Unknown });
            }
            panel::OFFSET => return self.torque.offset().to_bits(),
            panel::INERTIA => return self.ratio().to_bits(),
            panel::GAIN => return self.gain.to_bits(),
            _ => {}
        }
        0
    }

    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<Self> {
        Some(NoLoadLearner { ..*self })
    }
}
