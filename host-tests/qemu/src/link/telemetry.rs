//! An image that reports its ticks into the pipe `told`, as bytes to read.

use std::fs::File;
use std::io::{self, ErrorKind, Read};

use super::pipes::{has_bytes, incoming};
use super::qemu::Qemu;
use crate::children::Folder;
use crate::image::Image;

/// Telemetry of an image; ends with the image, and the image with it.
pub struct Telling {
    qemu: Qemu,
    pipe: File,
}

impl Telling {
    /// Starts the image.
    ///
    /// # Errors
    /// A pipe that cannot be made, a QEMU that does not start.
    pub fn start(image: &Image) -> io::Result<Self> {
        let directory = Folder::make()?;
        let path = directory.path().join("told");
        let pipe = incoming(&path)?;
        Ok(Telling { qemu: Qemu::start(image, directory)?, pipe })
    }
}

impl Read for Telling {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            let running = self.qemu.is_running();
            has_bytes(&self.pipe)?;
            match self.pipe.read(bytes) {
                Ok(0) if running => std::thread::sleep(std::time::Duration::from_millis(5)),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                other => return other,
            }
        }
    }
}
