//! Jobs side by side, one a core.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::{Failure, Job, Piece};

/// Does the jobs on so many threads, in their order; gives what came of each, in their order too. A job that panics has
/// failed. `says` receives the present step, `done` each job's weight at its end.
pub fn work(
    jobs: Vec<Job>,
    threads: usize,
    says: &(dyn Fn(&str) + Sync),
    done: &(dyn Fn(u64) + Sync),
) -> Vec<Result<Piece, Failure>> {
    let count = jobs.len();
    let jobs: Vec<Mutex<Option<Job>>> = jobs.into_iter().map(|job| Mutex::new(Some(job))).collect();
    let results: Mutex<Vec<Option<Result<Piece, Failure>>>> = Mutex::new((0..count).map(|_| None).collect());
    let next = AtomicUsize::new(0);
    let worker = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(slot) = jobs.get(index) else { break };
            let Some(job) = slot.lock().unwrap_or_else(PoisonError::into_inner).take() else { continue };
            let Job { place, name, weight, work, .. } = job;
            let failed = |reason: String| Failure { place: place.clone(), job: name.clone(), reason };
            let outcome = match catch_unwind(AssertUnwindSafe(|| work(&|text| says(text)))) {
                Ok(outcome) => outcome.map_err(failed),
                Err(panic) => Err(failed(sentence(&*panic))),
            };
            results.lock().unwrap_or_else(PoisonError::into_inner)[index] = Some(outcome);
            done(weight);
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            scope.spawn(worker);
        }
    });
    results.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter().flatten().collect()
}

/// Message of a panic.
fn sentence(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "it panicked".to_owned())
}

#[cfg(test)]
mod tests {
    use crate::survey::pool::*;

    #[test]
    fn one_that_fails_loses_no_other() {
        let job = |name: &str, work: fn() -> Result<Piece, String>| Job {
            place: name.into(),
            name: name.into(),
            core: "",
            weight: 2,
            work: Box::new(move |_| work()),
        };
        let jobs = vec![
            job("good", || Ok(Piece::Cases(Vec::new()))),
            job("refused", || Err("no such image".into())),
            job("panics", || panic!("out of range")),
            job("good too", || Ok(Piece::Cases(Vec::new()))),
        ];
        let weight = AtomicUsize::new(0);
        let done = |done: u64| {
            weight.fetch_add(done as usize, Ordering::Relaxed);
        };
        let results = work(jobs, 2, &|_| {}, &done);
        assert_eq!(weight.into_inner(), 8);
        assert!(matches!(results[0], Ok(Piece::Cases(_))) && matches!(results[3], Ok(Piece::Cases(_))));
        for (result, reason) in [(&results[1], "no such image"), (&results[2], "out of range")] {
            assert_eq!(result.as_ref().err().map(|failure| failure.reason.as_str()), Some(reason));
        }
    }
}
