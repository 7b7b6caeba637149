//! Campaigns: draws, faults of sensors and torque, statistics, and the command's files of results.

use std::f64::consts::TAU;
use std::fs;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use cargo_driveline::campaign::drive::Drive;
use cargo_driveline::campaign::run::run;
use cargo_driveline::campaign::scenes::CampaignScene;
use cargo_driveline::campaign::{
    Draw, Factor, Figure, PlainLoop, Tolerance, decay, median_range, noise_of_largest, quantile, rank_correlation,
};
use cargo_driveline::machine_file::parse;
use driveline_closed_loop::actuator::{Actuator, ActuatorErrors};
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::encoder_errors::EncoderErrors;
use driveline_closed_loop::lockstep::{Imperfections, follow};
use driveline_closed_loop::scenario::{Action, Scenario};
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;
use driveline_firmware::scene::no_load::panel;
use driveline_firmware::scene::{Input, Scene as _};
use driveline_firmware::scenes::find;
use driveline_lab::campaign::SCENES;
use driveline_lab::drivetrains::crane_travel;

/// The spindle is the shortest run.
fn campaign(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    command.arg("campaign").args(arguments).current_dir(folder).output().unwrap()
}

fn spindle(folder: &Path, draws: &str, file: &str, further: &[&str]) -> Output {
    let arguments = [&["spindle", "--json", "--draws", draws, "--results", file][..], further].concat();
    let output = campaign(folder, &arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

#[test]
fn threads_and_shards_change_no_bit() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let alone = spindle(folder.path(), "7", "alone", &["--threads", "1"]);
    let beside = spindle(folder.path(), "7", "beside", &["--threads", "3"]);
    assert_eq!(alone.stdout, beside.stdout);
    let file = fs::read(at("alone")).unwrap();
    assert_eq!(file, fs::read(at("beside")).unwrap());
    for shard in ["1/3", "2/3", "3/3"] {
        spindle(folder.path(), "7", &shard[..1], &["--shard", shard]);
    }
    let merged = campaign(folder.path(), &["merge", "2", "3", "1", "--json", "--results", "merged"]);
    assert_eq!(merged.stdout, alone.stdout);
    assert_eq!(file, fs::read(at("merged")).unwrap());
    let partly = campaign(folder.path(), &["merge", "1", "3"]);
    let error = String::from_utf8(partly.stderr).unwrap();
    // 7 draws over three shards: the second has draws 1 and 4
    assert!(partly.status.code() == Some(2) && error.contains("2 of 7 draws are missing, draw 1 first"), "{error}");
}

#[test]
fn a_campaign_that_was_killed_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let whole = spindle(folder.path(), "12", "whole", &[]);
    let path = folder.path().join("killed");
    let lines = || fs::read_to_string(&path).unwrap_or_default().lines().filter(|line| !line.starts_with('#')).count();
    let mut child = Command::new(env!("CARGO_BIN_EXE_lab"))
        .args(["campaign", "spindle", "--json", "--draws", "12", "--results", "killed", "--threads", "1"])
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // a guard against a hang, not a measurement
    let start = Instant::now();
    while lines() < 2 && child.try_wait().unwrap().is_none() && start.elapsed() < Duration::from_secs(600) {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(lines() >= 2);
    // and as a power cut leaves it: the last line is not whole
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 9]).unwrap();
    let resumed = spindle(folder.path(), "12", "killed", &[]);
    assert_eq!(resumed.stdout, whole.stdout);
    assert_eq!(fs::read(&path).unwrap(), fs::read(folder.path().join("whole")).unwrap());
}

#[test]
fn a_campaign_goes_on_to_more_draws() {
    let folder = tempfile::tempdir().unwrap();
    let whole = spindle(folder.path(), "6", "whole", &[]);
    spindle(folder.path(), "3", "grown", &[]);
    fs::write(folder.path().join("grown.extended"), "kept").unwrap();
    symlink("grown", folder.path().join("link")).unwrap();
    fs::set_permissions(folder.path().join("grown"), fs::Permissions::from_mode(0o640)).unwrap();
    assert_eq!(spindle(folder.path(), "6", "link", &[]).stdout, whole.stdout);
    assert!(folder.path().join("link").is_symlink());
    assert_eq!(fs::metadata(folder.path().join("grown")).unwrap().permissions().mode() & 0o777, 0o640);
    assert_eq!(fs::read(folder.path().join("grown")).unwrap(), fs::read(folder.path().join("whole")).unwrap());
    assert_eq!(fs::read_to_string(folder.path().join("grown.extended")).unwrap(), "kept");
    // not back to fewer
    let fewer = campaign(folder.path(), &["spindle", "--draws", "3", "--results", "grown"]);
    assert!(String::from_utf8_lossy(&fewer.stderr).contains("it has `draws 6`, this one `draws 3`"));
}

/// The feed axis with its own tolerances: the observer that the design selects, each by its name, and both refusals.
#[test]
fn a_machine_file_has_campaigns() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("../../../command/machines/axis.toml");
    fs::write(
        folder.path().join("axis.toml"),
        format!("{text}\n[tolerance]\nclass = \"machine-tool\"\nload = [1, 2]\n"),
    )
    .unwrap();
    let run = |further: &[&str]| {
        let arguments = [&["axis.toml", "--json", "--draws", "2"][..], further].concat();
        let output = campaign(folder.path(), &arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let usual = run(&["--results", "usual"]);
    // one mass would do for its load cycle, but has less than 30 degrees
    assert_eq!(usual["variant"], "feed-axis/two-mass");
    assert_eq!(usual["tolerances"]["load"], serde_json::json!([1.0, 2.0]));
    let rigid = run(&["--results", "one", "--drive", "rigid"]);
    assert_eq!(rigid["variant"], "feed-axis/rigid");
    for outcome in [usual, rigid] {
        // the nominal machine differs from the design by its upper modes alone: a few percent of rated torque
        let error = outcome["figures"][0]["nominal"].as_f64().unwrap();
        assert!(error > 0.0 && error < 0.05, "{error}");
    }
    // another machine in the file, and more draws of it
    let changed = text.replace("inertia = 0.0045", "inertia = 0.0046");
    fs::write(folder.path().join("axis.toml"), format!("{changed}\n[tolerance]\nclass = \"machine-tool\"\n")).unwrap();
    let refused = campaign(folder.path(), &["axis.toml", "--draws", "3", "--results", "one", "--drive", "rigid"]);
    let sentence = String::from_utf8_lossy(&refused.stderr);
    assert!(
        sentence.contains("one was written before the machine, by its file or by this program, changed"),
        "{sentence}"
    );
    let refused = campaign(folder.path(), &["axis.toml", "--drive", "f32/rigid/10000"]);
    assert!(
        String::from_utf8_lossy(&refused.stderr).contains("expected two-mass, semi-implicit, rigid, backlash or plain")
    );
}

#[test]
fn merged_shards_have_the_page_of_the_whole_campaign() {
    let folder = tempfile::tempdir().unwrap();
    // the file's name is not the machine's, `roll`
    fs::write(folder.path().join("mill.toml"), include_str!("../../../command/machines/roll.toml")).unwrap();
    let run = |arguments: &[&str]| {
        let output = campaign(folder.path(), arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let draws = ["mill.toml", "--draws", "2", "--drive", "plain"];
    let (page, own) = ("report/mill.toml-plain-campaign.html", "report/mine-campaign.html");
    run(&draws);
    let whole = fs::read(folder.path().join(page)).unwrap();
    fs::remove_file(folder.path().join(page)).unwrap();
    for shard in ["1/2", "2/2"] {
        run(&[&draws[..], &["--shard", shard]].concat());
    }
    let [first, second] = ["report/mill.toml-plain-1-of-2.draws", "report/mill.toml-plain-2-of-2.draws"];
    run(&["merge", first, second]);
    assert!(fs::read(folder.path().join(page)).unwrap() == whole);
    run(&["merge", first, second, "--results", "mine.draws"]);
    assert!(fs::read(folder.path().join(own)).unwrap() == whole);
}

/// The README's roll: the errors of one mass are as good, but its loop swings without end in the nominal machine and in
/// every draw. The expected refusal is that of the campaign's plant, which knows nothing of the margins.
#[test]
fn an_observer_whose_loop_lacks_margin_is_not_selected() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("../../../command/machines/roll.toml");
    fs::write(folder.path().join("roll.toml"), text).unwrap();
    let run = |further: &[&str]| {
        let arguments = [&["roll.toml", "--json", "--draws", "5"][..], further].concat();
        let output = campaign(folder.path(), &arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let unstable = |summary: &serde_json::Value| summary["unstable"].as_array().unwrap().len();
    let rigid = run(&["--results", "rigid", "--drive", "rigid"]);
    assert_eq!(unstable(&rigid), 5);
    let cause = "the speed loop with its observer is unstable";
    assert!(rigid["lacks"].as_str().unwrap().starts_with(cause));
    let merged = campaign(folder.path(), &["merge", "rigid", "--json"]);
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&merged.stdout).unwrap(), rigid);
    let one = campaign(folder.path(), &["roll.toml", "--draw", "0", "--drive", "rigid", "--json"]);
    assert!(serde_json::from_slice::<serde_json::Value>(&one.stdout).unwrap()["lacks"] == rigid["lacks"]);
    let shown = campaign(folder.path(), &["roll.toml", "--draw", "0", "--drive", "rigid"]);
    assert!(String::from_utf8_lossy(&shown.stdout).contains(&format!("warning: {cause}")));
    let usual = run(&["--results", "usual"]);
    assert!(usual["lacks"].is_null());
    assert_eq!((usual["variant"].as_str(), unstable(&usual)), (Some("roll/two-mass"), 0));
    let said = "one mass would do, but lacks margin: with it, the speed loop with its observer is unstable";
    let shown = campaign(folder.path(), &["roll.toml", "--draws", "5", "--results", "usual"]);
    assert!(String::from_utf8_lossy(&shown.stdout).contains(said));
    let mut design = Command::new(env!("CARGO_BIN_EXE_lab"));
    let shown = design.args(["design", "roll.toml"]).current_dir(folder.path()).output().unwrap();
    assert!(String::from_utf8_lossy(&shown.stdout).contains(said));
}

/// One kilogram on the hoist's rope: neither observer's loop holds at its tolerances, and none replaces the other.
#[test]
fn a_lack_of_both_observers_is_stated() {
    let folder = tempfile::tempdir().unwrap();
    let text = include_str!("../../../command/machines/hoist.toml").replace("mass = 12000.0", "mass = 1.0");
    fs::write(folder.path().join("light.toml"), text).unwrap();
    let shown = campaign(folder.path(), &["light.toml", "--draws", "1"]);
    let mut design = Command::new(env!("CARGO_BIN_EXE_lab"));
    let designed = design.args(["design", "light.toml"]).current_dir(folder.path()).output().unwrap();
    let [shown, designed] = [shown, designed].map(|output| String::from_utf8(output.stdout).unwrap());
    for shown in [&shown, &designed] {
        assert!(shown.contains("neither has the margins: with one mass, the speed loop"), "{shown}");
    }
    assert!(shown.contains("warning: the speed loop with its observer is unstable at the tolerance"), "{shown}");
}

/// A scene, its drives, and a file of a machine of the same name have results of their own.
#[test]
fn results_of_scene_drive_and_file_do_not_collide() {
    let folder = tempfile::tempdir().unwrap();
    let axis =
        include_str!("../../../command/machines/axis.toml").replace("name = \"feed axis\"", "name = \"spindle\"");
    fs::write(folder.path().join("spindle.toml"), axis).unwrap();
    for (scene, drive, name) in [
        ("spindle", "f32/rigid/10000", "spindle-f32-rigid-10000"),
        ("spindle", "plain", "spindle-plain"),
        ("spindle.toml", "plain", "spindle.toml-plain"),
    ] {
        let output = campaign(folder.path(), &[scene, "--drive", drive, "--draws", "1", "--json"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(folder.path().join(format!("report/{name}.draws")).exists(), "{name}");
    }
    let both = campaign(folder.path(), &["spindle", "--draw", "1", "--draws", "5"]);
    assert_eq!(both.status.code(), Some(2));
    let twice = ["spindle", "--draw", "1", "--tolerance", "jitter=0", "--tolerance", "jitter=1e-6"];
    let twice = campaign(folder.path(), &twice);
    assert_eq!(twice.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&twice.stderr).contains("--tolerance jitter: expected it once"));
}

/// The blow comes at its time, however many ticks before it did not run. Where half of them do not, a decay counted in
/// ticks would be twice as fast; the loop's part of the damping, a tick later on average, is less than a third. Where
/// none runs there is no swing to measure.
#[test]
fn ticks_that_do_not_run_leave_the_decay_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let decay = |share: &str| {
        let missed = format!("missed-ticks={share}");
        let output = campaign(folder.path(), &["spindle", "--draw", "0", "--json", "--tolerance", &missed]);
        assert!(output.status.success(), "{share}: {}", String::from_utf8_lossy(&output.stderr));
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        value["figures"]["decay of the slowest swing"].as_f64()
    };
    let [all, half] = ["0", "0.5"].map(|share| decay(share).unwrap());
    assert!((half / all - 1.0).abs() < 1.0 / 3.0, "{half} {all}");
    assert_eq!(["0.99", "1"].map(decay), [None, None]);
}

/// A motor that holds four fifths of the weight: behind a worm that keeps 0.7 of the power backwards the load stays,
/// behind one that keeps 0.9 it sinks [Huang 1987 tables 1-2 to 1-4].
#[test]
fn losses_backwards_reach_the_plant_of_a_file() {
    let text = include_str!("../../../command/machines/hoist.toml");
    let gear = "kind = \"gear\"\nratio = 31.5            # motor speed over drum speed\nefficiency = 0.94\n";
    assert!(text.contains(gear));
    for (back, stays) in [(-0.1, true), (0.7, true), (0.9, false)] {
        let worm = format!("kind = \"worm\"\nratio = 31.5\nefficiency = 0.94\nback_efficiency = {back}\n");
        let machine = parse("hoist", &text.replace(gear, &worm)).unwrap();
        let weight = machine.chain.gravity_torque();
        let machine = CampaignScene::of_file(machine).unwrap().departing(&Departure::NONE).unwrap();
        let mut plant = machine.scenarios[0].plant.clone();
        let mut turned = || {
            (0..1000).for_each(|_| plant.advance(0.8 * weight, 1e-3));
            plant.motor_angle()
        };
        let (second, later) = (turned(), turned());
        // what the motor shaft of 5e4 N m/rad gives is a fifth of the weight, as the motor rings on it
        let given = 0.2 * weight / 5.0e4;
        assert_eq!((later - second).abs() < given, stays, "{back}: {second} rad, {later} rad");
        assert!(stays || later < second - 1.0, "{back}: {second} rad, {later} rad");
    }
}

#[test]
fn a_file_of_other_settings_is_refused_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    spindle(folder.path(), "2", "file", &[]);
    let before = fs::read(folder.path().join("file")).unwrap();
    for (further, words) in [
        (&["--seed", "2"][..], "it has `seed 1`, this one `seed 2`"),
        (&["--tolerance", "jitter=0"], "it has `tolerance jitter=0..0.0000002`, this one `tolerance jitter=0..0`"),
        (
            &["--drive", "f32/exact/10000"],
            "it has `variant spindle/f32/rigid/10000`, this one `variant spindle/f32/exact/10000`",
        ),
        (&["--tolerance", "jiter=0"], "there is no factor `jiter`"),
        (&["--tolerance", "delay=9"], "lies from 0 to 3, ticks"),
        (&["--tolerance", "rope=0.5..2"], "the machine has nothing that `rope` changes"),
        (&["--shard", "4/3"], "expected K/N with K from 1 to N"),
    ] {
        let arguments = [&["spindle", "--draws", "2", "--results", "file"][..], further].concat();
        let output = campaign(folder.path(), &arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && error.contains(words), "{error}");
    }
    assert_eq!(before, fs::read(folder.path().join("file")).unwrap());
    spindle(folder.path(), "2", "other", &["--seed", "2"]);
    let compared = campaign(folder.path(), &["compare", "file", "other"]);
    assert!(String::from_utf8_lossy(&compared.stderr).contains("the two files have other draws"));
    let wrong = campaign(folder.path(), &["fan"]);
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("there are `hoist`, `strip-mill`"));
}

/// The plants of draws, of which no run is proven in a campaign, are those of runs that another integrator confirms.
#[test]
fn drawn_plants_are_proven_and_an_unrecorded_one_is_the_same_to_the_bit() {
    for scene in SCENES {
        let draw = Draw::new(&scene.tolerances(), 1, 3);
        let machine = scene.departing(&draw.departure()).unwrap();
        let drive = Drive::named(scene, &machine, None).unwrap();
        let units = drive.units(&machine);
        let mut scenario = machine.scenarios[0].clone();
        // the start and the first ramp: each has friction, gaps or brakes at work, and the crane has broken away
        scenario.duration = 2.0;
        let imperfections = draw.imperfections(scene.lines, scene.rated_torque);
        let runs = [scenario.plant.clone(), scenario.plant.unrecorded()].map(|mut plant| {
            let mut ticking = drive.start(scene, &machine).unwrap();
            let mut truth = Vec::new();
            let rate = drive.rate_hz();
            follow(&machine, &scenario, &units, rate, &imperfections, &mut ticking, &mut plant, |moment, _| {
                truth.extend(moment.truth.map(f64::to_bits));
            })
            .unwrap();
            (plant, truth)
        });
        assert_eq!(runs[0].1, runs[1].1, "{}", scene.name);
        assert!(runs[0].1.iter().any(|bits| f64::from_bits(*bits) != 0.0), "{}: nothing moves", scene.name);
        let proof = runs[0].0.prove().unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        assert!(proof.integrator.largest <= 1e-8, "{}", scene.name);
    }
}

#[test]
fn a_draw_depends_on_its_number_alone() {
    let all = SCENES[0].tolerances();
    let draw = Draw::new(&all, 5, 17);
    assert_eq!(draw, Draw::new(&all, 5, 17));
    assert_ne!(draw.values, Draw::new(&all, 5, 18).values);
    assert_ne!(draw.values, Draw::new(&all, 6, 17).values);
    // as on the command line, and as in a machine file
    assert_eq!(Tolerance::parse("load_inertia=0.9..1.1"), Tolerance::parse("load-inertia=0.9..1.1"));
    let one = [Tolerance::parse("load=0.5..1").unwrap()];
    let loads: Vec<f64> = (0..1000).map(|number| Draw::new(&one, 5, number).value(Factor::Load)).collect();
    let other = [Tolerance::new(Factor::Rope, 0.9, 1.1), one[0]];
    assert_eq!(loads[17], Draw::new(&other, 5, 17).value(Factor::Load));
    // uniform: the mean of n is within four standard deviations (high - low)/sqrt(12 n) of the middle
    let mean = loads.iter().sum::<f64>() / 1000.0;
    assert!((mean - 0.75).abs() < 4.0 * 0.5 / f64::sqrt(12_000.0), "{mean}");
    assert!(loads.iter().all(|load| (0.5..1.0).contains(load)));
    // what has no tolerance is nominal
    assert_eq!(Draw::new(&one, 5, 1).value(Factor::TorqueConstant), 1.0);
}

#[test]
fn the_faults_are_those_of_their_closed_forms() {
    let ideal = EncoderErrors::default();
    assert_eq!(ideal.seen(1.25, 100.0, 3.0), 1.25);
    let real = EncoderErrors { eccentricity: 1e-3, eccentricity_phase: 0.5, jitter: 1e-6, ..ideal };
    let angle = 2.0 + 100.0 * 1e-6 * 3.0;
    // rounding of an angle of two radians
    assert!((real.seen(2.0, 100.0, 3.0) - (angle + 1e-3 * f64::sin(angle + 0.5))).abs() < 1e-15);
    let interpolated = EncoderErrors { interpolation: 1e-4, lines: 512.0, ..ideal };
    let quarter = TAU / 512.0 / 4.0;
    assert!((interpolated.seen(quarter, 0.0, 0.0) - quarter - 1e-4).abs() < 1e-15);

    let step = |errors: ActuatorErrors| {
        let mut actuator = Actuator::new(errors, 1e-4);
        [0; 4].map(|_| actuator.torques(8.0, 0.0))
    };
    let none = ActuatorErrors::default();
    assert_eq!(step(none), [(8.0, 8.0); 4]);
    let late = step(ActuatorErrors { delay: 1.25, ..none }).map(|(shaft, _)| shaft);
    assert_eq!(late, [0.0, 6.0, 8.0, 8.0]);
    let weak = step(ActuatorErrors { gain: -0.25, offset: 1.0, ..none });
    assert_eq!(weak[0], (7.0, 8.0));
    // the mean of 1 - exp(-t/T) over a tick of a quarter of T, and over the next
    let slow = step(ActuatorErrors { lag: 4e-4, ..none });
    for (tick, (_, reported)) in slow.into_iter().enumerate() {
        let from = 0.25 * tick as f64;
        let mean = 1.0 - ((-from).exp() - (-from - 0.25).exp()) / 0.25;
        assert!((reported - 8.0 * mean).abs() < 1e-14, "{reported}");
    }
}

#[test]
fn two_drives_are_compared_draw_by_draw() {
    let folder = tempfile::tempdir().unwrap();
    spindle(folder.path(), "5", "observed", &[]);
    spindle(folder.path(), "5", "plain", &["--drive", "plain"]);
    let compared = |second: &str| -> serde_json::Value {
        let output = campaign(folder.path(), &["compare", "observed", second, "--json"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let same = campaign(folder.path(), &["compare", "observed", "observed"]);
    let sentence = String::from_utf8(same.stderr).unwrap();
    assert!(same.status.code() == Some(2) && sentence.contains("both files are of one drive, spindle/"), "{sentence}");
    let other = compared("plain");
    assert_eq!(other["second"], "spindle/plain");
    // the plain loop has no estimates: its errors are the quantities themselves
    let error = &other["ratios"][0];
    assert!(error["name"] == "shaft torque, rms error" && error["worst"].as_f64().unwrap() < 0.5, "{error}");
}

/// At rest under a setpoint the torque is `held + k_p r n + k_i T r n (n + 1)/2`, `r` the ramp's step; then the limit.
#[test]
fn the_plain_loop_is_its_law() {
    let scene = &SCENES[0];
    let machine = scene.departing(&Draw::nominal().departure()).unwrap();
    let units = Drive::Plain(10_000).units(&machine);
    let mut plain = PlainLoop::new(scene.speed_loop, scene.torque_limit, scene.ramp, machine.bases);
    let mut tick =
        |flags: u32, setpoint: u32| units.torque(plain.tick(&Input { flags, setpoint, ..Input::default() }).torque);
    assert_eq!(tick(0, units.torque_word(64.0)), 64.0);
    let loop_ = scene.speed_loop;
    let step = scene.ramp * loop_.period;
    for n in 1..=20 {
        let n = f64::from(n);
        let integral = loop_.integral * loop_.period * step * n * (n + 1.0) / 2.0;
        let expected = 64.0 + loop_.proportional * step * n + integral;
        // the words are floats
        assert!((tick(Input::RELEASED, units.speed_word(50.0)) / expected - 1.0).abs() < 1e-6);
    }
    let last = (0..100_000).map(|_| tick(Input::RELEASED, units.speed_word(50.0))).last().unwrap();
    assert_eq!(last, scene.torque_limit);
}

#[test]
fn statistics_are_those_of_known_examples() {
    // "Spearman's rank correlation coefficient", Wikipedia: IQ and hours of television, rho = -29/165
    let iq = [106.0, 100.0, 86.0, 101.0, 99.0, 103.0, 97.0, 113.0, 112.0, 110.0];
    let hours = [7.0, 27.0, 2.0, 50.0, 28.0, 29.0, 20.0, 12.0, 6.0, 17.0];
    assert!((rank_correlation(&iq, &hours) + 29.0 / 165.0).abs() < 1e-15);
    // ranks 1, 2.5, 2.5, 4 against 1 to 4: 4.5/sqrt(4.5 5)
    let tied = rank_correlation(&[1.0, 2.0, 2.0, 3.0], &[1.0, 2.0, 3.0, 4.0]);
    assert!((tied - 4.5 / f64::sqrt(22.5)).abs() < 1e-15);
    assert_eq!(rank_correlation(&[1.0, 1.0], &[1.0, 2.0]), 0.0);
    // the deviate of 0.025 is 1.959964; the approximation is good to 4.5e-4
    assert!((noise_of_largest(101, 1) - 0.195_996_4).abs() < 5e-5);
    let ten: Vec<f64> = (1..=10).map(f64::from).collect();
    assert_eq!([0.5, 0.9, 0.91, 1.0].map(|share| quantile(&ten, share)), [5.0, 9.0, 10.0, 10.0]);
    assert!(quantile(&[], 0.5).is_nan());
    // least and greatest of n values have the median between them in all but 2/2^n of the cases: 97 % of six, 94 % of
    // five
    assert_eq!(median_range(&ten[..6]), (1.0, 6.0));
    assert!(median_range(&ten[..5]).0.is_nan() && median_range(&ten[..5]).1.is_nan());
    // energy exp(-6 t) over two seconds: its centroid by the closed form, for decay and growth
    for rate in [3.0, 0.5, -0.5, -3.0_f64] {
        let x = 4.0 * rate;
        let centroid = 2.0 * (1.0 / x - 1.0 / x.exp_m1());
        // bisection of 1000/length to sixty bits; rounding of the closed form near one half
        assert!((decay(centroid, 2.0) - rate).abs() < 1e-12, "{rate}");
    }
    assert!(decay(1.0, 2.0).abs() < 1e-12);
}

/// Four hoists of the tolerances: with a torque constant that is known to 0.3 % the shaft torque is right to 0.5 % of
/// rated, where 5 % of torque constant make percents; the load speed's noise is 0.1 to 0.2 %. The last one's speed
/// creeps into its setpoint in the first window of a lift: taken for load, its acceleration hid the constant.
#[test]
fn a_drive_with_learners_finds_its_machine_before_the_run() {
    let scene = SCENES.iter().find(|scene| scene.name == "hoist").unwrap();
    let machine = scene.departing(&Departure::NONE).unwrap();
    let [learnt, told] =
        ["f32/learnt/10000", "f32/reduced/10000"].map(|name| Drive::named(scene, &machine, Some(name)).unwrap());
    for number in [0, 2, 5, 457] {
        let draw = Draw::new(&scene.tolerances(), 1, number);
        let [learnt, told] = [&learnt, &told].map(|drive| run(scene, drive, &draw).unwrap());
        let [torque, speed] = [Figure::ShaftTorque, Figure::LoadSpeed].map(|f| (learnt.of(f), told.of(f)));
        let better = torque.0 < 0.006 && torque.0 < torque.1 && speed.0 < 0.005 && speed.0 < 0.7 * speed.1;
        assert!(better, "draw {number}: shaft torque {torque:?}, load speed {speed:?}");
        assert_eq!((learnt.of(Figure::Flagged), learnt.is_unstable()), (0.0, false));
    }
}

/// The machines of the largest errors without learners. At most half of them is the aim. The torque constant's part
/// remains in the mill, up to 5 % of the run's rms shaft torque: 1.8 % of rated.
#[test]
fn a_no_load_run_halves_the_error_of_crane_and_mill() {
    for (name, drives, numbers) in [
        ("crane-travel", ["f32/learnt/1000", "f32/semi-implicit/1000"], [56, 310, 948]),
        ("blooming-mill", ["f32/learnt/10000", "f32/slack/10000"], [79, 221, 545]),
    ] {
        let scene = SCENES.iter().find(|scene| scene.name == name).unwrap();
        let machine = scene.departing(&Departure::NONE).unwrap();
        let drives = drives.map(|drive| Drive::named(scene, &machine, Some(drive)).unwrap());
        for number in numbers {
            let draw = Draw::new(&scene.tolerances(), 1, number);
            let [learnt, told] = [&drives[0], &drives[1]].map(|drive| run(scene, drive, &draw).unwrap());
            let torque = [&learnt, &told].map(|outcome| outcome.of(Figure::ShaftTorque));
            assert!(torque[0] <= 0.5 * torque[1], "{name}, draw {number}: shaft torque {torque:?}");
            assert_eq!((learnt.of(Figure::Flagged), learnt.is_unstable()), (0.0, false));
        }
    }
}

/// Cranes in whose one-mass observer the errors of torque constant, inertia and offset cancel. With offset and inertia
/// alone learnt, it was 1.5 to 1.9 times better than the learnt one: the torque constant was left, 0.72 to 0.86 % of
/// rated. The test weight finds it to 0.4 % rms, a twelfth of the tolerance: three times that leave 0.2 % of rated
/// beside the nominal 0.12 %.
#[test]
fn a_test_weight_gives_the_crane_its_torque_constant() {
    let scene = SCENES.iter().find(|scene| scene.name == "crane-travel").unwrap();
    let machine = scene.departing(&Departure::NONE).unwrap();
    let drives = ["f32/learnt/1000", "f32/rigid/1000"].map(|name| Drive::named(scene, &machine, Some(name)).unwrap());
    for number in [144, 307, 361, 400, 454] {
        let draw = Draw::new(&scene.tolerances(), 1, number);
        let [learnt, rigid] =
            [&drives[0], &drives[1]].map(|drive| run(scene, drive, &draw).unwrap().of(Figure::ShaftTorque));
        assert!(learnt <= rigid && learnt < 0.0032, "draw {number}: {learnt} for {rigid}");
    }
}

/// A test weight that is named and does not hang there, and one that comes before the run without load: nothing is
/// learnt from it. A motor that gives 1.04 of its reported torque is found behind the true one, to 1 %.
#[test]
fn a_test_weight_that_is_not_there_teaches_nothing() {
    let by = Departure { motor_inertia: 1.05, ..Departure::NONE };
    let machine = crane_travel::departing(&by).unwrap();
    let [empty, weight] = [crane_travel::empty_hook, crane_travel::test_weight].map(|run| run(&by).unwrap());
    let mut named = empty.clone();
    for (_, action) in &mut named.actions {
        if let Action::Panel(key, _) = action {
            *key = panel::TEST_WEIGHT;
        }
    }
    let row = find("crane-travel/f32/learnt/1000").unwrap();
    let units = Units::new(row.words(), machine.bases);
    let actuator = ActuatorErrors { gain: 0.04, ..ActuatorErrors::default() };
    let imperfections = Imperfections { actuator, ..Imperfections::default() };
    let gain = |runs: &[&Scenario]| {
        let mut drive = OnHost(row.start());
        for run in runs {
            let mut plant = run.plant.unrecorded();
            follow(&machine, run, &units, row.rate_hz, &imperfections, &mut drive, &mut plant, |_, _| {}).unwrap();
        }
        f32::from_bits(drive.0.panel([panel::GAIN, 0]))
    };
    assert_eq!([gain(&[&empty, &named]), gain(&[&weight])], [1.0; 2]);
    let found = gain(&[&empty, &named, &weight]);
    assert!((found - 1.04).abs() < 0.01, "{found}");
}

/// The spindle's own choice, one mass, is not worse than two masses: the aim is 95 % of the draws. Chosen on seed 1.
#[test]
fn the_spindle_is_best_observed_as_one_mass() {
    let scene = SCENES.iter().find(|scene| scene.name == "spindle").unwrap();
    let machine = scene.departing(&Departure::NONE).unwrap();
    let [chosen, two] = [None, Some("f32/exact/10000")].map(|name| Drive::named(scene, &machine, name).unwrap());
    assert_eq!(chosen.name(scene.name), "spindle/f32/rigid/10000");
    for number in 0..20 {
        let draw = Draw::new(&scene.tolerances(), 3, number);
        let [one, two] = [&chosen, &two].map(|drive| run(scene, drive, &draw).unwrap());
        for figure in [Figure::ShaftTorque, Figure::LoadSpeed, Figure::LoadTorque] {
            assert!(one.of(figure) <= two.of(figure), "draw {number}: {}", figure.name());
        }
    }
}

/// Blooming mills at the heavy end of the tolerances, and those of the largest peaks: no swing through the gap stays,
/// and the peak is at most the plain loop's. With more braking in the gap, and a reach that rises on either flank, the
/// first five swung for ever, and the peaks of the others were up to 1.49 of the plain loop's.
#[test]
fn backlash_take_up_does_no_harm_over_the_tolerances() {
    let scene = SCENES.iter().find(|scene| scene.name == "blooming-mill").unwrap();
    let machine = scene.departing(&Departure::NONE).unwrap();
    let [slack, plain] = ["f32/slack/10000", "plain"].map(|name| Drive::named(scene, &machine, Some(name)).unwrap());
    for number in [52, 184, 218, 394, 983, 20, 304, 310, 544, 884] {
        let draw = Draw::new(&scene.tolerances(), 1, number);
        let [slack, plain] = [&slack, &plain].map(|drive| run(scene, drive, &draw).unwrap());
        assert!(!slack.is_unstable() && !slack.swings(), "draw {number}: {slack:?}");
        let peaks = [&slack, &plain].map(|outcome| outcome.of(Figure::Peak));
        assert!(peaks[0] <= peaks[1], "draw {number}: {peaks:?}");
    }
}

#[test]
fn results_that_no_campaign_could_go_on_from_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (results, why) in
        [("/dev/full", "is not a file"), ("resluts/all", "there is no folder resluts"), (".", "is a folder")]
    {
        let output = campaign(folder.path(), &["spindle", "--draws", "2", "--results", results]);
        let sentence = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && sentence.contains(why), "{results}: {sentence}");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn more_draws_than_anyone_waits_for_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = campaign(folder.path(), &["spindle", "--draws", "18446744073709551615", "--results", "all"]);
    let sentence = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && sentence.contains("is not in 1..=10000000"), "{sentence}");
    assert!(!folder.path().join("all").exists());
}
