//! The proof of convergence: it passes what is changed on the way, and it fails a run with coarse events.

use driveline_solver::plant::converge::{BOUND, NotProven, Proof, Recording, prove};
use driveline_solver::plant::train::Source;
use driveline_solver::plant::{Chain, EventKind, Shaft, Start};

/// A torque that a controller might ask for: steps of a few levels, held for a tick each.
fn demand(tick: usize) -> f64 {
    let steps = [200.0, 150.0, -60.0, 220.0, 0.0, -180.0, 90.0];
    steps[(tick / 37) % steps.len()] + 20.0 * ((tick * 7919) % 13) as f64 / 13.0
}

fn report(name: &str, run: &Recording) -> Proof {
    let proof = prove(run).unwrap();
    println!(
        "{name}: {} events; {:.1e} of peak from the second integrator or from tighter events",
        run.plant().events().len(),
        proof.largest()
    );
    proof
}

#[test]
fn a_hoist_with_friction_a_lossy_gear_a_brake_and_a_rope() {
    let chain = Chain::motor(0.62)
        .viscous(0.01)
        .shaft(Shaft::elastic(5.0e3).damping(2.0).gap(0.01), 0.08)
        .efficiency(0.9)
        .coulomb(3.0)
        .shaft(Shaft::rope(900.0).damping(0.5).gap(0.2), 0.35)
        .load(60.0)
        .coulomb(80.0)
        .motor_law(Source::Starting { torque: 30.0, time: 0.15005, power: 1 })
        .start(Start::Slack);
    let mut run = Recording::new(chain.build().unwrap());
    for tick in 0..4000 {
        match tick {
            1500 => run.set_brake(0, 300.0),
            2000 => run.set_brake(0, 0.0),
            2500 => run.set_load_torque(2, 10.0),
            _ => {}
        }
        run.advance(demand(tick), 1e-4);
    }
    for kind in [EventKind::Contact, EventKind::Stop, EventKind::Slip] {
        assert!(run.plant().events().iter().any(|e| e.kind == kind), "{kind:?} {:?}", run.plant().events());
    }
    report("hoist", &run);
}

#[test]
fn a_run_that_no_tick_was_made_of_is_refused() {
    let plant = Chain::motor(1.0).shaft(Shaft::elastic(1.0), 1.0).build().unwrap();
    assert_eq!(prove(&Recording::new(plant)), Err(NotProven::Empty));
}

#[test]
fn a_run_with_coarse_events_is_refused() {
    let mut plant = Chain::motor(1.2).shaft(Shaft::elastic(850.0).gap(0.06), 0.35).start(Start::Slack).build().unwrap();
    // flanks met up to 0.1 ms late: at 4 rad/s that is 4e-4 rad of 0.2 rad
    plant.set_event_tolerance(1e-4);
    let mut run = Recording::new(plant);
    for tick in 0..1000 {
        run.advance(demand(tick), 1e-3);
    }
    match prove(&run) {
        Err(NotProven::Deviates { found, .. }) => assert!(found > BOUND),
        other => panic!("{other:?}"),
    }
}

/// A load at rest on its rope stays there while the rope is wound, and swings at `sqrt(k (1/J_1 + 1/J_2))` of the new
/// stiffness once it is pulled. A crossing is found to a tick.
#[test]
fn a_rope_that_is_wound_up_keeps_its_torque_and_swings_faster() {
    let (weight, inertias) = (300.0, [0.7, 0.5]);
    let chain = Chain::motor(inertias[0])
        .shaft(Shaft::rope(50.0), inertias[1])
        .load(weight)
        .start(Start::Given { twists: vec![weight / 50.0], speeds: vec![0.0; 2] });
    let mut run = Recording::new(chain.build().unwrap());
    let mut stiffness = 50.0;
    for _ in 0..1000 {
        run.advance(weight, 1e-4);
        stiffness += 0.25;
        run.set_shaft(0, stiffness, 0.0);
        // rounding of a thousand changes
        assert!((run.plant().shaft_torque(0) - weight).abs() < 1e-9 && run.plant().speed(1).abs() < 1e-9);
    }
    let mut crossings = Vec::new();
    let mut before = 0.0;
    for tick in 0..10_000 {
        run.advance(if tick == 0 { weight + 100.0 } else { weight }, 1e-4);
        let twisting = run.plant().speed(0) - run.plant().speed(1);
        if before < 0.0 && twisting >= 0.0 {
            crossings.push(f64::from(tick) * 1e-4);
        }
        before = twisting;
    }
    let periods = (crossings.len() - 1) as f64;
    let period = (crossings.last().unwrap() - crossings[0]) / periods;
    let expected = std::f64::consts::TAU / (stiffness * (1.0 / inertias[0] + 1.0 / inertias[1])).sqrt();
    assert!((period - expected).abs() < 1e-4 / periods + 1e-9, "{period} {expected}");
    report("wound rope", &run);
    run.set_shaft(0, -1.0, 0.0);
    run.set_shaft(7, 50.0, 0.0);
    run.set_shaft(0, 50.0, f64::NAN);
    assert_eq!((run.plant().refused(), run.plant().shaft_torque(0).is_finite()), (3, true));
}
