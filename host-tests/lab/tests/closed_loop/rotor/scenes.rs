//! Scenes that are balanced: by their firmware on the host, and in QEMU.

use driveline::balancing::{Phasor, Reading};
use driveline::configure::Machine as _;
use driveline_closed_loop::ticks::OnHost;
use driveline_firmware::panel::flash_model::WORDS;
use driveline_firmware::panel::trial_weights::{Goal, TrialWeights};
use driveline_firmware::scene::balanced::{Adviser as _, Measured};
use driveline_firmware::scene::panel_keys::{DONE, Key};
use driveline_firmware::scenes::balanced_fan::BalancedFan;
use driveline_firmware::scenes::find;
use driveline_lab::balancing::{GrinderStart, Outcome, Scene, grinder, rig};
use driveline_qemu::image::{Contents, Program, board, build};

fn balanced(scene: &str, variant: &str, seed: u64) -> Outcome {
    let outcome = Scene::named(scene).unwrap().on_host(variant, seed).unwrap();
    for claim in &outcome.claims {
        assert!(claim.holds(), "{variant} from {seed}: {claim:?}\n{:#?}", outcome.stages);
    }
    outcome
}

#[test]
fn a_fan_comes_from_g_16_to_g_1() {
    let single = balanced("balanced-fan", "balanced-fan/f32/two-mass/4000", 1);
    assert!((single.stages[0].measure - 16.0).abs() < 1e-9);
    balanced("balanced-fan", "balanced-fan/fixed/two-mass/4000", 2);
}

/// The controller loses its memory after every entry, the rotor still turning: it goes on from its flash to the same
/// weights, and the rotor is balanced as well. Baseline, two trials, and twice weights and their run make seven
/// entries.
#[test]
fn a_power_cut_after_every_entry_changes_nothing() {
    for variant in ["balanced-fan/f32/two-mass/4000", "balanced-fan/fixed/two-mass/4000"] {
        let scene = Scene::named("balanced-fan").unwrap();
        let (outcome, cuts, differing) = scene.with_power_cuts(variant, None, 1).unwrap();
        assert_eq!((cuts, differing), (7, 0), "{variant}");
        for claim in &outcome.claims {
            assert!(claim.holds(), "{variant}: {claim:?}");
        }
    }
}

#[test]
fn what_the_firmware_reads_is_what_the_rotor_does() {
    // The sensors read 1.05 of the velocity 10 degrees late, and 0.95 of it 10 degrees early. Noise of a tenth of the
    // larger vibration leaves 0.1 sqrt(2/5000) = 0.2 % after some thousand ticks, and the reading may be off by 0.5 %
    // and 0.5 degrees.
    let outcome = balanced("balanced-fan", "balanced-fan/f32/two-mass/4000", 1);
    let speed = BalancedFan::RATING.speed.0;
    for (row, (read, truth)) in outcome.stages[0].read.iter().zip(&outcome.stages[0].vibration).enumerate() {
        let (gain, lag) = if row % 2 == 0 { (1.05, 10.0) } else { (0.95, -10.0) };
        let turned = (read.angle - truth.angle - 90.0 + lag + 180.0).rem_euclid(360.0) - 180.0;
        assert!((read.size / (speed * truth.size) / gain - 1.0).abs() < 0.01, "{row}: {read:?} {truth:?}");
        assert!(turned.abs() < 1.0, "{row}: {read:?} {truth:?}");
    }
}

/// A drive with all four parts: the scene claims something of each.
#[test]
fn a_grinder_with_all_four_parts_keeps_every_claim() {
    for number in 1..=12 {
        let variant =
            if number % 2 == 0 { "surface-grinder/f32/whole/10000" } else { "surface-grinder/fixed/whole/10000" };
        let row = find(variant).unwrap();
        let (course, outcome) = grinder(row.words(), &mut OnHost(row.start()), &GrinderStart::random(number)).unwrap();
        assert!(course.worst <= 1.3);
        for claim in &outcome.claims {
            assert!(claim.holds(), "{variant} from {number}: {claim:?}");
        }
    }
}

/// The drive of the board with a motor, with the panel of its main loop.
#[test]
fn the_test_rig_with_all_four_parts_keeps_every_claim() {
    for number in 1..=4 {
        let (_, claims) = rig(&GrinderStart::random(number)).unwrap();
        for claim in &claims {
            assert!(claim.holds(), "{number}: {claim:?}");
        }
    }
}

#[test]
fn a_grinder_keeps_every_claim_in_qemu_with_the_host_s_bits() {
    for (core, variant) in [("m4f", "surface-grinder/f32/whole/10000"), ("m3", "surface-grinder/fixed/whole/10000")] {
        let scene = Scene::named("surface-grinder").unwrap();
        let ran = scene.in_qemu(variant, board(core).unwrap(), 1, &|_| {}).unwrap();
        assert!(ran.same_on_host, "{variant}");
        assert!(ran.outcome.claims.iter().all(|claim| claim.holds()), "{variant}: {:?}", ran.outcome.claims);
    }
}

#[test]
fn a_scene_without_balancing_has_none_of_it() {
    let core = board("m4f").unwrap();
    let has = |variant: &str, part: &str| {
        let image = build(variant, core, Program::ControlLoop, |_| {}).unwrap();
        Contents::read(&image.path).unwrap().symbols.iter().any(|symbol| symbol.name.contains(part))
    };
    // whole functions off the tick, and the table of directions on it
    for part in ["balance", "Influence", "nalgebra", "SINGLE"] {
        assert!(!has("hoist/f32/reduced/10000", part), "{part}");
    }
    assert!(has("balanced-fan/f32/two-mass/4000", "balance"));
}

/// What a slow roll reads is taken off every later reading, and kept with the procedure's entries.
#[test]
fn the_run_out_of_a_slow_roll_is_taken_off() {
    struct Quiet;
    impl Goal for Quiet {
        const GOOD: f32 = 1e-3;
    }
    type Panel = TrialWeights<Quiet, 2, 2>;
    let measured = |re: f32, im: f32| {
        let reading = Reading {
            phasor: Phasor { re, im },
            variance: 0.0,
            turns: 4,
            ticks: 100.0,
            speed_spread: 0.0,
            drift: 0.0,
            scatter: 0.0,
        };
        Some(Measured { readings: [reading; 2], speed: 100.0 })
    };
    let read = |panel: &mut Panel| {
        assert_eq!(panel.ask(Key::Row, 0, measured(2.0, 1.0)), DONE);
        [0, 1].map(|row| [Key::RowRe, Key::RowIm].map(|key| f32::from_bits(panel.ask(key, row, None))))
    };
    let mut panel = Panel::new();
    assert_eq!(panel.ask(Key::RunOut, 0, measured(0.5, -0.25)), DONE);
    assert_eq!(read(&mut panel), [[1.5, 1.25]; 2]);
    let mut resumed = Panel::new();
    for place in 0..WORDS as u32 {
        assert_eq!(resumed.ask(Key::PutWord, panel.ask(Key::FlashWord, place, None), None), DONE);
    }
    assert_eq!(resumed.ask(Key::Resume, 0, None), DONE);
    assert_eq!(read(&mut resumed), [[1.5, 1.25]; 2]);
}
