//! A QEMU process: started in a directory of its own, ended with its owner.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::process::{Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::emulator::{Emulator, PROGRAM, RISC_V};
use crate::children::{Folder, Running};
use crate::image::Image;

/// One instruction is 2^10 ns of virtual time, which the timer's arithmetic on the board relies on.
const INSTRUCTION_COUNT: &str = "shift=10,align=off,sleep=off";

/// A running QEMU.
pub struct Qemu {
    child: Running,
    directory: Folder,
    name: String,
}

impl Qemu {
    /// Starts an image with `directory` as working directory, where its console and QEMU's own words are kept.
    pub fn start(image: &Image, directory: Folder) -> io::Result<Self> {
        let said = File::create(directory.path().join("said"))?;
        let is_risc_v = image.board.is_risc_v();
        let (mut command, program) = match is_risc_v {
            true => (Command::new(RISC_V), RISC_V),
            false => (Emulator::find().unwrap_or(Emulator::Installed).command(), PROGRAM),
        };
        // without it the core starts in firmware
        let firmware: &[&str] = if is_risc_v { &["-bios", "none"] } else { &[] };
        command
            .args(firmware)
            .args(["-machine", image.board.name, "-display", "none", "-monitor", "none", "-serial", "none"])
            .args(["-icount", INSTRUCTION_COUNT])
            .args(["-chardev", "file,id=console,path=console"])
            .args(["-semihosting-config", "enable=on,target=native,chardev=console"])
            .arg("-kernel")
            .arg(&image.path)
            .current_dir(directory.path())
            .stdin(Stdio::null())
            .stdout(said.try_clone()?)
            .stderr(said);
        let child = Running::start(&mut command).map_err(|error| match error.kind() {
            ErrorKind::NotFound => io::Error::new(
                ErrorKind::NotFound,
                format!("{program} is not installed; `cargo driveline setup` installs QEMU for Arm or shows how"),
            ),
            _ => error,
        })?;
        let name = format!("{} of {} on {}", image.program.name(), image.variant, image.board.name);
        Ok(Qemu { child, directory, name })
    }

    /// Whether it has not ended.
    pub fn is_running(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Waits for the end and gives the lines that the image printed.
    pub fn finish(&mut self, limit: Duration) -> io::Result<Vec<Value>> {
        let status = self.wait(limit)?;
        if !status.success() {
            return Err(self.describe(&io::Error::other(format!("ended with {status}")), "at its end"));
        }
        if self.directory.is_full() {
            return Err(self.describe(&io::Error::other("its output may be cut off"), "at its end"));
        }
        let console = fs::read_to_string(self.directory.path().join("console"))?;
        console
            .lines()
            .map(|line| {
                serde_json::from_str(line).map_err(|error| {
                    io::Error::other(format!("{} printed `{line}`, expected JSON: {error}", self.name))
                })
            })
            .collect()
    }

    /// A file that the image has written.
    pub fn left(&self, name: &str) -> io::Result<Vec<u8>> {
        fs::read(self.directory.path().join(name)).map_err(|error| self.describe(&error, &format!("left no `{name}`")))
    }

    /// An error with the image's name, the place, and what QEMU and the image printed.
    pub fn describe(&self, error: &io::Error, place: &str) -> io::Error {
        let mut message = format!("{} {place}: {error}", self.name);
        for file in ["said", "console"] {
            let text = fs::read_to_string(self.directory.path().join(file)).unwrap_or_default();
            if !text.trim().is_empty() {
                message.push_str(&format!("; {file}: {}", text.trim()));
            }
        }
        if self.directory.is_full() {
            message.push_str(&format!("; {} is full", std::env::temp_dir().display()));
        }
        io::Error::new(error.kind(), message)
    }

    fn wait(&mut self, limit: Duration) -> io::Result<ExitStatus> {
        let started = Instant::now();
        let mut pause = Duration::from_millis(1);
        loop {
            if let Some(status) = self.child.try_wait()? {
                return Ok(status);
            }
            if started.elapsed() > limit {
                let error = io::Error::new(ErrorKind::TimedOut, format!("has not ended within {} s", limit.as_secs()));
                return Err(self.describe(&error, "at its end"));
            }
            thread::sleep(pause);
            pause = (pause * 2).min(Duration::from_millis(20));
        }
    }
}
