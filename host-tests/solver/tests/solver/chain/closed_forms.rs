//! The solver against closed forms: dynamic factors, impacts, conservation, friction, gear losses.

use std::f64::consts::PI;

use driveline_solver::plant::train::{Signal, Source};
use driveline_solver::plant::{Chain, EventKind, LoadProgram, Place, Plant, Shaft, Start};

/// Undamped: closed forms hold to rounding, of which a few hundred exact steps gather well below this.
const ROUNDING: f64 = 1e-12;

fn run(plant: &mut Plant, torque: f64, dt: f64, ticks: usize) {
    for _ in 0..ticks {
        plant.advance(torque, dt);
    }
}

fn close(found: f64, expected: f64, scale: f64) {
    let share = (found - expected).abs() / scale;
    assert!(share <= ROUNDING, "{found} for {expected}: {share:e} of {scale}");
}

#[test]
fn a_step_on_a_locked_load_doubles_the_static_torque() {
    // K = 2 [derived; headings: Huang 1987 ch. 3 to 7]; the load is locked by a brake that never slips
    let mut plant = Chain::motor(0.5).shaft(Shaft::elastic(800.0), 3.0).build().unwrap();
    plant.set_brake(1, 1.0e6);
    plant.watch(Signal::Force(0));
    run(&mut plant, 70.0, 1e-3, 300);
    let extremes = plant.extremes(Signal::Force(0)).unwrap();
    close(extremes.peak, 140.0, 140.0);
    close(extremes.least, 0.0, 140.0);
    assert_eq!(plant.speed(1), 0.0);
    // held by friction, the load feels all of the shaft's torque
    close(plant.load_torque(1), plant.shaft_torque(0), 140.0);
}

#[test]
fn masses_that_meet_at_a_relative_speed_add_the_impact_torque() {
    // tau = d_omega sqrt(k J1 J2/(J1 + J2)) [derived; headings: Huang 1987 ch. 3 to 7]
    let (j1, j2, k, speed) = (0.7, 0.3, 1500.0_f64, 6.0);
    let start = Start::Given { twists: vec![-0.02], speeds: vec![speed, 0.0] };
    let chain = Chain::motor(j1).shaft(Shaft::elastic(k).gap(0.04), j2).start(start);
    let mut plant = chain.build().unwrap();
    plant.watch(Signal::Force(0));
    run(&mut plant, 0.0, 1e-3, 60);
    let peak = speed * (k * j1 * j2 / (j1 + j2)).sqrt();
    close(plant.extremes(Signal::Force(0)).unwrap().peak, peak, peak);
    // met after the gap at that speed, left half a period later
    let times: Vec<f64> = plant.events().iter().map(|e| e.time).collect();
    let omega = (k * (j1 + j2) / (j1 * j2)).sqrt();
    // events are located to 1e-14 s
    assert!((times[0] - 0.04 / speed).abs() < 1e-12 && (times[1] - times[0] - PI / omega).abs() < 1e-12);
}

#[test]
fn a_pretensioned_start_at_speed_is_steady_when_the_motor_carries_the_load() {
    let mut plant = Chain::motor(0.5)
        .viscous(0.02)
        .efficiency(0.9)
        .shaft(Shaft::elastic(900.0).damping(0.3).gap(0.01), 0.2)
        .coulomb(5.0)
        .shaft(Shaft::rope(300.0).gap(0.3), 0.4)
        .load(36.0)
        .start(Start::Pretensioned { speed: 40.0 })
        .build()
        .unwrap();
    let torque = (36.0 + 5.0) / 0.9 + 0.02 * 40.0;
    run(&mut plant, torque, 1e-3, 500);
    for node in 0..3 {
        close(plant.speed(node), 40.0, 40.0);
    }
    close(plant.shaft_torque(0), 41.0 / 0.9, torque);
    close(plant.shaft_torque(1), 36.0, torque);
    assert!(plant.events().is_empty(), "{:?}", plant.events());
}

#[test]
fn momentum_and_energy_stay_over_a_hundred_thousand_ticks() {
    let start = Start::Given { twists: vec![0.02, -0.01], speeds: vec![30.0, 25.0, 28.0] };
    let chain = Chain::motor(0.62).shaft(Shaft::elastic(5.0e4), 0.08).shaft(Shaft::elastic(900.0), 0.35);
    let mut plant = chain.start(start).build().unwrap();
    let (momentum, energy) = (plant.momentum(), plant.energy());
    run(&mut plant, 0.0, 1e-4, 100_000);
    let (p, e) = (plant.momentum() / momentum - 1.0, plant.energy() / energy - 1.0);
    println!("after 1e5 ticks momentum is off by {p:.1e}, energy by {e:.1e}");
    // one rounding of 1e-16 a tick, all of one sign at the worst
    assert!(p.abs() < 1e-11 && e.abs() < 2e-11, "{p:e} {e:e}");
    // 1e5 steps of 1e-4 s
    close(plant.time(), 10.0, 10.0);
}

#[test]
fn momentum_and_energy_stay_through_thousands_of_impacts() {
    let start = Start::Given { twists: vec![0.0, 0.0], speeds: vec![6.0, -2.0, 1.0] };
    let chain =
        Chain::motor(0.62).shaft(Shaft::elastic(5.0e4).gap(0.01), 0.08).shaft(Shaft::elastic(900.0).gap(0.02), 0.35);
    let mut plant = chain.start(start).build().unwrap();
    let (momentum, energy) = (plant.momentum(), plant.energy());
    run(&mut plant, 0.0, 1e-3, 20_000);
    let (p, e) = (plant.momentum() / momentum - 1.0, plant.energy() / energy - 1.0);
    println!("after {} impacts momentum is off by {p:.1e}, energy by {e:.1e}", plant.events().len());
    assert!(plant.events().len() > 1000);
    // an event found 1e-14 s late puts some k d_omega^2 (1e-14)^2 astray, rounding 1e-16 per step
    assert!(p.abs() < 1e-11 && e.abs() < 1e-10, "{p:e} {e:e}");
}

#[test]
fn a_lossy_gear_drives_at_its_efficiency_holds_and_is_driven_at_it() {
    // a mass on a gear of eta = 0.8 with 100 N m behind it: it rises above 125, stays between 80 and 125, sinks below
    lossy(0.8, 0.8, [140.0, 124.0, 81.0, 60.0]);
    // a worm keeps less backwards, 0.6: it sinks below 60
    lossy(0.8, 0.6, [140.0, 124.0, 61.0, 40.0]);
    // and this one takes its loss backwards alone
    lossy(1.0, 0.6, [140.0, 99.0, 61.0, 40.0]);
}

/// A mass on a gear with 100 N m behind it, under torques at which it rises, holds twice, and sinks.
fn lossy(eta: f64, back: f64, [rises, holds, holds_too, sinks]: [f64; 4]) {
    let build = || {
        Chain::motor(1.0)
            .efficiency(eta)
            .back_efficiency(back)
            .shaft(Shaft::elastic(1.0e4).damping(60.0), 2.0)
            .load(100.0)
            .start(Start::Pretensioned { speed: 0.0 })
            .build()
            .unwrap()
    };
    for (torque, acceleration) in [
        // at rest behind a well damped shaft: J1 + J2/eta, or J1 + J2 eta backwards [Huang 1987 tables 1-2 to 1-4]
        (rises, (rises - 100.0 / eta) / (1.0 + 2.0 / eta)),
        (holds, 0.0),
        (holds_too, 0.0),
        (sinks, (sinks - 100.0 * back) / (1.0 + 2.0 * back)),
    ] {
        let mut plant = build();
        run(&mut plant, torque, 1e-3, 4000);
        let before = plant.motor_speed();
        run(&mut plant, torque, 1e-3, 1000);
        // the difference of two speeds of up to 25 rad/s
        close(plant.motor_speed() - before, acceleration, 25.0);
        if acceleration == 0.0 {
            assert_eq!(plant.motor_speed(), 0.0);
            // the gear takes just what the motor gives
            close(plant.shaft_torque(0), torque, 100.0);
        }
    }
}

#[test]
fn a_brake_stops_a_rotor_in_the_textbook_time_and_lets_go() {
    // J domega/dt = -M: from 20 rad/s with 10 N m on 0.5 + 1.5 kg m2 in 4 s
    let start = Start::Given { twists: vec![0.0], speeds: vec![20.0, 20.0] };
    // a brake on both ends in the ratio of the inertias leaves the shaft without torque
    let mut plant = Chain::motor(0.5).shaft(Shaft::elastic(500.0), 1.5).start(start).build().unwrap();
    plant.set_brake(0, 2.5);
    plant.set_brake(1, 7.5);
    run(&mut plant, 0.0, 1e-2, 500);
    let stops: Vec<f64> = plant.events().iter().filter(|e| e.kind == EventKind::Stop).map(|e| e.time).collect();
    assert_eq!(stops.len(), 2, "{:?}", plant.events());
    // the last tick of rounding in the twist shifts the stop of one mass: 1e-15 rad k / 10 N m s
    assert!(stops.iter().all(|t| (t - 4.0).abs() < 1e-11), "{stops:?}");
    run(&mut plant, 2.0, 1e-2, 10);
    assert_eq!((plant.speed(0), plant.speed(1)), (0.0, 0.0));
    plant.set_brake(0, 0.0);
    plant.set_brake(1, 0.0);
    run(&mut plant, 2.0, 1e-2, 100);
    // 2 N m on 2 kg m2 for one second
    close(plant.momentum(), 2.0, 2.0);
}

#[test]
fn laws_and_programs_bring_the_impulse_of_their_area() {
    let chain = || Chain::motor(0.6).shaft(Shaft::elastic(700.0).damping(1.0), 0.4);
    let ramp = Source::Starting { torque: 30.0, time: 0.7, power: 1 };
    let mut plant = chain().motor_law(ramp).build().unwrap();
    run(&mut plant, 0.0, 0.03, 40);
    close(plant.momentum(), 0.5 * 30.0 * 0.7, 10.0);

    let table = LoadProgram::table(&[(0.1, 0.0), (0.25, 12.0), (0.55, 12.0), (0.6, 0.0)]);
    let mut plant = chain().program(table).build().unwrap();
    run(&mut plant, 0.0, 0.03, 40);
    close(plant.momentum(), -12.0 * (0.075 + 0.3 + 0.025), 10.0);

    let steps = LoadProgram::steps(&[(0.1, 5.0), (0.25, -3.0), (0.55, 0.0)]);
    let mut plant = chain().program(steps).build().unwrap();
    run(&mut plant, 0.0, 0.03, 40);
    close(plant.momentum(), -(0.15 * 5.0 - 0.3 * 3.0), 10.0);

    // a - b w on the whole inertia: w = a/b (1 - exp(-b t/J)), once the shaft has come to rest
    let line = Source::Line { stall: 30.0, slope: 0.5 };
    let mut plant = chain().motor_law(line).build().unwrap();
    run(&mut plant, 0.0, 0.01, 10_000);
    close(plant.motor_speed(), 60.0, 60.0);
}

#[test]
fn a_rope_lifts_when_it_comes_taut_and_falls_slack_when_let_go() {
    // the load lies on the ground: dry friction cannot push it down, so its weight stands in as friction
    let mut plant =
        Chain::motor(0.5).shaft(Shaft::rope(400.0).gap(0.5), 0.2).coulomb(20.0).start(Start::Slack).build().unwrap();
    run(&mut plant, 10.0, 1e-3, 100);
    assert_eq!((plant.shaft_torque(0), plant.speed(1)), (0.0, 0.0));
    run(&mut plant, 10.0, 1e-3, 200);
    let taut = plant.events()[0];
    assert_eq!((taut.kind, taut.place, taut.new), (EventKind::Contact, Place::Shaft(0), 1));
    // half a radian at 20 rad/s2; located to 1e-14 s
    assert!((taut.time - (2.0_f64 * 0.5 / 20.0).sqrt()).abs() < 1e-12);
    plant.watch(Signal::Force(0));
    run(&mut plant, -40.0, 1e-3, 400);
    assert!(plant.events().iter().any(|e| e.kind == EventKind::Contact && e.new == 0));
    // never pushes
    // it leaves within 1e-14 s, in which its torque of 400 N m/rad falls by less than this
    assert!(plant.extremes(Signal::Force(0)).unwrap().least > -1e-10);
    assert!(plant.twist(0) < 0.5);
}
