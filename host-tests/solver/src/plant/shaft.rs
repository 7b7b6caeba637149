//! Shafts: elastic, with backlash, or a rope that can only pull.

use super::error::{PlantError, not_negative, positive};
use super::event::Place;

/// An elastic link between two neighbouring nodes, referred to the motor shaft.
///
/// Torque `k x + d dx/dt`, `x` the twist beyond the free play; see [`crate::plant`] for the law in the gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    /// Backlash: both flanks together. Rope: slack to be wound up.
    pub(super) gap: f64,
    pub(super) rope: bool,
}

impl Shaft {
    /// A shaft of this stiffness, N m/rad, above zero; undamped, without backlash.
    #[must_use]
    pub const fn elastic(stiffness: f64) -> Self {
        Self { stiffness, damping: 0.0, gap: 0.0, rope: false }
    }

    /// A rope of this stiffness, N m/rad: torque `max(0, k (theta - slack) + d dw)` while `theta > slack`, else zero.
    #[must_use]
    pub const fn rope(stiffness: f64) -> Self {
        Self { stiffness, damping: 0.0, gap: 0.0, rope: true }
    }

    /// The same with damping, N m s/rad, zero or above. It acts only while the shaft carries torque; a flank never
    /// pulls, a rope never pushes.
    #[must_use]
    pub const fn damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// The same with a gap, rad, zero or above. Elastic shaft: the whole backlash, half of it on either side of zero
    /// twist. Rope: the twist at which it comes taut.
    #[must_use]
    pub const fn gap(mut self, gap: f64) -> Self {
        self.gap = gap;
        self
    }

    /// The twist at which the torque of this contact is zero at rest, rad.
    pub(super) fn origin(&self, contact: i8) -> f64 {
        if self.rope { self.gap } else { 0.5 * self.gap * f64::from(contact.signum()) }
    }

    pub(super) fn validate(&self, shaft: usize) -> Result<(), PlantError> {
        let place = Place::Shaft(shaft);
        positive("stiffness", place, self.stiffness)?;
        not_negative("damping", place, self.damping)?;
        not_negative(if self.rope { "slack" } else { "backlash" }, place, self.gap)
    }
}
