//! Mechanisms behind a crank: laws of inertia, forces over a part of a stroke, and the steady cycle.

use std::f64::consts::{PI, TAU};

use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{
    Coordinate, Crank, FourBar, Friction, Link, Motion, Orders, Signal, Source, Toggle, Train, rubbing,
};

/// A four-bar press: motor line, flywheel, coupler and rocker.
const BARS: FourBar = FourBar { crank: 0.1, coupler: 0.35, rocker: 0.3, ground: 0.4 };
const FLYWHEEL: f64 = 6.0;
/// Of the coupler about the crank pin's end alone, taken as turning only, and of the rocker about its pivot.
const COUPLER: f64 = 0.4;
const ROCKER: f64 = 2.5;
const LINE: [f64; 2] = [400.0, 20.0];
const FORCE: f64 = 300.0;
const ARC: [f64; 2] = [0.8, 2.4];

/// Rates of coupler and rocker per rate of the crank, by the closed form `a sin(theta_4 - theta_2)/(b sin(theta_3 -
/// theta_4))` and `a sin(theta_2 - theta_3)/(c sin(theta_4 - theta_3))`.
fn rates(angle: f64) -> [f64; 2] {
    let [coupler, rocker] = BARS.angles(angle);
    let over = BARS.crank / (rocker - coupler).sin();
    [over * (angle - rocker).sin() / BARS.coupler, over * (angle - coupler).sin() / BARS.rocker]
}

/// Bars keep their lengths at every angle, and the angles move at the rates of the closed form.
#[test]
fn a_four_bar_closes_and_moves_as_its_velocity_ratios_say() {
    assert!(BARS.is_crank_rocker());
    assert!(!FourBar { crank: 0.3, ..BARS }.is_crank_rocker() && !FourBar { coupler: 0.61, ..BARS }.is_crank_rocker());
    let [coupler, rocker] = [0, 1].map(|bar| Orders::sampled(|angle| BARS.angles(angle)[bar]));
    for step in 0..40 {
        let angle = 0.1 + TAU * f64::from(step) / 40.0;
        let [c, r] = BARS.angles(angle);
        let x = BARS.crank * angle.cos() + BARS.coupler * c.cos() - BARS.ground - BARS.rocker * r.cos();
        let y = BARS.crank * angle.sin() + BARS.coupler * c.sin() - BARS.rocker * r.sin();
        assert!(x.hypot(y) < 1e-14 && r > 0.0 && r < PI, "{angle}: {x} {y}");
        for (series, rate) in [&coupler, &rocker].into_iter().zip(rates(angle)) {
            // coefficients of rounding times their orders, up to a hundred
            assert!((series.slope().at(angle) - rate).abs() < 1e-12, "{angle}: {rate}");
        }
    }
}

fn press() -> Motion {
    let [coupler, rocker] = [0, 1].map(|bar| Orders::sampled(|angle| BARS.angles(angle)[bar]));
    let law = Orders::inertia(&[(COUPLER, &coupler), (ROCKER, &rocker)]);
    let work = Source::Stroke { torque: rocker.slope().times(-FORCE), from: ARC[0], to: ARC[1], turns: 1 };
    let crank = Coordinate::new(FLYWHEEL).speed(15.0).inertia_law(law).source(work);
    Train::new().coordinate(crank.source(Source::Line { stall: LINE[0], slope: LINE[1] })).build().unwrap()
}

/// Speed after one turn from `speed`, with the extremes and the time: `d(J w^2/2)/dphi = M`, by Runge-Kutta of order
/// four from arc to arc, with inertia and torque from the velocity ratios.
fn turn(speed: f64, inertia: &dyn Fn(f64) -> f64, torque: &dyn Fn(f64, f64, bool) -> f64, arc: [f64; 2]) -> [f64; 4] {
    let mut energy = 0.5 * inertia(0.0) * speed * speed;
    let (mut most, mut least, mut time) = (speed, speed, 0.0);
    for (from, to, on) in [(0.0, arc[0], false), (arc[0], arc[1], true), (arc[1], TAU, false)] {
        const STEPS: usize = 20_000;
        let h = (to - from) / STEPS as f64;
        let speed = |angle: f64, energy: f64| (2.0 * energy / inertia(angle)).sqrt();
        let rate = |angle: f64, energy: f64| torque(angle, speed(angle, energy), on);
        let mut last = [speed(from, energy); 2];
        for step in 0..STEPS {
            let angle = from + h * step as f64;
            let k1 = rate(angle, energy);
            let k2 = rate(angle + 0.5 * h, energy + 0.5 * h * k1);
            let k3 = rate(angle + 0.5 * h, energy + 0.5 * h * k2);
            let k4 = rate(angle + h, energy + h * k3);
            let half = energy + 0.5 * h * k3;
            let begun = speed(angle, energy);
            energy += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            let now = speed(angle + h, energy);
            time += h / 6.0 * (1.0 / begun + 4.0 / speed(angle + 0.5 * h, half) + 1.0 / now);
            // the top of the parabola through three speeds, where the middle one is the greatest or the least
            let bend = last[0] - 2.0 * last[1] + now;
            if (last[1] - last[0]) * (last[1] - now) > 0.0 {
                let top = last[1] - (now - last[0]).powi(2) / (8.0 * bend);
                (most, least) = (most.max(top), least.min(top));
            }
            (most, least) = (most.max(now), least.min(now));
            last = [last[1], now];
        }
    }
    [(2.0 * energy / inertia(TAU)).sqrt(), most, least, time]
}

/// The start that comes back after a turn, by secants; its delta.
fn shooting(guess: f64, inertia: &dyn Fn(f64) -> f64, torque: &dyn Fn(f64, f64, bool) -> f64, arc: [f64; 2]) -> f64 {
    let off = |speed: f64| turn(speed, inertia, torque, arc)[0] - speed;
    let (mut a, mut b) = (guess, 1.01 * guess);
    let (mut at_a, mut at_b) = (off(a), off(b));
    for _ in 0..20 {
        if (b - a).abs() < 1e-13 * b.abs() || at_a == at_b {
            break;
        }
        let next = b - at_b * (b - a) / (at_b - at_a);
        (a, at_a) = (b, at_b);
        (b, at_b) = (next, off(next));
    }
    let [_, most, least, time] = turn(b, inertia, torque, arc);
    (most - least) * time / TAU
}

/// The cycle that a machine settles to has the delta of shooting, comes back, and is proven when it is run once more.
fn settles_as_by_shooting(
    mut motion: Motion,
    guess: f64,
    inertia: &dyn Fn(f64) -> f64,
    torque: &dyn Fn(f64, f64, bool) -> f64,
    arc: [f64; 2],
) {
    let cycle = motion.steady_cycle(0, 1, 1000, |_| ()).unwrap();
    let expected = shooting(guess, inertia, torque, arc);
    println!("delta {:.12} {expected:.12} after {} cycles", cycle.delta(), cycle.cycles);
    assert!(expected > 0.02, "{expected}");
    // 1e-10 of a speed over a delta of some percent
    assert!((cycle.delta() / expected - 1.0).abs() < 1e-7, "{cycle:?} {expected}");
    let (run, residual) = motion.closed_cycle(0, 1, 1000, 100, |_| ()).unwrap();
    assert!(residual <= 1e-9, "{residual}");
    prove(&run).unwrap();
    let [e, time] = [run.motion().extremes(Signal::Speed(0)).unwrap()].map(|e| [e.peak - e.least, cycle.time])[0];
    // what does not come back, over a delta of some percent
    assert!((e * time / TAU / expected - 1.0).abs() < 1e-6, "{e} {expected}");
}

#[test]
fn the_steady_cycle_of_a_four_bar_press_is_that_of_shooting() {
    let inertia = |angle: f64| {
        let [coupler, rocker] = rates(angle);
        FLYWHEEL + COUPLER * coupler * coupler + ROCKER * rocker * rocker
    };
    let torque = |angle: f64, speed: f64, on: bool| {
        let work = if on { -FORCE * rates(angle)[1] } else { 0.0 };
        LINE[0] - LINE[1] * speed + work
    };
    settles_as_by_shooting(press(), 15.0, &inertia, &torque, ARC);
}

#[test]
fn the_steady_cycle_of_a_slider_with_a_force_over_part_of_its_stroke_is_that_of_shooting() {
    let (r, l, mass, force) = (0.08, 0.3, 40.0, 9000.0);
    let way = move |angle: f64| r * angle.cos() + (l * l - (r * angle.sin()).powi(2)).sqrt();
    let arc = [3.6, 5.2];
    let work =
        Source::Stroke { torque: Orders::sampled(way).slope().times(-force), from: arc[0], to: arc[1], turns: 1 };
    let line = Source::Line { stall: 900.0, slope: 20.0 };
    let crank = Coordinate::new(12.0).speed(30.0).crank(Crank::new(r, l, mass)).source(work).source(line);
    let motion = Train::new().coordinate(crank).build().unwrap();
    // x' = -r sin - r^2 sin cos/S
    let slope = move |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        -r * sine - r * r * sine * cosine / (l * l - r * r * sine * sine).sqrt()
    };
    let inertia = |angle: f64| 12.0 + mass * slope(angle).powi(2);
    let torque = |angle: f64, speed: f64, on: bool| 900.0 - 20.0 * speed - if on { force * slope(angle) } else { 0.0 };
    settles_as_by_shooting(motion, 30.0, &inertia, &torque, arc);
}

/// A law of inertia from the way of a slider is the crank's own, and runs of both are proven and alike.
#[test]
fn a_slider_by_its_way_is_a_crank() {
    let crank = Crank::new(0.1, 0.35, 40.0);
    let way = Orders::sampled(|angle| 0.1 * angle.cos() + (0.35 * 0.35 - (0.1 * angle.sin()).powi(2)).sqrt());
    let law = Orders::inertia(&[(40.0, &way)]);
    for step in 0..20 {
        let angle = 0.3 * f64::from(step);
        let (inertia, slope) = crank.inertia(angle);
        // roundings of a hundred coefficients, the slope's times their orders
        assert!((law.at(angle) - inertia).abs() < 1e-12 && (law.slope().at(angle) - slope).abs() < 1e-10, "{angle}");
    }
    let run = |coordinate: Coordinate| {
        let mut run = Recording::new(Train::new().coordinate(coordinate).build().unwrap());
        (0..200).for_each(|_| run.advance(2e-3));
        prove(&run).unwrap();
        [run.motion().angle(0), run.motion().speed(0)]
    };
    let bare = || Coordinate::new(0.4).speed(20.0).source(Source::Constant(3.0));
    let (ours, expected) = (run(bare().inertia_law(law)), run(bare().crank(crank)));
    // angles of eight radians, by laws that differ by 1e-12
    assert!(ours.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-10), "{ours:?} {expected:?}");
}

/// A force over a part of a stroke gives its work, `F (x_2 - x_1)`, whatever the crank does meanwhile; a torque over an
/// arc of a cycle of two turns gives `T (to - from)` in the first turn and nothing in the second.
#[test]
fn forces_over_a_stroke_and_torques_over_two_turns_give_their_work() {
    let crank = Crank::new(0.1, 0.35, 40.0);
    let way = |angle: f64| 0.1 * angle.cos() + (0.35 * 0.35 - (0.1 * angle.sin()).powi(2)).sqrt();
    let push = Orders::sampled(way).slope().times(-500.0);
    let stroke = Source::Stroke { torque: push, from: 0.5, to: 2.0, turns: 1 };
    let constant = Orders(vec![driveline_solver::plant::train::Harmonic { order: 0.0, cosine: 70.0, sine: 0.0 }]);
    let ignition = Source::Stroke { torque: constant, from: 0.7, to: 8.0, turns: 2 };
    let coordinate = Coordinate::new(2.0).speed(20.0).crank(crank).source(stroke).source(ignition);
    let mut run = Recording::new(Train::new().coordinate(coordinate).build().unwrap());
    let energy = |run: &Recording| {
        let (angle, speed) = (run.motion().angle(0), run.motion().speed(0));
        0.5 * (2.0 + crank.inertia(angle).0) * speed * speed
    };
    let start = energy(&run);
    while run.motion().angle(0) < 4.0 * TAU {
        run.advance(1e-3);
        let angle = run.motion().angle(0);
        let (turn, within) = ((angle / TAU).floor(), angle.rem_euclid(TAU));
        let (pair, double) = ((angle / (2.0 * TAU)).floor(), angle.rem_euclid(2.0 * TAU));
        let stroke = 500.0 * (turn * (way(0.5) - way(2.0)) + way(0.5) - way(within.clamp(0.5, 2.0)));
        let ignition = 70.0 * (pair * 7.3 + double.clamp(0.7, 8.0) - 0.7);
        let expected = start + stroke + ignition;
        // roundings of some thousand stretches
        assert!((energy(&run) / expected - 1.0).abs() < 1e-11, "{angle}: {} {expected}", energy(&run));
    }
    prove(&run).unwrap();
}

/// A stroke from before the dead centre to behind it gives its work, begun on the arc or off it, forwards and back.
#[test]
fn a_stroke_passes_the_angle_zero() {
    let way = |angle: f64| 0.1 * angle.cos() + (0.35 * 0.35 - (0.1 * angle.sin()).powi(2)).sqrt();
    for (start, speed) in [(0.0, 20.0), (3.0, 20.0), (0.9, -20.0), (7.0, -20.0)] {
        let push = Orders::sampled(way).slope().times(300.0);
        let stroke = Source::Stroke { torque: push, from: 5.5, to: TAU + 0.8, turns: 1 };
        let coordinate = Coordinate::new(4.0).angle(start).speed(speed).source(stroke);
        let mut run = Recording::new(Train::new().coordinate(coordinate).build().unwrap());
        let on = |angle: f64| {
            // work up to an angle: whole turns, and what lies within the last arc
            let turn = ((angle - 5.5) / TAU).floor();
            let within = (angle - TAU * turn).min(TAU + 0.8);
            300.0 * (turn * (way(0.8) - way(5.5)) + way(within) - way(5.5))
        };
        for _ in 0..1000 {
            run.advance(1e-3);
            let (angle, speed_now) = (run.motion().angle(0), run.motion().speed(0));
            let expected = 2.0 * speed * speed + on(angle) - on(start);
            // roundings of some thousand stretches
            assert!((2.0 * speed_now * speed_now / expected - 1.0).abs() < 1e-11, "{start} {angle}");
        }
        prove(&run).unwrap();
    }
}

/// Dry friction on a crank takes its torque times the angle, and holds the weight of the slider where it has come to
/// rest; a weight beyond its breakaway torque drives it off again.
#[test]
fn a_crank_rubs_in_its_bearing_and_rests() {
    let crank = Crank::new(0.1, 0.35, 40.0);
    let way = |angle: f64| 0.1 * angle.cos() + (0.35 * 0.35 - (0.1 * angle.sin()).powi(2)).sqrt();
    let lines = Orders::sampled(way).slope();
    for (weight, holds) in [(100.0, true), (250.0, false)] {
        let coordinate = Coordinate::new(2.0).speed(12.0).crank(crank).source(Source::Orders(lines.times(-weight).0));
        let train = Train::new().coordinate(coordinate).friction(Friction::ground(0, 14.0).breakaway(15.0));
        let mut run = Recording::new(train.build().unwrap());
        let (mut turned, mut last, start) = (0.0, 0.0, 0.5 * (2.0 + crank.inertia(0.0).0) * 144.0 + weight * way(0.0));
        for _ in 0..3000 {
            run.advance(1e-3);
            let (angle, speed) = (run.motion().angle(0), run.motion().speed(0));
            turned += (angle - last).abs();
            last = angle;
            if !run.motion().events().is_empty() {
                continue;
            }
            let energy = 0.5 * (2.0 + crank.inertia(angle).0) * speed * speed + weight * way(angle);
            assert!((energy - start + 14.0 * turned).abs() < 1e-10 * start, "{angle}: {energy}");
        }
        prove(&run).unwrap();
        assert!(!run.motion().events().is_empty());
        if holds {
            // 100 N on at most 0.104 m a radian is 10.4 N m
            assert_eq!(run.motion().speed(0), 0.0);
        }
    }
    let crank = || Coordinate::new(2.0).crank(crank);
    let between =
        Train::new().coordinate(crank()).coordinate(Coordinate::new(1.0)).friction(Friction::between(0, 1, 1.0));
    assert!(between.build().is_err());
    assert!(Train::new().coordinate(crank()).friction(Friction::ground(0, 1.0).surface(2.0)).build().is_err());
}

/// A lossy gear drives a crank's shaft, and the crank drives a lossy gear: power behind it over power before it is its
/// efficiency. The run is proven.
#[test]
fn a_crank_drives_a_lossy_gear() {
    let crank = Coordinate::new(2.0).crank(Crank::new(0.1, 0.35, 4.0)).source(Source::Line { stall: 80.0, slope: 2.0 });
    let train = Train::new()
        .coordinate(crank)
        .coordinate(Coordinate::new(3.0).viscous(4.0))
        .link(Link::geared(0, 1, 2.0, 4.0e3).damping(8.0).efficiency(0.9));
    let mut run = Recording::new(train.build().unwrap());
    (0..1500).for_each(|_| run.advance(2e-3));
    prove(&run).unwrap();
    // what the motor gives over whole cycles, less the loss of the gear, is what the load takes
    let mut motion = run.motion().clone();
    let cycle = motion.steady_cycle(0, 1, 2000, |_| ()).unwrap();
    // the cycle is extrapolated; the motion itself comes to it
    motion.advance(100.0 * cycle.time);
    let [mut given, mut taken] = [0.0; 2];
    let steps = 4000;
    for step in 0..=steps {
        let weight = if step == 0 || step == steps { 0.5 } else { 1.0 };
        let (motor, load) = (motion.speed(0), motion.speed(1));
        given += weight * (80.0 - 2.0 * motor) * motor;
        // the load, and the damper of the shaft behind the gear
        taken += weight * (4.0 * load * load + 8.0 * (motor - 2.0 * load).powi(2));
        motion.advance(cycle.time / f64::from(steps));
    }
    // the trapezium rule of a smooth periodic power; flows do not turn round
    assert!((taken / given - 0.9).abs() < 1e-6, "{} {:?}", taken / given, motion.events());
}

/// Dry friction of a slider on its guide takes its force times the way, there and back: `4 r F` a turn.
#[test]
fn a_slider_rubs_on_its_guide() {
    let way = Orders::sampled(|angle| 0.1 * angle.cos() + (0.35 * 0.35 - (0.1 * angle.sin()).powi(2)).sqrt());
    let sources = rubbing(&way, 60.0);
    assert_eq!(sources.len(), 2);
    let coordinate = sources.into_iter().fold(Coordinate::new(4.0).speed(20.0), Coordinate::source);
    let mut run = Recording::new(Train::new().coordinate(coordinate).build().unwrap());
    for _ in 0..2000 {
        run.advance(1e-3);
        let (angle, speed) = (run.motion().angle(0), run.motion().speed(0));
        // from the top dead centre in, then out
        let (turn, within) = ((angle / TAU).floor(), angle.rem_euclid(TAU));
        let moved = if within < PI { way.at(0.0) - way.at(within) } else { 0.2 + way.at(within) - way.at(PI) };
        let expected = 800.0 - 60.0 * (0.4 * turn + moved);
        assert!((2.0 * speed * speed / expected - 1.0).abs() < 1e-10, "{angle}");
    }
    prove(&run).unwrap();
}

/// The slider of a toggle stays on its line, a link's length from the knee; its way is the closed form by small
/// differences of the knee.
#[test]
fn a_toggle_keeps_the_length_of_its_link() {
    let bars = FourBar { crank: 0.06, coupler: 0.5, rocker: 0.3, ground: 0.55 };
    let toggle = Toggle { bars, link: 0.32, direction: 1.9 };
    let way = Orders::sampled(|angle| toggle.way(angle));
    for step in 0..40 {
        let angle = TAU * f64::from(step) / 40.0;
        let rocker = bars.angles(angle)[1];
        let knee = [bars.rocker * rocker.cos(), bars.rocker * rocker.sin()];
        let slider = [toggle.way(angle) * 1.9_f64.cos(), toggle.way(angle) * 1.9_f64.sin()];
        assert!(((knee[0] - slider[0]).hypot(knee[1] - slider[1]) - 0.32).abs() < 1e-14, "{angle}");
        assert!((way.at(angle) - toggle.way(angle)).abs() < 1e-12, "{angle}");
    }
}

/// Of an almost flat four-bar the ratio is steep: the series still has that of the closed form, or is no number.
#[test]
fn bars_near_their_change_point_are_sampled_until_their_series_converges() {
    for ground in [0.4, 0.49, 0.4999] {
        let bars = FourBar { crank: 0.1, coupler: 0.3, rocker: 0.3, ground };
        let slope = Orders::sampled(|angle| bars.angles(angle)[1]).slope();
        for angle in [0.0, 1.0, 3.0, 3.1, 3.13] {
            let [coupler, rocker] = bars.angles(angle);
            let expected = bars.crank * (coupler - angle).sin() / (bars.rocker * (coupler - rocker).sin());
            // coefficients up to 1e-10 of the largest are left out, some hundreds of them
            assert!((slope.at(angle) - expected).abs() < 1e-7, "{ground} {angle}: {} {expected}", slope.at(angle));
        }
    }
    let flat = FourBar { crank: 0.1, coupler: 0.3, rocker: 0.3, ground: 0.499_999_999 };
    let rocker = Orders::sampled(|angle| flat.angles(angle)[1]);
    let press = Coordinate::new(1.0).inertia_law(Orders::inertia(&[(2.5, &rocker)]));
    assert!(Train::new().coordinate(press).build().is_err());
}

/// A motor of 400 N m and 20 N m s/rad on 6 kg m2 settles to 20 rad/s, from a tenth of a second after rest as well.
/// What coasts, turns backwards or gathers speed for ever does not.
#[test]
fn a_steady_cycle_is_found_from_rest_and_nowhere_else() {
    let cycle = |coordinate: Coordinate, time: f64| {
        let mut motion = Train::new().coordinate(coordinate).build().unwrap();
        motion.advance(time);
        motion.steady_cycle(0, 1, 2000, |_| ())
    };
    let motor = |stall| Coordinate::new(6.0).source(Source::Line { stall, slope: 20.0 });
    // 1e-10 of what is left of the start
    assert!((cycle(motor(400.0), 0.1).unwrap().mean - 20.0).abs() < 2e-9);
    assert_eq!(cycle(motor(-400.0), 5.0), None);
    assert_eq!(cycle(Coordinate::new(1.0).speed(10.0).viscous(1.0), 1.0), None);
    let drift = Coordinate::new(2e5).speed(157.0).source(Source::Constant(0.05));
    assert_eq!(cycle(drift, 0.1), None);
}
