//! Standard output: texts and JSON, or a string in its place.

use std::cell::RefCell;
use std::fmt::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};

use super::failure::Failure;

/// Writes to standard output. A reader that has gone away (`| head`) is no error.
pub fn say(text: impl std::fmt::Display) {
    use std::io::{ErrorKind, Write as _};
    if TAKEN.with_borrow_mut(|taken| taken.as_mut().map(|taken| writeln!(taken, "{text}"))).is_some() {
        return;
    }
    let mut out = std::io::stdout();
    let written = writeln!(out, "{text}").and_then(|()| out.flush());
    if written.is_err_and(|error| error.kind() != ErrorKind::BrokenPipe) {
        UNSAID.store(true, Ordering::Relaxed);
    }
}

thread_local! {
    /// What this thread says while it is taken.
    static TAKEN: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// What a call on this thread writes to standard output, in a string, beside its result.
pub fn taken<R>(call: impl FnOnce() -> R) -> (String, R) {
    TAKEN.set(Some(String::new()));
    let result = call();
    (TAKEN.take().unwrap_or_default(), result)
}

/// Standard output could not be written.
pub static UNSAID: AtomicBool = AtomicBool::new(false);

/// Version of the keys in the JSON: a key that goes, or changes its meaning or its unit, raises it.
const SCHEMA: u32 = 1;

/// Writes JSON to standard output, an object with the version of its keys first.
pub fn say_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Failure::failed(format!("the result cannot be written as JSON: {error}")))?;
    match text.strip_prefix("{\n") {
        Some(rest) => say(format_args!("{{\n  \"schema\": {SCHEMA},\n{rest}")),
        None => say(text),
    }
    Ok(())
}
