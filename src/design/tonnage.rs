//! Force at the tool of a mechanism, from the estimated load torque: tonnage without a load cell.

use core::f64::consts::TAU;

use super::MechanismDesign;
use crate::machine::{DrivenMechanism, MECHANISM_POINTS};
use crate::math::hypot;

/// Accuracy of a tool's force, as standard deviations.
///
/// With the leverage `y'(phi)` at the motor and the idle torque tau_0 of bearings and guides,
///
/// ```text
/// F = (tau_L - tau_0)/y',    s_F^2 = (s_tau^2 + (a tau)^2)/y'^2 + (F s_phi y''/y')^2
/// ```
///
/// [force: Wang 1989 (1-12); deviation: derived]. s_tau is the observer's standard deviation, a the relative accuracy
/// of torque and inertia, s_phi that of the crank's angle. Near the dead centres the leverage vanishes, and a motor
/// sees no force.
///
/// The observer follows a load torque that rises evenly with the delay `J |K_omega/K_tau|` \[derived\], K its gains. The
/// force is that of the angle where the crank was then.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ForceAccuracy {
    /// Idle torque (N m). Measured over a turn of the crank without a force, it is known to a part of itself.
    pub idle: f64,
    /// Torque constant and inertia, relative.
    pub relative: f64,
    /// Angle of the crank (rad).
    pub angle: f64,
}

impl MechanismDesign {
    /// Delay (s) of the load torque's estimate behind one that rises evenly.
    #[must_use]
    pub const fn load_delay(&self) -> f64 {
        let [_, speed, load] = self.rigid.gains;
        self.rigid.machine.inertia * (speed / load).abs()
    }

    /// Force at the tool, from the crank's angle (rad), the motor's speed (rad/s) and the load torque above the idle
    /// torque (N m at the motor), as estimated in one tick. Gives the crank's angle at which it acted (rad), the force
    /// against the increase of the tool's way (N; of a rocker its torque, N m) and its standard deviation, infinite at
    /// a dead centre.
    #[must_use]
    pub fn tool_force(&self, angle: f64, motor_speed: f64, torque: f64, accuracy: &ForceAccuracy) -> [f64; 3] {
        let angle = angle - self.machine.ratio() * motor_speed * self.load_delay();
        let [leverage, slope] = self.machine.leverage(angle);
        let force = torque / leverage;
        let torque = hypot(hypot(self.rigid.standard_deviation[2], accuracy.idle), accuracy.relative * torque);
        let deviation = hypot(torque / leverage, force * accuracy.angle * slope / leverage);
        [angle, force, if deviation.is_finite() { deviation } else { f64::INFINITY }]
    }
}

impl DrivenMechanism {
    /// Leverage of the tool at the motor (m/rad) and its derivative by the crank's angle, at that angle (rad): straight
    /// between the points.
    const fn leverage(&self, angle: f64) -> [f64; 2] {
        let step = TAU / MECHANISM_POINTS as f64;
        let place = angle / step;
        // towards zero, and below it one less
        let whole = (place as i64).wrapping_sub((place < 0.0) as i64);
        let index = whole.rem_euclid(MECHANISM_POINTS as i64) as usize;
        let (from, to) = (self.point(index).leverage, self.point(index + 1).leverage);
        [from + (to - from) * (place - whole as f64), (to - from) / step]
    }
}
