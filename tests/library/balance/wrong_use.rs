//! Each wrong use of balancing, with its own sentence, and nothing lost of what was entered before.

use driveline::balancing::{Complex, Error, Plan, Procedure, Run};

type Field = Procedure<f64, 4, 2>;

fn z(re: f64, im: f64) -> Complex<f64> {
    Complex::new(re, im)
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
    let mut aim = driveline::balancing::Aim::default();
    aim.weighting[0] = 0.0;
    let mut field = Field::new(Plan { aim, ..Plan::usual(2, 2, 0.1) }).unwrap();
    field.baseline(&right).unwrap();
    let runs = [[z(4.9, 0.0), z(4.0, 1.0)], [z(0.0, 0.5), z(1.0, 1.0)]];
    for (plane, run) in runs.iter().enumerate() {
        field.trial(plane, z(1.0, 0.0), &Run::new(run, &[155.0; 2]).unwrap()).unwrap();
    }
    assert_eq!(field.correction().unwrap_err().to_string(), planes);
}
