//! The observer of a cranked machine against a motion of own arithmetic: a press whose inertia at the motor swings by a
//! third.
//!
//! The inertia of the truth is the full solver's, the motion a Runge-Kutta integration, whose own error is far below a
//! count of the encoder.

mod balanced;
mod laws;
mod learnt;
mod rig;
mod tonnage;

use std::f64::consts::TAU;

use driveline::design::{Disturbance, Encoder, Error, MechanismDesign, Rate, RigidDesign};
use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism, Rigid};
use driveline::number::{Fixed, Number};
use driveline::observer::{MechanismConfig, MechanismObserver, Observer, RigidConfig, RigidObserver};
use driveline::settings::Bases;
use driveline_solver::plant::train::Orders;

use self::rig::{Drawn, Machine};

const RATE_HZ: u32 = 10_000;
const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.5), Inertia(4.0), Mass(4_000.0));
/// A small flywheel, so that the inertia swings: 0.54 to 0.96 kg m2 at the motor.
const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(0.5), &Mechanism::slider_crank(&RAM), 1, 10);
const USUAL: Disturbance = Disturbance { torque_accuracy: 1.0, load_torque_step: 60.0, within: 0.05 };
const DESIGN: MechanismDesign = PRESS.observer(Rate::hz(RATE_HZ), Encoder::lines(2048), USUAL);
const MEAN: RigidDesign =
    Rigid::new(Inertia(PRESS.mean_inertia())).observer(Rate::hz(RATE_HZ), Encoder::lines(2048), USUAL);
const BASES: Bases = Bases::rigid(1_200.0, 200.0);

/// The press as the truth has it, at 100 rad/s.
fn press() -> Machine {
    let reach = |phi: f64| (0.25 - (0.1 * phi.sin()).powi(2)).sqrt();
    let way = Orders::sampled(|phi| 0.6 - 0.1 * phi.cos() - reach(phi));
    let (mechanism, inertia) = (Mechanism::slider_crank(&RAM), Orders::inertia(&[(4_000.0, &way)]));
    let mut press = Machine::new(&Drawn { mechanism, inertia, way }, 0.0, 0.0);
    (press.constant, press.speed) = (0.5 + 4.0 / 100.0, 100.0);
    press
}

/// Root mean square errors of load torque and shaft torque (N m) and of speed (rad/s) over a second in which the motor
/// holds 100 rad/s against an arc of load on each turn of the crank; the first half, in which the estimate settles, is
/// left out.
fn errors<N: Number, O: Observer<N>>(config: &O::Config, bases: Bases) -> [f64; 3] {
    let Bases { torque: torque_base, speed: speed_base, .. } = bases;
    let mut press = press();
    let number = |value: f64| {
        N::from_word(if N::ONE.to_word() == 1.0_f32.to_bits() {
            (value as f32).to_bits()
        } else {
            Fixed::from_f64(value).to_bits() as u32
        })
    };
    let mut observer = O::steady(config, 0, number(0.0), number(100.0 / speed_base));
    let (mut squares, mut count) = ([0.0; 3], 0.0);
    for tick in 0..2 * RATE_HZ {
        let crank = (press.angle / 10.0).rem_euclid(TAU);
        // Half a sine over an eighth of a turn, 150 N m at the motor.
        press.load = if (2.0..2.0 + TAU / 8.0).contains(&crank) { 150.0 * ((crank - 2.0) * 4.0).sin() } else { 10.0 };
        let torque = 10.0 + 2.0 * (100.0 - press.speed);
        let torque = torque.clamp(-200.0, 200.0);
        press.tick(torque, 1.0 / f64::from(RATE_HZ));
        let counts = (press.angle / TAU * 8192.0).round() as i64;
        observer.step(config, (counts << 19) as u32, number(torque / torque_base));
        if tick >= RATE_HZ {
            let estimate = observer.estimate(config);
            let [inertia, slope, _] = press.at(press.angle);
            let taken = 0.5 * slope * press.speed * press.speed + press.load;
            // what the motor gives less what the constant inertia takes
            let shaft = torque - 0.5 * (torque - taken) / inertia;
            let real = |value: N, base: f64| value.to_real() * base;
            squares[0] += (real(estimate.load_torque, torque_base) - press.load).powi(2);
            squares[1] += (real(estimate.shaft_torque, torque_base) - shaft).powi(2);
            squares[2] += (real(estimate.load_speed, speed_base) - press.speed).powi(2);
            count += 1.0;
        }
    }
    squares.map(|square: f64| (square / count).sqrt())
}

#[test]
fn the_crank_is_not_taken_for_load() {
    let cranked = errors::<f32, MechanismObserver<f32>>(&MechanismConfig::<f32>::new(&DESIGN, Bases::SI), Bases::SI);
    let share = 1.0 - 0.5 / PRESS.mean_inertia();
    let rigid = errors::<f32, RigidObserver<f32>>(&RigidConfig::<f32>::new(&MEAN, share, Bases::SI), Bases::SI);
    println!("cranked {cranked:?}, rigid {rigid:?}");
    // Of the same gains, one knows the crank. What is left is the arc of load, which neither can foresee.
    assert!(cranked[0] < 0.1 * rigid[0] && cranked[1] < rigid[1], "{cranked:?} {rigid:?}");
    // 0.3 % of rated speed.
    assert!(cranked[2] < 0.003 * 100.0, "{cranked:?}");
}

#[test]
fn numbers_agree() {
    let double = errors::<f64, MechanismObserver<f64>>(&MechanismConfig::<f64>::new(&DESIGN, Bases::SI), Bases::SI);
    let single = errors::<f32, MechanismObserver<f32>>(&MechanismConfig::<f32>::new(&DESIGN, Bases::SI), Bases::SI);
    let fixed = errors::<Fixed, MechanismObserver<Fixed>>(&MechanismConfig::<Fixed>::new(&DESIGN, BASES), BASES);
    println!("{double:?} {single:?} {fixed:?}");
    for k in 0..3 {
        // The encoder's noise is in all of them alike; resolution adds less than a hundredth to it.
        assert!((single[k] - double[k]).abs() < 0.01 * double[k], "{single:?} {double:?}");
        assert!((fixed[k] - double[k]).abs() < 0.01 * double[k], "{fixed:?} {double:?}");
    }
}

#[test]
fn the_crank_stays_known_through_a_brake_and_a_restart() {
    let config = MechanismConfig::<f64>::new(&DESIGN, Bases::SI);
    let mut observer = MechanismObserver::<f64>::at_rest(&config, 0, 0.0);
    observer.home(&config, 1 << 30);
    // Three turns of the motor in steps of a twentieth, against a closed brake that slips.
    for step in 1..=60_u64 {
        let angle = (step * (1 << 32) / 20) as u32;
        observer.restart(&config, angle, 5.0, 0.0);
    }
    // A quarter of a turn and 3/10, to the resolution of 2^-26 turns and the twentieths' rounding.
    let expected = 0.25 + 3.0 / 10.0;
    let seen = f64::from(observer.crank_angle(&config)) / 4_294_967_296.0;
    assert!((seen - expected).abs() < 4.0 / f64::from(1 << 26), "{seen} {expected}");
}

#[test]
fn machines_that_cannot_be_are_refused() {
    use driveline::machine::Error as Machine;
    let ram = |radius: f64| CrankSlider::massless_rod(Length(radius), Length(0.5), Inertia(4.0), Mass(4_000.0));
    let of = |inertia: f64, radius: f64, turns: i32, motor: u32| {
        DrivenMechanism::try_new(Inertia(inertia), &Mechanism::slider_crank(&ram(radius)), turns, motor)
    };
    assert_eq!(of(0.0, 0.1, 1, 11), Err(Machine::MotorInertia));
    assert_eq!(of(f64::NAN, 0.1, 1, 11), Err(Machine::MotorInertia));
    assert_eq!(of(0.5, 0.5, 1, 11), Err(Machine::CrankRadius));
    assert_eq!(of(0.5, 0.1, 0, 11), Err(Machine::GearRatio));
    assert_eq!(of(0.5, 0.1, 1, 0), Err(Machine::GearRatio));
    let rate = Rate::hz(RATE_HZ);
    assert_eq!(PRESS.try_observer(rate, Encoder::lines(0), USUAL), Err(Error::EncoderLines));
    // A crank without a flywheel, whose least inertia is a hundredth of the mean: not in fixed point.
    let light = DrivenMechanism::new(
        Inertia(0.003),
        &Mechanism::slider_crank(&CrankSlider { crank: Inertia(0.0), ..RAM }),
        1,
        11,
    );
    let design = light.try_observer(rate, Encoder::lines(2048), USUAL);
    match design {
        Ok(design) => assert!(MechanismConfig::<Fixed>::try_new(&design, BASES).is_err()),
        Err(error) => assert_eq!(error, Error::MechanismNotStabilising),
    }
    // A base of the torque that the crank alone exceeds.
    let error = MechanismConfig::<Fixed>::try_new(&DESIGN, Bases::rigid(400.0, 2_500.0)).unwrap_err();
    assert!(error.message().contains("inertia torque is too large"), "{error}");
}

/// Of `f32` the table is refused where it would hold an infinity; `f64` holds both machines.
#[test]
fn a_table_beyond_its_number_is_refused() {
    let ram = |mass: f64| CrankSlider::massless_rod(Length(0.1), Length(0.5), Inertia(0.0), Mass(mass));
    // at the dead centre nothing is left but 1e-40 kg m2: less than the least `f32`, of a mean of 0.2
    let light = DrivenMechanism::new(Inertia(1e-40), &Mechanism::slider_crank(&ram(4_000.0)), 1, 10);
    // an inertia that swings by a tenth, and a torque of more than 1e39 N m at a speed of 1 rad/s
    let heavy = DrivenMechanism::new(Inertia(1e42), &Mechanism::slider_crank(&ram(1e45)), 1, 10);
    for (machine, word) in [(light, "swings too far"), (heavy, "inertia torque is too large")] {
        let design = MechanismDesign { machine, ..DESIGN };
        let error = MechanismConfig::<f32>::try_new(&design, Bases::SI).unwrap_err();
        assert!(error.message().contains(word), "{error}");
        assert!(MechanismConfig::<f64>::try_new(&design, Bases::SI).is_ok(), "{word}");
    }
}
