//! Recordings of a polygon mirror's rotor: an accelerometer and an infrared mark, 952 samples a second, 16 to 19 on a
//! turn (hstarmans/rotorbalancer, GPL-3.0; not part of the project, read where they are).

use std::f64::consts::TAU;

use driveline::angle::OncePerTurn;
use driveline::balancing::{Balancer, Complex, Phasors, PhasorsConfig, ReadingFault};
use driveline::settings::PhasorSettings;

use crate::recordings::recording;

/// Acceleration, and whether the mark passed since the sample before.
fn samples(path: &std::path::Path) -> Vec<(f64, bool)> {
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter_map(|line| line.split_once(','));
    let mut dark = true;
    rows.filter_map(|(acceleration, level)| Some((acceleration.parse().ok()?, level.trim() == "0")))
        .map(|(acceleration, now)| (acceleration, !std::mem::replace(&mut dark, now) && now))
        .collect()
}

/// Once-a-turn by least squares over the whole record, the angle by a straight line through all marks, each half a
/// sample before the one that shows it.
fn least_squares(samples: &[(f64, bool)]) -> Complex<f64> {
    let marks: Vec<f64> =
        samples.iter().enumerate().filter(|(_, sample)| sample.1).map(|(at, _)| at as f64 - 0.5).collect();
    let count = marks.len() as f64;
    let mean = marks.iter().sum::<f64>() / count;
    let middle = (count - 1.0) / 2.0;
    let square: f64 = (0..marks.len()).map(|turn| (turn as f64 - middle).powi(2)).sum();
    let turn: f64 = marks.iter().enumerate().map(|(turn, mark)| (turn as f64 - middle) * mark).sum::<f64>() / square;
    // normal equations of constant, cosine and sine
    let rows: Vec<([f64; 3], f64)> = samples
        .iter()
        .enumerate()
        .map(|(at, (v, _))| {
            let theta = TAU * ((at as f64 - mean) / turn + middle);
            ([1.0, theta.cos(), -theta.sin()], *v)
        })
        .collect();
    let a = nalgebra::Matrix3::from_fn(|i, j| rows.iter().map(|(row, _)| row[i] * row[j]).sum());
    let b = nalgebra::Vector3::from_fn(|i, _| rows.iter().map(|(row, v)| row[i] * v).sum());
    let found = a.lu().solve(&b).unwrap();
    Complex::new(found[1], found[2])
}

/// Without a weight: five blocks of eight turns are taken, and within 10 % and 8 degrees of the whole record, although
/// knocks of 30 times the vibration pass every sixth turn. With the weight next to nothing is left at once a turn:
/// those readings are refused with the uncertainty that they have.
#[test]
fn a_polygon_mirror_is_read() {
    let Some(folder) = recording("polygon_rotor") else { return };
    let config = PhasorsConfig::<f32, 1>::new(&PhasorSettings::DIRECT, [32_768.0]);
    for number in 100..105 {
        for weight in ["without_weight", "weight"] {
            let samples = samples(&folder.join(format!("{weight}_{number}.csv")));
            let mut tacho = OncePerTurn::new();
            let mut phasors = Phasors::<1, 6, f32>::default();
            for (v, mark) in &samples {
                // seen by sampling: half a sample ago on average
                if let Some(angle) = tacho.tick(mark.then_some(1 << 31)) {
                    phasors.measure(&config, angle, &[*v as f32]);
                }
            }
            let whole = least_squares(&samples);
            let reading = phasors.reading(&config, 0);
            println!("{weight} {number}: {:.1} at {:.1}, {reading:?}", whole.norm(), whole.arg().to_degrees());
            if weight == "weight" {
                let uncertain = phasors.unjudged(&config, 0).unwrap();
                let sure = uncertain.variance.sqrt() < 0.2 * uncertain.phasor.amplitude();
                assert!(
                    sure || matches!(reading, Err(ReadingFault::Scattered { .. } | ReadingFault::SpeedMoved { .. }))
                );
                continue;
            }
            let found = Complex::<f64>::from(reading.expect("taken").phasor);
            let ratio = found / whole;
            assert!((ratio.norm() - 1.0).abs() < 0.1 && ratio.arg().to_degrees().abs() < 8.0, "{found} {whole}");
        }
    }
}
