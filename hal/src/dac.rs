//! A torque as a voltage: a DAC on SPI before a drive's analog input.

use driveline::axis::TorqueOutput;
use driveline::fault::Faults;

use super::{FullScale, Scaled};

/// Which DAC it is. Its middle code is no torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Dac {
    /// AD5662: 16 bits, frames of 24 [Analog Devices AD5662, Rev. A, figure 41].
    Ad5662,
    /// MCP4921: 12 bits, frames of 16; not buffered, gain 1 [Microchip DS22248, register 5-1].
    Mcp4921,
}

/// A DAC on its bus. It cannot be read back: a wire that breaks behind the bus is not seen here, but by the drive that
/// it feeds.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpiDac<S, N: Scaled> {
    bus: S,
    dac: Dac,
    full_scale: FullScale<N>,
}

impl<S, N: Scaled> SpiDac<S, N> {
    /// A DAC whose largest code is `full_scale`.
    pub const fn new(bus: S, dac: Dac, full_scale: FullScale<N>) -> Self {
        SpiDac { bus, dac, full_scale }
    }

    /// The bus again.
    pub fn release(self) -> S {
        self.bus
    }
}

impl<S: embedded_hal::spi::SpiDevice, N: Scaled> SpiDac<S, N> {
    fn write(&mut self, fraction: i32) -> Result<(), Faults> {
        match self.dac {
            Dac::Ad5662 => self.bus.write(&ad5662(fraction)),
            Dac::Mcp4921 => self.bus.write(&mcp4921(fraction)),
        }
        .map_err(|_| Faults::TORQUE_OUTPUT)
    }
}

impl<S: embedded_hal::spi::SpiDevice, N: Scaled> TorqueOutput<N> for SpiDac<S, N> {
    fn set_torque(&mut self, torque: N, _angle: u32) -> Result<(), Faults> {
        let fraction = self.full_scale.fraction(torque);
        let written = self.write(fraction.unwrap_or(0));
        if written.is_err() {
            let _ = self.write(0);
        }
        if written.is_ok() && fraction.is_some() { Ok(()) } else { Err(Faults::TORQUE_OUTPUT) }
    }
}

#[cfg(feature = "async")]
impl<S: embedded_hal_async::spi::SpiDevice, N: Scaled> SpiDac<S, N> {
    async fn write_async(&mut self, fraction: i32) -> Result<(), Faults> {
        match self.dac {
            Dac::Ad5662 => self.bus.write(&ad5662(fraction)).await,
            Dac::Mcp4921 => self.bus.write(&mcp4921(fraction)).await,
        }
        .map_err(|_| Faults::TORQUE_OUTPUT)
    }

    /// [`TorqueOutput::set_torque`], awaited: the same frames and faults. Where the future is dropped, the output may
    /// give the last torque or this one: [`AwaitedTorque`](super::AwaitedTorque) takes that for a fault.
    ///
    /// # Errors
    /// [`Faults::TORQUE_OUTPUT`] where the torque could not be handed over.
    pub async fn set_torque_async(&mut self, torque: N) -> Result<(), Faults> {
        let fraction = self.full_scale.fraction(torque);
        let written = self.write_async(fraction.unwrap_or(0)).await;
        if written.is_err() {
            let _ = self.write_async(0).await;
        }
        if written.is_ok() && fraction.is_some() { Ok(()) } else { Err(Faults::TORQUE_OUTPUT) }
    }
}

/// The code of a fraction in 1/32768; the middle is none.
const fn code(fraction: i32) -> u16 {
    (fraction + 32768) as u16
}

/// The power-down bits are zero: normal operation.
const fn ad5662(fraction: i32) -> [u8; 3] {
    let [high, low] = code(fraction).to_be_bytes();
    [0, high, low]
}

const fn mcp4921(fraction: i32) -> [u8; 2] {
    (0x3000 | (code(fraction) >> 4)).to_be_bytes()
}
