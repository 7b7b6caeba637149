//! Natural frequencies and two-mass reductions against published machines and 40-digit arithmetic.

use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness};
use serde_json::Value;

fn data(name: &str) -> Value {
    let path = format!("{}/../../tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap_or_else(|| x.as_str().unwrap().parse().unwrap()))
        .collect()
}

fn chain(inertia: &[f64], stiffness: &[f64]) -> Chain {
    let mut chain = Chain::motor(Inertia(inertia[0]));
    for (j, k) in inertia[1..].iter().zip(stiffness) {
        chain = chain.shaft(Stiffness(*k), Damping(0.0)).rotor(Inertia(*j));
    }
    chain
}

fn apart(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// Every frequency, the residue at the motor, and both reductions with their cuts. Returns the worst frequency.
fn meets(id: &Value, chain: &Chain, case: &Value, limit: f64) -> f64 {
    let expected = numbers(&case["expected_omega_rad_s"]);
    let modes = chain.modes();
    assert_eq!(modes.resonances().len(), expected.len() - 1);
    let worst = modes.resonances().iter().zip(&expected[1..]).map(|(m, e)| apart(m.frequency, *e)).fold(0.0, f64::max);
    println!("{id}: worst frequency {worst:e}");
    assert!(worst < limit, "{id}");

    let two = &case["two_mass_reduction"];
    let at = |value: &Value, key: &str| value[key].as_f64().unwrap();
    let turn = core::f64::consts::TAU;
    assert!(apart(modes.antiresonances()[0], turn * at(two, "f1_antiresonance_drive_locked_Hz")) < limit, "{id}");
    assert!(apart(modes.resonances()[0].shape[0].abs(), at(two, "phi_drive_mass_normalised")) < 1e-12, "{id}");
    for (by, key) in [
        (Match::ModalTruncation, "modal_truncation_at_drive"),
        (Match::ResonanceAntiresonance, "resonance_antiresonance_fit"),
    ] {
        let (found, expected) = (chain.reduce(by), &two[key]);
        // Differences of nearly equal frequencies: a small mass keeps what the frequencies leave of it.
        for (value, name) in [(found.motor_inertia, "J_motor"), (found.load_inertia, "J_load"), (found.stiffness, "k")]
        {
            let error = apart(value, at(expected, name));
            println!("{id} {key} {name} {error:e}");
            assert!(error < 2e-12, "{id} {key} {name}: {value} {expected}");
        }
        assert!(found.error.resonance.abs() < 1e-12);
        if by == Match::ResonanceAntiresonance {
            assert!(found.error.antiresonance.abs() < 1e-12);
        }
        assert!(chain.masses().len() == 2 || found.error.next_mode == modes.resonances()[1].frequency);
    }
    for cut in two["textbook_cut"]["per_base_shaft"].as_array().unwrap_or(&Vec::new()) {
        let shaft = cut["base_shaft"].as_u64().unwrap() as usize;
        for (by, error) in [
            (Match::TextbookCut(shaft), "rel_err_series_vs_exact_f1"),
            (Match::TextbookShaft(shaft), "rel_err_base_only_vs_exact_f1"),
        ] {
            let (found, expected) = (chain.reduce(by).error.resonance, at(cut, error));
            // The errors are differences from one: absolute, in units of the frequency ratio.
            assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{id} {by:?}: {found} {expected}");
        }
    }
    worst
}

#[test]
fn published_machines() {
    for case in data("torsional_modes.json")["cases"].as_array().unwrap() {
        let equivalent = &case["equivalent_chain_referred_to_drive"];
        if equivalent.is_null() {
            continue; // branched
        }
        // 1e-13 where the file asks 1e-9: ordinary machines are no harder than the extreme ones.
        meets(&case["id"], &chain(&numbers(&equivalent["J"]), &numbers(&equivalent["k"])), case, 1e-13);
    }
}

#[test]
fn extreme_chains() {
    for case in data("torsional_modes_extreme.json")["cases"].as_array().unwrap() {
        let limit = case["rel_tol_high_relative_accuracy_f64"].as_f64().unwrap();
        meets(&case["id"], &chain(&numbers(&case["J_kg_m2"]), &numbers(&case["k_Nm_rad"])), case, limit);
    }
}
