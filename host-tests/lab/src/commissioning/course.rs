//! A commissioning from start to end: plant, sensors and test in lock-step.

use std::error::Error;
use std::io;

use driveline::commissioning::TestConfig;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::commission::{Commission, panel};

use super::machine::Case;
use driveline_closed_loop::sensors::Encoder;
use driveline_closed_loop::ticks::{OnHost, Ticks};
use driveline_solver::noise::Noise;

/// A moment of a course.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment {
    /// Time (s).
    pub time: f64,
    /// Stage, by its number.
    pub stage: u32,
    /// Torque of the motor (N m).
    pub torque: f64,
    /// Torque of the shaft (N m).
    pub shaft: f64,
    /// Speed of the motor (rad/s).
    pub speed: f64,
    /// Angle of the motor from the start (rad).
    pub angle: f64,
}

/// A course that has ended.
#[derive(Clone, Debug)]
pub struct Course {
    /// Its moments, one in a few milliseconds.
    pub moments: Vec<Moment>,
    /// Largest size of the shaft's torque (N m).
    pub peak: f64,
    /// Figures and standard deviations, where there is an answer.
    pub figures: Option<[[f64; 2]; 14]>,
    /// Gains that were designed for what was found.
    pub gains: Option<[f64; 8]>,
    /// Numbers of the reasons why there is none: of the test, of the gap.
    pub reasons: [u32; 2],
    pub ticks: u64,
}

/// Stage numbers that end a course.
const DONE: u32 = 5;

/// Longest course (s).
const LONGEST: f64 = 3600.0;

/// Noise of a seed: each has its own, where [`Noise`] tells odd ones apart alone.
fn noise_of(seed: u64) -> Noise {
    Noise::new(seed.wrapping_mul(2).wrapping_sub(1))
}

/// Runs a case on the host.
pub fn on_host(case: &Case, seed: u64) -> Result<Course, Box<dyn Error>> {
    // It lives as long as the program: there are a few.
    let config: &'static TestConfig = Box::leak(Box::new(TestConfig::try_new(&case.settings)?));
    Ok(run(case, seed, &mut OnHost(Commission::of(config)))?)
}

/// Runs a test on a plant.
pub fn run(case: &Case, seed: u64, drive: &mut impl Ticks) -> io::Result<Course> {
    let mut plant = case.plant.clone();
    let encoder = Encoder::new(case.counts);
    let mut noise = noise_of(seed);
    let period = case.settings.rate.period().unwrap_or(1.0e-4);
    let start = plant.motor_angle();
    let mut course = Course { moments: Vec::new(), peak: 0.0, figures: None, gains: None, reasons: [0; 2], ticks: 0 };
    let mut stage = 0;
    let read = |plant: &driveline_solver::plant::Plant| {
        let angle = plant.motor_angle() - start;
        let [amplitude, phase] = case.eccentricity;
        encoder.read(angle + amplitude * (angle - phase).cos())
    };
    while stage < DONE && (course.ticks as f64) < LONGEST / period {
        let input = Input { angle: read(&plant), asked: [panel::STAGE, 0], flags: Input::RELEASED, ..Input::default() };
        let output = drive.tick(&input)?;
        stage = output.answer;
        let torque = f64::from(f32::from_bits(output.torque)) + case.torque_noise * noise.normal();
        let shaft = plant.shaft_torque(case.shaft);
        course.peak = course.peak.max(shaft.abs());
        if course.ticks.is_multiple_of(64) {
            course.moments.push(Moment {
                time: course.ticks as f64 * period,
                stage,
                torque,
                shaft,
                speed: plant.motor_speed(),
                angle: plant.motor_angle() - start,
            });
        }
        plant.advance(torque, period);
        plant.clear_events();
        course.ticks += 1;
    }
    // The result, requested word by word while the motor stands.
    let mut ask = |key: u32, value: u32| -> io::Result<u32> {
        let input = Input { angle: read(&plant), asked: [key, value], flags: Input::RELEASED, ..Input::default() };
        Ok(drive.tick(&input)?.answer)
    };
    let number = |word: u32| if word == panel::NONE { f64::NAN } else { f64::from(f32::from_bits(word)) };
    course.reasons = [ask(panel::REASON, 0)?, ask(panel::REASON, 1)?];
    if stage == DONE {
        let mut figures = [[0.0; 2]; 14];
        for (place, figure) in figures.iter_mut().enumerate() {
            let place = place as u32;
            *figure = [number(ask(panel::FIGURE, place)?), number(ask(panel::DEVIATION, place)?)];
        }
        course.figures = Some(figures);
        let mut gains = [0.0; 8];
        for (place, gain) in gains.iter_mut().enumerate() {
            *gain = number(ask(panel::GAIN, place as u32)?);
        }
        course.gains = gains.iter().all(|gain| gain.is_finite()).then_some(gains);
    }
    Ok(course)
}
