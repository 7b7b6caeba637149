//! Act: the torque that the motor is to produce.
//!
//! # Terms
//! *Set point*: the motor speed that is wanted. *Anti-windup*: the integral stops where the torque is limited.
//! *Active damping*: torque against the rate of twist, as a damper between motor and load would give it, by the motor alone.

mod speed_loop;

pub use speed_loop::{SpeedLoop, SpeedLoopConfig};

use crate::number::Number;
use crate::sample::Estimate;

/// A controller of the motor's torque, advanced once a tick.
pub trait Governor<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;

    /// Whether it commands the torque. Where it does not, something else does.
    const COMMANDS: bool;

    /// Takes a set point that can be believed; it stands until the next.
    fn refer(&mut self, reference: N);

    /// The torque for the tick that begins.
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N;

    /// Starts anew from the speed that the machine has and the torque that it is given now, so that the first command is no jolt; the set
    /// point is a standstill.
    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>, torque: N);
}

/// No governor: the drive observes, and commands no torque.
impl<N: Number> Governor<N> for () {
    type Config = ();

    const COMMANDS: bool = false;

    #[inline(always)]
    fn refer(&mut self, _reference: N) {}

    #[inline(always)]
    fn command(&mut self, _config: &(), _estimate: &Estimate<N>) -> N {
        N::ZERO
    }

    fn start(&mut self, _config: &(), _estimate: &Estimate<N>, _torque: N) {}
}
