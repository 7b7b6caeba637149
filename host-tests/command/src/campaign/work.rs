//! Draws side by side on all cores.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::draw::Draw;
use super::drive::Drive;
use super::figure::Outcome;
use super::run::run;
use super::scenes::CampaignScene;
use crate::machine_file::factor::Tolerance;

/// Outcomes of so many draws of a seed, in their order.
///
/// # Errors
/// The first draw that failed.
pub fn outcomes(
    scene: &CampaignScene,
    drive: &Drive,
    tolerances: &[Tolerance],
    (seed, draws): (u64, u64),
    threads: Option<usize>,
) -> Result<Vec<Outcome>, String> {
    let one = |number: u64| run(scene, drive, &Draw::new(tolerances, seed, number));
    let mut outcomes = BTreeMap::new();
    let mut take = |number: u64, outcome: Outcome| {
        outcomes.insert(number, outcome);
        Ok(())
    };
    work(&(0..draws).collect::<Vec<_>>(), threads, &one, &mut take)?;
    Ok(outcomes.into_values().collect())
}

/// Runs the draws on so many threads, one a core where none is named, and takes each when it is done.
///
/// # Errors
/// The first draw that failed or was not taken; what was done before it has been taken.
pub fn work(
    draws: &[u64],
    threads: Option<usize>,
    run: &(dyn Fn(u64) -> Result<Outcome, String> + Sync),
    take: &mut (dyn FnMut(u64, Outcome) -> Result<(), String> + Send),
) -> Result<(), String> {
    let threads = threads.or_else(|| thread::available_parallelism().ok().map(Into::into)).unwrap_or(1);
    let next = AtomicUsize::new(0);
    let shared = Mutex::new((take, Ok(())));
    let worker = || {
        while let Some(&draw) = draws.get(next.fetch_add(1, Ordering::Relaxed)) {
            let outcome = run(draw);
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let taken = outcome.and_then(|outcome| shared.0(draw, outcome));
            if shared.1.is_err() {
                break;
            }
            if taken.is_err() {
                shared.1 = taken;
                break;
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, draws.len().max(1)) {
            scope.spawn(worker);
        }
    });
    shared.into_inner().unwrap_or_else(PoisonError::into_inner).1
}
