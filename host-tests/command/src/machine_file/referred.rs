//! A machine of elements as a train, everything referred to the motor.

use super::station::{Station, stations};
use super::{Element, MachineFile, Part};
use driveline_solver::plant::train::{Coordinate, Link, Source};
use driveline_solver::plant::{Chain, Plant, PlantError, Shaft, Start};

/// Masses and shafts with their names.
pub(super) struct Referred {
    pub coordinates: Vec<(String, Coordinate)>,
    pub links: Vec<(String, Link)>,
}

/// The masses and shafts of a machine. A gear's efficiency belongs to the shaft behind it; where a shaft ends in a
/// gear, to that shaft. A rope only pulls; the weight of what is lifted pulls backwards on the last mass of its chain
/// or branch.
pub(super) fn referred(machine: &MachineFile) -> Referred {
    let (masses, shafts) = machine.names();
    let (rope, efficiency) = machine.ropes_and_efficiencies();
    let mut weight = vec![0.0; masses.len()];
    weight[machine.chain.masses().len() - 1] = machine.chain.gravity_torque();
    for branch in &machine.branches {
        weight[branch.mass(branch.chain.masses().len() - 1)] += branch.chain.gravity_torque() / branch.ratio;
    }
    let coordinate = |(&inertia, &weight): (&f64, &f64)| {
        let bare = Coordinate::new(inertia);
        if weight != 0.0 { bare.source(Source::Constant(-weight)) } else { bare }
    };
    let link = |(s, joint): (usize, driveline::machine::Joint)| {
        let shaft = joint.shaft;
        let bare = Link::shaft(joint.from, joint.to, shaft.stiffness)
            .damping(shaft.damping)
            .gap(shaft.gap)
            .efficiency(efficiency[s]);
        if rope[s] { bare.rope() } else { bare }
    };
    Referred {
        coordinates: masses.into_iter().zip(machine.masses().iter().zip(&weight).map(coordinate)).collect(),
        links: shafts.into_iter().zip(machine.joints().into_iter().enumerate().map(link)).collect(),
    }
}

impl MachineFile {
    /// Of each shaft: whether it is a rope, and the efficiency of the gear before it.
    pub fn ropes_and_efficiencies(&self) -> (Vec<bool>, Vec<f64>) {
        let shafts = self.joints().len();
        let (mut rope, mut efficiency) = (vec![false; shafts], vec![1.0; shafts]);
        let mut look = |elements: &[Part], stations: &[Station], at: &dyn Fn(usize) -> usize| {
            for (part, Station { chain, .. }) in elements.iter().zip(stations) {
                let last = chain.masses().len() - 1;
                match part.element {
                    Element::Rope { .. } => rope[at(last - 1)] = true,
                    Element::Gear { efficiency: eta, .. } => {
                        let ends_a_shaft = last > 0 && chain.masses()[last] == 0.0;
                        if let Some(known) = efficiency.get_mut(at(if ends_a_shaft { last - 1 } else { last })) {
                            *known *= eta;
                        }
                    }
                    _ => {}
                }
            }
        };
        look(&self.elements, &stations(&self.elements), &|shaft| shaft);
        for branch in &self.branches {
            look(&branch.elements, &stations(&branch.elements), &|shaft| branch.shaft(shaft));
        }
        (rope, efficiency)
    }

    /// The machine as a plant that runs in lock-step: it hangs on its shafts, which carry its weight, with dry friction
    /// \[N m at the motor\] at its far end. A gear before the first shaft loses nothing.
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
