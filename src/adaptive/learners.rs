//! The learners of a drive: losses, torque constant and offset, inertia, eccentricity.

use super::{Adjust, HasEccentricity, STEPS, Scheduling, ticks_of_step};
use crate::configure::{Machine, Units};
use crate::drive::{Composition, ConfigOf, ObserverConfigOf};
use crate::learning::{
    EccentricityConfig, GearLoss, GearLossConfig, LearningBounds, Learnt, RunUp, RunUpConfig, TorqueCalibration,
    TorqueConstant, TorqueConstantConfig,
};
use crate::machine::STANDARD_GRAVITY;
use crate::number::{Magnitude, Number};
use crate::sample::Estimate;

/// Learners of the gear's friction and the encoder's eccentricity, and under named loads of the torque constant, the
/// torque's offset and the motor's inertia: the last slot of an [`Adaptive`](super::Adaptive) drive.
///
/// ```
#[doc = include_str!("crane.txt")]
/// type CraneDrive = Adaptive<Crane, Inner, (), Learners>;
/// static CONFIG: ConfigOf<CraneDrive> = CraneDrive::configure();
/// let mut drive = CraneDrive::new(&CONFIG, 0);
/// // it begins with the data sheet: a gear behind the shaft has no friction before it, the motor is the described one
/// let sheet = drive.learnt();
/// assert_eq!((sheet.torque, sheet.inertia), ([0.0, 0.0], 0.0));
/// // from before the restart: a motor that is 5 % heavier
/// drive.restore(&CONFIG, &driveline::learning::Learnt { inertia: 0.05, ..sheet });
/// assert!((drive.learnt().inertia - 0.05).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Learners;

/// State of [`Learners`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearnersState<N: Units> {
    calibration: TorqueCalibration<N>,
    /// Torque of the last tick, as reported.
    reported: N,
    loss: GearLoss,
    torque: TorqueConstant,
    run_up: RunUp,
    /// The named load (kg).
    load: Option<f32>,
    /// Motor's inertia over that of the design.
    motor: f32,
    /// At the last step (rad/s).
    speed: f32,
}

/// Learners of a drive `D` of the machine `M`: the state of the last slot of an [`Adaptive`](super::Adaptive) drive.
/// Without learners, `()`, nothing of it is left.
pub trait Learning<M: Machine, D: Composition>: Sized {
    /// The learners at the values of the design.
    fn start() -> Self;
    /// The torque at the shaft, from the reported one of a tick.
    fn calibrated(&mut self, reported: D::Number) -> D::Number;
    /// The load is named (kg), or no longer.
    fn set_load(&mut self, load: Option<f32>);
    /// A step, so many hundredths of a second after the last one; `interrupted` where the ticks between do not hang
    /// together.
    fn learn(&mut self, elapsed: f32, interrupted: bool, estimate: &Estimate<f32>);
    /// As [`EccentricityObserver::learn`](crate::learning::EccentricityObserver::learn).
    fn learn_eccentricity<S: Scheduling<M, D>>(&mut self, observer: &mut D::Observer, speed: f32);
    /// Changes the constants of the design to what has been learnt.
    fn adjust(&self, next: &mut ConfigOf<D>);
    /// What has been learnt.
    fn learnt(&self, drive: &D) -> Learnt;
    /// Takes what was learnt before.
    fn restore<S: Scheduling<M, D>>(&mut self, drive: &mut D, learnt: &Learnt);
}

impl<M: Machine, D: Composition> Learning<M, D> for () {
    fn start() -> Self {}
    #[inline(always)]
    fn calibrated(&mut self, reported: D::Number) -> D::Number {
        reported
    }
    fn set_load(&mut self, _: Option<f32>) {}
    fn learn(&mut self, _: f32, _: bool, _: &Estimate<f32>) {}
    fn learn_eccentricity<S: Scheduling<M, D>>(&mut self, _: &mut D::Observer, _: f32) {}
    fn adjust(&self, _: &mut ConfigOf<D>) {}
    fn learnt(&self, _: &D) -> Learnt {
        Learnt::default()
    }
    fn restore<S: Scheduling<M, D>>(&mut self, _: &mut D, _: &Learnt) {}
}

/// Constants of a machine's learners.
trait Constants: Machine {
    /// Time between two steps (s).
    const EVERY: f64 = ticks_of_step(Self::RATE_HZ) as f64 * Self::PERIOD;
    const LOSS: GearLossConfig =
        GearLossConfig::new(Self::RATING.torque.0, Self::RATING.speed.0, Self::LEARNING.efficiency, Self::EVERY);
    const TORQUE: TorqueConstantConfig =
        TorqueConstantConfig::new(Self::RATING.torque.0, Self::RATING.speed.0, Self::LEARNING.efficiency, Self::EVERY);
    /// Inertia before the shaft by the design (kg m2).
    const MOTOR: f64 = Self::TWO_MASS.motor_inertia;
    /// From an empty hook behind the lightest motor to twice the load behind the heaviest.
    const RUN_UP: RunUpConfig = {
        let [least, most] = Self::LEARNING.motor_inertia;
        let range = [0.9 * least * Self::MOTOR, most * Self::MOTOR + 2.0 * Self::TWO_MASS.load_inertia];
        RunUpConfig::new(Self::RATING.torque.0, Self::RATING.speed.0, range, Self::EVERY)
    };
    /// Inertia and weight of a load at the motor (kg m2/kg, N m/kg).
    const PER_LOAD: [f32; 2] = {
        let travel = Self::CHAIN.travel_per_angle();
        [(travel * travel) as f32, (STANDARD_GRAVITY * travel) as f32]
    };
}

impl<M: Machine> Constants for M {}

/// Blocks of 0.4 s: ten turns at the rated speed of a motor of four poles.
const fn eccentricity_of<M: Machine, D: Composition, S: Scheduling<M, D>>() -> EccentricityConfig {
    EccentricityConfig::of_placed(&S::OBSERVER, M::LEARNING.eccentricity, 0.4)
}

impl<M, D> Learning<M, D> for LearnersState<D::Number>
where
    M: Machine,
    D: Composition<Number: Units<Coefficient: Magnitude>, Observer: HasEccentricity>,
    ObserverConfigOf<D>: Adjust,
{
    fn start() -> Self {
        let friction = const { M::GEAR.friction() as f32 };
        LearnersState {
            calibration: TorqueCalibration::new(1.0, D::Number::ZERO),
            reported: D::Number::ZERO,
            loss: GearLoss::new(const { &<M as Constants>::LOSS }, friction),
            torque: TorqueConstant::new(const { &<M as Constants>::TORQUE }, 1.0, 0.0),
            run_up: RunUp::new(const { &<M as Constants>::RUN_UP }, const { M::MOTOR as f32 }),
            load: None,
            motor: 1.0,
            speed: 0.0,
        }
    }

    #[inline(always)]
    fn calibrated(&mut self, reported: D::Number) -> D::Number {
        self.reported = reported;
        self.calibration.torque(reported)
    }

    /// Without a drum a load has no weight and no inertia at the motor, and nothing is learnt under it.
    fn set_load(&mut self, load: Option<f32>) {
        self.load = load.filter(|_| const { M::PER_LOAD[0] > 0.0 });
        self.torque.set_load(self.load.map(|load| load * const { M::PER_LOAD[1] }));
        self.run_up.restart();
    }

    /// A loop that creeps into its setpoint accelerates motor and load all the while, which is no part of the load
    /// torque.
    fn learn(&mut self, elapsed: f32, interrupted: bool, estimate: &Estimate<f32>) {
        let speed = estimate.motor_speed;
        let change = speed - core::mem::replace(&mut self.speed, speed);
        if interrupted {
            self.loss.interrupt();
            self.torque.interrupt();
            self.run_up.interrupt();
            return;
        }
        let reported = self.reported.to_torque::<M>();
        let load = self.load.map_or(0.0, |load| load * const { M::PER_LOAD[0] });
        let acceleration = change * const { (1.0 / M::EVERY) as f32 } / elapsed;
        let accelerating = (self.motor * const { M::MOTOR as f32 } + load) * acceleration;
        self.torque.update_after(const { &<M as Constants>::TORQUE }, elapsed, reported - accelerating, speed);
        let torque = self.torque.gain() * reported + self.torque.offset();
        self.loss.update_after(const { &<M as Constants>::LOSS }, elapsed, torque, speed);
        if self.load.is_some() {
            let friction = (self.loss.friction() * estimate.shaft_torque.abs()).copysign(speed);
            self.run_up.update_after(const { &<M as Constants>::RUN_UP }, elapsed, torque - friction, speed);
            let motor = (self.run_up.inertia() - load) * const { (1.0 / M::MOTOR) as f32 };
            if self.run_up.is_learnt() && LearningBounds::holds(M::LEARNING.motor_inertia, motor) {
                self.motor = motor;
            }
        }
        self.calibrate::<M>();
    }

    fn learn_eccentricity<S: Scheduling<M, D>>(&mut self, observer: &mut D::Observer, speed: f32) {
        observer.learn_eccentricity(const { &eccentricity_of::<M, D, S>() }, speed);
    }

    fn adjust(&self, next: &mut ConfigOf<D>) {
        let (observer, _) = D::parts(next);
        observer.set_friction(self.loss.friction());
        observer.scale_motor_inertia(self.motor);
    }

    fn learnt(&self, drive: &D) -> Learnt {
        Learnt {
            friction: self.loss.friction(),
            eccentricity: drive.observer().learnt_eccentricity(),
            torque: [self.torque.gain() - 1.0, self.torque.offset()],
            inertia: self.motor - 1.0,
        }
    }

    fn restore<S: Scheduling<M, D>>(&mut self, drive: &mut D, learnt: &Learnt) {
        *self = <Self as Learning<M, D>>::start();
        let Learnt { friction, eccentricity, torque: [excess, offset], inertia } = *learnt;
        // no gear is without friction: a record that was never written
        if friction > 0.0 {
            self.loss = GearLoss::new(const { &<M as Constants>::LOSS }, friction);
        }
        self.torque = TorqueConstant::new(const { &<M as Constants>::TORQUE }, 1.0 + excess, offset);
        if LearningBounds::holds(M::LEARNING.motor_inertia, 1.0 + inertia) {
            self.motor = 1.0 + inertia;
        }
        drive.observer_mut().restore_eccentricity(const { &eccentricity_of::<M, D, S>() }, eccentricity);
        self.calibrate::<M>();
    }
}

impl<N: Units<Coefficient: Magnitude>> LearnersState<N> {
    fn calibrate<M: Machine>(&mut self) {
        self.calibration = TorqueCalibration::new(self.torque.gain(), N::from_torque::<M>(self.torque.offset()));
    }
}

const _: () = assert!(STEPS == 100, "the learners' windows are tuned for a hundred steps a second");
