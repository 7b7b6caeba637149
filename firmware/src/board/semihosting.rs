//! Files of the host through semihosting: the two pipes of the control loop, lines to print, the end of the run.
//!
//! Arm IHI 0105, Semihosting for AArch32 and AArch64. Paths are relative to QEMU's working directory.

#[cfg(target_arch = "riscv32")]
use super::virt::{syscall, syscall1};
use core::ffi::CStr;
use cortex_m_semihosting::nr;
#[cfg(target_arch = "arm")]
use cortex_m_semihosting::{syscall, syscall1};

use super::interface::Link;
use crate::scene::{Input, Output};

/// Ends the run; `nr::REPORT_EXCEPTION` in older documents.
const SYS_EXIT: usize = nr::REPORT_EXCEPTION;
/// Mode of `SYS_OPEN`: read, binary.
const READ: usize = 1;
/// Mode of `SYS_OPEN`: write, binary.
const WRITE: usize = 5;
/// Reason of `SYS_EXIT`: the application has ended by itself (`ADP_Stopped_ApplicationExit`).
const APPLICATION_EXIT: usize = 0x2_0026;
/// Reason of `SYS_EXIT`: an error (`ADP_Stopped_RunTimeErrorUnknown`).
const RUN_TIME_ERROR: usize = 0x2_0023;

/// The pipes `input` and `output`.
pub struct Pipes {
    input: usize,
    output: usize,
}

impl Pipes {
    /// Opens both; `None` where the working directory has none.
    pub fn open() -> Option<Self> {
        Some(Pipes { input: open(c"input", READ)?, output: open(c"output", WRITE)? })
    }
}

// Inlined into the loop: a call would use stack below the loop's frame, where the tick's is measured.
impl Link for Pipes {
    #[inline(always)]
    fn receive(&self, input: &mut Input) -> bool {
        let arguments = [self.input, input as *mut Input as usize, size_of::<Input>()];
        // SAFETY: SYS_READ writes at most the given bytes to `input`, all bit patterns of which are valid.
        (unsafe { syscall(nr::READ, &arguments) }) == 0
    }

    #[inline(always)]
    fn send(&self, output: &Output) -> bool {
        let arguments = [self.output, output as *const Output as usize, size_of::<Output>()];
        // SAFETY: SYS_WRITE reads the given bytes, which `output` has.
        (unsafe { syscall(nr::WRITE, &arguments) }) == 0
    }
}

/// Prints bytes on the semihosting console.
pub fn print(line: &[u8]) {
    for &byte in line {
        // SAFETY: SYS_WRITEC reads one byte.
        unsafe { syscall(nr::WRITEC, &byte) };
    }
}

/// A file that is written.
pub struct Sink(usize);

impl Sink {
    /// Opens a file of the host, emptied; a pipe waits for its other end.
    pub fn open(path: &CStr) -> Option<Self> {
        open(path, WRITE).map(Sink)
    }

    /// Appends bytes; whether the host took them all.
    pub fn write(&self, bytes: &[u8]) -> bool {
        let arguments = [self.0, bytes.as_ptr() as usize, bytes.len()];
        // SAFETY: SYS_WRITE reads the given bytes, which the slice has.
        (unsafe { syscall(nr::WRITE, &arguments) }) == 0
    }
}

/// The host did not take what was written.
#[derive(Clone, Copy, Debug)]
pub struct Closed;

impl core::fmt::Display for Closed {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("the host has closed the file")
    }
}

impl core::error::Error for Closed {}

impl embedded_io::Error for Closed {
    fn kind(&self) -> embedded_io::ErrorKind {
        embedded_io::ErrorKind::BrokenPipe
    }
}

impl embedded_io::ErrorType for Sink {
    type Error = Closed;
}

impl embedded_io::Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Closed> {
        if Sink::write(self, bytes) { Ok(bytes.len()) } else { Err(Closed) }
    }

    fn flush(&mut self) -> Result<(), Closed> {
        Ok(())
    }
}

/// Ends QEMU with exit code 0 or 1.
pub fn exit(success: bool) -> ! {
    let reason = if success { APPLICATION_EXIT } else { RUN_TIME_ERROR };
    loop {
        // SAFETY: SYS_EXIT takes its reason by value on AArch32.
        unsafe { syscall1(SYS_EXIT, reason) };
    }
}

fn open(path: &CStr, mode: usize) -> Option<usize> {
    let arguments = [path.as_ptr() as usize, mode, path.count_bytes()];
    // SAFETY: SYS_OPEN reads a path that ends with a zero byte.
    let handle = unsafe { syscall(nr::OPEN, &arguments) };
    (handle != usize::MAX).then_some(handle)
}
