//! A mill that bites: the observer over courses of the full solver, and its searching gains.

use driveline::design::{BacklashTuning, Rate};
use driveline::number::Fixed;
use driveline_lab::backlash::{Case, Course, Kind, Library, error};
use nalgebra::{SMatrix, SVector};

#[test]
fn bites_are_followed_in_both_numbers() {
    let mill = Case::mill();
    let courses: Vec<_> = (31..51).map(|seed| Course::record(&mill, Kind::Bites, seed, 6.0).unwrap()).collect();
    let mean = |of: &dyn Fn(&Course) -> f64| courses.iter().map(of).sum::<f64>() / courses.len() as f64;
    let single = mean(&|course| error(course, &mut Library::<f32>::single(&mill)));
    let fixed = mean(&|course| error(course, &mut Library::<Fixed>::fixed(&mill)));
    for error in [single, fixed] {
        println!("{:.2} %", 100.0 * error);
        // The aim, 6 %, is that of 200 courses. Single ones deviate by 0.8 %, a mean of 20 by 0.18 %. One mass that
        // follows best, its load wandering within 0.2 s, has 9.1 %.
        assert!(error < 0.06 + 0.0018, "{error}");
    }
}

/// The gains that the covariance settles at, tick by tick [Kalman 1960, J. Basic Eng. 82(1), (21) to (24)].
fn settled(case: &Case, wandering: [f64; 3]) -> SVector<f64, 5> {
    let contact = case.design().contact;
    let transition = SMatrix::<f64, 5, 5>::from(contact.transition.0).transpose();
    let input = SVector::from(contact.input);
    let mut noise = input * input.transpose() * case.disturbance().torque_variance().unwrap();
    for (state, variance) in [2, 3, 4].into_iter().zip(wandering) {
        noise[(state, state)] += variance;
    }
    let measurement = case.encoder().variance().unwrap();
    let (mut covariance, mut gain) = (noise, SVector::zeros());
    // The error falls by its pole of 0.998 in a tick, and the covariance by its square: e^-80.
    for _ in 0..20_000 {
        let prior = transition * covariance * transition.transpose() + noise;
        gain = prior.column(0) / (prior[(0, 0)] + measurement);
        covariance = prior - gain * prior.row(0);
        covariance = (covariance + covariance.transpose()) * 0.5;
    }
    gain
}

#[test]
fn the_searching_gains_are_those_of_the_wanders() {
    let mill = Case::mill();
    let BacklashTuning { wander, speed_wander, torque_wander, .. } = mill.tuning;
    let (resonance, gap, period) = (mill.machine.resonance(), mill.machine.gap, 1e-4);
    // A random walk's variance after a period of the resonance is the wander's square: of that a tick has its share.
    let share = period * resonance / core::f64::consts::TAU;
    let load = mill.disturbance().load_torque_variance(period).unwrap();
    let twist = (wander * gap).powi(2) * share;
    let speed = (speed_wander * gap * resonance).powi(2) * share;
    let expected = settled(&mill, [twist, speed, torque_wander.powi(2) * load]);
    let design = mill.machine.backlash_observer(Rate::hz(10_000), mill.encoder(), mill.disturbance(), mill.tuning);
    for (gain, expected) in design.searching.into_iter().zip(expected.iter()) {
        // A rounding of 1e-16 in a tick adds up to 1/(1 - 0.998^2) of it, and a tick has some hundred.
        assert!((gain / expected - 1.0).abs() < 1e-11, "{gain}, {expected}");
    }
}
