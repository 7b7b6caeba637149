//! A wrong line of a listing does not compile, and the compiler names the line or the field, and the remedy.
//!
//! Each case is a listing with one line changed. The compiler reads it against the library that this test is linked
//! with; nothing is built.

mod cases;

use std::path::{Path, PathBuf};
use std::process::Command;

use cases::{CASES, Case, Shown};

/// The newest library beside this test: the one that it is linked with, or another of the same sources.
fn library() -> (PathBuf, PathBuf) {
    let test = std::env::current_exe().unwrap();
    let folder = test.parent().unwrap().to_path_buf();
    let named = |path: &Path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        name.starts_with("libdriveline-") && name.ends_with(".rlib")
    };
    let files = std::fs::read_dir(&folder).unwrap().map(|file| file.unwrap().path()).filter(|path| named(path));
    let newest = files.max_by_key(|path| path.metadata().unwrap().modified().unwrap()).unwrap();
    (folder, newest)
}

/// What the compiler says of a program; `None` where it compiles. With `code` it generates that as well.
fn compiled(name: &str, text: &str, code: bool) -> Option<String> {
    let (folder, library) = library();
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mistakes");
    std::fs::create_dir_all(&out).unwrap();
    let file = out.join(format!("{name}.rs"));
    std::fs::write(&file, text).unwrap();
    let done = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .args(["--edition=2024", "--crate-type=bin", "-Awarnings", "--emit"])
        .arg(if code { "obj" } else { "metadata" })
        .arg("--extern")
        .arg(format!("driveline={}", library.display()))
        .arg("-L")
        .arg(format!("dependency={}", folder.display()))
        .arg("--out-dir")
        .arg(&out)
        .arg(&file)
        .output()
        .unwrap();
    (!done.status.success()).then(|| String::from_utf8_lossy(&done.stderr).into_owned())
}

/// The listings as they stand compile, or the cases would show nothing.
#[test]
fn the_listings_compile() {
    for (name, listing) in [("roll", cases::ROLL), ("geared", cases::GEARED), ("set", cases::SET)] {
        assert_eq!(compiled(name, listing, false), None, "{name}");
    }
}

/// Every mistake is found; the message has the phrase of the case: the field and the remedy. All but the number that
/// is counted here show the user's own line as well.
#[test]
fn every_mistake_names_its_line_and_a_remedy() {
    let mut elsewhere = Vec::new();
    for Case { name, listing, right, wrong, phrase, shown } in CASES {
        assert!(listing.contains(right), "{name}: {right}");
        let Some(said) = compiled(name, &listing.replacen(right, wrong, 1), false) else {
            panic!("{name} compiles");
        };
        assert!(said.contains(phrase), "{name}: {said}");
        let line = said.contains(&format!("{name}.rs:"));
        assert_eq!(line, *shown == Shown::Line, "{name}: {said}");
        if !line {
            elsewhere.push(name);
        }
    }
    assert!(CASES.len() >= 40 && elsewhere.len() <= 3, "{} {elsewhere:?}", CASES.len());
}

/// The remedy of a message works: the listing with it compiles.
#[test]
fn the_remedies_compile() {
    for (name, listing, right, remedy) in cases::REMEDIES {
        assert!(listing.contains(right), "{name}: {right}");
        assert_eq!(compiled(&format!("{name}_mended"), &listing.replacen(right, remedy, 1), false), None, "{name}");
    }
}

/// What the design itself refuses, in a constant of its own, with the sentence of the run-time error.
#[test]
fn constants_stop_with_the_sentence_of_the_error() {
    for (name, text, sentence) in cases::CONSTANTS {
        let said = compiled(name, text, false).unwrap_or_else(|| panic!("{name} compiles"));
        assert!(said.contains(sentence) && said.contains(&format!("{name}.rs:")), "{name}: {said}");
    }
}

/// Refused where the type is used, and not in a constant: code has to be generated.
#[test]
#[cfg(feature = "balancing")]
fn more_planes_than_readings_do_not_compile() {
    let field = |planes: u32| {
        format!(
            "use driveline::balancing::{{Plan, Procedure}};
            fn main() {{ let _ = Procedure::<f32, 2, {planes}>::new(Plan::usual(2, {planes}, 1e-4)); }}"
        )
    };
    assert_eq!(compiled("two_planes", &field(2), true), None);
    let said = compiled("three_planes", &field(3), true).unwrap();
    assert!(said.contains(driveline::balancing::Error::MORE_PLANES_THAN_READINGS), "{said}");
}

/// The README's listing keeps within 20 lines and 15 names of the prelude, and is the same for both numbers but for one
/// word.
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
    for number in ["f32", "Fixed"] {
        assert_eq!(listing.matches("<f32, ").count(), 1, "{listing}");
        let changed = listing.replace("<f32, ", &format!("<{number}, "));
        let body = changed.replace("use driveline::prelude::*;", "");
        let program = format!("use driveline::prelude::*;\n\nfn main() {{\n{body}}}\n");
        assert_eq!(compiled(&format!("first_drive_{number}"), &program, false), None, "{number}");
    }
}
