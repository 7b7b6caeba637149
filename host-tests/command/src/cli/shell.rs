//! `cargo driveline shell`: completions and the manual page.

use clap::{Args, CommandFactory, ValueEnum};
use clap_complete::Shell as Completed;
use clap_mangen::Man;

use super::command_line::Cli;
use super::{Failure, say};

/// Print completions of `cargo-driveline` for a shell, or its manual page.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline shell bash > ~/.local/share/bash-completion/completions/cargo-driveline
  cargo driveline shell man > ~/.local/share/man/man1/cargo-driveline.1")]
pub struct Shell {
    /// What to print
    form: Form,
}

/// What is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Completions for bash
    Bash,
    /// Completions for elvish
    Elvish,
    /// Completions for fish
    Fish,
    /// Completions for zsh
    Zsh,
    /// The manual page, for `cargo help driveline`
    Man,
}

impl Shell {
    /// Prints it.
    ///
    /// # Errors
    /// A manual page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let mut grammar = Cli::command().name("cargo-driveline").bin_name("cargo-driveline");
        let mut text = Vec::new();
        let completed = match self.form {
            Form::Bash => Completed::Bash,
            Form::Elvish => Completed::Elvish,
            Form::Fish => Completed::Fish,
            Form::Zsh => Completed::Zsh,
            Form::Man => {
                let written = Man::new(grammar).render(&mut text);
                written.map_err(|error| Failure::failed(format!("the manual page cannot be written: {error}")))?;
                say(String::from_utf8_lossy(&text).trim_end());
                return Ok(());
            }
        };
        clap_complete::generate(completed, &mut grammar, "cargo-driveline", &mut text);
        say(String::from_utf8_lossy(&text).trim_end());
        Ok(())
    }
}
