//! What a governor sees of the machine: the estimates as they are, or their mean over an interval in which the
//! machine's torque repeats itself.
//!
//! An engine's speed swings with every firing, and a governor that follows the swing wears the rack and mends nothing:
//! a flywheel mends what is periodic, a governor what is not [Notes ch. 5]. The mean over one firing interval at rated
//! speed has none of the firing's orders. Where the speed varies, or the cycle is long, what repeats is known by the angle: [`CycleAverage`] takes
//! the speed without its ripple from the drive's measurement of the fluctuation.

use crate::number::Number;
use crate::sample::Estimate;

/// What a governor sees; `()` sees the estimates as they are.
pub trait SpeedFilter<N: Number>: Default {
    /// Its constants.
    type Config;

    /// Takes the speed without its ripple, where the drive's fluctuation knows it.
    #[inline(always)]
    fn set_steady_speed(&mut self, _steady_speed: Option<N>) {}

    /// What is seen in this tick.
    #[inline(always)]
    fn filter(&mut self, _config: &Self::Config, estimate: &Estimate<N>) -> Estimate<N> {
        *estimate
    }

    /// What was seen in the last tick, of estimates that have not changed since.
    fn filtered(&self, estimate: &Estimate<N>) -> Estimate<N> {
        *estimate
    }

    /// What the modes and trips see, of the estimates as they are and as they are seen.
    #[inline(always)]
    fn monitored<'e>(_estimate: &'e Estimate<N>, filtered: &'e Estimate<N>) -> &'e Estimate<N> {
        filtered
    }

    /// Starts anew with these estimates.
    #[inline(always)]
    fn start(&mut self, _config: &Self::Config, _estimate: &Estimate<N>) {}
}

/// The estimates as they are.
impl<N: Number> SpeedFilter<N> for () {
    type Config = ();
}

/// The means of motor speed and load torque over the last `K` ticks, a power of two from 4 on; late by half of them.
/// Shaft torque and load speed are seen as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MovingAverage<N, const K: usize> {
    past: [[N; 2]; K],
    sum: [N; 2],
    /// The sum of the ring's beginning up to here, by additions alone: what replaces the running sum once a round, so
    /// that its roundings do not add up.
    fresh: [N; 2],
    at: u32,
}

/// Constants of [`MovingAverage`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MovingAverageConfig<N: Number, const K: usize> {
    /// 1/K.
    pub share: N::Coefficient,
}

impl<N: Number, const K: usize> Default for MovingAverage<N, K> {
    fn default() -> Self {
        const { assert!(K.is_power_of_two() && K >= 4 && K <= 1 << 16, "a mean is over a power of two of ticks") };
        MovingAverage { past: [[N::ZERO; 2]; K], sum: [N::ZERO; 2], fresh: [N::ZERO; 2], at: 0 }
    }
}

impl<N: Number, const K: usize> SpeedFilter<N> for MovingAverage<N, K> {
    type Config = MovingAverageConfig<N, K>;

    #[inline(always)]
    fn filter(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> Estimate<N> {
        let new = [estimate.motor_speed.times(config.share), estimate.load_torque.times(config.share)];
        let at = self.at as usize & (K - 1);
        self.at = self.at.wrapping_add(1);
        let [speed, load] = self.past.get(at).copied().unwrap_or_default();
        if let Some(slot) = self.past.get_mut(at) {
            *slot = new;
        }
        self.fresh = [self.fresh[0] + new[0], self.fresh[1] + new[1]];
        self.sum = [self.sum[0] + (new[0] - speed), self.sum[1] + (new[1] - load)];
        if at == K - 1 {
            self.sum = self.fresh;
            self.fresh = [N::ZERO; 2];
        }
        self.filtered(estimate)
    }

    #[inline(always)]
    fn filtered(&self, estimate: &Estimate<N>) -> Estimate<N> {
        Estimate { motor_speed: self.sum[0], load_torque: self.sum[1], ..*estimate }
    }

    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        let new = [estimate.motor_speed.times(config.share), estimate.load_torque.times(config.share)];
        self.past = [new; K];
        self.sum = [estimate.motor_speed, estimate.load_torque];
        self.fresh = [N::ZERO; 2];
        self.at = 0;
    }
}

/// The motor's speed without what repeats in every cycle, as the drive's fluctuation has it ([`CycleMean`](crate::fluctuation::CycleMean)); as it
/// is where the fluctuation does not know. Everything else is seen as it is, and so is the speed by the modes and their trips.
///
/// A load torque that is fed forward brings the ripple back: leave [`FeedForward`](super::FeedForward) out, or take [`MovingAverage`], which sees the
/// mean of the load torque as well, where the speed hardly varies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleAverage<N> {
    steady_speed: Option<N>,
}

impl<N: Number> SpeedFilter<N> for CycleAverage<N> {
    type Config = ();

    #[inline(always)]
    fn set_steady_speed(&mut self, steady_speed: Option<N>) {
        self.steady_speed = steady_speed;
    }

    #[inline(always)]
    fn filter(&mut self, _config: &(), estimate: &Estimate<N>) -> Estimate<N> {
        self.filtered(estimate)
    }

    #[inline(always)]
    fn filtered(&self, estimate: &Estimate<N>) -> Estimate<N> {
        Estimate { motor_speed: self.steady_speed.unwrap_or(estimate.motor_speed), ..*estimate }
    }

    #[inline(always)]
    fn monitored<'e>(estimate: &'e Estimate<N>, _filtered: &'e Estimate<N>) -> &'e Estimate<N> {
        estimate
    }

    #[inline(always)]
    fn start(&mut self, _config: &(), _estimate: &Estimate<N>) {
        self.steady_speed = None;
    }
}
