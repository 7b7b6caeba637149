//! Observer of two masses with a backlash between them, from the motor's angle alone.

use super::tuning::{Disturbance, Encoder, Rate, Variances};
use super::{Error, ExactStep, Kalman, Matrix, TwoMassDesign};
use crate::machine::TwoMass;
use crate::math::sqrt;

/// How the observer looks for the flank after an open gap.
///
/// Two sets of gains, both steady states of a Kalman filter of the shaft in contact. The settled ones are
/// [`TwoMass::observer`]'s. The searching ones are those of a shaft with random walks of twist and load speed: an open
/// gap leaves the position of the flank and the speed of the impact unknown, and the filter draws both to their values
/// within a few milliseconds of it.
///
/// How far they are to wander and how long the searching gains stand is [`BacklashTuning`], in units of the gap and of
/// the resonance. [`BacklashTuning::USUAL`] was found by search over two-mass machines of 5 to 150 Hz, motor to load
/// from 3:1 to 1:4. The gaps were a third to the whole of the twist under rated torque, the reversals random.
///
/// A motor that outweighs its load needs other numbers: a mill with 5.5 times the rolls' inertia that bites within
/// 50 ms, 0.08, 0.12, 0.45 and 0.42 (`cargo lab backlash --bites 20`). An impact moves such a motor little, and
/// lively gains follow noise. A load torque that wanders less leaves the innovations after the impact to twist and load
/// speed.
///
/// ```
/// use driveline::design::{BacklashDesign, BacklashTuning, Disturbance, Encoder, Rate};
/// use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
/// const SLACK: TwoMass =
///     TwoMass::new(Inertia(0.5), Inertia(0.5), Stiffness(1.0e4), Damping(0.5)).with_gap(Gap(0.02));
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 3.0, load_torque_step: 150.0, within: 10.0 };
/// // searching gains for a whole period after the impact: 2 pi/200 s, 10,000 ticks a second
/// const LONGER: BacklashTuning = BacklashTuning { hold: 1.0, ..BacklashTuning::USUAL };
/// const DESIGN: BacklashDesign = SLACK.backlash_observer(Rate::hz(10_000), Encoder::lines(2048), LOAD, LONGER);
/// assert!(DESIGN.hold.abs_diff(314) <= 1);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashTuning {
    /// Root mean square by which the twist is taken to wander in a period of the resonance, as a share of the gap;
    /// above 0.
    pub wander: f64,
    /// The same of the load speed, as a share of the gap times the resonance's angular frequency; not negative.
    pub speed_wander: f64,
    /// How far the load torque wanders meanwhile, as a share of the disturbance's; above 0.
    pub torque_wander: f64,
    /// How long the searching gains stand after the gap has closed, in periods of the resonance; not negative.
    pub hold: f64,
}

impl BacklashTuning {
    /// A quarter of the gap, the load as in contact, and three fifths of a period.
    pub const USUAL: Self = Self { wander: 0.25, speed_wander: 0.0, torque_wander: 1.0, hold: 0.6 };
}

/// A finished observer of two masses with backlash.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashDesign {
    /// The observer of the same machine in contact; its gains are the settled ones.
    pub contact: TwoMassDesign,
    /// The step of twist and twist rate in free flight.
    pub free: ExactStep,
    /// Whole free travel of the gap (rad).
    pub gap: f64,
    /// Searching gains: correction of each state per radian of innovation.
    pub searching: [f64; 5],
    /// Largest size of a pole of the estimate's error with the searching gains, in contact.
    pub searching_radius: f64,
    /// Predicted standard deviation of the twist with the searching gains (rad).
    pub searching_twist: f64,
    /// Ticks for which the searching gains stand after the gap has closed, at least 1.
    pub hold: u32,
}

impl TwoMass {
    stops! {
        /// Designs the observer of a machine with backlash.
        pub const fn backlash_observer(
            &self,
            rate: Rate,
            encoder: Encoder,
            disturbance: Disturbance,
            tuning: BacklashTuning,
        ) -> BacklashDesign = try_backlash_observer
    }

    /// [`backlash_observer`](Self::backlash_observer), with an error instead of a panic.
    ///
    /// # Errors
    /// Those of [`TwoMass::try_observer`]; [`Error::NoGap`], [`Error::Wander`], [`Error::Hold`].
    pub const fn try_backlash_observer(
        &self,
        rate: Rate,
        encoder: Encoder,
        disturbance: Disturbance,
        tuning: BacklashTuning,
    ) -> Result<BacklashDesign, Error> {
        let contact = get!(self.try_observer(rate, encoder, disturbance));
        if self.gap == 0.0 {
            return Err(Error::NoGap);
        }
        let period = contact.period;
        let ticks_a_period = core::f64::consts::TAU / (self.resonance() * period);
        let (step, speed) = (tuning.wander * self.gap, tuning.speed_wander * self.gap * self.resonance());
        let wandered = step * step / ticks_a_period;
        let load_speed = speed * speed / ticks_a_period;
        let share = tuning.torque_wander * tuning.torque_wander;
        let positive = tuning.wander > 0.0 && tuning.speed_wander >= 0.0 && tuning.torque_wander > 0.0;
        if !(positive && wandered > 0.0 && wandered.is_finite() && load_speed.is_finite() && share.is_finite()) {
            return Err(Error::Wander);
        }
        let hold = tuning.hold * ticks_a_period;
        if !(hold >= 0.0 && hold <= u32::MAX as f64) {
            return Err(Error::Hold);
        }
        let Variances { angle, torque, load_torque, .. } = get!(Variances::of(rate, encoder, &disturbance));
        let mut noise = Matrix::<5, 1>::square_of(&contact.input, torque);
        noise.0[2][2] += wandered;
        noise.0[3][3] += load_speed;
        noise.0[4][4] += share * load_torque;
        let seen = Matrix([[1.0, 0.0, 0.0, 0.0, 0.0]]);
        let filter = get!(Kalman::<5, 1>::design(&contact.transition, &seen, &noise, &Matrix([[angle]])));
        Ok(BacklashDesign {
            contact,
            free: ExactStep::from_rates(0.0, 0.0, period),
            gap: self.gap,
            searching: filter.gain.transpose().0[0],
            searching_radius: filter.spectral_radius,
            searching_twist: sqrt(filter.posterior.0[2][2]),
            // To the nearest tick, and the tick of the impact at the least.
            hold: if hold < 1.5 { 1 } else { (hold + 0.5) as u32 },
        })
    }
}
