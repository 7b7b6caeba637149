//! `cargo driveline modes`: natural vibrations and reduction of a machine.

mod campbell;
mod chain;
mod page;
mod train;

use std::f64::consts::TAU;
use std::path::PathBuf;

use clap::Args;

pub use chain::Vibration;

use campbell::critical;
use chain::{Leaving, Reduction, WORTH};
use page::page;
use train::TrainVibration;

use super::{Failure, say, say_json};
use crate::machine_file::{is_train, read, read_train};
use driveline_report::format::{DIVERGED, percent, significant};
use driveline_report::{Table, write_page};

/// Natural frequencies and shapes of a machine, the two masses that can stand for it, the parts not worth keeping.
///
/// A chain of elements, with its branches, is referred to the motor's shaft; a train of coordinates and links stays as it is. With
/// `[running]` and
/// `[[excitation]]` in the file, critical speeds are listed and drawn, and those within 10 % of the running range
/// flagged. The page with the plots opens in any browser.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline modes host-tests/command/machines/hoist.toml
  cargo driveline modes my.toml --html my.html
  cargo driveline modes my.toml --json")]
pub struct Modes {
    /// The machine: a TOML file of elements from the motor to the load
    file: PathBuf,
    /// Where the page goes [default: report/NAME-modes.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Modes {
    /// Reads the machine and shows its vibrations.
    ///
    /// # Errors
    /// A machine file with a fault; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        if is_train(&self.file) {
            let file = read_train(&self.file)?;
            let vibration = TrainVibration::of(&file)?;
            return self.show(&file.slug(), || vibration.page(&file), &vibration, vibration.tables());
        }
        let machine = read(&self.file)?;
        let vibration = Vibration::of(&machine);
        self.show(&machine.slug(), || page(&machine, &vibration), &vibration, tables(&vibration))
    }

    fn show(
        &self,
        slug: &str,
        page: impl FnOnce() -> String,
        vibration: &impl serde::Serialize,
        tables: Vec<(String, String, Table)>,
    ) -> Result<(), Failure> {
        let usual = (!self.json).then(|| PathBuf::from(format!("report/{slug}-modes.html")));
        let path = self.html.clone().or(usual);
        if let Some(path) = &path {
            write_page(path, &page())
                .map_err(|error| Failure::failed(format!("{} cannot be written: {error}", path.display())))?;
        }
        if self.json {
            return say_json(vibration);
        }
        for (title, _, table) in tables {
            say(format_args!("{title}\n{table}"));
        }
        if let Some(path) = path {
            say(format_args!("page: {}", path.display()));
        }
        Ok(())
    }
}

/// The tables as title, explanation and table: for the terminal and the page alike.
pub fn tables(vibration: &Vibration) -> Vec<(String, String, Table)> {
    let mut all = Vec::new();
    let mut parts = Table::new(["part", "inertia kg m²", "stiffness N m/rad", "damping N m s/rad", "gap rad"]);
    for (index, mass) in vibration.masses.iter().enumerate() {
        parts.row([mass.name.clone(), significant(mass.inertia)]);
        if let Some(shaft) = vibration.shafts.get(index) {
            let numbers = [shaft.stiffness, shaft.damping, shaft.gap].map(significant);
            parts.row([shaft.name.clone(), String::new()].into_iter().chain(numbers));
        }
    }
    all.push(("Machine, referred to the motor".to_owned(), String::new(), parts));
    if vibration.resonances.is_empty() {
        return all;
    }
    let mut modes = Table::new(
        ["mode", "Hz", "rad/s", "damping ratio", "antiresonance Hz"]
            .map(String::from)
            .into_iter()
            .chain(vibration.masses.iter().map(|mass| mass.name.clone())),
    );
    for (index, mode) in vibration.resonances.iter().enumerate() {
        let held = vibration.antiresonances.get(index).copied().unwrap_or(f64::NAN);
        let numbers = [mode.hz, mode.frequency, mode.damping_ratio, held / TAU].map(significant);
        let shape = mode.shape.iter().map(|value| format!("{value:+.3}"));
        modes.row([(index + 1).to_string()].into_iter().chain(numbers).chain(shape));
    }
    let text = "Frequencies of the free machine, and with the motor held; amplitudes of the masses, the largest 1.";
    all.push(("Frequencies and shapes".to_owned(), text.to_owned(), modes));
    all.extend(critical(&vibration.critical));
    all.push(reductions(&vibration.reductions));
    if !vibration.worth.is_empty() {
        all.push(worth(&vibration.worth));
    }
    all
}

fn reductions(reductions: &[Reduction]) -> (String, String, Table) {
    let mut table = Table::new([
        "two masses by",
        "motor kg m²",
        "load kg m²",
        "stiffness N m/rad",
        "damping N m s/rad",
        "resonance",
        "antiresonance",
        "give",
        "next mode Hz",
        "its share",
        "worst",
    ]);
    for r in reductions {
        let sizes = [r.motor_inertia, r.load_inertia, r.stiffness, r.damping].map(significant);
        let errors = [r.resonance_error, r.antiresonance_error, r.compliance_error].map(signed);
        let next = r.next_mode.map_or_else(|| "none".to_owned(), |next| significant(next / TAU));
        let rest = [next, significant(r.next_share), percent(r.worst)];
        table.row([r.by.clone()].into_iter().chain(sizes).chain(errors).chain(rest));
    }
    let text = "Errors of the first resonance, the first antiresonance and the static give at the motor; the lowest mode \
                left out and its share at the motor (1 moves it as much as the rigid turning does); a bound of the error of \
                the motor's speed after a blow, over its first jump.";
    ("Reduction to two masses".to_owned(), text.to_owned(), table)
}

fn worth(parts: &[Leaving]) -> (String, String, Table) {
    let mut table = Table::new(["if it were simplified", "resonance", "antiresonance", "give", "worth keeping"]);
    let change = |value: Option<f64>| value.map_or_else(|| "none left".to_owned(), signed);
    for part in parts {
        let changes = [part.resonance, part.antiresonance, part.compliance].map(change);
        let verdict = if part.worth_keeping { "yes" } else { "no" };
        table.row([part.part.clone()].into_iter().chain(changes).chain([verdict.to_owned()]));
    }
    let text = format!(
        "Computed change at the motor when a part is left out; below {} in all three it is not worth keeping.",
        percent(WORTH)
    );
    ("Parts and what they are worth".to_owned(), text, table)
}

/// A relative change in percent with its sign; what rounding leaves is none.
fn signed(change: f64) -> String {
    match percent(change) {
        text if text == DIVERGED => text,
        _ if change.abs() < 1e-9 => "0 %".to_owned(),
        text if change > 0.0 => format!("+{text}"),
        text => text,
    }
}
