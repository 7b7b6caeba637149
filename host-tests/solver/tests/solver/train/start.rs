//! The start conditions `[derived; headings: Huang 1987 ch. 3 to 7]` by the train's solver:
//! `data/backlash_transients.json`, made with 40 digits.

use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{Coordinate, Friction, Link, Motion, Orders, Signal, Source, Train};
use driveline_solver::plant::{EventKind, LoadProgram, Place};
use serde::Deserialize;

#[derive(Deserialize)]
struct Cases {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Case {
    id: String,
    J1_kg_m2: f64,
    J2_kg_m2: f64,
    c_Nm_rad: f64,
    d_Nms_rad: f64,
    gap_total_rad: f64,
    load_law: String,
    M2_Nm: f64,
    motor: (String, f64),
    initial_theta_w1_w2: [f64; 3],
    t_end_s: f64,
    events: Vec<Expected>,
    peak_torque_Nm: f64,
    t_peak_s: f64,
    min_torque_Nm: f64,
    t_min_s: f64,
    rel_tol_peak: f64,
    trajectory: Vec<[f64; 4]>,
}

#[derive(Deserialize)]
struct Expected {
    t_s: f64,
    kind: String,
    new: i8,
}

fn cases() -> Vec<Case> {
    let file = include_str!("../../../../../tests/data/backlash_transients.json");
    serde_json::from_str::<Cases>(file).unwrap().cases
}

fn motion(case: &Case) -> Motion {
    assert!(case.motor.0 == "const" && ["active", "coulomb", "none"].contains(&case.load_law.as_str()), "{}", case.id);
    let [theta, w1, w2] = case.initial_theta_w1_w2;
    let load = Coordinate::new(case.J2_kg_m2).speed(w2);
    let load = if case.load_law == "active" { load.source(Source::Constant(-case.M2_Nm)) } else { load };
    let mut train = Train::new()
        .coordinate(Coordinate::new(case.J1_kg_m2).speed(w1).source(Source::Constant(case.motor.1)))
        .coordinate(load)
        .link(Link::shaft(0, 1, case.c_Nm_rad).damping(case.d_Nms_rad).gap(case.gap_total_rad).elongated(theta));
    if case.load_law == "coulomb" {
        train = train.friction(Friction::ground(1, case.M2_Nm));
    }
    train.build().unwrap()
}

#[test]
fn every_start_condition_of_the_cases_is_met_to_a_millionth_of_peak() {
    for case in &cases() {
        let mut motion = motion(case);
        motion.watch(Signal::Force(0));
        let top = case.peak_torque_Nm.abs().max(case.min_torque_Nm.abs());
        let fast = case.trajectory.iter().flat_map(|p| [p[1].abs(), p[2].abs()]).fold(0.0, f64::max);
        for &[t, w1, w2, torque] in case.trajectory.iter().filter(|point| point[0] > 0.0) {
            motion.advance(t - motion.time());
            let found = [(motion.speed(0), w1, fast), (motion.speed(1), w2, fast), (motion.force(0), torque, top)];
            for (found, expected, scale) in found {
                assert!(
                    (found - expected).abs() <= case.rel_tol_peak * scale,
                    "{} at {t}: {found} {expected}",
                    case.id
                );
            }
        }
        if case.t_end_s > motion.time() {
            motion.advance(case.t_end_s - motion.time());
        }
        let extremes = motion.extremes(Signal::Force(0)).unwrap();
        assert!((extremes.peak - case.peak_torque_Nm).abs() <= case.rel_tol_peak * top, "{} {extremes:?}", case.id);
        assert!((extremes.least - case.min_torque_Nm).abs() <= case.rel_tol_peak * top, "{} {extremes:?}", case.id);
        // an undamped drive meets its extremes again and again, so the times are checked by going there
        for (time, torque) in [(case.t_peak_s, case.peak_torque_Nm), (case.t_min_s, case.min_torque_Nm)] {
            let mut there = self::motion(case);
            if time > 0.0 {
                there.advance(time);
            }
            assert!((there.force(0) - torque).abs() <= case.rel_tol_peak * top, "{} at {time}", case.id);
        }
    }
}

#[test]
fn events_of_the_cases_come_in_time_and_every_run_is_proven() {
    for case in &cases() {
        let mut run = Recording::new(motion(case));
        (0..2000).for_each(|_| run.advance(case.t_end_s / 2000.0));
        let events = run.motion().events();
        assert_eq!(events.len(), case.events.len(), "{} {events:?}", case.id);
        for (event, expected) in events.iter().zip(&case.events) {
            let (kind, place) = match expected.kind.as_str() {
                "contact" => (EventKind::Contact, Place::Shaft(0)),
                "stop" => (EventKind::Stop, Place::Node(1)),
                "slip" => (EventKind::Slip, Place::Node(1)),
                other => panic!("kind {other}"),
            };
            assert_eq!((event.kind, event.place, event.new), (kind, place, expected.new), "{}", case.id);
            // each is located to 1e-14 s, and 28 of them follow on one another in the longest case
            assert!((event.time - expected.t_s).abs() < 1e-11, "{} {event:?} {}", case.id, expected.t_s);
        }
        prove(&run).unwrap_or_else(|refused| panic!("{}: {refused}", case.id));
    }
}

#[test]
fn a_pretensioned_branch_and_a_slack_one_begin_as_they_say() {
    let train = || {
        Train::new()
            .coordinate(Coordinate::new(2.0).source(Source::Constant(500.0)))
            .coordinate(Coordinate::new(1.0).source(Source::Constant(-60.0)))
            .coordinate(Coordinate::new(3.0).source(Source::Constant(-90.0)))
            .link(Link::geared(0, 1, 3.0, 400.0).gap(0.1))
            .link(Link::shaft(0, 2, 900.0).gap(0.02))
    };
    // held at the motor, each branch carries its load: behind a gear of three a third of it
    let motion = train().pretensioned(0).unwrap().build().unwrap();
    let expected = [(20.0, 20.0 / 400.0 + 0.05), (90.0, 0.1 + 0.01)];
    for (link, (force, elongation)) in expected.into_iter().enumerate() {
        // solved to rounding
        assert!((motion.force(link) - force).abs() < 1e-11, "{}", motion.force(link));
        assert!((motion.elongation(link) - elongation).abs() < 1e-14);
    }
    let mut motion = train().slack().build().unwrap();
    assert_eq!((motion.elongation(0), motion.elongation(1)), (-0.05, -0.01));
    motion.advance(0.2);
    let met = |link: usize| {
        let place = Place::Shaft(link);
        motion.events().iter().find(|event| event.place == place && event.new == 1).map(|event| event.time)
    };
    // free flight: both ends accelerate, the second link closes 0.02 at 500/2 + 90/3 rad/s2
    let expected = (2.0 * 0.02 / (250.0 + 30.0_f64)).sqrt();
    assert!((met(1).unwrap() - expected).abs() < 1e-12, "{:?}", met(1));
    assert!(met(0).is_some());
}

#[test]
fn a_pretension_that_nothing_can_hold_is_refused_with_its_reason() {
    let loose =
        Train::new().coordinate(Coordinate::new(2.0)).coordinate(Coordinate::new(1.0).source(Source::Constant(-60.0)));
    let reason = loose.clone().pretensioned(0).unwrap_err().to_string();
    assert!(reason.contains("nothing holds"), "{reason}");
    let rope = loose.link(Link::shaft(1, 0, 100.0).rope());
    let reason = rope.pretensioned(0).unwrap_err().to_string();
    assert!(reason.contains("a rope cannot push"), "{reason}");
}

#[test]
fn after_a_sudden_loss_of_load_a_shaft_swings_about_its_inertia_share() {
    // pretensioned with 120 N m, the load vanishes at 10 ms: about what the free drive carries, K by the closed form
    let (j1, j2, k, load) = (1.2, 0.35, 850.0, 120.0);
    let program = LoadProgram::steps(&[(0.0, -load), (0.01, 0.0)]);
    let train = Train::new()
        .coordinate(Coordinate::new(j1).source(Source::Constant(load)))
        .coordinate(Coordinate::new(j2).source(Source::Program(program)))
        .link(Link::shaft(0, 1, k));
    let mut motion = train.pretensioned(0).unwrap().build().unwrap();
    motion.watch(Signal::Force(0));
    motion.advance(1.0);
    // mean torque T J2/(J1 + J2), swing from the static torque about it
    let mean = load * j2 / (j1 + j2);
    let extremes = motion.extremes(Signal::Force(0)).unwrap();
    assert!(
        (extremes.peak - load).abs() < 1e-10 && (extremes.least - (2.0 * mean - load)).abs() < 1e-10,
        "{extremes:?}"
    );
    assert!(motion.events().iter().all(|event| event.kind != EventKind::Contact));
}

/// Behind a mechanism a link carries the load as behind any rotor.
#[test]
fn the_inertia_of_a_mechanism_takes_no_part_in_a_pretension() {
    let law = Orders::sampled(|angle| 2.0 + angle.cos());
    let press = Coordinate::new(1.0).angle(1.0).inertia_law(law).source(Source::Constant(-100.0));
    let train = Train::new().coordinate(Coordinate::new(1.0)).coordinate(press).link(Link::shaft(0, 1, 1000.0));
    let motion = train.pretensioned(0).unwrap().build().unwrap();
    // solved to rounding
    assert!((motion.force(0) - 100.0).abs() < 1e-11, "{}", motion.force(0));
}
