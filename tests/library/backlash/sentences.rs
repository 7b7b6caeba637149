//! What cannot be is refused with a sentence.

use driveline::design::{BacklashTuning, Disturbance, Encoder, Error, Rate};
use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline::observer::BacklashConfig;
use driveline::settings::Bases;

const MACHINE: TwoMass = TwoMass::new(Inertia(0.6), Inertia(0.6), Stiffness(2665.0), Damping(1.1));
const USUAL: Disturbance = Disturbance { torque_accuracy: 0.6, load_torque_step: 18.0, within: 0.5 };

fn design(machine: &TwoMass, tuning: BacklashTuning) -> Result<driveline::design::BacklashDesign, Error> {
    machine.try_backlash_observer(Rate::hz(10_000), Encoder::lines(2048), USUAL, tuning)
}

#[test]
fn a_machine_without_a_gap_and_a_tuning_out_of_range_are_refused() {
    assert_eq!(design(&MACHINE, BacklashTuning::USUAL), Err(Error::NoGap));
    let machine = MACHINE.with_gap(Gap(0.01));
    let usual = BacklashTuning::USUAL;
    for wander in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(design(&machine, BacklashTuning { wander, ..usual }), Err(Error::Wander));
        assert_eq!(design(&machine, BacklashTuning { torque_wander: wander, ..usual }), Err(Error::Wander));
    }
    for speed_wander in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(design(&machine, BacklashTuning { speed_wander, ..usual }), Err(Error::Wander));
    }
    for hold in [-0.1, f64::NAN, 1e12] {
        assert_eq!(design(&machine, BacklashTuning { hold, ..usual }), Err(Error::Hold));
    }
    // A hold of nothing is the tick of the impact itself.
    assert_eq!(design(&machine, BacklashTuning { hold: 0.0, ..usual }).unwrap().hold, 1);
    // 0.6 periods of sqrt(2 * 2665/0.6)/(2 pi) = 15.0 Hz at 10 kHz.
    assert_eq!(design(&machine, BacklashTuning::USUAL).unwrap().hold, 400);
    assert!(Error::NoGap.message().contains("backlash"));
}

#[test]
fn the_searching_gains_are_livelier_and_stable() {
    let design = design(&MACHINE.with_gap(Gap(0.01)), BacklashTuning::USUAL).unwrap();
    assert!(design.searching_radius < 1.0);
    // A twist with a larger random walk has a lower weight and a larger correction.
    assert!(design.searching[2].abs() > 2.0 * design.contact.gains[2].abs());
    assert!(design.searching_twist > design.contact.standard_deviation.twist);
}

#[test]
fn fixed_point_refuses_a_gap_wider_than_its_base() {
    let machine = MACHINE.with_gap(Gap(0.5));
    // A wander of a quarter of such a gap would need gains beyond fixed point, which is another sentence.
    let lively = design(&machine, BacklashTuning::USUAL).unwrap();
    let design = design(&machine, BacklashTuning { wander: 0.01, ..BacklashTuning::USUAL }).unwrap();
    let error = BacklashConfig::<driveline::number::Fixed>::try_new(&design, Bases::new(&machine, 200.0, 100.0));
    assert!(error.unwrap_err().message().contains("gap"));
    let wide = Bases::new(&machine, 400.0, 100.0);
    assert!(BacklashConfig::<driveline::number::Fixed>::try_new(&design, wide).is_ok());
    let error = BacklashConfig::<driveline::number::Fixed>::try_new(&lively, wide);
    assert!(error.unwrap_err().message().contains("searching gain"));
}
