//! The procedure of balancing in the field, step by step: baseline, a trial run for each plane, correction,
//! verification, trim.

mod plan;
mod run;
mod words;

use heapless::Vec;

pub use plan::Plan;
pub use run::Run;

use super::correction::Correction;
use super::error::Error;
use super::influence::Influence;
use super::matrix::pick;
use super::scalar::{Complex, Scalar, size, zero};

/// Corrections and trims that are kept.
pub const CORRECTIONS: usize = 6;

/// The next step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ProcedureStep {
    /// Run as the rotor is, and give [`Procedure::baseline`].
    Baseline,
    /// Put a trial weight in this plane, run, and give [`Procedure::trial`].
    Trial {
        /// The plane.
        plane: usize,
    },
    /// Ask for [`Procedure::correction`], install the weights, and enter them with [`Procedure::installed`].
    Correction,
    /// Run with them, and give [`Procedure::verified`].
    Verify,
    /// As the correction, with the coefficients that are known.
    Trim,
    /// Good enough.
    Done,
}

/// Weights that were put on, and the run with them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Installed<T: Scalar, const ROWS: usize, const PLANES: usize> {
    weights: [Complex<T>; PLANES],
    run: Option<Run<T, ROWS>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Trial<T: Scalar, const ROWS: usize> {
    plane: usize,
    weight: Complex<T>,
    run: Run<T, ROWS>,
}

/// A procedure under way. `TRIALS` trial runs are kept: one for each plane by default.
///
/// The entries decide the next step; any step can be repeated, and the last one undone. Everything entered goes into a
/// record of words that a firmware can store, and from which the procedure goes on after a power cut.
///
/// ```
/// use driveline::balancing::{Complex, Plan, Procedure, ProcedureStep, Run};
/// // one sensor, one plane, 0.1 um left; a fan with 0.3i um per gram and 4 um of its own, at 155 rad/s
/// let run = |weight: Complex<f64>| Run::new(&[Complex::new(0.0, 0.3) * weight + 4.0], &[155.0]);
/// let mut field = Procedure::<f64, 1, 1>::new(Plan::usual(1, 1, 0.1))?;
/// field.baseline(&run(Complex::new(0.0, 0.0))?)?;
/// assert_eq!(field.next(), ProcedureStep::Trial { plane: 0 });
/// field.trial(0, Complex::new(10.0, 0.0), &run(Complex::new(10.0, 0.0))?)?;
/// let weights = field.correction()?.weights; // 13.3 g at 90 degrees
/// field.installed(&weights)?;
/// field.verified(&run(weights[0])?)?;
/// assert_eq!(field.next(), ProcedureStep::Done);
/// # Ok::<(), driveline::balancing::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
#[doc(alias("field balancing", "trial weight"))]
pub struct Procedure<T: Scalar, const ROWS: usize, const PLANES: usize, const TRIALS: usize = PLANES> {
    plan: Plan<T, ROWS, PLANES>,
    /// Coefficients that were known before.
    before: Option<Influence<T, ROWS, PLANES>>,
    baseline: Option<Run<T, ROWS>>,
    trials: Vec<Trial<T, ROWS>, TRIALS>,
    installed: Vec<Installed<T, ROWS, PLANES>, CORRECTIONS>,
}

impl<T: Scalar, const ROWS: usize, const PLANES: usize, const TRIALS: usize> Procedure<T, ROWS, PLANES, TRIALS> {
    /// A procedure at its beginning.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::MorePlanesThanReadings`], [`Error::Setting`] for the tolerance of the speed (0) or of
    /// the residual (1).
    pub fn new(plan: Plan<T, ROWS, PLANES>) -> Result<Self, Error> {
        Influence::<T, ROWS, PLANES>::new(plan.rows, plan.planes)?;
        for (index, value) in [plan.speed, plan.tolerance].into_iter().enumerate() {
            if !(value > T::zero() && value.is_finite()) {
                return Err(Error::Setting { index });
            }
        }
        Ok(Procedure { plan, before: None, baseline: None, trials: Vec::new(), installed: Vec::new() })
    }

    /// Takes known coefficients in place of trial runs.
    ///
    /// # Errors
    /// [`Error::Size`] where they are of other planes or rows, [`Error::PlaneUnknown`].
    pub fn with_coefficients(mut self, known: Influence<T, ROWS, PLANES>) -> Result<Self, Error> {
        if known.rows() != self.plan.rows || known.planes() != self.plan.planes {
            return Err(Error::Size);
        }
        if let Some(plane) = known.unknown() {
            return Err(Error::PlaneUnknown { plane });
        }
        self.before = Some(known);
        Ok(self)
    }

    /// How it goes.
    pub fn plan(&self) -> &Plan<T, ROWS, PLANES> {
        &self.plan
    }

    /// The next step.
    pub fn next(&self) -> ProcedureStep {
        if self.baseline.is_none() {
            return ProcedureStep::Baseline;
        }
        if let Some(plane) = self.influence().ok().and_then(|influence| influence.unknown()) {
            return ProcedureStep::Trial { plane };
        }
        match self.installed.last() {
            None => ProcedureStep::Correction,
            Some(Installed { run: None, .. }) => ProcedureStep::Verify,
            Some(Installed { run: Some(run), .. }) => {
                let counted = self.plan.aim.counted(&run.readings, self.plan.rows);
                let largest = counted.fold(T::zero(), |most, reading| most.max(size(reading)));
                if largest <= self.plan.tolerance { ProcedureStep::Done } else { ProcedureStep::Trim }
            }
        }
    }

    /// Gives the baseline, or gives it again.
    ///
    /// # Errors
    /// A run that is not complete; [`Error::SpeedDiffers`] where trial runs at other speeds exist.
    pub fn baseline(&mut self, run: &Run<T, ROWS>) -> Result<(), Error> {
        self.complete(run)?;
        for other in self
            .trials
            .iter()
            .map(|trial| &trial.run)
            .chain(self.installed.iter().filter_map(|placed| placed.run.as_ref()))
        {
            self.same_speed(run, other)?;
        }
        let old = self.baseline.replace(*run);
        let learnt = self.influence();
        if let Err(refusal) = learnt {
            self.baseline = old;
            return Err(refusal);
        }
        Ok(())
    }

    /// Gives the trial run of a plane, or gives it again: one that was entered before is replaced.
    ///
    /// # Errors
    /// [`Error::TooEarly`] without a baseline; an invalid plane, weight or run; [`Error::TrialRepeated`] where the
    /// plane has several trial runs, or its weight stayed on below a later one: undo the wrong entry
    /// ([`Procedure::undo`]), or enter a [`Procedure::extra_trial`]. Earlier entries stay.
    pub fn trial(&mut self, plane: usize, weight: Complex<T>, run: &Run<T, ROWS>) -> Result<(), Error> {
        self.at_baseline_speed(run)?;
        let trial = Trial { plane, weight, run: *run };
        let last = self.trials.len().saturating_sub(1);
        let mut known = self.trials.iter().enumerate().filter(|(_, trial)| trial.plane == plane).map(|(at, _)| at);
        match (known.next(), known.next()) {
            (None, _) => self.add(trial),
            (Some(at), None) if at == last || !self.plan.leave_trials => {
                let Some(place) = self.trials.get_mut(at) else { return Err(Error::NoPlane { plane }) };
                let old = core::mem::replace(place, trial);
                let learnt = self.influence().map(|_| ());
                if let (Err(_), Some(place)) = (learnt, self.trials.get_mut(at)) {
                    *place = old;
                }
                learnt
            }
            _ => Err(Error::TrialRepeated { plane }),
        }
    }

    /// Gives a further trial run of a plane that has one: all of them count, by least squares.
    ///
    /// Where trial weights stay, the weight is the one added since the run before.
    ///
    /// # Errors
    /// As [`Procedure::trial`], and [`Error::Size`] where `TRIALS` runs are there already.
    pub fn extra_trial(&mut self, plane: usize, weight: Complex<T>, run: &Run<T, ROWS>) -> Result<(), Error> {
        self.at_baseline_speed(run)?;
        self.add(Trial { plane, weight, run: *run })
    }

    fn add(&mut self, trial: Trial<T, ROWS>) -> Result<(), Error> {
        if trial.plane >= self.plan.planes {
            return Err(Error::NoPlane { plane: trial.plane });
        }
        self.trials.push(trial).map_err(|_| Error::Size)?;
        let learnt = self.influence().map(|_| ());
        if learnt.is_err() {
            self.trials.pop();
        }
        learnt
    }

    /// The coefficients, as far as they are known.
    ///
    /// # Errors
    /// [`Error::TooEarly`] without a baseline; an invalid trial run.
    pub fn influence(&self) -> Result<Influence<T, ROWS, PLANES>, Error> {
        let mut influence = match self.before {
            Some(known) => known,
            None => Influence::new(self.plan.rows, self.plan.planes)?,
        };
        let Some(baseline) = &self.baseline else {
            return if self.before.is_some() { Ok(influence) } else { Err(Error::TooEarly) };
        };
        let (mut before, mut known) = (baseline, [T::zero(); PLANES]);
        for trial in &self.trials {
            let so_far = pick(&known, trial.plane, T::zero());
            let (from, to) = (&before.readings, &trial.run.readings);
            let all = influence.learn_further(trial.plane, from, to, trial.weight, so_far)?;
            super::matrix::put(&mut known, trial.plane, all);
            if self.plan.leave_trials {
                before = &trial.run;
            }
        }
        Ok(influence)
    }

    /// The vibration as it is now: the last verification, or the last trial run where the trial weights stay, or the
    /// baseline.
    fn now(&self) -> Option<&Run<T, ROWS>> {
        let verified = self.installed.iter().rev().find_map(|placed| placed.run.as_ref());
        let trial = self.trials.last().filter(|_| self.plan.leave_trials).map(|trial| &trial.run);
        verified.or(trial).or(self.baseline.as_ref())
    }

    /// The weights to add to those on the rotor, for the correction and for each trim.
    ///
    /// # Errors
    /// [`Error::TooEarly`] before the baseline or while a correction is not verified; [`Error::PlaneUnknown`]; see
    /// [`Influence::correct`].
    pub fn correction(&self) -> Result<Correction<T, ROWS, PLANES>, Error> {
        if self.installed.last().is_some_and(|placed| placed.run.is_none()) {
            return Err(Error::TooEarly);
        }
        let now = self.now().ok_or(Error::TooEarly)?;
        self.influence()?.correct(&now.readings, &self.plan.aim)
    }

    /// Enters the weights actually installed, which may differ from those computed. Repeated before the run, it
    /// replaces the entry.
    ///
    /// # Errors
    /// [`Error::TooEarly`], [`Error::Weight`], [`Error::Size`] after the last correction there is room for.
    pub fn installed(&mut self, weights: &[Complex<T>; PLANES]) -> Result<(), Error> {
        if let Some(plane) = weights.iter().position(|weight| !super::scalar::given(*weight)) {
            return Err(Error::Weight { plane });
        }
        if let Some(plane) = self.influence()?.unknown() {
            return Err(Error::PlaneUnknown { plane });
        }
        if self.baseline.is_none() {
            return Err(Error::TooEarly);
        }
        if let Some(last) = self.installed.last_mut().filter(|last| last.run.is_none()) {
            last.weights = *weights;
            return Ok(());
        }
        self.installed.push(Installed { weights: *weights, run: None }).map_err(|_| Error::Size)
    }

    /// Gives the run with the weights that were put on last, or gives it again.
    ///
    /// # Errors
    /// [`Error::TooEarly`] where none were; an invalid run.
    pub fn verified(&mut self, run: &Run<T, ROWS>) -> Result<(), Error> {
        self.at_baseline_speed(run)?;
        let last = self.installed.last_mut().ok_or(Error::TooEarly)?;
        last.run = Some(*run);
        Ok(())
    }

    /// Undoes the last entry and returns its step; none where nothing was entered.
    pub fn undo(&mut self) -> Option<ProcedureStep> {
        if let Some(last) = self.installed.last_mut() {
            if last.run.take().is_some() {
                return Some(ProcedureStep::Verify);
            }
            self.installed.pop();
            return Some(if self.installed.is_empty() { ProcedureStep::Correction } else { ProcedureStep::Trim });
        }
        if let Some(trial) = self.trials.pop() {
            return Some(ProcedureStep::Trial { plane: trial.plane });
        }
        self.baseline.take().map(|_| ProcedureStep::Baseline)
    }

    /// The sum of the weights that corrections and trims have put on.
    pub fn weights(&self) -> [Complex<T>; PLANES] {
        let mut sum = [zero(); PLANES];
        for placed in &self.installed {
            for (sum, weight) in sum.iter_mut().zip(&placed.weights) {
                *sum += *weight;
            }
        }
        sum
    }

    fn complete(&self, run: &Run<T, ROWS>) -> Result<(), Error> {
        let speeds = run.speeds.iter().take(self.plan.rows);
        match speeds.enumerate().find(|(_, speed)| !(**speed > T::zero())) {
            Some((row, _)) => Err(Error::ReadingMissing { row }),
            None => Ok(()),
        }
    }

    fn at_baseline_speed(&self, run: &Run<T, ROWS>) -> Result<(), Error> {
        self.complete(run)?;
        self.same_speed(self.baseline.as_ref().ok_or(Error::TooEarly)?, run)
    }

    fn same_speed(&self, one: &Run<T, ROWS>, other: &Run<T, ROWS>) -> Result<(), Error> {
        for row in 0..self.plan.rows {
            let (a, b) = (pick(&one.speeds, row, T::zero()), pick(&other.speeds, row, T::zero()));
            if !((a - b).abs() <= a * self.plan.speed) {
                return Err(Error::SpeedDiffers { row });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_of_another_size_are_refused() {
        let plan = Plan::<f64, 3, 3>::usual(2, 2, 1.0);
        for (rows, planes) in [(3, 2), (2, 1)] {
            let known = Influence::new(rows, planes).unwrap();
            let refused = Procedure::<f64, 3, 3>::new(plan).unwrap().with_coefficients(known).unwrap_err();
            assert_eq!(refused, Error::Size);
        }
    }
}
