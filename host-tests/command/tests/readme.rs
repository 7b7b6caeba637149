//! The README's code compiles and does what the README says of it.
//!
//! The modules below are the README's two listings, between their `listing` marks and word for word.

use driveline::sample::Estimate;

#[allow(dead_code)]
mod single {
    // listing: single
    use driveline::constants::{Bases, Screening, SpeedLoopSettings};
    use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
    use driveline::drive::{Config, ConfigOf, Drive, Limits};
    use driveline::governor::{SpeedLoop, SpeedLoopConfig};
    use driveline::machine::{Chain, Damping, Efficiency, Inertia, Match, Ratio, Stiffness, TwoMass};
    use driveline::observer::{self, TwoMassConfig};
    use driveline::sample::Sample;

    /// Motor, coupling, gear and roll; every part on its own shaft.
    const ROLL: Chain = Chain::motor(Inertia(0.35))
        .shaft(Stiffness(2.0e4), Damping(0.5))
        .rotor(Inertia(0.05))
        .gear(Ratio(5.0), Efficiency(0.97))
        .shaft(Stiffness(9.0e4), Damping(10.0))
        .rotor(Inertia(12.0));
    const TWO: TwoMass = ROLL.reduce(Match::ResonanceAntiresonance);
    const RATE: Rate = Rate::hz(10_000);
    const LOAD: Disturbance = Disturbance { torque_accuracy: 3.0, load_torque_step: 200.0, within: 1.0 };
    const OBSERVER: TwoMassDesign = TWO.observer(RATE, Encoder::lines(2048), LOAD);
    const GOVERNOR: SpeedLoopDesign = TWO.speed_loop(RATE, SpeedLoopTuning::USUAL);
    const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: 550.0, ramp: 80.0 };
    const SCREENING: Screening =
        Screening { torque: 800.0, reference: 180.0, innovation: 0.05, standstill: 1.5e-3, missed: 150 };

    type Roll = Drive<f32, observer::TwoMass<f32>, (), SpeedLoop<f32>>;
    static CONFIG: ConfigOf<Drive<f32, observer::TwoMass<f32>, (), SpeedLoop<f32>>> = Config {
        limits: Limits::<f32>::new(&SCREENING, Bases::SI),
        observer: TwoMassConfig::<f32>::new(&OBSERVER, Bases::SI),
        fluctuation: (),
        governor: SpeedLoopConfig::<f32>::new(&GOVERNOR, SETTINGS, Bases::SI),
        balancer: (),
    };

    /// Once, before the timer starts.
    pub fn start(angle: u32) -> Roll {
        Drive::new(&CONFIG, angle)
    }

    /// In the timer's interrupt, every 100 us: the torque for the next tick.
    pub fn on_timer(roll: &mut Roll, angle: u32, torque: f32, speed: f32) -> f32 {
        let command = roll.tick(&CONFIG, &Sample { angle, torque, reference: speed });
        let _estimate = roll.estimate(&CONFIG); // shaft torque, load speed, load torque, motor speed
        command.torque // within the limit; zero while the angle is lost, which command.faults says
    }
    // end

    pub fn estimate(roll: &Roll) -> super::Estimate<f32> {
        roll.estimate(&CONFIG)
    }
    pub const DESIGN: TwoMassDesign = OBSERVER;
    pub const LOOP: SpeedLoopDesign = GOVERNOR;
    pub const LIMITS: (Screening, SpeedLoopSettings) = (SCREENING, SETTINGS);
}

#[allow(dead_code)]
mod fixed {
    use super::single::{DESIGN as OBSERVER, LIMITS, LOOP as GOVERNOR};
    use driveline::constants::{Screening, SpeedLoopSettings};
    use driveline::drive::{Config, ConfigOf, Drive, Limits};
    use driveline::governor::{SpeedLoop, SpeedLoopConfig};
    use driveline::observer::{self, TwoMassConfig};
    use driveline::sample::Sample;
    const SCREENING: Screening = LIMITS.0;
    const SETTINGS: SpeedLoopSettings = LIMITS.1;

    // listing: fixed
    use driveline::constants::Bases;
    use driveline::number::Fixed;

    const BASES: Bases = Bases::of(&OBSERVER, 900.0, 200.0); // N m and rad/s that a healthy machine stays below

    type Roll = Drive<Fixed, observer::TwoMass<Fixed>, (), SpeedLoop<Fixed>>;
    static CONFIG: ConfigOf<Drive<Fixed, observer::TwoMass<Fixed>, (), SpeedLoop<Fixed>>> = Config {
        limits: Limits::<Fixed>::new(&SCREENING, BASES),
        observer: TwoMassConfig::<Fixed>::new(&OBSERVER, BASES),
        fluctuation: (),
        governor: SpeedLoopConfig::<Fixed>::new(&GOVERNOR, SETTINGS, BASES),
        balancer: (),
    };
    // end

    pub fn start(angle: u32) -> Roll {
        Drive::new(&CONFIG, angle)
    }

    pub fn on_timer(roll: &mut Roll, angle: u32, torque: f32, speed: f32) -> f32 {
        let [torque, reference] =
            [f64::from(torque) / BASES.torque, f64::from(speed) / BASES.speed].map(Fixed::from_f64);
        let command = roll.tick(&CONFIG, &Sample { angle, torque, reference });
        assert!(command.faults.is_none(), "{}", command.faults);
        (command.torque.to_f64() * BASES.torque) as f32
    }

    pub fn estimate(roll: &Roll) -> super::Estimate<f32> {
        let estimate = roll.estimate(&CONFIG);
        let si = |value: Fixed, base: f64| (value.to_f64() * base) as f32;
        super::Estimate {
            motor_speed: si(estimate.motor_speed, BASES.speed),
            shaft_torque: si(estimate.shaft_torque, BASES.torque),
            load_speed: si(estimate.load_speed, BASES.speed),
            load_torque: si(estimate.load_torque, BASES.torque),
        }
    }
}

const README: &str = include_str!("../../../README.md");

/// The lines of this file between the marks of a listing, without their indentation.
fn listing(name: &str) -> String {
    let mark = format!("    // listing: {name}\n");
    let (_, after) = include_str!("readme.rs").split_once(&mark).unwrap();
    let (code, _) = after.split_once("    // end\n").unwrap();
    code.lines().map(|line| format!("{}\n", line.strip_prefix("    ").unwrap_or(line))).collect()
}

#[test]
fn the_listings_are_the_readmes() {
    for name in ["single", "fixed"] {
        assert!(README.contains(&format!("```rust\n{}```\n", listing(name))), "listing `{name}` is not in README.md");
    }
}

/// What the README shows of `design --emit rust` is what that prints for the hoist.
#[test]
fn the_printed_constants_are_the_readmes() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/hoist.toml");
    let printed = cargo_driveline::cli::rust(&cargo_driveline::machine_file::read(file.as_ref()).unwrap());
    let (_, after) = README.split_once("```rust,ignore\n").unwrap();
    let (shown, _) = after.split_once("```").unwrap();
    for line in shown.lines().filter(|line| *line != "// ...") {
        assert!(printed.lines().any(|real| real == line), "`{line}` is not printed");
    }
}

/// Motor, coupling and roll as three masses, stepped 20 times a tick; the roll carries a load of 150 N m at the motor from 3 s on.
/// The set point is 100 rad/s. Returns the root mean square errors of the estimated shaft torque and load speed in the last second of six.
fn run(mut tick: impl FnMut(u32, f32, f32) -> (f32, Estimate<f32>)) -> [f64; 2] {
    const INERTIA: [f64; 3] = [0.35, 0.05, 12.0 / 25.0];
    const STIFFNESS: [f64; 2] = [2.0e4, 9.0e4 / 25.0];
    const DAMPING: [f64; 2] = [0.5, 10.0 / 25.0];
    const STEP: f64 = 5e-6;
    let (mut angle, mut speed, mut torque, mut squares) = ([0.0; 3], [0.0; 3], 0.0_f32, [0.0_f64; 2]);
    for now in 0..60_000 {
        let load = if now < 30_000 { 0.0 } else { 150.0 };
        let mut shaft = [0.0; 2];
        for _ in 0..20 {
            shaft = [0, 1].map(|j| STIFFNESS[j] * (angle[j] - angle[j + 1]) + DAMPING[j] * (speed[j] - speed[j + 1]));
            let sums = [f64::from(torque) - shaft[0], shaft[0] - shaft[1], shaft[1] - load];
            for j in [0, 1, 2] {
                speed[j] += STEP * sums[j] / INERTIA[j];
                angle[j] += STEP * speed[j];
            }
        }
        let count = (angle[0] / core::f64::consts::TAU * 8192.0_f64).floor() as i64;
        let (command, estimate) = tick((count << 19) as u32, torque, 100.0);
        torque = command;
        if now >= 50_000 {
            squares[0] += (f64::from(estimate.shaft_torque) - shaft[1]).powi(2);
            squares[1] += (f64::from(estimate.load_speed) - speed[2]).powi(2);
        }
    }
    squares.map(|square| (square / 10_000.0).sqrt())
}

/// The two listings govern the roll, and their errors are below the standard deviations that the design predicts: the torque here is known
/// exactly, which the design does not count on. The machine is stepped by nothing of the library's.
#[test]
fn the_listings_govern_their_machine() {
    let mut single = single::start(0);
    let by_single = run(|angle, torque, speed| {
        let command = single::on_timer(&mut single, angle, torque, speed);
        (command, single::estimate(&single))
    });
    let mut fixed = fixed::start(0);
    let by_fixed = run(|angle, torque, speed| {
        let command = fixed::on_timer(&mut fixed, angle, torque, speed);
        (command, fixed::estimate(&fixed))
    });
    let predicted = single::DESIGN.standard_deviation;
    println!("{by_single:?}\n{by_fixed:?}\n{predicted:?}");
    for [torque, speed] in [by_single, by_fixed] {
        assert!(torque < predicted.shaft_torque && speed < predicted.load_speed, "{torque} N m, {speed} rad/s");
    }
}
