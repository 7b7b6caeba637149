//! Further functions off the tick, each once as a panel calls it: in-run balancing, holes, amplitudes alone, the
//! procedure from its beginning to its record and back, sensors and grades. Linking of this image shows that none of it
//! can panic.

use driveline::balancing::{
    Action, Aim, BalanceTolerance, Complex, CorrectionMethod, Entry, Error, Holes, InRun, InRunConfig, Influence,
    Objective, Plan, Procedure, ProcedureRecord, Run, degrees, from_amplitudes, resultant, two_planes,
};
use driveline::parameters::Store;

use super::Bench;
use crate::Words;
use crate::board::Board;
use crate::panel::flash_model::Pages;
use crate::self_test::inputs::Program;

/// Measures all of it.
pub fn all<B: Board>(bench: &mut Bench<'_, B>) {
    bench.measure_long("balance/in-run", Words::Single, readings::<8>, in_run);
    bench.measure_long("balance/holes", Words::Single, complex, holes);
    bench.measure_long("balance/amplitudes", Words::Single, amplitudes, by_amplitudes);
    bench.measure_long("balance/procedure", Words::Single, readings::<8>, procedure);
    bench.measure_long("balance/grade", Words::Single, readings::<2>, grade);
}

/// Two readings of each run.
type Readings<const RUNS: usize> = [[Complex<f32>; 2]; RUNS];

fn number(inputs: &mut Program) -> f32 {
    f32::from_bits(inputs.next_word())
}

fn complex(inputs: &mut Program) -> Complex<f32> {
    Complex { re: number(inputs), im: number(inputs) }
}

fn readings<const RUNS: usize>(inputs: &mut Program) -> Readings<RUNS> {
    core::array::from_fn(|_| core::array::from_fn(|_| complex(inputs)))
}

const HEADS: InRunConfig<f32, 2> =
    InRunConfig { probe: 0.1, limits: [5.0; 2], step: 3.0, bound: 1.3, target: 0.01, forgetting: 0.7, noise: 0.01 };

/// Eight readings with two heads, from nothing known and from a model.
#[inline(never)]
fn in_run(_: &mut (), readings: &Readings<8>, weights: &mut [Complex<f32>; 2]) {
    let Ok(mut blind) = InRun::<f32, 2, 2>::new(HEADS, 2, [Complex { re: 0.0, im: 0.0 }; 2]) else { return };
    let Ok(mut model) = Influence::new(2, 2) else { return };
    for (plane, column) in readings.iter().take(2).enumerate() {
        if model.set(plane, column).is_err() {
            return;
        }
    }
    let Ok(mut known) = blind.with_model(&model, 0.1) else { return };
    for reading in readings {
        for in_run in [&mut blind, &mut known] {
            match in_run.advise(reading, 1e-4) {
                Action::Set(to) | Action::Abort(to, _) => {
                    in_run.installed(&to);
                    *weights = to;
                }
                Action::Hold => *weights = *in_run.weights(),
            }
        }
    }
    if let (Some(level), (influence, deviation)) = (blind.level(), known.influence(1, 1)) {
        weights[0] += influence.scale(level * deviation);
    }
}

/// Twelve holes, six weights.
#[inline(never)]
fn holes(_: &mut (), wanted: &Complex<f32>, sum: &mut Complex<f32>) {
    let angles: [f32; 12] = core::array::from_fn(|hole| hole as f32 * (core::f32::consts::TAU / 12.0));
    let mode = if wanted.re > 0.0 { CorrectionMethod::Adding } else { CorrectionMethod::Removing };
    let holes = Holes { angles: &angles, weights: &[0.1, 0.2, 0.5, 1.0, 2.0, 5.0], method: mode };
    if let Ok(fitted) = holes.fit(*wanted) {
        *sum = fitted.sum;
    }
}

fn amplitudes(inputs: &mut Program) -> [f32; 5] {
    core::array::from_fn(|_| number(inputs))
}

/// Four runs, and two of them.
#[inline(never)]
fn by_amplitudes(_: &mut (), amplitudes: &[f32; 5], weights: &mut [Complex<f32>; 2]) {
    let [baseline, a, b, c, d] = *amplitudes;
    let runs = [(0.0, a), (1.5, b), (3.0, c), (4.5, d)];
    for (weight, count) in weights.iter_mut().zip([4, 2]) {
        if let Ok(found) = runs.get(..count).map_or(Err(Error::Size), |runs| from_amplitudes(baseline, 1.0, runs)) {
            *weight = found.or.unwrap_or(found.weight);
        }
    }
}

type Field = Procedure<f32, 2, 2, 3>;

/// Baseline, three trial runs, correction, verification, and all of it into a flash and out of it again.
#[inline(never)]
fn procedure(_: &mut (), readings: &Readings<8>, weights: &mut [Complex<f32>; 2]) {
    if let Ok(found) = field(readings) {
        *weights = found;
    }
}

#[inline(always)]
fn field(readings: &Readings<8>) -> Result<[Complex<f32>; 2], Error> {
    let mut entry = Entry::new();
    let trial = entry.polar(1.0, 40.0);
    let mut aim = Aim { objective: Objective::LeastSquares, ..Aim::default() };
    aim.limits[0] = Some(degrees(trial).0 * 100.0);
    let plan = Plan { aim, ..Plan::usual(2, 2, 0.1) };
    let mut field = Field::new(plan)?;
    let run = |at: usize| readings.get(at).map_or(Err(Error::Size), |readings| Run::new(readings, &[100.0; 2]));
    field.baseline(&run(0)?)?;
    field.trial(0, trial, &run(1)?)?;
    field.trial(1, trial, &run(2)?)?;
    field.trial(1, trial, &run(3)?)?;
    field.extra_trial(0, trial, &run(4)?)?;
    field.installed(&field.correction()?.weights)?;
    field.verified(&run(5)?)?;
    field.undo();
    field.verified(&run(6)?)?;
    entry.check()?;

    let mut flash = Pages::new();
    let Ok(mut store) = Store::new(&mut flash, 0..2048) else { return Err(Error::Size) };
    let record = ProcedureRecord::<{ Field::words(2, 2) + 1 }>::of(&field, &[7])?;
    if store.save(&record, &mut [0; 1024]).is_err() {
        return Err(Error::Size);
    }
    let Ok(loaded) = store.load::<ProcedureRecord<{ Field::words(2, 2) + 1 }>>(&mut [0; 1024]) else {
        return Err(Error::Size);
    };
    let field: Field = loaded.parameters.ok_or(Error::Size)?.resume(plan, &mut [0])?;
    let mut known = Field::new(plan)?.with_coefficients(field.influence()?)?;
    known.baseline(&run(7)?)?;
    known.next();
    Ok(known.correction()?.weights)
}

/// Two planes, the tolerance and the verdict.
#[inline(never)]
fn grade(_: &mut (), readings: &Readings<2>, grade: &mut f32) {
    let [[a, b], [c, d]] = *readings;
    let along = [(a, 0.1), (b, 0.4), (c, 0.5), (d, 0.9)];
    let Ok(planes) = two_planes(along, 0.0, 1.0) else { return };
    let tolerance = BalanceTolerance { grade: 2.5, mass: 100.0, speed: 150.0 };
    let (Ok(whole), Ok(bearings)) = (tolerance.permissible(), tolerance.at_bearings(0.4, 1.0)) else { return };
    if let Ok(verdict) = tolerance.judge(resultant(&planes)) {
        *grade = verdict.grade + verdict.fulfils.unwrap_or(whole) + bearings[0];
    }
}
