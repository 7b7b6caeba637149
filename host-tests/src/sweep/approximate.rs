//! The exact observer with another step, on the host: what the exact step is worth.
//!
//! It is the library's observer behind its gear, in `f64`, with the six coefficients of twist and slip exchanged; gains, gear,
//! mean motion and wrapped angle stay what they are, so that only the step differs. No sample is screened: a step that diverges
//! is seen to diverge.

use driveline::constants::Gear;
use driveline::design::{ApproximateStep, TwoMassDesign};
use driveline::observer::{Geared, GearedConfig, Observer, TwoMass, TwoMassConfig};

use crate::report::{Comparison, Deviation};

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

    /// What the report calls it.
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
    observer: Geared<TwoMass<f64>>,
}

impl ApproximateObserver {
    /// At rest at angle zero, without torque in its shaft.
    ///
    /// # Errors
    /// For a gear out of its range.
    pub fn new(design: &TwoMassDesign, step: StepOf, gear: &Gear) -> Result<Self, driveline::constants::Error> {
        let mut config = TwoMassConfig::<f64>::new(design);
        let other = match step {
            StepOf::Exact => None,
            StepOf::Tustin => Some(ApproximateStep::tustin(&design.machine, design.period)),
            StepOf::ForwardEuler => Some(ApproximateStep::forward_euler(&design.machine, design.period)),
        };
        if let Some(step) = other {
            config.twist = [step.n11, step.n12, step.g1];
            config.twist_rate = [step.n21, step.n22, step.g2];
        }
        let config = GearedConfig::<f64, _>::try_new(config, gear, design.period)?;
        Ok(ApproximateObserver { observer: Geared::at_rest(&config, 0, 0.0), config })
    }

    /// A tick against a closed brake: at rest at this angle [2^-32 turn], the shaft carrying this torque [N m].
    pub fn hold(&mut self, angle: u32, torque: f64) -> [f64; 3] {
        self.observer = Geared::at_rest(&self.config, angle, torque);
        self.estimate()
    }

    /// A tick with the angle at its end [2^-32 turn] and the motor's torque during it [N m]: shaft torque, load speed and load torque
    /// [N m, rad/s, N m].
    pub fn tick(&mut self, angle: u32, torque: f64) -> [f64; 3] {
        self.observer.step(&self.config, angle, torque);
        self.estimate()
    }

    fn estimate(&self) -> [f64; 3] {
        let estimate = self.observer.estimate(&self.config);
        [estimate.shaft_torque, estimate.load_speed, estimate.load_torque]
    }
}

/// One tick of a recorded run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorded {
    /// Motor angle as the drive read it [2^-32 turn].
    pub angle: u32,
    /// Torque that the drive was told of, or that it held against the brake [N m].
    pub torque: f64,
    /// The governor was released.
    pub released: bool,
    /// Shaft torque, load speed, load torque as the plant had them [N m, rad/s, N m].
    pub truth: [f64; 3],
}

/// The errors of an observer with this step on a recorded run, torques of their peaks in the run, the speed of the rated one [rad/s]. An
/// estimate that is no longer finite makes them infinite.
///
/// # Errors
/// For a gear out of its range.
pub fn comparison(
    design: &TwoMassDesign,
    step: StepOf,
    gear: &Gear,
    run: &[Recorded],
    rated_speed: f64,
) -> Result<Comparison, driveline::constants::Error> {
    let mut observer = ApproximateObserver::new(design, step, gear)?;
    let peak = |index: usize| run.iter().map(|tick| tick.truth[index].abs()).fold(0.0, f64::max);
    let scales = [peak(0), rated_speed, peak(2)];
    let (mut squares, mut largest) = ([0.0_f64; 3], [0.0_f64; 3]);
    for tick in run {
        let estimate =
            if tick.released { observer.tick(tick.angle, tick.torque) } else { observer.hold(tick.angle, tick.torque) };
        for index in 0..3 {
            let error = (estimate[index] - tick.truth[index]).abs() / scales[index];
            let error = if error.is_finite() { error } else { f64::INFINITY };
            squares[index] += error * error;
            largest[index] = largest[index].max(error);
        }
    }
    let deviation = |index: usize| Deviation { rms: (squares[index] / run.len() as f64).sqrt(), max: largest[index] };
    Ok(Comparison {
        step: step.name().to_owned(),
        observer: "two-mass, f64".to_owned(),
        rate_hz: (1.0 / design.period).round() as u32,
        shaft_torque: deviation(0),
        load_speed: deviation(1),
        load_torque: deviation(2),
    })
}
