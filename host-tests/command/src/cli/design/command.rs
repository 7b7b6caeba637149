//! The command and its arguments.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Detail, Whole, drawn, emitted, page, rates, responses, text, widest};
use crate::cli::results::{Destination, check};
use crate::cli::{Failure, Plan, say, say_json};
use crate::machine_file::read;

/// Design observer and governor of a machine: reduction, step, gains, poles, predicted deviations, margins.
///
/// The same functions design a firmware's constants at compile time; with --emit rust they are printed to paste.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example hoist > hoist.toml
  cargo driveline design hoist.toml
  cargo driveline design my.toml --emit rust > src/my_machine.rs
  cargo driveline design my.toml --html my.html
  cargo driveline design my.toml --rates --draws 40
  cargo driveline design my.toml --json")]
pub struct Design {
    /// The machine: a TOML file of elements from the motor to the load
    file: PathBuf,
    /// Print constants to paste into a firmware, instead of the tables
    #[arg(long, value_name = "LANGUAGE")]
    emit: Option<Language>,
    /// Write a page: Bode and Nyquist plots of the loop, machine, observer, steps, margins, poles
    #[arg(long, value_name = "PATH", alias = "page")]
    html: Option<PathBuf>,
    /// Compare rates and observers: errors over the tolerances against instructions a second, their front marked
    #[arg(long, conflicts_with = "emit")]
    rates: bool,
    /// With --rates: run each drive with this many machines drawn from within the tolerances, and compare these errors
    #[arg(long, value_name = "COUNT", requires = "rates", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    draws: Option<u64>,
    /// Print JSON, with the responses as arrays; with --emit, {"rust": "..."}
    #[arg(long)]
    pub json: bool,
}

/// Kinds of output to paste.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    /// Constants in the words of the library
    Rust,
}

impl Design {
    /// Reads the machine and designs its controller.
    ///
    /// # Errors
    /// A machine file with a fault; a machine that cannot be observed or governed so. A speed loop that lacks margins, of
    /// which the design is printed; of an unstable one no constants.
    pub fn execute(&self) -> Result<(), Failure> {
        let machine = read(&self.file)?;
        let html = self.html.as_ref().map(|path| Destination::chosen("page", path));
        check(&[&self.file], &html)?;
        let refused = |error: String| Failure::usage(format!("{}: no drive can be made: {error}", self.file.display()));
        let plan = Plan::with_dampers(&machine).map_err(refused)?;
        let speed_loop = plan.speed_loop.as_ref();
        let unstable = speed_loop.and_then(|governor| governor.no_margins.as_ref());
        if let (Some(_), Some(why)) = (self.emit, unstable) {
            return Err(Failure::failed(format!("{}: no constants are printed: {why}", self.file.display())));
        }
        let draws = self.draws.unwrap_or(0);
        let choices = || rates::choices(&machine, |choices| drawn::fill(choices, &machine, draws));
        let shown = || responses(&machine, Detail::FULL).map_err(refused);
        match (self.emit, self.json) {
            (Some(Language::Rust), true) => {
                say_json(&serde_json::json!({ "rust": emitted(&machine, &plan).map_err(refused)? }))?;
            }
            (Some(Language::Rust), false) => say(emitted(&machine, &plan).map_err(refused)?.trim_end()),
            (None, true) => {
                let rates = self.rates.then(choices);
                say_json(&Whole { plan: &plan, responses: shown()?, widest: widest(&machine, &plan), rates })?;
            }
            (None, false) if self.rates => say(rates::text(&choices(), draws)),
            (None, false) => say(text(&machine, &plan)),
        }
        if let Some(html) = html {
            html.write_and_say(&page(&plan, shown()?.as_ref()), self.json)?;
        }
        let lack = |which: &str, why: &String| {
            Failure::failed(format!("{}: the speed loop {which} margins: {why}", self.file.display()))
        };
        if let Some(why) = unstable {
            return Err(lack("has no", why));
        }
        speed_loop.and_then(|governor| governor.not_robust.as_ref()).map_or(Ok(()), |why| Err(lack("lacks", why)))
    }
}
