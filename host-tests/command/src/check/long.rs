//! The long runs, on demand. A line of a step that has `measured: ` in it is kept with its result.
//!
//! What takes long is a test like the others, ignored for its length and named here.

use driveline_qemu::image::{Program, build};
use driveline_qemu::measure::{Loops, MachineCode, count};

use super::steps::{each, passed, together};
use super::{Count, Failed, Step, Voice, cargo, pages};

/// All long steps, the shortest first.
pub const LONG: [Step; 7] = [
    Step {
        name: "power-cuts",
        content: "the flash's power cut at every byte of a save: the record is the old one or the new one",
        repeat: "cargo driveline check --long --only power-cuts",
        run: power_cuts,
    },
    Step {
        name: "pages",
        content: "the pages of commands that run firmware, on two screens and in print",
        repeat: "cargo driveline check --long --only pages",
        run: pages::of_firmware,
    },
    Step {
        name: "ticks",
        content: "a thousand million ticks without drift, ten million with random reversals",
        repeat: "cargo driveline check --long --only ticks",
        run: ticks,
    },
    Step {
        name: "starts",
        content: "100,000 in-run balancings: none ends worse than it began",
        repeat: "cargo driveline check --long --only starts",
        run: starts,
    },
    Step {
        name: "attacks",
        content: "6,000 malformed files, streams and argument lists, a disk that is full at every write, signals",
        repeat: "cargo driveline check --long --only attacks",
        run: attacks,
    },
    Step {
        name: "seeds",
        content: "three machines commissioned over 40 seeds of the torque's noise, each within its aims",
        repeat: "cargo driveline check --long --only seeds",
        run: seeds,
    },
    Step {
        name: "inputs",
        content: "three million inputs of each variant in QEMU: none above the longest path",
        repeat: "cargo driveline check --long --only inputs",
        run: inputs,
    },
];

fn power_cuts(voice: &Voice) -> Result<Count, Failed> {
    cargo::ignored_tests("library", &["a_power_cut_at_every_byte_of_every_history"], voice)
}

fn ticks(voice: &Voice) -> Result<Count, Failed> {
    let library = ["nothing_drifts_in_a_thousand_million_ticks", "an_even_engine_has_no_weak_cylinder"];
    let closed_loop = ["it_stays_right_over_ten_million_ticks", "the_same_in_fixed_point"];
    let tests = |program, names| cargo::ignored_tests(program, names, voice);
    together([tests("library", &library), tests("closed_loop", &closed_loop)])
}

fn starts(voice: &Voice) -> Result<Count, Failed> {
    cargo::ignored_tests("library", &["a_hundred_thousand_starts_end_no_worse"], voice)
}

fn attacks(voice: &Voice) -> Result<Count, Failed> {
    let attacks = [
        "six_thousand_malformed_files_streams_and_arguments",
        "a_full_disk_at_every_write_loses_nothing",
        "signals_at_fifty_moments",
    ];
    cargo::ignored_tests("attack", &attacks, voice)
}

fn seeds(voice: &Voice) -> Result<Count, Failed> {
    cargo::ignored_tests("closed_loop", &["every_machine_over_forty_seeds"], voice)
}

/// Inputs of a variant.
const INPUTS: usize = 3_000_000;

/// A variant without a bound has nothing to exceed.
fn inputs(voice: &Voice) -> Result<Count, Failed> {
    let counted = each(|variant, board| {
        let image = build(variant, board, Program::ControlLoop, |_| {}).map_err(|error| error.to_string())?;
        let code = MachineCode::read(&image.path, Loops::default()).map_err(|error| error.to_string())?;
        let start = code.find("driveline_tick").ok_or("there is no function `driveline_tick`")?;
        let most = u64::from(count(&image, INPUTS).map_err(|error| error.to_string())?.max);
        let Ok(bound) = code.bound(start).map(|bound| bound.instructions) else {
            voice.say(&format!("{variant} on {}: {most}, without a bound", board.name));
            return Ok(None);
        };
        voice.say(&format!("{variant} on {}: {most} of {bound}", board.name));
        if most > bound {
            Err(format!("{most} instructions were counted, the bound is {bound}"))
        } else {
            Ok(Some(most as f64 / bound as f64))
        }
    })?;
    let mut shares: Vec<f64> = counted.iter().copied().flatten().collect();
    shares.sort_by(f64::total_cmp);
    if let (Some(least), Some(median)) = (shares.first(), shares.get(shares.len() / 2)) {
        let (bounded, all) = (shares.len(), counted.len());
        voice.say(&format!(
            "measured: {INPUTS} inputs of each of {all} images; of {bounded} with a bound the most counted is {:.1} % \
             of it at least, {:.1} % in the median",
            100.0 * least,
            100.0 * median
        ));
    }
    Ok(passed(&counted))
}
