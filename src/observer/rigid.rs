//! The rigid observer: one inertia, for machines whose shafts the controller cannot feel.
//!
//! ```text
//! omega' = omega + T/J (tau_m - tau_L)
//! ```
//!
//! The shaft torque is then the load torque plus what accelerates the load's share of the inertia.

use super::{Observer, Predicted};
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`RigidObserver`]. Made by [`crate::settings`] from a design; the fields are in SI units for floats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RigidConfig<N: Number> {
    /// T/J.
    pub acceleration: N::Coefficient,
    /// Turn of the motor from the sum of the old and the new speed [2^-32 turn].
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

/// State of the rigid observer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RigidObserver<N> {
    speed: N,
    load_torque: N,
    accelerating: N,
    residual: N,
    angle: u32,
}

/// The state of [`RigidObserver`] at the end of a tick as the torque alone would have it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RigidPrediction<N: Number> {
    speed: N,
    accelerating: N,
    turn: N,
    innovation: N,
    carry: N::Carry,
}

impl<N: Number> Predicted<N> for RigidPrediction<N> {
    #[inline(always)]
    fn innovation(&self) -> N {
        self.innovation
    }

    #[inline(always)]
    fn turn(&self) -> N {
        self.turn
    }
}

impl<N: Number> Observer<N> for RigidObserver<N> {
    type Config = RigidConfig<N>;
    type Prediction = RigidPrediction<N>;

    fn steady(_config: &RigidConfig<N>, angle: u32, torque: N, speed: N) -> Self {
        RigidObserver { speed: speed.saturated(), load_torque: torque, angle, ..RigidObserver::default() }
    }

    fn speed_of_turn(config: &RigidConfig<N>, turned: N) -> N {
        turned.speed_of_turn(config.speed)
    }

    fn resync(&mut self, angle: u32) {
        self.angle = angle;
        self.residual = N::ZERO;
    }

    #[inline(always)]
    fn predict(&self, config: &RigidConfig<N>, angle: u32, torque: N) -> RigidPrediction<N> {
        let mut carry = N::CARRY;
        let accelerating = torque.minus(self.load_torque);
        let speed = self.speed.accumulate(&mut carry, config.acceleration, accelerating);
        let turn = N::product(&mut carry, config.turn, self.speed.plus(speed));
        let turned = N::from_angle(angle.wrapping_sub(self.angle) as i32).plus(self.residual);
        RigidPrediction { speed, accelerating, turn, innovation: turned.less_turn(turn), carry }
    }

    #[inline(always)]
    fn correct(&mut self, config: &RigidConfig<N>, predicted: RigidPrediction<N>, angle: u32) {
        let mut carry = predicted.carry;
        let innovation = predicted.innovation;
        let operand = innovation.innovation_operand();
        self.angle = angle;
        self.speed = predicted.speed.accumulate(&mut carry, config.correction[0], operand).saturated();
        self.load_torque = self.load_torque.accumulate(&mut carry, config.correction[1], operand).saturated();
        self.accelerating = predicted.accelerating;
        self.residual = innovation.accumulate(&mut carry, config.angle_correction, operand);
    }

    /// The angle stays where it was last believed, and the residual runs on.
    #[inline(always)]
    fn coast(&mut self, predicted: RigidPrediction<N>, angle: u32) {
        self.speed = predicted.speed.saturated();
        self.accelerating = predicted.accelerating;
        self.residual = predicted.innovation.minus(N::from_angle(angle.wrapping_sub(self.angle) as i32));
    }

    #[inline(always)]
    fn estimate(&self, config: &RigidConfig<N>) -> Estimate<N> {
        Estimate {
            motor_speed: self.speed,
            shaft_torque: self.load_torque.accumulate(
                &mut { N::CARRY },
                config.load_share,
                self.accelerating.widened(),
            ),
            load_speed: self.speed,
            load_torque: self.load_torque,
        }
    }

    #[inline(always)]
    fn angle(&self) -> u32 {
        self.angle
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        N::beyond_base([self.speed, self.load_torque, N::ZERO])
    }
}
