//! Sensitivity of a chain: changes at the motor when one of its parts is left out.

use super::chain::{CAPACITY, Chain};
use super::modes::lowest;
use super::reduce::compliance;
use super::refer::series;

/// A part of a chain that could be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Element {
    /// The shaft of this index made rigid: its two masses become one.
    Shaft(usize),
    /// The mass of this index made zero: its two shafts become one in series; the last takes its shaft along.
    Mass(usize),
}

/// Relative changes at the motor when a part is left out, signed; infinite where no vibration is left.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Part {
    /// The part.
    pub element: Element,
    /// Change of the first resonance.
    pub resonance: f64,
    /// Change of the first antiresonance.
    pub antiresonance: f64,
    /// Change of the static compliance at the motor, [`Chain::compliance`].
    pub compliance: f64,
}

impl Part {
    /// The largest of the three changes in size.
    #[must_use]
    pub const fn worst(&self) -> f64 {
        self.resonance.abs().max(self.antiresonance.abs()).max(self.compliance.abs())
    }
}

/// Every part of a chain that could be left out, shafts first, then the masses but for the motor.
///
/// A rule of thumb leaves out a drum below 10 % of its neighbours' inertia and a shaft ten times as stiff as the next
/// one [Wang 1989 example 1-5]. Here each is left out in turn and the change is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sensitivity {
    part: [Part; 2 * (CAPACITY - 1)],
    count: usize,
}

impl Sensitivity {
    /// The table.
    #[must_use]
    pub const fn parts(&self) -> &[Part] {
        self.part.split_at(self.count).0
    }
}

impl Chain {
    /// The changes when each shaft and each mass (but the motor) is left out; empty for a rigid chain.
    #[must_use]
    pub const fn sensitivity(&self) -> Sensitivity {
        let shafts = self.count - 1;
        let nothing = Part { element: Element::Shaft(0), resonance: 0.0, antiresonance: 0.0, compliance: 0.0 };
        let mut table = Sensitivity { part: [nothing; 2 * (CAPACITY - 1)], count: 2 * shafts };
        each!(j, 0..shafts, {
            table.part[j] = self.without(Element::Shaft(j));
            table.part[shafts + j] = self.without(Element::Mass(j + 1));
        });
        table
    }

    const fn without(&self, element: Element) -> Part {
        let shafts = self.count - 1;
        let mut inertia = self.inertia;
        let mut stiffness = [0.0; CAPACITY - 1];
        each!(j, 0..shafts, {
            stiffness[j] = self.shaft[j].stiffness;
        });
        let (resonance, antiresonance) = lowest(&inertia, &stiffness, shafts);
        let give = compliance(&inertia, &stiffness, shafts);
        if shafts == 1 {
            let change = f64::INFINITY;
            return Part { element, resonance: change, antiresonance: change, compliance: -1.0 };
        }
        // The mass and the shaft that are left out; the elements beyond move up.
        let (mass, shaft) = match element {
            Element::Shaft(j) => {
                inertia[j] += inertia[j + 1];
                (j + 1, j)
            }
            Element::Mass(j) => {
                if j < shafts {
                    stiffness[j - 1] = series(stiffness[j - 1], stiffness[j]);
                    (j, j)
                } else {
                    (j, j - 1)
                }
            }
        };
        each!(j, mass..shafts, {
            inertia[j] = inertia[j + 1];
        });
        each!(j, shaft.., j + 1 < shafts, {
            stiffness[j] = stiffness[j + 1];
        });
        let left = lowest(&inertia, &stiffness, shafts - 1);
        Part {
            element,
            resonance: left.0 / resonance - 1.0,
            antiresonance: left.1 / antiresonance - 1.0,
            compliance: compliance(&inertia, &stiffness, shafts - 1) / give - 1.0,
        }
    }
}
