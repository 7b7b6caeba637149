//! `cargo lab proof`: bounds that hold for every input and for every machine within the tolerances.

use std::path::PathBuf;

use cargo_driveline::cli::{Failure, say, say_json};
use cargo_driveline::machine_file;
use clap::Args;
use driveline_report::Table;
use serde_json::{Value, json};

use crate::proof::measured::measured;
use crate::proof::rounding::{Kind, bounds};
use crate::proof::stability::prove;
use crate::proof::subject::Subject;

/// Prove how far fixed point may ever be from real numbers, and that the speed loop is stable over its tolerances.
///
/// Stability is proven for every machine within the tolerances, not at points of them. The bound of fixed point holds
/// for every input and any time, while the drive reports neither a state beyond its base nor an implausible sample.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab proof
  cargo lab proof --machine hoist.toml --ticks 100000000")]
pub struct Proof {
    /// A machine file instead of the firmware's machines
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Compare with the largest difference in so many ticks
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    ticks: u64,
    /// Print [{machine, observer, error, coefficients, largest, measured}, ..., {machine, stability}, ...]
    #[arg(long)]
    pub json: bool,
}

impl Proof {
    /// Proves and prints.
    ///
    /// # Errors
    /// A file that is none, or has no drive.
    pub fn execute(&self) -> Result<(), Failure> {
        let subjects = match &self.machine {
            None => Subject::all().into_iter().map(|(name, subject)| (name.to_string(), subject)).collect(),
            Some(path) => {
                let place = |error: String| Failure::usage(format!("{}: {error}", path.display()));
                let file = machine_file::read(path).map_err(|error| Failure::usage(error.to_string()))?;
                vec![(path.display().to_string(), Subject::of_file(&file).map_err(place)?)]
            }
        };
        let mut table = Table::new([
            "machine",
            "observer",
            "motor speed",
            "shaft torque",
            "load speed",
            "load torque",
            "largest word, within and at twice the bases",
        ]);
        let mut all = Vec::new();
        for (name, subject) in &subjects {
            for kind in [Kind::Rigid, Kind::SemiImplicit, Kind::Exact] {
                let Some(bounds) = bounds(subject, kind) else { continue };
                let found = (self.ticks > 0).then(|| measured(subject, kind, self.ticks)).flatten();
                let bases = [subject.bases.speed, subject.bases.torque, subject.bases.speed, subject.bases.torque];
                let cell = |k: usize| {
                    let error = bounds.error[k];
                    let ratio = found.map_or(String::new(), |found| format!(", {:.1} times", error / found[k]));
                    format!("{error:.2e} ({:.1} ppm{ratio})", 1e6 * error / bases[k])
                };
                let cells = [cell(0), cell(1), cell(2), cell(3)];
                let [a, b, c, d] = cells;
                table.row([
                    name.clone(),
                    kind.to_string(),
                    a,
                    b,
                    c,
                    d,
                    format!("{:.2}; {:.2}", bounds.largest[0], bounds.largest[1]),
                ]);
                let measured = found.map_or(Value::Null, |found| json!(found));
                all.push(json!({
                    "machine": name, "observer": kind.to_string(), "error": bounds.error,
                    "coefficients": bounds.coefficients, "largest": bounds.largest, "measured": measured,
                }));
            }
        }
        let mut loops = Table::new(["machine", "speed loop over its tolerances"]);
        for (name, subject) in &subjects {
            let Some(outcome) = prove(subject, subject.tolerated()) else { continue };
            loops.row([name.clone(), outcome.to_string()]);
            all.push(json!({ "machine": name, "stability": outcome.to_string() }));
        }
        if self.json {
            return say_json(&all);
        }
        say(table);
        say(loops);
        Ok(())
    }
}
