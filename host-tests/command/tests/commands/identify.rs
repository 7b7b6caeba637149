//! `cargo driveline identify` and `replay` as a user meets them: on the recording of a real bench, on simulated ones
//! and on useless ones.

use std::f64::consts::TAU;
use std::fmt::Write;

use cargo_driveline::identification::{Figures, NotIdentified, Refusal, identify};
use cargo_driveline::recording::{Asked, Quantity, Recording, read_recording};
use driveline::commissioning::Figure;
use driveline_solver::noise::Noise;
use driveline_solver::plant::{Chain, Shaft};

use super::bench::Bench;

const BENCH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/recordings/two-mass-bench.csv");
/// The bench as others found it, by both encoders: inertias (kg m2), stiffness (N m/rad) and damping (N m s/rad).
const INERTIAS: [f64; 2] = [2.747e-3, 2.746e-3];
const SHAFT: [f64; 2] = [315.0, 5.8e-3];
const RESONANCES: [f64; 2] = [76.2, 53.9];

/// Rate of the bench's record, and torque over current of its motor.
const RECORDED: [&str; 4] = ["--rate", "2500", "--torque-constant", "0.564"];

fn recording(text: &str) -> Recording {
    read_recording(&Bench::with("log.csv", text).path("log.csv"), &Asked::default()).unwrap()
}

#[test]
fn half_of_the_benchs_record_gives_the_machine_and_the_observer_follows_the_other_half() {
    let bench = Bench::new();
    let found = bench.json(&[&["identify", BENCH, "--to", "5", "--toml", "bench.toml"], &RECORDED[..]].concat());
    let figure = |name: &str| ["value", "standard_deviation"].map(|of| found[name][of].as_f64().unwrap());
    // the tolerances, and three of the figures' own deviations
    for (name, truth, tolerance) in [
        ("resonance", TAU * RESONANCES[0], 0.01),
        ("antiresonance", TAU * RESONANCES[1], 0.01),
        ("motor_inertia", INERTIAS[0], 0.03),
        ("load_inertia", INERTIAS[1], 0.03),
    ] {
        let [value, deviation] = figure(name);
        assert!((value / truth - 1.0).abs() < tolerance, "{name}: {value}, not {truth}");
        assert!((value - truth).abs() < 3.0 * deviation, "{name}: {value} by {deviation}, not {truth}");
    }
    let delay = figure("dead_time")[0].to_string();
    let options = ["--machine", "bench.toml", "--from", "5", "--delay", &delay, "--csv", "bench.csv"];
    let replayed = bench.json(&[&["replay", BENCH], &options[..], &RECORDED].concat());
    assert_eq!(replayed["samples"], 12_500);
    let settling = replayed["settling"].as_u64().unwrap() as usize;
    // the truth from both encoders and the bench as others found it, not from the machine that was identified
    let rows = rows(&std::fs::read_to_string(BENCH).unwrap());
    let estimates = rows_of(&bench.read("bench.csv"));
    for number in ["f32", "fixed"] {
        let column = |name: &str| estimates.0.iter().position(|head| *head == format!("{number}_{name}")).unwrap();
        let (speed, torque) = (column("load_speed_rad_s"), column("shaft_torque_Nm"));
        let (mut speeds, mut torques) = (Vec::new(), Vec::new());
        for tick in settling..12_499 {
            let at = 12_500 + tick;
            let rate = |of: usize| (rows[at + 1][of] - rows[at - 1][of]) * 1250.0;
            let twist = rows[at][1] - rows[at][2];
            speeds.push([rate(2), estimates.1[tick][speed]]);
            torques.push([SHAFT[0] * twist + SHAFT[1] * (rate(1) - rate(2)), estimates.1[tick][torque]]);
        }
        let (speed, torque) = (error(&speeds), error(&torques));
        assert!(speed < 0.06 && torque < 0.04, "{number}: load speed {speed}, shaft torque {torque}");
    }
}

/// An encoder's angle that comes round at every turn, as a drive tells it, gives the same machine.
#[test]
fn an_angle_that_comes_round_gives_the_same_machine() {
    let (heads, rows) = rows_of(&std::fs::read_to_string(BENCH).unwrap());
    let mut text = heads.join(",") + "\n";
    for row in &rows {
        // the zero lies where the record begins, so the swing passes it again and again
        writeln!(text, "{},{},{}", row[0], (row[1] - rows[0][1]).rem_euclid(TAU), row[2]).unwrap();
    }
    let bench = Bench::with("wrapped.csv", text);
    let found = |file: &str| {
        let found = bench.json(&[&["identify", file, "--to", "5"], &RECORDED[..]].concat());
        ["resonance", "motor_inertia"].map(|name| found[name]["value"].as_f64().unwrap())
    };
    for (wrapped, whole) in found("wrapped.csv").into_iter().zip(found(BENCH)) {
        // the zero of the angle is no part of the machine: what rounding moves
        assert!((wrapped / whole - 1.0).abs() < 1e-6, "{wrapped} for {whole}");
    }
}

/// Rms error over rms truth, both about their means: the zeros of two encoders differ.
fn error(pairs: &[[f64; 2]]) -> f64 {
    let spread = |of: &dyn Fn(&[f64; 2]) -> f64| {
        let mean = pairs.iter().map(of).sum::<f64>() / pairs.len() as f64;
        (pairs.iter().map(|pair| (of(pair) - mean).powi(2)).sum::<f64>() / pairs.len() as f64).sqrt()
    };
    spread(&|pair| pair[1] - pair[0]) / spread(&|pair| pair[0])
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    rows_of(text).1
}

fn rows_of(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let heads = lines.next().unwrap().split(',').map(str::to_owned).collect();
    (heads, lines.map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect())
}

/// What stands between motor and load in a simulated machine.
#[derive(Clone, Copy, PartialEq)]
enum Machine {
    TwoMasses,
    /// Under a multisine, whose lines leave most frequencies without torque.
    Multisine,
    Gap,
    GapUnderMultisine,
    Rope,
    Third,
    Rigid,
}

fn simulated(seed: u64) -> ([f64; 4], String) {
    simulated_as(seed, Machine::TwoMasses)
}

/// A simulated machine: resonance, antiresonance, inertias; and its record with noise of 1 % in torque and speed.
fn simulated_as(seed: u64, machine: Machine) -> ([f64; 4], String) {
    let mut noise = Noise::new(7919 * seed);
    let mut between = |low: f64, high: f64| low * (high / low).powf(0.5 + 0.5 * noise.uniform());
    let (motor, share) = (between(1e-3, 1.0), between(0.2, 5.0));
    let load = motor * share;
    let resonance = TAU * between(5.0, 80.0);
    let reduced = motor * load / (motor + load);
    let stiffness = reduced * resonance * resonance;
    let damping = 2.0 * between(0.003, 0.05) * reduced * resonance;
    let friction = [motor, load].map(|inertia| between(0.002, 0.02) * inertia * resonance);
    let rate = resonance / TAU * between(30.0, 150.0);
    let shaft = Shaft::elastic(stiffness).damping(damping);
    // the torque that twists the shaft at the motor's torque, far below the resonance
    let twisting = 100.0 * load;
    let first = Chain::motor(motor).viscous(friction[0]);
    let (chain, mean) = match machine {
        Machine::TwoMasses | Machine::Multisine => (first.shaft(shaft, load), 0.0),
        Machine::Gap | Machine::GapUnderMultisine => (first.shaft(shaft.gap(1.5 * twisting / stiffness), load), 0.0),
        Machine::Rope => {
            let rope = Shaft::rope(stiffness).damping(damping);
            (first.shaft(rope, load).load(0.5 * twisting), 0.5 * twisting)
        }
        Machine::Third => {
            let second = Shaft::elastic(1.5 * stiffness).damping(damping);
            (first.shaft(shaft, 0.6 * load).shaft(second, 0.4 * load), 0.0)
        }
        Machine::Rigid => (Chain::motor(motor + load), 0.0),
    };
    let mut plant = chain.viscous(friction[1]).build().unwrap();
    // two hundred periods of the resonance
    let count = (200.0 * TAU * rate / resonance) as usize;
    let (mut held, mut rows) = (0.0, Vec::new());
    // from a tenth of the resonance to three times of it, with Schroeder's phases
    let tone = |time: f64, n: f64| (0.1 * n * resonance * time - std::f64::consts::PI * n * n / 30.0).cos();
    let multisine = matches!(machine, Machine::Multisine | Machine::GapUnderMultisine);
    for tick in 0..count {
        let time = tick as f64 / rate;
        let chirp = 0.1 * resonance * time + 1.45 * resonance * time * time * rate / count as f64;
        if tick.is_multiple_of(4) {
            held = noise.uniform().signum();
        }
        let course = match seed {
            _ if multisine => (1..=30).map(|n| tone(time, f64::from(n))).sum::<f64>() / 15.0_f64.sqrt(),
            even if even.is_multiple_of(2) => chirp.sin(),
            _ => held,
        };
        let torque = mean + 100.0 * (motor + load) * course;
        rows.push([time, torque, plant.motor_speed()]);
        plant.advance(torque, 1.0 / rate);
    }
    let rms = |of: usize| {
        let mean = rows.iter().map(|row| row[of]).sum::<f64>() / count as f64;
        (rows.iter().map(|row| (row[of] - mean).powi(2)).sum::<f64>() / count as f64).sqrt()
    };
    let sizes = [0.01 * rms(1), 0.01 * rms(2)];
    let mut text = "time_s,torque_Nm,speed_rad_per_s\n".to_owned();
    for [time, torque, speed] in rows {
        let (torque, speed) = (torque + sizes[0] * noise.normal(), speed + sizes[1] * noise.normal());
        writeln!(text, "{time:.9},{torque:.9e},{speed:.9e}").unwrap();
    }
    ([resonance, (stiffness / load).sqrt(), motor, load], text)
}

#[test]
fn fifty_simulated_machines_are_found_within_their_own_deviations() {
    let (mut beyond, mut all) = (0, 0);
    for seed in 1..=50 {
        let (truth, text) = simulated(seed);
        let found = identify(&recording(&text), None).unwrap_or_else(|error| panic!("{seed}: {error}"));
        let Figures { resonance, antiresonance, motor_inertia, load_inertia, .. } = found.estimate.figures;
        let figures = [resonance, antiresonance, motor_inertia, load_inertia];
        // the tolerances
        for ((Figure { value, standard_deviation }, truth), most) in figures.into_iter().zip(truth).zip([1, 1, 3, 3]) {
            assert!((value / truth - 1.0).abs() < 0.01 * f64::from(most), "{seed}: {value}, not {truth}");
            beyond += usize::from((value - truth).abs() > 3.0 * standard_deviation);
            all += 1;
        }
    }
    assert!(beyond * 20 <= all, "{beyond} of {all} figures are beyond three of their deviations");
}

/// A coarse encoder leaves most of the torque unexplained, and is no gap: its noise is at all frequencies alike, and the
/// figures have the deviations that it gives them.
#[test]
fn the_counts_of_a_coarse_encoder_are_no_gap() {
    let (mut beyond, mut all) = (0, 0);
    for seed in 1..=10 {
        let (truth, text) = simulated(seed);
        let rows = rows(&text);
        let period = rows[1][0] - rows[0][0];
        let square = rows.iter().map(|row| row[2] * row[2]).sum::<f64>() / rows.len() as f64;
        // two roundings a sample, of a twelfth of its square each: as much as the speed
        let count = period * (6.0 * square).sqrt();
        let (mut text, mut angle) = ("time_s,torque_Nm,angle_rad\n".to_owned(), 0.0);
        for row in &rows {
            writeln!(text, "{},{},{}", row[0], row[1], (angle / count).round() * count).unwrap();
            angle += period * row[2];
        }
        let found = identify(&recording(&text), None).unwrap_or_else(|error| panic!("{seed}: {error}")).estimate;
        assert!(found.unexplained > 0.4, "{seed}: {}", found.unexplained);
        let Figures { resonance, antiresonance, motor_inertia, load_inertia, .. } = found.figures;
        for (figure, truth) in [resonance, antiresonance, motor_inertia, load_inertia].into_iter().zip(truth) {
            beyond += usize::from((figure.value - truth).abs() > 3.0 * figure.standard_deviation);
            all += 1;
        }
    }
    assert!(beyond * 20 <= all, "{beyond} of {all} figures are beyond three of their deviations");
}

/// Friction and gap are told apart: two masses stay two masses under a multisine.
#[test]
fn two_masses_under_a_multisine_are_found() {
    for seed in 1..=6 {
        let ([_, _, motor, load], text) = simulated_as(seed, Machine::Multisine);
        let found = identify(&recording(&text), None).unwrap_or_else(|error| panic!("{seed}: {error}"));
        let found = found.estimate.model;
        // noise of 1 % in both signals
        assert!((found.motor / motor - 1.0).abs() < 0.02 && (found.load / load - 1.0).abs() < 0.02, "{found:?}");
    }
}

/// Machines that are not two masses, and a torque of the other sign: each is named, by what explains its record.
#[test]
fn what_is_not_two_masses_is_named() {
    let contact = "a gap (backlash) opens, a rope or shaft goes slack";
    let mut wrong = Vec::new();
    for (machine, words) in [
        (Machine::TwoMasses, "has the other sign"),
        (Machine::Gap, contact),
        (Machine::GapUnderMultisine, contact),
        (Machine::Rope, contact),
        (Machine::Third, "a third mass swings in the band"),
        (Machine::Rigid, "a rigid machine of "),
    ] {
        for seed in 1..=6 {
            let ([_, _, motor, load], text) = simulated_as(seed, machine);
            let turned = |row: &Vec<f64>| format!("{},{},{}\n", row[0], -row[1], row[2]);
            let text = match machine {
                Machine::TwoMasses => {
                    "time_s,torque_Nm,speed_rad_per_s\n".to_owned()
                        + &rows(&text).iter().map(turned).collect::<String>()
                }
                _ => text,
            };
            match identify(&recording(&text), None) {
                Err(refusal) if refusal.to_string().contains(words) => {
                    if let NotIdentified::Refused(Refusal::Rigid { rigid, .. }) = refusal {
                        // noise of 1 % in both signals
                        assert!(
                            (rigid.inertia / (motor + load) - 1.0).abs() < 0.01,
                            "{seed}: {rigid:?}, not {}",
                            motor + load
                        );
                    }
                }
                // a second resonance that noise covers: two masses, as right as those of the fifty
                Ok(found)
                    if [(found.estimate.model.motor, motor), (found.estimate.model.load, load)]
                        .iter()
                        .all(|(found, truth)| (found / truth - 1.0).abs() < 0.03) => {}
                other => wrong.push(format!("{words}, {seed}: {:?}", other.map(|found| found.estimate.figures))),
            }
        }
    }
    // 95 % of the thirty-six
    assert!(wrong.len() <= 1, "{}", wrong.join("\n"));
}

/// Speed per torque of two masses [derived; headings: Huang 1987 ch. 3 to 7]: inertias 0.02 and 0.05, 800 N m/rad, 0.1
/// N m s/rad.
fn response(frequency: f64) -> [f64; 2] {
    let s2 = -frequency * frequency;
    // (J_l s^2 + d s + k)/(s (J_m J_l s^2 + (J_m + J_l)(d s + k)))
    let above = [0.05 * s2 + 800.0, 0.1 * frequency];
    let inner = [0.02 * 0.05 * s2 + 0.07 * 800.0, 0.07 * 0.1 * frequency];
    let below = [-frequency * inner[1], frequency * inner[0]];
    let square = below[0] * below[0] + below[1] * below[1];
    [(above[0] * below[0] + above[1] * below[1]) / square, (above[1] * below[0] - above[0] * below[1]) / square]
}

#[test]
fn a_table_of_a_response_gives_the_machine() {
    let mut noise = Noise::new(5);
    let mut text = "frequency_Hz,magnitude [dB],phase_deg\n".to_owned();
    for line in 0..120 {
        let hertz = 4.0 * 25_f64.powf(f64::from(line) / 119.0);
        let [re, im] = response(TAU * hertz);
        // 1 % of noise
        let [re, im] = [re, im].map(|part| part + 0.01 * re.hypot(im) * noise.normal());
        writeln!(text, "{hertz:.6},{:.6},{:.6}", 20.0 * re.hypot(im).log10(), im.atan2(re).to_degrees()).unwrap();
    }
    let found = Bench::with("response.csv", text).json(&["identify", "response.csv", "--response", "speed"]);
    let truths = [
        ("resonance", (800.0_f64 * (1.0 / 0.02 + 1.0 / 0.05)).sqrt(), 0.01),
        ("antiresonance", (800.0_f64 / 0.05).sqrt(), 0.01),
        ("motor_inertia", 0.02, 0.03),
        ("load_inertia", 0.05, 0.03),
    ];
    // the tolerances
    for (name, truth, most) in truths {
        let value = found[name]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < most, "{name}: {value}, not {truth}");
    }
}

/// What is done to a good record, and what the refusal says.
#[test]
fn useless_records_are_refused_with_their_reason() {
    type Change = fn(usize, &mut [f64; 3]);
    let (_, good) = simulated(2);
    let rows = rows(&good);
    let largest = rows.iter().fold(0.0_f64, |size, row| size.max(row[2].abs()));
    let refused = |text: &str| {
        let output = Bench::with("log.csv", text).run(&["identify", "log.csv"]);
        assert!(!output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
        String::from_utf8(output.stderr).unwrap()
    };
    let changed = |change: &dyn Fn(usize, &mut [f64; 3])| {
        let mut text = "time_s,torque_Nm,speed_rad_per_s\n".to_owned();
        for (index, row) in rows.iter().enumerate() {
            let mut row = [row[0], row[1], row[2]];
            change(index, &mut row);
            writeln!(text, "{},{},{}", row[0], row[1], row[2]).unwrap();
        }
        text
    };
    let cases: [(Change, &str); 6] = [
        (|_, row| row[1] = 3.0, "the torque is constant"),
        (|_, row| row[2] = 3.0, "the speed is constant"),
        (|_, row| row[1] = -row[1], "has the other sign"),
        (|index, row| row[0] += if index > 900 { 1.0 } else { 0.0 }, "a gap of"),
        (|index, row| row[0] -= if index == 900 { 1.0 } else { 0.0 }, "a time that does not rise, at line 902"),
        (|index, row| row[2] = if index == 900 { f64::NAN } else { row[2] }, "log.csv:902:"),
    ];
    for (change, words) in cases {
        let sentence = refused(&changed(&change));
        assert!(sentence.contains(words), "{sentence}");
    }
    let clipped = refused(&changed(&|_, row| row[2] = row[2].clamp(-0.2 * largest, 0.2 * largest)));
    assert!(clipped.contains("the speed is clipped"), "{clipped}");
    let mut noise = Noise::new(3);
    let draws: Vec<f64> = rows.iter().map(|_| noise.normal()).collect();
    assert!(refused(&changed(&|index, row| row[2] = draws[index])).contains("no machine is identified"));
    for (from, to, words) in [
        ("speed_rad_per_s", "speed_kg", "log.csv:1:18: found the heading `speed_kg` without a unit"),
        ("torque_Nm", "torque", "found the heading `torque` without a unit"),
        ("torque_Nm", "current_A", "--torque-constant"),
    ] {
        let sentence = refused(&good.replace(from, to));
        assert!(sentence.contains(words), "{sentence}");
    }
}

/// What `identify` says of a file's bytes, and its exit code.
fn answered(bytes: &[u8], options: &[&str]) -> (Option<i32>, String) {
    let output = Bench::with("log.csv", bytes).run(&[&["identify", "log.csv", "--json"], options].concat());
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_single_tone_is_refused() {
    let mut text = "time_s,torque_Nm,speed_rad_per_s\n".to_owned();
    for row in 0..200 {
        let turned = TAU * 10.0 * f64::from(row) / 200.0;
        writeln!(text, "{},{},{}", f64::from(row) / 1000.0, turned.sin(), turned.cos()).unwrap();
    }
    // ten whole periods: one line of the spectrum carries all of the torque
    let (code, sentence) = answered(text.as_bytes(), &[]);
    assert!(code == Some(1) && sentence.contains("excites 1 frequencies at most"), "{code:?}: {sentence}");
}

#[test]
fn values_beyond_all_machines_are_refused_at_their_place() {
    let (_, good) = simulated(2);
    let scaled = |by: f64| {
        let mut text = "time_s,torque_Nm,speed_rad_per_s\n".to_owned();
        rows(&good).iter().for_each(|row| writeln!(text, "{},{},{:e}", row[0], row[1], by * row[2]).unwrap());
        text
    };
    let (code, sentence) = answered(scaled(1e300).as_bytes(), &[]);
    assert!(code == Some(2) && sentence.contains("log.csv:2:"), "{code:?}: {sentence}");
    assert!(sentence.contains("speed_rad_per_s") && sentence.contains("at most 1e100 in SI units"), "{sentence}");
    // within the bound, yet its powers leave the numbers
    let (code, sentence) = answered(scaled(1e95).as_bytes(), &[]);
    assert!(code == Some(1) && sentence.contains("no machine is identified"), "{code:?}: {sentence}");
}

#[test]
fn a_response_without_a_swing_gives_no_machine() {
    let mut text = "frequency_Hz,magnitude,phase_deg\n".to_owned();
    (1..100).for_each(|hertz| writeln!(text, "{hertz},1,0").unwrap());
    // a brake of 1 N m s/rad without inertia
    let (code, sentence) = answered(text.as_bytes(), &["--response", "speed"]);
    assert!(code == Some(1) && sentence.contains("no machine is identified"), "{code:?}: {sentence}");
}

/// A third mass in the band, by the impedances of masses and shafts in a row: all three are found.
#[test]
fn a_third_mass_in_the_band_is_named() {
    use nalgebra::Complex;
    let (inertias, shafts) = ([1.0, 1.799_927_265_131_757_7, 1.400_889_353_090_320_8], [18_608.465_1, 8_564.652_27]);
    let mut text = "frequency_Hz,magnitude,phase_deg\n".to_owned();
    for line in 0..200 {
        let hertz = 0.047_770_7 * f64::sqrt(shafts[0]) * 20_f64.powf(f64::from(line) / 199.0);
        let s = Complex::new(0.0, TAU * hertz);
        let behind = |load: Complex<f64>, stiffness: f64, inertia: f64| {
            let shaft = stiffness / s + 0.02 * (stiffness * inertia).sqrt();
            inertia * s + (shaft.inv() + load.inv()).inv()
        };
        let all = behind(behind(inertias[2] * s, shafts[1], inertias[1]), shafts[0], inertias[0]).inv();
        writeln!(text, "{hertz},{},{}", all.norm(), all.arg().to_degrees()).unwrap();
    }
    let (code, sentence) = answered(text.as_bytes(), &["--response", "speed"]);
    assert_eq!(code, Some(1));
    let words = "1.0000e0, 1.7999e0 and 1.4009e0 kg m² on shafts of 1.8608e4 and 8.5647e3 N m/rad";
    assert!(sentence.contains("a third mass swings in the band") && sentence.contains(words), "{sentence}");
}

#[test]
fn a_table_has_no_machine_file_and_says_so_first() {
    // the file itself is not read
    let (code, sentence) = answered(b"", &["--response", "speed", "--toml", "machine.toml"]);
    assert!(code == Some(2) && sentence.contains("--toml needs a recording over time"), "{code:?}: {sentence}");
}

#[test]
fn a_window_begins_and_ends_at_times() {
    for (options, words) in [
        (&["--from", "nan"][..], "--from must be zero or above and finite, not NaN"),
        (&["--from", "-5"], "--from must be zero or above and finite, not -5.0"),
        (&["--from", "2", "--to", "1"], "--from 2.0 must be before --to 1.0"),
    ] {
        let (code, sentence) = answered(b"", options);
        assert!(code == Some(2) && sentence.contains(words), "{code:?}: {sentence}");
    }
}

#[test]
fn a_file_in_another_encoding_is_told_with_its_line_and_a_remedy() {
    // a degree sign of ISO-8859-1 in the third line
    let (code, sentence) = answered(b"time_s,torque_Nm\n0,1\n1,2 \xb0\n", &[]);
    assert_eq!(code, Some(2));
    for words in ["log.csv:3:5:", "the byte 0xb0, which is not UTF-8", "iconv -f ISO-8859-1 -t UTF-8"] {
        assert!(sentence.contains(words), "{sentence}");
    }
    let wide =
        |mark: &[u8]| [mark, &"time_s,torque_Nm\n".bytes().flat_map(|byte| [byte, 0]).collect::<Vec<_>>()].concat();
    for mark in [&b"\xff\xfe"[..], b""] {
        let (code, sentence) = answered(&wide(mark), &[]);
        assert_eq!(code, Some(2));
        assert!(sentence.contains("log.csv:1:1:") && sentence.contains("iconv -f UTF-16 -t UTF-8"), "{sentence}");
    }
}

#[test]
fn what_is_asked_of_a_machine_or_is_the_loads_is_not_the_motors() {
    let headings = "time_s,load_current_A,torque_setpoint_Nm,speed_setpoint_rad/s,load_acceleration [rad/s2],\
                    speed_error_rpm,target_angle_rad,torque_command_Nm";
    let bench = Bench::with("log.csv", format!("{headings}\n0,1,2,3,4,5,6,7\n1,1,2,3,4,5,6,8\n"));
    let read = |columns: &[&str]| {
        let columns = columns.iter().map(|&column| column.to_owned()).collect();
        read_recording(&bench.path("log.csv"), &Asked { columns, ..Asked::default() }).unwrap()
    };
    let recording = read(&[]);
    let quantities: Vec<Quantity> = recording.columns.iter().map(|column| column.quantity).collect();
    assert_eq!(quantities, [Quantity::Time]);
    assert!(recording.torque(None).unwrap_err().expected.contains("--column torque=HEADING"));
    // who names a command means it, in the unit of its heading
    assert_eq!(read(&["torque=torque_command_Nm"]).torque(None).unwrap(), [7.0, 8.0]);
}

/// A recording of a motor, a gear of 80 % and a load that a weight of 10 N m pulls, always motoring; its machine file.
fn geared(gap: &str) -> Bench {
    let shaft = Shaft::elastic(800.0).damping(0.1);
    let mut plant = Chain::motor(0.02).efficiency(0.8).shaft(shaft, 0.05).load(10.0).build().unwrap();
    let mut text = "time_s,torque_Nm,angle_rad,speed_rad_per_s,shaft_torque_Nm\n".to_owned();
    for tick in 0..8000 {
        let time = f64::from(tick) / 2000.0;
        // up to about 20 rad/s, then about the balance of 10/0.8
        let torque = if time < 0.5 { 16.0 } else { 12.5 + 4.0 * (TAU * 3.0 * time).sin() };
        let (angle, speed, behind) = (plant.motor_angle(), plant.motor_speed(), plant.torque_behind_gear(0));
        writeln!(text, "{time:.6},{torque:.6},{angle:.9},{speed:.9},{behind:.9}").unwrap();
        plant.advance(torque, 1.0 / 2000.0);
    }
    let machine = format!(
        "name = \"geared\"\n[[element]]\nkind = \"motor\"\ninertia = 0.02\n\
         [[element]]\nkind = \"gear\"\nratio = 1.0\nefficiency = 0.8\n\
         [[element]]\nkind = \"shaft\"\nstiffness = 800.0\ndamping = 0.1\n{gap}\
         [[element]]\nkind = \"rotor\"\ninertia = 0.05\n\
         [encoder]\nlines = 2048\n[control]\nrate_hz = 2000\n\
         [disturbance]\ntorque_accuracy = 0.1\nload_torque_step = 5.0\nwithin = 1.0\n\
         [limits]\ntorque = 40.0\nspeed = 100.0\n"
    );
    let bench = Bench::with("geared.csv", text);
    bench.write("geared.toml", machine);
    bench
}

const REPLAY: [&str; 5] = ["replay", "geared.csv", "--machine", "geared.toml", "--held"];

#[test]
fn a_replay_deducts_the_losses_of_the_gear() {
    let replayed = geared("").json(&REPLAY);
    assert_eq!(replayed["gear_efficiency"], 0.8);
    for number in replayed["numbers"].as_array().unwrap() {
        // the loss of 2.5 N m is 1.5 times the rms of the shaft torque's 2.3 N m of amplitude; what is left is the lag
        let error = number["shaft_torque_error"].as_f64().unwrap();
        assert!(error < 0.2, "{number}");
    }
}

#[test]
fn a_gap_that_a_replay_ignores_is_said() {
    let bench = geared("[[element]]\nkind = \"backlash\"\ngap = 0.01\n");
    let said = String::from_utf8(bench.run(&REPLAY).stderr).unwrap();
    assert!(said.contains("0.0100 rad at the motor, ignored"), "{said}");
    assert_eq!(bench.json(&REPLAY)["gap_ignored"], 0.01);
}

#[test]
fn a_delay_is_shorter_than_its_recording() {
    const AXIS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/axis.toml");
    // the bench's record has 10 s; beyond 2^63 ticks a delay had no place in a number at all
    for delay in ["100", "10", "3.7e15"] {
        let options = ["replay", BENCH, "--machine", AXIS, "--delay", delay];
        let sentence = Bench::new().refused(&[&options[..], &RECORDED].concat());
        assert!(sentence.contains("expected seconds below the recording's length of 10.0 s"), "{sentence}");
    }
}

#[test]
fn a_decimal_comma_is_read_where_no_comma_separates() {
    let (_, good) = simulated(2);
    let told = |text: &str| Bench::with("log.csv", text).json(&["identify", "log.csv"]);
    let with_points = told(&good);
    for separator in [";", "\t"] {
        // the same digits, so that the numbers are the same bits
        assert_eq!(told(&good.replace(',', separator).replace('.', ",")), with_points, "{separator}");
    }
    let whole = "time_s;torque_Nm;speed_rpm\n";
    // three digits behind a comma are no thousands where another number has one or two, or a zero before it
    // none are grouped beside a thousand without a comma
    for speeds in
        [["999", "1,025", "1,5"], ["999", "1,025", "-0,125"], ["99", "1,025", "1,000"], ["999", "1000", "1,025"]]
    {
        let rows: Vec<String> = speeds.iter().enumerate().map(|(k, speed)| format!("{k};1;{speed}\n")).collect();
        let (_, sentence) = answered(format!("{whole}{}", rows.concat()).as_bytes(), &[]);
        assert!(!sentence.contains("thousands"), "{sentence}");
    }
    for (text, words) in [
        (
            format!("{whole}0,000;1,5;2\n0,001;1.5;2\n"),
            "log.csv:3:7: `torque_Nm`: found `1.5`, expected a finite number with a decimal comma, as those before it",
        ),
        (format!("{whole}0.000;1.5;1,024\n"), "found `1,024`, expected a finite number with a decimal point"),
        (format!("{whole}0;1.024,5;2\n"), "found `1.024,5`, expected a finite number, without a separator"),
        (format!("{whole}0;1;1,024.5\n"), "found `1,024.5`, expected a finite number, without a separator"),
        (format!("{whole}0;1,024,500;2\n"), "found `1,024,500`, expected a finite number, without a separator"),
        // whole numbers count up to a thousand and on
        (format!("{whole}0;1;999\n1;1;1,000\n2;1;-1,001\n"), "log.csv:3:5: `speed_rpm`: found `1,000` beside"),
        // a comma separates
        ("time_s,torque_Nm\n\"0,5\",1\n".to_owned(), "found `0,5`, expected a finite number with a decimal point"),
        ("0,000;1,5\n0,001;1,5\n".to_owned(), "found no headings"),
    ] {
        let (code, sentence) = answered(text.as_bytes(), &[]);
        assert!(code == Some(2) && sentence.contains(words), "{code:?}: {sentence}");
    }
}

#[test]
fn a_rate_beside_a_column_of_time_is_refused() {
    const AXIS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/axis.toml");
    let words = "log.csv:1:11: `time_s`: found --rate beside a column of time, expected no --rate";
    let text = "torque_Nm,time_s,speed_rpm\n1,0,0\n2,0.001,1\n";
    let (code, sentence) = answered(text.as_bytes(), &["--rate", "1000"]);
    assert!(code == Some(2) && sentence.contains(words), "{code:?}: {sentence}");
    let bench = Bench::with("log.csv", "tooth_time_s\n0\n0.1\n");
    let sentence = bench.refused(&["replay", "log.csv", "--rate", "1000", "--teeth", "60-2"]);
    assert!(sentence.contains("`tooth_time_s`: found --rate beside a column of tooth-time"), "{sentence}");
    bench.write("log.csv", text);
    for part in [&["--machine", AXIS][..], &["--teeth", "60-2"], &["--fluctuation"], &["--phasors"]] {
        let sentence = bench.refused(&[&["replay", "log.csv", "--rate", "1000"], part].concat());
        assert!(sentence.contains(words), "{part:?}: {sentence}");
    }
}

#[test]
fn a_heading_of_two_columns_is_to_be_renamed() {
    let text = "time_s,torque_Nm,torque_Nm,speed_rpm\n0,1,2,0\n0.001,2,3,1\n";
    // by its heading neither of the two is named
    for (options, place) in [(&[][..], "log.csv:1:18:"), (&["--column", "torque=torque_Nm"], "log.csv:1:8:")] {
        let (code, sentence) = answered(text.as_bytes(), options);
        assert!(code == Some(2) && sentence.contains(place), "{code:?}: {sentence}");
        let words = "found the heading `torque_Nm` twice, expected each heading once; rename one of them";
        assert!(sentence.contains(words), "{sentence}");
    }
}
