//! Programs of this machine: whether they run.

use std::ffi::{OsStr, OsString};
use std::process::{Command, Stdio};

/// The cargo that runs this program, else the one on the path.
pub fn cargo() -> OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Whether a program ends with success; nothing of it is shown.
pub fn succeeds(program: &OsStr, arguments: &[&str]) -> bool {
    let status = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}
