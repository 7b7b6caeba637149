//! The page of every scene, from made-up results; the front by its definition.

use driveline_lab::survey::{Aim, Scene, Survey, markdown, names, overview};
use driveline_report::chart::front;
use proptest::prelude::*;

use crate::sample;

/// Every drivetrain and rotor as a scene of three variants, of which the last is the design's choice and errs by
/// `error`.
fn survey(error: f64) -> Survey {
    let variant = sample::report().variants[2].clone();
    let scene = |name| {
        let mut chosen = variant.clone();
        chosen.shaft_torque.rms = error;
        let runs = vec![(variant.clone(), false), (variant.clone(), false), (chosen, true)];
        Scene { name, summary: format!("What {name} is."), aim: Aim::TIGHT, runs }
    };
    Survey { scenes: names().into_iter().map(scene).collect(), ..Survey::default() }
}

/// The page has a section for every scene with the cells of its heading in every row, the terminal a row with its
/// verdict. What is not a number keeps no aim; what failed stands in its place.
#[test]
fn every_scene_is_on_the_page_with_whole_tables_and_its_verdict() {
    let kept = survey(0.01);
    let page = markdown(&Survey { quick: true, failures: vec![("hoist", "<no such image>".into())], ..kept.clone() });
    assert!(
        page.contains("Not for figures to quote") && page.contains("**Failed:** hoist: &lt;no such image>"),
        "{page}"
    );
    for name in names() {
        assert!(page.contains(&format!("\n## {name}\n")) && overview(&kept).to_string().contains(name), "{name}");
    }
    let cells = |row: &str| row.replace("\\|", "").matches('|').count();
    for table in page.split("\n\n").filter(|block| block.starts_with('|')) {
        let mut rows = table.lines();
        let heading = rows.next().unwrap();
        assert!(rows.next().unwrap().starts_with("| --- |") && rows.all(|row| cells(row) == cells(heading)), "{table}");
    }
    let missed = |error: f64| overview(&survey(error)).to_string().matches("missed").count();
    assert_eq!([0.01, 0.03, f64::NAN].map(|error| missed(error) - missed(0.01)), [0, names().len(), names().len()]);
    assert!(markdown(&Survey::default()).starts_with("# Results\n"));
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
