//! Starting times of every prime mover against closed forms and the full solver.

use driveline::machine::{Characteristic, Induction, Inertia, Line, Parabola, Rigid, Series, Speed};
use driveline_solver::plant::train::{Coordinate, Source, Train};

use crate::references::close;

/// What the quadrature promises; the closed forms round less.
const PROMISED: f64 = 1e-12;

fn constant(torque: f64) -> Parabola {
    Parabola { constant: torque, linear: 0.0, square: 0.0 }
}

fn time(mover: Characteristic, inertia: f64, load: &Parabola, from: f64, to: f64) -> f64 {
    mover.time_to(&Rigid::new(Inertia(inertia)), load, Speed(from), Speed(to))
}

#[test]
fn a_line_takes_logarithms() {
    let line = Line { stall: 90.0, slope: 0.6 };
    for (load, to) in [(0.0, 149.999), (30.0, 99.0), (30.0, 20.0)] {
        let end: f64 = (90.0 - load) / 0.6;
        let expected = 0.4 / 0.6 * (end / (end - to)).ln();
        close(time(Characteristic::Line(line), 0.4, &constant(load), 0.0, to), expected, PROMISED);
    }
}

/// `t = J w_0/(2 tau_A) ((1 - s^2)/(2 s_A) + s_A ln(1/s))` alone; against a constant torque by partial fractions.
#[test]
fn an_induction_motor_takes_kloss_s_integral() {
    let motor = Induction { synchronous: 157.0, breakdown: 300.0, breakdown_slip: 0.18 };
    let mover = Characteristic::Induction(motor);
    for s in [0.9, 0.5, 0.18, 0.05, 1e-3] {
        let expected = 0.6 * 157.0 / 600.0 * ((1.0 - s * s) / 0.36 - 0.18 * f64::ln(s));
        // At a slip of 1e-3 the speed says it to 1e-13, a hundredth of the logarithm.
        close(time(mover, 0.6, &constant(0.0), 0.0, 157.0 * (1.0 - s)), expected, PROMISED);
    }
    for (load, s) in [(90.0, 0.5), (90.0, 0.1), (60.0, 0.02), (104.0, 0.04)] {
        let over: f64 = 300.0 / load;
        let wide = (over * over - 1.0).sqrt();
        let (first, second) = (0.18 / (over + wide), 0.18 * (over + wide));
        let rest = first * ((1.0 - first) / (s - first)).ln();
        let rise = second * ((second - s) / (second - 1.0)).ln();
        let expected = 0.6 * 157.0 / load * (s - 1.0 + (first + second) / (second - first) * (rest + rise));
        // The parts of the closed form cancel to a tenth.
        close(time(mover, 0.6, &constant(load), 0.0, 157.0 * (1.0 - s)), expected, 1e-11);
    }
    // It starts with 2 300/(1/0.18 + 0.18) = 104.6 N m.
    assert_eq!(time(mover, 0.6, &constant(105.0), 0.0, 1.0), f64::INFINITY);
    assert_eq!(time(mover, 0.6, &constant(90.0), 0.0, 156.0), f64::INFINITY);
}

/// `x = R + c w`: `J/(3 c^2 U^2) x^3` alone, `J/(c tau_L) (k atanh(x/k) - x)` with `k^2 = c U^2/tau_L` against a load.
#[test]
fn a_series_motor_takes_a_cube_or_a_hyperbolic_tangent() {
    let (u, r, c, j) = (600.0_f64, 1.2_f64, 0.02_f64, 40.0);
    let mover = Characteristic::Series(Series::new(u, r, c));
    let x = |w: f64| r + c * w;
    for to in [1.0, 50.0, 400.0] {
        let expected = j / (3.0 * (c * u).powi(2)) * (x(to).powi(3) - r.powi(3));
        // At 1 rad/s the cubes cancel to a twentieth.
        close(time(mover, j, &constant(0.0), 0.0, to), expected, 1e-11);
    }
    let (load, k) = (100.0, f64::sqrt(c * u * u / 100.0));
    for to in [100.0, 300.0, 360.0] {
        let part = |w: f64| k * (x(w) / k).atanh() - x(w);
        close(time(mover, j, &constant(load), 0.0, to), j / (c * load) * (part(to) - part(0.0)), 1e-11);
    }
    // Without resistance it has no bound at standstill.
    let bare = Characteristic::Series(Series::new(u, 0.0, c));
    close(time(bare, j, &constant(0.0), 0.0, 50.0), j / (3.0 * (c * u).powi(2)), PROMISED);
}

/// An induction motor with a fan has no short closed form: the full solver's speed at that time.
#[test]
fn an_induction_motor_with_a_fan_takes_the_solver_s_time() {
    let (breakdown, slip, synchronous) = (1875.0, 0.064, 157.08);
    let motor = Induction { synchronous, breakdown, breakdown_slip: slip };
    let fan = Parabola { constant: 40.0, linear: 0.3, square: 0.025 };
    for to in [40.0, 120.0, 147.0, 154.0] {
        let found = time(Characteristic::Induction(motor), 60.0, &fan, 0.0, to);
        let coordinate = Coordinate::new(60.0)
            .source(Source::Kloss { breakdown, slip, synchronous })
            .source(Source::Parabola(-40.0, -0.3, -0.025));
        let mut motion = Train::new().coordinate(coordinate).build().unwrap();
        motion.advance(found);
        // Both are exact but for 1e-12 of the time, in which a speed changes by no more than 1e-11 of itself.
        close(motion.speed(0), to, 1e-11);
    }
}

#[test]
fn a_start_that_is_none_takes_no_time_or_never_ends() {
    let line = Characteristic::Line(Line { stall: 90.0, slope: 0.6 });
    assert_eq!(time(line, 1.0, &constant(0.0), 50.0, 50.0), 0.0);
    assert_eq!(time(line, 1.0, &constant(0.0), 0.0, 150.0), f64::INFINITY);
    assert_eq!(time(line, 1.0, &constant(90.0), 0.0, 1.0), f64::INFINITY);
    for wrong in [f64::NAN, f64::INFINITY] {
        assert_eq!(time(line, 1.0, &constant(0.0), 0.0, wrong), f64::INFINITY);
        assert_eq!(time(line, 1.0, &constant(wrong), 0.0, 1.0), f64::INFINITY);
    }
}
