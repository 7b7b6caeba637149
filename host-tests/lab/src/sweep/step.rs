//! The steps under test: the library's own observers, run open loop.

use driveline::design::{StepChoice, TwoMassDesign};
use driveline::number::Fixed;
use driveline::observer::{Observer, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver};
use driveline::settings::{Bases, Error};

use super::number::{KICK, Swept};

/// The increments of two states per tick, from those states: `x += N x`.
pub type Increments = [[f64; 2]; 2];

/// An observer of two masses that a sweep can run.
pub trait Step<N: Swept>: Observer<N> + Copy {
    /// Name in the report.
    const NAME: &'static str;

    /// The constants of a design.
    fn config(design: &TwoMassDesign, bases: Bases) -> Result<Self::Config, Error>;

    /// The constants with corrections that set a state when the angle has turned by `KICK`.
    fn kicked(config: &Self::Config, bases: Bases, load_torque: f64) -> Self::Config;

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
    pub fn new(design: &TwoMassDesign, bases: Bases, load_torque: f64) -> Result<Self, Error> {
        let config = S::config(design, bases)?;
        let kicked = S::kicked(&config, bases, load_torque);
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

            fn kicked(config: &Self::Config, bases: Bases, load_torque: f64) -> Self::Config {
                let load = <$number>::kick(load_torque, bases.torque);
                let none = Default::default();
                TwoMassConfig { correction: [none, none, none, load], ..*config }
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

            fn kicked(config: &Self::Config, bases: Bases, load_torque: f64) -> Self::Config {
                let load = <$number>::kick(load_torque, bases.torque);
                let none = Default::default();
                SemiImplicitConfig { correction: [none, none, none, load], ..*config }
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
