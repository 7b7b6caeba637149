//! Networks of inertias, springs, dampers and shafts of their own inertia, against other methods.

use driveline_solver::noise::Noise;
use driveline_solver::plant::vibration::{Network, Spring};
use nalgebra::{Complex, DMatrix};

/// Inertias and dampings of coordinates; links as terms, stiffness and damping.
struct Case {
    coordinates: Vec<(f64, f64)>,
    links: Vec<(Vec<(usize, f64)>, f64, f64)>,
}

impl Case {
    /// One of five kinds: near modes, dampers alone, over-damped parts behind gears, springs to the ground, loops.
    fn random(noise: &mut Noise, kind: usize) -> Self {
        let mut decades = |low: f64, high: f64| 10f64.powf(low + (high - low) * (0.5 + 0.5 * noise.uniform()));
        let count = 3 + (decades(0.0, 0.8) as usize);
        let mut case = Self { coordinates: Vec::new(), links: Vec::new() };
        for j in 0..count {
            let viscous = if kind >= 2 && decades(0.0, 1.0) > 3.0 { decades(-1.0, 1.0) } else { 0.0 };
            // like branches on a hub, or anything
            let inertia = if kind == 0 { 0.3 * decades(0.0, 4e-5) } else { decades(-1.0, 1.0) };
            case.coordinates.push((inertia, viscous));
            let Some(before) = j.checked_sub(1) else { continue };
            let parent = if kind == 0 { 0 } else { ((decades(0.0, 1.0) - 1.0) / 9.0 * j as f64) as usize };
            let ratio = if kind == 2 { decades(-0.5, 0.5) } else { 1.0 };
            let stiffness = match kind {
                0 => 1e4 * decades(0.0, 4e-5),
                1 if decades(0.0, 1.0) < 2.5 => 0.0,
                _ => decades(2.0, 4.0),
            };
            let damping = if kind == 2 { decades(1.0, 3.0) } else { decades(-1.0, 1.0) };
            case.links.push((vec![(parent.min(before), 1.0), (j, -ratio)], stiffness, damping));
        }
        match kind {
            3 => case.links.push((vec![(count - 1, 1.0)], decades(2.0, 4.0), 0.0)),
            4 => case.links.push((vec![(0, 1.0), (count - 1, -1.0)], decades(2.0, 4.0), decades(-1.0, 1.0))),
            _ => {}
        }
        case
    }

    fn network(&self) -> Network {
        let mut network = Network::default();
        for &(inertia, viscous) in &self.coordinates {
            network.coordinate(inertia, viscous);
        }
        for (terms, stiffness, damping) in &self.links {
            network.link(Spring::new(terms, *stiffness).damping(*damping));
        }
        network
    }

    /// The eigenvalues of the equations in angles and speeds, from a Schur decomposition.
    fn eigenvalues(&self) -> Vec<Complex<f64>> {
        let n = self.coordinates.len();
        let mut state = DMatrix::zeros(2 * n, 2 * n);
        for (j, (inertia, viscous)) in self.coordinates.iter().enumerate() {
            state[(j, n + j)] = 1.0;
            state[(n + j, n + j)] -= viscous / inertia;
        }
        for (terms, stiffness, damping) in &self.links {
            for &(a, one) in terms {
                for &(b, other) in terms {
                    state[(n + a, b)] -= one * other * stiffness / self.coordinates[a].0;
                    state[(n + a, n + b)] -= one * other * damping / self.coordinates[a].0;
                }
            }
        }
        let all = state.complex_eigenvalues();
        let top = all.iter().map(|value| value.norm()).fold(0.0, f64::max);
        // the zeros of rigid motions are double, and so known to the root of a rounding
        all.iter().copied().filter(|value| value.norm() > 1e-5 * top && value.im >= 0.0).collect()
    }
}

/// 200 random networks: every eigenvalue of the dense matrix is there, once, and no other. What the diagonal of the
/// modal damping gives, is off by up to 3.5 times where modes are near.
#[test]
fn damped_eigenvalues_are_those_of_the_dense_matrix() {
    let (mut noise, mut worst) = (Noise::new(7), 0.0_f64);
    for number in 0..200 {
        let case = Case::random(&mut noise, number % 5);
        let network = case.network();
        let mut found = network.decays(&network.modes(usize::MAX)).unwrap();
        let expected = case.eigenvalues();
        let top = expected.iter().map(|value| value.norm()).fold(0.0, f64::max);
        for value in &expected {
            let off = |k: &usize| (found[*k].decay + value.re).hypot(found[*k].omega - value.im);
            let near = (0..found.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
            // the dense matrix has the rounding of the highest rate's square over the rate, some digits more where
            // two rates are near
            let off = off(&near) / top;
            worst = worst.max(off);
            assert!(off < 1e-9, "{number}: {value} {:?}", found[near]);
            found.remove(near);
        }
        assert!(found.iter().all(|left| left.decay.hypot(left.omega) < 2e-5 * top), "{number}: {found:?}");
    }
    println!("worst of 200: {worst:.1e}");
}

/// Shafts with an inertia of their own and without, all with damping in the ratio `b` to their stiffness: each mode has
/// `s^2 + b omega^2 s + omega^2 = 0`, below and beyond critical damping.
#[test]
fn damping_in_the_ratio_of_the_stiffness_damps_each_mode_by_its_frequency() {
    let mut noise = Noise::new(11);
    for number in 0..200 {
        let mut decades = |low: f64, high: f64| 10f64.powf(low + (high - low) * (0.5 + 0.5 * noise.uniform()));
        let count = 1 + decades(0.0, 0.6) as usize;
        let inertias: Vec<f64> = (0..=count).map(|_| decades(-1.0, 1.0)).collect();
        // one at least, and half of the others
        let own = |k: usize, inertia: f64| if k == 0 || number % (k + 2) == 0 { inertia } else { 0.0 };
        let shafts: Vec<[f64; 2]> = (0..count).map(|k| [decades(3.0, 5.0), own(k, decades(-1.0, 1.0))]).collect();
        let network = |ratio: f64| {
            let mut network = Network::default();
            inertias.iter().for_each(|&inertia| _ = network.coordinate(inertia, 0.0));
            for (k, &[stiffness, inertia]) in shafts.iter().enumerate() {
                network.link(Spring::shaft(k, k + 1, stiffness).damping(ratio * stiffness).inertia(inertia));
            }
            network
        };
        let omega = network(0.0).modes(8).omega;
        let ratio = 2.0 * decades(-2.0, 1.0) / omega[7];
        let damped = network(ratio);
        let mut found = damped.decays(&damped.modes(8)).unwrap_or_else(|error| panic!("{number}: {error}"));
        for omega in omega {
            let zeta = 0.5 * ratio * omega;
            let root = (1.0 - zeta * zeta).abs().sqrt();
            let expected = if zeta < 1.0 {
                vec![Complex::new(zeta, root)]
            } else {
                vec![(zeta + root).into(), (1.0 / (zeta + root)).into()]
            };
            for expected in expected {
                let off =
                    |k: &usize| (found[*k].decay / omega - expected.re).hypot(found[*k].omega / omega - expected.im);
                let near = (0..found.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
                // two decays that are nearly one are known to the root of a rounding
                let close = (1e-12 + 1e-14 / root) * expected.norm();
                assert!(off(&near) < close, "{number}: {omega} {zeta} {expected} {:?}", found[near]);
                found.remove(near);
            }
        }
        assert!(found.is_empty(), "{number}: {found:?}");
    }
}

/// A shaft held at one end with an inertia at the other, `theta tan(theta) = I/J`, and with none, `(m - 1/2) pi`.
#[test]
fn an_even_shaft_is_its_transcendental_equation() {
    for (shaft, bit) in [(200.0, 100.0), (200.0, 0.0), (1e-3, 1e3), (1e3, 1e-3)] {
        let mut string = Network::default();
        let end = string.coordinate(bit, 0.0);
        string.link(Spring::ground(end, 500.0).inertia(shaft));
        for (m, omega) in string.modes(8).omega.into_iter().enumerate() {
            let theta = omega * (shaft / 500.0_f64).sqrt();
            // one root in each half turn, where the difference changes its sign
            let (mut low, mut high) = (m as f64 * std::f64::consts::PI, (m as f64 + 0.5) * std::f64::consts::PI);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if middle * middle.sin() * bit < shaft * middle.cos() {
                    if m % 2 == 0 { low = middle } else { high = middle }
                } else if m % 2 == 0 {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            // roundings of a bisection
            assert!((theta / (0.5 * (low + high)) - 1.0).abs() < 1e-13, "{shaft} {bit} {m}: {theta} {low}");
        }
    }
}

/// A chain of equal parts, of any number: `2 sqrt(k/J) sin(m pi/2n)` free, and its first frequency at an inertia ratio
/// of 1e12.
#[test]
fn a_long_chain_has_every_frequency() {
    let n = 700;
    let mut chain = Network::default();
    for j in 0..n {
        chain.coordinate(2.0, 0.0);
        if j > 0 {
            chain.link(Spring::shaft(j - 1, j, 800.0));
        }
    }
    let modes = chain.modes(usize::MAX);
    assert_eq!((modes.omega.len(), modes.rigid_motions), (n - 1, 1));
    for (m, omega) in (1..).zip(&modes.omega) {
        let expected = 40.0 * (f64::from(m) * std::f64::consts::PI / (2 * n) as f64).sin();
        assert!((omega / expected - 1.0).abs() < 1e-13, "{m}: {omega} {expected}");
    }
    let mut far = Network::default();
    let (small, large) = (far.coordinate(1e-6, 0.0), far.coordinate(1e6, 0.0));
    far.link(Spring::shaft(small, large, 4.0));
    let expected = (4.0 * (1e6 + 1e-6_f64)).sqrt();
    assert!((far.modes(1).omega[0] / expected - 1.0).abs() < 1e-15, "{:?}", far.modes(1));
}

/// Two masses on three shafts side by side that one of them drags: the slow decay is that of both on the drag, as a
/// computation in 50 digits has it, with any order of the terms.
#[test]
fn shafts_side_by_side_leave_no_rounding_in_a_slow_decay() {
    let mut network = Network::default();
    network.coordinate(0.171_733_305_681_194_71, 0.0);
    network.coordinate(2.444_990_126_389_699_4, 0.257_042_271_785_849_76);
    network.link(Spring::shaft(0, 1, 44_201.101_500_684_1));
    network.link(Spring::shaft(1, 0, 1_017.646_462_974_432_2).damping(0.257_132_513_558_709_03));
    network.link(
        Spring::new(&[(1, 2.0), (0, -2.0)], 0.25 * 89.037_153_146_047_84).damping(0.25 * 0.482_078_639_094_214_4),
    );
    let decays = network.decays(&network.modes(8)).unwrap();
    let expected = [(0.098_230_584_574_8, 0.0), (2.306_825_067_51, 531.368_022_319)];
    assert_eq!(decays.len(), expected.len());
    for (found, (decay, omega)) in decays.iter().zip(expected) {
        // to the twelve digits that were written down
        assert!((found.decay - decay).abs() < 2e-12 * decay.hypot(omega), "{found:?}");
        assert!((found.omega - omega).abs() <= 2e-12 * omega, "{found:?}");
    }
}
