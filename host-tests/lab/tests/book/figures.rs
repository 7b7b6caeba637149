//! Instructions and bytes on the pages against `budgets.toml`, which `cargo lab check --only budgets` measures.

use cargo_driveline::cli::design::rates::INSTRUCTIONS;
use driveline_lab::atlas::{Atlas, CORES};
use driveline_qemu::measure::budgets::{Budget, Budgets};

use super::pages::{Page, root};

/// The whole numbers in a cell or a sentence.
fn numbers(text: &str) -> Vec<u64> {
    text.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse().ok()).collect()
}

/// The rows under a heading.
fn rows(page: &str, title: &str) -> Vec<Vec<String>> {
    let page = Page::read(page);
    let section = page.sections.iter().find(|section| section.title == title);
    let rows = section.map(|section| section.rows.clone()).unwrap_or_default();
    assert!(!rows.is_empty(), "no table under {title}");
    rows
}

/// What the file has for a variant, or a function of the bench, on a core.
fn budget(variant: &str, core: &str) -> Budget {
    let budgets = Budgets::read(&root().join("budgets.toml")).unwrap();
    budgets.of(variant, core).unwrap_or_else(|| panic!("no budget of {variant} on {core}"))
}

fn median(variant: &str, core: &str) -> u64 {
    budget(variant, core).median.unwrap()
}

fn longest(variant: &str, core: &str) -> u64 {
    budget(variant, core).longest.unwrap()
}

fn stack(variant: &str, core: &str) -> u64 {
    budget(variant, core).stack.unwrap()
}

/// Flash and RAM over the empty image.
fn bytes(variant: &str, core: &str) -> [u64; 2] {
    let [image, empty] = [variant, "empty/f32/none/10000"].map(|variant| budget(variant, core));
    [image.flash.unwrap() - empty.flash.unwrap(), image.ram.unwrap() - empty.ram.unwrap()]
}

#[test]
fn the_instructions_of_a_step_are_those_of_the_bench() {
    for (observer, bench) in [
        ("`RigidObserver`", "bench/step/rigid"),
        ("`SemiImplicitObserver`", "bench/step/semi-implicit"),
        ("`TwoMassObserver`", "bench/step/exact"),
        ("`BacklashObserver`", "bench/step/backlash"),
        ("`MechanismObserver`", "bench/step/mechanism"),
    ] {
        let rows = rows("README.md", "Which observer");
        let row = rows.iter().find(|row| row[0] == observer).unwrap();
        assert_eq!(numbers(&row[2]), ["m4f", "m3"].map(|core| longest(bench, core)), "{observer}");
    }
}

/// What a gear adds to the longest path of a drive of two masses without a governor.
#[test]
fn the_instructions_of_a_gear_are_the_difference_of_two_drives() {
    let geared = |number: &str, core: &str| {
        let [with, without] = ["geared-observer", "observer"]
            .map(|name| longest(&format!("composition/{number}/two-mass-{name}/10000"), core));
        with - without
    };
    let expected = [geared("f32", "m4f"), geared("fixed", "m3")];
    for (page, title, column) in [("README.md", "Which observer", 2), ("doc/parts.md", "Observers", 2)] {
        let rows = rows(page, title);
        let row = rows.iter().find(|row| row[0] == "`GearedObserver<_>`").unwrap();
        assert_eq!(numbers(&row[column]), expected, "{page}");
    }
}

#[test]
fn the_cost_of_the_hoist_is_that_of_its_image_and_its_tick() {
    let rows = rows("README.md", "Results");
    for (row, (variant, core)) in
        rows.iter().zip([("hoist/f32/reduced/10000", "m4f"), ("hoist/fixed/reduced/10000", "m3")])
    {
        let tick = "bench/drive/semi-implicit";
        assert_eq!(numbers(&row[4]), [median(tick, core), longest(tick, core)], "{row:?}");
        let [flash, ram] = bytes(variant, core);
        assert_eq!(
            [&row[5], &row[6], &row[7]].map(|cell| numbers(cell)),
            [[flash], [ram], [stack(variant, core)]],
            "{row:?}"
        );
    }
}

#[test]
fn the_cost_of_all_four_parts_is_that_of_their_images() {
    let tick = ["f32", "fixed"].map(|number| format!("surface-grinder/{number}/tick/10000"));
    let whole = "test-rig/f32/whole/10000".to_owned();
    for (title, variants) in
        [("surface-grinder", vec![(&tick[0], "m4f"), (&tick[1], "m3")]), ("test-rig", vec![(&whole, "m4f")])]
    {
        let rows = rows("doc/makers/scenes.md", title);
        for (column, (variant, core)) in (1..).zip(variants) {
            let found: Vec<u64> = rows.iter().flat_map(|row| numbers(&row[column])).collect();
            assert_eq!(found, [longest(variant, core), stack(variant, core), bytes(variant, core)[0]], "{variant}");
        }
    }
}

/// The median, the bound and its stack.
#[test]
fn medians_and_bounds_are_those_of_the_budgets() {
    let images = [
        "bench/drive/semi-implicit",
        "bench/drive/exact",
        "hoist/NUMBER/reduced/10000",
        "blooming-mill/NUMBER/slack/10000",
        "generator/NUMBER/diesel/2400",
        "punch-press/NUMBER/mean/10000",
    ];
    let rows = rows("doc/makers/worst-case.md", "Median and bound");
    assert_eq!(rows.len(), 2 * images.len());
    let both = images.iter().flat_map(|image| [("f32", "m4f"), ("fixed", "m3")].map(|of| (image, of)));
    for (row, (image, (number, core))) in rows.iter().zip(both) {
        let image = image.replace("NUMBER", number);
        let expected = [median(&image, core), longest(&image, core)];
        assert_eq!([&row[2], &row[3]].map(|cell| numbers(cell)), expected.map(|figure| vec![figure]), "{row:?}");
        let bound = numbers(&row[4]).last().copied();
        assert!(bound.is_none_or(|bound| bound == stack(&image, core)), "{image}: {row:?}");
    }
}

#[test]
fn the_price_of_a_static_is_that_of_the_bench() {
    let rows = rows("doc/makers/worst-case.md", "As it is called");
    for (row, step) in rows.iter().zip(["semi-implicit", "exact"]) {
        let both = |core| {
            [format!("bench/drive/{step}"), format!("bench/drive/{step}/static")].map(|name| longest(&name, core))
        };
        assert_eq!([&row[1], &row[2]].map(|cell| numbers(cell)), [both("m4f"), both("m3")], "{row:?}");
    }
}

#[test]
fn the_price_of_the_rainflow_is_that_of_the_strip_mill() {
    let text = std::fs::read_to_string(root().join("doc/parts.md")).unwrap();
    let (_, after) = text.split_once("mill's tick the count takes").unwrap();
    let sentence = after.split_once(", by").unwrap().0.replace("M4F", "").replace("`f32`", "").replace("M3", "");
    let price = |number: &str, core| {
        let of = |variant| longest(&format!("strip-mill/{number}/{variant}/10000"), core);
        of("life") - of("semi-implicit")
    };
    assert_eq!(numbers(&sentence), [price("f32", "m4f"), price("fixed", "m4f"), price("fixed", "m3")]);
}

/// In the last run of the peers no other observer wins in any scene: where one does, the scene takes it or the
/// library's gets better.
#[test]
fn no_peer_wins_in_the_last_run() {
    let page = std::fs::read_to_string(root().join("doc/makers/peers.md")).unwrap();
    let (_, fronts) = page.split_once("## The fronts").unwrap();
    let rows: Vec<Vec<&str>> = fronts
        .lines()
        .skip_while(|line| !line.starts_with('|'))
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.split('|').map(str::trim).collect())
        .collect();
    let [heading, _, scenes @ ..] = &rows[..] else { panic!("a table of scenes") };
    let columns: Vec<usize> = (0..heading.len()).filter(|&at| heading[at].ends_with("others that win")).collect();
    // on the scenes' own runs and on drawn ones, on two cores
    assert!(columns.len() == 2 && scenes.len() == 2 * 6, "{heading:?}");
    for row in scenes {
        assert!(columns.iter().all(|&at| row[at] == "none"), "{row:?}");
    }
}

/// Each error of the atlas stands in its page, in a row that has the part's words; its tables and its picture are those
/// that `cargo lab atlas` writes from the present budgets.
#[test]
fn the_atlas_is_that_of_the_pages_and_budgets() {
    let atlas = Atlas::read(&root()).unwrap();
    assert_eq!(atlas.subjects.len(), 7);
    let text = |page: &str| std::fs::read_to_string(root().join(page)).unwrap();
    let page = text("doc/makers/atlas.md");
    for subject in &atlas.subjects {
        for point in &subject.points {
            let Some(source) = &point.page else { continue };
            let has = |line: &str| point.row.iter().all(|words| line.contains(words));
            assert!(!point.row.is_empty() && text(source).lines().any(has), "{source}: {:?}", point.row);
        }
        let table = atlas.table(subject).markdown();
        assert!(
            page.contains(&table),
            "{} is not as on the page: cargo lab atlas --markdown ...\n{table}",
            subject.name
        );
    }
    assert_eq!(text("doc/atlas.svg"), atlas.picture());
}

/// The cycles of an instruction are those of the four intervals on the page of the worst case over their bounds.
#[test]
fn the_cycles_of_the_atlas_are_those_of_the_worst_case() {
    let rows = rows("doc/makers/worst-case.md", "Cycles");
    for (column, (core, _, _, cycles)) in [(1, CORES[0]), (3, CORES[1])] {
        let number = if core == "m4f" { "f32" } else { "fixed" };
        let mut found = [f64::INFINITY, 0.0];
        for (words, observer) in [("semi-implicit", "reduced"), ("exact", "exact")] {
            let row = rows.iter().find(|row| row[0] == format!("hoist, image, {words}")).unwrap();
            let bound = longest(&format!("hoist/{number}/{observer}/10000"), core) as f64;
            let each: Vec<f64> = numbers(&row[column]).into_iter().map(|cycles| cycles as f64 / bound).collect();
            found = [found[0].min(each[0]), found[1].max(each[1])];
        }
        let off = cycles.unwrap().into_iter().zip(found).map(|(noted, found)| (noted - found).abs());
        assert!(off.fold(0.0, f64::max) < 0.01, "{core}: {found:?}");
    }
}

/// `design --rates` counts by the images of two masses and of one with a governor.
#[test]
fn the_instructions_of_the_rates_are_those_of_the_images() {
    for (observer, counts) in INSTRUCTIONS {
        let part = if observer == "exact" { "two-mass" } else { observer };
        let of = |number: &str, core: &str| longest(&format!("composition/{number}/{part}-governed/10000"), core);
        assert_eq!(counts.map(u64::from), [of("f32", "m4f"), of("fixed", "m3")], "{observer}");
    }
}
