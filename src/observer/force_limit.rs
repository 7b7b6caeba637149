//! The limit of the force at a mechanism's tool, from the estimated load torque.

use crate::number::Number;
use crate::sample::Estimate;

/// The limit of the tool's force, without a division in a tick. Beyond it, stop a supervised drive:
/// [`Supervised::stop`](crate::governor::Supervised::stop).
///
/// The estimate follows a load torque that rises evenly with the delay D of
/// [`MechanismDesign::load_delay`](crate::design::MechanismDesign::load_delay). It is judged where it will be by then:
/// `tau + (tau - m)/4`, m the load torque behind a lag of 3 D, which is 3/4 D ahead of a steady rise and has a quarter
/// more noise \[derived\]. The share is chosen on drawn presses.
///
/// ```
/// use driveline::design::{Disturbance, Encoder, MechanismDesign, Rate};
/// use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism};
/// use driveline::observer::{ForceLimit, ForceLimitConfig};
/// use driveline::{sample::Estimate, settings::Bases};
/// const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.6), Inertia(1.0), Mass(40.0));
/// const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(2.0), &Mechanism::slider_crank(&RAM), 1, 1);
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 1.0, load_torque_step: 50.0, within: 1.0 };
/// const DESIGN: MechanismDesign = PRESS.observer(Rate::hz(1000), Encoder::lines(2048), LOAD);
/// // 4 kN beside an idle torque of 5 N m
/// static LIMIT: ForceLimitConfig<f64> = ForceLimitConfig::<f64>::new(&DESIGN, 4_000.0, 5.0, 0.25, Bases::SI);
/// let (mut limit, pressing) = (ForceLimit::default(), Estimate { load_torque: 255.0, ..Estimate::default() });
/// for _ in 0..5000 {
///     limit.is_exceeded(&LIMIT, 1.0, &pressing);
/// }
/// // 250 N m on the largest leverage of 0.1 m are 2.5 kN; at half of the leverage they are 5 kN
/// assert!(!limit.is_exceeded(&LIMIT, 1.0, &pressing) && limit.is_exceeded(&LIMIT, 0.5, &pressing));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ForceLimit<N> {
    /// The tool's torque behind the lag (N m).
    lagged: N,
}

/// Constants of a [`ForceLimit`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ForceLimitConfig<N: Number> {
    /// Torque of the limit at the largest leverage (N m).
    pub torque: N,
    /// Idle torque (N m), which is not the tool's.
    pub idle: N,
    /// Least leverage, per unit of the largest, at which the force is judged.
    pub least: N,
    /// Share by which the torque is judged ahead, and that of the lag in a tick.
    pub lead: [N::Coefficient; 2],
}

impl<N: Number> ForceLimit<N> {
    /// Whether the tool's force is beyond the limit, from the leverage of a
    /// [`ToolObserver`](crate::observer::ToolObserver) and the estimate of the same tick. Never near a dead centre. To
    /// be called in every tick.
    #[inline(always)]
    pub fn is_exceeded(&mut self, config: &ForceLimitConfig<N>, leverage: N, estimate: &Estimate<N>) -> bool {
        let [ahead, share] = config.lead;
        let torque = estimate.load_torque - config.idle;
        let rise = torque - self.lagged;
        // an estimate that is no number is forgotten with the lag
        self.lagged = (self.lagged + rise.times(share)).limited(config.torque);
        leverage.exceeds(config.least)
            && (torque + rise.times(ahead)).exceeds(config.torque.scaled(leverage.magnitude()))
    }
}
