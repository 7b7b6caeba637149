//! One tick through all parts: screening, observer, fluctuation, governor.
//!
//! A drive is composed by type, `Drive<N, Observer, Governor, Fluctuation, Balancer>`, with `()` for a part that the
//! machine does not need; such a part costs nothing. Configuration stands apart: one [`Config`] may serve many drives.
//!
//! # Bad samples
//! A sample is used only if plausible. An implausible value is flagged and left out. The sample, its flag, and what the
//! tick does:
//!
//! - **torque NaN, infinite, beyond its limit**, [`Faults::TORQUE`]: takes the torque last commanded; without a
//!   governor, the last plausible one
//! - **setpoint NaN, infinite, beyond its limit**, [`Faults::SETPOINT`]: keeps the last good one
//! - **angle further from the prediction than the innovation limit**, [`Faults::ANGLE_JUMP`]: coasts
//! - **angle unchanged** though the motor should have turned by more than the frozen-turn limit, or far from the
//!   prediction, [`Faults::ANGLE_FROZEN`]: coasts
//! - **no angle at all** ([`Drive::coast`]), [`Faults::ANGLE_MISSING`]: coasts
//! - **ticks that did not run before it** ([`Drive::make_up`]), [`Faults::TICK_MISSED`]: is preceded by as many
//!   predictions
//! - **after more than the limit of such ticks**, [`Faults::ANGLE_LOST`] as well: keeps the estimates and
//!   commands no torque until there are two angles in a row that differ
//!
//! With a lost angle the drive commands no torque: the brake must hold the machine. The governor starts anew when the
//! angle is reacquired.
//!
//! Of two such angles the second is accepted. If their difference agrees with the estimated speed, to the frozen-turn
//! limit, the estimates stand: only the angle has shifted. If not, the observer starts anew at the speed of the two
//! angles, in steady motion under the applied torque. So a drive that is switched on catches a spinning machine, and
//! one whose speed has changed without an angle. A speed beyond twice the largest setpoint is rejected.
//!
//! # Ticks that do not run
//! An observer predicts one period a tick. A tick that does not run leaves the next angle a period further than
//! predicted, an error as if the motor's speed had jumped. A control loop that may miss ticks counts them and calls
//! [`Drive::tick_after`], or [`Drive::make_up`] before a tick; [`Axis`](crate::axis::Axis) does both. [`TickCount`]
//! counts them from a number in the sample.
//!
//! # Standstill
//! Below the speed of the frozen-turn limit, a frozen encoder and a locked machine cannot be distinguished from the
//! motor's side. The estimated load torque is then the torque that would lock it.

mod actuated;
mod axis;
mod composition;
mod recorder;
mod switch;
mod tick_count;

pub use actuated::{Actuated, ActuatedConfig};
pub use axis::MADE_UP;
pub use composition::{Composition, ConfigOf};
pub(crate) use composition::{GovernorConfigOf, ObserverConfigOf, VibrationOf, handed_on, own};
pub use recorder::Recorded;
pub use tick_count::TickCount;

use crate::balancing::Balancer;
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::{Number, Part, StateOf};
use crate::observer::Observer;
use crate::sample::{Command, Estimate, Sample};

/// Plausibility limits of a sample.
///
/// ```
#[doc = include_str!("roll.txt")]
/// use driveline::drive::Limits;
/// type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
/// static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
/// // 1.67 of the torque limit; half a turn at 1.2 of rated speed: pi/180 s are 174 ticks
/// let Limits { torque, max_coast, .. } = CONFIG.limits;
/// assert_eq!((torque, max_coast), (1.67 * 550.0, 174));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits<N: Number> {
    /// Largest plausible applied torque (N m).
    pub torque: N,
    /// Largest plausible setpoint (rad/s).
    pub setpoint: N,
    /// Largest plausible innovation (2^-32 turn).
    pub innovation: N,
    /// Largest predicted turn in a tick for which an unchanged angle is plausible, in the unit of
    /// [`Number::less_turn`].
    pub frozen_turn: N,
    /// Ticks without a usable angle after which it counts as lost: at most the ticks of half a turn at the largest
    /// setpoint, beyond which the angle is ambiguous. A good angle takes one off: a wrong prediction can match by
    /// chance.
    pub max_coast: u32,
}

/// The constants of a drive.
///
/// ```
#[doc = include_str!("roll.txt")]
/// type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
/// static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
/// // a limit that is set on site: a changed copy of the constants
/// let mut config = CONFIG;
/// config.governor.torque_limit = 200.0;
/// let mut drive = RollDrive::new(&config, 0);
/// let most = (0..10_000).map(|_| drive.tick(&config, &Sample::si::<Roll>(0, 0.0, 100.0)).torque).fold(0.0, f32::max);
/// assert_eq!(most, 200.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Config<N: Number, O, G = (), F = (), B = ()> {
    /// Plausibility limits of a sample.
    pub limits: Limits<N>,
    /// Constants of the observer.
    pub observer: O,
    /// Constants of the fluctuation's measurement.
    pub fluctuation: F,
    /// Constants of the governor.
    pub governor: G,
    /// Constants of the balancer.
    pub balancer: B,
}

/// The state of a drive.
///
/// ```
#[doc = include_str!("roll.txt")]
/// use driveline::fault::Faults;
/// type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
/// static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
/// let mut drive = RollDrive::new(&CONFIG, 0);
/// // brake closed, 40 N m in the shaft; brake open; then ticks without an angle, until the torque is taken away
/// assert_eq!(drive.hold(&CONFIG, 0, 40.0).torque, 40.0);
/// assert!(drive.tick(&CONFIG, &Sample::si::<Roll>(0, 40.0, 0.0)).faults.is_none());
/// let lost = (1..).find(|_| drive.coast(&CONFIG, 40.0, 0.0).faults.contains(Faults::ANGLE_LOST));
/// assert_eq!(lost, Some(CONFIG.limits.max_coast + 2)); // the first beyond the limit still coasts
/// assert_eq!(drive.coast(&CONFIG, 40.0, 0.0).torque, 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// In this order: the compiler's own puts a measurement's tables in front.
#[repr(C)]
pub struct Drive<N, O: Part<N>, G: Part<N> = (), F: Part<N> = (), B: Part<N> = ()> {
    balancer: B::State,
    observer: O::State,
    governor: G::State,
    /// Substitute for an implausible torque.
    commanded: N,
    /// Ticks without a usable angle, less those with one; while the angle is lost [`NONE_YET`] or [`ONE`].
    coasted: i32,
    /// The last: a field behind its tables would be beyond the reach of a load.
    fluctuation: F::State,
}

/// The angle is lost, and none has been seen since.
const NONE_YET: i32 = -2;

/// The angle is lost, and one has been seen that differs from the last.
const ONE: i32 = -1;

impl<N, O, G, F, B> Drive<N, O, G, F, B>
where
    N: Number,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    F: Part<N, State: Fluctuation<N>>,
    B: Part<N, State: Balancer<N>>,
{
    /// A drive whose machine stands still at `angle` (2^-32 turn), without torque in its shaft.
    pub fn new(config: &ConfigOf<Self>, angle: u32) -> Self {
        Drive {
            observer: <StateOf<O, N>>::at_rest(&config.observer, angle, N::ZERO),
            fluctuation: Default::default(),
            governor: Default::default(),
            balancer: Default::default(),
            commanded: N::ZERO,
            coasted: 0,
        }
    }

    /// One tick with the governor active, a period after the last one.
    ///
    /// Where ticks did not run in between, use [`Drive::tick_after`].
    #[inline(always)]
    pub fn tick(&mut self, config: &ConfigOf<Self>, sample: &Sample<N>) -> Command<N> {
        if self.coasted < 0 {
            return self.reacquire(config, sample);
        }
        let (faults, applied) = self.observe(config, sample, true);
        let estimate = self.estimate(config);
        self.fluctuation.measure(&config.fluctuation, self.observer.angle(), applied, &estimate);
        self.governor.set_steady_speed(self.fluctuation.steady_speed());
        self.govern(config, &estimate, faults)
    }

    /// One tick against a closed brake: the machine stands still, the drive gives a constant torque, the shaft is taken
    /// to carry it, and the next [`Drive::tick`] starts from there. The torque is limited by the governor, without its
    /// slew. One that is NaN or beyond the sample's limit counts as zero and raises [`Faults::SETPOINT`]. A governor
    /// that has tripped holds with none.
    pub fn hold(&mut self, config: &ConfigOf<Self>, angle: u32, torque: N) -> Command<N> {
        let mut command = Command { torque, faults: Faults::NONE };
        if torque.exceeds(config.limits.torque) {
            command = Command { torque: N::ZERO, faults: Faults::SETPOINT };
        }
        self.fluctuation.disturb();
        let turned = N::from_angle(angle.wrapping_sub(self.observer.angle()) as i32);
        self.governor.set_turn_in_hold(&config.governor, turned);
        command.faults |= self.governor.faults();
        command.torque = self.governor.permitted(&config.governor, &Estimate::default(), command.torque);
        self.observer.restart(&config.observer, angle, command.torque, N::ZERO);
        self.governor.start(&config.governor, &self.estimate(config), command.torque);
        self.commanded = command.torque;
        self.coasted = 0;
        command
    }

    /// The present estimate.
    #[inline(always)]
    pub fn estimate(&self, config: &ConfigOf<Self>) -> Estimate<N> {
        self.observer.estimate(&config.observer)
    }

    /// The observer.
    pub fn observer(&self) -> &O::State {
        &self.observer
    }

    /// The observer, to set data that no sample contains, such as the crank's angle.
    pub fn observer_mut(&mut self) -> &mut O::State {
        &mut self.observer
    }

    /// The fluctuation's measurement.
    pub fn fluctuation(&self) -> &F::State {
        &self.fluctuation
    }

    /// The fluctuation's measurement, to take its finished results.
    pub fn fluctuation_mut(&mut self) -> &mut F::State {
        &mut self.fluctuation
    }

    /// The governor.
    pub fn governor(&self) -> &G::State {
        &self.governor
    }

    /// The governor, to request a start or stop or to switch its constants, between two ticks.
    pub fn governor_mut(&mut self) -> &mut G::State {
        &mut self.governor
    }

    /// The balancer.
    pub fn balancer(&self) -> &B::State {
        &self.balancer
    }

    /// The balancer, to begin a reading or to set the rotor's angle: between two ticks.
    pub fn balancer_mut(&mut self) -> &mut B::State {
        &mut self.balancer
    }

    /// Gives the balancer the samples of the vibration, taken with the last angle: once a tick.
    #[inline(always)]
    pub fn vibration(&mut self, config: &ConfigOf<Self>, vibration: &VibrationOf<Self>) {
        self.balancer.measure(&config.balancer, self.observer.angle(), vibration);
    }

    /// Reports a tick without a valid vibration sample to the balancer, with the cause: a reading across the gap is
    /// rejected.
    pub fn vibration_missing(&mut self, faults: Faults) {
        self.balancer.missed(faults);
    }

    /// The last accepted angle, 2^32 per turn.
    pub fn angle(&self) -> u32 {
        self.observer.angle()
    }

    /// Screens a sample and advances the observer, which coasts where there is no angle; gives the faults and the
    /// torque that was used.
    #[inline(always)]
    fn observe(&mut self, config: &ConfigOf<Self>, sample: &Sample<N>, has_angle: bool) -> (Faults, N) {
        let limits = &config.limits;
        if self.governor.is_to_judge() {
            self.judge(config);
        }
        let (mut torque, mut faults) = (sample.torque, Faults::NONE);
        if torque.exceeds(limits.torque) {
            torque = self.commanded;
            faults |= Faults::TORQUE;
        } else if !<StateOf<G, N>>::COMMANDS {
            self.commanded = torque;
        }
        if sample.setpoint.exceeds(limits.setpoint) {
            faults |= Faults::SETPOINT;
        } else {
            self.governor.set_setpoint(sample.setpoint);
        }
        let coasted = self.coasted;
        let predicted = self.observer.predict(&config.observer, sample.angle, torque);
        let innovation = if has_angle { predicted.innovation() } else { N::ZERO };
        self.governor.set_response(&config.governor, torque, innovation);
        let unchanged = sample.angle == self.observer.angle();
        let frozen = unchanged && predicted.turn().exceeds(limits.frozen_turn);
        if !has_angle || frozen || predicted.innovation().exceeds(limits.innovation) {
            faults |= if !has_angle {
                Faults::ANGLE_MISSING
            } else if unchanged {
                Faults::ANGLE_FROZEN
            } else {
                Faults::ANGLE_JUMP
            };
            self.observer.coast(predicted, sample.angle);
            let more = (coasted as u32) < limits.max_coast;
            self.coasted = if more { coasted.wrapping_add(1) } else { NONE_YET };
            self.fluctuation.disturb();
        } else {
            self.observer.correct(&config.observer, predicted, sample.angle);
            if coasted != 0 {
                self.coasted = coasted - 1;
            }
        }
        (faults | Faults::range(self.observer.beyond_base()), torque)
    }

    // Out of line at the start of a tick, where the fewest values wait for it.
    #[cold]
    #[inline(never)]
    fn judge(&mut self, config: &ConfigOf<Self>) {
        let estimate = self.estimate(config);
        self.governor.judge(&config.governor, &estimate);
    }

    #[inline(always)]
    fn govern(&mut self, config: &ConfigOf<Self>, estimate: &Estimate<N>, faults: Faults) -> Command<N> {
        self.governor.set_known_torque(self.observer.known_torque(&config.observer));
        let torque = self.governor.command(&config.governor, estimate);
        if <StateOf<G, N>>::COMMANDS {
            self.commanded = torque;
        }
        Command { torque, faults: faults | self.governor.faults() }
    }

    /// No torque while the angle is lost.
    fn release(&mut self, config: &ConfigOf<Self>, faults: Faults) -> Command<N> {
        self.fluctuation.disturb();
        self.commanded = N::ZERO;
        let estimate = self.estimate(config);
        self.governor.angle_lost(&config.governor, &estimate);
        Command { torque: N::ZERO, faults: faults | self.governor.faults() | Faults::ANGLE_LOST }
    }

    /// The angle is lost: commands no torque, looks for two angles in a row that differ, and goes on from the second.
    // Out of line: it leaves the registers to the tick.
    #[cold]
    #[inline(never)]
    fn reacquire(&mut self, config: &ConfigOf<Self>, sample: &Sample<N>) -> Command<N> {
        let limits = &config.limits;
        let mut faults = Faults::ANGLE_JUMP;
        let mut torque = sample.torque;
        if torque.exceeds(limits.torque) {
            torque = N::ZERO;
            faults |= Faults::TORQUE;
        }
        let last = self.observer.angle();
        let turned = N::from_angle(sample.angle.wrapping_sub(last) as i32);
        let speed = <StateOf<O, N>>::speed_of_turn(&config.observer, turned);
        if sample.angle == last {
            faults = Faults::ANGLE_FROZEN;
            self.coasted = NONE_YET;
        } else if self.coasted == NONE_YET || speed.exceeds(limits.setpoint + limits.setpoint) {
            self.observer.resync(sample.angle);
            self.coasted = ONE;
        } else {
            let count = <StateOf<O, N>>::speed_of_turn(
                &config.observer,
                N::ZERO.less_turn(limits.frozen_turn, N::Carry::default()),
            )
            .magnitude();
            let known = self.estimate(config).motor_speed;
            if (speed - known).exceeds(count) {
                self.observer.restart(&config.observer, sample.angle, torque, speed);
            } else {
                self.observer.resync(sample.angle);
            }
            self.coasted = limits.max_coast as i32 & i32::MAX;
        }
        self.release(config, faults)
    }
}

#[cfg(test)]
mod tests;
