//! Files of cranes against closed forms: a hoist on an elastic girder, a travelling drive that reverses through its
//! gap.
//!
//! Between two contacts a train without damping is the sum of its modes, so a run is in closed form but for the times
//! of the contacts, which are roots.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::bench::answered;

/// A link of three coordinates: its force is `stiffness (e - high)` above `high`, `stiffness (e - low)` below `low`.
struct Link {
    terms: [f64; 3],
    stiffness: f64,
    low: f64,
    high: f64,
    /// At rest.
    elongation: f64,
}

impl Link {
    fn side(&self, elongation: f64) -> i8 {
        i8::from(elongation > self.high) - i8::from(elongation < self.low)
    }

    fn edge(&self, side: i8) -> f64 {
        if side > 0 { self.high } else { self.low }
    }
}

/// Modes of the links that carry, about the displacements that the forces would hold.
struct Modes {
    shapes: Matrix3<f64>,
    eigenvalues: Vector3<f64>,
    forces: Vector3<f64>,
    at: Vector3<f64>,
    speed: Vector3<f64>,
}

impl Modes {
    fn of(masses: [f64; 3], links: &[Link], sides: &[i8], torque: Vector3<f64>, q: [Vector3<f64>; 2]) -> Self {
        let root = Vector3::from(masses.map(f64::sqrt));
        let mut stiffness = Matrix3::zeros();
        let mut force = torque;
        for (link, &side) in links.iter().zip(sides).filter(|(_, side)| **side != 0) {
            let terms = Vector3::from(link.terms);
            stiffness += link.stiffness * terms * terms.transpose();
            force -= link.stiffness * (link.elongation - link.edge(side)) * terms;
        }
        let scaled = Matrix3::from_fn(|i, j| stiffness[(i, j)] / (root[i] * root[j]));
        let SymmetricEigen { eigenvectors, eigenvalues } = scaled.symmetric_eigen();
        let most = eigenvalues.amax();
        let project = |vector: Vector3<f64>| eigenvectors.transpose() * vector;
        Self {
            shapes: Matrix3::from_fn(|i, j| eigenvectors[(i, j)] / root[i]),
            // a rigid mode's is rounding
            eigenvalues: eigenvalues.map(|one| if one > 1e-12 * most { one } else { 0.0 }),
            forces: project(force.component_div(&root)),
            at: project(q[0].component_mul(&root)),
            speed: project(q[1].component_mul(&root)),
        }
    }

    /// Displacements and speeds after a time.
    fn after(&self, t: f64) -> [Vector3<f64>; 2] {
        let mode = |k: usize| {
            let (square, force, at, speed) = (self.eigenvalues[k], self.forces[k], self.at[k], self.speed[k]);
            if square == 0.0 {
                return [at + t * (speed + 0.5 * force * t), speed + force * t];
            }
            let omega = square.sqrt();
            let (sine, cosine) = (omega * t).sin_cos();
            let rest = force / square;
            [rest + (at - rest) * cosine + speed / omega * sine, speed * cosine - (at - rest) * omega * sine]
        };
        [0, 1].map(|which| self.shapes * Vector3::from_fn(|k, _| mode(k)[which]))
    }
}

/// The root of a function that changes its sign between two times, to rounding.
fn root(of: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let negative = of(from) < 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (from + to);
        if (of(middle) < 0.0) == negative { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}

/// Least and greatest force of each link, and contacts made, over torques that change at given times.
fn peaks(masses: [f64; 3], links: &[Link], torques: &[(f64, [f64; 3])], end: f64) -> (Vec<[f64; 2]>, usize) {
    const LOOK: f64 = 1e-4;
    let mut extremes = vec![[0.0_f64; 2]; links.len()];
    let mut q = [Vector3::zeros(), Vector3::zeros()];
    let mut sides: Vec<i8> = links.iter().map(|link| link.side(link.elongation)).collect();
    let mut contacts = 0;
    for (index, &(start, torque)) in torques.iter().enumerate() {
        let last = torques.get(index + 1).map_or(end, |next| next.0);
        let mut time = start;
        while time < last {
            let modes = Modes::of(masses, links, &sides, Vector3::from(torque), q);
            let stretch =
                |l: usize, t: f64| links[l].elongation + Vector3::from(links[l].terms).dot(&modes.after(t)[0]);
            let rate = |l: usize, t: f64| Vector3::from(links[l].terms).dot(&modes.after(t)[1]);
            let mut length = last - time;
            let mut changed = None;
            let mut t = 0.0;
            while t < length {
                let next = (t + LOOK).min(length);
                for l in 0..links.len() {
                    let (side, link) = (sides[l], &links[l]);
                    let edges = [link.low, link.high].into_iter().filter(|edge| edge.is_finite());
                    for edge in edges {
                        let over = |t: f64| stretch(l, t) - edge;
                        // what lies on the edge at the start is leaving it
                        if t > 0.0 && (over(t) > 0.0) != (over(next) > 0.0) && link.low < link.high {
                            let at = root(over, t, next);
                            if at < length {
                                let inside = (side > 0) == (edge == link.high) && side != 0;
                                let entered = if edge == link.high { 1 } else { -1 };
                                (length, changed) = (at, Some((l, if inside { 0 } else { entered })));
                            }
                        }
                    }
                }
                for (l, extreme) in extremes.iter_mut().enumerate().filter(|(l, _)| sides[*l] != 0) {
                    let (link, till) = (&links[l], next.min(length));
                    let force = |t: f64| link.stiffness * (stretch(l, t) - link.edge(sides[l]));
                    let turns = (rate(l, t) > 0.0) != (rate(l, till) > 0.0);
                    let at = if turns { root(|t| rate(l, t), t, till) } else { till };
                    for value in [force(t), force(at), force(till)] {
                        *extreme = [extreme[0].min(value), extreme[1].max(value)];
                    }
                }
                t = next;
            }
            q = modes.after(length);
            time += length;
            if let Some((l, side)) = changed {
                sides[l] = side;
                contacts += usize::from(side != 0);
            }
        }
    }
    (extremes, contacts)
}

const FREE: f64 = f64::NEG_INFINITY;

/// A file of the repository without damping.
fn simulated(name: &str, undamped: &[&str]) -> serde_json::Value {
    let path = format!("{}/trains/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut text = std::fs::read_to_string(path).unwrap();
    for line in undamped {
        assert!(text.contains(line), "{line}");
        text = text.replace(line, "damping = 0.0");
    }
    // without damping a gap's bounces multiply roundings: until the first impacts behind the reversal
    text = text.replace("time = 6.0", "time = 4.2");
    answered("simulate", &text)
}

/// Roundings of the run, which the bounces of the travelling drive multiply.
const ROUNDINGS: f64 = 1e-8;

fn close(found: &serde_json::Value, expected: f64) {
    let found = found.as_f64().unwrap();
    assert!((found / expected - 1.0).abs() < ROUNDINGS, "{found} {expected}");
}

#[test]
fn rope_and_girder_of_a_hoist_that_lifts_from_the_ground() {
    let weight = 117_679.8;
    let (girder, ground) = (5.9e6, 2.0e8);
    let links = [
        Link { terms: [0.2, -1.0, -1.0], stiffness: 2.9e6, low: FREE, high: 0.0, elongation: -0.005 },
        Link { terms: [0.0, 1.0, 0.0], stiffness: girder, low: 0.0, high: 0.0, elongation: 1e-300 },
        Link { terms: [0.0, 0.0, -1.0], stiffness: ground, low: FREE, high: 0.0, elongation: 5.88399e-4 },
    ];
    let torque = [30_000.0, 0.0, -weight];
    let (expected, contacts) = peaks([694.6, 8000.0, 12_000.0], &links, &[(0.0, torque)], 1.0);
    let found = simulated("girder", &["damping = 3.6e3", "damping = 1.0e4", "damping = 1.0e5"]);
    // the rope is drawn tight and stays so; the load stands, and leaves the ground
    assert_eq!((contacts, found["links"][0]["contacts"].as_u64()), (1, Some(1)));
    for (l, [_, greatest]) in expected.iter().enumerate().take(2) {
        close(&found["links"][l]["greatest"], *greatest);
        close(&found["links"][l]["dynamic_factor"], greatest / weight);
    }
    close(&found["links"][1]["greatest_elongation"], expected[1][1] / girder);
}

#[test]
fn a_travelling_drive_that_reverses_through_its_gap() {
    let (ratio, gap) = (120.0, 0.05);
    let links = [
        Link { terms: [1.0, -ratio, 0.0], stiffness: 2.0e4, low: -0.5 * gap, high: 0.5 * gap, elongation: -0.5 * gap },
        Link { terms: [0.0, 1.0, -1.0], stiffness: 14_710.0, low: 0.0, high: 0.0, elongation: 1e-300 },
    ];
    let torques = [(0.0, [100.0, 0.0, 0.0]), (4.0, [-100.0, 0.0, 0.0])];
    let (expected, _) = peaks([0.2, 25_000.0, 15_000.0], &links, &torques, 4.2);
    let found = simulated("travel", &["damping = 2.0"]);
    close(&found["links"][0]["greatest"], expected[0][1]);
    close(&found["links"][0]["least"], expected[0][0]);
}
