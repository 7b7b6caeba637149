//! The spur pair of fourteen coordinates `[Tang 1994 (1.6)]`, and the damping of its mesh with the rate of the error
//! `[Tang 1994 (1.5)]`.

use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{
    Coordinate, Harmonic, Link, Signal, SpurBearing, SpurPair, SpurWheel, Teeth, Train, Variation,
};
use nalgebra::{Complex, DMatrix, DVector, SymmetricEigen};

/// Pinion and wheel of different shafts; no bearing like another.
fn pair(damping: f64) -> SpurPair {
    let bearing = |mass, lever, k: f64| SpurBearing {
        mass,
        lever,
        stiffness: [k, 0.7 * k],
        damping: [damping * 2e-5 * k, damping * 3e-5 * k],
    };
    let wheel = |mass, inertia, base_radius, k: f64, bearings| SpurWheel {
        mass,
        inertia,
        base_radius,
        shaft_stiffness: k,
        shaft_damping: damping * 1e-5 * k,
        bearings,
    };
    SpurPair {
        pinion: wheel(1.8, 0.0021, 0.0395, 2.0e8, [bearing(0.4, 0.06, 3.0e8), bearing(0.5, 0.09, 2.5e8)]),
        wheel: wheel(9.0, 0.065, 0.094, 4.0e8, [bearing(0.8, 0.05, 5.0e8), bearing(0.7, 0.1, 3.5e8)]),
        mesh_stiffness: 5.68e8,
        mesh_damping: damping * 2500.0,
        variation: None,
        gap: 0.0,
        torque: 0.0,
    }
}

/// `M`, `C` and `K` row by row from the equations of motion: each force is written with its sign where it acts. The
/// coordinates are those of the pair.
fn dense(pair: &SpurPair) -> [DMatrix<f64>; 3] {
    let (mut m, mut c, mut k) = (DMatrix::zeros(14, 14), DMatrix::zeros(14, 14), DMatrix::zeros(14, 14));
    // mesh: F = k (r1 phi1 - r2 phi2 + Y1 - Y2); on Y1: -F, on phi1: -r1 F, on Y2: +F, on phi2: +r2 F
    let [r1, r2] = [pair.pinion.base_radius, pair.wheel.base_radius];
    for (row, sign) in [(0, 1.0), (2, r1), (7, -1.0), (9, -r2)] {
        for (matrix, size) in [(&mut k, pair.mesh_stiffness), (&mut c, pair.mesh_damping)] {
            matrix[(row, 0)] += sign * size;
            matrix[(row, 2)] += sign * size * r1;
            matrix[(row, 7)] -= sign * size;
            matrix[(row, 9)] -= sign * size * r2;
        }
    }
    for (g, body) in [(0, &pair.pinion), (7, &pair.wheel)] {
        (m[(g, g)], m[(g + 1, g + 1)], m[(g + 2, g + 2)]) = (body.mass, body.mass, body.inertia);
        let [a, b] = [body.bearings[0].lever, body.bearings[1].lever];
        let l = a + b;
        for d in 0..2 {
            let (wheel, left, right) = (g + d, g + 3 + d, g + 5 + d);
            for (matrix, size) in [(&mut k, body.shaft_stiffness), (&mut c, body.shaft_damping)] {
                // the wheel: s (y - (b y_A + a y_B)/l); the bearings carry b/l and a/l of it, from the levers
                matrix[(wheel, wheel)] += size;
                matrix[(wheel, left)] -= size * b / l;
                matrix[(wheel, right)] -= size * a / l;
                matrix[(left, wheel)] -= size * b / l;
                matrix[(left, left)] += size * b * b / (l * l);
                matrix[(left, right)] += size * a * b / (l * l);
                matrix[(right, wheel)] -= size * a / l;
                matrix[(right, left)] += size * a * b / (l * l);
                matrix[(right, right)] += size * a * a / (l * l);
            }
            for (at, bearing) in [(left, &body.bearings[0]), (right, &body.bearings[1])] {
                m[(at, at)] = bearing.mass;
                k[(at, at)] += bearing.stiffness[d];
                c[(at, at)] += bearing.damping[d];
            }
        }
    }
    [m, c, k]
}

/// All fourteen against the eigenvalues of `M^-1/2 K M^-1/2`; one of them is the turning of both wheels.
#[test]
fn the_fourteen_frequencies_are_those_of_the_dense_matrices() {
    let pair = pair(0.0);
    let [m, _, k] = dense(&pair);
    let scaled = DMatrix::from_fn(14, 14, |i, j| k[(i, j)] / (m[(i, i)] * m[(j, j)]).sqrt());
    let mut expected: Vec<f64> = SymmetricEigen::new(scaled).eigenvalues.iter().copied().collect();
    expected.sort_by(f64::total_cmp);
    let modes = pair.train().modes().unwrap();
    assert_eq!((modes.omega.len(), modes.rigid_motions()), (SpurPair::COORDINATES, 1));
    let top = expected[13];
    assert!(expected[0].abs() < 1e-12 * top, "{}", expected[0]);
    for (omega, expected) in modes.omega.iter().zip(&expected).skip(1) {
        // the dense method rounds by 1e-16 of the largest eigenvalue, a hundred times the smallest
        assert!((omega * omega / expected - 1.0).abs() < 1e-10, "{} {expected}", omega * omega);
    }
}

fn error(size: f64) -> Variation {
    let error = vec![Harmonic { order: 1.0, cosine: 0.6 * size, sine: -0.8 * size }];
    Variation::Harmonics { frequency: 900.0, stiffness: Vec::new(), error }
}

/// One mass behind a mesh whose error swings: `m x'' + d (x' - e') + k (x - e) = 0`. From a start on it, the swing is
/// `X = E (k + i w d)/(k - m w^2 + i w d)`, and the force `-m x''`.
#[test]
fn the_damper_of_a_mesh_feels_the_rate_of_its_error() {
    let (mass, k, d) = (2.0, 4.0e8, 9.0e3);
    let omega = std::f64::consts::TAU * 900.0;
    let e = Complex::new(0.6e-5, 0.8e-5);
    let x = e * Complex::new(k, omega * d) / Complex::new(k - mass * omega * omega, omega * d);
    let at = |t: f64| x * Complex::new(0.0, omega * t).exp();
    let coordinate = Coordinate::new(mass).angle(x.re).speed(-omega * x.im);
    let link = Link::ground(0, k).damping(d).varying(error(1e-5)).elongated(x.re);
    let mut run = Recording::new(Train::new().coordinate(coordinate).link(link).build().unwrap());
    for step in 1..=500 {
        run.advance(2e-5);
        let (found, expected) = (run.motion().force(0), mass * omega * omega * at(2e-5 * f64::from(step)).re);
        // roundings of the run
        assert!((found - expected).abs() < 1e-8 * mass * omega * omega * x.norm(), "{step}: {found} {expected}");
        // the elastic part is k (x - e), without its damper
        let stretched = at(2e-5 * f64::from(step)) - e * Complex::new(0.0, omega * 2e-5 * f64::from(step)).exp();
        let elastic = run.motion().read(Signal::Elastic(0));
        assert!((elastic - k * stretched.re).abs() < 1e-8 * k * x.norm(), "{step}: {elastic}");
    }
    prove(&run).unwrap();
}

/// The whole pair under the same error: the swing solves `(K - w^2 M + i w C) X = (k + i w c) E b`, `b` the shares of
/// the mesh; the force is `(k + i w c) (b X - E)`.
#[test]
fn the_tooth_force_of_the_pair_with_its_error_is_that_of_the_closed_form() {
    let mut pair = pair(1.0);
    pair.variation = Some(error(1e-5));
    let [m, c, k] = dense(&pair);
    let omega = std::f64::consts::TAU * 900.0;
    let e = Complex::new(0.6e-5, 0.8e-5);
    let complex = |i: usize, j: usize| Complex::new(k[(i, j)] - omega * omega * m[(i, j)], omega * c[(i, j)]);
    let mesh = Complex::new(pair.mesh_stiffness, omega * pair.mesh_damping);
    let mut shares = DVector::zeros(14);
    for (at, share) in [(0, 1.0), (2, pair.pinion.base_radius), (7, -1.0), (9, -pair.wheel.base_radius)] {
        shares[at] = Complex::from(share);
    }
    let x = DMatrix::from_fn(14, 14, complex).lu().solve(&(&shares * (mesh * e))).unwrap();
    let force = mesh * (shares.dot(&x) - e);
    // from rest the free swings die out; what they leave of the turning is a steady drift without force
    let mut motion = pair.train().build().unwrap();
    motion.advance(0.4);
    for step in 1..=50 {
        motion.advance(3.7e-5);
        let expected = (force * Complex::new(0.0, omega * motion.time()).exp()).re;
        let found = motion.force(SpurPair::MESH);
        assert!((found - expected).abs() < 1e-8 * force.norm(), "{step}: {found} {expected} of {}", force.norm());
    }
}

/// Two pairs in contact, each with its own stiffness and error: the force at rest is `sum k_i (x - e_i)`, and pairs by
/// the angle of a wheel that turns evenly are those by time.
#[test]
fn two_pairs_carry_by_their_own_stiffness_and_error() {
    let (double, leaving, single, errors) = (6.8e8, 2.3e8, 4.0e8, [8e-6, -3e-6]);
    let frequency = 100.0;
    let zones = Variation::pairs(1.6, frequency, [double, leaving], single, errors);
    let speed = std::f64::consts::TAU * frequency / 21.0;
    let teeth = Teeth { coordinate: 1, count: 21.0, contact_ratio: 1.6, double, single, leaving, errors };
    let train = |variation: Variation| {
        let link = Link::ground(0, 5e8).damping(4.0e3).varying(variation).elongated(1e-5);
        Train::new().coordinate(Coordinate::new(2.0)).coordinate(Coordinate::new(1.0).speed(speed)).link(link)
    };
    let (mut by_time, mut by_angle) =
        (train(zones).build().unwrap(), Recording::new(train(Variation::Teeth(teeth)).build().unwrap()));
    // as long as the speed is zero the force is that of the springs: pair 0 enters, pair 1 leaves
    let expected = (double - leaving) * (1e-5 - errors[0]) + leaving * (1e-5 - errors[1]);
    assert!((by_time.force(0) - expected).abs() < 1e-10 * expected, "{}", by_time.force(0));
    for step in 1..=300 {
        by_time.advance(1.7e-4);
        by_angle.advance(1.7e-4);
        let (a, b) = (by_time.elongation(0), by_angle.motion().elongation(0));
        // edges by an angle of a few radians are located to its rounding
        assert!((a - b).abs() < 1e-10 * 1e-5, "{step}: {a} {b}");
    }
    prove(&by_angle).unwrap();
}
