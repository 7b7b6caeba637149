//! Belts between two pulleys, and screws that turn turning into travel.

use core::f64::consts::PI;

use super::error::{not_negative, positive};
use super::{Chain, Diameter, Efficiency, Error, Length, LinearDamping, Ratio, Stiffness};

/// A belt, chain or toothed belt, pretensioned so that neither strand goes slack.
///
/// One strand tightens as the other slackens, so both resist: the twist `r_1 phi_1 - r_2 phi_2` meets twice the
/// strand's stiffness. At the driving pulley that is `2 k r_1^2`, by the strain energy [Wang 1989 §1-3]. A strand of
/// length l, cross-section A and modulus E has `k = E A/l`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Belt {
    /// Effective diameter of the pulley on the motor's side (m).
    pub driving: Diameter,
    /// Effective diameter of the pulley on the load's side (m).
    pub driven: Diameter,
    /// Stiffness of one strand (N/m).
    pub strand: Stiffness,
    /// Damping of one strand (N s/m).
    pub damping: LinearDamping,
    /// Efficiency of the drive.
    pub efficiency: Efficiency,
}

impl Belt {
    /// Speed of the driving pulley over the driven one's, without slip.
    #[must_use]
    pub const fn ratio(&self) -> Ratio {
        Ratio(self.driven.0 / self.driving.0)
    }

    /// Torsional stiffness at the driving pulley (N m/rad).
    #[must_use]
    pub const fn stiffness(&self) -> Stiffness {
        Stiffness(self.at_driving(self.strand.0))
    }

    const fn at_driving(&self, strand: f64) -> f64 {
        0.5 * strand * self.driving.0 * self.driving.0
    }
}

impl Chain {
    /// A belt to the next mass, at the driven pulley's speed. The pulleys are rotors before and after it.
    ///
    /// Refused: [`Error::PulleyDiameter`], [`Error::BeltStiffness`], [`Error::BeltDamping`], [`Error::GearEfficiency`],
    /// [`Error::RotaryAfterDrum`], [`Error::TooManyMasses`].
    #[must_use]
    pub const fn belt(self, belt: Belt) -> Self {
        if !(positive(belt.driving.0) && positive(belt.driven.0)) {
            return self.refuse(Error::PulleyDiameter);
        }
        if !positive(belt.strand.0) {
            return self.refuse(Error::BeltStiffness);
        }
        if !not_negative(belt.damping.0) {
            return self.refuse(Error::BeltDamping);
        }
        self.shaft(belt.stiffness(), super::Damping(belt.at_driving(belt.damping.0)))
            .gear(belt.ratio(), belt.efficiency)
            .close()
    }

    /// A ball screw: turning becomes travel, by its lead (m) a turn. A drum of diameter `lead/pi` travels alike.
    ///
    /// Refused: [`Error::ScrewLead`], [`Error::RotaryAfterDrum`].
    #[must_use]
    pub const fn screw(self, lead: Length) -> Self {
        if !positive(lead.0) {
            return self.refuse(Error::ScrewLead);
        }
        let diameter = lead.0 / PI;
        if self.travel == 0.0 && !positive(diameter / (2.0 * self.ratio)) {
            return self.refuse(Error::ScrewLead);
        }
        self.drum(Diameter(diameter))
    }
}
