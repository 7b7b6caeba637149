//! Packets, their check and their framing.

use super::Record;

/// Longest packet without its check: below 254 bytes, so that a block of the stuffing never ends within.
const LONGEST: usize = 96;

/// Type of a channel's words.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Kind {
    /// An `f32`.
    Single,
    /// A signed integer, to be multiplied by this: base over 2^28 for fixed point, 1 for flags.
    Integer(f32),
}

/// A value of the records.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Channel<'a> {
    /// Its name; name and unit beyond 80 bytes are cut off.
    pub name: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Type of its words.
    pub kind: Kind,
}

impl Channel<'_> {
    /// Sends the descriptions of all channels; now and then, for a listener that comes later.
    ///
    /// # Errors
    /// The writer's error.
    pub fn send<W: embedded_io::Write>(channels: &[Channel<'_>], writer: &mut W) -> Result<(), W::Error> {
        for (index, channel) in channels.iter().enumerate() {
            let mut packet = Packet::new();
            let (kind, factor) = match channel.kind {
                Kind::Single => (0, 1.0),
                Kind::Integer(factor) => (1, factor),
            };
            packet.push(&[2, index as u8, channels.len() as u8, kind]);
            packet.push(&factor.to_le_bytes());
            let name = channel.name.as_bytes();
            let name = name.get(..60).unwrap_or(name);
            packet.push(&[name.len() as u8]);
            packet.push(name);
            let unit = channel.unit.as_bytes();
            packet.push(unit.get(..20).unwrap_or(unit));
            packet.framed(|bytes| writer.write_all(bytes))?;
        }
        Ok(())
    }
}

pub(super) fn record<E, const VALUES: usize>(
    record: &Record<VALUES>,
    write: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), E> {
    let mut packet = Packet::new();
    packet.push(&[1]);
    packet.push(&record.tick.to_le_bytes());
    packet.push(&record.dropped.to_le_bytes());
    for value in record.values {
        packet.push(&value.to_le_bytes());
    }
    packet.framed(write)
}

/// A packet under construction, cut off at the longest.
struct Packet {
    bytes: [u8; LONGEST + 2],
    length: usize,
}

impl Packet {
    const fn new() -> Self {
        Packet { bytes: [0; LONGEST + 2], length: 0 }
    }

    fn push(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(place) = self.bytes.get_mut(self.length) {
                *place = byte;
                self.length += 1;
            }
        }
    }

    /// Adds the check, and gives the stuffed packet and its zero to `write`, in one piece.
    fn framed<E>(mut self, mut write: impl FnMut(&[u8]) -> Result<(), E>) -> Result<(), E> {
        self.length = self.length.min(LONGEST);
        let check = self.bytes.get(..self.length).map_or(0, crc);
        self.push(&check.to_le_bytes());
        let packet = self.bytes.get(..self.length).unwrap_or(&[]);
        // one byte before each run up to a zero: the run's length and one more; and the zero at the end
        let mut frame = [0; LONGEST + 4];
        let mut length = 0;
        for run in packet.split(|&byte| byte == 0) {
            for byte in [run.len() as u8 + 1].iter().chain(run) {
                if let Some(place) = frame.get_mut(length) {
                    *place = *byte;
                    length += 1;
                }
            }
        }
        write(frame.get(..=length).unwrap_or(&frame))
    }
}

/// CRC-16 of polynomial 0x1021, begun with 0xffff.
fn crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |crc, &byte| {
        (0..8).fold(crc ^ (byte as u16) << 8, |crc, _| if crc & 0x8000 != 0 { crc << 1 ^ 0x1021 } else { crc << 1 })
    })
}
