//! What the task makes of its readings: the next move, a verdict, or a wait.

use super::{BalancingFault, BalancingState, BalancingTask, Phase};
use crate::balancing::Phasors;
use crate::balancing::head::{BalancingHead, HeadPosition};
use crate::balancing::in_run::{AbortReason, Action, BalancingRecord, InRun};
use crate::balancing::memory::BalancingMemory;
use crate::balancing::reading::{PhasorsConfig, ReadingFault, Steadiness};
use crate::balancing::scalar::{Complex, size, zero};
use crate::balancing::tolerance::Verdict;
use crate::configure::{HasVibration, VibrationNumber};

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
impl<M, H, K, const ROWS: usize, const PLANES: usize> BalancingTask<M, H, K, ROWS, PLANES>
where
    M: HasVibration,
    H: BalancingHead<PLANES>,
    K: BalancingMemory<ROWS, PLANES>,
{
    pub(super) fn complete<N: VibrationNumber, const EDGES: usize>(
        &mut self,
        config: &PhasorsConfig<N, ROWS>,
        phasors: &Phasors<ROWS, EDGES, N>,
    ) -> Result<(), BalancingFault<H::Error, K::Error>> {
        if let HeadPosition::At(at) = self.position()?
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
