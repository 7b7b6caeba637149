//! Stiffest part of a train: the part whose own rate is the fastest, against which every stretch has to be short.

use super::motion::Motion;
use crate::plant::Place;

/// The fastest part of a train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffest {
    /// The link, or the coordinate.
    pub place: Place,
    /// Which of its parameters: `stiffness`, `damping` or `viscous friction`.
    pub parameter: &'static str,
    /// Its value, as it stands.
    pub value: f64,
    /// Its rate, 1/s: that of a swing for a stiffness, that of a decay for a damping.
    pub rate: f64,
    /// The lightest coordinate that it moves.
    pub lightest: usize,
    /// The inertia or mass of that, kg m2 or kg.
    pub inertia: f64,
    /// The one further from the others of its kind: the parameter, or that inertia.
    pub odd: Place,
}

impl Motion {
    /// A bound of the rates of this train, 1/s. A run takes as many stretches as its length times this, by 1.5.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// The fastest part; none for a train without springs and dampers.
    #[must_use]
    pub fn stiffest(&self) -> Option<Stiffest> {
        let inertia = |at: usize| self.train.coordinates[at].inertia;
        let mut all = Vec::new();
        for (l, link) in self.train.links.iter().enumerate() {
            let shares = link.terms.iter().map(|&(at, share)| share * share / inertia(at)).sum::<f64>();
            let shares = shares / link.efficiency;
            let weight = |term: &&(usize, f64)| term.1 * term.1 / inertia(term.0);
            let lightest = link.terms.iter().max_by(|a, b| weight(a).total_cmp(&weight(b)));
            let Some(&(lightest, _)) = lightest else { continue };
            let part = |parameter, value, rate| Stiffest {
                place: Place::Shaft(l),
                parameter,
                value,
                rate,
                lightest,
                inertia: inertia(lightest),
                odd: Place::Shaft(l),
            };
            all.push(part("stiffness", link.stiffest(), (link.stiffest() * shares).sqrt()));
            all.push(part("damping", link.damping, link.damping * shares));
        }
        for (j, coordinate) in self.train.coordinates.iter().enumerate() {
            all.push(Stiffest {
                place: Place::Node(j),
                parameter: "viscous friction",
                value: coordinate.viscous,
                rate: coordinate.viscous / coordinate.inertia,
                lightest: j,
                inertia: coordinate.inertia,
                odd: Place::Node(j),
            });
        }
        let alike = |name| all.iter().filter(move |part| part.parameter == name).map(|part| part.value);
        let stiffest = all.iter().filter(|part| part.rate > 0.0).max_by(|a, b| a.rate.total_cmp(&b.rate))?;
        let usual_inertia = middle(self.train.coordinates.iter().map(|c| c.inertia));
        let lighter = usual_inertia / stiffest.inertia > stiffest.value / middle(alike(stiffest.parameter));
        Some(Stiffest { odd: if lighter { Place::Node(stiffest.lightest) } else { stiffest.odd }, ..*stiffest })
    }
}

/// The middle one of the values above zero, the lower of two.
fn middle(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.filter(|&value| value > 0.0).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied().unwrap_or(1.0)
}
