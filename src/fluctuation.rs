//! Measure: how far the speed swings about its mean.

use crate::number::Number;
use crate::sample::Estimate;

/// A measurement of the speed's fluctuation, advanced once a tick.
pub trait Fluctuation<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;

    /// Takes one tick's angle [2^-32 turn] and estimate into account.
    fn measure(&mut self, config: &Self::Config, angle: u32, estimate: &Estimate<N>);
}

/// Not measured.
impl<N: Number> Fluctuation<N> for () {
    type Config = ();

    #[inline(always)]
    fn measure(&mut self, _config: &(), _angle: u32, _estimate: &Estimate<N>) {}
}
