//! A drive that learns its torque offset and its inertia in a no-load run.
//!
//! *No-load run*: the motor turns both ways and changes its speed with nothing behind the shaft, a crane with an empty
//! hook or a mill with its spindles uncoupled. The panel names its beginning and its end.
//!
//! Angle and reported torque leave one factor of a drivetrain open: with all inertias, stiffnesses and torques larger
//! by it the motion is the same. So the inertia ratio, found over told, needs no constant of the observer: the reported
//! torque over the ratio goes in, estimated torques times the ratio come out. They are torques as the inverter reports
//! them. A torque constant that is off by 5 % leaves 5 % of them in error, and its motion is right.
//!
//! Speeds and the governor's gains stay as they are.

use core::marker::PhantomData;

use driveline::configure::{Machine, Units};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::Governor;
use driveline::learning::{RunUp, RunUpConfig, TorqueCalibration, TorqueConstant, TorqueConstantConfig};
use driveline::number::{Magnitude, Number};
use driveline::observer::Observer;
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
}

/// Keys of the panel, with a value as the bits of `f32`.
pub mod panel {
    /// A no-load run begins; zero ends it.
    pub const NO_LOAD: u32 = 1;
    /// Answers the torque's offset (N m).
    pub const OFFSET: u32 = 2;
    /// The inertia ratio.
    pub const INERTIA: u32 = 3;
}

/// Ticks between two updates of the learners.
const TICKS: u32 = 10;
/// A change of speed and the settling after it (s), at the most: the load is known to be none.
const PAUSE: f64 = 50.0;
/// Learners of torque offset and inertia, and what they have found.
pub struct NoLoadLearner<N: Number, M> {
    torque: TorqueConstant,
    run_up: RunUp,
    /// Of the reported torque.
    calibration: TorqueCalibration<N>,
    /// Inertia ratio less one.
    excess: N::Coefficient,
    no_load: bool,
    ticks: u32,
    /// At the last update (rad/s).
    speed: f32,
    /// Of the last tick.
    reported: N,
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
        ..TorqueConstantConfig::new(M::RATING.torque, M::RATING.speed, [0.5, 1.0], Self::EVERY)
    };
    const RUN_UP: RunUpConfig = RunUpConfig {
        window: (M::WINDOW / Self::EVERY) as u32,
        pause: (PAUSE / Self::EVERY) as u32,
        ..RunUpConfig::new(
            M::RATING.torque,
            M::RATING.speed,
            [M::RATIO[0] * M::INERTIA, M::RATIO[1] * M::INERTIA],
            Self::EVERY,
        )
    };

    fn ratio(&self) -> f32 {
        self.run_up.inertia() * const { (1.0 / M::INERTIA) as f32 }
    }

    /// Takes the torque of the last tick. A loop that creeps into its setpoint accelerates the inertia all the while,
    /// which is no offset.
    fn learn(&mut self, speed: f32) {
        let change = speed - core::mem::replace(&mut self.speed, speed);
        if core::mem::take(&mut self.held) {
            self.torque.interrupt();
            self.run_up.interrupt();
        } else if self.no_load {
            let reported = self.reported.to_torque::<M>();
            let accelerating = self.run_up.inertia() * change * const { (1.0 / Self::EVERY) as f32 };
            self.torque.update(const { &Self::TORQUE }, reported - accelerating, speed);
            self.run_up.update(const { &Self::RUN_UP }, reported, speed);
            let inverse = 1.0 / self.ratio();
            let offset = N::from_torque::<M>(inverse * self.torque.offset());
            self.calibration = TorqueCalibration::new(inverse, offset);
            self.excess = Magnitude::of(self.ratio() - 1.0);
        }
    }
}

impl<N, M, O, G> Beside<Drive<N, O, (), G>> for NoLoadLearner<N, M>
where
    N: Units<Coefficient: Magnitude>,
    M: NoLoadRun,
    O: Observer<N>,
    G: Governor<N>,
{
    fn start(_: &mut Drive<N, O, (), G>, _: &ConfigOf<Drive<N, O, (), G>>) -> Self {
        NoLoadLearner {
            torque: TorqueConstant::new(const { &Self::TORQUE }, 1.0, 0.0),
            run_up: RunUp::new(const { &Self::RUN_UP }, M::INERTIA as f32),
            calibration: TorqueCalibration::new(1.0, N::ZERO),
            excess: N::Coefficient::default(),
            no_load: false,
            ticks: 0,
            speed: 0.0,
            reported: N::ZERO,
            held: true,
            machine: PhantomData,
        }
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut Drive<N, O, (), G>, config: &ConfigOf<Drive<N, O, (), G>>, input: &Input) -> Output {
        if input.flags & Input::RELEASED == 0 {
            self.held = true;
            return drive.advance(config, input);
        }
        let sample: Sample<N> = sample(input);
        self.reported = sample.torque;
        let torque = self.calibration.torque(sample.torque);
        let command = drive.tick(config, &Sample { torque, ..sample });
        let estimate = drive.estimate(config);
        let scaled = |torque: N| torque + torque.times(self.excess);
        let (shaft_torque, load_torque) = (scaled(estimate.shaft_torque), scaled(estimate.load_torque));
        output(&command, &Estimate { shaft_torque, load_torque, ..estimate })
    }

    #[inline]
    fn panel(
        &mut self,
        drive: &mut Drive<N, O, (), G>,
        config: &mut &'static ConfigOf<Drive<N, O, (), G>>,
        [key, value]: [u32; 2],
    ) -> u32 {
        self.ticks = self.ticks.wrapping_add(1);
        if self.ticks.is_multiple_of(TICKS) {
            self.learn(drive.estimate(config).motor_speed.to_speed::<M>());
        }
        match key {
            panel::NO_LOAD => {
                self.no_load = f32::from_bits(value) != 0.0;
                self.torque.set_load(self.no_load.then_some(0.0));
                self.run_up.restart();
            }
            panel::OFFSET => return self.torque.offset().to_bits(),
            panel::INERTIA => return self.ratio().to_bits(),
            _ => {}
        }
        0
    }

    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<Self> {
        Some(NoLoadLearner { ..*self })
    }
}
