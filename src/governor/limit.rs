//! Limits of the torque: constant, by the prime mover's curve, and by slew.

use crate::number::Number;
use crate::sample::Estimate;

/// A limit of the torque.
pub trait Limit<N: Number>: Default {
    /// Its constants.
    type Config;

    /// The largest permitted torque (N m), in either direction.
    fn most(&self, config: &Self::Config, estimate: &Estimate<N>) -> N;

    /// The permitted torque nearest to `wanted`, whatever the last.
    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N;

    /// The permitted torque nearest to `wanted` in the tick that begins.
    #[inline(always)]
    fn limit(&mut self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N {
        self.permitted(config, estimate, wanted)
    }

    /// Ramp tracking: the ramped setpoint (rad/s) after a tick in which the governor wanted this torque, moved back by
    /// the torque that the limit withheld over the proportional gain. Without tracking the setpoint stays.
    #[inline(always)]
    fn track(&self, _config: &Self::Config, setpoint: N, _wanted: N) -> N {
        setpoint
    }

    /// Starts from this [permitted](Self::permitted) torque.
    #[inline(always)]
    fn start(&mut self, _torque: N) {}
}

/// The same limit in both directions.
///
/// ```
/// use driveline::governor::{Limit, SymmetricLimit, SymmetricLimitConfig};
/// use driveline::sample::Estimate;
/// const LIMIT: SymmetricLimitConfig<f64> = SymmetricLimitConfig { torque: 550.0 };
/// assert_eq!(SymmetricLimit.permitted(&LIMIT, &Estimate::default(), -700.0), -550.0); // it brakes as it drives
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SymmetricLimit;

/// Constants of [`SymmetricLimit`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SymmetricLimitConfig<N> {
    /// Largest torque, in either direction (N m).
    pub torque: N,
}

impl<N: Number> Limit<N> for SymmetricLimit {
    type Config = SymmetricLimitConfig<N>;

    #[inline(always)]
    fn most(&self, config: &Self::Config, _estimate: &Estimate<N>) -> N {
        config.torque
    }

    #[inline(always)]
    fn permitted(&self, config: &Self::Config, _estimate: &Estimate<N>, wanted: N) -> N {
        wanted.limited(config.torque)
    }
}

/// A range of torque: an engine or a turbine, which drives and does not brake.
///
/// ```
/// use driveline::governor::{Limit, TorqueRange, TorqueRangeConfig};
/// use driveline::sample::Estimate;
/// // an engine that brakes by its friction of 250 N m
/// const ENGINE: TorqueRangeConfig<f64> = TorqueRangeConfig { min: -250.0, max: 2546.0 };
/// assert_eq!(TorqueRange.permitted(&ENGINE, &Estimate::default(), -700.0), -250.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueRange;

/// Constants of [`TorqueRange`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueRangeConfig<N> {
    /// Smallest torque, zero or below (N m).
    pub min: N,
    /// Largest torque, above zero (N m).
    pub max: N,
}

/// Written so that a NaN gives the smallest.
#[inline(always)]
fn between<N: Number>(wanted: N, min: N, max: N) -> N {
    if wanted > max {
        max
    } else if wanted > min {
        wanted
    } else {
        min
    }
}

/// The larger of two magnitudes, of a least torque that is not positive and a largest that is not negative.
#[inline(always)]
fn larger<N: Number>(min: N, max: N) -> N {
    if max > -min { max } else { -min }
}

impl<N: Number> Limit<N> for TorqueRange {
    type Config = TorqueRangeConfig<N>;

    #[inline(always)]
    fn most(&self, config: &Self::Config, _estimate: &Estimate<N>) -> N {
        larger(config.min, config.max)
    }

    #[inline(always)]
    fn permitted(&self, config: &Self::Config, _estimate: &Estimate<N>, wanted: N) -> N {
        between(wanted, config.min, config.max)
    }
}

/// The prime mover's curve of torque against speed, by `K` straight lines; a power limit is part of it.
///
/// ```
/// use driveline::design::TorqueCurve;
/// use driveline::governor::{Curve, CurveConfig, Limit};
/// use driveline::{sample::Estimate, settings::Bases};
/// // 264 N m at rest, 1910 N m at 600 r/min: halfway between at 300 r/min
/// const POINTS: TorqueCurve<3> = TorqueCurve::through([[0.0, 264.0], [62.8, 1910.0], [125.7, 2838.0]]);
/// const CURVE: CurveConfig<f64, 3> = CurveConfig::<f64, 3>::new(&POINTS, 0.0, Bases::SI);
/// let halfway = Estimate { motor_speed: 31.4, ..Estimate::default() };
/// assert!((Curve.permitted(&CURVE, &halfway, 3000.0) - (264.0 + 1910.0) / 2.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Curve<const K: usize>;

/// A straight piece of a [`Curve`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CurvePiece<N: Number> {
    /// Where it begins (rad/s).
    pub speed: N,
    /// The largest torque there (N m).
    pub torque: N,
    /// Its slope (N m s/rad), on the [widened](Number::widened) speed.
    pub slope: N::Coefficient,
}

/// Constants of [`Curve`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CurveConfig<N: Number, const K: usize> {
    /// The pieces, speeds rising from zero; the last one is level.
    pub pieces: [CurvePiece<N>; K],
    /// Smallest torque, zero or below (N m).
    pub min: N,
}

impl<N: Number, const K: usize> CurveConfig<N, K> {
    /// The largest torque at a speed, either way.
    #[inline(always)]
    pub fn max_torque(&self, speed: N) -> N {
        let speed = speed.magnitude();
        let Some((mut piece, others)) = self.pieces.split_first() else { return N::ZERO };
        for other in others {
            if speed >= other.speed {
                piece = other;
            }
        }
        piece.torque + (speed - piece.speed).saturated().widened().times(piece.slope)
    }
}

impl<N: Number, const K: usize> Limit<N> for Curve<K> {
    type Config = CurveConfig<N, K>;

    #[inline(always)]
    fn most(&self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        larger(config.min, config.max_torque(estimate.motor_speed))
    }

    #[inline(always)]
    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N {
        between(wanted, config.min, config.max_torque(estimate.motor_speed))
    }
}

/// Another limit, and a slew limit. Where the other limit falls faster, it prevails.
///
/// ```
/// use driveline::governor::{Limit, Slew, SlewConfig, SymmetricLimit, SymmetricLimitConfig};
/// use driveline::{sample::Estimate, settings::Bases};
/// // 4000 N m/s at 1000 ticks a second: 300 N m in 75 ticks
/// const LIMIT: SymmetricLimitConfig<f64> = SymmetricLimitConfig { torque: 550.0 };
/// const SLEW: SlewConfig<f64, SymmetricLimitConfig<f64>> = SlewConfig::<f64, _>::new(4000.0, LIMIT, 1e-3, Bases::SI);
/// let mut slew = Slew::<SymmetricLimit, f64>::default();
/// let ticks = (1..).find(|_| slew.limit(&SLEW, &Estimate::default(), 300.0) == 300.0);
/// assert_eq!(ticks, Some(75));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Slew<L, N = f32> {
    last: N,
    limit: L,
}

/// Constants of [`Slew`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SlewConfig<N, L> {
    /// Largest change of the torque in a tick (N m).
    pub step: N,
    /// Constants of the other limit.
    pub limit: L,
}

impl<N: Number, L: Limit<N>> Limit<N> for Slew<L, N> {
    type Config = SlewConfig<N, L::Config>;

    #[inline(always)]
    fn most(&self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        self.limit.most(&config.limit, estimate)
    }

    #[inline(always)]
    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N {
        self.limit.permitted(&config.limit, estimate, wanted)
    }

    #[inline(always)]
    fn limit(&mut self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N {
        let slewed = self.last + (wanted - self.last).limited(config.step);
        self.last = self.limit.limit(&config.limit, estimate, slewed);
        self.last
    }

    #[inline(always)]
    fn start(&mut self, torque: N) {
        self.last = torque;
        self.limit.start(torque);
    }
}
