//! No growth over 1e8 ticks, from the poles of the coefficients as they are stored.

use driveline::design::StepChoice;
use driveline::machine::TwoMass as Machine;
use driveline::number::Fixed;
use driveline::observer::{SemiImplicitObserver, TwoMassObserver};
use driveline::settings::Bases;

use super::cause::Cause;
use super::grid::{PERIOD, Place, open_loop};
use super::number::Swept;
use super::poles;
use super::step::Step;

/// Ticks over which nothing may grow.
pub const TICKS: u64 = 100_000_000;

/// Growth that counts as none: 1e8 ticks of some roundings of 1e-16, which the coefficients of `f64` have as well, are
/// 1e-7.
pub const TOLERANCE: f64 = 1e-6;

/// Growth of a free swing by one step at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Factor over [`TICKS`], less one.
    pub factor_less_one: f64,
    /// Why it is more than it may be.
    pub cause: Option<Cause>,
}

/// Bases of a swing of 1 N m: motor and shaft within 1 N m, and the speed of the lighter mass in free motion.
pub fn bases(machine: &Machine) -> Bases {
    let lighter = machine.motor_inertia.min(machine.load_inertia);
    let swing = 1.0 / (machine.resonance() * lighter);
    // Fixed point holds no coefficient above 1/2.
    Bases::new(machine, 1.0, (1.1 * swing).max(2.1 * PERIOD / lighter))
}

fn predicted<N: Swept, S: Step<N>>(place: &Place) -> Growth {
    let machine = place.machine();
    let design = open_loop(&machine, PERIOD);
    let (factor_less_one, other) = match S::config(&design, bases(&machine)) {
        Ok(config) => (poles::growth(S::increments(&config), TICKS as f64), Cause::Coefficients),
        Err(_) => (f64::INFINITY, Cause::Refused),
    };
    let coarse = S::NAME != "exact" && design.chosen == StepChoice::Exact;
    let cause = match (factor_less_one > TOLERANCE, coarse) {
        (false, _) => None,
        (true, true) => Some(Cause::NotChosen),
        (true, false) => Some(other),
    };
    Growth { factor_less_one, cause }
}

/// Growth by every step of [`STEPS`](super::STEPS) at a place, from the coefficients as they are stored.
pub fn growths(place: &Place) -> [Growth; 6] {
    [
        predicted::<f32, TwoMassObserver<f32>>(place),
        predicted::<Fixed, TwoMassObserver<Fixed>>(place),
        predicted::<f64, TwoMassObserver<f64>>(place),
        predicted::<f32, SemiImplicitObserver<f32>>(place),
        predicted::<Fixed, SemiImplicitObserver<Fixed>>(place),
        predicted::<f64, SemiImplicitObserver<f64>>(place),
    ]
}
