//! The mill in closed loop with its full plant, on the host: what the shaft feels, and what is
//! estimated.

use driveline::configure::Machine as _;
use driveline::design::{BacklashTakeUpTuning, Error, Rate};
use driveline::governor::{
    BacklashTakeUp, BacklashTakeUpConfig, Gains, Governor, SpeedGovernor, SpeedGovernorConfig, SymmetricLimit,
    SymmetricLimitConfig,
};
use driveline::number::{Fixed, StateOf};
use driveline::sample::Estimate;
use driveline::settings::Bases;
use driveline_closed_loop::figures::{deviations, peaks};
use driveline_closed_loop::lockstep::{Trace, run};
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;
use driveline_firmware::scenes::blooming_mill::BloomingMill;
use driveline_firmware::scenes::find;
use driveline_lab::drivetrains::blooming_mill as mill;

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

/// It gets where it is asked to: the gentleness costs time, not the speed.
#[test]
fn the_gentle_loop_reaches_its_speed() {
    let machine = mill::machine().unwrap();
    let trace = ran(&machine, "blooming-mill/f32/slack/10000");
    // half of rated speed before the first bite; a hundredth of rated is what friction leaves of an integral loop
    let before = trace.moments.iter().rfind(|moment| moment.time < 1.2).unwrap();
    assert!((before.motor_speed / machine.rated_speed - 0.5).abs() < 0.01, "{}", before.motor_speed);
}

#[test]
fn an_invalid_take_up_is_refused() {
    let machine = BloomingMill::TWO_MASS;
    let tuning = BloomingMill::TAKING_UP;
    for wrong in [
        BacklashTakeUpTuning { impact: 0.0, ..tuning },
        BacklashTakeUpTuning { torque: -1.0, ..tuning },
        BacklashTakeUpTuning { rise: f64::NAN, ..tuning },
        BacklashTakeUpTuning { fall: 0.0, ..tuning },
        BacklashTakeUpTuning { max_torque: 0.0, ..tuning },
        BacklashTakeUpTuning { max_torque: 0.5 * tuning.torque, ..tuning },
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
    assert!(BacklashTakeUpConfig::<Fixed, _>::try_new(&design, 1.0, limit, small).is_err());
    // the ramp is held back by torque over the gain
    let single = SymmetricLimitConfig { torque: 1.0_f32 };
    for gain in [0.0, -3e6, f64::INFINITY, f64::NAN] {
        let error = BacklashTakeUpConfig::<f32, _>::try_new(&design, gain, single, Bases::SI).unwrap_err();
        assert!(error.message().contains("the proportional gain"), "{gain}: {error:?}");
    }
}

/// Constants with round figures: a least reach of 10 N m, a rise of 2 and a fall of 4 N m a tick, 100 N m at most, no
/// damping, a proportional gain of 50 N m s/rad.
const ROUND: BacklashTakeUpConfig<f64, SymmetricLimitConfig<f64>> = BacklashTakeUpConfig {
    torque: 10.0,
    braking: 0.0,
    step: 2.0,
    fall: -4.0,
    max_torque: 100.0,
    damping: 0.0,
    tracking: 1.0 / 50.0,
    limit: SymmetricLimitConfig { torque: 100.0 },
};

/// A shaft torque (N m), everything at rest.
fn carrying(shaft_torque: f64) -> Estimate<f64> {
    Estimate { shaft_torque, ..Estimate::default() }
}

/// While the gap withholds torque, the ramped setpoint stays ahead of the speed by the least reach over the
/// proportional gain: 10 over 50.
#[test]
fn the_ramp_waits_for_the_take_up() {
    let gains = Gains { proportional: 50.0, reset: 0.0, ramp: 0.01 };
    let config = SpeedGovernorConfig { gains, shape: (), compensation: (), limit: ROUND, sequence: (), filter: () };
    let mut governor = <StateOf<SpeedGovernor<(), (), BacklashTakeUp<SymmetricLimit>>, f64>>::default();
    governor.start(&config, &carrying(0.0), 0.0);
    governor.set_setpoint(5.0);
    for _ in 0..1000 {
        assert!(governor.command(&config, &carrying(0.0)) <= 10.0);
    }
    // rounding of a few sums
    assert!((governor.ramped_setpoint() - 0.2).abs() < 1e-12, "{}", governor.ramped_setpoint());
}
