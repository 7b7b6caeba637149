//! A tube mill's start by resistors: the library's starter on the full solver's motor, shaft and mill. A slip-ring motor
//! of 500 kW, breakdown at 2.5 times rated torque, behind a gear of 55; six resistors keep it below 1.8 times.

use driveline::governor::{ResistorStarter, ResistorStarterConfig};
use driveline::machine::{Induction, ResistorStart, Speed, Torque};
use driveline::number::{Fixed, Number};
use driveline::settings::Bases;
use driveline_solver::plant::train::{Coordinate, Friction, Link, Train};

/// Resistors, the start, and the contactors' time (s).
const STEPS: usize = 6;
const START: ResistorStart<STEPS> =
    Induction::new(Speed(103.67), Torque(RATED), Speed(SYNCHRONOUS), 2.5).resistor_start(Torque(1.8 * RATED));
const INTERVAL: f64 = 0.05;
/// Of fixed point.
const BASES: Bases = Bases { torque: 1.5 * 1.8 * RATED, speed: 1.34 * SYNCHRONOUS, ..Bases::SI };

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

/// Starts the mill with the motor's speed in a number.
fn starts<N: Number>(config: &ResistorStarterConfig<N, STEPS>, number: impl Fn(f64) -> N) {
    let resistance = |step: usize| START.resistances.get(step).copied().unwrap_or(1.0);
    let mut starter = ResistorStarter::default();
    let mut motion = Train::new()
        .coordinate(Coordinate::new(MOTOR))
        .coordinate(Coordinate::new(MILL))
        .link(Link::shaft(0, 1, 2.0e5).damping(200.0))
        .friction(Friction::ground(1, LOAD))
        .build()
        .unwrap();
    let mut switched = Vec::new();
    let (mut peak, mut least) = (0.0_f64, f64::INFINITY);
    for tick in 0..6000 {
        let step = starter.tick(config, number(motion.speed(0))) as usize;
        if step > switched.len() {
            switched.push(f64::from(tick) * PERIOD);
        }
        let torque = kloss(resistance(step), motion.speed(0));
        peak = peak.max(torque);
        if step < STEPS {
            least = least.min(torque);
        }
        motion.set_torque(0, torque);
        motion.advance(PERIOD);
    }
    // While friction holds the mill, for 12.5 ms, the shaft takes less than the load's torque: 32 N m s less, a lead of
    // 0.32 rad/s. The curve's slope of 71 N m s/rad leaves e^-1.3 of it by the first switch: 7 ms at 12 rad/s2. A switch
    // comes up to a tick late.
    assert_eq!(switched.len(), STEPS);
    assert!(switched.iter().zip(times()).all(|(found, time)| (found - time).abs() < 0.01), "{switched:?}");
    // The motor swings by 1 % of the speed at most when it switches.
    assert!(peak < 1.01 * START.peak && peak > 0.99 * START.peak, "{peak} {}", START.peak);
    assert!(least < 1.02 * START.switching && least > 0.95 * START.switching, "{least} {}", START.switching);
    // It carries the load on its own.
    assert!((kloss(1.0, motion.speed(0)) - LOAD).abs() < 1.0, "{}", motion.speed(0));
    starter.restart();
    assert_eq!(starter.step(), 0);
}

#[test]
fn the_mill_starts_in_steps_of_one_torque() {
    let single = ResistorStarterConfig::<f32, STEPS>::new(&START, INTERVAL, PERIOD, Bases::SI);
    starts(&single, |speed| speed as f32);
    let fixed = ResistorStarterConfig::<Fixed, STEPS>::new(&START, INTERVAL, PERIOD, BASES);
    starts(&fixed, |speed| Fixed::from_f64(speed / BASES.speed));
}
