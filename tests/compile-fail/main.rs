//! A wrong machine does not compile, and the compiler says the sentence that the run-time error says.
//!
//! A test of the root package: the compiler that it starts needs the library alone, not what the host's programs depend
//! on.

/// What each file beside this one must be told; the sentence of the error, and the file's name.
const SENTENCES: [(&str, &str); 12] = [
    ("negative_inertia", driveline::machine::Error::RotorInertia.message()),
    ("efficiency_out_of_range", driveline::machine::Error::GearEfficiency.message()),
    ("unobservable_pair", driveline::design::Error::Unobservable.message()),
    ("rate_below_the_shaft", driveline::design::Error::SampleRate.message()),
    ("encoder_without_lines", driveline::design::Error::EncoderLines.message()),
    ("first_drive_too_slow", driveline::design::Error::SampleRate.message()),
    ("too_few_ticks", "at rated speed a cycle has fewer than 96 ticks"),
    ("fragile_loop", driveline::design::Error::LoopGain.message()),
    ("speed_in_rpm", "RATING: at this `speed` (rad/s)"),
    ("limit_below_rated", "RATING: `torque_limit` must be finite and at least `torque`"),
    ("speed_without_unit", "wrapping the expression in `driveline::machine::Speed`"),
    ("number_named_twice", "name the number once and each part without it"),
];

/// What is refused where the type is used, and not in a constant: such a case has to be built, and one that compiles
/// makes the compiler build.
#[cfg(feature = "balancing")]
const BUILT: [(&str, &str); 1] =
    [("more_planes_than_readings", driveline::balancing::Error::MORE_PLANES_THAN_READINGS)];
#[cfg(not(feature = "balancing"))]
const BUILT: [(&str, &str); 0] = [];

#[test]
fn wrong_machines_do_not_compile() {
    let cases = trybuild::TestCases::new();
    for (file, _) in SENTENCES {
        cases.compile_fail(format!("tests/compile-fail/{file}.rs"));
    }
}

#[test]
#[cfg(feature = "balancing")]
fn more_planes_than_readings_do_not_compile() {
    let cases = trybuild::TestCases::new();
    cases.pass("tests/compile-fail/as_many_planes_as_readings.rs");
    for (file, _) in BUILT {
        cases.compile_fail(format!("tests/compile-fail/{file}.rs"));
    }
}

#[test]
fn the_compiler_says_the_sentence_of_the_error() {
    for (file, sentence) in SENTENCES.iter().chain(&BUILT) {
        let path = format!("{}/tests/compile-fail/{file}.stderr", env!("CARGO_MANIFEST_DIR"));
        assert!(std::fs::read_to_string(path).unwrap().contains(*sentence), "{file}");
    }
}

/// The README's listing keeps within 20 lines and 15 names of the prelude, and is the same for both numbers but for one
/// word: both are built and run.
#[test]
fn the_first_drive_differs_in_one_word_between_the_numbers() {
    let (_, after) = include_str!("../../README.md").split_once("```rust\n").unwrap();
    let (listing, _) = after.split_once("```").unwrap();
    assert!(listing.lines().count() <= 20, "{listing}");
    let words = |text: &'static str| text.split(|c: char| !c.is_alphanumeric() && c != '_');
    let code = || listing.lines().flat_map(|line| line.split("//").next());
    let named = |name: &str| code().flat_map(words).any(|word| word == name);
    // every name that the prelude gives; the module paths are in small letters
    let prelude: std::collections::HashSet<_> = words(include_str!("../../src/prelude.rs"))
        .filter(|word| word.starts_with(|c: char| c.is_uppercase()) && named(word))
        .collect();
    assert!(prelude.len() <= 15, "{prelude:?}");

    let cases = trybuild::TestCases::new();
    for number in ["f32", "Fixed"] {
        assert_eq!(listing.matches("<f32, ").count(), 1, "{listing}");
        let changed = listing.replace("<f32, ", &format!("<{number}, "));
        let body = changed.replace("use driveline::prelude::*;", "");
        let path = format!("{}/first_drive_{number}.rs", env!("CARGO_TARGET_TMPDIR"));
        std::fs::write(&path, format!("use driveline::prelude::*;\n\nfn main() {{\n{body}}}\n")).unwrap();
        cases.pass(path);
    }
}
