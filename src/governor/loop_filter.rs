//! Filters in the speed loop: lag of the setpoint, of the speed, of the active damping.

use crate::number::Number;

/// Filters in a [`SpeedLoop`](super::SpeedLoop); `()` is none, a tuple is one after the other.
///
/// The default is a filter at rest: the governor starts with it.
pub trait LoopFilter<N: Number>: Default {
    /// Its constants.
    type Config;

    /// Whether the damping lags.
    const LAGS_DAMPING: bool = false;

    /// Whether the speed lags.
    const LAGS_SPEED: bool = false;

    /// The setpoint for the loop, once a tick: the ramp has moved by `step` to `ramped`. `share` is the integral's part
    /// of the gain in a tick, k_i T/(k_p + k_i T): the distance of the loop's zero from 1.
    #[inline(always)]
    fn setpoint(&mut self, _carry: &mut N::Carry, _share: N::Coefficient, _step: N, ramped: N) -> N {
        ramped
    }

    /// The twist rate for the active damping, once a tick.
    #[inline(always)]
    fn twist_rate(&mut self, _carry: &mut N::Carry, _config: &Self::Config, twist_rate: N) -> N {
        twist_rate
    }

    /// The motor's speed for the proportional and integral part, once a tick.
    #[inline(always)]
    fn speed(&mut self, _carry: &mut N::Carry, _config: &Self::Config, speed: N) -> N {
        speed
    }

    /// Starts at rest, with the motor at this speed.
    fn start(&mut self, _speed: N) {
        *self = Self::default();
    }

    /// The filtered setpoint of the last tick.
    fn filtered_setpoint(&self, ramped: N) -> N {
        ramped
    }

    /// The filtered twist rate of the last tick; `twist_rate` is the estimated one.
    fn filtered_twist_rate(&self, twist_rate: N) -> N {
        twist_rate
    }

    /// The filtered speed of the last tick; `speed` is the estimated one.
    fn filtered_speed(&self, speed: N) -> N {
        speed
    }
}

/// Setpoint and twist rate as they are.
impl<N: Number> LoopFilter<N> for () {
    type Config = ();
}

impl<N: Number, A: LoopFilter<N>, B: LoopFilter<N>> LoopFilter<N> for (A, B) {
    type Config = (A::Config, B::Config);

    const LAGS_DAMPING: bool = A::LAGS_DAMPING || B::LAGS_DAMPING;
    const LAGS_SPEED: bool = A::LAGS_SPEED || B::LAGS_SPEED;

    #[inline(always)]
    fn setpoint(&mut self, carry: &mut N::Carry, share: N::Coefficient, step: N, ramped: N) -> N {
        let first = self.0.setpoint(carry, share, step, ramped);
        // The first filter's output has another step than its input. So only one of the two may filter the setpoint.
        self.1.setpoint(carry, share, step, first)
    }

    #[inline(always)]
    fn twist_rate(&mut self, carry: &mut N::Carry, config: &Self::Config, twist_rate: N) -> N {
        let first = self.0.twist_rate(carry, &config.0, twist_rate);
        self.1.twist_rate(carry, &config.1, first)
    }

    #[inline(always)]
    fn speed(&mut self, carry: &mut N::Carry, config: &Self::Config, speed: N) -> N {
        let first = self.0.speed(carry, &config.0, speed);
        self.1.speed(carry, &config.1, first)
    }

    fn start(&mut self, speed: N) {
        self.0.start(speed);
        self.1.start(speed);
    }

    fn filtered_setpoint(&self, ramped: N) -> N {
        self.1.filtered_setpoint(self.0.filtered_setpoint(ramped))
    }

    fn filtered_speed(&self, speed: N) -> N {
        self.1.filtered_speed(self.0.filtered_speed(speed))
    }

    fn filtered_twist_rate(&self, twist_rate: N) -> N {
        self.1.filtered_twist_rate(self.0.filtered_twist_rate(twist_rate))
    }
}

/// Lag of the setpoint: the loop follows the ramp with the time constant k_p/k_i, as though the proportional part acted
/// on the speed alone.
///
/// From setpoint to speed a proportional and integral loop has a zero at -k_i/k_p. With it the torque overshoots by an
/// eighth of the accelerating torque at the ends of a ramp (`e^-2` at a damping ratio of 1). A ramp that begins at once
/// lets the shaft swing with the whole accelerating torque. The lag's pole lies on the zero: no overshoot is left, and
/// of the swing the part `1/sqrt(1 + (omega k_p/k_i)^2)`. The price is that the speed follows the ramp later by
/// k_p/k_i, about 2/bandwidth at a damping ratio of 1. The response to load torques is that without it.
///
/// The state is the distance to the ramp, which decays to nothing: no bit of the setpoint is lost.
///
/// ```
/// use driveline::governor::{LoopFilter, SetpointLag};
/// // k_i T/(k_p + k_i T) = 0.01; behind a ramp of 0.02 rad/s a tick the lag is k_p/k_i = 99 ticks
/// let (mut lag, mut carry, mut ramped, mut setpoint) = (SetpointLag::default(), (), 0.0, 0.0);
/// for _ in 0..3000 {
///     ramped += 0.02;
///     setpoint = lag.setpoint(&mut carry, 0.01, 0.02, ramped);
/// }
/// assert!((ramped - setpoint - 99.0 * 0.02_f64).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SetpointLag<N = f32> {
    behind: N,
}

impl<N: Number> LoopFilter<N> for SetpointLag<N> {
    type Config = ();

    #[inline(always)]
    fn setpoint(&mut self, carry: &mut N::Carry, share: N::Coefficient, step: N, ramped: N) -> N {
        let behind = self.behind + step;
        self.behind = behind.accumulate(carry, [share], [-behind]);
        ramped - self.behind
    }

    fn filtered_setpoint(&self, ramped: N) -> N {
        ramped - self.behind
    }
}

/// Lag of the active damping: it damps the first resonance and leaves the higher ones alone.
///
/// An observer of two masses takes a higher vibration for a twist rate; damping on it drives that vibration. A lag of
/// the resonance's reciprocal costs the damping half of its power at the resonance, and takes from a vibration of ten
/// times the frequency nine tenths.
///
/// ```
/// use driveline::governor::{DampingLag, LagConfig, LoopFilter};
/// use driveline::settings::Bases;
/// // of 5 ms at 10,000 ticks a second: after 5 ms a step has come to 1 - 1/e
/// const LAG: LagConfig<f64> = LagConfig::<f64>::new(5e-3, 1e-4, Bases::SI);
/// let (mut lag, mut carry) = (DampingLag::default(), ());
/// let lagged = (0..50).map(|_| lag.twist_rate(&mut carry, &LAG, 1.0)).last();
/// assert!((lagged.unwrap() - (1.0 - (-1.0_f64).exp())).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("notch", "low-pass filter"))]
pub struct DampingLag<N = f32> {
    twist_rate: N,
}

/// Constants of [`DampingLag`] and [`SpeedLag`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LagConfig<N: Number> {
    /// Share of a step that the lag covers in a tick.
    pub share: N::Coefficient,
}

impl<N: Number> LoopFilter<N> for DampingLag<N> {
    type Config = LagConfig<N>;

    const LAGS_DAMPING: bool = true;

    #[inline(always)]
    fn twist_rate(&mut self, carry: &mut N::Carry, config: &LagConfig<N>, twist_rate: N) -> N {
        // In fixed point both are within twice the base, their difference within four times.
        let behind = twist_rate.saturated() - self.twist_rate;
        self.twist_rate = self.twist_rate.accumulate(carry, [config.share], [behind]);
        self.twist_rate
    }

    fn filtered_twist_rate(&self, _twist_rate: N) -> N {
        self.twist_rate
    }
}

/// Lag of the motor's speed in the proportional and integral part: the loop's gain falls with the frequency above its
/// reciprocal.
///
/// A resonance that is not described, or has less damping than described, is then not excited by a torque that is late.
/// [`SpeedLoopDesign::with_speed_lag`](crate::design::SpeedLoopDesign::with_speed_lag) has the phase that it costs.
///
/// ```
/// use driveline::governor::{LagConfig, LoopFilter, SpeedLag};
/// use driveline::settings::Bases;
/// // a roll-off of 5 ms passes a speed that rises by 20 rad/s2 on 0.1 rad/s late, a tick's step less
/// const LAG: LagConfig<f64> = LagConfig::<f64>::new(5e-3, 1e-4, Bases::SI);
/// let (mut lag, mut carry) = (SpeedLag::default(), ());
/// let late = (0..10_000).map(|tick| 2e-3 * tick as f64).map(|speed| speed - lag.speed(&mut carry, &LAG, speed));
/// assert!((late.last().unwrap() - 20.0 * 5e-3_f64).abs() < 2e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("notch", "low-pass filter", "roll-off"))]
pub struct SpeedLag<N = f32> {
    speed: N,
}

impl<N: Number> LoopFilter<N> for SpeedLag<N> {
    type Config = LagConfig<N>;

    const LAGS_SPEED: bool = true;

    #[inline(always)]
    fn speed(&mut self, carry: &mut N::Carry, config: &LagConfig<N>, speed: N) -> N {
        let behind = speed.saturated() - self.speed;
        self.speed = self.speed.accumulate(carry, [config.share], [behind]);
        self.speed
    }

    fn start(&mut self, speed: N) {
        self.speed = speed;
    }

    fn filtered_speed(&self, _speed: N) -> N {
        self.speed
    }
}

#[cfg(test)]
mod tests;
