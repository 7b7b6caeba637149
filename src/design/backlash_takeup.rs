//! Design of backlash take-up: approach speed, torque rise and damping from the permissible impact.

use super::Error;
use super::tuning::Rate;
use crate::machine::TwoMass;
use crate::math::sqrt;

/// Tuning of backlash take-up.
///
/// ```
/// use driveline::design::{BacklashTakeUpDesign, BacklashTakeUpTuning, Rate};
/// use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
/// const SLACK: TwoMass =
///     TwoMass::new(Inertia(0.5), Inertia(0.5), Stiffness(1.0e4), Damping(0.5)).with_gap(Gap(0.02));
/// const GENTLE: BacklashTakeUpTuning = BacklashTakeUpTuning {
///     impact: 100.0, torque: 50.0, rise: 200.0, fall: 400.0, max_torque: 550.0, damping: 0.05,
/// };
/// // an impact of 100 N m is one of 100/sqrt(1e4 * 0.25) = 2 rad/s; 200 N m in a period of 2 pi/200 s
/// const DESIGN: BacklashTakeUpDesign = SLACK.take_up(Rate::hz(10_000), GENTLE);
/// assert!((DESIGN.approach_speed - 2.0).abs() < 1e-9 && (DESIGN.slew - 6366.2).abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashTakeUpTuning {
    /// Torque that the impact may add in the shaft (N m), above 0.
    pub impact: f64,
    /// Largest torque while the gap is open (N m), above 0.
    pub torque: f64,
    /// Rise of the torque limit per period of the resonance, on the driven flank (N m), above 0.
    pub rise: f64,
    /// Fall of the torque limit per period of the resonance, in the gap and on the other flank (N m), above 0; at once
    /// if infinite.
    pub fall: f64,
    /// Largest torque that the limit rises to (N m), the motor's; at least [`torque`](Self::torque). Active damping is
    /// added to it, so that the limit behind the take-up is the final one.
    pub max_torque: f64,
    /// Damping ratio that the motor adds to the shaft; not negative.
    pub damping: f64,
}

/// Design of backlash take-up.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashTakeUpDesign {
    /// Time between two ticks (s).
    pub period: f64,
    /// Approach speed: largest twist rate in an open gap (rad/s).
    pub approach_speed: f64,
    /// Largest torque while the gap is open (N m).
    pub torque: f64,
    /// Damping of the twist rate while the gap is open (N m s/rad): torque over approach speed.
    pub braking: f64,
    /// Rate at which the largest torque rises on the driven flank (N m/s).
    pub slew: f64,
    /// Rate at which it falls in the gap and on the other flank (N m/s), at most to the least within a tick.
    pub fall: f64,
    /// Largest torque of the motor (N m).
    pub max_torque: f64,
    /// Active damping in contact (N m s/rad).
    pub damping: f64,
}

impl TwoMass {
    stops! {
        /// Designs backlash take-up.
        ///
        /// The approach speed is the impact over `sqrt(k J_m J_l/(J_m + J_l))` [derived; headings: Huang 1987 ch. 3 to
        /// 7], the damping `2 zeta omega J_m` (derived; the motor's torque alone).
        pub const fn take_up(&self, rate: Rate, tuning: BacklashTakeUpTuning) -> BacklashTakeUpDesign = try_take_up
    }

    /// [`take_up`](Self::take_up), with an error instead of a panic.
    ///
    /// # Errors
    /// A machine out of range; [`Error::Unobservable`] without stiffness; [`Error::Slack`].
    pub const fn try_take_up(&self, rate: Rate, tuning: BacklashTakeUpTuning) -> Result<BacklashTakeUpDesign, Error> {
        get!(self.check(), Error::Machine);
        let period = get!(rate.period());
        if self.stiffness == 0.0 {
            return Err(Error::Unobservable);
        }
        let BacklashTakeUpTuning { impact, torque, rise, fall, max_torque, damping } = tuning;
        let w = self.resonance();
        let (falling, at_once) = (fall * w / core::f64::consts::TAU, max_torque / period);
        let approach_speed = impact / sqrt(self.stiffness * self.reduced_inertia());
        let design = BacklashTakeUpDesign {
            period,
            approach_speed,
            torque,
            braking: torque / approach_speed,
            slew: rise * w / core::f64::consts::TAU,
            fall: if falling < at_once { falling } else { at_once },
            max_torque,
            damping: 2.0 * damping * w * self.motor_inertia,
        };
        let positive =
            impact > 0.0 && torque > 0.0 && rise > 0.0 && fall > 0.0 && max_torque >= torque && damping >= 0.0;
        let sum = design.approach_speed + design.braking + design.torque + design.slew + max_torque + design.damping;
        if positive && sum.is_finite() { Ok(design) } else { Err(Error::Slack) }
    }
}
