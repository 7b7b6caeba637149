//! How a train begins: the start conditions `[derived; headings: Huang 1987 ch. 3 to 7]` beside what coordinates and
//! links are given.

use nalgebra::{DMatrix, DVector};

use super::stretch::Stretch;
use super::{Motion, Train, Variation};
use crate::plant::error::PlantError;
use crate::plant::event::Place;

impl Train {
    /// Opens every backlash to its far flank, as after a load that hung on it: elongation `-gap/2`. Ropes stay as
    /// they are.
    #[must_use]
    pub fn slack(mut self) -> Self {
        for link in self.links.iter_mut().filter(|link| !link.rope) {
            link.elongation = -0.5 * link.gap;
        }
        self
    }

    /// Stretches every link by what it carries while `held` is held fast and everything else stands under the torques
    /// of time zero, friction left out.
    ///
    /// # Errors
    /// [`PlantError`] as [`build`](Self::build); a rope that would have to push; links in a loop whose backlash
    /// leaves open which of them carry.
    pub fn pretensioned(mut self, held: usize) -> Result<Self, PlantError> {
        let mut frictionless = self.clone();
        frictionless.frictions.clear();
        frictionless.links.clear();
        frictionless.unbalances.clear();
        // what stands has no use for the inertia of a mechanism, nor for the friction of a gear
        frictionless.coordinates.iter_mut().for_each(|c| (c.crank, c.pins, c.law, c.gear) = (None, None, None, None));
        let n = self.coordinates.len();
        if held >= n {
            return Err(PlantError::Count { name: "locked coordinate", found: held, expected: n });
        }
        self.validate()?;
        let bare = Motion::new(frictionless);
        let still = Stretch::new(&bare.train, &bare.mode, &bare.state, &bare.held, 0.0, 1e-6);
        let weight = |j: usize| {
            let on = self.unbalances.iter().filter(|unbalance| unbalance.turning == j);
            on.map(|unbalance| unbalance.weight(self.coordinates[j].angle)).sum::<f64>()
        };
        let torque = |j: usize| still.speed[j].value[1] / still.length * self.coordinates[j].inertia + weight(j);
        let free: Vec<usize> = (0..n).filter(|&j| j != held).collect();
        let links = self.links.len();
        let share = |l: usize, j: usize| self.links[l].terms.iter().find(|term| term.0 == j).map_or(0.0, |term| term.1);
        let stretch = DMatrix::from_fn(links, free.len(), |l, column| share(l, free[column]));
        let weighted = DMatrix::from_fn(links, free.len(), |l, c| stretch[(l, c)] * self.stiffness_at_start(l));
        let push = DVector::from_fn(free.len(), |row, _| torque(free[row]));
        let stiffness = stretch.transpose() * &weighted;
        let size = stiffness.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let solve = |svd: nalgebra::SVD<f64, nalgebra::Dyn, nalgebra::Dyn>, right: &DVector<f64>| {
            svd.solve(right, 1e-13 * size).unwrap_or_else(|_| DVector::zeros(right.len()))
        };
        let angles = solve(stiffness.clone().svd(true, true), &push);
        let left = (&stiffness * &angles - &push).amax();
        if left > 1e-9 * push.amax() {
            return Err(PlantError::Parameter {
                name: "torque that nothing holds",
                place: Place::Node(held),
                value: left,
                expected: "every coordinate linked to the locked one, or without torque",
            });
        }
        let forces = &weighted * &angles;
        for (l, link) in self.links.iter_mut().enumerate() {
            let force = forces[l];
            if link.rope && force < 0.0 {
                return Err(PlantError::Parameter {
                    name: "force to be carried",
                    place: Place::Shaft(l),
                    value: force,
                    expected: "zero or above, since a rope cannot push",
                });
            }
            let side = if force == 0.0 { 0.0 } else { force.signum() };
            let open = if link.rope { link.gap } else { 0.5 * link.gap * side };
            link.elongation = (stretch.row(l) * &angles)[0] + open;
        }
        // links in a loop must still close
        let wanted = DVector::from_fn(links, |l, _| self.links[l].elongation);
        let closed = stretch.clone().svd(true, true).solve(&wanted, 1e-12).unwrap_or_else(|_| angles.clone());
        let open = (&stretch * closed - &wanted).amax();
        if open > 1e-9 * wanted.amax() {
            return Err(PlantError::Parameter {
                name: "backlash in a loop",
                place: Place::Shaft(0),
                value: open,
                expected: "elongations given one by one, since its flanks leave open which links carry",
            });
        }
        Ok(self)
    }

    /// Stiffness at time zero.
    fn stiffness_at_start(&self, link: usize) -> f64 {
        let link = &self.links[link];
        match &link.variation {
            None => link.stiffness,
            Some(Variation::Teeth(teeth)) => teeth.before(teeth.next_edge(self.coordinates[teeth.coordinate].angle)).0,
            Some(variation) => variation.over(link.stiffness, 0.0, 1e-6, 0).0[0],
        }
    }
}
