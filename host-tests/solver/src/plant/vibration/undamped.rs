//! Natural frequencies by the number of them below a frequency, and their shapes by inverse iteration.

use super::elimination::Elimination;
use super::number::{Number, Reals};
use super::{Coordinate, Network, Spring};
use crate::noise::Noise;

/// Frequencies that are found side by side.
const SIDE_BY_SIDE: usize = 8;

/// Relative distance of two frequencies below which their shapes are made orthogonal.
const NEAR: f64 = 1e-6;

/// Share of the distance of two frequencies by which an inverse iteration stands beside its own.
const ASIDE: f64 = 1e-2;

/// Steps of the inverse iteration: each takes [`ASIDE`] of the other shapes.
const STEPS: usize = 8;

/// Halvings of a frequency's logarithm, then of itself: 2^1000 to 2, then to the last digit.
const HALVINGS: usize = 80;

/// Natural vibrations with strain.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// rad/s, rising.
    pub omega: Vec<f64>,
    /// Of each mode the amplitude of every coordinate, scaled to a kinetic energy `sum J q^2` of 1.
    pub shapes: Vec<Vec<f64>>,
    /// Of each mode the modal damping, 1/s: its dissipation at unit speed. Zero of one that no damper touches.
    pub dissipation: Vec<f64>,
    /// Motions without strain, which are not among these.
    pub rigid_motions: usize,
}

impl Network {
    /// The lowest natural vibrations without damping, at most so many.
    #[must_use]
    pub fn modes(&self, most: usize) -> Modes {
        let rigid_motions = self.free(|link| link.stiffness > 0.0, |_| false);
        let Some((cut, top, count)) = self.reach(most, rigid_motions) else {
            return Modes { omega: Vec::new(), shapes: Vec::new(), dissipation: Vec::new(), rigid_motions };
        };
        let below = Below::of(&cut);
        let omega = below.frequencies(rigid_motions, count, top);
        let mut shapes = cut.shapes(&below.elimination, &omega);
        let damped = self.cut(top);
        let dissipation = shapes.iter().zip(&omega).map(|(shape, &omega)| damped.dissipation(shape, omega)).collect();
        shapes.iter_mut().for_each(|shape| shape.truncate(self.size()));
        Modes { omega, shapes, dissipation, rigid_motions }
    }

    /// The highest natural frequency (rad/s) of a network without shafts of their own inertia; zero of one without
    /// springs.
    #[must_use]
    pub(in crate::plant) fn highest(&self) -> f64 {
        let Some((springs, top, _)) = self.reach(1, 0) else { return 0.0 };
        Below::of(&springs).frequencies(springs.size() - 1, 1, top)[0]
    }

    /// Springs alone, cut so finely that `most` frequencies are found; a frequency (rad/s) above these, and their
    /// number. None where nothing is elastic.
    fn reach(&self, most: usize, rigid: usize) -> Option<(Self, f64, usize)> {
        let is_spring = |link: &&Spring| link.stiffness > 0.0;
        let undamped = |link: &Spring| Spring { damping: 0.0, ..link.clone() };
        let springs = Self {
            coordinates: self.coordinates.iter().map(|at| Coordinate { viscous: 0.0, ..*at }).collect(),
            links: self.links.iter().filter(is_spring).map(undamped).collect(),
        };
        // half of a shaft's inertia at either end
        let mut ends: Vec<f64> = springs.coordinates.iter().map(|at| at.inertia).collect();
        for link in &springs.links {
            link.terms.iter().for_each(|&(at, _)| ends[at] += 0.5 * link.inertia);
        }
        // their trace bounds all frequencies, without the shafts' own
        let square = |link: &Spring| link.terms.iter().map(|&(at, c)| link.stiffness * c * c / ends[at]).sum::<f64>();
        let bound = springs.links.iter().map(square).sum::<f64>().sqrt() * (1.0 + 1e-9);
        if springs.links.is_empty() || most == 0 {
            return None;
        }
        if !springs.is_distributed() {
            let count = (springs.size() - rigid).min(most);
            return (count > 0).then_some((springs, bound, count));
        }
        let mut top = bound * 1e-12;
        loop {
            let cut = springs.cut(top);
            if Below::of(&cut).count([top])[0] >= rigid + most {
                return Some((cut, top, most));
            }
            top *= 2.0;
        }
    }

    /// Shapes of these frequencies.
    fn shapes(&self, elimination: &Elimination, omega: &[f64]) -> Vec<Vec<f64>> {
        let mut noise = Noise::new(1);
        let mut shapes: Vec<Vec<f64>> = Vec::with_capacity(omega.len());
        let mut factors = Vec::new();
        // the weight of a shaft by halves is good enough to begin with
        let mut weight: Vec<f64> = self.coordinates.iter().map(|at| at.inertia).collect();
        for link in &self.links {
            link.terms.iter().for_each(|&(at, _)| weight[at] += 0.5 * link.inertia);
        }
        for batch in omega.chunks(SIDE_BY_SIDE) {
            let mut at = [batch[0]; SIDE_BY_SIDE];
            for (at, &frequency) in at.iter_mut().zip(batch) {
                // beside the frequency, where an inner pivot may be zero, but much nearer to it than any other
                let apart = omega.iter().map(|other| (other / frequency - 1.0).abs()).filter(|apart| *apart > NEAR);
                *at = frequency * (1.0 + ASIDE * apart.fold(0.1, f64::min));
            }
            self.diagonal(Reals::ZERO, Reals(at.map(|omega| -omega * omega)), &mut factors);
            elimination.run(&mut factors, |_, _| {});
            let mut found: Vec<Vec<f64>> =
                at.map(|_| weight.iter().map(|w| noise.uniform() / w.max(f64::MIN_POSITIVE).sqrt()).collect()).to_vec();
            for _ in 0..STEPS {
                let mut side = vec![Reals([0.0; SIDE_BY_SIDE]); elimination.nodes()];
                for (j, side) in side.iter_mut().enumerate().take(weight.len()) {
                    *side = Reals(std::array::from_fn(|l| weight[j] * found[l][j]));
                }
                elimination.solve(&factors, &mut side);
                for l in 0..batch.len() {
                    let mut shape: Vec<f64> = side.iter().take(weight.len()).map(|angle| angle.0[l]).collect();
                    let largest = shape.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                    shape.iter_mut().for_each(|x| *x /= largest);
                    let known = shapes.len();
                    let near = |k: &usize| batch[l] - omega[*k] < NEAR * batch[l];
                    for k in (0..known + l).rev().take_while(near) {
                        let other = if k < known { &shapes[k] } else { &found[k - known] };
                        let product = |a: &[f64], b: &[f64]| -> f64 {
                            a.iter().zip(b).zip(&weight).map(|((a, b), w)| a * b * w).sum()
                        };
                        let along = product(&shape, other) / product(other, other);
                        shape.iter_mut().zip(other).for_each(|(x, y)| *x -= along * y);
                    }
                    found[l] = shape;
                }
            }
            for (shape, &omega) in found.iter_mut().zip(batch) {
                let size = self.kinetic(shape, omega).sqrt();
                shape.iter_mut().for_each(|x| *x /= size);
            }
            shapes.extend(found.into_iter().take(batch.len()));
        }
        shapes
    }

    /// Twice the kinetic energy of a shape at unit speed, `sum J q^2`, that in the shafts exactly.
    fn kinetic(&self, shape: &[f64], omega: f64) -> f64 {
        let lumped: f64 = self.coordinates.iter().zip(shape).map(|(at, q)| at.inertia * q * q).sum();
        let spread = |link: &Spring| {
            let ([near, far], angle) = (link.ends(shape), link.angle(omega));
            let along = |x: f64| ((angle * (1.0 - x)).sin() * near + (angle * x).sin() * far) / angle.sin();
            link.inertia * mean_square(along)
        };
        lumped + self.links.iter().filter(|link| link.inertia > 0.0).map(spread).sum::<f64>()
    }

    /// Dissipation of a shape at unit speed, that in short shafts with an inertia along their twist.
    pub(in crate::plant) fn dissipation(&self, shape: &[f64], omega: f64) -> f64 {
        let ground = |(at, q): (&Coordinate, &f64)| at.viscous * q * q;
        let twist = |link: &Spring| {
            if link.inertia == 0.0 {
                return link.damping * link.terms.iter().map(|&(at, c)| c * shape[at]).sum::<f64>().powi(2);
            }
            let ([near, far], angle) = (link.ends(shape), link.angle(omega));
            let slope = |x: f64| angle / angle.sin() * ((angle * x).cos() * far - (angle * (1.0 - x)).cos() * near);
            link.damping * mean_square(slope)
        };
        self.coordinates.iter().zip(shape).map(ground).sum::<f64>() + self.links.iter().map(twist).sum::<f64>()
    }
}

impl Spring {
    /// Amplitudes at the ends of a shaft, zero at the ground.
    fn ends(&self, shape: &[f64]) -> [f64; 2] {
        [0, 1].map(|k| self.terms.get(k).map_or(0.0, |&(at, _)| shape[at]))
    }
}

/// Mean of the square from 0 to 1.
fn mean_square(of: impl Fn(f64) -> f64) -> f64 {
    let both = |&(x, w): &(f64, f64)| w * [0.5 - 0.5 * x, 0.5 + 0.5 * x].map(|x| of(x).powi(2)).iter().sum::<f64>();
    0.5 * GAUSS.iter().map(both).sum::<f64>()
}

/// Points and weights of Gauss and Legendre's rule of eight points, one side of it
/// [Abramowitz and Stegun 1964, table 25.4].
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// How many frequencies lie below one.
struct Below<'n> {
    network: &'n Network,
    elimination: Elimination,
}

impl<'n> Below<'n> {
    fn of(network: &'n Network) -> Self {
        Self { network, elimination: Elimination::of(network) }
    }

    /// The negative pivots, less one for each link, whose compliance is one itself (Sylvester).
    fn count<const L: usize>(&self, omega: [f64; L]) -> [usize; L] {
        self.count_with(omega, &mut Vec::new())
    }

    fn count_with<const L: usize>(&self, omega: [f64; L], factors: &mut Vec<Reals<L>>) -> [usize; L] {
        self.network.diagonal(Reals([0.0; L]), Reals(omega.map(|omega| -omega * omega)), factors);
        let mut negative = [0.0; L];
        self.elimination.run(factors, |pivot, _| {
            for (count, value) in negative.iter_mut().zip(pivot.0) {
                *count += if value < 0.0 { 1.0 } else { 0.0 };
            }
        });
        negative.map(|count| (count as usize).saturating_sub(self.network.links.len()))
    }

    /// So many frequencies behind the rigid motions, all of them below `top`.
    fn frequencies(&self, rigid: usize, count: usize, top: f64) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::with_capacity(count);
        let mut factors = Vec::new();
        while all.len() < count {
            let first = rigid + all.len();
            let least = all.last().copied().unwrap_or(top * 1e-150);
            let mut low = [least; SIDE_BY_SIDE];
            let mut high = [top; SIDE_BY_SIDE];
            for _ in 0..HALVINGS {
                let middle: [f64; SIDE_BY_SIDE] = std::array::from_fn(|l| {
                    let [a, b] = [low[l], high[l]];
                    if b > 4.0 * a { a.sqrt() * b.sqrt() } else { a + 0.5 * (b - a) }
                });
                if (0..SIDE_BY_SIDE).all(|l| middle[l] <= low[l] || middle[l] >= high[l]) {
                    break;
                }
                let counts = self.count_with(middle, &mut factors);
                for l in 0..SIDE_BY_SIDE {
                    for (middle, below) in middle.into_iter().zip(counts) {
                        if below > first + l { high[l] = high[l].min(middle) } else { low[l] = low[l].max(middle) }
                    }
                }
            }
            all.extend((0..SIDE_BY_SIDE.min(count - all.len())).map(|l| low[l] + 0.5 * (high[l] - low[l])));
        }
        all
    }
}
