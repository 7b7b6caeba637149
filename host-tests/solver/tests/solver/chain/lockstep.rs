//! The solver in lock-step with a controller: nothing is stepped over, bad input is refused, the length of the tick
//! does not matter, and it is fast.

use std::time::Instant;

use driveline_solver::plant::train::Source;
use driveline_solver::plant::{Chain, EventKind, LoadProgram, Plant, PlantError, Shaft, Start};

fn hoist() -> Chain {
    Chain::motor(0.62)
        .viscous(0.01)
        .shaft(Shaft::elastic(5.0e4).damping(2.0), 0.08)
        .shaft(Shaft::elastic(900.0).damping(0.5), 0.35)
        .load(60.0)
}

#[test]
fn a_flank_that_is_barely_touched_is_found_within_one_long_tick() {
    // Thrown at the flank and drawn back by a constant torque: the twist rises to exactly the flank and `over` beyond.
    let (j1, torque, half_gap) = (0.5, -40.0, 0.05);
    let touch = |over: f64| {
        let height: f64 = half_gap + over;
        let speed = (2.0 * height * 40.0 / j1).sqrt();
        let start = Start::Given { twists: vec![0.0], speeds: vec![speed, 0.0] };
        let shaft = Shaft::elastic(2000.0).gap(2.0 * half_gap);
        let mut plant = Chain::motor(j1).shaft(shaft, 1.0e9).start(start).build().unwrap();
        // there and back is 2 speed / 80 rad/s2; the tick is longer than that
        plant.advance(torque, 1.5 * speed / 80.0);
        plant.events().iter().map(|event| event.new).collect::<Vec<_>>()
    };
    // a thousandth of a degree would be 2e-5 rad; these are down to 1e-13 rad, a contact of 0.1 us
    for over in [1e-3, 1e-6, 1e-9, 1e-11, 1e-13] {
        assert_eq!(touch(over), [1, 0], "over by {over}");
    }
    for under in [-1e-3, -1e-9, -1e-13] {
        assert!(touch(under).is_empty(), "under by {under}");
    }
}

#[test]
fn a_touch_in_the_middle_of_a_series_of_equal_ticks_is_found_too() {
    // the same throw in ticks of equal length, whose middle parts are taken in one leap each
    let (j1, half_gap) = (0.5, 0.05);
    let speed = (2.0_f64 * (half_gap + 1e-9) * 80.0).sqrt();
    let start = Start::Given { twists: vec![0.0], speeds: vec![speed, 0.0] };
    let shaft = Shaft::elastic(2000.0).gap(2.0 * half_gap);
    let plant = Chain::motor(j1).shaft(shaft, 1.0e9).start(start).build().unwrap();
    for ticks in [7, 64, 1000, 4096] {
        let mut plant = plant.clone();
        for _ in 0..ticks {
            plant.advance(-40.0, 1.5 * speed / 80.0 / f64::from(ticks));
        }
        let new: Vec<i8> = plant.events().iter().map(|event| event.new).collect();
        assert_eq!(new, [1, 0], "{ticks} ticks");
    }
}

#[test]
fn the_length_of_the_tick_does_not_matter() {
    let build = || {
        Chain::motor(0.62)
            .shaft(Shaft::elastic(5.0e3).damping(0.3).gap(0.02), 0.08)
            .efficiency(0.9)
            .shaft(Shaft::rope(900.0).damping(0.5).gap(0.1), 0.35)
            .load(60.0)
            .coulomb(70.0)
            .start(Start::Slack)
            .build()
            .unwrap()
    };
    let end = |ticks: usize| {
        let mut plant = build();
        for torque in [150.0, -80.0, 90.0] {
            for _ in 0..ticks {
                plant.advance(torque, 0.2 / ticks as f64);
            }
        }
        plant
    };
    let (coarse, fine) = (end(1), end(4000));
    assert_eq!(coarse.events().len(), fine.events().len());
    assert!(coarse.events().len() > 10);
    for (a, b) in coarse.events().iter().zip(fine.events()) {
        assert_eq!((a.kind, a.place, a.new), (b.kind, b.place, b.new));
        // events located to 1e-14 s each, dozens of them one after another
        assert!((a.time - b.time).abs() < 1e-10, "{a:?} {b:?}");
    }
    for node in 0..3 {
        // speeds of some 50 rad/s with accelerations of 1e4 rad/s2 at events off by 1e-14 s
        assert!((coarse.speed(node) - fine.speed(node)).abs() < 1e-7);
    }
}

#[test]
fn a_clone_runs_on_alone_and_alike() {
    let mut plant = hoist().build().unwrap();
    (0..100).for_each(|_| plant.advance(100.0, 1e-4));
    let mut twin = plant.clone();
    (0..100).for_each(|_| plant.advance(100.0, 1e-4));
    assert!(twin.time() < plant.time());
    (0..100).for_each(|_| twin.advance(100.0, 1e-4));
    // the same operations in the same order: the same bits
    assert_eq!(twin.speed(2).to_bits(), plant.speed(2).to_bits());
    assert_eq!(twin.motor_angle().to_bits(), plant.motor_angle().to_bits());
}

fn rate(mut plant: Plant, torque: impl Fn(u32) -> f64) -> f64 {
    let ticks = 200_000;
    let start = Instant::now();
    for tick in 0..ticks {
        plant.advance(torque(tick), 1e-4);
    }
    f64::from(ticks) / start.elapsed().as_secs_f64()
}

#[test]
fn ticks_per_second_are_printed() {
    // printed, never judged: a wall clock is no test
    let wave = |tick: u32| 60.0 + 30.0 * f64::from(tick / 500 % 2);
    println!("3 masses, linear: {:.0} ticks/s", rate(hoist().build().unwrap(), wave));
    let geared = Chain::motor(0.62)
        .viscous(0.3)
        .shaft(Shaft::elastic(5.0e4).damping(2.0).gap(0.005), 0.08)
        .efficiency(0.94)
        .shaft(Shaft::rope(900.0).damping(0.5).gap(0.1), 0.35)
        .load(60.0)
        .coulomb(5.0)
        .start(Start::Pretensioned { speed: 20.0 });
    println!("3 masses, gap, gear, rope, friction: {:.0} ticks/s", rate(geared.build().unwrap(), wave));
    let shuttle = |tick: u32| if tick / 500 % 2 == 1 { -20.0 } else { 20.0 };
    let rattling = Chain::motor(1.2).shaft(Shaft::elastic(850.0).damping(0.4).gap(0.06), 0.35).viscous(0.2);
    println!("2 masses rattling in a gap: {:.0} ticks/s", rate(rattling.build().unwrap(), shuttle));
}

#[test]
fn a_bad_chain_is_refused_by_the_name_of_what_is_wrong() {
    let soft = Shaft::elastic(100.0);
    let says = |chain: Chain| chain.build().unwrap_err().to_string();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(says(Chain::motor(bad)).starts_with(&format!("inertia of node 0 is {bad}")));
        assert!(says(Chain::motor(1.0).shaft(soft, bad)).starts_with("inertia of node 1 is"));
        assert!(says(Chain::motor(1.0).shaft(Shaft::elastic(bad), 1.0)).starts_with("stiffness of shaft 0 is"));
        assert!(says(Chain::motor(1.0).shaft(Shaft::rope(bad), 1.0)).starts_with("stiffness of shaft 0 is"));
        let law = Source::Starting { torque: 1.0, time: bad, power: 1 };
        assert!(says(Chain::motor(1.0).motor_law(law)).starts_with("starting time of node 0 is"));
    }
    for bad in [-1e-9, f64::NAN, f64::INFINITY] {
        assert!(says(Chain::motor(1.0).viscous(bad)).starts_with("viscous friction of node 0 is"));
        assert!(says(Chain::motor(1.0).coulomb(bad)).starts_with("Coulomb friction of node 0 is"));
        assert!(says(Chain::motor(1.0).shaft(soft.damping(bad), 1.0)).starts_with("damping of shaft 0 is"));
        assert!(says(Chain::motor(1.0).shaft(soft.gap(bad), 1.0)).starts_with("backlash of shaft 0 is"));
        let rope = Shaft::rope(1.0).gap(bad);
        assert!(says(Chain::motor(1.0).shaft(rope, 1.0)).starts_with("slack of shaft 0 is"));
    }
    for bad in [0.0, -0.5, 1.01, f64::NAN] {
        assert!(says(Chain::motor(1.0).efficiency(bad).shaft(soft, 1.0)).starts_with("efficiency of node 0 is"));
    }
    assert!(says(Chain::motor(1.0).shaft(soft, 1.0).efficiency(0.9)).contains("a shaft behind the gear"));
    assert!(says(Chain::motor(1.0).load(f64::NAN)).starts_with("load torque of node 0 is"));
    let backwards = LoadProgram::steps(&[(1.0, 2.0), (1.0, 3.0)]);
    let refused = Chain::motor(1.0).program(backwards).build().unwrap_err();
    assert!(matches!(refused, PlantError::TimesNotIncreasing { time: 1.0, .. }));
    let short = Start::Given { twists: vec![], speeds: vec![0.0, 0.0] };
    assert!(says(Chain::motor(1.0).shaft(soft, 1.0).start(short)).contains("starting twists: 0 given, expected 1"));
    let pushed = Chain::motor(1.0).shaft(Shaft::rope(1.0), 1.0).load(-5.0);
    assert!(says(pushed.start(Start::Pretensioned { speed: 0.0 })).contains("a rope cannot push"));
}

#[test]
fn bad_calls_change_nothing_and_are_counted() {
    let mut plant = hoist().build().unwrap();
    plant.advance(50.0, 1e-3);
    let (time, speed) = (plant.time(), plant.motor_speed());
    plant.advance(f64::NAN, 1e-3);
    plant.advance(1.0, 0.0);
    plant.advance(1.0, -1.0);
    plant.advance(1.0, f64::INFINITY);
    plant.set_load_torque(9, 1.0);
    plant.set_load_torque(1, f64::NAN);
    plant.set_brake(9, 1.0);
    plant.set_brake(1, -1.0);
    plant.set_event_tolerance(f64::NAN);
    assert_eq!((plant.time(), plant.motor_speed(), plant.refused()), (time, speed, 9));
    assert!(plant.speed(9).is_nan() && plant.angle(9).is_nan() && plant.load_torque(9).is_nan());
    assert!(plant.shaft_torque(2).is_nan() && plant.twist(2).is_nan());
}

#[test]
fn a_motor_alone_is_a_chain_too() {
    let mut plant = Chain::motor(2.0).coulomb(1.0).build().unwrap();
    (0..100).for_each(|_| plant.advance(5.0, 1e-2));
    // (5 - 1) / 2 rad/s2 for one second: rounding only
    assert!((plant.motor_speed() - 2.0).abs() < 1e-13 && (plant.motor_angle() - 1.0).abs() < 1e-13);
    // a start is no slip: the node was never held
    assert!(plant.events().is_empty());
    (0..100).for_each(|_| plant.advance(-5.0, 1e-2));
    // 2 rad/s gone at 3 rad/s2, then off the other way at 2 rad/s2 for the last third of a second
    assert_eq!(plant.events()[0].kind, EventKind::Reversal);
    assert!((plant.motor_speed() + 2.0 / 3.0).abs() < 1e-12);
    (0..100).for_each(|_| plant.advance(0.5, 1e-2));
    assert_eq!((plant.events()[1].kind, plant.motor_speed()), (EventKind::Stop, 0.0));
    plant.advance(-1.5, 1e-2);
    assert_eq!((plant.events()[2].kind, plant.events()[2].new), (EventKind::Slip, -1));
}
