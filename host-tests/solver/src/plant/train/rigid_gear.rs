//! A lossy gear between two parts of one coordinate, with no shaft behind it.
//!
//! In front of the gear stand `front` of the inertia and the links that end in the coordinate, in which it is not the
//! first term. Behind it acts everything else: the rest of the inertia, links that begin here, sources, held torques,
//! viscous and dry friction.
//!
//! `J_f w' = T_f - m R`, `J_b w' = R - L`, hence `(J_f + m J_b) w' = T_f - m L`. `R` is the torque behind the gear, `L`
//! the torque against it, `m` the loss: `1/eta` driving (`R w > 0`), `eta` driven \[derived\]. The sign of
//! `R = (J_b T_f + J_f L)/(J_f + m J_b)` does not depend on `m`, so `m` is never in doubt. At rest the gear holds while
//! `T_f` lies between the `m L` of both directions.

use super::Train;
use super::state::Mode;
use super::stretch::Stretch;
use crate::plant::error::{PlantError, in_range, not_negative};
use crate::plant::event::Place;

/// Efficiencies of the gear, and the inertia in front of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidGear {
    /// Zero or above, below the inertia of the whole coordinate, kg m2.
    pub front: f64,
    /// While the front drives: above 0 and up to 1.
    pub efficiency: f64,
    /// While the back drives: up to 1. A gear of zero or below locks itself.
    pub back_efficiency: f64,
}

impl RigidGear {
    /// Torque in front, as a multiple of that behind, when the front drives or is driven.
    pub(super) fn factor(&self, drives: bool) -> f64 {
        if drives { 1.0 / self.efficiency } else { self.back_efficiency }
    }
}

/// A rigid gear in motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Flow {
    pub at: usize,
    /// The friction against the ground that the gear holds with.
    pub friction: usize,
    /// Sign of the torque behind the gear, sliding or about to slide forwards and backwards.
    pub sign: [i8; 2],
}

impl Flow {
    /// The factor of a direction, +1 or -1.
    pub fn factor(&self, gear: &RigidGear, side: i8) -> f64 {
        gear.factor(side * self.sign[usize::from(side < 0)] > 0)
    }
}

impl Mode {
    /// Inertia of a coordinate as its acceleration feels it, kg m2.
    pub fn inertia(&self, train: &Train, at: usize) -> f64 {
        let coordinate = &train.coordinates[at];
        match (&coordinate.gear, self.gears.iter().find(|flow| flow.at == at)) {
            (Some(gear), Some(flow)) => gear.front + self.gear_factor(gear, flow) * (coordinate.inertia - gear.front),
            _ => coordinate.inertia,
        }
    }

    /// What the gear makes of the torques behind it; 1 while it holds, when friction takes the difference.
    fn gear_factor(&self, gear: &RigidGear, flow: &Flow) -> f64 {
        match self.slip[flow.friction] {
            0 => 1.0,
            side => flow.factor(gear, side),
        }
    }
}

impl Stretch {
    /// Makes the torques on geared coordinates, coefficient `k`, those that accelerate them, and notes the torque
    /// behind each gear.
    pub(super) fn gears(&mut self, train: &Train, mode: &Mode, k: usize, net: &mut [f64], size: &mut [f64]) {
        for (flow, torque) in mode.gears.iter().zip(&mut self.gear) {
            let at = flow.at;
            let Some(gear) = &train.coordinates[at].gear else { continue };
            let (mut front, mut sizes) = (0.0, size[at]);
            for (l, link) in train.links.iter().enumerate().filter(|&(l, _)| mode.carries(train, l)) {
                for &(_, share) in link.terms.iter().skip(1).filter(|term| term.0 == at) {
                    front -= share * self.strain[l].value[k];
                }
            }
            let (behind, factor) = (net[at] - front, mode.gear_factor(gear, flow));
            net[at] = front + factor * behind;
            size[at] *= factor.abs().max(1.0);
            let inertia = train.coordinates[at].inertia - gear.front;
            let mut speeding = 0.0;
            if mode.slip[flow.friction] != 0 {
                let whole = gear.front + factor * inertia;
                speeding = inertia * net[at] / whole;
                sizes += inertia * size[at] / whole;
            }
            torque.put(k, speeding - behind, sizes);
        }
    }
}

impl Train {
    pub(super) fn validate_gears(&self) -> Result<(), PlantError> {
        for (at, coordinate) in self.coordinates.iter().enumerate() {
            let Some(gear) = &coordinate.gear else { continue };
            let place = Place::Node(at);
            not_negative("inertia in front of the gear", place, gear.front)?;
            let behind = coordinate.inertia - gear.front;
            in_range("inertia in front of the gear", place, gear.front, behind > 0.0, "below that of the coordinate")?;
            let (eta, back) = (gear.efficiency, gear.back_efficiency);
            in_range("efficiency", place, eta, eta > 0.0 && eta <= 1.0, "above 0 and up to 1")?;
            // otherwise an overhauled gear would stop at once, whatever its speed
            let turns = back <= 1.0 && gear.front + back * behind > 0.0;
            let least = "up to 1, and above minus the inertia in front of the gear over that behind it: a \
                         rotor before the gear";
            in_range("efficiency when overhauling", place, back, turns, least)?;
            let lossy = self.links.iter().any(|link| link.is_lossy() && link.terms[0].0 == at);
            let on = self.frictions.iter().filter(|one| one.terms.iter().any(|term| term.0 == at));
            let still = |one: &super::Friction| one.terms == [(at, 1.0)] && one.surface == 0.0;
            let coupled = self.unbalances.iter().any(|one| one.turning == at || one.way == at);
            if lossy || coupled || coordinate.is_cranked() || on.clone().count() > 1 || !on.clone().all(still) {
                return Err(PlantError::Parameter {
                    name: "rigid gear with a crank, an unbalance, a second lossy gear or friction against what moves",
                    place,
                    value: eta,
                    expected: "those on another coordinate, behind a shaft",
                });
            }
        }
        Ok(())
    }
}
