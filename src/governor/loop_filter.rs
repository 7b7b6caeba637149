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
mod tests {
    extern crate std;

    use std::vec::Vec;

    use super::{DampingLag, LagConfig, LoopFilter, SetpointLag, SpeedLag};
    use crate::governor::{Governor, SpeedLoop, SpeedLoopConfig};
    use crate::sample::Estimate;

    const PERIOD: f64 = 1e-3;
    const ACCELERATION: f64 = 2.0;

    /// A proportional and integral loop on this inertia, natural frequency `w`, damping ratio 1.
    const fn config(inertia: f64, w: f64) -> SpeedLoopConfig<f64> {
        SpeedLoopConfig {
            proportional: (2.0 + w * PERIOD) * w * inertia,
            damping: 0.0,
            reset: w * PERIOD / (2.0 + w * PERIOD),
            torque_limit: 1e9,
            ramp: ACCELERATION * PERIOD,
            filter: (),
        }
    }

    /// Torques of a motor that carries a pendulum, per tick, in a ramp without end: the motor's inertia 1, the
    /// pendulum's `load`, swinging at `swing` with the motor at rest. The second is the pendulum's.
    fn run<F: LoopFilter<f64, Config = ()>>(w: f64, load: f64, swing: f64, ticks: usize) -> Vec<(f64, f64)> {
        let config = config(1.0 + load, w);
        let mut governor = SpeedLoop::<F, f64>::default();
        let (mut motor, mut speed, mut twist) = (0.0, 0.0, 0.0);
        let mut torques = Vec::new();
        for _ in 0..ticks {
            governor.set_setpoint(1e9);
            let now = Estimate { motor_speed: motor, ..Estimate::default() };
            let torque = governor.command(&config, &now);
            // A hundredth of a tick: the swing's frequency is right to 1e-8.
            for _ in 0..100 {
                let h = 0.01 * PERIOD;
                let shaft = load * swing * swing * twist;
                motor += h * (torque - shaft);
                speed += if load > 0.0 { h * shaft / load } else { 0.0 };
                twist += h * (motor - speed);
            }
            torques.push((torque, load * swing * swing * twist));
        }
        torques
    }

    /// A rigid machine: `s (2 w s + w^2)/(s + w)^2` from the ramp's acceleration to the torque overshoots by `e^-2`, at
    /// `2/w`; without its zero the response rises to the accelerating torque and stays there.
    #[test]
    fn the_torque_of_a_ramp_does_not_overshoot() {
        let w = 10.0;
        let peak = |torques: Vec<(f64, f64)>| torques.iter().map(|(torque, _)| *torque).fold(0.0, f64::max);
        // The delay of a tick is 1 % of 1/w, and the overshoot about as much more; a tick in 1/w of rounding.
        let plain = peak(run::<()>(w, 0.0, 1.0, 1500)) / ACCELERATION;
        assert!((plain - 1.0 - (-2.0_f64).exp()).abs() < 0.01, "{plain}");
        let lagged = peak(run::<SetpointLag<f64>>(w, 0.0, 1.0, 1500)) / ACCELERATION;
        assert!((lagged - 1.0).abs() < 1e-3, "{lagged}");
    }

    /// A pendulum so light that it does not act on the motor swings with the accelerating torque times the gain of the
    /// loop at its frequency: `|w^2 + 2 w j W|/(w^2 + W^2)`, with the lag `w^2/(w^2 + W^2)`.
    #[test]
    fn a_ramp_leaves_a_swing_by_the_loops_gain_at_its_frequency() {
        let (w, swing, load) = (6.0, 15.0, 1e-4);
        let amplitude = |torques: Vec<(f64, f64)>| {
            // After twenty time constants of the loop nothing but the swing is left, four of its periods.
            let last = &torques[3400..5080];
            let (low, high) = last.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x.1), high.max(x.1)));
            0.5 * (high - low) / (load * ACCELERATION)
        };
        let square = w * w + swing * swing;
        let plain = amplitude(run::<()>(w, load, swing, 5080));
        // A tick's delay turns the loop at this frequency by 1 %.
        assert!((plain - w * w.hypot(2.0 * swing) / square).abs() < 0.02 * plain, "{plain}");
        let lagged = amplitude(run::<SetpointLag<f64>>(w, load, swing, 5080));
        assert!((lagged - w * w / square).abs() < 0.02 * lagged, "{lagged}");
        // The documented factor, 1/sqrt(1 + (W k_p/k_i)^2).
        let factor = 1.0 / (1.0 + (2.0 * swing / w).powi(2)).sqrt();
        assert!((lagged / plain - factor).abs() < 0.02 * factor, "{lagged} {plain}");
    }

    /// At the end the setpoint is the ramp's, to the last bit: a lag that moved by less than half a unit in the last
    /// place would stop short.
    #[test]
    fn the_setpoint_is_reached_to_the_bit() {
        let (mut lag, share, step) = (SetpointLag::<f32>::default(), 1e-4, 0.01);
        let mut ramped = 0.0;
        for _ in 0..15_000 {
            ramped += step;
            lag.setpoint(&mut (), share, step, ramped);
        }
        // Behind by the step over the share, less e^-1.5 of it.
        let behind = f64::from(step / share) * (1.0 - (-1.5_f64).exp());
        assert!((f64::from(lag.behind) - behind).abs() < 1e-3 * behind, "{}", lag.behind);
        for _ in 0..300_000 {
            lag.setpoint(&mut (), share, 0.0, ramped);
        }
        assert_eq!(lag.setpoint(&mut (), share, 0.0, ramped), ramped);
    }

    /// A sine comes through with the gain of a first-order lag that is sampled: `c/|1 - (1 - c) e^(-j w T)|`, in every
    /// number.
    #[test]
    fn damping_and_speed_are_lagged_by_a_first_order_lag() {
        use crate::number::{Fixed, Number};
        use crate::settings::Bases;
        fn gain<N: Number>(config: &LagConfig<N>, angle: f64, number: fn(f64) -> N) -> f64 {
            let (mut lag, mut carry, mut peak) = (DampingLag::<N>::default(), N::CARRY, 0.0_f64);
            let (mut speed, mut other) = (SpeedLag::<N>::default(), N::CARRY);
            for tick in 0..20_000 {
                let sine = number((angle * f64::from(tick)).sin());
                let out = lag.twist_rate(&mut carry, config, sine).to_real();
                assert_eq!(speed.speed(&mut other, config, sine).to_real(), out);
                peak = if tick > 10_000 { peak.max(out.abs()) } else { 0.0 };
            }
            peak
        }
        let (lag, period) = (0.017_f64, 1e-4_f64);
        let share = 1.0 - (-period / lag).exp();
        for frequency in [10.0_f64, 59.0, 565.0] {
            let angle = frequency * period;
            let (sine, cosine) = angle.sin_cos();
            let expected = share / (1.0 - (1.0 - share) * cosine).hypot((1.0 - share) * sine);
            let all = [
                gain(&LagConfig::<f64>::new(lag, period, Bases::SI), angle, |x| x),
                gain(&LagConfig::<f32>::new(lag, period, Bases::SI), angle, |x| x as f32),
                gain(&LagConfig::<Fixed>::new(lag, period, Bases::SI), angle, Fixed::from_f64),
            ];
            // The largest of many samples misses the peak by half the angle between two squared; f32 rounds the share.
            assert!(all.iter().all(|gain| (gain / expected - 1.0).abs() < 1e-3), "{frequency}: {all:?} {expected}");
        }
    }

    /// The torque of a damping on a constant twist rate is that of the lag, `k (1 - (1 - c)^n)`, and after a change of
    /// gains it goes on from there: the integral takes over what the lagged twist rate makes of the difference.
    #[test]
    fn a_speed_loop_damps_by_the_lagged_twist_rate() {
        let (k, share) = (3.0, 0.25_f64);
        let of = |damping: f64| SpeedLoopConfig {
            proportional: 0.0,
            damping: -damping,
            reset: 0.0,
            ..config(1.0, 1.0).with_filter(LagConfig { share })
        };
        let slips = Estimate { motor_speed: 1.0, ..Estimate::default() };
        let mut governor = SpeedLoop::<DampingLag<f64>, f64>::default();
        let lagged = |ticks: i32| 1.0 - (1.0 - share).powi(ticks);
        for tick in 1..6 {
            let torque = governor.command(&of(k), &slips);
            assert!((torque + k * lagged(tick)).abs() < 1e-15, "{tick}: {torque}");
        }
        governor.switch(&of(k), &of(2.0 * k), &slips);
        let torque = governor.command(&of(2.0 * k), &slips);
        // some roundings
        assert!((torque - (k * lagged(5) - 2.0 * k * lagged(6))).abs() < 1e-14, "{torque}");
    }

    /// No filter takes no room.
    #[test]
    fn no_filter_takes_no_room() {
        assert_eq!(size_of::<SpeedLoop>(), 12);
        assert_eq!(size_of::<SpeedLoop<SetpointLag<f32>>>(), 16);
        assert_eq!(size_of::<SpeedLoopConfig<f32, LagConfig<f32>>>(), size_of::<SpeedLoopConfig<f32>>() + 4);
    }
}
