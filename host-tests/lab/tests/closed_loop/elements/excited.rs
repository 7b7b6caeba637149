//! The scenes whose machines excite themselves, by unbalance and by teeth: what their full plants do, and that their
//! runs are proven.

use super::scenes::selection;
use driveline::configure::{HasBarredSpeeds as _, Machine as _};
use driveline::design::{ObserverChoice, USUAL_MARGIN};
use driveline::drive::ConfigOf;
use driveline_closed_loop::lockstep::{Trace, run};
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::{FromConfig, Scene};
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::gear_drive::{self, GearDrive};
use driveline_firmware::scenes::vibrating_screen::{self, Plain, VibratingScreen};
use driveline_lab::drivetrains::{gear_drive as gears, vibrating_screen as screen};
use driveline_solver::plant::train::{GearPair, Signal};

/// `found` is `expected` within a relative tolerance.
#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() <= tolerance, "{found}, not {expected}");
}

fn ran(machine: &Machine, scene: impl Scene, duration: f64) -> Trace {
    let mut scenario = machine.scenarios[0].clone();
    scenario.duration = duration;
    let units = Units::new(Words::Single, machine.bases);
    run(machine, &scenario, &units, VibratingScreen::RATE_HZ, &mut OnHost(scene), |_| {}).unwrap()
}

/// Two of the plant's modes are those of box and frame on their springs, which the governor bars.
#[test]
fn the_critical_speeds_of_the_screen_are_those_of_its_springs() {
    let omega = screen::train().modes().unwrap().omega;
    for (critical, range) in vibrating_screen::CRITICAL.iter().zip(VibratingScreen::BARRED.ranges()) {
        // both are the roots of the same equation, one by a closed form and one by an eigenvalue solver
        assert!(omega.iter().any(|w| (w / critical - 1.0).abs() < 1e-9), "{critical} of {omega:?}");
        close(range[0], (1.0 - USUAL_MARGIN) * critical, 1e-12);
        close(range[1], (1.0 + USUAL_MARGIN) * critical, 1e-12);
    }
    // The torsional one, motor against exciter, lies above twice the speed, where the box's push is.
    assert!(omega.last().unwrap() > &(2.0 * 1.2 * VibratingScreen::RATING.speed.0), "{omega:?}");
}

/// Peak travel of the box against the frame below the speed that a run reaches, and how long it dwelt in the upper
/// barred range.
fn passed(name: &str, scene: impl Scene) -> (f64, f64) {
    let mut machine = screen::machine().unwrap();
    let mut motion = screen::train().build().unwrap();
    motion.watch(Signal::Elongation(screen::SPRINGS));
    machine.scenarios[0].plant = Body::train(motion, &[]);
    let trace = ran(&machine, scene, 3.0);
    let travel = trace.recording.motion().unwrap().extremes(Signal::Elongation(screen::SPRINGS)).unwrap();
    let [low, high] = VibratingScreen::BARRED.ranges()[1];
    let inside = trace.moments.iter().filter(|moment| (low..=high).contains(&moment.truth[1])).count();
    assert!(trace.moments.last().unwrap().truth[1] > high);
    let torque = trace.moments.iter().map(|moment| moment.truth[0].abs()).fold(0.0, f64::max);
    let most = travel.peak.max(-travel.least);
    let dwelt = inside as f64 / f64::from(VibratingScreen::RATE_HZ);
    println!("{}: {:.1} mm of travel, {dwelt:.3} s in the range, shaft torque {torque:.0} N m", name, 1e3 * most);
    (most, dwelt)
}

/// The quick ramp halves the time in the range, and the box swings less.
#[test]
fn the_screen_passes_its_resonance_quickly() {
    static PLAIN: ConfigOf<<Plain<f32> as FromConfig>::Drive> =
        <<Plain<f32> as FromConfig>::Drive>::configure::<VibratingScreen>();
    let quick = passed("quick", find("vibrating-screen/f32/exact/4000").unwrap().start());
    let plain = passed("plain", Plain::<f32>::from_config(&PLAIN));
    assert!(quick.1 < 0.6 * plain.1 && quick.0 < plain.0, "{quick:?} against {plain:?}");
}

/// A run-up by a steady torque passes the wheels' resonance and the fractions of the mesh's: the teeth carry more than
/// the torque asks for, with an error on every second tooth more than without, and do not part.
#[test]
fn the_teeth_excite_the_gear_drive() {
    let torque = 1.2 * GearDrive::RATING.torque.0;
    // what is left for the mesh when the motor's own inertia has been brought up
    let machine = GearDrive::TWO_MASS;
    let through = torque * (1.0 - 0.4 / (machine.motor_inertia + machine.load_inertia));
    let mut factors = Vec::new();
    for error in [gears::TOOTH_ERROR, 0.0] {
        let mut motion = gears::train(error).build().unwrap();
        motion.set_torque(0, torque);
        motion.advance(0.2);
        motion.watch(Signal::Force(GearPair::MESH));
        // a tick holds no more than a thousand events, and every tooth brings two
        (0..1600).for_each(|_| motion.advance(1e-3));
        let force = motion.extremes(Signal::Force(GearPair::MESH)).unwrap();
        let factor = force.peak * gear_drive::BASE_RADII[0] / through;
        println!("error {error}: mesh force {:.0} to {:.0} N, dynamic factor {factor:.2}", force.least, force.peak);
        // they meet and part while the step of the torque rings down; from then on they keep contact
        assert!(motion.events().iter().all(|event| event.time < 0.1), "{:?}", motion.events());
        assert!(force.least > 0.0 && motion.speed(0) > GearDrive::RATING.speed.0, "{force:?}");
        factors.push(factor);
    }
    assert!(factors[1] > 1.1 && factors[0] > factors[1], "{factors:?}");
}

/// Two masses for the one, whose box pushes at speed with `S^2 w^2/2M` either way, twice a turn, and for the other, with
/// a load step within 20 ms, by what leaving out the shaft would cost.
#[test]
fn both_need_two_masses() {
    let (torque, speed) = (VibratingScreen::RATING.torque.0, VibratingScreen::RATING.speed.0);
    let push = (vibrating_screen::UNBALANCE * speed).powi(2) / vibrating_screen::MASSES[0];
    let quarter = 0.5 * core::f64::consts::PI / speed;
    let screen = selection::<VibratingScreen>([2.0 * torque, push], [quarter; 2], true);
    let gears = selection::<GearDrive>([1.5, 0.5].map(|share| share * GearDrive::RATING.torque.0), [0.02, 0.5], false);
    for need in [screen, gears] {
        assert_eq!(need.chosen, ObserverChoice::Exact);
        assert!(need.without_shaft.shaft_torque > 0.02, "{need:?}");
    }
}

/// The solver's runs agree with another integrator within 1e-8 of the peaks: their beginnings here, all of them in
/// `cargo lab run`.
#[test]
fn their_runs_are_proven() {
    let machine = screen::machine().unwrap();
    ran(&machine, find("vibrating-screen/f32/exact/4000").unwrap().start(), 2.5).recording.prove().unwrap();
    let machine = gears::machine().unwrap();
    ran(&machine, find("gear-drive/f32/exact/4000").unwrap().start(), 0.3).recording.prove().unwrap();
}
