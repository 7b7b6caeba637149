//! `cargo driveline campaign`: a scene's drive over machines drawn from its tolerances.

mod tune;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::builder::RangedU64ValueParser;
use clap::{Args, Subcommand};

use super::results::{Destination, all, check, check_writable};
use super::{Failure, Progress, say, say_json};
use crate::campaign::compare::compare;
use crate::campaign::drive::Drive;
use crate::campaign::merge::{Shard, merge};
use crate::campaign::record::{Record, Settings};
use crate::campaign::run::run;
use crate::campaign::scenes::CampaignScene;
use crate::campaign::{Draw, Figure, Outcome, Summary, Tolerance, work};
use crate::machine_file::read;
use driveline_closed_loop::departure::Departure;
use driveline_report::format::{percent, significant};
use driveline_report::{Fact, Table};

/// Run a machine's drive in closed loop with many machines drawn from within its tolerances.
///
/// Stiffness, inertias, efficiency, gap, load and rope, torque constant and offset, cogging, delay and lag of the
/// torque, encoder and timing: each draw has other values. The library's own code runs on the host, with the bits of
/// the firmware. Prints medians, the worst draws, unstable draws and the factors that matter, and writes a page.
///
/// Each draw is added to a file of results when it is done. A campaign that was stopped goes on from there.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
#[command(after_help = "Examples:
  cargo driveline campaign hoist.toml --draws 1000
  cargo driveline campaign axis.toml --tolerance jitter=0 --drive rigid
  cargo driveline campaign hoist.toml --draws 10000 --shard 3/8 --results shard-3.draws
  cargo driveline campaign hoist.toml --tune disturbance.within=1..100 --least load-torque --tuned better.toml
  cargo driveline campaign merge shard-*.draws --html hoist.html
  cargo driveline campaign hoist.toml --drive plain --results plain.draws
  cargo driveline campaign compare hoist.draws plain.draws
  cargo driveline campaign hoist.toml --draw 17 --json")]
pub struct Campaign {
    #[command(subcommand)]
    further: Option<Further>,
    /// The machine file, FILE.toml; in the laboratory a scene, too: hoist, strip-mill, spindle, blooming-mill or
    /// crane-travel
    #[arg(required = true)]
    scene: Option<String>,
    /// Number of draws [default: 200; with --tune 40 a point]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=MOST_DRAWS))]
    draws: Option<u64>,
    /// Seed of the draws
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The drive: two-mass, semi-implicit or rigid, of a scene a variant as NUMBER/OBSERVER/RATE; or `plain`, a loop
    /// without an observer [default: the design's choice in f32]
    #[arg(long, value_name = "DRIVE")]
    drive: Option<String>,
    /// Range of a factor, as NAME=LOW..HIGH or NAME=VALUE, in place of the scene's; may be repeated
    #[arg(long, value_name = "RANGE")]
    tolerance: Vec<String>,
    /// Search a key of the machine file between two values for what --least names; may be repeated
    #[arg(long, value_name = "KEY=LOW..HIGH", conflicts_with_all = ["draw", "shard", "results"])]
    tune: Vec<String>,
    /// With --tune: the figure that is to be least in 95 % of the machines, shaft-torque, load-speed, load-torque, peak
    /// or dynamic-peak; of several their geometric mean [default: load-speed]
    #[arg(long, value_name = "FIGURE", requires = "tune")]
    least: Vec<String>,
    /// With --tune: a file for the machine with the values that were found
    #[arg(long, value_name = "PATH", requires = "tune")]
    tuned: Option<PathBuf>,
    /// Run one draw alone and print its values and figures
    #[arg(long, value_name = "NUMBER", conflicts_with_all = ["draws", "shard", "results", "threads", "html"])]
    draw: Option<u64>,
    /// Run part K of N alone, to be merged
    #[arg(long, value_name = "K/N", conflicts_with = "html")]
    shard: Option<String>,
    /// File of results, which grows by a line with each draw [default: report/SCENE-DRIVE.draws]
    #[arg(long, value_name = "PATH")]
    results: Option<PathBuf>,
    /// Number of threads [default: one a core]
    #[arg(long, value_name = "COUNT", value_parser = RangedU64ValueParser::<usize>::new().range(1..))]
    threads: Option<usize>,
    /// File of the page [default: report/SCENE-DRIVE-campaign.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

/// Draws of a campaign, unless told otherwise.
const DRAWS: u64 = 200;

/// Most draws of a campaign, of days of work.
const MOST_DRAWS: u64 = 10_000_000;

#[derive(Debug, Subcommand)]
enum Further {
    /// Put the results of all shards together
    Merge(Merge),
    /// Set two drives beside each other, draw by draw
    Compare(Compare),
}

/// Results of the shards of a campaign in one.
#[derive(Debug, Args)]
struct Merge {
    /// The shards' files of results
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// File of all results
    #[arg(long, value_name = "PATH")]
    results: Option<PathBuf>,
    /// File of the page [default: report/NAME-campaign.html, after --results or the first file]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    json: bool,
}

/// The figures of one drive over those of another, of the same draws.
#[derive(Debug, Args)]
struct Compare {
    /// The first drive's file of results
    first: PathBuf,
    /// The second's
    second: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Whether a machine at the ends of a tolerance differs from the nominal one. A factor of the sensors, the inverter or
/// the clock always has an effect; a gap or a rope only where there is one.
fn has_effect(scene: &CampaignScene, tolerance: Tolerance) -> bool {
    let departures = [tolerance.low, tolerance.high].map(|value| {
        let tolerance = Tolerance::new(tolerance.factor, value, value);
        Draw::new(&[tolerance], 0, 0).departure()
    });
    let runs = |by: &Departure| {
        let machine = scene.departing(by).ok()?;
        let runs = machine.scenarios.iter().map(|run| format!("{:?} {:?} {}", run.plant, run.actions, run.held));
        Some(runs.collect::<Vec<_>>())
    };
    let nominal = runs(&Departure::NONE);
    departures == [Departure::NONE; 2] || departures.iter().any(|by| runs(by) != nominal)
}

impl Campaign {
    /// Whether JSON is printed.
    pub fn json(&self) -> bool {
        match &self.further {
            None => self.json,
            Some(Further::Merge(merge)) => merge.json,
            Some(Further::Compare(compare)) => compare.json,
        }
    }

    /// Runs the draws that are not done and shows all, or merges shards; of a machine file or of one of `scenes`.
    ///
    /// # Errors
    /// A wrong argument; a file of another campaign; a result that cannot be written.
    pub fn execute(&self, scenes: &[CampaignScene]) -> Result<(), Failure> {
        match &self.further {
            Some(Further::Merge(merge)) => merge.execute(),
            Some(Further::Compare(compare)) => compare.execute(),
            None => self.run(scenes),
        }
    }

    fn run(&self, scenes: &[CampaignScene]) -> Result<(), Failure> {
        let draws = self.draws.unwrap_or(if self.tune.is_empty() { DRAWS } else { tune::DRAWS });
        if !self.tune.is_empty() {
            return self.tune();
        }
        let scene = &self.scene(scenes)?;
        let name = scene.name;
        let drive = scene
            .departing(&Departure::NONE)
            .map_err(|error| error.to_string())
            .and_then(|machine| Drive::named(scene, &machine, self.drive.as_deref()))
            .map_err(Failure::usage)?;
        let remark = scene.file().and_then(|file| file.designs.remark()).filter(|_| self.drive.is_none());
        if let Some(remark) = remark.filter(|_| !self.json) {
            say(format_args!("{}: {remark}", drive.name(name)));
        }
        let lacks = drive.lacks(scene);
        if let Some(lacks) = lacks.as_ref().filter(|_| !self.json) {
            say(format_args!("warning: {lacks}"));
        }
        let tolerances = self.tolerances(scene).map_err(Failure::usage)?;
        if let Some(number) = self.draw {
            return self.one(scene, &drive, &Draw::new(&tolerances, self.seed, number));
        }
        let shard = self.shard.as_deref().map(Shard::parse).transpose().map_err(Failure::usage)?;
        let stem = self.stem(scene, &drive.name(name));
        let usual = match shard {
            Some(Shard { which, of }) => format!("report/{stem}-{which}-of-{of}.draws"),
            None => format!("report/{stem}.draws"),
        };
        let path = self.results.clone().unwrap_or_else(|| PathBuf::from(usual));
        let page = Destination::page_unless(self.json || shard.is_some(), self.html.as_deref(), &page_name(&stem));
        let results = Destination::chosen("results", &path);
        let file = self.scene.as_deref().filter(|_| scene.file().is_some()).map(Path::new);
        check(file.as_slice(), [&results].into_iter().chain(&page))?;
        results.make_folder()?;
        let nominal = run(scene, &drive, &Draw::nominal()).map_err(Failure::failed)?;
        let variant = drive.name(name);
        let settings = Settings { variant, draws, seed: self.seed, tolerances, nominal, lacks };
        let mut record = Record::open(&path, &settings).map_err(Failure::usage)?;
        self.draw(scene, &drive, &settings, shard, &mut record)?;
        if let Some(Shard { which, of }) = shard {
            if self.json {
                return say_json(&serde_json::json!({ "shard": which, "of": of, "results": path }));
            }
            say(format_args!("shard {which} of {of}: {}", path.display()));
            return Ok(());
        }
        let summary = Summary::of(&settings, &record.outcomes);
        show(&summary, self.json)?;
        all([
            results.write(&settings.file(&record.outcomes)),
            page.map_or(Ok(()), |page| page.write_and_say(&summary.page(), self.json)),
        ])
    }

    /// What results and page are named after: the variant, and a machine file by its own name. A scene or another file
    /// may be of a machine of the same name.
    fn stem(&self, scene: &CampaignScene, variant: &str) -> String {
        let path = Path::new(self.scene.as_deref().unwrap_or_default());
        match (scene.file().and(path.file_name()), variant.split_once('/')) {
            (Some(file), Some((_, drive))) => format!("{}-{drive}", file.display()),
            _ => stem(variant),
        }
    }

    /// The scene of a name, or of a machine file.
    fn scene(&self, scenes: &[CampaignScene]) -> Result<CampaignScene, Failure> {
        let name = self.scene.as_deref().unwrap_or_default();
        if let Some(scene) = scenes.iter().find(|scene| scene.name == name) {
            return Ok(*scene);
        }
        let path = Path::new(name);
        if path.extension().is_some_and(|extension| extension == "toml") {
            return CampaignScene::of_file(read(path)?).map_err(|error| Failure::usage(format!("{name}: {error}")));
        }
        if scenes.is_empty() {
            return Err(Failure::usage(format!("a campaign is run of a machine file FILE.toml, not of `{name}`")));
        }
        let names: Vec<String> = scenes.iter().map(|scene| format!("`{}`", scene.name)).collect();
        let names = names.join(", ");
        Err(Failure::usage(format!("there is no campaign of a scene `{name}`; there are {names}, and files FILE.toml")))
    }

    /// The scene's tolerances with those of the command line in their place.
    fn tolerances(&self, scene: &CampaignScene) -> Result<Vec<Tolerance>, String> {
        let mut tolerances = scene.tolerances();
        let mut named = Vec::new();
        for text in &self.tolerance {
            let tolerance = Tolerance::parse(text)?;
            if named.contains(&tolerance.factor) {
                return Err(format!("--tolerance {}: expected it once", tolerance.factor.name()));
            }
            if !has_effect(scene, tolerance) {
                let name = tolerance.factor.name();
                return Err(format!(
                    "--tolerance {text}: the machine has nothing that `{name}` changes; expected a factor that it has"
                ));
            }
            named.push(tolerance.factor);
            match tolerances.iter_mut().find(|known| known.factor == tolerance.factor) {
                Some(known) => *known = tolerance,
                None => tolerances.push(tolerance),
            }
        }
        Ok(tolerances)
    }

    /// Runs the draws of the shard, or all, that are not in the record.
    fn draw(
        &self,
        scene: &CampaignScene,
        drive: &Drive,
        settings: &Settings,
        shard: Option<Shard>,
        record: &mut Record,
    ) -> Result<(), Failure> {
        let wanted = |draw: &u64| shard.is_none_or(|shard| shard.has(*draw)) && !record.outcomes.contains_key(draw);
        let draws: Vec<u64> = (0..settings.draws).filter(wanted).collect();
        let progress = Progress::of(draws.len() as u64);
        let one = |number: u64| run(scene, drive, &Draw::new(&settings.tolerances, settings.seed, number));
        let mut done = 0;
        let mut take = |number: u64, outcome: Outcome| {
            record.add(number, outcome)?;
            done += 1;
            progress.step();
            progress.says(&format!("{}: {done} of {} draws", settings.variant, draws.len()));
            Ok(())
        };
        work(&draws, self.threads, &one, &mut take).map_err(Failure::failed)
    }

    /// One draw beside the nominal machine.
    fn one(&self, scene: &CampaignScene, drive: &Drive, draw: &Draw) -> Result<(), Failure> {
        let outcome = run(scene, drive, draw).map_err(Failure::failed)?;
        let nominal = run(scene, drive, &Draw::nominal()).map_err(Failure::failed)?;
        if self.json {
            let values: BTreeMap<&str, f64> = draw.values.iter().map(|(f, v)| (f.name(), *v)).collect();
            let figures = |outcome: &Outcome| -> BTreeMap<&str, Option<f64>> {
                Figure::ALL.iter().map(|&figure| (figure.name(), outcome.found(figure))).collect()
            };
            return say_json(&serde_json::json!({
                "variant": drive.name(scene.name), "seed": self.seed, "draw": draw.number, "values": values,
                "figures": figures(&outcome), "nominal": figures(&nominal),
                "unstable": outcome.is_unstable(), "lacks": drive.lacks(scene),
            }));
        }
        let mut values = Table::new(["factor", "value", "unit", "nominal"]);
        for &(factor, value) in &draw.values {
            values.row([factor.name(), &significant(value), factor.unit(), &significant(factor.nominal())]);
        }
        let mut figures = Table::new(["figure", "value", "nominal"]);
        for &figure in Figure::ALL {
            let text = |outcome: &Outcome| match outcome.found(figure) {
                None => "nothing swings".to_owned(),
                Some(value) if figure.unit().is_empty() => percent(value),
                Some(value) => significant(value),
            };
            figures.row([figure.name().to_owned(), text(&outcome), text(&nominal)]);
        }
        say(format_args!("{}, seed {}, draw {}\n{values}\n{figures}", drive.name(scene.name), self.seed, draw.number));
        if outcome.is_unstable() {
            say("unstable");
        }
        Ok(())
    }
}

impl Merge {
    fn execute(&self) -> Result<(), Failure> {
        let (settings, outcomes) = merge(&self.files).map_err(Failure::usage)?;
        let results = self.results.as_deref().map(|path| Destination::chosen("results", path));
        let page = Destination::page_unless(self.json, self.html.as_deref(), &page_name(&self.stem()));
        let sources: Vec<&Path> = self.files.iter().map(PathBuf::as_path).collect();
        check_writable(&sources, results.iter().chain(&page))?;
        let summary = Summary::of(&settings, &outcomes);
        show(&summary, self.json)?;
        all([
            results.map_or(Ok(()), |results| results.write(&settings.file(&outcomes))),
            page.map_or(Ok(()), |page| page.write_and_say(&summary.page(), self.json)),
        ])
    }

    /// What the page is named after: the file of all results, or the first one less its shard. No file tells whether it
    /// is of a scene or of a machine file.
    fn stem(&self) -> String {
        let file = self.results.as_ref().or(self.files.first());
        let stem = file.and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy();
        let whole = stem.rsplit_once("-of-").and_then(|(before, of)| {
            let (whole, which) = before.rsplit_once('-')?;
            Shard::parse(&format!("{which}/{of}")).is_ok().then(|| whole.to_owned())
        });
        whole.unwrap_or_else(|| stem.into_owned())
    }
}

impl Compare {
    fn execute(&self) -> Result<(), Failure> {
        // of one file: all its draws must be there
        let [first, second] = [&self.first, &self.second].map(|path| merge(&[path]).map_err(Failure::usage));
        let comparison = compare(&first?, &second?).map_err(Failure::usage)?;
        if self.json {
            return say_json(&comparison);
        }
        say(comparison.table());
        Ok(())
    }
}

/// A variant's name as that of a file.
fn stem(variant: &str) -> String {
    variant.replace('/', "-")
}

fn page_name(stem: &str) -> String {
    format!("{stem}-campaign")
}

fn show(summary: &Summary, json: bool) -> Result<(), Failure> {
    if json {
        return say_json(summary);
    }
    let mut facts = Table::new(["campaign", ""]);
    summary.facts().into_iter().for_each(|Fact { name, value }| facts.row([name, value]));
    say(facts);
    summary.tables().into_iter().for_each(say);
    Ok(())
}
