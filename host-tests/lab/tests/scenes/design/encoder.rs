//! An encoder that is less accurate than its counts: the design from its data sheet against the one from its counts.

use std::io;

use driveline::configure::{Machine, Rating};
use driveline::design::{Encoder, Error, SpeedLoopTuning, Spread, Tolerance};
use driveline::drive::Drive;
use driveline::governor::SpeedLoop;
use driveline::machine::Chain;
use driveline::number::Number;
use driveline::observer::TwoMassObserver;
use driveline::sample::Sample;
use driveline::settings::{Bases, Screening};
use driveline_closed_loop::figures::{deviations, peaks};
use driveline_closed_loop::lockstep::run;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::scenes::spindle::{COUNTS, Spindle};
use driveline_lab::drivetrains::spindle;
use driveline_solver::noise::Noise;

/// Signal periods of the spindle's encoder on a turn, as its scene describes it: 512 lines, interpolated 1024 times.
const PERIODS: u32 = 512;
/// Interpolation error, as a fraction of a period, and jitter of a tick, as a fraction of it.
const ONE_PERCENT: f64 = 0.01;

/// The spindle by the counts of its encoder (0), with the interpolation error stated (1), or with the jitter (2).
struct Stated<const WHAT: u32>;

impl<const WHAT: u32> Machine for Stated<WHAT> {
    const CHAIN: Chain = Spindle::CHAIN;
    const RATING: Rating = Spindle::RATING;
    const ENCODER: Encoder = match WHAT {
        0 => Encoder::lines(COUNTS / 4),
        1 => Encoder::lines(COUNTS / 4).interpolation(PERIODS, ONE_PERCENT),
        _ => Encoder::lines(COUNTS / 4).jitter(ONE_PERCENT * Spindle::PERIOD, Spindle::RATING.speed.0),
    };
    const RATE_HZ: u32 = Spindle::RATE_HZ;
    const TUNING: SpeedLoopTuning = Spindle::TUNING;
    /// With damping as described: by the counts alone the observer is too fast for the least that the spindle may have.
    const TOLERANCE: Tolerance = Tolerance { damping: Spread::NONE, ..Spindle::TOLERANCE };
    const RAMP: f64 = Spindle::RAMP;
    const BASES: Bases = Spindle::BASES;
    const SCREENING: Screening = Spindle::SCREENING;
}

/// An encoder's faults between the plant and the drive.
#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Ideal,
    Interpolation,
    Jitter,
}

struct Faulty<D> {
    tick: D,
    fault: Fault,
    noise: Noise,
    last: u32,
}

impl<D: FnMut(&Input) -> Output> Ticks for Faulty<D> {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        let turn = 4_294_967_296.0;
        let error = match self.fault {
            Fault::Ideal => 0.0,
            Fault::Interpolation => {
                let phase = f64::from(PERIODS) * f64::from(input.angle) / turn * core::f64::consts::TAU;
                ONE_PERCENT / f64::from(PERIODS) * turn * phase.sin()
            }
            // the angle of a moment before or after: its speed is that of the last tick
            Fault::Jitter => f64::from(input.angle.wrapping_sub(self.last) as i32) * ONE_PERCENT * self.noise.normal(),
        };
        self.last = input.angle;
        let count = turn / f64::from(COUNTS);
        let error = ((error / count).round() * count) as i64 as u32;
        Ok((self.tick)(&Input { angle: input.angle.wrapping_add(error), ..*input }))
    }
}

/// Rms error of the shaft torque in % of its peak, in the run that counts.
fn error<const WHAT: u32>(fault: Fault) -> f64 {
    type Governed = Drive<f32, TwoMassObserver, SpeedLoop>;
    let machine = spindle::machine().unwrap();
    let config = Governed::configure::<Stated<WHAT>>();
    let mut drive = Governed::new(&config, 0);
    let tick = |input: &Input| {
        let word = f32::from_bits;
        let command = if input.flags & Input::RELEASED != 0 {
            let sample = Sample { angle: input.angle, torque: word(input.torque), setpoint: word(input.setpoint) };
            drive.tick(&config, &sample)
        } else {
            drive.hold(&config, input.angle, word(input.setpoint))
        };
        let estimate = drive.estimate(&config);
        Output {
            torque: command.torque.to_word(),
            shaft_torque: estimate.shaft_torque.to_word(),
            load_speed: estimate.load_speed.to_word(),
            load_torque: estimate.load_torque.to_word(),
            faults: command.faults.bits(),
            ..Output::default()
        }
    };
    let mut drive = Faulty { tick, fault, noise: Noise::new(5), last: 0 };
    let units = Units::new(Words::Single, machine.bases);
    let scenario = machine.scenarios.iter().find(|scenario| scenario.counted).unwrap();
    let trace = run(&machine, scenario, &units, Spindle::RATE_HZ, &mut drive, |_| ()).unwrap();
    let peaks = peaks([&trace].into_iter());
    let [shaft, ..] = deviations([&trace].into_iter(), peaks);
    println!("{WHAT}: {:.2} %", 100.0 * shaft.rms);
    100.0 * shaft.rms
}

/// The project's targets: with 1 % of interpolation error 8.2 to 2.3 %, with 1 % of jitter 24 to 3.6 %, at the cost of
/// 1.52 to 2.29 % on an ideal encoder. The errors are a seed's: a tenth is allowed for it.
#[test]
fn a_stated_accuracy_keeps_the_errors_of_an_encoder_out_of_the_estimates() {
    let nominal = error::<0>(Fault::Ideal);
    assert!(nominal < 1.1 * 1.52, "{nominal}");
    let (counted, stated) = (error::<0>(Fault::Interpolation), error::<1>(Fault::Interpolation));
    assert!(counted > 5.0 && stated < 1.1 * 2.3, "{counted} {stated}");
    let (counted, stated) = (error::<0>(Fault::Jitter), error::<2>(Fault::Jitter));
    assert!(counted > 15.0 && stated < 1.1 * 3.6, "{counted} {stated}");
    assert!(error::<1>(Fault::Ideal) < 1.1 * 2.29);
}

/// Rounding to a count has a variance of a twelfth of its square, a sine of an amplitude half of its square.
#[test]
fn the_variance_is_that_of_its_parts() {
    let near = |is: f64, should: f64| assert!((is / should - 1.0).abs() < 1e-12, "{is} {should}");
    let tau = core::f64::consts::TAU;
    let rounding = (tau / 8192.0_f64).powi(2) / 12.0;
    near(Encoder::lines(2048).variance().unwrap(), rounding);
    let encoder = Encoder::lines(2048).interpolation(2048, 0.02).eccentricity(1e-3).jitter(1e-6, 300.0);
    let parts = 0.5 * (0.02 * tau / 2048.0_f64).powi(2) + 0.5e-6 + 9e-8;
    near(encoder.variance().unwrap(), rounding + parts);
    for bad in [
        Encoder::lines(2048).interpolation(0, 0.01),
        Encoder::lines(2048).interpolation(2048, -0.01),
        Encoder::lines(2048).eccentricity(f64::NAN),
        Encoder::lines(2048).jitter(1e-6, f64::INFINITY),
    ] {
        assert_eq!(bad.variance(), Err(Error::EncoderAccuracy), "{bad:?}");
    }
}
