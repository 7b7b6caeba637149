//! Between a tick, which never waits, and sensors and outputs that are awaited.
//!
//! A task awaits the angle, runs the tick, and awaits the torque's way out. An awaited value may arrive late, fail, or
//! never arrive, where its future is dropped by a time limit. An angle is therefore good for one tick, and a torque
//! that was not handed over is a fault of the next tick.

use driveline::axis::{AngleSensor, TorqueOutput};
use driveline::fault::Faults;
use driveline::number::Number;

/// An angle that is awaited between two ticks.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AwaitedAngle(Option<Result<u32, Faults>>);

impl AwaitedAngle {
    /// None yet.
    pub const fn new() -> Self {
        AwaitedAngle(None)
    }

    /// Awaits an angle for the next tick. Where this is dropped there is none.
    pub async fn fetch(&mut self, angle: impl Future<Output = Result<u32, Faults>>) {
        self.0 = None;
        self.0 = Some(angle.await);
    }
}

/// Gives an angle once.
impl AngleSensor for AwaitedAngle {
    fn angle(&mut self) -> Result<u32, Faults> {
        self.0.take().unwrap_or(Err(Faults::ANGLE_MISSING))
    }
}

/// Where a torque is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Stage<N> {
    /// Handed over, or none yet.
    Given,
    /// Set by a tick.
    Waiting(N),
    /// Not handed over: on its way, dropped there, or failed.
    Out(N),
}

/// A torque that is handed over between two ticks.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AwaitedTorque<N>(Stage<N>);

impl<N: Number> AwaitedTorque<N> {
    /// None yet.
    pub const fn new() -> Self {
        AwaitedTorque(Stage::Given)
    }

    /// Writes the torque that the tick has set, if any; `output` is the output's awaited form. Where that fails, or
    /// this is dropped, the next torque that is set reports it; until then zero torque is written, repeatedly.
    pub async fn give(&mut self, output: impl AsyncFnOnce(N) -> Result<(), Faults>) {
        let (set, torque) = match self.0 {
            Stage::Given => return,
            Stage::Waiting(torque) => (torque, torque),
            Stage::Out(lost) => (lost, N::ZERO),
        };
        self.0 = Stage::Out(set);
        if output(torque).await.is_ok() && torque == set {
            self.0 = Stage::Given;
        }
    }
}

impl<N: Number> Default for AwaitedTorque<N> {
    fn default() -> Self {
        AwaitedTorque::new()
    }
}

/// Keeps a torque until it is handed over. It is a fault where the last one was not, but for a torque of zero that
/// still waits: one is set before there is a task that could hand it over.
impl<N: Number> TorqueOutput<N> for AwaitedTorque<N> {
    fn set_torque(&mut self, torque: N, _angle: u32) -> Result<(), Faults> {
        let last = core::mem::replace(&mut self.0, Stage::Waiting(torque));
        match last {
            Stage::Given => Ok(()),
            Stage::Waiting(zero) if zero == N::ZERO => Ok(()),
            Stage::Waiting(_) | Stage::Out(_) => Err(Faults::TORQUE_OUTPUT),
        }
    }
}
