//! The library's observer on a course.

use driveline::number::Fixed;
use driveline::observer::{BacklashConfig, BacklashObserver, Gap, Observer};
use driveline::settings::Bases;

use super::case::Case;
use super::run::Course;

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

impl<N: Gap> Library<N> {
    /// Takes the angle after a tick, 2^32 to the turn, and the torque during it (N m).
    pub fn tick(&mut self, angle: u32, torque: f64) {
        self.observer.step(&self.config, angle, (self.to)(torque / self.bases.torque));
    }

    /// Shaft torque (N m).
    pub fn shaft_torque(&self) -> f64 {
        (self.from)(self.observer.estimate(&self.config).shaft_torque) * self.bases.torque
    }
}

/// Root mean square error of the shaft torque over a course, of its peak.
pub fn error<N: Gap>(course: &Course, library: &mut Library<N>) -> f64 {
    let mut sum = 0.0;
    for (tick, (&(angle, applied), truth)) in course.sensed.iter().zip(&course.shaft_torque).enumerate() {
        // The first angle is where the observer starts.
        if tick > 0 {
            library.tick(angle, applied);
        }
        sum += (library.shaft_torque() - truth).powi(2);
    }
    (sum / course.shaft_torque.len().max(1) as f64).sqrt() / course.peak
}
