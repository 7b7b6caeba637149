//! Starts of two masses against the closed forms and the transients solved with 40 digits.

use driveline::machine::{
    Damping, Gap, Inertia, Line, Rigid, Speed, StartCondition, StartingLaw, Stiffness, Torque, TwoMass,
};

use crate::references::{case, close, meets};

fn crane(id: &str) -> (TwoMass, serde_json::Value) {
    let case = case("backlash_transients.json", id);
    let at = |key: &str| case[key].as_f64().unwrap();
    let masses = (Inertia(at("J1_kg_m2")), Inertia(at("J2_kg_m2")));
    let crane = TwoMass::new(masses.0, masses.1, Stiffness(at("c_Nm_rad")), Damping(at("d_Nms_rad")));
    (crane.with_gap(Gap(at("gap_total_rad"))), case)
}

/// The cases' own tolerance for peaks; both sides are closed forms, so 1e-12 would do.
const PEAK: f64 = 1e-9;

#[test]
fn peaks_of_three_starts() {
    for (id, condition) in [
        ("D1_crane_pretensioned_const", StartCondition::Pretensioned),
        ("D2_crane_slack_nogap_active_const", StartCondition::Untensioned),
        ("D4_crane_slack_gap_friction_const", StartCondition::Slack),
    ] {
        let (crane, case) = crane(id);
        let (motor, load) = (Torque(case["motor"][1].as_f64().unwrap()), Torque(case["M2_Nm"].as_f64().unwrap()));
        meets(crane.starting_peak(condition, motor, load).0, &case["peak_torque_Nm"], PEAK);
        meets(crane.dynamic_factor(condition, motor, load), &case["K_peak_over_static"], PEAK);
    }
}

/// A gap crossed at a relative speed and nothing else: the whole energy goes into the shaft.
#[test]
fn impact_and_locked_rotor() {
    let (crane, case) = crane("D4_crane_slack_gap_friction_const");
    let speed = case["closed_form"]["impact_speed_rad_s"].as_f64().unwrap();
    let reduced = 1.2 * 0.35 / 1.55;
    close(crane.impact_torque(speed).0, (850.0_f64 * reduced).sqrt() * speed, 1e-14);
    // Too weak for the load: the motor swings against a locked load, which carries twice its torque without a gap.
    let peak = crane.with_gap(Gap(0.0)).starting_peak(StartCondition::Slack, Torque(50.0), Torque(120.0)).0;
    close(peak, 100.0, 1e-14);
}

#[test]
fn starting_times() {
    let machine = Rigid::new(Inertia(2.0));
    // 2 kg m2 to 150 rad/s with 300 - 100 N m on average.
    close(StartingLaw::Hard { torque: 300.0 }.time_to(&machine, Torque(100.0), 150.0), 1.5, 1e-14);
    for (law, mean) in [
        (StartingLaw::Medium { torque: 300.0, time: 1.0 }, 200.0),
        (StartingLaw::Soft { torque: 300.0, time: 1.0 }, 150.0),
    ] {
        let time = law.time_to(&machine, Torque(100.0), 150.0);
        close(time, 300.0 / (mean - 100.0), 1e-14);
        let law = match law {
            StartingLaw::Medium { torque, .. } => StartingLaw::Medium { torque, time },
            StartingLaw::Soft { torque, .. } => StartingLaw::Soft { torque, time },
            hard => hard,
        };
        // With that starting time the law's impulse is what the machine and the load take: the midpoint rule, with an
        // error of a quarter of the square of a piece.
        let (pieces, sum) =
            (3000, |step: f64| (0..3000).map(|j| law.torque((f64::from(j) + 0.5) * step).0 * step).sum());
        close(sum(time / f64::from(pieces)), 2.0 * 150.0 + 100.0 * time, 1e-6);
    }
    assert_eq!(StartingLaw::Soft { torque: 150.0, time: 1.0 }.time_to(&machine, Torque(100.0), 1.0), f64::INFINITY);
    // A line: half the way to the final speed in ln 2 time constants.
    let line = Line::new((Speed(150.0), Torque(100.0)), Speed(160.0));
    let end = 160.0 - 10.0 * 0.5;
    close(line.time_constant(&machine), 0.2, 1e-14);
    close(line.time_to(&machine, Torque(50.0), end / 2.0), 0.2 * 2.0_f64.ln(), 1e-13);
    assert_eq!(line.time_to(&machine, Torque(50.0), end), f64::INFINITY);
}
