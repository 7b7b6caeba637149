//! Magnetic absolute encoders on SPI: AS5047P and AS5048A.
//!
//! 16-bit frames, SPI mode 1, most significant bit first. A frame's answer comes with the next frame. A reading is two
//! frames: the first requests the angle and returns the diagnosis of the last request, the second requests the
//! diagnosis and returns the angle. So every angle was requested in this tick, and every diagnosis is at most a tick
//! old [ams AS5047P DS000324, AS5048A datasheet].
//!
//! | checked in every frame | against |
//! |---|---|
//! | parity | a flipped bit; a line that is stuck high also sets the error bit |
//! | error bit | a command that the chip did not understand; the register is read, which clears it |
//! | offset compensation finished | a chip that has just started, and a line that is stuck low: zeros have an even parity |
//! | CORDIC overflow, field too strong, field too weak | a magnet that has moved or gone |

use driveline::axis::AngleSensor;
use driveline::fault::Faults;

/// Which chip it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Chip {
    /// AS5047P: the angle is compensated for the time that the chip takes.
    As5047P,
    /// AS5048A.
    As5048A,
}

const READ: u16 = 1 << 14;
const ERROR: u16 = 1 << 14;
const DATA: u16 = 0x3fff;
const ANGLE: u16 = 0x3fff;
const ERRORS: u16 = 0x0001;
const FINISHED: u16 = 1 << 8;
/// CORDIC overflow, field too strong, field too weak.
const TROUBLE: u16 = 0b111 << 9;

impl Chip {
    const fn diagnosis(self) -> u16 {
        match self {
            Chip::As5047P => 0x3ffc,
            Chip::As5048A => 0x3ffd,
        }
    }
}

/// A magnetic encoder.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MagneticEncoder<S> {
    bus: S,
    chip: Chip,
    /// Whether the next answer is a diagnosis. It is not while a reading runs, so that one that is cut off is followed
    /// by one from the start.
    asked: bool,
}

impl<S> MagneticEncoder<S> {
    /// An encoder on its bus: mode 1, at most 10 MHz.
    pub const fn new(bus: S, chip: Chip) -> Self {
        MagneticEncoder { bus, chip, asked: false }
    }

    /// The bus again.
    pub fn release(self) -> S {
        self.bus
    }

    /// The angle of a reading's two answers, where the diagnosis permits it.
    fn angle_of(&mut self, state: u16, angle: u16) -> Result<u32, Faults> {
        self.asked = true;
        if state & FINISHED == 0 || state & TROUBLE != 0 {
            return Err(Faults::ANGLE_MISSING);
        }
        Ok((angle as u32) << 18)
    }
}

impl<S: embedded_hal::spi::SpiDevice> MagneticEncoder<S> {
    /// Sends a command and returns the answer to the last one.
    fn exchange(&mut self, register: u16) -> Result<[u8; 2], Faults> {
        let mut frame = command(register);
        self.bus.transfer_in_place(&mut frame).map_err(|_| Faults::ANGLE_MISSING)?;
        Ok(frame)
    }

    fn read(&mut self) -> Result<u32, Faults> {
        let diagnosis = self.chip.diagnosis();
        if !self.asked {
            // the answer to no request
            self.exchange(diagnosis)?;
        }
        self.asked = false;
        let state = data(self.exchange(ANGLE)?)?;
        let angle = data(self.exchange(diagnosis)?)?;
        self.angle_of(state, angle)
    }
}

impl<S: embedded_hal::spi::SpiDevice> AngleSensor for MagneticEncoder<S> {
    fn angle(&mut self) -> Result<u32, Faults> {
        let angle = self.read();
        if angle.is_err() && !self.asked {
            // reading the errors clears them; the answer does not matter
            let _ = self.exchange(ERRORS);
        }
        angle
    }
}

#[cfg(feature = "async")]
impl<S: embedded_hal_async::spi::SpiDevice> MagneticEncoder<S> {
    async fn exchange_async(&mut self, register: u16) -> Result<[u8; 2], Faults> {
        let mut frame = command(register);
        self.bus.transfer_in_place(&mut frame).await.map_err(|_| Faults::ANGLE_MISSING)?;
        Ok(frame)
    }

    async fn read_async(&mut self) -> Result<u32, Faults> {
        let diagnosis = self.chip.diagnosis();
        if !self.asked {
            self.exchange_async(diagnosis).await?;
        }
        self.asked = false;
        let state = data(self.exchange_async(ANGLE).await?)?;
        let angle = data(self.exchange_async(diagnosis).await?)?;
        self.angle_of(state, angle)
    }

    /// [`AngleSensor::angle`], awaited: the same frames, checks and faults. Where the future is dropped, the next
    /// reading starts afresh.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where there is no angle that is new and sound.
    pub async fn angle_async(&mut self) -> Result<u32, Faults> {
        let angle = self.read_async().await;
        if angle.is_err() && !self.asked {
            let _ = self.exchange_async(ERRORS).await;
        }
        angle
    }
}

/// The frame that requests a register.
const fn command(register: u16) -> [u8; 2] {
    with_parity(READ | register).to_be_bytes()
}

/// The data of an answer that is sound.
fn data(answer: [u8; 2]) -> Result<u16, Faults> {
    let answer = u16::from_be_bytes(answer);
    if answer.count_ones() & 1 != 0 || answer & ERROR != 0 {
        return Err(Faults::ANGLE_MISSING);
    }
    Ok(answer & DATA)
}

/// Makes the number of ones even.
const fn with_parity(frame: u16) -> u16 {
    frame | ((frame.count_ones() as u16 & 1) << 15)
}
