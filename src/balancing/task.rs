//! Balancing by itself: a task of the main loop that reads, moves a head, confirms, judges, holds and remembers.
//!
//! [`BalancingTask::run`] is called at any rate. It begins each reading itself, after the head has arrived and the
//! vibration has settled. A reading is used once, with the largest variance of all channels and the speed that it was
//! taken at. [`InRun`] decides the moves.
//!
//! # When it begins
//! At power-up the head goes to the weights of the record: the best ones, or those that it began with. Without a record
//! it stays where it is, or goes to zero if it has no sensor. The task waits for steady readings between half of the
//! service speed and 1.1 times. Another speed by more than 5 % begins anew, since the influence is another.
//!
//! # When it goes back
//! The head goes back to those weights when the rotor stops, the sensor clips, eight readings in a row are refused,
//! or [`InRun`] aborts.
//!
//! # When it ends
//! At [`BalancingState::Held`] it goes on reading. Two readings in a row that are half as large again as at first, and
//! beyond the tolerance, are a change of the rotor: balancing begins again.

mod design;
mod state;

use core::marker::PhantomData;

pub use design::{BalancingDesign, BalancingDesignError};
pub use state::{BalancingFault, BalancingState};

use super::Phasors;
use super::head::{BalancingHead, HeadPosition};
use super::in_run::{AbortReason, Action, BalancingRecord, InRun, InRunConfig};
use super::memory::BalancingMemory;
use super::reading::{PhasorsConfig, ReadingFault, Steadiness};
use super::scalar::{Complex, size, zero};
use super::tolerance::Verdict;
use crate::configure::{HasVibration, VibrationNumber};
use crate::drive::{ConfigOf, Drive};
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::Part;
use crate::observer::Observer;

/// Deviation from the speed of the readings beyond which balancing begins anew.
const SPEED_BAND: f32 = 0.05;
/// Limits of a reading: a slow swing of the speed hardly changes a vibration, and the variance counts in each move.
const STEADINESS: Steadiness = Steadiness { speed: 0.05, drift: 0.1, scatter: 0.1, floor: 0.0 };
/// Share of the first vibration below which drift and scatter are taken of it: a balanced rotor's reading is noise.
const FLOOR: f32 = 0.3;
/// Readings in a row that are refused before the head goes back.
const DOUBTS: u32 = 8;
/// Good readings after an abort before it is tried again, and how often.
const REST: u32 = 6;
const RETRIES: u32 = 3;
/// Growth of the vibration that is a change of the rotor, and readings that show it.
const CHANGED: f32 = 1.5;
const CHANGES: u32 = 2;
/// Share of the capacity within which a head is at its weights.
const NEAR: f32 = 0.01;
/// Moves of a head without a sensor that may show no effect before that is believed; commands at power-up.
const MISSED: u32 = 6;
const COMMANDS: u32 = 3;
/// Standard deviations that a reading has to change by to show a move.
const SHOWN: f32 = 3.0;
/// Share of the predicted change that a reading has to change by.
const FOLLOWED: f32 = 0.4;
/// Least standard deviation of a change, over the level.
const LEAST: f32 = 0.001;
/// Calls without a tick.
const CALLS: u32 = 1_000_000;

/// Where the work stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase<const PLANES: usize> {
    /// Power is on.
    Start,
    /// The head is to be commanded.
    Command([Complex<f32>; PLANES]),
    Moving([Complex<f32>; PLANES]),
    Settling,
    Reading,
}

/// The measurement as it is copied between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: only the task reads it.
pub struct Look<N: VibrationNumber, const ROWS: usize, const EDGES: usize> {
    ticks: u32,
    complete: Option<Phasors<ROWS, EDGES, N>>,
}

/// A rotor that is balanced while it turns: of the machine `M`, by the head `H`, remembered by `K`.
#[derive(Clone, Debug)]
// Not logged: holds the head and the memory.
pub struct BalancingTask<M, H, K, const ROWS: usize = 2, const PLANES: usize = 1> {
    design: BalancingDesign<PLANES>,
    moves: InRunConfig<f32, PLANES>,
    head: H,
    memory: K,
    in_run: InRun<f32, ROWS, PLANES>,
    phase: Phase<PLANES>,
    /// A reading, or a wait, is to begin.
    begin: bool,
    /// Ticks at the last look, and calls since they changed.
    ticks: u32,
    calls: u32,
    state: BalancingState,
    /// Whether something is to be remembered, and what was last.
    dirty: bool,
    record: BalancingRecord<ROWS, PLANES>,
    /// The rotor stood, or readings failed: the influence has to be confirmed again.
    interrupted: bool,
    /// Level at which it holds, in the unit of the sensors.
    held: Option<f32>,
    doubts: u32,
    changes: u32,
    /// The last good reading, and the weights that it was taken with.
    last: Option<([Complex<f32>; ROWS], [Complex<f32>; PLANES])>,
    /// Whether the head has a sensor; moves that showed no effect; commands to repeat.
    measured: bool,
    missed: u32,
    repeats: u32,
    /// Readings until it is tried again; attempts.
    rest: u32,
    retries: u32,
    machine: PhantomData<fn() -> M>,
}

impl<M, H, K, const ROWS: usize, const PLANES: usize> BalancingTask<M, H, K, ROWS, PLANES>
where
    M: HasVibration,
    H: BalancingHead<PLANES>,
    K: BalancingMemory<ROWS, PLANES>,
{
    /// A task that goes on from what `memory` has kept. The head is not moved here.
    ///
    /// # Errors
    /// A value of the design out of its range; the memory cannot be read.
    pub fn new(
        design: BalancingDesign<PLANES>,
        head: H,
        mut memory: K,
    ) -> Result<Self, BalancingFault<H::Error, K::Error>> {
        const { assert!(ROWS > 0 && PLANES > 0, "a sensor and a plane are needed") };
        const { assert!(M::PHASORS.order == 1, "the task needs the order 1: the vibration at the rotor's own speed") };
        let moves = design.moves().map_err(BalancingFault::Design)?;
        let record = memory.load().map_err(BalancingFault::Memory)?;
        let within = |record: &BalancingRecord<ROWS, PLANES>| {
            record.weights.iter().zip(&design.capacity).all(|(weight, most)| size(*weight) <= *most)
        };
        let kept = record.filter(within).and_then(|record| Some((InRun::remembered(moves, &record).ok()?, record)));
        let known = kept.is_some();
        let (in_run, record) = match kept {
            Some(kept) => kept,
            None => match InRun::new(moves, ROWS, [zero(); PLANES]) {
                Ok(in_run) => (in_run, BalancingRecord::new([zero(); PLANES])),
                Err(_) => return Err(BalancingFault::Design(BalancingDesignError::Capacity)),
            },
        };
        Ok(BalancingTask {
            design,
            moves,
            head,
            memory,
            in_run,
            phase: Phase::Start,
            begin: true,
            ticks: 0,
            calls: 0,
            state: BalancingState::Moving,
            dirty: !known,
            record,
            interrupted: false,
            held: None,
            doubts: 0,
            changes: 0,
            last: None,
            measured: true,
            missed: 0,
            repeats: 0,
            rest: 0,
            retries: 0,
            machine: PhantomData,
        })
    }

    /// One call of the main loop, at any rate. A drive whose ticks interrupt the main loop is given to
    /// [`BalancingTask::look`] between two ticks, and the look to [`BalancingTask::proceed`].
    ///
    /// # Errors
    /// Head or memory failed, or there are no samples; the next call goes on.
    pub fn run<N, O, G, F, B, const EDGES: usize>(
        &mut self,
        drive: &mut Drive<N, O, G, F, B>,
        config: &ConfigOf<Drive<N, O, G, F, B>>,
    ) -> Result<BalancingState, BalancingFault<H::Error, K::Error>>
    where
        N: VibrationNumber,
        O: Part<N, State: Observer<N>>,
        G: Part<N, State: Governor<N>>,
        F: Part<N, State: Fluctuation<N>>,
        B: Part<N, State = Phasors<ROWS, EDGES, N>>,
    {
        let look = self.look(drive.balancer_mut());
        self.proceed(&config.balancer, &look)
    }

    /// Begins a reading or copies a complete one: between two ticks, and short.
    pub fn look<N: VibrationNumber, const EDGES: usize>(
        &mut self,
        phasors: &mut Phasors<ROWS, EDGES, N>,
    ) -> Look<N, ROWS, EDGES> {
        if core::mem::take(&mut self.begin) {
            phasors.begin();
        }
        let complete = phasors.is_complete() && self.phase == Phase::Reading;
        Look { ticks: phasors.ticks(), complete: complete.then_some(*phasors) }
    }

    /// What takes longer than a tick: the calculations, the head, the memory.
    ///
    /// # Errors
    /// As [`BalancingTask::run`].
    pub fn proceed<N: VibrationNumber, const EDGES: usize>(
        &mut self,
        config: &PhasorsConfig<N, ROWS>,
        look: &Look<N, ROWS, EDGES>,
    ) -> Result<BalancingState, BalancingFault<H::Error, K::Error>> {
        self.calls = if look.ticks == self.ticks { self.calls.saturating_add(1) } else { 0 };
        self.ticks = look.ticks;
        if self.calls > CALLS {
            return Err(BalancingFault::NoVibration);
        }
        match self.phase {
            Phase::Start => self.start()?,
            Phase::Command(to) => {
                // what the head goes back to is kept before it moves
                let kept = self.keep();
                self.head.set(&to).map_err(BalancingFault::Head)?;
                self.phase = Phase::Moving(to);
                self.begin = true;
                kept?;
            }
            Phase::Moving(to) => self.moving(to, look.ticks)?,
            Phase::Settling => {
                if look.ticks as f32 >= self.design.settle * M::RATE_HZ as f32 {
                    self.read();
                }
            }
            Phase::Reading => {
                if let Some(complete) = &look.complete {
                    self.complete(config, complete)?;
                } else if look.ticks as f32 > Self::patience(config, EDGES, self.design.rotor.speed) {
                    self.state = BalancingState::OffSpeed;
                    self.interrupt();
                }
            }
        }
        Ok(self.state)
    }

    /// What it does.
    pub fn state(&self) -> BalancingState {
        self.state
    }

    /// The weights that the head stands at or goes to (kg m).
    pub fn weights(&self) -> &[Complex<f32>; PLANES] {
        self.in_run.weights()
    }

    /// The head.
    pub fn head(&mut self) -> &mut H {
        &mut self.head
    }

    /// Head and memory again.
    pub fn release(self) -> (H, K) {
        (self.head, self.memory)
    }

    /// Ticks of a reading at half of the service speed, and half as many again.
    fn patience<N: VibrationNumber>(config: &PhasorsConfig<N, ROWS>, edges: usize, speed: f32) -> f32 {
        let turns = config.block as f32 * edges as f32;
        1.5 * turns * core::f32::consts::TAU * M::RATE_HZ as f32 / (0.5 * speed)
    }

    /// Keeps what has changed, once.
    fn keep(&mut self) -> Result<(), BalancingFault<H::Error, K::Error>> {
        if core::mem::take(&mut self.dirty) {
            return self.memory.save(&self.record).map_err(BalancingFault::Memory);
        }
        Ok(())
    }

    /// Power is on: to the weights of the record, or where the head stands.
    fn start(&mut self) -> Result<(), BalancingFault<H::Error, K::Error>> {
        match self.head.position().map_err(BalancingFault::Head)? {
            HeadPosition::Moving => {}
            HeadPosition::At(at) if self.dirty => {
                self.record.weights = at;
                if let Ok(in_run) = InRun::new(self.moves, ROWS, at) {
                    self.in_run = in_run;
                }
                self.arrive();
                self.keep()?;
            }
            HeadPosition::At(at) if self.near(&at, &self.record.weights) => self.arrive(),
            HeadPosition::At(_) => self.phase = Phase::Command(self.record.weights),
            HeadPosition::Unmeasured => {
                // a command that is missed now would show in no reading
                self.repeats = COMMANDS - 1;
                self.phase = Phase::Command(self.record.weights);
            }
        }
        Ok(())
    }

    /// Whether weights are the same, within a hundredth of the capacity.
    fn near(&self, a: &[Complex<f32>; PLANES], b: &[Complex<f32>; PLANES]) -> bool {
        let pairs = a.iter().zip(b).zip(&self.design.capacity);
        pairs.fold(true, |near, ((a, b), capacity)| near && size(*a - *b) <= NEAR * capacity)
    }

    fn moving(&mut self, to: [Complex<f32>; PLANES], ticks: u32) -> Result<(), BalancingFault<H::Error, K::Error>> {
        self.state = BalancingState::Moving;
        let late = ticks as f32 > self.design.travel * M::RATE_HZ as f32;
        let position = self.head.position().map_err(BalancingFault::Head)?;
        self.measured = position != HeadPosition::Unmeasured;
        match position {
            HeadPosition::At(at) if self.near(&at, &to) => self.arrive(),
            HeadPosition::At(at) if late => {
                // it has stuck: what it stands at counts
                self.in_run.installed(&at);
                self.state = BalancingState::HeadStuck;
                self.arrive();
            }
            HeadPosition::Moving if late => {
                self.state = BalancingState::HeadStuck;
                self.phase = Phase::Command(to);
            }
            HeadPosition::Unmeasured if late && self.repeats > 0 => {
                self.repeats -= 1;
                self.phase = Phase::Command(to);
            }
            HeadPosition::Unmeasured if late => self.arrive(),
            _ => {}
        }
        Ok(())
    }

    fn arrive(&mut self) {
        self.phase = Phase::Settling;
        self.begin = true;
    }

    fn read(&mut self) {
        self.phase = Phase::Reading;
        self.begin = true;
    }

    /// To other weights, or another reading with the same.
    fn go(&mut self, to: [Complex<f32>; PLANES], from: [Complex<f32>; PLANES]) {
        if to == from {
            self.read();
        } else {
            self.in_run.installed(&to);
            self.phase = Phase::Command(to);
        }
    }

    /// Back to the weights of the record; what is known has to be confirmed again.
    fn interrupt(&mut self) {
        self.interrupted = true;
        self.doubts = 0;
        let from = *self.in_run.weights();
        self.go(self.record.weights, from);
    }

    fn complete<N: VibrationNumber, const EDGES: usize>(
        &mut self,
        config: &PhasorsConfig<N, ROWS>,
        phasors: &Phasors<ROWS, EDGES, N>,
    ) -> Result<(), BalancingFault<H::Error, K::Error>> {
        let position = self.head.position().map_err(BalancingFault::Head)?;
        if let HeadPosition::At(at) = position
            && !self.near(&at, self.in_run.weights())
        {
            // the head has moved by itself, or the stuck one has come loose
            self.in_run.installed(&at);
            self.arrive();
            return Ok(());
        }
        let unit = N::vibration_unit::<M>();
        let steadiness = Steadiness { floor: FLOOR * self.in_run.first_level() / unit, ..STEADINESS };
        let (mut rows, mut variance, mut ticks) = ([zero(); ROWS], 0.0_f32, 0.0);
        for (row, value) in rows.iter_mut().enumerate() {
            match phasors.reading_within(config, row, &steadiness) {
                Ok(reading) => {
                    *value = Complex::from(reading.phasor.scaled(unit));
                    variance = variance.max(reading.variance * unit * unit);
                    ticks = reading.ticks;
                }
                Err(fault) => {
                    self.doubt(fault);
                    return Ok(());
                }
            }
        }
        self.doubts = 0;
        self.take(&rows, variance, core::f32::consts::TAU * M::RATE_HZ as f32 / ticks);
        if matches!(self.phase, Phase::Reading) { self.keep() } else { Ok(()) }
    }

    /// A refused reading.
    fn doubt(&mut self, fault: ReadingFault) {
        self.state = BalancingState::Waiting(fault);
        self.doubts += 1;
        if self.doubts < DOUBTS && fault != ReadingFault::Clipped {
            return self.read();
        }
        if *self.in_run.weights() != self.record.weights {
            self.state = BalancingState::Stopped(AbortReason::NoReading);
            (self.rest, self.retries) = (REST, self.retries + 1);
        }
        self.interrupt();
    }

    /// A good reading at a speed (rad/s).
    fn take(&mut self, reading: &[Complex<f32>; ROWS], variance: f32, speed: f32) {
        let share = speed / self.design.rotor.speed;
        if !(0.5..=1.1).contains(&share) {
            self.state = BalancingState::OffSpeed;
            return self.interrupt();
        }
        self.look_for_effect(reading, variance);
        let from = *self.in_run.weights();
        let off = self.record.speed > 0.0 && !((speed / self.record.speed - 1.0).abs() <= SPEED_BAND);
        if (off || self.interrupted) && from != self.record.weights {
            return self.interrupt();
        }
        if off || self.record.speed == 0.0 {
            // the influence is that of another speed
            if off && let Ok(in_run) = InRun::new(self.moves, ROWS, from) {
                self.in_run = in_run;
            }
            self.record = BalancingRecord { speed, ..BalancingRecord::new(from) };
            (self.held, self.rest, self.retries, self.interrupted) = (None, 0, 0, false);
        }
        let level = reading.iter().fold(0.0_f32, |most, value| most.max(size(*value)));
        if core::mem::take(&mut self.interrupted) {
            self.resume();
        }
        if let Some(held) = self.held {
            let verdict = self.verdict(reading);
            if !matches!(self.state, BalancingState::Stopped(_)) || verdict.is_some_and(|verdict| verdict.passed) {
                self.state = BalancingState::Held(verdict);
            }
            let worse =
                level > (CHANGED * held).max(self.design.quiet) && !verdict.is_some_and(|verdict| verdict.passed);
            self.changes = if worse { self.changes + 1 } else { 0 };
            if self.changes < CHANGES {
                return self.read();
            }
            (self.held, self.changes, self.retries) = (None, 0, 0);
            self.resume();
        }
        if self.rest > 0 {
            self.rest -= 1;
            if self.rest > 0 {
                return self.read();
            }
            if self.retries > RETRIES {
                self.held = Some(level);
                return self.read();
            }
            self.resume();
        }
        self.state = BalancingState::Measuring;
        if level <= self.design.quiet && self.in_run.level().is_none() {
            return self.hold(level, reading);
        }
        match self.in_run.advise_at(reading, variance, speed) {
            Action::Set(to) => {
                let home = self.in_run.home();
                if home != self.record.weights {
                    self.record.weights = home;
                    self.dirty = true;
                }
                self.go(to, from);
            }
            Action::Hold => self.hold(level, reading),
            Action::Abort(to, reason) => {
                self.state = BalancingState::Stopped(reason);
                (self.rest, self.retries) = (REST, self.retries + 1);
                self.remember(to);
                self.go(to, from);
            }
        }
    }

    /// A head without a sensor has missed a command that shows no effect: it stands where it stood.
    fn look_for_effect(&mut self, reading: &[Complex<f32>; ROWS], variance: f32) {
        let to = *self.in_run.weights();
        if let Some((last, from)) = self.last.filter(|(_, from)| !self.measured && *from != to) {
            let pairs = || reading.iter().zip(&last);
            let change = pairs().fold(0.0_f32, |most, (now, last)| most.max(size(*now - *last)));
            let level = pairs().fold(0.0_f32, |most, (now, last)| most.max(size(*now)).max(size(*last)));
            let noise = (2.0 * variance).max(LEAST * LEAST * level * level);
            let predicted = self.in_run.predicted_change(&from, &to);
            let shown = change * change >= SHOWN * SHOWN * noise && change >= FOLLOWED * predicted;
            if !shown && self.missed < MISSED {
                self.missed += 1;
                self.state = BalancingState::HeadStuck;
                self.in_run.installed(&from);
            } else {
                self.missed = 0;
            }
        }
        self.last = Some((*reading, *self.in_run.weights()));
    }

    fn resume(&mut self) {
        let from = *self.in_run.weights();
        self.in_run.resume(&from);
    }

    fn hold(&mut self, level: f32, reading: &[Complex<f32>; ROWS]) {
        self.held = Some(level);
        self.state = BalancingState::Held(self.verdict(reading));
        self.remember(*self.in_run.weights());
        self.read();
    }

    fn remember(&mut self, weights: [Complex<f32>; PLANES]) {
        self.record = BalancingRecord { weights, ..self.in_run.record(self.record.speed) };
        self.dirty = true;
    }

    /// The residual unbalance by a reading, judged by ISO 21940-11.
    fn verdict(&self, reading: &[Complex<f32>; ROWS]) -> Option<Verdict<f32>> {
        self.design.rotor.judge(self.in_run.residual(reading)?).ok()
    }
}
