//! `cargo lab run`: a scene in QEMU, in closed loop with the full solver.

use std::path::PathBuf;

use clap::Args;

use crate::campaign::SCENES as CAMPAIGNS;
use crate::campaign::sample;
use crate::drivetrains::{Plan, SCENES, Variants};
use cargo_driveline::campaign::drive::Drive;
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_closed_loop::departure::Departure;
use driveline_qemu::setup::Need;
use driveline_report::{SAMPLES, Sample, Variant, samples_table, variants_table};

/// Run a scene's variants in QEMU, in closed loop with the full solver, and report their errors and cost.
///
/// A first table has the errors of ten machines drawn from within the tolerances beside the nominal ones, where the
/// scene has tolerances.
///
/// Installs what is missing (as `setup` does), builds the firmware of the variants, runs it, prints a table and writes
/// a page with plots that opens in any browser. Without --all or --variants these are the design's choice in `f32` and
/// in fixed point.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab run
  cargo lab run hoist --all
  cargo lab run hoist --variants f32/m4f --quick
  cargo lab run --json > hoist.json")]
pub struct Run {
    /// The scene: hoist or another drivetrain
    #[arg(default_value = "hoist")]
    scene: String,
    /// The scene, as an option
    #[arg(long = "scene", value_name = "NAME", conflicts_with = "scene")]
    named: Option<String>,
    /// Print {scene, variants: [...]} and no table
    #[arg(long)]
    pub json: bool,
    /// File of the page of a drivetrain [default: report/SCENE.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Only variants whose number/core/observer/rate contains this text, as `fixed/m3` or `reduced/10000`
    #[arg(long, value_name = "FILTER")]
    variants: Option<String>,
    /// All variants, not only the design's choice of observer and rate in the number that each core is for
    #[arg(long, conflicts_with = "variants")]
    all: bool,
    /// A short run of each variant: for trying out, not for figures to quote
    #[arg(long)]
    quick: bool,
}

impl Run {
    /// Runs the scene, prints the table or JSON, writes the page.
    ///
    /// # Errors
    /// No such scene or variant; what kept a variant from running; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let scene = self.named.as_deref().unwrap_or(&self.scene);
        let variants = match self.variants.as_deref() {
            Some(filter) => Variants::Containing(filter),
            None if self.all => Variants::All,
            None => Variants::Chosen,
        };
        if !SCENES.iter().any(|(name, _)| *name == scene) {
            let names: Vec<String> = SCENES.iter().map(|(name, _)| format!("`{name}`")).collect();
            return Err(Failure::usage(format!("there is no scene `{scene}`; there are {}", names.join(", "))));
        }
        let plan = Plan::of(scene, variants, self.quick).map_err(Failure::usage)?;
        let file = Destination::page(self.html.as_deref(), scene);
        check_writable(&[], [&file])?;
        ready(&Need::to_run(plan.boards()))?;
        let progress = Progress::of(plan.steps());
        let mut report = plan
            .run(&|text| progress.says(text), &|| progress.step())
            .map_err(|error| Failure::failed(error.to_string()))?;
        if !self.quick {
            progress.says("machines within their tolerances");
            report.samples = samples(scene, &report.variants).map_err(Failure::failed)?;
        }
        drop(progress);
        if self.json {
            say_json(&report.json())?;
            return file.write(&report.page());
        }
        if !report.samples.is_empty() {
            let (text, table) = samples_table(&report.samples);
            say(format_args!("{SAMPLES}\n{text}\n{table}"));
        }
        say(format_args!("{}\n{}", report.scene, variants_table(&report.variants)));
        for budget in report.budgets.iter().filter(|budget| !budget.kept()) {
            let measured = format!("{} {}", budget.measured, budget.unit);
            say(format_args!("over budget: {}: {}, at most {}", budget.name, measured.trim_end(), budget.limit));
        }
        file.write_and_say(&report.page(), false)
    }
}

/// Machines of a sample.
const DRAWS: u64 = 10;

/// The variants on machines within the scene's tolerances, each once, whatever its core; none where the scene has no
/// tolerances.
fn samples(scene: &str, variants: &[Variant]) -> Result<Vec<Sample>, String> {
    let Some(scene) = CAMPAIGNS.iter().find(|known| known.name == scene) else { return Ok(Vec::new()) };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let machine = scene.departing(&Departure::NONE).map_err(|error| error.to_string())?;
    let mut samples: Vec<Sample> = Vec::new();
    for variant in variants {
        let name = format!("{}/{}/{}", variant.number, variant.observer, variant.rate_hz);
        let drive = Drive::named(scene, &machine, Some(&name))?;
        if samples.iter().all(|sample| sample.variant != drive.name(scene.name)) {
            samples.push(sample(scene, &drive, DRAWS, threads)?);
        }
    }
    Ok(samples)
}
