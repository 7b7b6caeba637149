//! The page of everything, from made-up results; the front by its definition.

use driveline_lab::cases::Case;
use driveline_lab::commissioning::{Target, Verdict, named, on_host, verdict};
use driveline_lab::drivetrains::SCENES;
use driveline_lab::survey::{Aim, Factor, Failure, Run, SceneFigures, Survey, Wanted, jobs};
use driveline_lab::survey::{survey_markdown, survey_table};
use driveline_report::chart::front;
use proptest::prelude::*;

use crate::sample;
/// Every scene there is, with three variants each, of which the last is the design's choice and errs by `error`.
pub fn survey(error: f64) -> Survey {
    let variants = sample::report().variants;
    let runs = || {
        ["rigid", "plain", "slack"].map(|observer| {
            let mut variant = variants[2].clone();
            observer.clone_into(&mut variant.observer);
            variant.shaft_torque.rms = error;
            variant.flash_bytes += if observer == "rigid" { 0 } else { 100 };
            let peak = if observer == "slack" { 60.0 } else { 100.0 };
            let chosen = observer == "slack";
            let factor = |scenario: &str, opened| Factor { scenario: scenario.into(), opened, peak, rigid: 50.0 };
            let factors = vec![factor("reversal", true), factor("steady", false)];
            Run { variant, chosen, factors }
        })
    };
    let scene = |name: &str| SceneFigures {
        name: name.to_owned(),
        summary: format!("What {name} is."),
        aim: Aim::TIGHT,
        runs: runs().into(),
    };
    Survey {
        scenes: SCENES.iter().map(|(name, _)| scene(name)).collect(),
        cases: vec![case("soft", 1e-9), case("stiff", 1e-3)],
        seconds: 754.0,
        ..Survey::default()
    }
}

/// What stands under a heading of the second order.
fn section<'p>(page: &'p str, title: &str) -> &'p str {
    let (_, after) = page.split_once(&format!("\n## {title}\n")).unwrap();
    after.split("\n## ").next().unwrap()
}

fn case(name: &str, found: f64) -> Case {
    Case { group: "chains", name: name.into(), compared: "frequencies", found, allowed: 1e-6 }
}

/// The page of the book has a section for every scene, and every row of a table has the cells of its heading.
#[test]
fn every_scene_is_in_the_book_with_whole_tables() {
    let text = survey_markdown(&survey(0.01));
    for (name, _) in SCENES {
        assert!(text.contains(&format!("\n## {name}\n")), "{name}");
    }
    let cells = |row: &str| row.replace("\\|", "").matches('|').count();
    let tables = text.split("\n\n").filter(|block| block.starts_with('|'));
    for table in tables {
        let mut rows = table.lines();
        let heading = rows.next().unwrap();
        assert!(rows.next().unwrap().starts_with("| --- |"), "{table}");
        assert!(rows.all(|row| cells(row) == cells(heading)), "{table}");
    }
}

#[test]
fn every_scene_is_on_the_page_with_its_verdict() {
    let survey = survey(0.01);
    let page = survey_markdown(&survey);
    let terminal = survey_table(&survey).to_string();
    for (name, _) in SCENES {
        assert!(page.contains(&format!("\n## {name}\n")) && terminal.contains(name), "{name}");
    }
    // K of 60 over 50, the gentle governor's 60 % of the plain one's, both cases with their verdicts.
    for part in ["1.20", "60.0 %", "chains", "kept", "missed", "12 min 34 s"] {
        assert!(page.contains(part), "{part}");
    }
}

/// A page outlives the command that wrote it: it says itself that it is no page to quote, or not the whole of it.
#[test]
fn a_page_that_was_only_tried_out_says_so() {
    let whole = survey(0.01);
    let tried = Survey { quick: true, part: true, ..whole.clone() };
    let [whole, tried] = [&whole, &tried].map(survey_markdown);
    assert!(whole.contains("Every scene in all its variants") && !whole.contains("Not for figures to quote"));
    assert!(tried.contains("The selected scenes") && tried.contains("Not for figures to quote"));
    let (_, quick) = jobs(&Wanted::scenes(&["fan".to_owned()]).unwrap(), true);
    assert!(quick.quick && quick.part);
    let (_, full) = jobs(&Wanted::scenes(&[]).unwrap(), false);
    assert!(!full.quick && !full.part);
}

#[test]
fn the_gentle_governor_stands_beside_the_plain_one_where_a_gap_opens() {
    let survey = survey(0.01);
    let scene = &survey.scenes[0];
    let gentle = scene.gentle(&scene.runs[2]);
    assert_eq!(gentle.len(), 1);
    assert_eq!((gentle[0].scenario.as_str(), gentle[0].plain.as_str(), gentle[0].share), ("reversal", "plain", 0.6));
    assert!(scene.gentle(&scene.runs[0]).is_empty());
    // without a plain one the others, but not one that learns beside the take-up
    let mut scene = scene.clone();
    "learnt".clone_into(&mut scene.runs[1].variant.observer);
    let beside: Vec<String> = scene.gentle(&scene.runs[2]).into_iter().map(|one| one.plain).collect();
    assert_eq!(beside, ["rigid"]);
    // 60 over 50, of either run.
    assert!((scene.runs[2].factor().k().unwrap() - 1.2).abs() < 1e-12);
}

#[test]
fn what_failed_stands_in_its_place_and_loses_nothing_else() {
    let mut survey = survey(0.01);
    let (lost, rest) = survey.scenes.split_first_mut().unwrap();
    lost.runs.clear();
    let failed = |place: &str| Failure { place: place.into(), job: "f32/m4f".into(), reason: "<no such image>".into() };
    survey.failures = vec![failed(SCENES[0].0), failed("generator"), failed("cases"), failed("fan")];
    assert!(!rest.is_empty());
    let page = survey_markdown(&survey);
    let section = section(&page, SCENES[0].0);
    assert!(section.contains("**Failed:** ") && section.contains("&lt;no such image>"), "{section}");
    assert_eq!(page.matches("no such image").count(), 4);
    for (name, _) in SCENES {
        assert!(page.contains(&format!("\n## {name}\n")), "{name}");
    }
    assert!(survey_table(&survey).to_string().contains("failed"));
}

#[test]
fn one_that_diverged_is_the_worst_wherever_it_stands() {
    let missed = |survey: &Survey| survey_table(survey).to_string().matches("missed").count();
    let one = |mut survey: Survey| {
        survey.scenes.truncate(1);
        survey
    };
    let without = missed(&one(survey(0.01)));
    for place in 0..3 {
        let mut survey = one(survey(0.01));
        for (at, run) in survey.scenes[0].runs.iter_mut().enumerate() {
            run.chosen = true;
            if at == place {
                run.variant.shaft_torque.rms = f64::NAN;
            }
        }
        assert_eq!(missed(&survey), without + 1, "{place}");
    }
}

#[test]
fn nothing_and_what_diverged_are_pages_too() {
    assert!(survey_markdown(&Survey::default()).starts_with("# Results\n"));
    let mut survey = survey(f64::NAN);
    survey.cases.push(case("diverged", f64::NAN));
    survey.scenes[0].runs[2].factors = vec![Factor::default()];
    let page = survey_markdown(&survey);
    // What is not a number keeps no aim.
    assert!(page.contains("diverged") && !survey.scenes[1].aim.kept(&survey.scenes[1].runs[2].variant));
    assert!(serde_json::to_string(&survey).is_ok());
}

/// The spindle, commissioned in half a second, as if QEMU had shown an image of it or not.
fn commissioned(target: Option<Target>) -> Verdict {
    let case = named("spindle").unwrap();
    verdict(&case, &on_host(&case, 1, |_, _| {}).unwrap(), target)
}

#[test]
fn commissioned_machines_stand_beside_what_is_true() {
    let mut survey = survey(0.01);
    let target = Target { instructions: [1, 2, 987], bytes: [9, 500, 234], bit_exact: true };
    survey.commissioned = vec![commissioned(None), commissioned(Some(target))];
    let page = survey_markdown(&survey);
    let section = section(&page, "Commissioning");
    // The longest tick, static memory with the stack, where it ran, the inertia that is true.
    for part in ["987", "734", "on the host, since", "in QEMU: 1 to 987", "0.016", "antiresonance, rad", "kept"] {
        assert!(section.contains(part), "{part}");
    }
    assert!(!section.contains("missed"));
    assert!(page.contains("2 of 2"));
    // One whose inertia is 4 % off, and one that has no answer.
    let mut wrong = commissioned(None);
    wrong.figures[0].error = Some(0.04);
    let mut refused = commissioned(None);
    refused.refused = Some("there is no motor");
    for (figure, row) in refused.figures.iter_mut().enumerate() {
        (row.found, row.error) = (None, if figure == 0 { Some(f64::NAN) } else { None });
    }
    assert!(!wrong.meets() && !refused.meets());
    survey.commissioned = vec![wrong, refused];
    let page = survey_markdown(&survey);
    assert!(page.contains("there is no motor") && page.contains("0 of 2"));
    assert!(serde_json::to_string(&survey).is_ok());
}

#[test]
fn commissioning_has_a_job_for_each_machine() {
    let only = Wanted::scenes(&["commissioning".to_owned()]).unwrap();
    let (all, _) = jobs(&only, false);
    // The mill's takes QEMU more than a minute.
    let places: Vec<(&str, &str)> = all.iter().map(|job| (job.name.as_str(), job.core)).collect();
    assert_eq!(places, [("mill", ""), ("hoist", "m4f"), ("spindle", "m4f")]);
    // Quick: all of them on the host, in three seconds; one of them as it comes out.
    let (quick, mut survey) = jobs(&only, true);
    assert!(quick.len() == 3 && quick.iter().all(|job| job.core.is_empty()));
    let spindle = quick.into_iter().find(|job| job.name == "spindle").unwrap();
    survey.add((spindle.work)(&|_| {}).unwrap());
    assert!(survey.commissioned.len() == 1 && survey.commissioned[0].meets());
}

#[test]
fn the_scenes_are_those_that_can_be_run() {
    let all = Wanted::names();
    assert!(SCENES.iter().all(|(name, _)| all.contains(name)));
    let some = Wanted::scenes(&["fan".to_owned(), "flexible".to_owned()]).unwrap();
    let (jobs, survey) = jobs(&some, false);
    assert!(jobs.iter().all(|job| job.place == "fan" || job.place == "flexible"));
    // Each in `f32` on one core and in fixed point on two.
    assert_eq!((jobs.len(), survey.scenes.len(), survey.balanced.len()), (6, 1, 1));
    // The first two are for two cores, so that their images are built side by side.
    assert_ne!(jobs[0].core, jobs[1].core);
    let unknown = Wanted::scenes(&["windmill".to_owned()]).unwrap_err();
    assert!(unknown.contains("`windmill`") && unknown.contains("`hoist`"), "{unknown}");
}

proptest! {
    /// On the front, and only there, is what no other point beats: none is as good in both and better in one. Of equal
    /// points one stands for all.
    #[test]
    fn the_front_is_what_nothing_beats(points in prop::collection::vec((0..20_u8, 0..20_u8), 0..40)) {
        let points: Vec<(f64, f64)> = points.iter().map(|&(cost, error)| (f64::from(cost), f64::from(error))).collect();
        let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
        let on = front(&points);
        for (index, &point) in points.iter().enumerate() {
            let beaten = points.iter().any(|&other| beats(other, point));
            let named = on.iter().any(|&other| points[other] == point);
            prop_assert_eq!(named, !beaten, "{} {:?}", index, point);
        }
        prop_assert!(on.windows(2).all(|pair| points[pair[0]].0 < points[pair[1]].0));
    }
}
