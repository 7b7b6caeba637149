//! Cranks and angle-dependent loads: `data/speed_fluctuation.json`.

use driveline_solver::plant::train::{Coordinate, Crank, Signal, Source, Train};
use serde::Deserialize;

#[derive(Deserialize)]
struct Cases {
    cases: Vec<Press>,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Press {
    J_const_kg_m2: f64,
    motor_line_a_b: [f64; 2],
    load: Load,
    w_at_phi0_rad_s: f64,
    w_max_rad_s: f64,
    w_min_rad_s: f64,
    cycle_time_s: f64,
    w_mean_time_rad_s: f64,
    delta_arithmetic_mean: f64,
    kinetic_energy_max_minus_min_J: f64,
    rel_tol: f64,
    rel_tol_delta: f64,
    wave: Vec<[f64; 3]>,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Load {
    M0: f64,
    M1: f64,
    p1: f64,
    p2: f64,
}

#[test]
fn a_punch_press_runs_through_its_cycle_as_in_the_case() {
    let text = include_str!("../../../../../tests/data/speed_fluctuation.json");
    let press = serde_json::from_str::<Cases>(text).unwrap().cases.remove(0);
    let [stall, slope] = press.motor_line_a_b;
    let mut motion = Train::new()
        .coordinate(
            Coordinate::new(press.J_const_kg_m2)
                .speed(press.w_at_phi0_rad_s)
                .source(Source::Line { stall, slope })
                .source(Source::Constant(-press.load.M0))
                .source(Source::Arc { torque: -press.load.M1, from: press.load.p1, to: press.load.p2 }),
        )
        .build()
        .unwrap();
    motion.watch(Signal::Speed(0));
    let mut time = 0.0;
    let mut worst = 0.0_f64;
    for &[angle, at, speed] in press.wave.iter().skip(1) {
        motion.advance(at - time);
        time = at;
        worst = worst.max((motion.speed(0) - speed).abs() / speed).max((motion.angle(0) - angle).abs() / angle);
    }
    assert!(worst <= press.rel_tol, "{worst:.1e}");
    let end = press.wave[press.wave.len() - 1];
    assert!((end[1] - press.cycle_time_s).abs() <= press.rel_tol * press.cycle_time_s);
    // the cycle closes, and its mean is a turn over its time
    assert!((motion.speed(0) - press.w_at_phi0_rad_s).abs() <= press.rel_tol * press.w_at_phi0_rad_s);
    let mean = motion.angle(0) / motion.time();
    assert!((mean - press.w_mean_time_rad_s).abs() <= press.rel_tol * mean);
    let extremes = motion.extremes(Signal::Speed(0)).unwrap();
    assert!((extremes.peak - press.w_max_rad_s).abs() <= press.rel_tol * press.w_max_rad_s);
    assert!((extremes.least - press.w_min_rad_s).abs() <= press.rel_tol * press.w_min_rad_s);
    let delta = 2.0 * (extremes.peak - extremes.least) / (extremes.peak + extremes.least);
    assert!((delta - press.delta_arithmetic_mean).abs() <= press.rel_tol_delta * delta);
    let swing = 0.5 * press.J_const_kg_m2 * (extremes.peak.powi(2) - extremes.least.powi(2));
    let expected = press.kinetic_energy_max_minus_min_J;
    // the swing is a difference of squares: twice the tolerance of a speed
    assert!((swing - expected).abs() <= 2.0 * press.rel_tol * expected);
}

#[test]
fn a_free_crank_keeps_its_energy_whatever_its_inertia_does() {
    let crank = Crank { rod_mass: 6.0, rod_inertia: 0.12, ..Crank::new(0.1, 0.35, 40.0) };
    let mut motion = Train::new().coordinate(Coordinate::new(0.4).speed(20.0).crank(crank)).build().unwrap();
    let energy = |angle: f64, speed: f64| (0.4 + crank.inertia(angle).0) * speed * speed;
    let whole = energy(0.0, 20.0);
    motion.watch(Signal::Speed(0));
    for _ in 0..1000 {
        motion.advance(1.7e-3);
        let now = energy(motion.angle(0), motion.speed(0));
        // energy integral of J w^2: rounding of some ten thousand stretches
        assert!((now - whole).abs() < 1e-11 * whole, "{now} {whole}");
    }
    let swing = motion.extremes(Signal::Speed(0)).unwrap();
    // the slider takes what it needs from the speed: 0.4 + 0.4 kg m2 at most against little more than 0.4 at the dead
    // centres
    assert!(swing.peak / swing.least > 1.3, "{swing:?}");
}
