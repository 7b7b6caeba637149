//! Prime movers and load programs, each against its closed form.

use std::f64::consts::TAU;

use driveline_solver::plant::LoadProgram;
use driveline_solver::plant::train::converge::{Recording, prove};
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
        Waveform::sawtooth(20.0, period, 15),
        Waveform::pulses(20.0, 0.13, period, 15),
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

#[test]
fn a_series_motor_runs_up_with_the_third_root_of_time() {
    // J dw/dt = c U^2/(R + c w)^2: (R + c w)^3 = R^3 + 3 c^2 U^2 t/J
    let (voltage, resistance, flux, j) = (440.0_f64, 1.5_f64, 0.03, 4.0);
    let found = run_up(j, 0.0, Source::Series { voltage, resistance, flux }, &TIMES);
    for (speed, t) in found.iter().zip(TIMES) {
        let sum = (resistance.powi(3) + 3.0 * (flux * voltage).powi(2) * t / j).cbrt();
        let expected = (sum - resistance) / flux;
        assert!((speed - expected).abs() < 1e-12 * 200.0, "{t}: {speed} {expected}");
    }
}

/// An engine with spark ignition, 1500 N m at 200 rad/s, idle at 70, no load at 210 rad/s.
fn engine() -> Source {
    let torques = vec![[1500.0, 7.5, -0.0375], [150.0 * 210.0, -150.0, 0.0]];
    Source::Pieces { ends: vec![70.0, 200.0, 210.0], torques }
}

#[test]
fn an_engine_runs_up_its_parabola_and_then_its_governor_s_line() {
    // x' = (1 + x - x^2)/T with T = J w_N/tau_N and the roots x+- = (1 +- sqrt 5)/2:
    // (x - x-)/(x+ - x) grows as e^(sqrt(5) t/T); beyond rated speed the rest to no load falls as e^(-150 t/J)
    let j = 30.0;
    let (time, root) = (j * 200.0 / 1500.0, 5.0_f64.sqrt());
    let (high, low) = (0.5 * (1.0 + root), 0.5 * (1.0 - root));
    let odds = |x: f64| (x - low) / (high - x);
    let rated = time / root * (odds(1.0) / odds(0.35)).ln();
    let expected = |t: f64| {
        if t < rated {
            let now = odds(0.35) * (root * t / time).exp();
            200.0 * (low + now * high) / (1.0 + now)
        } else {
            210.0 - 10.0 * (-150.0 * (t - rated) / j).exp()
        }
    };
    let coordinate = Coordinate::new(j).speed(70.0).source(engine());
    let mut run = Recording::new(Train::new().coordinate(coordinate).build().unwrap());
    for step in 1..=60 {
        run.advance(0.05);
        let (t, speed) = (0.05 * f64::from(step), run.motion().speed(0));
        // rounding of the clock and of 60 steps
        assert!((speed - expected(t)).abs() < 1e-11 * 210.0, "{t}: {speed} {}", expected(t));
    }
    // both parts are passed
    assert!(rated > 0.5 && rated < 2.5, "{rated}");
    assert!(prove(&run).unwrap().largest() <= 1e-8);
}

#[test]
fn an_engine_that_is_pulled_under_idle_stalls() {
    // between 70 and 80 rad/s the torque is 1500 (1 + x - x^2) of x from 0.35 to 0.4; a brake of 2500 N m wins
    let (j, brake) = (30.0, 2500.0);
    let coordinate = Coordinate::new(j).speed(80.0).source(engine()).source(Source::Constant(-brake));
    let mut run = Recording::new(Train::new().coordinate(coordinate).build().unwrap());
    let mut before = (0.0, 80.0);
    for _ in 0..200 {
        run.advance(0.01);
        let now = (run.motion().time(), run.motion().speed(0));
        if before.1 < 70.0 {
            // the brake alone
            let fall = brake / j * (now.0 - before.0);
            assert!((before.1 - now.1 - fall).abs() < 1e-12 * 80.0, "{now:?}");
        } else if now.1 >= 70.0 {
            let x = 0.5 * (before.1 + now.1) / 200.0;
            let fall = (brake - 1500.0 * (1.0 + x - x * x)) / j * (now.0 - before.0);
            // the mean of the torque over a step is that of its middle but for a twelfth of its bend
            assert!((before.1 - now.1 - fall).abs() < 1e-6, "{now:?}");
        }
        before = now;
    }
    assert!(before.1 < 0.0, "{before:?}");
    assert!(prove(&run).unwrap().largest() <= 1e-8);
    // the same as it comes back through idle: the torque is there again
    let coordinate = Coordinate::new(j).speed(65.0).source(engine()).source(Source::Constant(100.0));
    let mut motion = Train::new().coordinate(coordinate).build().unwrap();
    motion.advance(1.5);
    assert!((motion.speed(0) - 70.0).abs() < 1e-12 * 70.0);
    motion.advance(0.01);
    let x = 0.35;
    let rise = 0.01 * (100.0 + 1500.0 * (1.0 + x - x * x)) / j;
    // the torque rises by 1500 (1 - 2 x) of a share of 0.67/200 over the step: 0.08 % at its end
    assert!(((motion.speed(0) - 70.0) / rise - 1.0).abs() < 1e-3);
}
