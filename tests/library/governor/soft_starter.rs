//! A start by reduced voltage: its starting time in closed form, the starter in a closed loop with the full solver.

use driveline::governor::{SoftStarter, SoftStarterConfig};
use driveline::machine::{Error, Induction, Inertia, Parabola, Rigid, SoftStart, Speed, Torque};
use driveline::number::{Fixed, Number};
use driveline::settings::{self, Bases};
use driveline_solver::plant::train::{Coordinate, Friction, Link, Source, Train};

/// A pump's motor with a high-resistance cage: 1724 N m at standstill, 1200 N m at most in the start.
const MOTOR: Induction = Induction { synchronous: 104.72, breakdown: 2500.0, breakdown_slip: 0.4 };
const START: SoftStart = MOTOR.soft_start(Torque(1200.0), 0.5, 0.5);
const PUMP: Parabola = Parabola { constant: 200.0, linear: 0.0, square: 0.05 };
const INERTIA: f64 = 60.0;
const PERIOD: f64 = 1e-3;
const TARGET: f64 = 95.0;

fn kloss(speed: f64) -> f64 {
    let s = 1.0 - speed / 104.72;
    2.0 * 2500.0 * s * 0.4 / (s * s + 0.16)
}

#[test]
fn a_short_rise_starts_in_the_time_of_the_limit() {
    // Under 1200 N m to the speed at which full voltage gives that, then on the motor's curve; midpoint rule.
    let over = 2500.0_f64 / 1200.0;
    let full = 104.72 * (1.0 - 0.4 / (over + (over * over - 1.0).sqrt()));
    assert!((kloss(full) - 1200.0).abs() < 1e-9);
    let integral = |torque: &dyn Fn(f64) -> f64, from: f64, to: f64| -> f64 {
        let step = (to - from) / 1e5;
        let middles = (0..100_000).map(|k| from + (f64::from(k) + 0.5) * step);
        middles.map(|w| INERTIA * step / (torque(w) - 200.0 - 0.05 * w * w)).sum()
    };
    let expected = integral(&|_| 1200.0, 0.0, full) + integral(&kloss, full, TARGET);
    let short = MOTOR.soft_start(Torque(1200.0), 0.5, 1e-6);
    let time =
        |start: &SoftStart, load: &Parabola| start.time_to(&MOTOR, &Rigid::new(Inertia(INERTIA)), load, Speed(TARGET));
    // A rise of 1e-6 s, and the midpoint rule's error of 1e-10.
    assert!((time(&short, &PUMP) - expected).abs() < 1e-6, "{} {expected}", time(&short, &PUMP));
    let load = Parabola { constant: 500.0, linear: 0.0, square: 0.0 };
    let heavy = Parabola { constant: 1200.0, ..load };
    assert_eq!(time(&START, &heavy), f64::INFINITY);
    assert_eq!(MOTOR.at_voltage(0.5).torque(Speed(40.0)).0, 0.25 * MOTOR.torque(Speed(40.0)).0);
}

/// The starter on the full solver's motor, shaft and load: time to the target, and the largest torque (N m).
fn run<N: Number>(
    config: &SoftStarterConfig<N>,
    load: &Parabola,
    target: f64,
    to: impl Fn(f64) -> N,
    of: impl Fn(N) -> f64,
) -> (f64, f64) {
    let mut motion = Train::new()
        .coordinate(Coordinate::new(20.0))
        .coordinate(Coordinate::new(INERTIA - 20.0).source(Source::Parabola(0.0, 0.0, -load.square)))
        .friction(Friction::ground(1, load.constant))
        .link(Link::shaft(0, 1, 2.0e6).damping(2000.0))
        .build()
        .unwrap();
    let mut starter = SoftStarter::default();
    let (mut torque, mut peak) = (0.0, 0.0_f64);
    for tick in 0..20_000 {
        let share = of(starter.tick(config, to(torque)));
        assert!((0.5 - 1e-6..=1.0).contains(&share), "{share}");
        torque = share * share * kloss(motion.speed(0));
        peak = peak.max(torque);
        motion.set_torque(0, torque);
        motion.advance(PERIOD);
        if motion.speed(0) >= target {
            return (f64::from(tick + 1) * PERIOD, peak);
        }
    }
    panic!("{target} rad/s is not reached: {}", motion.speed(0));
}

#[test]
fn the_starter_keeps_the_torque_and_the_starting_time() {
    let bases = Bases { torque: 4000.0, speed: 110.0, ..Bases::SI };
    let float = run(&SoftStarterConfig::<f32>::new(&START, PERIOD, Bases::SI), &PUMP, TARGET, |t| t as f32, f64::from);
    let fixed = SoftStarterConfig::<Fixed>::new(&START, PERIOD, bases);
    let fixed = run(&fixed, &PUMP, TARGET, |torque| Fixed::from_f64(torque / 4000.0), Fixed::to_f64);
    let expected = START.time_to(&MOTOR, &Rigid::new(Inertia(INERTIA)), &PUMP, Speed(TARGET));
    for (time, peak) in [float, fixed] {
        // The target is seen up to a tick late, after voltages that are held for a tick.
        assert!((time - expected).abs() < 0.003, "{time} {expected}");
        // The voltage is above what the limit allows by a step of 0.001 at most, of 0.69: 0.3 % of the torque.
        assert!(peak < 1.003 * START.peak && peak > START.peak, "{peak}");
    }
}

#[test]
fn starts_that_end_or_turn_in_the_rise_have_their_time() {
    // it stands until the voltage carries that
    let held = Parabola { constant: 500.0, linear: 0.0, square: 0.0 };
    let starts = [(0.5, 1.0), (5.0, 20.0), (10.0, 95.0), (20.0, 20.0), (20.0, 95.0)].map(|start| (start, PUMP));
    for ((rise, target), load) in
        starts.into_iter().chain([(0.5, 60.0), (8.0, 30.0), (20.0, 0.2), (60.0, 1.0)].map(|start| (start, held)))
    {
        let start = SoftStart { rise, ..START };
        let config = SoftStarterConfig::<f32>::new(&start, PERIOD, Bases::SI);
        let (found, _) = run(&config, &load, target, |torque| torque as f32, f64::from);
        let time = start.time_to(&MOTOR, &Rigid::new(Inertia(INERTIA)), &load, Speed(target));
        // The target is seen up to a tick late, after voltages that are held for a tick. Under the limit the voltage
        // goes a step up and down: its torque is up to 0.3 % out, half of it on average, for part of the start.
        assert!((time - found).abs() < 0.002 + 0.001 * found, "{rise} s to {target} rad/s: {time} {found}");
    }
}

#[test]
fn the_voltage_stays_between_its_bounds() {
    let config = SoftStarterConfig { initial: 0.5_f32, step: 0.125, limit: 100.0 };
    let mut starter = SoftStarter::default();
    let mut shares = |torque: f32| -> Vec<f32> { (0..6).map(|_| starter.tick(&config, torque)).collect() };
    assert_eq!(shares(0.0), [0.5, 0.625, 0.75, 0.875, 1.0, 1.0]);
    assert_eq!(shares(101.0), [0.875, 0.75, 0.625, 0.5, 0.5, 0.5]);
    assert_eq!(shares(100.0)[5], 1.0);
    assert_eq!(shares(f32::NAN), [0.875, 0.75, 0.625, 0.5, 0.5, 0.5]);
    starter.tick(&config, 0.0);
    starter.restart();
    assert_eq!(starter.tick(&config, 0.0), 0.5);
}

#[test]
fn a_start_that_cannot_be_is_refused() {
    for (peak, initial, rise) in [
        (1730.0, 0.5, 1.0), // above the torque of standstill
        (620.0, 0.5, 1.0),  // below 2500 N m/4
        (1200.0, 1.0, 1.0),
        (1200.0, 0.0, 1.0),
        (1200.0, f64::NAN, 1.0),
        (1200.0, 0.5, 0.0),
        (f64::NAN, 0.5, 1.0),
    ] {
        assert_eq!(MOTOR.try_soft_start(Torque(peak), initial, rise), Err(Error::SoftStart), "{peak} {initial} {rise}");
    }
    let bases = Bases { torque: 500.0, ..Bases::SI };
    assert!(matches!(SoftStarterConfig::<Fixed>::try_new(&START, PERIOD, bases), Err(settings::Error::Value(_))));
    for rise in [1e-3, 1e5] {
        let start = SoftStart { rise, ..START };
        let refused = SoftStarterConfig::<f32>::try_new(&start, PERIOD, Bases::SI);
        assert!(matches!(refused, Err(settings::Error::Value(_))), "{rise}");
    }
}
