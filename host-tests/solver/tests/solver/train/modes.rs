//! Natural frequencies of trains whose inertias and stiffnesses lie far apart.

use driveline_solver::noise::Noise;
use driveline_solver::plant::train::{Coordinate, Link, Source, Train};

/// A tree of coordinates: for each but the first the one before it, the stiffness and the ratio of its link; and
/// springs to the ground.
struct Tree {
    inertia: Vec<f64>,
    links: Vec<(usize, f64, f64)>,
    ground: Vec<f64>,
}

impl Tree {
    /// A random one: up to eleven inertias over fifteen decades, as many stiffnesses, ratios of either sign.
    fn random(noise: &mut Noise) -> Self {
        let mut decades = |half: f64| 10f64.powf(half * noise.uniform());
        let count = 3 + (3.0 * decades(0.47)) as usize;
        let inertia: Vec<f64> = (0..count).map(|_| decades(7.5)).collect();
        let mut links = Vec::new();
        for node in 1..count {
            let parent = ((decades(0.5) - 0.316) / 2.85 * node as f64) as usize;
            let sign = if decades(1.0) > 3.0 { -1.0 } else { 1.0 };
            links.push((parent.min(node - 1), decades(7.5), sign * decades(1.0)));
        }
        let ground = (0..count).map(|_| if decades(1.0) > 6.0 { decades(7.5) } else { 0.0 }).collect();
        Tree { inertia, links, ground }
    }

    fn train(&self) -> Train {
        let mut train = self.inertia.iter().fold(Train::new(), |train, &j| train.coordinate(Coordinate::new(j)));
        for (node, &(parent, stiffness, ratio)) in (1..).zip(&self.links) {
            train = train.link(Link::geared(parent, node, ratio, stiffness));
        }
        let grounded = self.ground.iter().enumerate().filter(|(_, stiffness)| **stiffness > 0.0);
        grounded.fold(train, |train, (node, &stiffness)| train.link(Link::ground(node, stiffness)))
    }

    /// Frequencies below `omega`, by Holzer's method from the leaves to the root: each link turns the dynamic stiffness
    /// behind it into `k X/(k + X)`, and as many frequencies lie below as there are negative pivots (Sylvester). Every
    /// rounding is that of a stiffness or of an inertia, so a frequency found so has all its digits.
    fn below(&self, omega: f64) -> usize {
        let dynamic = |(j, ground): (&f64, &f64)| ground - omega * omega * j;
        let mut stiffness: Vec<f64> = self.inertia.iter().zip(&self.ground).map(dynamic).collect();
        let mut negative = 0;
        for (node, &(parent, k, ratio)) in (1..self.inertia.len()).zip(&self.links).rev() {
            let behind = stiffness[node] / (ratio * ratio);
            negative += usize::from(k + behind < 0.0);
            stiffness[parent] += k * (behind / (k + behind));
        }
        negative + usize::from(stiffness[0] < 0.0)
    }

    /// All frequencies, by bisection of their logarithm; zero for those below anything elastic.
    fn frequencies(&self) -> Vec<f64> {
        let frequency = |rank: usize| {
            let (mut low, mut high) = (1e-30_f64, 1e30_f64);
            if self.below(low) > rank {
                return 0.0;
            }
            while high / low > 1.0 + 4e-16 {
                let middle = (low * high).sqrt();
                if middle <= low || middle >= high {
                    break;
                }
                if self.below(middle) > rank { high = middle } else { low = middle }
            }
            (low * high).sqrt()
        };
        (0..self.inertia.len()).map(frequency).collect()
    }
}

/// 200 random trees over fifteen decades: every frequency to 1e-12, where the bisection keeps some 1e-15 for each of
/// its ten links; and the right number of rigid motions, exactly zero.
#[test]
fn frequencies_of_random_trains_over_fifteen_decades_keep_their_digits() {
    let mut noise = Noise::new(1);
    let mut worst = 0.0_f64;
    for number in 0..200 {
        let tree = Tree::random(&mut noise);
        let (modes, expected) = (tree.train().modes().unwrap(), tree.frequencies());
        assert_eq!(modes.rigid_motions(), expected.iter().filter(|omega| **omega == 0.0).count(), "{number}");
        for (found, expected) in modes.omega.iter().zip(&expected).filter(|(_, expected)| **expected > 0.0) {
            worst = worst.max((found / expected - 1.0).abs());
        }
        assert!(worst < 1e-12, "{number}: {worst} {:?} {expected:?}", modes.omega);
        // A shape is a motion with its frequency: the strain energy is the kinetic energy.
        for (omega, shape) in modes.omega.iter().zip(&modes.shapes) {
            let kinetic: f64 = shape.iter().zip(&tree.inertia).map(|(q, j)| j * q * q).sum();
            assert!((kinetic - 1.0).abs() < 1e-12, "{number}: {kinetic}");
            let links = (1..).zip(&tree.links).map(|(node, &(p, k, r))| k * (shape[p] - r * shape[node]).powi(2));
            let ground = tree.ground.iter().zip(shape).map(|(k, q)| k * q * q);
            let strain: f64 = links.chain(ground).sum();
            // differences of shapes that are alike lose digits: the strain of the slow modes is not held to more
            if *omega > 1e-6 * modes.omega[modes.omega.len() - 1] {
                assert!((strain / (omega * omega) - 1.0).abs() < 1e-3, "{number}: {strain} {omega}");
            }
        }
    }
    println!("worst of 200: {worst:.1e}");
}

/// A gnat between a motor and a mill: the roots of `s^2 - b s + c`, the lower one as `c` over the upper.
#[test]
fn a_slow_frequency_beside_a_fast_one_is_there() {
    let ([j1, j2, j3], [k1, k2]) = ([1e-3, 1.0, 1e3], [1e9, 1.0]);
    let b = k1 * (1.0 / j1 + 1.0 / j2) + k2 * (1.0 / j2 + 1.0 / j3);
    let c: f64 = k1 * k2 * (j1 + j2 + j3) / (j1 * j2 * j3);
    let fast = 0.5 * (b + (b * b - 4.0 * c).sqrt());
    let train = [j1, j2, j3].iter().fold(Train::new(), |train, &j| train.coordinate(Coordinate::new(j)));
    let modes = train.link(Link::shaft(0, 1, k1)).link(Link::shaft(1, 2, k2)).modes().unwrap();
    assert_eq!((modes.omega[0], modes.rigid_motions()), (0.0, 1));
    // some roundings
    for (found, expected) in modes.omega[1..].iter().zip([(c / fast).sqrt(), fast.sqrt()]) {
        assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
    }
}

/// Loops, whose links depend on each other: a ring of three equal masses has `sqrt(3 k/J)` twice, and a mass between
/// two springs to the ground `sqrt((k1 + k2)/J)`, whatever their ratio.
#[test]
fn loops_have_no_frequencies_of_their_own() {
    let ring = (0..3).fold(Train::new(), |train, _| train.coordinate(Coordinate::new(2.0)));
    let ring = (0..3).fold(ring, |train, at| train.link(Link::shaft(at, (at + 1) % 3, 6.0)));
    let modes = ring.modes().unwrap();
    assert_eq!((modes.omega.len(), modes.rigid_motions()), (3, 1));
    // some roundings
    assert!(modes.omega[1..].iter().all(|omega| (omega / 3.0 - 1.0).abs() < 1e-14), "{:?}", modes.omega);
    let between = Train::new().coordinate(Coordinate::new(4.0)).link(Link::ground(0, 1e14)).link(Link::ground(0, 1.0));
    let modes = between.modes().unwrap();
    assert!((modes.omega[0] / ((1e14 + 1.0) / 4.0_f64).sqrt() - 1.0).abs() < 1e-14, "{:?}", modes.omega);
}

/// Two coordinates that nothing ties, and one behind an external gear: the ratio is negative, the frequency as with a
/// positive one.
#[test]
fn what_nothing_holds_is_rigid_and_an_external_gear_is_a_gear() {
    let three = || (0..3).fold(Train::new(), |train, _| train.coordinate(Coordinate::new(1.0)));
    assert_eq!(three().modes().unwrap().rigid_motions(), 3);
    let geared = |ratio: f64| three().link(Link::geared(0, 1, ratio, 8.0)).modes().unwrap();
    let (external, internal) = (geared(-2.0), geared(2.0));
    assert_eq!(external.rigid_motions(), 2);
    // k (1/J + r^2/J), rounded a few times
    assert!((external.omega[2] / 40f64.sqrt() - 1.0).abs() < 1e-14);
    assert!((external.omega[2] / internal.omega[2] - 1.0).abs() < 1e-14);
}

/// Damping in proportion to stiffness and inertia, `d = b k` and `c = a J`, gives each mode the decay
/// `(a + b w^2)/2` and the frequency `sqrt(w^2 - decay^2)` \[derived\]; a fast one only decays, twice.
#[test]
fn damped_vibrations_of_proportional_damping_are_the_closed_form() {
    let (a, b) = (0.4, 3.0e-3);
    let inertia = [0.5, 2.0, 0.1, 3.0];
    let train = inertia.iter().fold(Train::new(), |t, &j| t.coordinate(Coordinate::new(j).viscous(a * j)));
    let shafts = [4.0e3, 9.0e4, 700.0];
    let shaft = |(at, &k): (usize, &f64)| Link::shaft(at, at + 1, k).damping(b * k);
    let train = shafts.iter().enumerate().map(shaft).fold(train, Train::link);
    let mut expected = vec![(a, 0.0)];
    for omega in train.modes().unwrap().omega.into_iter().filter(|omega| *omega > 0.0) {
        let decay = 0.5 * (a + b * omega * omega);
        if decay < omega {
            expected.push((decay, (omega * omega - decay * decay).sqrt()));
        } else {
            let apart = (decay * decay - omega * omega).sqrt();
            expected.extend([(decay - apart, 0.0), (decay + apart, 0.0)]);
        }
    }
    assert!(expected.iter().filter(|one| one.1 == 0.0).count() > 2 && expected.iter().any(|one| one.1 > 0.0));
    expected.sort_by(|a, b| a.0.hypot(a.1).total_cmp(&b.0.hypot(b.1)));
    let found = train.decays(&train.modes().unwrap()).unwrap();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    let top = expected.iter().map(|one| one.0.hypot(one.1)).fold(0.0, f64::max);
    for (found, (decay, omega)) in found.iter().zip(&expected) {
        // rounding of the largest eigenvalue, some hundred times the smallest difference here
        let off = (found.decay - decay).hypot(found.omega - omega);
        assert!(off < 1e-12 * top, "{found:?} {decay} {omega}");
        assert!((found.damping_ratio() - decay / decay.hypot(*omega)).abs() < 1e-9, "{found:?}");
    }
}

/// A motor's falling characteristic damps as friction to the ground does: `J w' = -slope w`. One that rises runs away.
#[test]
fn the_slope_of_a_line_is_damping() {
    let motor = |slope| Coordinate::new(2.0).source(Source::Line { stall: 10.0, slope });
    let decays = |slope| {
        let train = Train::new().coordinate(motor(slope));
        train.decays(&train.modes().unwrap()).unwrap()
    };
    assert!((decays(6.0)[0].decay - 3.0).abs() < 1e-15 && (decays(-6.0)[0].decay + 3.0).abs() < 1e-15);
    assert!(decays(0.0).is_empty());
}
