//! Flash and RAM of each board's image, section by section.

use std::error::Error;

use driveline_firmware::board::nucleo_g474re::FACTS as NUCLEO;
use driveline_firmware::board::{BOARDS, FURTHER, Facts};
use serde::Serialize;

use super::{Contents, ON_NUCLEO, Program, build};
use driveline_report::Table;

/// Bytes of an image.
#[derive(Clone, Debug, Serialize)]
pub struct Footprint {
    pub board: &'static str,
    /// Its core, or its controller.
    pub core: &'static str,
    /// Its content.
    pub variant: String,
    /// Sections, by address: name and bytes.
    pub sections: Vec<(String, u64)>,
    /// Bytes of flash.
    pub flash: u64,
    /// Bytes of RAM, the stack not.
    pub ram: u64,
    /// Bytes of code that a tick reaches, part of the flash.
    pub tick_code: u64,
}

/// Builds the hoist for each board of QEMU's, in `f32` where the core has a unit for it and in fixed point where not,
/// and the test rig for the M4F and for the board that has a motor; `progress` receives each.
///
/// # Errors
/// An image that was not built or could not be read.
pub fn footprints(mut progress: impl FnMut(&str)) -> Result<Vec<Footprint>, Box<dyn Error>> {
    let mut images = Vec::new();
    let by_core = |core: &str| BOARDS.iter().chain(FURTHER).find(|board| board.core == core).copied();
    for board in ["m0plus", "m3", "m4f", "m7", "m33"].into_iter().filter_map(by_core) {
        let number = if board.target.ends_with("hf") { "f32" } else { "fixed" };
        images.push((board, Program::ControlLoop, format!("hoist/{number}/reduced/10000")));
    }
    images.extend(by_core("m4f").map(|board| (board, Program::ControlLoop, ON_NUCLEO.into())));
    images.push((NUCLEO, Program::Nucleo, ON_NUCLEO.into()));
    let footprint = |(board, program, variant): (Facts, Program, String)| {
        progress(&format!("{variant} for {}", board.core));
        let Contents { sizes, sections, tick_code, .. } =
            Contents::read(&build(&variant, board, program, |_| {})?.path)?;
        let Facts { name, core, .. } = board;
        Ok(Footprint { board: name, core, variant, sections, flash: sizes.flash(), ram: sizes.ram(), tick_code })
    };
    images.into_iter().map(footprint).collect()
}

impl Footprint {
    /// The sections of all boards, as they stand in memory.
    const SECTIONS: [&'static str; 6] = [".vector_table", ".text", ".rodata", ".data", ".bss", ".uninit"];

    /// Bytes of a section; zero where there is none.
    pub fn section(&self, name: &str) -> u64 {
        self.sections.iter().filter(|(section, _)| section == name).map(|(_, bytes)| bytes).sum()
    }

    pub fn table(all: &[Footprint]) -> Table {
        let headings = ["board", "core", "variant"].iter().chain(&Self::SECTIONS).chain(&["flash", "RAM", "tick"]);
        let mut table = Table::new(headings.copied());
        for image in all {
            let names = [image.board, image.core, &image.variant].map(String::from);
            let sections = Self::SECTIONS.map(|section| image.section(section).to_string());
            let sums = [image.flash, image.ram, image.tick_code].map(|bytes| bytes.to_string());
            table.row(names.into_iter().chain(sections).chain(sums));
        }
        table
    }
}
