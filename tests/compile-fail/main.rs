//! A wrong machine does not compile, and the compiler says the sentence that the run-time error says.
//!
//! A test of the root package: the compiler that it starts needs the library alone, not what the host's programs depend on.

/// What each file beside this one must be told; the sentence of the error, and the file's name.
const SENTENCES: [(&str, &str); 5] = [
    ("negative_inertia", driveline::machine::Error::RotorInertia.message()),
    ("efficiency_out_of_range", driveline::machine::Error::GearEfficiency.message()),
    ("unobservable_pair", driveline::design::Error::Unobservable.message()),
    ("rate_below_the_shaft", driveline::design::Error::SampleRate.message()),
    ("encoder_without_lines", driveline::design::Error::EncoderLines.message()),
];

/// What is refused where the type is used, and not in a constant: such a case has to be built, and one that compiles makes the compiler build.
#[cfg(feature = "balancing")]
const BUILT: [(&str, &str); 1] =
    [("more_planes_than_readings", driveline::balance::Refusal::MORE_PLANES_THAN_READINGS)];
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
