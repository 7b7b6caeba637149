//! The limit of torque by a prime mover's characteristic.

use driveline::design::{Error, TorqueCurve};
use driveline::machine::{Characteristic, Induction, Line, Parabola, Series, Speed, Torque};

/// The points of the curve lie on the closed form of the limit.
fn meets<const K: usize>(mover: Characteristic, speeds: [f64; K], expected: impl Fn(f64) -> f64) {
    for (point, speed) in TorqueCurve::of(&mover, speeds).points().iter().zip(speeds) {
        // A handful of roundings of some thousand N m.
        assert!(point[0] == speed && (point[1] - expected(speed)).abs() < 1e-11, "{mover:?}: {point:?}");
    }
}

#[test]
fn points_lie_on_the_characteristic() {
    let line = Line::new((Speed(154.0), Torque(750.0)), Speed(157.0));
    // beyond no load it would brake: the limit is zero
    meets(Characteristic::Line(line), [0.0, 100.0, 155.0, 157.0, 159.0], |w| (250.0 * (157.0 - w)).max(0.0));
    let parabola = Parabola { constant: 1700.0, linear: -0.6, square: -0.002 };
    let curve = |w: f64| (1700.0 - 0.6 * w - 0.002 * w * w).max(0.0);
    meets(Characteristic::Parabola(parabola), [0.0, 60.0, 180.0, 500.0, 900.0], curve);
    // c U^2/(R + c w)^2
    let series = Characteristic::Series(Series::new(440.0, 2.0, 0.03));
    meets(series, [0.0, 13.0, 28.0, 45.0, 65.0, 88.0, 115.0, 147.0], |w| 0.03 * (440.0 / (2.0 + 0.03 * w)).powi(2));
}

/// Kloss's formula, with breakdown near synchronous speed and, by resistors, at standstill.
#[test]
fn points_lie_on_kloss_s_curve() {
    let motor = Induction::new(Speed(154.99), Torque(750.0), Speed(157.08), 2.5);
    let kloss = |a: f64| {
        move |w: f64| {
            let s = 1.0 - w / 157.08;
            if w < 157.08 { 2.0 * 1875.0 / (s / a + a / s).max(f64::MIN_POSITIVE) } else { 0.0 }
        }
    };
    let a = 2.09 / 157.08 * (2.5 + f64::sqrt(5.25));
    meets(Characteristic::Induction(motor), [0.0, 60.0, 100.0, 132.0, 147.0, 151.0, 154.0, 157.08, 158.0], kloss(a));
    let crane = Characteristic::Induction(Induction { breakdown_slip: 1.0, ..motor });
    meets(crane, [0.0, 60.0, 110.0, 157.08], kloss(1.0));
}

/// Slopes against central differences: their error is a sixth of the third derivative times 1e-6.
#[test]
fn slopes_have_their_sign() {
    let movers = [
        Characteristic::Line(Line { stall: 100.0, slope: 2.0 }),
        Characteristic::Parabola(Parabola { constant: 0.0, linear: 1.0, square: 0.02 }),
        Characteristic::Series(Series::new(440.0, 0.2, 0.03)),
        Characteristic::Induction(Induction::new(Speed(154.99), Torque(750.0), Speed(157.08), 2.5)),
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
