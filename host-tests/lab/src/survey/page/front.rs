//! Error against cost over all scenes, and what is on the front.

use super::Section;
use crate::survey::Survey;
use driveline_report::chart;
use driveline_report::format::{grouped, percent};
use driveline_report::{Table, Variant};

/// Every variant, with its scene before its observer.
fn named(survey: &Survey) -> Vec<Variant> {
    let name = |scene: &str, variant: &Variant| Variant {
        observer: format!("{scene} {}", variant.observer),
        ..variant.clone()
    };
    let scenes = survey.scenes.iter();
    scenes.flat_map(|scene| scene.runs.iter().map(|run| name(&scene.name, &run.variant))).collect()
}

/// Members of the front.
pub fn section(survey: &Survey) -> Section {
    let variants = named(survey);
    let mut section = Section::new("On the front", "The variants that no other of any scene beats in both.");
    if variants.is_empty() {
        return section;
    }
    let torque = variants.iter().map(|variant| variant.shaft_torque.rms).collect();
    let speed = variants.iter().map(|variant| variant.load_speed.rms).collect();
    for (name, errors) in [("shaft torque", torque), ("load speed", speed)] {
        let errors: Vec<f64> = errors;
        let costs = variants.iter().map(|variant| variant.instructions.median as f64);
        let points: Vec<(f64, f64)> = costs.zip(errors.iter().copied()).collect();
        let mut table = Table::new(["variant", "instructions a tick", "rms error"]);
        for index in chart::front(&points) {
            let variant = &variants[index];
            table.row([variant.label(), grouped(variant.instructions.median as i64), percent(errors[index])]);
        }
        section = section.table(name, "", &table);
    }
    section
}
