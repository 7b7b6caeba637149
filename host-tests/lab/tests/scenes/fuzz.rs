//! The fuzz targets over their corpus and over mutations of it: the part of `cargo fuzz` that needs neither its
//! compiler nor its hours. The numbers of mutations are fixed, and so is the seed: what passes here passes everywhere.
//! `DRIVELINE_FUZZ=100` plays a hundred times as many, each time with the next seed.

#[path = "../../../fuzz/src/lib.rs"]
mod targets;

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{RngSeed, TestRunner};

/// Bytes that a mutation puts in: those that readers of numbers stumble over, text, and, but for a corpus of text, any.
fn put(is_text: bool) -> impl Strategy<Value = Vec<u8>> {
    let numbers =
        ["-1", "0", "-0.0", "nan", "inf", "1e308", "1e-320", "1e999", "9223372036854775807", "\n", ",", "=", "["];
    let binary = if is_text { 0 } else { 2 };
    prop_oneof![
        3 => prop::sample::select(numbers.to_vec()).prop_map(|text| text.as_bytes().to_vec()),
        1 => "[ -~\\n]{0,6}".prop_map(String::into_bytes),
        binary => prop::collection::vec(any::<u8>(), 0..9),
        binary => prop::sample::select(vec![0_u32, 1, 0x7fff_ffff, 0x8000_0000, u32::MAX, 0x7f80_0000, 0x7fc0_0000])
            .prop_map(|word| word.to_le_bytes().to_vec()),
    ]
}

/// One place where bytes are cut out, others put in, and a piece of another place copied to.
#[derive(Clone, Debug)]
struct Edit {
    at: Index,
    /// Bytes to cut out; none for a whole word or number.
    cut: Option<usize>,
    put: Vec<u8>,
    copied: Option<(Index, usize)>,
}

fn edit(is_text: bool) -> impl Strategy<Value = Edit> {
    let copied = prop::option::weighted(0.2, (any::<Index>(), 0..200_usize));
    (any::<Index>(), prop::option::of(0..24_usize), put(is_text), copied).prop_map(|(at, cut, put, copied)| Edit {
        at,
        cut,
        put,
        copied,
    })
}

impl Edit {
    fn apply(self, bytes: &mut Vec<u8>) {
        let range = |at: &Index, wanted: usize| {
            let from = at.index(bytes.len() + 1);
            from..(from + wanted).min(bytes.len())
        };
        let cut = self.cut.map_or_else(
            || {
                let at = self.at.index(bytes.len() + 1);
                let separates = |byte: &u8| b" \n,;=[]\"".contains(byte);
                let from = bytes[..at].iter().rposition(separates).map_or(0, |before| before + 1);
                from..bytes[at..].iter().position(separates).map_or(bytes.len(), |length| at + length)
            },
            |length| range(&self.at, length),
        );
        let copied = self.copied.map_or(Vec::new(), |(from, length)| bytes[range(&from, length)].to_vec());
        bytes.splice(cut, self.put.into_iter().chain(copied));
    }
}

/// Plays every file of the corpus of a target, and mutations of them.
fn plays(target: fn(&[u8]), name: &str, mutations: u32) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(name);
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let corpus: Vec<Vec<u8>> = files.iter().map(|file| fs::read(file).unwrap()).collect();
    corpus.iter().for_each(|bytes| target(bytes));
    let is_text = corpus.iter().all(|bytes| std::str::from_utf8(bytes).is_ok_and(|text| !text.contains('\0')));
    let mutated = (any::<Index>(), prop::collection::vec(edit(is_text), 1..4)).prop_map(|(seed, edits)| {
        let mut bytes = seed.get(&corpus).clone();
        edits.into_iter().for_each(|edit: Edit| edit.apply(&mut bytes));
        bytes
    });
    let rounds =
        std::env::var("DRIVELINE_FUZZ").map_or(1, |rounds| rounds.parse().expect("DRIVELINE_FUZZ is a number"));
    for seed in 0..rounds {
        let rng_seed = RngSeed::Fixed(seed);
        let config =
            ProptestConfig { cases: mutations, failure_persistence: None, rng_seed, ..ProptestConfig::default() };
        // proptest catches a panic, and shows the smallest bytes that still have it
        let played = TestRunner::new(config).run(&mutated, |bytes| {
            target(&bytes);
            Ok(())
        });
        played.unwrap();
    }
}

#[test]
fn machine_files() {
    plays(targets::machine_file, "machine_file", 500);
}

#[test]
fn balancing_files() {
    plays(targets::balancing_file, "balancing_file", 1000);
}

#[test]
fn recordings() {
    plays(targets::recording, "recording", 500);
}

#[test]
fn telemetry() {
    plays(targets::telemetry, "telemetry", 3000);
}

#[test]
fn procedures() {
    plays(targets::procedure, "procedure", 3000);
}

#[test]
fn ticks() {
    plays(targets::tick, "tick", 2000);
}

/// Every target of `cargo fuzz` is played above.
#[test]
fn every_target_is_played() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/fuzz_targets");
    for entry in fs::read_dir(folder).unwrap() {
        let target = entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
        assert!(include_str!("fuzz.rs").contains(&format!("plays(targets::{target}, \"{target}\"")), "{target}");
    }
}
