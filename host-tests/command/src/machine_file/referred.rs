//! A machine of elements as a train, everything referred to the motor.

use super::station::{Station, stations};
use super::{DamperRing, Element, MachineFile, Part};
use driveline::machine::{Damper, Resonance};
use driveline_solver::plant::train::{Coordinate, Friction, Link, Source, Train};
use driveline_solver::plant::{Chain, Place, Plant, PlantError, Shaft, Start};

/// Masses and shafts with their names.
pub(super) struct Referred {
    pub coordinates: Vec<(String, Coordinate)>,
    pub links: Vec<(String, Link)>,
}

/// The masses and shafts of a machine. The losses of a gear, a worm or a planetary set belong to the shaft behind it;
/// where a shaft ends in it, to that shaft; those of a belt to the belt. A rope only pulls; the weight of what is
/// lifted pulls backwards on the last mass of its chain or branch.
///
/// # Errors
/// The label of an element whose losses no shaft can carry.
pub(super) fn referred(machine: &MachineFile) -> Result<Referred, String> {
    let (masses, shafts) = machine.names();
    let Carried { rope, efficiency, without_shaft } = machine.carried();
    if let Some(label) = without_shaft {
        return Err(label);
    }
    let mut weight = vec![0.0; masses.len()];
    weight[machine.chain.masses().len() - 1] = machine.chain.gravity_torque();
    for branch in &machine.branches {
        weight[branch.mass(branch.chain.masses().len() - 1)] += branch.chain.gravity_torque() / branch.ratio;
    }
    let coordinate = |((&inertia, &weight), viscous): ((&f64, &f64), f64)| {
        let bare = Coordinate::new(inertia).viscous(viscous);
        if weight != 0.0 { bare.source(Source::Constant(-weight)) } else { bare }
    };
    let link = |(s, joint): (usize, driveline::machine::Joint)| {
        let shaft = joint.shaft;
        let bare = Link::shaft(joint.from, joint.to, shaft.stiffness)
            .damping(shaft.damping)
            .gap(shaft.gap)
            .efficiency(efficiency[s][0])
            .back_efficiency(efficiency[s][1]);
        if rope[s] { bare.rope() } else { bare }
    };
    Ok(Referred {
        coordinates: masses
            .into_iter()
            .zip(machine.masses().iter().zip(&weight).zip(machine.viscous()).map(coordinate))
            .collect(),
        links: shafts.into_iter().zip(machine.joints().into_iter().enumerate().map(link)).collect(),
    })
}

impl MachineFile {
    /// Of each shaft: whether it is a rope, and the efficiencies that it carries while the motor drives and while the
    /// load does.
    pub fn ropes_and_efficiencies(&self) -> (Vec<bool>, Vec<[f64; 2]>) {
        let carried = self.carried();
        (carried.rope, carried.efficiency)
    }

    /// The label of an element whose losses no chain carries: no shaft is behind it.
    pub fn losses_of_no_chain(&self) -> Option<String> {
        self.carried().without_shaft
    }

    fn carried(&self) -> Carried {
        let shafts = self.joints().len();
        let mut carried =
            Carried { rope: vec![false; shafts], efficiency: vec![[1.0; 2]; shafts], without_shaft: None };
        // behind the last mass of a chain or a branch there is no shaft
        let own = self.chain.shafts().len();
        carried.look(&self.elements, &|shaft| (shaft < own).then_some(shaft));
        for branch in &self.branches {
            let own = branch.chain.shafts().len();
            carried.look(&branch.elements, &|shaft| (shaft < own).then(|| branch.shaft(shaft)));
        }
        carried
    }

    /// The machine as a plant that runs in lock-step: it hangs on its shafts, which carry its weight, with dry friction
    /// (N m at the motor) at its far end. A gear before the first shaft loses nothing.
    ///
    /// # Errors
    /// What the plant refuses.
    pub fn plant(&self, friction: f64) -> Result<Plant, PlantError> {
        let (masses, shafts) = (self.chain.masses(), self.chain.shafts());
        let weight = self.chain.gravity_torque();
        let mut known = Chain::motor(1.0);
        let viscous = self.viscous();
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
            known = known.viscous(viscous[node]);
        }
        let start = Start::Given { twists, speeds: vec![0.0; masses.len()] };
        known.load(weight).coulomb(friction).start(start).build()
    }
}

/// A damper as parts of a run, its mass and what holds it.
pub(super) struct DamperParts {
    pub name: String,
    pub ring: Coordinate,
    pub link: Option<Link>,
    pub friction: Option<Friction>,
}

impl MachineFile {
    /// The dampers as parts of a run in which `before` coordinates come before them.
    pub(super) fn damper_parts(&self, before: usize) -> Vec<DamperParts> {
        let parts = |(index, (damper, sized, friction)): (usize, (&DamperRing, Damper, Option<f64>))| {
            let ring = before + index;
            let link = Link::shaft(damper.mass, ring, sized.stiffness).damping(sized.damping);
            let same = self.dampers[..index].iter().filter(|other| other.at == damper.at).count();
            let number = if same == 0 { String::new() } else { format!(" {}", same + 1) };
            DamperParts {
                name: format!("damper{number} of {}", damper.at),
                ring: Coordinate::new(sized.inertia),
                link: friction.is_none().then_some(link),
                friction: friction.map(|torque| Friction::between(damper.mass, ring, torque)),
            }
        };
        self.sized_dampers().into_iter().enumerate().map(parts).collect()
    }

    /// The dampers in the order of the file, with their sizes at the motor, and the friction torque (N m) of those on
    /// dry friction.
    pub(crate) fn sized_dampers<'a>(&'a self) -> Vec<(&'a DamperRing, Damper, Option<f64>)> {
        let modes = self.modes();
        let sized = |damper: &'a DamperRing| {
            let main = damper.kind.mode().map(|mode| Resonance::of(&modes.resonances()[mode], damper.mass));
            let friction = main.as_ref().and_then(|main| damper.friction(main));
            (damper, damper.sized(main.as_ref()), friction.map(|friction| friction.torque))
        };
        self.dampers.iter().map(sized).collect()
    }

    /// A train of `before` coordinates, the machine's masses first, with the dampers on them: a coordinate each, and a
    /// link or a friction.
    pub fn put_dampers(&self, train: Train, before: usize) -> Train {
        self.damper_parts(before).into_iter().fold(train, |train, part| {
            let train = train.coordinate(part.ring);
            let train = part.link.into_iter().fold(train, Train::link);
            part.friction.into_iter().fold(train, Train::friction)
        })
    }

    /// The name of a place in such a train of the machine's masses and shafts; empty beyond its end.
    pub(crate) fn name_at(&self, place: Place) -> String {
        let (mut masses, mut shafts) = self.names();
        for part in self.damper_parts(masses.len()) {
            shafts.extend(part.link.map(|_| part.name.clone()));
            masses.push(part.name);
        }
        let name = match place {
            Place::Node(node) | Place::Pins(node) => masses.get(node),
            Place::Shaft(shaft) => shafts.get(shaft),
        };
        name.cloned().unwrap_or_default()
    }
}

/// What each shaft carries beside its torque.
struct Carried {
    rope: Vec<bool>,
    /// While the motor's side drives, and while it is driven.
    efficiency: Vec<[f64; 2]>,
    /// An element whose losses no shaft can carry.
    without_shaft: Option<String>,
}

impl Carried {
    /// Looks at the elements of a chain or a branch; `at` places its shafts in the whole machine.
    fn look(&mut self, elements: &[Part], at: &dyn Fn(usize) -> Option<usize>) {
        // inertia at the end of the elements before
        let mut before = 0.0;
        for (part, Station { last, inertia, .. }) in elements.iter().zip(stations(elements)) {
            let behind = if last > 0 && before == 0.0 { last - 1 } else { last };
            before = inertia;
            let (shaft, losses) = match part.element {
                Element::Rope { .. } => {
                    let rope = last.checked_sub(1).and_then(at).and_then(|shaft| self.rope.get_mut(shaft));
                    rope.into_iter().for_each(|rope| *rope = true);
                    continue;
                }
                Element::Gear { efficiency, .. } | Element::Planetary { efficiency, .. } => (behind, [efficiency; 2]),
                Element::Worm { efficiency, back_efficiency, .. } => (behind, [efficiency, back_efficiency]),
                Element::Belt { efficiency, .. } => (last.saturating_sub(1), [efficiency; 2]),
                _ => continue,
            };
            match at(shaft).and_then(|shaft| self.efficiency.get_mut(shaft)) {
                Some(known) => *known = [known[0] * losses[0], known[1] * losses[1]],
                None if losses != [1.0; 2] => self.without_shaft = Some(part.label.clone()),
                None => {}
            }
        }
    }
}
