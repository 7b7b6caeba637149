//! The decay of the slowest swing: against closed forms, over noise, in a gap.

use std::f64::consts::TAU;
use std::fs;
use std::process::Command;

use cargo_driveline::campaign::drive::Drive;
use cargo_driveline::campaign::ring_down::{parts, slowest};
use cargo_driveline::campaign::run::run;
use cargo_driveline::campaign::scenes::CampaignScene;
use cargo_driveline::campaign::{Draw, Figure, Tolerance};
use cargo_driveline::machine_file::parse;
use driveline_closed_loop::departure::Departure;
use driveline_lab::campaign::SCENES;
use driveline_solver::plant::{Chain, LoadProgram, Shaft};

/// Two swings and a creep, of known decays.
#[test]
fn the_parts_of_a_sum_of_exponentials_are_found() {
    let every = 0.01;
    let signal: Vec<f64> = (0..240)
        .map(|k| f64::from(k) * every)
        .map(|t| {
            3.0 * (-2.5 * t).exp() * (17.0 * t + 0.4).cos() + (-0.8 * t).exp() * (41.0 * t).sin() - (-6.0 * t).exp()
        })
        .collect();
    let mut found = parts(&signal, every).unwrap();
    found.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    let expected = [(6.0, 0.0, 1.0), (2.5, 17.0, 3.0), (0.8, 41.0, 1.0)];
    assert_eq!(found.len(), 3, "{found:?}");
    for (part, (decay, frequency, amplitude)) in found.iter().zip(expected) {
        // squares of the singular values: half of the digits
        assert!((part.decay - decay).abs() < 1e-5 && (part.frequency - frequency).abs() < 1e-5, "{part:?}");
        assert!((part.amplitude - amplitude).abs() < 1e-4, "{part:?}");
    }
    assert!((slowest(&signal, every, 0.0).unwrap() - 0.8).abs() < 1e-5);
    // the slower one has an amplitude of 1, the other of 3
    assert!((slowest(&signal, every, 2.0).unwrap() - 2.5).abs() < 1e-5);
    assert_eq!(slowest(&signal, every, 4.0), None);
    // nothing swings: a creep, and no signal at all
    let creep: Vec<f64> = (0..240).map(|k| (-0.05 * f64::from(k)).exp()).collect();
    assert_eq!([slowest(&creep, every, 0.0), slowest(&[0.0; 240], every, 0.0)], [None; 2]);
    // one that grows
    let growing: Vec<f64> = signal.iter().rev().copied().collect();
    assert!(slowest(&growing, every, 0.0).unwrap() < 0.0);
    // one that overflows, and one that is shorter than the order that is looked for
    let overflows: Vec<f64> = signal.iter().map(|value| value * f64::MAX).collect();
    assert!([&overflows[..], &signal[..100]].iter().all(|signal| slowest(signal, every, 0.0).unwrap().is_nan()));
}

/// Two free masses on a damped shaft after a blow on one: the twist decays at `d/2 (1/J1 + 1/J2)` \[derived\].
#[test]
fn a_free_machine_rings_down_as_its_damping_says() {
    let (inertias, stiffness, damping) = ([0.62, 0.4], 900.0, 1.1);
    let shaft = Shaft::elastic(stiffness).damping(damping);
    let program = LoadProgram::table(&[(0.0, 5.0), (0.01, 5.0), (0.0101, 0.0)]);
    let mut plant = Chain::motor(inertias[0]).shaft(shaft, inertias[1]).program(program).build().unwrap();
    plant.advance(0.0, 0.02);
    let sum = inertias.iter().map(|inertia| 1.0 / inertia).sum::<f64>();
    let (decay, resonance) = (0.5 * damping * sum, f64::sqrt(stiffness * sum));
    let every = TAU / resonance / 24.0;
    // means of ten ticks, as the campaign samples
    let mut mean = || {
        let mut tick = || {
            plant.advance(0.0, 0.1 * every);
            plant.shaft_torque(0)
        };
        (0..10).map(|_| tick()).sum::<f64>() / 10.0
    };
    let signal: Vec<f64> = (0..240).map(|_| mean()).collect();
    let found = slowest(&signal, every, 0.0).unwrap();
    assert!((found / decay - 1.0).abs() < 1e-6, "{found} 1/s for {decay}");
}

/// One hoist and one mill with other noise, phases of the encoder's errors and cogging: the decay scatters by less than
/// a tenth of the gain that is looked for, 1.3, in the hoist and half of it in the mill, whose encoder has 0.2 mrad.
#[test]
fn noise_hardly_moves_the_decay() {
    for (name, most) in [("hoist", 0.03), ("blooming-mill", 0.15)] {
        let scene = SCENES.iter().find(|scene| scene.name == name).unwrap();
        let draw = Draw::new(&scene.tolerances(), 1, 3);
        let fixed: Vec<Tolerance> =
            draw.values.iter().map(|&(factor, value)| Tolerance::new(factor, value, value)).collect();
        let machine = scene.departing(&Departure::NONE).unwrap();
        let drive = Drive::named(scene, &machine, None).unwrap();
        let decays: Vec<f64> = (0..8)
            .map(|number| run(scene, &drive, &Draw::new(&fixed, 2, number)).unwrap().of(Figure::RingDown))
            .collect();
        let mean = decays.iter().sum::<f64>() / decays.len() as f64;
        assert!(mean > 0.0 && decays.iter().all(|decay| (decay / mean - 1.0).abs() < most), "{name}: {decays:?}");
    }
}

/// The hoist damps the load's swing actively: by the aim at least 1.3 times as fast as the plain loop, in the median.
/// Tuned on seed 1. The crane is only required to be no slower: a damping that would bring the 1.3 excites the drive
/// shaft that its description leaves out.
#[test]
fn active_damping_takes_a_swing_away_sooner() {
    for (name, drive, least) in [("hoist", "f32/learnt/10000", 1.3), ("crane-travel", "f32/semi-implicit/1000", 1.0)] {
        let scene = SCENES.iter().find(|scene| scene.name == name).unwrap();
        let machine = scene.departing(&Departure::NONE).unwrap();
        let drives = [drive, "plain"].map(|drive| Drive::named(scene, &machine, Some(drive)).unwrap());
        let mut ratios: Vec<f64> = (0..5)
            .map(|number| {
                let draw = Draw::new(&scene.tolerances(), 3, number);
                let [damped, plain] = [0, 1].map(|k| run(scene, &drives[k], &draw).unwrap().of(Figure::RingDown));
                damped / plain
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        assert!(ratios[2] >= least, "{name}: {ratios:?}");
    }
}

/// The README's roll with teeth of 4 mrad and no load behind them, on the observer of one mass: its loop swings through
/// the gap for ever.
#[test]
fn a_swing_that_a_gap_sustains_does_not_decay() {
    let gap = "[[element]]\nkind = \"backlash\"\nlabel = \"teeth\"\ngap = 0.004\n\n";
    let roll = include_str!("../../../command/machines/roll.toml");
    let (head, tail) = roll.split_once("[[element]]\nkind = \"rotor\"").unwrap();
    let text = format!("{head}{gap}[[element]]\nkind = \"rotor\"{tail}");
    let scene = CampaignScene::of_file(parse("roll", &text).unwrap()).unwrap();
    let machine = scene.departing(&Departure::NONE).unwrap();
    let drive = |name: &str| Drive::named(&scene, &machine, Some(name)).unwrap();
    let mut sustained = 0;
    for number in 0..6 {
        let draw = Draw::new(&scene.tolerances(), 1, number);
        let [rigid, two_masses] = ["rigid", "two-mass"].map(|name| run(&scene, &drive(name), &draw).unwrap());
        if rigid.is_unstable() {
            sustained += 1;
            assert!(rigid.of(Figure::RingDown) <= 0.0, "draw {number}: {rigid:?}");
        }
        assert!(two_masses.of(Figure::RingDown) > 0.0, "draw {number}: {two_masses:?}");
    }
    assert!(sustained > 0);
}

/// A hoist of 1 kg carries 0.06 N m, so that a blow that its rope bears moves the motor by 1e-4 of a count. The rope is
/// damped more than critically, `d > 2 sqrt(k m)`: nothing swings. The counts that one copy reads and the other not
/// swung by -100 to 14 1/s.
#[test]
fn nothing_swings_in_a_hoist_that_carries_next_to_nothing() {
    let (mass, load) = (1.0, "mass = 12000.0");
    let (stiffness, damping) = (2.9e6, 3.6e3);
    assert!(damping > 2.0 * f64::sqrt(stiffness * mass));
    let text = include_str!("../../../command/machines/hoist.toml").replace(load, "mass = 1.0");
    let scene = CampaignScene::of_file(parse("hoist", &text).unwrap()).unwrap();
    let machine = scene.departing(&Departure::NONE).unwrap();
    let drive = Drive::named(&scene, &machine, Some("two-mass")).unwrap();
    for number in [2, 3, 5, 7, 14] {
        let outcome = run(&scene, &drive, &Draw::new(&scene.tolerances(), 1, number)).unwrap();
        assert_eq!((outcome.found(Figure::RingDown), outcome.is_unstable()), (None, false), "draw {number}");
    }
}

/// A hoist of 10 kg is struck by 2e-4 of rated torque. Its load swings on the rope against a motor of 1700 times its
/// inertia, and decays at `d/(2 m)`, 180 1/s. In six of these draws what the counts leave was taken for the slowest
/// swing, at -30 to 12 1/s. Where the answer stands above that, the decay is found to a third.
#[test]
fn the_swing_of_a_light_load_is_told_from_the_encoders_counts() {
    let (mass, damping) = (10.0, 3.6e3);
    let text = include_str!("../../../command/machines/hoist.toml").replace("mass = 12000.0", "mass = 10.0");
    let scene = CampaignScene::of_file(parse("hoist", &text).unwrap()).unwrap();
    let machine = scene.departing(&Departure::NONE).unwrap();
    let drive = Drive::named(&scene, &machine, Some("two-mass")).unwrap();
    let decays: Vec<f64> = [1, 23, 25, 27, 32, 49, 11, 13, 20, 30]
        .into_iter()
        .filter_map(|number| {
            let outcome = run(&scene, &drive, &Draw::new(&scene.tolerances(), 11, number)).unwrap();
            // a NaN is an answer whose parts were not found
            outcome.found(Figure::RingDown).filter(|decay| !decay.is_nan())
        })
        .collect();
    let expected = damping / (2.0 * mass);
    assert!(decays.len() >= 4, "{decays:?}");
    assert!(decays.iter().all(|decay| (decay / expected - 1.0).abs() < 0.34), "{decays:?}");
}

/// A loop that decays beside one that does not: the ratio has no number.
#[test]
fn an_infinite_ratio_is_a_word() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("roll.toml"), include_str!("../../../command/machines/roll.toml")).unwrap();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
        let output = command.arg("campaign").args(arguments).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    for drive in ["two-mass", "rigid"] {
        run(&["roll.toml", "--json", "--draws", "2", "--drive", drive, "--results", drive]);
    }
    let compared = run(&["compare", "two-mass", "rigid", "--json"]);
    let compared: serde_json::Value = serde_json::from_str(&compared).unwrap();
    let decay = compared["ratios"].as_array().unwrap().iter().find(|ratio| ratio["name"] == Figure::RingDown.name());
    assert!(decay.unwrap()["median"].is_null());
    assert!(run(&["compare", "two-mass", "rigid"]).contains("infinite"));
}
