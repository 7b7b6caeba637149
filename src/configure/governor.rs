//! Governors and their parts for a machine.

use super::{Configure, Machine};
use crate::constants::{Bases, ModesSettings, SpeedLoopSettings};
use crate::design::{BarredSpeeds, GovernorDesign, SlackDesign, SlackTuning, SpeedLoopDesign, TorqueCurve};
use crate::governor::{
    AccelerationFeedback, AccelerationFeedbackConfig, ActiveDamping, ActiveDampingConfig, Barred, BarredConfig,
    Between, BetweenConfig, Curve, CurveConfig, Droop, DroopConfig, FeedForward, FeedForwardConfig, Gains, Limit, Mean,
    MeanConfig, Modes, ModesConfig, OverCycle, Prompt, SetPoint, Slack, SlackConfig, Slew, SlewConfig, SpeedGovernor,
    SpeedGovernorConfig, SpeedGovernorConfigOf, SpeedLoop, SpeedLoopConfig, Supervisor, Symmetric, SymmetricConfig,
    View,
};
use crate::number::{Fixed, Number};

/// What [`SpeedGovernor`] takes its gains from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum GainSource {
    /// The speed loop of a torque-controlled drive.
    SpeedLoop(SpeedLoopDesign),
    /// The governor of a late actuator, with what it feeds forward.
    Governor(GovernorDesign),
}

impl GainSource {
    const fn governor(&self) -> &GovernorDesign {
        match self {
            GainSource::Governor(design) => design,
            GainSource::SpeedLoop(_) => panic!(
                "feed-forward and acceleration feedback need a governor's design: let GAINS be GainSource::Governor"
            ),
        }
    }
}

/// A machine whose backlash or slack rope is taken up.
pub trait HasBacklash: Machine {
    /// How it is taken up.
    const TAKING_UP: SlackTuning;
    /// The taking up, from the two masses, rate and tuning.
    const TAKE_UP: SlackDesign = Self::TWO_MASS.take_up(Self::RATE, Self::TAKING_UP);
}

/// A machine whose set point yields to the load.
pub trait HasDroop: Machine {
    /// Fraction of the rated speed, at rated torque.
    const DROOP: f64;
}

/// A machine with speeds that it must not dwell at.
pub trait HasBarredSpeeds<const K: usize>: Machine {
    /// The barred ranges.
    const BARRED: BarredSpeeds<K>;
    /// Acceleration through them \[rad/s2\]: nine tenths of the torque limit on the inertia of the two masses.
    const QUICK_RAMP: f64 =
        0.9 * Self::RATING.torque_limit / (Self::TWO_MASS.motor_inertia + Self::TWO_MASS.load_inertia);
}

/// A machine whose largest torque depends on the speed.
pub trait HasTorqueCurve<const K: usize>: Machine {
    /// Largest torque against speed.
    const CURVE: TorqueCurve<K>;
}

/// A machine whose torque may change so fast and no faster.
pub trait HasSlew: Machine {
    /// Torque per time \[N m/s\].
    const SLEW: f64;
}

/// A machine that starts, runs, stops and trips.
pub trait HasModes: Machine {
    /// Limits of the modes.
    const MODES: ModesSettings;
}

impl<M, N, S, F, L, U, V> Configure<M, N> for SpeedGovernor<N, S, F, L, U, V>
where
    M: Machine,
    N: Number,
    Gains<N>: Configure<M, N, Config = Gains<N>>,
    S: SetPoint<N> + Configure<M, N, Config = <S as SetPoint<N>>::Config>,
    F: Prompt<N> + Configure<M, N, Config = <F as Prompt<N>>::Config>,
    L: Limit<N> + Configure<M, N, Config = <L as Limit<N>>::Config>,
    U: Supervisor<N> + Configure<M, N, Config = <U as Supervisor<N>>::Config>,
    V: View<N> + Configure<M, N, Config = <V as View<N>>::Config>,
{
    type Config = SpeedGovernorConfigOf<N, S, F, L, U, V>;
    const CONFIG: Self::Config = SpeedGovernorConfig {
        gains: <Gains<N> as Configure<M, N>>::CONFIG,
        set_point: S::CONFIG,
        prompt: F::CONFIG,
        limit: L::CONFIG,
        supervisor: U::CONFIG,
        view: V::CONFIG,
    };
}

/// Nothing: what is renewed over a cycle comes from the measurement of the fluctuation.
impl<M: Machine, N: Number> Configure<M, N> for OverCycle<N> {
    type Config = ();
    const CONFIG: () = ();
}

macro_rules! parts {
    ($number:ident, $bases:expr; $([$($k:ident)?] $machine:path, $part:ty => $config:ty, $new:expr;)+) => {$(
        impl<M: $machine $(, const $k: usize)?> Configure<M, $number> for $part {
            type Config = $config;
            const CONFIG: Self::Config = $new;
        }
    )+};
}

macro_rules! governors {
    ($number:ident, $bases:expr) => {
        parts! { $number, $bases;
            [] Machine, SpeedLoop<$number> => SpeedLoopConfig<$number>, SpeedLoopConfig::<$number>::new(
                &M::SPEED_LOOP, SpeedLoopSettings { torque_limit: M::RATING.torque_limit, ramp: M::RAMP }, $bases
            );
            [] Machine, Gains<$number> => Gains<$number>, match &M::GAINS {
                GainSource::SpeedLoop(design) => Gains::<$number>::of_speed_loop(design, M::RAMP, $bases),
                GainSource::Governor(design) => Gains::<$number>::new(design, M::RAMP, $bases),
            };
            [] HasDroop, Droop => DroopConfig<$number>,
                DroopConfig::<$number>::new(M::DROOP, M::RATING.speed, M::RATING.torque, $bases);
            [K] HasBarredSpeeds<K>, Barred<K> => BarredConfig<$number, K>,
                BarredConfig::<$number, K>::new(&M::BARRED, M::QUICK_RAMP, M::PERIOD, $bases);
            [] Machine, FeedForward => FeedForwardConfig<$number>,
                FeedForwardConfig::<$number>::new(M::GAINS.governor().share, $bases);
            [] Machine, AccelerationFeedback => AccelerationFeedbackConfig<$number>,
                AccelerationFeedbackConfig::<$number>::new(M::GAINS.governor(), $bases);
            [] Machine, ActiveDamping => ActiveDampingConfig<$number>,
                ActiveDampingConfig::<$number>::new(&M::SPEED_LOOP, $bases);
            [] Machine, Symmetric => SymmetricConfig<$number>,
                SymmetricConfig::<$number>::new(M::RATING.torque_limit, $bases);
            [] Machine, Between => BetweenConfig<$number>,
                BetweenConfig::<$number>::new(M::LEAST_TORQUE, M::RATING.torque_limit, $bases);
            [K] HasTorqueCurve<K>, Curve<K> => CurveConfig<$number, K>,
                CurveConfig::<$number, K>::new(&M::CURVE, M::LEAST_TORQUE, $bases);
            [] HasModes, Modes => ModesConfig<$number>, ModesConfig::<$number>::new(&M::MODES, M::PERIOD, $bases);
            [K] Machine, Mean<$number, K> => MeanConfig<$number, K>, MeanConfig::<$number, K>::of_ticks();
        }

        impl<M: HasSlew, L> Configure<M, $number> for Slew<$number, L>
        where
            L: Limit<$number, Config: Copy> + Configure<M, $number, Config = <L as Limit<$number>>::Config>,
        {
            type Config = SlewConfig<$number, <L as Limit<$number>>::Config>;
            const CONFIG: Self::Config =
                SlewConfig::<$number, _>::new(M::SLEW, <L as Configure<M, $number>>::CONFIG, M::PERIOD, $bases);
        }

        impl<M: HasBacklash, L> Configure<M, $number> for Slack<$number, L>
        where
            L: Limit<$number, Config: Copy> + Configure<M, $number, Config = <L as Limit<$number>>::Config>,
        {
            type Config = SlackConfig<$number, <L as Limit<$number>>::Config>;
            const CONFIG: Self::Config =
                SlackConfig::<$number, _>::new(&M::TAKE_UP, <L as Configure<M, $number>>::CONFIG, $bases);
        }
    };
}

governors!(f32, Bases::SI);
governors!(f64, Bases::SI);
governors!(Fixed, M::BASES);
