//! Flash for a panel's record, as memory: the boards here model none.
//!
//! Two pages of 1 KiB, erased as a whole and written by words, in which bits only go from one to zero. A real board has
//! its flash's driver here. The host keeps its content over a power cut and puts it into the next start.

use core::convert::Infallible;

use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};

/// Words of both pages.
pub const WORDS: usize = 512;

/// Two pages.
pub struct Pages([u32; WORDS]);

impl Pages {
    /// Erased.
    pub const fn new() -> Self {
        Pages([u32::MAX; WORDS])
    }

    /// A word; all ones beyond the end.
    pub fn word(&self, place: u32) -> u32 {
        self.0.get(place as usize).copied().unwrap_or(u32::MAX)
    }

    /// Puts a word there, as a programmer does; false beyond the end.
    pub fn put(&mut self, place: u32, word: u32) -> bool {
        match self.0.get_mut(place as usize) {
            Some(place) => *place = word,
            None => return false,
        }
        true
    }
}

impl Default for Pages {
    fn default() -> Self {
        Pages::new()
    }
}

impl ErrorType for Pages {
    type Error = Infallible;
}

impl ReadNorFlash for Pages {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Infallible> {
        for (at, byte) in (offset..).zip(bytes) {
            *byte = (self.word(at >> 2) >> (8 * (at & 3))) as u8;
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        4 * WORDS
    }
}

impl NorFlash for Pages {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = 1024;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Infallible> {
        for (place, word) in (0..).zip(&mut self.0) {
            if (from >> 2..to >> 2).contains(&place) {
                *word = u32::MAX;
            }
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Infallible> {
        for (place, bytes) in (offset >> 2..).zip(bytes.as_chunks().0) {
            if let Some(word) = self.0.get_mut(place as usize) {
                *word &= u32::from_le_bytes(*bytes);
            }
        }
        Ok(())
    }
}
