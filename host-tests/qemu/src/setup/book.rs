//! `mdbook`, which builds the book: the one on the path, else one compiled into the user's cache.

use std::ffi::OsString;

use super::programs::{cargo, succeeds};
use super::runner::Runner;
use crate::cache;

/// What is compiled.
const VERSION: &str = "0.5.4";

/// The program to run: the one on the path, where there is one, else the one in the cache.
pub fn mdbook() -> OsString {
    let installed = OsString::from("mdbook");
    if answers(&installed) { installed } else { cache::folder("mdbook").join("bin/mdbook").into() }
}

/// Whether a program starts and gives its version.
pub fn answers(program: &OsString) -> bool {
    succeeds(program, &["--version"])
}

/// Compiles it, without its server and its search, unoptimised: a book of this size takes a second.
pub fn install(runner: &mut Runner) -> Result<(), String> {
    runner.run(&command())
}

/// The command that compiles it.
pub fn command() -> Vec<String> {
    let root = cache::folder("mdbook");
    let options = ["install", "mdbook", "--version", VERSION, "--locked", "--debug", "--no-default-features", "--root"];
    let words = options.into_iter().map(String::from);
    [cargo().to_string_lossy().into_owned()].into_iter().chain(words).chain([root.display().to_string()]).collect()
}
