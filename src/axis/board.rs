//! Interface of a control loop to its board and to the board's parts.

use crate::fault::Faults;

/// A board with a motor: an angle in, a torque out, the power stage on and off.
///
/// ```
/// use driveline::fault::Faults;
/// use driveline::axis::{Axis, Board};
/// # struct Timer; struct Bridge;
/// # impl Timer { fn count(&self) -> u32 { 0 } }
/// # impl Bridge { fn duty(&mut self, _: f32) {} fn enable(&mut self, _: bool) {} }
/// struct MyBoard {
///     encoder: Timer, // of 8192 counts a turn
///     bridge: Bridge,
/// }
///
/// impl Board<f32> for MyBoard {
///     fn angle(&mut self) -> Result<u32, Faults> {
///         Ok(self.encoder.count() << 19)
///     }
///     fn set_torque(&mut self, torque: f32, _angle: u32) -> Result<(), Faults> {
///         self.bridge.duty(torque / 2.5);
///         Ok(())
///     }
///     fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
///         self.bridge.enable(enabled);
///         Ok(())
///     }
/// }
/// ```
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

/// A sensor of the motor's angle.
#[doc(alias("encoder", "resolver"))]
pub trait AngleSensor {
    /// The angle now, 2^32 to the turn.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where there is none that is new and sound.
    fn angle(&mut self) -> Result<u32, Faults>;
}

/// An output for the torque.
pub trait TorqueOutput<N> {
    /// Gives `torque` from now on; `angle` is the motor's, 2^32 to the turn, for outputs that commutate.
    ///
    /// # Errors
    /// [`Faults::TORQUE_OUTPUT`] where it could not be handed over. Zero torque has then been written as far as
    /// possible.
    fn set_torque(&mut self, torque: N, angle: u32) -> Result<(), Faults>;
}

/// Switches the power stage.
pub trait Enabling {
    /// On or off.
    ///
    /// # Errors
    /// [`Faults::ENABLE`] where a line did not obey; all that do are then off.
    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults>;
}

/// A sensor of vibration.
#[doc(alias = "accelerometer")]
pub trait VibrationSensor<N> {
    /// The newest sample, `None` where none has come since the last call and none is overdue.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_CLIPPED`] where the sensor was at an end of its range, [`Faults::VIBRATION_MISSING`] where
    /// the sample is not sound otherwise, or overdue.
    fn vibration(&mut self) -> Result<Option<N>, Faults>;
}

/// A board made of parts.
///
/// ```
/// use driveline::axis::{AngleSensor, Board, Enabling, Parts, TorqueOutput};
/// use driveline::fault::Faults;
/// // parts of one's own, or drivers of `driveline-hal`
/// struct Encoder(u16); // of 8192 counts
/// impl AngleSensor for Encoder {
///     fn angle(&mut self) -> Result<u32, Faults> { Ok(u32::from(self.0) << 19) }
/// }
/// struct Bridge { duty: f32, on: bool }
/// impl TorqueOutput<f32> for Bridge {
///     fn set_torque(&mut self, torque: f32, _: u32) -> Result<(), Faults> { self.duty = torque / 2.5; Ok(()) }
/// }
/// struct Line;
/// impl Enabling for Line {
///     fn set_enabled(&mut self, _: bool) -> Result<(), Faults> { Ok(()) }
/// }
/// let mut board = Parts { angle: Encoder(2048), torque: Bridge { duty: 0.0, on: false }, enable: Line };
/// assert_eq!(Board::<f32>::angle(&mut board), Ok(1 << 30)); // a quarter of a turn
/// board.set_torque(1.25, 0)?;
/// assert_eq!(board.torque.duty, 0.5);
/// # Ok::<(), Faults>(())
/// ```
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

/// One after the other; off in the reverse order.
impl<A: Enabling, B: Enabling> Enabling for (A, B) {
    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        if enabled {
            let on = self.0.set_enabled(true).and_then(|()| self.1.set_enabled(true));
            if on.is_err() {
                let _ = self.set_enabled(false);
            }
            return on;
        }
        let second = self.1.set_enabled(false);
        self.0.set_enabled(false).and(second)
    }
}
