//! A start by resistors: its design by Kloss's formula, the starter in a closed loop with the full solver.

use driveline::governor::{ResistorStarter, ResistorStarterConfig};
use driveline::machine::{Characteristic, Error, Induction, Inertia, Parabola, ResistorStart, Rigid, Speed, Torque};
use driveline::number::{Fixed, Number};
use driveline::settings::{self, Bases};
use driveline_solver::plant::train::{Coordinate, Link, Source, Train};

/// A crane's motor: 1800 N m at most in its start, against 600 N m.
const MOTOR: Induction = Induction::new(Speed(100.0), Torque(900.0), Speed(104.72), 2.8);
const START: ResistorStart<4> = MOTOR.resistor_start(Torque(1800.0));
const LOAD: f64 = 600.0;
const INERTIA: f64 = 30.0;
const PERIOD: f64 = 1e-3;

fn kloss(breakdown_slip: f64, speed: f64) -> f64 {
    let s = 1.0 - speed / 104.72;
    2.0 * 2520.0 / (s / breakdown_slip + breakdown_slip / s)
}

#[test]
fn every_step_swings_between_the_same_two_torques() {
    let own = 4.72 / 104.72 * (2.8 + f64::sqrt(2.8 * 2.8 - 1.0));
    let mut from = 0.0;
    for (step, (resistance, to)) in START.resistances.into_iter().zip(START.speeds).enumerate() {
        let slip = own * resistance;
        // Roundings of a slip down to a hundredth.
        assert!((kloss(slip, from) / 1800.0 - 1.0).abs() < 1e-13, "{step}: {}", kloss(slip, from));
        assert!((kloss(slip, to) / START.switching - 1.0).abs() < 1e-13, "{step}");
        assert!((START.motor(&MOTOR, step).breakdown_slip / slip - 1.0).abs() < 1e-15);
        if step > 0 {
            let ratio = START.resistances[step - 1] / resistance;
            assert!((ratio / (START.resistances[0] / START.resistances[1]) - 1.0).abs() < 1e-14);
        }
        from = to;
    }
    // After the last one the motor alone begins at the peak.
    assert!((kloss(own, from) / 1800.0 - 1.0).abs() < 1e-13);
    const { assert!(START.switching > LOAD) };
    // More steps, less swing: with one the torque falls farther.
    assert!(MOTOR.resistor_start::<1>(Torque(1800.0)).switching < START.switching);
    assert!(MOTOR.resistor_start::<8>(Torque(1800.0)).switching > START.switching);
    for peak in [2600.0, 0.0, -5.0, f64::NAN] {
        assert_eq!(MOTOR.try_resistor_start::<4>(Torque(peak)), Err(Error::ResistorStart), "{peak}");
    }
    // On its own the motor begins at 2 2520/(1.5 + 1/1.5) = 2326 N m, and the torque falls from there.
    let stiff = Induction { breakdown_slip: 1.5, ..MOTOR };
    assert_eq!(stiff.try_resistor_start::<4>(Torque(2400.0)), Err(Error::ResistorStart));
    assert_eq!(MOTOR.try_resistor_start::<0>(Torque(1800.0)), Err(Error::ResistorStart));
}

/// Time of each step, by the design.
fn times() -> Vec<f64> {
    let load = Parabola { constant: LOAD, linear: 0.0, square: 0.0 };
    let mut from = 0.0;
    let step = |(step, to): (usize, f64)| {
        let mover = Characteristic::Induction(START.motor(&MOTOR, step));
        let time = mover.time_to(&Rigid::new(Inertia(INERTIA)), &load, Speed(from), Speed(to));
        from = to;
        time
    };
    START.speeds.into_iter().enumerate().map(step).collect()
}

/// The starter on the full solver's motor, shaft and load: times of its steps, and the largest torque.
fn run<N: Number>(config: &ResistorStarterConfig<N, 4>, speed_of: impl Fn(f64) -> N) -> (Vec<f64>, f64) {
    let mut motion = Train::new()
        .coordinate(Coordinate::new(10.0))
        .coordinate(Coordinate::new(INERTIA - 10.0).source(Source::Constant(-LOAD)))
        .link(Link::shaft(0, 1, 2.0e6).damping(200.0))
        .build()
        .unwrap();
    let own = 4.72 / 104.72 * (2.8 + f64::sqrt(2.8 * 2.8 - 1.0));
    let mut starter = ResistorStarter::default();
    let (mut switched, mut peak) = (Vec::new(), 0.0_f64);
    for tick in 0..6000 {
        let speed = motion.speed(0);
        let step = starter.tick(config, speed_of(speed));
        if step as usize > switched.len() {
            switched.push(f64::from(tick) * PERIOD);
        }
        let resistance = START.resistances.get(step as usize).copied().unwrap_or(1.0);
        let torque = kloss(own * resistance, speed);
        peak = peak.max(torque);
        motion.set_torque(0, torque);
        motion.advance(PERIOD);
    }
    assert_eq!(starter.step(), 4);
    // At the end the motor carries the load: 600 N m on the falling branch.
    assert!((kloss(own, motion.speed(0)) - LOAD).abs() < 1.0, "{}", motion.speed(0));
    (switched, peak)
}

#[test]
fn the_starter_keeps_the_peak_and_the_starting_time() {
    let bases = Bases { torque: 4000.0, speed: 110.0, ..Bases::SI };
    let float = ResistorStarterConfig::<f32, 4>::new(&START, 0.0, PERIOD, Bases::SI);
    let fixed = ResistorStarterConfig::<Fixed, 4>::new(&START, 0.0, PERIOD, bases);
    let in_fixed = |speed: f64| Fixed::from_f64(speed / 110.0);
    for (switched, peak) in [run(&float, |speed| speed as f32), run(&fixed, in_fixed)] {
        // The load hangs slack at first: 2 600 N m over 2e6 N m/rad are taken up within the first swing of 12 ms. The
        // motor alone turns by less than 1 rad/s meanwhile. A switch comes up to a tick late: 4 of them.
        let mut expected = 0.0;
        for (time, step) in switched.iter().zip(times()) {
            expected += step;
            assert!((time - expected).abs() < 0.01, "{time} {expected}");
        }
        assert_eq!(switched.len(), 4);
        // A late switch comes at a higher speed, and at less than the peak; the shaft's swing moves the speed by
        // 0.1 rad/s, of which a step of 1/u_1 of its slip makes 2 %.
        assert!(peak < 1.02 * 1800.0 && peak > 0.98 * 1800.0, "{peak}");
    }
}

#[test]
fn contactors_have_their_time_and_no_resistor_comes_back() {
    let config = ResistorStarterConfig { speeds: [10.0_f32, 20.0, 30.0, 40.0], interval: 3 };
    let mut starter = ResistorStarter::default();
    let steps: Vec<u32> = (0..20).map(|_| starter.tick(&config, 100.0)).collect();
    // Three ticks between two of them, from the start on.
    assert_eq!(steps, [0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4]);
    assert_eq!((starter.tick(&config, -5.0), starter.tick(&config, f32::NAN)), (4, 4));
    starter.restart();
    for _ in 0..10 {
        assert_eq!((starter.tick(&config, 9.9), starter.tick(&config, f32::NAN)), (0, 0));
    }
    assert_eq!(starter.tick(&config, 10.0), 1);
}

#[test]
fn a_starter_that_its_number_does_not_hold_is_refused() {
    let bases = Bases { torque: 4000.0, speed: 40.0, ..Bases::SI };
    let refused = ResistorStarterConfig::<Fixed, 4>::try_new(&START, 0.1, PERIOD, bases);
    assert!(matches!(refused, Err(settings::Error::Value(_))), "{refused:?}");
    for interval in [-1.0, f64::NAN, 1e9] {
        let refused = ResistorStarterConfig::<f32, 4>::try_new(&START, interval, PERIOD, Bases::SI);
        assert!(matches!(refused, Err(settings::Error::Value(_))), "{interval}");
    }
}
