//! How many of the firmware's machines keep the defaults of `Machine`: the documentation gives the counts.

use driveline::configure::Machine;
use driveline_firmware::scenes::balanced_fan::BalancedFan;
use driveline_firmware::scenes::belt_conveyor::BeltConveyor;
use driveline_firmware::scenes::blooming_mill::BloomingMill;
use driveline_firmware::scenes::converter::Converter;
use driveline_firmware::scenes::crane_travel::CraneTravel;
use driveline_firmware::scenes::fan::Fan;
use driveline_firmware::scenes::flexible::Flexible;
use driveline_firmware::scenes::gear_drive::GearDrive;
use driveline_firmware::scenes::generator::{DieselSet, FED, TurbineSet, With};
use driveline_firmware::scenes::grinding_spindle::GrindingSpindle;
use driveline_firmware::scenes::hoist::Hoist;
use driveline_firmware::scenes::planetary::PlanetaryDrive;
use driveline_firmware::scenes::punch_press::PunchPress;
use driveline_firmware::scenes::skip_winch::SkipWinch;
use driveline_firmware::scenes::spindle::Spindle;
use driveline_firmware::scenes::strip_mill::StripMill;
use driveline_firmware::scenes::test_rig::TestRig;
use driveline_firmware::scenes::vibrating_screen::VibratingScreen;

/// Which defaults a machine keeps; the gear's where it has losses.
struct Kept {
    torque_accuracy: bool,
    torque_and_setpoint: bool,
    innovation: bool,
    gear: Option<bool>,
}

/// Equal to the last bit: what is kept is the same expression.
fn kept<M: Machine>() -> Kept {
    let usual = M::RATING.screening(M::ENCODER, M::RATE);
    Kept {
        torque_accuracy: M::DISTURBANCE.torque_accuracy == M::RATING.disturbance().torque_accuracy,
        torque_and_setpoint: (M::SCREENING.torque, M::SCREENING.setpoint) == (usual.torque, usual.setpoint),
        innovation: M::SCREENING.innovation == usual.innovation,
        gear: (M::CHAIN.efficiency() < 1.0).then(|| M::GEAR.deadband == 8.0 * M::ENCODER.resolution().unwrap()),
    }
}

#[test]
fn the_documentation_counts_the_machines_that_keep_a_default() {
    let machines = [
        kept::<BalancedFan>(),
        kept::<BeltConveyor>(),
        kept::<BloomingMill>(),
        kept::<Converter>(),
        kept::<CraneTravel>(),
        kept::<Fan>(),
        kept::<Flexible>(),
        kept::<GearDrive>(),
        kept::<With<DieselSet, FED>>(),
        kept::<With<TurbineSet, FED>>(),
        kept::<GrindingSpindle>(),
        kept::<Hoist<10_000>>(),
        kept::<PlanetaryDrive>(),
        kept::<PunchPress>(),
        kept::<SkipWinch>(),
        kept::<Spindle>(),
        kept::<StripMill>(),
        kept::<TestRig>(),
        kept::<VibratingScreen>(),
    ];
    let all = machines.len();
    let count = |of: fn(&Kept) -> bool| machines.iter().filter(|kept| of(kept)).count();
    let lossy = machines.iter().filter_map(|kept| kept.gear).collect::<Vec<_>>();
    let text: String = include_str!("../../../../../src/configure/machine.rs").replace("\n    /// ", " ");
    for sentence in [
        format!("The torque's 1 % is kept by {} of {all}.", count(|kept| kept.torque_accuracy)),
        format!("Torque and setpoint are kept by {} of {all},", count(|kept| kept.torque_and_setpoint)),
        format!("the innovation by {} of {all}.", count(|kept| kept.innovation)),
        format!(
            "{} of {} machines with a lossy gear keep it.",
            lossy.iter().filter(|kept| **kept).count(),
            lossy.len()
        ),
    ] {
        assert!(text.contains(&sentence), "src/configure/machine.rs should say: {sentence}");
    }
}
