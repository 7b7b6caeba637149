//! Links: whatever stretches between coordinates and pulls them together.

use super::super::error::{PlantError, in_range, not_negative};
use super::super::event::Place;
use super::mesh::Variation;

/// An elastic link. Its elongation is `sum c_j q_j` over its terms: a shaft has the terms 1 and -1, a mesh the base
/// radii, a bearing a single 1. Its force `k x + d dx/dt` acts on coordinate `j` as `-c_j` times itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    pub(super) terms: Vec<(usize, f64)>,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    pub(super) gap: f64,
    pub(super) rope: bool,
    pub(super) variation: Option<Variation>,
    pub(super) efficiency: f64,
    pub(super) back_efficiency: f64,
    pub(super) elongation: f64,
}

impl Link {
    /// Any terms: coordinate and elongation per coordinate, m/rad, rad/rad or 1. A stiffness of zero leaves a damper.
    #[must_use]
    pub fn new(terms: &[(usize, f64)], stiffness: f64) -> Self {
        Self {
            terms: terms.to_vec(),
            stiffness,
            damping: 0.0,
            gap: 0.0,
            rope: false,
            variation: None,
            efficiency: 1.0,
            back_efficiency: 1.0,
            elongation: 0.0,
        }
    }

    /// A shaft between two coordinates, N m/rad.
    #[must_use]
    pub fn shaft(from: usize, to: usize, stiffness: f64) -> Self {
        Self::new(&[(from, 1.0), (to, -1.0)], stiffness)
    }

    /// A shaft behind whose far end a gear turns `ratio` times slower; stiffness, gap and torque are of the near end.
    #[must_use]
    pub fn geared(from: usize, to: usize, ratio: f64, stiffness: f64) -> Self {
        Self::new(&[(from, 1.0), (to, -ratio)], stiffness)
    }

    /// A spring to the ground.
    #[must_use]
    pub fn ground(at: usize, stiffness: f64) -> Self {
        Self::new(&[(at, 1.0)], stiffness)
    }

    /// A gear mesh along the line of action, N/m, with the base radii of pinion and wheel, m.
    #[must_use]
    pub fn mesh(pinion: (usize, f64), wheel: (usize, f64), stiffness: f64) -> Self {
        Self::new(&[pinion, (wheel.0, -wheel.1)], stiffness)
    }

    /// The same with damping, zero or above. It acts only while the link carries force; a flank never pulls, a rope
    /// never pushes.
    #[must_use]
    pub fn damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// The same with backlash: the whole free elongation, half of it on either side of zero. Of a rope: the slack.
    #[must_use]
    pub fn gap(mut self, gap: f64) -> Self {
        self.gap = gap;
        self
    }

    /// The same as a rope, which only pulls.
    #[must_use]
    pub fn rope(mut self) -> Self {
        self.rope = true;
        self
    }

    /// The same with a stiffness that changes with time.
    #[must_use]
    pub fn varying(mut self, variation: Variation) -> Self {
        self.variation = Some(variation);
        self
    }

    /// The same with a gear's efficiency between its first coordinate and itself, above 0 and up to 1: the coordinate
    /// carries `F/eta` when motoring and `eta F` when overhauling `[Huang 1987 tables 1-2 to 1-4]`.
    #[must_use]
    pub fn efficiency(mut self, efficiency: f64) -> Self {
        (self.efficiency, self.back_efficiency) = (efficiency, efficiency);
        self
    }

    /// The same with another efficiency when overhauling, up to 1: a worm's. At zero or below the gear locks itself.
    #[must_use]
    pub fn back_efficiency(mut self, efficiency: f64) -> Self {
        self.back_efficiency = efficiency;
        self
    }

    /// Whether its first coordinate carries another force than itself.
    pub(super) fn is_lossy(&self) -> bool {
        self.efficiency < 1.0 || self.back_efficiency < 1.0
    }

    /// Force on its first coordinate, as a multiple of its own, when that one drives or is driven.
    pub(super) fn factor(&self, drives: bool) -> f64 {
        if drives { 1.0 / self.efficiency } else { self.back_efficiency }
    }

    /// The same with this elongation at the start.
    #[must_use]
    pub fn elongated(mut self, elongation: f64) -> Self {
        self.elongation = elongation;
        self
    }

    /// Whether it carries force of either sign at every elongation.
    pub(super) fn is_linear(&self) -> bool {
        !self.rope && self.gap == 0.0
    }

    /// Whether its force may change at once, with its stiffness and its tooth error.
    pub(super) fn jumps(&self) -> bool {
        matches!(self.variation, Some(Variation::Zones(_) | Variation::Teeth(_)))
    }

    /// The elongation beyond the tooth error at which the force of this contact is zero at rest.
    pub(super) fn origin(&self, contact: i8) -> f64 {
        if self.rope { self.gap } else { 0.5 * self.gap * f64::from(contact.signum()) }
    }

    /// Stiffness at its greatest.
    pub(super) fn stiffest(&self) -> f64 {
        self.variation.as_ref().map_or(self.stiffness, |variation| variation.bounds(self.stiffness).0)
    }

    /// The elongation, at most, at which it carries a force, without its damper.
    pub(super) fn elongation_at(&self, force: f64) -> f64 {
        self.origin(1) + force / self.stiffest()
    }

    /// Mean stiffness over time.
    pub(super) fn mean_stiffness(&self) -> f64 {
        self.variation.as_ref().map_or(self.stiffness, |variation| variation.mean(self.stiffness))
    }

    pub(super) fn validate(&self, index: usize, coordinates: usize) -> Result<(), PlantError> {
        let place = Place::Shaft(index);
        if self.terms.is_empty() {
            return Err(PlantError::Count { name: "terms of a link", found: 0, expected: 1 });
        }
        for &(at, share) in &self.terms {
            if at >= coordinates {
                return Err(PlantError::Count { name: "coordinate of a link", found: at, expected: coordinates });
            }
            in_range("share of a link's term", place, share, share != 0.0, "a finite number that is not zero")?;
        }
        let twice = |(i, term): (usize, &(usize, f64))| self.terms[..i].iter().any(|other| other.0 == term.0);
        if self.terms.iter().enumerate().any(twice) {
            return Err(PlantError::Count { name: "times that a link names one coordinate", found: 2, expected: 1 });
        }
        not_negative("stiffness", place, self.stiffness)?;
        not_negative("damping", place, self.damping)?;
        let alone = self.is_linear() && self.variation.is_none() && self.damping > 0.0;
        in_range("stiffness", place, self.stiffness, self.stiffness > 0.0 || alone, "above zero, or damping alone")?;
        not_negative(if self.rope { "slack" } else { "backlash" }, place, self.gap)?;
        let eta = self.efficiency;
        in_range("efficiency", place, eta, eta > 0.0 && eta <= 1.0, "above 0 and up to 1")?;
        let back = self.back_efficiency;
        in_range("efficiency when overhauling", place, back, back <= 1.0, "up to 1")?;
        in_range("elongation at the start", place, self.elongation, true, "a finite number")?;
        let Some(variation) = &self.variation else { return Ok(()) };
        if let Variation::Teeth(teeth) = variation
            && teeth.coordinate >= coordinates
        {
            let (name, found) = ("coordinate of teeth", teeth.coordinate);
            return Err(PlantError::Count { name, found, expected: coordinates });
        }
        variation.validate(place, self.stiffness)
    }
}
