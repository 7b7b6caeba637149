//! The waveform of a cycle, averaged over some cycles: each tick counts itself in the bin of its angle.
//!
//! A bin holds how many ticks fell into it and the first two moments of where in it they fell. Together they are the
//! integral of any smooth function of the angle over time: a sine of a low order is next to a parabola within a bin. So
//! the bins hold every order at once, and a tick needs no sine. All of it is in integers: the same bits in every
//! number, and no drift.
//!
//! The table is filled over a whole number of cycles, from one end of a cycle to another, and then stands until it is
//! taken between two ticks ([`Waveform::take`]). The next window begins at the next end of a cycle. Every other tick
//! also detects the end of a segment, or does a slice of its work. Its delay does no harm: a bin is found from any
//! segment near it, and a window's fractions of a cycle are known at its ends.

use super::position::{Position, Way};
use super::{Bin, Edge, Fluctuation, Summed, WaveformConfig, Window};
use crate::sample::Estimate;

/// Ticks that a window may last, so that no bin's sum of the distances overflows: 419 s at 10 kHz.
const LONGEST: u32 = 1 << 22;

/// Binary places of a bin in the upper word of an angle times the scale.
pub(crate) const PLACES: u32 = 18;

/// Where a window stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Stage {
    /// In the middle of it: ticks are counted.
    Filling,
    /// The table is empty, and no cycle has begun.
    #[default]
    Waiting,
    /// Finished, to be taken.
    Full,
    /// Disturbed, to be emptied.
    Void,
}

/// Further work of every other tick: one of these.
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
    CountUp,
    CountDown,
    Away,
    Beyond,
    NextCycle,
    CarryOn,
    Measure,
    CarryBack,
    MeasureBack,
    LastCycle,
    /// The angle was elsewhere, a tick was left out on the way here, or the motor has turned back.
    ReadingFault,
    /// Role of the cycle's end in the window.
    Decide,
    Open,
    Direction,
    Duration,
    /// Notes the end of the cycle down, and begins or ends the window by it.
    Note,
    NoteBack,
    File,
    FileFirst,
}

/// The waveform of a cycle's speed and torque over some cycles, in `BINS` bins.
///
/// ```
#[doc = include_str!("ripple.txt")]
/// const CONFIG: WaveformConfig = WaveformConfig::new::<64>(CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI), 16);
/// let mut waveform = Waveform::<64, f64>::default();
/// let window = turning().find_map(|(angle, _)| {
///     let theta = f64::from(angle) / 4_294_967_296.0 * core::f64::consts::TAU;
///     let torque = 40.0 + 10.0 * (2.0 * theta).cos(); // N m, twice a turn
///     waveform.measure(&CONFIG, angle, torque, &Estimate::default());
///     waveform.take()
/// });
/// let torque = window.map(|window| window.motor_torque(&CONFIG, 4)).unwrap_or_default();
/// assert!((torque.mean - 40.0).abs() < 0.1 && (torque.order(2).amplitude() - 10.0).abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("cyclic irregularity", "order analysis"))]
pub struct Waveform<const BINS: usize, N: Summed = f32> {
    tick: u32,
    stage: Stage,
    /// The stage that the cycle's end leads to.
    then: Stage,
    slice: Slice,
    ahead: bool,
    forward: bool,
    /// The segment's first bin.
    base: u32,
    position: Position,
    cycles: u32,
    edge: Edge<N>,
    /// The window's first end of a cycle and the second; the last of an even and of an odd number.
    edges: [Edge<N>; 4],
    bins: [Bin<N>; BINS],
}

impl<N: Summed, const BINS: usize> Default for Waveform<BINS, N> {
    fn default() -> Self {
        const { assert!(BINS.is_power_of_two(), "the bins of a waveform must be a power of two") };
        Waveform {
            tick: 0,
            stage: Stage::Waiting,
            then: Stage::Waiting,
            slice: Slice::Begin,
            ahead: true,
            forward: true,
            base: 0,
            position: Position::default(),
            cycles: 0,
            edge: Edge::default(),
            edges: [Edge::default(); 4],
            bins: [Bin::default(); BINS],
        }
    }
}

impl<N: Summed, const BINS: usize> Fluctuation<N> for Waveform<BINS, N> {
    type Config = WaveformConfig;

    #[inline(always)]
    fn measure(&mut self, config: &WaveformConfig, angle: u32, torque: N, estimate: &Estimate<N>) {
        let tick = self.next_tick();
        if tick & 1 != 0 {
            self.slice(config, angle, tick, estimate);
        }
        self.fill(config, angle, torque);
    }

    fn disturb(&mut self) {
        self.position.is_sure = false;
        self.give_up();
    }
}

impl<N: Summed, const BINS: usize> Waveform<BINS, N> {
    fn give_up(&mut self) {
        if self.stage == Stage::Filling {
            self.stage = Stage::Void;
        }
        self.reconsider(Slice::Watch);
    }

    /// The pending decision on a cycle's end is void.
    fn reconsider(&mut self, slice: Slice) {
        if let Slice::Open | Slice::Direction | Slice::Duration | Slice::Note | Slice::NoteBack = self.slice {
            self.slice = slice;
        }
    }

    /// The number of the tick that begins.
    #[inline(always)]
    pub(super) fn next_tick(&mut self) -> u32 {
        self.tick = self.tick.wrapping_add(1);
        self.tick
    }

    /// Counts a tick, while a window is being filled.
    #[inline(always)]
    pub(super) fn fill(&mut self, config: &WaveformConfig, angle: u32, torque: N) {
        if self.stage == Stage::Filling {
            self.count(config, self.position.within(angle), torque);
        }
    }

    /// Whether no end of a segment is being dealt with.
    #[inline(always)]
    pub(super) fn is_watching(&self) -> bool {
        self.slice == Slice::Watch
    }

    /// A tick so far from the segment's start (2^-32 turn), a little before it or beyond its end included.
    #[inline(always)]
    fn count(&mut self, config: &WaveformConfig, within: u32, torque: N) {
        let place = ((i64::from(within as i32) * i64::from(config.scale)) >> 32) as i32;
        let index = self.base.wrapping_add((place >> PLACES) as u32) as usize & BINS.wrapping_sub(1);
        if let Some(bin) = self.bins.get_mut(index) {
            // The distance from the bin's middle [2^-32 bin].
            let distance = (place << (32 - PLACES)) ^ i32::MIN;
            let coarse = distance >> 24;
            bin.ticks = bin.ticks.wrapping_add(1);
            bin.first = bin.first.wrapping_add(distance >> 22);
            bin.second = bin.second.wrapping_add((coarse * coarse) as u32);
            bin.torque = torque.added_to(bin.torque);
        }
    }

    /// One slice of the work at the end of a segment or of a cycle.
    #[inline(always)]
    pub(super) fn slice(&mut self, config: &WaveformConfig, angle: u32, tick: u32, estimate: &Estimate<N>) {
        let cycle = &config.cycle;
        let position = &mut self.position;
        self.slice = match self.slice {
            Slice::Watch => {
                if position.within(angle) < cycle.length {
                    return;
                }
                Slice::Ahead
            }
            Slice::Begin => {
                position.measure(cycle);
                Slice::Watch
            }
            Slice::Ahead if !position.is_sure => Slice::Away,
            Slice::Ahead => match position.ahead(cycle, position.within(angle).wrapping_sub(cycle.length)) {
                Way::Segment => Slice::Advance,
                Way::Cycle => Slice::Beyond,
                Way::Other => Slice::Behind,
            },
            Slice::Behind => match position.behind(cycle, position.within(angle).wrapping_neg()) {
                Way::Segment => Slice::Retreat,
                Way::Cycle => Slice::CarryBack,
                Way::Other => Slice::Away,
            },
            Slice::Advance => {
                position.advance(cycle);
                self.base = self.base.wrapping_add(config.per_segment);
                Slice::CountUp
            }
            Slice::Retreat => {
                position.retreat(cycle);
                self.base = self.base.wrapping_sub(config.per_segment);
                Slice::CountDown
            }
            Slice::CountUp => {
                position.count(1);
                if self.forward { Slice::Watch } else { Slice::ReadingFault }
            }
            Slice::CountDown => {
                position.count(-1);
                if self.forward { Slice::ReadingFault } else { Slice::Watch }
            }
            Slice::Away => {
                position.jump(cycle, Position::away(cycle, position.within(angle)));
                self.base = position.segment.wrapping_mul(config.per_segment);
                Slice::ReadingFault
            }
            Slice::Beyond => {
                let beyond = position.beyond_cycle(position.within(angle).wrapping_sub(cycle.length));
                if beyond < 0 { Slice::Watch } else { Slice::NextCycle }
            }
            Slice::NextCycle => {
                position.next_cycle(cycle);
                self.base = 0;
                Slice::CarryOn
            }
            Slice::CarryOn => {
                position.carry_on(cycle);
                self.ahead = true;
                Slice::Measure
            }
            Slice::Measure => {
                position.measure(cycle);
                Slice::Decide
            }
            Slice::CarryBack => {
                position.carry_back(cycle);
                Slice::MeasureBack
            }
            Slice::MeasureBack => {
                position.measure(cycle);
                self.ahead = false;
                Slice::LastCycle
            }
            Slice::LastCycle => {
                position.last_cycle(cycle);
                self.base = (BINS as u32).wrapping_sub(config.per_segment);
                Slice::Decide
            }
            Slice::ReadingFault => {
                position.is_sure = true;
                if self.stage == Stage::Filling {
                    self.stage = Stage::Void;
                }
                Slice::Watch
            }
            Slice::Decide => match self.stage {
                Stage::Waiting => Slice::Open,
                Stage::Filling => Slice::Direction,
                Stage::Full | Stage::Void => Slice::Watch,
            },
            Slice::Open => {
                self.forward = self.ahead;
                self.cycles = u32::MAX;
                self.then = Stage::Filling;
                if self.ahead { Slice::Note } else { Slice::NoteBack }
            }
            Slice::Direction => {
                self.then = if self.ahead == self.forward { Stage::Filling } else { Stage::Void };
                Slice::Duration
            }
            Slice::Duration => {
                let long = tick.wrapping_sub(self.edges[0].tick) > LONGEST / 2;
                if self.then == Stage::Filling && (long || self.cycles.wrapping_add(1) >= config.cycles) {
                    self.then = Stage::Full;
                }
                if self.ahead { Slice::Note } else { Slice::NoteBack }
            }
            // The motor has turned back meanwhile.
            Slice::Note if (position.within(angle) as i32) < 0 => Slice::ReadingFault,
            Slice::Note => {
                self.edge = Edge { tick, angle, beyond: position.within(angle), speed: estimate.motor_speed };
                self.stage = self.then;
                Slice::File
            }
            Slice::NoteBack => {
                let beyond = position.behind_end(cycle, position.within(angle));
                if (beyond as i32) < 0 {
                    Slice::ReadingFault
                } else {
                    self.edge = Edge { tick, angle, beyond, speed: estimate.motor_speed };
                    self.stage = self.then;
                    Slice::File
                }
            }
            Slice::File => {
                self.cycles = self.cycles.wrapping_add(1);
                if let Some(last) = self.edges.get_mut(2 + (self.cycles as usize & 1)) {
                    *last = self.edge;
                }
                Slice::FileFirst
            }
            Slice::FileFirst => {
                if let Some(early) = self.edges.get_mut(self.cycles as usize)
                    && self.cycles < 2
                {
                    *early = self.edge;
                }
                Slice::Watch
            }
        };
    }

    /// Takes a finished window and lets the next one begin; `None` while there is none. To be called between two ticks;
    /// it copies and empties the table, and it must be called now and then also for a window that was disturbed to be
    /// given up.
    pub fn take(&mut self) -> Option<Window<N, BINS>> {
        // While an end is being filed the window is not complete.
        if let Slice::File | Slice::FileFirst = self.slice {
            return None;
        }
        let [first, second, even, odd] = self.edges;
        let [before, last] = if self.cycles & 1 == 0 { [odd, even] } else { [even, odd] };
        let longest = |from: &Edge<N>, to: u32| to.wrapping_sub(from.tick) > LONGEST;
        if (self.stage == Stage::Filling && longest(&last, self.tick))
            || (self.stage == Stage::Full && longest(&first, last.tick))
        {
            self.stage = Stage::Void;
        }
        let window = match self.stage {
            Stage::Full => Some(Window {
                bins: self.bins,
                edges: [first, second, before, last],
                cycles: self.cycles,
                forward: self.forward,
            }),
            Stage::Void => None,
            Stage::Waiting | Stage::Filling => return None,
        };
        self.bins = [Bin::default(); BINS];
        self.stage = Stage::Waiting;
        self.reconsider(Slice::Decide);
        window
    }
}

#[cfg(test)]
mod tests;
