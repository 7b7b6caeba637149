//! Dynamic factors against the full solver, and the slew limit that they choose.

use std::f64::consts::PI;

use driveline::machine::{Damping, Gap, Inertia, StartingLaw, Stiffness, Torque, TwoMass};
use driveline_solver::plant::LoadProgram;
use driveline_solver::plant::train::{Coordinate, Link, Signal, Source, Train};

use crate::references::{case, close, meets};

const MILL: TwoMass = TwoMass::new(Inertia(1.2), Inertia(0.35), Stiffness(850.0), Damping(0.0));

/// Largest and smallest torque of the shaft from rest, or from a torque that it carries.
fn peaks(machine: &TwoMass, motor: Source, load: f64, before: f64) -> [f64; 2] {
    let twist = before / machine.stiffness + 0.5 * machine.gap * before.signum();
    let mut motion = Train::new()
        .coordinate(Coordinate::new(machine.motor_inertia).source(motor))
        .coordinate(Coordinate::new(machine.load_inertia).source(Source::Constant(-load)))
        .link(Link::shaft(0, 1, machine.stiffness).gap(machine.gap).elongated(twist))
        .build()
        .unwrap();
    motion.watch(Signal::Force(0));
    // three periods, and the longest law of the tests
    motion.advance(3.0 * 2.0 * PI / machine.resonance() + 1.0);
    let extremes = motion.extremes(Signal::Force(0)).unwrap();
    [extremes.peak, extremes.least]
}

/// Largest change either way over the accelerating torque.
fn factor(motor: Source) -> f64 {
    let [peak, least] = peaks(&MILL, motor, 0.0, 0.0);
    peak.max(-least) / MILL.accelerating_torque(Torque(100.0), Torque(0.0)).0
}

#[test]
fn ramps_pulses_and_starting_laws() {
    let period = 2.0 * PI / MILL.resonance();
    // solver and closed form to rounding; extremes located
    let tolerance = 1e-9;
    for periods in [0.02, 0.3, 0.5, 0.9, 1.3, 4.7] {
        let time = periods * period;
        let ramp = Source::Program(LoadProgram::table(&[(0.0, 0.0), (time, 100.0)]));
        close(MILL.ramp_factor(time), factor(ramp), tolerance);
        let pulse = Source::Program(LoadProgram::steps(&[(0.0, 100.0), (time, 0.0)]));
        close(MILL.pulse_factor(time), factor(pulse), tolerance);
        for (law, power) in
            [(StartingLaw::Soft { torque: 100.0, time }, 1), (StartingLaw::Medium { torque: 100.0, time }, 2)]
        {
            close(MILL.law_factor(&law), factor(Source::Starting { torque: 100.0, time, power }), tolerance);
        }
    }
    assert_eq!(MILL.law_factor(&StartingLaw::Hard { torque: 100.0 }), 2.0);
    // whole periods of a ramp excite nothing: the sine of pi is left
    close(MILL.ramp_factor(3.0 * period), 1.0, 1e-15);
    assert_eq!(MILL.ramp_factor(0.0), 2.0);
    // no torque acts
    for time in [0.0, -0.1 * period] {
        for law in [StartingLaw::Soft { torque: 100.0, time }, StartingLaw::Medium { torque: 100.0, time }] {
            assert_eq!([MILL.pulse_factor(time), MILL.law_factor(&law)], [0.0; 2], "{time}");
        }
    }
    assert_eq!(MILL.slew_for_factor(Torque(100.0), 0.9), 0.0);
}

#[test]
fn a_slew_limit_holds_the_factor_that_is_allowed() {
    for allowed in [1.05, 1.3, 1.9] {
        let slew = MILL.slew_for_factor(Torque(-100.0), allowed);
        // every change up to this one has a ramp as steep: of a smaller one the torque above its mean is the same
        for change in [100.0, 63.0, 20.0] {
            let above = (MILL.ramp_factor(change / slew) - 1.0) * change;
            assert!(above <= (allowed - 1.0) * 100.0 * (1.0 + 1e-15), "{allowed} {change}: {above}");
        }
        // and one ramp with its sine at one reaches it
        let period = 2.0 * PI / MILL.resonance();
        let rate = MILL.slew_for_factor(Torque(1.0), MILL.ramp_factor(1.5 * period));
        close(rate, 1.0 / (1.5 * period), 1e-14);
    }
}

#[test]
fn reversals_and_loss_of_the_load_through_the_gap() {
    let (none, crane) = (Torque(0.0), MILL.with_gap(Gap(0.06)));
    // 40 digits: the load is lost, and the shaft turns to the other flank
    let lost = case("backlash_transients.json", "D6_crane_load_loss_const");
    meets(crane.reversal_torque(Torque(120.0), Torque(120.0), none).0, &lost["min_torque_Nm"], 1e-9);
    close(MILL.reversal_torque(Torque(120.0), Torque(120.0), none).0, 120.0 * (0.35 - 1.2) / (0.35 + 1.2), 1e-14);
    for (machine, before, motor, load) in [
        (crane, 120.0, -200.0, 20.0),
        (crane, -80.0, 150.0, 0.0),
        (MILL, 120.0, -200.0, 120.0),
        (crane, 120.0, 60.0, 110.0),
    ] {
        let [peak, least] = peaks(&machine, Source::Constant(motor), load, before);
        let expected = if before > 0.0 { least } else { peak };
        // contacts located to 1e-14 s
        close(machine.reversal_torque(Torque(before), Torque(motor), Torque(load)).0, expected, 1e-9);
    }
    // D5: the new accelerating torque brings the flank back before the gap is crossed
    let turned = case("backlash_transients.json", "D5_crane_reversal_const");
    assert_eq!(turned["events"][1]["new"], 1, "{turned}");
    assert_eq!(crane.reversal_torque(Torque(120.0), Torque(-200.0), Torque(120.0)).0, 0.0);
}

/// A gap crossed at a relative speed and nothing else: the whole energy goes into the shaft. The speed is that of the
/// transient solved with 40 digits.
#[test]
fn impact_of_a_gap() {
    let case = case("backlash_transients.json", "D4_crane_slack_gap_friction_const");
    let speed = case["closed_form"]["impact_speed_rad_s"].as_f64().unwrap();
    let at = |key: &str| case[key].as_f64().unwrap();
    assert_eq!(["J1_kg_m2", "J2_kg_m2", "c_Nm_rad"].map(at), [1.2, 0.35, 850.0]);
    let crane = MILL.with_gap(Gap(at("gap_total_rad")));
    close(crane.impact_torque(speed).0, (850.0_f64 * 1.2 * 0.35 / 1.55).sqrt() * speed, 1e-14);
}
