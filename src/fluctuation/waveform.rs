//! The waveform of a cycle, averaged over some cycles: each tick counts itself in the bin of its angle.
//!
//! A bin holds how many ticks fell into it and the first two moments of where in it they fell. Together they are the integral of any smooth
//! function of the angle over time: a sine of a low order is next to a parabola within a bin. So the bins hold every order at once, and a
//! tick needs no sine. All of it is in integers: the same bits in every number, and no drift.
//!
//! The table is filled over a whole number of cycles, from one end of a cycle to another, and then stands until it is taken between two
//! ticks ([`Waveform::take`]). The next window begins at the next end of a cycle.

use super::position::{Crossing, Position};
use super::{CycleConfig, Edge, Fluctuation, Window};
use crate::number::Number;
use crate::sample::Estimate;

/// Ticks that a window may last, so that no bin overflows: 419 s at 10 kHz.
const LONGEST: u32 = 1 << 22;

/// Constants of [`Waveform`]. Made by [`crate::constants`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WaveformConfig {
    /// The cycle.
    pub cycle: CycleConfig,
    /// Cycles in a window; fewer where they last too long.
    pub cycles: u32,
    /// Bins per 2^-32 turn [2^-32].
    pub scale: u32,
    /// Bins in a segment of the cycle.
    pub per_segment: u32,
}

/// What has fallen into a bin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bin {
    /// Ticks.
    pub ticks: u32,
    /// Sum of their distances from the bin's middle [2^-10 bin].
    pub first: i32,
    /// Sum of the squares of their distances from the bin's middle [2^-12 bin2].
    pub second: u32,
}

/// Where a window stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Stage {
    /// The table is empty, and no cycle has begun.
    #[default]
    Waiting,
    /// In the middle of it.
    Filling,
    /// Finished, to be taken.
    Full,
    /// Disturbed, to be emptied.
    Void,
}

/// The waveform of a cycle's speed and torque over some cycles, in `BINS` bins.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Waveform<N, const BINS: usize> {
    position: Position,
    tick: u32,
    /// The segment's first bin; beyond the table while nothing is to be counted.
    base: usize,
    stage: Stage,
    forward: bool,
    cycles: u32,
    /// The window's first end of a cycle, the second, the last but one, the last.
    edges: [Edge<N>; 4],
    bins: [Bin; BINS],
    torque: [N; BINS],
}

impl<N: Number, const BINS: usize> Default for Waveform<N, BINS> {
    fn default() -> Self {
        Waveform {
            position: Position::default(),
            tick: 0,
            base: BINS,
            stage: Stage::Waiting,
            forward: true,
            cycles: 0,
            edges: [Edge::default(); 4],
            bins: [Bin::default(); BINS],
            torque: [N::ZERO; BINS],
        }
    }
}

impl<N: Number, const BINS: usize> Fluctuation<N> for Waveform<N, BINS> {
    type Config = WaveformConfig;

    #[inline(always)]
    fn measure(&mut self, config: &WaveformConfig, angle: u32, torque: N, estimate: &Estimate<N>) {
        self.tick = self.tick.wrapping_add(1);
        let within = self.position.within(angle);
        if within >= config.cycle.length {
            self.pass(config, angle, estimate.motor_speed);
            return;
        }
        let (index, distance) = self.place(config, within);
        if let (Some(bin), Some(mean)) = (self.bins.get_mut(index), self.torque.get_mut(index)) {
            if bin.ticks == 0 {
                *mean = torque;
            }
            bin.count(distance);
            *mean = mean.plus(torque.minus(*mean).sixteenth());
        }
    }

    fn disturb(&mut self) {
        self.position.interrupt();
        self.give_up();
    }
}

impl<N: Number, const BINS: usize> Waveform<N, BINS> {
    fn give_up(&mut self) {
        if self.stage == Stage::Filling {
            self.stage = Stage::Void;
        }
        self.base = BINS;
    }
}

impl Bin {
    /// A tick at this distance from the bin's middle [2^-32 bin].
    #[inline(always)]
    fn count(&mut self, distance: i32) {
        let coarse = distance >> 26;
        self.ticks = self.ticks.wrapping_add(1);
        self.first = self.first.wrapping_add(distance >> 22);
        self.second = self.second.wrapping_add((coarse * coarse) as u32);
    }
}

impl<N: Number, const BINS: usize> Waveform<N, BINS> {
    /// The bin, and the distance from its middle [2^-32 bin], so far within the segment.
    #[inline(always)]
    fn place(&self, config: &WaveformConfig, within: u32) -> (usize, i32) {
        let place = u64::from(within) * u64::from(config.scale);
        (self.base.wrapping_add((place >> 32) as usize), (place as u32 ^ 1 << 31) as i32)
    }

    /// A tick that ends a segment or a cycle; its torque is not looked at.
    #[cold]
    #[inline(never)]
    fn pass(&mut self, config: &WaveformConfig, angle: u32, speed: N) {
        match self.position.pass(&config.cycle, angle) {
            Crossing::Within => {}
            Crossing::Lost => self.give_up(),
            Crossing::Cycle { beyond, forward } => {
                self.end(config, Edge { tick: self.tick, beyond, speed }, forward);
            }
        }
        self.base = match self.stage {
            Stage::Filling => (self.position.segment * config.per_segment) as usize,
            Stage::Waiting | Stage::Full | Stage::Void => BINS,
        };
        let (index, distance) = self.place(config, self.position.within(angle));
        if let Some(bin) = self.bins.get_mut(index) {
            bin.count(distance);
        }
    }

    /// The end of a cycle.
    fn end(&mut self, config: &WaveformConfig, edge: Edge<N>, forward: bool) {
        let [first, second, last_but_one, last] = &mut self.edges;
        match self.stage {
            Stage::Waiting => {
                self.stage = Stage::Filling;
                self.forward = forward;
                self.cycles = 0;
                *first = edge;
                *last = edge;
            }
            Stage::Filling if forward == self.forward => {
                if self.cycles == 0 {
                    *second = edge;
                }
                *last_but_one = *last;
                *last = edge;
                self.cycles = self.cycles.wrapping_add(1);
                let ticks = edge.tick.wrapping_sub(first.tick);
                if ticks > LONGEST {
                    self.stage = Stage::Void;
                } else if self.cycles >= config.cycles || ticks > LONGEST / 2 {
                    self.stage = Stage::Full;
                }
            }
            Stage::Filling => self.stage = Stage::Void,
            Stage::Full | Stage::Void => {}
        }
    }

    /// Takes a finished window and lets the next one begin; `None` while there is none. To be called between two ticks; it copies and empties
    /// the table, and it must be called now and then also for a window that was disturbed to be given up.
    pub fn take(&mut self) -> Option<Window<N, BINS>> {
        let stale = self.stage == Stage::Filling && self.tick.wrapping_sub(self.edges[3].tick) > LONGEST;
        if stale {
            self.stage = Stage::Void;
        }
        let window = match self.stage {
            Stage::Full => Some(Window {
                bins: self.bins,
                torque: self.torque,
                edges: self.edges,
                cycles: self.cycles,
                forward: self.forward,
            }),
            Stage::Void => None,
            Stage::Waiting | Stage::Filling => return None,
        };
        self.bins = [Bin::default(); BINS];
        self.stage = Stage::Waiting;
        self.base = BINS;
        window
    }
}
