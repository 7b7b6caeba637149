//! Counts of a bench beside the bounds of its image: what a board printed, line by line.

use driveline_qemu::measure::{Core, Cycles, Flash, MachineCode};
use driveline_report::Table;
use serde::{Deserialize, Serialize};

/// A function that the bench has called many times.
#[derive(Clone, Debug, Deserialize)]
struct Line {
    bench: String,
    function: u32,
    min: u64,
    max: u64,
    unit: Unit,
}

/// Object of the counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Unit {
    Instructions,
    Cycles,
}

/// A function's counts, and its bounds where it has some.
#[derive(Clone, Debug, Serialize)]
pub struct Counted {
    bench: String,
    unit: Unit,
    counted: [u64; 2],
    bounds: Option<[u64; 2]>,
    /// Whether the counts are within the bounds: of a kernel, whose path is known, within both, else below the most.
    pub within: Option<bool>,
}

/// Lays a board's lines beside the bounds of the image that printed them. Lines that name no `bench` are passed over: a
/// terminal's log has others.
///
/// # Errors
/// A line that is cut off, with its number; no line of a bench; lines of another image.
pub fn compare(text: &str, code: &MachineCode, core: Core, flash: Flash) -> Result<Vec<Counted>, String> {
    let mut all = Vec::new();
    for (number, line) in (1..).zip(text.lines().map(str::trim)) {
        // a terminal may put the time before it
        let object = line.find('{').map(|at| &line[at..]).filter(|object| object.contains("\"bench\""));
        let Some(line) = object else { continue };
        let wrong = |error| format!("line {number}: {error}; expected a line of the bench, as the board prints it");
        let line: Line = serde_json::from_str(line).map_err(|error| wrong(error.to_string()))?;
        if line.min > line.max {
            return Err(wrong(format!("`min` {} is above `max` {}", line.min, line.max)));
        }
        if !code.begins_function(line.function) {
            return Err(wrong(format!(
                "the image has no function at {:#x}, where it ran `{}`",
                line.function, line.bench
            )));
        }
        all.push(beside(line, code, core, flash));
    }
    if all.is_empty() { Err("no line of a bench".into()) } else { Ok(all) }
}

fn beside(line: Line, code: &MachineCode, core: Core, flash: Flash) -> Counted {
    let Line { bench, function, min, max, unit } = line;
    let is_kernel = bench.starts_with("kernel/");
    let bounds = match unit {
        // a kernel has one path
        Unit::Instructions => code.bound(function).ok().map(|bound| {
            let most = bound.instructions;
            [if is_kernel { most } else { 0 }, most]
        }),
        Unit::Cycles => code.counted_cycles(function, core, flash).map(|Cycles { least, most }| [least, most]),
    };
    let within = bounds.map(|[least, most]| max <= most && (!is_kernel || min >= least));
    Counted { bench, unit, counted: [min, max], bounds, within }
}

/// The counts and bounds of each function.
pub fn table(all: &[Counted]) -> Table {
    let mut table = Table::new(["function", "unit", "counted", "bounds", "within"]);
    for Counted { bench, unit, counted: [min, max], bounds, within } in all {
        let unit = if *unit == Unit::Cycles { "cycles" } else { "instructions" };
        table.row([
            bench.clone(),
            unit.into(),
            format!("{min} to {max}"),
            bounds.map_or("none".into(), |[least, most]| format!("{least} to {most}")),
            within.map_or("", |within| if within { "yes" } else { "NO" }).into(),
        ]);
    }
    table
}
