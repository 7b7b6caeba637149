//! An unbalanced mass on a machine that moves: closed forms by momentum and energy, the linear response, and the proof.

use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{Coordinate, Link, Motion, Signal, Source, Train, Unbalance};

const MASS: f64 = 50.0;
const INERTIA: f64 = 2.0;
const MOMENT: f64 = 4.0;

fn free(speed: f64, gravity: f64) -> Motion {
    Train::new()
        .coordinate(Coordinate::new(INERTIA).speed(speed).angle(0.7))
        .coordinate(Coordinate::new(MASS))
        .unbalance(Unbalance { turning: 0, way: 1, moment: MOMENT, gravity })
        .build()
        .unwrap()
}

/// Without springs and gravity the momentum along the way stays, so what is left is a rotor of the inertia
/// `J - S^2 sin^2 phi / M` whose energy stays.
#[test]
fn a_free_machine_keeps_its_momentum_and_its_energy() {
    let mut motion = free(30.0, 0.0);
    let momentum = |motion: &Motion| MASS * motion.speed(1) - MOMENT * motion.speed(0) * motion.angle(0).sin();
    let begins = momentum(&motion);
    let energy = |motion: &Motion| {
        let (turning, way, sine) = (motion.speed(0), motion.speed(1), motion.angle(0).sin());
        0.5 * (INERTIA * turning * turning + MASS * way * way) - MOMENT * turning * way * sine
    };
    let whole = energy(&motion);
    let (mut slowest, mut fastest) = (f64::MAX, 0.0_f64);
    for _ in 0..2000 {
        motion.advance(1e-3);
        // rounding of 2000 ticks of a few stretches
        assert!((momentum(&motion) / begins - 1.0).abs() < 1e-12);
        assert!((energy(&motion) / whole - 1.0).abs() < 1e-12);
        (slowest, fastest) = (slowest.min(motion.speed(0)), fastest.max(motion.speed(0)));
    }
    // What turns with the centre of gravity at rest, `E - p^2/2M = (J - S^2 sin^2/M) w^2/2`, swings between these two.
    let left = 2.0 * (whole - 0.5 * begins * begins / MASS);
    let expected = [left / INERTIA, left / (INERTIA - MOMENT * MOMENT / MASS)].map(f64::sqrt);
    // a sample every millisecond is within 30 mrad of the extreme, whose square is 5e-4 of the swing of 8 %
    assert!(
        (slowest / expected[0] - 1.0).abs() < 1e-4 && (fastest / expected[1] - 1.0).abs() < 1e-4,
        "{slowest} {fastest}"
    );
}

/// A rotor that the way cannot slow swings a mass on a spring with `S w^2/(k - M w^2)`.
#[test]
fn a_heavy_rotor_drives_the_linear_response() {
    let (speed, stiffness) = (60.0, 4.0e4);
    let amplitude = MOMENT * speed * speed / (stiffness - MASS * speed * speed);
    let mut motion = Train::new()
        .coordinate(Coordinate::new(1e12).speed(speed))
        .coordinate(Coordinate::new(MASS))
        .link(Link::ground(1, stiffness).elongated(amplitude))
        .unbalance(Unbalance { turning: 0, way: 1, moment: MOMENT, gravity: 9.81 })
        .build()
        .unwrap();
    for _ in 0..500 {
        motion.advance(1e-3);
        let expected = amplitude * (speed * motion.time()).cos();
        assert!((motion.elongation(0) - expected).abs() < 1e-9 * amplitude.abs(), "{}", motion.time());
    }
}

/// On a way that cannot move, gravity makes a pendulum of it; the torque from outside is that of its weight.
#[test]
fn gravity_pulls_the_mass_down() {
    let mut motion = Train::new()
        .coordinate(Coordinate::new(INERTIA).angle(2.0))
        .coordinate(Coordinate::new(1e12))
        .unbalance(Unbalance { turning: 0, way: 1, moment: MOMENT, gravity: 9.81 })
        .build()
        .unwrap();
    let energy = |motion: &Motion| 0.5 * INERTIA * motion.speed(0).powi(2) + MOMENT * 9.81 * motion.angle(0).cos();
    let whole = energy(&motion);
    for _ in 0..500 {
        motion.advance(1e-3);
        // rounding, and the way's share of 1e-12
        assert!((energy(&motion) - whole).abs() < 1e-10 * MOMENT * 9.81);
        let weight = MOMENT * 9.81 * motion.angle(0).sin();
        assert!((motion.read(Signal::Outside(0)) - weight).abs() < 1e-9 * MOMENT * 9.81);
    }
}

/// A motor that is too weak hangs in the resonance (Sommerfeld's effect), one that is stronger passes; both runs are
/// proven.
#[test]
fn a_run_up_through_resonance_is_proven() {
    let ran = |torque: f64| {
        let motion = Train::new()
            .coordinate(Coordinate::new(0.5).source(Source::Line { stall: torque, slope: torque / 120.0 }))
            .coordinate(Coordinate::new(INERTIA))
            .coordinate(Coordinate::new(MASS))
            .link(Link::shaft(0, 1, 4.0e3).damping(1.0))
            .link(Link::ground(2, 2.0e4).damping(100.0))
            .unbalance(Unbalance { turning: 1, way: 2, moment: 0.8, gravity: 9.81 })
            .build()
            .unwrap();
        let mut run = Recording::new(motion);
        for _ in 0..4000 {
            run.advance(1e-3);
        }
        prove(&run).unwrap();
        run.motion().speed(1)
    };
    // 20 rad/s is the resonance
    let (weak, strong) = (ran(20.0), ran(60.0));
    assert!(weak < 25.0 && strong > 40.0, "{weak} {strong}");
}

#[test]
fn an_unbalance_that_cannot_be_is_refused() {
    let two = || Train::new().coordinate(Coordinate::new(INERTIA)).coordinate(Coordinate::new(MASS));
    let good = Unbalance { turning: 0, way: 1, moment: MOMENT, gravity: 9.81 };
    assert!(two().unbalance(good).build().is_ok());
    for bad in [
        // sqrt(2 50) = 10 is what the inertias carry
        Unbalance { moment: 10.0, ..good },
        Unbalance { moment: f64::NAN, ..good },
        Unbalance { gravity: f64::INFINITY, ..good },
        Unbalance { way: 0, ..good },
        Unbalance { way: 2, ..good },
    ] {
        assert!(two().unbalance(bad).build().is_err(), "{bad:?}");
    }
    let rubbing = two().friction(driveline_solver::plant::train::Friction::ground(0, 1.0)).unbalance(good);
    assert_eq!(
        rubbing.build().unwrap_err().to_string(),
        "unbalance with dry friction, a lossy gear or a crank of node 0 is 4: expected those on another coordinate, \
            behind a shaft"
    );
}
