//! The observer with a step of choice against the library's drive, and the approximate steps against the exact one.

use driveline::configure::Machine as _;
use driveline::design::{Disturbance, Encoder, Rate, TwoMassDesign};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass as Machine};
use driveline::observer::{GearedConfig, GearedObserver, TwoMassConfig, TwoMassObserver};
use driveline::sample::Sample;
use driveline::settings::{Bases, Gear, Screening};
use driveline_closed_loop::lockstep::run;
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::hoist::Hoist;
use driveline_lab::drivetrains::approximate::{ApproximateObserver, StepOf};
use driveline_lab::drivetrains::hoist;
use driveline_lab::drivetrains::other_steps::{Recorded, comparison, comparisons, recorded};

const GEAR: Gear = Gear { efficiency: 0.94, inertia: 0.7, deadband: 0.01 };

fn design(rate_hz: u32) -> TwoMassDesign {
    let disturbance = Disturbance { torque_accuracy: 7.5, load_torque_step: 375.0, within: 1.0 };
    // A resonance of 5.4 Hz.
    Machine::new(Inertia(0.7), Inertia(0.3), Stiffness(240.0), Damping(0.3)).observer(
        Rate::hz(rate_hz),
        Encoder::lines(2048),
        disturbance,
    )
}

/// A run of the machine itself, by the exact step without corrections: a motor torque that changes, a load torque, an
/// encoder.
fn recording(design: &TwoMassDesign, ticks: usize) -> Vec<Recorded> {
    let (machine, step, period) = (&design.machine, &design.step, design.period);
    let (motor, load) = (machine.motor_inertia, machine.load_inertia);
    let (mut twist, mut slip, mut mean, mut angle) = (0.0, 0.0, 0.0, 0.0);
    let counts = 8192.0 / core::f64::consts::TAU;
    (0..ticks)
        .map(|tick| {
            let time = tick as f64 * period;
            let torque = 100.0 * (3.0 * time).sin() + 40.0;
            // The mean torque: at 100 Hz the motor must turn by less than half a turn in a tick.
            let load_torque = 40.0;
            // The gear is left out of the plant: the observers are compared with each other.
            let drive = torque / motor + load_torque / load;
            let moved = step.n11 * twist + step.n12 * slip + step.g1 * drive;
            slip += step.n21 * twist + step.n22 * slip + step.g2 * drive;
            twist += moved;
            let before = mean;
            mean += period * (torque - load_torque) / (motor + load);
            angle += 0.5 * period * (before + mean) + load / (motor + load) * moved;
            let count = (angle * counts).floor();
            Recorded {
                angle: ((count / 8192.0).rem_euclid(1.0) * 4_294_967_296.0) as u64 as u32,
                torque,
                released: true,
                truth: [
                    machine.stiffness * twist + machine.damping * slip,
                    mean - motor / (motor + load) * slip,
                    load_torque,
                ],
            }
        })
        .collect()
}

/// With the exact step it is the drive, as long as no sample is refused: to 1e-9 of the estimates, though in fact to
/// the last bit.
#[test]
fn with_the_exact_step_it_is_the_drive() {
    type Observer = GearedObserver<TwoMassObserver>;
    let design = design(10_000);
    let screening = Screening { torque: 1e4, setpoint: 1e3, innovation: 0.5, frozen_turn: 0.5, max_coast: 200 };
    let config: ConfigOf<Drive<f64, Observer>> = Config {
        limits: Limits::<f64>::new(&screening, Bases::SI),
        observer: GearedConfig::<f64, _>::new(
            TwoMassConfig::<f64>::new(&design, Bases::SI),
            &GEAR,
            design.period,
            Bases::SI,
        ),
        fluctuation: (),
        governor: (),
        balancer: (),
    };
    let mut drive: Drive<f64, Observer> = Drive::new(&config, 0);
    let mut observer = ApproximateObserver::new(&design, StepOf::Exact, &GEAR).unwrap();
    for tick in recording(&design, 20_000) {
        let sample = Sample { angle: tick.angle, torque: tick.torque, setpoint: 0.0 };
        let command = drive.tick(&config, &sample);
        assert!(command.faults.is_none());
        let now = drive.estimate(&config);
        let expected = [now.shaft_torque, now.load_speed, now.load_torque];
        for (value, expected) in observer.tick(tick.angle, tick.torque).into_iter().zip(expected) {
            assert!((value - expected).abs() <= 1e-9 * expected.abs().max(1.0));
        }
    }
}

/// Sampled slowly the exact step is the better one, and forward Euler is the worst: at 100 Hz omega T is a third of a
/// radian.
#[test]
fn the_exact_step_is_the_best() {
    let design = design(100);
    let run = recording(&design, 2_000);
    // Without losses, as the run is.
    let gear = Gear { efficiency: 1.0, ..GEAR };
    let [exact, tustin, euler] = StepOf::ALL.map(|step| comparison(&design, step, &gear, &run, 155.0).unwrap());
    println!("{exact:?}\n{tustin:?}\n{euler:?}");
    assert!(exact.shaft_torque.rms < tustin.shaft_torque.rms);
    assert!(tustin.shaft_torque.rms < euler.shaft_torque.rms);
}

/// The hoist's recorded runs: the observer in `f64` and the drive in `f32` see the same, and the other steps stand
/// beside it.
#[test]
fn the_hoists_recordings_are_understood() {
    let machine = hoist::machine().unwrap();
    let row = find("hoist/f32/exact/1000").unwrap();
    let units = Units::new(row.words(), machine.bases);
    let record = |scenario| run(&machine, scenario, &units, row.rate_hz, &mut OnHost(row.start()), |_| ()).unwrap();
    let design = Hoist::<1_000>::OBSERVER;
    for trace in machine.scenarios.iter().map(record) {
        let run = recorded(&trace, &units);
        let compared = comparisons(&design, &Hoist::<10_000>::GEAR, &run, Hoist::<10_000>::RATING.speed.0).unwrap();
        let peak = trace.moments.iter().map(|moment| moment.truth[0].abs()).fold(0.0, f64::max);
        let squares = trace.moments.iter().map(|moment| ((moment.estimate[0] - moment.truth[0]) / peak).powi(2));
        let drive = (squares.sum::<f64>() / trace.moments.len() as f64).sqrt();
        println!("drive {drive} {:?}", compared.iter().map(|c| (&c.step, c.shaft_torque)).collect::<Vec<_>>());
        // As long as the drive believes every sample they differ by the rounding of f32, far below what both are wrong
        // by.
        let unscreened = trace.moments.iter().all(|moment| moment.faults == 0);
        assert!(!unscreened || (compared[0].shaft_torque.rms - drive).abs() < 1e-4);
    }
}
