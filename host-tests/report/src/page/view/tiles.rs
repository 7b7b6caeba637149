//! The figures that stand at the head of the page.

use serde::Serialize;

use crate::format::{grouped, percent};
use crate::report::Report;
use crate::results::Deviation;

/// A figure with its name.
#[derive(Serialize)]
pub struct Tile {
    name: &'static str,
    value: String,
    detail: String,
    bad: bool,
}

/// The best variant's figures, whether target and host agree, whether the budgets are kept.
pub fn tiles(report: &Report) -> Vec<Tile> {
    let mut tiles = Vec::new();
    let best = report.variants.iter().filter(|variant| variant.shaft_torque.rms.is_finite());
    if let Some(best) = best.min_by(|a, b| a.shaft_torque.rms.total_cmp(&b.shaft_torque.rms)) {
        let figure = |name, deviation: Deviation| Tile {
            name,
            value: percent(deviation.rms),
            detail: format!("rms, {} at worst", percent(deviation.max)),
            bad: false,
        };
        tiles.push(figure("Shaft torque error", best.shaft_torque));
        tiles.push(figure("Load speed error", best.load_speed));
        tiles.push(Tile {
            name: "Instructions a tick",
            value: grouped(best.instructions.median as i64),
            detail: format!("at most {} in the run", grouped(best.instructions.max as i64)),
            bad: false,
        });
        tiles.push(Tile {
            name: "Tick in flash",
            value: format!("{} B", grouped(best.flash_bytes as i64)),
            detail: format!("{} B RAM, {} B stack", grouped(best.ram_bytes as i64), grouped(best.stack_bytes as i64)),
            bad: false,
        });
    }
    if !report.variants.is_empty() {
        let exact = report.variants.iter().filter(|variant| variant.bit_exact).count();
        let ticks: u64 = report.variants.iter().map(|variant| variant.ticks).sum();
        tiles.push(Tile {
            name: "Host and target agree",
            value: format!("{exact} of {}", report.variants.len()),
            detail: format!("bit for bit, {} ticks", grouped(ticks as i64)),
            bad: exact < report.variants.len(),
        });
    }
    if !report.budgets.is_empty() {
        let kept = report.budgets.iter().filter(|budget| budget.kept()).count();
        let all = report.budgets.len();
        let detail = if kept == all { "all kept".to_owned() } else { format!("{} exceeded", all - kept) };
        tiles.push(Tile { name: "Budgets", value: format!("{kept} of {all}"), detail, bad: kept < all });
    }
    tiles
}
