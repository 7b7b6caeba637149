//! Ctrl-C, SIGTERM, SIGHUP and SIGQUIT at any moment of a run: no process, folder, pipe or half page is left, and
//! nothing is reported as a failure of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use driveline_lab::check::skip;
use driveline_qemu::clone::workspace;
use rustix::process::{Pid, Signal, kill_process};

use super::random::Random;
use super::run::{Place, wait};

/// A mark in the environment, by which all descendants of a run are known.
const MARK: &str = "DRIVELINE_ATTACK";

/// Descendants that are there still, with their command lines.
fn left(mark: &str) -> Vec<String> {
    let mark = format!("{MARK}={mark}");
    let has = |path: &Path| {
        fs::read(path.join("environ")).is_ok_and(|text| text.split(|&byte| byte == 0).any(|one| one == mark.as_bytes()))
    };
    let processes = fs::read_dir("/proc").into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    let line =
        |path: PathBuf| String::from_utf8_lossy(&fs::read(path.join("cmdline")).unwrap_or_default()).replace('\0', " ");
    processes.filter(|path| has(path)).map(line).filter(|line| !line.is_empty()).collect()
}

/// A run in the project's folder with a place of its own for temporary files, pages below the place.
fn start(place: &Place, mark: &str, line: &str) -> Child {
    let page = place.at("page.html");
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    command.args(line.split(' ').map(|word| word.replace("WORK", &place.at("").display().to_string())));
    if line.starts_with("run") || line.starts_with("campaign") {
        command.arg("--html").arg(page);
    }
    command.current_dir(workspace().unwrap()).env("TMPDIR", place.outside("tmp")).env(MARK, mark);
    let file = |name| fs::File::create(place.outside(name)).unwrap();
    command.stdin(Stdio::null()).stdout(file("out")).stderr(file("err"));
    command.spawn().unwrap()
}

/// Signals at so many moments of a run, over so many seconds of it.
fn at_moments(line: &str, moments: u64, seconds: f64) {
    let mut random = Random::new(moments);
    for moment in 0..moments {
        let mut place = Place::new();
        place.put("stream.bin", &super::cases::frames().repeat(500));
        place.put("hoist.toml", include_bytes!("../../../command/machines/hoist.toml"));
        let mark = format!("{}-{moment}-{}", std::process::id(), random.next());
        let delay = seconds * (moment as f64 + (random.below(1000) as f64) / 1000.0) / moments as f64;
        let mut child = start(&place, &mark, line);
        let begun = Instant::now();
        // one that ends before is none the worse
        while begun.elapsed().as_secs_f64() < delay && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        let signal = [Signal::TERM, Signal::INT, Signal::HUP, Signal::QUIT][moment as usize % 4];
        let pid = Pid::from_raw(i32::try_from(child.id()).unwrap()).unwrap();
        if child.try_wait().unwrap().is_none() {
            kill_process(pid, signal).unwrap();
        }
        let (status, late) = wait(child, Duration::from_secs(60));
        let said = fs::read_to_string(place.outside("err")).unwrap();
        let at = format!("{line}, signal after {delay:.3} s: {status}\n{said}");
        assert!(!late, "it does not end: {at}");
        let by_signal = std::os::unix::process::ExitStatusExt::signal(&status);
        assert!(status.success() || by_signal == Some(signal.as_raw()), "{at}");
        assert!(!said.contains("error:") && !said.contains("panicked"), "{at}");
        // what was killed takes a moment to be gone
        let begun = Instant::now();
        while !left(&mark).is_empty() && begun.elapsed() < Duration::from_secs(30) {
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(left(&mark), Vec::<String>::new(), "{at}");
        let faults = place.faults(&["page.html", "report.md", "run.csv", "draws"], true);
        assert!(faults.is_empty(), "{faults:?}: {at}");
    }
}

#[test]
fn a_signal_ends_a_watch_and_a_campaign() {
    at_moments("watch WORK/stream.bin --csv WORK/run.csv", 4, 0.2);
    at_moments("campaign spindle --results WORK/draws --draws 1000", 4, 2.0);
}

#[test]
#[ignore = "minutes"]
fn signals_at_fifty_moments() {
    if !Path::new("/proc/self/environ").exists() {
        skip("this system has no /proc, where the processes that are left would be found");
        return;
    }
    // the images are built before, so that most moments are within the runs
    let qemu = "run spindle --variants f32/m4f/rigid/10000 --quick";
    let place = Place::new();
    assert!(wait(start(&place, "before", qemu), Duration::from_secs(3600)).0.success());
    let fmus = tempfile::tempdir().unwrap();
    let machine = fmus.path().join("plant.fmu");
    let hoist = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/machines/hoist.toml");
    let export = ["export", "fmu", hoist, "--of", "plant", "--out"];
    let status = Command::new(env!("CARGO_BIN_EXE_lab")).args(export).arg(&machine).status().unwrap();
    assert!(status.success());
    let cosim =
        format!("cosim WORK/hoist.toml {} --time 20 --csv WORK/run.csv --html WORK/page.html", machine.display());
    let report = "report --quick --scene spindle --markdown WORK/report.md";
    let runs = [
        (qemu, 12, 8.0),
        (report, 12, 20.0),
        ("campaign spindle --results WORK/draws --draws 1000", 12, 10.0),
        (&*cosim, 12, 12.0),
        ("check", 12, 30.0),
        ("watch --qemu spindle/f32/rigid/10000 --records 2000000 --csv WORK/run.csv", 8, 10.0),
    ];
    for (line, moments, seconds) in runs {
        at_moments(line, moments, seconds);
    }
    let moments: u64 = runs.iter().map(|(_, moments, _)| moments).sum();
    println!("measured: signals at {moments} moments of {} runs", runs.len());
}
