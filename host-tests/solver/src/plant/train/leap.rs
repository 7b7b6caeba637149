//! Linear trains without events: a whole tick at once by the matrix exponential, however stiff the train.

use super::series::ZERO;
use super::{Source, Train};
use crate::plant::dense::Dense;
use crate::plant::exponential::Propagator;

/// Steps kept; a run of one tick length needs one.
const KEPT: usize = 4;

/// `x' = A x + B f` of a linear train: elongations, speeds, angles; `f` the torques on the coordinates.
#[derive(Debug, Clone)]
pub(super) struct Leap {
    a: Dense,
    b: Dense,
    weights: Vec<f64>,
    rate: f64,
    steps: Vec<Propagator>,
    last: f64,
}

impl Leap {
    /// None for a train with events, or with torques or stiffnesses that are not linear in state and time.
    pub fn of(train: &Train, rate: f64) -> Option<Self> {
        let linear = |source: &Source| match source {
            Source::Constant(_) | Source::Program(_) | Source::Line { .. } => true,
            Source::Starting { power, .. } => *power == 1,
            _ => false,
        };
        let coordinates =
            train.coordinates.iter().all(|c| !c.is_cranked() && c.gear.is_none() && c.sources.iter().all(linear));
        let links = train.links.iter().all(|l| l.is_linear() && l.variation.is_none() && !l.is_lossy());
        if !(coordinates && links && train.frictions.is_empty() && train.unbalances.is_empty()) {
            return None;
        }
        let (links, n) = (train.links.len(), train.coordinates.len());
        let size = links + 2 * n;
        let (mut a, mut b) = (Dense::zeros(size, size), Dense::zeros(size, n));
        let mut weights = vec![1.0; size];
        for (l, link) in train.links.iter().enumerate() {
            if link.stiffness > 0.0 {
                weights[l] = link.stiffness.sqrt();
            }
            for &(at, share) in &link.terms {
                let inertia = train.coordinates[at].inertia;
                a.set(l, links + at, share);
                a.add(links + at, l, -share * link.stiffness / inertia);
                for &(other, c) in &link.terms {
                    a.add(links + at, links + other, -share * c * link.damping / inertia);
                }
            }
        }
        for (j, coordinate) in train.coordinates.iter().enumerate() {
            let slope = |source: &Source| if let Source::Line { slope, .. } = source { *slope } else { 0.0 };
            let fall = coordinate.viscous + coordinate.sources.iter().map(slope).sum::<f64>();
            a.add(links + j, links + j, -fall / coordinate.inertia);
            a.set(links + n + j, links + j, 1.0);
            b.set(links + j, j, 1.0 / coordinate.inertia);
            weights[links + j] = coordinate.inertia.sqrt();
            weights[links + n + j] = weights[links + j] * rate.max(1.0);
        }
        Some(Self { a, b, weights, rate, steps: Vec::new(), last: 0.0 })
    }

    /// The state after a step from a time, with no corner of a torque on the way. The matrices are made when the same
    /// length is used a second time running; none until then.
    pub fn step(&mut self, train: &Train, x: &[f64], held: &[f64], t: f64, length: f64) -> Option<Vec<f64>> {
        let again = self.last == length;
        self.last = length;
        let index = match self.steps.iter().position(|kept| kept.step == length) {
            Some(index) => index,
            None if again => {
                if self.steps.len() == KEPT {
                    self.steps.remove(0);
                }
                self.steps.push(Propagator::new(&self.a, &self.b, &self.weights, self.rate, length));
                self.steps.len() - 1
            }
            None => return None,
        };
        let (mut torque, mut rise) = (held.to_vec(), vec![0.0; held.len()]);
        for (j, coordinate) in train.coordinates.iter().enumerate() {
            for source in &coordinate.sources {
                let mut series = ZERO;
                source.add_over(&mut series, t, length, false);
                if let Source::Line { stall, .. } = source {
                    series[0] += stall;
                }
                torque[j] += series[0];
                rise[j] += series[1] / length;
            }
        }
        let mut out = vec![0.0; x.len()];
        self.steps[index].apply(x, &torque, &rise, true, &mut out);
        Some(out)
    }
}
