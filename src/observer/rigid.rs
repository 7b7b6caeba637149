//! The rigid observer: one inertia, for machines whose shafts the controller cannot feel.
//!
//! ```text
//! omega' = omega + T/J (tau_m - tau_L)
//! ```
//!
//! The shaft torque is then the load torque plus what accelerates the load's share of the inertia.

use super::Observer;
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`Rigid`]. Made by [`crate::constants`] from a design; the fields are in SI units for floats.
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
    /// Largest innovation that is believed [2^-32 turn].
    pub innovation_limit: N,
    /// The load's share of the inertia, which is the share of the accelerating torque that passes through the shaft.
    pub load_share: N::Coefficient,
}

/// State of the rigid observer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rigid<N> {
    speed: N,
    load_torque: N,
    residual: N,
    angle: u32,
    accelerating: N,
}

impl<N: Number> Rigid<N> {
    /// The predicted speed and turn.
    #[inline(always)]
    fn predict(&self, config: &RigidConfig<N>, carry: &mut N::Carry, torque: N) -> (N, N) {
        let accelerating = torque.minus(self.load_torque);
        let speed = self
            .speed
            .accumulate(carry, config.acceleration, accelerating);
        let turn = N::ZERO
            .accumulate(carry, config.turn, self.speed.plus(speed))
            .to_angle();
        (speed, turn)
    }
}

impl<N: Number> Observer<N> for Rigid<N> {
    type Config = RigidConfig<N>;

    fn synchronise(&mut self, angle: u32) {
        self.angle = angle;
        self.residual = N::ZERO;
    }

    #[inline(always)]
    fn update(&mut self, config: &RigidConfig<N>, angle: u32, torque: N) -> bool {
        let turned = N::from_angle(angle.wrapping_sub(self.angle) as i32).plus(self.residual);
        let mut carry = N::CARRY;
        let (speed, turn) = self.predict(config, &mut carry, torque);
        let innovation = turned.minus(turn);
        if innovation.exceeds(config.innovation_limit) {
            self.speed = speed.saturated();
            self.residual = self.residual.minus(turn);
            self.accelerating = torque.minus(self.load_torque);
            return false;
        }
        let operand = innovation.angle_operand();
        self.angle = angle;
        self.speed = speed
            .accumulate(&mut carry, config.correction[0], operand)
            .saturated();
        self.load_torque = self
            .load_torque
            .accumulate(&mut carry, config.correction[1], operand)
            .saturated();
        self.residual = innovation.accumulate(&mut carry, config.angle_correction, operand);
        self.accelerating = torque.minus(self.load_torque);
        true
    }

    fn coast(&mut self, config: &RigidConfig<N>, torque: N) {
        let (speed, turn) = self.predict(config, &mut { N::CARRY }, torque);
        self.speed = speed.saturated();
        self.residual = self.residual.minus(turn);
        self.accelerating = torque.minus(self.load_torque);
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

    fn angle(&self) -> u32 {
        self.angle
    }

    #[inline(always)]
    fn is_saturated(&self) -> bool {
        self.speed.is_at_rail() || self.load_torque.is_at_rail()
    }
}
