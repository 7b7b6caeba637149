//! Vibration from an ADXL355: three axes of 20 bits at up to 4 kHz, SPI mode 0.
//!
//! A read starts with the address shifted up by one and a set lowest bit. The burst from `STATUS` to the last of the
//! data returns the data together with their new-data flag [Analog Devices ADXL354/ADXL355, Rev. B, tables 16, 22 and
//! 24 to 26].

use driveline::axis::VibrationSensor;
use driveline::fault::Faults;

use super::{PerCount, Scaled};

const WHO: u8 = 0x00;
const STATUS: u8 = 0x04;
const FILTER: u8 = 0x28;
const RANGE: u8 = 0x2c;
const POWER: u8 = 0x2d;
/// Analog Devices, MEMS, ADXL355.
const IDENTITY: [u8; 3] = [0xad, 0x1d, 0xed];
const READY: u8 = 1 << 0;
/// The chip has lost its trimming.
const BUSY: u8 = 1 << 4;
/// Largest magnitude of 20 bits, less the clipping margin.
const CLIPPED: i32 = (1 << 19) - 1;

/// Full scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Range {
    /// 2.048 g, 256,000 counts to the g.
    G2,
    /// 4.096 g, 128,000 counts to the g.
    G4,
    /// 8.192 g, 64,000 counts to the g.
    G8,
}

impl Range {
    /// Acceleration per count (m/s2).
    pub const fn per_count(self) -> f64 {
        9.806_65
            / match self {
                Range::G2 => 256_000.0,
                Range::G4 => 128_000.0,
                Range::G8 => 64_000.0,
            }
    }

    const fn bits(self) -> u8 {
        match self {
            Range::G2 => 1,
            Range::G4 => 2,
            Range::G8 => 3,
        }
    }
}

/// The axis that is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Along {
    /// x.
    X,
    /// y.
    Y,
    /// z.
    Z,
}

/// An ADXL355 that measures.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Adxl355<S, N: Scaled> {
    bus: S,
    along: Along,
    per_count: PerCount<N>,
    patience: u32,
    /// Polls without a sample.
    waited: u32,
}

impl<S, N: Scaled> Adxl355<S, N> {
    /// The bus again.
    pub fn release(self) -> S {
        self.bus
    }

    /// Result of a burst.
    fn sample(&self, burst: [u8; 14]) -> Result<Option<N>, Faults> {
        // status, entries of the FIFO, temperature of 2, then x, y and z of 3
        let [_, status, _, _, _, x @ .., y2, y1, y0, z2, z1, z0] = burst;
        // a line that is stuck high has the busy bit, one that is stuck low is never ready
        if status & BUSY != 0 {
            return Err(Faults::VIBRATION_MISSING);
        }
        if status & READY == 0 {
            return Ok(None);
        }
        let [high, middle, low] = match self.along {
            Along::X => x,
            Along::Y => [y2, y1, y0],
            Along::Z => [z2, z1, z0],
        };
        let counts = i32::from_be_bytes([high, middle, low, 0]) >> 12;
        if counts <= -CLIPPED || counts >= CLIPPED {
            return Err(Faults::VIBRATION_CLIPPED);
        }
        Ok(Some(self.per_count.times(counts)))
    }

    /// The sample of a poll after `waited` without one, or that it is overdue.
    fn judged(&mut self, waited: u32, sample: Result<Option<N>, Faults>) -> Result<Option<N>, Faults> {
        // a clipped one has come all the same
        if matches!(sample, Ok(Some(_)) | Err(Faults::VIBRATION_CLIPPED)) {
            self.waited = 0;
            return sample;
        }
        self.waited = waited.saturating_add(1);
        if self.waited > self.patience { Err(Faults::VIBRATION_MISSING) } else { sample }
    }
}

impl<S: embedded_hal::spi::SpiDevice, N: Scaled> Adxl355<S, N> {
    /// Starts a chip at 4 kHz, after asking who it is; `per_count` is of [`Range::per_count`]. A sample is overdue
    /// after `patience` polls without one: three, say, of a loop at 10 kHz.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_MISSING`] and the bus, where it fails or another chip answers.
    pub fn start(
        bus: S,
        along: Along,
        range: Range,
        per_count: PerCount<N>,
        patience: u32,
    ) -> Result<Self, (Faults, S)> {
        let mut bus = bus;
        let mut who = IDENTIFY;
        let is_it = bus.transfer_in_place(&mut who).is_ok() && is_adxl355(who);
        if is_it && settings(range).iter().all(|setting| bus.write(setting).is_ok()) {
            Ok(Adxl355 { bus, along, per_count, patience, waited: 0 })
        } else {
            Err((Faults::VIBRATION_MISSING, bus))
        }
    }

    fn read(&mut self) -> Result<Option<N>, Faults> {
        let mut burst = BURST;
        self.bus.transfer_in_place(&mut burst).map_err(|_| Faults::VIBRATION_MISSING)?;
        self.sample(burst)
    }
}

impl<S: embedded_hal::spi::SpiDevice, N: Scaled> VibrationSensor<N> for Adxl355<S, N> {
    fn vibration(&mut self) -> Result<Option<N>, Faults> {
        let sample = self.read();
        self.judged(self.waited, sample)
    }
}

/// Polls without a sample, where the last one was cut off: far beyond any patience.
#[cfg(feature = "async")]
const CUT_OFF: u32 = u32::MAX;

#[cfg(feature = "async")]
impl<S: embedded_hal_async::spi::SpiDevice, N: Scaled> Adxl355<S, N> {
    /// [`Adxl355::start`], awaited.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_MISSING`] and the bus, where it fails or another chip answers.
    pub async fn start_async(
        bus: S,
        along: Along,
        range: Range,
        per_count: PerCount<N>,
        patience: u32,
    ) -> Result<Self, (Faults, S)> {
        let mut bus = bus;
        let mut who = IDENTIFY;
        let mut started = bus.transfer_in_place(&mut who).await.is_ok() && is_adxl355(who);
        for setting in settings(range) {
            started = started && bus.write(&setting).await.is_ok();
        }
        if started {
            Ok(Adxl355 { bus, along, per_count, patience, waited: 0 })
        } else {
            Err((Faults::VIBRATION_MISSING, bus))
        }
    }

    async fn read_async(&mut self) -> Result<Option<N>, Faults> {
        let mut burst = BURST;
        self.bus.transfer_in_place(&mut burst).await.map_err(|_| Faults::VIBRATION_MISSING)?;
        self.sample(burst)
    }

    /// [`VibrationSensor::vibration`], awaited: the same burst, checks and faults. Where the future is dropped, it may
    /// have taken a sample off the chip: the next call reports one as missing and takes none.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_CLIPPED`] and [`Faults::VIBRATION_MISSING`], as there.
    pub async fn vibration_async(&mut self) -> Result<Option<N>, Faults> {
        let waited = core::mem::replace(&mut self.waited, CUT_OFF);
        let sample = self.read_async().await;
        if waited == CUT_OFF {
            self.waited = 0;
            return Err(Faults::VIBRATION_MISSING);
        }
        // so many that are not cut off do not count as if
        self.judged(waited.min(CUT_OFF - 2), sample)
    }
}

/// Reads the chip's identity.
const IDENTIFY: [u8; 4] = [WHO << 1 | 1, 0, 0, 0];
/// Reads all from the status to the last of z.
const BURST: [u8; 14] = [STATUS << 1 | 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

fn is_adxl355(answer: [u8; 4]) -> bool {
    matches!(answer, [_, who @ ..] if who == IDENTITY)
}

/// Interrupt polarity as after a reset; no filter but the 1 kHz low-pass; measuring, without temperature.
const fn settings(range: Range) -> [[u8; 2]; 3] {
    [[RANGE << 1, 0x80 | range.bits()], [FILTER << 1, 0], [POWER << 1, 0]]
}
