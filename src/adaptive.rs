//! A drive whose constants follow load and rope, and what its learners find: [`Adaptive`].
//!
//! The tick is that of the drive inside, with the working copy of its constants. [`Adaptive::background`] does
//! everything that is slower than a tick: gain schedule, learners, their bounds, and the bumpless transfer to the
//! constants that follow. It counts the ticks itself, so it may be called at any rate; below twenty times a second
//! nothing is learnt. A part that is left out, `()`, costs nothing.
//!
//! | slot | part | needs |
//! |---|---|---|
//! | schedule | [`LoadAndRope`] | [`HasLoadAndRope`](crate::configure::HasLoadAndRope) |
//! | learners | [`Learners`] | [`Machine::LEARNING`] for their bounds |
//!
//! [`Learners`] find the friction of a [`GearedObserver`], and the eccentricity with an [`EccentricityObserver`] in the
//! drive. While a load is named they find the motor's torque constant, its offset and its inertia too. They pause by
//! themselves: while the brake holds, after a fault, after ticks that did not run, and while the axis is tripped.

mod adjust;
mod composition;
mod learners;
mod load_and_rope;

pub use adjust::Adjust;
pub(crate) use adjust::HasEccentricity;
pub use learners::{Learners, LearnersState, Learning};
pub use load_and_rope::{LoadAndRope, LoadAndRopeState, Scheduling};

use core::marker::PhantomData;

use crate::configure::{Configure, Machine, Units};
use crate::drive::{Composition, ConfigOf, Drive};
use crate::fault::Faults;
use crate::governor::{SetpointLag, SpeedLoop};
use crate::learning::{EccentricityObserver, Learnt};
use crate::number::{Part, StateOf};
use crate::observer::{GearedObserver, SemiImplicitObserver};
use crate::sample::Command;

/// What is known of load and rope at this time, beyond what the drive finds.
///
/// ```
#[doc = include_str!("adaptive/crane.txt")]
/// type CraneDrive = Adaptive<Crane, Inner, LoadAndRope<3, 2>>;
/// static CONFIG: ConfigOf<CraneDrive> = CraneDrive::configure();
/// let mut drive = CraneDrive::new(&CONFIG, 0);
/// let hold = |drive: &mut CraneDrive| (0..200).for_each(|_| { drive.hold(&CONFIG, 0, 0.0); });
/// // at the upper limit switch, with an empty hook
/// hold(&mut drive);
/// drive.background(&CONFIG, &Known { rope: Some(4.0), load: Some(500.0) });
/// hold(&mut drive);
/// drive.background(&CONFIG, &Known::NOTHING);
/// assert!((drive.rope() - 4.0).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Known {
    /// Length of the rope now (m), as at a limit switch. Between two of them the motor's turns are counted.
    pub rope: Option<f32>,
    /// Mass of the load now (kg): an empty hook, a test weight. Without it the load is weighed by the load torque.
    pub load: Option<f32>,
}

impl Known {
    /// Nothing beyond what the drive finds.
    pub const NOTHING: Known = Known { rope: None, load: None };

    /// Without values that cannot be.
    fn checked(&self) -> Known {
        Known {
            rope: self.rope.filter(|rope| rope.is_finite()),
            load: self.load.filter(|load| *load >= 0.0 && load.is_finite()),
        }
    }
}

/// The constants of an [`Adaptive`] drive: those of the drive inside, and of its schedule.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdaptiveConfig<C, S, M> {
    drive: C,
    schedule: S,
    machine: PhantomData<fn() -> M>,
}

/// A drive `D` of the machine `M` that adapts itself to its load and to what it learns.
///
/// It is a [`Composition`] as the drive inside is, and takes its place in an [`Axis`](crate::axis::Axis).
///
/// ```
/// use driveline::prelude::*;
///
/// struct Crane;
/// impl Machine for Crane {
///     const CHAIN: Chain = Chain::motor(Inertia(0.3)).shaft(Stiffness(2.0e4), Damping(1.0)).rotor(Inertia(0.05))
///         .gear(Ratio(20.0), Efficiency(0.95)).drum(Diameter(0.5)).rope(Falls(2), Stiffness(1.2e6))
///         .lengths(Length(4.0), Length(10.0), Length(16.0)).lifted(Mass(5e3)).loads(Mass(500.0), Mass(5_500.0));
///     const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed::rpm(1480.0), torque_limit: Torque(600.0) };
///     const ENCODER: Encoder = Encoder::lines(1024);
///     const RATE_HZ: u32 = 10_000;
///     const DISTURBANCE: Disturbance = Self::RATING.hoisting(Self::RATE);
/// }
/// impl HasLoadAndRope<3, 2> for Crane {}
/// type CraneDrive = HoistDrive<Crane, f32, 3, 2>;
/// static CONFIG: ConfigOf<CraneDrive> = CraneDrive::configure();
///
/// let mut drive = CraneDrive::new(&CONFIG, 0);
/// // in the interrupt
/// let command = drive.tick(&CONFIG, &Sample::si::<Crane>(0, 0.0, 100.0));
/// // between two ticks, now and then
/// drive.background(&CONFIG, &Known { rope: Some(12.0), load: None });
/// // before the power goes, and after it has come back
/// let learnt = drive.learnt();
/// let mut drive = CraneDrive::new(&CONFIG, 0);
/// drive.restore(&CONFIG, &learnt);
/// assert_eq!(drive.learnt(), learnt);
/// # assert!(command.torque > 0.0);
/// ```
// Not logged: it holds the drive, whose estimates are; `learnt` gives what was learnt.
pub struct Adaptive<M, D: Composition, S: Part<D::Number> = (), L: Part<D::Number> = ()> {
    drive: D,
    /// The working copy of its constants.
    config: ConfigOf<D>,
    learners: StateOf<L, D::Number>,
    /// [`fresh`] and the ticks since the last call of `background` in the low half, [`INTERRUPTED`] above.
    passed: u32,
    /// Ticks since the last step, since the last transfer, and since the last block of the eccentricity.
    ticks: [u32; 3],
    interrupted: bool,
    /// The named load (kg).
    load: Option<f32>,
    schedule: StateOf<S, D::Number>,
    machine: PhantomData<fn() -> M>,
}

/// The drive of the hoist `M` in the number `N`, which follows load and rope over `LOADS` loads and `ROPES` lengths,
/// and learns its machine. The ramp's setpoint lags by the loop's own time constant, so that a ramp leaves less of a
/// swing.
pub type HoistDrive<M, N, const LOADS: usize, const ROPES: usize> = Adaptive<
    M,
    Drive<N, EccentricityObserver<GearedObserver<SemiImplicitObserver>>, SpeedLoop<SetpointLag>>,
    LoadAndRope<LOADS, ROPES>,
    Learners,
>;

/// In the upper half of the count of ticks: the brake held, or the axis was tripped. The faults of the ticks lie below
/// it.
const INTERRUPTED: u32 = 1 << 31;

/// The count of ticks, from which on `background` is overdue; it ends there.
const OVERDUE: u32 = 1 << 15;

/// The count after a call of `background`: a second before it is overdue, at rates above 32,768 Hz as many ticks.
const fn fresh(rate_hz: u32) -> u32 {
    OVERDUE.saturating_sub(rate_hz)
}

/// The bits of faults, 0 to 13 and 24 to 30, in the upper half of a word, below its top.
const fn flagged(faults: Faults) -> u32 {
    faults.bits() << 16 | faults.bits() & 0x7f00_0000
}

/// Steps of the learners in a second.
const STEPS: u32 = 100;
/// Steps from one transfer to the next, and of a block of the eccentricity.
const TRANSFER: u32 = 5;
const BLOCK: u32 = 10;

const fn ticks_of_step(rate_hz: u32) -> u32 {
    if rate_hz < STEPS { 1 } else { rate_hz / STEPS }
}

impl<M, D, S, L> Adaptive<M, D, S, L>
where
    M: Machine,
    D: Composition<Number: Units, Config: Copy>,
    S: Part<D::Number, State: Scheduling<M, D>>,
    L: Part<D::Number, State: Learning<M, D>>,
{
    const STEP: u32 = ticks_of_step(M::RATE_HZ);

    /// The constants of this drive, to be kept in a `static`.
    pub const fn configure() -> ConfigOf<Self>
    where
        Self: Configure<M, D::Number, Config = ConfigOf<Self>>,
    {
        crate::configure::stop_refused::<Self, M, D::Number>();
        crate::configure::constants::<Self, M, D::Number>()
    }

    /// Counts a tick with its faults, and adds that of a `background` that is overdue.
    #[inline(always)]
    fn count(&mut self, mut command: Command<D::Number>) -> Command<D::Number> {
        let overdue = self.passed >> 15 & 1;
        self.passed = (self.passed + (1 - overdue)) | flagged(command.faults);
        command.faults |= Faults::background_missing(overdue);
        command
    }

    /// Counts ticks that did not run.
    fn count_missed(&mut self, missed: u32) {
        let ticks = (self.passed & 0xffff).saturating_add(missed).min(OVERDUE);
        self.passed = self.passed & !0xffff | ticks;
    }

    /// Everything that is slower than a tick, between two ticks: counts the rope, weighs the load, learns, and takes
    /// the constants that follow from both.
    ///
    /// It may be called at any rate, after each tick or now and then, and does nothing until a hundredth of a second
    /// has passed. Nothing is learnt where it is called less than twenty times a second. The rope is counted to the
    /// turn of the motor where it is called twice a second. A second after the last call each tick raises
    /// [`Faults::BACKGROUND_MISSING`].
    pub fn background(&mut self, config: &ConfigOf<Self>, known: &Known) {
        let passed = core::mem::replace(&mut self.passed, const { fresh(M::RATE_HZ) });
        self.interrupted |= passed >= OVERDUE;
        let passed = (passed & 0xffff).saturating_sub(const { fresh(M::RATE_HZ) });
        for ticks in &mut self.ticks {
            *ticks = ticks.saturating_add(passed);
        }
        self.schedule.pass(passed);
        let known = known.checked();
        if self.load != known.load {
            self.load = known.load;
            self.learners.set_load(known.load);
        }
        let [step, transfer, block] = self.ticks;
        if step < Self::STEP && known.rope.is_none() {
            return;
        }
        let estimate = self.drive.estimate(&self.config).si::<M>();
        self.schedule.wind(known.rope, self.drive.angle(), estimate.motor_speed);
        if step < Self::STEP {
            return;
        }
        let interrupted = core::mem::take(&mut self.interrupted);
        let elapsed = step as f32 * const { 1.0 / Self::STEP as f32 };
        self.learners.learn(elapsed, interrupted, &estimate);
        self.ticks = [0, transfer, block];
        if transfer >= const { TRANSFER * Self::STEP } {
            self.ticks[1] = 0;
            let seconds = transfer as f32 * const { M::PERIOD as f32 };
            self.schedule.weigh(seconds, self.load, estimate.load_torque);
            self.transfer(config);
        }
        if block >= const { BLOCK * Self::STEP } {
            self.ticks[2] = 0;
            self.learners.learn_eccentricity::<S::State>(self.drive.observer_mut(), estimate.motor_speed);
        }
    }

    /// Takes the constants that follow from load, rope and what is learnt, bumplessly.
    fn transfer(&mut self, config: &ConfigOf<Self>) {
        let mut next = config.drive;
        self.schedule.constants(&config.schedule, &mut next);
        self.learners.adjust(&mut next);
        self.drive.switch(&self.config, &next);
        self.config = next;
    }

    /// What has been learnt, to be kept over a restart.
    pub fn learnt(&self) -> Learnt {
        self.learners.learnt(&self.drive)
    }

    /// Takes what was learnt before the restart, each value within its bounds: at standstill, before the first tick.
    /// The eccentricity needs the angle's zero of that time: an absolute encoder, or one that has passed its index.
    pub fn restore(&mut self, config: &ConfigOf<Self>, learnt: &Learnt) {
        self.learners.restore::<S::State>(&mut self.drive, learnt);
        self.transfer(config);
    }

    /// Length of the rope (m), as it is counted; zero without a schedule.
    pub fn rope(&self) -> f32 {
        self.schedule.rope()
    }

    /// Mass of the load (kg), named or weighed; zero without a schedule.
    pub fn load(&self) -> f32 {
        self.schedule.load()
    }

    /// The drive inside.
    pub fn drive(&self) -> &D {
        &self.drive
    }

    /// The present constants of the drive inside.
    pub fn constants(&self) -> &ConfigOf<D> {
        &self.config
    }
}

impl<M, D, S, L> Clone for Adaptive<M, D, S, L>
where
    D: Composition<Config: Clone> + Clone,
    S: Part<D::Number, State: Clone>,
    L: Part<D::Number, State: Clone>,
{
    fn clone(&self) -> Self {
        let Adaptive { passed, ticks, interrupted, load, machine, .. } = *self;
        let (drive, config) = (self.drive.clone(), self.config.clone());
        let (learners, schedule) = (self.learners.clone(), self.schedule.clone());
        Adaptive { drive, config, learners, passed, ticks, interrupted, load, schedule, machine }
    }
}

#[cfg(test)]
mod tests {
    use super::{INTERRUPTED, flagged};
    use crate::fault::Faults;

    /// Any fault is seen above the count of ticks, and none is counted as ticks.
    #[test]
    fn no_fault_is_counted_as_ticks() {
        let mut seen = Faults::NONE;
        // its own fault comes after the count
        for (fault, name) in Faults::NAMES.into_iter().filter(|(fault, _)| *fault != Faults::BACKGROUND_MISSING) {
            let bits = flagged(fault);
            assert!(bits > 0xffff && bits & (0xffff | INTERRUPTED) == 0, "{name}: {bits:x}");
            seen |= fault;
        }
        assert_eq!(seen.bits().count_ones(), 21);
    }
}
