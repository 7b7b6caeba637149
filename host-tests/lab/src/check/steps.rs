//! The steps, in order: what is cheap and finds most comes first.

use std::fs;
use std::process::{Command, Stdio};

use driveline_firmware::board::nucleo_g474re::FACTS as NUCLEO;
use driveline_firmware::board::{BOARDS, Facts, RISC_V};

use super::comparison::Comparison;
use super::each::{each, passed};
use super::{Count, Failed, Step, Voice, cargo, pages};
use driveline_qemu::clone::{target_directory, workspace};
use driveline_qemu::image::{ON_NUCLEO, Program, build};
use driveline_qemu::measure::budgets::Budgets;
use driveline_qemu::measure::{Cost, self_test};
use driveline_qemu::setup;

/// All steps; the firmware, which is built board beside board, before the tests that use its images one by one.
pub const STEPS: [Step; 12] = [
    Step {
        name: "setup",
        content: "tools that are missing are installed",
        repeat: "cargo lab check --only setup",
        run: setup_step,
    },
    Step { name: "format", content: "`cargo fmt --check`", repeat: "cargo fmt --check", run: format },
    Step {
        name: "clippy",
        content: "no warning, nor any from `cargo doc`",
        repeat: "cargo lab check --only clippy",
        run: clippy,
    },
    Step {
        name: "packages",
        content: "every crate can be published",
        repeat: "cargo lab check --only packages",
        run: packages,
    },
    Step {
        name: "deny",
        content: "licences, versions, sources and advisories of dependencies, where `cargo deny` is installed",
        repeat: "cargo lab check --only deny",
        run: deny,
    },
    Step { name: "book", content: "both books build", repeat: "cargo lab check --only book", run: book },
    Step {
        name: "firmware",
        content: "every image links for every board",
        repeat: "cargo lab check --only firmware",
        run: firmware,
    },
    Step {
        name: "examples",
        content: "the examples for RTIC and Embassy link",
        repeat: "cargo lab check --only examples",
        run: examples,
    },
    Step {
        name: "tests",
        content: "all tests",
        repeat: "cargo test --workspace --exclude driveline-defmt-log --no-fail-fast",
        run: tests,
    },
    Step {
        name: "pages",
        content: "every kind of page on two screens and in print, where Chromium is installed",
        repeat: "cargo lab check --only pages",
        run: pages::quick,
    },
    Step {
        name: "self-tests",
        content: "the same bits in QEMU as on the host, on RISC-V too where its QEMU and targets are installed",
        repeat: "cargo lab check --only self-tests",
        run: self_tests,
    },
    Step {
        name: "budgets",
        content: "cost of each variant within `budgets.toml`",
        repeat: "cargo lab check --only budgets",
        run: budgets,
    },
];

fn setup_step(voice: &Voice) -> Result<Count, Failed> {
    let installed = setup::ensure(&setup::Need::all(), |command| voice.say(command)).map_err(Failed::whole)?;
    for name in installed {
        voice.say(&format!("installed {name}"));
    }
    Ok(Count { passed: 1, ..Count::default() })
}

/// The folders where `cargo fmt` does not follow, since a macro writes the `mod` lines or the crate is in no workspace:
/// their files are named to it.
const NOT_FOLLOWED: [&str; 4] =
    ["firmware/src/scenes", "host-tests/lab/src/drivetrains", "examples/rtic/src", "examples/embassy/src"];

fn format(voice: &Voice) -> Result<Count, Failed> {
    let root = workspace().map_err(Failed::whole)?;
    let mut arguments = ["fmt", "--all", "--check", "--"].map(String::from).to_vec();
    for folder in NOT_FOLLOWED {
        let entries = fs::read_dir(root.join(folder)).map_err(Failed::whole)?;
        let files = entries.filter_map(|entry| Some(entry.ok()?.path().display().to_string()));
        arguments.extend(files.filter(|file| file.ends_with(".rs")));
    }
    cargo::passes(&arguments.iter().map(String::as_str).collect::<Vec<_>>(), voice)
}

/// The workspace with every feature of the library, its documentation, then the firmware as each core sees it.
fn clippy(voice: &Voice) -> Result<Count, Failed> {
    // the other crates ask for all other features
    let all = "--features=driveline/defmt";
    let mut count = cargo::passes(&["clippy", "--workspace", "--all-targets", all, "--", "-D", "warnings"], voice)?;
    let deny = "--config=build.rustdocflags=['-D','warnings']";
    count.passed += cargo::passes(&["doc", deny, "--workspace", "--no-deps", all], voice)?.passed;
    for board in BOARDS {
        let target = format!("--target={}", board.target);
        // the board with a motor is linted with the others of its core, of which the binaries for QEMU take theirs
        let of_core = if board.target == NUCLEO.target { ",nucleo-g474re" } else { "" };
        let features = format!("--features=target,defmt{of_core}");
        let this = format!("--config=env.DRIVELINE_BOARD='{}'", board.name);
        let package = ["clippy", &this, "--package=driveline-firmware", &features];
        let arguments = [&package[..], &[&target, "--", "-D", "warnings"]].concat();
        count.passed += cargo::passes(&arguments, voice)?.passed;
    }
    Ok(count)
}

/// Every crate can be published, in order; what they are packed from has been compiled by the step before.
fn packages(voice: &Voice) -> Result<Count, Failed> {
    cargo::passes(&["publish", "--workspace", "--dry-run", "--no-verify", "--allow-dirty"], voice)
}

/// `cargo deny`, whose installation would take longer than all it does: a test of the book has its rules but for the
/// advisories, which come over the network.
fn deny(voice: &Voice) -> Result<Count, Failed> {
    let runs = |words: &[&str]| {
        let mut command = Command::new(setup::cargo());
        let output = command.arg("deny").args(words).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        output.status().is_ok_and(|status| status.success())
    };
    if !runs(&["--version"]) {
        voice
            .say("skipped: cargo deny is not installed (`cargo install --locked cargo-deny`), so no advisory was read");
        return Ok(Count::default());
    }
    let check = ["deny", "--workspace", "--offline", "check"];
    let mut count = cargo::passes(&[&check[..], &["bans", "licenses", "sources"]].concat(), voice)?;
    if runs(&["--workspace", "fetch", "db"]) {
        count.passed += cargo::passes(&[&check[..], &["advisories"]].concat(), voice)?.passed;
    } else {
        voice.say("skipped: the advisories of RustSec cannot be reached");
    }
    Ok(count)
}

/// Both books build; a test checks their links.
fn book(voice: &Voice) -> Result<Count, Failed> {
    let place = target_directory().map_err(Failed::whole)?.join("book");
    together([("doc", place.clone()), ("doc/makers", place.join("makers"))].map(|(book, place)| {
        let place = place.display().to_string();
        cargo::program_passes(&setup::mdbook(), &["build", book, "--dest-dir", &place], voice)
    }))
}

/// All tests; what decodes logs is built by the test that calls it.
const TESTS: [&str; 4] = ["test", "--workspace", "--exclude=driveline-defmt-log", "--no-fail-fast"];

/// The tests of images wait for the compilers that they start, one after the other; all other tests run beside them.
fn tests(voice: &Voice) -> Result<Count, Failed> {
    let results = std::thread::scope(|scope| {
        let images = scope.spawn(|| cargo::tests(&[&TESTS[..], &["--test=images"]].concat(), voice));
        // their names begin with the program's
        let others = cargo::tests(&[&TESTS[..], &["--", "--skip=images::"]].concat(), voice);
        [others, images.join().unwrap_or_else(|_| Err(Failed::whole("the images' thread panicked")))]
    });
    together(results)
}

/// Several results as one.
pub(super) fn together(results: impl IntoIterator<Item = Result<Count, Failed>>) -> Result<Count, Failed> {
    let (mut sum, mut messages) = (Count::default(), Vec::new());
    for result in results {
        let (count, message) = match result {
            Ok(count) => (count, None),
            Err(Failed { count, message }) => (count, Some(message)),
        };
        sum.passed += count.passed;
        sum.failed += count.failed;
        sum.skipped += count.skipped;
        messages.extend(message);
    }
    if messages.is_empty() { Ok(sum) } else { Err(Failed { count: sum, message: messages.join("\n") }) }
}

/// Every image links: no panic can be reached in any.
///
/// The images keep only one of two processors busy: the tests are compiled on the other. What does not compile is the
/// next step's to report.
fn firmware(voice: &Voice) -> Result<Count, Failed> {
    std::thread::scope(|scope| {
        scope.spawn(|| cargo::passes(&[&TESTS[..], &["--no-run"]].concat(), voice));
        images(voice)
    })
}

/// The examples that are crates of their own, each with its own dependencies; their manifests deny warnings.
///
/// They are built where the images for this core are: what both need is compiled once.
fn examples(voice: &Voice) -> Result<Count, Failed> {
    let place = target_directory().map_err(Failed::whole)?.join("firmware/fpu");
    let place = format!("--target-dir={}", place.display());
    let target = format!("--target={}", NUCLEO.target);
    let build = |name: &str| {
        let manifest = format!("--manifest-path=examples/{name}/Cargo.toml");
        cargo::passes(&["build", "--locked", &manifest, "--profile=firmware", &target, &place], voice)
    };
    together(["rtic", "embassy"].map(build))
}

fn images(voice: &Voice) -> Result<Count, Failed> {
    let linked = each(|variant, board| {
        let image = |board: Facts, program| {
            build(variant, board, program, |_| {}).map_err(|error| error.to_string())?;
            voice.say(&format!("{variant} for {}: linked", board.name));
            Ok(())
        };
        if variant == ON_NUCLEO {
            image(NUCLEO, Program::Nucleo)?;
        }
        image(board, Program::ControlLoop)
    })?;
    let count = passed(&linked);
    // and the one for the board with a motor
    Ok(Count { passed: count.passed + 1, ..count })
}

/// The self-test of every observer in every number gives the same bits on the host and in QEMU, at one rate; the
/// budgets compare the others over the link.
fn self_tests(voice: &Voice) -> Result<Count, Failed> {
    let run = each(|variant, board| {
        if !(variant.starts_with("hoist/") && variant.ends_with("/10000")) {
            return Ok(());
        }
        let fingerprint = self_test(variant, board).map_err(|error| error.to_string())?;
        voice.say(&format!("{variant} on {}: {fingerprint}", board.name));
        Ok(())
    })?;
    let mut count = passed(&run);
    for &board in RISC_V {
        if !setup::has_risc_v() {
            count.skipped += 1;
            continue;
        }
        let number = if board.has_float_unit() { "f32" } else { "fixed" };
        for observer in ["exact", "reduced"] {
            let variant = format!("hoist/{number}/{observer}/10000");
            let fingerprint = self_test(&variant, board).map_err(Failed::whole)?;
            voice.say(&format!("{variant} on {} ({}): {fingerprint}", board.name, board.core));
            count.passed += 1;
        }
    }
    Ok(count)
}

/// Every figure is within its budget.
fn budgets(voice: &Voice) -> Result<Count, Failed> {
    let root = workspace().map_err(Failed::whole)?;
    let budgets = Budgets::read(&root.join("budgets.toml")).map_err(Failed::whole)?;
    let mut costs = each(|variant, board| {
        let cost = Cost::measure(variant, board, |_| {}).map_err(|error| error.to_string())?;
        Ok((variant.to_string(), board.core, cost))
    })?;
    for &board in BOARDS {
        let benches = Cost::benches(board).map_err(Failed::whole)?;
        costs.extend(benches.into_iter().map(|(name, cost)| (name, board.core, cost)));
    }
    let comparison = Comparison::of(&budgets, &costs);
    voice.say(comparison.to_string().trim_end());
    comparison.count().map_err(|(count, message)| Failed { count, message })
}
