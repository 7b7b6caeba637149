//! Draws side by side on all cores.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::figure::Outcome;
use super::record::Record;

/// Runs the draws on so many threads and adds each to the record when it is done. `done` counts them.
///
/// # Errors
/// The first draw or line that failed; what was done before it is in the record.
pub fn work(
    draws: &[u64],
    threads: usize,
    record: &mut Record,
    run: &(dyn Fn(u64) -> Result<Outcome, String> + Sync),
    done: &(dyn Fn() + Sync),
) -> Result<(), String> {
    let next = AtomicUsize::new(0);
    let shared = Mutex::new((record, Ok(())));
    let worker = || {
        while let Some(&draw) = draws.get(next.fetch_add(1, Ordering::Relaxed)) {
            let outcome = run(draw);
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let added = outcome.and_then(|outcome| shared.0.add(draw, outcome));
            if shared.1.is_err() {
                break;
            }
            if added.is_err() {
                shared.1 = added;
                break;
            }
            drop(shared);
            done();
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, draws.len().max(1)) {
            scope.spawn(worker);
        }
    });
    shared.into_inner().unwrap_or_else(PoisonError::into_inner).1
}
