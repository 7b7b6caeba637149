//! The procedure on a rotor: step by step, back and again, cut off and resumed, and used wrongly.

use driveline::balancing::{Aim, Complex, Error, Influence, Plan, Procedure, ProcedureStep, Run};

use crate::noise::Noise;

type Field = Procedure<f64, 4, 2>;
type Model = Influence<f64, 4, 2>;

fn z(re: f64, im: f64) -> Complex<f64> {
    Complex::new(re, im)
}

/// A fan: two planes, two sensors.
struct Fan {
    influence: Model,
    vibration: Vec<Complex<f64>>,
    on: [Complex<f64>; 2],
}

const SPEED: f64 = 157.0;

impl Fan {
    fn new() -> Self {
        let mut noise = Noise::new(31);
        let mut z = |size: f64| Complex::new(size * noise.normal(), size * noise.normal());
        let mut influence = Model::new(2, 2).unwrap();
        for plane in 0..2 {
            influence.set(plane, &[z(1.0), z(1.0)]).unwrap();
        }
        Fan { influence, vibration: vec![z(7.0), z(7.0)], on: [Complex::new(0.0, 0.0); 2] }
    }

    fn run(&self) -> Run<f64, 4> {
        let readings = self.influence.predict(&self.vibration, &self.on).unwrap();
        Run::new(&readings[..2], &[SPEED; 2]).unwrap()
    }
}

fn plan(leave_trials: bool) -> Plan<f64, 4, 2> {
    Plan { leave_trials, ..Plan::usual(2, 2, 1e-9) }
}

/// Does what the procedure asks for until it is done, putting on weights that are off by a hundredth; after each step
/// it is cut off.
fn field(leave_trials: bool) -> (Fan, Field, Vec<ProcedureStep>) {
    let mut fan = Fan::new();
    let mut field = Field::new(plan(leave_trials)).unwrap();
    let mut steps = Vec::new();
    let mut words = [0_u32; 300];
    loop {
        let step = field.next();
        steps.push(step);
        match step {
            ProcedureStep::Baseline => field.baseline(&fan.run()).unwrap(),
            ProcedureStep::Trial { plane } => {
                let trial = Complex::new(1.5, 0.5);
                fan.on[plane] += trial;
                field.trial(plane, trial, &fan.run()).unwrap();
                if !leave_trials {
                    fan.on[plane] -= trial;
                }
            }
            ProcedureStep::Correction | ProcedureStep::Trim => {
                let weights = field.correction().unwrap().weights;
                let off = if step == ProcedureStep::Trim { 1.0 } else { 1.01 };
                let put = weights.map(|w| w * off);
                for (on, put) in fan.on.iter_mut().zip(&put) {
                    *on += put;
                }
                field.installed(&put).unwrap();
            }
            ProcedureStep::Verify => field.verified(&fan.run()).unwrap(),
            ProcedureStep::Done => return (fan, field, steps),
        }
        let length = field.record(&mut words).unwrap();
        let resumed = Field::resume(plan(leave_trials), &words[..length]).unwrap();
        assert_eq!(resumed, field);
        field = resumed;
        assert!(steps.len() < 20);
    }
}

#[test]
fn through_all_steps_and_every_power_cut() {
    for leave_trials in [false, true] {
        let (fan, field, steps) = self::field(leave_trials);
        let expected = [
            ProcedureStep::Baseline,
            ProcedureStep::Trial { plane: 0 },
            ProcedureStep::Trial { plane: 1 },
            ProcedureStep::Correction,
            ProcedureStep::Verify,
            ProcedureStep::Trim,
            ProcedureStep::Verify,
            ProcedureStep::Done,
        ];
        assert_eq!(steps, expected);
        assert!(fan.run().readings().iter().all(|reading| reading.norm() < 1e-9));
        let trials = if leave_trials { Complex::new(1.5, 0.5) } else { Complex::new(0.0, 0.0) };
        for (on, corrected) in fan.on.iter().zip(field.weights()) {
            assert!((on - corrected - trials).norm() < 1e-12);
        }
    }
}

#[test]
fn steps_are_taken_back_and_given_again() {
    let (_, mut field, steps) = self::field(false);
    let whole = field.clone();
    let mut back = Vec::new();
    while let Some(step) = field.undo() {
        // what was taken back is what comes next
        assert_eq!(field.next(), step);
        back.push(step);
    }
    back.reverse();
    assert_eq!(back, steps[..steps.len() - 1]);
    assert_eq!(field, Field::new(plan(false)).unwrap());

    // a trial run given again counts, and the coefficients follow
    let mut again = whole.clone();
    let fan = Fan::new();
    let mut with = fan.influence;
    with.set(0, &[Complex::new(2.0, 0.0), Complex::new(0.0, 1.0)]).unwrap();
    let readings = with.predict(&fan.vibration, &[Complex::new(3.0, 0.0), Complex::new(0.0, 0.0)]).unwrap();
    again.trial(0, Complex::new(3.0, 0.0), &Run::new(&readings[..2], &[SPEED; 2]).unwrap()).unwrap();
    assert!((again.influence().unwrap().get(0, 0).unwrap() - Complex::new(2.0, 0.0)).norm() < 1e-12);
    assert_eq!(again.influence().unwrap().get(1, 1), whole.influence().unwrap().get(1, 1));
}

/// A plane tried again: given again it is replaced, given further it counts with the others, and where weights stay a
/// later run forbids the first.
#[test]
fn a_plane_is_tried_again_or_further() {
    type Roomy = Procedure<f64, 4, 2, 5>;
    for stays in [false, true] {
        let mut fan = Fan::new();
        let mut field = Roomy::new(plan(stays)).unwrap();
        field.baseline(&fan.run()).unwrap();
        for (plane, weight) in
            [(0, z(1.0, 0.5)), (1, z(0.5, -1.0)), (0, z(-0.3, 1.0)), (1, z(2.0, 0.0)), (0, z(0.7, 0.1))]
        {
            fan.on[plane] += weight;
            field.extra_trial(plane, weight, &fan.run()).unwrap();
            if !stays {
                fan.on[plane] -= weight;
            }
        }
        assert_eq!(field.extra_trial(0, z(1.0, 0.0), &fan.run()), Err(Error::Size));
        for (row, plane) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            // rounding of five runs of size 10
            let (got, truth) = (field.influence().unwrap().get(row, plane), fan.influence.get(row, plane));
            assert!((got.unwrap() - truth.unwrap()).norm() < 1e-13);
        }
        // which of the three is meant to be replaced cannot be known
        let kept = field.clone();
        assert_eq!(field.trial(0, z(1.0, 0.0), &fan.run()), Err(Error::TrialRepeated { plane: 0 }));
        assert_eq!(field, kept);
        let mut words = [0; 300];
        let length = field.record(&mut words).unwrap();
        assert_eq!(Roomy::resume(plan(stays), &words[..length]), Ok(field));
        // a procedure with less room does not take it
        assert!(matches!(Field::resume(plan(stays), &words[..length]), Err(Error::Record { .. })));
    }
    // weights that stay: the last trial may be given again, one below another one not
    let mut fan = Fan::new();
    let mut field = Field::new(plan(true)).unwrap();
    field.baseline(&fan.run()).unwrap();
    for plane in 0..2 {
        fan.on[plane] += z(9.0, 9.0);
        field.trial(plane, z(1.0, 0.0), &fan.run()).unwrap();
        if plane == 0 {
            // it was not one but nine and nine
            field.trial(plane, z(9.0, 9.0), &fan.run()).unwrap();
        }
    }
    assert_eq!(field.trial(0, z(9.0, 9.0), &fan.run()), Err(Error::TrialRepeated { plane: 0 }));
    field.trial(1, z(9.0, 9.0), &fan.run()).unwrap();
    assert!((field.influence().unwrap().get(0, 0).unwrap() - fan.influence.get(0, 0).unwrap()).norm() < 1e-13);
    assert!((field.influence().unwrap().get(0, 1).unwrap() - fan.influence.get(0, 1).unwrap()).norm() < 1e-13);
    assert_eq!(
        Error::TrialRepeated { plane: 0 }.to_string(),
        "plane 1 has its trial run already: undo it, or enter an extra one"
    );
}

/// A reading that is weighted with zero keeps no procedure from its end, and is in no residual.
#[test]
fn a_reading_that_is_left_out_is_in_no_residual() {
    let run = |readings: [Complex<f64>; 3]| Run::new(&readings, &[SPEED; 3]).unwrap();
    let tried = |weighting: f64| {
        let mut aim = Aim::default();
        aim.weighting[2] = weighting;
        let mut field = Field::new(Plan { aim, ..Plan::usual(3, 2, 0.1) }).unwrap();
        field.baseline(&run([z(5.0, 0.0), z(0.0, 3.0), z(50.0, 0.0)])).unwrap();
        field.trial(0, z(1.0, 0.0), &run([z(6.0, 0.0), z(0.0, 3.0), z(50.0, 0.0)])).unwrap();
        field.trial(1, z(1.0, 0.0), &run([z(5.0, 0.0), z(1.0, 3.0), z(50.0, 0.0)])).unwrap();
        field
    };
    let mut field = tried(0.0);
    let correction = field.correction().unwrap();
    // influences of one: two readings vanish, and the third, which no plane changes, stays
    assert!(
        correction.rms < 1e-15 && correction.largest < 1e-15 && (correction.residual[2].norm() - 50.0).abs() < 1e-12
    );
    field.installed(&correction.weights).unwrap();
    field.verified(&run([z(0.05, 0.0), z(0.0, 0.05), z(50.0, 0.0)])).unwrap();
    assert_eq!(field.next(), ProcedureStep::Done);
    // and counts as soon as it is weighted
    assert!((tried(1.0).correction().unwrap().rms - 50.0 / 3_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn known_coefficients_need_no_trial_runs() {
    let mut fan = Fan::new();
    let mut field = Field::new(plan(false)).unwrap().with_coefficients(fan.influence).unwrap();
    field.baseline(&fan.run()).unwrap();
    assert_eq!(field.next(), ProcedureStep::Correction);
    fan.on = field.correction().unwrap().weights[..2].try_into().unwrap();
    field.installed(&fan.on).unwrap();
    field.verified(&fan.run()).unwrap();
    assert_eq!(field.next(), ProcedureStep::Done);
    let unknown = Model::new(2, 2).unwrap();
    assert!(Field::new(plan(false)).unwrap().with_coefficients(unknown).is_err());
    assert!(Field::new(plan(false)).unwrap().with_coefficients(Model::new(3, 2).unwrap()).is_err());
}

#[test]
fn wrong_use_is_refused_and_loses_nothing() {
    let (fan, whole, _) = self::field(false);
    let mut field = whole.clone();
    let run = fan.run();
    let w = Complex::new(1.0, 0.0);
    let readings = &run.readings()[..2];
    let faster = Run::new(readings, &[SPEED, SPEED * 1.02]).unwrap();
    assert_eq!(field.baseline(&faster), Err(Error::SpeedDiffers { row: 1 }));
    assert_eq!(field.verified(&faster), Err(Error::SpeedDiffers { row: 1 }));
    let short = Run::new(&readings[..1], &[SPEED]).unwrap();
    assert_eq!(field.verified(&short), Err(Error::ReadingMissing { row: 1 }));
    assert_eq!(Run::<f64, 4>::new(readings, &[SPEED]), Err(Error::ReadingMissing { row: 1 }));
    assert_eq!(Run::<f64, 4>::new(&[w, w * f64::NAN], &[SPEED; 2]), Err(Error::Reading { row: 1 }));
    assert_eq!(field.installed(&[w, w * f64::NAN]), Err(Error::Weight { plane: 1 }));
    assert_eq!(field, whole);

    let mut empty = Field::new(plan(false)).unwrap();
    assert_eq!(empty.trial(0, w, &run), Err(Error::TooEarly));
    assert_eq!(empty.verified(&run), Err(Error::TooEarly));
    assert_eq!(empty.correction(), Err(Error::TooEarly));
    assert_eq!(empty.installed(&[w; 2]), Err(Error::TooEarly));
    empty.baseline(&run).unwrap();
    assert_eq!(empty.correction(), Err(Error::PlaneUnknown { plane: 0 }));
    assert_eq!(Field::new(Plan::usual(2, 2, f64::NAN)), Err(Error::Setting { index: 1 }));
}

/// A procedure with everything in it but the second trial.
fn half_way() -> Field {
    let mut field = Field::new(Plan::usual(2, 2, 0.1)).unwrap();
    field.baseline(&Run::new(&[z(7.2, 1.0), z(3.0, 2.0)], &[155.0; 2]).unwrap()).unwrap();
    field.trial(0, z(2.5, 0.0), &Run::new(&[z(4.9, 0.0), z(4.0, 1.0)], &[155.0; 2]).unwrap()).unwrap();
    field
}

#[test]
fn every_wrong_use_has_its_own_sentence_and_loses_nothing() {
    let right = Run::new(&[z(1.0, 1.0), z(-2.0, 2.0)], &[155.0; 2]).unwrap();
    type Use = fn(&mut Field, &Run<f64, 4>) -> Result<(), Error>;
    let uses: [(&str, Use); 8] = [
        ("the trial weight in plane 2 is zero: put a weight there and run again", |field, run| {
            field.trial(1, z(0.0, 0.0), run)
        }),
        ("reading 2 was taken at another speed than its baseline: run at the same speed", |field, run| {
            field.trial(1, z(1.0, 0.0), &Run::new(&run.readings()[..2], &[155.0, 158.0])?)
        }),
        ("reading 2 is missing", |field, run| field.trial(1, z(1.0, 0.0), &Run::new(&run.readings()[..1], &[155.0])?)),
        ("reading 1 is not a number", |field, run| {
            field.trial(1, z(1.0, 0.0), &Run::new(&[z(f64::NAN, 0.0), run.readings()[1]], &[155.0; 2])?)
        }),
        ("the influence of plane 2 is not known: make its trial run", |field, _| field.correction().map(|_| ())),
        ("there is no plane 3", |field, run| field.trial(2, z(1.0, 0.0), run)),
        ("a step before this one is still missing", |field, run| field.verified(run)),
        ("the trial weight in plane 2 changed nothing: take a heavier one", |field, _| {
            field.trial(1, z(1.0, 0.0), &Run::new(&[z(7.2, 1.0), z(3.0, 2.0)], &[155.0; 2])?)
        }),
    ];
    for (sentence, wrong) in uses {
        let mut field = half_way();
        assert_eq!(wrong(&mut field, &right).unwrap_err().to_string(), sentence);
        assert_eq!(field, half_way(), "{sentence}");
        // and it goes on from where it was
        field.trial(1, z(1.0, 1.0), &right).unwrap();
        assert!(field.correction().unwrap().rms < 1e-12);
    }
    let planes = Field::new(Plan::usual(1, 2, 0.1)).unwrap_err().to_string();
    assert_eq!(planes, "2 planes cannot be separated by 1 readings: measure at another place or speed");
    let mut aim = Aim::default();
    aim.weighting[0] = 0.0;
    let mut field = Field::new(Plan { aim, ..Plan::usual(2, 2, 0.1) }).unwrap();
    field.baseline(&right).unwrap();
    let runs = [[z(4.9, 0.0), z(4.0, 1.0)], [z(0.0, 0.5), z(1.0, 1.0)]];
    for (plane, run) in runs.iter().enumerate() {
        field.trial(plane, z(1.0, 0.0), &Run::new(run, &[155.0; 2]).unwrap()).unwrap();
    }
    assert_eq!(field.correction().unwrap_err().to_string(), planes);
}

/// Any single word changed, and any end cut off, is noticed; nothing is made of it.
#[test]
fn a_damaged_record_is_noticed() {
    let (_, field, _) = self::field(true);
    let mut words = [0_u32; 300];
    let length = field.record(&mut words).unwrap();
    for at in 0..length {
        for change in [1, 0x8000_0000, 0x0010_0000] {
            let mut damaged = words;
            damaged[at] ^= change;
            assert!(matches!(Field::resume(plan(true), &damaged[..length]), Err(Error::Record { .. })), "word {at}");
        }
        assert!(Field::resume(plan(true), &words[..at]).is_err());
    }
    assert!(Field::resume(plan(false), &words[..length]).is_err());
    assert_eq!(field.record(&mut [0; 20]), Err(Error::Size));
    let mut noise = Noise::new(6);
    for _ in 0..2000 {
        let garbage: Vec<u32> = (0..100).map(|_| (noise.even() * 4e9) as u32).collect();
        assert!(Field::resume(plan(true), &garbage).is_err());
    }
}

/// Everything that can be entered fills `words` to the last: one word less is too few.
#[test]
fn the_longest_record_is_as_long_as_stated() {
    fn check<T: driveline::balancing::Scalar + From<f32>>(turned: impl Fn(f32) -> Run<T, 3>) {
        type Whole<T> = Procedure<T, 3, 2, 5>;
        let z = |re: f32, im: f32| Complex::new(T::from(re), T::from(im));
        let mut field = Whole::<T>::new(Plan { leave_trials: false, ..Plan::usual(3, 2, T::from(1e-6)) }).unwrap();
        field.baseline(&turned(0.0)).unwrap();
        let trials =
            (0..9).take_while(|&k| field.extra_trial(k % 2, z(1.0, k as f32), &turned(1.0 + k as f32)).is_ok());
        assert_eq!(trials.count(), 5);
        let corrections = (0..9).take_while(|&k| {
            field.installed(&[z(0.1, k as f32), z(0.2, 0.0)]).is_ok() && field.verified(&turned(0.1 * k as f32)).is_ok()
        });
        assert_eq!(corrections.count(), driveline::balancing::CORRECTIONS);
        let mut words = vec![0; Whole::<T>::words(3, 2)];
        assert_eq!(field.record(&mut words), Ok(words.len()));
        let short = words.len() - 1;
        assert_eq!(field.record(&mut words[..short]), Err(Error::Size));
    }
    let readings = |by: f32| [(3.0 + by, 1.0), (2.0, -by), (by * by, 4.0)];
    check(|by| Run::new(&readings(by).map(|(re, im)| Complex::new(re, im)), &[157.0; 3]).unwrap());
    check(|by| {
        let readings = readings(by).map(|(re, im)| Complex::new(f64::from(re), f64::from(im)));
        Run::new(&readings, &[157.0; 3]).unwrap()
    });
}
