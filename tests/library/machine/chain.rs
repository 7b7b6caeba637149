//! Chains against the textbooks' formulas and worked examples, and the sentences of their errors.

use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Element, Error, Falls, Flow, Gap, Inertia, Length, LinearDamping, Mass,
    Match, Ratio, STANDARD_GRAVITY, Side, Stiffness, TwoMass, refer_gap, refer_inertia, refer_stiffness,
};
use serde_json::Value;

use super::{chain, damped_chain, planetary};
use crate::references::{case, data, meets};

/// The tolerance of the example files: a handful of roundings, with room.
const TEXTBOOK: f64 = 1e-12;

#[track_caller]
fn near(found: f64, expected: &Value) {
    meets(found, expected, TEXTBOOK);
}

/// Four masses, whose vibrations are as many as a reduction leaves out and one.
fn four_masses(damping: f64) -> Chain {
    damped_chain(&[0.4, 0.05, 0.2, 0.7], &[2.0e4, 9.0e3, 4.0e4], damping)
}

#[test]
fn huang_hoist() {
    let case = case("textbook_examples.json", "S06_hoist_1");
    let at = |key: &str| case[key].as_f64().unwrap();
    let hoist = |chain: Chain| {
        chain
            .gear(Ratio(at("gear_i")), Efficiency(at("eta")))
            .rotor(Inertia(1e-3))
            .drum(Diameter(at("drum_D_m")))
            .rope(Falls(at("reeving_n") as u32), Stiffness(at("rope_k_N_m_at_load")))
            .slack(Length(at("gap_m_at_load")))
            .lifted(Mass(at("load_kg")))
    };
    let chain = hoist(Chain::motor(Inertia(1.0)));
    near(chain.masses()[1], &case["expected_J_high_no_loss"]);
    near(chain.shafts()[0].stiffness, &case["expected_c_high_no_loss"]);
    near(chain.shafts()[0].gap, &case["expected_gap_rad_high_if_gap_is_at_load"]);
    near(chain.gravity_torque() / chain.efficiency(), &case["expected_M_high_start_for_weight_9.80665"]);
    near(hoist(Chain::motor(Inertia(1.0)).starting()).masses()[1], &case["expected_J_high_start"]);
    // Braking multiplies by the efficiency where starting divides.
    let ratio = hoist(Chain::motor(Inertia(1.0)).braking()).masses()[1] / chain.masses()[1];
    assert!((ratio - at("eta")).abs() < TEXTBOOK);
}

#[test]
fn wang_gears_from_either_side() {
    let case = case("textbook_examples.json", "S04_geared_1");
    let at = |key: &str| case[key].as_f64().unwrap();
    let (i, one) = (at("i"), Efficiency(1.0));
    let chain = Chain::motor(Inertia(at("J1")))
        .shaft(Stiffness(at("k1")), Damping(0.0))
        .gear(Ratio(i), one)
        .shaft(Stiffness(at("k2")), Damping(0.0))
        .rotor(Inertia(at("J2")));
    let motor = &case["expected_at_motor_shaft"];
    // Nothing lies between the two shafts: one spring in series.
    assert_eq!(chain.masses().len(), 2);
    near(chain.masses()[1], &motor["J2"]);
    near(chain.shafts()[0].stiffness, &motor["k_series"]);
    near(
        chain.reduce(Match::ResonanceAntiresonance).resonance() / core::f64::consts::TAU,
        &case["expected_two_mass_frequency_Hz_gears_neglected"],
    );
    let gears = chain_of_gears(&case);
    near(gears.masses()[1], &motor["J_gears"]);

    let load = &case["expected_at_load_shaft"];
    near(refer_inertia(at("J1"), i, 1.0, Side::Motor, Flow::Lossless), &load["J1"]);
    let k1 = refer_stiffness(at("k1"), i, 1.0, Side::Motor, Flow::Lossless);
    near(driveline::machine::series(k1, at("k2")), &load["k_series"]);
}

/// The same drive with its wheels kept as a mass of their own.
fn chain_of_gears(case: &Value) -> Chain {
    let at = |key: &str| case[key].as_f64().unwrap();
    Chain::motor(Inertia(at("J1")))
        .shaft(Stiffness(at("k1")), Damping(0.0))
        .rotor(Inertia(at("J_gear_A")))
        .gear(Ratio(at("i")), Efficiency(1.0))
        .rotor(Inertia(at("J_gear_B")))
        .shaft(Stiffness(at("k2")), Damping(0.0))
        .rotor(Inertia(at("J2")))
}

#[test]
fn wang_planetary_set() {
    let case = case("textbook_examples.json", "S07_planetary_1");
    let set = planetary(&case);
    near(1.0 / set.ratio(), &case["expected_wH_over_w1"]);
    near(set.planet_speed(), &case["expected_w2_over_w1_signed"]);
    near(set.inertia_at_sun(), &case["expected_J_at_sun"]);
    let chain = Chain::motor(Inertia(1.0)).planetary(set);
    assert_eq!(chain.ratio(), set.ratio());
    near(chain.total_inertia() - 1.0, &case["expected_J_at_sun"]);
    near(set.inertia_at_sun() * set.ratio().powi(2), &case["expected_J_at_carrier"]);
}

/// openTorsion's geared and damped example (`examples/transient_simulation.py`), referred by the chain itself.
#[test]
fn open_torsion_geared_chain() {
    let case = case("torsional_modes.json", "A15_ot_transient_geared_damped");
    let chain = Chain::motor(Inertia(0.5))
        .shaft(Stiffness(5000.0), Damping(10.0))
        .rotor(Inertia(0.1))
        .shaft(Stiffness(500.0), Damping(0.8))
        .rotor(Inertia(0.5))
        .gear(Ratio(8.0), Efficiency(1.0))
        .rotor(Inertia(0.1))
        .shaft(Stiffness(1000.0), Damping(5.0))
        .rotor(Inertia(1.0));
    let expected = &case["equivalent_chain_referred_to_drive"];
    for (j, mass) in chain.masses().iter().enumerate() {
        near(*mass, &expected["J"][j]);
    }
    for (j, shaft) in chain.shafts().iter().enumerate() {
        near(shaft.stiffness, &expected["k"][j]);
    }
    // 5 N m s/rad behind 8 : 1.
    assert_eq!(chain.shafts()[2].damping, 5.0 / 64.0);
    for (mode, expected) in
        chain.modes().resonances().iter().zip(case["expected_omega_rad_s"].as_array().unwrap()[1..].iter())
    {
        near(mode.frequency, expected);
    }
}

#[test]
fn published_two_mass_rig() {
    let file = data("two_mass_benchmarks.json");
    let case = &file["two_mass_cases"][0];
    let at = |key: &str| case[key].as_f64().unwrap();
    let rig = TwoMass::new(Inertia(at("J_motor")), Inertia(at("J_load")), Stiffness(at("k")), Damping(at("d")));
    near(rig.resonance(), &case["expected_omega_res_rad_s"]);
    near(rig.antiresonance(), &case["expected_omega_antires_rad_s"]);
    near(rig.damping_ratio(), &case["expected_zeta_res"]);
}

/// Starting and braking of the table in Huang 1987 ch. 1, in both directions.
#[test]
fn losses_are_on_the_driving_side() {
    for (side, flow, factor) in [
        (Side::Load, Flow::Motoring, 1.0 / 4.0 / 0.8),
        (Side::Load, Flow::Overhauling, 1.0 / 4.0 * 0.8),
        (Side::Motor, Flow::Motoring, 4.0 * 0.8),
        (Side::Motor, Flow::Overhauling, 4.0 / 0.8),
        (Side::Load, Flow::Lossless, 1.0 / 4.0),
    ] {
        assert_eq!(refer_inertia(1.0, 2.0, 0.8, side, flow), factor);
    }
    assert_eq!(refer_gap(0.01, 4.0, Side::Load), 0.04);
    assert_eq!(refer_gap(0.01, 4.0, Side::Motor), 0.0025);
}

/// Springs in series carry one torque: 1/k adds up, gaps add up, and the loss d (tau/k)^2 adds up.
#[test]
fn nothing_between_two_shafts_makes_them_one() {
    let chain = Chain::motor(Inertia(1.0))
        .backlash(Gap(0.001))
        .shaft(Stiffness(100.0), Damping(2.0))
        .backlash(Gap(0.01))
        .gear(Ratio(2.0), Efficiency(0.9))
        .backlash(Gap(0.1))
        .shaft(Stiffness(1200.0), Damping(12.0))
        .rotor(Inertia(8.0));
    let shaft = chain.shafts()[0];
    assert_eq!(chain.masses(), [1.0, 2.0]);
    // 100 and 1200/4 in series; 0.001 + 0.01 + 2 * 0.1; 2 (75/100)^2 + 3 (75/300)^2. Two or three roundings.
    assert!((shaft.stiffness - 75.0).abs() < 1e-13);
    assert!((shaft.gap - 0.211).abs() < 1e-15);
    assert!((shaft.damping - 1.3125).abs() < 1e-14);
    assert_eq!(chain.reduce(Match::ModalTruncation).gap, chain.total_gap());
}

/// Damping in proportion to stiffness, `d = beta k`, gives every mode the damping ratio `beta w/2` exactly.
#[test]
fn modal_damping_survives_the_reduction() {
    let beta = 1e-4;
    let chain = four_masses(beta);
    for by in [Match::ResonanceAntiresonance, Match::ModalTruncation] {
        let two = chain.reduce(by);
        assert!((two.damping_ratio() / (0.5 * beta * two.resonance()) - 1.0).abs() < 1e-12);
        assert!((two.total_inertia() / chain.total_inertia() - 1.0).abs() < 1e-14);
    }
    for mode in chain.modes().resonances() {
        assert!((mode.damping / (beta * mode.frequency * mode.frequency) - 1.0).abs() < 1e-12);
    }
}

/// Mode shapes are mass-normalised, and their residues add up to the static compliance computed from the torques.
#[test]
fn residues_add_up_to_the_static_give() {
    let chain = four_masses(0.0);
    let modes = chain.modes();
    let mut give = 0.0;
    for mode in modes.resonances() {
        let norm: f64 = chain.masses().iter().zip(mode.shape).map(|(j, phi)| j * phi * phi).sum();
        assert!((norm - 1.0).abs() < 1e-14);
        give += mode.residue / mode.frequency.powi(2);
    }
    assert!((give / chain.compliance() - 1.0).abs() < 1e-13);
}

/// The bound holds: the motor's speed after a blow, by all modes and by two masses, over a hundred periods.
#[test]
fn worst_case_bounds_the_answer_to_a_blow() {
    let chain = four_masses(0.0);
    let (modes, total) = (chain.modes(), chain.total_inertia());
    let cuts = [Match::ResonanceAntiresonance, Match::ModalTruncation, Match::TextbookCut(1), Match::TextbookShaft(1)];
    for by in cuts {
        let two = chain.reduce(by);
        let residue = two.load_inertia / (two.motor_inertia * total);
        let mut largest: f64 = 0.0;
        for n in 0..20_000 {
            let t = f64::from(n) * 100.0 * core::f64::consts::TAU / two.resonance() / 20_000.0;
            let full: f64 = modes.resonances().iter().map(|m| m.residue * (m.frequency * t).cos()).sum();
            largest = largest.max((full - residue * (two.resonance() * t).cos()).abs() * chain.masses()[0]);
        }
        println!("{by:?}: error {largest:.4}, bound {:.4}", two.error.worst);
        // Not exceeded, and not vain: a hundred periods come within a tenth of it.
        assert!(largest <= two.error.worst * (1.0 + 1e-9) && largest > 0.9 * two.error.worst);
    }
}

/// Each part left out by hand gives the change that the table tells.
#[test]
fn sensitivity_to_each_part() {
    let whole = chain(&[0.4, 0.05, 0.7], &[2.0e4, 9.0e3]);
    let series = 1.0 / (1.0 / 2.0e4 + 1.0 / 9.0e3);
    let expected = [
        (Element::Shaft(0), chain(&[0.45, 0.7], &[9.0e3])),
        (Element::Shaft(1), chain(&[0.4, 0.75], &[2.0e4])),
        (Element::Mass(1), chain(&[0.4, 0.7], &[series])),
        (Element::Mass(2), chain(&[0.4, 0.05], &[2.0e4])),
    ];
    let worth = whole.sensitivity();
    assert_eq!(worth.parts().len(), expected.len());
    for (part, (element, without)) in worth.parts().iter().zip(expected) {
        assert_eq!(part.element, element);
        let change = |f: &dyn Fn(&Chain) -> f64| f(&without) / f(&whole) - 1.0;
        // Ratios of numbers known to some 1e-15.
        assert!((part.resonance - change(&|c| c.modes().resonances()[0].frequency)).abs() < 1e-13);
        assert!((part.antiresonance - change(&|c| c.modes().antiresonances()[0])).abs() < 1e-13);
        assert!((part.compliance - change(&Chain::compliance)).abs() < 1e-13);
        assert!(part.worst() >= part.resonance.abs());
    }
    // The small mass between two shafts matters least.
    let least = worth.parts().iter().min_by(|a, b| a.worst().total_cmp(&b.worst())).unwrap();
    assert_eq!(least.element, Element::Mass(1));
}

#[test]
fn errors_name_the_parameter() {
    let motor = Chain::motor(Inertia(1.0));
    let shaft = motor.shaft(Stiffness(1.0), Damping(0.0));
    let drum = motor.drum(Diameter(1.0));
    let one = Efficiency(1.0);
    let found = [
        (Chain::motor(Inertia(0.0)), Error::MotorInertia),
        (motor.rotor(Inertia(-0.08)), Error::RotorInertia),
        (motor.rotor(Inertia(f64::NAN)), Error::RotorInertia),
        (motor.shaft(Stiffness(0.0), Damping(0.0)), Error::ShaftStiffness),
        (motor.shaft(Stiffness(1.0), Damping(-1.0)), Error::ShaftDamping),
        (motor.gear(Ratio(0.0), one), Error::GearRatio),
        (motor.gear(Ratio(2.0), Efficiency(1.01)), Error::GearEfficiency),
        (motor.gear(Ratio(2.0), Efficiency(0.0)), Error::GearEfficiency),
        (motor.drum(Diameter(f64::INFINITY)), Error::DrumDiameter),
        (motor.rope(Falls(2), Stiffness(1.0)), Error::DrumMissing),
        (motor.lifted(Mass(1.0)), Error::DrumMissing),
        (drum.rope(Falls(0), Stiffness(1.0)), Error::RopeFalls),
        (drum.rope(Falls(1), Stiffness(-1.0)), Error::RopeStiffness),
        (drum.damped_rope(Falls(1), Stiffness(1.0), LinearDamping(-1.0)), Error::RopeDamping),
        (drum.driven(Mass(0.0)), Error::LoadMass),
        (drum.slack(Length(-1.0)), Error::BacklashGap),
        (drum.shaft(Stiffness(1.0), Damping(0.0)), Error::RotaryAfterDrum),
        (drum.drum(Diameter(1.0)), Error::RotaryAfterDrum),
        (motor.backlash(Gap(-0.1)), Error::BacklashGap),
    ];
    for (result, expected) in found {
        let error = result.error().unwrap();
        assert_eq!(error, expected);
        assert_eq!(error.to_string(), expected.message());
    }
    let two = Match::ResonanceAntiresonance;
    assert_eq!(shaft.try_reduce(two), Err(Error::OpenEnd));
    assert_eq!(shaft.rotor(Inertia(1.0)).backlash(Gap(0.1)).try_reduce(two), Err(Error::BacklashAlone));
    assert_eq!(motor.try_reduce(two), Err(Error::Rigid));
    assert_eq!(shaft.rotor(Inertia(1.0)).try_reduce(Match::TextbookCut(1)), Err(Error::CutOutOfRange));
    // infinite as it is given, behind a gear, or as a sum
    let (heavy, one) = (Inertia(f64::MAX), Efficiency(1.0));
    assert_eq!(
        Chain::motor(Inertia(f64::INFINITY)).shaft(Stiffness(1.0), Damping(0.0)).rotor(heavy).try_reduce(two),
        Err(Error::MotorInertia)
    );
    assert_eq!(shaft.rotor(Inertia(f64::INFINITY)).try_reduce(two), Err(Error::RotorInertia));
    assert_eq!(shaft.gear(Ratio(0.5), one).rotor(heavy).try_reduce(two), Err(Error::RotorInertia));
    let both = shaft.rotor(heavy).rotor(heavy);
    assert_eq!(both.try_reduce(two), Err(Error::LoadInertia));
    assert!(both.shaft(Stiffness(1.0), Damping(0.0)).rotor(Inertia(1.0)).try_reduce(two).is_err());
    let mut full = motor;
    for _ in 1..driveline::machine::CAPACITY {
        full = full.shaft(Stiffness(1.0), Damping(0.0)).rotor(Inertia(1.0));
    }
    assert_eq!(full.shaft(Stiffness(1.0), Damping(0.0)).error(), Some(Error::TooManyMasses));
    assert_eq!(full.reduce(two).error.next_mode, full.modes().resonances()[1].frequency);
}

/// A weight with no gear: its torque is m g D/2.
#[test]
fn weight_and_level_mass() {
    let drum = Chain::motor(Inertia(1.0)).drum(Diameter(0.5));
    let rope = |chain: Chain| chain.rope(Falls(1), Stiffness(1.0e4));
    assert_eq!(rope(drum).lifted(Mass(10.0)).gravity_torque(), 10.0 * STANDARD_GRAVITY * 0.25);
    assert_eq!(rope(drum).driven(Mass(10.0)).gravity_torque(), 0.0);
    assert_eq!(rope(drum).driven(Mass(10.0)).masses(), rope(drum).lifted(Mass(10.0)).masses());
    assert_eq!(rope(drum).driven(Mass(10.0)).rigid().inertia, 1.0 + 10.0 * 0.0625);
}

/// Products of such inertias and stiffnesses are below the least number: no reduction's error is one.
#[test]
fn a_reduction_whose_error_is_no_number_is_refused() {
    let chain = |size: f64| {
        let motor = Chain::motor(Inertia(size));
        let shaft = |chain: Chain| chain.shaft(Stiffness(size), Damping(0.0)).rotor(Inertia(size));
        shaft(shaft(motor))
    };
    for by in [Match::ResonanceAntiresonance, Match::ModalTruncation, Match::TextbookCut(0), Match::TextbookShaft(1)] {
        assert_eq!(chain(1e-300).try_reduce(by), Err(Error::Reduction), "{by:?}");
        assert!(chain(1.0).try_reduce(by).is_ok(), "{by:?}");
    }
}
