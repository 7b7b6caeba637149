//! Start of a slip-ring motor: its resistors are cut out one after another, by the speed.

use crate::number::Number;

/// Constants of [`ResistorStarter`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ResistorStarterConfig<N, const STEPS: usize> {
    /// Speed at which each resistor is cut out, rising (rad/s).
    pub speeds: [N; STEPS],
    /// Least ticks that pass between two of them, and before the first, for the contactors.
    pub interval: u32,
}

/// Counts the resistors that are cut out. None is put back by a falling speed: [`restart`](Self::restart) does that.
///
/// [`Induction::resistor_start`](crate::machine::Induction::resistor_start) finds resistors and speeds.
///
/// ```
/// use driveline::governor::{ResistorStarter, ResistorStarterConfig};
/// // two resistors, cut out at 60 and 100 rad/s, the contactors 50 ticks apart
/// const CONFIG: ResistorStarterConfig<f32, 2> = ResistorStarterConfig { speeds: [60.0, 100.0], interval: 50 };
/// let mut starter = ResistorStarter::default();
/// let cut_out = [0.0, 70.0, 120.0].map(|speed| (0..60).map(|_| starter.tick(&CONFIG, speed)).last());
/// assert_eq!(cut_out, [Some(0), Some(1), Some(2)]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ResistorStarter {
    step: u32,
    since: u32,
}

impl ResistorStarter {
    /// Resistors cut out so far, 0 to `STEPS`.
    #[must_use]
    pub fn step(&self) -> u32 {
        self.step
    }

    /// A tick at a speed (rad/s): the resistors that are cut out from now on, at most one more than before. A speed
    /// that is NaN cuts out none.
    #[inline(always)]
    pub fn tick<N: Number, const STEPS: usize>(&mut self, config: &ResistorStarterConfig<N, STEPS>, speed: N) -> u32 {
        let reached = config.speeds.get(self.step as usize).is_some_and(|&at| speed >= at);
        if reached && self.since >= config.interval {
            self.step = self.step.saturating_add(1);
            self.since = 0;
        } else {
            self.since = self.since.saturating_add(1);
        }
        self.step
    }

    /// Puts all resistors back, for the next start.
    pub fn restart(&mut self) {
        *self = Self::default();
    }
}
