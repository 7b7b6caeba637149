//! The rigid observer: one inertia, for shafts that are rigid at the controller's bandwidth.

use super::{AngleTracker, Observer, Prediction};
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`RigidObserver`]. Made by [`crate::settings`] from a design; the fields are in SI units for floats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RigidConfig<N: Number> {
    /// T/J.
    pub acceleration: N::Coefficient,
    /// Turn of the motor from the sum of the old and the new speed (2^-32 turn).
    pub turn: N::Coefficient,
    /// Correction of speed and load torque per innovation.
    pub correction: [N::Coefficient; 2],
    /// The share of an innovation that is taken off the residual.
    pub angle_correction: N::Coefficient,
    /// Speed from a turn in a tick [rad/s per 2^-32 turn].
    pub speed: N::Coefficient,
    /// The load's share of the inertia, which is the share of the accelerating torque that passes through the shaft.
    pub load_share: N::Coefficient,
}

/// The observer of a rigid machine.
///
/// ```text
/// omega' = omega + T/J (tau_m - tau_L)
/// ```
///
/// The shaft torque is then the load torque plus the acceleration torque of the load's share of the inertia.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::configure::Configure;
/// use driveline::observer::{Observer, RigidConfig, RigidObserver};
/// const CONFIG: RigidConfig<f64> = <RigidObserver as Configure<Roll, f64>>::CONFIG;
/// let mut observer = RigidObserver::<f64>::at_rest(&CONFIG, 0, 0.0);
/// // two seconds under 40 N m at 100 rad/s, 0.01 rad a tick (2^-32 turn)
/// for tick in 1..=20_000_u32 {
///     observer.step(&CONFIG, tick.wrapping_mul(6_835_653), 40.0);
/// }
/// assert!((observer.estimate(&CONFIG).load_torque - 40.0).abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct RigidObserver<N = f32> {
    speed: N,
    load_torque: N,
    accelerating: N,
    angle: AngleTracker<N>,
}

impl<N: Number> Observer<N> for RigidObserver<N> {
    type Config = RigidConfig<N>;
    type States = ([N; 2], N);

    fn steady(_config: &RigidConfig<N>, angle: u32, torque: N, speed: N) -> Self {
        RigidObserver {
            speed: speed.saturated(),
            load_torque: torque,
            angle: AngleTracker::new(angle),
            ..RigidObserver::default()
        }
    }

    tracked!();

    #[inline(always)]
    fn predict(&self, config: &RigidConfig<N>, angle: u32, torque: N) -> Prediction<N, Self::States> {
        let mut carry = N::CARRY;
        let accelerating = torque - self.load_torque;
        let speed = self.speed.accumulate(&mut carry, [config.acceleration], [accelerating]);
        let turn = ([config.turn], [self.speed + speed]);
        self.angle.predict([speed, self.load_torque], turn, angle, carry).with(accelerating)
    }

    #[inline(always)]
    fn correct(&mut self, config: &RigidConfig<N>, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, accelerating) = predicted.split();
        let states = [&mut self.speed, &mut self.load_torque];
        self.angle.correct(predicted, config.correction, &config.angle_correction, angle, states);
        self.accelerating = accelerating;
    }

    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, accelerating) = predicted.split();
        [self.speed, _] = self.angle.coast(predicted, angle);
        self.accelerating = accelerating;
    }

    #[inline(always)]
    fn estimate(&self, config: &RigidConfig<N>) -> Estimate<N> {
        Estimate {
            motor_speed: self.speed,
            shaft_torque: self.load_torque.accumulate(
                &mut { N::CARRY },
                [config.load_share],
                [self.accelerating.widened()],
            ),
            load_speed: self.speed,
            load_torque: self.load_torque,
        }
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        N::beyond_base([self.speed, self.load_torque])
    }
}
