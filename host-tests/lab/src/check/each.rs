//! Every variant on every board that it belongs on, on all boards at a time.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use driveline_firmware::board::{BOARDS, Facts};
use driveline_firmware::scenes::VARIANTS;
use driveline_qemu::image::belongs;

use super::{Count, Failed};

/// Does something for every variant on every board that it belongs on, each board up to its first failure. A thread a
/// board, which goes on with the others' variants when its own are done.
pub(super) fn each<T: Send>(check: impl Fn(&str, Facts) -> Result<T, String> + Sync) -> Result<Vec<T>, Failed> {
    let left: Vec<Left> = BOARDS.iter().map(|&board| Left::of(board)).collect();
    let from = |own: usize| {
        let (mut done, mut messages) = (Vec::new(), Vec::new());
        for at in (own..left.len()).chain(0..own) {
            let Left { board, variants, next } = &left[at];
            while let Some((k, variant)) = left[at].take() {
                match check(variant, *board) {
                    Ok(value) => done.push(((at, k), value)),
                    Err(error) => {
                        next.store(variants.len(), Relaxed);
                        messages.push(format!("{variant} on {}: {error}", board.name));
                    }
                }
            }
        }
        (done, messages)
    };
    let threads = std::thread::scope(|scope| {
        let from = &from;
        let threads: Vec<_> = (0..left.len()).map(|own| scope.spawn(move || from(own))).collect();
        threads.into_iter().map(|thread| thread.join()).collect::<Result<Vec<_>, _>>()
    })
    .map_err(|_| Failed::whole("a board's thread panicked"))?;
    let (mut all, mut messages) = (Vec::new(), Vec::new());
    for (done, failed) in threads {
        all.extend(done);
        messages.extend(failed);
    }
    all.sort_by_key(|(place, _)| *place);
    let all: Vec<T> = all.into_iter().map(|(_, value)| value).collect();
    if messages.is_empty() {
        return Ok(all);
    }
    let count = Count { failed: messages.len() as u64, ..passed(&all) };
    Err(Failed { count, message: messages.join("\n") })
}

/// The variants of a board that no thread has taken yet.
struct Left {
    board: Facts,
    variants: Vec<&'static str>,
    next: AtomicUsize,
}

impl Left {
    fn of(board: Facts) -> Self {
        let variants = VARIANTS.iter().copied().filter(|variant| belongs(variant, &board)).collect();
        Left { board, variants, next: AtomicUsize::new(0) }
    }

    fn take(&self) -> Option<(usize, &'static str)> {
        let k = self.next.fetch_add(1, Relaxed);
        self.variants.get(k).map(|&variant| (k, variant))
    }
}

/// The count of what was done.
pub(super) fn passed<T>(done: &[T]) -> Count {
    Count { passed: done.len() as u64, ..Count::default() }
}
