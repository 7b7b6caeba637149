//! Prime movers against the textbook's examples and their own definitions.

use driveline::machine::{
    Combustion, CombustionType, Error, Induction, Line, Parabola, Series, Shunt, Speed, StartingLaw, Torque,
};

use crate::references::{case, close, meets};

/// A handful of roundings.
const ROUNDING: f64 = 5e-15;

#[test]
fn wang_parabola_of_a_series_motor() {
    let case = case("textbook_examples.json", "S01_parabola_motor");
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let points = [0, 1, 2].map(|j| {
        let point = &case["points_w_M"][j];
        (Speed(number(&point[0])), Torque(number(&point[1])))
    });
    let parabola = Parabola::through(points);
    for (found, j) in [(parabola.constant, 0), (parabola.linear, 1), (parabola.square, 2)] {
        meets(found, &case["expected_a_b_c"][j], 1e-12);
    }
    meets(parabola.torque(Speed(80.0)).0, &case["expected_M_at_80"], 1e-12);
    meets(parabola.torque(Speed(130.0)).0, &case["expected_M_at_130"], 1e-12);
    // The book rounds as it goes; 10 % is what its own graph differs from it by.
    for (speed, key) in [(80.0, "published_M_at_80"), (130.0, "published_M_at_130")] {
        meets(parabola.torque(Speed(speed)).0, &case[key], 0.1);
    }
    let slope = (parabola.torque(Speed(81.0)).0 - parabola.torque(Speed(79.0)).0) / 2.0;
    close(parabola.stiffness(Speed(80.0)), slope.abs(), 1e-13);
    assert_eq!(Parabola::try_through([points[0], points[0], points[2]]), Err(Error::CharacteristicPoints));
}

#[test]
fn a_line_passes_through_its_points() {
    let line = Line::new((Speed(154.0), Torque(750.0)), Speed(157.0));
    close(line.torque(Speed(154.0)).0, 750.0, 1e-12);
    assert!(line.torque(Speed(157.0)).0.abs() < 1e-9);
    close(line.slope, 250.0, ROUNDING);
    let error = Err(Error::CharacteristicPoints);
    assert_eq!(Line::try_new((Speed(157.0), Torque(750.0)), Speed(157.0)), error);
    assert_eq!(Line::try_new((Speed(157.0), Torque(0.0)), Speed(157.0)), error);
}

/// Wang 1989 (1-8) for the breakdown speed; the largest torque is there, and the rated one at rated speed.
#[test]
fn induction_motor_with_breakdown() {
    let (rated, none, overload) = (148.7, 157.0, 2.4);
    let motor = Induction::new(Speed(rated), Torque(120.0), Speed(none), overload);
    let breakdown = none - (none - rated) * (overload + (overload * overload - 1.0_f64).sqrt());
    close(motor.synchronous * (1.0 - motor.breakdown_slip), breakdown, ROUNDING);
    close(motor.torque(Speed(rated)).0, 120.0, 1e-13);
    close(motor.torque(Speed(breakdown)).0, 2.4 * 120.0, ROUNDING);
    assert_eq!(motor.torque(Speed(none)).0, 0.0);
    let largest = (0..2000).map(|j| motor.torque(Speed(f64::from(j) * 0.1)).0).fold(0.0, f64::max);
    assert!(largest <= motor.breakdown * (1.0 + 1e-15) && largest > motor.breakdown * 0.999_99);
    for speed in [-40.0, 0.0, 60.0, rated, none, 180.0] {
        let slope = (motor.torque(Speed(speed + 1e-3)).0 - motor.torque(Speed(speed - 1e-3)).0) / 2e-3;
        // A central difference of 1e-3 rad/s at a curve that bends over some 10 rad/s.
        close(motor.stiffness(Speed(speed)), slope.abs(), 1e-6);
    }
    // Above synchronous speed it generates, as far as it motors below.
    close(motor.torque(Speed(none + 5.0)).0, -motor.torque(Speed(none - 5.0)).0, 1e-12);
}

#[test]
fn an_induction_motor_out_of_range_is_refused() {
    let wrong = |rated: f64, overload: f64| Induction::try_new(Speed(rated), Torque(1.0), Speed(100.0), overload);
    assert_eq!(wrong(100.0, 2.0), Err(Error::InductionSpeed));
    assert_eq!(wrong(95.0, 1.0), Err(Error::Overload));
}

/// Jazar, Vehicle Dynamics ch. 4: power at rated speed is rated power; the power's derivative there, a + 2 b - 3 c, is
/// zero with spark ignition, and positive of a diesel, whose governor ends the curve.
#[test]
fn combustion_engines() {
    for (mixture, overload) in [
        (CombustionType::Spark, 1.25),
        (CombustionType::IndirectInjection, 1.09),
        (CombustionType::DirectInjection, 1.189_225),
    ] {
        let engine = Combustion::new(mixture, (Speed(200.0), Torque(1_500.0)), Speed(70.0), Speed(210.0));
        let power = |speed: f64| engine.torque(Speed(speed)).0 * speed;
        close(power(200.0), 300e3, ROUNDING);
        let rise = (power(200.0) - power(199.99)) / 0.01 * 200.0 / 300e3;
        let expected = [0.0, 0.4, 0.13][mixture as usize];
        // The second derivative is 2 b - 6 c, over half the difference of speeds: 1e-4.
        assert!((rise - expected).abs() < 2e-4);
        // a + b^2/(4 c), worked out by hand from the coefficients.
        close(engine.overload(), overload, 1e-12);
        // The governor: halfway down halfway through its droop, nothing beyond, nothing below idle.
        close(engine.torque(Speed(205.0)).0, 750.0, 1e-13);
        assert_eq!([engine.torque(Speed(211.0)).0, engine.torque(Speed(69.0)).0], [0.0; 2]);
        close(engine.droop(), 0.05, 1e-14);
    }
    let wrong = Combustion::try_new(CombustionType::Spark, (Speed(200.0), Torque(1.0)), Speed(70.0), Speed(200.0));
    assert_eq!(wrong, Err(Error::CombustionEngine));
}

/// 440 V, 0.1 ohm, 2.8 V s: 100 A give 280 N m at 430/2.8 rad/s.
#[test]
fn direct_current_motors() {
    let shunt = Shunt::new(440.0, 0.1, 2.8);
    close(shunt.torque(Speed(430.0 / 2.8)).0, 280.0, 1e-12);
    close(shunt.no_load_speed().0, 440.0 / 2.8, ROUNDING);
    close(shunt.stiffness(), 78.4, ROUNDING);
    // Power in less heat is power out: U I - R I^2 = tau omega.
    let series = Series::new(440.0, 0.2, 0.03);
    for speed in [20.0, 60.0, 150.0] {
        let (current, torque) = (series.current(Speed(speed)), series.torque(Speed(speed)).0);
        close(440.0 * current - 0.2 * current * current, torque * speed, 1e-13);
        let slope = (series.torque(Speed(speed + 1e-3)).0 - series.torque(Speed(speed - 1e-3)).0) / 2e-3;
        close(series.stiffness(Speed(speed)), slope.abs(), 1e-7);
    }
    assert_eq!(Shunt::try_new(440.0, 0.0, 2.8), Err(Error::DirectCurrent));
    assert_eq!(Series::try_new(-440.0, 0.1, 2.8), Err(Error::DirectCurrent));
}

#[test]
fn starting_laws_and_their_impulse() {
    let (torque, time) = (300.0, 2.0);
    for (law, mid) in [
        (StartingLaw::Hard { torque }, 300.0),
        (StartingLaw::Medium { torque, time }, 225.0),
        (StartingLaw::Soft { torque, time }, 150.0),
    ] {
        close(law.torque(0.0).0, 300.0, ROUNDING);
        close(law.torque(1.0).0, mid, ROUNDING);
    }
    assert_eq!(StartingLaw::Soft { torque, time }.torque(2.0).0, 0.0);
    assert_eq!(StartingLaw::Soft { torque, time: 0.0 }.check(), Err(Error::StartingTime));
    assert_eq!(StartingLaw::Hard { torque: f64::NAN }.check(), Err(Error::StartingTime));
}
