//! The description of a torsional system, and its reduction to the angles that gears leave free.

use super::super::error::{PlantError, in_range, not_negative, positive};
use super::super::event::Place;

/// Why a system was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SystemError {
    /// A number out of its range.
    #[error(transparent)]
    Parameter(#[from] PlantError),
    /// An element on a node that is not there.
    #[error("{element} stands on node {node}: expected a node below {nodes}")]
    NoSuchNode {
        element: &'static str,
        /// The requested node.
        node: usize,
        /// How many there are.
        nodes: usize,
    },
    /// A node that two gears drive, or gears in a ring.
    #[error("the gears tie node {node} more than once: expected gears to form trees")]
    GearLoop { node: usize },
}

/// An elastic link: between two nodes, or from one to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spring {
    from: usize,
    to: Option<usize>,
    stiffness: f64,
    damping: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Gear {
    parent: usize,
    node: usize,
    /// Angle of the node per angle of the parent.
    ratio: f64,
    radii: (f64, f64),
}

/// Discs, shafts, gears and springs to the ground, each on its own shaft.
///
/// ```
/// use driveline_solver::plant::modes::System;
/// // a motor that drives a fan through a reduction of 2
/// let system = System::new(&[0.5, 0.1, 2.0]).gear(0, 1, 1.0, 2.0).shaft(1, 2, 800.0, 0.0);
/// let modes = system.modes()?;
/// // two masses, referred to the slow shaft: 0.5 x 4 + 0.1 and 2.0
/// let expected = (800.0_f64 * (2.1 + 2.0) / (2.1 * 2.0)).sqrt();
/// assert!((modes.omega[1] - expected).abs() < 1e-12 * expected);
/// # Ok::<(), driveline_solver::plant::modes::SystemError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    inertia: Vec<f64>,
    disc_damping: Vec<f64>,
    springs: Vec<Spring>,
    gears: Vec<Gear>,
}

impl System {
    /// Discs of these inertias, kg m2, zero or above.
    #[must_use]
    pub fn new(inertia: &[f64]) -> Self {
        Self { inertia: inertia.to_vec(), disc_damping: Vec::new(), springs: Vec::new(), gears: Vec::new() }
    }

    /// Damping of every disc to the ground, N m s/rad, zero or above; one number per disc.
    #[must_use]
    pub fn disc_damping(mut self, damping: &[f64]) -> Self {
        self.disc_damping = damping.to_vec();
        self
    }

    /// A shaft of this stiffness (N m/rad, above zero) and damping (N m s/rad, zero or above) between two nodes.
    #[must_use]
    pub fn shaft(mut self, from: usize, to: usize, stiffness: f64, damping: f64) -> Self {
        self.springs.push(Spring { from, to: Some(to), stiffness, damping });
        self
    }

    /// A spring and damper from a node to the ground.
    #[must_use]
    pub fn ground(mut self, node: usize, stiffness: f64, damping: f64) -> Self {
        self.springs.push(Spring { from: node, to: None, stiffness, damping });
        self
    }

    /// A pair of gears in external mesh: `r_parent theta_parent + r theta_node = 0`, radii above zero.
    #[must_use]
    pub fn gear(mut self, parent: usize, node: usize, r_parent: f64, r: f64) -> Self {
        self.gears.push(Gear { parent, node, ratio: -r_parent / r, radii: (r_parent, r) });
        self
    }

    /// Checks every number and ties the geared nodes together.
    pub(super) fn reduce(&self) -> Result<Reduced, SystemError> {
        self.validate()?;
        let nodes = self.inertia.len();
        let ties = (0..nodes).map(|node| self.tie(node)).collect::<Result<Vec<_>, _>>()?;
        let mut free: Vec<usize> = ties.iter().map(|tie| tie.0).collect();
        free.sort_unstable();
        free.dedup();
        let place = |node: usize| free.partition_point(|&f| f < node);
        let ties: Vec<(usize, f64)> = ties.iter().map(|&(root, ratio)| (place(root), ratio)).collect();
        let (mut inertia, mut disc_damping) = (vec![0.0; free.len()], vec![0.0; free.len()]);
        for (node, &(coordinate, ratio)) in ties.iter().enumerate() {
            inertia[coordinate] += ratio * ratio * self.inertia[node];
            let damping = self.disc_damping.get(node).copied().unwrap_or(0.0);
            disc_damping[coordinate] += ratio * ratio * damping;
        }
        for (&node, &inertia) in free.iter().zip(&inertia) {
            positive("inertia with that of its gears", Place::Node(node), inertia)?;
        }
        let links = self.springs.iter().map(|spring| Link {
            from: ties[spring.from],
            to: spring.to.map(|to| ties[to]),
            stiffness: spring.stiffness,
            damping: spring.damping,
        });
        Ok(Reduced { free, links: links.collect(), ties, inertia, disc_damping })
    }

    /// The node that this one follows through gears, and its angle per angle of that node.
    fn tie(&self, node: usize) -> Result<(usize, f64), SystemError> {
        let (mut at, mut ratio) = (node, 1.0);
        for _ in 0..=self.gears.len() {
            let mut driving = self.gears.iter().filter(|gear| gear.node == at);
            match (driving.next(), driving.next()) {
                (None, _) => return Ok((at, ratio)),
                (Some(gear), None) => {
                    ratio *= gear.ratio;
                    at = gear.parent;
                }
                (Some(_), Some(_)) => break,
            }
        }
        Err(SystemError::GearLoop { node })
    }

    fn validate(&self) -> Result<(), SystemError> {
        let nodes = self.inertia.len();
        let there = |element, node| {
            if node < nodes { Ok(()) } else { Err(SystemError::NoSuchNode { element, node, nodes }) }
        };
        for (j, &inertia) in self.inertia.iter().enumerate() {
            not_negative("inertia", Place::Node(j), inertia)?;
        }
        let damped = self.disc_damping.len();
        if damped != 0 && damped != nodes {
            return Err(PlantError::Count { name: "disc damping", found: damped, expected: nodes }.into());
        }
        for (j, &damping) in self.disc_damping.iter().enumerate() {
            not_negative("disc damping", Place::Node(j), damping)?;
        }
        for (s, spring) in self.springs.iter().enumerate() {
            there("a shaft", spring.from)?;
            spring.to.map_or(Ok(()), |to| there("a shaft", to))?;
            positive("stiffness", Place::Shaft(s), spring.stiffness)?;
            not_negative("damping", Place::Shaft(s), spring.damping)?;
        }
        for gear in &self.gears {
            there("a gear", gear.parent)?;
            there("a gear", gear.node)?;
            for radius in [gear.radii.0, gear.radii.1] {
                let place = Place::Node(gear.node);
                in_range("gear radius", place, radius, radius > 0.0, "a finite number above zero")?;
            }
        }
        Ok(())
    }
}

/// A link in the free coordinates: each end as coordinate and angle per coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    pub from: (usize, f64),
    pub to: Option<(usize, f64)>,
    pub stiffness: f64,
    pub damping: f64,
}

impl Link {
    /// Twist per coordinate, as a row.
    pub fn row(&self, coordinates: usize) -> Vec<f64> {
        let mut row = vec![0.0; coordinates];
        row[self.from.0] += self.from.1;
        if let Some((to, ratio)) = self.to {
            row[to] -= ratio;
        }
        row
    }
}

/// The system in the coordinates that gears leave free.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reduced {
    /// The nodes whose angles are the coordinates.
    pub free: Vec<usize>,
    /// Of every node: its coordinate, and its angle per coordinate.
    pub ties: Vec<(usize, f64)>,
    pub inertia: Vec<f64>,
    pub disc_damping: Vec<f64>,
    pub links: Vec<Link>,
}

impl Reduced {
    /// Motions that strain no link: groups of coordinates whose links agree on one ratio and lead to no ground.
    pub fn rigid_motions(&self) -> usize {
        let n = self.inertia.len();
        let mut angle: Vec<Option<f64>> = vec![None; n];
        let mut motions = 0;
        for first in 0..n {
            if angle[first].is_some() {
                continue;
            }
            angle[first] = Some(1.0);
            let mut group = vec![first];
            let mut locked = false;
            while let Some(at) = group.pop() {
                let here = angle[at].unwrap_or(0.0);
                for link in &self.links {
                    let Some(to) = link.to else {
                        locked |= link.from.0 == at;
                        continue;
                    };
                    for (near, far) in [(link.from, to), (to, link.from)] {
                        if near.0 != at {
                            continue;
                        }
                        let there = here * near.1 / far.1;
                        match angle[far.0] {
                            // ratios are products of a few radii: alike to rounding or not at all
                            Some(known) => locked |= (known - there).abs() > 1e-9 * known.abs(),
                            None => {
                                angle[far.0] = Some(there);
                                group.push(far.0);
                            }
                        }
                    }
                }
            }
            motions += usize::from(!locked);
        }
        motions
    }

    /// `sqrt(k) B / sqrt(J)`, one row per link: the singular values are the natural frequencies.
    pub fn scaled_incidence(&self) -> Vec<Vec<f64>> {
        let n = self.inertia.len();
        let scale = |link: &Link| {
            let row = link.row(n).into_iter().zip(&self.inertia);
            row.map(|(twist, inertia)| twist * (link.stiffness / inertia).sqrt()).collect()
        };
        self.links.iter().map(scale).collect()
    }
}
