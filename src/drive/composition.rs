//! A drive by its type alone: number, constants, parts and ticks.

use super::{Config, Drive};
use crate::balancing::Balancer;
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::{Number, Part, StateOf};
use crate::observer::Observer;
use crate::sample::{Command, Estimate, Sample};

/// A drive of any parts, for generic code such as [`Axis`](crate::axis::Axis): its number, its constants, the states
/// of its parts, and its ticks.
pub trait Composition: Sized {
    /// The number that it calculates with.
    type Number: Number;
    /// Its constants.
    type Config;
    /// State of its observer.
    type Observer: Observer<Self::Number>;
    /// State of its governor.
    type Governor: Governor<Self::Number>;
    /// State of the fluctuation's measurement.
    type Fluctuation: Fluctuation<Self::Number>;
    /// State of its balancer.
    type Balancer: Balancer<Self::Number>;

    /// As [`Drive::new`].
    fn new(config: &Self::Config, angle: u32) -> Self;
    /// As [`Drive::tick`].
    fn tick(&mut self, config: &Self::Config, sample: &Sample<Self::Number>) -> Command<Self::Number>;
    /// As [`Drive::tick_after`].
    fn tick_after(
        &mut self,
        config: &Self::Config,
        sample: &Sample<Self::Number>,
        missed: u32,
    ) -> Command<Self::Number>;
    /// As [`Drive::make_up`].
    fn make_up(&mut self, config: &Self::Config, torque: Self::Number, missed: u32) -> Faults;
    /// As [`Drive::coast`].
    fn coast(&mut self, config: &Self::Config, torque: Self::Number, setpoint: Self::Number) -> Command<Self::Number>;
    /// As [`Drive::hold`].
    fn hold(&mut self, config: &Self::Config, angle: u32, torque: Self::Number) -> Command<Self::Number>;
    /// As [`Drive::engage`].
    fn engage(&mut self, config: &Self::Config);
    /// As [`Drive::switch`].
    fn switch(&mut self, from: &Self::Config, to: &Self::Config);
    /// The constants of its observer and of its governor.
    fn parts(config: &mut Self::Config) -> (&mut ObserverConfigOf<Self>, &mut GovernorConfigOf<Self>);
    /// As [`Drive::observer`].
    fn observer(&self) -> &Self::Observer;
    /// As [`Drive::observer_mut`].
    fn observer_mut(&mut self) -> &mut Self::Observer;
    /// As [`Drive::governor`].
    fn governor(&self) -> &Self::Governor;
    /// As [`Drive::governor_mut`].
    fn governor_mut(&mut self) -> &mut Self::Governor;
    /// As [`Drive::fluctuation_mut`].
    fn fluctuation_mut(&mut self) -> &mut Self::Fluctuation;
    /// The torque that was commanded for the tick that has begun.
    fn commanded(&self) -> Self::Number;
    /// As [`Drive::vibration`].
    fn vibration(&mut self, config: &Self::Config, vibration: &VibrationOf<Self>);
    /// As [`Drive::vibration_missing`].
    fn vibration_missing(&mut self, faults: Faults);
    /// As [`Drive::estimate`].
    fn estimate(&self, config: &Self::Config) -> Estimate<Self::Number>;
    /// As [`Drive::angle`].
    fn angle(&self) -> u32;
    /// As [`Drive::is_lost`].
    fn is_lost(&self) -> bool;
}

/// What a drive around another hands on unchanged: what it reads, and with `mut` what it lets change.
macro_rules! handed_on {
    () => {
        fn observer(&self) -> &Self::Observer {
            self.drive.observer()
        }

        fn governor(&self) -> &Self::Governor {
            self.drive.governor()
        }

        fn commanded(&self) -> D::Number {
            self.drive.commanded()
        }

        fn vibration_missing(&mut self, faults: Faults) {
            self.drive.vibration_missing(faults);
        }

        #[inline(always)]
        fn angle(&self) -> u32 {
            self.drive.angle()
        }

        #[inline(always)]
        fn is_lost(&self) -> bool {
            self.drive.is_lost()
        }
    };
    (mut) => {
        handed_on!();

        fn observer_mut(&mut self) -> &mut Self::Observer {
            self.drive.observer_mut()
        }

        fn governor_mut(&mut self) -> &mut Self::Governor {
            self.drive.governor_mut()
        }

        fn fluctuation_mut(&mut self) -> &mut Self::Fluctuation {
            self.drive.fluctuation_mut()
        }
    };
}

/// Methods of the trait that are those of the type itself.
macro_rules! own {
    ($own:ident:) => {};
    ($own:ident: fn $name:ident(&mut $this:ident $(, $given:ident: $type:ty)*) $(-> $out:ty)?; $($rest:tt)*) => {
        #[inline(always)]
        fn $name(&mut $this $(, $given: $type)*) $(-> $out)? {
            $own::$name($this $(, $given)*)
        }
        own! { $own: $($rest)* }
    };
    ($own:ident: fn $name:ident(&$this:ident $(, $given:ident: $type:ty)*) $(-> $out:ty)?; $($rest:tt)*) => {
        #[inline(always)]
        fn $name(&$this $(, $given: $type)*) $(-> $out)? {
            $own::$name($this $(, $given)*)
        }
        own! { $own: $($rest)* }
    };
    ($own:ident: fn $name:ident($($given:ident: $type:ty),*) -> $out:ty; $($rest:tt)*) => {
        #[inline(always)]
        fn $name($($given: $type),*) -> $out {
            $own::$name($($given),*)
        }
        own! { $own: $($rest)* }
    };
}

pub(crate) use {handed_on, own};

/// The constants of a drive, from its type.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
/// static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
/// assert_eq!(CONFIG.governor.ramp, 150.0 / 2.0 / 10_000.0); // rated speed in two seconds, in a tick
/// ```
pub type ConfigOf<D> = <D as Composition>::Config;

/// The constants of a drive's observer, from the type of the drive.
pub(crate) type ObserverConfigOf<D> = <<D as Composition>::Observer as Observer<<D as Composition>::Number>>::Config;

/// The constants of a drive's governor, from the type of the drive.
pub(crate) type GovernorConfigOf<D> = <<D as Composition>::Governor as Governor<<D as Composition>::Number>>::Config;

/// The samples of the vibration in a tick, from the type of the drive.
pub(crate) type VibrationOf<D> = <<D as Composition>::Balancer as Balancer<<D as Composition>::Number>>::Vibration;

impl<N, O, G, F, B> Composition for Drive<N, O, G, F, B>
where
    N: Number,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    F: Part<N, State: Fluctuation<N>>,
    B: Part<N, State: Balancer<N>>,
{
    type Number = N;
    type Config = Config<
        N,
        <O::State as Observer<N>>::Config,
        <G::State as Governor<N>>::Config,
        <F::State as Fluctuation<N>>::Config,
        <B::State as Balancer<N>>::Config,
    >;
    type Observer = StateOf<O, N>;
    type Governor = StateOf<G, N>;
    type Fluctuation = StateOf<F, N>;
    type Balancer = StateOf<B, N>;

    own! { Drive:
        fn new(config: &Self::Config, angle: u32) -> Self;
        fn tick(&mut self, config: &Self::Config, sample: &Sample<N>) -> Command<N>;
        fn tick_after(&mut self, config: &Self::Config, sample: &Sample<N>, missed: u32) -> Command<N>;
        fn make_up(&mut self, config: &Self::Config, torque: N, missed: u32) -> Faults;
        fn coast(&mut self, config: &Self::Config, torque: N, setpoint: N) -> Command<N>;
        fn hold(&mut self, config: &Self::Config, angle: u32, torque: N) -> Command<N>;
        fn engage(&mut self, config: &Self::Config);
        fn switch(&mut self, from: &Self::Config, to: &Self::Config);
        fn observer(&self) -> &Self::Observer;
        fn observer_mut(&mut self) -> &mut Self::Observer;
        fn governor(&self) -> &Self::Governor;
        fn governor_mut(&mut self) -> &mut Self::Governor;
        fn fluctuation_mut(&mut self) -> &mut Self::Fluctuation;
        fn vibration(&mut self, config: &Self::Config, vibration: &VibrationOf<Self>);
        fn vibration_missing(&mut self, faults: Faults);
        fn estimate(&self, config: &Self::Config) -> Estimate<N>;
        fn angle(&self) -> u32;
        fn is_lost(&self) -> bool;
    }

    fn parts(config: &mut Self::Config) -> (&mut ObserverConfigOf<Self>, &mut GovernorConfigOf<Self>) {
        (&mut config.observer, &mut config.governor)
    }

    fn commanded(&self) -> N {
        self.commanded
    }
}
