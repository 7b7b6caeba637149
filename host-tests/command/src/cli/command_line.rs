//! The commands and their arguments.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use clap::{Arg, ColorChoice, Parser, Subcommand, ValueEnum, value_parser};
use driveline_qemu::children::end_with_signals;

use super::output::UNSAID;
use super::{
    Failure, balance, campaign, cosim, design, example, export, failure, identify, modes, new, output, page, qemu,
    replay, rotor, setup, shell, simulate, watch,
};

/// Controllers for machine drives, checked against a full solver of the machine.
#[derive(Debug, Parser)]
#[command(name = "cargo driveline", bin_name = "cargo driveline", version, max_term_width = 100)]
pub(super) struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// The commands for who designs a machine.
#[derive(Debug, Subcommand)]
pub enum Command {
    Campaign(campaign::Campaign),
    Modes(modes::Modes),
    Design(design::Design),
    Example(example::Example),
    Export(export::Export),
    New(new::New),
    Page(page::Page),
    #[command(hide = true)]
    Qemu(qemu::Qemu),
    Rotor(rotor::Rotor),
    Balancing(balance::Balance),
    Identify(identify::Identify),
    Cosim(cosim::Cosim),
    Replay(replay::Replay),
    Setup(setup::Setup),
    Shell(shell::Shell),
    Simulate(simulate::Simulate),
    Watch(watch::Watch),
}

impl Command {
    /// Whether JSON is printed.
    pub fn json(&self) -> bool {
        match self {
            Self::Campaign(command) => command.json(),
            Self::Modes(command) => command.json,
            Self::Design(command) => command.json,
            Self::Example(command) => command.json,
            Self::Export(command) => command.json,
            Self::New(command) => command.json,
            Self::Page(command) => command.json,
            Self::Qemu(_) | Self::Shell(_) => false,
            Self::Rotor(command) => command.json,
            Self::Balancing(command) => command.json,
            Self::Identify(command) => command.json,
            Self::Cosim(command) => command.json,
            Self::Replay(command) => command.json,
            Self::Setup(command) => command.json,
            Self::Simulate(command) => command.json,
            Self::Watch(command) => command.json,
        }
    }

    /// Runs the command.
    pub fn execute(&self) -> Result<(), Failure> {
        match self {
            Self::Campaign(command) => command.execute(&[]),
            Self::Modes(command) => command.execute(),
            Self::Design(command) => command.execute(),
            Self::Example(command) => command.execute(),
            Self::Export(command) => command.execute(),
            Self::New(command) => command.execute(),
            Self::Page(command) => command.execute(),
            Self::Qemu(command) => command.execute(),
            Self::Rotor(command) => command.execute(),
            Self::Balancing(command) => command.execute(),
            Self::Identify(command) => command.execute(),
            Self::Cosim(command) => command.execute(),
            Self::Replay(command) => command.execute(),
            Self::Setup(command) => command.execute(),
            Self::Shell(command) => command.execute(),
            Self::Simulate(command) => command.execute(),
            Self::Watch(command) => command.execute(),
        }
    }
}

/// A program's arguments.
pub trait CommandLine: Parser {
    /// What its commands are for, and their names: the help lists them so. Without any it lists them in one.
    const GROUPS: &[(&str, &[&str])] = &[];
    /// The chosen command prints JSON.
    fn json(&self) -> bool;
    /// Runs the chosen command.
    fn execute(&self) -> Result<(), Failure>;
}

impl CommandLine for Cli {
    const GROUPS: &[(&str, &[&str])] = &[
        ("A machine in a file", &["modes", "design", "simulate", "campaign"]),
        ("A recording of a machine", &["identify", "replay"]),
        ("A rotor", &["rotor", "balancing"]),
        ("A file to begin with", &["example"]),
        ("Firmware of your own", &["new", "export"]),
        ("A machine from another tool", &["cosim"]),
        ("A running drive", &["watch"]),
        ("The design in a browser", &["page"]),
        ("Missing tools, completions, manual page", &["setup", "shell"]),
    ];

    fn json(&self) -> bool {
        self.command.json()
    }

    fn execute(&self) -> Result<(), Failure> {
        self.command.execute()
    }
}

/// Runs a command line of `cargo driveline`, the program's name first, and says how it ended.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let mut arguments: Vec<OsString> = arguments.into_iter().collect();
    // Cargo runs `cargo-driveline driveline ...` for `cargo driveline ...`.
    if arguments.get(1).is_some_and(|first| first == "driveline") {
        arguments.remove(1);
    }
    run::<Cli>(&arguments)
}

/// The arguments of a command line, the program's name first.
fn parsed<C: CommandLine>(arguments: &[OsString]) -> Result<C, clap::Error> {
    // `--seed -1` is a wrong value, not an option that nobody knows
    let grammar = C::command().mut_subcommands(|command| command.allow_negative_numbers(true));
    let color =
        Arg::new("color").long("color").global(true).value_name("WHEN").value_parser(value_parser!(ColorChoice));
    let color =
        color.help("Color labels of errors and the help: where it is a terminal, or as named").hide_default_value(true);
    let mut grammar = grouped(grammar, C::GROUPS).arg(color.default_value("auto")).color(color_choice(arguments));
    let matches = grammar.try_get_matches_from_mut(arguments)?;
    C::from_arg_matches(&matches).map_err(|error| error.format(&mut grammar))
}

/// What `--color` says, also of a line that cannot be parsed.
fn color_choice(arguments: &[OsString]) -> ColorChoice {
    let words = || arguments.iter().filter_map(|argument| argument.to_str());
    let next = words().skip_while(|word| *word != "--color").nth(1);
    let said = words().find_map(|word| word.strip_prefix("--color=")).or(next);
    said.and_then(|word| ColorChoice::from_str(word, true).ok()).unwrap_or(ColorChoice::Auto)
}

/// The commands listed by what they are for.
fn grouped(grammar: clap::Command, groups: &[(&str, &[&str])]) -> clap::Command {
    if groups.is_empty() {
        return grammar;
    }
    let mut listed = String::new();
    for (title, names) in groups {
        listed.push_str(&format!("{title}:\n"));
        for name in *names {
            let about = grammar.find_subcommand(name).and_then(clap::Command::get_about).map(ToString::to_string);
            listed.push_str(&format!("  {name:<11}{}\n", about.unwrap_or_default()));
        }
        listed.push('\n');
    }
    let template = "{about-with-newline}\n{usage-heading} {usage}\n\n{before-help}Options:\n{options}";
    grammar.before_help(listed.trim_end().to_owned()).help_template(template)
}

/// Runs a command of `cargo driveline` inside another program: what it writes to standard output, and how it ended.
///
/// A command that answers no, as `design` of a loop without margins, gives both.
pub fn answer(arguments: &[OsString]) -> (String, Result<(), Failure>) {
    let program = [OsString::from("cargo driveline")];
    match parsed::<Cli>(&[&program, arguments].concat()) {
        Ok(cli) => output::taken(|| cli.execute()),
        Err(error) => (String::new(), Err(Failure::usage(sentence(&error.to_string())))),
    }
}

/// Runs a command line, the program's name first, and says how it ended.
pub fn run<C: CommandLine>(arguments: &[OsString]) -> ExitCode {
    failure::color(match color_choice(arguments) {
        ColorChoice::Auto => None,
        choice => Some(choice == ColorChoice::Always),
    });
    let cli = match parsed::<C>(arguments) {
        Ok(cli) => cli,
        Err(error) if error.use_stderr() && arguments.iter().any(|argument| argument == "--json") => {
            return Failure::usage(sentence(&error.to_string())).report(true);
        }
        Err(error) if error.use_stderr() => {
            eprintln!("{}", failure::labelled(&failure::visible(&error.render().to_string())));
            return ExitCode::from(2);
        }
        // Help and version are no errors, unless they cannot be written; a reader that has gone away is none.
        Err(error) => {
            return match error.print() {
                Err(failed) if failed.kind() != ErrorKind::BrokenPipe => {
                    Failure::failed("standard output cannot be written").report(false)
                }
                _ => ExitCode::SUCCESS,
            };
        }
    };
    if let Err(error) = end_with_signals() {
        return Failure::failed(format!("signals cannot be caught: {error}")).report(cli.json());
    }
    match cli.execute() {
        Ok(()) if UNSAID.load(Ordering::Relaxed) => {
            Failure::failed("standard output cannot be written").report(cli.json())
        }
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(cli.json()),
    }
}

/// The parser's message as a sentence: its first line, and what it lists below in indented ones.
fn sentence(message: &str) -> String {
    let mut lines = message.lines();
    let first = lines.next().unwrap_or("wrong arguments").trim_start_matches("error: ");
    let listed: Vec<&str> = lines.take_while(|line| line.starts_with(' ')).map(str::trim).collect();
    if listed.is_empty() { first.to_owned() } else { format!("{first} {}", listed.join(", ")) }
}
