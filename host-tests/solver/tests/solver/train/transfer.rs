//! Natural frequencies by transfer matrices, by Holzer and by Jacobi: the same numbers by three roads.

use driveline_solver::plant::modes::{System, holzer, transfer};
use serde::Deserialize;

#[derive(Deserialize)]
struct Cases {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    id: String,
    equivalent_chain_referred_to_drive: Option<Equivalent>,
    expected_omega_rad_s: Vec<f64>,
    rel_tol: f64,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Equivalent {
    J: Vec<f64>,
    k: Vec<f64>,
}

#[test]
fn the_three_ways_agree_on_every_published_chain() {
    let cases =
        serde_json::from_str::<Cases>(include_str!("../../../../../tests/data/torsional_modes.json")).unwrap().cases;
    let mut chains = 0;
    for case in &cases {
        let Some(chain) = &case.equivalent_chain_referred_to_drive else { continue };
        chains += 1;
        let mut system = System::new(&chain.J);
        for (s, &k) in chain.k.iter().enumerate() {
            system = system.shaft(s, s + 1, k, 0.0);
        }
        let jacobi = system.frequencies().unwrap();
        let expected: Vec<f64> = case.expected_omega_rad_s.iter().copied().filter(|&w| w > 0.0).collect();
        let found = transfer::frequencies(&chain.J, &chain.k);
        assert_eq!(found.len(), expected.len(), "{}", case.id);
        for ((&by_transfer, &by_jacobi), &omega) in found.iter().zip(&jacobi[1..]).zip(&expected) {
            assert!((by_transfer - omega).abs() <= case.rel_tol * omega, "{}: {by_transfer} for {omega}", case.id);
            // ways that share no step agree to the rounding of a dozen discs
            assert!((by_transfer - by_jacobi).abs() <= 1e-12 * omega, "{}: {by_transfer} {by_jacobi}", case.id);
            let (low, high) = (omega * (1.0 - 1e-6), omega * (1.0 + 1e-6));
            let by_holzer = holzer::frequency_between(&chain.J, &chain.k, low, high).unwrap();
            // Holzer's residual torque loses digits as the chain's frequencies spread
            assert!((by_transfer - by_holzer).abs() <= 1e-9 * omega, "{}: {by_transfer} {by_holzer}", case.id);
            // and the matrix of the whole chain turns its sign there
            let torque = |omega: f64| transfer::chain(&chain.J, &chain.k, omega)[1][0];
            assert!(torque(low) * torque(high) < 0.0, "{}: {omega}", case.id);
        }
    }
    assert_eq!(chains, 4);
}

#[test]
fn with_the_first_disc_held_the_matrix_gives_the_antiresonance() {
    // two discs: held, the second swings at sqrt(k/J2)
    let omega = (800.0_f64 / 2.0).sqrt();
    let whole = transfer::chain(&[0.5, 2.0], &[800.0], omega);
    // 1 - J2 omega^2/k, of order one but at the root
    assert!(whole[1][1].abs() < 1e-14, "{whole:?}");
}

#[test]
fn they_agree_on_chains_of_any_length() {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // three decades
        1000.0_f64.powf((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    for discs in 2..14 {
        let inertia: Vec<f64> = (0..discs).map(|_| random()).collect();
        let stiffness: Vec<f64> = (1..discs).map(|_| 1e4 * random()).collect();
        let mut system = System::new(&inertia);
        for (s, &k) in stiffness.iter().enumerate() {
            system = system.shaft(s, s + 1, k, 0.0);
        }
        let jacobi = system.frequencies().unwrap();
        let transfer = transfer::frequencies(&inertia, &stiffness);
        assert_eq!(transfer.len(), discs - 1);
        for (a, b) in transfer.iter().zip(&jacobi[1..]) {
            // pivots lose digits by the ratio of neighbouring stiffnesses, three decades
            assert!((a - b).abs() <= 1e-11 * b, "{discs}: {a} {b}");
        }
    }
}
