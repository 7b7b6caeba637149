//! In-run balancing (active balancing) with a balancing head or an electromagnetic actuator.
//!
//! Each move of the weights is a trial of its own: the influence and its variance are identified from the moves by
//! recursive least squares with forgetting. A move minimises the expected vibration (cautious control, Åström and
//! Wittenmark, *Adaptive Control*, 7.3). It is larger where the influence is too uncertain to be identified by it. It
//! is never larger than four standard deviations of that uncertainty allow within the bound.
//!
//! Without a first estimate the head stands still for three further readings: their change is the machine's own. The
//! first move is the probe: a weight that is known to change the vibration by less than the bound allows. Later moves
//! are bounded by the identified influence, and go no more than a few times as far as weights that were read.
//!
//! A correction waits until a second move has confirmed the estimate. It is made only where it cannot make the
//! vibration worse within its uncertainty. Where readings change by themselves by too much, the head goes back to where
//! it began. A change that an identified influence does not explain is a jump of the unbalance: the influence stays,
//! and the correction follows. What was best before it is best no longer.
//!
//! Weights stay only where the vibration is below four fifths of that at rest, measured and estimated. Else the head
//! goes back. The speed of a reading is used only where the reading is not as predicted: slow swings of the speed
//! hardly change a vibration.
//!
//! A resumed run is judged by the first vibration of all: noise and target are shares of that. What was learnt has to
//! be confirmed again, first at rest and then by a move that is safe without it.

use core::fmt;

mod estimate;
mod remembered;

use super::error::Error;
use super::influence::Influence;
use super::matrix::{pick, put};
use super::scalar::{Complex, Scalar, real, size, zero};
use estimate::{DEVIATIONS, Estimate, INFORMATIVE};

pub use remembered::BalancingRecord;

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
    /// larger. What the readings change by themselves is added as it is seen.
    pub noise: T,
}

/// The next action on the weights.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub enum Action<T: Scalar, const PLANES: usize> {
    /// Set these weights, wait for a steady reading and give it. The same weights again ask for another reading.
    Set([Complex<T>; PLANES]),
    /// Within the target, or nothing left to gain: leave the weights.
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
    /// The weights change the readings by no more than these change by themselves.
    Unidentified,
}

impl fmt::Display for AbortReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AbortReason::Diverging => "the vibration rose above its bound",
            AbortReason::Stalled => "eight moves brought nothing",
            AbortReason::NoReading => "a reading is missing or not a number",
            AbortReason::Unidentified => "the weights change the readings by no more than these change by themselves",
        })
    }
}

/// A move goes no farther from where it began than this times the farthest weight that was read. This and the next
/// three are tuned on seeds 1 to 300 of `never_harmful.rs`, and judged there on 501 to 1000.
const GROWTH: f64 = 2.5;
/// Growth times the influence's relative standard deviation, where that allows more.
const CERTAIN: f64 = 0.6;
/// Further readings at rest before the first probe: one small change does not show that a machine holds still. Twice as
/// many where it was resumed: most of those machines did not hold still before.
const RESTED: u32 = 2;
/// What readings may change by themselves, over their level, before the influence is confirmed.
const RESTLESS: f64 = 0.08;
/// Moves without a better vibration before it is given up.
const PATIENCE: u32 = 8;
/// Moves, for each plane, that may serve identification before the vibration is better.
const PROBES: u32 = 16;
/// Square of what the vibration wanders from reading to reading, over the square of a reading's error.
const WALK: f64 = 0.1;
/// Share of the bound that a probe may use.
const ALLOWED: f64 = 0.93;
/// Least share of a correction that is worth a move.
const LEAST_SHARE: f64 = 0.3;
/// Deviation from the speed of the first reading beyond which a reading is not used that is not as predicted:
/// acceleration by unbalance goes with the fourth power of the speed, a fifth here.
const SPEED_BAND: f64 = 0.05;
/// A vibration below this share of the initial one is better beyond doubt.
const BETTER: f64 = 0.7;
/// Share of the vibration at rest that weights have to stay below, to be left there: a hum that keeps its phase makes
/// readings of weights that are no better look so.
const WORTH: f64 = 0.8;

/// In-run balancing of at most `ROWS` readings by `PLANES` heads.
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
    /// Speed of the first reading.
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

    /// The same with the speed of the reading, in any unit. More than 5 % off the speed of the first reading, one that
    /// is not as predicted teaches nothing; above the bound the head goes home. One that is as predicted is used at any
    /// speed, since the speed explains nothing of it.
    pub fn advise_at(&mut self, reading: &[Complex<T>], variance: T, speed: T) -> Action<T, PLANES> {
        let off = (speed / self.speed.unwrap_or(speed) - T::one()).abs();
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
        self.speed.get_or_insert(speed);
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
        let numbers = reading.iter().take(self.rows).all(|value| value.re.is_finite() && value.im.is_finite());
        if reading.len() < self.rows || !numbers {
            // nothing is learnt from this; the next reading may be better
            return Action::Abort(self.home(), AbortReason::NoReading);
        }
        let level = largest(reading, self.rows);
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
        self.installed(&to);
        Action::Set(to)
    }

    /// Takes in what has changed since the last reading, and returns the level of the weights that it began with.
    fn learn(&mut self, reading: &[Complex<T>], level: T, start: T, noise: T) -> T {
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

    /// The next move: a correction where it cannot do harm, a probe where the influence is not known well enough.
    fn correct(&mut self, start: T, noise: T) -> Action<T, PLANES> {
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

fn largest<T: Scalar>(reading: &[Complex<T>], rows: usize) -> T {
    reading.iter().take(rows).fold(T::zero(), |most, value| most.max(size(*value)))
}

#[cfg(test)]
mod tests;
