//! The scenes: all of them beside their aims, and each in all its variants.

use super::{Section, kept};
use crate::survey::{Run, SceneFigures, Survey};
use driveline_report::format::{grouped, percent, rate, significant};
use driveline_report::{Fact, Table};

/// Scope of the survey.
pub fn facts(survey: &Survey) -> Vec<Fact> {
    let fact = |name: &str, value: String| Fact { name: name.to_owned(), value };
    let chosen = || survey.scenes.iter().flat_map(|scene| scene.chosen().map(move |run| (scene, run)));
    let runs = || survey.scenes.iter().flat_map(|scene| &scene.runs);
    let keep = chosen().filter(|(scene, run)| scene.aim.kept(&run.variant)).count();
    let equal = runs().filter(|run| run.variant.bit_exact).count();
    let cases = survey.cases.iter().filter(|case| case.holds()).count();
    vec![
        fact("drivetrains", survey.scenes.len().to_string()),
        fact("variants in closed loop", runs().count().to_string()),
        fact("chosen variants within their aims", format!("{keep} of {}", chosen().count())),
        fact("same bits on host and target", format!("{equal} of {}", runs().count())),
        fact("cases within tolerance", format!("{cases} of {}", survey.cases.len())),
        fact(
            "machines commissioned within the aims",
            format!(
                "{} of {}",
                survey.commissioned.iter().filter(|one| one.meets()).count(),
                survey.commissioned.len()
            ),
        ),
        fact("jobs that failed", survey.failures.len().to_string()),
        fact("measured", survey.measured.clone()),
        fact("time that it took", {
            let seconds = survey.seconds.round() as u64;
            format!("{} min {:02} s", seconds / 60, seconds % 60)
        }),
    ]
}

/// A scene a row: the worst of its chosen variants.
pub fn overview_table(survey: &Survey) -> Table {
    let mut table = Table::new([
        "scene",
        "chosen",
        "shaft torque rms",
        "aim",
        "",
        "load speed rms",
        "aim",
        "",
        "instructions at most, M4F f32",
        "M3 fixed",
        "K",
        "bits",
    ]);
    for scene in &survey.scenes {
        let failed = survey.failures_in(&scene.name).count();
        let bits = match (scene.runs.iter().all(|run| run.variant.bit_exact), failed, scene.runs.is_empty()) {
            (.., true) => "not run".to_owned(),
            (true, 0, _) => "equal".to_owned(),
            (true, count, _) => format!("equal, {count} failed"),
            (false, ..) => "differ".to_owned(),
        };
        let mut row = vec![scene.name.clone()];
        // A value that is not a number is worse than any.
        let worse = |a: f64, b: f64| if a.is_nan() || b <= a { a } else { b };
        let worst = |of: fn(&Run) -> f64| scene.chosen().map(of).reduce(worse).unwrap_or(f64::NAN);
        let (torque, speed) = (worst(|run| run.variant.shaft_torque.rms), worst(|run| run.variant.load_speed.rms));
        let Some(first) = scene.chosen().next() else {
            row.extend(["failed".to_owned()]);
            row.extend((0..9).map(|_| String::new()));
            row.push(bits);
            table.row(row);
            continue;
        };
        row.push(format!("{} {}", first.variant.observer, rate(first.variant.rate_hz)));
        row.extend([
            percent(torque),
            percent(scene.aim.shaft_torque),
            kept(torque <= scene.aim.shaft_torque).to_owned(),
        ]);
        row.push(percent(speed));
        match scene.aim.load_speed {
            Some(aim) => row.extend([percent(aim), kept(speed <= aim).to_owned()]),
            None => row.extend([String::new(), String::new()]),
        }
        for (number, core) in [("f32", "m4f"), ("fixed", "m3")] {
            let found = scene.chosen().find(|run| run.variant.number == number && run.variant.core == core);
            row.push(found.map_or_else(String::new, |run| grouped(run.variant.instructions.max as i64)));
        }
        row.push(first.factor().k().map_or_else(String::new, significant));
        row.push(bits);
        table.row(row);
    }
    table
}

/// All scenes beside their aims.
pub fn overview(survey: &Survey) -> Section {
    let text = "Of each scene the design's chosen observer, the worst of its numbers and cores. Aims: with a tight \
        shaft the shaft torque within 2 % \
                rms of its peak and the load's speed within 0.3 % of rated; through backlash the shaft torque within \
                6 %. K is the peak of the \
                shaft torque over what a rigid machine's shaft would carry.";
    let section = Section::new("Beside the aims", text);
    if survey.scenes.is_empty() { section } else { section.table("", "", &overview_table(survey)) }
}

/// One scene in all its variants, and why it misses.
pub fn section(survey: &Survey, scene: &SceneFigures) -> Section {
    let mut table = Table::new([
        "variant",
        "",
        "shaft torque rms",
        "max",
        "over aim",
        "load speed rms",
        "max",
        "over aim",
        "instructions med",
        "max",
        "flash",
        "RAM",
        "stack",
        "peak N m",
        "K",
        "bits",
    ]);
    for run in &scene.runs {
        let variant = &run.variant;
        let torque = scene.aim.torque_missed(variant);
        let over = |missed: f64| {
            if missed <= 0.0 { "kept".to_owned() } else { format!("missed by {}", percent(missed)) }
        };
        table.row([
            variant.label(),
            if run.chosen { "chosen" } else { "" }.to_owned(),
            percent(variant.shaft_torque.rms),
            percent(variant.shaft_torque.max),
            over(torque),
            percent(variant.load_speed.rms),
            percent(variant.load_speed.max),
            scene.aim.speed_missed(variant).map_or_else(String::new, over),
            grouped(variant.instructions.median as i64),
            grouped(variant.instructions.max as i64),
            grouped(variant.flash_bytes as i64),
            grouped(variant.ram_bytes as i64),
            grouped(variant.stack_bytes as i64),
            significant(run.factor().peak),
            run.factor().k().map_or_else(String::new, significant),
            if variant.bit_exact { "equal" } else { "differ" }.to_owned(),
        ]);
    }
    let mut section = Section::new(&scene.name, &scene.summary).failed(survey, &scene.name);
    if !scene.runs.is_empty() {
        section = section.table("", "", &table);
    }
    section
}
