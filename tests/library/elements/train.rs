//! Branched and closed trains: a published ship, chains seen from their middle, loops against a dense solution.

use driveline::machine::{
    Belt, Chain, Damping, Diameter, Efficiency, Error, Gap, Inertia, LinearDamping, Mass, Match, Planetary, Ratio,
    STANDARD_GRAVITY, Stiffness, Train, TwoMass,
};
use nalgebra::DMatrix;

use crate::machine::chain;
use crate::references::{case, close, data, meets};

const ONE: Ratio = Ratio(1.0);

/// Friswell et al., Dynamics of Rotating Machines, example 9.6.3: an engine, and two propellers behind gears.
#[test]
fn twin_screw_ship() {
    let case = case("torsional_modes.json", "A10_friswell_963_twin_screw_ship");
    let k = |j: usize| case["shafts"][j]["k"].as_f64().unwrap();
    // Both pinions, 200 kg m2 each, mesh with one another one to one and turn as the engine does.
    let engine = chain(&[3200.0, 400.0], &[k(0)]);
    let train = Train::of(engine).branch(1, Ratio(0.8 / 0.5), chain(&[800.0, 450.0], &[k(1)])).branch(
        1,
        Ratio(0.8 / 0.5),
        chain(&[800.0, 450.0], &[k(2)]),
    );
    let tolerance = case["rel_tol"].as_f64().unwrap();
    let modes = train.modes();
    for (mode, expected) in modes.resonances().iter().zip(&case["expected_omega_rad_s"].as_array().unwrap()[1..]) {
        meets(mode.frequency, expected, tolerance);
    }
    let expected = &case["two_mass_reduction"];
    meets(train.total_inertia(), &expected["J_total_at_drive_kg_m2"], 1e-14);
    for (by, key) in [
        (Match::ResonanceAntiresonance, "resonance_antiresonance_fit"),
        (Match::ModalTruncation, "modal_truncation_at_drive"),
    ] {
        let two = train.reduce(by);
        meets(two.motor_inertia, &expected[key]["J_motor"], tolerance);
        meets(two.load_inertia, &expected[key]["J_load"], tolerance);
        meets(two.stiffness, &expected[key]["k"], tolerance);
    }
    let two: TwoMass = train.reduce(Match::ResonanceAntiresonance);
    meets(two.antiresonance() / std::f64::consts::TAU, &expected["f1_antiresonance_drive_locked_Hz"], tolerance);
    // The propellers against one another are the second vibration; the engine feels the third as the next.
    assert!(modes.resonances()[1].residue * train.total_inertia() < 1e-20);
    meets(two.error.next_mode, &case["expected_omega_rad_s"][3], tolerance);
}

/// A chain as a train is the same chain, and so is its reduction: to a few roundings, since roots are taken in another
/// order.
#[test]
fn a_train_of_one_chain() {
    let chain = chain(&[0.4, 0.05, 0.2, 0.7], &[2.0e4, 9.0e3, 4.0e4]);
    let train = Train::of(chain);
    for (a, b) in train.modes().resonances().iter().zip(chain.modes().resonances()) {
        close(a.frequency, b.frequency, 5e-15);
        close(a.residue, b.residue, 1e-13);
    }
    for by in [Match::ResonanceAntiresonance, Match::ModalTruncation] {
        let (a, b) = (train.reduce(by), chain.reduce(by));
        close(a.motor_inertia, b.motor_inertia, 1e-13);
        close(a.load_inertia, b.load_inertia, 1e-13);
        close(a.stiffness, b.stiffness, 1e-13);
        close(a.error.next_mode, b.error.next_mode, 5e-15);
        close(a.error.next_share, b.error.next_share, 1e-13);
        // The give by residues and by torques, the sum of residues in another order.
        assert!((a.error.compliance - b.error.compliance).abs() < 1e-13);
        close(a.error.worst, b.error.worst, 1e-9);
    }
}

/// A chain with extreme ratios, with the motor in its middle: the frequencies stay those of the chain, to the same
/// digits.
#[test]
fn extreme_chains_from_their_middle() {
    for case in data("torsional_modes_extreme.json")["cases"].as_array().unwrap() {
        let number = |value: &serde_json::Value| match value.as_str() {
            Some(decimal) => decimal.parse().unwrap(),
            None => value.as_f64().unwrap(),
        };
        let numbers = |key: &str| case[key].as_array().unwrap().iter().map(number).collect::<Vec<f64>>();
        let (inertia, stiffness) = (numbers("J_kg_m2"), numbers("k_Nm_rad"));
        let expected = numbers("expected_omega_rad_s");
        let tolerance = case["rel_tol_high_relative_accuracy_f64"].as_f64().unwrap();
        for middle in 0..inertia.len() {
            let onward = chain(&inertia[middle..], &stiffness[middle..]);
            let back = |values: &[f64]| values.iter().rev().copied().collect::<Vec<f64>>();
            let mut train = Train::of(onward);
            if middle > 0 {
                // The middle mass is there already: next to nothing is added to it.
                let mut masses = back(&inertia[..=middle]);
                masses[0] = f64::MIN_POSITIVE;
                train = train.branch(0, ONE, chain(&masses, &back(&stiffness[..middle])));
            }
            let modes = train.modes();
            let above = expected.iter().filter(|omega| **omega > 0.0);
            for (mode, omega) in modes.resonances().iter().zip(above) {
                close(mode.frequency, *omega, tolerance);
            }
        }
    }
}

/// Natural frequencies of a train by a dense symmetric eigensolution of the scaled stiffness, free or with the motor
/// locked.
fn dense(train: &Train, held: bool) -> Vec<f64> {
    let n = train.masses().len();
    let mut k = DMatrix::<f64>::zeros(n, n);
    for joint in train.joints() {
        let (a, b, stiffness) = (joint.from, joint.to, joint.shaft.stiffness);
        k[(a, a)] += stiffness;
        k[(b, b)] += stiffness;
        k[(a, b)] -= stiffness;
        k[(b, a)] -= stiffness;
    }
    for i in 0..n {
        for j in 0..n {
            k[(i, j)] /= (train.masses()[i] * train.masses()[j]).sqrt();
        }
    }
    let k = if held { k.remove_row(0).remove_column(0) } else { k };
    let mut frequencies: Vec<f64> = k.symmetric_eigenvalues().iter().map(|value| value.max(0.0).sqrt()).collect();
    frequencies.sort_by(f64::total_cmp);
    if held { frequencies } else { frequencies[1..].to_vec() }
}

/// A triangle of masses with a tail, and a gear in the loop: power divided between two shafts and joined again.
fn closed() -> Train {
    Train::of(chain(&[0.4, 0.15, 0.2], &[2.0e4, 9.0e3]))
        .branch(1, Ratio(2.0), chain(&[0.1, 0.6], &[3.0e4]))
        .close(2, 3, Ratio(2.0), Stiffness(5.0e4), Damping(3.0))
        .close(0, 3, Ratio(0.5), Stiffness(4.0e3), Damping(0.0))
}

/// Loops with mild ratios: both solutions are good to 1e-13 or so.
#[test]
fn loops_against_a_dense_solution() {
    let train = closed();
    let modes = train.modes();
    for (mode, expected) in modes.resonances().iter().zip(dense(&train, false)) {
        close(mode.frequency, expected, 1e-12);
    }
    for (held, expected) in modes.antiresonances().iter().zip(dense(&train, true)) {
        close(*held, expected, 1e-12);
    }
    // Shapes are mass-normalised, and Rayleigh's quotient gives each frequency and damping again.
    for mode in modes.resonances() {
        let norm: f64 = train.masses().iter().zip(mode.shape).map(|(j, phi)| j * phi * phi).sum();
        close(norm, 1.0, 1e-13);
        let twist = |joint: &driveline::machine::Joint| (mode.shape[joint.from] - mode.shape[joint.to]).powi(2);
        let stiffness: f64 = train.joints().iter().map(|joint| joint.shaft.stiffness * twist(joint)).sum();
        let damping: f64 = train.joints().iter().map(|joint| joint.shaft.damping * twist(joint)).sum();
        close(stiffness, mode.frequency.powi(2), 1e-12);
        assert!((mode.damping - damping).abs() <= 1e-12 * damping);
    }
    let two = train.reduce(Match::ResonanceAntiresonance);
    close(two.resonance(), modes.resonances()[0].frequency, 1e-13);
    close(two.antiresonance(), modes.antiresonances()[0], 1e-13);
}

/// Equal masses with a shaft between each two: all vibrations but the turn have `n k/J`.
#[test]
fn masses_joined_each_with_each() {
    let joined = |train: Train, from, to| train.close(from, to, ONE, Stiffness(2.0e4), Damping(0.0));
    let three = joined(Train::of(chain(&[0.4; 3], &[2.0e4; 2])), 0, 2);
    let four = Train::of(chain(&[0.4; 4], &[2.0e4; 3]));
    let four = joined(joined(joined(four, 0, 3), 0, 2), 1, 3);
    for (train, count) in [(three, 3_u8), (four, 4)] {
        let modes = train.modes();
        assert_eq!(modes.resonances().len(), usize::from(count) - 1);
        let expected = (f64::from(count) * 2.0e4 / 0.4).sqrt();
        modes.resonances().iter().for_each(|mode| close(mode.frequency, expected, 1e-13));
    }
}

/// A second shaft beside the first is a loop of two: stiffnesses add up.
#[test]
fn a_shaft_beside_another_adds_its_stiffness() {
    let beside = Train::of(chain(&[0.4, 0.7], &[2.0e4])).close(0, 1, ONE, Stiffness(1.0e4), Damping(0.0));
    let thicker = chain(&[0.4, 0.7], &[3.0e4]).reduce(Match::ResonanceAntiresonance);
    let two = beside.reduce(Match::ResonanceAntiresonance);
    close(two.stiffness, thicker.stiffness, 1e-13);
    close(two.resonance(), thicker.resonance(), 1e-14);
}

/// Two equal branches swing against one another unfelt, at the lowest frequency of all; the motor's vibration is the
/// other.
#[test]
fn equal_branches_hide_a_vibration() {
    let wheel = chain(&[0.01, 0.5], &[2.0e4]);
    let train = Train::of(Chain::motor(Inertia(0.3))).branch(0, ONE, wheel).branch(0, ONE, wheel);
    let held = (2.0e4_f64 / 0.5).sqrt();
    assert_eq!(train.modes().resonances().len(), 2);
    close(train.modes().resonances()[0].frequency, held, 1e-14);
    let two = train.reduce(Match::ResonanceAntiresonance);
    // Both wheels as one: 0.32 and 1.0 kg m2 on twice the stiffness.
    close(two.motor_inertia, 0.32, 1e-13);
    close(two.load_inertia, 1.0, 1e-13);
    close(two.stiffness, 4.0e4, 1e-13);
    assert_eq!((two.error.next_mode, two.error.next_share), (f64::INFINITY, 0.0));
    assert!(two.error.worst < 1e-14);
}

#[test]
fn referred_through_the_branch() {
    let hoist =
        Chain::motor(Inertia(2.0)).backlash(Gap(0.01)).shaft(Stiffness(900.0), Damping(9.0)).rotor(Inertia(18.0));
    let train = Train::of(chain(&[0.4, 0.1], &[2.0e4])).branch(1, Ratio(3.0), hoist);
    close(train.masses()[1], 0.1 + 2.0 / 9.0, 1e-15);
    close(train.masses()[2], 2.0, 1e-15);
    let joint = train.joints()[1];
    assert_eq!((joint.from, joint.to), (1, 2));
    assert_eq!((joint.shaft.stiffness, joint.shaft.damping), (100.0, 1.0));
    close(train.total_gap(), 0.03, 1e-15);
    close(train.rigid().inertia, train.total_inertia(), 1e-15);
}

/// A hoist with a worm as a branch behind a spur gear, by hand: a weight motors through both, and drives back through
/// both; the gear before a shaft belongs to that shaft, and so does one at the end of it.
#[test]
fn losses_of_a_branch() {
    let stem = |motor: Chain| {
        motor
            .shaft(Stiffness(2.0e4), Damping(0.0))
            .gear(Ratio(3.0), Efficiency(0.97))
            .rotor(Inertia(0.9))
            .gear(Ratio(2.0), Efficiency(0.96))
            .shaft(Stiffness(8.0e4), Damping(0.0))
            .rotor(Inertia(3.6))
    };
    let hoist = hoist_from(Chain::motor(Inertia(0.3)));
    let train = Train::of(stem(Chain::motor(Inertia(0.4)))).branch(2, Ratio(6.0), hoist);
    let losses = |mass: usize| [train.efficiency(mass), train.back_efficiency(mass)];
    // products of two or three factors: a rounding each
    for (mass, expected) in
        [(0, [1.0; 2]), (1, [0.97; 2]), (2, [0.97 * 0.96; 2]), (3, [0.97 * 0.96 * 0.8, 0.97 * 0.96 * 0.6])]
    {
        close(losses(mass)[0], expected[0], 1e-15);
        close(losses(mass)[1], expected[1], 1e-15);
    }
    assert_eq!((train.joints()[2].shaft.efficiency, train.joints()[2].shaft.back_efficiency), (0.8, 0.6));
    let weight = 900.0 * STANDARD_GRAVITY * 0.25 / 120.0;
    close(train.gravity_torque(), weight, 1e-14);
    let beside = Train::of(stem(Chain::motor(Inertia(0.4)))).branch(1, Ratio(3.0), hoist);
    close(beside.gravity_torque(), 2.0 * weight, 1e-14);
    // Without losses inertias are kept; with those of motoring or overhauling the way to the branch counts in them.
    let load = 4.0 + 900.0 * 0.25 * 0.25;
    let referred =
        |train: &Train| (train.masses()[3], train.joints()[2].shaft.stiffness, train.joints()[2].shaft.damping);
    let square = 120.0_f64 * 120.0;
    let [lossless, starting, braking] = [
        train,
        Train::of(stem(Chain::motor(Inertia(0.4)).starting())).branch(2, Ratio(6.0), hoist),
        Train::of(stem(Chain::motor(Inertia(0.4)).braking())).branch(2, Ratio(6.0), hoist),
    ];
    for (train, factor) in [(lossless, 1.0), (starting, 1.0 / (0.97 * 0.96)), (braking, 0.97 * 0.96)] {
        let (inertia, stiffness, damping) = referred(&train);
        close(inertia, load / square * factor, 1e-14);
        close(stiffness, 5.0e5 / square * factor, 1e-14);
        close(damping, 7.0 / square * factor, 1e-14);
    }
    // The same chain straight on is referred alike, its own losses included.
    let own = hoist_from(Chain::motor(Inertia(0.4)).starting());
    let straight = Train::of(Chain::motor(Inertia(0.1)).starting()).branch(0, ONE, own);
    close(straight.masses()[1], load / (400.0 * 0.8), 1e-14);
    close(straight.gravity_torque(), own.gravity_torque(), 1e-15);
}

/// The losses of a planetary set or a belt are those of the shaft that ends in it; of a set on the motor, of the next.
#[test]
fn losses_belong_to_shafts() {
    let set = Planetary {
        sun_teeth: 20,
        ring_teeth: 70,
        module: 4e-3,
        planets: 3,
        sun: Inertia(0.01),
        planet: Inertia(2e-3),
        planet_mass: Mass(0.8),
        carrier: Inertia(0.2),
        efficiency: Efficiency(0.95),
    };
    let belt = Belt {
        driving: Diameter(0.1),
        driven: Diameter(0.3),
        strand: Stiffness(4.0e5),
        damping: LinearDamping(0.0),
        efficiency: Efficiency(0.9),
    };
    let motor = Chain::motor(Inertia(0.4));
    let last = |chain: Chain| chain.shaft(Stiffness(1.0e4), Damping(0.0)).rotor(Inertia(1.0));
    let losses =
        |chain: Chain| Train::of(chain).joints().iter().map(|joint| joint.shaft.efficiency).collect::<Vec<_>>();
    let shaft = motor.shaft(Stiffness(2.0e4), Damping(0.0));
    assert_eq!(losses(last(shaft.planetary(set))), [0.95, 1.0]);
    assert_eq!(losses(last(motor.planetary(set))), [0.95]);
    assert_eq!(losses(last(shaft.rotor(Inertia(0.1)).planetary(set))), [1.0, 0.95]);
    assert_eq!(losses(last(motor.belt(belt).rotor(Inertia(0.1)))), [0.9, 1.0]);
}

/// The worm hoist behind another first inertia.
fn hoist_from(motor: Chain) -> Chain {
    motor
        .worm(Ratio(20.0), Efficiency(0.8), Efficiency(0.6))
        .shaft(Stiffness(5.0e5), Damping(7.0))
        .rotor(Inertia(4.0))
        .drum(Diameter(0.5))
        .lifted(Mass(900.0))
}

#[test]
fn wrong_trains_are_refused() {
    let train = Train::of(chain(&[0.4, 0.1], &[2.0e4]));
    let branch = chain(&[0.1, 0.2], &[1.0e4]);
    assert_eq!(train.branch(2, ONE, branch).error(), Some(Error::BranchNode));
    assert_eq!(train.branch(1, Ratio(0.0), branch).error(), Some(Error::GearRatio));
    let open = Chain::motor(Inertia(1.0)).shaft(Stiffness(1.0), Damping(0.0));
    assert_eq!(train.branch(1, ONE, open).error(), Some(Error::OpenEnd));
    assert_eq!(Train::of(open).error(), Some(Error::OpenEnd));
    let close = |to: usize, k: f64, d: f64| train.close(0, to, ONE, Stiffness(k), Damping(d)).error();
    assert_eq!(close(2, 1.0, 0.0), Some(Error::BranchNode));
    assert_eq!(close(0, 1.0, 0.0), Some(Error::BranchNode));
    assert_eq!(close(1, 0.0, 0.0), Some(Error::ShaftStiffness));
    assert_eq!(close(1, 1.0, -1.0), Some(Error::ShaftDamping));
    assert_eq!(train.try_reduce(Match::TextbookCut(0)), Err(Error::TrainCut));
    assert_eq!(Train::of(Chain::motor(Inertia(1.0))).try_reduce(Match::ModalTruncation), Err(Error::Unseen));
    // Branches come before what closes loops.
    let looped = train.close(0, 1, ONE, Stiffness(1.0), Damping(0.0));
    assert_eq!(looped.branch(1, ONE, branch).error(), Some(Error::BranchNode));
    let mut full = looped;
    while full.close(0, 1, ONE, Stiffness(1.0), Damping(0.0)).error().is_none() {
        full = full.close(0, 1, ONE, Stiffness(1.0), Damping(0.0));
    }
    assert_eq!(full.joints().len(), driveline::machine::TRAIN_SHAFTS);
    let mut wide = train;
    while wide.branch(1, ONE, branch).error().is_none() {
        wide = wide.branch(1, ONE, branch);
    }
    assert_eq!(wide.masses().len(), driveline::machine::CAPACITY);
}

/// A branch on the motor itself: with the motor locked, what stands on it comes apart, and two of the three columns
/// that the frequencies are found from are orthogonal from the start.
#[test]
fn a_branch_on_the_motor() {
    let (k, j) = ([4.3e6, 2.9e6, 2.9e6], [3512.5, 712.5, 176.0, 176.0]);
    // Both branches bring half of the mass that they stand on.
    let main = chain(&[0.5 * j[0], 0.5 * j[1]], &k[..1]);
    let [first, second] = [0, 1].map(|side| chain(&[0.5 * j[side], j[2 + side]], &k[1 + side..2 + side]));
    let train = Train::of(main).branch(0, ONE, first).branch(1, ONE, second);
    // By hand: one mass on a spring, and two in a row, J1 J3 x^2 - ((k0 + k2) J3 + k2 J1) x + k0 k2 = 0.
    let (a, b, c) = (j[1] * j[3], (k[0] + k[2]) * j[3] + k[2] * j[1], k[0] * k[2]);
    let root = (b * b - 4.0 * a * c).sqrt();
    let mut expected = [2.0 * c / (b + root), k[1] / j[2], (b + root) / (2.0 * a)].map(f64::sqrt);
    expected.sort_by(f64::total_cmp);
    let modes = train.modes();
    for (found, expected) in modes.antiresonances().iter().zip(expected) {
        close(*found, expected, 1e-13);
    }
    // Resonances and antiresonances alternate, and so the load has an inertia.
    for (resonance, antiresonance) in modes.resonances().iter().zip(modes.antiresonances()) {
        assert!(*antiresonance < resonance.frequency);
    }
    assert!(train.reduce(Match::ResonanceAntiresonance).load_inertia > 0.0);
}
