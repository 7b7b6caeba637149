//! The comparison as a page of the book.

use std::fmt::Write;

use super::comparison::{Accuracy, Comparison, Observer};
use super::count::CORES;
use driveline_report::Table;
use driveline_report::format::percent;

/// The text above the tables. It has no measured figure and no winner: those are in the tables.
const OPENING: &str = include_str!("opening.md");

/// The page, its tables in Markdown.
pub fn peers_markdown(comparison: &Comparison) -> String {
    let mut page = OPENING.to_owned();
    let _ = writeln!(page, "\nMeasured on {}.\n", comparison.measured);
    let _ = writeln!(page, "## The fronts\n\n{}", fronts(comparison).markdown());
    for scene in &comparison.scenes {
        let heading = format!("## {}, {} ticks at {} Hz", scene.scene, scene.ticks, scene.rate_hz);
        let _ = writeln!(page, "{heading}\n\n{}", scene.table().markdown());
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
        "drawn: best of the library",
        "best of the others",
        "others that win",
        "cheaper than the library",
    ]);
    let runs: [fn(&Observer) -> Accuracy; 2] = [|observer| observer.own, |observer| observer.drawn];
    for scene in &comparison.scenes {
        for core in CORES {
            let mut row = vec![scene.scene.clone(), core.to_owned()];
            let names = |names: Vec<&str>| if names.is_empty() { "none".to_owned() } else { names.join("; ") };
            for of in runs {
                row.extend([true, false].map(|library| {
                    let all = scene.on(core).filter(|(observer, _)| observer.library == library);
                    let least = all.min_by(|(a, cost), (b, than)| {
                        of(a).shaft_torque.total_cmp(&of(b).shaft_torque).then(cost.median.cmp(&than.median))
                    });
                    least.map_or_else(String::new, |(observer, cost)| {
                        format!("{}: {}, {}", observer.name, percent(of(observer).shaft_torque), cost.median)
                    })
                }));
                row.push(names(scene.winners(core, of)));
            }
            row.push(names(scene.cheaper(core)));
            table.row(row);
        }
    }
    table
}
