//! A torque as a target of a TMC4671, a drive that controls the motor's current itself.
//!
//! Datagrams of 40 bits: an address, its top bit set to write, and 32 bits of data; a read value comes in the same
//! datagram. Register 0x64 holds the targets of torque (upper half) and flux (lower half) in the drive's units of
//! current, signed 16 bits [TMC4671 datasheet, register `PID_TORQUE_FLUX_TARGET`]. There is no checksum, so that each
//! target is read back.

use driveline::axis::TorqueOutput;
use driveline::fault::Faults;

use super::{FullScale, Scaled};

const TARGET: u8 = 0x64;
const WRITE: u8 = 0x80;

/// A TMC4671 in its torque mode (register 0x63 at 1), which the board has set up; the flux target stays zero.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tmc4671<S, N: Scaled> {
    bus: S,
    full_scale: FullScale<N>,
}

impl<S, N: Scaled> Tmc4671<S, N> {
    /// A drive, SPI mode 3, whose largest target of torque is `full_scale`.
    pub const fn new(bus: S, full_scale: FullScale<N>) -> Self {
        Tmc4671 { bus, full_scale }
    }

    /// The bus again.
    pub fn release(self) -> S {
        self.bus
    }
}

impl<S: embedded_hal::spi::SpiDevice, N: Scaled> Tmc4671<S, N> {
    /// Writes a target and reads it back.
    fn target(&mut self, torque: i16) -> Result<(), Faults> {
        self.bus.write(&write(torque)).map_err(|_| Faults::TORQUE_OUTPUT)?;
        let mut datagram = READ;
        self.bus.transfer_in_place(&mut datagram).map_err(|_| Faults::TORQUE_OUTPUT)?;
        reads_back(datagram, torque)
    }
}

impl<S: embedded_hal::spi::SpiDevice, N: Scaled> TorqueOutput<N> for Tmc4671<S, N> {
    fn set_torque(&mut self, torque: N, _angle: u32) -> Result<(), Faults> {
        let fraction = self.full_scale.fraction(torque);
        let set = self.target(fraction.unwrap_or(0) as i16);
        if set.is_err() {
            let _ = self.target(0);
        }
        if fraction.is_some() { set } else { Err(Faults::TORQUE_OUTPUT) }
    }
}

#[cfg(feature = "async")]
impl<S: embedded_hal_async::spi::SpiDevice, N: Scaled> Tmc4671<S, N> {
    async fn target_async(&mut self, torque: i16) -> Result<(), Faults> {
        self.bus.write(&write(torque)).await.map_err(|_| Faults::TORQUE_OUTPUT)?;
        let mut datagram = READ;
        self.bus.transfer_in_place(&mut datagram).await.map_err(|_| Faults::TORQUE_OUTPUT)?;
        reads_back(datagram, torque)
    }

    /// [`TorqueOutput::set_torque`], awaited: the same datagrams, check and faults. Where the future is dropped, the
    /// drive may give the last torque or this one: [`AwaitedTorque`](super::AwaitedTorque) takes that for a fault.
    ///
    /// # Errors
    /// [`Faults::TORQUE_OUTPUT`] where the torque could not be handed over.
    pub async fn set_torque_async(&mut self, torque: N) -> Result<(), Faults> {
        let fraction = self.full_scale.fraction(torque);
        let set = self.target_async(fraction.unwrap_or(0) as i16).await;
        if set.is_err() {
            let _ = self.target_async(0).await;
        }
        if fraction.is_some() { set } else { Err(Faults::TORQUE_OUTPUT) }
    }
}

/// The datagram that reads the target.
const READ: [u8; 5] = [TARGET, 0, 0, 0, 0];

/// The datagram that writes a target.
const fn write(torque: i16) -> [u8; 5] {
    let [high, low] = torque.to_be_bytes();
    [TARGET | WRITE, high, low, 0, 0]
}

/// Whether a target has arrived.
fn reads_back(answer: [u8; 5], torque: i16) -> Result<(), Faults> {
    let [_, is @ ..] = answer;
    let [_, was @ ..] = write(torque);
    if is == was { Ok(()) } else { Err(Faults::TORQUE_OUTPUT) }
}
