//! Natural and damped vibrations of a network of inertias, springs and dampers of any shape and any size.
//!
//! Coordinates have an inertia (kg m2, or kg) and viscous damping to the ground; links stretch between any of them,
//! with a stiffness and a damping, and where they are shafts with an inertia of their own, spread evenly. Nothing is
//! lumped: a uniform shaft is its exact dynamic stiffness, a spring `k theta/sin(theta)` between two inertial ends
//! `k theta tan(theta/2)`, with `theta = omega sqrt(I/k)` [Wittrick and Williams 1971, Q. J. Mech. Appl. Math. 24].
//!
//! - [`Network::modes`]: natural frequencies by bisection of the number of them below a frequency, which takes a time
//!   in proportion to the links, and keeps every digit at any ratio of inertias and stiffnesses of a network without
//!   loops; shapes by inverse iteration
//! - [`Network::decays`]: damped eigenvalues by the iteration of Ehrlich and Aberth on the same elimination
//!   [Bini, Gemignani and Tisseur 2005, SIAM J. Matrix Anal. Appl. 27(1)]
//! - [`Network::responses`]: angles under torques of a frequency
//!
//! ```
//! use driveline_solver::plant::vibration::{Network, Spring};
//! // a drill string with its bit, held at the table: theta tan(theta) = I/J
//! let mut string = Network::default();
//! let bit = string.coordinate(100.0, 0.0);
//! string.link(Spring::ground(bit, 500.0).inertia(200.0));
//! let theta = string.modes(5).omega[0] * (200.0_f64 / 500.0).sqrt();
//! assert!((theta * theta.tan() - 2.0).abs() < 1e-12);
//! ```

mod damped;
mod elimination;
mod number;
mod undamped;

use std::collections::BTreeMap;

use nalgebra::Complex;

use super::train::Elimination as Rank;
use elimination::Elimination;
use number::{Complexes, Number};

pub use damped::Decay;
pub use undamped::Modes;

/// Largest angle `theta` of a piece of a shaft: at pi its stiffness would be infinite.
const PIECE: f64 = 1.0;

/// An inertia and its damping to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Coordinate {
    inertia: f64,
    viscous: f64,
}

/// A link, which stretches by the sum of its terms: coordinate and elongation per coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    terms: Vec<(usize, f64)>,
    stiffness: f64,
    damping: f64,
    inertia: f64,
}

impl Spring {
    /// Any terms, and a stiffness (N m/rad or N/m); zero leaves a damper.
    #[must_use]
    pub fn new(terms: &[(usize, f64)], stiffness: f64) -> Self {
        Self { terms: terms.to_vec(), stiffness, damping: 0.0, inertia: 0.0 }
    }

    /// A shaft between two coordinates.
    #[must_use]
    pub fn shaft(from: usize, to: usize, stiffness: f64) -> Self {
        Self::new(&[(from, 1.0), (to, -1.0)], stiffness)
    }

    /// A shaft from a coordinate to the ground.
    #[must_use]
    pub fn ground(at: usize, stiffness: f64) -> Self {
        Self::new(&[(at, 1.0)], stiffness)
    }

    /// The same with damping (N m s/rad or N s/m).
    #[must_use]
    pub const fn damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// The same with an inertia of its own, of a shaft with terms of 1 and -1; damping and stiffness are spread as
    /// evenly.
    #[must_use]
    pub const fn inertia(mut self, inertia: f64) -> Self {
        self.inertia = inertia;
        self
    }

    /// `theta` at a frequency (rad/s).
    fn angle(&self, omega: f64) -> f64 {
        omega * (self.inertia / self.stiffness).sqrt()
    }
}

/// Inertias and the links between them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Network {
    coordinates: Vec<Coordinate>,
    links: Vec<Spring>,
}

impl Network {
    /// Adds a coordinate of an inertia and a viscous damping to the ground, and returns its index. One without an
    /// inertia is the joint of two shafts that have their own.
    pub fn coordinate(&mut self, inertia: f64, viscous: f64) -> usize {
        self.coordinates.push(Coordinate { inertia, viscous });
        self.coordinates.len() - 1
    }

    /// Adds a link.
    pub fn link(&mut self, link: Spring) {
        self.links.push(link);
    }

    /// The same with a coordinate held at rest; it stays in its place, without links.
    #[must_use]
    pub fn held(&self, at: usize) -> Self {
        let mut held = self.clone();
        held.coordinates[at].viscous = 0.0;
        for link in &mut held.links {
            link.terms.retain(|term| term.0 != at);
        }
        held.links.retain(|link| !link.terms.is_empty());
        held
    }

    /// Whether a shaft has an inertia of its own, and so any number of modes.
    #[must_use]
    pub fn is_distributed(&self) -> bool {
        self.links.iter().any(|link| link.inertia > 0.0)
    }

    /// Coordinates.
    #[must_use]
    pub const fn size(&self) -> usize {
        self.coordinates.len()
    }

    /// Independent motions that leave all links at their length which `strains`, and all coordinates at rest which
    /// `holds`.
    fn free(&self, strains: impl Fn(&Spring) -> bool, holds: impl Fn(&Coordinate) -> bool) -> usize {
        let held: Vec<[(usize, f64); 1]> =
            (0..self.size()).filter(|&at| holds(&self.coordinates[at])).map(|at| [(at, 1.0)]).collect();
        let links = self.links.iter().filter(|link| strains(link)).map(|link| link.terms.as_slice());
        let rows = links.chain(held.iter().map(<[_; 1]>::as_slice));
        self.size() - Rank::of(rows, self.size()).rank()
    }

    /// Adds a link, to the stiffness and damping of one that strains with it if there is one: a loop of two would leave
    /// the roundings of their stiffness in the equations of a slow decay. Places of links by their coordinates.
    fn beside(&mut self, link: &Spring, places: &mut BTreeMap<Vec<usize>, usize>) {
        let mut terms = link.terms.clone();
        terms.sort_by_key(|term| term.0);
        let place = *places.entry(terms.iter().map(|term| term.0).collect()).or_insert(self.links.len());
        if let Some(other) = self.links.get_mut(place).filter(|other| other.inertia + link.inertia == 0.0)
            && let (Some(&(_, ours)), Some(&(_, theirs))) = (terms.first(), other.terms.first())
            && terms.iter().zip(&other.terms).all(|(one, two)| one.1 * theirs == two.1 * ours)
        {
            let share = (ours / theirs).powi(2);
            other.stiffness += share * link.stiffness;
            other.damping += share * link.damping;
            return;
        }
        self.links.push(Spring { terms, ..link.clone() });
    }

    /// The same with the shafts that have an inertia cut into pieces that are short at a frequency (rad/s), and links
    /// side by side as one.
    fn cut(&self, omega: f64) -> Self {
        let mut cut = Self { coordinates: self.coordinates.clone(), links: Vec::new() };
        let mut places = BTreeMap::new();
        for link in &self.links {
            let pieces = (link.angle(omega) / PIECE).ceil().max(1.0);
            let piece = Spring {
                stiffness: link.stiffness * pieces,
                damping: link.damping * pieces,
                inertia: link.inertia / pieces,
                terms: Vec::new(),
            };
            let [first, last] = [link.terms.first(), link.terms.get(1)];
            if pieces == 1.0 {
                cut.beside(link, &mut places);
                continue;
            }
            let mut near: Vec<(usize, f64)> = first.into_iter().copied().collect();
            for _ in 1..pieces as usize {
                let joint = cut.coordinate(0.0, 0.0);
                near.push((joint, -1.0));
                cut.links.push(Spring { terms: near, ..piece.clone() });
                near = vec![(joint, 1.0)];
            }
            near.extend(last);
            cut.links.push(Spring { terms: near, ..piece });
        }
        cut
    }

    /// The diagonal of the equations at a shift and its square: dynamic stiffnesses of the coordinates, compliances of
    /// the links with the sign turned.
    fn diagonal<T: Number>(&self, shift: T, square: T, diagonal: &mut Vec<T>) {
        diagonal.clear();
        let inertial = |at: &Coordinate| square.times(T::real(at.inertia)).plus(shift.times(T::real(at.viscous)));
        diagonal.extend(self.coordinates.iter().map(inertial));
        for link in &self.links {
            if link.damping == 0.0 && link.inertia == 0.0 {
                diagonal.push(T::real(-1.0 / link.stiffness));
                continue;
            }
            let stiffness = T::real(link.stiffness).plus(shift.scaled(link.damping));
            let mut compliance = stiffness.inverse();
            if link.inertia > 0.0 {
                let own = square.scaled(link.inertia);
                let angle = own.times(compliance);
                compliance = compliance.times(series(angle, 1.0));
                let quarter = angle.scaled(0.25);
                let end = own.scaled(0.5).times(series(quarter, 1.0)).times(series(quarter, 0.0).inverse());
                for &(at, _) in &link.terms {
                    diagonal[at] = diagonal[at].plus(end);
                }
            }
            diagonal.push(T::ZERO.minus(compliance));
        }
    }

    /// Whether anything damps.
    #[must_use]
    pub fn is_damped(&self) -> bool {
        self.coordinates.iter().any(|at| at.viscous != 0.0) || self.links.iter().any(|link| link.damping > 0.0)
    }

    /// Motions of the coordinates (rad) under the same torques (N m) at several shifts `s` (1/s), which are `i omega`
    /// of steady vibrations; beyond any size at an undamped resonance.
    #[must_use]
    pub fn responses(&self, shifts: &[Complex<f64>], torques: &[Complex<f64>]) -> Vec<Vec<Complex<f64>>> {
        if shifts.len() < 4 { self.side_by_side::<1>(shifts, torques) } else { self.side_by_side::<4>(shifts, torques) }
    }

    /// The responses, so many shifts at a time.
    fn side_by_side<const L: usize>(
        &self,
        shifts: &[Complex<f64>],
        torques: &[Complex<f64>],
    ) -> Vec<Vec<Complex<f64>>> {
        let cut = self.cut(shifts.iter().map(|shift| shift.norm()).fold(0.0, f64::max));
        let elimination = Elimination::of(&cut);
        let lanes = |of: [Complex<f64>; L]| Complexes { re: of.map(|one| one.re), im: of.map(|one| one.im) };
        let mut factors = Vec::new();
        let respond = |some: &[Complex<f64>]| {
            let shift = lanes(std::array::from_fn(|l| some[l.min(some.len() - 1)]));
            cut.diagonal(shift, shift.times(shift), &mut factors);
            elimination.run(&mut factors, |_, _| {});
            let mut side = vec![Complexes::ZERO; elimination.nodes()];
            for (side, torque) in side.iter_mut().zip(torques) {
                *side = lanes([*torque; L]);
            }
            elimination.solve(&factors, &mut side);
            side.truncate(self.size());
            let one = |l: usize| side.iter().map(|angle| Complex::new(angle.re[l], angle.im[l])).collect();
            (0..some.len()).map(one).collect::<Vec<Vec<_>>>()
        };
        shifts.chunks(L).flat_map(respond).collect()
    }
}

/// `sinh(x)/x` (`odd` 1) or `cosh(x)` (`odd` 0) by the square of x, of a size below some ten.
fn series<T: Number>(square: T, odd: f64) -> T {
    (1..=12).rev().map(f64::from).fold(T::real(1.0), |rest, k| {
        let next = (2.0 * k) * (2.0 * k + if odd > 0.0 { 1.0 } else { -1.0 });
        T::real(1.0).plus(rest.times(square).scaled(1.0 / next))
    })
}
