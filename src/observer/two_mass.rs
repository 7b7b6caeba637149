//! The exact two-mass observer: any stiffness, any tick rate.
//!
//! The drivetrain is seen as its mean motion, which only external torques change, and its twist, a closed pair:
//! with omega = (J_m omega_m + J_l omega_l)/(J_m + J_l), delta the twist, v = omega_m - omega_l its rate and
//! s = tau_m/J_m + tau_L/J_l,
//!
//! ```text
//! omega' = omega + T (tau_m - tau_L)/(J_m + J_l)
//! delta' = delta + n11 delta + n12 v + g1 s
//! v'     = v     + n21 delta + n22 v + g2 s
//! ```
//!
//! which is the zero-order-hold solution to the last digit that the number has: the coefficients are those of the
//! *increment*, which keeps the resolution of a slow mode that is sampled fast (in `f32` a coefficient
//! cos(omega T) has lost a fast-sampled mode's frequency where 1 - cos(omega T) has not). Angular momentum is a state, so it is kept
//! whatever the stiffness. The motor turns by the mean speed's trapezium plus its share of the twist's increment, again exactly.

use super::{Observer, Predicted};
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
    /// Turn of the motor from the sum of two mean speeds and from the twist's increment [2^-32 turn].
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

/// State of the exact two-mass observer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TwoMassObserver<N> {
    twist: N,
    twist_rate: N,
    load_torque: N,
    speed: N,
    residual: N,
    angle: u32,
}

/// The state of [`TwoMassObserver`] at the end of a tick as the torque alone would have it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TwoMassPrediction<N: Number> {
    twist: N,
    twist_rate: N,
    speed: N,
    turn: N,
    innovation: N,
    carry: N::Carry,
}

impl<N: Number> Predicted<N> for TwoMassPrediction<N> {
    #[inline(always)]
    fn innovation(&self) -> N {
        self.innovation
    }

    #[inline(always)]
    fn turn(&self) -> N {
        self.turn
    }
}

impl<N: Number> Observer<N> for TwoMassObserver<N> {
    type Config = TwoMassConfig<N>;
    type Prediction = TwoMassPrediction<N>;

    fn steady(config: &TwoMassConfig<N>, angle: u32, torque: N, speed: N) -> Self {
        TwoMassObserver {
            twist: N::product(&mut { N::CARRY }, config.compliance, torque.widened()),
            load_torque: torque,
            speed: speed.saturated(),
            angle,
            ..TwoMassObserver::default()
        }
    }

    fn speed_of_turn(config: &TwoMassConfig<N>, turned: N) -> N {
        turned.speed_of_turn(config.speed)
    }

    fn resync(&mut self, angle: u32) {
        self.angle = angle;
        self.residual = N::ZERO;
    }

    #[inline(always)]
    fn predict(&self, config: &TwoMassConfig<N>, angle: u32, torque: N) -> TwoMassPrediction<N> {
        let mut carry = N::CARRY;
        let forcing = N::times2(config.forcing, [torque, self.load_torque]);
        let pair = [self.twist.widened(), self.twist_rate.widened(), forcing.widened()];
        let twist = self.twist.accumulate3(&mut carry, config.twist, pair);
        let twist_rate = self.twist_rate.accumulate3(&mut carry, config.twist_rate, pair);
        let accelerating = torque.minus(self.load_torque);
        let speed = self.speed.accumulate(&mut carry, config.acceleration, accelerating);
        let path = [self.speed.plus(speed), twist.minus(self.twist).widened()];
        let turn = N::sum2(&mut carry, config.turn, path);
        let turned = N::from_angle(angle.wrapping_sub(self.angle) as i32).plus(self.residual);
        TwoMassPrediction { twist, twist_rate, speed, turn, innovation: turned.less_turn(turn), carry }
    }

    #[inline(always)]
    fn correct(&mut self, config: &TwoMassConfig<N>, predicted: TwoMassPrediction<N>, angle: u32) {
        let mut carry = predicted.carry;
        let innovation = predicted.innovation;
        let operand = innovation.innovation_operand();
        let [speed, twist_rate, twist, load_torque] = config.correction;
        self.angle = angle;
        self.speed = predicted.speed.accumulate(&mut carry, speed, operand).saturated();
        self.twist_rate = predicted.twist_rate.accumulate(&mut carry, twist_rate, operand).saturated();
        self.twist = predicted.twist.accumulate(&mut carry, twist, operand).saturated();
        self.load_torque = self.load_torque.accumulate(&mut carry, load_torque, operand).saturated();
        self.residual = innovation.accumulate(&mut carry, config.angle_correction, operand);
    }

    /// The angle stays where it was last believed, and the residual runs on.
    #[inline(always)]
    fn coast(&mut self, predicted: TwoMassPrediction<N>, angle: u32) {
        self.speed = predicted.speed.saturated();
        self.twist_rate = predicted.twist_rate.saturated();
        self.twist = predicted.twist.saturated();
        self.residual = predicted.innovation.minus(N::from_angle(angle.wrapping_sub(self.angle) as i32));
    }

    #[inline(always)]
    fn estimate(&self, config: &TwoMassConfig<N>) -> Estimate<N> {
        let mut carry = N::CARRY;
        let pair = [self.twist.widened(), self.twist_rate.widened()];
        Estimate {
            motor_speed: self.speed.accumulate(&mut carry, config.share[0], pair[1]),
            shaft_torque: N::times2(config.shaft, pair),
            load_speed: self.speed.accumulate(&mut carry, config.share[1], pair[1]),
            load_torque: self.load_torque,
        }
    }

    #[inline(always)]
    fn angle(&self) -> u32 {
        self.angle
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        N::beyond_base([self.twist, self.speed, self.load_torque])
    }
}
