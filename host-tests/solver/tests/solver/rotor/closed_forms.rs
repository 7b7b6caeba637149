//! Steady vibration, refusals, spins and sensors against what can be worked out by hand.

use std::f64::consts::{PI, TAU};

use driveline_solver::rotor::{
    Bearing, Direction, Disc, Faulty, FlexibleRotor, Material, Modal, Motion, Polar, RigidRotor, Ripple, RotorError,
    Spin, Transducer, Whirl,
};
use nalgebra::Complex;

use super::rig::{BEARING, three_discs};

/// A rotor of 40 kg on four springs, its planes and sensors at both ends.
fn rigid(damping: f64) -> RigidRotor {
    RigidRotor::new(40.0, 0.9, 1.6)
        .bearing(-0.3, Bearing::isotropic(2e5, damping))
        .bearing(0.3, Bearing::isotropic(2e5, damping))
        .station(-0.2)
        .station(0.25)
        .sensor(-0.3, Direction::X)
        .sensor(0.3, Direction::X)
}

#[test]
fn a_rigid_rotor_shakes_as_two_oscillators() {
    let (speed, damping) = (150.0_f64, 80.0);
    let model = rigid(damping).build().unwrap();
    let unbalance = [Polar::degrees(2e-3, 40.0), Polar::degrees(1e-3, 200.0)];
    let found = model.response(speed, &unbalance).unwrap();
    // On isotropic supports z = x + i y = Z exp(i phi) for deflection and tilt each; the sensor along x reads Re(Z
    // exp(i phi)).
    let square = speed * speed;
    let oscillator = |inertia: f64, stiffness: f64, damping: f64| {
        Complex::new(stiffness - inertia * square, damping * speed).inv() * square
    };
    let bounce = oscillator(40.0, 4e5, 2.0 * damping) * (unbalance[0] + unbalance[1]);
    let moment = unbalance[0] * -0.2 + unbalance[1] * 0.25;
    let tilt = oscillator(1.6 - 0.9, 4e5 * 0.09, 2.0 * damping * 0.09) * moment;
    for (found, place) in found.iter().zip([-0.3, 0.3]) {
        let expected = bounce + tilt * place;
        assert!((found - expected).norm() < 1e-13 * expected.norm(), "{found} {expected}");
    }
}

#[test]
fn a_simple_beam_bends_and_shears_as_the_books_say() {
    // On stiff supports the shape is a sine of wave number k = pi/l, and its frequency the lower root of
    // (rho I rho/(kappa G)) w^4 - (rho A + rho I k^2 (1 + E/(kappa G))) w^2 + E I k^4 = 0
    // [Timoshenko 1921, Phil. Mag. 41, 744-746].
    let (length, diameter) = (2.0, 0.04);
    let rigid = Bearing::isotropic(1e13, 0.0);
    let model = FlexibleRotor::uniform(24, length, diameter, Material::STEEL)
        .bearing(0, rigid)
        .bearing(24, rigid)
        .station(12)
        .build()
        .unwrap();
    let first = Modal::of(&model).unwrap().frequencies()[0];
    let Material { density, young, poisson } = Material::STEEL;
    let (area, moment) = (PI / 4.0 * diameter * diameter, PI / 64.0 * diameter.powi(4));
    let shear = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson) * young / (2.0 * (1.0 + poisson));
    let square = (PI / length).powi(2);
    let (a, c) = (density * moment * density / shear, young * moment * square * square);
    let b = density * area + density * moment * square * (1.0 + young / shear);
    let expected = (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt();
    // elements of a cubic are too stiff by (pi/24)^4/720 = 4e-7
    assert!((first / expected - 1.0).abs() < 1e-6, "{first} {expected}");
}

#[test]
fn a_settled_whirl_is_the_steady_response() {
    for bearing in [BEARING, Bearing::anisotropic([4e6, 1e6], [2500.0, 900.0])] {
        let model = three_discs(bearing).build().unwrap();
        let unbalance = [Polar::degrees(1.8e-4, 35.0), Polar::degrees(4.2e-4, 250.0), Polar::degrees(2.5e-4, 160.0)];
        let speed = 169.0;
        let response = model.response(speed, &unbalance).unwrap();
        let mut whirl = Whirl::new(Modal::of(&model).unwrap(), 1e-4);
        whirl.set_unbalance(&unbalance).unwrap();
        let spin = Spin::steady(speed);
        whirl.settle(spin.at(0.0).0, speed).unwrap();
        for tick in 0..500 {
            whirl.advance(&spin.turn(f64::from(tick) * 1e-4, 1e-4));
            let turned = Complex::from_polar(1.0, spin.at(f64::from(tick + 1) * 1e-4).0);
            for (sensor, x) in response.iter().enumerate() {
                let motion = whirl.motion(sensor).unwrap();
                let expected = [x * turned, x * turned * Complex::new(0.0, speed), x * turned * -speed * speed];
                let sizes = [1.0, speed, speed * speed].map(|factor| factor * x.norm());
                let found = [motion.displacement, motion.velocity, motion.acceleration];
                for ((found, expected), size) in found.into_iter().zip(expected).zip(sizes) {
                    // the cubic through the force and the grid of speeds, each some 1e-10 a tick, gathered over a decay
                    assert!((found - expected.re).abs() < 1e-8 * size, "{tick} {found} {expected}");
                }
            }
        }
    }
}

#[test]
fn a_ripple_keeps_angle_and_speed_together() {
    let spin = Spin::through(&[(0.0, 50.0), (2.0, 90.0)])
        .unwrap()
        .ripple(Ripple { order: 3.0, share: 0.01, phase: 0.4 })
        .ripple(Ripple { order: 0.5, share: 0.004, phase: 1.0 });
    let step = 1e-5;
    for tick in 0..250 {
        let time = f64::from(tick) * 0.01;
        let (before, after) = (spin.at(time - step).0, spin.at(time + step).0);
        let slope = (after - before) / (2.0 * step);
        // the second derivative of the speed, some (3 Omega)^2 1 % of it, times step^2/6; rounding of the angle over
        // the step; at the corner of the course the mean of both sides
        let bound = 1e-6 * 90.0 + if (time - 2.0).abs() < step || time < step { 20.0 * step } else { 0.0 };
        assert!((slope - spin.at(time).1).abs() < bound, "{time} {slope} {}", spin.at(time).1);
    }
}

#[test]
fn a_turn_is_a_cubic_with_its_ends() {
    let spin = Spin::steady(80.0).ripple(Ripple { order: 7.0, share: 0.02, phase: 0.0 });
    let turn = spin.turn(0.37, 1e-4);
    for share in [0.0, 0.2, 0.5, 0.8, 1.0] {
        let (angle, speed, rate) = turn.at(share);
        let (true_angle, true_speed) = spin.at(0.37 + share * 1e-4);
        // fourth derivative of the angle, (7 Omega)^3 2 % of Omega, times h^4/384, and times h^3 and h^2 by its slopes
        assert!((angle - true_angle).abs() < 1e-11 && (speed - true_speed).abs() < 1e-5, "{share}");
        let expected = -80.0 * 80.0 * 7.0 * 0.02 * (7.0 * 80.0 * (0.37 + share * 1e-4)).sin();
        assert!((rate - expected).abs() < 0.2, "{share} {rate} {expected}");
    }
}

#[test]
fn a_sensor_lags_scales_clips_and_sees_run_out() {
    let (speed, x) = (100.0_f64, Polar::degrees(3e-6, 20.0));
    for kind in [Transducer::Displacement, Transducer::Velocity, Transducer::Acceleration] {
        let mut sensor = Faulty::new(kind, 1).error(0.05, 10_f64.to_radians());
        for k in 0..20 {
            let angle = f64::from(k) * 0.3;
            let at = |factor: Complex<f64>, angle: f64| (x * factor * Complex::from_polar(1.0, angle)).re;
            let factors = [Complex::new(1.0, 0.0), Complex::new(0.0, speed), Complex::new(-speed * speed, 0.0)];
            let [displacement, velocity, acceleration] = factors.map(|factor| at(factor, angle));
            let read = sensor.read(&Motion { displacement, velocity, acceleration }, angle, speed);
            let lagging = at(factors[kind as usize], angle - 10_f64.to_radians());
            // rounding
            assert!((read - 1.05 * lagging).abs() < 1e-13 * factors[kind as usize].norm() * x.norm(), "{kind:?}");
        }
    }
    let still = Motion::default();
    let mut rough = Faulty::new(Transducer::Displacement, 1).run_out(1.0, 2e-6, 0.0).range(1.5e-6);
    assert_eq!(rough.read(&still, 0.0, 10.0), 1.5e-6);
    assert!((rough.read(&still, TAU / 6.0, 10.0) - 1e-6).abs() < 1e-18);
    let mut velocity = Faulty::new(Transducer::Velocity, 1).run_out(1.0, 2e-6, 0.0);
    assert_eq!(velocity.read(&still, 0.0, 10.0), 0.0);
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let steel = Material::STEEL;
    let sentence = |rotor: FlexibleRotor| rotor.build().unwrap_err().to_string();
    let shaft = || FlexibleRotor::uniform(4, 1.0, 0.05, steel);
    assert_eq!(
        sentence(shaft().disc(1, Disc { mass: -1.0, polar: 1.0, diametral: 1.0 })),
        "mass of disc 0 is -1: expected a finite number above zero"
    );
    assert_eq!(sentence(shaft().bearing(7, BEARING)), "bearing 0 stands at node 7: the nodes are 0 to 4");
    assert_eq!(sentence(FlexibleRotor::new()), "elements: 0 given, expected 1");
    assert!(sentence(FlexibleRotor::uniform(2, f64::NAN, 0.05, steel)).contains("length of element 0"));
    let free = shaft().station(2).build().unwrap();
    assert_eq!(Modal::of(&free).unwrap_err(), RotorError::NotHeld);
    let one_end = shaft().bearing(0, BEARING).build().unwrap();
    assert_eq!(Modal::of(&one_end).unwrap_err(), RotorError::NotHeld);
    let held = three_discs(BEARING).build().unwrap();
    assert!(matches!(held.response(10.0, &[]), Err(RotorError::Count { found: 0, expected: 3, .. })));
    assert!(Spin::through(&[(0.0, 1.0), (0.0, 2.0)]).is_err());
}
