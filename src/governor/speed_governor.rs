//! A governor composed by type: ramp, proportional and integral with anti-windup, and whatever else the machine needs.
//!
//! ```text
//! omega* = ramp(reference) - droop,    e = omega* - omega_m
//! tau    = limit(k_p e + I + prompt),  I' = I + k_i e + k_u (tau - wanted)
//! ```
//!
//! What the limit cuts off is taken from the integral at the rate at which it would otherwise have grown
//! (back-calculation), so that it does not wind up, whichever part of the limit cuts: torque, power or slew.
//!
//! | parameter | parts |
//! |---|---|
//! | `S`, the set point | `()` isochronous, [`Droop`](super::Droop), [`Barred`](super::Barred) |
//! | `F`, added torque | `()`, [`FeedForward`](super::FeedForward), [`ActiveDamping`](super::ActiveDamping), [`AccelerationFeedback`](super::AccelerationFeedback) |
//! | `L`, the limit | [`Symmetric`], [`Between`](super::Between), [`Curve`](super::Curve), [`Slew`](super::Slew) or [`Slack`](super::Slack) round any of them |
//! | `M`, the modes | `()` always at work, [`Modes`](super::Modes) |
//! | `V`, the view | `()` the estimates as they are, [`Mean`](super::Mean) over an engine's firing interval, [`OverCycle`](super::OverCycle) without what repeats every cycle |
//!
//! Two parts of one kind are a tuple: `(Droop, Barred<f32, 2>)`. What is left out costs nothing.

use super::{Duty, Governor, Limit, Prompt, SetPoint, Supervisor, Symmetric, View};
use crate::number::Number;
use crate::sample::Estimate;

/// Gains and ramp of [`SpeedGovernor`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gains<N: Number> {
    /// Proportional gain k_p [N m s/rad].
    pub proportional: N::Coefficient,
    /// Integral gain per tick, k_i T [N m s/rad].
    pub integral: N::Coefficient,
    /// The share of what the limit cuts off that is taken from the integral in a tick, k_i T/k_p.
    pub unwinding: N::Coefficient,
    /// Largest change of the set point in a tick [rad/s].
    pub ramp: N,
}

/// Constants of [`SpeedGovernor`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedGovernorConfig<N: Number, S, F, L, M, V> {
    /// Gains and ramp.
    pub gains: Gains<N>,
    /// Constants of what shapes the set point.
    pub set_point: S,
    /// Constants of what adds torque.
    pub prompt: F,
    /// Constants of the limit.
    pub limit: L,
    /// Constants of the modes.
    pub supervisor: M,
    /// Constants of the view.
    pub view: V,
}

/// The constants of a governor composed of these parts.
pub type SpeedGovernorConfigOf<N, S = (), F = (), L = Symmetric, M = (), V = ()> = SpeedGovernorConfig<
    N,
    <S as SetPoint<N>>::Config,
    <F as Prompt<N>>::Config,
    <L as Limit<N>>::Config,
    <M as Supervisor<N>>::Config,
    <V as View<N>>::Config,
>;

/// State of the governor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedGovernor<N, S = (), F = (), L = Symmetric, M = (), V = ()> {
    integral: N,
    set_point: N,
    reference: N,
    shape: S,
    prompt: F,
    limit: L,
    supervisor: M,
    view: V,
}

impl<N, S, F, L, M, V> SpeedGovernor<N, S, F, L, M, V>
where
    N: Number,
    S: SetPoint<N>,
    F: Prompt<N>,
    L: Limit<N>,
    M: Supervisor<N>,
    V: View<N>,
{
    /// Where the ramp stands, before the droop [rad/s].
    pub fn set_point(&self) -> N {
        self.set_point
    }

    /// The integral [N m].
    pub fn integral(&self) -> N {
        self.integral
    }

    /// The modes.
    pub fn supervisor(&self) -> &M {
        &self.supervisor
    }

    /// The modes, to ask for another.
    pub fn supervisor_mut(&mut self) -> &mut M {
        &mut self.supervisor
    }

    /// Makes the next tick's torque under the constants `to` what it would have been under `from`: call it once,
    /// between two ticks, when the constants change (gains, droop, feed-forward). The integral takes up the difference
    /// of the torques; the set point takes up that of the droops, and comes back by its ramp. In fixed point the
    /// integral ends at twice the base.
    pub fn switch(
        &mut self,
        from: &SpeedGovernorConfigOf<N, S, F, L, M, V>,
        to: &SpeedGovernorConfigOf<N, S, F, L, M, V>,
        estimate: &Estimate<N>,
    ) {
        let estimate = &self.view.seen(estimate);
        let target = self.target(from, estimate);
        let error = target.minus(estimate.motor_speed).gain_operand();
        let before = self.wanted(from, estimate, self.integral, error);
        let after = self.wanted(to, estimate, self.integral, error);
        self.integral = self.integral.plus(before.minus(after).saturated()).saturated();
        self.set_point = self.set_point.plus(target.minus(self.target(to, estimate)));
    }

    /// The set point after the droop.
    #[inline(always)]
    fn target(&self, config: &SpeedGovernorConfigOf<N, S, F, L, M, V>, estimate: &Estimate<N>) -> N {
        let standing = self.prompt.stand(&config.prompt, estimate, self.integral);
        self.shape.lower(&config.set_point, self.set_point, standing)
    }

    #[inline(always)]
    fn wanted(
        &self,
        config: &SpeedGovernorConfigOf<N, S, F, L, M, V>,
        estimate: &Estimate<N>,
        integral: N,
        error: N,
    ) -> N {
        let standing = self.prompt.stand(&config.prompt, estimate, integral);
        self.prompt.oppose(&config.prompt, estimate, standing.plus(error.times(config.gains.proportional)))
    }

    /// Starts from the speed that the machine has, with a standing torque, so that the first command is no jolt.
    fn begin(&mut self, config: &SpeedGovernorConfigOf<N, S, F, L, M, V>, estimate: &Estimate<N>, torque: N) {
        let speed = estimate.motor_speed;
        let lowered = self.shape.lower(&config.set_point, speed, torque);
        self.set_point = speed.plus(speed.minus(lowered));
        let beyond = self.prompt.stand(&config.prompt, estimate, torque).minus(torque);
        self.integral = torque.minus(beyond).saturated();
        self.limit.start(torque);
    }
}

impl<N, S, F, L, M, V> Governor<N> for SpeedGovernor<N, S, F, L, M, V>
where
    N: Number,
    S: SetPoint<N>,
    F: Prompt<N>,
    L: Limit<N>,
    M: Supervisor<N>,
    V: View<N>,
{
    type Config = SpeedGovernorConfigOf<N, S, F, L, M, V>;

    const COMMANDS: bool = true;

    #[inline(always)]
    fn refer(&mut self, reference: N) {
        self.reference = reference;
    }

    #[inline(always)]
    fn follow(&mut self, steady_speed: Option<N>) {
        self.view.follow(steady_speed);
    }

    #[inline(always)]
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        let mut carry = N::CARRY;
        let seen = self.view.see(&config.view, estimate);
        let watched = V::watched(estimate, &seen);
        let estimate = &seen;
        let mut reference = self.reference;
        match self.supervisor.duty(&config.supervisor, watched) {
            Duty::Govern => {}
            Duty::Begin => self.begin(config, estimate, N::ZERO),
            Duty::Brake => reference = N::ZERO,
            Duty::Idle => return N::ZERO,
        }
        let (aim, ramp) = self.shape.aim(&config.set_point, reference, self.set_point, config.gains.ramp);
        self.set_point = self.set_point.plus(aim.minus(self.set_point).limited(ramp));
        let error = self.target(config, estimate).minus(estimate.motor_speed).gain_operand();
        let integral = self.integral.accumulate(&mut carry, config.gains.integral, error);
        let wanted = self.wanted(config, estimate, integral, error).saturated();
        let torque = self.limit.limit(&config.limit, estimate, wanted);
        let excess = torque.minus(wanted);
        self.integral = integral.accumulate(&mut carry, config.gains.unwinding, excess).saturated();
        torque
    }

    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>, torque: N) {
        self.supervisor.start();
        self.view.start(&config.view, estimate);
        self.begin(config, estimate, torque);
        self.reference = N::ZERO;
    }

    fn lost(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.view.start(&config.view, estimate);
        self.begin(config, estimate, N::ZERO);
        self.reference = N::ZERO;
        self.supervisor.lose();
    }

    #[inline(always)]
    fn permits(&self) -> bool {
        self.supervisor.permits()
    }
}
