//! Advise: the unbalance of the rotor, from its vibration.

use crate::number::Number;

/// A measurement of the rotor's unbalance, advanced once a tick.
pub trait Balancer<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;

    /// Takes one tick's angle [2^-32 turn] and vibration into account.
    fn measure(&mut self, config: &Self::Config, angle: u32, vibration: N);
}

/// Not balanced.
impl<N: Number> Balancer<N> for () {
    type Config = ();

    #[inline(always)]
    fn measure(&mut self, _config: &(), _angle: u32, _vibration: N) {}
}
