//! Two records in flash, of which the newest good one counts.

use core::fmt;
use core::ops::Range;

use embedded_storage::nor_flash::NorFlash;

use super::record::{self, Parameters, Refusal};

/// Why parameters were not kept or found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Error<E> {
    /// The flash says so.
    Flash(E),
    /// The range is not of an even number of whole pages.
    Range,
    /// The record does not fit the buffer, or half the range.
    TooLarge,
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Flash(error) => write!(f, "the flash failed: {error:?}"),
            Error::Range => f.write_str("the range of the flash must be of an even number of whole pages"),
            Error::TooLarge => f.write_str("the record must fit the buffer and half the range"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Loaded<P> {
    /// The parameters of the newest good record, if there is one.
    pub parameters: Option<P>,
    /// Why a record was refused; where both were, the newer one's reason.
    pub refused: Option<Refusal>,
}

/// Parameters in a range of a flash.
#[derive(Debug)]
pub struct Store<F> {
    flash: F,
    start: u32,
    /// Bytes of each half.
    half: u32,
}

impl<F: NorFlash> Store<F> {
    /// A store in a range of addresses of `flash`: an even number of whole pages. Nothing is read or written here.
    ///
    /// # Errors
    /// [`Error::Range`].
    pub fn new(flash: F, range: Range<u32>) -> Result<Self, Error<F::Error>> {
        let half = range.end.checked_sub(range.start).ok_or(Error::Range)? / 2;
        let page = F::ERASE_SIZE as u32;
        let whole = range.start.is_multiple_of(page) && half.is_multiple_of(page) && half > 0;
        if !whole || half * 2 != range.end - range.start || range.end as usize > flash.capacity() {
            return Err(Error::Range);
        }
        Ok(Store { flash, start: range.start, half })
    }

    /// The newest good parameters. `buffer` holds a record and some bytes more; what is in it does not matter.
    ///
    /// # Errors
    /// What the flash says.
    pub fn load<P: Parameters>(&mut self, buffer: &mut [u8]) -> Result<Loaded<P>, Error<F::Error>> {
        Ok(self.newest(buffer)?.0)
    }

    /// Keeps parameters; they are there once this returns, and until then the last ones are.
    ///
    /// # Errors
    /// What the flash says; [`Error::TooLarge`] where the buffer or half the range has no room for them.
    pub fn save<P: Parameters>(&mut self, parameters: &P, buffer: &mut [u8]) -> Result<(), Error<F::Error>> {
        let (_, newest) = self.newest::<P>(buffer)?;
        let (place, count) = newest.map_or((0, 0), |(place, count)| (place ^ 1, count.wrapping_add(1)));
        let length = record::write(parameters, count, buffer).ok_or(Error::TooLarge)?;
        // up to a whole word, as if still erased
        let whole = length.next_multiple_of(F::WRITE_SIZE);
        buffer.get_mut(length..whole).ok_or(Error::TooLarge)?.fill(0xff);
        let bytes = buffer.get(..whole).filter(|bytes| bytes.len() <= self.half as usize).ok_or(Error::TooLarge)?;
        let from = self.start + place * self.half;
        self.flash.erase(from, from + self.half).map_err(Error::Flash)?;
        self.flash.write(from, bytes).map_err(Error::Flash)
    }

    /// The flash again.
    pub fn release(self) -> F {
        self.flash
    }

    /// The newest good record, and its place and count.
    #[allow(clippy::type_complexity)]
    fn newest<P: Parameters>(&mut self, buffer: &mut [u8]) -> Result<(Loaded<P>, Option<(u32, u32)>), Error<F::Error>> {
        let mut good: Option<(P, u32, u32)> = None;
        let mut refused: Option<(Refusal, Option<u32>)> = None;
        for place in 0..2 {
            match self.fetch::<P>(place, buffer)? {
                None => {}
                Some(Ok((parameters, count))) => {
                    // the counts are one apart; they wrap
                    let newer = good.as_ref().is_none_or(|(_, _, other)| (count.wrapping_sub(*other) as i32) > 0);
                    good = if newer { Some((parameters, place, count)) } else { good };
                }
                Some(Err(reason)) => {
                    let newer = |other: &(Refusal, Option<u32>)| {
                        reason.1.zip(other.1).is_none_or(|(count, other)| (count.wrapping_sub(other) as i32) > 0)
                    };
                    if refused.as_ref().is_none_or(newer) {
                        refused = Some(reason);
                    }
                }
            }
        }
        let refused = refused.map(|(reason, _)| reason);
        Ok(match good {
            Some((parameters, place, count)) => {
                (Loaded { parameters: Some(parameters), refused }, Some((place, count)))
            }
            None => (Loaded { parameters: None, refused }, None),
        })
    }

    #[allow(clippy::type_complexity)]
    fn fetch<P: Parameters>(
        &mut self,
        place: u32,
        buffer: &mut [u8],
    ) -> Result<Option<Result<(P, u32), (Refusal, Option<u32>)>>, Error<F::Error>> {
        let length = buffer.len().min(self.half as usize);
        let length = length - length % F::READ_SIZE.max(1);
        let bytes = buffer.get_mut(..length).unwrap_or(&mut []);
        self.flash.read(self.start + place * self.half, bytes).map_err(Error::Flash)?;
        Ok((!record::is_erased(bytes)).then(|| record::read(bytes)))
    }
}
