//! The filters by their laws.

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
