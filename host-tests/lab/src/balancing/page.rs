//! Results of balancing a scene, as tables and as a page.

use super::outcome::{Outcome, Stage, Vector};
use super::scene::{Ran, Scene};
use driveline_report::chart::{Arrow, Curve, Lines, polar};
use driveline_report::format::significant;
use driveline_report::{Arrangement, Fact, Figure, Key, Section, Sheet, Table};

/// The tables as title, explanation and table: for the terminal and the page alike.
#[must_use]
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

/// The page as HTML.
#[must_use]
pub fn page(scene: &Scene, ran: &[Ran]) -> String {
    let mut sheet = Sheet {
        name: scene.name.to_owned(),
        kicker: "balanced in QEMU, in closed loop".to_owned(),
        summary: scene.summary.to_owned(),
        tables: tables(ran),
        ..Sheet::default()
    };
    let Some(first) = ran.first() else { return sheet.page() };
    let outcome = &first.outcome;
    sheet.facts = vec![
        Fact { name: "shown".to_owned(), value: first.variant.clone() },
        Fact { name: "stages".to_owned(), value: outcome.stages.len().to_string() },
        Fact { name: "time at the machine".to_owned(), value: format!("{:.0} s", outcome.time) },
        Fact { name: "readings refused".to_owned(), value: outcome.doubts.len().to_string() },
    ];
    let legend: Vec<Key> =
        outcome.stages.iter().enumerate().map(|(index, stage)| Key::curve(&*stage.name, class(index))).collect();
    let rows = outcome.rows.iter().enumerate();
    let vibration = rows.map(|(row, name)| plot(name, "µm", outcome, |stage| stage.vibration.get(row).copied()));
    sheet.figures.push(Figure {
        title: "Vibration, stage by stage".to_owned(),
        text: "Steady displacement of each sensor by the full solver; angles from the rotor's zero.".to_owned(),
        legend: legend.clone(),
        plots: vibration.collect(),
        arrangement: Arrangement::Beside,
    });
    let planes = outcome.stages.first().map_or(0, |stage| stage.unbalance.len());
    let unbalance = (0..planes).map(|plane| {
        plot(&format!("plane {}", plane + 1), "g mm", outcome, |stage| stage.unbalance.get(plane).copied())
    });
    sheet.figures.push(Figure {
        title: "Unbalance, stage by stage".to_owned(),
        text: "Residual in each plane.".to_owned(),
        legend: legend.clone(),
        plots: unbalance.collect(),
        arrangement: Arrangement::Beside,
    });
    sheet.figures.push(over_speed(outcome, legend));
    sheet.page()
}

const fn class(index: usize) -> &'static str {
    ["s0", "s1", "s2", "s3", "s4", "s5"][index % 6]
}

fn plot(title: &str, unit: &str, outcome: &Outcome, of: impl Fn(&Stage) -> Option<Vector>) -> String {
    let arrow = |(index, stage): (usize, &Stage)| {
        let vector = of(stage)?;
        // m to µm and kg m to g mm alike
        let amplitude = vector.size * 1e6;
        Some(Arrow { class: class(index), name: stage.name.clone(), amplitude, degrees: vector.angle })
    };
    let arrows: Vec<Arrow> = outcome.stages.iter().enumerate().filter_map(arrow).collect();
    polar(title, unit, &arrows)
}

fn over_speed(outcome: &Outcome, legend: Vec<Key>) -> Figure {
    let (speeds, amplitudes) = &outcome.over_speed;
    let curve = |(index, amplitudes): (usize, &Vec<f64>)| Curve {
        class: class(index).to_owned(),
        values: amplitudes.iter().map(|amplitude| amplitude * 1e6).collect(),
    };
    let lines = Lines {
        label: "Amplitude over the speed".to_owned(),
        along: "speed, r/min".to_owned(),
        across: "largest amplitude, µm".to_owned(),
        places: speeds.iter().map(|speed| speed * 30.0 / std::f64::consts::PI).collect(),
        curves: amplitudes.iter().enumerate().map(curve).collect(),
        logarithmic: true,
        ..Lines::default()
    };
    Figure {
        title: "Amplitude over the speed".to_owned(),
        text: "The larger of the sensors' displacements, steady at each speed.".to_owned(),
        legend,
        plots: vec![lines.draw()],
        ..Figure::default()
    }
}
