//! The two named pipes, `input` and `output`, in QEMU's working directory.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{CWD, FileType, Mode, OFlags, mknodat};
use rustix::io::Errno;

/// How often a wait looks whether QEMU still runs.
const LOOK: Timespec = Timespec { tv_sec: 0, tv_nsec: 100_000_000 };

fn make(path: &Path) -> io::Result<()> {
    Ok(mknodat(CWD, path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0)?)
}

/// Makes a pipe that QEMU writes, and opens it; neither waits for QEMU.
pub(super) fn incoming(path: &Path) -> io::Result<File> {
    make(path)?;
    OpenOptions::new().read(true).custom_flags(OFlags::NONBLOCK.bits() as i32).open(path)
}

/// Whether the pipe has bytes, or has them before the next look at QEMU is due.
pub(super) fn has_bytes(pipe: &File) -> io::Result<bool> {
    match poll(&mut [PollFd::new(pipe, PollFlags::IN)], Some(&LOOK)) {
        Ok(ready) => Ok(ready > 0),
        // a signal that ends the program is another thread's: no failure of the link
        Err(Errno::INTR) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

/// The host's ends.
pub struct Pipes {
    input: File,
    output: File,
}

impl Pipes {
    /// Makes the pipes and opens them; neither waits for QEMU.
    pub fn make(directory: &Path) -> io::Result<Self> {
        let input = directory.join("input");
        make(&input)?;
        // opened for both, a pipe does not wait for its other end
        let input = OpenOptions::new().read(true).write(true).open(input)?;
        Ok(Pipes { input, output: incoming(&directory.join("output"))? })
    }

    /// Writes a message and waits until the answer is full, as long as `is_running` and at most `limit`.
    pub fn exchange(
        &mut self,
        message: &[u8],
        answer: &mut [u8],
        limit: Duration,
        mut is_running: impl FnMut() -> bool,
    ) -> io::Result<()> {
        // no longer than a pipe's buffer, which is empty: does not block
        self.input.write_all(message)?;
        let mut length = 0;
        let mut started = None;
        while length < answer.len() {
            if has_bytes(&self.output)? {
                match self.output.read(&mut answer[length..]) {
                    Ok(0) => {
                        return Err(io::Error::new(ErrorKind::UnexpectedEof, "the image closed the link"));
                    }
                    Ok(more) => length += more,
                    Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                    Err(error) => return Err(error),
                }
            } else if !is_running() {
                return Err(io::Error::new(ErrorKind::BrokenPipe, "QEMU has ended"));
            } else if started.get_or_insert_with(Instant::now).elapsed() > limit {
                let message = format!("no answer within {} s", limit.as_secs());
                return Err(io::Error::new(ErrorKind::TimedOut, message));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
    use std::thread;
    use std::time::{Duration, Instant};

    use super::Pipes;

    #[test]
    fn nobody_at_the_other_end_is_an_error_and_not_a_wait() {
        let directory = tempfile::tempdir().unwrap();
        let mut pipes = Pipes::make(directory.path()).unwrap();
        let started = Instant::now();
        let hangs = pipes.exchange(&[0; 32], &mut [0; 32], Duration::from_millis(250), || true).unwrap_err();
        assert_eq!(hangs.kind(), ErrorKind::TimedOut);
        let died = pipes.exchange(&[0; 32], &mut [0; 32], Duration::from_secs(3600), || false).unwrap_err();
        assert_eq!(died.kind(), ErrorKind::BrokenPipe);
        // three or four looks of 0.1 s each and one more; a loaded machine takes longer, an hour is the other limit
        assert!(started.elapsed() < Duration::from_secs(60));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_signal_while_it_waits_is_no_failure_of_the_link() {
        use rustix::process::{Signal, kill_process};
        let caught = Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(signal_hook::consts::SIGUSR1, Arc::clone(&caught)).unwrap();
        let directory = tempfile::tempdir().unwrap();
        let mut pipes = Pipes::make(directory.path()).unwrap();
        // Linux gives a signal to the thread whose number is asked for, if it does not block it
        let waiting = rustix::thread::gettid();
        let sender = thread::spawn(move || {
            thread::sleep(Duration::from_millis(50));
            kill_process(waiting, Signal::USR1).unwrap();
        });
        let hangs = pipes.exchange(&[0; 32], &mut [0; 32], Duration::from_millis(250), || true).unwrap_err();
        sender.join().unwrap();
        assert!(caught.load(Relaxed));
        assert_eq!(hangs.kind(), ErrorKind::TimedOut);
    }
}
