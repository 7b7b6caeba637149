//! The tube mill's start by resistors: the scene's starter on the full solver's motor, shaft and mill.

use driveline::configure::Machine as _;
use driveline_closed_loop::sensors::Encoder;
use driveline_closed_loop::units::Units;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::tube_mill::{COUNTS, START, STEPS, TubeMill};
use driveline_solver::plant::train::{Coordinate, Friction, Link, Train};

/// The machine by its own arithmetic, at the motor.
const SYNCHRONOUS: f64 = 104.72;
const RATED: f64 = 4_820.0;
const MOTOR: f64 = 35.0;
const MILL: f64 = 2.0e5 / (55.0 * 55.0);
const LOAD: f64 = 0.8 * RATED;
const PERIOD: f64 = 1e-3;

/// Kloss's formula with the rotor's resistance over its own.
fn kloss(resistance: f64, speed: f64) -> f64 {
    let own = (SYNCHRONOUS - 103.67) / SYNCHRONOUS * (2.5 + f64::sqrt(2.5 * 2.5 - 1.0));
    let (slip, at) = (1.0 - speed / SYNCHRONOUS, own * resistance);
    2.0 * 2.5 * RATED * slip * at / (slip * slip + at * at)
}

/// Times of the rigid machine at which each step ends, by the midpoint rule, whose error of 4,000 pieces is below 1e-6.
fn times() -> [f64; STEPS] {
    let (mut time, mut from) = (0.0, 0.0);
    std::array::from_fn(|step| {
        let piece = (START.speeds[step] - from) / 4000.0;
        for middle in (0..4000).map(|k| from + (f64::from(k) + 0.5) * piece) {
            time += (MOTOR + MILL) * piece / (kloss(START.resistances[step], middle) - LOAD);
        }
        from = START.speeds[step];
        time
    })
}

#[test]
fn the_mill_starts_in_steps_of_one_torque() {
    let resistance = |step: usize| START.resistances.get(step).copied().unwrap_or(1.0);
    for number in ["f32", "fixed"] {
        let row = find(&format!("tube-mill/{number}/resistors/1000")).unwrap();
        let units = Units::new(row.words(), TubeMill::BASES);
        let (mut scene, encoder) = (row.start(), Encoder::new(COUNTS));
        let mut motion = Train::new()
            .coordinate(Coordinate::new(MOTOR))
            .coordinate(Coordinate::new(MILL))
            .link(Link::shaft(0, 1, 2.0e5).damping(200.0))
            .friction(Friction::ground(1, LOAD))
            .build()
            .unwrap();
        let (mut torque, mut switched) = (0.0, Vec::new());
        let (mut peak, mut least, mut off) = (0.0_f64, f64::INFINITY, 0.0_f64);
        for tick in 0..6000 {
            let input = Input {
                angle: encoder.read(motion.angle(0)),
                torque: units.torque_word(torque),
                setpoint: units.speed_word(103.67),
                flags: Input::RELEASED,
                ..Input::default()
            };
            let output = scene.exchange(&input);
            assert_eq!(output.faults, 0, "{number}, tick {tick}");
            let step = scene.channel(0) as usize;
            if step > switched.len() {
                switched.push(f64::from(tick) * PERIOD);
            }
            torque = kloss(resistance(step), motion.speed(0));
            peak = peak.max(torque);
            if step < STEPS {
                least = least.min(torque);
            }
            let estimated = kloss(resistance(step), units.speed(output.motor_speed));
            off = off.max((units.torque(output.torque) - estimated).abs() / START.peak);
            motion.set_torque(0, torque);
            motion.advance(PERIOD);
        }
        println!("{number}: {switched:.3?} against {:.3?}, {least:.0} to {peak:.0} N m, {off:.4}", times());
        // Straight lines between points of which the first two are 0.2 of the slip apart, where u is 0.34 to 0.43 and
        // the curve 2 tau_A/(u + 1/u) bends by 4 tau_A: 0.085^2/8 of that is 0.5 % of the peak.
        assert!(off < 0.01, "{off}");
        // While friction holds the mill, for 12.5 ms, the shaft takes less than the load's torque: 32 N m s less, a
        // lead of 0.32 rad/s. The curve's slope of 71 N m s/rad leaves e^-1.3 of it by the first switch: 7 ms at
        // 12 rad/s2. A switch comes up to a tick late, and the estimate lags by some.
        assert_eq!(switched.len(), STEPS);
        assert!(switched.iter().zip(times()).all(|(found, time)| (found - time).abs() < 0.01), "{switched:?}");
        // The motor swings by 1 % of the speed at most when it switches.
        assert!(peak < 1.01 * START.peak && peak > 0.99 * START.peak, "{peak} {}", START.peak);
        assert!(least < 1.02 * START.switching && least > 0.95 * START.switching, "{least} {}", START.switching);
        // It carries the load on its own.
        assert!((kloss(1.0, motion.speed(0)) - LOAD).abs() < 1.0, "{}", motion.speed(0));
        // without a setpoint the stator is off, and the resistors are back
        let off = Input { setpoint: 0, flags: Input::RELEASED, ..Input::default() };
        assert_eq!((units.torque(scene.exchange(&off).torque), scene.channel(0)), (0.0, 0));
    }
}
