//! Start of an induction motor by reduced voltage.

use super::{Characteristic, Induction, Parabola};
use crate::machine::error::{Error, positive};
use crate::machine::{Rigid, Speed, Torque};
use crate::math::sqrt;

/// Steps of a start under its largest torque alone: an error of its square, 1e-6 of the time.
const STEPS: f64 = 2000.0;

/// A start by reduced voltage (soft starter): the voltage rises evenly from an initial share to the full one, and is
/// reduced while the torque is above a limit. The torque goes with the square of the voltage.
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

    stops! {
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
        pub const fn soft_start(&self, peak: Torque, initial: f64, rise: f64) -> SoftStart = try_soft_start
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
    /// Starting time (s) from standstill to a speed, in steps of a two-thousandth of a start under the largest torque:
    /// the voltage rises where the torque is below its limit and falls where it is above, no faster than it rises.
    /// Infinite where the torque does not suffice.
    ///
    /// The load is constant or rises as that of a fan, and does not turn the machine backwards.
    #[must_use]
    pub const fn time_to(&self, motor: &Induction, machine: &Rigid, load: &Parabola, to: Speed) -> f64 {
        let rate = (1.0 - self.initial) / self.rise;
        // it stands until the voltage carries the load
        let carried = sqrt(load.constant.max(0.0) / motor.starting_torque().0);
        if !(self.peak > load.constant && to.0.is_finite()) {
            return f64::INFINITY;
        }
        let (mut share, mut speed) = (self.initial.max(carried), 0.0);
        let mut time = (share - self.initial) / rate;
        let coarse = machine.inertia * to.0 / self.peak / STEPS;
        let mut step = coarse.min(self.rise / STEPS);
        let (mut moved, mut left) = (0.0, 50.0 * STEPS);
        while speed < to.0 {
            if share >= 1.0 {
                return time + Characteristic::Induction(*motor).time_to(machine, load, Speed(speed), to);
            }
            // Runge and Kutta's step of fourth order
            let mut rates = [0.0; 4];
            each!(k, 0..4, {
                let part = [0.0, 0.5, 0.5, 1.0][k] * step;
                let then = speed + part * if k > 0 { rates[k - 1] } else { 0.0 };
                let share = self.share(motor, then, share, part * rate);
                let torque = share * share * motor.torque(Speed(then)).0 - load.torque(Speed(then)).0;
                rates[k] = torque / machine.inertia;
            });
            let next = (speed + step * (rates[0] + 2.0 * (rates[1] + rates[2]) + rates[3]) / 6.0).max(0.0);
            share = self.share(motor, next, share, step * rate);
            if next >= to.0 {
                return time + step * (to.0 - speed) / (next - speed);
            }
            let limited = share == self.share(motor, next, share, 1.0);
            left -= 1.0;
            if left < 0.0 || limited && next <= speed {
                return f64::INFINITY;
            }
            (time, speed, moved) = (time + step, next, moved + step);
            if limited {
                step = coarse;
            }
            // a rise that is slow against the start
            step = step.max(0.5 * moved / STEPS);
        }
        time
    }

    /// The share of the voltage at a speed: that of the largest torque, as far as it can change.
    const fn share(&self, motor: &Induction, speed: f64, share: f64, change: f64) -> f64 {
        let wanted = sqrt(self.peak / motor.torque(Speed(speed)).0);
        let wanted = if wanted < 1.0 { wanted } else { 1.0 };
        wanted.max(share - change).min(share + change)
    }
}
