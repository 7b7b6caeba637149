//! `cargo lab atlas`: error against time and flash of every subject, and the stiff and extreme cases.

use std::path::PathBuf;

use clap::Args;
use driveline_firmware::board::{BOARDS, FURTHER};

use crate::atlas;
use crate::extremes::Cases;
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, say};
use driveline_qemu::clone::workspace;
use driveline_qemu::measure::Cost;
use driveline_qemu::setup::Need;

/// Collect errors, instructions and flash of every subject on one page, and run the stiff and extreme cases.
///
/// Errors are those of the pages of the book, costs those of `budgets.toml`; parts that no other part betters for the
/// same machine are marked. --count builds bench and images for one core and prints the instructions of functions and
/// ticks.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab atlas
  cargo lab atlas --markdown doc/makers/atlas.md --picture doc/atlas.svg
  cargo lab atlas --count m33")]
pub struct Atlas {
    /// Write the page in Markdown
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Write the picture, as SVG
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Write the page for a browser
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Count the bench's functions and the images' ticks on this core in QEMU instead: m4f, m3, m7, m33
    #[arg(long, value_name = "CORE")]
    count: Option<String>,
}

impl Atlas {
    /// Prints the tables, writes the pages.
    ///
    /// # Errors
    /// A page that cannot be written, a core without a board; with the tables printed, a case that is wrong.
    pub fn execute(&self) -> Result<(), Failure> {
        if let Some(core) = &self.count {
            return count(core);
        }
        let failed = |error: String| Failure::failed(error);
        let root = workspace().map_err(|error| failed(error.to_string()))?;
        let file = |what, path: &Option<PathBuf>| path.as_deref().map(|path| Destination::chosen(what, path));
        let (markdown, picture) = (file("page", &self.markdown), file("picture", &self.picture));
        let html = file("page", &self.html);
        check_writable(&[], [&markdown, &picture, &html].into_iter().flatten())?;
        let atlas = atlas::Atlas::read(root).map_err(failed)?;
        let extremes = Cases::all();
        for subject in &atlas.subjects {
            say(format_args!("{}: {}, a {}\n{}", subject.name, subject.error, subject.call, atlas.table(subject)));
        }
        say(&extremes);
        for (file, text) in
            [(markdown, atlas.markdown(&extremes)), (picture, atlas.picture()), (html, atlas.page(&extremes))]
        {
            file.map_or(Ok(()), |file| file.write_and_say(&text, false))?;
        }
        match extremes.wrong().count() {
            0 => Ok(()),
            wrong => {
                Err(Failure::failed(format!("{wrong} of {} cases are wrong without a word", extremes.cases.len())))
            }
        }
    }
}

/// Counts the bench on a core.
fn count(core: &str) -> Result<(), Failure> {
    let boards =
        || BOARDS.iter().chain(FURTHER).filter(|board| board.target.starts_with("thumbv7") || board.core == "m33");
    let board = boards().copied().find(|board| board.core == core).ok_or_else(|| {
        let cores: Vec<_> = boards().map(|board| board.core).collect();
        Failure::usage(format!("--count {core}: expected one of {}", cores.join(", ")))
    })?;
    ready(&Need::to_run([&board]))?;
    let failed = |error: Box<dyn std::error::Error>| Failure::failed(error.to_string());
    let mut counted = Cost::benches(board).map_err(failed)?;
    let atlas = atlas::Atlas::read(workspace().map_err(|error| failed(error.into()))?).map_err(Failure::failed)?;
    for name in atlas.images() {
        counted.push((name.to_owned(), Cost::measure(name, board, |_| {}).map_err(failed)?));
    }
    for (name, cost) in counted {
        say(format_args!(
            "\"{name}\" = {}",
            cost.bound.map_or(cost.instructions.median.into(), |bound| bound.instructions)
        ));
    }
    Ok(())
}
