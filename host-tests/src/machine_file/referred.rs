//! A chain of elements as a train, everything referred to the motor.

use super::{Element, MachineFile};
use crate::cli::names;
use crate::plant::train::{Coordinate, Link, Source};
use crate::plant::{Chain, Plant, PlantError, Shaft, Start};

/// Masses and shafts with their names.
pub(super) struct Referred {
    pub coordinates: Vec<(String, Coordinate)>,
    pub links: Vec<(String, Link)>,
}

/// The masses and shafts of a machine. A gear's efficiency belongs to the shaft behind it; where a shaft ends in a
/// gear, to that shaft. A rope only pulls; the weight of what is lifted pulls backwards on the last mass.
pub(super) fn referred(machine: &MachineFile) -> Referred {
    let (masses, shafts) = names(machine);
    let mut chain = machine.chain;
    let mut rope = vec![false; shafts.len()];
    let mut efficiency = vec![1.0; shafts.len()];
    for part in &machine.elements {
        // the whole chain was built of these elements, so each of them can follow
        chain = part.element.follow(chain).unwrap_or(chain);
        let last = chain.masses().len() - 1;
        match part.element {
            Element::Rope { .. } => rope[last - 1] = true,
            Element::Gear { efficiency: eta, .. } => {
                let ends_a_shaft = last > 0 && chain.masses()[last] == 0.0;
                if let Some(known) = efficiency.get_mut(if ends_a_shaft { last - 1 } else { last }) {
                    *known *= eta;
                }
            }
            _ => {}
        }
    }
    let last = machine.chain.masses().len() - 1;
    let weight = machine.chain.gravity_torque();
    let coordinate = |(j, &inertia): (usize, &f64)| {
        let bare = Coordinate::new(inertia);
        if j == last && weight != 0.0 { bare.source(Source::Constant(-weight)) } else { bare }
    };
    let link = |(s, shaft): (usize, &driveline::machine::Shaft)| {
        let bare =
            Link::shaft(s, s + 1, shaft.stiffness).damping(shaft.damping).gap(shaft.gap).efficiency(efficiency[s]);
        if rope[s] { bare.rope() } else { bare }
    };
    Referred {
        coordinates: masses.into_iter().zip(machine.chain.masses().iter().enumerate().map(coordinate)).collect(),
        links: shafts.into_iter().zip(machine.chain.shafts().iter().enumerate().map(link)).collect(),
    }
}

impl MachineFile {
    /// The machine as a plant that runs in lock-step: it hangs on its shafts, which carry its weight, with dry friction \[N m at the motor\] at its
    /// far end. A gear before the first shaft loses nothing.
    ///
    /// # Errors
    /// What the plant refuses.
    pub fn plant(&self, friction: f64) -> Result<Plant, PlantError> {
        let (masses, shafts) = (self.chain.masses(), self.chain.shafts());
        let weight = self.chain.gravity_torque();
        let mut known = Chain::motor(1.0);
        let mut twists = Vec::new();
        for (node, inertia) in masses.iter().enumerate() {
            match node.checked_sub(1).and_then(|before| shafts.get(before)) {
                None => known = Chain::motor(*inertia),
                Some(shaft) => {
                    let shaft_of = Shaft::elastic(shaft.stiffness).damping(shaft.damping).gap(shaft.gap);
                    let flank = if weight > 0.0 { 0.5 * shaft.gap } else { 0.0 };
                    twists.push(flank + weight / shaft.stiffness);
                    known = known.shaft(shaft_of, *inertia);
                }
            }
        }
        let start = Start::Given { twists, speeds: vec![0.0; masses.len()] };
        known.load(weight).coulomb(friction).start(start).build()
    }
}
