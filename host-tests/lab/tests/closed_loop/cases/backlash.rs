//! Starts, reversal and loss of load of a two-mass drive against runs made with 40-digit matrix exponentials
//! (`data/backlash_transients.json`; its header has the equations).

use driveline_lab::cases::transients::{Transient, transients};
use driveline_solver::plant::{EventKind, Extremes, Place, Plant};

fn cases() -> Vec<Transient> {
    transients().unwrap()
}

fn plant(case: &Transient) -> Plant {
    case.plant().unwrap()
}

#[test]
fn trajectories_agree_with_the_reference() {
    for case in cases() {
        let worst = case.deviations().unwrap();
        println!("{}: largest deviation of w1, w2, torque over their peaks {worst:?}", case.id);
        // the tolerance that the file sets: 1e-6 of peak
        assert!(worst.iter().all(|w| *w <= case.rel_tol_peak), "{} {worst:?}", case.id);
    }
}

#[test]
fn events_come_when_and_as_the_reference_says() {
    for case in cases() {
        let mut plant = plant(&case);
        while plant.time() < case.t_end_s {
            plant.advance(0.0, 1e-3_f64.min(case.t_end_s - plant.time()));
        }
        assert_eq!(plant.events().len(), case.events.len(), "{} {:?}", case.id, plant.events());
        let mut worst = 0.0_f64;
        for (event, expected) in plant.events().iter().zip(&case.events) {
            let (kind, place) = match expected.kind.as_str() {
                "contact" => (EventKind::Contact, Place::Shaft(0)),
                "stop" => (EventKind::Stop, Place::Node(1)),
                "slip" => (EventKind::Slip, Place::Node(1)),
                other => panic!("kind {other}"),
            };
            assert_eq!((event.kind, event.place, event.new), (kind, place, expected.new), "{}", case.id);
            worst = worst.max((event.time - expected.t_s).abs());
        }
        println!("{}: {} events, largest error of a time {worst:.1e} s", case.id, case.events.len());
        // each event is located to 1e-14 s, and 28 of them follow on one another in the longest case
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
        let Extremes { peak: most, least, .. } = watched.extremes(0).unwrap();
        // the tolerance that the file sets: 1e-6 of peak
        let tolerance = case.rel_tol_peak * case.peak();
        assert!((most - case.peak_torque_Nm).abs() <= tolerance, "{} peak {most}", case.id);
        assert!((least - case.min_torque_Nm).abs() <= tolerance, "{} least {least}", case.id);
        // an undamped drive meets its extremes again and again, so the times are checked by going there
        for (time, torque) in [(case.t_peak_s, case.peak_torque_Nm), (case.t_min_s, case.min_torque_Nm)] {
            let mut there = start.clone();
            if time > 0.0 {
                there.advance(0.0, time);
            }
            assert!((there.shaft_torque(0) - torque).abs() <= tolerance, "{} at {time}", case.id);
        }
    }
}

#[test]
fn every_run_proves_its_own_convergence() {
    for case in cases() {
        // 1e-8 of peak, or it is refused
        let proof = case.proof().unwrap().unwrap_or_else(|refused| panic!("{}: {refused}", case.id));
        println!("{}: {:.1e} of peak from the second integrator or from tighter events", case.id, proof.largest());
    }
}
