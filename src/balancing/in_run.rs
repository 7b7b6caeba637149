//! In-run balancing (active balancing) with a balancing head or an electromagnetic actuator.

mod action;
mod correct;
mod estimate;
mod learn;
mod remembered;

use super::error::Error;
use super::influence::Influence;
use super::scalar::{Complex, Scalar, given, real, size, zero};
use estimate::{DEVIATIONS, Estimate, INFORMATIVE};

pub use action::{AbortReason, Action, InRunConfig};
pub use remembered::BalancingRecord;

/// Further readings at rest before the first probe: one small change does not show that a machine holds still. Twice as
/// many where it was resumed: most of those machines did not hold still before.
const RESTED: u32 = 2;
/// What readings may change by themselves, over their level, before the influence is confirmed.
const RESTLESS: f64 = 0.08;
/// Moves without a better vibration before it is given up.
const PATIENCE: u32 = 8;
/// Square of what the vibration wanders from reading to reading, over the square of a reading's error.
const WALK: f64 = 0.1;
/// Share of the bound that a probe may use.
const ALLOWED: f64 = 0.93;
/// Change of the speed from reading to reading beyond which a reading is not used that is not as predicted:
/// acceleration by unbalance goes with the fourth power of the speed, a fifth here.
const SPEED_BAND: f64 = 0.05;
/// A vibration below this share of the initial one is better beyond doubt.
const BETTER: f64 = 0.7;
/// Share of the vibration at rest that weights have to stay below, to be left there: a hum that keeps its phase makes
/// readings of weights that are no better look so.
const WORTH: f64 = 0.8;

/// In-run balancing of at most `ROWS` readings by `PLANES` heads.
///
/// Each move of the weights is a trial of its own: the influence and its variance are identified from the moves by
/// recursive least squares with forgetting. A move minimises the expected vibration (cautious control, Åström and
/// Wittenmark, *Adaptive Control*, 7.3). It is larger where the influence is too uncertain to be identified by it. It
/// is never larger than four standard deviations of that uncertainty allow within the bound.
///
/// Without a first estimate the head stands still for three further readings: their change is the machine's own. The
/// first move is the probe: a weight that is known to change the vibration by less than the bound allows. Later moves
/// are bounded by the identified influence, and go no more than a few times as far as weights that were read.
///
/// A correction waits until a second move has confirmed the estimate. It is made only where it cannot make the
/// vibration worse within its uncertainty. Where readings change by themselves by too much, the head goes back to where
/// it began. A change that an identified influence does not explain is a jump of the unbalance: the influence stays,
/// and the correction follows. What was best before it is best no longer.
///
/// Weights stay only where the vibration is below four fifths of that at rest, measured and estimated. Else the head
/// goes back. The speed of a reading is used only where the reading is not as predicted: slow swings of the speed
/// hardly change a vibration.
///
/// A resumed run is judged by the first vibration of all: noise and target are shares of that. What was learnt has to
/// be confirmed again, first at rest and then by a move that is safe without it.
///
/// ```
/// use driveline::balancing::{Action, Complex, InRun, InRunConfig};
/// const CONFIG: InRunConfig<f64, 1> =
///     InRunConfig { probe: 0.01, limits: [1.0], step: 2.0, bound: 1.3, target: 0.04, forgetting: 0.8, noise: 0.005 };
/// // a spindle of an influence that nobody knows, with an unbalance that a weight of 0.4i takes away
/// let vibration = |weight: Complex<f64>| Complex::new(0.2, 0.7) * (weight - Complex::new(0.0, 0.4));
/// let (mut head, mut moves) = (Complex::new(0.0, 0.0), 0);
/// let mut rule = InRun::<f64, 1, 1>::new(CONFIG, 1, [head])?;
/// while let Action::Set([to]) = rule.advise(&[vibration(head)], 0.0) {
///     (head, moves) = (to, moves + u32::from(to != head));
///     assert!(moves < 12);
/// }
/// assert!((head - Complex::new(0.0, 0.4)).norm() < 0.04 * 0.4);
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct InRun<T: Scalar, const ROWS: usize, const PLANES: usize> {
    config: InRunConfig<T, PLANES>,
    rows: usize,
    estimate: Estimate<T, ROWS, PLANES>,
    weights: [Complex<T>; PLANES],
    /// Change of the weights since the last reading.
    moved: [Complex<T>; PLANES],
    /// Level of the last reading.
    level: T,
    /// Weights that it began with, and their level; none before the first reading.
    rest: [Complex<T>; PLANES],
    start: Option<T>,
    best: (T, [Complex<T>; PLANES]),
    /// Standard deviation of the readings beside their prediction, over the level.
    scatter: T,
    /// Level of the very first reading, and whether it was resumed since.
    first: T,
    resumed: bool,
    /// Speed of the reading before.
    speed: Option<T>,
    /// The farthest that the heads have been from where they began, and were read.
    reach: T,
    /// Further readings to come before the first probe.
    rested: u32,
    stalled: u32,
    probes: u32,
    /// Moves in a row that ended above the bound, or beside their prediction.
    failures: u32,
    /// The last reading was beside its prediction although the influence is confirmed.
    jumped: bool,
    aborted: Option<AbortReason>,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize> InRun<T, ROWS, PLANES> {
    /// Nothing known of the influence; the heads stand at `weights`.
    ///
    /// # Errors
    /// [`Error::Size`]; [`Error::Setting`] with the place of the setting in [`InRunConfig`], the limits being one.
    #[inline(never)]
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
            estimate: Estimate::new(rows),
            weights,
            moved: [zero(); PLANES],
            level: T::zero(),
            rest: weights,
            start: None,
            best: (T::zero(), weights),
            scatter: T::zero(),
            first: T::zero(),
            resumed: false,
            speed: None,
            reach: T::zero(),
            rested: RESTED,
            stalled: 0,
            probes: 0,
            failures: 0,
            jumped: false,
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
        self.estimate.adopt(model, share)?;
        self.reach = self.config.limits.iter().fold(T::zero(), |most, limit| most.max(*limit));
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
        self.start.map(|start| self.level / start)
    }

    /// The estimate of a coefficient and its standard deviation.
    pub fn influence(&self, row: usize, plane: usize) -> (Complex<T>, T) {
        (self.estimate.influence(row, plane), self.estimate.deviation(plane))
    }

    /// Begins again after an abort, from where the heads stand now. A confirmed influence is kept. Before a correction
    /// uses it, readings at rest and a move have to confirm it. The noise of the readings and the target
    /// stay shares of the very first reading.
    pub fn resume(&mut self, weights: &[Complex<T>; PLANES]) {
        (self.aborted, self.start, self.speed) = (None, None, None);
        (self.weights, self.rest, self.moved) = (*weights, *weights, [zero(); PLANES]);
        (self.stalled, self.probes, self.failures, self.jumped) = (0, 0, 0, false);
        // what wandered may stand still now
        (self.scatter, self.rested, self.reach) = (T::zero(), 2 * RESTED, T::zero());
        self.estimate.distrust();
        self.resumed = self.first > T::zero();
    }

    /// Takes a steady reading with the present weights and its variance (0 where unknown), and returns the next action.
    pub fn advise(&mut self, reading: &[Complex<T>], variance: T) -> Action<T, PLANES> {
        self.next(reading, variance)
    }

    /// The same with the speed of the reading, in any unit. More than 5 % off the speed of the reading before, one that
    /// is not as predicted teaches nothing; above the bound the head goes home. One that is as predicted is used at any
    /// speed, since the speed explains nothing of it. A speed that stays is the machine's new one, and so is what
    /// changes after it.
    pub fn advise_at(&mut self, reading: &[Complex<T>], variance: T, speed: T) -> Action<T, PLANES> {
        let off = (speed / self.speed.unwrap_or(speed) - T::one()).abs();
        if speed.is_finite() {
            self.speed = Some(speed);
        }
        // written so that a NaN is beyond the band
        if !(off <= real(SPEED_BAND)) && !self.foresees(reading, variance) {
            if let Some(reason) = self.aborted {
                return Action::Abort(self.best.1, reason);
            }
            self.stalled += 1;
            if self.stalled > PATIENCE {
                return self.abort(AbortReason::Stalled);
            }
            // no reason to leave it above the bound
            let high = self.start.is_some_and(|start| !(largest(reading, self.rows) <= start * self.config.bound));
            return self.go(if high { self.home() } else { self.weights });
        }
        self.next(reading, variance)
    }

    /// Whether a reading is as predicted.
    fn foresees(&self, reading: &[Complex<T>], variance: T) -> bool {
        let Some(start) = self.start else { return false };
        let noise = self.noise(start, variance);
        let mut estimate = self.estimate;
        estimate.predict(&self.moved, noise * noise * real(WALK));
        let innovation = estimate.innovation(reading, noise * noise);
        innovation.largest <= innovation.deviation * real(DEVIATIONS)
    }

    /// Standard deviation of a reading by itself, `start` being the level that it began with.
    fn own(&self, start: T, variance: T) -> T {
        let first = if self.resumed { self.first } else { T::zero() };
        (start.max(first) * self.config.noise).max(variance.max(T::zero()).sqrt())
    }

    /// The same with what the readings change by themselves. The reading itself does not count: a jump would widen what
    /// it is judged by.
    fn noise(&self, start: T, variance: T) -> T {
        let foreseen = self.estimate.level_after(&self.moved).max(self.level);
        self.own(start, variance).max(foreseen * self.scatter)
    }

    fn next(&mut self, reading: &[Complex<T>], variance: T) -> Action<T, PLANES> {
        if let Some(reason) = self.aborted {
            return Action::Abort(self.best.1, reason);
        }
        let level = largest(reading, self.rows);
        let squares = (level * level + variance.max(T::zero())).is_finite();
        if reading.len() < self.rows || !squares || !reading.iter().take(self.rows).all(|value| given(*value)) {
            // nothing is learnt from this; the next reading may be better
            return Action::Abort(self.home(), AbortReason::NoReading);
        }
        let Some(start) = self.start else {
            self.level = level;
            (self.start, self.best) = (Some(level), (level, self.weights));
            let own = self.own(level, variance);
            self.estimate.restart(reading, own * own);
            if !self.resumed {
                self.first = level;
            }
            let most = self.first * (self.config.bound - T::one()) * real(0.95) / self.config.probe;
            let rest = self.estimate.begin(most) || self.resumed;
            return if rest { Action::Set(self.weights) } else { self.correct(level, own) };
        };
        let noise = self.noise(start, variance);
        if self.weights == self.best.1 {
            self.best.0 = level;
        }
        for (is, was) in self.weights.iter().zip(&self.rest) {
            self.reach = self.reach.max(size(*is - *was));
        }
        let at_rest = self.weights == self.rest;
        let mut start = self.learn(reading, level, start, noise * noise);
        self.level = level;
        let confirmed = self.estimate.confirmed();
        self.stalled += u32::from(confirmed);
        if level < self.best.0 && confirmed && !self.jumped {
            // anything less than a tenth better counts as nothing
            if level < self.best.0 * real(0.9) {
                self.stalled = 0;
            }
            self.best = (level, self.weights);
        }
        if at_rest {
            // what the head is judged by: where it has jumped, identification begins again
            if level > start * self.config.bound {
                self.probes = 0;
                self.estimate.restart(reading, noise * noise);
            }
            start = level;
            (self.start, self.best) = (Some(start), (level, self.weights));
        }
        if level > start * self.config.bound {
            self.failures += 1;
            if self.failures > 1 {
                return self.abort(AbortReason::Diverging);
            }
            self.estimate.doubt(real(4.0));
            return self.go(self.home());
        }
        // resumed where the largest move that is safe cannot be told from the readings' error
        let change = start * (self.config.bound * real(ALLOWED) - T::one());
        let faint = self.resumed && at_rest && !confirmed && change * real(INFORMATIVE) < self.own(start, variance);
        if level <= start.max(if self.resumed { self.first } else { T::zero() }) * self.config.target || faint {
            (self.stalled, self.probes, self.failures) = (0, 0, 0);
            return Action::Hold;
        }
        if self.failures > 3 || self.scatter > real(RESTLESS) && !confirmed {
            return self.abort(AbortReason::Unidentified);
        }
        if self.stalled > PATIENCE {
            return self.abort(AbortReason::Stalled);
        }
        if core::mem::take(&mut self.jumped) {
            // a jump stays, a disturbance goes: the next reading shows which
            return if self.estimate.confirmed() { Action::Set(self.weights) } else { self.go(self.rest) };
        }
        if at_rest && self.rested > 0 && self.probes == 0 && !confirmed {
            self.rested -= 1;
            return Action::Set(self.weights);
        }
        self.correct(start, noise)
    }

    /// The best weights, where they are better beyond doubt, or those that it began with.
    pub fn home(&self) -> [Complex<T>; PLANES] {
        // what wanders by itself, of the readings as they were at first
        let still = |start: T| self.scatter * self.level <= start * real(RESTLESS);
        let better = self.start.is_some_and(|start| self.best.0 < start * real(BETTER) && still(start));
        if better { self.best.1 } else { self.rest }
    }

    fn abort(&mut self, reason: AbortReason) -> Action<T, PLANES> {
        self.aborted = Some(reason);
        self.best.1 = self.home();
        Action::Abort(self.best.1, reason)
    }

    fn go(&mut self, to: [Complex<T>; PLANES]) -> Action<T, PLANES> {
        // readings that differ by many decades overflow
        if !to.iter().all(|weight| given(*weight)) {
            return self.abort(AbortReason::NoReading);
        }
        self.installed(&to);
        Action::Set(to)
    }

    /// Level with the weights that it began with, as estimated.
    fn at_rest(&self) -> T {
        self.estimate.level_after(&self.back())
    }

    /// Step to the weights that it began with.
    fn back(&self) -> [Complex<T>; PLANES] {
        let mut back = self.rest;
        for (back, weight) in back.iter_mut().zip(&self.weights) {
            *back -= *weight;
        }
        back
    }
}

fn largest<T: Scalar>(reading: &[Complex<T>], rows: usize) -> T {
    reading.iter().take(rows).fold(T::zero(), |most, value| most.max(size(*value)))
}

#[cfg(test)]
mod tests;
