//! The observer of backlash: its prediction through the gap against the full solver, which finds every flank to 1e-14 s,
//! its gains, and what it refuses.

use driveline::design::{BacklashDesign, BacklashTuning, Disturbance, Encoder, Error, Rate};
use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{BacklashConfig, BacklashObserver, Observer};
use driveline::settings::Bases;
use driveline_solver::plant::{Chain, Shaft};

/// Largest error of the shaft torque over its peak, predicting without corrections for one second under a torque of
/// changing sign, and the impacts met.
fn predicted(resonance_hz: f64, damping_ratio: f64) -> (f64, usize) {
    let (motor, load) = (0.6, 0.4);
    let reduced = motor * load / (motor + load);
    let w = core::f64::consts::TAU * resonance_hz;
    let (stiffness, damping) = (w * w * reduced, 2.0 * damping_ratio * w * reduced);
    let machine =
        TwoMass::new(Inertia(motor), Inertia(load), Stiffness(stiffness), Damping(damping)).with_gap(Gap(0.01));
    // Torque that twists the shaft by half the gap.
    let rated = 0.005 * stiffness;
    let disturbance = Disturbance { torque_accuracy: 0.01 * rated, load_torque_step: rated, within: 1.0 };
    let rate = 10_000;
    let design = machine.backlash_observer(Rate::hz(rate), Encoder::lines(2048), disturbance, BacklashTuning::USUAL);
    let config = BacklashConfig::<f64>::new(&design, Bases::SI);
    let mut observer = BacklashObserver::<f64>::at_rest(&config, 0, 0.0);
    let shaft = Shaft::elastic(stiffness).damping(damping).gap(0.01);
    let mut plant = Chain::motor(motor).shaft(shaft, load).build().unwrap();
    let (mut largest, mut peak) = (0.0_f64, 0.0_f64);
    // Reversals every 1.3 periods: each opens the gap and closes it, most at some other point of a tick.
    let every = (1.3 / resonance_hz * f64::from(rate)) as usize;
    let ticks = (10.0 / resonance_hz * f64::from(rate)) as usize;
    for tick in 0..ticks {
        let torque = if (tick / every).is_multiple_of(2) { rated } else { -rated };
        plant.advance(torque, 1.0 / f64::from(rate));
        let prediction = observer.predict(&config, 0, torque);
        observer.coast(prediction, 0);
        let estimate = observer.estimate(&config);
        largest = largest.max((estimate.shaft_torque - plant.shaft_torque(0)).abs());
        peak = peak.max(plant.shaft_torque(0).abs());
    }
    (largest / peak, plant.events().len())
}

#[test]
fn a_crossing_is_split_within_the_tick() {
    // The split takes the twist's way in the tick for straight. Its curvature is (omega T)^2/8 of that way, and a tick
    // changes the torque by omega T of its peak at most: (omega T)^3/8 a crossing, and four times that over some
    // fifteen crossings of either sign. The observer ends a contact where the twist is back at the gap, the plant
    // where the flank's force is zero: until then the observer's flank pulls by its damping, twice the damping ratio of
    // the peak at most.
    for (omega_t, ratio) in [(0.01, 0.0), (0.1, 0.0), (0.3, 0.0), (0.01, 0.02), (0.1, 0.05)] {
        let bound = 0.5 * f64::powi(omega_t, 3) + 2.0 * ratio;
        let (error, events) = predicted(omega_t * 10_000.0 / core::f64::consts::TAU, ratio);
        println!("omega T {omega_t}, damping ratio {ratio}: {error:.1e} of peak over {events} crossings");
        assert!(events >= 10, "{events}");
        assert!(error <= bound, "omega T {omega_t}, damping ratio {ratio}: {error:.2e}");
    }
}

const MACHINE: TwoMass = TwoMass::new(Inertia(0.6), Inertia(0.6), Stiffness(2665.0), Damping(1.1));
const USUAL: Disturbance = Disturbance { torque_accuracy: 0.6, load_torque_step: 18.0, within: 0.5 };

fn design(machine: &TwoMass, tuning: BacklashTuning) -> Result<BacklashDesign, Error> {
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
    let error = BacklashConfig::<Fixed>::try_new(&design, Bases::new(&machine, 200.0, 100.0));
    assert!(error.unwrap_err().message().contains("gap"));
    let wide = Bases::new(&machine, 400.0, 100.0);
    assert!(BacklashConfig::<Fixed>::try_new(&design, wide).is_ok());
    let error = BacklashConfig::<Fixed>::try_new(&lively, wide);
    assert!(error.unwrap_err().message().contains("searching gain"));
}
