//! The belt conveyor started by its torque limit: with the slew that follows from the allowed dynamic factor, and at
//! once.

use std::f64::consts::PI;

use driveline::configure::Machine as _;
use driveline::drive::ConfigOf;
use driveline::machine::{StartCondition, Torque};
use driveline_closed_loop::lockstep::{Moment, run};
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;
use driveline_firmware::scene::table::Words;
use driveline_firmware::scene::{FromConfig, Scene};
use driveline_firmware::scenes::belt_conveyor::{ALLOWED, AtOnce, TorqueStart};
use driveline_firmware::scenes::find;
use driveline_lab::drivetrains::SCENES;

/// The motor's limit, and at the motor the resistance to motion: 2 % of the weight of 60 t (N m).
const LIMIT: f64 = 730.0;
const RESISTANCE: f64 = 0.02 * 60_000.0 * 9.80665 * 0.02;
/// Inertias at the motor (kg m2): motor and drum, the belt.
const MOTOR: f64 = 1.8;
const BELT: f64 = 60_000.0 * 0.02 * 0.02;

/// Largest torque of the strand over the accelerating torque, and the largest speed (rad/s).
fn started(name: &str, words: Words, drive: impl Scene) -> [f64; 2] {
    let (_, machine) = SCENES.iter().find(|(scene, _)| *scene == "belt-conveyor").unwrap();
    let machine = machine().unwrap();
    let units = Units::new(words, machine.bases);
    let trace = run(&machine, &machine.scenarios[0], &units, TorqueStart::RATE_HZ, &mut OnHost(drive), |_| {}).unwrap();
    trace.recording.prove().unwrap();
    assert!(trace.moments.iter().all(|moment| moment.faults == 0), "{name}");
    let most = |of: fn(&Moment) -> f64| trace.moments.iter().map(of).fold(0.0, f64::max);
    let accelerating = (LIMIT * BELT + RESISTANCE * MOTOR) / (MOTOR + BELT);
    let found = [most(|moment| moment.truth[0]) / accelerating, most(|moment| moment.motor_speed)];
    // It stops by its resistance to motion with a third more load, 305 N m on 25.8 kg m2, which takes 13 s of 16.
    assert!(trace.moments.last().unwrap().motor_speed.abs() < 1.0, "{name}");
    println!("{name}: factor {:.3}, at most {:.1} rad/s", found[0], found[1]);
    found
}

#[test]
fn the_strand_s_dynamic_factor_is_the_allowed_one() {
    static AT_ONCE: ConfigOf<<AtOnce<f32> as FromConfig>::Drive> =
        <<AtOnce<f32> as FromConfig>::Drive>::configure::<TorqueStart>();
    let at_once = started("at once", Words::Single, AtOnce::<f32>::from_config(&AT_ONCE));
    let machine = TorqueStart::TWO_MASS;
    // Friction holds the belt until the strand carries it. The strand's damping ratio of 0.04 takes e^(-0.04 pi) of the
    // swing on its way to the peak; the ramp of the setpoint and the motor's shaft, 330 times as stiff, move it by 2 %.
    let mean = machine.accelerating_torque(Torque(LIMIT), Torque(RESISTANCE)).0;
    let undamped = machine.starting_peak(StartCondition::Slack, Torque(LIMIT), Torque(RESISTANCE)).0;
    let expected = 1.0 + (undamped / mean - 1.0) * (-0.04 * PI).exp();
    assert!((at_once[0] / expected - 1.0).abs() < 0.02, "{at_once:?} {expected}");
    for number in ["f32", "fixed"] {
        let row = find(&format!("belt-conveyor/{number}/eased/1000")).unwrap();
        let eased = started(number, row.words(), row.start());
        // The ramp lasts for omega T/2 = 1/(factor - 1) = 5, where 1 + |sin 5|/5 is 1.19 undamped.
        assert!(eased[0] <= ALLOWED && eased[0] > 1.1, "{eased:?}");
        // The slew has done its work long before the belt is up to speed, and leaves the end of the start alone. In
        // fixed point the wanted torque ends at its base, and the integral begins elsewhere: 1 % of the speed.
        assert!((eased[1] / at_once[1] - 1.0).abs() < 0.015, "{eased:?} {at_once:?}");
    }
}
