//! How the task moves its head, and sees that it has moved.

use super::{BalancingFault, BalancingState, BalancingTask, Phase};
use crate::balancing::head::{BalancingHead, HeadPosition};
use crate::balancing::memory::BalancingMemory;
use crate::balancing::scalar::{Complex, size};
use crate::configure::HasVibration;

/// Moves of a head without a sensor that may show no effect before that is believed.
const MISSED: u32 = 6;
/// Standard deviations that a reading has to change by to show a move.
const SHOWN: f32 = 3.0;
/// Share of the predicted change that a reading has to change by.
const FOLLOWED: f32 = 0.4;
/// Least standard deviation of a change, over the level.
const LEAST: f32 = 0.001;
impl<M, H, K, const ROWS: usize, const PLANES: usize> BalancingTask<M, H, K, ROWS, PLANES>
where
    M: HasVibration,
    H: BalancingHead<PLANES>,
    K: BalancingMemory<ROWS, PLANES>,
{
    pub(super) fn moving(
        &mut self,
        to: [Complex<f32>; PLANES],
        ticks: u32,
    ) -> Result<(), BalancingFault<H::Error, K::Error>> {
        self.state = BalancingState::Moving;
        let late = ticks as f32 > self.design.travel * M::RATE_HZ as f32;
        let position = self.position()?;
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

    pub(super) fn arrive(&mut self) {
        self.phase = Phase::Settling;
        self.begin = true;
    }

    pub(super) fn read(&mut self) {
        self.phase = Phase::Reading;
        self.begin = true;
    }

    /// To other weights, or another reading with the same.
    pub(super) fn go(&mut self, to: [Complex<f32>; PLANES], from: [Complex<f32>; PLANES]) {
        if to == from {
            self.read();
        } else {
            self.in_run.installed(&to);
            self.phase = Phase::Command(to);
        }
    }

    /// Back to the weights of the record; what is known has to be confirmed again.
    pub(super) fn interrupt(&mut self) {
        self.interrupted = true;
        self.doubts = 0;
        let from = *self.in_run.weights();
        self.go(self.record.weights, from);
    }

    /// A head without a sensor has missed a command that shows no effect: it stands where it stood.
    pub(super) fn look_for_effect(&mut self, reading: &[Complex<f32>; ROWS], variance: f32) {
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
}
