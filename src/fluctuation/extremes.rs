//! Largest and least speed of every cycle, of motor and load, and its mean.
//!
//! A tick looks at one of the two speeds, the motor's in even ticks and the load's in odd ones: half the rate is ten times what a ripple needs,
//! and the extreme between the samples is found by a parabola through three of them. The mean by time is exact: the cycle's angle over the
//! time between its two ends, which are interpolated within their ticks.
//!
//! The speeds are the observer's. A ripple much faster than the observer is smaller in them than it is, and their noise makes the largest value too
//! large and the least too small by two or three of its standard deviations; where delta is not far above that, take a [`super::Waveform`].

use super::position::{Crossing, Position};
use super::{CycleConfig, Edge, Fluctuation};
use crate::number::Number;
use crate::sample::Estimate;

/// An extreme as the tick keeps it: three samples, and where the last of them was.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Peak<N> {
    value: N,
    /// The extreme before: on the way to a peak, the sample before.
    before: N,
    after: N,
    /// Segment in the upper six bits, [2^-28 turn] into it in the others.
    place: u32,
}

/// The extremes of one speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Speed<N> {
    last: N,
    max: Peak<N>,
    min: Peak<N>,
}

impl<N: Number> Speed<N> {
    #[inline(always)]
    fn follow(&mut self, value: N, place: impl Fn() -> u32) {
        let middle = core::mem::replace(&mut self.last, value);
        if middle > self.max.value {
            self.max = Peak { value: middle, before: self.max.value, after: value, place: place() };
        } else if middle < self.min.value {
            self.min = Peak { value: middle, before: self.min.value, after: value, place: place() };
        }
    }

    fn anew(&mut self, place: u32) {
        let value = self.last;
        self.max = Peak { value, before: value, after: value, place };
        self.min = self.max;
    }
}

/// Cycle by cycle: mean, extremes and delta of the motor's and of the load's speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extremes<N> {
    position: Position,
    tick: u32,
    motor: Speed<N>,
    load: Speed<N>,
    forward: bool,
    /// The last ends of a cycle, the latest last, and how many of them are good.
    edges: [Edge<N>; 3],
    good: u32,
    /// Maximum and minimum of the motor's speed in the finished cycle, then of the load's.
    peaks: [Peak<N>; 4],
    cycles: u32,
}

impl<N: Number> Fluctuation<N> for Extremes<N> {
    type Config = CycleConfig;

    #[inline(always)]
    fn measure(&mut self, config: &CycleConfig, angle: u32, _torque: N, estimate: &Estimate<N>) {
        let tick = self.tick.wrapping_add(1);
        self.tick = tick;
        let within = self.position.within(angle);
        if within >= config.length {
            self.pass(config, angle, estimate.motor_speed);
            return;
        }
        let position = &self.position;
        let place = || position.segment << 26 | within >> 4;
        if tick & 1 == 0 {
            self.motor.follow(estimate.motor_speed, place);
        } else {
            self.load.follow(estimate.load_speed, place);
        }
    }

    fn disturb(&mut self) {
        self.position.interrupt();
        self.give_up();
    }
}

impl<N: Number> Extremes<N> {
    fn give_up(&mut self) {
        self.good = 0;
    }

    /// A tick that ends a segment or a cycle; its speeds are not looked at.
    #[cold]
    #[inline(never)]
    fn pass(&mut self, config: &CycleConfig, angle: u32, speed: N) {
        match self.position.pass(config, angle) {
            Crossing::Within => {}
            Crossing::Lost => self.give_up(),
            Crossing::Cycle { beyond, forward } => {
                let to = Edge { tick: self.tick, beyond, speed };
                if forward != self.forward {
                    self.give_up();
                    self.forward = forward;
                }
                if self.good > 0 {
                    let [motor_max, motor_min, load_max, load_min] = &mut self.peaks;
                    *motor_max = self.motor.max;
                    *motor_min = self.motor.min;
                    *load_max = self.load.max;
                    *load_min = self.load.min;
                    self.cycles = self.cycles.wrapping_add(1);
                }
                let [first, second, third] = &mut self.edges;
                *first = *second;
                *second = *third;
                *third = to;
                self.good = (self.good + 1).min(3);
                // The next cycle begins with what the speeds were last.
                let place = self.position.segment << 26 | self.position.within(angle) >> 4;
                self.motor.anew(place);
                self.load.anew(place);
            }
        }
    }

    /// Cycles that have been finished, to know a new one from the last; wraps.
    pub fn cycles(&self) -> u32 {
        self.cycles
    }

    /// The cycle that was finished last, `None` until there is one since the last disturbance or change of direction.
    ///
    /// Not for the tick: it divides, in `f64`.
    pub fn reading(&self, config: &CycleConfig) -> Option<Reading> {
        if self.good < 2 {
            return None;
        }
        let [before, from, to] = &self.edges;
        let ticks = to.since(from, config);
        let sign = if self.forward { 1.0 } else { -1.0 };
        let mean = sign * config.angle / (ticks * config.period);
        let previous = sign * config.angle / (from.since(before, config) * config.period);
        let [motor_max, motor_min, load_max, load_min] = self.peaks.map(|peak| vertex(config, &peak));
        Some(Reading {
            mean,
            change: if self.good < 3 { None } else { Some(mean - previous) },
            duration: ticks * config.period,
            motor: Fluctuations::of(motor_max, motor_min, mean),
            load: Fluctuations::of(load_max, load_min, mean),
        })
    }

    /// Mean speed by time of the cycle that was finished last [rad/s], negative backwards: what a governor acts on that is to leave the
    /// ripple alone.
    pub fn mean(&self, config: &CycleConfig) -> Option<f64> {
        self.reading(config).map(|reading| reading.mean)
    }
}

/// The parabola's vertex through three samples that are two ticks apart.
fn vertex<N: Number>(config: &CycleConfig, peak: &Peak<N>) -> Extreme {
    let [before, value, after] = [peak.before, peak.value, peak.after].map(|n| n.to_real() * config.speed);
    let segment = config.angle / (f64::from(config.last_segment) + 1.0);
    let last = f64::from(peak.place >> 26) * segment + f64::from(peak.place & ((1 << 26) - 1)) * RADIANS;
    let curvature = before - 2.0 * value + after;
    let offset = if curvature == 0.0 { 0.0 } else { (0.5 * (before - after) / curvature).clamp(-1.0, 1.0) };
    let angle = last + (offset - 1.0) * 2.0 * config.period * value;
    let angle = if angle < 0.0 { angle + config.angle } else { angle };
    let angle = if angle < config.angle { angle } else { angle - config.angle };
    Extreme { speed: value - 0.25 * (before - after) * offset, angle }
}

/// Radians of 2^-28 turn.
const RADIANS: f64 = core::f64::consts::TAU / 268_435_456.0;

/// A largest or least speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extreme {
    /// Speed [rad/s].
    pub speed: f64,
    /// Where in the cycle, from 0 to less than the cycle's angle \[rad\].
    pub angle: f64,
}

/// How far a speed swings in a cycle [Notes ch. 5].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fluctuations {
    /// The largest speed.
    pub max: Extreme,
    /// The least speed.
    pub min: Extreme,
    /// (max + min)/2 [rad/s].
    pub arithmetic_mean: f64,
    /// (max - min) over the mean by time.
    pub delta: f64,
    /// (max - min) over the arithmetic mean.
    pub delta_arithmetic: f64,
}

impl Fluctuations {
    /// From the extremes and the mean by time; a delta over no mean at all is infinite or not a number.
    pub fn of(max: Extreme, min: Extreme, mean: f64) -> Self {
        let arithmetic_mean = 0.5 * (max.speed + min.speed);
        let swing = max.speed - min.speed;
        Fluctuations {
            max,
            min,
            arithmetic_mean,
            delta: swing / mean.abs(),
            delta_arithmetic: swing / arithmetic_mean.abs(),
        }
    }
}

/// One cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// Mean by time [rad/s], of motor and load alike; negative backwards.
    pub mean: f64,
    /// The mean less that of the cycle before [rad/s]: the part that is not periodic, which a governor mends and a flywheel does not.
    pub change: Option<f64>,
    /// How long the cycle took \[s\].
    pub duration: f64,
    /// The motor.
    pub motor: Fluctuations,
    /// The load.
    pub load: Fluctuations,
}
