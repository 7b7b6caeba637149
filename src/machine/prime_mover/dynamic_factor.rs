//! Dynamic factors of torques that are no step, and the slew limit for an allowed one.
//!
//! The shaft of two masses answers a change of the motor's torque as one undamped vibration at the resonance omega. The
//! factor is the largest change of the shaft's torque over
//! [`accelerating_torque`](crate::machine::TwoMass::accelerating_torque) of the change alone; a step has 2 (mills:
//! torque amplification factor) [derived; headings: Huang 1987 ch. 3 to 7].

use core::f64::consts::PI;

use super::StartingLaw;
use crate::machine::{Torque, TwoMass};
use crate::math::{atan2, hypot, sin_cos, sqrt};

impl TwoMass {
    /// Factor of a torque that rises evenly within `time` (s) and stays: `1 + |sin(omega T/2)|/(omega T/2)`,
    /// 2 at zero or below.
    #[must_use]
    pub const fn ramp_factor(&self, time: f64) -> f64 {
        let half = 0.5 * self.resonance() * time;
        if half > 0.0 { 1.0 + (sin_cos(half).0 / half).abs() } else { 2.0 }
    }

    /// Factor of a constant torque that lasts for `time` (s): `2 sin(omega T/2)` up to half a period, 2 from there
    /// on, 0 at zero or below.
    #[must_use]
    pub const fn pulse_factor(&self, time: f64) -> f64 {
        let half = 0.5 * self.resonance() * time;
        if half < 0.5 * PI { 2.0 * sin_cos(half.max(0.0)).0 } else { 2.0 }
    }

    /// Factor of a starting law, of its torque at the start.
    ///
    /// With `a = omega T` a soft start has `2 (1 - atan(a)/a)` where that peak lies within T, as a medium one
    /// `(1 + 2/a^2)(1 - cos theta) - theta^2/a^2` with `(a^2 + 2) sin theta = 2 theta`; a shorter start has the
    /// amplitude that it leaves, 0 at a time of zero or below. Within 1e-12 from a = 1e-3 on.
    #[must_use]
    pub const fn law_factor(&self, law: &StartingLaw) -> f64 {
        match *law {
            StartingLaw::Hard { .. } => 2.0,
            StartingLaw::Soft { time, .. } | StartingLaw::Medium { time, .. } if time <= 0.0 => 0.0,
            StartingLaw::Soft { time, .. } => {
                let a = self.resonance() * time;
                let peak = atan2(a, 1.0);
                if 2.0 * peak <= a {
                    return 2.0 * (1.0 - peak / a);
                }
                let ((sine, cosine), half) = (sin_cos(a), sin_cos(0.5 * a).0);
                hypot(sine / a - cosine, sine - 2.0 * half * half / a)
            }
            StartingLaw::Medium { time, .. } => {
                let a = self.resonance() * time;
                let (more, peak) = (1.0 + 2.0 / (a * a), medium_peak(a));
                if peak <= a {
                    return more * (1.0 - sin_cos(peak).1) - peak * peak / (a * a);
                }
                let ((sine, _), half) = (sin_cos(a), sin_cos(0.5 * a).0);
                hypot(2.0 * more * half * half - 1.0, more * sine - 2.0 / a)
            }
        }
    }

    /// Torque per time (N m/s) at which a change of the motor's torque (N m) has at most this factor, between 1
    /// and 2: `change omega (factor - 1)/2`, from the envelope `1 + 2/(omega T)` of all ramps; 0 for a factor of 1 or
    /// below. The constant [`HasSlew::SLEW`](crate::configure::HasSlew::SLEW) of a governor.
    ///
    /// ```
    /// # use driveline::machine::{Damping, Inertia, Stiffness, Torque, TwoMass};
    /// const MILL: TwoMass = TwoMass::new(Inertia(40.0), Inertia(25.0), Stiffness(2.0e6), Damping(0.0));
    /// const SLEW: f64 = MILL.slew_for_factor(Torque(9000.0), 1.2);
    /// assert!(MILL.ramp_factor(9000.0 / SLEW) <= 1.2);
    /// ```
    #[must_use]
    pub const fn slew_for_factor(&self, change: Torque, factor: f64) -> f64 {
        0.5 * change.0.abs() * self.resonance() * (factor - 1.0).max(0.0)
    }

    /// Torque that the shaft first turns to (N m) after motor and load torque have changed at once, from the torque
    /// `before` and masses at one speed: a reversal, or a loss of the load, through the gap. Zero where the masses turn
    /// back within the gap.
    ///
    /// With the new accelerating torque tau_e, whatever side `before` is on:
    /// `tau_e - sqrt((tau_e - before)^2 - 2 k tau_e gap)` on the other flank of a positive one, `2 tau_e - before`
    /// where the flanks stay together. Over `before` it is the dynamic factor.
    #[must_use]
    pub const fn reversal_torque(&self, before: Torque, motor: Torque, load: Torque) -> Torque {
        let side = if before.0 < 0.0 { -1.0 } else { 1.0 };
        let (mean, from) = (side * self.accelerating_torque(motor, load).0, before.0.abs());
        let together = 2.0 * mean - from;
        if together >= 0.0 {
            return Torque(side * together);
        }
        let square = (mean - from) * (mean - from) - 2.0 * self.stiffness * mean * self.gap;
        let other = if square > 0.0 { mean - sqrt(square) } else { 0.0 };
        Torque(if other < 0.0 { side * other } else { 0.0 })
    }
}

/// The angle of the peak in a medium start, the root of `(a^2 + 2) sin theta = 2 theta` below pi, halved to rounding.
const fn medium_peak(a: f64) -> f64 {
    let (mut low, mut high) = (0.0, PI);
    each!(halvings, 0..60, {
        let middle = 0.5 * (low + high);
        if (a * a + 2.0) * sin_cos(middle).0 > 2.0 * middle {
            low = middle;
        } else {
            high = middle;
        }
    });
    0.5 * (low + high)
}
