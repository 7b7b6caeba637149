//! The steps under test: the library's own observers, run open loop.

use driveline::design::{StepChoice, TwoMassDesign};
use driveline::number::Fixed;
use driveline::observer::{Observer, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver};
use driveline::settings::{Bases, Error};

use super::number::{KICK, Swept};

/// The increments of two states per tick, from those states: `x += N x`.
pub type Increments = [[f64; 2]; 2];

/// Initial state of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// A load torque (N m), from the next tick on.
    LoadTorque(f64),
    /// A shaft torque (N m) of a twisted shaft, and free motion from then on.
    ShaftTorque(f64),
}

/// An observer of two masses that a sweep can run.
pub trait Step<N: Swept>: Observer<N> + Copy {
    /// Name in the report.
    const NAME: &'static str;

    /// The constants of a design.
    fn config(design: &TwoMassDesign, bases: Bases) -> Result<Self::Config, Error>;

    /// The constants with corrections that set a state when the angle has turned by `KICK`.
    fn kicked(config: &Self::Config, design: &TwoMassDesign, bases: Bases, start: Start) -> Self::Config;

    /// The step of the free pair as stored: twist and twist rate, or twist rate and shaft torque.
    fn increments(config: &Self::Config) -> Increments;
}

/// A step with its constants, at rest or just disturbed.
pub struct OpenLoop<N: Swept, S: Step<N>> {
    config: S::Config,
    observer: S,
    bases: Bases,
    number: core::marker::PhantomData<N>,
}

impl<N: Swept, S: Step<N>> OpenLoop<N, S> {
    /// A machine at rest, one state of which has then been set.
    pub fn new(design: &TwoMassDesign, bases: Bases, start: Start) -> Result<Self, Error> {
        let config = S::config(design, bases)?;
        let kicked = S::kicked(&config, design, bases, start);
        let mut observer = S::at_rest(&config, 0, N::ZERO);
        // From zero everywhere the prediction is zero without rounding, so the innovation is the angle itself.
        observer.step(&kicked, KICK, N::ZERO);
        Ok(OpenLoop { config, observer, bases, number: core::marker::PhantomData })
    }

    /// One tick under a motor torque (N m): predict and correct, by gains of zero.
    #[inline]
    pub fn tick(&mut self, torque: f64) {
        self.observer.step(&self.config, KICK, N::of(torque, self.bases.torque));
    }

    /// One tick of free motion.
    #[inline(always)]
    pub fn coast(&mut self) {
        self.observer.step(&self.config, KICK, N::ZERO);
    }

    /// The step of the free pair as stored.
    pub fn increments(&self) -> Increments {
        S::increments(&self.config)
    }

    /// Motor speed, shaft torque, load speed [rad/s, N m, rad/s].
    pub fn state(&self) -> [f64; 3] {
        let estimate = self.observer.estimate(&self.config);
        [
            estimate.motor_speed.value(self.bases.speed),
            estimate.shaft_torque.value(self.bases.torque),
            estimate.load_speed.value(self.bases.speed),
        ]
    }
}

macro_rules! steps {
    ($number:ty, |$design:ident, $bases:ident| $exact:expr, $semi_implicit:expr) => {
        impl Step<$number> for TwoMassObserver<$number> {
            const NAME: &'static str = "exact";

            fn config($design: &TwoMassDesign, $bases: Bases) -> Result<Self::Config, Error> {
                $exact
            }

            fn kicked(config: &Self::Config, design: &TwoMassDesign, bases: Bases, start: Start) -> Self::Config {
                let (mut twist, mut load) = (Default::default(), Default::default());
                match start {
                    Start::LoadTorque(torque) => load = <$number>::kick(torque, bases.torque),
                    Start::ShaftTorque(torque) => {
                        twist = <$number>::kick(torque / design.machine.stiffness, bases.twist);
                    }
                }
                TwoMassConfig { correction: [Default::default(), Default::default(), twist, load], ..*config }
            }

            fn increments(config: &Self::Config) -> Increments {
                [config.twist, config.twist_rate].map(|[twist, slip, _]| {
                    [<$number>::widened_coefficient(twist), <$number>::widened_coefficient(slip)]
                })
            }
        }

        impl Step<$number> for SemiImplicitObserver<$number> {
            const NAME: &'static str = "semi-implicit";

            fn config($design: &TwoMassDesign, $bases: Bases) -> Result<Self::Config, Error> {
                $semi_implicit
            }

            fn kicked(config: &Self::Config, _: &TwoMassDesign, bases: Bases, start: Start) -> Self::Config {
                let (mut shaft, mut load) = (Default::default(), Default::default());
                match start {
                    Start::LoadTorque(torque) => load = <$number>::kick(torque, bases.torque),
                    Start::ShaftTorque(torque) => shaft = <$number>::kick(torque, bases.torque),
                }
                SemiImplicitConfig { correction: [Default::default(), Default::default(), shaft, load], ..*config }
            }

            // rate -= c torque, then torque += s0 rate' + s1 rate, with the twist rate.
            fn increments(config: &Self::Config) -> Increments {
                let softness = <$number>::coefficient(config.motor) + <$number>::coefficient(config.load);
                let [new, old] = config.shaft.map(<$number>::coefficient);
                [[0.0, -softness], [new + old, -new * softness]]
            }
        }
    };
}

steps!(
    f32,
    |design, bases| TwoMassConfig::<f32>::try_new(design, bases),
    SemiImplicitConfig::<f32>::try_new(&design.with_step(StepChoice::SemiImplicit), bases)
);
steps!(
    f64,
    |design, bases| TwoMassConfig::<f64>::try_new(design, bases),
    SemiImplicitConfig::<f64>::try_new(&design.with_step(StepChoice::SemiImplicit), bases)
);
steps!(
    Fixed,
    |design, bases| TwoMassConfig::<Fixed>::try_new(design, bases),
    SemiImplicitConfig::<Fixed>::try_new(&design.with_step(StepChoice::SemiImplicit), bases)
);
