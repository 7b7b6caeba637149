//! The link to QEMU against the same scene on the host, bit for bit.

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
