//! Natural frequencies, critical speeds and the Campbell diagram.

use std::f64::consts::TAU;

use driveline_solver::rotor::{Bearing, Direction, Modal, RigidRotor, WhirlSense};

use super::rig::{BEARING, file, number, three_discs};

#[test]
fn natural_frequencies_at_rest_are_those_of_ross() {
    let file = file();
    let modal = Modal::of(&three_discs(BEARING).build().unwrap()).unwrap();
    let at_rest = modal.campbell(&[0.0], 4).unwrap();
    let expected = file["rotor"]["ross_wn_at_rest_Hz"].as_array().unwrap();
    for (natural, expected) in at_rest.whirls[0].iter().zip(expected) {
        let hz = natural.undamped / TAU;
        // the file's own pairs, which are equal in truth, differ by 1e-10
        assert!((hz - number(expected)).abs() <= 1e-8 * hz, "{hz} Hz instead of {expected}");
    }
}

#[test]
fn forward_critical_speeds_are_those_of_the_file() {
    let file = file();
    // the file's are those without damping
    let modal = Modal::of(&three_discs(BEARING).build().unwrap()).unwrap();
    let forward: Vec<f64> =
        modal.criticals().iter().filter(|c| c.sense == WhirlSense::Forward).map(|c| c.speed / TAU).collect();
    for (found, expected) in
        forward.iter().zip(file["rotor"]["synchronous_forward_criticals_Hz_own_FE"].as_array().unwrap())
    {
        assert!((found - number(expected)).abs() <= 1e-6 * found, "{found} Hz instead of {expected}");
    }
}

#[test]
fn an_undamped_whirl_meets_the_speed_where_the_campbell_diagram_says() {
    let bearing = Bearing::anisotropic([4e6, 2e6], [0.0, 0.0]);
    let model = three_discs(bearing).build().unwrap();
    let modal = Modal::of(&model).unwrap();
    for critical in &modal.criticals()[..6] {
        let naturals = modal.campbell(&[critical.speed], 8).unwrap();
        let nearest = naturals.whirls[0].iter().map(|n| (n.frequency / critical.speed - 1.0).abs());
        // two ways, one Hermitian and one not, in numbers of one size: rounding and the Schur form's 1e-13 of the
        // largest of some 3e5 rad/s
        assert!(nearest.fold(f64::INFINITY, f64::min) <= 1e-8, "{critical:?}");
        // and the vibration there is large: 1e-5 beside it, some 1e4 times as much as at twice the distance of a tenth
        let at = |speed: f64| model.influence(speed).unwrap().iter().map(|a| a.norm()).fold(0.0, f64::max);
        assert!(at(critical.speed * (1.0 + 1e-6)) > 1e3 * at(critical.speed * 1.01), "{critical:?}");
    }
}

#[test]
fn a_tilting_disc_whirls_as_the_closed_form_says() {
    // Pure tilt on symmetric supports: Id w^2 - Ip Omega w - k a^2 2 = 0 for the forward whirl, + for the backward one.
    let (mass, polar, diametral, stiffness, half) = (20.0, 0.5, 0.3, 1e6, 0.2);
    let model = RigidRotor::new(mass, polar, diametral)
        .bearing(-half, Bearing::isotropic(stiffness, 0.0))
        .bearing(half, Bearing::isotropic(stiffness, 0.0))
        .station(half)
        .sensor(half, Direction::X)
        .build()
        .unwrap();
    let modal = Modal::of(&model).unwrap();
    let speed: f64 = 300.0;
    let tilt = 2.0 * stiffness * half * half;
    let root = (polar * speed).hypot(2.0 * (diametral * tilt).sqrt());
    let (forward, backward) = ((polar * speed + root) / (2.0 * diametral), (root - polar * speed) / (2.0 * diametral));
    let bounce = (2.0 * stiffness / mass).sqrt();
    let mut expected =
        [(bounce, None), (bounce, None), (forward, Some(WhirlSense::Forward)), (backward, Some(WhirlSense::Backward))];
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found = modal.campbell(&[speed], 4).unwrap();
    for (natural, (frequency, sense)) in found.whirls[0].iter().zip(expected) {
        // an eigenvalue of an 8 x 8 matrix: rounding
        assert!((natural.frequency / frequency - 1.0).abs() < 1e-12, "{natural:?} {frequency}");
        assert!(sense.is_none_or(|sense| natural.sense == sense), "{natural:?}");
    }
    // A disc with Ip > Id outruns its forward whirl: bounce forward and backward, and a backward tilt.
    let criticals = modal.criticals();
    assert_eq!(criticals.len(), 3, "{criticals:?}");
    let backward = (tilt / (diametral + polar)).sqrt();
    assert!(criticals.iter().any(|c| (c.speed / backward - 1.0).abs() < 1e-12 && c.sense == WhirlSense::Backward));
}

#[test]
fn the_lowest_vibrations_give_the_lowest_whirls() {
    // What the command's diagram keeps: 32 of 52 vibrations for eight whirls, good to a line's width.
    let model = three_discs(BEARING).build().unwrap();
    let speeds = [0.0, 300.0, 600.0];
    let [whole, kept] = [52, 32].map(|count| Modal::lowest(&model, count).unwrap().campbell(&speeds, 8).unwrap());
    for (a, b) in whole.whirls.iter().flatten().zip(kept.whirls.iter().flatten()) {
        assert!((a.frequency / b.frequency - 1.0).abs() < 2e-3, "{a:?} {b:?}");
        assert!((a.damping_ratio - b.damping_ratio).abs() < 2e-3, "{a:?} {b:?}");
    }
}
