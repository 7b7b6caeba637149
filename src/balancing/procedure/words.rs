//! Everything entered into a procedure as words that a firmware can store.

use super::{CORRECTIONS, Installed, Plan, Procedure, Run, Trial};
use crate::balancing::error::Error;
use crate::balancing::matrix::put;
use crate::balancing::scalar::{Complex, Scalar, zero};

/// First word of a record: "BAL" and its version.
const MARK: u32 = 0x4241_4c01;

impl<T: Scalar, const ROWS: usize, const PLANES: usize, const TRIALS: usize> Procedure<T, ROWS, PLANES, TRIALS> {
    /// The most words that a record of this many readings and planes takes.
    pub const fn words(rows: usize, planes: usize) -> usize {
        let run = 3 * rows * T::WORDS;
        // mark, sum, four numbers of the plan, three counts
        9 + run + TRIALS * (1 + 2 * T::WORDS + run) + CORRECTIONS * (1 + 2 * planes * T::WORDS + run)
    }

    /// Writes every entry as words and returns their number. The plan and coefficients that were known before are not
    /// in it.
    ///
    /// # Errors
    /// [`Error::Size`] where there are not enough words.
    pub fn record(&self, words: &mut [u32]) -> Result<usize, Error> {
        let mut to = Writer { words, at: 0 };
        to.word(MARK)?;
        to.word(0)?;
        for number in [self.plan.rows, self.plan.planes, usize::from(self.plan.leave_trials), T::WORDS] {
            to.word(number as u32)?;
        }
        to.word(u32::from(self.baseline.is_some()))?;
        if let Some(run) = &self.baseline {
            to.run(run, self.plan.rows)?;
        }
        to.word(self.trials.len() as u32)?;
        for trial in &self.trials {
            to.word(trial.plane as u32)?;
            to.complex(trial.weight)?;
            to.run(&trial.run, self.plan.rows)?;
        }
        to.word(self.installed.len() as u32)?;
        for placed in &self.installed {
            for weight in placed.weights.iter().take(self.plan.planes) {
                to.complex(*weight)?;
            }
            to.word(u32::from(placed.run.is_some()))?;
            if let Some(run) = &placed.run {
                to.run(run, self.plan.rows)?;
            }
        }
        let length = to.at;
        let sum = sum_of(words.get(2..length).unwrap_or(&[]));
        put(words, 1, sum);
        Ok(length)
    }

    /// Goes on from a record: a procedure of the same plan with everything entered.
    ///
    /// # Errors
    /// [`Error::Record`] with the word at which it is not one of this plan, or damaged.
    pub fn resume(plan: Plan<T, ROWS, PLANES>, words: &[u32]) -> Result<Self, Error> {
        let mut procedure = Procedure::new(plan)?;
        let mut from = Reader { words, at: 0 };
        from.require(MARK)?;
        let sum = from.word()?;
        for number in [plan.rows, plan.planes, usize::from(plan.leave_trials), T::WORDS] {
            from.require(number as u32)?;
        }
        if from.flag()? {
            procedure.baseline = Some(from.run(plan.rows)?);
        }
        for _ in 0..from.count(TRIALS)? {
            let plane = from.count(PLANES)?;
            let trial = Trial { plane, weight: from.complex()?, run: from.run(plan.rows)? };
            procedure.trials.push(trial).map_err(|_| from.wrong())?;
        }
        for _ in 0..from.count(CORRECTIONS)? {
            let mut weights = [zero(); PLANES];
            for weight in weights.iter_mut().take(plan.planes) {
                *weight = from.complex()?;
            }
            let run = if from.flag()? { Some(from.run(plan.rows)?) } else { None };
            procedure.installed.push(Installed { weights, run }).map_err(|_| from.wrong())?;
        }
        if sum_of(words.get(2..from.at).unwrap_or(&[])) != sum {
            return Err(Error::Record { word: 1 });
        }
        Ok(procedure)
    }
}

/// FNV-1a over words.
fn sum_of(words: &[u32]) -> u32 {
    words.iter().fold(0x811c_9dc5, |sum, word| (sum ^ word).wrapping_mul(0x0100_0193).rotate_left(5))
}

struct Writer<'w> {
    words: &'w mut [u32],
    at: usize,
}

impl Writer<'_> {
    fn word(&mut self, word: u32) -> Result<(), Error> {
        *self.words.get_mut(self.at).ok_or(Error::Size)? = word;
        self.at += 1;
        Ok(())
    }

    fn number<T: Scalar>(&mut self, value: T) -> Result<(), Error> {
        let words = value.to_words();
        for word in words.into_iter().take(T::WORDS) {
            self.word(word)?;
        }
        Ok(())
    }

    fn complex<T: Scalar>(&mut self, value: Complex<T>) -> Result<(), Error> {
        self.number(value.re)?;
        self.number(value.im)
    }

    fn run<T: Scalar, const ROWS: usize>(&mut self, run: &Run<T, ROWS>, rows: usize) -> Result<(), Error> {
        for (reading, speed) in run.readings.iter().zip(&run.speeds).take(rows) {
            self.complex(*reading)?;
            self.number(*speed)?;
        }
        Ok(())
    }
}

struct Reader<'w> {
    words: &'w [u32],
    at: usize,
}

impl Reader<'_> {
    /// The word read last is wrong.
    fn wrong(&self) -> Error {
        Error::Record { word: self.at.saturating_sub(1) }
    }

    fn word(&mut self) -> Result<u32, Error> {
        let word = self.words.get(self.at).copied();
        self.at += 1;
        word.ok_or(self.wrong())
    }

    fn require(&mut self, expected: u32) -> Result<(), Error> {
        if self.word()? == expected { Ok(()) } else { Err(self.wrong()) }
    }

    fn flag(&mut self) -> Result<bool, Error> {
        Ok(self.count(1)? == 1)
    }

    fn count(&mut self, most: usize) -> Result<usize, Error> {
        let count = self.word()? as usize;
        if count <= most { Ok(count) } else { Err(self.wrong()) }
    }

    fn number<T: Scalar>(&mut self) -> Result<T, Error> {
        let mut words = [0; 2];
        for word in words.iter_mut().take(T::WORDS) {
            *word = self.word()?;
        }
        let value = T::from_words(words);
        if value.is_finite() { Ok(value) } else { Err(self.wrong()) }
    }

    fn complex<T: Scalar>(&mut self) -> Result<Complex<T>, Error> {
        Ok(Complex { re: self.number()?, im: self.number()? })
    }

    fn run<T: Scalar, const ROWS: usize>(&mut self, rows: usize) -> Result<Run<T, ROWS>, Error> {
        let mut run = Run { readings: [zero(); ROWS], speeds: [T::zero(); ROWS] };
        for (reading, speed) in run.readings.iter_mut().zip(&mut run.speeds).take(rows) {
            *reading = self.complex()?;
            *speed = self.number()?;
        }
        Ok(run)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nine words of its own; 3 numbers for each reading of a run; a plane, a weight of two numbers and a run for each
    /// trial; a flag, a weight for each plane and a run for each of six corrections.
    #[test]
    fn the_words_of_a_record() {
        assert_eq!(Procedure::<f32, 3, 3, 2>::words(1, 1), 9 + 3 + 2 * (1 + 2 + 3) + 6 * (1 + 2 + 3));
        assert_eq!(Procedure::<f64, 3, 3>::words(3, 2), 9 + 18 + 3 * (1 + 4 + 18) + 6 * (1 + 8 + 18));
    }
}
