//! `cargo driveline qemu`: the runner of a project that `new` has written.

use std::io::Read;
use std::path::PathBuf;
use std::process::Stdio;

use clap::Args;

use super::Failure;
use super::setup::install;
use driveline_qemu::children::Running;
use driveline_qemu::link::Emulator;
use driveline_qemu::setup::Need;

/// An instruction is 4 ns of virtual time: 25,000 in a tick of 100 us, enough for a simulated machine in it.
const INSTRUCTION_COUNT: &str = "shift=2,align=off,sleep=off";

/// Run an image in QEMU, its semihosting on this terminal: the runner of the projects that `new` writes.
///
/// Installs QEMU where it is missing. The exit code is 0 where the image ends QEMU with success.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  cargo driveline qemu mps2-an386 target/thumbv7em-none-eabihf/release/roll")]
pub struct Qemu {
    /// QEMU's machine: mps2-an385 (Cortex-M3) or mps2-an386 (Cortex-M4F)
    #[arg(value_parser = ["mps2-an385", "mps2-an386"])]
    machine: String,
    /// The image, an ELF file
    image: PathBuf,
}

impl Qemu {
    /// Runs the image to its end.
    ///
    /// # Errors
    /// No such image, no QEMU, an image that ends otherwise than with success.
    pub fn execute(&self) -> Result<(), Failure> {
        if !self.image.is_file() {
            return Err(Failure::usage(format!("there is no image {}", self.image.display())));
        }
        let mut magic = [0; 4];
        let read = std::fs::File::open(&self.image).and_then(|mut file| file.read_exact(&mut magic));
        if read.is_err() || magic != *b"\x7fELF" {
            let image = self.image.display();
            return Err(Failure::usage(format!(
                "{image} is no ELF file: expected the image that `cargo build` writes, such as \
                 target/thumbv7em-none-eabihf/release/NAME"
            )));
        }
        install(&[Need::Qemu])?;
        let mut command = Emulator::find().unwrap_or(Emulator::Installed).command();
        command
            .args(["-machine", &self.machine, "-display", "none", "-monitor", "none", "-serial", "none"])
            .args(["-icount", INSTRUCTION_COUNT, "-semihosting-config", "enable=on,target=native", "-kernel"])
            .arg(&self.image)
            .stdin(Stdio::null());
        let failed = |error: std::io::Error| Failure::failed(format!("QEMU: {error}"));
        let status = Running::start(&mut command).map_err(failed)?.wait().map_err(failed)?;
        if status.success() { Ok(()) } else { Err(Failure::failed(format!("the image ended QEMU with {status}"))) }
    }
}
