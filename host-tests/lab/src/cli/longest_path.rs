//! `cargo lab longest-path`: upper bounds of a function, from its machine code.

mod counted;

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use driveline_firmware::board::{BOARDS, FURTHER};
use driveline_firmware::scenes::VARIANTS;
use driveline_qemu::image::{Image, Program, belongs, build};
use driveline_qemu::measure::{Bound, Core, Cycles, Flash, Loops, MachineCode, Piece, Refusal, worst_drawn};
use driveline_qemu::setup::Need;
use driveline_report::Table;
use serde_json::json;

use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, say, say_json};

/// Bound a function's instructions and stack from the machine code of a firmware.
///
/// Every branch is taken both ways, so no input can exceed the bounds. Calls are followed. A call through a pointer,
/// recursion, and a loop without stated turns are refused.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab longest-path target/thumbv7em-none-eabihf/release/drive --function control_interrupt
  cargo lab longest-path --qemu hoist/fixed/reduced/10000 --core m3 --ticks 100000
  cargo lab longest-path bench.elf --counted bench.log --wait-states 4")]
pub struct LongestPath {
    /// An ELF file for a Cortex-M, with its symbols
    #[arg(conflicts_with = "qemu", required_unless_present = "qemu")]
    file: Option<PathBuf>,
    /// The function, as in the source (`crate::module::function`) or as in the file
    #[arg(long, value_name = "NAME", default_value = "driveline_tick")]
    function: String,
    /// Most turns of each loop in a function, by address: NAME=TURNS,TURNS; may be repeated
    #[arg(long, value_name = "TURNS")]
    turns: Vec<String>,
    /// The control loop of this variant instead of a file
    #[arg(long, value_name = "VARIANT")]
    qemu: Option<String>,
    /// The core, for the variant and for the cycles: m4f, m3, m0plus, m0
    #[arg(long, default_value = "m4f")]
    core: String,
    /// Cycles that a reading of the flash waits, without a cache
    #[arg(long, value_name = "CYCLES", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=64))]
    wait_states: u64,
    /// Bytes that a reading of the flash gives: 4, 8, 16 or 32
    #[arg(long, value_name = "BYTES", default_value_t = 8, value_parser = line_of_flash)]
    flash_line: u32,
    /// Count the instructions of so many ticks of the variant in QEMU, too
    #[arg(long, value_name = "COUNT", requires = "qemu")]
    ticks: Option<usize>,
    /// Compare the lines that the image's bench printed, from this file, with its bounds
    #[arg(long, value_name = "FILE", conflicts_with_all = ["qemu", "function"])]
    counted: Option<PathBuf>,
    /// Print {function, instructions, stack, cycles: {least, most}, path: [...], counted}; of a bench's lines [{bench,
    /// unit, counted, bounds, within}, ...]
    #[arg(long)]
    pub json: bool,
}

impl LongestPath {
    /// Bounds the function and lists its longest path.
    ///
    /// # Errors
    /// A file that cannot be read, no such function or variant, a function without a bound.
    pub fn execute(&self) -> Result<(), Failure> {
        let core = match self.core.as_str() {
            "m0" => Core::M0,
            "m0plus" => Core::M0Plus,
            "m3" => Core::M3,
            "m4f" => Core::M4,
            other => {
                let known = "the cores whose manuals print cycles are m4f, m3, m0plus, m0";
                return Err(Failure::usage(format!("--core {other}: {known}")));
            }
        };
        let flash = Flash { wait_states: self.wait_states, line: self.flash_line };
        let loops = self.loops()?;
        let image = self.qemu.as_deref().map(|variant| self.image(variant)).transpose()?;
        let path = image.as_ref().map(|image| &image.path).or(self.file.as_ref());
        let path = path.ok_or_else(|| Failure::usage("name a file or `--qemu VARIANT`"))?;
        let code = MachineCode::read(path, loops).map_err(|error| Failure::usage(error.to_string()))?;
        if let Some(log) = &self.counted {
            return self.compare(log, &code, core, flash);
        }
        let name = &self.function;
        let start = code.find(name).ok_or_else(|| {
            Failure::usage(format!("{} has no function `{name}`; it may have been inlined", path.display()))
        })?;
        let refused = |error: Refusal| Failure::failed(error.to_string());
        let bound = code.bound(start).map_err(refused)?;
        let pieces = code.path(start).map_err(refused)?;
        let Cycles { least, most } = code.cycles(start, core, flash).map_err(refused)?;
        let counted = match (image, self.ticks) {
            (Some(image), Some(ticks)) => {
                Some(worst_drawn(&image, ticks).map_err(|error| Failure::failed(error.to_string()))?)
            }
            _ => None,
        };
        let Bound { instructions, stack } = bound;
        if self.json {
            let path: Vec<_> = pieces.iter().map(as_json).collect();
            return say_json(&json!({
                "function": name, "instructions": instructions, "stack": stack,
                "cycles": { "least": least, "most": most }, "path": path, "counted": counted,
            }));
        }
        say(table(&pieces));
        let counted = counted.map_or(String::new(), |counted| format!("; most counted: {counted}"));
        say(format!("{name}: at most {instructions} instructions and {stack} bytes of stack{counted}"));
        let flash = match self.wait_states {
            0 => "without wait states".into(),
            states => format!("at most {states} wait states for each {} bytes of flash", self.flash_line),
        };
        say(format!("{least} to {most} cycles on {}, {flash}", self.core));
        Ok(())
    }

    /// Lays a board's counts beside the bounds.
    fn compare(&self, log: &Path, code: &MachineCode, core: Core, flash: Flash) -> Result<(), Failure> {
        let place = |error: String| Failure::usage(format!("{}: {error}", log.display()));
        // a serial port gives bytes of any kind at a reset
        let bytes = fs::read(log).map_err(|error| place(error.to_string()))?;
        let text = String::from_utf8_lossy(&bytes);
        let all = counted::compare(&text, code, core, flash).map_err(place)?;
        if self.json {
            say_json(&all)?;
        } else {
            say(counted::table(&all));
        }
        match all.iter().filter(|one| one.within == Some(false)).count() {
            0 => Ok(()),
            outside => Err(Failure::failed(format!("{outside} of {} functions are outside their bounds", all.len()))),
        }
    }

    fn loops(&self) -> Result<Loops, Failure> {
        let mut loops = Loops::default();
        for text in &self.turns {
            let wrong = || Failure::usage(format!("--turns {text}: expected NAME=TURNS,TURNS, such as `memcpy=4,16`"));
            let (function, turns) = text.split_once('=').ok_or_else(wrong)?;
            let turns: Result<Vec<u64>, _> = turns.split(',').map(str::parse).collect();
            loops.state(function, turns.map_err(|_| wrong())?);
        }
        Ok(loops)
    }

    fn image(&self, variant: &str) -> Result<Image, Failure> {
        if !VARIANTS.contains(&variant) {
            let names = VARIANTS.join(", ");
            return Err(Failure::usage(format!("no variant is called `{variant}`; there are {names}")));
        }
        let boards = || BOARDS.iter().chain(FURTHER).filter(|board| belongs(variant, board));
        let board = boards().copied().find(|board| board.core == self.core).ok_or_else(|| {
            let cores: Vec<_> = boards().map(|board| board.core).collect();
            Failure::usage(format!("{variant} does not run on `{}`, but on {}", self.core, cores.join(", ")))
        })?;
        ready(&Need::to_run([&board]))?;
        let image = build(variant, board, Program::ControlLoop, |line| eprintln!("{line}"));
        image.map_err(|error| Failure::failed(error.to_string()))
    }
}

fn line_of_flash(text: &str) -> Result<u32, String> {
    let bytes = text.parse().ok().filter(|bytes| [4, 8, 16, 32].contains(bytes));
    bytes.ok_or_else(|| "expected 4, 8, 16 or 32 bytes".into())
}

fn as_json(piece: &Piece) -> serde_json::Value {
    let Piece { function, depth, from, to, instructions, times } = piece;
    json!({
        "function": function, "depth": depth, "from": from, "to": to, "instructions": instructions, "times": times,
    })
}

/// The path: a callee further to the right than its caller.
fn table(pieces: &[Piece]) -> Table {
    let mut table = Table::new(["function", "from", "to", "instructions", "times"]);
    for Piece { function, depth, from, to, instructions, times } in pieces {
        let name = format!("{}{function}", "  ".repeat(*depth));
        table.row([name, format!("{from:#x}"), format!("{to:#x}"), instructions.to_string(), times.to_string()]);
    }
    table
}
