//! Prime movers and load programs, each against its closed form.

use std::f64::consts::TAU;

use driveline_solver::plant::LoadProgram;
use driveline_solver::plant::train::{Coordinate, Link, Source, Train, Waveform};

/// Speed of a free inertia under one source, from rest.
fn run_up(inertia: f64, speed: f64, source: Source, times: &[f64]) -> Vec<f64> {
    let mut motion = Train::new().coordinate(Coordinate::new(inertia).speed(speed).source(source)).build().unwrap();
    let mut at = |t: &f64| {
        motion.advance(t - motion.time());
        motion.speed(0)
    };
    times.iter().map(&mut at).collect()
}

const TIMES: [f64; 6] = [0.01, 0.1, 0.3, 0.7, 1.0, 2.5];

#[test]
fn a_linear_characteristic_runs_up_exponentially() {
    let found = run_up(0.4, 0.0, Source::Line { stall: 90.0, slope: 0.6 }, &TIMES);
    for (speed, t) in found.iter().zip(TIMES) {
        let expected = 150.0 * (1.0 - (-0.6 * t / 0.4_f64).exp());
        assert!((speed - expected).abs() < 1e-12 * 150.0, "{t}: {speed} {expected}");
    }
}

#[test]
fn a_parabola_runs_up_as_riccati_says() {
    // a - c w^2: w = sqrt(a/c) tanh(sqrt(a c) t/J)
    let (a, c, j) = (80.0, 0.01, 0.5);
    let found = run_up(j, 0.0, Source::Parabola(a, 0.0, -c), &TIMES);
    for (speed, t) in found.iter().zip(TIMES) {
        let expected = f64::sqrt(a / c) * (f64::sqrt(a * c) * t / j).tanh();
        assert!((speed - expected).abs() < 1e-12 * 90.0, "{t}: {speed} {expected}");
    }
}

#[test]
fn the_book_s_series_motor_has_the_book_s_torques() {
    // through (64, 13.5), (100, 4.5), (160, 0.72) [Wang 1989 example 1-1]: slopes of speed at a stand-still of time
    let (a, b, c) = (41.966_666_666_666_67, -0.569_458_333_333_333_3, 0.001_947_916_666_666_666_6);
    for (speed, torque) in [(64.0, 13.5), (100.0, 4.5), (160.0, 0.72), (80.0, 8.876_666_666_666_667)] {
        let moved = run_up(1.0, speed, Source::Parabola(a, b, c), &[1e-7])[0] - speed;
        // over 1e-7 s the torque changes by 1e-7 of its slope; the difference of speeds has 1e-14/1e-7 of rounding
        assert!((moved / 1e-7 - torque).abs() < 1e-6, "{speed}: {}", moved / 1e-7);
    }
}

#[test]
fn an_induction_motor_runs_up_in_the_time_of_kloss_s_formula() {
    // t = J w0/(2 tau_A) ((1 - s^2)/(2 s_A) + s_A ln(1/s))
    let (inertia, breakdown, slip, synchronous) = (0.6, 300.0, 0.18, 157.0);
    let time = |s: f64| inertia * synchronous / (2.0 * breakdown) * ((1.0 - s * s) / (2.0 * slip) - slip * s.ln());
    let slips = [0.9, 0.5, 0.18, 0.05, 1e-3, 1e-6];
    let times: Vec<f64> = slips.iter().map(|&s| time(s)).collect();
    let found = run_up(inertia, 0.0, Source::Kloss { breakdown, slip, synchronous }, &times);
    for (speed, s) in found.iter().zip(slips) {
        assert!((speed / synchronous - (1.0 - s)).abs() < 1e-12, "{s}: {speed}");
    }
}

#[test]
fn the_starting_laws_give_their_polynomials() {
    let (torque, end, j) = (50.0, 0.8, 2.0);
    for power in [1_u8, 2] {
        let found = run_up(j, 0.0, Source::Starting { torque, time: end, power }, &TIMES);
        for (speed, t) in found.iter().zip(TIMES) {
            let (t, n) = (t.min(end), i32::from(power));
            let expected = torque / j * (t - t * (t / end).powi(n) / f64::from(n + 1));
            assert!((speed - expected).abs() < 1e-13 * torque, "{power} {t}: {speed} {expected}");
        }
    }
}

#[test]
fn a_table_and_a_ramp_give_their_integrals() {
    let table = LoadProgram::table(&[(0.2, 0.0), (0.6, 40.0), (0.8, 40.0), (0.9, -10.0)]);
    let found = run_up(1.0, 0.0, Source::Program(table), &[0.2, 0.6, 0.8, 0.9, 1.9]);
    for (speed, expected) in found.iter().zip([0.0, 8.0, 16.0, 17.5, 7.5]) {
        // areas of triangles and rectangles
        assert!((speed - expected).abs() < 1e-13, "{speed} {expected}");
    }
}

#[test]
fn an_oscillator_follows_every_waveform_harmonic_by_harmonic() {
    let (inertia, k, period) = (0.5, 900.0, 0.4);
    let waves = [
        Waveform::triangle(20.0, period, 15),
        Waveform::square(20.0, period, 15),
        Waveform::sawtooth_up(20.0, period, 15),
        Waveform::sawtooth_down(20.0, period, 15),
        Waveform::rectified(20.0, period, 15),
    ];
    for wave in waves {
        // steady state: every harmonic over k - J (n omega)^2, none of them near resonance at 42.4 rad/s = 2.7 orders
        let steady = |t: f64| {
            let mut sum = (wave.mean / k, 0.0);
            for h in &wave.harmonics {
                let omega = TAU * h.order / period;
                let gain = 1.0 / (k - inertia * omega * omega);
                let (sine, cosine) = (omega * t).sin_cos();
                sum.0 += gain * (h.cosine * cosine + h.sine * sine);
                sum.1 += gain * omega * (h.sine * cosine - h.cosine * sine);
            }
            sum
        };
        let (angle, speed) = steady(0.0);
        let mut motion = Train::new()
            .coordinate(Coordinate::new(inertia).speed(speed).source(Source::Waveform(wave.clone())))
            .link(Link::ground(0, k).elongated(angle))
            .build()
            .unwrap();
        for step in 1..=100 {
            motion.advance(0.037);
            let (angle, speed) = steady(0.037 * f64::from(step));
            // nine periods of rounding, angles of a tenth, speeds of a few
            assert!((motion.elongation(0) - angle).abs() < 1e-12, "{step}");
            assert!((motion.speed(0) - speed).abs() < 1e-11, "{step}");
        }
    }
}
