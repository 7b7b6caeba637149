//! The impact of a gap against the transients solved with 40 digits.

use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};

use crate::references::{case, close};

fn crane(id: &str) -> (TwoMass, serde_json::Value) {
    let case = case("backlash_transients.json", id);
    let at = |key: &str| case[key].as_f64().unwrap();
    let masses = (Inertia(at("J1_kg_m2")), Inertia(at("J2_kg_m2")));
    let crane = TwoMass::new(masses.0, masses.1, Stiffness(at("c_Nm_rad")), Damping(at("d_Nms_rad")));
    (crane.with_gap(Gap(at("gap_total_rad"))), case)
}

/// A gap crossed at a relative speed and nothing else: the whole energy goes into the shaft.
#[test]
fn impact_of_a_gap() {
    let (crane, case) = crane("D4_crane_slack_gap_friction_const");
    let speed = case["closed_form"]["impact_speed_rad_s"].as_f64().unwrap();
    let reduced = 1.2 * 0.35 / 1.55;
    close(crane.impact_torque(speed).0, (850.0_f64 * reduced).sqrt() * speed, 1e-14);
}
