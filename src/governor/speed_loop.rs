//! A speed loop: proportional and integral, active damping, limits, anti-windup.

use super::{Governor, LoopFilter};
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`SpeedLoop`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedLoopConfig<N: Number, F = ()> {
    /// Gain on the error of the speed in a tick, k_p + k_i T (N m s/rad).
    pub proportional: N::Coefficient,
    /// Active damping -k_d (N m s/rad), on the twist rate.
    pub damping: N::Coefficient,
    /// Share of its distance to the limited torque that the integral covers in a tick, k_i T/(k_p + k_i T): 0 to 1.
    pub reset: N::Coefficient,
    /// Largest torque, in either direction (N m).
    pub torque_limit: N,
    /// Largest change of the setpoint in a tick (rad/s).
    pub ramp: N,
    /// Constants of the filters.
    pub filter: F,
}

impl<N: Number> SpeedLoopConfig<N> {
    /// The same with the constants of filters.
    #[must_use]
    pub const fn with_filter<F: Copy>(self, filter: F) -> SpeedLoopConfig<N, F> {
        let Self { proportional, damping, reset, torque_limit, ramp, filter: () } = self;
        SpeedLoopConfig { proportional, damping, reset, torque_limit, ramp, filter }
    }
}

/// A speed loop: proportional and integral action, active damping, limits, anti-windup.
///
/// ```text
/// tau = limit(k (omega* - omega_m) + I + d),   d = -k_d (omega_m - omega_l),   I' = I + r (tau - d - I)
/// ```
///
/// with `k = k_p + k_i T` and `r = k_i T/k`, T the period. Within the limit this is the proportional and integral law,
/// `I' = I + k_i T (omega* - omega_m)`. The integral follows the limited torque with its own time constant (automatic
/// reset [Åström and Hägglund 1995, PID Controllers, section 3.5]). With r below 1 it stays within the limit and the
/// largest damping, whatever gains, setpoint and estimates: it cannot wind up. The setpoint moves by at most the ramp's
/// step a tick. Filters of the ramped setpoint, of the speed and of the twist rate are optional: [`LoopFilter`].
///
/// ```
/// use driveline::governor::{Governor, SpeedLoop, SpeedLoopConfig};
/// use driveline::sample::Estimate;
/// const CONFIG: SpeedLoopConfig<f64> =
///     SpeedLoopConfig { proportional: 20.0, damping: 0.0, reset: 0.01, torque_limit: 550.0, ramp: 300.0, filter: () };
/// let mut governor = SpeedLoop::<(), f64>::default();
/// governor.set_setpoint(100.0);
/// // a motor that is held fast for a minute of ticks: the integral stays at the limit ...
/// assert!((0..60_000).all(|_| governor.command(&CONFIG, &Estimate::default()) <= 550.0));
/// // ... and once the motor turns 30 rad/s too fast, it brakes at once: no wind-up
/// let fast = Estimate { motor_speed: 130.0, ..Estimate::default() };
/// assert!((governor.command(&CONFIG, &fast) - (550.0 - 20.0 * 30.0)).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("PI", "PID", "anti-windup"))]
pub struct SpeedLoop<F = (), N = f32> {
    integral: N,
    ramped: N,
    setpoint: N,
    filter: F,
}

impl<N: Copy, F> SpeedLoop<F, N> {
    /// The ramped setpoint (rad/s).
    pub fn ramped_setpoint(&self) -> N {
        self.ramped
    }
}

impl<N: Number, F: LoopFilter<N>> Governor<N> for SpeedLoop<F, N> {
    type Config = SpeedLoopConfig<N, F::Config>;

    const COMMANDS: bool = true;

    #[inline(always)]
    fn set_setpoint(&mut self, setpoint: N) {
        self.setpoint = setpoint;
    }

    #[inline(always)]
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        let mut carry = N::CARRY;
        let step = (self.setpoint - self.ramped).limited(config.ramp);
        self.ramped = self.ramped + step;
        let setpoint = self.filter.setpoint(&mut carry, config.reset, step, self.ramped);
        let speed = self.filter.speed(&mut carry, &config.filter, estimate.motor_speed);
        let error = setpoint - speed;
        let twist_rate = estimate.motor_speed - estimate.load_speed;
        let twist_rate = self.filter.twist_rate(&mut carry, &config.filter, twist_rate);
        let standing = self.integral + twist_rate.gained::<1>(config.damping);
        let torque = (standing + error.gained::<4>(config.proportional)).limited(config.torque_limit);
        self.integral = self.integral.accumulate(&mut carry, [config.reset], [torque - standing]);
        torque
    }

    /// The integral takes over the difference of the torques, up to twice the limit.
    fn switch(&mut self, from: &Self::Config, to: &Self::Config, estimate: &Estimate<N>) {
        let speed = self.filter.filtered_speed(estimate.motor_speed);
        let error = self.filter.filtered_setpoint(self.ramped) - speed;
        let twist_rate = self.filter.filtered_twist_rate(estimate.motor_speed - estimate.load_speed);
        // The proportional part of saturation counts as four limits, which every number holds.
        let twice = to.torque_limit + to.torque_limit;
        let prompt = |c: &Self::Config| {
            error.gained::<4>(c.proportional).limited(twice + twice) + twist_rate.gained::<1>(c.damping)
        };
        self.integral = (self.integral + (prompt(from) - prompt(to)).limited(twice)).limited(twice);
    }

    fn permitted(&self, config: &Self::Config, _estimate: &Estimate<N>, torque: N) -> N {
        torque.limited(config.torque_limit)
    }

    fn start(&mut self, _config: &Self::Config, estimate: &Estimate<N>, torque: N) {
        self.ramped = estimate.motor_speed;
        self.setpoint = N::ZERO;
        self.integral = torque;
        self.filter.start(estimate.motor_speed);
    }
}
