//! The link to QEMU against the same scene on the host, bit for bit.

use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use driveline_closed_loop::actuator::ActuatorErrors;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::lockstep::{Imperfections, follow};
use driveline_closed_loop::units::Units;
use driveline_firmware::board::{BOARDS, Facts};
use driveline_firmware::scene::no_load::panel;
use driveline_firmware::scene::{Input, Output, Scene};
use driveline_firmware::scenes::{VARIANTS, find};
use driveline_firmware::self_test::inputs::Program as Inputs;
use driveline_lab::drivetrains::{blooming_mill, crane_travel};
use driveline_qemu::image::{Program, belongs, board, build};
use driveline_qemu::link::{Link, Summary};

/// Runs a variant on the host, over so many inputs from a seed.
fn on_host(variant: &str, seed: u32, ticks: usize) -> Vec<(Input, Output)> {
    let row = find(variant).unwrap();
    let (mut scene, mut inputs) = (row.start(), Inputs::new(seed, row.words()));
    let tick = |_| {
        let input = inputs.next_input();
        (input, scene.tick(&input))
    };
    (0..ticks).map(tick).collect()
}

fn run(variant: &str, board: Facts, inputs: &[(Input, Output)]) -> (Vec<Output>, Summary) {
    let image = build(variant, board, Program::ControlLoop, |_| {}).unwrap();
    let mut link = Link::start(&image).unwrap();
    let outputs = inputs.iter().map(|(input, _)| link.exchange(input).unwrap()).collect();
    (outputs, link.finish().unwrap())
}

/// The names follow from the scenes' files; they are those of images, budgets and reports.
#[test]
fn every_variant_is_listed_once_by_scene_number_observer_and_rate() {
    for &name in VARIANTS {
        let parts: Vec<&str> = name.split('/').collect();
        let row = find(name).unwrap();
        assert_eq!((row.name, VARIANTS.iter().filter(|one| **one == name).count(), parts.len()), (name, 1, 4));
        assert!(["f32", "fixed"].contains(&parts[1]) && parts[3] == row.rate_hz.to_string(), "{name}");
    }
}

#[test]
fn outputs_are_those_of_the_host_bit_for_bit() {
    // The others' bits are compared with their budgets.
    for variant in ["empty/f32/none/10000", "hoist/f32/exact/10000", "hoist/fixed/exact/10000"] {
        let expected = on_host(variant, 1, 3000);
        for &board in BOARDS {
            let (outputs, summary) = run(variant, board, &expected);
            for (tick, (output, (input, expected))) in outputs.iter().zip(&expected).enumerate() {
                let output = Output { instructions: 0, ..*output };
                assert_eq!(output, *expected, "{variant} on {} at tick {tick} for {input:?}", board.name);
            }
            assert_eq!(summary.ticks, 3000);
            assert_eq!((summary.control_loop.as_str(), summary.board.as_str()), (variant, board.name));
        }
    }
}

#[test]
fn two_runs_take_the_same_instructions() {
    let inputs = on_host("hoist/f32/rigid/10000", 7, 2000);
    let m3 = board("m3").unwrap();
    let first = run("hoist/f32/rigid/10000", m3, &inputs);
    assert_eq!(first, run("hoist/f32/rigid/10000", m3, &inputs));
    let counts: Vec<_> = first.0.iter().map(|output| output.instructions).collect();
    // software floating point takes longer for some operands than for others
    assert!(counts.iter().min() < counts.iter().max());
}

#[test]
fn a_scene_that_does_nothing_uses_one_frame_and_writes_eight_words() {
    let inputs = on_host("empty/f32/none/10000", 1, 50);
    for &board in BOARDS {
        let (outputs, summary) = run("empty/f32/none/10000", board, &inputs);
        // the frame pointer and the return address: nothing of the loop itself reaches below the measured call
        assert_eq!((summary.stack, summary.state), (8, 0), "on {}", board.name);
        // at most an address, a zero and eight stores
        assert!(outputs.iter().all(|output| output.instructions <= 12), "{:?}", outputs[0]);
    }
}

#[test]
fn two_links_run_at_once() {
    let inputs = on_host("hoist/fixed/rigid/10000", 3, 2000);
    let alone = run("hoist/fixed/rigid/10000", BOARDS[0], &inputs);
    thread::scope(|scope| {
        let both = [0, 1].map(|_| scope.spawn(|| run("hoist/fixed/rigid/10000", BOARDS[0], &inputs)));
        for one in both {
            assert_eq!(one.join().unwrap(), alone);
        }
    });
}

#[test]
fn a_link_that_is_dropped_leaves_no_qemu_behind() {
    let image = build("empty/f32/none/10000", BOARDS[0], Program::ControlLoop, |_| {}).unwrap();
    for _ in 0..3 {
        let mut link = Link::start(&image).unwrap();
        link.exchange(&Input::default()).unwrap();
        drop(link);
    }
    let mut link = Link::start(&image).unwrap();
    link.exchange(&Input::default()).unwrap();
    assert_eq!(link.finish().unwrap().ticks, 1);
}

#[test]
fn a_qemu_that_dies_is_an_error_that_names_image_and_tick() {
    // the self-test never opens the link: it prints its line and ends
    let image = build("empty/f32/none/10000", BOARDS[0], Program::SelfTest, |_| {}).unwrap();
    let error = Link::start(&image).unwrap().exchange(&Input::default()).unwrap_err().to_string();
    for expected in ["self_test of empty/f32/none/10000 on mps2-an386 at tick 0", "QEMU has ended", "fingerprint"] {
        assert!(error.contains(expected), "{error}");
    }
}

/// SIGTERM at five moments of a run: its QEMU ends with it, and of its temporary folders none is left.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_leaves_neither_a_process_nor_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let images = [("empty/f32/none/10000", "m4f"), ("hoist/f32/reduced/10000", "m4f")];
    for (variant, core) in images {
        build(variant, board(core).unwrap(), Program::ControlLoop, |_| {}).unwrap();
    }
    let mut in_qemu = 0;
    for moment in 0..5 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
        command.args(["run", "hoist", "--variants", "f32/m4f/reduced/10000", "--json", "--html", "/dev/null"]);
        let said = tempfile::NamedTempFile::new().unwrap();
        let errors = said.reopen().unwrap();
        let mut child = command.env("TMPDIR", folder.path()).stdout(Stdio::null()).stderr(errors).spawn().unwrap();
        // QEMU stands in its folder: the signal comes then, or a little later
        let runs = || working_in(folder.path());
        while runs() == 0 && matches!(child.try_wait(), Ok(None)) {
            thread::sleep(Duration::from_millis(5));
        }
        thread::sleep(Duration::from_millis(40 * moment));
        in_qemu += usize::from(runs() > 0);
        assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
        let status = child.wait().unwrap();
        assert_eq!(status.signal(), Some(15), "{status}: {}", std::fs::read_to_string(said.path()).unwrap());
        // the kernel may still be at it
        for _ in 0..100 {
            if runs() == 0 {
                break;
            }
            thread::sleep(Duration::from_millis(10));
        }
        assert_eq!(runs(), 0, "a process is left");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "a folder is left");
    }
    assert!(in_qemu > 0, "no signal came while QEMU ran");
}

/// Processes whose working directory is below a folder.
#[cfg(target_os = "linux")]
fn working_in(folder: &Path) -> usize {
    let processes = std::fs::read_dir("/proc").unwrap().flatten();
    let place = |process: std::fs::DirEntry| std::fs::read_link(process.path().join("cwd")).ok();
    processes.filter_map(place).filter(|place| place.starts_with(folder)).count()
}

/// The learners' runs, in closed loop with the plant of a heavier motor whose torque is off: the inputs of the
/// self-tests name no run without load, and then nothing is learnt.
#[test]
fn no_load_runs_have_the_hosts_bits() {
    let by = Departure { motor_inertia: 1.1, ..Departure::NONE };
    let hook = [crane_travel::empty_hook(&by).unwrap(), crane_travel::test_weight(&by).unwrap()];
    let crane = (crane_travel::departing(&by).unwrap(), hook.to_vec());
    let mill = (blooming_mill::departing(&by).unwrap(), vec![blooming_mill::uncoupled(&by).unwrap()]);
    for (variants, (machine, runs)) in [
        (["crane-travel/f32/learnt/1000", "crane-travel/fixed/learnt/1000"], crane),
        (["blooming-mill/f32/learnt/10000", "blooming-mill/fixed/learnt/10000"], mill),
    ] {
        for variant in variants {
            let (row, board) = (find(variant).unwrap(), *BOARDS.iter().rfind(|board| belongs(variant, board)).unwrap());
            let image = build(variant, board, Program::ControlLoop, |_| {}).unwrap();
            let mut link = Link::start(&image).unwrap();
            let units = Units::new(row.words(), machine.bases);
            let offset = machine.torque_noise;
            let actuator = ActuatorErrors { offset, ..ActuatorErrors::default() };
            let imperfections = Imperfections { actuator, ..Imperfections::default() };
            let mut words = Vec::new();
            for run in &runs {
                let mut plant = run.plant.unrecorded();
                let each = |_: &_, exchanged| words.push(exchanged);
                follow(&machine, run, &units, row.rate_hz, &imperfections, &mut link, &mut plant, each).unwrap();
            }
            let learnt = [(panel::OFFSET, 0.0), (panel::INERTIA, 1.0), (panel::GAIN, 1.0)];
            for (key, told) in learnt.into_iter().take(1 + runs.len()) {
                let input = Input { asked: [key, 0], ..Input::default() };
                let output = link.exchange(&input).unwrap();
                assert_ne!(f32::from_bits(output.answer), told, "{variant} has learnt nothing");
                words.push((input, output));
            }
            link.finish().unwrap();
            assert!(row.gives(&words), "{variant} on {} and on the host have different bits", board.name);
        }
    }
}
