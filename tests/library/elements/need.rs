//! Which observer a machine needs: what leaving something out costs, against the full solver and closed forms.

use std::f64::consts::PI;

use driveline::design::{LoadCycle, ObserverChoice, Requirement};
use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline_solver::plant::{Chain, LoadProgram, Shaft};

use crate::references::{case, close};

const DUTY: LoadCycle = LoadCycle { speed: 100.0, torque: 200.0, change: 60.0, rise: 0.0, every: 0.7, reverses: false };

fn machine(damping: f64) -> TwoMass {
    TwoMass::new(Inertia(1.2), Inertia(0.35), Stiffness(850.0), Damping(damping))
}

/// What a rigid observer does not show after a change of load: shaft torque less its steady part, load's speed less the
/// mean speed, rms.
fn solved(duty: &LoadCycle, damping: f64) -> [f64; 2] {
    let ramp = if duty.rise == 0.0 {
        LoadProgram::steps(&[(0.0, duty.change)])
    } else {
        LoadProgram::table(&[(0.0, 0.0), (duty.rise, duty.change)])
    };
    let shaft = Shaft::elastic(850.0).damping(damping);
    let mut plant = Chain::motor(1.2).shaft(shaft, 0.35).program(ramp).build().unwrap();
    let dt = 1e-4;
    let (mut squares, mut count) = ([0.0; 2], 0.0);
    while plant.time() < duty.rise + duty.every {
        plant.advance(0.0, dt);
        if plant.time() > duty.rise {
            let mean = (1.2 * plant.speed(0) + 0.35 * plant.speed(1)) / 1.55;
            let swing = plant.shaft_torque(0) - duty.change * 1.2 / 1.55;
            for (square, error) in squares.iter_mut().zip([swing / duty.torque, (plant.speed(1) - mean) / duty.speed]) {
                *square += error * error;
            }
            count += 1.0;
        }
    }
    squares.map(|square| f64::sqrt(square / count))
}

/// A step and a ramp of half a period, after which the bound `2/(w r)` is reached. The formula has whole swings, 2 %,
/// and takes the ramp as undamped: during it a swing loses `zeta w r` at the most, half of that on average.
#[test]
fn the_shaft_left_out() {
    for damping in [0.0, 0.3, 1.2] {
        let two = machine(damping);
        for rise in [0.0, PI / two.resonance()] {
            let duty = LoadCycle { rise, ..DUTY };
            let cost = two.select_observer(&duty, &Requirement::USUAL, 1e-4).without_shaft;
            let [torque, speed] = solved(&duty, damping);
            let tolerance = 0.02 + 0.5 * PI * two.damping_ratio();
            close(cost.shaft_torque, torque, tolerance);
            close(cost.load_speed, speed, tolerance);
        }
        // A ramp of whole periods leaves nothing; the bound does not count on that.
        let duty = LoadCycle { rise: 2.0 * PI / two.resonance(), ..DUTY };
        assert!(
            two.select_observer(&duty, &Requirement::USUAL, 1e-4).without_shaft.shaft_torque
                > solved(&duty, damping)[0]
        );
    }
}

/// The gap of D4: it closes at the speed given there, and the blow swings the shaft undamped by `v sqrt(k J_r)`.
#[test]
fn the_gap_left_out() {
    let case = case("backlash_transients.json", "D4_crane_slack_gap_friction_const");
    let closing = case["closed_form"]["impact_speed_rad_s"].as_f64().unwrap();
    let two = machine(0.0).with_gap(Gap(case["gap_total_rad"].as_f64().unwrap()));
    let duty = LoadCycle { change: case["motor"][1].as_f64().unwrap(), reverses: true, ..DUTY };
    let cost = two.select_observer(&duty, &Requirement::USUAL, 1e-4).without_gap;
    let blow = closing * (850.0_f64 * 1.2 * 0.35 / 1.55).sqrt();
    close(cost.shaft_torque * duty.torque, blow / 2.0_f64.sqrt(), 1e-12);
    // The slip of the blow is the closing speed; the load has 1.2/1.55 of it.
    close(cost.load_speed * duty.speed, closing / 2.0_f64.sqrt() * 1.2 / 1.55, 1e-12);
    let steady = two.select_observer(&LoadCycle { reverses: false, ..duty }, &Requirement::USUAL, 1e-4).without_gap;
    assert_eq!((steady.shaft_torque, steady.load_speed), (0.0, 0.0));
}

#[test]
fn the_cheapest_observer_that_will_do() {
    let choice =
        |two: TwoMass, duty: &LoadCycle, hz: f64| two.select_observer(duty, &Requirement::USUAL, 1.0 / hz).chosen;
    let soft = machine(0.3);
    assert_eq!(choice(soft, &DUTY, 10_000.0), ObserverChoice::SemiImplicit);
    assert_eq!(choice(soft, &DUTY, 1_000.0), ObserverChoice::Exact);
    // Slowly loaded, it is a rigid machine.
    assert_eq!(choice(soft, &LoadCycle { rise: 10.0, ..DUTY }, 1_000.0), ObserverChoice::Rigid);
    let slack = soft.with_gap(Gap(0.01));
    assert_eq!(choice(slack, &LoadCycle { reverses: true, ..DUTY }, 10_000.0), ObserverChoice::Backlash);
    // The gap stays closed where the torque keeps its sign.
    assert_eq!(choice(slack, &DUTY, 10_000.0), ObserverChoice::SemiImplicit);
    const AT_COMPILE_TIME: ObserverChoice = TwoMass::new(Inertia(1.2), Inertia(0.35), Stiffness(850.0), Damping(0.3))
        .select_observer(&DUTY, &Requirement::USUAL, 1e-4)
        .chosen;
    assert_eq!(AT_COMPILE_TIME, ObserverChoice::SemiImplicit);
}
