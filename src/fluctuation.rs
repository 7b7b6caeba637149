//! Measure: how far the speed swings about its mean, cycle by cycle.
//!
//! Everything is synchronous in angle. The cycle is a turn of the motor, two for a four-stroke engine, or any ratio of whole numbers; where
//! in it the motor is follows from its wrapped angle in integers, so that nothing drifts however long the machine runs.
//!
//! | part | a tick does | gives |
//! |---|---|---|
//! | [`Extremes`] | compares the observer's speeds | every cycle: mean, largest and least speed of motor and load, delta |
//! | [`Waveform`] | counts itself in the bin of its angle | every few cycles: the mean waveform, orders, delta, torque, energy |
//! | a pair of both | both | both |
//!
//! What takes longer than a tick (divisions, sines, the waveform from its bins) is done by a `reading` between the ticks, in `f64`.
//!
//! # Why time is what is counted
//! An observer's speed follows a ripple late and not quite, and the quantisation of the encoder makes every largest value too large. The
//! time that the motor spends at each angle has neither fault: dt/dphi = 1/omega is what a tick samples when it merely counts, and over
//! some cycles the counts of an encoder average out.
//!
//! # Terms
//! *Slowness*: dt/dphi, the inverse of the speed. *Order*: multiples of a cycle's frequency; order 1 of a cycle of two turns is the
//! half order of the engine. *Delta*: (omega_max - omega_min)/omega_m [Notes ch. 5]. *Ripple*: what repeats every cycle; *trend*: what
//! does not.

mod extremes;
mod position;
mod series;
mod waveform;
mod window;

pub use extremes::{Extreme, Extremes, Fluctuations, Reading};
pub use position::{CycleConfig, Edge};
pub use series::{Order, Series};
pub use waveform::{Bin, Waveform, WaveformConfig};
pub use window::{MAX_ORDER, Ripple, Window};

use crate::number::Number;
use crate::sample::Estimate;

/// A measurement of the speed's fluctuation, advanced once a tick.
pub trait Fluctuation<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;

    /// Takes one tick's angle [2^-32 turn], the torque that the motor gave in it and the estimate into account.
    fn measure(&mut self, config: &Self::Config, angle: u32, torque: N, estimate: &Estimate<N>);

    /// This tick's angle cannot be used: what is being measured is void.
    fn disturb(&mut self);
}

/// Not measured.
impl<N: Number> Fluctuation<N> for () {
    type Config = ();

    #[inline(always)]
    fn measure(&mut self, _config: &(), _angle: u32, _torque: N, _estimate: &Estimate<N>) {}

    #[inline(always)]
    fn disturb(&mut self) {}
}

/// Both.
impl<N: Number, A: Fluctuation<N>, B: Fluctuation<N>> Fluctuation<N> for (A, B) {
    type Config = (A::Config, B::Config);

    #[inline(always)]
    fn measure(&mut self, config: &Self::Config, angle: u32, torque: N, estimate: &Estimate<N>) {
        self.0.measure(&config.0, angle, torque, estimate);
        self.1.measure(&config.1, angle, torque, estimate);
    }

    #[inline(always)]
    fn disturb(&mut self) {
        self.0.disturb();
        self.1.disturb();
    }
}
