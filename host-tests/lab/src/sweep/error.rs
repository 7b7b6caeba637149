//! The state error of every step at one place, all of them beside one reference.

use driveline::design::{StepChoice, TwoMassDesign};
use driveline::number::Fixed;
use driveline::observer::{SemiImplicitObserver, TwoMassObserver};
use driveline::settings::Bases;

use super::cause::Cause;
use super::grid::{PERIOD, Place, open_loop};
use super::load::{LOAD_TORQUE, Torques};
use super::number::Swept;
use super::program::Course;
use super::reference::Reference;
use super::step::{OpenLoop, Step};

/// The steps of a sweep, in the order of [`errors`].
pub const STEPS: [(&str, &str); 6] = [
    (<f32 as Swept>::NAME, "exact"),
    (<Fixed as Swept>::NAME, "exact"),
    (<f64 as Swept>::NAME, "exact"),
    (<f32 as Swept>::NAME, "semi-implicit"),
    (<Fixed as Swept>::NAME, "semi-implicit"),
    (<f64 as Swept>::NAME, "semi-implicit"),
];

/// How one step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Largest error of the run, relative; infinite where it did not run.
    pub error: f64,
    /// Its limit.
    pub bound: f64,
    /// Why it is more.
    pub cause: Option<Cause>,
}

/// Error above which a step is of no use, whatever its number can do: 1 %, less than a stiffness is ever known to.
pub const USABLE: f64 = 0.01;

/// Roundings per tick below which they cannot be taken as independent of each other.
pub const FINEST: f64 = 2048.0;

/// Bound of rounding errors.
///
/// Every tick rounds each state a few times, and independent roundings grow with the square root of the ticks: 16
/// roundings' worth a tick. A coefficient's rounding shifts the frequency, so its error grows in proportion to the
/// ticks: relative to what moves in a tick for floats; absolute, half of 2^-30 for each of two coefficients, in fixed
/// point, where all of it counts in units of the bases. The reference itself is rounded in the same way as `f64`, with
/// the angle turned and the decay as factors.
fn rounding<N: Swept>(place: &Place, ticks: u64, coarseness: f64) -> f64 {
    let n = ticks as f64;
    let reference = 0.5 * f64::EPSILON * n * place.omega_t * (1.0 + 2.0 * place.damping);
    let independent = 16.0 * N::ROUNDING * n.sqrt();
    let own = if N::FLOATS {
        independent + 4.0 * N::ROUNDING * n * place.omega_t.min(1.0)
    } else {
        coarseness * (independent + n / 1_073_741_824.0)
    };
    own + reference
}

struct Judged<N: Swept, S: Step<N>> {
    run: Option<OpenLoop<N, S>>,
    ticks: u64,
    error: f64,
}

impl<N: Swept, S: Step<N>> Judged<N, S> {
    fn new(design: &TwoMassDesign, bases: Bases, ticks: u64) -> Self {
        let run = OpenLoop::new(design, bases, LOAD_TORQUE).ok();
        Judged { error: if run.is_some() { 0.0 } else { f64::INFINITY }, run, ticks }
    }

    #[inline]
    fn tick(&mut self, tick: u64, torque: f64, error: impl Fn([f64; 3]) -> f64) {
        if tick < self.ticks
            && self.error < f64::INFINITY
            && let Some(run) = &mut self.run
        {
            run.tick(torque);
            self.error = self.error.max(error(run.state()));
        }
    }

    fn outcome(&self, place: &Place, step: f64, coarseness: f64, others: impl Fn() -> Option<Cause>) -> Outcome {
        let rounding = rounding::<N>(place, self.ticks, coarseness);
        let bound = (step + rounding).min(USABLE + step);
        let finest = FINEST * N::ROUNDING * if N::FLOATS { 1.0 } else { coarseness };
        let cause = if self.error <= bound {
            None
        } else if let Some(cause) = others() {
            Some(cause)
        } else if self.run.is_none() {
            Some(Cause::Refused)
        } else if place.slowest() < finest || self.error <= step + rounding {
            Some(Cause::Resolution)
        } else {
            Some(Cause::Unexplained)
        };
        Outcome { error: self.error, bound, cause }
    }
}

/// Runs every step of [`STEPS`] at a place, over at most `longest` ticks.
pub fn errors(place: &Place, longest: u64) -> [Outcome; 6] {
    let machine = place.machine();
    let design = open_loop(&machine, PERIOD);
    let course = Course::new(place, longest);
    // The slip's base is the twist's swing or the damper's torque, and must not be cut by the speed's: the forcing
    // counts in it.
    let swing = (machine.resonance() / machine.stiffness).min(1.0 / machine.damping);
    let bases = course.bases(&machine, machine.total_inertia(), 0.95 * swing * course.torque_base());
    let mut exact = (
        Judged::<f32, TwoMassObserver<f32>>::new(&design, bases, course.ticks),
        Judged::<Fixed, TwoMassObserver<Fixed>>::new(&design, bases, course.ticks),
        Judged::<f64, TwoMassObserver<f64>>::new(&design, bases, course.ticks),
    );
    // The cheap step is judged as the design judges it: over a period of the natural frequency.
    let horizon = u64::from(design.semi_implicit.fidelity.horizon).min(course.ticks);
    let unit = course.coarseness(&machine, &bases);
    let bases = course.bases(&machine, machine.motor_inertia.min(machine.load_inertia), 0.0);
    let mut cheap = (
        Judged::<f32, SemiImplicitObserver<f32>>::new(&design, bases, horizon),
        Judged::<Fixed, SemiImplicitObserver<Fixed>>::new(&design, bases, horizon),
        Judged::<f64, SemiImplicitObserver<f64>>::new(&design, bases, horizon),
    );
    let mut reference = Reference::new(place, LOAD_TORQUE);
    let mut torques = Torques::new(course.hold);
    for tick in 0..course.ticks {
        let torque = torques.next();
        reference.tick(torque);
        let truth = reference.state();
        let error = |state| course.error(&machine, &truth, state);
        exact.0.tick(tick, torque, error);
        exact.1.tick(tick, torque, error);
        exact.2.tick(tick, torque, error);
        if tick < horizon {
            cheap.0.tick(tick, torque, error);
            cheap.1.tick(tick, torque, error);
            cheap.2.tick(tick, torque, error);
        }
    }
    let none = || None;
    let coarse = || match design.chosen {
        StepChoice::Exact => Some(Cause::NotChosen),
        StepChoice::SemiImplicit if course.rigid > FINEST => Some(Cause::Cancellation),
        StepChoice::SemiImplicit => None,
    };
    let step = StepChoice::THRESHOLD;
    let cheap_unit = course.coarseness(&machine, &bases);
    [
        exact.0.outcome(place, 0.0, unit, none),
        exact.1.outcome(place, 0.0, unit, none),
        exact.2.outcome(place, 0.0, unit, none),
        cheap.0.outcome(place, step, cheap_unit, coarse),
        cheap.1.outcome(place, step, cheap_unit, coarse),
        cheap.2.outcome(place, step, cheap_unit, coarse),
    ]
}
