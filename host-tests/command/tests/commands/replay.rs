//! `cargo driveline replay` of a toothed wheel and of a vibration, on recordings with closed forms.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use serde_json::Value;

use super::bench::Bench;

/// What is printed, and the exit code.
fn replay(bench: &Bench, arguments: &[&str]) -> (String, Option<i32>) {
    let output = bench.run(&[&["replay"], arguments].concat());
    (String::from_utf8(output.stdout).unwrap(), output.status.code())
}

fn json(bench: &Bench, arguments: &[&str]) -> Value {
    let (printed, code) = replay(bench, &[arguments, &["--json"]].concat());
    // 1 where the record tells nothing
    assert!(matches!(code, Some(0 | 1)), "{arguments:?}");
    serde_json::from_str(&printed).unwrap()
}

fn refused(bench: &Bench, arguments: &[&str]) -> String {
    bench.refused(&[&["replay"], arguments].concat())
}

/// Speed of the wheels (rad/s).
const SPEED: f64 = 80.0;

/// Ripple of the slowness.
const RIPPLE: f64 = 0.01;

/// When an angle passes whose slowness is `(1 + h cos(n theta))/w`.
fn passes(theta: f64, order: f64) -> f64 {
    passes_at(SPEED, theta, order)
}

fn passes_at(speed: f64, theta: f64, order: f64) -> f64 {
    (theta + RIPPLE / order * (order * theta).sin()) / speed
}

/// Levels of a pickup: each tooth is as wide as half a place of `places`.
fn levels(places: u32, has_tooth: impl Fn(u32) -> bool, turns: u32, order: f64) -> String {
    let mut text = String::from("time_s,crank\n0,0\n");
    for turn in 0..turns {
        for place in (0..places).filter(|place| has_tooth(*place)) {
            let theta = TAU * (f64::from(turn) + f64::from(place) / f64::from(places));
            let (rises, falls) = (passes(theta, order), passes(theta + 0.5 * TAU / f64::from(places), order));
            writeln!(text, "{:.9},1\n{:.9},0", 0.5 + rises, 0.5 + falls).unwrap();
        }
    }
    text
}

/// Speed 80 rad/s, extremes w/(1 - h) and w/(1 + h): delta is 2 h/(1 - h2), and the order of the speed h to h2.
#[test]
fn a_wheels_edges_give_its_speed_and_ripple() {
    let bench = Bench::new();
    let delta = 2.0 * RIPPLE / (1.0 - RIPPLE * RIPPLE);
    let three_gaps = [10, 11, 22, 23, 34, 35];
    let wheels: [(&str, u32, &[u32]); 3] =
        [("60-2", 60, &[58, 59]), ("36:10,11,22,23,34,35", 36, &three_gaps), ("36:17,34,35", 36, &[17, 34, 35])];
    for (wheel, places, missing) in wheels {
        // rising edges, then falling ones, which come half a place later
        bench.write("log.csv", levels(places, |place| !missing.contains(&place), 60, 2.0));
        for edge in [&[][..], &["--falling"]] {
            let found = json(&bench, &[&["log.csv", "--teeth", wheel, "--cycles", "4"], edge].concat());
            let windows = found["windows"].as_array().unwrap();
            assert!(windows.len() > 10, "{wheel}: {} windows", windows.len());
            for window in windows {
                let of = |name: &str| window[name].as_f64().unwrap();
                // the clock's count is 1e-7 s of 0.0785 s; a window of whole cycles
                assert!((of("speed_by_time") / SPEED - 1.0).abs() < 1e-5, "{wheel}: {window}");
                // a count of each tooth, of 2e-3 s, is 5e-5, and there are four cycles and 30 teeth
                assert!((of("delta") - delta).abs() < 1e-4, "{wheel}: {window}");
                let second = window["orders"][1]["amplitude"].as_f64().unwrap();
                // the series of 1/(1 + h cos) has h/(1 - h2/4 ..) in front
                assert!((second - RIPPLE).abs() < 1e-4, "{wheel}: {window}");
            }
        }
    }
    // a row for each edge, and the fourth order of a cycle of two turns
    let rows: String = levels(60, |place| place < 58, 60, 2.0)
        .lines()
        .filter(|line| line.ends_with(",1"))
        .map(|line| format!("{}\n", line.trim_end_matches(",1")))
        .collect();
    bench.write("edges.csv", format!("time_s\n{rows}"));
    let found = json(&bench, &["edges.csv", "--teeth", "60-2", "--cycle", "2"]);
    let fourth = found["windows"][1]["orders"][3]["amplitude"].as_f64().unwrap();
    assert!((fourth - RIPPLE).abs() < 1e-4, "{fourth}");
    // the table has a line for each window, the page its plots
    let text = bench.said(&["replay", "edges.csv", "--teeth", "60-2", "--csv", "table.csv", "--html", "page.html"]);
    assert!(text.contains("764") && text.contains("2: 1.00 %"), "{text}");
    let table = bench.read("table.csv");
    assert!(table.starts_with("until_s,") && table.lines().count() > 5, "{table}");
    assert!(bench.read("page.html").contains("Fluctuation"));
}

/// After a stop the phase of a cycle of two turns is another, and so may be the speed: no window has cycles of both.
#[test]
fn a_window_ends_where_the_wheel_stops() {
    let bench = Bench::new();
    let (mut text, mut begin) = (String::from("time_s\n"), 0.0);
    // half orders of the turn, begun a turn later after each stop of four seconds, and half the speed at the end
    for (run, slower) in [1.0, 1.0, 1.0, 2.0].into_iter().enumerate() {
        for turn in run..run + 13 {
            for place in 0..58 {
                let theta = TAU * (turn as f64 + f64::from(place) / 60.0);
                writeln!(text, "{:.9}", begin + slower * (passes(theta, 0.5) - TAU * run as f64 / SPEED)).unwrap();
            }
        }
        begin += slower * 13.0 * TAU / SPEED + 4.0;
    }
    bench.write("log.csv", text);
    let found = json(&bench, &["log.csv", "--teeth", "60-2", "--cycle", "2", "--cycles", "100"]);
    let windows = found["windows"].as_array().unwrap();
    assert_eq!(windows.len(), 4, "{found}");
    for (window, speed) in windows.iter().zip([SPEED, SPEED, SPEED, 0.5 * SPEED]) {
        let of = |name: &str| window[name].as_f64().unwrap();
        assert!((of("speed_by_time") / speed - 1.0).abs() < 1e-5, "{window}");
        // as in the test above
        assert!((of("delta") - 2.0 * RIPPLE / (1.0 - RIPPLE * RIPPLE)).abs() < 1e-4, "{window}");
        assert_eq!(window["doubtful"], false);
    }
}

/// A trapezium sampled at 10 kHz with noise: the crossing is interpolated, and noise about the middle is no edge.
#[test]
fn an_analog_level_gives_the_same() {
    let bench = Bench::new();
    let (mut text, mut noise) = (String::from("crank_V\n"), 1_u32);
    for sample in 0..20_000 {
        // by theta = w t - h/2 sin 2 theta, to a place in 1e-12 after eight rounds
        let at = f64::from(sample) * 1e-4 * SPEED;
        let theta = (0..8).fold(at, |theta, _| at - RIPPLE / 2.0 * (2.0 * theta).sin());
        let place = 60.0 * (theta / TAU).fract();
        let has_tooth = !(57.5..=59.5).contains(&place);
        let height = 2.0 * (0.25 - ((place + 0.25).fract() - 0.5).abs());
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let jitter = 0.02 * (f64::from(noise >> 8) / 8_388_608.0 - 1.0);
        writeln!(text, "{:.6}", if has_tooth { height } else { -0.5 } + jitter).unwrap();
    }
    bench.write("log.csv", text);
    let arguments = ["log.csv", "--teeth", "60-2", "--orders", "4", "--rate", "10000", "--cycles", "4"];
    let found = json(&bench, &arguments);
    let windows = found["windows"].as_array().unwrap();
    assert!(windows.len() >= 4, "{found}");
    for window in windows {
        let delta = window["delta"].as_f64().unwrap();
        // a flank of half a place has 6 samples of a height of 1: the noise is 1 % of it, a place 1/60 of a turn, and
        // four cycles of 58 teeth average it; whole samples, not interpolated, give 0.026 for 0.020
        assert!((delta - 2.0 * RIPPLE).abs() < 1e-3, "{window}");
    }
    // a heading that says nothing is not passed over
    bench.write("ckp.csv", "time_s,CKP\n1,0\n2,1\n3,0\n");
    assert!(refused(&bench, &["ckp.csv", "--teeth", "12-1"]).contains("--column teeth=HEADING"));
}

#[test]
fn another_wheel_gives_nothing_and_is_said_to() {
    let bench = Bench::new();
    bench.write("log.csv", levels(60, |place| place < 58, 30, 2.0));
    for wheel in ["36-2", "60-1", "36:17,34,35", "12+1@340", "8-1"] {
        let found = json(&bench, &["log.csv", "--teeth", wheel]);
        assert_eq!(found["edges_with_place"], 0, "{wheel}");
        assert_eq!(found["windows"].as_array().unwrap().len(), 0, "{wheel}");
        let (said, code) = replay(&bench, &["log.csv", "--teeth", wheel]);
        assert!(code == Some(1) && said.contains("is the wheel the one described"), "{wheel}");
    }
    // the right wheel, but two turns of it; then a stop of two seconds after each turn
    bench.write("short.csv", levels(60, |place| place < 58, 2, 2.0));
    let stops = (0..5).flat_map(|turn| (0..58).map(move |at| f64::from(turn) * 3.0 + f64::from(at) / 60.0));
    let stops: String = stops.map(|time| format!("{time:.6}\n")).collect();
    bench.write("stops.csv", format!("time_s\n{stops}"));
    // a clock of one step
    bench.write("at-once.csv", format!("time_s\n{}", "1.5\n".repeat(290)));
    for (file, word) in [
        ("short.csv", "too short, 116 edges"),
        ("stops.csv", "the edges stay away for"),
        ("at-once.csv", "289 of 290 edges are at the time of the one before"),
    ] {
        let (said, code) = replay(&bench, &[file, "--teeth", "60-2"]);
        assert!(code == Some(1) && said.contains(word) && !said.contains("described"), "{file}: {said}");
    }
    for (wheel, word) in [
        ("60-2x", "expected a wheel such as"),
        ("5:9", "expected places from 0 to 4"),
        ("36:1,1", "the place 1 twice"),
        ("0,400", "expected a wheel such as"),
        ("90,0,180", "must rise"),
        ("9999-2", "expected one of 3, 4, 7"),
        ("0,120,240", "among even teeth"),
        ("36-0", "among even teeth"),
        ("", "expected a wheel such as"),
    ] {
        let said = refused(&bench, &["log.csv", "--teeth", wheel]);
        assert!(said.contains(word), "{wheel}: {said}");
    }
    bench.write("back.csv", "time_s\n1\n2\n1.5\n3\n");
    assert!(refused(&bench, &["back.csv", "--teeth", "8-1"]).contains("a time that falls, at line 4"));
    bench.write("flat.csv", "time_s,crank\n1,0\n2,0\n3,0\n");
    assert!(refused(&bench, &["flat.csv", "--teeth", "8-1"]).contains("found 0 edges"));
    for arguments in [
        &["log.csv", "--teeth", "60-2", "--turns", "3"][..],
        &["log.csv", "--phasors", "--cycles", "3"],
        &["log.csv", "--phasors", "--teeth", "60-2"],
        &["log.csv", "--phasors", "--fluctuation"],
        &["log.csv", "--teeth", "60-2", "--machine", "m.toml", "--cycle", "2"],
        &["log.csv", "--fluctuation", "--falling"],
    ] {
        assert!(refused(&bench, arguments).contains("cannot be used with"), "{arguments:?}");
    }
    for options in [&["--held"][..], &["--delay", "1e-4"], &["--torque-constant", "0.5"]] {
        for part in [&["--teeth", "60-2"][..], &["--fluctuation"], &["--phasors"]] {
            let said = refused(&bench, &[&["log.csv"], part, options].concat());
            assert!(said.contains("--machine <FILE>") || said.contains("cannot be used with"), "{options:?}: {said}");
        }
    }
    assert!(refused(&bench, &["log.csv", "--machine", "m.toml", "--falling"]).contains("--teeth <WHEEL>"));
    assert!(refused(&bench, &["stops.csv", "--teeth", "60-2", "--falling"]).contains("without a pickup's level"));
    assert!(refused(&bench, &["log.csv", "--teeth", "60-2", "--csv", "log.csv"]).contains("its own input"));
}

/// A magnetic pickup: its level swings with the speed and rests at the middle over the gap, so that only the steep edge
/// of a tooth is one. An even speed, first at a tenth; noise of a fiftieth of the largest swing.
#[test]
fn a_magnetic_pickups_steep_edge_is_found_at_every_speed() {
    let bench = Bench::new();
    let mut seed = 1_u32;
    let mut text = String::from("crank\n");
    let (mut turn, mut time) = (0.0_f64, 0.0_f64);
    while time < 4.0 {
        let speed = if time < 2.0 { 4.0 } else { (4.0 + 72.0 * (time - 2.0)).min(40.0) };
        time += 5e-5;
        turn += 5e-5 * speed;
        let place = 60.0 * turn.fract();
        // a pulse up, then one down, about each tooth but those of the gap
        let from = place - place.round();
        let pulse = if place.round() % 60.0 < 58.0 { -from * (-20.0 * from * from).exp() } else { 0.0 };
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = f64::from(seed >> 16) / 65_536.0 - 0.5;
        writeln!(text, "{:.5}", speed * pulse + 0.02 * 40.0 * 0.1 * noise).unwrap();
    }
    bench.write("log.csv", text);
    let arguments = ["log.csv", "--teeth", "60-2", "--rate", "20000", "--cycles", "4", "--orders", "4"];
    let found = json(&bench, &[&arguments[..], &["--falling"]].concat());
    let windows = found["windows"].as_array().unwrap();
    // 8 turns at the low speed, 12 on the way up, 60 at the high one: one turn is spent on finding the place
    assert!(windows.len() >= 17, "{}", windows.len());
    let [first, last] = [&windows[0], windows.last().unwrap()];
    for (window, speed) in [(first, 4.0), (last, 40.0)] {
        let of = |name: &str| window[name].as_f64().unwrap();
        assert!((of("speed") / (TAU * speed) - 1.0).abs() < 1e-3, "{window}");
        // noise of 0.023 rms on a slope of 4 a place is 6e-4 rad a tooth, over 232 teeth n times 6e-5 in the order n:
        // from peak to peak twice the root of the squares of four, 6e-4, and more for the tail
        assert!(of("delta") < 1e-3 && window["doubtful"] == false, "{window}");
    }
    assert!(found["lost_after"].is_null(), "{found}");
    // the magnet goes: from 3 s on a thousandth of the swing is left
    let weak = |(row, line): (usize, &str)| match line.parse::<f64>() {
        Ok(level) if row > 60_000 => format!("{:.5}\n", 1e-3 * level),
        _ => format!("{line}\n"),
    };
    let faded: String = bench.read("log.csv").lines().enumerate().map(weak).collect();
    bench.write("faded.csv", faded);
    let gone = json(&bench, &[&["faded.csv"], &arguments[1..], &["--falling"]].concat());
    // the last edge before, up to a gap of 1.3 ms
    let lost = gone["lost_after"].as_f64().unwrap();
    assert!((2.998..=3.0).contains(&lost), "{lost}");
    let (said, _) = replay(&bench, &[&["faded.csv"], &arguments[1..], &["--falling"]].concat());
    assert!(said.contains(&format!("; lost first after {lost:.3} s")), "{said}");
    // a spike is no level
    let text = bench.read("log.csv").replacen("\n0.0", "\n200.0", 1);
    bench.write("spike.csv", text);
    let found = json(&bench, &[&["spike.csv"], &arguments[1..], &["--falling"]].concat());
    assert!(found["windows"].as_array().unwrap().len() >= 17, "{found}");
    // the other edge of a tooth is spread over the gap, which the command sees
    let (said, _) = replay(&bench, &arguments);
    assert!(said.contains("with --falling the other edges leave"), "{said}");
    assert_eq!(json(&bench, &arguments)["better_edges"]["falling"], true);
}

/// A short stop between two turns of a machine without any ripple: the window that has it is doubted.
#[test]
fn a_stop_within_a_window_is_doubted() {
    let bench = Bench::new();
    let mut text = String::from("time_s\n");
    for turn in 0..24 {
        for place in 0..58 {
            let late = if turn >= 12 { 0.3 } else { 0.0 };
            writeln!(text, "{:.9}", late + TAU / SPEED * (f64::from(turn) + f64::from(place) / 60.0)).unwrap();
        }
    }
    bench.write("log.csv", text);
    let found = json(&bench, &["log.csv", "--teeth", "60-2", "--cycles", "20"]);
    let window = &found["windows"][0];
    assert!(window["doubtful"] == true || window["unusable"].is_string(), "{window}");
    let found = json(&bench, &["log.csv", "--teeth", "60-2", "--cycles", "8"]);
    // turns 1 to 8 know nothing of it, and are as even as the clock
    let window = &found["windows"][0];
    assert!(window["doubtful"] == false && window["delta"].as_f64().unwrap() < 1e-4, "{window}");
}

/// The motion of the wheels as an encoder shows it, sampled by ticks: the same speed, delta and orders as by the teeth,
/// forwards and backwards, at one turn and two to the cycle.
#[test]
fn an_angles_fluctuation_is_that_of_its_motion() {
    let bench = Bench::new();
    for (rate, counts, sign) in [(10_000.0, 16_384.0, 1.0), (10_000.0, 16_384.0, -1.0), (2_000.0, 1e9, 1.0)] {
        let mut text = String::from("time_s,angle_rad\n");
        let mut theta = 0.0;
        for sample in 0..(5.0 * rate) as u32 {
            let time = f64::from(sample) / rate;
            // each step of this is closer by a hundredth
            for _ in 0..6 {
                theta += SPEED * (time - passes(theta, 2.0));
            }
            let shown = sign * (theta / TAU * counts).floor() / counts * TAU;
            writeln!(text, "{time:.9},{shown:.9}").unwrap();
        }
        bench.write("log.csv", text);
        for (turns, order) in [("1", 2), ("2", 4)] {
            let found = json(&bench, &["log.csv", "--fluctuation", "--cycle", turns, "--cycles", "4"]);
            let windows = found["windows"].as_array().unwrap();
            assert!(windows.len() >= 6, "{rate}: {} windows", windows.len());
            for window in windows {
                let of = |name: &str| window[name].as_f64().unwrap();
                // both ends of a window of 25 rad lie between samples up to 0.04 rad apart, placed to 3 % of that
                assert!((of("speed_by_time") / (sign * SPEED) - 1.0).abs() < 1e-4, "{rate} Hz: {window}");
                // what is promised of ticks: 3 % of this delta
                assert!((of("delta") - 2.0 * RIPPLE / (1.0 - RIPPLE * RIPPLE)).abs() < 6e-4, "{rate} Hz: {window}");
                let amplitude = window["orders"][order - 1]["amplitude"].as_f64().unwrap();
                assert!((amplitude - RIPPLE).abs() < 3e-4, "{rate} Hz: {window}");
            }
        }
    }
    // a stop within a window, on the way at an even 100 rad/s: refused, or doubted
    for stop in [0.05, 2.0] {
        let angle = |time: f64| 100.0 * if time < 1.0 { time } else { (time - stop).max(1.0) };
        let rows: String = (0..12_000).map(|at| format!("{:.9}\n", angle(f64::from(at) / 2000.0))).collect();
        bench.write("stop.csv", format!("angle_rad\n{rows}"));
        let found = json(&bench, &["stop.csv", "--fluctuation", "--rate", "2000", "--cycles", "8"]);
        let windows = found["windows"].as_array().unwrap();
        let at_it = |window: &&Value| (1.0..1.0 + stop + 0.6).contains(&window["until"].as_f64().unwrap());
        let good = |window: &Value| window["doubtful"] == false && window["delta"].as_f64().unwrap() < 2e-3;
        assert!(windows.iter().filter(at_it).any(|window| !good(window)), "{stop}: {found}");
        let apart = windows.iter().filter(|window| !at_it(window));
        assert!(apart.clone().count() >= 3 && apart.clone().all(good), "{stop}: {found}");
    }
    // fewer orders; then a motion forwards and backwards, one too fast for its samples, no angle at all
    let found = json(&bench, &["log.csv", "--fluctuation", "--cycles", "1", "--from", "4", "--orders", "3"]);
    assert!(found["windows"][0]["orders"].as_array().unwrap().len() <= 3, "{found}");
    let samples = |angle: fn(f64) -> f64| -> String { (0..2000).map(|at| format!("{}\n", angle(at.into()))).collect() };
    bench.write("swing.csv", format!("angle_rad\n{}", samples(|at| 9.0 * (0.01 * at).sin())));
    bench.write("fast.csv", format!("angle_rad\n{}", samples(|at| 0.4 * at)));
    for file in ["swing.csv", "fast.csv"] {
        let (said, code) = replay(&bench, &[file, "--fluctuation", "--rate", "1000"]);
        assert!(code == Some(1) && said.contains("no window of 8 cycles of 1 turn"), "{file}: {said}");
    }
    bench.write("speed.csv", "speed_rad_per_s\n1\n2\n");
    assert!(refused(&bench, &["speed.csv", "--fluctuation", "--rate", "1000"]).contains("--column angle=HEADING"));
    for other in ["--machine", "--teeth"] {
        let said = refused(&bench, &["log.csv", "--fluctuation", other, "60-2"]);
        assert!(said.contains("cannot be used with"), "{said}");
    }
}

/// What is promised of ticks, 3 % of delta or 0.0005, at every speed with the usual orders and cycles; a window of too
/// few ticks says so.
#[test]
fn delta_by_ticks_is_right_or_refused_at_any_speed() {
    let bench = Bench::new();
    let delta = 2.0 * RIPPLE / (1.0 - RIPPLE * RIPPLE);
    for rate in [10_000.0, 2_000.0] {
        for speed in [60.0, 110.0, 130.0, 157.0, 170.0, 200.0, 220.0, 250.0] {
            for (turns, order) in [("1", 2.0), ("2", 1.0), ("2", 0.5)] {
                let (mut text, mut theta) = (String::from("angle_rad\n"), 0.0);
                for sample in 0..(40.0 * TAU / speed * rate) as u32 {
                    // each step of this is closer by a hundredth
                    for _ in 0..6 {
                        theta += speed * (f64::from(sample) / rate - passes_at(speed, theta, order));
                    }
                    writeln!(text, "{theta:.9}").unwrap();
                }
                bench.write("log.csv", text);
                let arguments = ["log.csv", "--fluctuation", "--cycle", turns, "--rate", &rate.to_string()];
                let found = json(&bench, &arguments);
                let a_turn = rate * TAU / speed;
                let windows = found["windows"].as_array().unwrap();
                assert!(!windows.is_empty(), "{rate} Hz, {speed} rad/s, {turns} turns");
                for window in windows {
                    // a two-turn cycle needs 72 ticks to a turn
                    let few = a_turn < if turns == "1" { 48.0 } else { 72.0 };
                    assert_eq!(window["unusable"].is_string(), few, "{rate} Hz, {speed} rad/s, {turns}: {window}");
                    let off = window["delta"].as_f64().map_or(0.0, |found| (found - delta).abs());
                    assert!(off < 5e-4_f64.max(0.03 * delta), "{rate} Hz, {speed} rad/s, {turns} turns: {window}");
                }
            }
        }
    }
}

/// The same promise where a turn has a whole number of samples, or nearly so: even motion, and one order.
#[test]
fn delta_by_ticks_is_right_with_a_whole_number_of_samples_to_the_turn() {
    let bench = Bench::new();
    for (order, size) in [(1.0, 0.0), (1.0, 0.0025), (5.0, 0.01), (8.0, 0.01)] {
        // of a mean speed of 1 the speed is 1 + a cos(n phi)
        let delta = 2.0 * size;
        for samples in [50.0, 60.0, 72.0, 72.01, 72.2, 73.0, 80.0, 96.0, 100.0, 116.0, 120.0, 128.0, 200.0, 256.0] {
            let mut text = String::from("angle_rad\n");
            for sample in 0..(30.0 * samples) as u32 {
                let phi = TAU * f64::from(sample) / samples;
                writeln!(text, "{:.9}", 0.123 + phi + size / order * (order * phi).sin()).unwrap();
            }
            bench.write("log.csv", text);
            let found = json(&bench, &["log.csv", "--fluctuation", "--rate", "2000"]);
            let windows = found["windows"].as_array().unwrap();
            assert!(windows.len() >= 2, "{samples}: {found}");
            for window in windows {
                let off = (window["delta"].as_f64().unwrap() - delta).abs();
                assert!(off < 5e-4_f64.max(0.03 * delta), "order {order}, {samples} samples: {window}");
            }
        }
    }
}

/// `v = 3 cos(theta + 0.5)` beside an offset and the second order, at 20.3 turns a second and 1,000 samples a second.
#[test]
fn a_vibrations_phasor_is_read_by_the_angle_and_by_a_mark() {
    let bench = Bench::new();
    let turns = |at: u32| 20.3e-3 * f64::from(at);
    let mut text = String::from("angle_turns,mark,vibration_mm_per_s\n");
    for at in 0..9_000 {
        let theta = TAU * turns(at);
        let v = 0.7 + 3.0 * (theta + 0.5).cos() + (2.0 * theta + 1.0).cos();
        // the mark is a twentieth of a turn wide
        writeln!(text, "{:.9},{},{v:.9}", turns(at), u8::from(turns(at).fract() < 0.05)).unwrap();
    }
    bench.write("both.csv", &text);
    let without_angle: String = text.lines().map(|line| format!("{}\n", line.split_once(',').unwrap().1)).collect();
    bench.write("mark.csv", without_angle);
    // an angle that comes round as the mark passes, and whose zero is a third of a turn behind the mark
    for (file, zero) in [("wrapped.csv", 0.0), ("third.csv", 1.0 / 3.0)] {
        let lines = text
            .lines()
            .skip(1)
            .zip(0..)
            .map(|(line, at)| format!("{:.9},{}\n", (turns(at) + zero).fract(), line.split_once(',').unwrap().1));
        let wrapped = format!("angle_turns,mark,vibration_mm_per_s\n{}", lines.collect::<String>());
        bench.write(file, wrapped);
    }
    // by the angle: single precision, and the samples at a block's ends, of 49 on a turn and 400 on a block; by the
    // mark an error of the pulse of up to half a sample, 0.064 rad, of which the filter leaves a fifth
    for (file, order, amplitude, phase, tolerance) in [
        ("both.csv", "1", 3.0, 0.5, 5e-3),
        ("both.csv", "2", 1.0, 1.0, 5e-3),
        ("wrapped.csv", "1", 3.0, 0.5, 5e-3),
        ("third.csv", "1", 3.0, 0.5, 5e-3),
        ("mark.csv", "1", 3.0, 0.5, 0.013),
    ] {
        let found = json(&bench, &[file, "--phasors", "--rate", "1000", "--order", order]);
        let readings = found["readings"].as_array().unwrap();
        assert!(readings.len() >= 3, "{file}: {}", readings.len());
        assert!(readings.iter().all(|reading| reading["refused"].is_null()), "{file}: {readings:?}");
        let [size, angle] = ["amplitude", "phase"].map(|of| found["mean"][of].as_f64().unwrap());
        assert!((size / amplitude - 1.0).abs() < tolerance, "{file}, order {order}: {size}");
        let speed = found["readings"][0]["turns_a_second"].as_f64().unwrap();
        // by whole ticks over 40 turns of 49
        assert!((speed / 20.3 - 1.0).abs() < 1e-3, "{file}, order {order}: {speed}");
        assert!((angle - phase).abs() < tolerance, "{file}, order {order}: {angle}");
    }
    // two marks on a turn tell no zero
    let twice: String =
        text.lines().skip(1).zip(0..).fold(String::from("angle_turns,mark,vibration_mm_per_s\n"), |all, (line, at)| {
            // a twelfth of a turn apart
            let mark = u8::from((12.0 * turns(at)).fract() < 0.6 && turns(at).fract() < 1.0 / 6.0);
            all + &format!("{:.9},{mark},{}\n", turns(at), line.rsplit_once(',').unwrap().1)
        });
    bench.write("twice.csv", twice);
    let said = refused(&bench, &["twice.csv", "--phasors", "--rate", "1000"]);
    assert!(said.contains("marks at different angles"), "{said}");
    // without a mark there is no edge to choose
    let alone: String = text
        .lines()
        .map(|line| format!("{},{}\n", line.split(',').next().unwrap(), line.rsplit(',').next().unwrap()))
        .collect();
    bench.write("alone.csv", alone);
    let said = refused(&bench, &["alone.csv", "--phasors", "--rate", "1000", "--falling"]);
    assert!(said.contains("--falling without a column of a mark"), "{said}");
    // beyond the sensor's range no reading is to be used
    let found = json(&bench, &["both.csv", "--phasors", "--rate", "1000", "--range", "2.0"]);
    assert!(found["mean"].is_null() && found["readings"][0]["refused"].as_str().unwrap().contains("range"), "{found}");
    // too short for one
    let short: String = text.lines().take(300).map(|line| format!("{line}\n")).collect();
    bench.write("short.csv", short);
    let (said, code) = replay(&bench, &["short.csv", "--phasors", "--rate", "1000"]);
    assert!(code == Some(1) && said.contains("no reading is to be used") && said.contains("turns"), "{said}");
    let said = refused(&bench, &["both.csv", "--phasors", "--rate", "1000", "--counts", "360"]);
    assert!(said.contains("--counts without a column in counts"), "{said}");
    bench.write("none.csv", "angle_rad,vibration_g\n");
    assert!(refused(&bench, &["none.csv", "--phasors", "--rate", "1000"]).contains("found 0 samples"));
    assert!(refused(&bench, &["both.csv", "--phasors", "--rate", "1000", "--order", "0"]).contains("1..=15"));
    let no_mark: String = text.lines().map(|line| format!("{}\n", line.rsplit_once(',').unwrap().1)).collect();
    bench.write("alone.csv", no_mark);
    assert!(refused(&bench, &["alone.csv", "--phasors", "--rate", "1000"]).contains("a `mark` once a turn"));
}
