//! The bytes of a record and the errors in reading one.

use core::fmt;

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Parameters to keep: any type with `serde`, without lifetimes.
///
/// ```
#[doc = include_str!("flash.txt")]
/// use driveline::parameters::{Parameters, RecordError, Store};
/// #[derive(serde::Serialize, serde::Deserialize)]
/// struct Old { hours: u32 }
/// impl Parameters for Old {
///     const IDENTITY: u32 = u32::from_be_bytes(*b"hois");
///     const VERSION: u16 = 1;
/// }
/// #[derive(serde::Serialize, serde::Deserialize)]
/// struct New { hours: u32, starts: u32 }
/// impl Parameters for New {
///     const IDENTITY: u32 = Old::IDENTITY;
///     const VERSION: u16 = 2; // another form: another version
/// }
/// let mut store = Store::new(&mut flash, 0..4096)?;
/// store.save(&Old { hours: 7 }, &mut [0; 256])?;
/// assert_eq!(store.load::<New>(&mut [0; 256])?.refused, Some(RecordError::Version(1)));
/// assert_eq!(store.load::<Old>(&mut [0; 256])?.parameters.map(|old| old.hours), Some(7));
/// # Ok::<(), driveline::parameters::Error<core::convert::Infallible>>(())
/// ```
pub trait Parameters: Serialize + DeserializeOwned {
    /// Identity of the parameters: a number of the firmware's own.
    const IDENTITY: u32;
    /// Version of their form; another one is refused.
    const VERSION: u16;
}

/// Why a record is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RecordError {
    /// It is not whole, or a bit of it has changed.
    Damaged,
    /// It is another firmware's, whose identity this is.
    Foreign(u32),
    /// Its form is of this version.
    Version(u16),
    /// Its parameters do not match the type.
    Content,
    /// The flash cannot read it: for instance, its error-correcting code fails after a power cut during a write.
    Unreadable,
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RecordError::Damaged => f.write_str("the record is damaged"),
            RecordError::Foreign(identity) => write!(f, "the record is another firmware's, {identity:#010x}"),
            RecordError::Version(version) => write!(f, "the record is of version {version}"),
            RecordError::Content => f.write_str("the record's parameters cannot be read"),
            RecordError::Unreadable => f.write_str("the flash does not give the record"),
        }
    }
}

impl core::error::Error for RecordError {}

const MAGIC: [u8; 4] = *b"DLP1";
const HEAD: usize = 18;
const CHECK: usize = 4;
/// Bytes of the least record, which has no parameters.
pub(super) const LEAST: usize = HEAD + CHECK;

/// Writes a record; gives its length, `None` where there is no room for it.
pub(super) fn write<P: Parameters>(parameters: &P, count: u32, bytes: &mut [u8]) -> Option<usize> {
    let (head, content) = bytes.split_first_chunk_mut::<HEAD>()?;
    head[..4].copy_from_slice(&MAGIC);
    head[4..8].copy_from_slice(&P::IDENTITY.to_le_bytes());
    head[8..10].copy_from_slice(&P::VERSION.to_le_bytes());
    head[10..14].copy_from_slice(&count.to_le_bytes());
    let room = content.len().checked_sub(CHECK)?;
    let length = postcard::to_slice(parameters, content.get_mut(..room)?).ok()?.len();
    bytes.get_mut(HEAD - 4..HEAD)?.copy_from_slice(&(length as u32).to_le_bytes());
    let check = crc(bytes.get(..HEAD + length)?).to_le_bytes();
    bytes.get_mut(HEAD + length..HEAD + length + CHECK)?.copy_from_slice(&check);
    Some(HEAD + length + CHECK)
}

/// Whether nothing was written here since it was erased.
pub(super) fn is_erased(bytes: &[u8]) -> bool {
    bytes.iter().all(|&byte| byte == 0xff)
}

/// How worth keeping a record in the flash is to whom reads it as `P`, in rising order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum RecordState {
    /// Nothing is there, or nothing that is whole.
    Nothing,
    /// It begins as a record does and is longer than the buffer: undecided.
    Unknown,
    /// Sound, another firmware's.
    Foreign,
    /// Sound, this firmware's, in another form.
    Other,
    /// Sound, and parameters.
    Good,
}

/// A record that is refused.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refused {
    pub reason: RecordError,
    pub state: RecordState,
    /// The count of its save that it claims, where it has one.
    pub count: Option<u32>,
}

impl Refused {
    /// A place that the flash does not give.
    pub(super) const UNREADABLE: Refused =
        Refused { reason: RecordError::Unreadable, state: RecordState::Nothing, count: None };
}

/// Reads a record, whatever is behind it, and the count of its save.
pub(super) fn read<P: Parameters>(bytes: &[u8]) -> Result<(P, u32), Refused> {
    let damaged = Refused { reason: RecordError::Damaged, state: RecordState::Nothing, count: None };
    let (head, after) = bytes.split_first_chunk::<HEAD>().ok_or(damaged)?;
    let &[m0, m1, m2, m3, i0, i1, i2, i3, v0, v1, c0, c1, c2, c3, l0, l1, l2, l3] = head;
    let length = u32::from_le_bytes([l0, l1, l2, l3]) as usize;
    if [m0, m1, m2, m3] != MAGIC {
        return Err(damaged);
    }
    let longer = Refused { state: RecordState::Unknown, ..damaged };
    let (content, check) = after.split_at_checked(length).ok_or(longer)?;
    let check = check.first_chunk::<CHECK>().ok_or(longer)?;
    if bytes.get(..HEAD + length).map(crc) != Some(u32::from_le_bytes(*check)) {
        return Err(damaged);
    }
    let identity = u32::from_le_bytes([i0, i1, i2, i3]);
    let version = u16::from_le_bytes([v0, v1]);
    let count = u32::from_le_bytes([c0, c1, c2, c3]);
    let refused = |reason, state| Err(Refused { reason, state, count: Some(count) });
    if identity != P::IDENTITY {
        return refused(RecordError::Foreign(identity), RecordState::Foreign);
    }
    if version != P::VERSION {
        return refused(RecordError::Version(version), RecordState::Other);
    }
    match postcard::take_from_bytes(content) {
        Ok((parameters, [])) => Ok((parameters, count)),
        _ => refused(RecordError::Content, RecordState::Other),
    }
}

/// CRC-32 of Ethernet and zip.
fn crc(bytes: &[u8]) -> u32 {
    // a compiler makes a table of 1024 bytes of single bits
    const NIBBLES: [u32; 16] = {
        let mut table = [0; 16];
        each!(k, 0..16, {
            let mut crc = k as u32;
            each!(_bit, 0..4, {
                crc = (crc >> 1) ^ (0xedb8_8320 * (crc & 1));
            });
            table[k] = crc;
        });
        table
    };
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..2).fold(crc ^ u32::from(byte), |crc, _| (crc >> 4) ^ NIBBLES[crc as usize & 15])
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_check_is_that_of_the_catalogue() {
        // CRC-32/ISO-HDLC: Greg Cook, Catalogue of parametrised CRC algorithms
        assert_eq!(super::crc(b"123456789"), 0xcbf4_3926);
    }
}
