//! The comparison as a page of the book.

use std::fmt::Write;

use super::comparison::{CORES, Comparison};
use driveline_report::Table;
use driveline_report::format::percent;

/// What stands above the tables.
const OPENING: &str = include_str!("opening.md");

/// The page, its tables in Markdown.
pub fn peers_markdown(comparison: &Comparison) -> String {
    let mut page = OPENING.to_owned();
    let _ = writeln!(page, "\n## The fronts\n\n{}", rows(&fronts(comparison)));
    for scene in &comparison.scenes {
        let heading = format!("## {}, {} ticks at {} Hz", scene.scene, scene.ticks, scene.rate_hz);
        let _ = writeln!(page, "{heading}\n\n{}", rows(&scene.table()));
    }
    page.truncate(page.trim_end().len());
    page.push('\n');
    page
}

/// A row a scene and a core: the library's best, the best of the others, and who wins.
pub fn fronts(comparison: &Comparison) -> Table {
    let mut table = Table::new([
        "scene",
        "core",
        "best of the library",
        "best of the others",
        "others that win",
        "cheaper than the library",
    ]);
    for scene in &comparison.scenes {
        for core in CORES {
            let best = |library: bool| {
                let all = scene.on(core).filter(|(observer, _)| observer.library == library);
                let least = all.min_by(|(a, of), (b, than)| {
                    a.shaft_torque.total_cmp(&b.shaft_torque).then(of.median.cmp(&than.median))
                });
                least.map_or_else(String::new, |(observer, cost)| {
                    format!("{}: {}, {}", observer.name, percent(observer.shaft_torque), cost.median)
                })
            };
            let names = |names: Vec<&str>| if names.is_empty() { "none".to_owned() } else { names.join("; ") };
            let [winners, cheaper] = [scene.winners(core), scene.cheaper(core)].map(names);
            table.row([scene.scene.clone(), core.to_owned(), best(true), best(false), winners, cheaper]);
        }
    }
    table
}

fn rows(table: &Table) -> String {
    let mut text = String::new();
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    text.push_str(&line(table.headings()));
    text.push_str(&format!("|{}\n", "---|".repeat(table.headings().len())));
    table.filled().iter().for_each(|row| text.push_str(&line(row)));
    text
}
