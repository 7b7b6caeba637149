//! Natural motions `q exp(lambda t)` of `(K + lambda C + lambda^2 B) q = 0`: the smallest `lambda`.
//!
//! Their inverses are the largest eigenvalues of `(q, v) -> (-K^-1 (C q + B v), q)`, `v = lambda q`: Arnoldi's method
//! finds them with a factor of `K` alone. Its vectors are `(L^T q, N^T v)` of `K = L L^T` and `M = N N^T`, whose length
//! is the energy: undamped the operator is skew then, and soft bearings cost no digits. Each is then refined by the
//! quotient of a left and a right vector, whose error is the product of theirs, with the strain energy summed part by
//! part: of neighbouring nodes that move almost alike the assembled stiffness has lost digits. A motion counts if that
//! error and rounding are small for certain. Whether some are missing shows the argument of the determinant around them.

use nalgebra::{Complex, ComplexField, DMatrix};

use super::band::Band;

/// A product of two deflections in the strain energy: stiffness (N/m, or N m), and both by coordinates.
#[derive(Clone, Debug)]
pub(super) struct Strain {
    pub stiffness: f64,
    pub force: Vec<(usize, f64)>,
    pub motion: Vec<(usize, f64)>,
}

/// A natural motion.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub value: Complex<f64>,
    pub shape: Vec<Complex<f64>>,
}

/// What was found.
pub(super) struct Found {
    /// The wanted motions that are proven.
    pub motions: Vec<Motion>,
    /// Whether all that were wanted are proven.
    pub whole: bool,
    /// Values near to those of the lowest motions, decays among them.
    pub values: Vec<Complex<f64>>,
}

/// Motions in one block: twice in number are those of a round rotor.
const BLOCK: usize = 2;
/// Part of its length that a vector must keep beside the others to count.
const NEW: f64 = 1e-12;
/// What Arnoldi's method leaves of a motion, over its eigenvalue.
const CONVERGED: f64 = 1e-8;
/// Error of an eigenvalue, over its size, up to which a motion is proven. The bound takes all roundings for one sign.
const PROVEN: f64 = 1e-6;
/// The same of what the vectors leave, with which refinement ends.
const REFINED: f64 = 1e-14;
/// Cosine of the angle between two motions that are one.
const SAME: f64 = 1.0 - 1e-6;

/// The matrices.
pub(super) struct Pencil<'a, T> {
    pub stiffness: Band<T>,
    pub damping: Band<T>,
    pub inertia: Band<T>,
    pub strains: &'a [Strain],
    /// Whether the stiffness counts by its symmetric part.
    pub symmetric: bool,
}

/// Eigenvalues of a small matrix.
pub(super) trait Eigenvalues: ComplexField<RealField = f64> + Copy {
    fn eigenvalues(matrix: DMatrix<Self>) -> Vec<Complex<f64>>;
    fn complex(self) -> Complex<f64>;
}

impl Eigenvalues for f64 {
    fn eigenvalues(matrix: DMatrix<f64>) -> Vec<Complex<f64>> {
        matrix.complex_eigenvalues().iter().copied().collect()
    }

    fn complex(self) -> Complex<f64> {
        Complex::new(self, 0.0)
    }
}

impl Eigenvalues for Complex<f64> {
    fn eigenvalues(matrix: DMatrix<Complex<f64>>) -> Vec<Complex<f64>> {
        matrix.schur().unpack().1.diagonal().iter().copied().collect()
    }

    fn complex(self) -> Complex<f64> {
        self
    }
}

/// Inner product, the first one conjugate.
fn inner<T: ComplexField + Copy>(a: &[T], b: &[T]) -> T {
    // four sums, of which none waits for another
    let (mut sums, whole) = ([T::zero(); 4], a.len() - a.len() % 4);
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, &b))| *sum += a.conjugate() * b);
    }
    let rest = a[whole..].iter().zip(&b[whole..]).fold(T::zero(), |sum, (a, &b)| sum + a.conjugate() * b);
    sums.into_iter().fold(rest, |sum, part| sum + part)
}

fn length<T: ComplexField<RealField = f64> + Copy>(a: &[T]) -> f64 {
    a.iter().map(|a| a.modulus_squared()).sum::<f64>().sqrt()
}

/// Numbers without a pattern between -1 and 1 (Weyl's sequence).
fn scattered<T: ComplexField<RealField = f64>>(size: usize, seed: usize) -> Vec<T> {
    let number =
        |k: usize| ((k + 1) as f64 * (0.618_033_988_749_894_9 + seed as f64 * 0.414_213_562_373_095_1)).fract();
    (0..size).map(|k| T::from_real(2.0 * number(k) - 1.0)).collect()
}

/// The basis of Arnoldi's method, which grows.
struct Basis<T> {
    vectors: Vec<Vec<T>>,
    /// What the operator makes of each vector, over the vectors.
    columns: Vec<Vec<T>>,
    dimension: usize,
}

impl<T: Eigenvalues> Basis<T> {
    fn new(dimension: usize) -> Self {
        let mut basis = Basis { vectors: Vec::new(), columns: Vec::new(), dimension };
        (0..BLOCK).for_each(|_| basis.fill());
        basis
    }

    /// Takes all vectors out of one; their shares.
    fn orthogonalise(&self, x: &mut [T]) -> Vec<T> {
        let mut shares = vec![T::zero(); self.vectors.len()];
        for _ in 0..2 {
            for (share, vector) in shares.iter_mut().zip(&self.vectors) {
                let part = inner(vector, x);
                *share += part;
                x.iter_mut().zip(vector).for_each(|(x, &v)| *x -= part * v);
            }
        }
        shares
    }

    /// A new vector without a pattern.
    fn fill(&mut self) {
        let full = self.vectors.len() >= self.dimension;
        for seed in 0..if full { 0 } else { 4 } {
            let mut x = scattered(self.dimension, 4 * self.vectors.len() + seed);
            let before = length(&x);
            self.orthogonalise(&mut x);
            let left = length(&x);
            if left > 1e-6 * before {
                x.iter_mut().for_each(|x| *x = x.unscale(left));
                return self.vectors.push(x);
            }
        }
    }

    /// Grows to so many columns.
    fn grow(&mut self, count: usize, operator: &impl Fn(&[T]) -> Vec<T>) {
        while self.columns.len() < count.min(self.vectors.len()) {
            let mut x = operator(&self.vectors[self.columns.len()]);
            let before = length(&x);
            let mut shares = self.orthogonalise(&mut x);
            let left = length(&x);
            if left > NEW * before && self.vectors.len() < self.dimension {
                x.iter_mut().for_each(|x| *x = x.unscale(left));
                shares.push(T::from_real(left));
                self.vectors.push(x);
            } else {
                self.fill();
            }
            self.columns.push(shares);
        }
    }

    /// The operator in the basis, with the rows of what leads out of it.
    fn matrix(&self) -> DMatrix<T> {
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied().unwrap_or_else(T::zero);
        DMatrix::from_fn(self.vectors.len(), self.columns.len(), entry)
    }

    /// Eigenvector in the basis, and what leads out of it.
    fn vector(&self, matrix: &DMatrix<T>, value: Complex<f64>, seed: usize) -> Option<(Vec<Complex<f64>>, f64)> {
        let m = matrix.ncols();
        let beside = value * Complex::new(1.0 + 1e-11, 1e-11);
        let row = |i: usize| (0..m).map(move |j| matrix[(i, j)].complex() - if i == j { beside } else { 0.0.into() });
        let mut rows: Vec<Vec<Complex<f64>>> = (0..m).map(|i| row(i).collect()).collect();
        // a column ends a block below the diagonal
        let below = |k: usize| k + 1..(k + 1 + BLOCK).min(m);
        let mut steps = Vec::with_capacity(m);
        for k in 0..m {
            let larger = |best: usize, i: usize| if rows[i][k].l1_norm() > rows[best][k].l1_norm() { i } else { best };
            let pivot = below(k).fold(k, larger);
            rows.swap(k, pivot);
            let (upper, lower) = rows.split_at_mut(k + 1);
            let mut factors = [Complex::new(0.0, 0.0); BLOCK];
            for (factor, row) in factors.iter_mut().zip(lower) {
                *factor = row[k] / upper[k][k];
                row[k..].iter_mut().zip(&upper[k][k..]).for_each(|(entry, above)| *entry -= *factor * above);
            }
            steps.push((pivot, factors));
        }
        let mut y = scattered::<Complex<f64>>(m, seed);
        for _ in 0..2 {
            for (k, (pivot, factors)) in steps.iter().enumerate() {
                y.swap(k, *pivot);
                let known = y[k];
                below(k).zip(factors).for_each(|(i, factor)| y[i] -= factor * known);
            }
            for k in (0..m).rev() {
                let known: Complex<f64> = rows[k][k + 1..].iter().zip(&y[k + 1..]).map(|(a, y)| a * y).sum();
                y[k] = (y[k] - known) / rows[k][k];
            }
            let size = length(&y);
            if !size.is_finite() {
                return None;
            }
            y.iter_mut().for_each(|y| *y /= size);
        }
        let out = (m..matrix.nrows()).map(|i| (0..m).map(|j| matrix[(i, j)].complex() * y[j]).sum::<Complex<f64>>());
        let out = out.map(|part| part.norm_sqr()).sum::<f64>().sqrt();
        Some((y, out))
    }
}

impl<T: Eigenvalues> Pencil<'_, T> {
    /// The natural motions that are wanted, in any order. `wanted` picks them of all values that are known so far, or
    /// says that they are too few (`None`); the last call takes what there is.
    pub fn motions(&self, wanted: impl Fn(&[Complex<f64>], bool) -> Option<Vec<usize>>) -> Found {
        let (n, half) = self.stiffness.shape();
        let (Some(spring), Some(mass)) = (self.spring().positive(), self.mass().positive()) else {
            return Found { motions: Vec::new(), whole: false, values: Vec::new() };
        };
        let circulatory = (0..n).any(|i| {
            let across = i.saturating_sub(half)..i;
            across.into_iter().any(|j| self.stiffness.get(i, j) != self.stiffness.get(j, i).conjugate())
        });
        let whole = circulatory.then(|| self.stiffness.clone().factors());
        let operator = |x: &[T]| {
            let (z, w) = x.split_at(n);
            let (q, v) = (spring.half_adjoint(z.to_vec()), mass.half_adjoint(w.to_vec()));
            let pairs = self.damping.times(&q).into_iter().zip(self.inertia.times(&v));
            let force = pairs.map(|(c, b)| -(c + b)).collect();
            let mut image = match &whole {
                Some(whole) => spring.half_times(&whole.solve(force)),
                None => spring.half(force),
            };
            image.extend(mass.half_times(&q));
            image
        };
        let dimension = 2 * n;
        let mut basis = Basis::new(dimension);
        let mut size = 48;
        loop {
            basis.grow(size, &operator);
            let matrix = basis.matrix();
            let m = matrix.ncols();
            let last = m >= dimension || m >= 480;
            let values: Vec<Complex<f64>> = T::eigenvalues(matrix.rows(0, m).into_owned())
                .into_iter()
                .filter(|value| value.norm() > 0.0)
                .map(|value| value.inv())
                .collect();
            let mut chosen = wanted(&values, last).unwrap_or_default();
            // the largest settle last
            chosen.sort_by(|&a, &b| values[b].norm().total_cmp(&values[a].norm()));
            let (mut found, mut settled) = (Vec::new(), !chosen.is_empty());
            for &k in &chosen {
                if !(last || settled) {
                    break;
                }
                let pair = basis.vector(&matrix, values[k].inv(), k);
                settled &= pair.as_ref().is_some_and(|(_, out)| out * values[k].norm() <= CONVERGED);
                found.push((values[k], pair));
            }
            if last || settled {
                let complex = self.spring();
                let complex = Band::new(n, half, |i, j| complex.get(i, j).complex()).positive();
                let refined = found.into_iter().map(|(value, pair)| {
                    let mut shape = vec![Complex::new(0.0, 0.0); n];
                    for (share, vector) in pair?.0.into_iter().zip(&basis.vectors) {
                        shape.iter_mut().zip(vector).for_each(|(shape, v)| *shape += share * v.complex());
                    }
                    self.refined(value, complex.as_ref()?.half_adjoint(shape))
                });
                let refined: Vec<Option<Motion>> = refined.collect();
                let whole = refined.iter().all(Option::is_some);
                return Found { motions: apart(refined.into_iter().flatten()), whole, values };
            }
            size += size / 3;
        }
    }

    /// The symmetric part of the stiffness.
    pub(super) fn spring(&self) -> Band<T> {
        let (n, half) = self.stiffness.shape();
        Band::new(n, half, |i, j| (self.stiffness.get(i, j) + self.stiffness.get(j, i).conjugate()).scale(0.5))
    }

    /// The inertia without what the spin makes of it.
    pub(super) fn mass(&self) -> Band<T> {
        let (n, half) = self.inertia.shape();
        Band::new(n, half, |i, j| T::from_real(self.inertia.get(i, j).real()))
    }

    pub(super) fn at(&self, value: Complex<f64>) -> Band<Complex<f64>> {
        let (n, half) = self.stiffness.shape();
        let square = value * value;
        Band::new(n, half, |i, j| {
            let [k, c, b] = [&self.stiffness, &self.damping, &self.inertia].map(|band| band.get(i, j).complex());
            k + value * c + square * b
        })
    }

    /// `y^H K q`, part by part, and its rounding.
    fn strain(&self, y: &[Complex<f64>], q: &[Complex<f64>]) -> (Complex<f64>, f64) {
        let along = |row: &[(usize, f64)], x: &[Complex<f64>]| {
            let parts = row.iter().map(|&(at, share)| x[at] * share);
            parts.fold((Complex::new(0.0, 0.0), 0.0), |(sum, size), part| (sum + part, size + part.norm()))
        };
        let product = |force: &[(usize, f64)], motion: &[(usize, f64)]| {
            let ((a, a_size), (b, b_size)) = (along(force, y), along(motion, q));
            (a.conj() * b, a_size * b.norm() + a.norm() * b_size)
        };
        let part = |Strain { stiffness, force, motion }: &Strain| {
            let (straight, rounding) = product(force, motion);
            let (across, other) = if self.symmetric { product(motion, force) } else { (straight, rounding) };
            ((straight + across) * 0.5 * *stiffness, (rounding + other) * 0.5 * stiffness.abs() * f64::EPSILON)
        };
        let zero = (Complex::new(0.0, 0.0), 0.0);
        self.strains.iter().map(part).fold(zero, |sum, part| (sum.0 + part.0, sum.1 + part.1))
    }

    /// The root nearest to a value of the scalar equation that two vectors make of the pencil; the equation's slope
    /// there, times the root; and its rounding.
    fn quotient(&self, y: &[Complex<f64>], q: &[Complex<f64>], near: Complex<f64>) -> (Complex<f64>, f64, f64) {
        let form = |band: &Band<T>| {
            let (n, half) = band.shape();
            let places = (0..n).flat_map(|i| (i.saturating_sub(half)..(i + half + 1).min(n)).map(move |j| (i, j)));
            places.fold((Complex::new(0.0, 0.0), 0.0), |(sum, size), (i, j)| {
                let part = y[i].conj() * band.get(i, j).complex() * q[j];
                (sum + part, size + part.l1_norm())
            })
        };
        let ((a, a_size), (b, b_size), (c, c_rounding)) = (form(&self.inertia), form(&self.damping), self.strain(y, q));
        let root = (b * b - a * c * 4.0).sqrt();
        // without the difference of two numbers that are alike
        let sum = if (b.conj() * root).re >= 0.0 { b + root } else { b - root };
        let [one, other] = [-sum / (a * 2.0), -c * 2.0 / sum];
        let value = if (one - near).norm() < (other - near).norm() { one } else { other };
        let size = value.norm();
        let slope = (b + value * a * 2.0).norm() * size;
        (value, slope, c_rounding + f64::EPSILON * size * (b_size + size * a_size))
    }

    /// The motion near to one that is known about, if it is proven.
    ///
    /// To the first order the left vector takes the residual out of the quotient; what is left is the product of the
    /// residual and of the left vector's own error, `|change|^T |residual|` at most, over the slope.
    fn refined(&self, mut value: Complex<f64>, mut q: Vec<Complex<f64>>) -> Option<Motion> {
        let factors = self.at(value + Complex::from_polar(1e-4 * value.norm(), 0.7)).factors();
        let mut y = factors.solve_adjoint(q.clone());
        let mut best = f64::INFINITY;
        for _ in 0..6 {
            for x in [&mut q, &mut y] {
                let size = length(x);
                x.iter_mut().for_each(|x| *x /= size);
            }
            let (next, slope, rounding) = self.quotient(&y, &q, value);
            value = next;
            let at = self.at(value);
            let residual = at.times(&q);
            let left = factors.solve_adjoint(at.adjoint_times(&y));
            let rest: f64 = left.iter().zip(&residual).map(|(change, rest)| change.norm() * rest.norm()).sum();
            let error = (rest + rounding) / slope;
            if rest <= REFINED * slope || error >= best {
                best = best.min(error);
                break;
            }
            best = error;
            let right = factors.solve(residual);
            q.iter_mut().zip(right).for_each(|(q, change)| *q -= change);
            y.iter_mut().zip(left).for_each(|(y, change)| *y -= change);
        }
        (best <= PROVEN && value.re.is_finite() && value.im.is_finite()).then_some(Motion { value, shape: q })
    }
}

/// Without those that are another one again.
fn apart(motions: impl Iterator<Item = Motion>) -> Vec<Motion> {
    let mut kept: Vec<Motion> = Vec::new();
    for motion in motions {
        let again = |other: &Motion| {
            let near = (other.value - motion.value).norm() <= 1e-9 * motion.value.norm();
            near && inner(&other.shape, &motion.shape).norm() >= SAME * length(&other.shape) * length(&motion.shape)
        };
        if !kept.iter().any(again) {
            kept.push(motion);
        }
    }
    kept
}
