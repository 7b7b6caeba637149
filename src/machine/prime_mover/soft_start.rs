//! Start of an induction motor by reduced voltage.

use super::{Characteristic, Induction, Line, Parabola};
use crate::machine::error::{Error, positive};
use crate::machine::{Rigid, Speed, Torque};
use crate::math::sqrt;

/// A start by reduced voltage (soft starter): the voltage rises evenly from an initial share to the full one, and gives
/// way while the torque is above a limit. The torque goes with the square of the voltage.
///
/// At standstill full voltage would exceed the limit; at the initial share the breakdown torque does not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SoftStart {
    /// Largest torque (N m).
    pub peak: f64,
    /// Share of the full voltage that it begins with.
    pub initial: f64,
    /// Time from there to full voltage where nothing limits it (s).
    pub rise: f64,
}

impl Induction {
    /// The same motor at a share of its voltage: every torque times its square.
    #[must_use]
    pub const fn at_voltage(self, share: f64) -> Self {
        Induction { breakdown: share * share * self.breakdown, ..self }
    }

    /// A start by reduced voltage that does not exceed a torque.
    ///
    /// ```
    /// # use driveline::machine::{Induction, Inertia, Parabola, Rigid, SoftStart, Speed, Torque};
    /// const MOTOR: Induction = Induction { synchronous: 104.72, breakdown: 2500.0, breakdown_slip: 0.4 };
    /// const START: SoftStart = MOTOR.soft_start(Torque(1200.0), 0.5, 1.0);
    /// const PUMP: Parabola = Parabola { constant: 200.0, linear: 0.0, square: 0.05 };
    /// let time = START.time_to(&MOTOR, &Rigid::new(Inertia(60.0)), &PUMP, Speed(95.0));
    /// assert!(time > 60.0 * 95.0 / 1000.0);
    /// ```
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that
    /// [`try_soft_start`](Self::try_soft_start) returns.
    #[must_use]
    pub const fn soft_start(&self, peak: Torque, initial: f64, rise: f64) -> SoftStart {
        match self.try_soft_start(peak, initial, rise) {
            Ok(start) => start,
            Err(error) => error.stop(),
        }
    }

    /// [`soft_start`](Self::soft_start), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::SoftStart`] for a share that is not between 0 and 1, a time (s) that is not positive and finite, a
    /// torque above that of standstill at full voltage or below the breakdown torque at the initial one.
    pub const fn try_soft_start(&self, peak: Torque, initial: f64, rise: f64) -> Result<SoftStart, Error> {
        let within = peak.0 <= self.starting_torque().0 && peak.0 >= self.at_voltage(initial).breakdown;
        if initial > 0.0 && initial < 1.0 && positive(rise) && within {
            Ok(SoftStart { peak: peak.0, initial, rise })
        } else {
            Err(Error::SoftStart)
        }
    }
}

impl SoftStart {
    /// Starting time (s) from standstill to a speed: the voltage rises until the torque is at its limit, which stays
    /// until full voltage gives less. Infinite where the torque does not suffice.
    ///
    /// It takes the torque of the rise for that of standstill, and the voltage for fast enough to keep the torque at
    /// its limit: a rise that is short against the start.
    #[must_use]
    pub const fn time_to(&self, motor: &Induction, machine: &Rigid, load: &Parabola, to: Speed) -> f64 {
        let standstill = motor.starting_torque().0;
        if !(self.peak > load.constant) {
            return f64::INFINITY;
        }
        let limited = sqrt(self.peak / standstill);
        let carried = sqrt(load.constant.max(0.0) / standstill).max(self.initial);
        let cubes = limited * limited * limited - carried * carried * carried;
        let per_share = self.rise / (1.0 - self.initial);
        let impulse = per_share * (standstill * cubes / 3.0 - load.constant * (limited - carried));
        let begins = impulse / machine.inertia;
        // u/2 + 1/(2 u) = tau_A/tau at full voltage, on the side where the torque falls with the speed.
        let over = motor.breakdown / self.peak;
        let slip = motor.breakdown_slip / (over + sqrt((over - 1.0) * (over + 1.0)));
        let full = motor.synchronous * (1.0 - slip);
        let constant = Characteristic::Line(Line { stall: self.peak, slope: 0.0 });
        per_share * (limited - self.initial)
            + constant.time_to(machine, load, Speed(begins), Speed(if to.0 < full { to.0 } else { full }))
            + Characteristic::Induction(*motor).time_to(machine, load, Speed(full), to)
    }
}
