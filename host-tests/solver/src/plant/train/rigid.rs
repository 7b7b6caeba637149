//! A train whose links are rigid: one body, seen from the coordinate that drives it.

use super::{Source, Train};

/// Share by which two ways round a loop may differ for its ratio to be one.
const LOOP: f64 = 1e-9;

/// A coordinate of a rigid train.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidPart {
    /// Its speed over that of the coordinate that drives.
    pub ratio: f64,
    /// Efficiency of the links between them, while that coordinate drives.
    pub efficiency: f64,
    /// kg m2 or kg.
    pub inertia: f64,
    /// At the start, rad/s or m/s.
    pub speed: f64,
    /// Its torques, friction included, while the driving coordinate moves forwards.
    pub torques: Vec<Source>,
    /// Torque that its friction takes at rest beyond that of `torques`, N m or N.
    pub breakaway: f64,
}

impl Train {
    /// The coordinates of the train as parts of one body that a coordinate drives, gaps and slack aside. None where
    /// they are not one: a coordinate that no link of two terms with a stiffness joins, a link to the ground or of
    /// several terms, a loop that is locked or loses power, a damper that slips, a gear that locks itself, friction
    /// against what moves, an unbalance, an inertia that changes with the angle, a gear without a shaft behind it.
    #[must_use]
    pub fn rigid(&self, driving: usize) -> Option<Vec<RigidPart>> {
        let mut ways = vec![None; self.coordinates.len()];
        *ways.get_mut(driving)? = Some((1.0, 1.0));
        // every pass reaches at least one coordinate more, or none for good
        for _ in 0..ways.len() {
            for link in &self.links {
                let &[(first, near), (second, far)] = &link.terms[..] else { return None };
                if link.stiffness == 0.0 {
                    continue;
                }
                // the first coordinate carries the losses of both directions
                let from_first = |(ratio, eta): (f64, f64)| (-ratio * near / far, eta * link.efficiency);
                let from_second = |(ratio, eta): (f64, f64)| (-ratio * far / near, eta * link.back_efficiency);
                match (ways[first], ways[second]) {
                    (Some(way), None) => ways[second] = Some(from_first(way)),
                    (None, Some(way)) => ways[first] = Some(from_second(way)),
                    _ => {}
                }
            }
        }
        let ways: Vec<(f64, f64)> = ways.into_iter().collect::<Option<_>>()?;
        let is_loop = self.links.iter().filter(|link| link.stiffness > 0.0).count() >= self.coordinates.len();
        let strains = |terms: &[(usize, f64)]| {
            let shares = terms.iter().map(|&(at, share)| share * ways[at].0);
            shares.clone().sum::<f64>().abs() > LOOP * shares.map(f64::abs).sum::<f64>()
        };
        let mut holding = self.links.iter().filter(|link| link.stiffness > 0.0 || link.damping > 0.0);
        let is_locked = holding.any(|link| strains(&link.terms) || is_loop && link.is_lossy());
        let rubs = self.frictions.iter().any(|friction| friction.terms.len() > 1 || friction.surface != 0.0);
        let changes = self.coordinates.iter().any(|c| c.is_cranked() || c.gear.is_some());
        if is_locked || rubs || changes || !self.unbalances.is_empty() || ways.iter().any(|way| way.1 <= 0.0) {
            return None;
        }
        let part = |(at, (coordinate, (ratio, efficiency))): (usize, (&super::Coordinate, (f64, f64)))| {
            let mut torques = coordinate.sources.clone();
            if coordinate.viscous > 0.0 {
                torques.push(Source::Line { stall: 0.0, slope: coordinate.viscous });
            }
            let on = self.frictions.iter().filter(|friction| friction.terms[0].0 == at);
            torques.extend(on.clone().map(|friction| Source::Constant(-friction.kinetic * ratio.signum())));
            let breakaway = on.map(|friction| friction.breakaway - friction.kinetic).sum();
            RigidPart { ratio, efficiency, inertia: coordinate.inertia, speed: coordinate.speed, torques, breakaway }
        };
        Some(self.coordinates.iter().zip(ways).enumerate().map(part).collect())
    }
}
