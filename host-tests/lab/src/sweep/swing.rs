//! No growth over 1e8 ticks, by running free swings where it is decisive.

use std::hint::black_box;

use driveline::machine::TwoMass as Machine;
use driveline::number::Fixed;
use driveline::observer::{SemiImplicitObserver, TwoMassObserver};

use super::grid::{PERIOD, Place, open_loop};
use super::growth::{TOLERANCE, bases};
use super::number::Swept;
use super::poles;
use super::step::{OpenLoop, Start, Step};

/// Where free motion is run: undamped, equal masses; slow, fast, at a radian, next to half the sample rate, far above
/// it.
pub const DECISIVE: [f64; 5] = [1e-3, 0.1, 1.0, 3.1, 100.0];

/// Ticks in which the largest swing is looked for: more than a period of the slowest.
const WINDOW: u64 = 10_000;

/// Growth of a free oscillation of one step at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Where.
    pub place: Place,
    /// Last over first swing, less one; negative where it died down.
    pub change: f64,
    /// Bound of roundings.
    pub bound: f64,
    /// Growth by the poles of the stored coefficients: the factor over the run, less one.
    pub predicted: f64,
}

/// Runs free swings side by side, which a processor is faster at than one after the other.
fn swings<N: Swept, S: Step<N>>(ticks: u64, omega_t: &[f64]) -> Vec<Swing> {
    let places: Vec<Place> =
        omega_t.iter().map(|&omega_t| Place { omega_t, inertia_ratio: 1.0, damping: 0.0 }).collect();
    let machines: Vec<Machine> = places.iter().map(Place::machine).collect();
    let start = |machine: &Machine| {
        OpenLoop::<N, S>::new(&open_loop(machine, PERIOD), bases(machine), Start::ShaftTorque(0.5))
            .expect("a step within its format")
    };
    let mut runs: Vec<OpenLoop<N, S>> = machines.iter().map(start).collect();
    let largest = |runs: &mut Vec<OpenLoop<N, S>>| {
        let mut sizes = vec![0.0_f64; runs.len()];
        for _ in 0..WINDOW {
            for ((run, machine), size) in runs.iter_mut().zip(&machines).zip(&mut sizes) {
                run.coast();
                let [motor, torque, load] = run.state();
                let kinetic = machine.motor_inertia * motor * motor + machine.load_inertia * load * load;
                *size = size.max((kinetic + torque * torque / machine.stiffness).sqrt());
            }
        }
        sizes
    };
    let first = largest(&mut runs);
    for _ in 0..ticks {
        for run in &mut runs {
            run.coast();
        }
    }
    let last = largest(black_box(&mut runs));
    // As for errors: 16 independent roundings' worth a tick, in fixed point of bases that are four times the swing.
    let coarseness = if N::FLOATS { 1.0 } else { 4.0 };
    let bound = TOLERANCE + 16.0 * coarseness * N::ROUNDING * (ticks as f64).sqrt();
    let swing = |index: usize| Swing {
        place: places[index],
        change: last[index] / first[index] - 1.0,
        bound,
        predicted: poles::growth(runs[index].increments(), ticks as f64),
    };
    (0..places.len()).map(swing).collect()
}

/// Free swings of so many ticks by every step of [`STEPS`](super::STEPS): the semi-implicit ones where it is stable.
pub fn free_swings(ticks: u64) -> [Vec<Swing>; 6] {
    type Run = fn(u64, &[f64]) -> Vec<Swing>;
    let stable = &DECISIVE[..3];
    let runs: [(Run, &[f64]); 6] = [
        (swings::<f32, TwoMassObserver<f32>>, &DECISIVE),
        (swings::<Fixed, TwoMassObserver<Fixed>>, &DECISIVE),
        (swings::<f64, TwoMassObserver<f64>>, &DECISIVE),
        (swings::<f32, SemiImplicitObserver<f32>>, stable),
        // At a radian fixed point holds no such coefficient.
        (swings::<Fixed, SemiImplicitObserver<Fixed>>, &DECISIVE[..2]),
        (swings::<f64, SemiImplicitObserver<f64>>, stable),
    ];
    runs.map(|(run, places)| run(ticks, places))
}
