//! Dampers and absorbers, each against its closed form: tuned, viscous (Lanchester), dry friction `[derived;
//! heading: Pfützner 1980 §1.5]`.

use std::f64::consts::{PI, TAU};

use driveline_solver::plant::train::{Coordinate, Friction, Harmonic, Link, Signal, Source, Train, Waveform};
use driveline_solver::plant::{EventKind, LoadProgram};
use nalgebra::Complex;

fn swing(amplitude: f64, omega: f64) -> Source {
    let harmonics = vec![Harmonic { order: 1.0, cosine: amplitude, sine: 0.0 }];
    Source::Waveform(Waveform { period: TAU / omega, mean: 0.0, harmonics })
}

#[test]
fn a_tuned_absorber_keeps_its_disc_still() {
    let (main, absorber, k1, k2, torque) = (2.0, 0.2, 8000.0, 720.0, 15.0);
    let omega = f64::sqrt(k2 / absorber);
    // the absorber alone swings, with the torque's own amplitude in its spring
    let mut motion = Train::new()
        .coordinate(Coordinate::new(main).source(swing(torque, omega)))
        .coordinate(Coordinate::new(absorber))
        .link(Link::ground(0, k1))
        .link(Link::shaft(0, 1, k2).elongated(torque / k2))
        .build()
        .unwrap();
    for signal in [Signal::Elongation(0), Signal::Force(1)] {
        motion.watch(signal);
    }
    motion.advance(50.0 * TAU / omega);
    let [still, spring] = [Signal::Elongation(0), Signal::Force(1)].map(|signal| motion.extremes(signal).unwrap());
    // without it the disc would swing by torque/(k1 - J omega^2) = 19 mrad; fifty periods of rounding are left
    assert!(still.peak.abs().max(still.least.abs()) < 1e-12, "{still:?}");
    assert!((spring.peak - torque).abs() < 1e-9 && (spring.least + torque).abs() < 1e-9, "{spring:?}");
}

/// Amplitude of a disc with a viscously coupled ring, forced at `ratio` of its own frequency, over its static
/// deflection.
fn lanchester(ratio: f64, damping: f64) -> f64 {
    let (disc, ring, k, torque) = (2.0, 0.8, 5000.0, 10.0);
    let omega = ratio * f64::sqrt(k / disc);
    // the closed form of the steady state, as complex amplitudes of the two angles
    let s = Complex::new(0.0, omega);
    let (c, mass) = (Complex::from(damping), |j: f64| s * s * j);
    let (a, b, d) = (mass(disc) + c * s + k, -c * s, mass(ring) + c * s);
    let first = d * torque / (a * d - b * b);
    let second = -b / d * first;
    let mut motion = Train::new()
        .coordinate(Coordinate::new(disc).speed((s * first).re).source(swing(torque, omega)))
        .coordinate(Coordinate::new(ring).speed((s * second).re))
        .link(Link::ground(0, k).elongated(first.re))
        .link(Link::shaft(0, 1, 0.0).damping(damping))
        .build()
        .unwrap();
    motion.watch(Signal::Elongation(0));
    for step in 1..=200 {
        let t = f64::from(step) * 0.05 * TAU / omega;
        motion.advance(t - motion.time());
        let expected = (first * (s * t).exp()).re;
        let off = (motion.elongation(0) - expected).abs() / first.norm();
        // the stiffest damper makes some thousand stretches of ten periods, each rounded
        assert!(off < 1e-11, "{damping} {t}: {off:e}");
    }
    motion.extremes(Signal::Elongation(0)).unwrap().peak * k / torque
}

#[test]
fn all_lanchester_dampers_meet_in_one_point() {
    // at r^2 = 2/(2 + mu) the amplitude is (2 + mu)/mu whatever the damping
    let mu = 0.8 / 2.0_f64;
    let fixed = (2.0 / (2.0 + mu)).sqrt();
    for damping in [1.0, 30.0, 1000.0] {
        let amplitude = lanchester(fixed, damping);
        // the frequency itself is rounded; near the fixed point amplitudes change by a few times their own size per
        // ratio
        assert!((amplitude / ((2.0 + mu) / mu) - 1.0).abs() < 1e-10, "{damping}: {amplitude}");
    }
    // away from it the damping tells
    assert!((lanchester(0.9 * fixed, 1.0) - lanchester(0.9 * fixed, 1000.0)).abs() > 0.5);
}

#[test]
fn a_friction_damper_takes_up_its_ring_and_lets_it_slip_again() {
    // a hub at 20 rad/s, its ring at rest on a friction of 6 N m; from 4 s on the hub is driven, from 5 s too hard
    let (hub, ring, friction) = (3.0, 1.5, 6.0);
    let drive = LoadProgram::steps(&[(4.0, 17.0), (5.0, 25.0)]);
    let mut motion = Train::new()
        .coordinate(Coordinate::new(hub).speed(20.0).source(Source::Program(drive)))
        .coordinate(Coordinate::new(ring))
        .friction(Friction::between(0, 1, friction))
        .build()
        .unwrap();
    motion.advance(4.0);
    // closes 20 rad/s at 6/3 + 6/1.5 rad/s2, then both turn with the common momentum
    let stop = motion.events()[0];
    assert!(stop.kind == EventKind::Stop && (stop.time - 20.0 / 6.0).abs() < 1e-13, "{stop:?}");
    let common = 20.0 * hub / (hub + ring);
    // half a dozen additions
    assert!((motion.speed(0) - common).abs() < 1e-13 && (motion.speed(1) - common).abs() < 1e-13);
    motion.advance(1.0);
    // 17 N m asks for 17/3 on the ring, less than friction has: both gain 17/4.5 rad/s
    assert!((motion.speed(1) - common - 17.0 / 4.5).abs() < 1e-13, "{}", motion.speed(1));
    motion.advance(1.0);
    // 25 N m would ask for 25/3, more than the 6 N m
    assert_eq!(motion.events().len(), 2, "{:?}", motion.events());
    let slip = motion.events()[1];
    assert!(slip.kind == EventKind::Slip && (slip.time - 5.0).abs() < 1e-13, "{slip:?}");
    let gained = motion.speed(1) - common - 17.0 / 4.5;
    assert!((gained - friction / ring).abs() < 1e-13, "{gained}");
}

#[test]
fn dry_friction_takes_the_same_off_every_swing() {
    // from x0 a free swing loses 2 F/k every half period and stops inside the band of F/k
    let (mass, k, friction) = (2.0, 800.0, 10.0);
    let mut motion = Train::new()
        .coordinate(Coordinate::new(mass))
        .link(Link::ground(0, k).elongated(0.106))
        .friction(Friction::ground(0, friction))
        .build()
        .unwrap();
    let half = PI / f64::sqrt(k / mass);
    let mut expected: f64 = 0.106;
    for swing in 1..=4 {
        motion.advance(half);
        expected = -(expected.abs() - 2.0 * friction / k) * expected.signum();
        assert!((motion.elongation(0) - expected).abs() < 1e-13, "{swing}: {} {expected}", motion.elongation(0));
    }
    motion.advance(1.0);
    // 0.106 - 4 x 0.025 = 6 mm, inside the 12.5 mm that friction holds
    assert!((motion.elongation(0) - 0.006).abs() < 1e-13 && motion.speed(0) == 0.0);
}

#[test]
fn stick_and_slip_on_a_belt_take_the_times_of_the_closed_form() {
    let (mass, k, stick, slide, belt) = (1.0, 400.0, 5.0, 3.0, 0.1);
    let friction = Friction::ground(0, slide).breakaway(stick).surface(belt);
    let mut motion = Train::new()
        .coordinate(Coordinate::new(mass).speed(belt))
        .link(Link::ground(0, k))
        .friction(friction)
        .build()
        .unwrap();
    motion.advance(3.0);
    let events = motion.events();
    let omega = f64::sqrt(k / mass);
    let drop = (stick - slide) / k;
    // carried along until the spring asks for the breakaway force; slides until the belt has caught up again
    let first = stick / (k * belt);
    let sliding = 2.0 / omega * (PI - (drop * omega / belt).atan());
    let sticking = 2.0 * drop / belt;
    let mut time = first;
    assert!(events.len() > 8);
    for (i, event) in events.iter().enumerate() {
        let kind = if i % 2 == 0 { EventKind::Slip } else { EventKind::Stop };
        // each located to 1e-14 s, and rounding of a dozen of them
        assert!(event.kind == kind && (event.time - time).abs() < 1e-12, "{event:?} {time}");
        time += if i % 2 == 0 { sliding } else { sticking };
    }
}
