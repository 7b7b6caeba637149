//! Flash and RAM, scene by scene.

use super::Section;
use crate::survey::{Run, Survey};
use driveline_report::Table;
use driveline_report::format::{grouped, rate};

/// The observer of one mass, as variants are named.
const RIGID: &str = "rigid";

/// The smallest by flash of all variants of a number on a core.
fn smallest<'s>(survey: &'s Survey, number: &str, core: &str) -> Option<(&'s str, &'s Run)> {
    let all = survey.scenes.iter().flat_map(|scene| scene.runs.iter().map(|run| (scene.name.as_str(), run)));
    let like = all.filter(|(_, run)| run.variant.number == number && run.variant.core == core);
    like.min_by_key(|(_, run)| run.variant.flash_bytes)
}

/// Flash and RAM of the chosen variants, and the smallest of each scene.
pub fn section(survey: &Survey) -> Section {
    let mut table = Table::new([
        "scene",
        "number",
        "core",
        "chosen",
        "flash",
        "of it a tick's code",
        "RAM",
        "smallest",
        "flash",
        "RAM",
        "rigid is smallest",
    ]);
    for scene in &survey.scenes {
        let smallest = scene.smallest();
        for run in scene.chosen() {
            let variant = &run.variant;
            let like = |other: &&&Run| {
                let other = &other.variant;
                (&other.number, &other.core, other.rate_hz) == (&variant.number, &variant.core, variant.rate_hz)
            };
            let least = smallest.iter().find(like).map(|run| &run.variant);
            let has_rigid = scene.runs.iter().any(|run| run.variant.observer == RIGID);
            let is = least.is_some_and(|least| least.observer == RIGID);
            table.row([
                scene.name.clone(),
                variant.number.clone(),
                variant.core.clone(),
                format!("{} {}", variant.observer, rate(variant.rate_hz)),
                grouped(variant.flash_bytes as i64),
                grouped(run.tick_code as i64),
                grouped(variant.ram_bytes as i64),
                least.map_or_else(String::new, |least| least.observer.clone()),
                least.map_or_else(String::new, |least| grouped(least.flash_bytes as i64)),
                least.map_or_else(String::new, |least| grouped(least.ram_bytes as i64)),
                if !has_rigid { "none has one mass" } else { super::kept(is) }.to_owned(),
            ]);
        }
    }
    let mut of_all = Table::new(["number", "core", "smallest of all", "flash", "RAM", "it is rigid"]);
    for (number, core) in [("f32", "m4f"), ("fixed", "m4f"), ("fixed", "m3")] {
        if let Some((scene, run)) = smallest(survey, number, core) {
            let variant = &run.variant;
            of_all.row([
                number.to_owned(),
                core.to_owned(),
                format!("{scene} {} {}", variant.observer, rate(variant.rate_hz)),
                grouped(variant.flash_bytes as i64),
                grouped(variant.ram_bytes as i64),
                super::kept(variant.observer == RIGID).to_owned(),
            ]);
        }
    }
    let text = "Bytes of the image with the drive less those of the image without one; a tick's code is that of every \
        function that it reaches.";
    let section = Section::new("Flash and RAM", text);
    if survey.scenes.is_empty() { section } else { section.table("", "", &table).table("The smallest", "", &of_all) }
}
