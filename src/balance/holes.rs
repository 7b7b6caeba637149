//! Weights for real holes: what is at hand, where there is room for it, and what that leaves.

use super::grid::pick;
use super::real::{Complex, Real, real, size, zero};
use super::refusal::Refusal;

/// Whether weight is screwed on or drilled out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mode {
    /// Weight is put where it is wanted.
    #[default]
    Adding,
    /// Weight is taken off on the other side.
    Removing,
}

/// The holes of a plane and the weights for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Holes<'a, T> {
    /// Angles of the holes \[rad\].
    pub angles: &'a [T],
    /// Weights that a hole can take, any of them as often as wanted, in the unit of the weights; none is always there.
    pub weights: &'a [T],
    /// Whether weight is added or removed.
    pub mode: Mode,
}

/// What goes where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted<T: Real> {
    /// Two holes, by their places in [`Holes::angles`], and the weight in each; a weight of zero is none.
    pub holes: [(usize, T); 2],
    /// The weight that they make together, as if it were added.
    pub sum: Complex<T>,
}

impl<T: Real> Holes<'_, T> {
    /// The two holes and weights that come nearest to a weight; of more than four holes, two within a quarter turn.
    ///
    /// # Errors
    /// [`Refusal::NothingToFit`]; [`Refusal::Setting`] with the place of a weight that is not positive or an angle that is no number;
    /// [`Refusal::TooHeavy`] (of plane 0) where even the heaviest weights in the best holes leave more than half.
    pub fn fit(&self, wanted: Complex<T>) -> Result<Fitted<T>, Refusal> {
        if self.angles.is_empty() || self.weights.is_empty() {
            return Err(Refusal::NothingToFit);
        }
        if let Some(index) = self.weights.iter().position(|weight| !(*weight > T::zero() && weight.is_finite())) {
            return Err(Refusal::Setting { index });
        }
        if let Some(index) = self.angles.iter().position(|angle| !angle.is_finite()) {
            return Err(Refusal::Setting { index });
        }
        let target = match self.mode {
            Mode::Adding => wanted,
            Mode::Removing => -wanted,
        };
        let mut best = Fitted { holes: [(0, T::zero()); 2], sum: zero() };
        let mut off = size(target);
        let mut consider = |holes: [(usize, T); 2]| {
            let sum = holes.iter().fold(zero(), |sum, (hole, weight)| sum + self.way(*hole).scale(*weight));
            let left = size(target - sum);
            if left < off {
                (off, best) = (left, Fitted { holes, sum });
            }
        };
        for (first, _) in self.angles.iter().enumerate() {
            let along = self.way(first);
            for weight in self.near((target * along.conj()).re) {
                consider([(first, weight), (first, T::zero())]);
            }
            for second in first + 1..self.angles.len() {
                let other = self.way(second);
                // target = x along + y other
                let across = along.re * other.im - along.im * other.re;
                // Holes further apart than a quarter turn pull against each other; only where there are few it takes them.
                let apart = along.re * other.re + along.im * other.im < real(-1e-6) && self.angles.len() > 4;
                if apart || across.abs() < real(1e-6) {
                    continue;
                }
                let x = (target.re * other.im - target.im * other.re) / across;
                for weight in self.near(x) {
                    // the second hole makes the best of what the first leaves
                    let left = target - along.scale(weight);
                    for more in self.near((left * other.conj()).re) {
                        consider([(first, weight), (second, more)]);
                    }
                }
            }
        }
        if off > size(target) * real(0.5) && size(target) > self.heaviest() {
            return Err(Refusal::TooHeavy { plane: 0 });
        }
        if self.mode == Mode::Removing {
            best.sum = -best.sum;
        }
        Ok(best)
    }

    /// Cosine and sine of a hole's angle.
    fn way(&self, hole: usize) -> Complex<T> {
        let (sine, cosine) = pick(self.angles, hole, T::zero()).sin_cos();
        Complex { re: cosine, im: sine }
    }

    fn heaviest(&self) -> T {
        self.weights.iter().fold(T::zero(), |most, weight| most.max(*weight))
    }

    /// No weight, the next below and the next above.
    fn near(&self, wanted: T) -> [T; 3] {
        let below =
            self.weights.iter().filter(|weight| **weight <= wanted).fold(T::zero(), |most, weight| most.max(*weight));
        let heaviest = self.heaviest();
        let above =
            self.weights.iter().filter(|weight| **weight >= wanted).fold(heaviest, |least, weight| least.min(*weight));
        [T::zero(), below, above]
    }
}
