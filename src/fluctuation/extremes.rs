//! Largest and least speed of every cycle, of motor and load, and its mean.
//!
//! The work is spread evenly over the ticks: of four, one looks at the motor's speed, one at the load's, and the two
//! between detect the end of the cycle or do a slice of its work. The extreme between the samples is found by a
//! parabola through three of them: of a sine with 64 ticks to its period it then misses at most 0.06 % of the
//! amplitude, with 40 ticks 0.35 %. The mean by time is exact: the cycle's angle over the time between its two ends,
//! which are interpolated. A cycle, and a turn of a longer one, must have 96 ticks: the work at its end takes half of
//! them.
//!
//! The speeds are the observer's. A ripple much faster than the observer is smaller in them than it is. Their noise
//! makes the largest value too large and the least too small by two or three of its standard deviations.
//! [`CycleReading::with_errors`] corrects the noise and gives each delta a deviation by noise and lag. Where delta is
//! not far above that, take a [`super::Waveform`].

mod peak;
mod reading;

use core::f64::consts::TAU;

pub use peak::Ranked;
pub use reading::{CycleReading, Extreme, Fluctuations, SpeedErrors};

use super::position::{Position, RADIANS, Way};
use super::{CycleConfig, Edge, Fluctuation};
use crate::number::Real;
use crate::sample::Estimate;
use peak::{Peak, SEGMENTS, Speed, place};

/// Ticks between two samples of a speed.
const SAMPLE: f64 = 4.0;

/// Work of the ticks between the samples: one of these each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Slice {
    /// Looks for the end of the segment.
    Watch,
    /// The first tick of all.
    #[default]
    Begin,
    Ahead,
    Behind,
    Advance,
    Retreat,
    Away,
    Jump,
    Beyond,
    NextCycle,
    CarryOn,
    Measure,
    CarryBack,
    MeasureBack,
    LastCycle,
    Direction,
    /// The angle was elsewhere, or a tick was left out on the way here.
    ReadingFault,
    TakeMotorMax,
    RenewMotorMax,
    TakeMotorMin,
    RenewMotorMin,
    Pause,
    TakeLoadMax,
    RenewLoadMax,
    TakeLoadMin,
    RenewLoadMin,
    File,
    Publish,
    Count,
}

/// The extremes of a finished cycle: largest and least of the motor's speed, and of the load's.
type Finished<R> = [[Peak<R>; 2]; 2];

/// Cycle by cycle: mean, extremes and delta of the motor's and of the load's speed.
#[doc = include_str!("extremes/example.txt")]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extremes<N: Ranked = f32> {
    tick: u32,
    slice: Slice,
    /// Direction in which the end of the present cycle was passed, and the ends before.
    ahead: bool,
    forward: bool,
    /// Which of the two is that of the finished cycle.
    other: bool,
    position: Position,
    motor: Speed<N::Rank>,
    load: Speed<N::Rank>,
    edge: Edge<N>,
    /// The last ends of a cycle, how many have been filed, and how many of them are good.
    edges: [Edge<N>; 4],
    filed: u32,
    good: u32,
    finished: [Finished<N::Rank>; 2],
    cycles: u32,
}

impl<N: Ranked> Fluctuation<N> for Extremes<N> {
    type Config = CycleConfig;

    #[inline(always)]
    fn measure(&mut self, config: &CycleConfig, angle: u32, _torque: N, estimate: &Estimate<N>) {
        let tick = self.tick.wrapping_add(1);
        self.tick = tick;
        let position = &self.position;
        if tick & 1 != 0 {
            self.slice(config, angle, tick, estimate);
        } else if tick & 2 == 0 {
            self.motor.follow(estimate.motor_speed.rank(), || place(angle, position.segment));
        } else {
            self.load.follow(estimate.load_speed.rank(), || place(angle, position.segment));
        }
    }

    fn disturb(&mut self) {
        self.position.is_sure = false;
        self.good = 0;
        // an end of a segment that was noticed before is not that of the next angle
        if (Slice::Ahead as u8..=Slice::Beyond as u8).contains(&(self.slice as u8)) {
            self.slice = Slice::Watch;
        }
    }
}

impl<N: Ranked> Extremes<N> {
    /// Looks at the speed of the load, or of the motor.
    #[inline(always)]
    pub(super) fn look(&mut self, load: bool, angle: u32, estimate: &Estimate<N>) {
        let segment = self.position.segment;
        let (speed, value) = if load {
            (&mut self.load, estimate.load_speed.rank())
        } else {
            (&mut self.motor, estimate.motor_speed.rank())
        };
        speed.follow(value, || place(angle, segment));
    }

    /// Whether a finished cycle's extremes are being taken, in every other tick.
    #[inline(always)]
    pub(super) fn is_taking(&self) -> bool {
        self.slice as u8 >= Slice::Direction as u8
    }

    /// One slice of the work at the end of a segment or of a cycle.
    #[inline(always)]
    pub(super) fn slice(&mut self, config: &CycleConfig, angle: u32, tick: u32, estimate: &Estimate<N>) {
        let position = &mut self.position;
        self.slice = match self.slice {
            Slice::Watch => {
                let within = position.within(angle);
                if within < config.length {
                    return;
                }
                let beyond = within.wrapping_sub(config.length);
                self.edge = Edge { tick, angle, beyond, speed: estimate.motor_speed };
                Slice::Ahead
            }
            Slice::Begin => {
                position.measure(config);
                Slice::Watch
            }
            Slice::Ahead if !position.is_sure => Slice::Away,
            Slice::Ahead => match position.ahead(config, self.edge.beyond) {
                Way::Segment => Slice::Advance,
                Way::Cycle => Slice::Beyond,
                Way::Other => Slice::Behind,
            },
            Slice::Behind => {
                let behind = self.edge.beyond.wrapping_add(config.length).wrapping_neg();
                match position.behind(config, behind) {
                    Way::Segment => Slice::Retreat,
                    Way::Cycle => Slice::CarryBack,
                    Way::Other => Slice::Away,
                }
            }
            Slice::Advance => {
                position.advance(config);
                position.count(1);
                Slice::Watch
            }
            Slice::Retreat => {
                position.retreat(config);
                position.count(-1);
                Slice::Watch
            }
            Slice::Away => {
                self.edge.beyond = Position::away(config, self.edge.beyond.wrapping_add(config.length));
                Slice::Jump
            }
            Slice::Jump => {
                position.jump(config, self.edge.beyond);
                Slice::ReadingFault
            }
            Slice::Beyond => {
                let beyond = position.beyond_cycle(self.edge.beyond);
                self.edge.beyond = beyond as u32;
                if beyond < 0 { Slice::Watch } else { Slice::NextCycle }
            }
            Slice::NextCycle => {
                position.next_cycle(config);
                self.ahead = true;
                Slice::CarryOn
            }
            Slice::CarryOn => {
                position.carry_on(config);
                Slice::Measure
            }
            Slice::Measure => {
                position.measure(config);
                Slice::Direction
            }
            Slice::CarryBack => {
                position.carry_back(config);
                Slice::MeasureBack
            }
            Slice::MeasureBack => {
                position.measure(config);
                self.edge.beyond = self.edge.beyond.wrapping_add(config.length).wrapping_neg();
                Slice::LastCycle
            }
            Slice::LastCycle => {
                position.last_cycle(config);
                self.ahead = false;
                Slice::Direction
            }
            // Two ticks later a sample of the motor's speed has just been taken.
            Slice::Direction if tick & 2 == 0 => return,
            Slice::Direction => {
                if self.ahead != self.forward {
                    self.good = 0;
                }
                self.forward = self.ahead;
                Slice::TakeMotorMax
            }
            Slice::ReadingFault => {
                position.is_sure = true;
                self.good = 0;
                Slice::Watch
            }
            // An extreme is taken in the tick after a sample and renewed before the next.
            Slice::TakeMotorMax => {
                let max = self.motor.max;
                self.hidden()[0][0] = max;
                Slice::RenewMotorMax
            }
            Slice::RenewMotorMax => {
                self.motor.max = self.motor.fresh(place(angle, position.segment));
                Slice::TakeMotorMin
            }
            Slice::TakeMotorMin => {
                let min = self.motor.min;
                self.hidden()[0][1] = min;
                Slice::RenewMotorMin
            }
            Slice::RenewMotorMin => {
                self.motor.min = self.motor.fresh(place(angle, position.segment));
                Slice::Pause
            }
            // Until the load's turn.
            Slice::Pause => Slice::TakeLoadMax,
            Slice::TakeLoadMax => {
                let max = self.load.max;
                self.hidden()[1][0] = max;
                Slice::RenewLoadMax
            }
            Slice::RenewLoadMax => {
                self.load.max = self.load.fresh(place(angle, position.segment));
                Slice::TakeLoadMin
            }
            Slice::TakeLoadMin => {
                let min = self.load.min;
                self.hidden()[1][1] = min;
                Slice::RenewLoadMin
            }
            Slice::RenewLoadMin => {
                self.load.min = self.load.fresh(place(angle, position.segment));
                Slice::File
            }
            Slice::File => {
                if let Some(edge) = self.edges.get_mut(self.filed as usize & 3) {
                    *edge = self.edge;
                }
                Slice::Publish
            }
            Slice::Publish => {
                self.filed = self.filed.wrapping_add(1);
                self.other = !self.other;
                if self.good < 3 {
                    self.good += 1;
                }
                Slice::Count
            }
            Slice::Count => {
                if self.good > 1 {
                    self.cycles = self.cycles.wrapping_add(1);
                }
                Slice::Watch
            }
        };
    }

    /// State apart from the finished cycle's.
    #[inline(always)]
    fn hidden(&mut self) -> &mut Finished<N::Rank> {
        let [one, other] = &mut self.finished;
        if self.other { one } else { other }
    }

    /// Cycles that have been finished, to know a new one from the last; wraps.
    pub fn cycles(&self) -> u32 {
        self.cycles
    }

    /// An end of a cycle, so many before the latest.
    fn edge(&self, before: u32) -> &Edge<N> {
        let [first, second, third, fourth] = &self.edges;
        match self.filed.wrapping_sub(1 + before) & 3 {
            0 => first,
            1 => second,
            2 => third,
            _ => fourth,
        }
    }

    /// The cycle that was finished last. `None` until there is one since the last disturbance or change of direction,
    /// and for a cycle in which an estimated speed was no number or changed its sign.
    ///
    /// Not for the tick: it divides.
    pub fn reading(&self, config: &CycleConfig) -> Option<CycleReading<N::Real>> {
        let mean = self.mean(config)?;
        let [before, from, to] = [self.edge(2), self.edge(1), self.edge(0)];
        let (angle, period) = (N::Real::of(config.angle), N::Real::of(config.period));
        let (ticks, previous) = (to.since(from, config), angle / (from.since(before, config) * period));
        let previous = if self.forward { previous } else { -previous };
        let [first, second] = &self.finished;
        let [motor, load] = if self.other { second } else { first };
        let fluctuations = |[max, min]: &[Peak<N::Rank>; 2]| {
            let (max, min) = (self.vertex(config, max), self.vertex(config, min));
            // Negative floats are ordered the other way round.
            let [max, min] = if max.speed < min.speed { [min, max] } else { [max, min] };
            (max.speed * min.speed >= N::Real::ZERO && (max.speed - min.speed).is_finite())
                .then(|| Fluctuations::of(max, min, mean))
        };
        Some(CycleReading {
            mean,
            change: (self.good >= 3).then_some(mean - previous),
            duration: ticks * period,
            motor: fluctuations(motor)?,
            load: fluctuations(load)?,
        })
    }

    /// Mean speed by time of the cycle that was finished last (rad/s), negative backwards: input of a governor that is
    /// not to act on the ripple.
    pub fn mean(&self, config: &CycleConfig) -> Option<N::Real> {
        if self.good < 2 {
            return None;
        }
        let ticks = self.edge(0).since(self.edge(1), config);
        let mean = N::Real::of(config.angle) / (ticks * N::Real::of(config.period));
        (ticks > N::Real::ZERO && mean.is_finite()).then_some(if self.forward { mean } else { -mean })
    }

    /// The parabola's vertex through three samples.
    #[inline(never)]
    fn vertex(&self, config: &CycleConfig, peak: &Peak<N::Rank>) -> Extreme<N::Real> {
        let r = <N::Real as Real>::of;
        let cycle = r(config.angle);
        let [before, value, after] =
            [peak.before, peak.value, peak.after].map(|rank| N::of_rank(rank).real() * r(config.speed));
        let curvature = before - r(2.0) * value + after;
        let offset = if curvature == N::Real::ZERO { curvature } else { r(0.5) * (before - after) / curvature };
        let offset = offset.max(r(-1.0)).min(N::Real::ONE);
        // An estimate that cannot be does not lead out of the cycle.
        let back = (N::Real::ONE - offset) * r(SAMPLE) * r(config.period) * value;
        let back = if back.abs() < cycle { back } else { N::Real::ZERO };
        let angle = self.place(config, peak) - back;
        // Into the cycle; a motion that is none may lead beyond it by some cycles.
        let angle = angle - (angle / cycle).nearest() * cycle;
        let angle = if angle < N::Real::ZERO { angle + cycle } else { angle };
        Extreme { speed: value - r(0.25) * (before - after) * offset, angle }
    }

    /// Where in the cycle that was finished last a sample was (rad): to the turn by its segment, within it by its
    /// angle.
    fn place(&self, config: &CycleConfig, peak: &Peak<N::Rank>) -> N::Real {
        let r = <N::Real as Real>::of;
        let (from, to) = (self.edge(1), self.edge(0));
        let foot = if self.forward { from.angle.wrapping_sub(from.beyond) } else { to.angle.wrapping_add(to.beyond) };
        let segment = r(config.angle) / (N::Real::count(config.last_segment) + N::Real::ONE);
        let about = (N::Real::count(peak.place & SEGMENTS) + r(0.5)) * segment;
        let place = N::Real::count((peak.place & !SEGMENTS).wrapping_sub(foot)) * r(RADIANS);
        // whole turns, one less for the tick at a cycle's end that is found before it
        place + ((about - place) * r(1.0 / TAU)).nearest() * r(TAU)
    }
}

#[cfg(test)]
mod tests;
