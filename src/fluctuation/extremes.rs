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
    before: N,
    after: N,
    /// Segment in the upper six bits, [2^-28 turn] into it in the others.
    place: u32,
}

impl<N: Copy> Peak<N> {
    #[inline(always)]
    fn flat(value: N, place: u32) -> Self {
        Peak { value, before: value, after: value, place }
    }
}

/// The extremes of one speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Speed<N> {
    last: N,
    before: N,
    max: Peak<N>,
    min: Peak<N>,
}

impl<N: Number> Speed<N> {
    #[inline(always)]
    fn follow(&mut self, value: N, place: impl Fn() -> u32) {
        let (middle, before) = (self.last, self.before);
        self.before = middle;
        self.last = value;
        if middle > self.max.value {
            self.max = Peak { value: middle, before, after: value, place: place() };
        } else if middle < self.min.value {
            self.min = Peak { value: middle, before, after: value, place: place() };
        }
    }

    #[inline(always)]
    fn anew(&mut self, place: u32) {
        self.max = Peak::flat(self.last, place);
        self.min = self.max;
    }
}

/// A finished cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Finished<N> {
    from: Edge,
    to: Edge,
    /// Maximum and minimum of the motor's speed, then of the load's.
    peaks: [Peak<N>; 4],
    forward: bool,
    /// The end of the cycle before, where there was one.
    before: Option<Edge>,
}

/// Cycle by cycle: mean, extremes and delta of the motor's and of the load's speed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extremes<N> {
    position: Position,
    tick: u32,
    motor: Speed<N>,
    load: Speed<N>,
    forward: bool,
    edge: Option<Edge>,
    finished: Option<Finished<N>>,
    cycles: u32,
}

impl<N: Number> Default for Extremes<N> {
    fn default() -> Self {
        Extremes {
            position: Position::default(),
            tick: 0,
            motor: Speed::default(),
            load: Speed::default(),
            forward: true,
            edge: None,
            finished: None,
            cycles: 0,
        }
    }
}

impl<N: Number> Fluctuation<N> for Extremes<N> {
    type Config = CycleConfig;

    #[inline(always)]
    fn measure(&mut self, config: &CycleConfig, angle: u32, _torque: N, estimate: &Estimate<N>) {
        let tick = self.tick;
        self.tick = tick.wrapping_add(1);
        if let Some(crossing) = self.position.advance(config, angle, tick) {
            self.cross(crossing, estimate, angle);
            return;
        }
        let position = self.position;
        let place = || position.segment << 26 | position.within(angle) >> 4;
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
        self.edge = None;
        self.finished = None;
    }

    #[inline(never)]
    fn cross(&mut self, crossing: Crossing, estimate: &Estimate<N>, angle: u32) {
        let place = self.position.segment << 26 | self.position.within(angle) >> 4;
        match crossing {
            Crossing::Segment => {}
            Crossing::Lost => self.give_up(),
            Crossing::Cycle { edge, forward } => {
                if forward != self.forward {
                    self.give_up();
                    self.forward = forward;
                }
                if let Some(from) = self.edge {
                    let before = self.finished.map(|finished| finished.from);
                    let peaks = [self.motor.max, self.motor.min, self.load.max, self.load.min];
                    self.finished = Some(Finished { from, to: edge, peaks, forward, before });
                    self.cycles = self.cycles.wrapping_add(1);
                }
                self.edge = Some(edge);
                // The cycle begins with what the speeds are now.
                self.motor.last = estimate.motor_speed;
                self.load.last = estimate.load_speed;
                self.motor.before = estimate.motor_speed;
                self.load.before = estimate.load_speed;
                self.motor.anew(place);
                self.load.anew(place);
                return;
            }
        }
        if self.tick & 1 == 1 {
            self.motor.follow(estimate.motor_speed, || place);
        } else {
            self.load.follow(estimate.load_speed, || place);
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
        let finished = self.finished?;
        let ticks = finished.to.since(&finished.from);
        let sign = if finished.forward { 1.0 } else { -1.0 };
        let mean = sign * config.angle / (ticks * config.period);
        let previous = finished.before.map(|before| {
            let ticks = finished.from.since(&before);
            sign * config.angle / (ticks * config.period)
        });
        let [motor_max, motor_min, load_max, load_min] = finished.peaks.map(|peak| vertex(config, &peak));
        Some(Reading {
            mean,
            change: previous.map(|previous| mean - previous),
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
