//! The host's end of telemetry: bytes in, records out, as `driveline::telemetry` documents the frames. Written from
//! that description, not from its code.

use std::collections::BTreeMap;

use crate::machine_file::printable;

/// Description of a channel.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Described {
    pub name: String,
    pub unit: String,
    /// Factor of an integer; `None` for `f32`.
    pub factor: Option<f32>,
}

impl Described {
    /// Its name and unit as the heading of a column: `torque [N m]`. A drive's descriptions may contain anything.
    pub fn heading(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        printable(&format!("{}{unit}", self.name), usize::MAX)
    }

    pub fn value(&self, word: u32) -> f64 {
        match self.factor {
            Some(factor) => f64::from(word as i32) * f64::from(factor),
            None => f64::from(f32::from_bits(word)),
        }
    }
}

/// Record of a tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// Number of the tick.
    pub tick: u32,
    /// Records dropped before it.
    pub dropped: u32,
    /// The values' words.
    pub words: Vec<u32>,
}

/// Finds records in bytes that may begin anywhere and be damaged anywhere.
#[derive(Debug, Default)]
pub struct Decoder {
    frame: Vec<u8>,
    begun: bool,
    channels: BTreeMap<u8, Described>,
    /// Frames that were damaged.
    pub damaged: u64,
    /// Frames that were sound and are not understood: a later firmware's.
    pub unknown: u64,
    /// Bytes that came.
    pub bytes: u64,
}

/// Kind of packet.
enum Packet {
    Record(Told),
    Channel(u8, Described),
    Unknown,
}

/// A frame that grows beyond this is none.
const LONGEST: usize = 256;

impl Decoder {
    /// Takes bytes, and gives each record that is complete.
    pub fn take(&mut self, bytes: &[u8], mut record: impl FnMut(&Decoder, Told)) {
        self.bytes += bytes.len() as u64;
        for &byte in bytes {
            if byte != 0 {
                if self.frame.len() < LONGEST {
                    self.frame.push(byte);
                }
                continue;
            }
            let frame = std::mem::take(&mut self.frame);
            match unstuffed(&frame).and_then(|packet| understood(&packet)) {
                Some(Packet::Record(told)) => record(self, told),
                Some(Packet::Channel(index, described)) => {
                    self.channels.insert(index, described);
                }
                Some(Packet::Unknown) => self.unknown += 1,
                // bytes before the first zero may be the end of a frame
                None if self.begun && !frame.is_empty() => self.damaged += 1,
                None => {}
            }
            self.begun = true;
        }
    }

    /// The channel of a value, by its index; one that has not described itself is `value 3`, an integer.
    pub fn channel(&self, index: usize) -> Described {
        self.described(index).cloned().unwrap_or_else(|| Described {
            name: format!("value {index}"),
            unit: String::new(),
            factor: Some(1.0),
        })
    }

    /// The channel of a value, if it has described itself.
    pub fn described(&self, index: usize) -> Option<&Described> {
        self.channels.get(&u8::try_from(index).ok()?)
    }

    /// A word of a record as a value: an integer where its channel has not described itself.
    pub fn value(&self, index: usize, word: u32) -> f64 {
        self.described(index).map_or_else(|| f64::from(word as i32), |channel| channel.value(word))
    }

    /// Whether no sound frame came, but for records.
    pub fn is_empty(&self) -> bool {
        self.channels.is_empty() && self.unknown == 0
    }

    /// Whether so many channels have described themselves.
    pub fn describes(&self, channels: usize) -> bool {
        self.channels.len() >= channels
    }
}

/// `None` for a damaged packet.
fn understood(packet: &[u8]) -> Option<Packet> {
    let (packet, check) = packet.split_last_chunk::<2>()?;
    if crc(packet) != u16::from_le_bytes(*check) {
        return None;
    }
    Some(match packet {
        [1, rest @ ..] if rest.len() >= 8 && rest.len().is_multiple_of(4) => {
            let words: Vec<_> = rest.chunks_exact(4).map(le).collect();
            let [tick, dropped, words @ ..] = &words[..] else { return None };
            Packet::Record(Told { tick: *tick, dropped: *dropped, words: words.to_vec() })
        }
        [2, index, _, kind @ 0..=1, a, b, c, d, length, text @ ..] if text.len() >= usize::from(*length) => {
            let (name, unit) = text.split_at_checked(usize::from(*length))?;
            let factor = (*kind == 1).then(|| f32::from_le_bytes([*a, *b, *c, *d]));
            let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
            Packet::Channel(*index, Described { name: text(name), unit: text(unit), factor })
        }
        _ => Packet::Unknown,
    })
}

fn le(four: &[u8]) -> u32 {
    four.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte))
}

/// A frame without its stuffing; `None` where it was not stuffed so.
fn unstuffed(frame: &[u8]) -> Option<Vec<u8>> {
    let mut packet = Vec::with_capacity(frame.len());
    let mut rest = frame;
    while let [code, after @ ..] = rest {
        let (run, more) = after.split_at_checked(usize::from(*code).checked_sub(1)?)?;
        packet.extend_from_slice(run);
        if !more.is_empty() && *code != 255 {
            packet.push(0);
        }
        rest = more;
    }
    Some(packet)
}

/// CRC-16/CCITT, from its division: the remainder of the bits.
pub fn crc(bytes: &[u8]) -> u16 {
    let mut remainder = 0xffff_u16;
    for bit in bytes.iter().flat_map(|byte| (0..8).rev().map(move |place| byte >> place & 1)) {
        let out = remainder >> 15 ^ u16::from(bit);
        remainder = (remainder << 1) ^ (out * 0x1021);
    }
    remainder
}

#[cfg(test)]
mod tests {
    use super::{crc, unstuffed};

    #[test]
    fn the_check_is_that_of_the_catalogue() {
        // CRC-16/IBM-3740, also called CCITT-FALSE: Greg Cook, Catalogue of parametrised CRC algorithms
        assert_eq!(crc(b"123456789"), 0x29b1);
    }

    #[test]
    fn stuffing_is_undone() {
        // examples of the Wikipedia article on consistent overhead byte stuffing
        assert_eq!(unstuffed(&[1, 1]), Some(vec![0]));
        assert_eq!(unstuffed(&[3, 0x11, 0x22, 2, 0x33]), Some(vec![0x11, 0x22, 0, 0x33]));
        assert_eq!(unstuffed(&[2, 0x11, 1, 1, 1]), Some(vec![0x11, 0, 0, 0]));
        assert_eq!(unstuffed(&[5, 0x11]), None);
    }
}
