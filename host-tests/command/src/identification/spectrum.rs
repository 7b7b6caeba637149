//! From a recording to the lines of its spectrum that carry the torque, and to a first guess of the machine.

use std::f64::consts::TAU;

use driveline::commissioning::{Fit, Response, fit};
use nalgebra::Complex;
use rustfft::FftPlanner;

use super::model::{Model, Motion};

/// A line of the spectrum, or of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Frequency (rad/s).
    pub frequency: f64,
    /// Amplitude of the torque (N m).
    pub torque: Complex<f64>,
    /// Amplitude of the motion (rad/s, rad or rad/s2).
    pub motion: Complex<f64>,
    /// Part of the motion's noise in this line, of its power in all: of an angle whose speed is its difference.
    pub noise: f64,
}

/// Share of the sample rate up to which the spectrum is used: beyond it a torque between samples is guesswork.
const HIGHEST: f64 = 0.2;
/// Lines of a block, among which those that carry the torque are found.
const BLOCK: usize = 50;
/// Share of a block's power that its lines must carry: a multisine leaves the lines between without torque.
const CARRIED: f64 = 0.9;
/// Power of a band's torque, of the strongest band's, below which the first guess leaves it out.
const FAINT: f64 = 1e-4;
/// Bands of the first guess.
const BANDS: usize = 90;

/// The spectrum of a signal without its mean, from the first line to the highest.
fn spectrum(signal: &[f64], planner: &mut FftPlanner<f64>) -> Vec<Complex<f64>> {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let mut buffer: Vec<_> = signal.iter().map(|value| Complex::new(value - mean, 0.0)).collect();
    planner.plan_fft_forward(signal.len()).process(&mut buffer);
    buffer.truncate(1 + (HIGHEST * signal.len() as f64) as usize);
    let unit = 2.0 / signal.len() as f64;
    buffer.iter().map(|amplitude| amplitude * unit).collect()
}

/// The lines of a recording, samples of torque and motion at the same times, `period` (s) apart. An angle is taken as
/// the mean speed from sample to sample, so that it need not return.
#[must_use]
pub fn lines(torque: &[f64], values: &[f64], motion: Motion, period: f64) -> Vec<Line> {
    let turned: Vec<f64>;
    let (torque, values) = match motion {
        Motion::Angle => {
            turned = values.windows(2).map(|pair| (pair[1] - pair[0]) / period).collect();
            (&torque[1..], &turned[..])
        }
        _ => (torque, values),
    };
    let mut planner = FftPlanner::new();
    let unit = TAU / (period * torque.len() as f64);
    let (torque, moved) = (spectrum(torque, &mut planner), spectrum(values, &mut planner));
    let line = |(index, (&torque, &moved)): (usize, (&Complex<f64>, &Complex<f64>))| {
        let frequency = unit * index as f64;
        let difference = 2.0 * (0.5 * frequency * period).sin();
        let noise = if motion == Motion::Angle { difference * difference } else { 1.0 };
        Line { frequency, torque, motion: moved, noise }
    };
    torque.iter().zip(&moved).enumerate().skip(1).map(line).collect()
}

/// The lines that carry the torque: of each block the fewest that hold 90 % of its power.
#[must_use]
pub fn carriers(lines: &[Line], between: [f64; 2]) -> Vec<Line> {
    let mut carriers = Vec::new();
    let within: Vec<Line> =
        lines.iter().filter(|line| line.frequency >= between[0] && line.frequency <= between[1]).copied().collect();
    for block in within.chunks(BLOCK) {
        let mut powers: Vec<f64> = block.iter().map(|line| line.torque.norm_sqr()).collect();
        let total: f64 = powers.iter().sum();
        powers.sort_by(|a, b| b.total_cmp(a));
        let mut sum = 0.0;
        let held = |power: &f64| {
            sum += power;
            sum < CARRIED * total
        };
        let count = powers.iter().copied().take_while(held).count();
        let least = powers.get(count).copied().unwrap_or(0.0);
        carriers.extend(block.iter().filter(|line| line.torque.norm_sqr() >= least && least > 0.0));
    }
    carriers
}

/// A smoothed response from the lines that carry the torque: the mean of each band, with the standard deviation by its
/// coherence. Bands with hardly any torque are left out.
#[must_use]
pub fn smoothed(carriers: &[Line], motion: Motion) -> Vec<Response> {
    let (Some(first), Some(last)) = (carriers.first(), carriers.last()) else { return Vec::new() };
    // a single tone has no bands: their edges would never pass it
    if !(last.frequency > first.frequency) {
        return Vec::new();
    }
    let ratio = (last.frequency / first.frequency).powf(1.0 / BANDS as f64);
    let mut bands: Vec<&[Line]> = Vec::new();
    let (mut rest, mut edge) = (carriers, first.frequency);
    while !rest.is_empty() {
        edge *= ratio;
        let (band, after) = rest.split_at(rest.partition_point(|line| line.frequency < edge));
        if !band.is_empty() {
            bands.push(band);
        }
        rest = if edge > last.frequency { &[] } else { after };
    }
    let torque = |band: &[Line]| band.iter().map(|line| line.torque.norm_sqr()).sum::<f64>() / band.len() as f64;
    let strongest = bands.iter().map(|band| torque(band)).fold(0.0, f64::max);
    let response = |band: &&[Line]| {
        let count = band.len() as f64;
        let middle = band.iter().map(|line| line.frequency).sum::<f64>() / count;
        let power = torque(band) * count;
        let moved: f64 = band.iter().map(|line| line.motion.norm_sqr()).sum();
        let cross: Complex<f64> = band.iter().map(|line| line.motion * line.torque.conj()).sum();
        let coherence = cross.norm_sqr() / (power * moved).max(f64::MIN_POSITIVE);
        let speed = if motion == Motion::Acceleration { 1.0.into() } else { Complex::new(0.0, middle) };
        let acceleration = cross / power * speed;
        // of few lines little is known: as of a coherence of a half
        let unknown = if band.len() > 2 { (1.0 - coherence) / coherence } else { 1.0 };
        Response {
            frequency: middle,
            acceleration: [acceleration.re, acceleration.im],
            standard_deviation: acceleration.norm() * ((0.5 * unknown / count).sqrt() + 0.02),
            torque: torque(band).sqrt(),
        }
    };
    let strong = bands.iter().filter(|band| torque(band) > FAINT * strongest);
    strong.map(response).filter(|response| response.standard_deviation.is_finite()).collect()
}

/// The table of a response as the fit of commissioning takes it.
#[must_use]
pub fn tabulated(lines: &[Line], motion: Motion) -> Vec<Response> {
    let response = |line: &Line| {
        let s = Complex::new(0.0, line.frequency);
        let acceleration = line.motion / line.torque
            * match motion {
                Motion::Angle => s * s,
                Motion::Speed => s,
                Motion::Acceleration => Complex::new(1.0, 0.0),
            };
        Response {
            frequency: line.frequency,
            acceleration: [acceleration.re, acceleration.im],
            standard_deviation: 0.05 * acceleration.norm(),
            torque: line.torque.norm(),
        }
    };
    lines.iter().map(response).collect()
}

/// A first guess of the machine: the fit of commissioning to responses.
#[must_use]
pub fn guess(responses: &[Response]) -> Option<(Model, Fit)> {
    let mut inertias: Vec<f64> =
        responses.iter().map(|response| response.acceleration[0].hypot(response.acceleration[1]).recip()).collect();
    inertias.sort_by(f64::total_cmp);
    let unit = inertias.get(inertias.len() / 2).copied()?;
    let (first, last) = (responses.first()?.frequency, responses.last()?.frequency);
    let fitted = fit(responses, unit, [first, last])?;
    let derived = fitted.derived();
    let model = Model {
        motor: derived.motor,
        load: derived.load,
        stiffness: derived.stiffness,
        damping: derived.damping,
        friction: [0.0; 2],
        delay: 0.0,
        third: None,
    };
    (model.motor > 0.0 && model.load > 0.0).then_some((model, fitted))
}
