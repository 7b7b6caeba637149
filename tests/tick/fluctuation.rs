//! Figures from a ripple against closed forms: the ripple is given, so that no measurement hides an error in them.

use core::f64::consts::TAU;

use driveline::fluctuation::{
    Balance, CylinderReading, CylinderVerdict, Drivetrain, Engine, Extreme, Fluctuations, FourierSeries, MachineClass,
    Order, Quality, Ripple, Summed,
};
use driveline::number::Fixed;
use driveline::settings::{Bases, Cycle};

type CycleConfig = driveline::fluctuation::CycleConfig;

/// A ripple of this speed over the cycle, `theta` being 2 pi to it, with its extremes as they are at 65,536 places.
fn ripple(speed: impl Fn(f64) -> f64, acceleration: f64, cycles: u32, quality: Quality) -> Ripple {
    const PLACES: u32 = 65_536;
    let all = (0..PLACES).map(|k| speed(f64::from(k) / f64::from(PLACES) * TAU));
    let (least, most) = all.fold((f64::INFINITY, 0.0), |(least, most), speed| (speed.min(least), speed.max(most)));
    let table: Vec<f64> = (0..64).map(|k| speed(f64::from(k) / 64.0 * TAU)).collect();
    // by time: the cycle's angle over its duration
    let slowness = (0..64).map(|k| 1.0 / speed(f64::from(k) / 64.0 * TAU)).sum::<f64>() / 64.0;
    let extreme = |speed| Extreme { speed, angle: 0.0 };
    Ripple {
        mean: 1.0 / slowness,
        acceleration,
        speed: FourierSeries::from_samples(&table),
        motor: Fluctuations::of(extreme(most), extreme(least), 1.0 / slowness),
        cycles,
        quality,
    }
}

/// A complex number of an order, `cos - j sin`.
fn times([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a * c - b * d, a * d + b * c]
}

/// The engine whose cylinders have these mean torques, in the order of firing, each with the combustion of
/// [`Engine::peak`]: `T (1 + 2 sum Re P(m) e^(j m (theta - theta_k)))` over the cycle, P(m) = 1/(1 + j m a/turns)^2.
/// Speed and energy follow by integration.
fn engine<const Z: usize>(torques: [f64; Z], turns: u32, quality: Quality, cycles: u32) -> [CylinderReading; Z] {
    let (first, peak, inertia, mean_speed) = (0.4, 0.7, 2.5, 100.0);
    let mut orders = vec![];
    for m in 1..=Z / 2 {
        let m = m as f64;
        let ka = m * peak / f64::from(turns);
        let size = (1.0 + ka * ka) * (1.0 + ka * ka);
        // 1/(1 + j ka)^2
        let shape = [(1.0 - ka * ka) / size, -2.0 * ka / size];
        let mut sum = [0.0; 2];
        for (k, torque) in torques.iter().enumerate() {
            let fires = first / f64::from(turns) + TAU * k as f64 / Z as f64;
            let part = times(shape, [(m * fires).cos(), -(m * fires).sin()]);
            sum = [sum[0] + 2.0 * torque * part[0], sum[1] + 2.0 * torque * part[1]];
        }
        orders.push((m, sum));
    }
    // the energy over theta: torque over the crank's angle, turns times theta, by integration divided by j m
    let energy = |theta: f64| {
        let swing = orders.iter().map(|(m, [re, im])| {
            let (s, c) = (m * theta).sin_cos();
            f64::from(turns) / m * (re * s + im * c)
        });
        0.5 * inertia * mean_speed * mean_speed + swing.sum::<f64>()
    };
    let ripple = ripple(|theta| (2.0 * energy(theta) / inertia).sqrt(), 0.0, cycles, quality);
    let mut firing_order = [0; Z];
    for (k, number) in firing_order.iter_mut().enumerate() {
        *number = 10 + k as u8;
    }
    let engine = Engine { firing_order, first, peak, inertia, coupling: None, turns };
    ripple.cylinders(&engine, torques.iter().sum(), 50)
}

/// The torques come back to the accuracy of double precision; orders of the speed beyond the 16th are below 1e-12 of
/// it, as its ripple is of some per cent.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn the_torque_of_each_cylinder() {
    fn check<const Z: usize>(torques: [f64; Z], turns: u32, median: f64, verdicts: [CylinderVerdict; Z]) {
        let found = engine(torques, turns, Quality::default(), 8);
        for (k, cylinder) in found.iter().enumerate() {
            assert_eq!(usize::from(cylinder.number), 10 + k);
            assert!((cylinder.torque - torques[k]).abs() < 1e-6, "{torques:?} {found:?}");
            assert!((cylinder.share - torques[k] / median).abs() < 1e-6, "{torques:?} {found:?}");
            assert_eq!(cylinder.deviation, 0.0);
        }
        assert_eq!(found.map(|cylinder| cylinder.verdict), verdicts, "{torques:?}");
    }
    use CylinderVerdict::{Good, Misfire, Weak};
    check([10.0, 8.9, 10.0, 10.0], 2, 10.0, [Good, Weak, Good, Good]);
    check([10.0, 9.1, 10.0, 10.0], 2, 10.0, [Good; 4]);
    check([10.0, 10.2, 9.8, 4.1], 2, 9.9, [Good, Good, Good, Weak]);
    check([3.9, 10.0, 11.0, 10.0], 2, 10.0, [Misfire, Good, Good, Good]);
    check([10.0, 12.0, 3.0], 2, 10.0, [Good, Good, Misfire]);
    check([10.0, 9.2, 10.0, 11.0, 6.0, 10.0], 2, 10.0, [Good, Good, Good, Good, Weak, Good]);
    // short by 0.12 of 0.5: less than a third of what the weakest lacks; and by 0.2: more
    check([10.0, 8.8, 10.0, 10.0, 5.0, 10.0], 2, 10.0, [Good, Good, Good, Good, Weak, Good]);
    check([10.0, 8.0, 10.0, 10.0, 5.0, 10.0], 2, 10.0, [Good, Weak, Good, Good, Weak, Good]);
    check([10.0, 8.0], 1, 9.0, [Good, Weak]);
    // two cylinders: the median is the mean
    check([10.0, 9.5, 11.0, 2.0, 10.0], 1, 10.0, [Good, Good, Good, Misfire, Good]);
}

/// The scatter of the angle, 1e-4 rad over 50 teeth and 8 cycles, has in a sine of each order the deviation
/// `1e-4/sqrt(50*8/2)`, a relative one of the slowness of k times that, and one of the torque `J omega^2 k` times that.
/// Through `(1 + j k a)^2/2` and the inverse transform it comes into each cylinder: hand-computed for two of a
/// two-stroke engine, whose order is alone, and for four of a four-stroke one, with a weight of 1/2 and one of 1/4.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn the_scatter_of_a_cylinder() {
    let quality = Quality { spread: 1e-4, ..Quality::default() };
    let scatter = 1e-4 / 200.0_f64.sqrt();
    // J omega^2: the mean by time is below the mean of the energy by the square of the ripple, 1e-3 of it
    let firm = 2.5 * 100.0 * 100.0 * scatter;
    let two = 0.5 * firm * 0.5 * (1.0 + 0.7 * 0.7);
    assert!((engine([101.0, 99.0], 1, quality, 8)[0].deviation / (two / 100.0) - 1.0).abs() < 1e-5);
    let of = [0.5 * firm * 0.25 * 0.5 * (1.0 + 0.35 * 0.35), 0.25 * firm * 0.5 * (1.0 + 0.7 * 0.7)];
    let four = (of[0] * of[0] + of[1] * of[1]).sqrt();
    let found = engine([99.0, 101.0, 100.0, 100.0], 2, quality, 8);
    assert!((found[0].deviation / (four / 100.0) - 1.0).abs() < 1e-5, "{found:?} {four}");
}

/// Two deviations beyond a tenth, a mean torque against the rotation, and a ripple whose orders end too early.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_cylinder_without_a_verdict() {
    // the deviation of two, as above, is 6.585 for each radian of spread: 0.05 at 0.00759 rad
    for (spread, verdict) in [(0.0075, CylinderVerdict::Good), (0.0077, CylinderVerdict::Uncertain)] {
        let found = engine([101.0, 99.0], 1, Quality { spread, ..Quality::default() }, 8);
        assert_eq!(found.map(|cylinder| cylinder.verdict), [verdict; 2], "{found:?}");
    }
    let braking = engine([-101.0, -99.0], 1, Quality::default(), 8);
    assert!(braking.iter().all(|cylinder| cylinder.verdict == CylinderVerdict::Uncertain));
    let mut short = ripple(|theta| 100.0 + theta.cos() + (2.0 * theta).sin(), 0.0, 8, Quality::default());
    let of = |ripple: &Ripple| {
        let engine =
            Engine { firing_order: [1, 3, 4, 2], first: 0.0, peak: 0.6, inertia: 1.0, coupling: None, turns: 2 };
        ripple.cylinders(&engine, 1e6, 50)[0]
    };
    assert_eq!(of(&short).verdict, CylinderVerdict::Good);
    // one part of an order may be zero
    short.speed.orders[1] = Order { cos: 0.0, sin: 1.0 };
    assert_eq!(of(&short).verdict, CylinderVerdict::Good);
    short.speed.orders[1] = Order::default();
    assert!(of(&short).deviation.is_nan() && of(&short).verdict == CylinderVerdict::Uncertain);
}

/// A press's speed in three orders, and an inertia that comes and goes.
fn pressing(theta: f64) -> f64 {
    20.0 + 1.5 * theta.cos() + 0.6 * (2.0 * theta).cos() - 0.2 * (3.0 * theta).cos()
}

fn inertia(theta: f64) -> f64 {
    3.0 + 0.4 * (2.0 * theta).cos()
}

/// Delta of the machine with `added`, by steps of Runge and Kutta over the cycle of `turns`, 4,096 at the end: the
/// energy changes by the work that the cycle without the flywheel has shown, less what the motor's characteristic takes
/// off where the speed is above that. The energy to begin with by bisection, so that the mean speed over the angle is
/// the same.
fn with_flywheel(added: f64, slope: f64, turns: f64) -> f64 {
    let work = |theta: f64| 0.5 * inertia(theta) * pressing(theta) * pressing(theta);
    let run = |start: f64, steps: u32| {
        let step = TAU * turns / f64::from(steps);
        // the energy less the work
        let (mut rest, mut excess, mut least, mut most) = (start, 0.0, f64::INFINITY, 0.0_f64);
        let speed = |theta: f64, rest: f64| (2.0 * (rest + work(theta)) / (inertia(theta) + added)).sqrt();
        for k in 0..steps {
            let theta = |part: f64| (f64::from(k) + part) / f64::from(steps) * TAU;
            let slip = |part: f64, rest: f64| speed(theta(part), rest) - pressing(theta(part));
            let one = slip(0.0, rest);
            let two = slip(0.5, rest - 0.5 * step * slope * one);
            let three = slip(0.5, rest - 0.5 * step * slope * two);
            let four = slip(1.0, rest - step * slope * three);
            let mean = (one + 2.0 * two + 2.0 * three + four) / 6.0;
            rest -= step * slope * mean;
            excess += mean;
            let now = speed(theta(1.0), rest);
            (least, most) = (least.min(now), most.max(now));
        }
        (excess, 2.0 * (most - least) / (most + least))
    };
    let (mut low, mut high) = (0.0, 1e5);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if run(middle, 256).0 > 0.0 { high = middle } else { low = middle }
    }
    run(0.5 * (low + high), 4_096).1
}

/// The flywheel brings delta to what is permitted: to the search's 1e-6 where the torque is constant, to the 1e-4 of
/// the trapezia on 128 points where it falls with the speed. Backwards the same.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn the_flywheel_of_a_press() {
    for (turns, cycle) in [(1.0, Cycle::TURN), (2.0, Cycle::FOUR_STROKE)] {
        let cycle = CycleConfig::new(cycle, 1e-4, Bases::SI);
        for (slope, accuracy) in [(0.0, 2e-6), (5.0, 1e-4), (100.0, 3e-4)] {
            let table: Vec<f64> = (0..32).map(|k| inertia(f64::from(k) / 32.0 * TAU)).collect();
            let balance = Balance { inertia: FourierSeries::from_samples(&table), slope };
            for permissible in [0.1, 0.02, 0.005] {
                let found = [1.0, -1.0].map(|sign| {
                    let ripple = ripple(pressing, 0.0, 8, Quality::default());
                    let speed = FourierSeries::from_samples(&[0; 64].map(|_| 0.0));
                    let mut turned = Ripple { mean: sign * ripple.mean, speed, ..ripple };
                    turned.speed.mean = sign * ripple.speed.mean;
                    for (order, of) in turned.speed.orders.iter_mut().zip(&ripple.speed.orders) {
                        *order = Order { cos: sign * of.cos, sin: sign * of.sin };
                    }
                    let [max, min] = [ripple.motor.max.speed, ripple.motor.min.speed].map(|speed| speed * sign);
                    let of = |speed| Extreme { speed, angle: 0.0 };
                    turned.motor = Fluctuations::of(of(max.max(min)), of(min.min(max)), turned.mean);
                    turned.flywheel(&cycle, &balance, permissible).unwrap()
                });
                assert_eq!(found[0].missing, found[1].missing);
                let flywheel = found[0];
                let then = with_flywheel(flywheel.missing, slope, turns);
                assert!((then / permissible - 1.0).abs() < accuracy, "{slope}, {turns}: {then} {flywheel:?}");
                assert!((flywheel.remaining / permissible - 1.0).abs() < 1e-6, "{flywheel:?}");
                let energies = (0..65_536).map(|k| f64::from(k) / 65_536.0 * TAU);
                let energies = energies.map(|theta| 0.5 * inertia(theta) * pressing(theta) * pressing(theta));
                let (least, most) = energies
                    .fold((f64::INFINITY, 0.0_f64), |(least, most), energy| (least.min(energy), most.max(energy)));
                // half a step of the grid beside the least: 0.0245^2/2 of a curvature of some orders
                assert!((flywheel.energy_swing / (most - least) - 1.0).abs() < 2e-3, "{flywheel:?}");
            }
        }
    }
}

/// Half a per cent above what is permitted needs a flywheel, half a per cent below none; figures that cannot be give
/// none at all.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_flywheel_that_is_not_needed_or_cannot_be() {
    let cycle = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
    let ripple = ripple(pressing, 0.0, 8, Quality::default());
    let steady = |inertia, slope| Balance { inertia: FourierSeries::constant(inertia), slope };
    let delta = ripple.motor.delta_arithmetic;
    let flywheel = ripple.flywheel(&cycle, &steady(3.0, 0.0), 1.005 * delta).unwrap();
    assert_eq!((flywheel.missing, flywheel.remaining, flywheel.delta), (0.0, delta, delta));
    assert_eq!(ripple.flywheel(&cycle, &steady(3.0, 0.0), delta).unwrap().missing, 0.0);
    let flywheel = ripple.flywheel(&cycle, &steady(3.0, 0.0), 0.995 * delta).unwrap();
    // the inertia over delta: next to a straight line
    assert!((flywheel.missing / (3.0 * 0.005) - 1.0).abs() < 0.05, "{flywheel:?}");
    for (balance, permissible) in [
        (steady(0.0, 0.0), 0.01),
        (steady(-3.0, 0.0), 0.01),
        (steady(f64::INFINITY, 0.0), 0.01),
        (steady(f64::NAN, 0.0), 0.01),
        (steady(3.0, -1.0), 0.01),
        (steady(3.0, f64::INFINITY), 0.01),
        (steady(3.0, f64::NAN), 0.01),
        (steady(3.0, 0.0), 0.0),
        (steady(3.0, 0.0), -0.01),
        (steady(3.0, 0.0), f64::NAN),
        (steady(3.0, 0.0), f64::INFINITY),
    ] {
        assert_eq!(ripple.flywheel(&cycle, &balance, permissible), None, "{balance:?} {permissible}");
    }
    // one that stands still somewhere, and one that is against its mean
    let mut stands = ripple;
    stands.speed.orders[0].cos = 25.0;
    assert_eq!(stands.flywheel(&cycle, &steady(3.0, 0.0), 0.01), None);
    assert_eq!(Ripple { mean: -ripple.mean, ..ripple }.flywheel(&cycle, &steady(3.0, 0.0), 0.01), None);
    let mut infinite = ripple;
    infinite.speed.mean = f64::INFINITY;
    assert_eq!(infinite.flywheel(&cycle, &steady(3.0, 0.0), 0.01), None);
    // nor is any permitted
    let mut stops = ripple;
    stops.speed = FourierSeries::constant(20.0);
    stops.speed.orders[0].cos = -20.0;
    for (ripple, inertia) in [
        (ripple, 0.0),
        (ripple, -3.0),
        (ripple, f64::INFINITY),
        (ripple, f64::NAN),
        (stops, 3.0),
        (Ripple { mean: 0.0, ..ripple }, 3.0),
        (infinite, 3.0),
    ] {
        assert_eq!(ripple.flywheel(&cycle, &steady(inertia, 0.0), 3.0), None, "{inertia}");
    }
    let even = self::ripple(|_| 20.0, 0.0, 8, Quality::default());
    assert_eq!(even.flywheel(&cycle, &steady(3.0, 0.0), 0.0), None);
    // the motor's figure is above what is permitted, that of the orders below: as good as none, to the search's 1e-6
    let mut above = ripple;
    above.motor.delta_arithmetic *= 1.001;
    let flywheel = above.flywheel(&cycle, &steady(3.0, 0.0), (1.0 + 5e-7) * delta).unwrap();
    assert!(flywheel.missing > 0.0 && flywheel.missing < 3e-6, "{flywheel:?}");
}

/// Motor and load by the machine's law in closed form: the motor in the orders 1 and 2 of a cycle of two turns, so that
/// the products have orders up to 4, and the load's, of orders up to 8, in what the ripple's highest order counts.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn the_load_side_in_closed_form() {
    let machine = Drivetrain { motor_inertia: 2.0, load_inertia: 5.0, stiffness: 4_000.0, damping: 30.0 };
    let cycle = CycleConfig::new(Cycle::FOUR_STROKE, 1e-4, Bases::SI);
    let (acceleration, mean) = (3.0, 50.0);
    let motor = [(1.0, 0.8, 0.3), (2.0, 0.1, -0.5)];
    let at = |theta: f64| {
        mean + motor.iter().map(|(n, cos, sin)| cos * (n * theta).cos() + sin * (n * theta).sin()).sum::<f64>()
    };
    let slope = |theta: f64| {
        motor.iter().map(|(n, cos, sin)| n * (sin * (n * theta).cos() - cos * (n * theta).sin())).sum::<f64>()
    };
    let mut ripple = ripple(at, acceleration, 8, Quality::default());
    // the highest order counts, be it as good as nothing
    ripple.speed.orders[11] = Order { cos: 0.0, sin: 1e-300 };
    let torque = FourierSeries {
        orders: {
            let mut orders = [Order::default(); 16];
            orders[1].sin = 7.0;
            orders
        },
        ..FourierSeries::constant(90.0)
    };
    let found = ripple.load_side(&cycle, &machine, &torque);
    // theta is half of the motor's angle: d/dt = omega/2 d/dtheta
    let shaft = |theta: f64| 90.0 + 7.0 * (2.0 * theta).sin() - 2.0 * (0.5 * at(theta) * slope(theta) + acceleration);
    let orders = |of: &dyn Fn(f64) -> f64| {
        let table: Vec<f64> = (0..64).map(|k| of(f64::from(k) / 64.0 * TAU)).collect();
        FourierSeries::from_samples(&table)
    };
    let shaft_orders = orders(&shaft);
    // twist = torque over (k + j d n w/2), the load's speed less its rate, which is omega/2 times its derivative
    let parts: Vec<[f64; 5]> = (1..=12)
        .map(|n| {
            let (order, n) = (shaft_orders.order(n), n as f64);
            let d = machine.damping * n * 0.5 * mean;
            let size = machine.stiffness * machine.stiffness + d * d;
            let twist = times([order.cos, -order.sin], [machine.stiffness / size, -d / size]);
            // j n times the twist
            [n, twist[0], -twist[1], -n * twist[1], -n * twist[0]]
        })
        .collect();
    let sum = |theta: f64, k: usize| {
        parts.iter().map(|p| p[k] * (p[0] * theta).cos() + p[k + 1] * (p[0] * theta).sin()).sum::<f64>()
    };
    let load = |theta: f64| at(theta) * (1.0 - 0.5 * sum(theta, 3));
    let twist = |theta: f64| shaft_orders.mean / machine.stiffness + sum(theta, 1);
    let load_torque = |theta: f64| {
        let rate = (load(theta + 1e-5) - load(theta - 1e-5)) / 2e-5;
        shaft(theta) - 5.0 * (0.5 * load(theta) * rate + acceleration)
    };
    let load_torque = orders(&load_torque);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    let (mut slowest, mut fastest) = (f64::INFINITY, 0.0_f64);
    for k in 0..1_280 {
        let theta = f64::from(k) / 1_280.0 * TAU;
        assert!((found.shaft_torque.at(theta) - shaft(theta)).abs() < 1e-9, "{k}");
        assert!((found.load_speed.at(theta) - load(theta)).abs() < 1e-9, "{k}");
        // the difference of 1e-5: 1e-10 of it, times 50 rad/s and orders of some tens
        assert!((found.load_torque.at(theta) - load_torque.at(theta)).abs() < 1e-4, "{k}");
        let energy = 0.5 * (2.0 * at(theta).powi(2) + 5.0 * load(theta).powi(2) + 4_000.0 * twist(theta).powi(2));
        if k % 10 == 0 {
            // the grid of the energy has 128 points
            (least, most) = (least.min(energy), most.max(energy));
        }
        (slowest, fastest) = (slowest.min(load(theta)), fastest.max(load(theta)));
    }
    assert!((found.energy_swing / (most - least) - 1.0).abs() < 1e-9, "{} {}", found.energy_swing, most - least);
    // within 1,280 points the extreme is missed by 1e-5 of the swing
    let swing = found.load.max.speed - found.load.min.speed;
    assert!((swing / (fastest - slowest) - 1.0).abs() < 1e-4, "{swing} {}", fastest - slowest);
    let (max, min) = (found.load.max, found.load.min);
    assert!((load(max.angle / 2.0) - max.speed).abs() < 1e-9 && (load(min.angle / 2.0) - min.speed).abs() < 1e-9);
    assert!((found.load.delta * ripple.mean - swing).abs() < 1e-9 * swing);
}

/// A series is its orders; those of a table come back, and so do their derivative, size and phase.
#[test]
fn a_series_is_its_orders() {
    let of = |theta: f64| 3.0 + 2.0 * theta.cos() - (2.0 * theta).sin() + 0.5 * (5.0 * theta + 0.3).cos();
    let table: Vec<f64> = (0..11).map(|k| of(f64::from(k) / 11.0 * TAU)).collect();
    let series = FourierSeries::from_samples(&table);
    for (n, cos, sin) in [(1, 2.0, 0.0), (2, 0.0, -1.0), (3, 0.0, 0.0), (5, 0.5 * 0.3_f64.cos(), -0.5 * 0.3_f64.sin())]
    {
        assert!((series.order(n).cos - cos).abs() < 1e-14 && (series.order(n).sin - sin).abs() < 1e-14, "{n}");
    }
    assert_eq!((series.order(0), series.order(6), series.order(17)), Default::default());
    assert!((series.order(5).amplitude() - 0.5).abs() < 1e-14 && (series.order(5).phase() + 0.3).abs() < 1e-13);
    for k in 0..7 {
        let theta = f64::from(k);
        assert!((series.at(theta) - of(theta)).abs() < 1e-13);
        let slope = -2.0 * theta.sin() - 2.0 * (2.0 * theta).cos() - 2.5 * (5.0 * theta + 0.3).sin();
        assert!((series.derivative().at(theta) - slope).abs() < 1e-13);
    }
    // orders below half of the table's length: of ten, four
    let table: Vec<f64> = (0..10).map(|k| of(f64::from(k) / 10.0 * TAU)).collect();
    assert_eq!(FourierSeries::from_samples(&table).order(5), Order::default());
    assert_eq!(FourierSeries::from_samples(&[]), FourierSeries::<f64>::default());
}

/// A number of fixed point has 2^28 to its base: a total is the sum of them as whole numbers, over 2^28, however often
/// it passes a word's end, either way.
#[test]
fn a_total_of_fixed_point_is_the_sum_in_two_words() {
    let (mut total, mut sum) = (Default::default(), 0_i64);
    let numbers = [7.5, 7.9, -0.25, 6.0, -7.75, -7.75, -7.75, -7.5, 1e-8, -7.0, 3.0];
    for number in numbers.iter().cycle().take(2_000).map(|&number| Fixed::from_f64(number)) {
        total = number.added_to(total);
        sum += i64::from(number.to_bits());
        assert_eq!(Fixed::total_to_real(total), sum as f32 / 268_435_456.0);
    }
    assert!(sum < -(1 << 32), "{sum}");
    assert_eq!(f64::total_to_real(0.5_f64.added_to(0.25)), 0.75);
}

/// As printed, the tolerant one first [Notes ch. 5].
#[test]
fn permissible_fluctuations_are_those_of_the_table() {
    for (class, tolerant, strict) in [
        (MachineClass::Crusher, 5.0, 20.0),
        (MachineClass::Press, 7.0, 10.0),
        (MachineClass::Farm, 10.0, 50.0),
        (MachineClass::MachineTool, 20.0, 50.0),
        (MachineClass::Vehicle, 20.0, 60.0),
        (MachineClass::MarineEngine, 20.0, 150.0),
        (MachineClass::Compressor, 50.0, 100.0),
        (MachineClass::CombustionEngine, 80.0, 150.0),
        (MachineClass::Generator, 100.0, 300.0),
    ] {
        let [least, most] = class.permissible();
        // a rounding of the quotient and one of the product
        assert!((least * strict - 1.0).abs() < 3e-16 && (most * tolerant - 1.0).abs() < 3e-16, "{class:?}");
    }
}
