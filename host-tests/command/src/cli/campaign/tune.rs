//! `cargo driveline campaign FILE.toml --tune`: the values of a machine file that make a figure least.

use std::path::PathBuf;

use serde::Serialize;

use super::Campaign;
use crate::campaign::drive::Drive;
use crate::campaign::scenes::CampaignScene;
use crate::campaign::tune::{SHARE, Text, Tried, Tuned, objective, of_share, search};
use crate::campaign::{Figure, Outcome, outcomes};
use crate::cli::results::{Destination, check};
use crate::cli::{Failure, Progress, say, say_json};
use crate::machine_file::{parse, text};
use driveline_closed_loop::departure::Departure;
use driveline_report::chart::{Curve, Lines};
use driveline_report::format::{percent, significant};
use driveline_report::{Figure as Drawing, Section, Sheet, Table, fact};

/// Most keys.
const MOST_KEYS: usize = 3;

/// Draws of each point, unless told otherwise.
pub const DRAWS: u64 = 40;

/// The figures that may be least, by their words on the command line.
const FIGURES: [(&str, Figure); 5] = [
    ("shaft-torque", Figure::ShaftTorque),
    ("load-speed", Figure::LoadSpeed),
    ("load-torque", Figure::LoadTorque),
    ("peak", Figure::Peak),
    ("dynamic-peak", Figure::DynamicPeak),
];

/// The figure of a word.
pub fn figure(word: &str) -> Result<Figure, String> {
    let words = || FIGURES.map(|(word, _)| word).join(", ");
    let found = FIGURES.into_iter().find(|(known, _)| *known == word).map(|(_, figure)| figure);
    found.ok_or_else(|| format!("there is no figure `{word}`; expected {}", words()))
}

/// What was found.
#[derive(Debug, Serialize)]
struct Found {
    draws: u64,
    seed: u64,
    share: f64,
    keys: Vec<Tuned>,
    /// Names of the figures that are least together.
    least: Vec<&'static str>,
    /// The values in the file, and the best ones.
    from: Vec<f64>,
    to: Vec<f64>,
    /// What 95 % of the machines do not exceed, with the file's values (`null` where they are refused) and the best.
    figures: Vec<Change>,
    /// All points, the best one first.
    tried: Vec<Tried>,
}

/// A figure before and after.
#[derive(Debug, Serialize)]
struct Change {
    name: &'static str,
    from: Option<f64>,
    to: f64,
}

impl Campaign {
    /// Searches the ranges of `--tune`.
    ///
    /// # Errors
    /// A wrong argument; a file that no point of the ranges makes a sound drive of; a result that cannot be written.
    pub(super) fn tune(&self) -> Result<(), Failure> {
        let path = PathBuf::from(self.scene.as_deref().unwrap_or_default());
        if path.extension().is_none_or(|extension| extension != "toml") {
            return Err(Failure::usage("--tune changes a machine file; expected FILE.toml"));
        }
        if self.tune.len() > MOST_KEYS {
            return Err(Failure::usage(format!("--tune: at most {MOST_KEYS} keys, not {}", self.tune.len())));
        }
        let usage = |error: String| Failure::usage(error);
        let keys = self.tune.iter().map(|text| Tuned::parse(text)).collect::<Result<Vec<_>, _>>().map_err(usage)?;
        let least = self.least.iter().map(|word| figure(word)).collect::<Result<Vec<_>, _>>().map_err(usage)?;
        let least = if least.is_empty() { vec![Figure::LoadSpeed] } else { least };
        let (name, source) = text(&path, "a machine file")?;
        let disturbance = parse(&name, &source)?.disturbance;
        if disturbance.torque_noise.is_none() && keys.iter().any(|tuned| tuned.key == "disturbance.torque_accuracy") {
            return Err(Failure::usage(format!(
                "--tune disturbance.torque_accuracy: the noise of the torque would change with it; expected the noise \
                 that the torque has beside it, as `torque_noise = {:?}`",
                disturbance.noise()
            )));
        }
        let original = Text::of(&name, source, &keys).map_err(usage)?;
        let stem = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let tuned_file = self.tuned.as_deref().map(|path| Destination::chosen("machine file", path));
        let page = Destination::page_unless(self.json, self.html.as_deref(), &format!("{stem}-tune"));
        check(&[path.as_path()], tuned_file.iter().chain(&page))?;

        let draws = self.draws.unwrap_or(DRAWS);
        let progress = Progress::open();
        let mut tried = 0;
        let mut outcomes_at = |values: &[f64]| {
            tried += 1;
            progress.says(&format!("{stem}: point {tried}, {draws} draws each"));
            self.outcomes(&name, &original.with(values), draws)
        };
        let mut after = (f64::INFINITY, Vec::new());
        let points = search(&keys, |values| {
            let outcomes = match outcomes_at(values)? {
                Ok(outcomes) => outcomes,
                Err(refused) => return Ok(Err(refused)),
            };
            let found = objective(&least, &outcomes);
            if let Some(&found) = found.as_ref().ok().filter(|found| **found < after.0) {
                after = (found, outcomes);
            }
            Ok(found)
        })
        .map_err(Failure::failed)?;
        let Some(best) = points.first().filter(|best| best.objective.is_some()).cloned() else {
            let why = points.first().and_then(|tried| tried.refused.clone()).unwrap_or_default();
            return Err(Failure::failed(format!("{name}: all {} points are refused; one: {why}", points.len())));
        };
        let from = original.values();
        let before = outcomes_at(&from).map_err(Failure::failed)?.ok();
        let change = |&(_, figure): &(&str, Figure)| Change {
            name: figure.name(),
            from: before.as_ref().map(|outcomes| of_share(figure, outcomes, SHARE)),
            to: of_share(figure, &after.1, SHARE),
        };
        let found = Found {
            draws,
            seed: self.seed,
            share: SHARE,
            least: least.iter().map(|figure| figure.name()).collect(),
            from,
            to: best.values.clone(),
            figures: FIGURES.iter().map(change).collect(),
            keys,
            tried: points,
        };
        if self.json {
            say_json(&found)?;
        } else {
            found.sections().into_iter().for_each(say);
        }
        if let Some(file) = tuned_file {
            file.write_and_say(&original.with(&found.to), self.json)?;
        }
        page.map_or(Ok(()), |page| page.write_and_say(&found.page(&stem), self.json))
    }

    /// Outcomes of all draws with this machine file. The inner error is the reason why it is refused.
    fn outcomes(&self, name: &str, text: &str, draws: u64) -> Result<Result<Vec<Outcome>, String>, String> {
        let scene = match parse(name, text).map_err(|error| error.to_string()).and_then(CampaignScene::of_file) {
            Ok(scene) => scene,
            Err(error) => return Ok(Err(error)),
        };
        let machine = scene.departing(&Departure::NONE).map_err(|error| error.to_string())?;
        let drive = Drive::named(&scene, &machine, self.drive.as_deref())?;
        if let Some(lacks) = drive.lacks(&scene) {
            return Ok(Err(lacks));
        }
        let tolerances = self.tolerances(&scene)?;
        outcomes(&scene, &drive, &tolerances, (self.seed, draws), self.threads).map(Ok)
    }
}

impl Found {
    fn sections(&self) -> Vec<Section> {
        let mut values = Table::new(["key", "range", "in the file", "found"]);
        for ((tuned, from), to) in self.keys.iter().zip(&self.from).zip(&self.to) {
            let range = format!("{} to {}", significant(tuned.low), significant(tuned.high));
            let end = if *to == tuned.low || *to == tuned.high { ", at the end of its range" } else { "" };
            values.row([tuned.key.clone(), range, significant(*from), format!("{}{end}", significant(*to))]);
        }
        let share = percent(self.share);
        let mut figures = Table::new(["figure", "in the file", "found"]);
        for Change { name, from, to } in &self.figures {
            let least = if self.least.contains(name) { " (least)" } else { "" };
            let from = from.map_or_else(|| "refused".to_owned(), percent);
            figures.row([format!("{name}{least}"), from, percent(*to)]);
        }
        let refused: Vec<&str> = self.tried.iter().filter_map(|tried| tried.refused.as_deref()).collect();
        let why = refused.first().map_or_else(String::new, |why| format!(", one of them: {why}"));
        let note = format!(
            "Of {} draws of seed {}, {share} of the machines are not worse. {} points were tried, {} refused{why}.",
            self.draws,
            self.seed,
            self.tried.len(),
            refused.len()
        );
        vec![
            Section::new("Values", "Each by ratio over its range.".to_owned(), values),
            Section::new("Figures", note, figures),
        ]
    }

    fn page(&self, name: &str) -> String {
        let drawing = |(k, tuned): (usize, &Tuned)| {
            // the least over the other keys
            let mut points: Vec<(f64, f64)> = Vec::new();
            for tried in &self.tried {
                if let Some(objective) = tried.objective.filter(|_| points.iter().all(|(at, _)| *at != tried.values[k]))
                {
                    points.push((tried.values[k], objective));
                }
            }
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let lines = Lines {
                label: format!("What is least over {}", tuned.key),
                along: format!("logarithm to base ten of {}", tuned.key),
                across: "what is least, %".to_owned(),
                places: points.iter().map(|point| point.0.log10()).collect(),
                curves: vec![Curve { class: "s0".to_owned(), values: points.iter().map(|p| 100.0 * p.1).collect() }],
                marks: vec![(self.to[k].log10(), "found".to_owned())],
                logarithmic: true,
                ..Lines::default()
            };
            Drawing::new(&tuned.key, "The best of all points with this value.", Vec::new(), vec![lines.draw()])
        };
        Sheet {
            name: name.to_owned(),
            kicker: "values that make a figure least".to_owned(),
            summary: format!("Least: {}, of {} of the drawn machines.", self.least.join(", "), percent(self.share)),
            facts: vec![fact("draws", self.draws.to_string())],
            figures: self.keys.iter().enumerate().map(drawing).collect(),
            tables: self.sections(),
        }
        .page()
    }
}
