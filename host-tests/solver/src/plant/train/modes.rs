//! Natural frequencies and shapes of a train with every link in contact at its mean stiffness.

use super::rank::Elimination;
use super::{Source, Train};
use crate::plant::error::PlantError;
use crate::plant::vibration::{Decay, Modes, Network, Spring};

/// Natural frequencies and shapes.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainModes {
    /// rad/s, rising; exactly zero for a rigid motion.
    pub omega: Vec<f64>,
    /// Of each mode, the amplitude of every coordinate, scaled to `sum J q^2 = 1`.
    pub shapes: Vec<Vec<f64>>,
}

impl TrainModes {
    /// Motions that strain no link.
    #[must_use]
    pub fn rigid_motions(&self) -> usize {
        self.omega.iter().take_while(|&&omega| omega == 0.0).count()
    }
}

impl Train {
    /// Undamped modes, without what unbalances couple: see [`Network::modes`]. How many motions are rigid is the rank
    /// of the links' terms alone, which have no stiffness in them.
    ///
    /// # Errors
    /// [`PlantError`] as [`build`](Self::build).
    pub fn modes(&self) -> Result<TrainModes, PlantError> {
        self.validate()?;
        let root: Vec<f64> = self.inertias().iter().map(|inertia| inertia.sqrt()).collect();
        let springs = self.links.iter().filter(|link| link.mean_stiffness() > 0.0);
        let rigid = Elimination::of(springs.map(|link| link.terms.as_slice()), root.len()).free_motions(&root);
        let mut modes = self.network().modes(usize::MAX);
        let mut omega = vec![0.0; rigid.len()];
        let unscaled = |shape: Vec<f64>| shape.iter().zip(&root).map(|(x, root)| x / root).collect();
        let mut shapes: Vec<Vec<f64>> = rigid.into_iter().map(unscaled).collect();
        omega.append(&mut modes.omega);
        shapes.append(&mut modes.shapes);
        Ok(TrainModes { omega, shapes })
    }

    /// Damped vibrations and decays about standstill, from the train's modes, the slowest first; one of each conjugate
    /// pair. None of what neither swings nor decays. Of the torques, lines alone count, with their slopes. See
    /// [`Network::decays`].
    ///
    /// # Errors
    /// [`PlantError::Count`] where the eigenvalues are not found.
    pub fn decays(&self, modes: &TrainModes) -> Result<Vec<Decay>, PlantError> {
        let rigid_motions = modes.rigid_motions();
        let (omega, shapes) = (modes.omega[rigid_motions..].to_vec(), modes.shapes[rigid_motions..].to_vec());
        let network = self.network();
        // no link of a train has an inertia of its own
        let dissipation = shapes.iter().map(|shape| network.dissipation(shape, 0.0)).collect();
        network.decays(&Modes { omega, shapes, dissipation, rigid_motions })
    }

    /// Inertias, dampings, and mean stiffnesses.
    fn network(&self) -> Network {
        let mut network = Network::default();
        for (coordinate, inertia) in self.coordinates.iter().zip(self.inertias()) {
            let slope = |source: &Source| if let Source::Line { slope, .. } = source { *slope } else { 0.0 };
            network.coordinate(inertia, coordinate.viscous + coordinate.sources.iter().map(slope).sum::<f64>());
        }
        for link in &self.links {
            network.link(Spring::new(&link.terms, link.mean_stiffness()).damping(link.damping));
        }
        network
    }

    /// Coordinates that each link joins.
    #[must_use]
    pub fn joined(&self) -> Vec<Vec<usize>> {
        self.links.iter().map(|link| link.terms.iter().map(|term| term.0).collect()).collect()
    }

    /// Inertia of every coordinate, kg m2 or kg, with what a crank or a law adds at its starting angle.
    #[must_use]
    pub fn inertias(&self) -> Vec<f64> {
        self.coordinates.iter().map(|c| c.inertia_at(c.angle)).collect()
    }
}
