//! Modal balancing: of a uniform beam by the analytic shapes of its modes, and of a whirling rotor through its critical
//! speeds. Static and couple unbalance by hand, and the planes of a balancing machine separated against the solver's
//! rotor.

use std::f64::consts::PI;

use driveline::balancing::{Aim, Complex, Error, Influence, RigidUnbalance, one_plane_suffices, two_planes};
use driveline_solver::rotor::{Bearing, Direction, FlexibleRotor, Material, Modal, RigidRotor, Spin, Whirl};

fn z(re: f64, im: f64) -> Complex<f64> {
    Complex::new(re, im)
}

/// Weights of planes on modes, and on the rigid rotor where planes are two more than modes; `couple` is a length (m)
/// that makes the couple comparable with the others.
fn weights(
    shapes: &[Vec<f64>],
    places: &[f64],
    modal: &[Complex<f64>],
    rigid: RigidUnbalance<f64>,
    couple: f64,
) -> Vec<Complex<f64>> {
    let shapes: Vec<&[f64]> = shapes.iter().map(Vec::as_slice).collect();
    let influence = Influence::<f64, 8, 8>::modal(&shapes, places).unwrap();
    let mut aim = Aim { independence: 1e-6, ..Aim::default() };
    let mut conditions = modal.to_vec();
    if places.len() > shapes.len() {
        conditions.extend([rigid.resultant, rigid.couple]);
        aim.weighting[conditions.len() - 1] = 1.0 / couple;
    }
    let found = influence.correct(&conditions, &aim).unwrap();
    assert!(found.left_out.is_empty());
    found.weights[..places.len()].to_vec()
}

/// A simply supported beam of 2 m about its middle: shapes sin(n pi x/l), unbalance at three places and a mode's worth
/// of it spread as sin(2 pi x/l), whose modal unbalance is l/2 and whose resultant is zero, couple -l^2/(2 pi).
#[test]
fn n_planes_take_n_modes_and_two_more_the_rigid_rotor() {
    let length: f64 = 2.0;
    let shape = |n: usize, place: f64| (n as f64 * PI * (place + 0.5 * length) / length).sin();
    let unbalances = [(z(1.2, 0.3), -0.61), (z(-0.4, 0.8), 0.13), (z(0.2, -1.1), 0.77)];
    let spread = z(0.05, -0.02);
    let modal = |n: usize, weights: &[(Complex<f64>, f64)]| -> Complex<f64> {
        let points: Complex<f64> = unbalances.iter().chain(weights).map(|(u, place)| u * shape(n, *place)).sum();
        points + if n == 2 { spread * (0.5 * length) } else { z(0.0, 0.0) }
    };
    let rigid = |weights: &[(Complex<f64>, f64)]| {
        let mut found = RigidUnbalance::of(unbalances.iter().chain(weights).copied()).unwrap();
        found.couple -= spread * (length * length / (2.0 * PI));
        found
    };
    for count in 1..=4 {
        let before: Vec<Complex<f64>> = (1..=count).map(|n| modal(n, &[])).collect();
        for planes in [count, count + 2] {
            // unevenly spread, and on no node of the four modes
            let places: Vec<f64> =
                (0..planes).map(|j| length * ((j as f64 + 0.83) / (planes as f64 + 0.9) - 0.5)).collect();
            let shapes: Vec<Vec<f64>> =
                (1..=count).map(|n| places.iter().map(|place| shape(n, *place)).collect()).collect();
            let found = weights(&shapes, &places, &before, rigid(&[]), 0.5 * length);
            let set: Vec<(Complex<f64>, f64)> = found.into_iter().zip(places).collect();
            let size: f64 = set.iter().map(|(weight, _)| weight.norm()).sum();
            for n in 1..=count {
                // rounding of the weights' sum, times a condition of some hundreds
                assert!(modal(n, &set).norm() < 1e-12 * size, "{n} of {count} in {planes}: {}", modal(n, &set));
            }
            let left = rigid(&set);
            if planes > count {
                assert!(left.resultant.norm() < 1e-12 * size && left.couple.norm() < 1e-12 * size, "{count}: {left:?}");
            } else {
                // the rigid rotor is not balanced by the way
                assert!(left.resultant.norm() > 0.05 && left.couple.norm() > 0.05, "{count}: {left:?}");
            }
        }
    }
}

/// One plane in the middle of the beam: the first mode of an unbalance u at a quarter of the length takes
/// u sin(pi/4) there. Its own set of weights bends a mode by one, and no other.
#[test]
fn weights_by_hand() {
    let middle = weights(&[vec![1.0]], &[0.0], &[z(0.5_f64.sqrt(), 0.0)], RigidUnbalance::of([]).unwrap(), 1.0);
    assert!((middle[0] + z(0.5_f64.sqrt(), 0.0)).norm() < 1e-15);
    // planes at a quarter and three quarters: modes are their half sum and half difference
    let half = 0.5_f64.sqrt();
    let shapes: [&[f64]; 2] = [&[half, half], &[1.0, -1.0]];
    let influence = Influence::<f64, 2, 2>::modal(&shapes, &[-0.5, 0.5]).unwrap();
    let second = influence.correct(&[z(0.0, 0.0), z(-1.0, 0.0)], &Aim::default()).unwrap().weights;
    assert!((second[0] - z(0.5, 0.0)).norm() < 1e-15 && (second[1] + z(0.5, 0.0)).norm() < 1e-15, "{second:?}");
}

#[test]
fn other_numbers_of_planes_are_refused() {
    type Planes = Influence<f64, 4, 4>;
    let shape: &[f64] = &[0.5, 1.0, 0.5];
    assert!(Planes::modal(&[shape], &[-0.5, 0.0, 0.5]).is_ok());
    // no mode in two planes: the rigid rotor alone
    assert!(Planes::modal(&[], &[-0.5, 0.5]).is_ok());
    let wrong = Planes::modal(&[shape], &[-0.5, 0.5]).unwrap_err();
    assert_eq!(wrong, Error::ModalPlanes { modes: 1, planes: 2 });
    assert_eq!(wrong.to_string(), "balancing 1 mode(s) takes 1 plane(s), or two more: there are 2");
    assert_eq!(Planes::modal(&[], &[0.0]), Err(Error::ModalPlanes { modes: 0, planes: 1 }));
    assert_eq!(Planes::modal(&[], &[]), Err(Error::Size));
    assert_eq!(Planes::modal(&[shape; 3], &[0.0; 5]), Err(Error::Size));
    assert_eq!(Planes::modal(&[shape], &[-0.5, f64::NAN, 0.5]), Err(Error::Setting { index: 1 }));
    assert_eq!(Planes::modal(&[&[0.5, 1.0]], &[-0.5, 0.0, 0.5]), Err(Error::ReadingMissing { row: 0 }));
    assert_eq!(Planes::modal(&[&[0.5, f64::NAN, 0.5]], &[-0.5, 0.0, 0.5]), Err(Error::Reading { row: 0 }));
}

/// A shaft of 2 m through its first two critical speeds, in time. Balanced in four planes it is quiet at low speed and
/// at the critical speeds; in two planes at the critical speeds only.
#[test]
fn a_rotor_balanced_in_n_and_two_planes_is_quiet_at_all_speeds() {
    const NODES: usize = 12;
    let mut rotor = FlexibleRotor::uniform(NODES, 2.0, 0.06, Material::STEEL)
        .bearing(0, Bearing::isotropic(2e7, 2e3))
        .bearing(NODES, Bearing::isotropic(2e7, 2e3))
        .sensor(0, Direction::X)
        .sensor(5, Direction::X)
        .sensor(NODES, Direction::X);
    for node in 0..=NODES {
        rotor = rotor.station(node);
    }
    let (model, places, centre) = (rotor.build().unwrap(), rotor.places(), rotor.centre());
    // of a uniform shaft
    assert!((centre - 1.0).abs() < 1e-12);
    let modal = Modal::of(&model).unwrap();
    let modes = model.forward_shapes(8);
    let mut unbalance = vec![z(0.0, 0.0); NODES + 1];
    for (node, amount) in [(2, z(8e-5, 0.0)), (4, z(-3e-5, 9e-5)), (9, z(2e-5, 7e-5)), (11, z(-6e-5, -2e-5))] {
        unbalance[node] = amount;
    }
    let rigid = RigidUnbalance::of(unbalance.iter().copied().zip(places.iter().map(|at| at - centre))).unwrap();
    let before: Vec<Complex<f64>> =
        modes[..2].iter().map(|(_, shape)| unbalance.iter().zip(shape).map(|(u, phi)| u * phi).sum()).collect();
    let balanced = |planes: &[usize]| {
        let at = |shape: &[f64]| -> Vec<f64> { planes.iter().map(|&node| shape[node]).collect() };
        let shapes: Vec<Vec<f64>> = modes[..2].iter().map(|(_, shape)| at(shape)).collect();
        let distances: Vec<f64> = planes.iter().map(|&node| places[node] - centre).collect();
        let mut all = unbalance.clone();
        for (&node, weight) in planes.iter().zip(weights(&shapes, &distances, &before, rigid, 1.0)) {
            all[node] += weight;
        }
        all
    };
    let (two, four) = (balanced(&[4, 9]), balanced(&[1, 4, 8, 11]));
    // the largest motion of the shaft at rest in a whirl, in time over two turns
    let whirl = |unbalance: &[Complex<f64>], speed: f64| {
        let tick = 2.0 * PI / speed / 64.0;
        let mut whirl = Whirl::new(modal.clone(), tick);
        whirl.set_unbalance(unbalance).unwrap();
        whirl.settle(0.0, speed).unwrap();
        let spin = Spin::steady(speed);
        let mut largest = [0.0_f64; 3];
        for step in 0..128 {
            whirl.advance(&spin.turn(f64::from(step) * tick, tick));
            for (sensor, largest) in largest.iter_mut().enumerate() {
                *largest = largest.max(whirl.motion(sensor).unwrap().displacement.abs());
            }
        }
        largest
    };
    let worst =
        |now: [f64; 3], before: [f64; 3]| now.iter().zip(before).map(|(now, before)| now / before).fold(0.0, f64::max);
    let low = 0.1 * modes[0].0;
    let ratios = |speed: f64, of: &[Complex<f64>]| worst(whirl(of, speed), whirl(&unbalance, speed));
    // two planes leave 39 %, four 0.6 %: the share of the modes above the second, whose frequencies are far away
    assert!(ratios(low, &two) > 0.3, "{}", ratios(low, &two));
    assert!(ratios(low, &four) < 0.01, "{}", ratios(low, &four));
    for (speed, _) in &modes[..2] {
        for set in [&two, &four] {
            // without the mode, what is left is the static share of the others: a damping ratio of a few per cent
            assert!(ratios(*speed, set) < 0.03, "{speed}: {}", ratios(*speed, set));
        }
    }
    // and between them: the highest peak up to a tenth above the second critical speed
    let peak = |unbalance: &[Complex<f64>]| {
        let speeds =
            (1..=110).map(|step| f64::from(step) * 0.01 * modes[1].0).chain(modes[..2].iter().map(|mode| mode.0));
        let motion = |speed| model.response(speed, unbalance).unwrap().iter().map(|x| x.norm()).fold(0.0, f64::max);
        speeds.map(motion).fold(0.0, f64::max)
    };
    for set in [&two, &four] {
        let ratio = peak(set) / peak(&unbalance);
        // the peaks of the unbalanced rotor are those of the two modes
        assert!(ratio < 1e-3, "{ratio}");
    }
}

/// Binary fractions, so that every sum is exact.
#[test]
fn static_and_couple_part_are_sums() {
    let unbalances = [(z(3.0, 0.0), -0.5), (z(0.0, 2.0), 0.25), (z(-1.0, 1.0), 0.75)];
    let found = RigidUnbalance::of(unbalances).unwrap();
    // 3 + 2i - 1 + i, and -1.5 + 0.5i + (-0.75 + 0.75i)
    assert_eq!(found, RigidUnbalance { resultant: z(2.0, 3.0), couple: z(-2.25, 1.25) });
}

#[test]
fn a_narrow_rotor_takes_one_plane() {
    assert_eq!(one_plane_suffices(0.2, 1.0), Ok(true));
    assert_eq!(one_plane_suffices(0.2_f64.next_up(), 1.0), Ok(false));
    assert_eq!(one_plane_suffices(0.1_f32, 0.4), Ok(false));
    assert_eq!(one_plane_suffices(f64::NAN, 1.0), Err(Error::Setting { index: 0 }));
    assert_eq!(one_plane_suffices(0.1, 0.0), Err(Error::Setting { index: 1 }));
}

#[test]
fn what_is_no_number_is_refused() {
    let right = (z(1.0, 0.0), 0.1);
    assert_eq!(RigidUnbalance::of([right, (z(f64::NAN, 0.0), 0.1)]), Err(Error::Weight { plane: 1 }));
    assert_eq!(RigidUnbalance::of([right, (z(1.0, 0.0), f64::INFINITY)]), Err(Error::Setting { index: 1 }));
}

/// A rotor in stiff bearings 0.7 m apart, its planes overhung and between: the solver's bearing forces, over the
/// square of the speed, give each plane its own unbalance back.
#[test]
fn forces_in_hard_bearings_separate_the_planes() {
    let (stiffness, speed) = (1e12, 60.0);
    let (bearings, planes) = ([-0.3, 0.4], [-0.45, 0.2]);
    let model = RigidRotor::new(40.0, 0.9, 1.6)
        .bearing(bearings[0], Bearing::isotropic(stiffness, 0.0))
        .bearing(bearings[1], Bearing::isotropic(stiffness, 0.0))
        .station(planes[0])
        .station(planes[1])
        .sensor(bearings[0], Direction::X)
        .sensor(bearings[1], Direction::X)
        .build()
        .unwrap();
    let unbalances = [z(2e-3, 1e-3), z(-5e-4, 1.5e-3)];
    let motion = model.response(speed, &unbalances).unwrap();
    let at_bearing = |k: usize| (motion[k] * stiffness / (speed * speed), bearings[k]);
    let found = two_planes([at_bearing(0), at_bearing(1)], planes[0], planes[1]).unwrap();
    for (found, expected) in found.iter().zip(unbalances) {
        // the masses move by m Omega^2/k = 1.4e-7 of their share
        assert!((found - expected).norm() < 1e-6 * expected.norm(), "{found} {expected}");
    }
}
