//! A torque as a voltage: a DAC on SPI before a drive's analog input.

use embedded_hal::spi::SpiDevice;

use super::{FullScale, Scaled, TorqueOutput};
use crate::fault::Faults;

/// Which DAC it is. Its middle code is no torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Dac {
    /// AD5662: 16 bits, frames of 24 [Analog Devices AD5662, Rev. A, figure 41].
    Ad5662,
    /// MCP4921: 12 bits, frames of 16; not buffered, gain 1 [Microchip DS22248, register 5-1].
    Mcp4921,
}

/// A DAC on its bus. It cannot be read back: a wire that breaks behind the bus is not seen here, but by the drive that it feeds.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpiDac<S, N: Scaled> {
    bus: S,
    dac: Dac,
    full_scale: FullScale<N>,
}

impl<S: SpiDevice, N: Scaled> SpiDac<S, N> {
    /// A DAC whose largest code is `full_scale`.
    pub const fn new(bus: S, dac: Dac, full_scale: FullScale<N>) -> Self {
        SpiDac { bus, dac, full_scale }
    }

    /// The bus again.
    pub fn release(self) -> S {
        self.bus
    }

    fn write(&mut self, fraction: i32) -> Result<(), S::Error> {
        let code = (fraction + 32768) as u16;
        let [high, low] = code.to_be_bytes();
        match self.dac {
            // power-down bits zero: normal operation
            Dac::Ad5662 => self.bus.write(&[0, high, low]),
            Dac::Mcp4921 => self.bus.write(&(0x3000 | (code >> 4)).to_be_bytes()),
        }
    }
}

impl<S: SpiDevice, N: Scaled> TorqueOutput<N> for SpiDac<S, N> {
    fn set_torque(&mut self, torque: N, _angle: u32) -> Result<(), Faults> {
        let fraction = self.full_scale.fraction(torque);
        let written = self.write(fraction.unwrap_or(0));
        if written.is_err() {
            let _ = self.write(0);
        }
        if written.is_ok() && fraction.is_some() { Ok(()) } else { Err(Faults::TORQUE_OUTPUT) }
    }
}
