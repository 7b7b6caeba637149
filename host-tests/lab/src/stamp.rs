//! When and of what something was measured, for the pages of the book.

use std::process::Command;

use driveline_qemu::clone::workspace;

/// Date and commit.
#[derive(Debug)]
pub struct Stamp {
    /// The day, as `2026-11-26`.
    pub date: String,
    /// The commit, with a `+` where the tree has changes outside the book.
    pub commit: String,
}

impl Stamp {
    /// Of now and of the project's folder.
    pub fn now() -> Self {
        let date = said("date", &["-u", "+%F"]).unwrap_or_default();
        let commit = said("git", &["rev-parse", "--short=10", "HEAD"]).unwrap_or_else(|| "unknown".into());
        // the page itself is no change
        let changed = said("git", &["status", "--porcelain", "--untracked-files=no", "--", ".", ":!doc"]);
        let mark = if changed.is_some_and(|changed| !changed.is_empty()) { " +" } else { "" };
        Stamp { date, commit: commit + mark }
    }
}

impl std::fmt::Display for Stamp {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, commit {}", self.date, self.commit)
    }
}

/// What a program prints, in the project's folder.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).current_dir(workspace().ok()?).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
