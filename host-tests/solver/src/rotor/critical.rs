//! Natural whirls over the speed, and where the unbalance meets them.

use nalgebra::{Complex, DMatrix, DVector, DVectorView, RowDVector};

use super::error::RotorError;
use super::modal::Modal;

/// Which way a whirl goes round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WhirlSense {
    /// With the spin.
    Forward,
    /// Against the spin.
    Backward,
    /// Along a line, or forward at some places and backward at others.
    Mixed,
}

/// A natural whirl at a speed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Natural {
    /// Damped frequency (rad/s).
    pub frequency: f64,
    /// Size of the eigenvalue (rad/s): the frequency without its damping.
    pub undamped: f64,
    /// Damping ratio; negative where the whirl grows.
    pub damping_ratio: f64,
    /// Sense.
    pub sense: WhirlSense,
}

/// Natural whirls at some speeds.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Campbell {
    /// Speeds (rad/s).
    pub speeds: Vec<f64>,
    /// The whirls at each speed, lowest first.
    pub whirls: Vec<Vec<Natural>>,
}

/// A critical speed without damping.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Critical {
    /// Speed (rad/s).
    pub speed: f64,
    /// Sense of the whirl. On supports that are alike in all directions unbalance excites forward whirls only.
    pub sense: WhirlSense,
}

/// Share of the larger of two circles that the smaller one may have before a motion counts as mixed.
const MIXED: f64 = 0.9;
/// Share of a critical speed within which others count as the same, far above rounding.
const ALIKE: f64 = 1e-6;

impl Modal {
    /// Critical speeds, lowest first: speeds at which the undamped rotor whirls once a turn. The stiffness counts by
    /// its symmetric part.
    ///
    /// From `(w^2 - Omega^2 (1 - i G)) eta = 0` of the whirl `exp(i Omega t)`: with `eta = zeta/w`, the positive
    /// eigenvalues of the Hermitian `(1 - i G)/(w w)` are `1/Omega^2`.
    #[must_use]
    pub fn criticals(&self) -> Vec<Critical> {
        self.synchronous().into_iter().map(|(critical, _)| critical).collect()
    }

    /// Critical speeds (rad/s) of the forward whirls, lowest first, each with the deflection at every station, the
    /// largest of which is 1: the shapes of modal balancing. On supports that are alike in all directions a whirl is
    /// round and in one plane, and these shapes are those in which unbalance bends the undamped rotor.
    #[must_use]
    pub fn forward_shapes(&self) -> Vec<(f64, Vec<f64>)> {
        let forward = self.synchronous().into_iter().filter(|(critical, _)| critical.sense == WhirlSense::Forward);
        let scaled = |(critical, shape): (Critical, DVector<Complex<f64>>)| {
            let whirls: Vec<Complex<f64>> = self.stations.iter().map(|rows| circles(rows, &shape)[0]).collect();
            let largest = whirls.iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm()));
            let largest = largest.unwrap_or(Complex::new(1.0, 0.0));
            (critical.speed, whirls.iter().map(|whirl| (whirl / largest).re).collect())
        };
        forward.map(scaled).collect()
    }

    /// Critical speeds, lowest first, with the deflections of their whirls.
    fn synchronous(&self) -> Vec<(Critical, DVector<Complex<f64>>)> {
        let r = self.count();
        let w = &self.frequency;
        let hermitian = DMatrix::from_fn(r, r, |i, j| {
            let unity = if i == j { 1.0 } else { 0.0 };
            // skew by its half, so that rounding leaves it Hermitian
            let skew = 0.5 * (self.gyroscopic[(i, j)] - self.gyroscopic[(j, i)]);
            Complex::new(unity, -skew) / (w[i] * w[j])
        });
        let eigen = hermitian.symmetric_eigen();
        let mut all: Vec<(f64, DVector<Complex<f64>>)> = (0..r)
            .filter(|&k| eigen.eigenvalues[k] > 0.0)
            .map(|k| {
                let shape = DVector::from_iterator(r, (0..r).map(|i| eigen.eigenvectors[(i, k)] / w[i]));
                (eigen.eigenvalues[k].sqrt().recip(), shape)
            })
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let groups = all.chunk_by(|a, b| b.0 - a.0 <= ALIKE * a.0);
        let shapes = groups.flat_map(|group| {
            let shapes: Vec<_> = group.iter().map(|(_, shape)| shape.clone()).collect();
            self.apart(&shapes)
        });
        let critical = |shape: DVector<Complex<f64>>, speed| (Critical { speed, sense: self.sense(&shape) }, shape);
        shapes.zip(all.iter().map(|(speed, _)| *speed)).map(|(shape, speed)| critical(shape, speed)).collect()
    }

    /// Whirls of one frequency, of which any combination is one: those that go round least forward, up to the most.
    fn apart(&self, shapes: &[DVector<Complex<f64>>]) -> Vec<DVector<Complex<f64>>> {
        let m = shapes.len();
        if m == 1 {
            return shapes.to_vec();
        }
        let mut forward = DMatrix::from_element(m, m, Complex::new(0.0, 0.0));
        for rows in &self.stations {
            let all: Vec<[Complex<f64>; 2]> = shapes.iter().map(|shape| circles(rows, shape)).collect();
            for (j, k) in (0..m).flat_map(|j| (0..m).map(move |k| (j, k))) {
                forward[(j, k)] += all[j][0].conj() * all[k][0] - all[j][1].conj() * all[k][1];
            }
        }
        let turned = forward.symmetric_eigen();
        let mut order: Vec<usize> = (0..m).collect();
        order.sort_by(|&j, &k| turned.eigenvalues[j].total_cmp(&turned.eigenvalues[k]));
        let combined = |k: usize| {
            let parts = shapes.iter().enumerate().map(|(j, shape)| shape * turned.eigenvectors[(j, k)]);
            parts.reduce(|sum, part| sum + part).unwrap_or_else(|| shapes[0].clone())
        };
        order.into_iter().map(combined).collect()
    }

    /// The `count` lowest natural whirls at each of some speeds (rad/s).
    ///
    /// # Errors
    /// A speed that is not finite.
    pub fn campbell(&self, speeds: &[f64], count: usize) -> Result<Campbell, RotorError> {
        for (index, &speed) in speeds.iter().enumerate() {
            super::error::check("speed", || format!("point {index}"), speed, true, "a finite number")?;
        }
        let whirls = speeds.iter().map(|&speed| self.naturals(speed, count)).collect();
        Ok(Campbell { speeds: speeds.to_vec(), whirls })
    }

    fn naturals(&self, speed: f64, count: usize) -> Vec<Natural> {
        let a = self.system(speed);
        let mut values: Vec<Complex<f64>> = a.complex_eigenvalues().iter().copied().collect();
        // an overdamped motion does not whirl
        values.retain(|value| value.im > 1e-9 * value.norm());
        values.sort_by(|a, b| a.im.total_cmp(&b.im));
        let groups = values.chunk_by(|a, b| (b - a).norm() <= ALIKE * a.norm());
        let senses = groups.flat_map(|group| {
            let shapes = self.shapes(&a, group[0], group.len()).map(|shapes| self.apart(&shapes));
            let senses = shapes.map(|shapes| shapes.iter().map(|shape| self.sense(shape)).collect());
            senses.unwrap_or_else(|| vec![WhirlSense::Mixed; group.len()])
        });
        let natural = |(&value, sense): (&Complex<f64>, WhirlSense)| Natural {
            frequency: value.im,
            undamped: value.norm(),
            damping_ratio: -value.re / value.norm(),
            sense,
        };
        values.iter().zip(senses).take(count).map(natural).collect()
    }

    /// The deflections of so many whirls of one eigenvalue, by inverse iteration beside it.
    fn shapes(&self, a: &DMatrix<f64>, value: Complex<f64>, count: usize) -> Option<Vec<DVector<Complex<f64>>>> {
        let n = a.nrows();
        let beside = value * Complex::new(1.0, 1e-9);
        let system = DMatrix::from_fn(n, n, |i, j| {
            Complex::new(a[(i, j)], 0.0) - if i == j { beside } else { Complex::new(0.0, 0.0) }
        })
        .lu();
        // as many independent ones, none along an axis
        let mut vectors = DMatrix::from_fn(n, count, |i, k| Complex::new(1.0, 0.3 + 0.01 * (i * (k + 1)) as f64));
        for _ in 0..3 {
            vectors = system.solve(&vectors)?.qr().q();
        }
        let r = self.count();
        let shape =
            |vector: DVectorView<Complex<f64>>| vector.rows(0, r).zip_map(&self.frequency, |entry, w| entry / w);
        Some(vectors.column_iter().map(shape).collect())
    }

    /// Which way a whirl `Re(eta exp(i w t))` goes round at most stations.
    fn sense(&self, shape: &DVector<Complex<f64>>) -> WhirlSense {
        let (mut forward, mut backward) = (0.0, 0.0);
        for rows in &self.stations {
            let [with, against] = circles(rows, shape);
            forward += with.norm_sqr();
            backward += against.norm_sqr();
        }
        if backward < MIXED * MIXED * forward {
            WhirlSense::Forward
        } else if forward < MIXED * MIXED * backward {
            WhirlSense::Backward
        } else {
            WhirlSense::Mixed
        }
    }
}

/// The forward and the backward circle, twice each, of a station in a whirl `Re(eta exp(i w t))`.
fn circles(rows: &[RowDVector<f64>; 2], shape: &DVector<Complex<f64>>) -> [Complex<f64>; 2] {
    let [x, y] = [0, 1].map(|axis| {
        let row = rows[axis].iter().zip(shape.iter());
        row.map(|(&row, &eta)| eta * row).sum::<Complex<f64>>()
    });
    // x + i y = f exp(i w t) + b exp(-i w t), 2 f = X + i Y, 2 b* = X - i Y
    let i = Complex::new(0.0, 1.0);
    [x + i * y, x - i * y]
}
