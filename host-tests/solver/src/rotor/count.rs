//! How many natural motions there are, which shows whether some are missing.
//!
//! Undamped motions by Sylvester's law of inertia: of `K + i w C - w^2 B`, Hermitian then, each motion below `w` has
//! made one eigenvalue negative. Damped ones by the argument principle: the determinant turns once about each.

use nalgebra::Complex;

use super::band::Band;
use super::pencil::{Eigenvalues, Pencil};

/// Change of a phase (rad) on either half between two points of a contour, up to which no turn is hidden.
const STEP: f64 = 0.6;
/// Halvings of a side of a contour before a motion counts as being on it.
const HALVINGS: usize = 24;

impl<T: Eigenvalues> Pencil<'_, T> {
    /// Whether it is Hermitian at imaginary values: undamped.
    fn conservative(&self) -> bool {
        let (n, half) = self.stiffness.shape();
        let pairs = (0..n).flat_map(|i| (i.saturating_sub(half)..=i).map(move |j| (i, j)));
        pairs.into_iter().all(|(i, j)| {
            self.stiffness.get(i, j) == self.stiffness.get(j, i).conjugate()
                && self.damping.get(i, j) == -self.damping.get(j, i).conjugate()
        })
    }

    /// Number of motions of a frequency below `top` (rad/s), a damping ratio below `decay` and a growth below `top`;
    /// `None` where it cannot be told.
    ///
    /// Undamped by Sylvester's law. Damped by the turns of the determinant around them, over that of the undamped
    /// motions at rest: far values turn both alike. Decays that are `known` are divided out: many are close together,
    /// and just outside.
    pub fn count(&self, top: f64, decay: f64, known: &[Complex<f64>]) -> Option<usize> {
        let up = Complex::new(0.0, top);
        if self.conservative() {
            return self.at(up).negative();
        }
        let (n, half) = self.stiffness.shape();
        let (spring, mass) = (self.spring(), self.mass());
        let at_rest = |value: Complex<f64>| {
            Band::new(n, half, |i, j| spring.get(i, j).complex() + value * value * mass.get(i, j).complex())
        };
        let decays = || known.iter().filter(|value| -value.re > 0.5 * (1.0 + decay) * value.norm());
        let phase = |value: Complex<f64>| {
            let turned = self.at(value).factors().phase() * at_rest(value).factors().phase().conj();
            decays().fold(turned, |turned, decay| turned * ((value - decay).conj() / (value - decay).norm()))
        };
        // the lowest decay that counts, and points beside it that are closer together than it is away from the others
        let left = -top * decay / (1.0 - decay * decay).sqrt();
        let share = |k: i32| f64::from(k) / 24.0;
        let mut over: Vec<f64> = (0..=24).map(|k| left * share(k).powi(2)).collect();
        over.extend((1..=4).map(|k| top * f64::from(k) / 4.0));
        over.extend(known.iter().map(|value| value.re).filter(|&re| re > left && re < top));
        over.sort_by(|a, b| b.total_cmp(a));
        let mut points: Vec<Complex<f64>> = (0..4).map(|k| Complex::from(top * f64::from(k) / 4.0)).collect();
        points.extend((0..4).map(|k| Complex::new(top, top * f64::from(k) / 4.0)));
        points.extend(over.into_iter().map(|re| Complex::new(re, top)));
        let lowest = known.iter().map(|value| value.norm()).fold(top, f64::min) / left.hypot(top);
        let halves = std::iter::successors(Some(0.5 * share(1).powi(2)), |share| Some(0.5 * share));
        let below = halves.take_while(|&share| share > 0.1 * lowest).chain([0.0]);
        points
            .extend((1..24).rev().map(|k| share(k).powi(2)).chain(below).map(|share| Complex::new(left, top) * share));
        let points: Vec<_> = points.into_iter().map(|value| (value, phase(value))).collect();
        let sides = points.windows(2).map(|ends| turn(&phase, ends[0], ends[1], HALVINGS));
        let turned: f64 = sides.sum::<Option<f64>>()?;
        let turns = turned / std::f64::consts::TAU;
        // whole but for rounding
        let number = at_rest(up).negative()? as f64 + turns.round();
        ((turns - turns.round()).abs() < 1e-3 && number >= 0.0).then_some(number as usize)
    }
}

/// Phase by which a function turns between two points.
fn turn(
    phase: &impl Fn(Complex<f64>) -> Complex<f64>,
    from: (Complex<f64>, Complex<f64>),
    to: (Complex<f64>, Complex<f64>),
    halvings: usize,
) -> Option<f64> {
    let middle = (from.0 + to.0) * 0.5;
    let middle = (middle, phase(middle));
    let [first, second] = [(from, middle), (middle, to)].map(|(a, b)| (b.1 * a.1.conj()).arg());
    if first.abs() <= STEP && second.abs() <= STEP {
        return Some(first + second);
    }
    let halvings = halvings.checked_sub(1)?;
    Some(turn(phase, from, middle, halvings)? + turn(phase, middle, to, halvings)?)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use crate::noise::Noise;
    use crate::rotor::count::*;

    /// Chains of six masses with dampers from next to nothing to locks, and skew coupling: the eigenvalues of the
    /// whole first-order equations by another algorithm.
    #[test]
    fn motions_are_counted_as_all_eigenvalues_are() {
        let mut noise = Noise::new(4);
        let mut missing = 0;
        for round in 0..200 {
            let mut random = |low: f64, high: f64| 10_f64.powf(low + (high - low) * (0.5 + 0.5 * noise.uniform()));
            let (strong, turning) = ([-4.0, 0.0, 5.0][round % 3], if round % 2 == 0 { 0.0 } else { 1.0 });
            let springs: Vec<f64> = (0..7).map(|_| random(-1.0, 1.0)).collect();
            let masses: Vec<f64> = (0..6).map(|_| random(-0.5, 0.5)).collect();
            let dampers: Vec<f64> =
                (0..6).map(|k| if k % 3 == 0 { random(strong - 1.0, strong) } else { 0.0 }).collect();
            let stiffness = |i: usize, j: usize| match i.abs_diff(j) {
                0 => springs[i] + springs[i + 1],
                1 => -springs[i.max(j)],
                _ => 0.0,
            };
            let mass = |i: usize, j: usize| if i == j { masses[i] } else { 0.0 };
            let damping = |i: usize, j: usize| match j.abs_diff(i) {
                0 => dampers[i],
                1 => turning * if i < j { 1.0 } else { -1.0 },
                _ => 0.0,
            };
            let first_order = DMatrix::from_fn(12, 12, |i, j| match (i < 6, j < 6) {
                (true, _) => f64::from(j == i + 6),
                (false, true) => -stiffness(i - 6, j) / masses[i - 6],
                (false, false) => -damping(i - 6, j - 6) / masses[i - 6],
            });
            let all = first_order.complex_eigenvalues();
            let pencil = Pencil {
                stiffness: Band::new(6, 1, stiffness),
                damping: Band::new(6, 1, damping),
                inertia: Band::new(6, 1, mass),
                strains: &[],
                symmetric: false,
            };
            for top in [0.3, 1.0, 2.0, 5.0] {
                let counts =
                    |value: &&Complex<f64>| value.im > 1e-6 && value.im < top && -value.re < 0.999 * value.norm();
                let expected = all.iter().filter(counts).count();
                let decays: Vec<Complex<f64>> = all.iter().filter(|value| value.im == 0.0).copied().collect();
                let found = pencil.count(top, 0.999, &decays);
                assert!(found.is_none_or(|found| found == expected), "{round} {top}: {found:?} {expected} {all}");
                missing += usize::from(found.is_none());
            }
        }
        // a motion on the contour is no count; few are
        assert!(missing <= 8, "{missing}");
    }
}
