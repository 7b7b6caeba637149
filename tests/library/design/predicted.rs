//! Predicted errors of the estimates against the library's own observers over machines that differ.

use std::f64::consts::TAU;

use driveline::design::{
    Disturbance, Encoder, EstimateError, LoadCycle, LoopObserver, ObserverChoice, ObserverSelection, Operation,
    Penalty, PredictedErrors, Rate, RigidDesign, Spread, Tolerance, TwoMassDesign,
};
use driveline::machine::{Damping, Inertia, Rigid, Stiffness, TwoMass};
use driveline::observer::{Observer, RigidConfig, RigidObserver, TwoMassConfig, TwoMassObserver};
use driveline::settings::Bases;
use driveline_solver::noise::Noise;

use crate::references::close;

const PERIOD: f64 = 1e-3;
const TURN: f64 = 4_294_967_296.0;

fn machine(motor: f64, load: f64, stiffness: f64) -> TwoMass {
    TwoMass::new(Inertia(1.2 * motor), Inertia(0.5 * load), Stiffness(850.0 * stiffness), Damping(0.2))
}

fn designs() -> (TwoMassDesign, RigidDesign) {
    let disturbance = Disturbance { torque_accuracy: 1.0, load_torque_step: 50.0, within: 5.0 };
    let (rate, encoder) = (Rate::every(PERIOD), Encoder::lines(4096));
    let rigid = Rigid { inertia: 1.7, gravity_torque: 0.0 };
    (machine(1.0, 1.0, 1.0).observer(rate, encoder, disturbance), rigid.observer(rate, encoder, disturbance))
}

const OPERATION: Operation = Operation {
    rated_torque: 100.0,
    torque: 60.0,
    acceleration: 25.0,
    speed: 40.0,
    torque_noise: 0.0,
    cycle: LoadCycle { speed: 40.0, torque: 100.0, change: 30.0, rise: 0.0, every: 2.0, reverses: false },
};

fn predicted(observer: LoopObserver<'_>, encoder: Encoder, tolerance: &Tolerance, noise: f64) -> PredictedErrors {
    machine(1.0, 1.0, 1.0).predicted_errors(
        observer,
        encoder,
        tolerance,
        &Operation { torque_noise: noise, ..OPERATION },
    )
}

const EXACT: Encoder = Encoder::counts(u32::MAX);

/// Shaft torque, load speed and load torque that an observer gives for each tick's angle (rad) and torque.
fn estimates(two: bool, ticks: usize, mut tick: impl FnMut(usize) -> (f64, f64), speed: f64) -> Vec<[f64; 3]> {
    fn run<O: Observer<f64>>(
        config: &O::Config,
        ticks: usize,
        tick: &mut dyn FnMut(usize) -> (f64, f64),
        speed: f64,
    ) -> Vec<[f64; 3]> {
        let word = |angle: f64| (angle / TAU).rem_euclid(1.0) * TURN;
        let mut observer = O::steady(config, word(tick(0).0) as u64 as u32, 0.0, speed);
        let each = |k| {
            let (angle, torque) = tick(k);
            let angle = word(angle) as u64 as u32;
            let predicted = observer.predict(config, angle, torque);
            observer.correct(config, predicted, angle);
            let estimate = observer.estimate(config);
            [estimate.shaft_torque, estimate.load_speed, estimate.load_torque]
        };
        (1..ticks).map(each).collect()
    }
    let (two_masses, rigid) = designs();
    if two {
        let config = TwoMassConfig::<f64>::new(&two_masses, Bases::SI);
        run::<TwoMassObserver<f64>>(&config, ticks, &mut tick, speed)
    } else {
        let config = RigidConfig::<f64>::new(&rigid, 0.5 / 1.7, Bases::SI);
        run::<RigidObserver<f64>>(&config, ticks, &mut tick, speed)
    }
}

fn both(of: impl Fn(bool, LoopObserver<'_>)) {
    let (two_masses, rigid) = designs();
    of(true, LoopObserver::TwoMass(&two_masses));
    of(false, LoopObserver::Rigid(&rigid));
}

/// Rms of the second half, about `truth`.
fn rms(values: &[[f64; 3]], truth: impl Fn(usize) -> [f64; 3]) -> [f64; 3] {
    let half = values.len() / 2;
    let mut squares = [0.0; 3];
    for (k, value) in values.iter().enumerate().skip(half) {
        let truth = truth(k + 1);
        for (square, (value, truth)) in squares.iter_mut().zip(value.iter().zip(truth)) {
            *square += (value - truth).powi(2);
        }
    }
    squares.map(|square| (square / (values.len() - half) as f64).sqrt())
}

#[track_caller]
fn near(found: [f64; 3], expected: EstimateError, tolerance: f64) {
    for (found, expected) in found.into_iter().zip([expected.shaft_torque, expected.load_speed, expected.load_torque]) {
        close(found, expected, tolerance);
    }
}

/// An eccentric encoder on a motor that turns steadily: the response of the observer that runs. A word of the angle is
/// 1.5e-9 rad, a millionth of the amplitude; the shaft's damping leaves nothing of the start.
#[test]
fn a_periodic_error_passes_as_predicted() {
    const AMPLITUDE: f64 = 1e-3;
    both(|two, observer| {
        let errors = predicted(observer, EXACT.eccentricity(AMPLITUDE), &Tolerance::NONE, 0.0).encoder;
        let angle = |k: usize| {
            let angle = 40.0 * PERIOD * k as f64;
            (angle + AMPLITUDE * (angle + 0.3).sin(), 0.0)
        };
        // whole turns in the second half: 157 ticks a turn
        let found = rms(&estimates(two, 40_000, angle, 40.0), |_| [0.0, 40.0, 0.0]);
        near(found, errors, 0.01);
    });
}

/// White noise of the reported torque. The slowest pole of the observers settles in some hundred ticks: 400,000 ticks
/// are thousands of independent values, whose rms is known to 1 to 2 %.
#[test]
fn noise_passes_as_predicted() {
    both(|two, observer| {
        let errors = predicted(observer, EXACT, &Tolerance::NONE, 2.0).noise;
        let mut noise = Noise::new(5);
        let ticks = estimates(two, 800_000, |k| (40.0 * PERIOD * k as f64, 2.0 * noise.normal()), 40.0);
        let found = rms(&ticks, |_| [0.0, 40.0, 0.0]);
        near(found, errors, 0.05);
    });
}

/// The swing of a stiffer machine, by its own closed form, after a start that the observer has forgotten.
#[test]
fn a_swing_of_another_machine_passes_as_predicted() {
    let other = machine(1.1, 0.8, 1.3);
    let tolerance = Tolerance {
        motor_inertia: Spread::between(1.1, 1.1),
        load_inertia: Spread::between(0.8, 0.8),
        stiffness: Spread::between(1.3, 1.3),
        ..Tolerance::NONE
    };
    both(|two, observer| {
        let errors = predicted(observer, EXACT, &tolerance, 0.0).swing;
        let (w, zeta) = (other.resonance(), other.damping_ratio());
        let turns = w * (1.0 - zeta * zeta).sqrt();
        // begins large, so that enough is left when the observer has settled
        let theta = |k: usize| {
            let time = PERIOD * k as f64;
            10.0 * (-zeta * w * time).exp() * (turns * time).cos()
        };
        let derivative = |k: usize| {
            let time = PERIOD * k as f64;
            let (sine, cosine) = (turns * time).sin_cos();
            -10.0 * (-zeta * w * time).exp() * (zeta * w * cosine + turns * sine)
        };
        // s^2 = -2 zeta w s - w^2
        let shaft = |k: usize| other.motor_inertia * (2.0 * zeta * w * derivative(k) + w * w * theta(k));
        let load = |k: usize| -other.motor_inertia / other.load_inertia * derivative(k);
        let ticks = estimates(two, 30_000, |k| (theta(k), 0.0), 0.0);
        let found = rms(&ticks, |k| [shaft(k), load(k), 0.0]);
        let size = rms(&vec![[0.0; 3]; 29_999], |k| [shaft(k), 0.0, 0.0])[0];
        // the prediction's own swing: its amplitude by the load cycle, rms until the next change
        let share = other.motor_inertia / other.total_inertia();
        let decays = 2.0 * zeta * w * OPERATION.cycle.every;
        let own = OPERATION.cycle.change * share * (0.5 * -(-decays).exp_m1() / decays).sqrt();
        near(found.map(|found| found / size * own), errors, 0.02);
    });
}

/// Draws of torque constant, offset, efficiency and inertias at a steady acceleration: what a motor of the drawn
/// machine does with the reported torque. 4,000 draws have an rms that is known to `1/sqrt(2 n)` = 1.1 %, the products
/// of two deviations add 5 % of 5 %.
#[test]
fn static_errors_are_those_of_draws() {
    const TOLERANCE: Tolerance = Tolerance { efficiency: 0.03, ..Tolerance::USUAL };
    let (two_masses, _) = designs();
    let predicted = predicted(LoopObserver::TwoMass(&two_masses), EXACT, &TOLERANCE, 0.0).statics;
    let mut noise = Noise::new(9);
    let (mut squares, draws) = ([0.0; 2], 4_000);
    for _ in 0..draws {
        let mut within = |spread: Spread| 1.0 + (spread.max - 1.0) * noise.uniform();
        let [gain, motor, load] = [TOLERANCE.torque, TOLERANCE.motor_inertia, TOLERANCE.load_inertia].map(&mut within);
        let (offset, loss) = (OPERATION.rated_torque * TOLERANCE.offset * noise.uniform(), 0.03 * noise.uniform());
        let acting = OPERATION.torque * (gain - loss) + offset;
        let true_shaft = acting - 1.2 * motor * OPERATION.acceleration;
        let true_load = true_shaft - 0.5 * load * OPERATION.acceleration;
        // an observer that has settled: its model's torques at the reported torque and the true acceleration
        let shaft = OPERATION.torque - 1.2 * OPERATION.acceleration;
        let load = shaft - 0.5 * OPERATION.acceleration;
        squares[0] += (shaft - true_shaft).powi(2) / f64::from(draws);
        squares[1] += (load - true_load).powi(2) / f64::from(draws);
    }
    close(squares[0].sqrt(), predicted.shaft_torque, 0.04);
    close(squares[1].sqrt(), predicted.load_torque, 0.04);
    assert_eq!(predicted.load_speed, 0.0);
}

/// One mass where it is as good in both quantities, and never in place of backlash.
#[test]
fn one_mass_is_taken_where_it_is_as_good() {
    let none = Penalty { shaft_torque: 1.0, load_speed: 1.0 };
    let of = |chosen| ObserverSelection { without_shaft: none, without_gap: none, semi_implicit: 0.0, chosen };
    let error = |shaft_torque, load_speed| EstimateError { shaft_torque, load_speed, load_torque: 9.0 };
    let chosen = |one: EstimateError, choice| of(choice).over_tolerances(&one, &error(2.0, 1.0)).chosen;
    use ObserverChoice::{Backlash, Exact, Rigid, SemiImplicit};
    assert_eq!(chosen(error(2.0, 1.0), Exact), Rigid);
    assert_eq!(chosen(error(2.0, 0.5), SemiImplicit), Rigid);
    assert_eq!(chosen(error(1.0, 1.2), SemiImplicit), SemiImplicit);
    assert_eq!(chosen(error(2.2, 0.5), Exact), Exact);
    assert_eq!(chosen(error(0.0, 0.0), Backlash), Backlash);
    assert_eq!(chosen(error(f64::NAN, 0.0), Exact), Exact);
}
