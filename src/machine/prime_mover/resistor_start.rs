//! Start of a slip-ring motor by resistors in steps.

use super::Induction;
use crate::machine::Torque;
use crate::machine::error::Error;
use crate::math::{exp, ln, sqrt};

/// A start by resistors at the slip rings, which are cut out one after another: the torque swings between the same two
/// values on every step.
///
/// At a resistance factor r the torque depends on `s/(r s_A)` alone. Each step begins at the peak torque, at `u_1` of
/// this, and ends at the switching torque, at `u_2`, where the slip is the same for both steps: the factors are a
/// geometric series of the ratio `u_1/u_2` that ends at the rotor's own resistance, 1 [Wang 1989 §1-2 has the motor;
/// the series is derived].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ResistorStart<const STEPS: usize> {
    /// Torque at the beginning of every step (N m).
    pub peak: f64,
    /// Torque at its end (N m).
    pub switching: f64,
    /// The rotor's whole resistance over its own on every step; 1 beyond the last.
    pub resistances: [f64; STEPS],
    /// Speed at the end of every step (rad/s).
    pub speeds: [f64; STEPS],
}

impl Induction {
    stops! {
        /// The resistors of a start in steps from standstill, none of which exceeds a torque.
        ///
        /// ```
        /// # use driveline::machine::{Induction, ResistorStart, Speed, Torque};
        /// const MOTOR: Induction = Induction::new(Speed(100.0), Torque(900.0), Speed(104.72), 2.8);
        /// const START: ResistorStart<4> = MOTOR.resistor_start(Torque(1800.0));
        /// assert!(START.switching > 900.0);
        /// ```
        pub const fn resistor_start<const STEPS: usize>(
            &self,
            peak: Torque,
        ) -> ResistorStart<STEPS> = try_resistor_start
    }

    /// [`resistor_start`](Self::resistor_start), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::ResistorStart`] for a peak that is not positive or above the breakdown torque, one that the motor keeps
    /// to without resistors, or no step.
    pub const fn try_resistor_start<const STEPS: usize>(&self, peak: Torque) -> Result<ResistorStart<STEPS>, Error> {
        let over = self.breakdown / peak.0;
        // u/2 + 1/(2 u) = tau_A/tau, on the side where the torque falls with the speed.
        let high = 1.0 / (over + sqrt((over - 1.0) * (over + 1.0)));
        let first = 1.0 / (self.breakdown_slip * high);
        if !(peak.0 > 0.0 && over >= 1.0 && first > 1.0 && first.is_finite() && STEPS > 0) {
            return Err(Error::ResistorStart);
        }
        let ratio = exp(ln(first) / STEPS as f64);
        let low = high / ratio;
        let (mut resistances, mut speeds) = ([first; STEPS], [0.0; STEPS]);
        each!(step, 0..STEPS, {
            if step > 0 {
                resistances[step] = resistances[step - 1] / ratio;
            }
            speeds[step] = self.synchronous * (1.0 - low * self.breakdown_slip * resistances[step]);
        });
        let switching = 2.0 * self.breakdown * low / (1.0 + low * low);
        Ok(ResistorStart { peak: peak.0, switching, resistances, speeds })
    }
}

impl<const STEPS: usize> ResistorStart<STEPS> {
    /// The motor on a step counted from 0; with its own resistance alone beyond the last.
    #[must_use]
    pub const fn motor(&self, motor: &Induction, step: usize) -> Induction {
        let factor = if step < STEPS { self.resistances[step] } else { 1.0 };
        Induction { breakdown_slip: motor.breakdown_slip * factor, ..*motor }
    }
}
