//! Starts, reversal and loss of load of a two-mass drive against runs made with 40-digit matrix exponentials
//! (`data/backlash_transients.json`; its header has the equations).

use host_tests::plant::{Chain, EventKind, Extremes, MotorLaw, Place, Plant, Shaft, Start};
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
    let text = include_str!("data/backlash_transients.json");
    serde_json::from_str::<Cases>(text).unwrap().cases
}

fn plant(case: &Case) -> Plant {
    let shaft = Shaft::elastic(case.c_Nm_rad)
        .damping(case.d_Nms_rad)
        .gap(case.gap_total_rad);
    let chain = Chain::motor(case.J1_kg_m2).shaft(shaft, case.J2_kg_m2);
    let chain = match case.load_law.as_str() {
        "active" => chain.load(case.M2_Nm),
        "coulomb" => chain.coulomb(case.M2_Nm),
        "none" => chain,
        other => panic!("load law {other}"),
    };
    assert_eq!(case.motor.0, "const");
    let [theta, w1, w2] = case.initial_theta_w1_w2;
    chain
        .start(Start::Given {
            twists: vec![theta],
            speeds: vec![w1, w2],
        })
        .motor_law(MotorLaw::Constant(case.motor.1))
        .build()
        .unwrap()
}

fn peak(case: &Case) -> f64 {
    case.peak_torque_Nm.abs().max(case.min_torque_Nm.abs())
}

#[test]
fn trajectories_agree_with_the_reference() {
    for case in cases() {
        let mut plant = plant(&case);
        let mut worst = [0.0_f64; 3];
        let top_speed = case
            .trajectory
            .iter()
            .flat_map(|p| [p[1].abs(), p[2].abs()])
            .fold(0.0, f64::max);
        for &[t, w1, w2, torque] in &case.trajectory {
            // uneven ticks on purpose: the grid of the reference is not the solver's
            plant.advance(0.0, t - plant.time());
            let found = [plant.speed(0), plant.speed(1), plant.shaft_torque(0)];
            for ((worst, found), (expected, scale)) in worst.iter_mut().zip(found).zip([
                (w1, top_speed),
                (w2, top_speed),
                (torque, peak(&case)),
            ]) {
                *worst = worst.max((found - expected).abs() / scale);
            }
        }
        println!(
            "{}: largest deviation of w1, w2, torque over their peaks {worst:?}",
            case.id
        );
        // the tolerance that the file sets: 1e-6 of peak
        assert!(
            worst.iter().all(|w| *w <= case.rel_tol_peak),
            "{} {worst:?}",
            case.id
        );
    }
}

#[test]
fn events_come_when_and_as_the_reference_says() {
    for case in cases() {
        let mut plant = plant(&case);
        while plant.time() < case.t_end_s {
            plant.advance(0.0, 1e-3_f64.min(case.t_end_s - plant.time()));
        }
        assert_eq!(
            plant.events().len(),
            case.events.len(),
            "{} {:?}",
            case.id,
            plant.events()
        );
        let mut worst = 0.0_f64;
        for (event, expected) in plant.events().iter().zip(&case.events) {
            let (kind, place) = match expected.kind.as_str() {
                "contact" => (EventKind::Contact, Place::Shaft(0)),
                "stop" => (EventKind::Stop, Place::Node(1)),
                "slip" => (EventKind::Slip, Place::Node(1)),
                other => panic!("kind {other}"),
            };
            assert_eq!(
                (event.kind, event.place, event.new),
                (kind, place, expected.new),
                "{}",
                case.id
            );
            worst = worst.max((event.time - expected.t_s).abs());
        }
        println!(
            "{}: {} events, largest error of a time {worst:.1e} s",
            case.id,
            case.events.len()
        );
        // each event is located to 1e-13 s, and 28 of them follow on one another in the longest case
        assert!(worst < 1e-11, "{} {worst:e}", case.id);
    }
}

#[test]
fn peaks_are_found_between_the_ticks() {
    for case in cases() {
        let start = plant(&case);
        let mut watched = start.clone();
        watched.watch_extremes();
        // ticks of about an eighth of a period, so that no tick ends on a peak
        while watched.time() < case.t_end_s {
            watched.advance(0.0, 0.0137_f64.min(case.t_end_s - watched.time()));
        }
        let Extremes {
            peak: most, least, ..
        } = watched.extremes(0).unwrap();
        // the tolerance that the file sets: 1e-6 of peak
        let tolerance = case.rel_tol_peak * peak(&case);
        assert!(
            (most - case.peak_torque_Nm).abs() <= tolerance,
            "{} peak {most}",
            case.id
        );
        assert!(
            (least - case.min_torque_Nm).abs() <= tolerance,
            "{} least {least}",
            case.id
        );
        // an undamped drive meets its extremes again and again, so the times are checked by going there
        for (time, torque) in [
            (case.t_peak_s, case.peak_torque_Nm),
            (case.t_min_s, case.min_torque_Nm),
        ] {
            let mut there = start.clone();
            if time > 0.0 {
                there.advance(0.0, time);
            }
            assert!(
                (there.shaft_torque(0) - torque).abs() <= tolerance,
                "{} at {time}",
                case.id
            );
        }
    }
}
