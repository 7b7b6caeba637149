//! The limit of torque by a prime mover's characteristic, between its points.

use driveline::design::{Error, TorqueCurve};
use driveline::machine::{
    Characteristic, Combustion, CombustionType, Induction, Line, Parabola, Series, Shunt, Speed, Torque,
};

/// Largest difference between the curve's lines and a closed form, at 1000 places between two points each.
fn largest_error<const K: usize>(curve: &TorqueCurve<K>, expected: impl Fn(f64) -> f64) -> f64 {
    let pieces = curve.points().windows(2);
    let errors = pieces.flat_map(|pair| {
        let [[from, left], [to, right]] = [pair[0], pair[1]];
        let expected = &expected;
        (0..=1000).map(move |place| {
            let share = f64::from(place) / 1000.0;
            (left + share * (right - left) - expected(from + share * (to - from))).abs()
        })
    });
    errors.fold(0.0, f64::max)
}

/// The bound holds, and is no more than `slack` times what is met.
fn bounds<const K: usize>(mover: Characteristic, speeds: [f64; K], slack: f64, expected: impl Fn(f64) -> f64) -> f64 {
    let curve = TorqueCurve::of(&mover, speeds);
    for (point, speed) in curve.points().iter().zip(speeds) {
        // A handful of roundings of some thousand N m.
        assert!(point[0] == speed && (point[1] - expected(speed)).abs() < 1e-11, "{mover:?}: {point:?}");
    }
    let (met, bound) = (largest_error(&curve, expected), curve.interpolation_error(&mover));
    assert!(met <= bound + 1e-11 && bound <= slack * met + 1e-11, "{mover:?}: {met} {bound}");
    bound
}

#[test]
fn straight_characteristics_are_met_whole() {
    let line = Line::new((Speed(154.0), Torque(750.0)), Speed(157.0));
    let shunt = Shunt::new(440.0, 0.1, 2.8);
    let exact = bounds(Characteristic::Line(line), [0.0, 100.0, 157.0], 1.0, |w| 250.0 * (157.0 - w));
    // 2.8 (440 - 2.8 w)/0.1
    let other = bounds(Characteristic::Shunt(shunt), [0.0, 440.0 / 2.8], 1.0, |w| 28.0 * (440.0 - 2.8 * w));
    assert_eq!([exact, other], [0.0; 2]);
    // Beyond no load it would brake, the limit is zero: a corner of 250 N m s/rad in the middle of 4 rad/s.
    let corner =
        bounds(Characteristic::Line(line), [0.0, 155.0, 159.0], 1.0 + 1e-9, |w| (250.0 * (157.0 - w)).max(0.0));
    assert!((corner - 250.0).abs() < 1e-9);
}

/// Half the second derivative times a quarter of the square of the distance, in the middle between two points.
#[test]
fn a_parabola_differs_by_its_chord() {
    let curve = |w: f64| 1700.0 - 0.6 * w - 0.002 * w * w;
    let parabola = Parabola { constant: 1700.0, linear: -0.6, square: -0.002 };
    let bound = bounds(Characteristic::Parabola(parabola), [0.0, 60.0, 180.0], 1.0 + 1e-9, curve);
    assert!((bound - 0.002 * 60.0 * 60.0).abs() < 1e-12);
    // It is zero at 784.2 rad/s: a corner.
    let falls = bounds(Characteristic::Parabola(parabola), [0.0, 500.0, 900.0], 1.5, |w| curve(w).max(0.0));
    assert!(falls > 0.002 * 250.0 * 250.0);
}

/// `c U^2/(R + c w)^2`.
#[test]
fn a_series_motor_differs_least_with_points_close_at_low_speed() {
    let motor = Characteristic::Series(Series::new(440.0, 2.0, 0.03));
    let curve = |w: f64| 0.03 * (440.0 / (2.0 + 0.03 * w)).powi(2);
    // The bound has the second derivative of a piece's start all along it.
    let near = bounds(motor, [0.0, 13.0, 28.0, 45.0, 65.0, 88.0, 115.0, 147.0], 2.0, curve);
    let even = bounds(motor, [0.0, 21.0, 42.0, 63.0, 84.0, 105.0, 126.0, 147.0], 2.0, curve);
    assert!(near < 0.6 * even, "{near} {even}");
    assert!(near < 0.04 * curve(0.0), "{near}");
}

/// Kloss's formula, with breakdown near synchronous speed and, by resistors, at standstill.
#[test]
fn an_induction_motor_differs_most_about_its_breakdown() {
    let motor = Induction::new(Speed(154.99), Torque(750.0), Speed(157.08), 2.5);
    let kloss = |a: f64| {
        move |w: f64| {
            let s = 1.0 - w / 157.08;
            2.0 * 1875.0 / (s / a + a / s).max(f64::MIN_POSITIVE)
        }
    };
    let a = 2.09 / 157.08 * (2.5 + f64::sqrt(5.25));
    let limit = |w: f64| if w < 157.08 { kloss(a)(w) } else { 0.0 };
    let places = [0.0, 60.0, 100.0, 120.0, 132.0, 138.0, 142.0, 145.0, 147.0, 149.0, 151.0, 154.0, 157.08];
    let bound = bounds(Characteristic::Induction(motor), places, 1.5, limit);
    assert!(bound < 0.04 * 1875.0, "{bound}");
    // Across synchronous speed: a corner.
    bounds(Characteristic::Induction(motor), [0.0, 100.0, 130.0, 140.0, 145.0, 149.0, 152.0, 155.0, 158.0], 3.0, limit);
    let crane = Characteristic::Induction(motor.rotor_resistance(1.0 / a));
    let bound = bounds(crane, [0.0, 60.0, 110.0, 157.08], 1.5, |w| if w < 157.08 { kloss(1.0)(w) } else { 0.0 });
    assert!(bound < 0.05 * 1875.0, "{bound}");
}

/// `tau_N (a + b x - c x^2)` to rated speed, the governor's line from there to no load; below idle as at idle.
#[test]
fn a_combustion_engine_has_corners() {
    let rated = (Speed(200.0), Torque(1500.0));
    for (mixture, [a, b, c]) in [
        (CombustionType::Spark, [1.0, 1.0, 1.0]),
        (CombustionType::IndirectInjection, [0.6, 1.4, 1.0]),
        (CombustionType::DirectInjection, [0.87, 1.13, 1.0]),
    ] {
        let engine = Characteristic::Combustion(Combustion::new(mixture, rated, Speed(70.0), Speed(210.0)));
        let limit = |w: f64| {
            let x = w.max(70.0) / 200.0;
            let full = 1500.0 * (a + x * (b - c * x));
            if w <= 200.0 { full } else { (150.0 * (210.0 - w)).max(0.0) }
        };
        // With the corners among the points, 130/3 rad/s apart: 1500/200^2 (130/6)^2.
        let third = 130.0 / 3.0;
        let bound = bounds(engine, [0.0, 70.0, 70.0 + third, 200.0 - third, 200.0, 210.0], 1.0 + 1e-6, limit);
        assert!((bound - 1500.0 / 4e4 * (third * third / 4.0)).abs() < 1e-9, "{bound}");
        // Without: the corner of rated speed alone is 150 N m s/rad over 10 rad/s to either side.
        let bound = bounds(engine, [0.0, 100.0, 190.0, 210.0], 1.1, limit);
        assert!(bound > 700.0);
    }
}

/// Slopes against central differences: their error is a sixth of the third derivative times 1e-6.
#[test]
fn slopes_have_their_sign() {
    let rated = (Speed(200.0), Torque(1500.0));
    let movers = [
        Characteristic::Line(Line { stall: 100.0, slope: 2.0 }),
        Characteristic::Parabola(Parabola { constant: 0.0, linear: 1.0, square: 0.02 }),
        Characteristic::Shunt(Shunt::new(440.0, 0.1, 2.8)),
        Characteristic::Series(Series::new(440.0, 0.2, 0.03)),
        Characteristic::Induction(Induction::new(Speed(154.99), Torque(750.0), Speed(157.08), 2.5)),
        Characteristic::Combustion(Combustion::new(CombustionType::Spark, rated, Speed(70.0), Speed(210.0))),
    ];
    for mover in movers {
        for speed in [20.0, 80.0, 141.0, 150.0, 156.0, 160.0, 173.0, 205.0] {
            let torque = |speed| mover.torque(Speed(speed)).0;
            let slope = (torque(speed + 1e-3) - torque(speed - 1e-3)) / 2e-3;
            let found = mover.slope(Speed(speed));
            // Third derivatives of up to 2 tau_A/w_A^3, 1875/15^3; torques of 12,000 N m to 16 digits over 2e-3.
            assert!((found - slope).abs() < 1e-6 * slope.abs() + 3e-9 + 1e-8, "{mover:?} {speed}: {found} {slope}");
        }
    }
}

#[test]
fn a_limit_that_is_no_number_is_refused() {
    let infinite = Characteristic::Series(Series::new(440.0, 0.0, 0.03));
    assert_eq!(TorqueCurve::try_of(&infinite, [0.0, 10.0]), Err(Error::TorqueCurve));
    let line = Characteristic::Line(Line { stall: f64::NAN, slope: 1.0 });
    assert_eq!(TorqueCurve::try_of(&line, [0.0, 10.0]), Err(Error::TorqueCurve));
    let line = Characteristic::Line(Line { stall: 5.0, slope: 1.0 });
    assert_eq!(TorqueCurve::try_of(&line, [1.0, 10.0]), Err(Error::TorqueCurve));
}
