//! The influence of the heads as it is identified while the rotor turns.

use nalgebra::ComplexField;

use crate::balancing::error::Error;
use crate::balancing::influence::Influence;
use crate::balancing::matrix::{Matrix, pick, put};
use crate::balancing::qr::Qr;
use crate::balancing::scalar::{Complex, Scalar, real, size, square, zero};

/// Standard deviations that a move is bounded by.
pub(super) const DEVIATIONS: f64 = 4.0;
/// Largest deviation of a predicted change over it for which a move can confirm the influence.
pub(super) const INFORMATIVE: f64 = 0.4;
/// Relative standard deviation of the influence above which a plane is probed: four of it leave little gain.
const UNKNOWN: f64 = 0.2;

/// The reading with the present weights, and the influence; the covariance of one of its rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate<T: Scalar, const ROWS: usize, const PLANES: usize> {
    rows: usize,
    now: [Complex<T>; ROWS],
    influence: Matrix<T, ROWS, PLANES>,
    /// Variance of the reading, its covariance with the coefficients, and theirs.
    variance: T,
    cross: [Complex<T>; PLANES],
    covariance: Matrix<T, PLANES, PLANES>,
    known: bool,
    /// Whether a move of each plane has confirmed its influence.
    confirmed: [bool; PLANES],
}

/// Difference of a reading from its prediction.
pub(super) struct Innovation<T: Scalar, const ROWS: usize> {
    rows: [Complex<T>; ROWS],
    /// The largest of them.
    pub(super) largest: T,
    /// Its standard deviation.
    pub(super) deviation: T,
    /// Its standard deviation without that of the reading.
    pub(super) predicted: T,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Estimate<T, ROWS, PLANES> {
    pub(super) fn new(rows: usize) -> Self {
        Estimate {
            rows,
            now: [zero(); ROWS],
            influence: Matrix::new(),
            variance: T::zero(),
            cross: [zero(); PLANES],
            covariance: Matrix::new(),
            known: false,
            confirmed: [false; PLANES],
        }
    }

    /// Takes the influence from a model, each coefficient known to `share` of its plane's largest.
    pub(super) fn adopt(&mut self, model: &Influence<T, ROWS, PLANES>, share: T) -> Result<(), Error> {
        for plane in 0..PLANES {
            let mut largest = T::zero();
            for row in 0..self.rows {
                let value = model.get(row, plane).ok_or(Error::PlaneUnknown { plane })?;
                self.influence.set(row, plane, value);
                largest = largest.max(size(value));
            }
            self.doubt_plane(plane, largest * share);
        }
        (self.known, self.confirmed) = (true, [true; PLANES]);
        Ok(())
    }

    /// Takes the influence and the standard deviation of each plane as they were.
    pub(super) fn remember(&mut self, influence: Matrix<T, ROWS, PLANES>, deviation: &[T; PLANES]) {
        self.influence = influence;
        for (plane, deviation) in deviation.iter().enumerate() {
            self.doubt_plane(plane, *deviation);
        }
        (self.known, self.confirmed) = (true, [true; PLANES]);
    }

    /// The influence of each plane on each row.
    pub(super) fn coefficients(&self) -> [[Complex<T>; PLANES]; ROWS] {
        self.influence.rows()
    }

    /// Begins with `most` as the largest coefficient; false where coefficients are known.
    pub(super) fn begin(&mut self, most: T) -> bool {
        if self.known {
            return false;
        }
        for plane in 0..PLANES {
            self.doubt_plane(plane, most / real(DEVIATIONS));
        }
        self.known = true;
        true
    }

    fn doubt_plane(&mut self, plane: usize, deviation: T) {
        self.covariance.set(plane, plane, Complex { re: deviation * deviation, im: T::zero() });
    }

    /// Multiplies the covariance of the influence, which has to be confirmed again.
    pub(super) fn doubt(&mut self, factor: T) {
        for p in 0..PLANES {
            for q in 0..PLANES {
                self.covariance.set(p, q, self.covariance.at(p, q).scale(factor));
            }
        }
        self.confirmed = [false; PLANES];
    }

    /// Allows for changes of the machine: the influence is no more certain than a correction needs, and has to be
    /// confirmed again. One that was not confirmed is forgotten.
    pub(super) fn distrust(&mut self) {
        if self.confirmed() {
            for plane in 0..PLANES {
                let (own, changed) = (self.deviation(plane), self.largest(plane) * real(UNKNOWN));
                self.doubt_plane(plane, (own * own + changed * changed).sqrt());
            }
        } else {
            self.known = false;
            (self.influence, self.covariance) = (Matrix::new(), Matrix::new());
        }
        self.confirmed = [false; PLANES];
    }

    /// Takes a reading for the present one; the influence stays.
    pub(super) fn restart(&mut self, reading: &[Complex<T>], noise: T) {
        for (now, value) in self.now.iter_mut().zip(reading).take(self.rows) {
            *now = *value;
        }
        (self.variance, self.cross) = (noise, [zero(); PLANES]);
    }

    /// The largest present amplitude.
    pub(super) fn level(&self) -> T {
        self.now.iter().take(self.rows).fold(T::zero(), |most, value| most.max(size(*value)))
    }

    pub(super) fn influence(&self, row: usize, plane: usize) -> Complex<T> {
        self.influence.at(row, plane)
    }

    pub(super) fn deviation(&self, plane: usize) -> T {
        self.covariance.at(plane, plane).re.max(T::zero()).sqrt()
    }

    /// The largest coefficient of a plane.
    fn largest(&self, plane: usize) -> T {
        (0..self.rows).fold(T::zero(), |most, row| most.max(size(self.influence.at(row, plane))))
    }

    /// The largest that a coefficient of a plane can be.
    pub(super) fn most(&self, plane: usize) -> T {
        self.largest(plane) + self.deviation(plane) * real(DEVIATIONS)
    }

    /// Whether every plane's influence is confirmed, and certain enough for a correction.
    pub(super) fn confirmed(&self) -> bool {
        self.least_known().is_none()
    }

    /// Standard deviation of a plane's influence over its size.
    pub(super) fn doubt_of(&self, plane: usize) -> T {
        let deviation = self.deviation(plane);
        deviation / self.largest(plane).max(T::default_epsilon() * deviation)
    }

    /// The plane to probe: one that is not confirmed, or the most uncertain one.
    pub(super) fn least_known(&self) -> Option<usize> {
        let mut worst = None;
        for (plane, confirmed) in self.confirmed.iter().enumerate() {
            let doubt = self.doubt_of(plane);
            let doubt = if *confirmed { doubt } else { doubt.max(real(UNKNOWN * 1.001)) };
            if doubt > real(UNKNOWN) && worst.is_none_or(|(_, most)| doubt > most) {
                worst = Some((plane, doubt));
            }
        }
        worst.map(|(plane, _)| plane)
    }

    /// A row's change by moved weights.
    fn change(&self, row: usize, moved: &[Complex<T>; PLANES]) -> Complex<T> {
        moved.iter().enumerate().fold(zero(), |sum, (plane, moved)| sum + self.influence.at(row, plane) * *moved)
    }

    /// The variance of a row's change by moved weights.
    fn variance_of(&self, moved: &[Complex<T>; PLANES]) -> T {
        let mut square = T::zero();
        for (p, a) in moved.iter().enumerate() {
            for (q, b) in moved.iter().enumerate() {
                square += (*a * self.covariance.at(p, q) * b.conj()).re;
            }
        }
        square.max(T::zero())
    }

    /// The largest amplitude after moved weights.
    pub(super) fn level_after(&self, moved: &[Complex<T>; PLANES]) -> T {
        self.level_from(&self.now, moved)
    }

    pub(super) fn level_from(&self, reading: &[Complex<T>], moved: &[Complex<T>; PLANES]) -> T {
        (0..self.rows).fold(T::zero(), |most, row| most.max(size(pick(reading, row, zero()) + self.change(row, moved))))
    }

    /// Takes moved weights into account, and the square of what readings change from one to the next.
    pub(super) fn predict(&mut self, moved: &[Complex<T>; PLANES], walk: T) {
        let mut variance = self.variance + self.variance_of(moved) + walk;
        for (moved, cross) in moved.iter().zip(&self.cross) {
            variance += real::<T>(2.0) * (moved.conj() * *cross).re;
        }
        self.variance = variance.max(T::zero());
        for (q, cross) in self.cross.iter_mut().enumerate() {
            *cross = moved.iter().enumerate().fold(*cross, |sum, (p, moved)| sum + *moved * self.covariance.at(p, q));
        }
        let mut now = self.now;
        for (row, now) in now.iter_mut().enumerate().take(self.rows) {
            *now += self.change(row, moved);
        }
        self.now = now;
    }

    /// A reading of this variance less its prediction.
    pub(super) fn innovation(&self, reading: &[Complex<T>], noise: T) -> Innovation<T, ROWS> {
        let mut found = Innovation {
            rows: [zero(); ROWS],
            largest: T::zero(),
            deviation: (self.variance + noise).sqrt(),
            predicted: self.variance.sqrt(),
        };
        for ((to, value), now) in found.rows.iter_mut().zip(reading).zip(&self.now).take(self.rows) {
            *to = *value - *now;
            found.largest = found.largest.max(size(*to));
        }
        found
    }

    /// Takes in a reading by its innovation: Kalman's update, the same gain for every row.
    pub(super) fn learn(&mut self, innovation: &Innovation<T, ROWS>) {
        let spread = innovation.deviation * innovation.deviation;
        if !(spread > T::zero()) {
            return;
        }
        let (own, cross) = (self.variance / spread, self.cross);
        for (row, innovation) in innovation.rows.iter().enumerate().take(self.rows) {
            if let Some(now) = self.now.get_mut(row) {
                *now += innovation.scale(own);
            }
            for (p, cross) in cross.iter().enumerate() {
                let gain = cross.conj().unscale(spread);
                self.influence.set(row, p, self.influence.at(row, p) + gain * *innovation);
            }
        }
        self.variance *= T::one() - own;
        for (p, left) in cross.iter().enumerate() {
            for (q, right) in cross.iter().enumerate() {
                let less = left.conj() * right.unscale(spread);
                self.covariance.set(p, q, self.covariance.at(p, q) - less);
            }
        }
        for cross in &mut self.cross {
            *cross = cross.scale(T::one() - own);
        }
    }

    /// The largest predicted change by moved weights.
    pub(super) fn largest_change(&self, moved: &[Complex<T>; PLANES]) -> T {
        (0..self.rows).fold(T::zero(), |most, row| most.max(size(self.change(row, moved))))
    }

    /// Confirms the planes of a move whose change, `predicted`, was as predicted; forgets a part of what is certain.
    pub(super) fn confirm(
        &mut self,
        moved: &[Complex<T>; PLANES],
        predicted: T,
        innovation: &Innovation<T, ROWS>,
        forgetting: T,
    ) {
        let informative = innovation.deviation < predicted * real(INFORMATIVE);
        let longest = moved.iter().fold(T::zero(), |most, moved| most.max(size(*moved)));
        for (plane, (confirmed, moved)) in self.confirmed.iter_mut().zip(moved).enumerate() {
            if size(*moved) > longest * real(0.3) && informative && innovation.largest < predicted * real(0.5) {
                *confirmed = true;
            }
            // no less certain by it than a correction needs
            let deviation = self.covariance.at(plane, plane).re.max(T::zero()).sqrt();
            let largest = (0..self.rows).fold(T::zero(), |most, row| most.max(size(self.influence.at(row, plane))));
            if deviation < largest * real(0.3 * UNKNOWN) {
                let value = self.covariance.at(plane, plane);
                self.covariance.set(plane, plane, value.unscale(forgetting));
            }
        }
    }

    /// The change that minimises the expected square, uncertainty included.
    pub(super) fn cautious(&self) -> [Complex<T>; PLANES] {
        self.cautious_from(&self.now)
    }

    fn cautious_from(&self, reading: &[Complex<T>; ROWS]) -> [Complex<T>; PLANES] {
        let mut qr = Qr::<T, PLANES>::new();
        for (row, now) in reading.iter().enumerate().take(self.rows) {
            let mut a = [zero(); PLANES];
            for (plane, a) in a.iter_mut().enumerate() {
                *a = self.influence.at(row, plane);
            }
            qr.absorb(&a, -*now);
        }
        for plane in 0..PLANES {
            let mut a = [zero(); PLANES];
            let root = self.deviation(plane) * real::<T>(self.rows as f64).sqrt();
            put(&mut a, plane, Complex { re: root, im: T::zero() });
            qr.absorb(&a, zero());
        }
        qr.pivoted(T::zero()).solve()
    }

    /// The unbalance behind a reading: what the planes lack, and what is left beside that over the least effective
    /// plane's influence.
    pub(super) fn residual(&self, reading: &[Complex<T>; ROWS]) -> T {
        let lacking = self.cautious_from(reading);
        let left = (0..self.rows)
            .fold(T::zero(), |sum, row| sum + square(pick(reading, row, zero()) + self.change(row, &lacking)));
        let norms = (0..PLANES).map(|plane| self.influence.norm_from(0, plane));
        let least = norms.fold(None, |least: Option<T>, norm| Some(least.map_or(norm, |least| least.min(norm))));
        let lacking = lacking.iter().fold(T::zero(), |sum, weight| sum + size(*weight));
        lacking + least.map_or(T::zero(), |least| left.sqrt() / least)
    }

    /// The largest amplitude that a share of a step may lead to, within the standard deviations that count.
    pub(super) fn expected(&self, step: &[Complex<T>; PLANES], share: T) -> T {
        let step = step.map(|step| step.scale(share));
        self.level_after(&step) + self.variance_of(&step).sqrt() * real(DEVIATIONS)
    }
}

#[cfg(test)]
mod tests;
