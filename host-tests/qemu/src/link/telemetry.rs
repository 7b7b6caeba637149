//! An image that reports its ticks into the pipe `told`, as bytes to read.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::os::unix::fs::OpenOptionsExt;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{CWD, FileType, Mode, OFlags, mknodat};
use rustix::io::Errno;

use super::qemu::Qemu;
use crate::children::Folder;
use crate::image::Image;

/// How often a wait looks whether QEMU still runs.
const LOOK: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };

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
        mknodat(CWD, &path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0)?;
        // does not wait for the other end
        let pipe = OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits() as i32).open(&path)?;
        Ok(Telling { qemu: Qemu::start(image, directory)?, pipe })
    }
}

impl Read for Telling {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            let running = self.qemu.is_running();
            match poll(&mut [PollFd::new(&self.pipe, PollFlags::IN)], Some(&LOOK)) {
                // a signal that ends the program is another thread's
                Ok(_) | Err(Errno::INTR) => {}
                Err(error) => return Err(error.into()),
            }
            match self.pipe.read(bytes) {
                Ok(0) if running => std::thread::sleep(std::time::Duration::from_millis(5)),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                other => return other,
            }
        }
    }
}
