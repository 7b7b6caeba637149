//! The long runs, on demand. A line of a step that has `measured: ` in it is kept with its result.
//!
//! What takes long is a test like the others, ignored for its length and named here.

use super::steps::together;
use super::{Count, Failed, Step, Voice, cargo, pages};

/// The package of the tests of scenes and commands.
const LAB: &str = "driveline-lab";

/// All long steps, the shortest first.
pub const LONG: [Step; 6] = [
    Step {
        name: "power-cuts",
        content: "the flash's power cut at every byte of a save: the record is the old one or the new one",
        repeat: "cargo lab check --long --only power-cuts",
        run: power_cuts,
    },
    Step {
        name: "pages",
        content: "the pages of commands that run firmware, on two screens and in print",
        repeat: "cargo lab check --long --only pages",
        run: pages::of_firmware,
    },
    Step {
        name: "ticks",
        content: "a thousand million ticks without drift, ten million with random reversals",
        repeat: "cargo lab check --long --only ticks",
        run: ticks,
    },
    Step {
        name: "starts",
        content: "100,000 in-run balancings: none ends worse than it began",
        repeat: "cargo lab check --long --only starts",
        run: starts,
    },
    Step {
        name: "attacks",
        content: "6,000 malformed files and streams, a disk that is full at every write, signals",
        repeat: "cargo lab check --long --only attacks",
        run: attacks,
    },
    Step {
        name: "seeds",
        content: "three machines commissioned over 40 seeds of the torque's noise, each within its aims",
        repeat: "cargo lab check --long --only seeds",
        run: seeds,
    },
];

fn power_cuts(voice: &Voice) -> Result<Count, Failed> {
    cargo::ignored_tests("driveline", "library", &["a_power_cut_at_every_byte_of_every_history"], voice)
}

fn ticks(voice: &Voice) -> Result<Count, Failed> {
    let library = ["nothing_drifts_in_a_thousand_million_ticks", "an_even_engine_has_no_weak_cylinder"];
    let closed_loop = ["it_stays_right_over_ten_million_ticks", "the_same_in_fixed_point"];
    let tests = |package, program, names| cargo::ignored_tests(package, program, names, voice);
    together([tests("driveline", "library", &library), tests(LAB, "closed_loop", &closed_loop)])
}

fn starts(voice: &Voice) -> Result<Count, Failed> {
    cargo::ignored_tests("driveline", "library", &["a_hundred_thousand_starts_end_no_worse"], voice)
}

fn attacks(voice: &Voice) -> Result<Count, Failed> {
    let attacks = [
        "six_thousand_malformed_files_and_streams",
        "a_full_disk_at_every_write_loses_nothing",
        "signals_at_fifty_moments",
    ];
    cargo::ignored_tests(LAB, "attack", &attacks, voice)
}

fn seeds(voice: &Voice) -> Result<Count, Failed> {
    cargo::ignored_tests(LAB, "closed_loop", &["every_machine_over_forty_seeds"], voice)
}
