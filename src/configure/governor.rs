//! Governors and their parts for a machine.

use super::{Configure, GainSource, LoopPart, Machine};
use crate::design::{Averaging, BarredSpeeds, SpeedLoopDesign, TorqueCurve};
use crate::governor::{
    AccelerationFeedback, AccelerationFeedbackConfig, ActiveDamping, ActiveDampingConfig, ActuatorMonitor,
    ActuatorMonitorConfig, BacklashTakeUp, BacklashTakeUpConfig, Barred, BarredConfig, Curve, CurveConfig,
    CycleAverage, DampingLag, Droop, DroopConfig, FeedForward, FeedForwardConfig, Gains, InputShaper,
    InputShaperConfig, LagConfig, LoadSharing, LoadSharingConfig, LoopFilter, MechanismFeedForward, MovingAverage,
    MovingAverageConfig, Sequencer, SequencerConfig, SetpointLag, Slew, SlewConfig, SpeedGovernor, SpeedGovernorConfig,
    SpeedLag, SpeedLoop, SpeedLoopConfig, Supervised, SupervisedConfig, SupervisionConfig, SymmetricLimit,
    SymmetricLimitConfig, TorqueRange, TorqueRangeConfig,
};
use crate::number::{Fixed, Number, Part};
use crate::settings::{ActuatorMonitorSettings, Bases, LoadSharingSettings, SpeedLoopSettings};

/// A machine with speeds that it must not dwell at.
pub trait HasBarredSpeeds<const K: usize>: Machine {
    /// The barred ranges.
    const BARRED: BarredSpeeds<K>;
    /// Acceleration through them (rad/s2): nine tenths of the torque limit on the inertia of the two masses.
    const QUICK_RAMP: f64 =
        0.9 * Self::RATING.torque_limit.0 / (Self::TWO_MASS.motor_inertia + Self::TWO_MASS.load_inertia);
}

/// A machine whose largest torque depends on the speed.
///
/// ```
#[doc = include_str!("../generator_set.txt")]
/// impl HasTorqueCurve<3> for Set {
///     const POINTS: [[f64; 2]; 3] = [[0.0, 264.0], [62.8, 1910.0], [125.7, 2838.0]];
/// }
/// const CONFIG: CurveConfig<f64, 3> = <Curve<3> as Configure<Set, f64>>::CONFIG;
/// assert!((CONFIG.max_torque(62.8) - 1910.0).abs() < 1e-9);
/// ```
pub trait HasTorqueCurve<const K: usize>: Machine {
    /// Points of the largest torque: speed (rad/s), torque (N m), by rising speed. To give a curve that is made
    /// otherwise, name [`CURVE`](Self::CURVE).
    const POINTS: [[f64; 2]; K] = [[f64::NAN; 2]; K];
    /// Largest torque against speed: [`TorqueCurve::through`] the points.
    const CURVE: TorqueCurve<K> = TorqueCurve::through(Self::POINTS);
}

/// A machine that several motors turn.
pub trait HasLoadSharing: Machine {
    /// Torques, limits and damping of the sharing.
    const SHARING: LoadSharingSettings;
}

/// A machine whose torque may change so fast and no faster.
pub trait HasSlew: Machine {
    /// Torque per time (N m/s).
    const SLEW: f64;
}

/// A machine whose torque comes from an actuator of `K` lags in a row, which reports its position: a fuel rack, a steam
/// valve. [`Machine::ACTUATOR`] has to allow for their sum.
///
/// ```
#[doc = include_str!("../generator_set.txt")]
/// impl HasActuator<1> for Set {
///     const LAGS: [f64; 1] = [0.02];
///     const TORQUE_DELAY: f64 = 0.0065;
/// }
/// // what the monitor expects after a tick of 1/2400 s: 1 - exp(-T/lag) of a step
/// const CONFIG: ActuatorMonitorConfig<f64, 1> = <ActuatorMonitor<f64, 1> as Configure<Set, f64>>::CONFIG;
/// assert!((CONFIG.share[0] - (1.0 - (-1.0 / 48.0_f64).exp())).abs() < 1e-12);
/// ```
pub trait HasActuator<const K: usize>: Machine {
    /// Lags from the command to the torque of the reported position (s).
    const LAGS: [f64; K];
    /// Delay from the position to the torque that acts on the machine (s); zero where it acts at once.
    const TORQUE_DELAY: f64;
    /// Limits of the actuator's monitor: [`ActuatorMonitorSettings::of`] the rating.
    const MONITOR: ActuatorMonitorSettings = ActuatorMonitorSettings::of(&Self::RATING);
}

/// The gains behind the filter `V`.
pub(crate) struct GainsBehind<V>(core::marker::PhantomData<V>);

impl<M, N, S, F, L, U, V> Configure<M, N> for SpeedGovernor<S, F, L, U, V>
where
    M: Machine,
    N: Number,
    GainsBehind<V>: Configure<M, N, Config = Gains<N>>,
    S: Configure<M, N>,
    F: Configure<M, N>,
    L: Configure<M, N>,
    U: Configure<M, N>,
    V: Configure<M, N>,
{
    type Config = SpeedGovernorConfig<N, S::Config, F::Config, L::Config, U::Config, V::Config>;
    const CONFIG: Self::Config = SpeedGovernorConfig {
        gains: <GainsBehind<V> as Configure<M, N>>::CONFIG,
        shape: S::CONFIG,
        compensation: F::CONFIG,
        limit: L::CONFIG,
        sequence: U::CONFIG,
        filter: V::CONFIG,
    };
    const LOOP: LoopPart = {
        let gains = match M::GAINS {
            // the compensation brings the damping, and has no lag
            GainSource::SpeedLoop(design) => {
                GainSource::SpeedLoop(SpeedLoopDesign { damping: 0.0, damping_lag: 0.0, speed_lag: 0.0, ..design })
            }
            GainSource::Governor(design) => GainSource::Governor(design.behind(V::LOOP.averaging)),
        };
        LoopPart { gains: Some(gains), ..LoopPart::NONE }.and(&F::LOOP).and(&L::LOOP).and(&V::LOOP)
    };
}

/// None: the average over a cycle comes from the measurement of the fluctuation.
impl<M: Machine, N: Number> Configure<M, N> for CycleAverage {
    type Config = ();
    const CONFIG: () = ();
    // at rated speed: slower than that the cycle lasts longer
    const LOOP: LoopPart = {
        let turns = M::CYCLE.turns as f64 / M::CYCLE.cycles as f64;
        let averaging = Averaging::Cycle(core::f64::consts::TAU * turns / M::RATING.speed.0);
        LoopPart { averaging, ..LoopPart::NONE }
    };
}

/// None: the observer has the mechanism.
impl<M: super::HasMechanism, N: Number> Configure<M, N> for MechanismFeedForward {
    type Config = ();
    const CONFIG: () = ();
}

/// None: its time constant is that of the loop's gains.
impl<M: Machine, N: Number> Configure<M, N> for SetpointLag {
    type Config = ();
    const CONFIG: () = ();
}

macro_rules! parts {
    ($number:ident, $bases:expr;
        $([$($k:ident)?] $machine:path, $part:ty => $config:ty, $new:expr $(, $loop:expr)?;)+) => {$(
        impl<M: $machine $(, const $k: usize)?> Configure<M, $number> for $part {
            type Config = $config;
            const CONFIG: Self::Config = $new;
            $(const LOOP: LoopPart = $loop;)?
        }
    )+};
}

const fn speed_loop_settings<M: Machine>() -> SpeedLoopSettings {
    SpeedLoopSettings { torque_limit: M::RATING.torque_limit.0, ramp: M::RAMP }
}

macro_rules! governors {
    ($number:ident, $bases:expr) => {
        parts! { $number, $bases;
            [] Machine, DampingLag => LagConfig<$number>,
                LagConfig::<$number>::new(M::SPEED_LOOP.damping_lag, M::PERIOD, $bases);
            [] Machine, SpeedLag => LagConfig<$number>,
                LagConfig::<$number>::new(M::SPEED_LOOP.speed_lag, M::PERIOD, $bases);
            [] Machine, Droop => DroopConfig<$number>,
                DroopConfig::<$number>::new(
                    M::DROOP,
                    M::RATING.speed.0,
                    M::RATING.torque.0,
                    M::GAINS.integral(),
                    $bases,
                );
            [K] HasBarredSpeeds<K>, Barred<K> => BarredConfig<$number, K>,
                BarredConfig::<$number, K>::new(&M::BARRED, M::QUICK_RAMP, M::PERIOD, $bases);
            [] Machine, FeedForward => FeedForwardConfig<$number>,
                FeedForwardConfig::<$number>::new(M::GAINS.design().share, $bases),
                LoopPart { forward: M::GAINS.design().share, ..LoopPart::NONE };
            [] Machine, AccelerationFeedback => AccelerationFeedbackConfig<$number>,
                AccelerationFeedbackConfig::<$number>::new(M::GAINS.design(), $bases),
                LoopPart { acceleration: M::GAINS.design().acceleration, ..LoopPart::NONE };
            [] Machine, ActiveDamping => ActiveDampingConfig<$number>,
                ActiveDampingConfig::<$number>::new(&M::SPEED_LOOP, $bases),
                LoopPart { damping: M::SPEED_LOOP.damping, ..LoopPart::NONE };
            [] Machine, SymmetricLimit => SymmetricLimitConfig<$number>,
                SymmetricLimitConfig::<$number>::new(M::RATING.torque_limit.0, $bases);
            [] Machine, TorqueRange => TorqueRangeConfig<$number>,
                TorqueRangeConfig::<$number>::new(M::LEAST_TORQUE, M::RATING.torque_limit.0, $bases);
            [K] HasTorqueCurve<K>, Curve<K> => CurveConfig<$number, K>,
                CurveConfig::<$number, K>::new(&M::CURVE, M::LEAST_TORQUE, $bases);
            [] Machine, Sequencer => SequencerConfig<$number>,
                SequencerConfig::<$number>::new(&M::SEQUENCER, M::PERIOD, $bases);
            [K] HasActuator<K>, ActuatorMonitor<$number, K> => ActuatorMonitorConfig<$number, K>,
                ActuatorMonitorConfig::<$number, K>::new(&M::LAGS, &M::MONITOR, M::PERIOD, $bases);
            [MOTORS] HasLoadSharing, LoadSharing<$number, MOTORS> => LoadSharingConfig<$number>, {
                assert!(MOTORS as u32 == M::SHARING.motors, "the load sharing and its settings differ in their motors");
                LoadSharingConfig::<$number>::new(&M::SHARING, M::PERIOD, $bases)
            };
            [K] Machine, MovingAverage<K> => MovingAverageConfig<$number, K>,
                MovingAverageConfig::<$number, K>::of_ticks(),
                LoopPart { averaging: Averaging::Ticks(K as u32), ..LoopPart::NONE };
        }

        impl<M: Machine, V: Configure<M, $number>> Configure<M, $number> for GainsBehind<V> {
            type Config = Gains<$number>;
            const CONFIG: Self::Config = match &M::GAINS {
                GainSource::SpeedLoop(design) => {
                    Gains::<$number>::of_speed_loop(design, speed_loop_settings::<M>(), $bases)
                }
                GainSource::Governor(design) => {
                    Gains::<$number>::new(&design.behind(V::LOOP.averaging), speed_loop_settings::<M>(), $bases)
                }
            };
        }

        impl<M: Machine, F> Configure<M, $number> for SpeedLoop<F>
        where
            F: Part<$number, State: LoopFilter<$number>> + Configure<M, $number, Config: Copy>,
        {
            type Config = SpeedLoopConfig<$number, F::Config>;
            const LOOP: LoopPart = LoopPart { gains: Some(GainSource::SpeedLoop(M::SPEED_LOOP)), ..LoopPart::NONE };
            const CONFIG: Self::Config = {
                assert!(
                    <F::State as LoopFilter<$number>>::LAGS_DAMPING == (M::SPEED_LOOP.damping_lag > 0.0),
                    "the speed loop's design and its governor differ in the lag of the damping: give the design \
                        with_damping_lag and the governor DampingLag, or neither"
                );
                assert!(
                    <F::State as LoopFilter<$number>>::LAGS_SPEED == (M::SPEED_LOOP.speed_lag > 0.0),
                    "the speed loop's design and its governor differ in the lag of the speed: give the design \
                        with_speed_lag and the governor SpeedLag, or neither"
                );
                SpeedLoopConfig::<$number>::new(&M::SPEED_LOOP, speed_loop_settings::<M>(), $bases)
                    .with_filter(F::CONFIG)
            };
        }

        impl<M: HasSlew, L: Configure<M, $number, Config: Copy>> Configure<M, $number> for Slew<L> {
            type Config = SlewConfig<$number, L::Config>;
            const CONFIG: Self::Config = SlewConfig::<$number, _>::new(M::SLEW, L::CONFIG, M::PERIOD, $bases);
            const LOOP: LoopPart = L::LOOP;
        }

        impl<M: Machine, G: Configure<M, $number, Config: Copy>> Configure<M, $number> for Supervised<G> {
            type Config = SupervisedConfig<$number, G::Config>;
            const CONFIG: Self::Config = SupervisedConfig {
                governor: G::CONFIG,
                supervision: SupervisionConfig::<$number>::new(&M::SUPERVISION, M::PERIOD, $bases),
            };
            const LOOP: LoopPart = G::LOOP;
        }

        impl<M: Machine, G, const SLOTS: usize, const PARTS: usize> Configure<M, $number>
            for InputShaper<G, SLOTS, PARTS>
        where
            G: Configure<M, $number, Config: Copy>,
        {
            type Config = InputShaperConfig<$number, G::Config>;
            const CONFIG: Self::Config = InputShaperConfig::<$number, _>::new(
                &M::SHAPER,
                (SLOTS / (PARTS - 1)) as u32,
                M::RAMP,
                G::CONFIG,
                M::PERIOD,
                $bases,
            );
            const LOOP: LoopPart = G::LOOP;
        }

        impl<M: Machine, L: Configure<M, $number, Config: Copy>> Configure<M, $number> for BacklashTakeUp<L> {
            type Config = BacklashTakeUpConfig<$number, L::Config>;
            const CONFIG: Self::Config =
                BacklashTakeUpConfig::<$number, _>::new(&M::TAKE_UP, M::GAINS.proportional(), L::CONFIG, $bases);
            const LOOP: LoopPart = LoopPart { damping: M::TAKE_UP.damping, ..LoopPart::NONE }.and(&L::LOOP);
        }
    };
}

governors!(f32, Bases::SI);
governors!(f64, Bases::SI);
governors!(Fixed, M::BASES);
