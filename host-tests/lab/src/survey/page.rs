//! The page of `report`: every scene, every variant and every stiff case, with verdicts.

mod balancing;
mod cases;
mod commissioning;
mod factors;
mod front;
mod generator;
mod markdown;
mod scenes;
mod section;
mod sizes;

use section::{Section, kept};
use serde::Serialize;

use crate::survey::{Survey, adapters};
use driveline_report::page::fill;
use driveline_report::page::view::{Costs, Sweeps};
use driveline_report::{Fact, SAMPLES, Table, samples_table};

#[derive(Serialize)]
struct View {
    summary: String,
    facts: Vec<Fact>,
    front: Costs,
    before: Vec<Section>,
    scenes: Vec<Section>,
    after: Vec<Section>,
    sweeps: Sweeps,
    last: Vec<Section>,
}

/// Content and limits of the page.
fn summary(survey: &Survey) -> String {
    let whole = "Every scene in all its variants in QEMU, tick by tick against the full solver of its machine; and \
        every stiff or extreme case \
                 beside its reference.";
    let part = "The selected scenes in all their variants in QEMU, tick by tick against the full solver of the \
        machine.";
    let quick = " A quick run: two seconds of each drivetrain, unproven. Not for figures to quote.";
    format!("{}{}", if survey.part { part } else { whole }, if survey.quick { quick } else { "" })
}

/// The sections that have something to show, by their place on the page.
struct Sections {
    before: Vec<Section>,
    scenes: Vec<Section>,
    after: Vec<Section>,
    last: Vec<Section>,
}

impl Sections {
    fn of(survey: &Survey) -> Self {
        let shown = |all: Vec<Section>| all.into_iter().filter(|section| !section.is_empty()).collect();
        Self {
            before: shown(vec![real(survey), scenes::overview(survey), front::section(survey)]),
            scenes: survey.scenes.iter().map(|scene| scenes::section(survey, scene)).collect(),
            after: shown(vec![
                sizes::section(survey),
                factors::section(survey),
                cases::section(survey),
                cases::reversals(survey),
            ]),
            last: shown(vec![
                cases::sweep_failures(survey),
                generator::section(survey),
                balancing::section(survey),
                commissioning::section(survey),
            ]),
        }
    }
}

/// The chosen drives on machines within their tolerances.
fn real(survey: &Survey) -> Section {
    let (text, table) = samples_table(&survey.samples);
    let section = Section::new(SAMPLES, &text);
    if survey.samples.is_empty() { section } else { section.table("", "", &table) }
}

/// The facts and tables of the page in Markdown, as a page of the book.
pub fn survey_markdown(survey: &Survey) -> String {
    let Sections { before, scenes, after, last } = Sections::of(survey);
    let sections: Vec<Section> = before.into_iter().chain(scenes).chain(after).chain(last).collect();
    markdown::page(&summary(survey), &scenes::facts(survey), &sections)
}

/// The page as HTML, one file.
pub fn survey_page(survey: &Survey) -> String {
    let Sections { before, scenes, after, mut last } = Sections::of(survey);
    if let Ok(table) = adapters() {
        let text = "From doc/adapters.md, which a test writes from runs on mocked buses and compares ever since.";
        last.push(Section::new("Every fault of every adapter", text).table("", "", &table));
    }
    let (facts, front, sweeps) = (scenes::facts(survey), front::costs(survey), Sweeps::of(&survey.sweeps));
    fill("survey.html", View { summary: summary(survey), facts, front, before, scenes, after, sweeps, last })
}

/// The table of all scenes beside their aims, for the terminal.
pub fn survey_table(survey: &Survey) -> Table {
    scenes::overview_table(survey)
}
