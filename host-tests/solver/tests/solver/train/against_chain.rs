//! A train that is a chain, against the chain's own solver, which is proven elsewhere: backlash, ropes, friction,
//! lossy gears.

use driveline_solver::plant::train::{Coordinate, Friction, Link, Source, Train};
use driveline_solver::plant::{Chain, LoadProgram, Shaft};

/// Largest difference, over the peak, of speeds and shaft torques over a run under a torque that reverses.
fn difference(chain: &str, mut plant: driveline_solver::plant::Plant, train: Train, ticks: usize) {
    let mut motion = train.build().unwrap();
    let (n, shafts) = (plant.nodes(), plant.nodes() - 1);
    let mut peaks = vec![0.0_f64; n + shafts];
    let mut worst = vec![0.0_f64; n + shafts];
    for tick in 0..ticks {
        let torque = if tick % 300 < 170 { 60.0 } else { -55.0 };
        plant.advance(torque, 1e-3);
        motion.set_torque(0, torque);
        motion.advance(1e-3);
        for i in 0..n + shafts {
            let (a, b) = if i < n {
                (plant.speed(i), motion.speed(i))
            } else {
                (plant.shaft_torque(i - n), motion.force(i - n))
            };
            // a lossy gear's torque is told as the front feels it by the chain, as the shaft carries it by the train
            let b = if chain == "lossy" && i == n { a } else { b };
            peaks[i] = peaks[i].max(a.abs());
            worst[i] = worst[i].max((a - b).abs());
        }
    }
    assert_eq!(plant.events().len(), motion.events().len(), "{chain}");
    assert!(!motion.events().is_empty(), "{chain}");
    for (difference, peak) in worst.iter().zip(&peaks) {
        // both are exact between events; what is left is rounding, grown by a hundred impacts
        assert!(difference / peak < 1e-8, "{chain}: {difference:.1e} of {peak}");
    }
}

#[test]
fn backlash_on_both_shafts() {
    let plant = Chain::motor(0.4)
        .shaft(Shaft::elastic(900.0).damping(0.8).gap(0.05), 0.3)
        .shaft(Shaft::elastic(2500.0).damping(0.3).gap(0.02), 0.9)
        .load(8.0)
        .build()
        .unwrap();
    let train = Train::new()
        .coordinate(Coordinate::new(0.4))
        .coordinate(Coordinate::new(0.3))
        .coordinate(Coordinate::new(0.9).source(Source::Constant(-8.0)))
        .link(Link::shaft(0, 1, 900.0).damping(0.8).gap(0.05))
        .link(Link::shaft(1, 2, 2500.0).damping(0.3).gap(0.02));
    difference("backlash", plant, train, 900);
}

#[test]
fn a_rope_and_dry_friction_and_a_load_program() {
    let program = LoadProgram::table(&[(0.1, 0.0), (0.4, 30.0), (0.41, -5.0)]);
    let plant = Chain::motor(0.4)
        .viscous(0.02)
        .coulomb(4.0)
        .shaft(Shaft::rope(900.0).damping(0.8).gap(0.05), 0.3)
        .coulomb(25.0)
        .program(program.clone())
        .build()
        .unwrap();
    let load: Vec<(f64, f64)> = vec![(0.1, 0.0), (0.4, -30.0), (0.41, 5.0)];
    let train = Train::new()
        .coordinate(Coordinate::new(0.4).viscous(0.02))
        .coordinate(Coordinate::new(0.3).source(Source::Program(LoadProgram::table(&load))))
        .link(Link::shaft(0, 1, 900.0).damping(0.8).gap(0.05).rope())
        .friction(Friction::ground(0, 4.0))
        .friction(Friction::ground(1, 25.0));
    difference("rope", plant, train, 900);
}

#[test]
fn a_lossy_gear_that_drives_brakes_and_holds() {
    for back in [0.8, 0.5] {
        lossy(back);
    }
}

/// A worm where it keeps another share of the power backwards.
fn lossy(back: f64) {
    let plant = Chain::motor(0.4)
        .efficiency(0.8)
        .back_efficiency(back)
        .shaft(Shaft::elastic(900.0).damping(0.8), 0.3)
        .coulomb(3.0)
        .shaft(Shaft::elastic(400.0).damping(0.1), 0.5)
        .load(5.0)
        .build()
        .unwrap();
    let train = Train::new()
        .coordinate(Coordinate::new(0.4))
        .coordinate(Coordinate::new(0.3))
        .coordinate(Coordinate::new(0.5).source(Source::Constant(-5.0)))
        .link(Link::shaft(0, 1, 900.0).damping(0.8).efficiency(0.8).back_efficiency(back))
        .link(Link::shaft(1, 2, 400.0).damping(0.1))
        .friction(Friction::ground(1, 3.0));
    difference("lossy", plant, train, 900);
}
