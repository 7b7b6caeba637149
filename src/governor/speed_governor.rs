//! A speed governor composed by type: ramp, proportional and integral action with anti-windup, and optional parts.

use super::{
    Compensation, Governor, HasRunSequence, Limit, RunAction, Sequence, Sequencer, SetpointShape, SpeedFilter,
    SymmetricLimit,
};
use crate::number::{Number, Part};
use crate::sample::Estimate;

/// Gains and ramp of [`SpeedGovernor`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gains<N: Number> {
    /// Gain on the error of the speed in a tick, k_p + k_i T (N m s/rad).
    pub proportional: N::Coefficient,
    /// Share of its distance to the limited torque that the integral covers in a tick, k_i T/(k_p + k_i T): 0 to 1.
    pub reset: N::Coefficient,
    /// Largest change of the setpoint in a tick (rad/s).
    pub ramp: N,
}

/// Constants of [`SpeedGovernor`], of the number `N` and those of each part.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedGovernorConfig<N: Number, S, F, L, M, V> {
    /// Gains and ramp.
    pub gains: Gains<N>,
    /// Constants of the setpoint's shaping.
    pub shape: S,
    /// Constants of the compensation.
    pub compensation: F,
    /// Constants of the limit.
    pub limit: L,
    /// Constants of the run sequence.
    pub sequence: M,
    /// Constants of the filter.
    pub filter: V,
}

/// State of the governor, by its parts: `S` shapes the setpoint, `F` compensates, `L` limits the torque, `M` is the run
/// sequence, `V` filters the speed.
///
/// ```text
/// omega* = ramp(setpoint) - droop,     e = omega* - omega_m
/// tau    = limit(k e + I + c),         I' = I + r (tau - c - I)
/// ```
///
/// with gain k and reset r as in [`SpeedLoop`](super::SpeedLoop) and the compensation c. The integral follows the
/// limited torque, whichever part limits it: torque, power or slew. [`BacklashTakeUp`](super::BacklashTakeUp) moves the
/// ramped setpoint back as well.
///
/// - **`S`**, shaping of the setpoint: `()` isochronous, [`Droop`](super::Droop), [`Barred`](super::Barred)
/// - **`F`**, compensation: `()` none, [`FeedForward`](super::FeedForward), [`ActiveDamping`](super::ActiveDamping),
///   [`AccelerationFeedback`](super::AccelerationFeedback)
/// - **`L`**, the limit: [`SymmetricLimit`], [`TorqueRange`](super::TorqueRange), [`Curve`](super::Curve),
///   [`Slew`](super::Slew) or [`BacklashTakeUp`](super::BacklashTakeUp) round any of them
/// - **`M`**, run sequence: `()` always governing, [`Sequencer`](super::Sequencer)
/// - **`V`**, speed filter: `()` none, [`MovingAverage`](super::MovingAverage) over an engine's firing interval,
///   [`CycleAverage`](super::CycleAverage) over a cycle
///
/// Two parts of one kind are a tuple: `(Droop, Barred<2>)`. A part left out costs nothing.
///
/// ```
/// use driveline::governor::*;
/// use driveline::sample::Estimate;
/// // nothing but a proportional part of 20 N m s/rad and the limit; a drive has all of it from its machine
/// const CONFIG: SpeedGovernorConfig<f64, (), (), SymmetricLimitConfig<f64>, (), ()> = SpeedGovernorConfig {
///     gains: Gains { proportional: 20.0, reset: 0.0, ramp: 5.0 },
///     limit: SymmetricLimitConfig { torque: 550.0 },
///     shape: (), compensation: (), sequence: (), filter: (),
/// };
/// let mut governor = SpeedGovernor::<(), (), SymmetricLimit, (), (), f64>::default();
/// governor.set_setpoint(150.0);
/// // the ramp has moved by 5 rad/s in the first tick
/// assert_eq!(governor.command(&CONFIG, &Estimate::default()), 20.0 * 5.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("PI", "PID", "anti-windup"))]
pub struct SpeedGovernor<S = (), F = (), L = SymmetricLimit, M = (), V = (), N = f32> {
    integral: N,
    ramped: N,
    setpoint: N,
    shape: S,
    compensation: F,
    limit: L,
    sequence: M,
    filter: V,
}

impl<N, S, F, L, M, V> Part<N> for SpeedGovernor<S, F, L, M, V>
where
    S: Part<N>,
    F: Part<N>,
    L: Part<N>,
    M: Part<N>,
    V: Part<N>,
{
    type State = SpeedGovernor<S::State, F::State, L::State, M::State, V::State, N>;
}

impl<N, S, F, L, V> HasRunSequence for SpeedGovernor<S, F, L, Sequencer, V, N> {
    fn sequencer(&self) -> &Sequencer {
        &self.sequence
    }

    #[inline(always)]
    fn sequencer_mut(&mut self) -> &mut Sequencer {
        &mut self.sequence
    }
}

impl<N, S, F, L, M, V> SpeedGovernor<S, F, L, M, V, N>
where
    N: Number,
    S: SetpointShape<N>,
    F: Compensation<N>,
    L: Limit<N>,
    M: Sequence<N>,
    V: SpeedFilter<N>,
{
    /// The ramped setpoint, before the droop (rad/s).
    pub fn ramped_setpoint(&self) -> N {
        self.ramped
    }

    /// The integral (N m).
    pub fn integral(&self) -> N {
        self.integral
    }

    /// Bumpless transfer from the constants `from` to `to`: the next tick's torque is as under `from`. Call it once,
    /// between two ticks, when gains, droop or feed-forward change. The integral takes over the difference of the
    /// torques, up to twice the limit; the ramped setpoint that of the droops, and returns by its ramp.
    pub fn switch(
        &mut self,
        from: &<Self as Governor<N>>::Config,
        to: &<Self as Governor<N>>::Config,
        estimate: &Estimate<N>,
    ) {
        let estimate = &self.filter.filtered(estimate);
        let target = self.target(from, estimate);
        let error = target - estimate.motor_speed;
        // The proportional part of saturation counts as four limits, which every number holds.
        let most = self.limit.most(&to.limit, estimate);
        let twice = most + most;
        let wanted = |c: &<Self as Governor<N>>::Config| {
            self.standing(c, estimate) + error.gained::<4>(c.gains.proportional).limited(twice + twice)
        };
        self.integral = (self.integral + (wanted(from) - wanted(to)).limited(twice)).limited(twice);
        // With the compensation three: less four of the proportional part, it is the limit the other way.
        let standing = self.standing(to, estimate);
        self.integral = self.integral + (standing.limited(twice + most) - standing);
        self.ramped = self.ramped + (target - self.target(to, estimate));
    }

    /// The setpoint after the droop.
    #[inline(always)]
    fn target(&self, config: &<Self as Governor<N>>::Config, estimate: &Estimate<N>) -> N {
        let standing = self.compensation.steady(&config.compensation, estimate, self.integral);
        self.shape.lower(&config.shape, self.ramped, standing)
    }

    /// The integral with the compensation, within what can be added to.
    #[inline(always)]
    fn standing(&self, config: &<Self as Governor<N>>::Config, estimate: &Estimate<N>) -> N {
        let steady = self.compensation.steady(&config.compensation, estimate, self.integral);
        self.compensation.transient(&config.compensation, estimate, steady).addable()
    }

    /// Starts from the present speed with this permitted torque, steady (bumpless transfer).
    fn begin(&mut self, config: &<Self as Governor<N>>::Config, estimate: &Estimate<N>, torque: N) {
        let speed = estimate.motor_speed;
        let lowered = self.shape.lower(&config.shape, speed, torque);
        self.ramped = speed + (speed - lowered);
        let beyond = self.compensation.steady(&config.compensation, estimate, torque) - torque;
        self.integral = F::held(torque - beyond);
        self.limit.start(torque);
    }
}

impl<N, S, F, L, M, V> Governor<N> for SpeedGovernor<S, F, L, M, V, N>
where
    N: Number,
    S: SetpointShape<N>,
    F: Compensation<N>,
    L: Limit<N>,
    M: Sequence<N>,
    V: SpeedFilter<N>,
{
    type Config = SpeedGovernorConfig<N, S::Config, F::Config, L::Config, M::Config, V::Config>;

    const COMMANDS: bool = true;

    #[inline(always)]
    fn set_setpoint(&mut self, setpoint: N) {
        self.setpoint = setpoint;
    }

    #[inline(always)]
    fn set_steady_speed(&mut self, steady_speed: Option<N>) {
        self.filter.set_steady_speed(steady_speed);
    }

    #[inline(always)]
    fn set_known_torque(&mut self, known_torque: N) {
        self.compensation.set_known_torque(known_torque);
    }

    #[inline(always)]
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        let mut carry = N::CARRY;
        let filtered = self.filter.filter(&config.filter, estimate);
        let monitored = V::monitored(estimate, &filtered);
        let estimate = &filtered;
        let mut setpoint = self.setpoint;
        match self.sequence.action(&config.sequence, monitored) {
            RunAction::Govern => {}
            RunAction::Begin => self.begin(config, estimate, N::ZERO),
            RunAction::Brake => setpoint = N::ZERO,
            RunAction::Idle => return N::ZERO,
        }
        let (goal, ramp) = self.shape.goal(&config.shape, setpoint, self.ramped, config.gains.ramp);
        self.ramped = self.ramped + (goal - self.ramped).limited(ramp);
        let error = self.target(config, estimate) - estimate.motor_speed;
        let standing = self.standing(config, estimate);
        let wanted = (standing + error.gained::<4>(config.gains.proportional)).saturated();
        let torque = self.limit.limit(&config.limit, estimate, wanted);
        self.ramped = self.limit.track(&config.limit, self.ramped, wanted);
        self.integral = F::held(self.integral.accumulate(&mut carry, [config.gains.reset], [torque - standing]));
        torque
    }

    fn switch(&mut self, from: &Self::Config, to: &Self::Config, estimate: &Estimate<N>) {
        SpeedGovernor::switch(self, from, to, estimate);
    }

    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        if self.sequence.permits() { self.limit.permitted(&config.limit, estimate, torque) } else { N::ZERO }
    }

    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>, torque: N) {
        self.sequence.start();
        self.filter.start(&config.filter, estimate);
        self.begin(config, estimate, torque);
        self.setpoint = N::ZERO;
    }

    fn angle_lost(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.filter.start(&config.filter, estimate);
        self.begin(config, estimate, N::ZERO);
        self.setpoint = N::ZERO;
        self.sequence.angle_lost();
    }
}
