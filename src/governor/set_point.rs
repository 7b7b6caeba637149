//! What shapes the set point: droop, and speeds that the machine must not dwell at.

use crate::number::Number;

/// A shape of the set point; `()` leaves it as it is, a tuple is one after the other.
pub trait SetPoint<N: Number>: Default {
    /// Its constants.
    type Config;

    /// Where the ramp is to go for a reference, and its largest step in this tick, from where it stands now [rad/s].
    #[inline(always)]
    fn aim(&self, _config: &Self::Config, reference: N, _set_point: N, ramp: N) -> (N, N) {
        (reference, ramp)
    }

    /// The set point less what it yields to a standing torque (the integral and what is fed forward).
    #[inline(always)]
    fn lower(&self, _config: &Self::Config, set_point: N, _standing: N) -> N {
        set_point
    }
}

/// Isochronous, and no speed is barred.
impl<N: Number> SetPoint<N> for () {
    type Config = ();
}

impl<N: Number, A: SetPoint<N>, B: SetPoint<N>> SetPoint<N> for (A, B) {
    type Config = (A::Config, B::Config);

    #[inline(always)]
    fn aim(&self, config: &Self::Config, reference: N, set_point: N, ramp: N) -> (N, N) {
        let (reference, ramp) = self.0.aim(&config.0, reference, set_point, ramp);
        self.1.aim(&config.1, reference, set_point, ramp)
    }

    #[inline(always)]
    fn lower(&self, config: &Self::Config, set_point: N, standing: N) -> N {
        self.1.lower(&config.1, self.0.lower(&config.0, set_point, standing), standing)
    }
}

/// Droop: the set point yields in proportion to the standing torque, so that sets which turn together share the load.
///
/// Sets with equal droop per rated torque carry equal shares of theirs; a set with none would carry all. The
/// proportional part does not count: a droop on the whole torque would be an algebraic loop of gain k_p R in every
/// tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Droop;

/// Constants of [`Droop`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DroopConfig<N: Number> {
    /// Speed per torque [rad/(s N m)].
    pub droop: N::Coefficient,
}

impl<N: Number> SetPoint<N> for Droop {
    type Config = DroopConfig<N>;

    #[inline(always)]
    fn lower(&self, config: &DroopConfig<N>, set_point: N, standing: N) -> N {
        set_point.minus(standing.times(config.droop))
    }
}

/// Barred ranges of speed: a reference inside one stops at the edge on the machine's side, and a set point that must
/// pass one does so by a quick ramp. Ranges for both directions are ranges of their own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Barred<const K: usize>;

/// A range of speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Window<N> {
    /// Its middle [rad/s].
    pub middle: N,
    /// Half its width [rad/s].
    pub half: N,
}

/// Constants of [`Barred`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BarredConfig<N, const K: usize> {
    /// The ranges; they do not overlap.
    pub ranges: [Window<N>; K],
    /// Largest step of the set point in a tick inside a range [rad/s].
    pub quick: N,
}

impl<N: Number, const K: usize> SetPoint<N> for Barred<K> {
    type Config = BarredConfig<N, K>;

    #[inline(always)]
    fn aim(&self, config: &Self::Config, reference: N, set_point: N, ramp: N) -> (N, N) {
        let (mut aim, mut step) = (reference, ramp);
        for range in &config.ranges {
            if !aim.minus(range.middle).exceeds(range.half) {
                let below = set_point < range.middle;
                aim = if below { range.middle.minus(range.half) } else { range.middle.plus(range.half) };
            }
            if !set_point.minus(range.middle).exceeds(range.half) {
                step = config.quick;
            }
        }
        (aim, step)
    }
}
