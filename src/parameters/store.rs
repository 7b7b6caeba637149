//! Two records in flash, of which the newest good one counts.

use core::fmt;
use core::ops::Range;

use embedded_storage::nor_flash::NorFlash;

use super::record::{self, Parameters, RecordError, RecordState, Refused};

/// Why parameters were not kept or found.
///
/// ```
#[doc = include_str!("flash.txt")]
/// use driveline::parameters::{Error, Store};
/// // three pages cannot hold two records of the same size
/// assert_eq!(Store::new(&mut flash, 0..3 * 2048).err(), Some(Error::Range));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Error<E> {
    /// The flash's own error.
    Flash(E),
    /// The range is not of an even number of whole pages.
    Range,
    /// The record does not fit the buffer, or half the range.
    TooLarge,
    /// The bytes read back differ from those written: a worn page, for instance. The last record is untouched.
    Unwritten,
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Flash(error) => write!(f, "the flash failed: {error:?}"),
            Error::Range => f.write_str("the range of the flash must be of an even number of whole pages"),
            Error::TooLarge => f.write_str("the record must fit the buffer and half the range"),
            Error::Unwritten => f.write_str("the flash does not hold what was written to it"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

/// The result of [`Store::load`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Loaded<P> {
    /// The parameters of the newest good record, if there is one.
    pub parameters: Option<P>,
    /// Why a record was refused; where both were, the newer one's reason.
    pub refused: Option<RecordError>,
}

/// Parameters in a range of a flash.
///
/// ```
#[doc = include_str!("flash.txt")]
/// use driveline::learning::Learnt;
/// use driveline::parameters::{Parameters, Store};
/// #[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
/// struct Kept { learnt: Learnt, hours: u32 }
/// impl Parameters for Kept {
///     const IDENTITY: u32 = u32::from_be_bytes(*b"hois");
///     const VERSION: u16 = 1;
/// }
/// let mut store = Store::new(&mut flash, 0..4096)?;
/// for hours in 1..=3 {
///     store.save(&Kept { learnt: Learnt::default(), hours }, &mut [0; 256])?;
/// }
/// // a bit of the newest record, in the first page, is lost: the one before it counts
/// store.release().0[30] ^= 1;
/// let kept = Store::new(&mut flash, 0..4096)?.load::<Kept>(&mut [0; 256])?;
/// assert_eq!(kept.parameters.map(|kept| kept.hours), Some(2));
/// # Ok::<(), driveline::parameters::Error<core::convert::Infallible>>(())
/// ```
#[derive(Debug)]
// Not logged: holds the flash.
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

    /// The newest good parameters. `buffer` holds a record and some bytes more; its content does not matter. A record
    /// that the flash does not give is refused, and the other one taken.
    ///
    /// # Errors
    /// The flash's error, where neither record can be read; [`Error::TooLarge`] where the buffer or half the range has
    /// no room for any record.
    pub fn load<P: Parameters>(&mut self, buffer: &mut [u8]) -> Result<Loaded<P>, Error<F::Error>> {
        if self.readable(buffer) < record::LEAST {
            return Err(Error::TooLarge);
        }
        let Newest { loaded, failed, .. } = self.newest(buffer);
        match failed {
            Some(error) => Err(Error::Flash(error)),
            None => Ok(loaded),
        }
    }

    /// Keeps parameters; they are there once this returns, and until then the last ones are. Without any that this
    /// firmware can read, its records of another version count: the less valuable record is overwritten, or else the
    /// older one.
    ///
    /// # Errors
    /// The flash's error; [`Error::TooLarge`] where the buffer or half the range has no room for them;
    /// [`Error::Unwritten`] where they are not read back.
    pub fn save<P: Parameters>(&mut self, parameters: &P, buffer: &mut [u8]) -> Result<(), Error<F::Error>> {
        let Newest { kept, failed, .. } = self.newest::<P>(buffer);
        if let Some(error) = failed {
            return Err(Error::Flash(error));
        }
        let (place, count) = kept.map_or((0, 0), |kept| (kept.place ^ 1, kept.count.wrapping_add(1)));
        let length = record::write(parameters, count, buffer).ok_or(Error::TooLarge)?;
        // up to a whole word, as if still erased
        let whole = length.next_multiple_of(F::WRITE_SIZE.max(1));
        buffer.get_mut(length..whole).ok_or(Error::TooLarge)?.fill(0xff);
        // A record that cannot be read back whole must not displace a valid one.
        if length > self.readable(buffer) {
            return Err(Error::TooLarge);
        }
        let bytes = buffer.get(..whole).filter(|bytes| bytes.len() <= self.half as usize).ok_or(Error::TooLarge)?;
        let from = self.start + place * self.half;
        self.flash.erase(from, from + self.half).map_err(Error::Flash)?;
        self.flash.write(from, bytes).map_err(Error::Flash)?;
        match self.fetch::<P>(place, buffer).map_err(Error::Flash)? {
            Some(Ok((_, read))) if read == count => Ok(()),
            _ => Err(Error::Unwritten),
        }
    }

    /// The flash again.
    pub fn release(self) -> F {
        self.flash
    }

    /// The newest good record, and the one of both that a save must leave alone.
    fn newest<P: Parameters>(&mut self, buffer: &mut [u8]) -> Newest<P, F::Error> {
        let mut parameters = None;
        let mut failures = 0;
        let mut failed = None;
        let mut refused: Option<Refused> = None;
        let mut kept: Option<Kept> = None;
        for place in 0..2 {
            let fetched = self.fetch::<P>(place, buffer).unwrap_or_else(|error| {
                failures += 1;
                failed = Some(error);
                Some(Err(Refused::UNREADABLE))
            });
            let found = match fetched {
                None => continue,
                Some(Ok((read, count))) => {
                    let found = Kept { state: RecordState::Good, place, count };
                    if kept.is_none_or(|kept| found.before(&kept)) {
                        parameters = Some(read);
                    }
                    found
                }
                Some(Err(reason)) => {
                    let newer = |other: &Refused| {
                        reason.count.zip(other.count).is_none_or(|(count, other)| is_newer(count, other))
                    };
                    if refused.as_ref().is_none_or(newer) {
                        refused = Some(reason);
                    }
                    Kept { state: reason.state, place, count: reason.count.unwrap_or(0) }
                }
            };
            if found.state > RecordState::Nothing && kept.is_none_or(|kept| found.before(&kept)) {
                kept = Some(found);
            }
        }
        let loaded = Loaded { parameters, refused: refused.map(|refused| refused.reason) };
        Newest { loaded, kept, failed: failed.filter(|_| failures == 2) }
    }

    /// How much of a record is read into a buffer: whole words that half the range has.
    fn readable(&self, buffer: &[u8]) -> usize {
        let length = buffer.len().min(self.half as usize);
        length - length % F::READ_SIZE.max(1)
    }

    fn fetch<P: Parameters>(&mut self, place: u32, buffer: &mut [u8]) -> Result<Fetched<P>, F::Error> {
        let length = self.readable(buffer);
        let bytes = buffer.get_mut(..length).unwrap_or(&mut []);
        self.flash.read(self.start + place * self.half, bytes)?;
        Ok((!record::is_erased(bytes)).then(|| record::read(bytes)))
    }
}

/// The newest record, and what its search met.
struct Newest<P, E> {
    loaded: Loaded<P>,
    /// The record that a save must leave alone.
    kept: Option<Kept>,
    /// The flash's error, where neither record can be read.
    failed: Option<E>,
}

/// The parameters of a record and the count of its save, or why it is refused; none where nothing was written.
type Fetched<P> = Option<Result<(P, u32), Refused>>;

/// A record that stands in the flash.
#[derive(Clone, Copy)]
struct Kept {
    state: RecordState,
    place: u32,
    count: u32,
}

impl Kept {
    /// Whether this one is to be kept rather than the other.
    fn before(&self, other: &Kept) -> bool {
        self.state > other.state || self.state == other.state && is_newer(self.count, other.count)
    }
}

/// Whether a save came after another: their counts are one apart, and wrap.
fn is_newer(count: u32, other: u32) -> bool {
    count.wrapping_sub(other) as i32 > 0
}
