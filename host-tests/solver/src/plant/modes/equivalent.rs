//! A geared chain as a plain one, referred to its drive.

use super::system::{System, SystemError};

/// Inertias and stiffnesses of a chain, all referred to one shaft.
#[derive(Debug, Clone, PartialEq)]
pub struct EquivalentChain {
    /// kg m2.
    pub inertia: Vec<f64>,
    /// N m/rad, one fewer.
    pub stiffness: Vec<f64>,
}

impl System {
    /// The chain that keeps kinetic and strain energy, referred to `drive_node` at one end: inertias and stiffnesses
    /// times the square of their ratio of speeds `[Pfützner 1980 (1.10)]`.
    ///
    /// # Errors
    /// [`SystemError::NotAChain`] if shafts branch, close a loop, leave a disc out or lead to the ground; other
    /// variants name what is out of range.
    pub fn equivalent_chain(&self, drive_node: usize) -> Result<EquivalentChain, SystemError> {
        let reduced = self.reduce()?;
        let nodes = reduced.ties.len();
        let (mut at, ratio) = *reduced.ties.get(drive_node).ok_or(SystemError::NoSuchNode {
            element: "the drive",
            node: drive_node,
            nodes,
        })?;
        let broken = |coordinate: usize| SystemError::NotAChain { node: reduced.free[coordinate] };
        // angle of the coordinate per angle of the drive
        let mut speed = 1.0 / ratio;
        let mut left = reduced.links.clone();
        let mut chain = EquivalentChain { inertia: Vec::new(), stiffness: Vec::new() };
        loop {
            chain.inertia.push(reduced.inertia[at] * speed * speed);
            let touches = |link: &super::system::Link| link.from.0 == at || link.to.is_some_and(|to| to.0 == at);
            let mut next = (0..left.len()).filter(|&i| touches(&left[i]));
            let Some(index) = next.next() else { break };
            if next.next().is_some() {
                return Err(broken(at));
            }
            let link = left.swap_remove(index);
            let to = link.to.ok_or_else(|| broken(at))?;
            let (near, far) = if link.from.0 == at { (link.from, to) } else { (to, link.from) };
            let turn = near.1 * speed;
            chain.stiffness.push(link.stiffness * turn * turn);
            speed = turn / far.1;
            at = far.0;
        }
        let whole = chain.inertia.len() == reduced.inertia.len() && left.is_empty();
        if whole { Ok(chain) } else { Err(broken(at)) }
    }
}
