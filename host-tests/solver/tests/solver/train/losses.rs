//! Gears that lose power, each with a closed form.

use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{Coordinate, Link, Source, Train};

/// Motor, load (kg m2), its weight (N m) and the shaft (N m/rad).
const MOTOR: f64 = 0.5;
const LOAD: f64 = 2.0;
const WEIGHT: f64 = 60.0;
const STIFFNESS: f64 = 900.0;

/// A load that falls over a worm, in steady acceleration from the start.
fn falling(link: Link, force: f64) -> Recording {
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR).speed(-0.1))
        .coordinate(Coordinate::new(LOAD).speed(-0.1).source(Source::Constant(-WEIGHT)))
        .link(link.elongated(force / STIFFNESS))
        .build()
        .unwrap();
    Recording::new(motion)
}

/// The load drives: of its force F the motor gets eta' F. With `J_1 a = eta' F` and `J_2 a = W - F` the acceleration is
/// `eta' W/(J_1 + eta' J_2)`.
#[test]
fn a_worm_has_its_own_efficiency_when_the_load_drives() {
    for back in [0.3, 0.8, 1.0] {
        let acceleration = back * WEIGHT / (MOTOR + back * LOAD);
        let link = Link::shaft(0, 1, STIFFNESS).efficiency(0.5).back_efficiency(back);
        let mut run = falling(link, WEIGHT - LOAD * acceleration);
        for _ in 0..100 {
            run.advance(0.01);
        }
        for coordinate in 0..2 {
            let (speed, expected) = (run.motion().speed(coordinate), -0.1 - acceleration);
            // the solver's roundings over a thousand stretches
            assert!((speed / expected - 1.0).abs() < 1e-11, "{back}: {speed} {expected}");
        }
        prove(&run).unwrap();
    }
}

/// A worm that locks itself: at `eta = 0.4` it has `eta' = 2 - 1/eta = -0.5`, and the motor stands still. The load
/// swings on the shaft that was slack, by `W/k (1 - cos(w t))`.
#[test]
fn a_self_locking_worm_holds_its_load() {
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR))
        .coordinate(Coordinate::new(LOAD).source(Source::Constant(-WEIGHT)))
        .link(Link::shaft(0, 1, STIFFNESS).efficiency(0.4).back_efficiency(-0.5))
        .build()
        .unwrap();
    let mut run = Recording::new(motion);
    let omega = (STIFFNESS / LOAD).sqrt();
    for step in 1..=100 {
        run.advance(0.01);
        let (expected, found) = (WEIGHT * (1.0 - (omega * 0.01 * f64::from(step)).cos()), run.motion().force(0));
        assert!((found - expected).abs() < 1e-10 * WEIGHT, "{step}: {found} {expected}");
        assert_eq!(run.motion().speed(0), 0.0, "{step}");
    }
    prove(&run).unwrap();
}

/// A lossy gear on a motor at rest is started by its torque, and proven: with `T` at the motor and nothing on the load,
/// both turn with `T/(J_1 + J_2/eta)` once the swing is taken off: their momentum weighted by the loss.
#[test]
fn a_lossy_gear_starts_from_rest() {
    let (torque, eta) = (10.0, 0.9);
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR).source(Source::Constant(torque)))
        .coordinate(Coordinate::new(LOAD))
        .link(Link::shaft(0, 1, STIFFNESS).efficiency(eta))
        .build()
        .unwrap();
    let mut run = Recording::new(motion);
    for _ in 0..50 {
        run.advance(0.01);
    }
    let motion = run.motion();
    // While the motor drives all the time, J_1 w_1 + J_2 w_2/eta = T t.
    let momentum = MOTOR * motion.speed(0) + LOAD * motion.speed(1) / eta;
    assert!((momentum / (torque * 0.5) - 1.0).abs() < 1e-11, "{momentum} {:?}", motion.events());
    prove(&run).unwrap();
}

/// Nothing moves and nothing pulls: a lossy gear at rest has no events.
#[test]
fn a_lossy_gear_at_rest_stays_there() {
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR))
        .coordinate(Coordinate::new(LOAD))
        .link(Link::shaft(0, 1, STIFFNESS).efficiency(0.9))
        .build()
        .unwrap();
    let mut run = Recording::new(motion);
    run.advance(1.0);
    assert_eq!((run.motion().events().len(), run.motion().speed(0)), (0, 0.0));
    prove(&run).unwrap();
}
