//! Results of balancing a scene, as tables.

use super::outcome::{Outcome, Vector};
use super::scene::Ran;
use driveline_report::format::significant;
use driveline_report::{Section, Table};

/// The tables as title, explanation and table.
pub fn tables(ran: &[Ran]) -> Vec<Section> {
    let mut claims = Table::new(["variant", "what", "measured", "at most", ""]);
    for ran in ran {
        for claim in &ran.outcome.claims {
            let verdict = if claim.holds() { "kept" } else { "missed" };
            let numbers = [claim.measured, claim.limit].map(significant);
            claims
                .row([ran.variant.clone(), claim.name.clone()].into_iter().chain(numbers).chain([verdict.to_owned()]));
        }
    }
    let text = "By the full solver, from the weights as they were set.";
    let mut all = vec![Section::new("Criterion", text, claims)];
    let mut costs = Table::new([
        "variant",
        "instructions mean",
        "at most",
        "stack",
        "flash of the image",
        "RAM of the image",
        "readings refused",
        "time s",
        "ticks same on the host",
    ]);
    for ran in ran {
        let (most, mean) = ran.cost.instructions;
        costs.row([
            ran.variant.clone(),
            format!("{mean:.1}"),
            most.to_string(),
            ran.cost.stack.to_string(),
            ran.cost.flash.to_string(),
            ran.cost.ram.to_string(),
            ran.outcome.doubts.len().to_string(),
            format!("{:.1}", ran.outcome.time),
            if ran.same_on_host { "yes" } else { "no" }.to_owned(),
        ]);
    }
    let text = "A tick of drive, measurement and link words in QEMU; the panel works between ticks and is not counted. \
        Stack and sizes \
                hold drive, measurement and panel.";
    all.push(Section::new("Cost", text, costs));
    if let Some(first) = ran.first() {
        all.push(stages(&first.outcome));
    }
    all
}

fn stages(outcome: &Outcome) -> Section {
    let planes = outcome.stages.first().map_or(0, |stage| stage.unbalance.len());
    let unbalance = (0..planes).map(|plane| format!("plane {} g mm", plane + 1));
    let rows = outcome.rows.iter().map(|row| format!("{row} µm"));
    let headings = ["stage".to_owned(), "at s".to_owned(), outcome.measure.clone()];
    let mut table = Table::new(headings.into_iter().chain(unbalance).chain(rows));
    let polar = |vector: &Vector, scale: f64| format!("{} ∠ {:.0}°", significant(vector.size * scale), vector.angle);
    for stage in &outcome.stages {
        let start = [stage.name.clone(), format!("{:.1}", stage.time), significant(stage.measure)];
        // 1 kg m is 1e6 g mm
        let unbalance = stage.unbalance.iter().map(|vector| polar(vector, 1e6));
        let vibration = stage.vibration.iter().map(|vector| polar(vector, 1e6));
        table.row(start.into_iter().chain(unbalance).chain(vibration));
    }
    let text = "Unbalance and displacement by the full solver, sizes with angles, of the first variant.";
    Section::new("Stage by stage", text, table)
}
