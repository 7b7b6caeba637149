//! A flash of two pages that outlives its store.

use std::convert::Infallible;

use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};

/// Bytes of a page.
pub const PAGE: usize = 2048;

/// It is read by words of `READ` bytes and written by words of `WRITE`.
pub struct Flash<const READ: usize, const WRITE: usize>(pub [u8; 2 * PAGE]);

impl<const READ: usize, const WRITE: usize> Flash<READ, WRITE> {
    pub fn erased() -> Self {
        Flash([0xff; 2 * PAGE])
    }
}

impl<const READ: usize, const WRITE: usize> ErrorType for Flash<READ, WRITE> {
    type Error = Infallible;
}

impl<const READ: usize, const WRITE: usize> ReadNorFlash for Flash<READ, WRITE> {
    const READ_SIZE: usize = READ;
    fn read(&mut self, at: u32, bytes: &mut [u8]) -> Result<(), Infallible> {
        assert!(bytes.len().is_multiple_of(READ));
        bytes.copy_from_slice(&self.0[at as usize..][..bytes.len()]);
        Ok(())
    }
    fn capacity(&self) -> usize {
        self.0.len()
    }
}

impl<const READ: usize, const WRITE: usize> NorFlash for Flash<READ, WRITE> {
    const WRITE_SIZE: usize = WRITE;
    const ERASE_SIZE: usize = PAGE;
    fn erase(&mut self, from: u32, to: u32) -> Result<(), Infallible> {
        self.0[from as usize..to as usize].fill(0xff);
        Ok(())
    }
    fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Infallible> {
        self.0[at as usize..][..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }
}
