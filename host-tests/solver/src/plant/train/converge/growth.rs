//! How a small difference grows within a piece of a run, as the solver shows that runs it twice.

use super::{Motion, Run, Step, felt, sample, state};

/// The solver where a piece begins.
pub(super) struct Growth {
    motion: Motion,
    /// The first step of the piece.
    step: usize,
}

impl Growth {
    pub fn of(run: &Run) -> Self {
        Self { motion: run.start.clone(), step: 0 }
    }

    /// What the piece so far makes of a difference of 1e-13 at its begin, at most.
    pub fn until(&self, run: &Run, sizes: &[f64], last: usize) -> f64 {
        const SEED: f64 = 1e-13;
        let (mut one, mut other) = (self.motion.clone(), self.motion.clone());
        // what friction holds stays at rest
        let held = |j: usize| one.train.frictions.iter().any(|friction| friction.terms.iter().any(|term| term.0 == j));
        for (j, speed) in other.state.speed.iter_mut().enumerate() {
            if *speed != 0.0 || !held(j) {
                *speed += SEED * sizes[j];
            }
        }
        if !one.settled {
            let sizes = &sizes[one.coordinates()..];
            other.state.elongation.iter_mut().zip(sizes).for_each(|(elongation, size)| *elongation += SEED * size);
        }
        let mut largest = 0.0_f64;
        for step in &run.steps[self.step..=last] {
            let before = one.now;
            [&mut one, &mut other].into_iter().for_each(|motion| step.take(motion));
            if let Step::Advance(_) = step {
                largest = largest.max(run.apart([before, one.now], &sample(&one), &sample(&other), sizes));
            }
        }
        largest / SEED
    }

    /// Sizes to measure the first tick of the piece by, of `dt` s: an elongation gathers what its speeds are off by, and
    /// a force is off by what its elongation and its speeds make of it. [`Self::until`] sees none of that where all
    /// speeds are off by the same share.
    pub fn resolved(&self, sizes: &[f64], dt: f64) -> Vec<f64> {
        let (n, links) = (self.motion.coordinates(), &self.motion.train.links);
        let mut resolved = sizes.to_vec();
        for (l, link) in links.iter().enumerate() {
            let speed: f64 = link.terms.iter().map(|&(j, factor)| factor.abs() * sizes[j]).sum();
            let force = &mut resolved[n + links.len() + l];
            let elongation = felt(&self.motion, sizes, l) + speed * dt;
            *force = force.max(link.stiffest() * elongation + link.damping * speed);
            resolved[n + l] += speed * dt;
        }
        resolved
    }

    /// A new piece, at a step, in the state of the recording.
    pub fn begin(&mut self, run: &Run, step: usize, sample: &[f64]) {
        run.steps[self.step..step].iter().for_each(|step| step.take(&mut self.motion));
        self.motion.state = state(&self.motion, sample);
        self.step = step;
    }
}
