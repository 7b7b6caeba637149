//! Static and couple unbalance by hand, and the planes of a balancing machine separated against the solver's rotor.

use driveline::balancing::{Complex, Error, RigidUnbalance, one_plane_suffices, two_planes};
use driveline_solver::rotor::{Bearing, Direction, RigidRotor};

fn z(re: f64, im: f64) -> Complex<f64> {
    Complex::new(re, im)
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
