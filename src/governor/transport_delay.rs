//! Transport delay of a fuel rack or steam valve: its torque acts later than its position.

use crate::number::Number;

/// Delays the torque of an actuator's position by its dead time, for the observer.
///
/// A ring of `K` ticks, a power of two. Nothing is screened.
///
/// ```
/// use driveline::governor::{TransportDelay, TransportDelayConfig};
/// // a firing delay of 5 ms at 1000 ticks a second
/// const DELAY: TransportDelayConfig<8> = TransportDelayConfig { ticks: 5 };
/// let mut delay = TransportDelay::new();
/// assert_eq!((0..20).position(|_| delay.delayed(&DELAY, 300.0) == 300.0), Some(5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TransportDelay<N, const K: usize> {
    past: [N; K],
    at: u32,
}

/// Constants of [`TransportDelay`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TransportDelayConfig<const K: usize> {
    /// Ticks of delay, below `K`.
    pub ticks: u32,
}

impl<N: Number, const K: usize> TransportDelay<N, K> {
    /// An actuator that has been at zero torque.
    pub const fn new() -> Self {
        const { assert!(K.is_power_of_two() && K <= 1 << 16, "the ring of a rack must hold a power of two of ticks") };
        TransportDelay { past: [N::ZERO; K], at: 0 }
    }

    /// Takes the torque of the tick that has just ended, and returns the delayed one.
    #[inline(always)]
    pub fn delayed(&mut self, config: &TransportDelayConfig<K>, torque: N) -> N {
        let (at, mask) = (self.at as usize, K - 1);
        self.at = self.at.wrapping_add(1);
        if let Some(slot) = self.past.get_mut(at & mask) {
            *slot = torque;
        }
        self.past.get(at.wrapping_sub(config.ticks as usize) & mask).copied().unwrap_or(torque)
    }
}

impl<N: Number, const K: usize> Default for TransportDelay<N, K> {
    fn default() -> Self {
        Self::new()
    }
}
