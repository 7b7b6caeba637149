//! The inertia of a coordinate that changes with its angle, as series over a stretch.

use super::crank::{Crank, Work};
use super::linkage::Orders;
use super::mesh::Harmonic;
use super::pins::{Loss, Pinned, Pinning};
use super::series::{Series, Turn, ZERO};

/// The inertia of a coordinate over a stretch beside its own.
#[derive(Debug, Clone)]
pub(super) struct Varying {
    crank: Option<(Crank, Box<Work>)>,
    loss: Option<Box<Loss>>,
    law: Vec<(Harmonic, Turn)>,
    pub inertia: Series,
    /// What the momentum changes by per square of the speed: half the slope of the inertia, and the friction of pins.
    pub push: Series,
}

impl Varying {
    /// Of a crank, pins and a law; none without any of them.
    pub fn of(crank: Option<Crank>, pins: Option<(&Pinned, &Pinning)>, law: Option<&Orders>) -> Option<Self> {
        if crank.is_none() && pins.is_none() && law.is_none() {
            return None;
        }
        let loss = pins.map(|(pinned, pinning)| Box::new(Loss::new(pinned, pinning, crank)));
        let crank = crank.map(|crank| (crank, Box::new(Work::new())));
        let law = law.iter().flat_map(|law| &law.0).map(|h| (*h, Turn::new(h.order))).collect();
        Some(Self { crank, loss, law, inertia: ZERO, push: ZERO })
    }

    /// Fills in coefficient `k` from the angle's coefficients up to it.
    pub fn extend(&mut self, angle: &Series, k: usize) {
        if let Some((crank, work)) = &mut self.crank {
            work.extend(crank, angle, k);
            (self.inertia[k], self.push[k]) = (work.inertia[k], work.half_slope[k]);
        }
        if let Some(loss) = &mut self.loss {
            let crank = self.crank.as_ref().map(|(crank, work)| (crank, &**work));
            let [inertia, push] = loss.extend(crank, angle, k);
            (self.inertia[k], self.push[k]) = (self.inertia[k] + inertia, self.push[k] + push);
        }
        for (h, turn) in &mut self.law {
            turn.extend(angle, k);
            self.inertia[k] += h.cosine * turn.cosine[k] + h.sine * turn.sine[k];
            self.push[k] += 0.5 * h.order * (h.sine * turn.cosine[k] - h.cosine * turn.sine[k]);
        }
    }

    /// Coefficient `k` of the torque of the pins under the force on the slider or the torque on the rocker.
    pub fn torque(&self, k: usize) -> f64 {
        self.loss.as_ref().map_or(0.0, |loss| loss.torque(k))
    }

    /// Coefficient `k` of the force in the rod or coupler of a crank with friction in its pins, see [`Loss::carried`].
    pub fn rod(&self, speed: &Series, k: usize, step: f64) -> Option<(f64, f64)> {
        self.loss.as_ref().map(|loss| loss.carried(speed, k, step))
    }
}
