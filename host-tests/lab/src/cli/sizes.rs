//! `cargo lab sizes`: flash and RAM of each board's image, by section.

use clap::Args;
use driveline_firmware::board::{BOARDS, FURTHER};

use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_qemu::image::{Footprint, footprints};
use driveline_qemu::setup::Need;

/// Build an image for each board and show what it takes of flash and RAM, by section.
///
/// The hoist for QEMU's boards, start-up, link and measuring included, and the test rig for the board with a motor,
/// balancing, telemetry and registers included. Without the stack.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  cargo lab sizes\n  cargo lab sizes --json")]
pub struct Sizes {
    /// Print [{board, core, variant, sections, flash, ram, tick_code}]
    #[arg(long)]
    pub json: bool,
}

impl Sizes {
    /// Builds the images and shows them.
    pub fn execute(&self) -> Result<(), Failure> {
        ready(&Need::to_build(BOARDS.iter().chain(FURTHER)))?;
        let bar = Progress::of(7);
        let all = footprints(|image| {
            bar.says(image);
            bar.step();
        })
        .map_err(|error| Failure::failed(error.to_string()))?;
        drop(bar);
        if self.json {
            return say_json(&all);
        }
        say(Footprint::table(&all));
        Ok(())
    }
}
