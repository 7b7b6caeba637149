//! Speed filters before the governor: none, a moving average over the firing interval, or the average over a cycle.

use crate::number::Number;
use crate::sample::Estimate;

/// A filter of the speed; `()` passes the estimates unchanged.
///
/// An engine's speed fluctuates with every firing, and a governor that follows the ripple only wears the rack: a
/// flywheel reduces periodic fluctuation, a governor the rest [Notes ch. 5]. The moving average over one firing
/// interval at rated speed contains none of the firing orders. For a varying speed or a long cycle the ripple follows
/// the angle: [`CycleAverage`] takes the speed without its ripple from the drive's measurement of the fluctuation.
pub trait SpeedFilter<N: Number>: Default {
    /// Its constants.
    type Config;

    /// Sets the speed without its ripple, where the drive's fluctuation measures it.
    #[inline(always)]
    fn set_steady_speed(&mut self, _steady_speed: Option<N>) {}

    /// The filtered estimate of this tick.
    #[inline(always)]
    fn filter(&mut self, _config: &Self::Config, estimate: &Estimate<N>) -> Estimate<N> {
        *estimate
    }

    /// The filtered estimate of the last tick, for unchanged estimates.
    fn filtered(&self, estimate: &Estimate<N>) -> Estimate<N> {
        *estimate
    }

    /// The estimate for sequence and trips: filtered or not.
    #[inline(always)]
    fn monitored<'e>(_estimate: &'e Estimate<N>, filtered: &'e Estimate<N>) -> &'e Estimate<N> {
        filtered
    }

    /// Restarts from these estimates.
    #[inline(always)]
    fn start(&mut self, _config: &Self::Config, _estimate: &Estimate<N>) {}
}

/// No filter.
impl<N: Number> SpeedFilter<N> for () {
    type Config = ();
}

/// Moving averages of motor speed and load torque over the last `K` ticks, a power of two from 4 on; their delay is
/// half of it. Shaft torque and load speed pass unchanged.
///
/// ```
/// use core::f64::consts::TAU;
/// use driveline::governor::{MovingAverage, MovingAverageConfig, SpeedFilter};
/// use driveline::sample::Estimate;
/// // 32 ticks to the firing interval: of a ripple of 3 rad/s nothing is left
/// const AVERAGE: MovingAverageConfig<f64, 32> = MovingAverageConfig { share: 1.0 / 32.0 };
/// let mut filter = MovingAverage::<32, f64>::default();
/// let speeds = (0..64).map(|tick| 157.0 + 3.0 * (TAU * tick as f64 / 32.0).sin());
/// let filtered = speeds.map(|motor_speed| filter.filter(&AVERAGE, &Estimate { motor_speed, ..Estimate::default() }));
/// assert!((filtered.last().unwrap().motor_speed - 157.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MovingAverage<const K: usize, N = f32> {
    past: [[N; 2]; K],
    sum: [N; 2],
    /// The sum of the ring up to here, by additions alone. It replaces the running sum once a round, so that roundings
    /// do not accumulate.
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

impl<N: Number, const K: usize> Default for MovingAverage<K, N> {
    fn default() -> Self {
        const { assert!(K.is_power_of_two() && K >= 4 && K <= 1 << 16, "a mean is over a power of two of ticks") };
        MovingAverage { past: [[N::ZERO; 2]; K], sum: [N::ZERO; 2], fresh: [N::ZERO; 2], at: 0 }
    }
}

impl<N: Number, const K: usize> SpeedFilter<N> for MovingAverage<K, N> {
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

/// The motor's speed without its ripple, as measured by the drive's fluctuation
/// ([`CycleMean`](crate::fluctuation::CycleMean)); unfiltered where that is unknown. All else passes unchanged;
/// sequence and trips use the unfiltered speed.
///
/// Load feed-forward brings the ripple back: leave [`FeedForward`](super::FeedForward) out, or at nearly constant speed
/// take [`MovingAverage`], which averages the load torque as well.
///
/// ```
/// use driveline::governor::{CycleAverage, SpeedFilter};
/// use driveline::sample::Estimate;
/// // in a drive the fluctuation gives the speed without its ripple in every tick
/// let mut filter = CycleAverage::default();
/// filter.set_steady_speed(Some(157.0));
/// let estimate = Estimate { motor_speed: 159.2, load_torque: 800.0, ..Estimate::default() };
/// assert_eq!(filter.filter(&(), &estimate), Estimate { motor_speed: 157.0, ..estimate });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleAverage<N = f32> {
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
