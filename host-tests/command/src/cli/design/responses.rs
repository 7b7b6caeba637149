//! The speed loop in numbers to draw: responses over frequency with their band over the tolerances, margins, poles,
//! steps.

use std::f64::consts::{PI, TAU};

use driveline::design::{ClosedLoop, CutLoop, Error, LoopObserver, Plant};
use driveline::machine::TwoMass;
use nalgebra::Complex;
use serde::Serialize;

use super::crossings::{Crossing, Pole, crossings, poles};
use super::linear::{Body, Entry, Linear, Observer};
use crate::machine_file::MachineFile;
use crate::machine_file::designs::Designs;

/// Where the loop is cut.
pub const CUT: &str = "at the torque on the machine: from a torque that is added there, through machine, encoder, \
    observer, governor and actuator, back to the torque that the drive gives";

/// How finely it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    /// Points of a response, evenly spread by their logarithm.
    points: usize,
    /// Points about each resonance.
    about: usize,
    /// Most points of a step.
    shown: usize,
}

impl Detail {
    /// Every point.
    pub const FULL: Self = Self { points: 800, about: 60, shown: 1_000 };
    /// A quarter: while a slider moves.
    pub const QUICK: Self = Self { points: 200, about: 20, shown: 250 };
}

/// How far the points about a resonance reach.
const REACH: f64 = 0.1;
/// Highest frequency, over half the rate, where a sampled response has its zeros.
const HIGHEST: f64 = 0.98;
/// Steps last so many radians of the speed's natural frequency.
const RADIANS: f64 = 14.0;

/// Size and phase (degrees, unwrapped) over the common frequencies.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Curve {
    /// Size.
    pub gain: Vec<f64>,
    /// Phase (degrees).
    pub phase: Vec<f64>,
}

impl Curve {
    fn of(response: &[Complex<f64>]) -> Self {
        Self::whole(response).short()
    }

    /// In six digits.
    fn short(self) -> Self {
        let short = |values: Vec<f64>| values.into_iter().map(short).collect();
        Self { gain: short(self.gain), phase: short(self.phase) }
    }

    /// In all digits.
    fn whole(response: &[Complex<f64>]) -> Self {
        let mut turned = 0.0;
        let mut before: Option<f64> = None;
        let phase = |value: &Complex<f64>| {
            let angle = value.arg();
            turned -= before.map_or(0.0, |before| TAU * ((angle - before) / TAU).round());
            before = Some(angle);
            (angle + turned).to_degrees()
        };
        Self { gain: response.iter().map(|value| value.norm()).collect(), phase: response.iter().map(phase).collect() }
    }
}

/// Least and most of a curve over the tolerances.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Range {
    /// The least of each.
    pub least: Curve,
    /// The most of each.
    pub most: Curve,
}

impl Range {
    /// Of curves whose gain has a least and a greatest factor.
    fn of(curves: &[Curve], factors: [f64; 2]) -> Self {
        let over = |part: fn(&Curve) -> &Vec<f64>, better: fn(f64, f64) -> f64| {
            let mut all = curves.iter().map(part);
            let first = all.next().cloned().unwrap_or_default();
            all.fold(first, |found, one| found.iter().zip(one).map(|(a, b)| better(*a, *b)).collect())
        };
        let curve = |better, factor| {
            let gain = over(|c| &c.gain, better).into_iter().map(|gain| factor * gain).collect();
            Curve { gain, phase: over(|c| &c.phase, better) }.short()
        };
        Self { least: curve(f64::min, factors[0]), most: curve(f64::max, factors[1]) }
    }
}

/// Course of a step: per rad/s of the setpoint, or per N m of load torque.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Step {
    /// Speed of the motor (rad/s).
    pub motor_speed: Vec<f64>,
    /// Speed of the load (rad/s).
    pub load_speed: Vec<f64>,
    /// Torque of the motor (N m).
    pub motor_torque: Vec<f64>,
}

/// The two steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Steps {
    /// Of the setpoint, without its ramp.
    pub setpoint: Step,
    /// Of the load torque.
    pub load: Step,
}

/// A machine at the edge of the tolerances, by its factors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Drawn {
    /// Factor of the motor side's inertia.
    pub motor_inertia: f64,
    /// Of the load side's inertia.
    pub load_inertia: f64,
    /// Of the stiffness.
    pub stiffness: f64,
    /// Of the torque.
    pub torque: f64,
    /// Whether the torque is as late as it may be.
    pub is_late: bool,
    /// Least distance of its loop from -1.
    pub distance: f64,
}

/// What is drawn of one machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct One {
    /// Motor speed per motor torque (rad/s per N m), in continuous time.
    pub plant: Curve,
    /// The loop.
    pub open: Curve,
    /// Its parts, for a Nyquist plot.
    pub real: Vec<f64>,
    /// As above.
    pub imaginary: Vec<f64>,
    /// Crossings of the unit circle and of the negative real axis.
    pub crossings: Vec<Crossing>,
    /// Least distance from -1 at the drawn points.
    pub distance: f64,
    /// Poles of the closed loop, without the free angle's.
    pub poles: Vec<Pole>,
    /// `null` where the loop is unstable.
    pub steps: Option<Steps>,
}

/// The estimates per speed of the motor as it is measured, without a torque of the motor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observed {
    /// Of the load speed: estimated.
    pub load_speed: Curve,
    /// As the two masses have it.
    pub load_speed_of_two_masses: Curve,
    /// Of the shaft torque (N m per rad/s): estimated.
    pub shaft_torque: Curve,
    /// As the two masses have it.
    pub shaft_torque_of_two_masses: Curve,
}

/// The speed loop in numbers to draw.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Responses {
    /// Where the loop is cut, in words.
    pub cut: &'static str,
    /// Frequencies (Hz), up to 0.98 of half the rate.
    pub hz: Vec<f64>,
    /// The machine as the file has it, with all its vibrations.
    pub nominal: One,
    /// The two masses whose loop comes nearest to -1 within the tolerances.
    pub drawn: One,
    /// Which those are.
    pub drawn_by: Drawn,
    /// The loop within the tolerances.
    pub open_within: Range,
    /// The machine within the tolerances.
    pub plant_within: Range,
    /// The observer.
    pub observer: Observed,
    /// Times of the steps (s).
    pub time: Vec<f64>,
}

/// A machine in the loop.
struct InLoop<'a> {
    closed: &'a ClosedLoop,
    plant: Plant,
    cut: CutLoop,
    body: Body,
    torque: f64,
    late: bool,
}

impl<'a> InLoop<'a> {
    fn new(closed: &'a ClosedLoop, plant: Plant, body: Body) -> Self {
        Self { closed, plant, cut: closed.cut(&plant), body, torque: 1.0, late: false }
    }

    /// Response of the loop at a frequency (rad/s).
    fn open(&self, frequency: f64) -> Complex<f64> {
        let (re, im) = self.cut.response(frequency);
        Complex::new(re, im) * self.torque
    }
}

impl Responses {
    /// Of a machine with its designs.
    ///
    /// # Errors
    /// The library's sentence for a loop that it does not have.
    pub fn of(machine: &MachineFile, designs: &Designs, detail: Detail) -> Result<Self, Error> {
        let Designs { two, speed_loop, .. } = designs;
        let observer = match designs.is_rigid() {
            true => LoopObserver::Rigid(&designs.rigid),
            false => LoopObserver::TwoMass(&designs.two_masses),
        };
        let (actuator, tolerance, period) = (machine.actuator(), machine.tolerance(), speed_loop.period);
        let loops = observer.close_within(speed_loop, actuator, &tolerance)?;
        let (modes, load) = (machine.modes(), machine.chain.masses().len() - 1);
        let inertia = two.total_inertia();
        let (plant, body) = (Plant::of_modes(inertia, &modes), Body::of_modes(inertia, &modes, load));
        let nominal = InLoop::new(&loops[0], plant, body);
        let slowest = 1e-2 * speed_loop.integral / speed_loop.proportional;
        let frequencies = frequencies(slowest, HIGHEST * PI / period, two.antiresonance(), &nominal.body, detail);
        // with the torque as it is: its tolerance is a factor on the response
        let within: Vec<(u32, InLoop)> = (0..2 * tolerance.machines())
            .map(|index| {
                let (machine, late) = (tolerance.machine(two, index / 2), index & 1 == 1);
                let one = InLoop::new(&loops[usize::from(late)], Plant::of(&machine), Body::of(&machine));
                (index / 2, InLoop { late, ..one })
            })
            .collect();
        let torques = [tolerance.torque.min, tolerance.torque.max];
        let of_loops: Vec<Vec<Complex<f64>>> =
            within.iter().map(|(_, one)| frequencies.iter().map(|&at| one.open(at)).collect()).collect();
        let all = of_loops.iter().zip(&within).flat_map(|(open, one)| torques.map(|torque| (open, one, torque)));
        let ((index, worst), torque, distance) = all
            .map(|(open, one, torque)| (one, torque, distance(open, torque)))
            .min_by(|a, b| a.2.total_cmp(&b.2))
            .ok_or(Error::Tolerance)?;
        let factors = tolerance.machine(two, *index);
        let drawn_by = Drawn {
            motor_inertia: short(factors.motor_inertia / two.motor_inertia),
            load_inertia: short(factors.load_inertia / two.load_inertia),
            stiffness: short(factors.stiffness / two.stiffness),
            torque,
            is_late: worst.late,
            distance: short(distance),
        };
        let later = driveline::design::Actuator {
            delay: actuator.delay + f64::from(tolerance.late) * period,
            lag: actuator.lag + tolerance.lag,
        };
        let seen = Observer::of(&observer, two).ok_or(Error::Unobservable)?;
        let ticks = (RADIANS / (speed_loop.bandwidth * period)).ceil().clamp(2.0, 4e6) as usize;
        let stride = ticks.div_ceil(detail.shown);
        let worst = &InLoop { torque, body: worst.body.clone(), ..*worst };
        let one = |one: &InLoop| {
            let actuator = if one.late { later } else { actuator };
            let linear = Linear::new(one.body.clone(), seen.clone(), speed_loop, actuator, one.torque)?;
            let is_stable = one.closed.is_stable(&one.plant, one.torque);
            let steps = is_stable.then(|| Steps::of(&linear, ticks, stride));
            Ok::<_, Error>(One::of(one, &frequencies, period, &linear, steps))
        };
        let prompt = within.iter().filter(|(_, one)| !one.late);
        let plants: Vec<Curve> = prompt.map(|(_, one)| Curve::whole(&mobility(&one.body, &frequencies))).collect();
        let curves: Vec<Curve> = of_loops.iter().map(|one| Curve::whole(one)).collect();
        Ok(Self {
            cut: CUT,
            nominal: one(&nominal)?,
            drawn: one(worst)?,
            drawn_by,
            open_within: Range::of(&curves, torques),
            plant_within: Range::of(&plants, [1.0; 2]),
            observer: Observed::of(&seen, two, &frequencies, period).ok_or(Error::Unobservable)?,
            time: (0..ticks).step_by(stride).map(|tick| short(tick as f64 * period)).collect(),
            hz: frequencies.iter().map(|at| short(at / TAU)).collect(),
        })
    }
}

impl One {
    fn of(one: &InLoop, frequencies: &[f64], period: f64, linear: &Linear, steps: Option<Steps>) -> Self {
        let open: Vec<Complex<f64>> = frequencies.iter().map(|&at| one.open(at)).collect();
        Self {
            plant: Curve::of(&mobility(&one.body, frequencies)),
            crossings: crossings(|at| one.open(at), frequencies, &open),
            distance: short(distance(&open, 1.0)),
            real: open.iter().map(|value| short(value.re)).collect(),
            imaginary: open.iter().map(|value| short(value.im)).collect(),
            open: Curve::of(&open),
            poles: poles(linear, period),
            steps,
        }
    }
}

impl Steps {
    fn of(linear: &Linear, ticks: usize, stride: usize) -> Self {
        let step = |entry| {
            let shown = linear.step(entry, ticks, stride);
            let part = |at: usize| shown.iter().map(|shown| short(shown[at])).collect();
            Step { motor_speed: part(0), load_speed: part(1), motor_torque: part(2) }
        };
        Self { setpoint: step(Entry { setpoint: 1.0, load: 0.0 }), load: step(Entry { setpoint: 0.0, load: 1.0 }) }
    }
}

impl Observed {
    fn of(observer: &Observer, two: &TwoMass, frequencies: &[f64], period: f64) -> Option<Self> {
        let estimated: Option<Vec<[Complex<f64>; 2]>> =
            frequencies.iter().map(|&at| observer.response(at, period)).collect();
        let (load_speed, shaft_torque): (Vec<_>, Vec<_>) = estimated?.into_iter().map(|[a, b]| (a, b)).unzip();
        // the motor's inertia alone is what the shaft turns; the twist follows
        let exact = |&at: &f64| {
            let s = Complex::new(0.0, at);
            let torque = -s * two.motor_inertia;
            (1.0 - torque * s / (s * two.damping + two.stiffness), torque)
        };
        let (speed, torque): (Vec<_>, Vec<_>) = frequencies.iter().map(exact).unzip();
        Some(Self {
            load_speed: Curve::of(&load_speed),
            load_speed_of_two_masses: Curve::of(&speed),
            shaft_torque: Curve::of(&shaft_torque),
            shaft_torque_of_two_masses: Curve::of(&torque),
        })
    }
}

/// Six digits, as the arrays are written.
pub fn short(value: f64) -> f64 {
    let exponent = (value.abs().log10().floor() - 5.0) as i32;
    // powers of ten up to the 22nd are numbers, so the quotient or the product is rounded once
    match exponent {
        0..=22 if value != 0.0 => (value / 10f64.powi(exponent)).round() * 10f64.powi(exponent),
        -22..0 => (value * 10f64.powi(-exponent)).round() / 10f64.powi(-exponent),
        _ => format!("{value:.5e}").parse().unwrap_or(value),
    }
}

fn mobility(body: &Body, frequencies: &[f64]) -> Vec<Complex<f64>> {
    frequencies.iter().map(|&at| body.mobility(at)).collect()
}

/// Least distance from -1 of a response times a factor.
fn distance(open: &[Complex<f64>], factor: f64) -> f64 {
    open.iter().map(|value| (value * factor + 1.0).norm_sqr()).fold(f64::INFINITY, f64::min).sqrt()
}

/// Frequencies (rad/s) from the slowest to the highest, denser about the antiresonance, the resonances and on their
/// flanks.
fn frequencies(slowest: f64, highest: f64, antiresonance: f64, body: &Body, detail: Detail) -> Vec<f64> {
    let Detail { points, about, .. } = detail;
    let even = (0..points).map(|point| slowest * (highest / slowest).powf(point as f64 / (points - 1) as f64));
    let mut all: Vec<f64> = even.collect();
    for [frequency, damping] in body.resonances().chain([[antiresonance, 0.0]]) {
        let share = |point: usize| 1.0 - REACH + 2.0 * REACH * point as f64 / about as f64;
        all.extend((0..=about).map(|point| frequency * share(point)));
        let widths = [0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
        all.extend(widths.into_iter().flat_map(|n| [frequency - n * damping, frequency + n * damping]));
    }
    all.retain(|at| (slowest..=highest).contains(at));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
