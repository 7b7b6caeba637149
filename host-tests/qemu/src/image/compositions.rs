//! Cost of each part of a drive: the same drive with parts left out, over the image without any.

use std::error::Error;

use super::{Contents, Program, Sizes, board, build};
use driveline_report::Composition;

/// The compositions, by the distinguishing part of their variants' names.
const PARTS: [&str; 8] = [
    "rigid-observer",
    "rigid-governed",
    "semi-implicit-observer",
    "semi-implicit-governed",
    "two-mass-observer",
    "two-mass-governed",
    "two-mass-geared-observer",
    "two-mass-geared-governed",
];

/// Builds every composition for the cores that the numbers are for, `f32` with an FPU and fixed point without;
/// `progress` receives each.
///
/// # Errors
/// An image that was not built or could not be read.
pub fn compositions(mut progress: impl FnMut(&str)) -> Result<Vec<Composition>, Box<dyn Error>> {
    let mut table = Vec::new();
    for (number, core) in [("f32", "m4f"), ("fixed", "m3")] {
        let board = board(core).ok_or_else(|| format!("no board has the core `{core}`"))?;
        let mut sizes = |variant: &str| -> Result<Sizes, Box<dyn Error>> {
            progress(&format!("{variant} for {core}"));
            let image = build(variant, board, Program::ControlLoop, |_| {})?;
            Ok(Contents::read(&image.path)?.sizes)
        };
        let empty = sizes("empty/f32/none/10000")?;
        for parts in PARTS {
            let Sizes { text, constants, data, zeroed } = sizes(&format!("composition/{number}/{parts}/10000"))?;
            table.push(Composition {
                name: parts.replace('-', " "),
                number: number.into(),
                core: core.into(),
                text_bytes: text.saturating_sub(empty.text),
                rodata_bytes: constants.saturating_sub(empty.constants),
                data_bytes: data.saturating_sub(empty.data),
                bss_bytes: zeroed.saturating_sub(empty.zeroed),
            });
        }
    }
    Ok(table)
}
