//! Draws side by side on all cores.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::figure::Outcome;

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
