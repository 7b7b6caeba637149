//! Every scene at one go: what its variants come to beside what is aimed at, as a page of the book.

use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use serde::Serialize;

use crate::balancing::{self, Ran, tables};
use crate::candidates::candidates;
use crate::drivetrains::engine::{self, Options};
use crate::drivetrains::{Build, SCENES};
use driveline_closed_loop::lockstep::Trace;
use driveline_closed_loop::scenario::Machine;
use driveline_report::format::{grouped, percent, rate};
use driveline_report::{Table, Variant};

/// Root mean square errors that are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Aim {
    /// Of the shaft torque, over its peak.
    pub shaft_torque: f64,
    /// Of the load's speed, over rated; none through backlash.
    pub load_speed: Option<f64>,
}

impl Aim {
    /// With a tight shaft.
    pub const TIGHT: Self = Self {
        shaft_torque: driveline::design::Requirement::USUAL.shaft_torque,
        load_speed: Some(driveline::design::Requirement::USUAL.load_speed),
    };
    /// Through backlash.
    pub const BACKLASH: Self = Self { shaft_torque: 0.06, load_speed: None };

    /// Of a machine in its runs: through backlash where a plant has some, and it opens.
    fn of(machine: &Machine, traces: &[Trace]) -> Self {
        let mut runs = machine.scenarios.iter().zip(traces);
        let through = runs
            .any(|(scenario, trace)| scenario.plant.has_backlash() && trace.moments.iter().any(|moment| moment.open));
        if through { Self::BACKLASH } else { Self::TIGHT }
    }
}

/// A drivetrain in all its variants.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    pub name: &'static str,
    /// Its kind.
    pub summary: String,
    pub aim: Aim,
    /// Every variant, and whether it is the design's choice, which the aims are for.
    pub runs: Vec<(Variant, bool)>,
}

/// Everything that was measured.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Survey {
    pub scenes: Vec<Scene>,
    /// The rotors that were balanced, by scene.
    pub balanced: Vec<(&'static str, Vec<Ran>)>,
    /// Scenes that could not be run, and why.
    pub failures: Vec<(&'static str, String)>,
    /// Day and commit.
    pub measured: String,
    /// Two seconds of each drivetrain, unproven.
    pub quick: bool,
}

/// Every scene there is.
pub fn names() -> Vec<&'static str> {
    SCENES.iter().map(|(name, _)| *name).chain(balancing::scenes().map(|scene| scene.name)).collect()
}

/// Runs these scenes on all cores; one that fails loses no other. `says` names what is under way, `done` counts scenes.
pub fn survey(names: &[&'static str], quick: bool, says: &(dyn Fn(&str) + Sync), done: &(dyn Fn() + Sync)) -> Survey {
    let survey = Mutex::new(Survey { quick, ..Survey::default() });
    let next = AtomicUsize::new(0);
    let worker = || {
        while let Some(&name) = names.get(next.fetch_add(1, Ordering::Relaxed)) {
            let says = |text: &str| says(&format!("{name} {text}"));
            let ran = match SCENES.iter().find(|(scene, _)| *scene == name) {
                Some((_, build)) => drivetrain(name, *build, quick, &says).map(Ok),
                None => balanced(name, &says).map(Err),
            };
            let mut survey = survey.lock().unwrap_or_else(PoisonError::into_inner);
            match ran {
                Ok(Ok(scene)) => survey.scenes.push(scene),
                Ok(Err(ran)) => survey.balanced.push((name, ran)),
                Err(reason) => survey.failures.push((name, reason)),
            }
            done();
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(worker);
        }
    });
    let mut survey = survey.into_inner().unwrap_or_else(PoisonError::into_inner);
    let at = |name: &str| names.iter().position(|other| *other == name);
    survey.scenes.sort_by_key(|scene| at(scene.name));
    survey.balanced.sort_by_key(|scene| at(scene.0));
    survey
}

fn drivetrain(name: &'static str, build: Build, quick: bool, says: &dyn Fn(&str)) -> Result<Scene, String> {
    let machine = build().map_err(|error| error.to_string())?;
    let mut scene = Scene { name, summary: machine.summary.to_owned(), aim: Aim::TIGHT, runs: Vec::new() };
    let mut empty = Vec::new();
    for candidate in candidates(name, None) {
        let core = candidate.board.core;
        if empty.iter().all(|(known, _)| *known != core) {
            empty.push((core, engine::empty(candidate.board, says).map_err(|error| error.to_string())?));
        }
        let base = empty.iter().find(|(known, _)| *known == core).map_or((0, 0), |(_, base)| *base);
        let ran =
            engine::run(&machine, &candidate, base, Options { quick }, says).map_err(|error| error.to_string())?;
        if Aim::of(&machine, &ran.traces) == Aim::BACKLASH {
            scene.aim = Aim::BACKLASH;
        }
        scene.runs.push((ran.variant, (candidate.part(2), candidate.rate_hz()) == machine.chosen));
    }
    Ok(scene)
}

/// The seed of balancing is the same in every run.
const SEED: u64 = 1;

fn balanced(name: &str, says: &dyn Fn(&str)) -> Result<Vec<Ran>, String> {
    let scene = balancing::Scene::named(name).ok_or("there is no such scene")?;
    let ran = |(variant, board)| scene.in_qemu(variant, board, SEED, says).map_err(|error| error.to_string());
    scene.variants().into_iter().map(ran).collect()
}

/// The scenes beside their aims: of each the worst of the variants that the design chooses.
pub fn overview(survey: &Survey) -> Table {
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
        "bits",
    ]);
    let kept = |is: bool| if is { "kept" } else { "missed" }.to_owned();
    for scene in &survey.scenes {
        let chosen = || scene.runs.iter().filter(|(_, chosen)| *chosen).map(|(variant, _)| variant);
        let Some(first) = chosen().next() else { continue };
        // A value that is not a number is worse than any, and keeps no aim.
        let worse = |a: f64, b: f64| if a.is_nan() || b <= a { a } else { b };
        let torque = chosen().map(|variant| variant.shaft_torque.rms).reduce(worse).unwrap_or(f64::NAN);
        let speed = chosen().map(|variant| variant.load_speed.rms).reduce(worse).unwrap_or(f64::NAN);
        let Aim { shaft_torque, load_speed } = scene.aim;
        let mut row = vec![scene.name.to_owned(), format!("{} {}", first.observer, rate(first.rate_hz))];
        row.extend([percent(torque), percent(shaft_torque), kept(torque <= shaft_torque), percent(speed)]);
        row.push(load_speed.map_or_else(String::new, percent));
        row.push(load_speed.map_or_else(String::new, |aim| kept(speed <= aim)));
        for (number, core) in [("f32", "m4f"), ("fixed", "m3")] {
            let found = chosen().find(|variant| variant.number == number && variant.core == core);
            row.push(found.map_or_else(String::new, |variant| grouped(variant.instructions.max as i64)));
        }
        row.push(if scene.runs.iter().all(|(variant, _)| variant.bit_exact) { "equal" } else { "differ" }.to_owned());
        table.row(row);
    }
    table
}

fn variants(scene: &Scene) -> Table {
    let mut table = Table::new([
        "variant",
        "",
        "shaft torque rms",
        "max",
        "load speed rms",
        "max",
        "instructions med",
        "max",
        "flash",
        "RAM",
        "stack",
        "bits",
    ]);
    for (variant, chosen) in &scene.runs {
        let errors = [variant.shaft_torque, variant.load_speed].map(|error| [percent(error.rms), percent(error.max)]);
        let cost = [
            variant.instructions.median,
            variant.instructions.max,
            variant.flash_bytes,
            variant.ram_bytes,
            variant.stack_bytes,
        ];
        let names = [variant.label(), if *chosen { "chosen" } else { "" }.to_owned()];
        let cost = cost.map(|number| grouped(number as i64));
        let bits = if variant.bit_exact { "equal" } else { "differ" }.to_owned();
        table.row(names.into_iter().chain(errors.into_iter().flatten()).chain(cost).chain([bits]));
    }
    table
}

/// The page of the book.
pub fn markdown(survey: &Survey) -> String {
    let mut text = "# Results\n\nEvery scene in all its variants in QEMU, tick by tick against the full solver of its \
        machine.\n\n`cargo lab report --markdown doc/makers/results.md` has written this page. [Limits](../limits.md) \
        has the limits of the figures.\n\n"
        .to_owned();
    let _ = writeln!(text, "Measured on {}.\n", survey.measured);
    if survey.quick {
        text.push_str("A quick run: two seconds of each drivetrain, unproven. Not for figures to quote.\n\n");
    }
    for (scene, reason) in &survey.failures {
        let _ = writeln!(text, "**Failed:** {scene}: {}\n", escaped(reason));
    }
    let said = "Of each scene the design's chosen observer, the worst of its numbers and cores. Aims: with a tight \
        shaft the shaft torque within 2 % rms of its peak and the load's speed within 0.3 % of rated; through backlash \
        the shaft torque within 6 %.";
    section(&mut text, "## Beside the aims", said, &overview(survey));
    for scene in &survey.scenes {
        section(&mut text, &format!("## {}", scene.name), &scene.summary, &variants(scene));
    }
    for (scene, ran) in &survey.balanced {
        for part in tables(ran) {
            section(&mut text, &format!("## {scene}: {}", part.title.to_lowercase()), &part.text, &part.table);
        }
    }
    text.truncate(text.trim_end().len());
    text + "\n"
}

fn section(text: &mut String, title: &str, said: &str, table: &Table) {
    let _ = writeln!(text, "{title}\n\n{}\n\n{}", escaped(said), table.markdown());
}

/// What Markdown would take for something else.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;").replace('*', "\\*").replace('\n', " ")
}
