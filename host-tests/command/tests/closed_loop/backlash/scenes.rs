//! The mill and the converter in closed loop with their full plants, on the host: what the shaft feels, and what is
//! estimated.

use cargo_driveline::closed_loop::ticks::OnHost;
use cargo_driveline::closed_loop::units::Units;
use cargo_driveline::drivetrains::figures::{deviations, peaks};
use cargo_driveline::drivetrains::lockstep::{Trace, run};
use cargo_driveline::drivetrains::scenario::Machine;
use cargo_driveline::drivetrains::{blooming_mill as mill, converter};
use driveline::configure::HasBacklash as _;
use driveline::configure::Machine as _;
use driveline::design::{BacklashTakeUpTuning, Error, Rate};
use driveline::governor::{BacklashTakeUpConfig, SymmetricLimitConfig};
use driveline::number::Fixed;
use driveline::settings::Bases;
use driveline_firmware::scenes::blooming_mill::BloomingMill;
use driveline_firmware::scenes::find;

fn ran(machine: &Machine, variant: &str) -> Trace {
    let row = find(variant).unwrap();
    let units = Units::new(row.words(), machine.bases);
    let trace = run(machine, &machine.scenarios[0], &units, row.rate_hz, &mut OnHost(row.start()), |_| {}).unwrap();
    let faults = trace.moments.iter().fold(0, |all, moment| all | moment.faults);
    assert_eq!(faults, 0, "{variant}: {faults:x}");
    trace
}

/// Peak of the shaft torque, and the rms errors of shaft torque over its peak and of load speed over rated.
fn figures(machine: &Machine, variant: &str) -> [f64; 3] {
    let trace = ran(machine, variant);
    let [torque, _, load] = peaks([&trace].into_iter());
    let errors = deviations([&trace].into_iter(), [torque, machine.rated_speed, load]);
    println!(
        "{variant}: peak {torque:.3e} N m, shaft torque {:.2} % rms, load speed {:.2} % rms",
        100.0 * errors[0].rms,
        100.0 * errors[1].rms
    );
    [torque, errors[0].rms, errors[1].rms]
}

/// The project's figures: at most 70 % of the peak under a plain speed loop, and the shaft torque within 6 % rms of its
/// peak through backlash.
#[track_caller]
fn gentler(machine: &Machine, plain: &str, slack: &str) {
    let (rough, gentle) = (figures(machine, plain), figures(machine, slack));
    println!("{slack}: {:.1} % of the plain loop's peak", 100.0 * gentle[0] / rough[0]);
    assert!(gentle[0] <= 0.7 * rough[0], "{slack}: {gentle:?} against {rough:?}");
    assert!(gentle[1] <= 0.06 && rough[1] <= 0.06, "{slack}: {gentle:?} and {rough:?}");
}

#[test]
fn the_mill_reverses_gently() {
    let machine = mill::machine().unwrap();
    for number in ["f32", "fixed"] {
        gentler(
            &machine,
            &format!("blooming-mill/{number}/backlash/10000"),
            &format!("blooming-mill/{number}/slack/10000"),
        );
        figures(&machine, &format!("blooming-mill/{number}/exact/10000"));
    }
}

#[test]
fn the_converter_tilts_gently() {
    let machine = converter::machine().unwrap();
    for number in ["f32", "fixed"] {
        gentler(&machine, &format!("converter/{number}/plain/10000"), &format!("converter/{number}/slack/10000"));
    }
}

/// It gets where it is asked to: the gentleness costs time, not the speed.
#[test]
fn the_gentle_loop_reaches_its_speed() {
    let machine = converter::machine().unwrap();
    let trace = ran(&machine, "converter/f32/slack/10000");
    // At the end of the tilting forwards, before the reversal at 5.5 s; a hundredth of rated is what the changing load
    // leaves of an integral loop.
    let before = trace.moments.iter().rfind(|moment| moment.time < 5.5).unwrap();
    assert!((before.motor_speed - machine.rated_speed).abs() < 0.01 * machine.rated_speed, "{}", before.motor_speed);
}

#[test]
fn a_taking_up_that_cannot_be_is_refused() {
    let machine = BloomingMill::TWO_MASS;
    let tuning = BloomingMill::TAKING_UP;
    for wrong in [
        BacklashTakeUpTuning { impact: 0.0, ..tuning },
        BacklashTakeUpTuning { torque: -1.0, ..tuning },
        BacklashTakeUpTuning { rise: f64::NAN, ..tuning },
        BacklashTakeUpTuning { max_torque: 0.0, ..tuning },
        BacklashTakeUpTuning { damping: -0.1, ..tuning },
    ] {
        assert_eq!(machine.try_take_up(Rate::hz(10_000), wrong), Err(Error::Slack));
    }
    // The creep at which the impact adds what was allowed: impact over sqrt(k J_m J_l/(J_m + J_l)), in full digits.
    let design = machine.take_up(Rate::hz(10_000), tuning);
    let wave = (machine.stiffness * 120_000.0 * 22_000.0 / 142_000.0).sqrt();
    assert!((design.approach_speed * wave / tuning.impact - 1.0).abs() < 1e-12);
    assert_eq!(design.braking, design.torque / design.approach_speed);
    let small = Bases { torque: 1e5, ..BloomingMill::BASES };
    let limit = SymmetricLimitConfig { torque: Fixed::ONE };
    assert!(BacklashTakeUpConfig::<Fixed, _>::try_new(&design, limit, small).is_err());
}
