//! The generator sets: verdicts by the standards, and a fault on every input.

use super::Section;
use crate::generator::page::{diesel, faults, steps, trips, turbine};
use crate::survey::{GENERATOR, Survey};

/// The sets.
pub fn section(survey: &Survey) -> Section {
    let section =
        Section::new("Gensets and their governor", "In QEMU against their full plants.").failed(survey, GENERATOR);
    let Some(verdicts) = &survey.generator else { return section };
    let section = section
        .table("Diesel set against ISO 8528-5", "", &diesel(verdicts))
        .table("Turbine set against NEMA SM 23", "", &turbine(verdicts))
        .table("Every load step", "", &steps(verdicts));
    if verdicts.faults.is_empty() {
        return section;
    }
    let text = "On the diesel at half load. Torques are of rated.";
    section.table("A fault on every input of the governor", text, &faults(verdicts)).table(
        "Every trip of the governor, brought about",
        "On the diesel. Each stands with its reason, the cause gone, until it is reset.",
        &trips(verdicts),
    )
}
