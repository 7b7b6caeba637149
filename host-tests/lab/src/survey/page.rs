//! The page of `report` in Markdown: every scene, every variant and every stiff case, with verdicts.

mod balancing;
mod cases;
mod commissioning;
mod factors;
mod generator;
mod markdown;
mod scenes;
mod section;

use section::{Section, kept};

use crate::survey::Survey;
use driveline_report::{SAMPLES, Table, samples_table};

/// Content and limits of the page.
fn summary(survey: &Survey) -> String {
    let whole = "Every scene in all its variants in QEMU, tick by tick against the full solver of its machine; and \
        every stiff or extreme case beside its reference.";
    let part = "The selected scenes in all their variants in QEMU, tick by tick against the full solver of the \
        machine.";
    let quick = " A quick run: two seconds of each drivetrain, unproven. Not for figures to quote.";
    format!("{}{}", if survey.part { part } else { whole }, if survey.quick { quick } else { "" })
}

/// The chosen drives on machines within their tolerances.
fn real(survey: &Survey) -> Section {
    let (text, table) = samples_table(&survey.samples);
    let section = Section::new(SAMPLES, &text);
    if survey.samples.is_empty() { section } else { section.table("", "", &table) }
}

/// Facts and tables in Markdown, as a page of the book.
pub fn survey_markdown(survey: &Survey) -> String {
    let mut sections = vec![real(survey), scenes::overview(survey)];
    sections.extend(survey.scenes.iter().map(|scene| scenes::section(survey, scene)));
    sections.extend([
        factors::section(survey),
        cases::section(survey),
        generator::section(survey),
        balancing::section(survey),
        commissioning::section(survey),
    ]);
    sections.retain(|section| !section.is_empty());
    markdown::page(&summary(survey), &scenes::facts(survey), &sections)
}

/// The table of all scenes beside their aims, for the terminal.
pub fn survey_table(survey: &Survey) -> Table {
    scenes::overview_table(survey)
}
