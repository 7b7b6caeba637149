//! The inertia of a coordinate that changes with its angle, as series over a stretch.

use super::crank::{Crank, Work};
use super::linkage::Orders;
use super::mesh::Harmonic;
use super::pins::{Loss, Pinned, Pinning};
use super::series::{Series, Turn, ZERO, product};

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
    /// Of a crank with its pins, a law, or both; none without either.
    pub fn of(crank: Option<Crank>, pins: Option<(&Pinned, &Pinning)>, law: Option<&Orders>) -> Option<Self> {
        if crank.is_none() && law.is_none() {
            return None;
        }
        let loss = pins.map(|(pinned, pinning)| Box::new(Loss::new(pinned, pinning)));
        let crank = crank.map(|crank| (crank, Box::new(Work::new())));
        let law = law.iter().flat_map(|law| &law.0).map(|h| (*h, Turn::new(h.order))).collect();
        Some(Self { crank, loss, law, inertia: ZERO, push: ZERO })
    }

    /// Fills in coefficient `k` from the angle's coefficients up to it.
    pub fn extend(&mut self, angle: &Series, k: usize) {
        if let Some((crank, work)) = &mut self.crank {
            work.extend(crank, angle, k);
            let [inertia, push] = self.loss.as_mut().map_or([0.0; 2], |loss| loss.extend(crank, work, k));
            (self.inertia[k], self.push[k]) = (work.inertia[k] + inertia, work.half_slope[k] + push);
        }
        for (h, turn) in &mut self.law {
            turn.extend(angle, k);
            self.inertia[k] += h.cosine * turn.cosine[k] + h.sine * turn.sine[k];
            self.push[k] += 0.5 * h.order * (h.sine * turn.cosine[k] - h.cosine * turn.sine[k]);
        }
    }

    /// Coefficient `k` of the torque of the pins under the force on the slider.
    pub fn torque(&self, k: usize) -> f64 {
        self.loss.as_ref().map_or(0.0, |loss| loss.torque(k))
    }

    /// Coefficient `k` of the force that the rod takes from the slider, and what sizes its rounding, from coefficient
    /// `k + 1` of the speed, of which `step` is the time.
    pub fn rod(&self, speed: &Series, k: usize, step: f64) -> Option<(f64, f64)> {
        let (Some((crank, work)), Some(loss)) = (&self.crank, &self.loss) else { return None };
        let force = if k == 0 { loss.force() } else { 0.0 };
        let (mass, way) = (crank.slider_mass / step, &work.slider[0]);
        let size: f64 = (0..=k + 1).map(|i| (way[i] * speed[k + 1 - i]).abs()).sum();
        Some((force - mass * product(way, speed, k + 1), force.abs() + mass * size))
    }
}
