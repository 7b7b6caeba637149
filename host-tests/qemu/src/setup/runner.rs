//! Programs that are run: quietly, or with what they print.

use std::process::{Command, Stdio};

use super::packages::Trial;

/// Runner of commands, which reports them.
pub struct Runner<'p>(pub &'p mut dyn FnMut(&str));

impl Runner<'_> {
    pub fn say(&mut self, line: &str) {
        (self.0)(line);
    }

    /// Runs a command and shows what it prints; an error says how it ended.
    pub fn run(&mut self, words: &[String]) -> Result<(), String> {
        let line = words.join(" ");
        self.say(&line);
        // standard output is for the caller's own lines
        let status = command(words).stdout(std::io::stderr()).status().map_err(|error| format!("`{line}`: {error}"))?;
        if status.success() { Ok(()) } else { Err(format!("`{line}` ended with {status}")) }
    }

    /// Runs a command, called `name`, of which nothing is shown; gives the last line of its warnings, or of its error.
    pub fn quietly(&mut self, words: &[String], name: &str) -> Result<String, String> {
        let output = command(words).output().map_err(|error| format!("{name}: {error}"))?;
        let last = format!("{name}: {}", last_line(&output.stderr));
        if output.status.success() { Ok(last) } else { Err(last) }
    }

    /// Actions of an `apt-get install`; the query needs no rights.
    pub fn trial(&mut self, words: &[String]) -> Result<Trial, String> {
        let name = words.join(" ");
        let output = command(words).arg("--simulate").env("LC_ALL", "C").output();
        let output = output.map_err(|error| format!("`{name}`: {error}"))?;
        let trial = Trial::read(&String::from_utf8_lossy(&output.stdout));
        if output.status.success() || !trial.removed.is_empty() {
            return Ok(trial);
        }
        Err(format!("`{name}`: {}", last_line(&output.stderr)))
    }
}

/// The last line of what a program printed, as its reason.
fn last_line(text: &[u8]) -> String {
    let text = String::from_utf8_lossy(text);
    text.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("no reason given").trim_start_matches("E: ").to_owned()
}

/// A command of some words, without input.
fn command(words: &[String]) -> Command {
    let mut command = Command::new(words.first().map_or("", String::as_str));
    command.args(words.iter().skip(1)).env("DEBIAN_FRONTEND", "noninteractive").stdin(Stdio::null());
    command
}
