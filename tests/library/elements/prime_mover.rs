//! Prime movers against the textbook's examples and their own definitions.

use driveline::machine::{Error, Induction, Line, Parabola, Series, Speed, Torque};

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

/// Power in less heat is power out: U I - R I^2 = tau omega.
#[test]
fn a_series_motor() {
    let series = Series::new(440.0, 0.2, 0.03);
    for speed in [20.0, 60.0, 150.0] {
        let (current, torque) = (series.current(Speed(speed)), series.torque(Speed(speed)).0);
        close(440.0 * current - 0.2 * current * current, torque * speed, 1e-13);
        let slope = (series.torque(Speed(speed + 1e-3)).0 - series.torque(Speed(speed - 1e-3)).0) / 2e-3;
        close(series.stiffness(Speed(speed)), slope.abs(), 1e-7);
    }
    assert_eq!(Series::try_new(-440.0, 0.1, 2.8), Err(Error::DirectCurrent));
}
