//! What a reading teaches.

use super::{BETTER, Complex, DEVIATIONS, InRun, Scalar, WALK, real, zero};

impl<T: Scalar, const ROWS: usize, const PLANES: usize> InRun<T, ROWS, PLANES> {
    /// Takes in what has changed since the last reading, and returns the level of the weights that it began with.
    pub(super) fn learn(&mut self, reading: &[Complex<T>], level: T, start: T, noise: T) -> T {
        let moved = core::mem::replace(&mut self.moved, [zero(); PLANES]);
        let still = moved.iter().all(|moved| *moved == zero());
        let predicted = self.estimate.largest_change(&moved);
        self.estimate.predict(&moved, noise * real(WALK));
        let innovation = self.estimate.innovation(reading, noise);
        let surprise = innovation.largest > innovation.deviation * real(DEVIATIONS);
        // what the readings change by themselves: all of it where nothing has moved, or what the prediction leaves
        let beyond = if still { innovation.largest * real(0.7) } else { innovation.largest - innovation.predicted };
        let largest = level.max(self.level);
        // a dead sensor reads zero twice
        let beyond = if largest > T::zero() { beyond.max(T::zero()) / largest } else { T::zero() };
        if surprise && self.estimate.confirmed() {
            self.failures += 1;
            self.stalled = 0;
            self.jumped = true;
            let wrong = innovation.largest > predicted * real(0.5) && level > self.level * real(0.9);
            if !still && wrong {
                // the influence may be wrong: it has to be confirmed again, from where it began
                let ratio = innovation.largest / innovation.deviation;
                // or it is a jump of the unbalance: then the weights that it began with have another level
                let least = start.min(self.estimate.level_from(reading, &self.back()));
                self.estimate.learn(&innovation);
                self.estimate.doubt(ratio * ratio);
                if level > least * real(BETTER) {
                    self.best = (start, self.rest);
                }
                return start;
            }
            // a jump of the unbalance: the influence stays
            self.estimate.restart(reading, noise);
            let start = self.at_rest().max(level / self.config.bound);
            self.start = Some(start);
            self.best = if level < start * real(BETTER) { (level, self.weights) } else { (start, self.rest) };
            return start;
        }
        let share = real::<T>(if self.scatter > T::zero() { 0.35 } else { 1.0 });
        let square = self.scatter * self.scatter * (T::one() - share) + beyond * beyond * share;
        self.scatter = square.sqrt();
        self.estimate.learn(&innovation);
        if surprise {
            self.failures += 1;
            self.scatter = self.scatter.max(beyond * real(0.5));
            let ratio = innovation.largest / (innovation.deviation * real(DEVIATIONS));
            self.estimate.doubt(real::<T>(4.0) * ratio * ratio);
        } else if !still {
            if self.estimate.confirmed() {
                self.failures = 0;
            }
            self.estimate.confirm(&moved, predicted, &innovation, self.config.forgetting);
        }
        start
    }
}
