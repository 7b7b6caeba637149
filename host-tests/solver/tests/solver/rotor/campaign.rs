//! A balancing campaign on paper: every reading and every coefficient of `data/flexible_rotor.json`.

use driveline_solver::rotor::{Model, Polar};
use nalgebra::Complex;
use serde_json::Value;

use super::rig::{BEARING, PLANES, file, number, three_discs};

/// The file's own tolerance.
const TOLERANCE: f64 = 1e-6;

fn polar(value: &Value) -> Complex<f64> {
    Polar::degrees(number(&value[0]), number(&value[1]))
}

fn by_plane(case: &Value, key: &str) -> [Complex<f64>; 3] {
    PLANES.map(|node| polar(&case[key][node.to_string()]))
}

fn near(found: &[Complex<f64>], expected: &[Complex<f64>], of: &str) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).norm() <= TOLERANCE * b.norm(), "{of}: {a} instead of {b}");
    }
}

fn model() -> Model {
    three_discs(BEARING).build().unwrap()
}

#[test]
fn discs_are_those_of_the_file() {
    let file = file();
    let discs = [(0.28, 0.05), (0.32, 0.07), (0.28, 0.05)];
    for ((outer, width), expected) in discs.into_iter().zip(file["rotor"]["disc_mass_kg_Ip_Id"].as_array().unwrap()) {
        let disc = driveline_solver::rotor::Disc::of(outer, 0.05, width, driveline_solver::rotor::Material::STEEL);
        for (found, expected) in [disc.mass, disc.polar, disc.diametral].into_iter().zip(expected.as_array().unwrap()) {
            // the same formula by another program: rounding
            assert!((found - number(expected)).abs() <= 1e-14 * found, "{found} {expected}");
        }
    }
}

#[test]
fn influence_coefficients_at_both_speeds() {
    let (file, model) = (file(), model());
    let case = &file["cases"][0];
    for (k, speed) in case["speeds_rad_s"].as_array().unwrap().iter().enumerate() {
        let influence = model.influence(number(speed)).unwrap();
        for sensor in 0..2 {
            let row = &case["expected_influence_m_per_kg_m_re_im"][2 * k + sensor];
            let expected = [0, 1, 2].map(|p| Complex::new(number(&row[p][0]), number(&row[p][1])));
            let found: Vec<_> = influence.row(sensor).iter().copied().collect();
            near(&found, &expected, "influence");
        }
    }
}

#[test]
fn baseline_trial_runs_and_the_corrected_rotor() {
    let (file, model) = (file(), model());
    let case = &file["cases"][0];
    let unbalance = by_plane(case, "true_unbalance_kg_m_by_node");
    let trial = by_plane(case, "trial_unbalance_kg_m");
    let speeds = case["speeds_rad_s"].as_array().unwrap();
    let readings = |value: &Value| value.as_array().unwrap().iter().map(polar).collect::<Vec<_>>();
    for (speed, key) in speeds.iter().zip(["1062rpm", "1614rpm"]) {
        let baseline = model.response(number(speed), &unbalance).unwrap();
        near(&baseline, &readings(&case["baseline_m_amp_phase_deg"][key]), "baseline");
    }
    for run in case["trial_runs_m_amp_phase_deg"].as_array().unwrap() {
        let speed = number(&run["rpm"]).mul_add(std::f64::consts::PI / 30.0, 0.0);
        let plane = PLANES.iter().position(|&node| run["plane_node"] == node).unwrap();
        let mut with = unbalance;
        with[plane] += trial[plane];
        near(&model.response(speed, &with).unwrap(), &readings(&run["readings"]), "trial run");
    }
    let correction = &case["expected_LS_correction_kg_m_amp_phase_deg"];
    let corrected: Vec<_> = (0..3).map(|p| unbalance[p] + polar(&correction[p])).collect();
    for speed in speeds {
        let left = model.response(number(speed), &corrected).unwrap();
        let before = model.response(number(speed), &unbalance).unwrap();
        // the corrections are rounded to 16 digits
        assert!(left.iter().zip(&before).all(|(a, b)| a.norm() <= 1e-13 * b.norm()), "{left:?}");
    }
}

#[test]
fn one_speed_is_not_enough_for_a_flexible_rotor() {
    let (file, model) = (file(), model());
    let case = &file["cases"][0];
    let single = &case["single_speed_two_plane"];
    let mut unbalance = by_plane(case, "true_unbalance_kg_m_by_node");
    unbalance[0] += polar(&single["correction_kg_m_amp_phase_deg"][0]);
    unbalance[2] += polar(&single["correction_kg_m_amp_phase_deg"][1]);
    let speeds = case["speeds_rad_s"].as_array().unwrap();
    let baseline = number(&case["baseline_rms_m"]);
    let first = model.response(number(&speeds[0]), &unbalance).unwrap();
    assert!(first.iter().all(|x| x.norm() <= TOLERANCE * baseline));
    let second = model.response(number(&speeds[1]), &unbalance).unwrap();
    let expected = [2, 3].map(|row| polar(&single["predicted_residual_all_rows_m_amp_phase_deg"][row]));
    for (a, b) in second.iter().zip(&expected) {
        // a difference of larger vibrations, whose tolerance it takes
        assert!((a - b).norm() <= TOLERANCE * baseline, "{a} {b}");
    }
}
