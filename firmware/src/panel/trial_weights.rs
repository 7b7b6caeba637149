//! A panel that balances by trial weights: the library's procedure, and the readings that make up its runs.
//!
//! After every entry the run-out and the procedure go into a record in flash; with power on again, [`Key::Resume`] goes
//! on from there. The zero of the phases has to be the same then: an absolute encoder's, or an index's.

use core::marker::PhantomData;

use driveline::balancing::{Complex, Correction, Error, Phasor, Plan, Procedure, ProcedureRecord, ProcedureStep, Run};
use driveline::parameters::Store;

use super::flash_model::{self, Pages};
use crate::scene::balanced::{Adviser, CHANNELS, Measured};
use crate::scene::panel_keys::{DONE, Key, next, refused};

/// Tolerance of the residual.
pub trait Goal {
    /// The largest residual (unit of the sensors).
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
    flash: Pages,
    /// Where the next word is put.
    place: u32,
}

/// Words of a record, of which the run-out has some; both go into a page of the flash.
const WORDS: usize = 192;
const RUN_OUT: usize = 2 * CHANNELS;
const BYTES: usize = 1024;
/// The whole flash.
const RANGE: core::ops::Range<u32> = 0..4 * flash_model::WORDS as u32;

const ZERO: Complex<f32> = Complex { re: 0.0, im: 0.0 };

/// Answers: rejected by the procedure, no procedure, no reading, key of another panel.
const BY_PROCEDURE: u32 = refused(0);
const NO_PROCEDURE: u32 = refused(1);
const NO_READING: u32 = refused(2);
const NO_KEY: u32 = refused(3);
const NOT_KEPT: u32 = refused(4);
const NOTHING_KEPT: u32 = refused(5);

impl<G: Goal, const ROWS: usize, const PLANES: usize> TrialWeights<G, ROWS, PLANES> {
    /// Gives the procedure the run.
    fn give(
        &mut self,
        entry: impl FnOnce(&mut Procedure<f32, ROWS, PLANES>, &Run<f32, ROWS>) -> Result<(), Error>,
    ) -> u32 {
        let Some(procedure) = &mut self.procedure else { return NO_PROCEDURE };
        match Run::new(&self.run, &self.speeds).and_then(|run| entry(procedure, &run)) {
            Ok(()) => self.save(),
            Err(_) => BY_PROCEDURE,
        }
    }

    /// Keeps the entries.
    fn save(&mut self) -> u32 {
        const { assert!(Procedure::<f32, ROWS, PLANES>::words(ROWS, PLANES) + RUN_OUT <= WORDS) };
        let Some(procedure) = &self.procedure else { return NO_PROCEDURE };
        let mut own = [0; RUN_OUT];
        for (words, run_out) in own.as_chunks_mut::<2>().0.iter_mut().zip(self.run_out) {
            *words = [run_out.re.to_bits(), run_out.im.to_bits()];
        }
        let Ok(record) = ProcedureRecord::<WORDS>::of(procedure, &own) else { return NOT_KEPT };
        match Store::new(&mut self.flash, RANGE).and_then(|mut store| store.save(&record, &mut [0; BYTES])) {
            Ok(()) => DONE,
            Err(_) => NOT_KEPT,
        }
    }

    /// Resumes from the kept record.
    fn resume(&mut self) -> u32 {
        let loaded = Store::new(&mut self.flash, RANGE).and_then(|mut store| store.load(&mut [0; BYTES]));
        let Some(record) = loaded.ok().and_then(|loaded| loaded.parameters) else { return NOTHING_KEPT };
        let record: ProcedureRecord<WORDS> = record;
        let mut own = [0; RUN_OUT];
        let Ok(procedure) = record.resume(Self::plan(), &mut own) else { return NOTHING_KEPT };
        for (run_out, [re, im]) in self.run_out.iter_mut().zip(own.as_chunks::<2>().0) {
            *run_out = Phasor { re: f32::from_bits(*re), im: f32::from_bits(*im) };
        }
        (self.procedure, self.solution) = (Some(procedure), None);
        DONE
    }

    fn plan() -> Plan<f32, ROWS, PLANES> {
        Plan::usual(ROWS, PLANES, G::GOOD)
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
            (Some(procedure), Some(solution)) => match procedure.installed(&solution.weights) {
                Ok(()) => self.save(),
                Err(_) => BY_PROCEDURE,
            },
            _ => NO_PROCEDURE,
        }
    }

    fn next(&self) -> u32 {
        match self.procedure.as_ref().map(Procedure::next) {
            Some(ProcedureStep::Baseline) => next::BASELINE,
            Some(ProcedureStep::Trial { plane }) => next::TRIAL + plane as u32,
            Some(ProcedureStep::Correction) => next::CORRECTION,
            Some(ProcedureStep::Verify) => next::VERIFY,
            Some(ProcedureStep::Trim) => next::TRIM,
            Some(ProcedureStep::Done) => next::DONE,
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
            procedure: Procedure::new(Self::plan()).ok(),
            solution: None,
            flash: Pages::new(),
            place: 0,
        }
    }

    fn ask(&mut self, key: Key, value: u32, measured: Option<Measured>) -> u32 {
        let row = self.run.get(value as usize).copied().unwrap_or(ZERO);
        let (plane, weight) = (value as usize, self.weight);
        match (key, measured) {
            (Key::RunOut, Some(measured)) => {
                self.run_out = measured.readings.map(|reading| reading.phasor);
                self.save()
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
            (Key::TakeBack, _) => match self.procedure.as_mut().and_then(Procedure::undo) {
                Some(_) => self.save(),
                None => NO_PROCEDURE,
            },
            (Key::RowRe, _) => row.re.to_bits(),
            (Key::RowIm, _) => row.im.to_bits(),
            (Key::Predicted, _) => self.solution.as_ref().map_or(0, |solution| solution.rms.to_bits()),
            (Key::Condition, _) => self.solution.as_ref().map_or(0, |solution| solution.condition.to_bits()),
            (Key::Resume, _) => self.resume(),
            (Key::FlashWord, _) => self.flash.word(value),
            (Key::PutPlace, _) => {
                self.place = value;
                DONE
            }
            (Key::PutWord, _) => {
                let put = self.flash.put(self.place, value);
                self.place = self.place.saturating_add(1);
                if put { DONE } else { NOT_KEPT }
            }
            (Key::Begin | Key::State | Key::Balance | Key::HeadRe | Key::HeadIm | Key::Grade, _) => NO_KEY,
        }
    }
}
