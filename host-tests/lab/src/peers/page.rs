//! The page of `peers`: for each scene error against instructions on both cores, and the table.

use super::comparison::{Comparison, Observer, SceneComparison};
use super::count::CORES;
use super::markdown::{beside_observers, fronts};
use driveline_report::chart::{Cost, Quality, error_against_cost};
use driveline_report::{Arrangement, Deviation, Figure, Instructions, Key, Section, Sheet, Variant};

/// The page as HTML, one file.
pub fn peers_page(comparison: &Comparison) -> String {
    let legend = [Key::curve("the library", "s0"), Key::curve("others", "s1")];
    let mut tables = vec![Section::new(
        "The fronts",
        "Of the library and of the others the observer with the least error of the shaft torque, with its \
         instructions; others that win have an error smaller by 1 % than all of the library's at no more instructions.",
        fronts(comparison),
    )];
    tables.extend(comparison.scenes.iter().map(|scene| Section::new(scene.scene.clone(), "", scene.table())));
    tables.extend(beside_observers(comparison).map(|(opening, table)| {
        let (heading, text) = opening.split_once('\n').unwrap_or((opening, ""));
        Section::new(heading.trim_start_matches("## "), text.trim().replace('`', ""), table)
    }));
    Sheet {
        name: "Peers".to_owned(),
        kicker: "other observers".to_owned(),
        summary:
            "The library's observers beside others on the signals of the scenes' own runs. Errors are computed on \
            the host, cost is counted in QEMU: a step with its estimates."
                .to_owned(),
        facts: Vec::new(),
        figures: comparison
            .scenes
            .iter()
            .map(|scene| Figure {
                title: scene.scene.clone(),
                text: "Error of the shaft torque against instructions of a step, M4F and M3.".to_owned(),
                legend: legend.to_vec(),
                plots: CORES.iter().map(|core| plot(scene, core)).collect(),
                arrangement: Arrangement::Beside,
            })
            .collect(),
        tables,
    }
    .page()
}

fn plot(scene: &SceneComparison, core: &str) -> String {
    let deviation = |rms: f64| Deviation { rms, max: rms };
    let name = |observer: &Observer| observer.name.replace("driveline ", "");
    let variants: Vec<Variant> = scene
        .on(core)
        .map(|(observer, cost)| Variant {
            number: String::new(),
            core: core.to_owned(),
            observer: name(observer),
            rate_hz: scene.rate_hz,
            shaft_torque: deviation(observer.own.shaft_torque),
            load_speed: deviation(observer.own.load_speed),
            load_torque: deviation(0.0),
            instructions: Instructions { min: cost.median.into(), median: cost.median.into(), max: cost.worst.into() },
            cycles: None,
            flash_bytes: cost.code,
            ram_bytes: cost.state.into(),
            stack_bytes: cost.stack.into(),
            bit_exact: true,
            ticks: scene.ticks as u64,
        })
        .collect();
    let look: Vec<(usize, usize)> =
        scene.on(core).map(|(observer, _)| if observer.library { (0, 0) } else { (1, 1) }).collect();
    error_against_cost(&variants, &look, Cost::Tick, Quality::ShaftTorque)
}
