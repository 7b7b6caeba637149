//! Where in the gap: kept through free flight, found again when lost.

use driveline::observer::{BacklashConfig, BacklashObserver, Observer};
use driveline::settings::Bases;
use driveline_closed_loop::sensors::Encoder;
use driveline_lab::backlash::{Case, GAP, cases};
use driveline_solver::plant::{Chain, Plant, Shaft, Start};

const PERIOD: f64 = 1e-4;

fn plant(case: &Case, twist: f64, speeds: [f64; 2], load: f64) -> Plant {
    let machine = &case.machine;
    let shaft = Shaft::elastic(machine.stiffness).damping(machine.damping).gap(machine.gap);
    Chain::motor(machine.motor_inertia)
        .shaft(shaft, machine.load_inertia)
        .load(load)
        .start(Start::Given { twists: vec![twist], speeds: speeds.to_vec() })
        .build()
        .unwrap()
}

/// A machine in steady contact on one side, and an observer that believes in the other one.
#[test]
fn a_lost_side_is_found_again() {
    for case in cases() {
        let config = BacklashConfig::<f64>::new(&case.design(), Bases::SI);
        let torque = 0.5 * case.rated;
        let twist = torque / case.machine.stiffness + 0.5 * case.machine.gap;
        let mut plant = plant(&case, twist, [0.0; 2], torque);
        let encoder = Encoder::new(8192);
        let mut observer = BacklashObserver::<f64>::at_rest(&config, encoder.read(0.0), -torque);
        // Two periods of the resonance after the observer has reached the flank, and what the load torque takes to be
        // found: 0.5 s is the tuning's.
        for _ in 0..10_000 {
            plant.advance(torque, PERIOD);
            observer.step(&config, encoder.read(plant.motor_angle()), torque);
        }
        let mut largest = 0.0_f64;
        for _ in 0..2_000 {
            plant.advance(torque, PERIOD);
            observer.step(&config, encoder.read(plant.motor_angle()), torque);
            largest = largest.max((observer.estimate(&config).shaft_torque - plant.shaft_torque(0)).abs());
        }
        // Left as it was it would be off by twice the torque; an encoder of 8192 counts leaves a few per cent.
        assert!(largest < 0.1 * torque, "{}: {:.3} of the torque", case.name, largest / torque);
    }
}

/// In free flight the twist goes on as motor and load do, and the impact comes when it should.
#[test]
fn the_twist_is_kept_through_free_flight() {
    for case in cases() {
        let design = case.design();
        let config = BacklashConfig::<f64>::new(&design, Bases::SI);
        let torque = 0.2 * case.rated;
        // In contact on the left, which carries the load; then the motor drives to the right with all it has: it
        // leaves, flies and meets the right flank.
        let twist = -torque / case.machine.stiffness - 0.5 * case.machine.gap;
        let mut plant = plant(&case, twist, [0.0; 2], -torque);
        let encoder = Encoder::new(8192);
        let mut observer = BacklashObserver::<f64>::at_rest(&config, encoder.read(0.0), -torque);
        let (mut flown, mut largest) = (0, 0.0_f64);
        for _ in 0..3_000 {
            plant.advance(case.rated, PERIOD);
            observer.step(&config, encoder.read(plant.motor_angle()), case.rated);
            if plant.twist(0).abs() < 0.5 * case.machine.gap {
                flown += 1;
                largest = largest.max((observer.twist() - plant.twist(0)).abs());
            } else if flown > 0 {
                break;
            }
        }
        assert!(flown > 10, "{}: {flown} ticks in the gap", case.name);
        // Four standard deviations of what the encoder leaves of the twist with the searching gains.
        let bound = 4.0 * design.searching_twist;
        assert!(largest < bound, "{}: {:.2} gaps, {:.2} allowed", case.name, largest / GAP, bound / GAP);
    }
}

#[test]
fn it_starts_on_the_side_of_the_torque_and_in_the_middle_without_one() {
    let case = &cases()[0];
    let config = BacklashConfig::<f64>::new(&case.design(), Bases::SI);
    for torque in [10.0, -10.0] {
        let observer = BacklashObserver::<f64>::at_rest(&config, 0, torque);
        assert!(!observer.is_open(&config));
        // The sum of two products in f64.
        assert!((observer.estimate(&config).shaft_torque - torque).abs() < 1e-12);
    }
    let observer = BacklashObserver::<f64>::at_rest(&config, 0, 0.0);
    assert_eq!((observer.twist(), observer.estimate(&config).shaft_torque), (0.0, 0.0));
    assert!(observer.is_open(&config));
}
