//! Linear trains: solved at once, however stiff, and by series: the same numbers by two roads.

use driveline_solver::plant::LoadProgram;
use driveline_solver::plant::train::{Coordinate, Link, Signal, Source, Train};

/// A loop and a branch with a coupling a hundred thousand times as stiff as the rest.
fn stiff() -> Train {
    Train::new()
        .coordinate(Coordinate::new(2.0).source(Source::Line { stall: 300.0, slope: 2.0 }))
        .coordinate(Coordinate::new(0.01))
        .coordinate(
            Coordinate::new(5.0).viscous(0.4).source(Source::Program(LoadProgram::table(&[(0.1, 0.0), (0.3, -90.0)]))),
        )
        .coordinate(Coordinate::new(0.7).source(Source::Starting { torque: 20.0, time: 0.25, power: 1 }))
        .link(Link::shaft(0, 1, 1.0e9).damping(1.0))
        .link(Link::shaft(1, 2, 1.0e4).damping(2.0))
        .link(Link::geared(2, 3, 2.0, 3.0e4))
        .link(Link::geared(0, 3, 2.0, 2.0e3).damping(0.3))
}

#[test]
fn whole_ticks_by_the_exponential_are_the_sum_of_the_series() {
    let (mut leaps, mut series) = (stiff().build().unwrap(), stiff().build().unwrap());
    // who watches looks between the ticks, and so goes by series
    series.watch(Signal::Force(0));
    let signals: Vec<Signal> = (0..4).flat_map(|i| [Signal::Speed(i), Signal::Force(i), Signal::Angle(i)]).collect();
    let (mut worst, mut peak) = ([0.0_f64; 12], [0.0_f64; 12]);
    for _ in 0..500 {
        leaps.advance(1e-3);
        series.advance(1e-3);
        let pairs = leaps.read_all(&signals).into_iter().zip(series.read_all(&signals));
        for (i, (a, b)) in pairs.enumerate() {
            worst[i] = worst[i].max((a - b).abs());
            peak[i] = peak[i].max(b.abs());
        }
    }
    for (i, (worst, peak)) in worst.iter().zip(peak).enumerate() {
        // 3e5 rad/s over half a second: 1e5 radians of phase, each rounded to 1e-16, in the stiff coupling alone
        assert!(*worst < 1e-9 * peak, "{:?}: {worst:e} of {peak:e}", signals[i]);
    }
}

#[test]
fn a_long_tick_of_a_stiff_pair_lands_on_its_closed_form() {
    // two equal masses at 1e6 rad/s, one pushed: a tick of 10 ms holds 1600 swings, and a thousand ticks follow each
    // other
    let (j, k, push) = (1e-3, 5.0e8, 40.0);
    let mut motion = Train::new()
        .coordinate(Coordinate::new(j).source(Source::Constant(push)))
        .coordinate(Coordinate::new(j))
        .link(Link::shaft(0, 1, k).damping(2.0 * 0.5 * k.sqrt() * 1e-3))
        .build()
        .unwrap();
    for _ in 0..1000 {
        motion.advance(1e-2);
    }
    // damped out long ago: half the push goes through the shaft, and both masses share the acceleration
    assert!((motion.force(0) - 0.5 * push).abs() < 1e-9 * push, "{}", motion.force(0));
    let expected = push / (2.0 * j) * 10.0;
    assert!((motion.speed(1) / expected - 1.0).abs() < 1e-12, "{} {expected}", motion.speed(1));
}
