//! Torque of a motor against time while it starts.

use crate::machine::Torque;
use crate::math::sqrt;

/// A starting torque and how it falls over the starting time [Huang 1987 §2.2].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StartingLaw {
    /// Hard: a constant torque (N m).
    Hard {
        /// Torque (N m).
        torque: f64,
    },
    /// Medium: `torque (1 - t^2/T^2)`, nothing after T.
    Medium {
        /// Torque at the start (N m).
        torque: f64,
        /// Starting time T (s).
        time: f64,
    },
    /// Soft: `torque (1 - t/T)`, nothing after T.
    Soft {
        /// Torque at the start (N m).
        torque: f64,
        /// Starting time T (s).
        time: f64,
    },
}

impl crate::machine::TwoMass {
    /// Torque that the shaft carries while both masses accelerate alike (N m): `(tau_m J_l + tau_L J_m)/(J_m + J_l)`
    /// [derived; headings: Huang 1987 ch. 3 to 7].
    #[must_use]
    pub const fn accelerating_torque(&self, motor: Torque, load: Torque) -> Torque {
        Torque((motor.0 * self.load_inertia + load.0 * self.motor_inertia) / self.total_inertia())
    }

    /// Torque that an impact of the masses at a relative speed (rad/s) adds, undamped:
    /// `delta_omega sqrt(k J_m J_l/(J_m + J_l))` (N m) [derived; headings: Huang 1987 ch. 3 to 7].
    #[must_use]
    pub const fn impact_torque(&self, relative_speed: f64) -> Torque {
        Torque(relative_speed * sqrt(self.stiffness * self.reduced_inertia()))
    }
}
