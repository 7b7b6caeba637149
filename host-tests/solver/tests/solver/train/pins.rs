//! Friction in the pins of a slider-crank and of a four-bar.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{
    Coordinate, Crank, FourBar, FourBarPins, Link, Orders, Pins, Source, StrokeLoad, Train,
};

/// A crank of 0.1 m with a rod of 0.25 m, and its pins.
const PRESS: Crank = Crank::new(0.1, 0.25, 0.0);
const PINS: Pins = Pins { coefficient: 0.1, main: 0.06, crank: 0.05, wrist: 0.03 };

/// The torque at the crank of a force of 1 N that pushes the slider towards it, by the friction circles: the force in
/// the rod is tangent to the circles of mu r about both of its pins, each on the side that is against the turning of
/// the rod in that pin.
fn by_friction_circles(pins: &Pins, angle: f64) -> f64 {
    let [main, crank, wrist] = [pins.main, pins.crank, pins.wrist].map(|radius| pins.coefficient * radius);
    let (r, l) = (PRESS.radius, PRESS.rod);
    let lean = (r * angle.sin() / l).asin();
    // the rod turns against the crank at all angles, against the slider in the half turn about the dead centre
    let sense = -angle.cos().signum();
    let line = -lean + ((crank - sense * wrist) / l).asin();
    // along the slider's way the force is 1 N; its lever about the crank's axis, less the circle of the crank pin
    (r * (angle - line).sin() - crank - main) / line.cos()
}

#[test]
fn pins_take_what_the_friction_circles_say() {
    for step in 0..36 {
        let angle = 0.05 + TAU * f64::from(step) / 36.0;
        let off = |coefficient: f64| {
            let pins = Pins { coefficient, ..PINS };
            let frictionless = by_friction_circles(&Pins { coefficient: 0.0, ..PINS }, angle);
            let loss = frictionless - by_friction_circles(&pins, angle);
            (loss - pins.loss(&PRESS, angle), loss)
        };
        // of the second order in the coefficient: mu times the pins' radii over the rod's length, 3.2 %
        let [(coarse, loss), (fine, _)] = [0.1, 0.05].map(off);
        assert!(coarse.abs() < 0.032 * loss, "{angle}: {coarse} of {loss}");
        // a quarter of it for half the coefficient, but for the third order, 3.2 % squared
        assert!((coarse - 4.0 * fine).abs() < 1e-3 * loss, "{angle}: {coarse} {fine}");
    }
}

/// Over a turn `4 mu F ((r_main + r_crank) K(lambda) + r_wrist artanh lambda)`, with the elliptic integral by the
/// arithmetic-geometric mean; a run loses it, turn by turn.
#[test]
fn pins_take_their_energy_from_every_turn() {
    let lambda = PRESS.radius / PRESS.rod;
    let (mut a, mut g) = (1.0, (1.0 - lambda * lambda).sqrt());
    for _ in 0..5 {
        (a, g) = (0.5 * (a + g), f64::sqrt(a * g));
    }
    let elliptic = PI / (2.0 * a);
    let turn = 4.0 * 0.1 * 900.0 * ((0.06 + 0.05) * elliptic + 0.03 * lambda.atanh());
    // two arcs that make a turn, whatever the sense of the force; what pushes against it elsewhere is taken off
    let force = |load, from, to| StrokeLoad { load, from, to };
    let forces = [force(-900.0, 0.0, TAU), force(1800.0, 1.0, 4.0), force(500.0, 5.0, 6.0), force(-500.0, 5.0, 6.0)];
    let coordinate = Coordinate::new(4.0).speed(20.0).crank(PRESS).pins(PINS, &forces);
    let mut run = Recording::new(Train::new().coordinate(coordinate).build().unwrap());
    // the loss from the start to an angle, by Simpson's rule between the corners at a quarter and three quarters
    let lost = |angle: f64| {
        let turns = (angle / TAU).floor();
        let corners = [0.0, 0.25 * TAU, 0.75 * TAU, angle - turns * TAU];
        let within = corners[3];
        let pieces = corners[..3].iter().zip(&corners[1..]).map(|(&from, &to)| (from.min(within), to.min(within)));
        let last = (within.min(corners[2]), within);
        let simpson = |(from, to): (f64, f64)| {
            if to - from < 1e-9 {
                return 0.0;
            }
            let h = (to - from) / 1000.0;
            // off the corners, where the loss has one value on each side
            let at = |k: i32| PINS.loss(&PRESS, (from + h * f64::from(k)).clamp(from + 1e-13, to - 1e-13));
            (0..500).map(|k| h / 3.0 * (at(2 * k) + 4.0 * at(2 * k + 1) + at(2 * k + 2))).sum::<f64>()
        };
        let part: f64 = pieces.take(2).chain([last]).map(simpson).sum();
        turns * turn + 900.0 * part
    };
    // fourth order of a thousand pieces, and the clamped ends
    assert!((lost(TAU - 1e-12) / turn - 1.0).abs() < 1e-9, "{} {turn}", lost(TAU - 1e-12));
    for _ in 0..1000 {
        run.advance(1e-3);
        let (angle, speed) = (run.motion().angle(0), run.motion().speed(0));
        let expected = 800.0 - lost(angle);
        assert!((2.0 * speed * speed / expected - 1.0).abs() < 1e-9, "{angle}: {} {expected}", 2.0 * speed * speed);
    }
    assert!(run.motion().angle(0) > 2.0 * TAU);
    prove(&run).unwrap();
}

/// Energy that the pins take of the slider's mass and a force on it in a turn at an even speed, rad/s: the integral of
/// the product of the force in the rod, the friction's arms and the pins' own turns, by the midpoint rule. From the
/// angles of the rod by small differences.
fn taken(crank: &Crank, pins: &Pins, force: f64, speed: f64) -> f64 {
    const STEPS: usize = 400_000;
    const NEAR: f64 = 1e-4;
    let lean = |angle: f64| (crank.radius / crank.rod * angle.sin()).asin();
    let way = |angle: f64| crank.radius * angle.cos() + crank.rod * lean(angle).cos();
    let power = |angle: f64| {
        let (ahead, behind) = (angle + NEAR, angle - NEAR);
        let swing = (lean(ahead) - lean(behind)) / (2.0 * NEAR);
        let bend = (way(ahead) - 2.0 * way(angle) + way(behind)) / (NEAR * NEAR);
        let rod = (force - crank.slider_mass * bend * speed * speed) / lean(angle).cos();
        let slips = pins.main + pins.crank * (1.0 + swing).abs() + pins.wrist * swing.abs();
        pins.coefficient * rod.abs() * slips
    };
    let h = TAU / STEPS as f64;
    (0..STEPS).map(|step| h * power((step as f64 + 0.5) * h)).sum()
}

/// Energy that a turn takes from a flywheel so large that it turns evenly, at its start's speed.
fn lost(crank: Crank, pins: Pins, force: f64, speed: f64) -> f64 {
    let whole = StrokeLoad { load: force, from: 0.0, to: TAU };
    let way = move |angle: f64| {
        crank.radius * angle.cos() + (crank.rod.powi(2) - (crank.radius * angle.sin()).powi(2)).sqrt()
    };
    let push = Source::Orders(Orders::sampled(way).slope().times(force).0);
    let flywheel = 1e7 * crank.slider_mass * crank.radius * crank.radius;
    let coordinate = Coordinate::new(flywheel).speed(speed).crank(crank).pins(pins, &[whole]).source(push);
    let mut motion = Train::new().coordinate(coordinate).build().unwrap();
    // the work of the force and the slider's energy come back where the turn ends
    motion.advance(TAU / speed);
    let missing = TAU - motion.angle(0);
    motion.advance(missing / motion.speed(0));
    let slower = speed - motion.speed(0);
    flywheel * slower * (speed - 0.5 * slower)
}

/// Of a long rod the slider's mass alone costs `mu m r w^2 (4 (r_main + r_crank) + pi lambda r_wrist)` a turn: the
/// force in the rod is `m r w^2 cos phi`, the rod swings at `lambda cos phi`.
#[test]
fn the_sliders_mass_loads_the_pins_as_by_the_closed_form_of_a_long_rod() {
    let pins = Pins { coefficient: 0.1, main: 0.06, crank: 0.05, wrist: 0.03 };
    let (mass, radius, speed) = (30.0, 0.1, 20.0);
    let off = |lambda: f64| {
        let closed = 0.1 * mass * radius * speed * speed * (4.0 * 0.11 + PI * lambda * 0.03);
        lost(Crank::new(radius, radius / lambda, mass), pins, 0.0, speed) / closed - 1.0
    };
    let [long, longer] = [0.02, 0.01].map(off);
    // left out are terms of lambda squared, of a factor of the order of one
    assert!(long.abs() < 0.02 * 0.02, "{long}");
    // and they fall to a quarter; at most lambda of that is of the third order
    assert!((long - 4.0 * longer).abs() < 0.04 * long.abs(), "{long} {longer}");
}

#[test]
fn the_sliders_mass_and_a_force_load_the_pins_of_a_short_rod_as_by_quadrature() {
    let crank = Crank::new(0.1, 0.25, 30.0);
    // m r w^2 is 1200 N: the force adds to it, and moves where the rod's force reverses
    for force in [0.0, 500.0, -900.0] {
        let expected = taken(&crank, &PINS, force, 20.0);
        let found = lost(crank, PINS, force, 20.0);
        // the flywheel's speed swings by a 1e-7th and falls by a 1e-8th in a turn; small differences of 1e-4 rad are
        // right to 1e-8
        assert!((found / expected - 1.0).abs() < 1e-6, "{force}: {found} {expected}");
    }
}

/// The square of a speed that begins with 30 rad/s, which falls so by the angle: Runge-Kutta of order four, so many steps
/// between every two corners.
fn fallen(corners: &[f64], steps: i32, fall: impl Fn(f64, f64) -> f64) -> f64 {
    let mut square = 900.0;
    for pair in corners.windows(2) {
        let h = (pair[1] - pair[0]) / f64::from(steps);
        for step in 0..steps {
            let angle = pair[0] + h * f64::from(step);
            let k1 = fall(angle, square);
            let k2 = fall(angle + 0.5 * h, square + 0.5 * h * k1);
            let k3 = fall(angle + 0.5 * h, square + 0.5 * h * k2);
            let k4 = fall(angle + h, square + h * k3);
            square += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
    }
    square
}

/// A light machine, whose speed swings by much, loses what the pins take of the rod's force as it is then: the power
/// over the angle by Runge-Kutta of order four, with the force solved for by trials. Both integrators run it alike.
#[test]
fn a_light_crank_is_slowed_by_its_pins_as_its_speed_swings() {
    let (crank, inertia, force) = (Crank::new(0.1, 0.25, 30.0), 0.8, 600.0);
    let slope = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        let upright = (1.0 - (0.4 * sine).powi(2)).sqrt();
        let rate = 0.4 * cosine / upright;
        [-0.1 * sine - 0.25 * 0.4 * sine * rate, rate, upright]
    };
    // of the square of the speed by the angle
    let fall = |angle: f64, square: f64| {
        let [way, rate, upright] = slope(angle);
        let bend = (slope(angle + 1e-5)[0] - slope(angle - 1e-5)[0]) / 2e-5;
        let arm = 0.1 * (0.06 + 0.05 * (1.0 + rate) + 0.03 * rate.abs()) / upright;
        // J w' + m y' (y' w' + y'' w^2) = F y' - arm |F - m (y' w' + y'' w^2)|, by repetition
        let (mut speeding, mut rod) = (0.0, 0.0_f64);
        for _ in 0..200 {
            speeding = (way * (force - 30.0 * bend * square) - arm * rod.abs()) / (inertia + 30.0 * way * way);
            rod = force - 30.0 * (way * speeding + bend * square);
        }
        2.0 * speeding
    };
    let corners = [0.0, FRAC_PI_2, 3.0 * FRAC_PI_2, TAU];
    let square = fallen(&corners, 4000, fall);
    let way = |angle: f64| 0.1 * angle.cos() + (0.0625 - (0.1 * angle.sin()).powi(2)).sqrt();
    let machine = |coordinate: Coordinate| {
        let push = Source::Orders(Orders::sampled(way).slope().times(force).0);
        let whole = StrokeLoad { load: force, from: 0.0, to: TAU };
        coordinate.crank(crank).pins(PINS, &[whole]).source(push)
    };
    let mut motion = Train::new().coordinate(machine(Coordinate::new(inertia).speed(30.0))).build().unwrap();
    // half of what is left at a time, since it speeds up towards the end
    while TAU - motion.angle(0) > 1e-12 {
        motion.advance(0.5 * (TAU - motion.angle(0)) / motion.speed(0));
    }
    let (found, expected) = (motion.speed(0), square.sqrt());
    // Runge-Kutta with 4000 steps and these small differences is within 1e-9 of 16,000 steps with the closed form of
    // the bend
    assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
    // driven through a gap, with a torque that jumps, so that the rod's force jumps as well
    let motor = Coordinate::new(0.5).speed(30.0).source(Source::Line { stall: 400.0, slope: 10.0 });
    let arc = Source::Arc { torque: -300.0, from: 1.0, to: 4.0 };
    let machine = machine(Coordinate::new(inertia).speed(30.0).source(arc));
    let train = Train::new().coordinate(motor).coordinate(machine);
    let mut run = Recording::new(train.link(Link::shaft(0, 1, 4e3).damping(2.0).gap(0.02)).build().unwrap());
    (0..500).for_each(|_| run.advance(2e-3));
    prove(&run).unwrap();
    assert!(run.motion().angle(1) > 3.0 * TAU && run.motion().events().len() > 4);
}

/// What would make the crank jam is refused, and so are pins without a crank and numbers out of range; pins that do
/// not rub are none.
#[test]
fn pins_that_jam_are_refused() {
    let crank = Crank::new(0.1, 0.25, 30.0);
    let build = |inertia: f64, coefficient: f64| {
        let coordinate = Coordinate::new(inertia).crank(crank).pins(Pins { coefficient, ..PINS }, &[]);
        Train::new().coordinate(coordinate).build().is_ok()
    };
    // half of g sqrt(m/J) at its greatest is one and more: g about 0.12 mu, m 30 kg
    assert!(build(0.8, 0.5) && !build(0.001, 0.5) && !build(0.8, -0.1) && !build(0.8, f64::NAN));
    let without = |pins: Pins| Train::new().coordinate(Coordinate::new(1.0).pins(pins, &[])).build().is_ok();
    assert!(!without(PINS) && without(Pins { coefficient: 0.0, ..PINS }));
    // nor does what does not rub have numbers out of range
    assert!(!without(Pins { coefficient: 0.0, main: -1.0, ..PINS }));
    assert!(!without(Pins { coefficient: f64::NAN, main: 0.0, crank: 0.0, wrist: 0.0 }));
    let pushed = |force: f64| {
        let forces = [StrokeLoad { load: force, from: 0.0, to: TAU }];
        let coordinate = Coordinate::new(1.0).crank(crank).pins(Pins { coefficient: 0.0, ..PINS }, &forces);
        Train::new().coordinate(coordinate).build().is_ok()
    };
    assert!(pushed(1.0) && !pushed(f64::INFINITY));
}

/// A four-bar press, and its pins.
const BARS: FourBar = FourBar { crank: 0.1, coupler: 0.35, rocker: 0.3, ground: 0.4 };
const JOINTS: FourBarPins = FourBarPins { coefficient: 0.1, main: 0.04, crank: 0.03, rocker: 0.02, pivot: 0.025 };
const ROCKER: f64 = 2.5;

/// Angle of the rocker, rad, from where two circles meet.
fn rocker(angle: f64) -> f64 {
    rocker_pin(angle)[1].atan2(rocker_pin(angle)[0] - BARS.ground)
}

/// Where coupler and rocker meet, m.
fn rocker_pin(angle: f64) -> [f64; 2] {
    let (x, y) = (BARS.crank * angle.cos(), BARS.crank * angle.sin());
    let (dx, dy) = (BARS.ground - x, -y);
    let across = dx.hypot(dy);
    let along = (BARS.coupler.powi(2) - BARS.rocker.powi(2) + across * across) / (2.0 * across);
    let height = (BARS.coupler.powi(2) - along * along).sqrt();
    [x + (along * dx - height * dy) / across, y + (along * dy + height * dx) / across]
}

/// Rates of coupler and rocker per rate of the crank, by small differences of 1e-5 rad.
fn swings(angle: f64) -> [f64; 2] {
    const NEAR: f64 = 1e-5;
    let coupler = |angle: f64| {
        let [x, y] = rocker_pin(angle);
        (y - BARS.crank * angle.sin()).atan2(x - BARS.crank * angle.cos())
    };
    let rate = |of: &dyn Fn(f64) -> f64| (of(angle + NEAR) - of(angle - NEAR)) / (2.0 * NEAR);
    [rate(&coupler), rate(&rocker)]
}

/// The torque at the crank of a torque on the rocker, with the balance of forces and moments of crank, coupler and
/// rocker: each pin has a moment of coefficient times radius times its force, against its turning.
fn by_equilibrium(pins: &FourBarPins, angle: f64, torque: f64) -> f64 {
    let [coupler, rocker] = swings(angle);
    let moment = |radius: f64, turning: f64, force: f64| -pins.coefficient * radius * force * turning.signum();
    let a = [BARS.crank * angle.cos(), BARS.crank * angle.sin()];
    let b = rocker_pin(angle);
    let (bar, lever) = ([b[0] - a[0], b[1] - a[1]], [b[0] - BARS.ground, b[1]]);
    let (mut size, mut force) = (0.0, [0.0; 2]);
    for _ in 0..200 {
        // coupler about the crank pin: bar x F = -moments; rocker about its pivot: lever x F = torque + moments
        let between = moment(pins.rocker, coupler - rocker, size);
        let first = -moment(pins.crank, coupler - 1.0, size) - between;
        let second = torque - between + moment(pins.pivot, rocker, size);
        let determinant = bar[1] * lever[0] - bar[0] * lever[1];
        force =
            [(bar[0] * second - lever[0] * first) / determinant, (bar[1] * second - lever[1] * first) / determinant];
        size = f64::hypot(force[0], force[1]);
    }
    let at_crank = a[0] * force[1] - a[1] * force[0];
    -at_crank + moment(pins.crank, coupler - 1.0, size) - moment(pins.main, 1.0, size)
}

#[test]
fn pin_friction_of_a_four_bar_agrees_with_the_equilibrium_of_its_bars() {
    for step in 0..36 {
        let angle = 0.05 + TAU * f64::from(step) / 36.0;
        for torque in [1.0, -1.0] {
            let frictionless = by_equilibrium(&FourBarPins { coefficient: 0.0, ..JOINTS }, angle, torque);
            // virtual work; small differences of 1e-5 rad are right to 1e-10
            assert!((frictionless + torque * swings(angle)[1]).abs() < 1e-9, "{angle}: {frictionless}");
            let off = |coefficient: f64| {
                let pins = FourBarPins { coefficient, ..JOINTS };
                let loss = by_equilibrium(&pins, angle, torque) - frictionless;
                (loss - pins.loss(&BARS, angle), loss)
            };
            // of the second order in the coefficient: the moments in the pins change the coupler's force by mu times
            // the sum of the radii over its arm at most, 0.1 0.115/0.2437, the arm at least c sin(54.3 degrees)
            let [(coarse, loss), (fine, _)] = [0.1, 0.05].map(off);
            assert!(coarse.abs() < 0.0472 * loss, "{angle}: {coarse} of {loss}");
            // a quarter of it for half the coefficient, but for the third order, the square of that
            assert!((coarse - 4.0 * fine).abs() < 0.0472 * 0.0472 * loss, "{angle}: {coarse} {fine}");
        }
    }
}

#[test]
fn the_rocker_reverses_at_its_dead_centres() {
    let [stretched, folded] = BARS.dead_centres();
    for (angle, reach) in [(stretched, 0.45), (folded, 0.25)] {
        let [x, y] = rocker_pin(angle);
        // sums of lengths below one
        assert!((x.hypot(y) - reach).abs() < 1e-14 && BARS.rates(angle)[1].abs() < 1e-13, "{angle}");
    }
}

/// A light machine, whose speed swings by much, by Runge-Kutta of order four over the angle, with the torque in the
/// coupler solved for by trials; both integrators run it alike.
#[test]
fn a_light_four_bar_is_slowed_by_its_pins_as_its_speed_swings() {
    let (inertia, torque) = (0.2, 60.0);
    let fall = |angle: f64, square: f64| {
        let [coupler, way] = swings(angle);
        let bend = (rocker(angle + 1e-4) - 2.0 * rocker(angle) + rocker(angle - 1e-4)) / 1e-8;
        let [x, y] = rocker_pin(angle);
        let lean = (y - BARS.crank * angle.sin()).atan2(x - BARS.crank * angle.cos());
        let slips = 0.04 + 0.03 * (1.0 - coupler) + 0.02 * (coupler - way).abs() + 0.025 * way.abs();
        let arm = 0.1 * slips / (BARS.rocker * (rocker(angle) - lean).sin());
        // J w' + m y' (y' w' + y'' w^2) = F y' - arm |F - m (y' w' + y'' w^2)|, by repetition
        let (mut speeding, mut carried) = (0.0, 0.0_f64);
        for _ in 0..60 {
            speeding = (way * (torque - ROCKER * bend * square) - arm * carried.abs()) / (inertia + ROCKER * way * way);
            carried = torque - ROCKER * (way * speeding + bend * square);
        }
        2.0 * speeding
    };
    let [stretched, folded] = BARS.dead_centres();
    let corners = [0.0, stretched, PI, folded, TAU];
    assert!(corners.is_sorted());
    let square = fallen(&corners, 2000, fall);
    let way = Orders::sampled(rocker);
    let machine = |coordinate: Coordinate| {
        let push = Source::Orders(way.slope().times(torque).0);
        let whole = StrokeLoad { load: torque, from: 0.0, to: TAU };
        let law = Orders::inertia(&[(ROCKER, &way)]);
        coordinate.inertia_law(law).four_bar_pins(BARS, ROCKER, JOINTS, &[whole]).source(push)
    };
    let mut motion = Train::new().coordinate(machine(Coordinate::new(inertia).speed(30.0))).build().unwrap();
    while TAU - motion.angle(0) > 1e-12 {
        motion.advance(0.5 * (TAU - motion.angle(0)) / motion.speed(0));
    }
    let (found, expected) = (motion.speed(0), square.sqrt());
    // it is felt: a run without friction ends as fast as it began
    assert!(expected < 29.9, "{expected}");
    // Runge-Kutta with 2000 steps is within 1e-9 of one with 8000; small differences of 1e-4 rad in the bend, instead
    // of its closed form, change the end by 2e-9
    assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
    // driven through a gap, with a torque that jumps, so that the coupler's force jumps as well
    let motor = Coordinate::new(0.5).speed(30.0).source(Source::Line { stall: 400.0, slope: 10.0 });
    let arc = Source::Arc { torque: -100.0, from: 1.0, to: 4.0 };
    let machine = machine(Coordinate::new(inertia).speed(30.0).source(arc));
    let train = Train::new().coordinate(motor).coordinate(machine);
    let mut run = Recording::new(train.link(Link::shaft(0, 1, 4e3).damping(2.0).gap(0.02)).build().unwrap());
    (0..250).for_each(|_| run.advance(2e-3));
    prove(&run).unwrap();
    assert!(run.motion().angle(1) > 2.0 * TAU && run.motion().events().len() > 4);
}

/// Without a law of inertia the torque alone loads the pins; bars that do not turn round and pins that jam are refused.
#[test]
fn pins_of_a_four_bar_that_jam_are_refused() {
    let whole = [StrokeLoad { load: 1.0, from: 0.0, to: TAU }];
    let law = Orders::inertia(&[(ROCKER, &Orders::sampled(rocker))]);
    let build = |inertia: f64, bars: FourBar, pins: FourBarPins| {
        let coordinate = Coordinate::new(inertia).inertia_law(law.clone()).four_bar_pins(bars, ROCKER, pins, &whole);
        Train::new().coordinate(coordinate).build()
    };
    assert!(build(0.2, BARS, JOINTS).is_ok());
    assert!(build(1e-6, BARS, FourBarPins { coefficient: 0.9, ..JOINTS }).is_err());
    assert!(build(0.2, BARS, FourBarPins { pivot: -0.1, ..JOINTS }).is_err());
    assert!(build(0.2, FourBar { crank: 0.38, ..BARS }, JOINTS).is_err());
    // almost in one line: what the pins take has more orders than are sampled
    assert!(build(0.2, FourBar { ground: 0.55 - 1e-9, ..BARS }, JOINTS).is_err());
    let alone = Coordinate::new(1e6).speed(10.0).four_bar_pins(BARS, 0.0, JOINTS, &whole);
    let mut motion = Train::new().coordinate(alone).build().unwrap();
    motion.advance(0.01);
    // the pins' torque at the middle of 0.1 rad: 0.1^2/24 of its second derivative is left out
    let expected = JOINTS.loss(&BARS, 0.05) * 0.01 / 1e6;
    assert!(((10.0 - motion.speed(0)) / expected - 1.0).abs() < 1e-3, "{}", motion.speed(0));
}
