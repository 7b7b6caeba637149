//! In-run balancing (active balancing) with a balancing head or an electromagnetic actuator.
//!
//! Each move of the weights is a trial of its own: the influence and its variance are identified from the moves by
//! recursive least squares with forgetting. A move minimises the expected vibration (cautious control, Åström and
//! Wittenmark, *Adaptive Control*, 7.3), larger where the influence is too uncertain to be identified by it, and never
//! larger than four standard deviations of that uncertainty allow within the bound.
//!
//! Without a first estimate the first move is the probe: a weight that is known to change the vibration by less than
//! the bound allows. Later moves are bounded by the identified influence.

use core::fmt;

use nalgebra::ComplexField;

use super::error::Error;
use super::influence::Influence;
use super::matrix::{Matrix, pick, put};
use super::qr::Qr;
use super::scalar::{Complex, Scalar, real, size, zero};

/// How far a machine may be moved while it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InRunConfig<T, const PLANES: usize> {
    /// A weight in any plane that changes the vibration by less than `bound - 1` of it.
    pub probe: T,
    /// The largest weight that each plane's head can set.
    pub limits: [T; PLANES],
    /// The largest change of a weight in one move.
    pub step: T,
    /// The multiple of where it began that the vibration must not exceed, above 1.
    pub bound: T,
    /// The share of where it began that is good enough, below 1.
    pub target: T,
    /// Forgetting factor per move, 0 to 1.
    pub forgetting: T,
    /// Standard deviation of a reading as a share of the initial vibration, unless the reading's own variance is
    /// larger. Include the drift of the influence from move to move: with too small a value one start in several
    /// thousand exceeds the bound.
    pub noise: T,
}

/// The next action on the weights.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub enum Action<T: Scalar, const PLANES: usize> {
    /// Set these weights, wait for a steady reading and give it.
    Set([Complex<T>; PLANES]),
    /// Within the target: leave the weights.
    Hold,
    /// Abort: set these weights, the best so far, and look for the cause.
    Abort([Complex<T>; PLANES], AbortReason),
}

/// Why in-run balancing was aborted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AbortReason {
    /// The vibration rose above its bound.
    Diverging,
    /// Eight moves brought nothing.
    Stalled,
    /// A reading is missing or not a number.
    NoReading,
}

impl fmt::Display for AbortReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AbortReason::Diverging => "the vibration rose above its bound",
            AbortReason::Stalled => "eight moves brought nothing",
            AbortReason::NoReading => "a reading is missing or not a number",
        })
    }
}

/// Moves without a better vibration before it is given up.
const PATIENCE: u32 = 8;
/// Standard deviations that a move is bounded by.
const DEVIATIONS: f64 = 4.0;

/// In-run balancing of at most `ROWS` readings by `PLANES` heads.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct InRun<T: Scalar, const ROWS: usize, const PLANES: usize> {
    config: InRunConfig<T, PLANES>,
    rows: usize,
    /// The estimated influence, and the covariance of one of its rows.
    influence: Matrix<T, ROWS, PLANES>,
    covariance: Matrix<T, PLANES, PLANES>,
    known: bool,
    weights: [Complex<T>; PLANES],
    /// Change of the weights since the last reading.
    moved: [Complex<T>; PLANES],
    last: [Complex<T>; ROWS],
    /// Level that it began with; none before the first reading.
    start: Option<T>,
    best: (T, [Complex<T>; PLANES]),
    stalled: u32,
    aborted: Option<AbortReason>,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> InRun<T, ROWS, PLANES> {
    /// Nothing known of the influence; the heads stand at `weights`.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Setting`] with the place of the setting in [`InRunConfig`], the limits being one.
    pub fn new(config: InRunConfig<T, PLANES>, rows: usize, weights: [Complex<T>; PLANES]) -> Result<Self, Error> {
        if rows == 0 || rows > ROWS || PLANES == 0 {
            return Err(Error::Size);
        }
        let positive = |value: T| value > T::zero() && value.is_finite();
        let one = T::one();
        let limits = config.limits.iter().all(|limit| positive(*limit));
        let right = [
            positive(config.probe),
            limits,
            positive(config.step),
            config.bound > one && config.bound.is_finite(),
            positive(config.target) && config.target < one,
            positive(config.forgetting) && config.forgetting <= one,
            positive(config.noise) && config.noise < one,
        ];
        if let Some(index) = right.iter().position(|right| !right) {
            return Err(Error::Setting { index });
        }
        Ok(InRun {
            config,
            rows,
            influence: Matrix::new(),
            covariance: Matrix::new(),
            known: false,
            weights,
            moved: [zero(); PLANES],
            last: [zero(); ROWS],
            start: None,
            best: (T::zero(), weights),
            stalled: 0,
            aborted: None,
        })
    }

    /// The influence from a model or from trial runs, each coefficient known to `share` of the largest one of its
    /// plane.
    ///
    /// # Errors
    /// [`Error::PlaneUnknown`], [`Error::Setting`] where the share is not positive.
    pub fn with_model(mut self, model: &Influence<T, ROWS, PLANES>, share: T) -> Result<Self, Error> {
        if !(share > T::zero() && share.is_finite()) {
            return Err(Error::Setting { index: 0 });
        }
        for plane in 0..PLANES {
            let mut largest = T::zero();
            for row in 0..self.rows {
                let value = model.get(row, plane).ok_or(Error::PlaneUnknown { plane })?;
                self.influence.set(row, plane, value);
                largest = largest.max(size(value));
            }
            let deviation = largest * share;
            self.covariance.set(plane, plane, Complex { re: deviation * deviation, im: T::zero() });
        }
        self.known = true;
        Ok(self)
    }

    /// Where the heads stand, or are to be.
    pub fn weights(&self) -> &[Complex<T>; PLANES] {
        &self.weights
    }

    /// Sets the weights actually installed, where they differ from those commanded.
    pub fn installed(&mut self, weights: &[Complex<T>; PLANES]) {
        for ((moved, was), is) in self.moved.iter_mut().zip(&mut self.weights).zip(weights) {
            *moved += *is - *was;
            *was = *is;
        }
    }

    /// The largest amplitude over that of the first reading; none before that.
    pub fn level(&self) -> Option<T> {
        self.start.map(|start| largest(&self.last, self.rows) / start)
    }

    /// The estimate of a coefficient and its standard deviation.
    pub fn influence(&self, row: usize, plane: usize) -> (Complex<T>, T) {
        (self.influence.at(row, plane), self.deviation(plane))
    }

    /// Takes a steady reading with the present weights and its variance (0 where unknown), and returns the next action.
    pub fn advise(&mut self, reading: &[Complex<T>], variance: T) -> Action<T, PLANES> {
        if let Some(reason) = self.aborted {
            return Action::Abort(self.best.1, reason);
        }
        let numbers = reading.iter().take(self.rows).all(|value| value.re.is_finite() && value.im.is_finite());
        if reading.len() < self.rows || !numbers {
            // nothing is learnt from this; the next reading may be better
            return Action::Abort(self.best.1, AbortReason::NoReading);
        }
        let level = largest(reading, self.rows);
        let start = match self.start {
            Some(start) => {
                self.learn(reading, start, variance);
                start
            }
            None => {
                self.begin(level);
                level
            }
        };
        for (last, value) in self.last.iter_mut().zip(reading).take(self.rows) {
            *last = *value;
        }
        self.stalled += 1;
        if level < self.best.0 {
            // anything less than a tenth better counts as nothing
            if level < self.best.0 * real(0.9) {
                self.stalled = 0;
            }
            self.best = (level, self.weights);
        }
        if level > start * self.config.bound {
            return self.abort(AbortReason::Diverging);
        }
        if level <= start * self.config.target {
            self.stalled = 0;
            return Action::Hold;
        }
        if self.stalled > PATIENCE {
            return self.abort(AbortReason::Stalled);
        }
        let step = self.step(start);
        for ((moved, weight), step) in self.moved.iter_mut().zip(&mut self.weights).zip(&step) {
            *moved = *step;
            *weight += *step;
        }
        Action::Set(self.weights)
    }

    fn abort(&mut self, reason: AbortReason) -> Action<T, PLANES> {
        self.aborted = Some(reason);
        Action::Abort(self.best.1, reason)
    }

    fn begin(&mut self, level: T) {
        self.start = Some(level);
        self.best = (level, self.weights);
        if !self.known {
            // the promise of the probe, as so many standard deviations
            let most = level * (self.config.bound - T::one()) * real(0.95) / self.config.probe;
            let deviation = most / real(DEVIATIONS);
            for plane in 0..PLANES {
                self.covariance.set(plane, plane, Complex { re: deviation * deviation, im: T::zero() });
            }
        }
    }

    /// Recursive least squares: the change of the readings against the change of the weights.
    fn learn(&mut self, reading: &[Complex<T>], start: T, variance: T) {
        let (moved, rows) = (self.moved, self.rows);
        self.moved = [zero(); PLANES];
        if moved.iter().all(|moved| *moved == zero()) {
            return;
        }
        for p in 0..PLANES {
            for q in 0..PLANES {
                self.covariance.set(p, q, self.covariance.at(p, q).unscale(self.config.forgetting));
            }
        }
        let own = start * self.config.noise;
        let given = if variance > T::zero() { variance } else { T::zero() };
        // two readings differ
        let noise = (own * own).max(given) * real(2.0);
        let mut gain = [zero(); PLANES];
        let mut spread = noise;
        for (p, gain) in gain.iter_mut().enumerate() {
            *gain =
                moved.iter().enumerate().fold(zero(), |sum, (q, moved)| sum + self.covariance.at(p, q) * moved.conj());
            spread += (pick(&moved, p, zero()) * *gain).re;
        }
        let along = gain;
        for gain in &mut gain {
            *gain = gain.unscale(spread);
        }
        for row in 0..rows {
            let known = (0..PLANES).fold(zero(), |sum, p| sum + self.influence.at(row, p) * pick(&moved, p, zero()));
            let innovation = pick(reading, row, zero()) - pick(&self.last, row, zero()) - known;
            for (p, gain) in gain.iter().enumerate() {
                self.influence.set(row, p, self.influence.at(row, p) + *gain * innovation);
            }
        }
        for (p, gain) in gain.iter().enumerate() {
            for (q, along) in along.iter().enumerate() {
                self.covariance.set(p, q, self.covariance.at(p, q) - *gain * along.conj());
            }
        }
    }

    fn deviation(&self, plane: usize) -> T {
        self.covariance.at(plane, plane).re.max(T::zero()).sqrt()
    }

    /// The change of the weights.
    fn step(&self, start: T) -> [Complex<T>; PLANES] {
        let allowed = start * self.config.bound * real(0.95);
        let level = largest(&self.last, self.rows);
        // the plane of largest relative uncertainty
        let (mut unknown_plane, mut worst) = (PLANES, real::<T>(0.5));
        for plane in 0..PLANES {
            let known = (0..self.rows).fold(T::zero(), |most, row| most.max(size(self.influence.at(row, plane))));
            let unknown = self.deviation(plane) / known.max(T::default_epsilon() * self.deviation(plane));
            if unknown > worst {
                (unknown_plane, worst) = (plane, unknown);
            }
        }
        let mut step = self.cautious();
        if unknown_plane < PLANES {
            // learn by the largest move that is safe whichever way it goes
            let known =
                (0..self.rows).fold(T::zero(), |most, row| most.max(size(self.influence.at(row, unknown_plane))));
            let length = (allowed - level).max(T::zero()) / (known + self.deviation(unknown_plane) * real(DEVIATIONS));
            let wanted = pick(&step, unknown_plane, zero());
            let ahead = Complex { re: T::one(), im: T::zero() };
            let way = if size(wanted) > T::zero() { wanted.unscale(size(wanted)) } else { ahead };
            step = [zero(); PLANES];
            put(&mut step, unknown_plane, way.scale(length.max(size(wanted))));
        }
        for ((step, weight), limit) in step.iter_mut().zip(&self.weights).zip(&self.config.limits) {
            if size(*step) > self.config.step {
                *step = step.scale(self.config.step / size(*step));
            }
            let to = *weight + *step;
            if size(to) > *limit {
                *step = to.scale(*limit / size(to)) - *weight;
            }
        }
        let mut share = T::one();
        for _ in 0..24 {
            if self.expected(&step, share) <= allowed {
                break;
            }
            share *= real(0.8);
        }
        step.map(|step| step.scale(share))
    }

    /// The change that minimises the expected square, uncertainty included.
    fn cautious(&self) -> [Complex<T>; PLANES] {
        let mut qr = Qr::<T, PLANES>::new();
        for (row, last) in self.last.iter().enumerate().take(self.rows) {
            let mut a = [zero(); PLANES];
            for (plane, a) in a.iter_mut().enumerate() {
                *a = self.influence.at(row, plane);
            }
            qr.absorb(&a, -*last);
        }
        for plane in 0..PLANES {
            let mut a = [zero(); PLANES];
            let root = self.deviation(plane) * real::<T>(self.rows as f64).sqrt();
            put(&mut a, plane, Complex { re: root, im: T::zero() });
            qr.absorb(&a, zero());
        }
        qr.pivoted(T::zero()).solve()
    }

    /// The largest amplitude that a share of a step may lead to, within the standard deviations that count.
    fn expected(&self, step: &[Complex<T>; PLANES], share: T) -> T {
        let mut square = T::zero();
        for (p, a) in step.iter().enumerate() {
            for (q, b) in step.iter().enumerate() {
                square += (*a * self.covariance.at(p, q) * b.conj()).re;
            }
        }
        let unknown = square.max(T::zero()).sqrt() * share * real(DEVIATIONS);
        let mut most = T::zero();
        for (row, last) in self.last.iter().enumerate().take(self.rows) {
            let change =
                step.iter().enumerate().fold(zero(), |sum, (plane, step)| sum + self.influence.at(row, plane) * *step);
            most = most.max(size(*last + change.scale(share)));
        }
        most + unknown
    }
}

fn largest<T: Scalar>(reading: &[Complex<T>], rows: usize) -> T {
    reading.iter().take(rows).fold(T::zero(), |most, value| most.max(size(*value)))
}
