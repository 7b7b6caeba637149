//! Shaping of the setpoint: droop and barred speed ranges.

use crate::number::Number;

/// Shaping of the setpoint; `()` is none, a tuple is one after the other.
pub trait SetpointShape<N: Number>: Default {
    /// Its constants.
    type Config;

    /// The ramp's target for a setpoint and its largest step in this tick, from its present value (rad/s).
    #[inline(always)]
    fn goal(&self, _config: &Self::Config, setpoint: N, _ramped: N, ramp: N) -> (N, N) {
        (setpoint, ramp)
    }

    /// The setpoint less its droop under a steady torque (the integral and the feed-forward).
    #[inline(always)]
    fn lower(&self, _config: &Self::Config, ramped: N, _standing: N) -> N {
        ramped
    }
}

/// Isochronous, without barred ranges.
impl<N: Number> SetpointShape<N> for () {
    type Config = ();
}

impl<N: Number, A: SetpointShape<N>, B: SetpointShape<N>> SetpointShape<N> for (A, B) {
    type Config = (A::Config, B::Config);

    #[inline(always)]
    fn goal(&self, config: &Self::Config, setpoint: N, ramped: N, ramp: N) -> (N, N) {
        let (setpoint, ramp) = self.0.goal(&config.0, setpoint, ramped, ramp);
        self.1.goal(&config.1, setpoint, ramped, ramp)
    }

    #[inline(always)]
    fn lower(&self, config: &Self::Config, ramped: N, standing: N) -> N {
        self.1.lower(&config.1, self.0.lower(&config.0, ramped, standing), standing)
    }
}

/// Droop: the setpoint falls in proportion to the steady torque, so that gensets in parallel share the load.
///
/// Gensets of equal droop per rated torque carry equal shares of it; one without droop would carry the whole load. The
/// proportional part does not count: a droop on the whole torque would be an algebraic loop of gain k_p R in every
/// tick.
///
/// ```
/// use driveline::governor::{Droop, DroopConfig, SetpointShape};
/// use driveline::settings::Bases;
/// // 4 % of 1500 r/min at a rated torque of 2546 N m: at half of it the set turns at 1470 r/min
/// const DROOP: DroopConfig<f64> = DroopConfig::<f64>::new(0.04, 157.08, 2546.0, 1.0, Bases::SI);
/// assert!((Droop.lower(&DROOP, 157.08, 1273.0) * 60.0 / core::f64::consts::TAU - 1470.0).abs() < 0.01);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Droop;

/// Constants of [`Droop`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DroopConfig<N: Number> {
    /// Speed per torque (rad/(s N m)).
    pub droop: N::Coefficient,
}

impl<N: Number> SetpointShape<N> for Droop {
    type Config = DroopConfig<N>;

    #[inline(always)]
    fn lower(&self, config: &DroopConfig<N>, ramped: N, standing: N) -> N {
        ramped - standing.times(config.droop)
    }
}

/// Barred speed ranges: a setpoint inside one stops at the edge on the machine's side, and a ramp that must pass one is
/// quick. Ranges of both directions are given separately.
///
/// ```
/// use driveline::governor::{Barred, BarredConfig, SetpointShape, SpeedRange};
/// // no standing between 90 and 110 rad/s, which are passed by 0.5 rad/s a tick instead of 0.1
/// const BARRED: BarredConfig<f64, 1> =
///     BarredConfig { ranges: [SpeedRange { middle: 100.0, half: 10.0 }], quick: 0.5 };
/// assert_eq!(Barred.goal(&BARRED, 105.0, 60.0, 0.1), (90.0, 0.1)); // from below to the lower edge
/// assert_eq!(Barred.goal(&BARRED, 150.0, 95.0, 0.1), (150.0, 0.5)); // through
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("critical speed", "resonance"))]
pub struct Barred<const K: usize>;

/// A range of speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedRange<N> {
    /// Its middle (rad/s).
    pub middle: N,
    /// Half its width (rad/s).
    pub half: N,
}

/// Constants of [`Barred`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BarredConfig<N, const K: usize> {
    /// The ranges; they do not overlap.
    pub ranges: [SpeedRange<N>; K],
    /// Largest step of the setpoint in a tick inside a range (rad/s).
    pub quick: N,
}

impl<N: Number, const K: usize> SetpointShape<N> for Barred<K> {
    type Config = BarredConfig<N, K>;

    #[inline(always)]
    fn goal(&self, config: &Self::Config, setpoint: N, ramped: N, ramp: N) -> (N, N) {
        let (mut goal, mut step) = (setpoint, ramp);
        for range in &config.ranges {
            if !(goal - range.middle).exceeds(range.half) {
                let below = ramped < range.middle;
                goal = if below { range.middle - range.half } else { range.middle + range.half };
            }
            if !(ramped - range.middle).exceeds(range.half) {
                step = config.quick;
            }
        }
        (goal, step)
    }
}
