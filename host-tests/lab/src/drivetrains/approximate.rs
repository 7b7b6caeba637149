//! The exact observer with another step, on the host: what the exact step is worth.
//!
//! It is the library's observer behind its gear, in `f64`, with the six coefficients of twist and slip exchanged;
//! gains, gear, mean motion and wrapped angle stay what they are, so that only the step differs. No sample is screened:
//! a step that diverges is seen to diverge.

use driveline::design::{ApproximateStep, TwoMassDesign};
use driveline::observer::{GearedConfig, GearedObserver, Observer, TwoMassConfig, TwoMassObserver};
use driveline::settings::{Bases, Gear};

/// The step of twist and slip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepOf {
    /// The library's own.
    Exact,
    /// The trapezoidal rule.
    Tustin,
    /// Forward Euler.
    ForwardEuler,
}

impl StepOf {
    /// All of them.
    pub const ALL: [StepOf; 3] = [StepOf::Exact, StepOf::Tustin, StepOf::ForwardEuler];

    /// Name in the report.
    pub const fn name(self) -> &'static str {
        match self {
            StepOf::Exact => "exact",
            StepOf::Tustin => "Tustin",
            StepOf::ForwardEuler => "forward Euler",
        }
    }
}

/// An observer of two masses behind a gear, with a step of choice.
#[derive(Clone, Copy, Debug)]
pub struct ApproximateObserver {
    config: GearedConfig<f64, TwoMassConfig<f64>>,
    observer: GearedObserver<TwoMassObserver<f64>>,
}

impl ApproximateObserver {
    /// At rest at angle zero, without torque in its shaft.
    ///
    /// # Errors
    /// For a gear out of its range.
    pub fn new(design: &TwoMassDesign, step: StepOf, gear: &Gear) -> Result<Self, driveline::settings::Error> {
        let mut config = TwoMassConfig::<f64>::new(design, Bases::SI);
        let other = match step {
            StepOf::Exact => None,
            StepOf::Tustin => Some(ApproximateStep::tustin(&design.machine, design.period)),
            StepOf::ForwardEuler => Some(ApproximateStep::forward_euler(&design.machine, design.period)),
        };
        if let Some(step) = other {
            config.twist = [step.n11, step.n12, step.g1];
            config.twist_rate = [step.n21, step.n22, step.g2];
        }
        let config = GearedConfig::<f64, _>::try_new(config, gear, design.period, Bases::SI)?;
        Ok(ApproximateObserver { observer: GearedObserver::at_rest(&config, 0, 0.0), config })
    }

    /// A tick against a closed brake: at rest at this angle (2^-32 turn), the shaft carrying this torque (N m).
    pub fn hold(&mut self, angle: u32, torque: f64) -> [f64; 3] {
        self.observer = GearedObserver::at_rest(&self.config, angle, torque);
        self.estimate()
    }

    /// A tick with the angle at its end (2^-32 turn) and the motor's torque during it (N m): shaft torque, load speed
    /// and load torque [N m, rad/s, N m].
    pub fn tick(&mut self, angle: u32, torque: f64) -> [f64; 3] {
        self.observer.step(&self.config, angle, torque);
        self.estimate()
    }

    fn estimate(&self) -> [f64; 3] {
        let estimate = self.observer.estimate(&self.config);
        [estimate.shaft_torque, estimate.load_speed, estimate.load_torque]
    }
}
