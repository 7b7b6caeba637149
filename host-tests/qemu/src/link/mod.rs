//! The link to a control loop in QEMU: an input in, an output out, in lock-step.
//!
//! The image reads and writes two named pipes through semihosting; the calling thread and QEMU share one core, so that
//! handing over is a switch of context and not a wake-up of another core. Under
//! `-icount shift=10,align=off,sleep=off` the run is deterministic to the instruction. Nothing here waits indefinitely:
//! a QEMU that hangs or dies is an error that says which image, at which tick, and what QEMU printed; dropping a
//! [`Link`] ends its QEMU.

mod affinity;
mod emulator;
mod pipes;
mod qemu;
mod telemetry;
mod words;

use std::io;
use std::time::Duration;

use driveline_firmware::scene::{Input, Output};
use serde::Deserialize;
use serde_json::Value;

use crate::children::Folder;
use crate::image::{Image, Program};
use affinity::Pinned;
use pipes::Pipes;
use qemu::Qemu;

pub use emulator::{Emulator, PROGRAM as QEMU, RISC_V as QEMU_RISC_V};
pub use telemetry::Telling;

/// Longest wait for one output: a tick takes microseconds, a stalled machine some seconds.
const TICK_LIMIT: Duration = Duration::from_secs(20);
/// Inputs that are written together: a page, which the buffer of every pipe has.
const TOGETHER: usize = 4096 / words::LENGTH;
/// Longest wait for the end after the last tick.
const END_LIMIT: Duration = Duration::from_secs(20);

/// A control loop that runs in QEMU.
pub struct Link {
    qemu: Qemu,
    pipes: Pipes,
    ticks: u64,
    _pinned: Pinned,
}

/// Report of a control loop at its end.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Summary {
    /// The scene's name.
    pub control_loop: String,
    /// The board's name.
    pub board: String,
    /// Ticks made.
    pub ticks: u32,
    /// Most stack that a tick used, bytes.
    pub stack: u32,
    /// The drive's state and constants in RAM, bytes.
    pub state: u32,
    /// Instructions of the measuring frame that were subtracted from every tick's.
    pub overhead: u32,
    /// Address of the measured function, where the image says it.
    #[serde(default)]
    pub function: u32,
}

impl Link {
    /// Starts the image of a control loop. The calling thread stays on QEMU's core until the link is dropped.
    pub fn start(image: &Image) -> io::Result<Self> {
        let pinned = Pinned::to_free_core();
        let directory = Folder::make()?;
        let pipes = Pipes::make(directory.path())?;
        let qemu = Qemu::start(image, directory)?;
        Ok(Link { qemu, pipes, ticks: 0, _pinned: pinned })
    }

    /// One tick.
    pub fn exchange(&mut self, input: &Input) -> io::Result<Output> {
        let mut answer = [0; words::LENGTH];
        self.pass(&words::of_input(input), &mut answer)?;
        Ok(words::to_output(&answer))
    }

    /// Ticks whose inputs do not depend on each other's outputs: in open loop a switch of context serves many of them.
    pub fn exchange_all(&mut self, inputs: &[Input]) -> io::Result<Vec<Output>> {
        let mut outputs = Vec::with_capacity(inputs.len());
        for inputs in inputs.chunks(TOGETHER) {
            let message: Vec<u8> = inputs.iter().flat_map(words::of_input).collect();
            let mut answer = vec![0; message.len()];
            self.pass(&message, &mut answer)?;
            outputs.extend(answer.as_chunks().0.iter().map(words::to_output));
        }
        Ok(outputs)
    }

    /// Inputs in, as many outputs out.
    fn pass(&mut self, message: &[u8], answer: &mut [u8]) -> io::Result<()> {
        let Link { qemu, pipes, ticks, .. } = self;
        pipes
            .exchange(message, answer, TICK_LIMIT, || qemu.is_running())
            .map_err(|error| qemu.describe(&error, &format!("at tick {ticks}")))?;
        *ticks += (message.len() / words::LENGTH) as u64;
        Ok(())
    }

    /// Ends the run and gives what the loop says of it.
    pub fn finish(self) -> io::Result<Summary> {
        let Link { mut qemu, pipes, .. } = self;
        drop(pipes);
        let lines = qemu.finish(END_LIMIT)?;
        let last = lines.last().cloned().unwrap_or_default();
        serde_json::from_value(last)
            .map_err(|error| io::Error::other(format!("the control loop's summary is not as expected: {error}")))
    }
}

/// Output of an image without a link (the bench, the self-test, the log).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Left {
    /// The lines of JSON that it printed.
    pub lines: Vec<Value>,
    /// Its log: frames of `defmt`, to be decoded with the image itself.
    pub log: Vec<u8>,
}

/// Runs an image that needs no link to its end, `limit` at most.
pub fn run(image: &Image, limit: Duration) -> io::Result<Left> {
    let _pinned = Pinned::to_free_core();
    let directory = Folder::make()?;
    let mut qemu = Qemu::start(image, directory)?;
    let lines = qemu.finish(limit)?;
    let log = if image.program == Program::Log { qemu.left("log")? } else { Vec::new() };
    Ok(Left { lines, log })
}
