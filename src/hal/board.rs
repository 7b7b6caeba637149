//! Interface of a control loop to its board.

use super::{AngleSensor, Enabling, TorqueOutput};
use crate::fault::Faults;

/// A board with a motor: an angle in, a torque out, the power stage on and off.
pub trait Board<N> {
    /// Ticks that should have run since the last one and did not, as [`MissedTicks`](super::MissedTicks) counts them:
    /// none, where the board cannot miss one.
    fn missed(&mut self) -> u32 {
        0
    }

    /// The motor's angle now, 2^32 to the turn.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where there is none that is new and sound.
    fn angle(&mut self) -> Result<u32, Faults>;

    /// The motor's torque (N m) during the tick that has just ended: `set` where it follows its command. A board that
    /// measures currents returns the measured value.
    ///
    /// # Errors
    /// [`Faults::TORQUE`] where the measurement failed; `set` is taken then.
    fn torque(&mut self, set: N) -> Result<N, Faults> {
        Ok(set)
    }

    /// Gives a torque from now on; `angle` is the motor's, for boards that commutate.
    ///
    /// # Errors
    /// [`Faults::TORQUE_OUTPUT`] where it could not be handed over.
    fn set_torque(&mut self, torque: N, angle: u32) -> Result<(), Faults>;

    /// Switches the power stage.
    ///
    /// # Errors
    /// [`Faults::ENABLE`] where a line did not obey.
    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults>;

    /// A tick has run to its end: the place to feed a watchdog.
    fn alive(&mut self) {}
}

/// A board made of adapters.
#[derive(Clone, Copy, Debug)]
// Not logged: holds the parts of a board.
pub struct Parts<A, T, E> {
    /// The angle.
    pub angle: A,
    /// The torque.
    pub torque: T,
    /// The power stage.
    pub enable: E,
}

impl<N, A: AngleSensor, T: TorqueOutput<N>, E: Enabling> Board<N> for Parts<A, T, E> {
    fn angle(&mut self) -> Result<u32, Faults> {
        self.angle.angle()
    }

    fn set_torque(&mut self, torque: N, angle: u32) -> Result<(), Faults> {
        self.torque.set_torque(torque, angle)
    }

    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        self.enable.set_enabled(enabled)
    }
}
