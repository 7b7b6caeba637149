//! Start of an induction motor by reduced voltage, under a torque limit.

use crate::number::Number;

/// Constants of [`SoftStarter`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SoftStarterConfig<N> {
    /// Share of the full voltage that it begins with, of 1.
    pub initial: N,
    /// Change of the share in a tick.
    pub step: N,
    /// Torque above which the voltage gives way (N m).
    pub limit: N,
}

/// Raises the voltage tick by tick, and lowers it while the torque is above its limit.
///
/// [`Induction::soft_start`](crate::machine::Induction::soft_start) has the starting time.
///
/// ```
/// use driveline::governor::{SoftStarter, SoftStarterConfig};
/// // from 30 % of the voltage by 0.1 % a tick: the full one after 700 ticks, where the torque stays below 400 N m
/// const CONFIG: SoftStarterConfig<f64> = SoftStarterConfig { initial: 0.3, step: 0.001, limit: 400.0 };
/// let mut starter = SoftStarter::default();
/// let halfway = (0..350).map(|_| starter.tick(&CONFIG, 250.0)).last().unwrap();
/// assert!((halfway - 0.65).abs() < 2e-3);
/// assert!(starter.tick(&CONFIG, 410.0) < halfway);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SoftStarter<N> {
    share: N,
}

impl<N: Number> SoftStarter<N> {
    /// A tick at the motor's torque (N m): the share of the full voltage from now on, from the initial one to 1. A
    /// torque that is NaN lowers it.
    #[inline(always)]
    pub fn tick(&mut self, config: &SoftStarterConfig<N>, torque: N) -> N {
        let next = if torque <= config.limit { self.share + config.step } else { self.share - config.step };
        self.share = if next >= N::ONE {
            N::ONE
        } else if next >= config.initial {
            next
        } else {
            config.initial
        };
        self.share
    }

    /// Begins anew at the initial voltage, for the next start.
    pub fn restart(&mut self) {
        self.share = N::ZERO;
    }
}
