//! A sample of machines within the tolerances, beside the nominal one.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use cargo_driveline::campaign::drive::Drive;
use cargo_driveline::campaign::run::run;
use cargo_driveline::campaign::scenes::CampaignScene;
use cargo_driveline::campaign::{Draw, Figure, Outcome, quantile};
use driveline_report::{Sample, Sampled};

/// The seed of samples.
pub const SEED: u64 = 1;

/// Runs a drive on the nominal machine and on the first draws of [`SEED`], on so many threads.
pub fn sample(scene: &CampaignScene, drive: &Drive, draws: u64, threads: usize) -> Result<Sample, String> {
    let tolerances = scene.tolerances();
    let nominal = run(scene, drive, &Draw::nominal())?;
    let (next, done) = (AtomicU64::new(0), Mutex::new(Vec::new()));
    let worker = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= draws {
                break;
            }
            let outcome = run(scene, drive, &Draw::new(&tolerances, SEED, number));
            done.lock().unwrap_or_else(PoisonError::into_inner).push(outcome);
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            scope.spawn(worker);
        }
    });
    let done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    let outcomes: Vec<Outcome> = done.into_iter().collect::<Result<_, _>>()?;
    let sampled = |figure: Figure| {
        let mut values: Vec<f64> = outcomes.iter().map(|outcome| outcome.of(figure)).collect();
        // not a number is worst
        values.iter_mut().filter(|value| value.is_nan()).for_each(|value| *value = f64::INFINITY);
        values.sort_by(f64::total_cmp);
        Sampled { nominal: nominal.of(figure), median: quantile(&values, 0.5), p90: quantile(&values, 0.9) }
    };
    let machine = scene.departing(&Draw::nominal().departure()).map_err(|error| error.to_string())?;
    Ok(Sample {
        variant: drive.name(scene.name),
        run: machine.scenarios.first().map_or_else(String::new, |scenario| scenario.name.to_owned()),
        draws,
        seed: SEED,
        unstable: outcomes.iter().filter(|outcome| outcome.is_unstable()).count() as u64,
        shaft_torque: sampled(Figure::ShaftTorque),
        load_speed: sampled(Figure::LoadSpeed),
        load_torque: sampled(Figure::LoadTorque),
    })
}
