//! The torque output.

use crate::fault::Faults;

/// An output for the torque.
pub trait TorqueOutput<N> {
    /// Gives `torque` from now on; `angle` is the motor's, 2^32 to the turn, for outputs that commutate.
    ///
    /// # Errors
    /// [`Faults::TORQUE_OUTPUT`] where it could not be handed over. Zero torque has then been written as far as
    /// possible.
    fn set_torque(&mut self, torque: N, angle: u32) -> Result<(), Faults>;
}
