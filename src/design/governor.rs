//! Design of a governor with a slow actuator: a fuel rack, a steam valve.

use super::late_loop::{Averaging, Late, LateLoop};
use super::margins::{Margins, OpenLoop};
use super::tuning::Rate;
use super::{Error, ExactStep, LoopObserver, NaturalDamping, Robustness};
use crate::machine::TwoMass;
use crate::math::sqrt;

/// Dead time and lag of the actuator.
///
/// ```
/// use driveline::design::Actuator;
/// // 1500 r/min, 40 ms a turn: half of the 13.3 ms between the firings of six cylinders, and a quarter of a turn; of
/// // four cylinders of a two-stroke engine half of 10 ms
/// let speed = 50.0 * core::f64::consts::PI;
/// assert!((Actuator::firing_delay(6, true, speed) - (0.04 / 3.0 / 2.0 + 0.01)).abs() < 1e-15);
/// assert!((Actuator::firing_delay(4, false, speed) - (0.01 / 2.0 + 0.01)).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Actuator {
    /// Dead time (s).
    pub delay: f64,
    /// Time constant of the first-order lag (s).
    pub lag: f64,
}

impl Actuator {
    /// A torque-controlled drive: within a tick.
    pub const DIRECT: Self = Self { delay: 0.0, lag: 0.0 };

    /// The dead time to allow for with a combustion engine (s) at a speed (rad/s): half the interval between two
    /// firings, until the next cylinder takes the new amount of fuel, and a quarter of a turn until its pressure has
    /// become torque. A four-stroke engine fires `cylinders/2` times a turn.
    ///
    /// The form of the usual estimate of the literature on diesel governing. Torque that is delivered in pulses follows
    /// the fuel sooner on average, by the pulse's centre alone; the rule leaves room for an unlucky phase.
    ///
    /// # Errors
    /// [`Error::Actuator`] for a speed that is not positive, or no cylinder.
    pub const fn try_firing_delay(cylinders: u32, four_stroke: bool, speed: f64) -> Result<f64, Error> {
        if cylinders == 0 || !(speed > 0.0 && speed.is_finite()) {
            return Err(Error::Actuator);
        }
        let turn = core::f64::consts::TAU / speed;
        let cycle = if four_stroke { 2.0 * turn } else { turn };
        Ok(0.5 * cycle / cylinders as f64 + 0.25 * turn)
    }

    stops! {
        /// [`try_firing_delay`](Self::try_firing_delay).
        pub const fn firing_delay(cylinders: u32, four_stroke: bool, speed: f64) -> f64 = try_firing_delay
    }
}

/// Feed-forward of the estimated load torque.
///
/// ```
/// use driveline::design::{Actuator, LoadFeedForward, Rate};
/// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
/// const SET: TwoMass = TwoMass::new(Inertia(4.4), Inertia(8.0), Stiffness(5.0e4), Damping(66.0));
/// const RACK: Actuator = Actuator { delay: 0.0, lag: 0.02 };
/// // nine tenths of the load, 18 ms late: they take gain margin, since the estimate depends on the torque
/// const FED: LoadFeedForward = LoadFeedForward { share: 0.9, lag: 0.018 };
/// let [with, without] = [FED, LoadFeedForward::NONE].map(|fed| SET.governor(Rate::hz(2400), RACK, 3.0, fed));
/// assert!(with.margins(&SET).gain_up < without.margins(&SET).gain_up);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "feedforward")]
pub struct LoadFeedForward {
    /// The share, from 0 to 1.
    pub share: f64,
    /// Delay of the estimate, as a first-order lag (s).
    pub lag: f64,
}

impl LoadFeedForward {
    /// Nothing is fed forward.
    pub const NONE: Self = Self { share: 0.0, lag: 0.0 };
}

/// An inertia that the governor gives the machine by the actuator, against the estimated acceleration.
///
/// With a share `s` of the machine's own inertia J the actuator A is closed into the inner loop `A/(1 + s A)`. For a
/// sum of lags that is a lag of `1/(1 + s)` of theirs and of `1/(1 + s)` of their gain. The loop round it is designed
/// for the shorter lag, with the gain left as it is, which is as if the machine were heavier: both raise the margins.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct VirtualInertia {
    /// Share of the machine's total inertia, from 0 to 1.
    pub share: f64,
    /// Delay of the load torque's estimate, as a first-order lag (s).
    pub lag: f64,
}

/// Design of a governor for a slow actuator.
///
/// To a governor slower than the shaft's vibration the machine is one mass of the total inertia J. Dead time and lag of
/// the actuator and the tick act as one equivalent delay T_s, their sum. With `a` the factor of the symmetrical
/// optimum,
///
/// - `k_p = J/(a T_s)`, `k_i = k_p/(a^2 T_s)`
///
/// put the crossover at `1/(a T_s)`, the geometric mean of a range of `a^2` over which the phase stays above -180
/// degrees: the symmetrical optimum [Kessler 1958, Regelungstechnik 6(11); Föllinger, Regelungstechnik, ch. 7]. For a
/// true first-order lag the phase margin is `atan(a) - atan(1/a)`: 37 degrees at 2, 53 at 3.
///
/// Margins are those of the full loop: two masses, sampled, with dead time, lag and feed-forward. P is the machine, A
/// the actuator, C the controller, F the lag of the estimated load torque and g its share. The observer finds the load
/// from the machine's motion and from the torque that acts. The loop cut at the actuator is therefore
/// `A (C P + g F)/(1 - g F A)`. The closed loop is that of `A C P` alone, as long as the actuator matches its model;
/// the margins cover the mismatch. At g = 1 the feed-forward integrates by itself. With a virtual inertia of the share
/// s the estimated acceleration is that of the reported torque plus, delayed, that of the machine's motion. The loop is
/// then `A (C P + s F)/(1 + s (1 - F) A)`.
///
/// ```
/// use driveline::design::{Actuator, LoadFeedForward, Rate};
/// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
/// let stiff = TwoMass::new(Inertia(4.0), Inertia(8.0), Stiffness(5.0e7), Damping(6.0e4));
/// let valve = Actuator { delay: 0.0, lag: 0.1 };
/// let design = stiff.governor(Rate::hz(10_000), valve, 2.0, LoadFeedForward::NONE);
/// assert!((design.margins(&stiff).phase.to_degrees() - 37.0).abs() < 0.5); // atan 2 - atan 1/2
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "symmetrical optimum")]
pub struct GovernorDesign {
    /// Time between two ticks (s).
    pub period: f64,
    /// Proportional gain (N m s/rad).
    pub proportional: f64,
    /// Integral gain (N m/rad).
    pub integral: f64,
    /// Equivalent delay of the loop (s), as reduced by a virtual inertia.
    pub equivalent_delay: f64,
    /// Share of the load torque that is fed forward.
    pub share: f64,
    /// Torque against the acceleration, per torque that accelerates the load.
    pub acceleration: f64,
    /// The actuator.
    pub actuator: Actuator,
    /// Lag of the estimated load torque (s); 0 where nothing is taken of it.
    pub lag: f64,
    /// Natural damping of motor and load.
    pub natural: NaturalDamping,
}

impl TwoMass {
    stops! {
        /// Designs a governor for a slow actuator. `optimum_factor` is a of the symmetrical optimum, above 1; from 2
        /// (fast) to 4 (well damped).
        pub const fn governor(
            &self,
            rate: Rate,
            actuator: Actuator,
            optimum_factor: f64,
            forward: LoadFeedForward,
        ) -> GovernorDesign = try_governor
    }

    /// [`governor`](Self::governor), with an error instead of a panic.
    ///
    /// # Errors
    /// A value out of range, or [`Error::GovernorUnstable`].
    pub const fn try_governor(
        &self,
        rate: Rate,
        actuator: Actuator,
        optimum_factor: f64,
        forward: LoadFeedForward,
    ) -> Result<GovernorDesign, Error> {
        if !(forward.share >= 0.0 && forward.share <= 1.0 && forward.lag >= 0.0 && forward.lag.is_finite()) {
            return Err(Error::FeedForward);
        }
        self.late_governor(rate, actuator, optimum_factor, [forward.share, 0.0, forward.lag])
    }

    stops! {
        /// [`governor`](Self::governor) with a virtual inertia instead of feed-forward.
        pub const fn governor_with_inertia(
            &self,
            rate: Rate,
            actuator: Actuator,
            optimum_factor: f64,
            inertia: VirtualInertia,
        ) -> GovernorDesign = try_governor_with_inertia
    }

    /// [`governor_with_inertia`](Self::governor_with_inertia), with an error instead of a panic.
    ///
    /// # Errors
    /// A value out of range, or [`Error::GovernorUnstable`].
    pub const fn try_governor_with_inertia(
        &self,
        rate: Rate,
        actuator: Actuator,
        optimum_factor: f64,
        inertia: VirtualInertia,
    ) -> Result<GovernorDesign, Error> {
        if !(inertia.share >= 0.0 && inertia.share <= 1.0 && inertia.lag >= 0.0 && inertia.lag.is_finite()) {
            return Err(Error::VirtualInertia);
        }
        self.late_governor(rate, actuator, optimum_factor, [0.0, inertia.share, inertia.lag])
    }

    /// The governor with its use of the estimates: share of the load torque, of the inertia, and their lag.
    const fn late_governor(
        &self,
        rate: Rate,
        actuator: Actuator,
        optimum_factor: f64,
        taken: [f64; 3],
    ) -> Result<GovernorDesign, Error> {
        get!(self.check(), Error::Machine);
        let period = get!(rate.period());
        let Actuator { delay, lag } = actuator;
        if !(delay >= 0.0 && delay.is_finite() && lag >= 0.0 && lag.is_finite()) {
            return Err(Error::Actuator);
        }
        if !(optimum_factor > 1.0 && optimum_factor.is_finite()) {
            return Err(Error::OptimumFactor);
        }
        let [share, inertia, estimate] = taken;
        // The torque acts in the tick after its sample and is held for a tick: another half tick on average.
        let equivalent_delay = (delay + lag + 1.5 * period) / (1.0 + inertia);
        let proportional = self.total_inertia() / (optimum_factor * equivalent_delay);
        let integral = proportional / (optimum_factor * optimum_factor * equivalent_delay);
        let acceleration = inertia * self.total_inertia() / self.load_inertia;
        let lag = if share == 0.0 && inertia == 0.0 { 0.0 } else { estimate };
        let natural = NaturalDamping::NONE;
        let design = GovernorDesign {
            period,
            proportional,
            integral,
            equivalent_delay,
            share,
            acceleration,
            actuator,
            lag,
            natural,
        };
        if design.open(self, Averaging::None).is_stable(design.crossover()) {
            Ok(design)
        } else {
            Err(Error::GovernorUnstable)
        }
    }
}

impl GovernorDesign {
    stops! {
        /// The same gains on a machine with natural damping, which [`margins`](Self::margins) then have in the loop.
        /// Damping adds margin; a load or motor whose torque rises off the operating point (a negative sum) takes some.
        pub const fn with_natural_damping(
            self,
            machine: &TwoMass,
            natural: NaturalDamping,
        ) -> Self = try_with_natural_damping
    }

    /// [`with_natural_damping`](Self::with_natural_damping), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::NaturalDamping`], [`Error::DampingUnstable`].
    pub const fn try_with_natural_damping(mut self, machine: &TwoMass, natural: NaturalDamping) -> Result<Self, Error> {
        get!(natural.step(machine, self.period));
        self.natural = natural;
        if self.open(machine, Averaging::None).is_stable(self.crossover()) {
            Ok(self)
        } else {
            Err(Error::DampingUnstable)
        }
    }

    /// The gains behind an average of the speed, whose [delay](Averaging::delay) joins the equivalent delay. A
    /// [`SpeedGovernor`](crate::governor::SpeedGovernor) takes them for its own filter.
    #[must_use]
    pub const fn behind(self, averaging: Averaging) -> Self {
        let Actuator { delay, lag } = self.actuator;
        let sum = delay + lag + 1.5 * self.period;
        let ratio = sum / (sum + averaging.delay(self.period));
        Self {
            proportional: self.proportional * ratio,
            integral: self.integral * ratio * ratio,
            equivalent_delay: self.equivalent_delay / ratio,
            ..self
        }
    }

    /// Margins of the loop round a machine, cut at the actuator.
    #[must_use]
    pub const fn margins(&self, machine: &TwoMass) -> Margins {
        self.margins_behind(machine, Averaging::None)
    }

    /// Whether the loop round a machine has the required margins: with the observer whose estimates the governor takes,
    /// or with the speed as known, and with an average of the speed.
    ///
    /// # Errors
    /// [`Error::GovernorUnstable`], [`Error::GovernorGain`], [`Error::GovernorPhase`].
    pub const fn try_robust(
        &self,
        machine: &TwoMass,
        observer: Option<LoopObserver<'_>>,
        averaging: Averaging,
        robustness: &Robustness,
    ) -> Result<(), Error> {
        let observer = match observer {
            Some(observer) => Some(observer.model()),
            None => None,
        };
        let open = LateLoop { observer, ..self.open(machine, averaging) };
        if !open.is_stable(self.crossover()) {
            return Err(Error::GovernorUnstable);
        }
        let margins = self.margins_of(open);
        if !(margins.gain_up >= robustness.gain && margins.gain_down * robustness.gain <= 1.0) {
            Err(Error::GovernorGain)
        } else if !(margins.phase >= robustness.phase) {
            Err(Error::GovernorPhase)
        } else {
            Ok(())
        }
    }

    /// [`margins`](Self::margins) with an average of the speed in the loop.
    #[must_use]
    pub const fn margins_behind(&self, machine: &TwoMass, averaging: Averaging) -> Margins {
        self.margins_of(self.open(machine, averaging))
    }

    const fn margins_of(&self, open: LateLoop) -> Margins {
        let (machine, open) = (open.machine, OpenLoop::Late(open));
        let nyquist = core::f64::consts::PI / self.period;
        let mut found = Margins::NONE;
        // A negative natural damping sets a least gain, at a frequency far below the crossover. A large one lowers the
        // crossover itself, to the integral's corner at the least.
        let sum = self.natural.sum();
        let slowest = if sum < 0.0 { 1e-3 } else { 1e-2 } * self.crossover();
        let corner = if sum > 0.0 { 0.1 * self.integral / sum } else { slowest };
        open.sweep(&mut found, [1.0], 0.0, [if corner < slowest { corner } else { slowest }, nyquist], 300);
        open.sweep_about(&mut found, [1.0], machine.resonance(), nyquist);
        found
    }

    /// The integral gain is the proportional one over `a^2 T_s`, so their root is the crossover: `1/(a T_s)`.
    const fn crossover(&self) -> f64 {
        sqrt(self.integral / (self.proportional * self.equivalent_delay))
    }

    const fn open(&self, machine: &TwoMass, averaging: Averaging) -> LateLoop {
        let inertia = self.acceleration * machine.load_inertia / machine.total_inertia();
        let Actuator { delay, lag } = self.actuator;
        LateLoop {
            step: ExactStep::new(machine, self.period),
            machine: *machine,
            period: self.period,
            proportional: self.proportional,
            integral: self.integral,
            late: Late { delay, lag, share: self.share, inertia, estimate: self.lag },
            averaging,
            observer: None,
            natural: if self.natural.motor == 0.0 && self.natural.load == 0.0 {
                None
            } else {
                match self.natural.step(machine, self.period) {
                    Ok(step) => Some((self.natural, step)),
                    Err(_) => None,
                }
            },
        }
    }
}
