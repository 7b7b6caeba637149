//! A machine of elements as a train, everything referred to the motor.

use super::station::{Station, stations};
use super::{DamperRing, Element, MachineFile, Part};
use driveline::machine::{Damper, Resonance};
use driveline_solver::plant::train::{Coordinate, Friction, Link, RigidGear, Source, Train};
use driveline_solver::plant::{Chain, Place, Plant, PlantError, Shaft, Start};

/// Masses and shafts with their names.
pub(super) struct Referred {
    pub coordinates: Vec<(String, Coordinate)>,
    pub links: Vec<(String, Link)>,
}

/// The masses and shafts of a machine. The losses of a gear, a worm or a planetary set belong to the shaft behind it;
/// where a shaft ends in it, to that shaft; those of a belt to the belt. Where no shaft follows, the gear is part of the
/// last mass, which it divides. A rope only pulls; the weight of what is lifted pulls backwards on the last mass of its
/// chain or branch.
///
/// # Errors
/// The label of an element whose losses no shaft can carry: there is none.
pub(super) fn referred(machine: &MachineFile) -> Result<Referred, String> {
    let (masses, shafts) = machine.names();
    let Carried { rope, losses, rigid, without_shaft } = machine.carried();
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
        let [ahead, back] = losses[s];
        let bare = Link::shaft(joint.from, joint.to, shaft.stiffness)
            .damping(shaft.damping)
            .gap(shaft.gap)
            .efficiency(ahead)
            .back_efficiency(back);
        if rope[s] { bare.rope() } else { bare }
    };
    let mut coordinates: Vec<(String, Coordinate)> =
        masses.into_iter().zip(machine.masses().iter().zip(&weight).zip(machine.viscous()).map(coordinate)).collect();
    for (mass, gear) in rigid {
        coordinates[mass].1 = coordinates[mass].1.clone().gear(gear);
    }
    Ok(Referred {
        coordinates,
        links: shafts.into_iter().zip(machine.joints().into_iter().enumerate().map(link)).collect(),
    })
}

impl MachineFile {
    /// Of each shaft: whether it is a rope, and the efficiencies before it, while the motor drives and while the load
    /// does. Behind the last shaft stand [rigid gears](Self::rigid_gears).
    pub fn ropes_and_efficiencies(&self) -> (Vec<bool>, Vec<[f64; 2]>) {
        let carried = self.carried();
        (carried.rope, carried.losses)
    }

    /// The gears with no shaft behind them, each with the mass that it divides.
    pub fn rigid_gears(&self) -> Vec<(usize, RigidGear)> {
        self.carried().rigid
    }

    /// Why a gear without a shaft behind it has no motion in which its load drives it, and what gives it one; none where
    /// each has one.
    pub fn gear_that_stops_at_once(&self) -> Option<String> {
        let (names, _) = self.names();
        self.rigid_gears().into_iter().find_map(|(mass, gear)| {
            let RigidGear { front, back_efficiency, .. } = gear;
            let behind = self.masses()[mass] - front;
            // half as much again and a twentieth: a campaign draws other efficiencies
            let missing = (0.05 - 1.5 * back_efficiency) * behind - front;
            (front + back_efficiency * behind <= 0.0).then(|| {
                format!(
                    "driven by its load, the gear in `{}` would stop at once: its `back_efficiency` is \
                     {back_efficiency}, and {front} kg m² stand before it; put a `rotor` of {missing:.3e} kg m², at \
                     the motor, before the gear",
                    names[mass]
                )
            })
        })
    }

    /// The label of an element whose losses nothing carries: it stands before the first shaft, has no inertia behind
    /// it.
    pub fn losses_of_no_chain(&self) -> Option<String> {
        self.carried().without_shaft
    }

    fn carried(&self) -> Carried {
        let shafts = self.joints().len();
        let mut carried = Carried {
            rope: vec![false; shafts],
            losses: vec![[1.0; 2]; shafts],
            rigid: Vec::new(),
            without_shaft: None,
        };
        // behind the last mass of a chain or a branch there is no shaft
        let own = self.chain.shafts().len();
        carried.look(&self.elements, &|shaft| (shaft < own).then_some(shaft), &|mass| mass);
        for branch in &self.branches {
            let own = branch.chain.shafts().len();
            carried
                .look(&branch.elements, &|shaft| (shaft < own).then(|| branch.shaft(shaft)), &|mass| branch.mass(mass));
        }
        carried
    }

    /// The machine as a plant that runs in lock-step: it hangs on its shafts, which carry its weight, with dry friction
    /// (N m at the motor) at its far end. A gear before the first shaft loses nothing.
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

/// Efficiencies of two gears in a row, from the motor on. Where the second one locks, the motor has to drive the first.
fn both(first: [f64; 2], second: [f64; 2]) -> [f64; 2] {
    [first[0] * second[0], if second[1] > 0.0 { first[1] * second[1] } else { second[1] / first[0] }]
}

/// What each shaft carries beside its torque.
struct Carried {
    rope: Vec<bool>,
    /// Efficiencies before it, while the motor drives and while the load does.
    losses: Vec<[f64; 2]>,
    /// Gears with no shaft behind them, and their masses.
    rigid: Vec<(usize, RigidGear)>,
    /// An element whose losses nothing can carry.
    without_shaft: Option<String>,
}

impl Carried {
    /// Looks at the elements of a chain or a branch; `at` and `on` place its shafts and masses in the whole machine.
    fn look(&mut self, elements: &[Part], at: &dyn Fn(usize) -> Option<usize>, on: &dyn Fn(usize) -> usize) {
        let whole = stations(elements).last().map_or(0.0, |end| end.inertia);
        // inertia at the end of the elements before
        let mut before = 0.0;
        for (part, Station { last, inertia, .. }) in elements.iter().zip(stations(elements)) {
            let ends_in_shaft = last > 0 && before == 0.0;
            before = inertia;
            let (shaft, losses) = match part.element {
                Element::Rope { .. } => {
                    let rope = last.checked_sub(1).and_then(at).and_then(|shaft| self.rope.get_mut(shaft));
                    rope.into_iter().for_each(|rope| *rope = true);
                    continue;
                }
                Element::Planetary { gear, back_efficiency } => (last, [gear.set.efficiency.0, back_efficiency]),
                Element::Gear { efficiency, back_efficiency, .. }
                | Element::Worm { efficiency, back_efficiency, .. } => (last, [efficiency, back_efficiency]),
                Element::Belt(belt) => (last.saturating_sub(1), [belt.efficiency.0; 2]),
                _ => continue,
            };
            if losses == [1.0; 2] {
                continue;
            }
            let is_belt = matches!(part.element, Element::Belt(_));
            let behind = at(shaft).and_then(|shaft| self.losses.get(shaft).map(|_| shaft));
            let ending = last.checked_sub(1).and_then(at);
            match (behind, ending) {
                (Some(_), Some(own)) if ends_in_shaft && !is_belt => {
                    self.losses[own] = both(self.losses[own], losses);
                }
                (Some(shaft), _) => self.losses[shaft] = both(self.losses[shaft], losses),
                (None, Some(_)) if before < whole => {
                    let [efficiency, back_efficiency] = losses;
                    match self.rigid.iter_mut().find(|(mass, _)| *mass == on(last)) {
                        None => self.rigid.push((on(last), RigidGear { front: before, efficiency, back_efficiency })),
                        // the inertia between the two counts behind both
                        Some((_, gear)) => {
                            [gear.efficiency, gear.back_efficiency] =
                                both([gear.efficiency, gear.back_efficiency], losses);
                        }
                    }
                }
                (None, _) => self.without_shaft = Some(part.label.clone()),
            }
        }
    }
}
