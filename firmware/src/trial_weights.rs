//! A panel that balances by trial weights: the library's procedure, and the readings that make up its runs.

use core::marker::PhantomData;

use driveline::balance::{Complex, Correction, Phasor, Plan, Procedure, Refusal, Run, Step};

use crate::balanced::{Adviser, CHANNELS, Measured};
use crate::panel::{DONE, Key, next, refused};

/// What is good enough.
pub trait Goal {
    /// The largest residual \[unit of the sensors\].
    const GOOD: f32;
}

/// A procedure under way, and the run that is being made; `ROWS` is channels times speeds.
pub struct TrialWeights<G, const ROWS: usize, const PLANES: usize> {
    goal: PhantomData<G>,
    run_out: [Phasor; CHANNELS],
    run: [Complex<f32>; ROWS],
    speeds: [f32; ROWS],
    weight: Complex<f32>,
    procedure: Option<Procedure<f32, ROWS, PLANES>>,
    solution: Option<Correction<f32, ROWS, PLANES>>,
}

const ZERO: Complex<f32> = Complex { re: 0.0, im: 0.0 };

/// Answers: the procedure refused, there is none, there is no reading, the key is another panel's.
const BY_PROCEDURE: u32 = refused(0);
const NO_PROCEDURE: u32 = refused(1);
const NO_READING: u32 = refused(2);
const NO_KEY: u32 = refused(3);

impl<G: Goal, const ROWS: usize, const PLANES: usize> TrialWeights<G, ROWS, PLANES> {
    /// Gives the procedure the run.
    fn give(
        &mut self,
        entry: impl FnOnce(&mut Procedure<f32, ROWS, PLANES>, &Run<f32, ROWS>) -> Result<(), Refusal>,
    ) -> u32 {
        let Some(procedure) = &mut self.procedure else { return NO_PROCEDURE };
        match Run::new(&self.run, &self.speeds).and_then(|run| entry(procedure, &run)) {
            Ok(()) => DONE,
            Err(_) => BY_PROCEDURE,
        }
    }

    fn keep(&mut self, row: usize, measured: &Measured) -> u32 {
        let (Some(rows), Some(speeds)) = (self.run.get_mut(row..), self.speeds.get_mut(row..)) else {
            return NO_READING;
        };
        for (((row, speed), reading), run_out) in rows.iter_mut().zip(speeds).zip(measured.readings).zip(self.run_out) {
            (*row, *speed) = (Complex::from(reading.phasor.less(run_out)), measured.speed);
        }
        DONE
    }

    fn solve(&mut self) -> u32 {
        match self.procedure.as_ref().map(Procedure::correction) {
            Some(Ok(solution)) => {
                self.solution = Some(solution);
                DONE
            }
            Some(Err(_)) => BY_PROCEDURE,
            None => NO_PROCEDURE,
        }
    }

    fn placed(&mut self) -> u32 {
        match (&mut self.procedure, &self.solution) {
            (Some(procedure), Some(solution)) => match procedure.placed(&solution.weights) {
                Ok(()) => DONE,
                Err(_) => BY_PROCEDURE,
            },
            _ => NO_PROCEDURE,
        }
    }

    fn next(&self) -> u32 {
        match self.procedure.as_ref().map(Procedure::next) {
            Some(Step::Baseline) => next::BASELINE,
            Some(Step::Trial { plane }) => next::TRIAL + plane as u32,
            Some(Step::Correction) => next::CORRECTION,
            Some(Step::Verify) => next::VERIFY,
            Some(Step::Trim) => next::TRIM,
            Some(Step::Done) => next::DONE,
            None => 0,
        }
    }

    fn weight(&self, plane: u32) -> Complex<f32> {
        let solution = self.solution.as_ref();
        solution.and_then(|solution| solution.weights.get(plane as usize)).copied().unwrap_or(ZERO)
    }
}

impl<G: Goal, const ROWS: usize, const PLANES: usize> Adviser for TrialWeights<G, ROWS, PLANES> {
    fn new() -> Self {
        TrialWeights {
            goal: PhantomData,
            run_out: [Phasor::default(); CHANNELS],
            run: [ZERO; ROWS],
            speeds: [0.0; ROWS],
            weight: ZERO,
            procedure: Procedure::new(Plan::usual(ROWS, PLANES, G::GOOD)).ok(),
            solution: None,
        }
    }

    fn ask(&mut self, key: Key, value: u32, measured: Option<Measured>) -> u32 {
        let row = self.run.get(value as usize).copied().unwrap_or(ZERO);
        let (plane, weight) = (value as usize, self.weight);
        match (key, measured) {
            (Key::RunOut, Some(measured)) => {
                self.run_out = measured.readings.map(|reading| reading.phasor);
                DONE
            }
            (Key::Row, Some(measured)) => self.keep(value as usize, &measured),
            (Key::RunOut | Key::Row, None) => NO_READING,
            (Key::Next, _) => self.next(),
            (Key::Baseline, _) => self.give(Procedure::baseline),
            (Key::WeightRe, _) => {
                self.weight.re = f32::from_bits(value);
                DONE
            }
            (Key::WeightIm, _) => {
                self.weight.im = f32::from_bits(value);
                DONE
            }
            (Key::Trial, _) => self.give(|procedure, run| procedure.trial(plane, weight, run)),
            (Key::Solve, _) => self.solve(),
            (Key::AddRe, _) => self.weight(value).re.to_bits(),
            (Key::AddIm, _) => self.weight(value).im.to_bits(),
            (Key::Placed, _) => self.placed(),
            (Key::Verified, _) => self.give(Procedure::verified),
            (Key::TakeBack, _) => match self.procedure.as_mut().and_then(Procedure::take_back) {
                Some(_) => DONE,
                None => NO_PROCEDURE,
            },
            (Key::RowRe, _) => row.re.to_bits(),
            (Key::RowIm, _) => row.im.to_bits(),
            (Key::Predicted, _) => self.solution.as_ref().map_or(0, |solution| solution.rms.to_bits()),
            (Key::Condition, _) => self.solution.as_ref().map_or(0, |solution| solution.condition.to_bits()),
            (Key::Begin | Key::State | Key::Step | Key::HeadRe | Key::HeadIm, _) => NO_KEY,
        }
    }
}
