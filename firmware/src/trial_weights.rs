//! A panel that balances by trial weights: readings in rows, influence coefficients, a solution.

use driveline::balance::{Aim, Complex, Correction, Influence, Phasor, Reading};

use crate::balanced::{Adviser, CHANNELS};
use crate::panel::{DONE, Key, refused};

/// Runs and what was learnt from them; `ROWS` is channels times speeds.
pub struct TrialWeights<const ROWS: usize, const PLANES: usize> {
    run_out: [Phasor; CHANNELS],
    run: [Complex<f32>; ROWS],
    baseline: [Complex<f32>; ROWS],
    weight: Complex<f32>,
    influence: Option<Influence<f32, ROWS, PLANES>>,
    solution: Option<Correction<f32, ROWS, PLANES>>,
}

const ZERO: Complex<f32> = Complex { re: 0.0, im: 0.0 };

impl<const ROWS: usize, const PLANES: usize> TrialWeights<ROWS, PLANES> {
    fn trial(&mut self, plane: usize) -> u32 {
        match &mut self.influence {
            Some(influence) => match influence.learn(plane, &self.baseline, &self.run, self.weight) {
                Ok(()) => DONE,
                Err(_) => refused(0),
            },
            None => refused(1),
        }
    }

    fn solve(&mut self) -> u32 {
        let Some(influence) = &self.influence else { return refused(1) };
        match influence.correct(&self.run, &Aim::default()) {
            Ok(solution) => {
                self.solution = Some(solution);
                DONE
            }
            Err(_) => refused(0),
        }
    }

    fn weight(&self, plane: u32) -> Complex<f32> {
        let solution = self.solution.as_ref();
        solution.and_then(|solution| solution.weights.get(plane as usize)).copied().unwrap_or(ZERO)
    }
}

impl<const ROWS: usize, const PLANES: usize> Adviser for TrialWeights<ROWS, PLANES> {
    fn new() -> Self {
        TrialWeights {
            run_out: [Phasor::default(); CHANNELS],
            run: [ZERO; ROWS],
            baseline: [ZERO; ROWS],
            weight: ZERO,
            influence: Influence::new(ROWS, PLANES).ok(),
            solution: None,
        }
    }

    fn ask(&mut self, key: Key, value: u32, reading: Option<[Reading; CHANNELS]>) -> u32 {
        let row = self.run.get(value as usize).copied().unwrap_or(ZERO);
        match key {
            Key::RunOut => match reading {
                Some(reading) => {
                    self.run_out = reading.map(|reading| reading.phasor);
                    DONE
                }
                None => refused(0),
            },
            Key::Row => match (reading, self.run.get_mut(value as usize..)) {
                (Some(reading), Some(rows)) if rows.len() >= CHANNELS => {
                    for ((row, reading), run_out) in rows.iter_mut().zip(reading).zip(self.run_out) {
                        *row = Complex::from(reading.phasor.less(run_out));
                    }
                    DONE
                }
                _ => refused(0),
            },
            Key::Baseline => {
                self.baseline = self.run;
                DONE
            }
            Key::WeightRe => {
                self.weight.re = f32::from_bits(value);
                DONE
            }
            Key::WeightIm => {
                self.weight.im = f32::from_bits(value);
                DONE
            }
            Key::Trial => self.trial(value as usize),
            Key::Solve => self.solve(),
            Key::AddRe => self.weight(value).re.to_bits(),
            Key::AddIm => self.weight(value).im.to_bits(),
            Key::RowRe => row.re.to_bits(),
            Key::RowIm => row.im.to_bits(),
            Key::Predicted => self.solution.as_ref().map_or(0, |solution| solution.rms.to_bits()),
            Key::Condition => self.solution.as_ref().map_or(0, |solution| solution.condition.to_bits()),
            Key::Begin | Key::State | Key::Step | Key::HeadRe | Key::HeadIm => refused(2),
        }
    }
}
