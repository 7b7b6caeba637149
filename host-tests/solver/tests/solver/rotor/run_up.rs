//! Runs in time, proven by another integrator.

use driveline_solver::plant::{Chain, LoadProgram, Shaft};
use driveline_solver::rotor::converge::{BOUND, Recording, prove};
use driveline_solver::rotor::{Bearing, Modal, Polar, Ripple, Spin, Turn, Whirl};
use nalgebra::Complex;

use super::rig::{BEARING, three_discs};

const UNBALANCE: [(f64, f64); 3] = [(1.8e-4, 35.0), (4.2e-4, 250.0), (2.5e-4, 160.0)];

fn unbalance() -> Vec<Complex<f64>> {
    UNBALANCE.iter().map(|&(size, angle)| Polar::degrees(size, angle)).collect()
}

/// The rotor's eight lowest vibrations, those below 600 Hz: DOP853 takes the others at its leisure only.
fn eight(bearing: Bearing) -> Modal {
    Modal::of(&three_discs(bearing).build().unwrap()).unwrap().lowest(8)
}

#[test]
fn a_run_up_through_the_first_critical_is_proven() {
    // 21.55 Hz is passed at 135 rad/s
    let spin = Spin::through(&[(0.0, 60.0), (2.5, 200.0)]).unwrap();
    for bearing in [BEARING, Bearing::anisotropic([4e6, 1.5e6], [2500.0, 600.0])] {
        // the second critical is the one along x: with the spin, or of the stiffer direction
        let modal = eight(bearing);
        let mut whirl = Whirl::new(modal.clone(), 1e-4);
        whirl.set_unbalance(&unbalance()).unwrap();
        whirl.settle(0.0, 60.0).unwrap();
        let mut run = Recording::new(whirl);
        let mut peak = (0.0, 0.0);
        for tick in 0..25_000 {
            let turn = spin.turn(f64::from(tick) * 1e-4, 1e-4);
            run.advance(&turn);
            let motion = run.whirl().motion(0).unwrap().displacement.abs();
            if motion > peak.1 {
                peak = (turn.end_speed, motion);
            }
        }
        assert!(prove(&run).unwrap() <= BOUND);
        // the peak comes late [Lewis 1932, Trans. ASME 54, 253-261], by some square roots of the rate, 7.5 rad/s
        let critical = three_discs(bearing).build().unwrap().criticals(200.0)[1].speed;
        assert!(peak.0 > critical && peak.0 < critical + 3.0 * 7.5, "{peak:?} {critical}");
    }
}

#[test]
fn ripple_and_a_moving_weight_are_proven() {
    let spin = Spin::steady(111.2).ripple(Ripple { order: 1.0, share: 0.01, phase: 0.3 }).ripple(Ripple {
        order: 6.0,
        share: 0.005,
        phase: 2.0,
    });
    let mut run = Recording::new(Whirl::new(eight(BEARING), 1e-4));
    for tick in 0..6_000 {
        let moved = f64::from(tick) / 6_000.0;
        let mut u = unbalance();
        u[1] += Polar::degrees(3e-4 * moved, 100.0 * moved);
        run.whirl().set_unbalance(&u).unwrap();
        run.advance(&spin.turn(f64::from(tick) * 1e-4, 1e-4));
    }
    assert!(prove(&run).unwrap() <= BOUND);
}

#[test]
fn a_run_that_is_wrong_is_found() {
    let spin = Spin::steady(111.2);
    let mut whirl = Whirl::new(eight(BEARING), 1e-4);
    whirl.set_unbalance(&unbalance()).unwrap();
    let mut run = Recording::new(whirl);
    for tick in 0..200 {
        // the rotor is told another duration than that of its ticks
        let turn = spin.turn(f64::from(tick) * 1e-4, 1e-4);
        run.advance(&Turn { duration: 1.001e-4, ..turn });
    }
    assert!(prove(&run).is_err());
}

#[test]
fn the_whole_rotor_runs_as_its_lowest_vibrations_and_what_they_leave_out() {
    // Of the steady vibration the eight lowest leave out what the others give: at 1062 r/min a part of (17.7 Hz/600
    // Hz)^2 = 1e-3 of what moves the discs statically.
    let model = three_discs(BEARING).build().unwrap();
    let truth = model.response(111.2, &unbalance()).unwrap();
    let mut errors = Vec::new();
    for count in [8, 16, 32, 52] {
        let mut whirl = Whirl::new(Modal::of(&model).unwrap().lowest(count), 1e-4);
        whirl.set_unbalance(&unbalance()).unwrap();
        whirl.settle(0.0, 111.2).unwrap();
        let found = whirl.motion(0).unwrap().displacement;
        errors.push((found - truth[0].re).abs() / truth[0].norm());
    }
    assert!(errors[0] < 1e-2 && errors[1] < errors[0] && errors[2] < errors[1], "{errors:?}");
    // all of them are the model: rounding at stiffnesses that span 1e9
    assert!(errors[3] < 1e-9, "{errors:?}");
}

#[test]
fn the_ripple_of_a_drivetrain_reaches_the_rotor() {
    // A motor drives the rotor through a coupling against a load that throbs nine times in the time of a turn: a mean
    // of 40 N m.
    let beat = 9.0 * 100.0;
    let table: Vec<(f64, f64)> =
        (0..2_000).map(|k| (f64::from(k) * 5e-4, 40.0 + 30.0 * (beat * f64::from(k) * 5e-4).sin())).collect();
    let mut drive = Chain::motor(0.4)
        .shaft(Shaft::elastic(3.0e3).damping(1.0), 1.04)
        .program(LoadProgram::table(&table))
        .start(driveline_solver::plant::Start::Given { twists: vec![40.0 / 3.0e3], speeds: vec![100.0; 2] })
        .build()
        .unwrap();
    let mut whirl = Whirl::new(eight(BEARING), 1e-4);
    whirl.set_unbalance(&unbalance()).unwrap();
    whirl.settle(drive.angle(1), drive.speed(1)).unwrap();
    let mut run = Recording::new(whirl);
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for _ in 0..6_000 {
        let (angle, speed) = (drive.angle(1), drive.speed(1));
        drive.advance(40.0 + 20.0 * (100.0 - drive.motor_speed()), 1e-4);
        let turn = Turn { angle, speed, end_angle: drive.angle(1), end_speed: drive.speed(1), duration: 1e-4 };
        run.advance(&turn);
        (low, high) = (low.min(turn.end_speed), high.max(turn.end_speed));
    }
    assert!(high - low > 0.02, "no ripple: {low} to {high}");
    assert!(prove(&run).unwrap() <= BOUND);
}
