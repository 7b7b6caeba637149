//! Runs of machines whose motion has a closed form, timed: a line of JSON a case, for `closed_forms.py`, which has the
//! closed forms and the other solvers.
//!
//! The twist of the first shaft is written at [`SAMPLES`] instants. The time is the processor's for building the plant
//! and running it, the middle of [`BATCHES`] batches: the kernel counts it in milliseconds. A case is stated here and
//! in the script, in the same figures.

use std::time::Instant;

use driveline_solver::plant::{Chain, LoadProgram, Plant, PlantError, Shaft, Start};

/// Instants at which the twist is written, at equal distances up to the end of the run.
const SAMPLES: u32 = 200;
/// Batches of runs of a case, and runs in each.
const BATCHES: usize = 5;
const BATCH: u32 = 100;

/// A torque of 10 N m, on two masses from rest.
fn step() -> Result<Plant, PlantError> {
    Chain::motor(0.5).shaft(Shaft::elastic(6000.0).damping(2.0), 1.5).build()
}

/// A pinion of 1e-4 kg m2 between two masses of 1 kg m2: a mode of 16 Hz, and one that dies away within 50 us.
fn pinion() -> Result<Plant, PlantError> {
    let shaft = Shaft::elastic(1e4).damping(1.0);
    Chain::motor(1.0).shaft(shaft, 1e-4).shaft(shaft, 1.0).build()
}

/// Two masses that rattle in a gap of 20 mrad.
fn gap() -> Result<Plant, PlantError> {
    let start = Start::Given { twists: vec![0.0], speeds: vec![0.5, -0.5] };
    Chain::motor(1.0).shaft(Shaft::elastic(1e4).gap(0.02), 1.0).start(start).build()
}

/// A load of 20 N m that comes within 50 ms, and goes within 50 ms.
fn ramp() -> Result<Plant, PlantError> {
    let load = LoadProgram::table(&[(0.1, 0.0), (0.15, 20.0), (1.0, 20.0), (1.05, 0.0)]);
    Chain::motor(0.5).shaft(Shaft::elastic(6000.0).damping(2.0), 1.5).program(load).build()
}

/// Time that this thread had the processor (s): the kernel's count where there is one.
fn processor_time(start: Instant) -> f64 {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = counted.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

fn main() -> Result<(), PlantError> {
    type Case = (&'static str, fn() -> Result<Plant, PlantError>, f64, f64);
    let cases: [Case; 4] =
        [("step", step, 10.0, 10.0), ("pinion", pinion, 10.0, 2.0), ("gap", gap, 0.0, 10.0), ("ramp", ramp, 0.0, 2.0)];
    let origin = Instant::now();
    for (name, build, torque, end) in cases {
        let mut times = Vec::with_capacity(BATCHES);
        let mut twists = Vec::new();
        for _ in 0..BATCHES {
            let from = processor_time(origin);
            for _ in 0..BATCH {
                let mut plant = build()?;
                twists.clear();
                for _ in 0..SAMPLES {
                    plant.advance(torque, end / f64::from(SAMPLES));
                    twists.push(plant.twist(0));
                }
            }
            times.push((processor_time(origin) - from) / f64::from(BATCH));
        }
        times.sort_by(f64::total_cmp);
        println!("{{\"case\": \"{name}\", \"seconds\": {:e}, \"twists\": {twists:?}}}", times[BATCHES / 2]);
    }
    Ok(())
}
