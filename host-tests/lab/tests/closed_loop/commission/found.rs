//! The scene's machines, each against its full plant, with 1 % of noise in the torque.

use std::collections::BTreeMap;

use driveline_lab::commissioning::{Case, Course, Row, Verdict, named, on_host, verdict};

fn course(name: &str, seed: u64) -> (Case, Course) {
    let case = named(name).unwrap();
    let course = on_host(&case, seed).unwrap();
    (case, course)
}

/// The aims stand in the rows: resonance and antiresonance 1 %, inertias 3 %, gap 5 %.
fn meets_its_aims(name: &str, seed: u64) -> Course {
    let (verdict, course) = course_of_aims(name, seed);
    for row in &verdict.figures {
        if let Some([error, deviation]) = unexplained(row) {
            assert!(error <= 5.0 * deviation, "{name}: {row:?}");
        }
    }
    course
}

/// How far a figure lies from the truth, less the half per mille and half percent that no noise explains: the third
/// mass, and the mean of a gear's two ways, (1/0.94 + 0.94)/2 = 1.0019. Beside it its own standard deviation.
fn unexplained(row: &Row) -> Option<[f64; 2]> {
    let (truth, found) = (row.truth?, row.found?);
    Some([((found - truth).abs() - 0.005 * truth.abs()).max(0.0), row.standard_deviation?])
}

fn course_of_aims(name: &str, seed: u64) -> (Verdict, Course) {
    let (case, course) = course(name, seed);
    let verdict = verdict(&case, &course);
    assert_eq!(verdict.refused, None, "{name}");
    assert!(verdict.meets(), "{name}: {verdict:?}");
    assert!(verdict.figures.iter().filter(|row| row.aim.is_some()).count() >= 5, "{name}");
    // The governor of a machine that is 3 % off: as far off itself, and twice for what goes with the inertia twice.
    assert!(verdict.gains.len() == 3 && verdict.gains.iter().all(|error| error.abs() < 0.06), "{name}: {verdict:?}");
    (verdict, course)
}

#[test]
fn the_hoist_with_a_test_load() {
    let course = meets_its_aims("hoist", 1);
    // Travel: 6 m of the load are 945 rad of the motor.
    assert!(course.moments.iter().all(|moment| moment.angle.abs() < 945.0));
}

#[test]
fn the_mill_with_its_gap() {
    meets_its_aims("mill", 1);
}

#[test]
fn the_spindle_in_the_air() {
    for seed in [1, 2, 3] {
        meets_its_aims("spindle", seed);
    }
}

/// The largest error of each figure that has an aim, as a share of the aim, and whether the deviations are those that
/// are told: where a course tells it by four degrees of freedom, one in some hundred is off by five of its own.
#[test]
#[ignore = "an hour"]
fn every_machine_over_forty_seeds() {
    for name in ["hoist", "mill", "spindle"] {
        let mut worst = (0.0, "");
        let mut rows: BTreeMap<&str, Vec<[f64; 2]>> = BTreeMap::new();
        for seed in 1..=40 {
            let (verdict, _) = course_of_aims(name, seed);
            for row in &verdict.figures {
                rows.entry(row.name).or_default().extend(unexplained(row));
                if let (Some(error), Some(aim)) = (row.error(), row.aim) {
                    worst = if error.abs() / aim > worst.0 { (error.abs() / aim, row.name) } else { worst };
                }
            }
        }
        for (row, seeds) in rows.iter().filter(|(_, seeds)| !seeds.is_empty()) {
            let mean = |k: usize| seeds.iter().map(|figures| figures[k].powi(2)).sum::<f64>() / seeds.len() as f64;
            let (error, told) = (mean(0), mean(1).sqrt());
            let largest = seeds.iter().map(|[error, _]| *error).fold(0.0, f64::max);
            // Forty errors against forty deviations of four degrees of freedom: the ratio of the mean squares is below
            // 1 + 5 sqrt(2/40 + 2/160).
            assert!(error <= 2.25 * told.powi(2), "{name}, {row}: {} rms, {told} are told", error.sqrt());
            assert!(largest <= 5.0 * told, "{name}, {row}: {largest}, {told} are told");
        }
        let (share, row) = worst;
        println!("measured: {name}, 40 seeds: the largest error is {:.0} % of its aim, {row}", 100.0 * share);
    }
}
