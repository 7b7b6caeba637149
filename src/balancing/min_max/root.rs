//! The triangle of a Hessian's root, and the rows that are rotated into it.

use nalgebra::ComplexField;

use crate::balancing::scalar::{Complex, Scalar};

/// Real and imaginary part of each weight, and the bound `t` of the residuals.
#[derive(Clone, Copy)]
pub(super) struct Wide<T, const PLANES: usize> {
    pub(super) weights: [[T; 2]; PLANES],
    pub(super) bound: T,
}

impl<T: Scalar, const PLANES: usize> Wide<T, PLANES> {
    pub(super) fn new() -> Self {
        Wide { weights: [[T::zero(); 2]; PLANES], bound: T::zero() }
    }

    pub(super) fn at(&self, index: usize) -> T {
        match self.weights.get(index / 2) {
            Some([re, im]) => {
                if index.is_multiple_of(2) {
                    *re
                } else {
                    *im
                }
            }
            None => self.bound,
        }
    }

    pub(super) fn at_mut(&mut self, index: usize) -> &mut T {
        match self.weights.get_mut(index / 2) {
            Some([re, im]) => {
                if index.is_multiple_of(2) {
                    re
                } else {
                    im
                }
            }
            None => &mut self.bound,
        }
    }
}

/// The triangle of the rows of a Hessian's root.
pub(super) struct Root<T, const PLANES: usize> {
    rows: [[Wide<T, PLANES>; 2]; PLANES],
    last: Wide<T, PLANES>,
}

impl<T: Scalar, const PLANES: usize> Root<T, PLANES> {
    pub(super) fn new() -> Self {
        Root { rows: [[Wide::new(); 2]; PLANES], last: Wide::new() }
    }

    fn row(&mut self, index: usize) -> &mut Wide<T, PLANES> {
        match self.rows.get_mut(index / 2) {
            Some([re, im]) => {
                if index.is_multiple_of(2) {
                    re
                } else {
                    im
                }
            }
            None => &mut self.last,
        }
    }

    /// Takes in a row; `free` are the indices in use.
    pub(super) fn absorb(&mut self, mut new: Wide<T, PLANES>, free: impl Iterator<Item = usize> + Clone) {
        let mut rest = free;
        while let Some(k) = rest.next() {
            let out = new.at(k);
            if out == T::zero() {
                continue;
            }
            let row = self.row(k);
            let radius = Complex { re: row.at(k), im: out }.modulus();
            let (c, s) = (row.at(k) / radius, out / radius);
            *row.at_mut(k) = radius;
            for j in rest.clone() {
                let (x, y) = (row.at(j), new.at(j));
                *row.at_mut(j) = c * x + s * y;
                *new.at_mut(j) = c * y - s * x;
            }
        }
    }

    /// `-H^-1 g` for `H = R^T R`, and the decrement, the root of `g^T H^-1 g`.
    pub(super) fn step(
        &mut self,
        gradient: &Wide<T, PLANES>,
        free: impl DoubleEndedIterator<Item = usize> + Clone,
    ) -> (Wide<T, PLANES>, T) {
        let mut y = Wide::<T, PLANES>::new();
        let mut square = T::zero();
        for k in free.clone() {
            let mut sum = -gradient.at(k);
            for j in free.clone().take_while(|&j| j < k) {
                sum -= self.row(j).at(k) * y.at(j);
            }
            let value = sum / self.row(k).at(k);
            *y.at_mut(k) = value;
            square += value * value;
        }
        let mut p = Wide::<T, PLANES>::new();
        for k in free.clone().rev() {
            let mut sum = y.at(k);
            for j in free.clone().rev().take_while(|&j| j > k) {
                sum -= self.row(k).at(j) * p.at(j);
            }
            *p.at_mut(k) = sum / self.row(k).at(k);
        }
        (p, square.sqrt())
    }
}

/// A sum of rows times factors.
pub(super) fn combined<T: Scalar, const PLANES: usize, const K: usize>(
    parts: [(T, Wide<T, PLANES>); K],
) -> Wide<T, PLANES> {
    let mut sum = Wide::new();
    for (factor, part) in parts {
        for index in 0..=2 * PLANES {
            *sum.at_mut(index) += factor * part.at(index);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balancing::scalar::noise::Noise;

    /// Rows go into the triangle, and the step solves its normal equations: seven rows of five numbers, some of them
    /// zero, with all of them in use and without the last.
    #[test]
    fn the_triangle_solves_its_normal_equations() {
        let mut noise = Noise::new(3);
        for used in [5, 4] {
            let mut root = Root::<f64, 2>::new();
            let mut hessian = [[0.0; 5]; 5];
            for row in 0..7 {
                let mut wide = Wide::new();
                for k in 0..5 {
                    *wide.at_mut(k) = if row % 3 == k % 3 { 0.0 } else { noise.even() };
                }
                for (i, line) in hessian.iter_mut().enumerate() {
                    for (j, value) in line.iter_mut().enumerate() {
                        *value += wide.at(i) * wide.at(j);
                    }
                }
                root.absorb(wide, 0..used);
            }
            let mut gradient = Wide::new();
            for k in 0..5 {
                *gradient.at_mut(k) = noise.even();
            }
            let (step, decrement) = root.step(&gradient, 0..used);
            let mut product = 0.0;
            for (k, line) in hessian.iter().enumerate().take(used) {
                let sum: f64 = line.iter().enumerate().take(used).map(|(j, value)| value * step.at(j)).sum();
                assert!((sum + gradient.at(k)).abs() < 1e-13, "{used}, {k}");
                product -= gradient.at(k) * step.at(k);
            }
            assert!((product.sqrt() / decrement - 1.0).abs() < 1e-12);
        }
    }
}
