//! Torque of a motor against time while it starts.

use crate::machine::error::{Error, positive};
use crate::machine::{Line, Rigid, Torque};
use crate::math::{ln, sqrt};

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

impl StartingLaw {
    /// Whether torque and time are in their range.
    ///
    /// # Errors
    /// [`Error::StartingTime`].
    pub const fn check(&self) -> Result<(), Error> {
        let valid = match *self {
            Self::Hard { torque } => torque.is_finite(),
            Self::Medium { torque, time } | Self::Soft { torque, time } => torque.is_finite() && positive(time),
        };
        if valid { Ok(()) } else { Err(Error::StartingTime) }
    }

    /// Torque at a time (s) after the start, zero or above.
    #[must_use]
    pub const fn torque(&self, t: f64) -> Torque {
        Torque(match *self {
            Self::Hard { torque } => torque,
            Self::Medium { torque, time } if t < time => torque * (1.0 - t / time) * (1.0 + t / time),
            Self::Soft { torque, time } if t < time => torque * (1.0 - t / time),
            _ => 0.0,
        })
    }

    /// Starting time T (s) that brings a rigid machine to a speed (rad/s) against a load torque that is constant:
    /// `J omega = integral of (tau - tau_L)`; infinite where the torque does not suffice.
    ///
    /// The law's own time has no effect: it is the result.
    #[must_use]
    pub const fn time_to(&self, machine: &Rigid, load: Torque, speed: f64) -> f64 {
        let (torque, mean) = match *self {
            Self::Hard { torque } => (torque, 1.0),
            Self::Medium { torque, .. } => (torque, 2.0 / 3.0),
            Self::Soft { torque, .. } => (torque, 0.5),
        };
        let left = mean * torque - load.0;
        if left > 0.0 { machine.inertia * speed / left } else { f64::INFINITY }
    }
}

impl Line {
    /// Time constant of a rigid machine on this characteristic (s): `J/b`.
    #[must_use]
    pub const fn time_constant(&self, machine: &Rigid) -> f64 {
        machine.inertia / self.slope
    }

    /// Time (s) from standstill to a speed (rad/s) against a constant load torque,
    /// `J/b ln(omega_e/(omega_e - omega))` with the speed omega_e that it tends to; infinite where that is not above
    /// the target speed.
    #[must_use]
    pub const fn time_to(&self, machine: &Rigid, load: Torque, speed: f64) -> f64 {
        let end = (self.stall - load.0) / self.slope;
        if end > speed && self.slope > 0.0 {
            self.time_constant(machine) * ln(end / (end - speed))
        } else {
            f64::INFINITY
        }
    }
}

/// Peak of the shaft's torque in a start of two masses [derived; headings: Huang 1987 ch. 3 to 7]; see
/// [`crate::machine::TwoMass::starting_peak`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StartCondition {
    /// The shaft carries the load's torque before the motor starts, as against a brake.
    Pretensioned,
    /// The shaft is without torque, the load's torque acts from the start.
    Untensioned,
    /// The shaft is unloaded, with the machine's gap open, and the load is held by its own friction until the shaft
    /// carries its torque.
    Slack,
}

impl crate::machine::TwoMass {
    /// Torque that the shaft carries while both masses accelerate alike (N m): `(tau_m J_l + tau_L J_m)/(J_m + J_l)`
    /// [derived; headings: Huang 1987 ch. 3 to 7].
    #[must_use]
    pub const fn accelerating_torque(&self, motor: Torque, load: Torque) -> Torque {
        Torque((motor.0 * self.load_inertia + load.0 * self.motor_inertia) / self.total_inertia())
    }

    /// Largest torque in the shaft after a constant motor torque sets in, undamped (N m) [derived; headings: Huang 1987
    /// ch. 3 to 7].
    ///
    /// For a slack start motor and load torque must be positive. The motor crosses the gap, twists the shaft against
    /// the load that friction still holds, until the shaft carries the load's torque; then both swing about the
    /// accelerating torque. A motor too weak for the load swings against it locked.
    #[must_use]
    pub const fn starting_peak(&self, condition: StartCondition, motor: Torque, load: Torque) -> Torque {
        let mean = self.accelerating_torque(motor, load).0;
        Torque(match condition {
            StartCondition::Pretensioned => mean + (mean - load.0).abs(),
            StartCondition::Untensioned => mean + mean.abs(),
            StartCondition::Slack => {
                let (tau, k) = (motor.0, self.stiffness);
                // Square of the motor's speed, times its inertia, when the shaft carries the load's torque.
                let energy = 2.0 * tau * (self.gap + load.0 / k) - load.0 * load.0 / k;
                if energy < 0.0 {
                    tau + sqrt(tau * tau + 2.0 * k * tau * self.gap)
                } else {
                    let share = self.load_inertia / self.total_inertia();
                    mean + sqrt((load.0 - mean) * (load.0 - mean) + k * share * energy)
                }
            }
        })
    }

    /// Dynamic factor of a start: its largest torque over the load's torque [derived; headings: Huang 1987 ch. 3 to 7].
    #[must_use]
    pub const fn dynamic_factor(&self, condition: StartCondition, motor: Torque, load: Torque) -> f64 {
        self.starting_peak(condition, motor, load).0 / load.0
    }

    /// Torque that an impact of the masses at a relative speed (rad/s) adds, undamped:
    /// `delta_omega sqrt(k J_m J_l/(J_m + J_l))` (N m) [derived; headings: Huang 1987 ch. 3 to 7].
    #[must_use]
    pub const fn impact_torque(&self, relative_speed: f64) -> Torque {
        Torque(relative_speed * sqrt(self.stiffness * self.reduced_inertia()))
    }
}
