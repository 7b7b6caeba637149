//! Score of the estimates.

use driveline::design::{Disturbance, Rate};
use driveline::machine::{Chain, Inertia};
use driveline::number::Fixed;
use driveline::observer::{BacklashConfig, BacklashObserver, Gap, Observer, RigidConfig, RigidObserver};
use driveline::settings::Bases;

use super::case::{Case, RATE_HZ};
use super::run::Course;

/// Something that estimates from the motor's angle and torque, tick by tick.
pub trait Estimator {
    /// Takes the angle after a tick, 2^32 to the turn, and the torque during it (N m).
    fn tick(&mut self, angle: u32, torque: f64);

    /// Shaft torque (N m) and load speed (rad/s).
    fn estimate(&self) -> [f64; 2];
}

/// The library's observer in one of its numbers.
pub struct Library<N: Gap> {
    config: BacklashConfig<N>,
    observer: BacklashObserver<N>,
    bases: Bases,
    to: fn(f64) -> N,
    from: fn(N) -> f64,
}

impl<N: Gap> Library<N> {
    fn with(config: BacklashConfig<N>, bases: Bases, to: fn(f64) -> N, from: fn(N) -> f64) -> Self {
        Library { config, observer: BacklashObserver::at_rest(&config, 0, N::ZERO), bases, to, from }
    }
}

impl Library<f32> {
    /// In `f32`.
    pub fn single(case: &Case) -> Self {
        Library::with(BacklashConfig::<f32>::new(&case.design(), Bases::SI), Bases::SI, |x| x as f32, f64::from)
    }
}

impl Library<f64> {
    /// In `f64`.
    pub fn double(case: &Case) -> Self {
        Library::with(BacklashConfig::<f64>::new(&case.design(), Bases::SI), Bases::SI, |x| x, |x| x)
    }
}

impl Library<Fixed> {
    /// In fixed point.
    pub fn fixed(case: &Case) -> Self {
        let bases = case.bases();
        Library::with(BacklashConfig::<Fixed>::new(&case.design(), bases), bases, Fixed::from_f64, Fixed::to_f64)
    }
}

impl<N: Gap> Estimator for Library<N> {
    fn tick(&mut self, angle: u32, torque: f64) {
        self.observer.step(&self.config, angle, (self.to)(torque / self.bases.torque));
    }

    fn estimate(&self) -> [f64; 2] {
        let estimate = self.observer.estimate(&self.config);
        [(self.from)(estimate.shaft_torque) * self.bases.torque, (self.from)(estimate.load_speed) * self.bases.speed]
    }
}

/// The library's observer of one mass in `f64`.
pub struct Rigid {
    config: RigidConfig<f64>,
    observer: RigidObserver<f64>,
}

impl Rigid {
    /// With a load that wanders `within` a time (s) by what the case has.
    pub fn new(case: &Case, within: f64) -> Self {
        let machine = &case.machine;
        let disturbance = Disturbance { within, ..case.disturbance() };
        let total = machine.total_inertia();
        let design = Chain::motor(Inertia(total)).rigid().observer(Rate::hz(RATE_HZ), case.encoder(), disturbance);
        let config = RigidConfig::<f64>::new(&design, machine.load_inertia / total, Bases::SI);
        Rigid { observer: RigidObserver::at_rest(&config, 0, 0.0), config }
    }
}

impl Estimator for Rigid {
    fn tick(&mut self, angle: u32, torque: f64) {
        self.observer.step(&self.config, angle, torque);
    }

    fn estimate(&self) -> [f64; 2] {
        let estimate = self.observer.estimate(&self.config);
        [estimate.shaft_torque, estimate.load_speed]
    }
}

/// Errors over one or more courses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// Root mean square error of the shaft torque over its peak.
    pub shaft_torque: f64,
    /// Root mean square error of the load's speed over its highest.
    pub load_speed: f64,
}

impl Score {
    /// Lets an estimator run over a course.
    pub fn of(course: &Course, estimator: &mut dyn Estimator) -> Self {
        let (mut torque, mut speed) = (0.0, 0.0);
        for (tick, (&(angle, applied), truth)) in course.sensed.iter().zip(&course.truth).enumerate() {
            // The first angle is where the estimator starts.
            if tick > 0 {
                estimator.tick(angle, applied);
            }
            let estimate = estimator.estimate();
            torque += (estimate[0] - truth[0]).powi(2);
            speed += (estimate[1] - truth[1]).powi(2);
        }
        let count = course.truth.len().max(1) as f64;
        Score {
            shaft_torque: (torque / count).sqrt() / course.peak,
            load_speed: (speed / count).sqrt() / course.fastest,
        }
    }
}
