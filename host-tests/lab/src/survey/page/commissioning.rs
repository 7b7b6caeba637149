//! The machines that were commissioned: what the test found beside what is true.

use super::{Section, kept};
use crate::commissioning::Verdict;
use crate::survey::{COMMISSIONING, Survey};
use driveline_report::Table;
use driveline_report::format::{grouped, percent};

/// Every machine in a row, and each with all its figures.
pub fn section(survey: &Survey) -> Section {
    let text = "The test finds the machine from the motor's angle and its own torque, on the full plant, with 1 % of \
                noise in the torque. True are the two masses that have the plant's first resonance, first \
                antiresonance and total inertia.";
    let mut section = Section::new("Commissioning", text).failed(survey, COMMISSIONING);
    if survey.commissioned.is_empty() {
        return section;
    }
    let text = "Aims: resonance and antiresonance within 1 %, inertias (the worst of three) within 3 %, the gap within \
                5 %, the shaft's torque below half of rated. Instructions are those of the longest tick, RAM is static \
                memory and stack, the solving included.";
    section = section.table("Beside the aims", text, &overview(&survey.commissioned));
    for verdict in &survey.commissioned {
        section = section.table(&verdict.machine, &said(verdict), &verdict.table());
    }
    section
}

/// Where a machine was commissioned, and what was said of it.
fn said(verdict: &Verdict) -> String {
    let mut sentences = verdict.sentences();
    if verdict.target.is_none() {
        sentences.push(
            "on the host, since QEMU would take longer than a minute or only a quick run was requested: \
             `cargo lab commissioning --qemu` has it there"
                .to_owned(),
        );
    }
    format!("{}.", sentences.join("; "))
}

fn overview(verdicts: &[Verdict]) -> Table {
    let mut table = Table::new([
        "machine",
        "where",
        "resonance",
        "antiresonance",
        "inertias",
        "gap",
        "shaft torque of rated",
        "instructions",
        "RAM",
        "bits",
        "",
    ]);
    for verdict in verdicts {
        let error = |names: &[&str]| {
            let rows = verdict.figures.iter().filter(|row| row.aim.is_some());
            let rows = rows.filter(|row| names.iter().any(|name| row.name.starts_with(name)));
            let worst = rows.filter_map(|row| row.error).max_by(|a, b| a.abs().total_cmp(&b.abs()));
            worst.map_or_else(String::new, percent)
        };
        let target = verdict.target.as_ref();
        let of_target = |of: fn(&crate::commissioning::Target) -> String| target.map_or_else(String::new, of);
        table.row([
            verdict.machine.clone(),
            if target.is_some() { "QEMU" } else { "host" }.to_owned(),
            error(&["resonance"]),
            error(&["antiresonance"]),
            error(&["total inertia", "motor's inertia", "load's inertia"]),
            error(&["gap"]),
            percent(verdict.peak),
            of_target(|target| grouped(target.instructions[2] as i64)),
            of_target(|target| grouped((target.bytes[1] + target.bytes[2]) as i64)),
            of_target(|target| if target.bit_exact { "equal" } else { "differ" }.to_owned()),
            kept(verdict.meets()).to_owned(),
        ]);
    }
    table
}
