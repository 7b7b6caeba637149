//! The report's page from made-up figures: whole, safe and small, whatever the figures are.

mod sample;
mod sound;

use driveline_report::{Deviation, Report, Signal, Trajectory};
use sound::assert_sound;

#[test]
fn a_whole_report_is_one_sound_page() {
    let report = sample::report();
    let page = report.page();
    assert_sound(&page);
    for variant in &report.variants {
        assert!(page.contains(&variant.observer));
    }
    assert!(page.contains("exceeded") && page.contains("failed"));
    if let Some(path) = std::env::var_os("DRIVELINE_SAMPLE_REPORT") {
        std::fs::write(path, &page).unwrap();
    }
}

#[test]
fn nothing_to_report_is_a_page_too() {
    assert_sound(&Report::default().page());
}

#[test]
fn names_are_escaped() {
    let mut report = sample::report();
    let bad = "<script>alert('&\"')</script>\u{1}".to_owned();
    report.scene.clone_from(&bad);
    report.variants[0].observer.clone_from(&bad);
    report.trajectories[0].variant.clone_from(&bad);
    report.trajectories[0].marks[0].label.clone_from(&bad);
    report.notes.push(bad);
    let page = report.page();
    assert_sound(&page);
    // the viewer's is the only one
    assert!(page.matches("<script").count() == 1 && !page.contains("<script>alert"));
}

#[test]
fn what_diverged_has_a_word_and_no_number() {
    let mut report = sample::report();
    for variant in &mut report.variants {
        variant.shaft_torque = Deviation { rms: f64::NAN, max: f64::INFINITY };
        variant.load_speed = Deviation { rms: f64::INFINITY, max: f64::NAN };
        variant.instructions.median = 0;
    }
    for trajectory in &mut report.trajectories {
        trajectory.load_speed.estimate.iter_mut().for_each(|value| *value = f64::NAN);
        trajectory.shaft_torque.truth[7] = f64::NEG_INFINITY;
    }
    assert_sound(&report.page());
    assert!(report.json()["variants"][0]["shaft_torque"]["rms"].is_null());
}

#[test]
fn many_long_trajectories_stay_small_and_keep_their_peaks() {
    let time: Vec<f64> = (0..100_000).map(|n| f64::from(n) * 1e-4).collect();
    let wave = |phase: f64| time.iter().map(|t| (40.0 * t + phase).sin() * (1.0 + t)).collect::<Vec<_>>();
    let signal = || Signal { truth: wave(0.0), estimate: wave(0.01) };
    let trajectory = |n: usize| Trajectory {
        variant: format!("variant {}", n / 4),
        situation: format!("situation {}", n % 4),
        time: time.clone(),
        shaft_torque: signal(),
        load_speed: signal(),
        load_torque: signal(),
        marks: Vec::new(),
    };
    let report = Report { trajectories: (0..24).map(trajectory).collect(), ..Report::default() };
    assert_sound(&report.page());
}

#[test]
fn json_has_exactly_the_promised_fields() {
    let json = sample::report().json();
    let variant = json["variants"][0].as_object().unwrap();
    let mut names: Vec<&str> = variant.keys().map(String::as_str).collect();
    names.sort_unstable();
    let mut promised = [
        "number",
        "core",
        "observer",
        "rate_hz",
        "shaft_torque",
        "load_speed",
        "load_torque",
        "instructions",
        "cycles",
        "flash_bytes",
        "ram_bytes",
        "stack_bytes",
        "bit_exact",
        "ticks",
    ];
    promised.sort_unstable();
    assert_eq!(names, promised);
    assert_eq!(variant["instructions"].as_object().unwrap().len(), 3);
    assert!(variant["shaft_torque"]["rms"].is_f64() && variant["shaft_torque"]["max"].is_f64());
}
