//! The next move of the weights.

use super::super::matrix::{pick, put};
use super::{ALLOWED, AbortReason, Action, Complex, InRun, Scalar, WORTH, real, size, zero};

/// A move goes no farther from where it began than this times the farthest weight that was read. This, [`CERTAIN`],
/// `RESTED` and `RESTLESS` are tuned on seeds 1 to 300 of `never_harmful.rs`, and judged there on 501 to 1000.
const GROWTH: f64 = 2.5;
/// Growth times the influence's relative standard deviation, where that allows more.
const CERTAIN: f64 = 0.6;
/// Moves, for each plane, that may serve identification before the vibration is better.
const PROBES: u32 = 16;
/// Least share of a correction that is worth a move.
const LEAST_SHARE: f64 = 0.3;

impl<T: Scalar, const ROWS: usize, const PLANES: usize> InRun<T, ROWS, PLANES> {
    /// The next move: a correction where it cannot do harm, a probe where the influence is not known well enough.
    pub(super) fn correct(&mut self, start: T, noise: T) -> Action<T, PLANES> {
        let level = self.estimate.level();
        let correction = self.within(self.estimate.cautious());
        let mut probing = self.estimate.least_known();
        if probing.is_none() {
            let after = self.estimate.level_after(&correction);
            // not enough to be left there
            if self.weights == self.rest && after > start * real(WORTH) {
                (self.stalled, self.probes, self.failures) = (0, 0, 0);
                return Action::Hold;
            }
            // within the readings' error nothing is left to gain
            if level - after < noise {
                // weights that are not better beyond doubt are not left there: by the estimate, which a slow beat may
                // have led astray, and as measured
                let home = self.home();
                let better = self.at_rest() - level > noise + noise && self.level < start * real(WORTH);
                if better || self.weights == home {
                    (self.stalled, self.probes, self.failures) = (0, 0, 0);
                    return Action::Hold;
                }
                return self.go(home);
            }
            let correction = self.reachable(correction);
            let mut share = T::one();
            while self.estimate.expected(&correction, share) > level && share > real(LEAST_SHARE) {
                share *= real(0.8);
            }
            if share > real(LEAST_SHARE) {
                return self.move_by(&correction, share);
            }
            probing = (0..PLANES).max_by(|a, b| {
                let doubt = |plane: &usize| self.estimate.doubt_of(*plane);
                doubt(a).partial_cmp(&doubt(b)).unwrap_or(core::cmp::Ordering::Equal)
            });
        }
        let Some(plane) = probing else { return self.abort(AbortReason::Unidentified) };
        self.probes += 1;
        if self.probes > PROBES * PLANES as u32 {
            return self.abort(AbortReason::Unidentified);
        }
        // the first reading may have been a large one
        let start = start.min(self.at_rest());
        // learn by the largest move that is safe whichever way it goes: towards the correction where that is known
        // roughly, else on both sides of the weights that it began with
        let allowed = start * self.config.bound * real(ALLOWED);
        let mut step = [zero(); PLANES];
        let wanted = pick(&correction, plane, zero());
        if self.estimate.doubt_of(plane) < real(0.5) && size(wanted) > T::zero() && self.level <= start {
            let length = (allowed - level.max(self.level)).max(T::zero()) / self.estimate.most(plane);
            put(&mut step, plane, wanted.unscale(size(wanted)).scale(length));
        } else {
            let length = (allowed - start).max(T::zero()) / self.estimate.most(plane);
            let from = pick(&self.weights, plane, zero()) - pick(&self.rest, plane, zero());
            let ahead = Complex { re: T::one(), im: T::zero() };
            let way = if size(from) > T::zero() { -from.unscale(size(from)) } else { ahead };
            put(&mut step, plane, way.scale(length) - from);
        }
        let step = self.reachable(self.within(step));
        let mut share = T::one();
        for _ in 0..24 {
            if self.estimate.expected(&step, share) <= allowed {
                break;
            }
            share *= real(0.8);
        }
        self.move_by(&step, share)
    }

    /// A step within the limits of a move and of the heads.
    fn within(&self, mut step: [Complex<T>; PLANES]) -> [Complex<T>; PLANES] {
        for ((step, weight), limit) in step.iter_mut().zip(&self.weights).zip(&self.config.limits) {
            if size(*step) > self.config.step {
                *step = step.scale(self.config.step / size(*step));
            }
            let to = *weight + *step;
            if size(to) > *limit {
                *step = to.scale(*limit / size(to)) - *weight;
            }
        }
        step
    }

    /// A step no farther from where it began than what was read bears out.
    fn reachable(&self, mut step: [Complex<T>; PLANES]) -> [Complex<T>; PLANES] {
        for plane in 0..PLANES {
            let (weight, rest) = (pick(&self.weights, plane, zero()), pick(&self.rest, plane, zero()));
            let growth = real::<T>(GROWTH).max(real::<T>(CERTAIN) / self.estimate.doubt_of(plane));
            let (most, far) = (self.reach * growth, weight + pick(&step, plane, zero()) - rest);
            if self.reach > T::zero() && size(far) > most {
                put(&mut step, plane, far.scale(most / size(far)) + rest - weight);
            }
        }
        step
    }

    fn move_by(&mut self, step: &[Complex<T>; PLANES], share: T) -> Action<T, PLANES> {
        let mut to = self.weights;
        for (to, step) in to.iter_mut().zip(step) {
            *to += step.scale(share);
        }
        self.go(to)
    }
}
