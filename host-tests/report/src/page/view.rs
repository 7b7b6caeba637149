//! Input of the page's template: finished texts and plots.

mod tables;
mod tiles;
mod variants;

use serde::Serialize;

use super::thinning::fineness;
use crate::chart;
use crate::report::Report;
use crate::results::{Fact, Variant};
use crate::sample::{SAMPLES, Sample, samples_table};
use crate::svg::MARKERS;
use crate::trajectory::Trajectory;
use variants::{Named, index_of, names};

/// Everything on the page.
#[derive(Serialize)]
pub struct View<'a> {
    scene: &'a str,
    summary: &'a str,
    facts: &'a [Fact],
    notes: &'a [String],
    tiles: Vec<tiles::Tile>,
    #[serde(flatten)]
    costs: Costs,
    rows: Vec<variants::Row>,
    sampled: Option<Sampled>,
    courses: Courses,
    budgets: Vec<tables::Verdict>,
}

/// Errors against costs, with what colours and markers stand for.
#[derive(Serialize)]
pub struct Costs {
    costs: Vec<variants::Plot>,
    series: Vec<Named>,
    shapes: Vec<Named>,
    markers: [&'static str; 6],
}

impl Costs {
    /// The plots of variants that look as they are and are called as `named` has them, in the same order.
    pub fn named(variants: &[Variant], named: &[Variant]) -> Self {
        let looks = variants::Looks::of(variants);
        Costs {
            costs: variants::costs(named, &looks.each),
            series: looks.series,
            shapes: looks.shapes,
            markers: MARKERS,
        }
    }
}

/// Trajectories, chosen by variant and situation.
#[derive(Serialize)]
struct Courses {
    variants: Vec<String>,
    situations: Vec<String>,
    plots: Vec<Course>,
    left_out: usize,
}

#[derive(Serialize)]
struct Course {
    variant: usize,
    situation: usize,
    svg: String,
}

/// The table of the samples.
#[derive(Serialize)]
struct Sampled {
    title: String,
    text: String,
    headings: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Sampled {
    fn of(samples: &[Sample]) -> Self {
        let (text, table) = samples_table(samples);
        Self {
            title: SAMPLES.into(),
            text: text.replace('`', ""),
            headings: table.headings().to_vec(),
            rows: table.filled(),
        }
    }
}

/// Prepares a report for the page.
pub fn view(report: &Report) -> View<'_> {
    let looks = variants::Looks::of(&report.variants);
    View {
        scene: &report.scene,
        summary: &report.summary,
        facts: &report.facts,
        notes: &report.notes,
        tiles: tiles::tiles(report),
        costs: Costs::named(&report.variants, &report.variants),
        rows: variants::rows(&report.variants, &looks.each),
        sampled: (!report.samples.is_empty()).then(|| Sampled::of(&report.samples)),
        courses: courses(&report.trajectories),
        budgets: report.budgets.iter().map(tables::verdict).collect(),
    }
}

fn courses(trajectories: &[Trajectory]) -> Courses {
    let (drawn, stretches) = fineness(trajectories.len());
    let shown = &trajectories[..drawn];
    let variants = names(shown.iter().map(|trajectory| trajectory.variant.clone()));
    let situations = names(shown.iter().map(|trajectory| trajectory.situation.clone()));
    let plot = |trajectory: &Trajectory| Course {
        variant: index_of(&variants, &trajectory.variant),
        situation: index_of(&situations, &trajectory.situation),
        svg: chart::course(trajectory, stretches),
    };
    let plots = shown.iter().map(plot).collect();
    Courses { variants, situations, plots, left_out: trajectories.len() - drawn }
}
