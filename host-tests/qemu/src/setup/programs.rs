//! Programs of this machine: whether they run.

use std::ffi::OsStr;
use std::process::{Command, Stdio};

/// Whether a program ends with success; nothing of it is shown.
pub fn succeeds(program: &OsStr, arguments: &[&str]) -> bool {
    let status = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}
