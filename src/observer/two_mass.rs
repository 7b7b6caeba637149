//! The exact two-mass observer: any stiffness, any tick rate.

use super::{AngleTracker, Observer, Prediction};
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`TwoMassObserver`]. Made by [`crate::settings`] from a design; the fields are in SI units for floats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TwoMassConfig<N: Number> {
    /// Twist forcing s from the motor's and the load's torque [rad/s2 per N m].
    pub forcing: [N::Coefficient; 2],
    /// Increment of the twist from twist, v and s (n11, n12, g1).
    pub twist: [N::Coefficient; 3],
    /// Increment of v from twist, v and s (n21, n22, g2).
    pub twist_rate: [N::Coefficient; 3],
    /// Increment of the mean speed from the accelerating torque, T/(J_m + J_l).
    pub acceleration: N::Coefficient,
    /// Turn of the motor from the sum of two mean speeds and from the twist's increment (2^-32 turn).
    pub turn: [N::Coefficient; 2],
    /// Correction of mean speed, v, twist and load torque per innovation.
    pub correction: [N::Coefficient; 4],
    /// The share of an innovation that is taken off the residual.
    pub angle_correction: N::Coefficient,
    /// Speed from a turn in a tick [rad/s per 2^-32 turn].
    pub speed: N::Coefficient,
    /// Motor speed above the mean, load speed below it, both per v.
    pub share: [N::Coefficient; 2],
    /// Shaft torque from twist and v: stiffness and damping.
    pub shaft: [N::Coefficient; 2],
    /// Twist from shaft torque at rest: compliance.
    pub compliance: N::Coefficient,
}

/// The observer of two masses with the exact step.
///
/// The drivetrain is seen as its mean motion, which only external torques change, and its twist, a closed pair:
/// with omega = (J_m omega_m + J_l omega_l)/(J_m + J_l), delta the twist, v = omega_m - omega_l its rate and
/// s = tau_m/J_m + tau_L/J_l,
///
/// ```text
/// omega' = omega + T (tau_m - tau_L)/(J_m + J_l)
/// delta' = delta + n11 delta + n12 v + g1 s
/// v'     = v     + n21 delta + n22 v + g2 s
/// ```
///
/// which is the zero-order-hold solution to the last digit of the number type. The coefficients are those of the
/// *increment*, which keeps the resolution of a slow mode that is sampled fast. In `f32` a coefficient cos(omega T) has
/// lost the mode's frequency where 1 - cos(omega T) has not. Angular momentum is a state, so it is kept whatever the
/// stiffness. The motor turns by the mean speed's trapezium plus its share of the twist's increment, again exactly.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::configure::Configure;
/// use driveline::observer::{Observer, TwoMassConfig};
/// const CONFIG: TwoMassConfig<f64> = <TwoMassObserver as Configure<Roll, f64>>::CONFIG; // in a drive: `configure`
/// let mut observer = TwoMassObserver::<f64>::at_rest(&CONFIG, 0, 0.0);
/// // two seconds under 40 N m at 100 rad/s, 0.01 rad a tick (2^-32 turn): the load takes all of it
/// for tick in 1..=20_000_u32 {
///     observer.step(&CONFIG, tick.wrapping_mul(6_835_653), 40.0);
/// }
/// let estimate = observer.estimate(&CONFIG);
/// assert!((estimate.shaft_torque - 40.0).abs() < 0.1 && (estimate.load_torque - 40.0).abs() < 0.1);
/// assert!((estimate.load_speed - 100.0).abs() < 0.01);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
#[doc(alias("Kalman", "Luenberger", "torque estimation"))]
pub struct TwoMassObserver<N = f32> {
    twist: N,
    twist_rate: N,
    load_torque: N,
    speed: N,
    angle: AngleTracker<N>,
}

impl<N: Number> Observer<N> for TwoMassObserver<N> {
    type Config = TwoMassConfig<N>;
    type States = [N; 4];

    fn steady(config: &TwoMassConfig<N>, angle: u32, torque: N, speed: N) -> Self {
        TwoMassObserver {
            twist: N::sum(&mut { N::CARRY }, [config.compliance], [torque.widened()]),
            load_torque: torque,
            speed: speed.saturated(),
            angle: AngleTracker::new(angle),
            ..TwoMassObserver::default()
        }
    }

    /// The mean speed takes over the difference of the inertias' shares, the twist that of the stiffness.
    fn switch(&mut self, from: &TwoMassConfig<N>, to: &TwoMassConfig<N>) {
        let (before, after) = (self.estimate(from), self.estimate(to));
        self.speed = (self.speed + (before.motor_speed - after.motor_speed)).saturated();
        let missing = [(before.shaft_torque - after.shaft_torque).widened()];
        self.twist = self.twist.accumulate(&mut { N::CARRY }, [to.compliance], missing).saturated();
    }

    tracked!();

    #[inline(always)]
    fn predict(&self, config: &TwoMassConfig<N>, angle: u32, torque: N) -> Prediction<N, Self::States> {
        let mut carry = N::CARRY;
        let forcing = N::truncated(config.forcing, [torque, self.load_torque]);
        let pair = [self.twist.widened(), self.twist_rate.widened(), forcing.widened()];
        let twist = self.twist.accumulate(&mut carry, config.twist, pair);
        let twist_rate = self.twist_rate.accumulate(&mut carry, config.twist_rate, pair);
        let accelerating = torque - self.load_torque;
        let speed = self.speed.accumulate(&mut carry, [config.acceleration], [accelerating]);
        let path = [self.speed + speed, (twist - self.twist).widened()];
        self.angle.predict([speed, twist_rate, twist, self.load_torque], (config.turn, path), angle, carry)
    }

    #[inline(always)]
    fn correct(&mut self, config: &TwoMassConfig<N>, predicted: Prediction<N, Self::States>, angle: u32) {
        let states = [&mut self.speed, &mut self.twist_rate, &mut self.twist, &mut self.load_torque];
        self.angle.correct(predicted, config.correction, &config.angle_correction, angle, states);
    }

    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32) {
        [self.speed, self.twist_rate, self.twist, _] = self.angle.coast(predicted, angle);
    }

    #[inline(always)]
    fn estimate(&self, config: &TwoMassConfig<N>) -> Estimate<N> {
        let mut carry = N::CARRY;
        let pair = [self.twist.widened(), self.twist_rate.widened()];
        Estimate {
            motor_speed: self.speed.accumulate(&mut carry, [config.share[0]], [pair[1]]),
            shaft_torque: N::truncated(config.shaft, pair),
            load_speed: self.speed.accumulate(&mut carry, [config.share[1]], [pair[1]]),
            load_torque: self.load_torque,
        }
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        N::beyond_base([self.twist, self.twist_rate, self.speed, self.load_torque])
    }
}
