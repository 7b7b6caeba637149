//! Selection of an observer, by the error of each simplification.

use super::{EstimateError, SemiImplicitStep, StepChoice};
use crate::machine::TwoMass;
use crate::math::{exp_m1, sqrt};

/// Load cycle, as far as it excites the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadCycle {
    /// Rated speed (rad/s), which errors of speed are fractions of.
    pub speed: f64,
    /// Peak torque of the shaft (N m), which errors of torque are fractions of.
    pub torque: f64,
    /// Largest change of torque that comes about at once, of the motor's or the load's (N m).
    pub change: f64,
    /// How long it takes (s), 0 for a step.
    pub rise: f64,
    /// Time between two such changes (s).
    pub every: f64,
    /// Whether the shaft's torque changes its sign, so that a gap opens and closes.
    pub reverses: bool,
}

/// Required accuracy, rms.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Requirement {
    /// Error of the shaft torque, over its peak.
    pub shaft_torque: f64,
    /// Error of the load speed, over rated speed.
    pub load_speed: f64,
}

impl Requirement {
    /// 2 % of the shaft's peak torque and 0.3 % of rated speed.
    pub const USUAL: Self = Self { shaft_torque: 0.02, load_speed: 0.003 };

    /// Share of the requirement available to a simplification.
    pub const SHARE: f64 = 0.5;
}

/// Error of a simplification, rms.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Penalty {
    /// Error of the shaft torque, over its peak.
    pub shaft_torque: f64,
    /// Error of the load's speed, over rated speed.
    pub load_speed: f64,
}

impl Penalty {
    const fn within(&self, aim: &Requirement) -> bool {
        self.shaft_torque <= Requirement::SHARE * aim.shaft_torque
            && self.load_speed <= Requirement::SHARE * aim.load_speed
    }
}

/// The observers there are, the cheapest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ObserverChoice {
    /// One mass.
    Rigid,
    /// Two masses, the semi-implicit step.
    SemiImplicit,
    /// Two masses, the exact step.
    Exact,
    /// Two masses with a gap between them.
    Backlash,
}

/// Errors of each observer, and the cheapest that meets the requirement.
///
/// A change of torque, of the motor's or the load's, sets the shaft swinging. A rigid observer shows the steady part of
/// the shaft's torque and not the swing; an observer that takes a gap for closed does not see the blow with which it
/// closes. Both errors follow from the machine and its load cycle:
///
/// - a change D that takes the time r sets off a swing of at most `D min(1, 2/(w r))` times the larger share of the
///   inertia [derived; headings: Huang 1987 ch. 3 to 7];
/// - a gap that is crossed under the torque D closes at `v = sqrt(2 D gap/J_m)`, and the blow swings by `v sqrt(k J_r)`
///   [derived; headings: Huang 1987 ch. 3 to 7];
/// - a swing A in the shaft's torque is one of `A w/k J_m/J` in the load's speed, and decays as `exp(-zeta w t)` until
///   the next change.
///
/// The figures are rms over the time between two changes. Noise and lag, common to all observers, come on top. A
/// simpler observer is therefore chosen only where its error is at most half of the requirement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObserverSelection {
    /// Cost of leaving out the shaft.
    pub without_shaft: Penalty,
    /// Cost of leaving out the gap; nothing where there is none or the torque does not reverse.
    pub without_gap: Penalty,
    /// Error of the semi-implicit step over a period of the resonance, as [`StepChoice`] takes it.
    pub semi_implicit: f64,
    /// The cheapest sufficient observer.
    pub chosen: ObserverChoice,
}

impl ObserverSelection {
    /// Errors of one mass over those of two masses up to which it is selected: closer than either is predicted.
    pub const AS_GOOD: f64 = 1.05;

    /// The selection over the tolerances of machine, motor and encoder, by the predicted errors of both observers: one
    /// mass where its errors of shaft torque and load speed are as good as those of two masses.
    ///
    /// Two masses follow the swings of the shaft, and amplify errors of the encoder and of the model more than one
    /// mass does.
    #[must_use]
    pub const fn over_tolerances(self, rigid: &EstimateError, two_masses: &EstimateError) -> Self {
        let as_good = rigid.shaft_torque <= Self::AS_GOOD * two_masses.shaft_torque
            && rigid.load_speed <= Self::AS_GOOD * two_masses.load_speed;
        match self.chosen {
            ObserverChoice::SemiImplicit | ObserverChoice::Exact if as_good => {
                Self { chosen: ObserverChoice::Rigid, ..self }
            }
            _ => self,
        }
    }
}

impl TwoMass {
    /// The observer for a load cycle, at a tick period (s).
    ///
    /// A scene may take another, at the cost of the excess error. Without damping a swing does not decay.
    #[must_use]
    pub const fn select_observer(&self, cycle: &LoadCycle, aim: &Requirement, period: f64) -> ObserverSelection {
        let without_shaft = self.swing(self.amplitude_after(cycle), cycle);
        let without_gap = if cycle.reverses && self.gap > 0.0 {
            let closing = sqrt(2.0 * cycle.change * self.gap / self.motor_inertia);
            self.swing(self.impact_torque(closing).0, cycle)
        } else {
            Penalty { shaft_torque: 0.0, load_speed: 0.0 }
        };
        let step = SemiImplicitStep::new(self, period);
        let chosen = if !without_gap.within(aim) {
            ObserverChoice::Backlash
        } else if without_shaft.within(aim) {
            ObserverChoice::Rigid
        } else {
            match StepChoice::choose(&step, StepChoice::THRESHOLD) {
                StepChoice::SemiImplicit => ObserverChoice::SemiImplicit,
                StepChoice::Exact => ObserverChoice::Exact,
            }
        };
        ObserverSelection { without_shaft, without_gap, semi_implicit: step.fidelity.error_bound, chosen }
    }

    /// Largest amplitude of the shaft torque's swing after a change of the load cycle (N m).
    pub(super) const fn amplitude_after(&self, cycle: &LoadCycle) -> f64 {
        let share = if self.motor_inertia > self.load_inertia { self.motor_inertia } else { self.load_inertia };
        let turned = self.resonance() * cycle.rise;
        let damped = if turned > 2.0 { 2.0 / turned } else { 1.0 };
        cycle.change * damped * share / self.total_inertia()
    }

    /// Rms of an amplitude that decays until the next change.
    pub(super) const fn rms_until(&self, every: f64, amplitude: f64) -> f64 {
        let decays = 2.0 * self.damping_ratio() * self.resonance() * every;
        // The mean of exp(-x) over the interval.
        let left = if decays > 0.0 { -exp_m1(-decays) / decays } else { 1.0 };
        amplitude * sqrt(0.5 * left)
    }

    /// Rms error of a shaft torque oscillation of this amplitude (N m), until the next change.
    const fn swing(&self, amplitude: f64, cycle: &LoadCycle) -> Penalty {
        let resonance = self.resonance();
        let rms = self.rms_until(cycle.every, amplitude);
        let speed = rms * resonance / self.stiffness * (self.motor_inertia / self.total_inertia());
        Penalty { shaft_torque: rms / cycle.torque, load_speed: speed / cycle.speed }
    }
}
