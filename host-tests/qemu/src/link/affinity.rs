//! One core for the host's thread and its QEMU.
//!
//! Without it the round trips wander by a factor of ten with the scheduler's mood. A child inherits the affinity of the
//! thread that starts it, so pinning the thread is enough. Links at the same time take different cores while there are
//! any.

#[cfg(target_os = "linux")]
mod linux {
    use std::sync::{Mutex, OnceLock, PoisonError};

    use rustix::thread::{CpuSet, Pid, gettid, sched_getaffinity, sched_getcpu, sched_setaffinity};

    /// Links on each core.
    static TAKEN: Mutex<[u32; CpuSet::MAX_CPU]> = Mutex::new([0; CpuSet::MAX_CPU]);
    /// The cores that the process may use, as found by the first link.
    static ALLOWED: OnceLock<Option<CpuSet>> = OnceLock::new();

    /// While it lives, the thread that made it is on one core.
    pub struct Pinned {
        core: Option<usize>,
        thread: Pid,
    }

    impl Pinned {
        /// Pins the calling thread to the allowed core that the fewest links are on, its own where it is one of
        /// them. Where pinning is not permitted the thread stays free: slower, not wrong.
        pub fn to_free_core() -> Self {
            let thread = gettid();
            let allowed = ALLOWED.get_or_init(|| sched_getaffinity(None).ok());
            let core = allowed.as_ref().and_then(|allowed| pin(thread, allowed));
            Pinned { core, thread }
        }
    }

    fn pin(thread: Pid, allowed: &CpuSet) -> Option<usize> {
        let mut taken = TAKEN.lock().unwrap_or_else(PoisonError::into_inner);
        let here = sched_getcpu();
        let core = (0..CpuSet::MAX_CPU)
            .filter(|&core| allowed.is_set(core))
            .min_by_key(|&core| (taken[core], core != here))?;
        let mut only = CpuSet::new();
        only.set(core);
        sched_setaffinity(Some(thread), &only).ok()?;
        taken[core] += 1;
        Some(core)
    }

    impl Drop for Pinned {
        fn drop(&mut self) {
            let (Some(core), Some(Some(allowed))) = (self.core, ALLOWED.get()) else {
                return;
            };
            TAKEN.lock().unwrap_or_else(PoisonError::into_inner)[core] -= 1;
            // the thread may have ended since: nothing to give back then
            let _ = sched_setaffinity(Some(self.thread), allowed);
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod elsewhere {
    /// Threads cannot be pinned here.
    pub struct Pinned;

    impl Pinned {
        /// Leaves the thread as it is.
        pub fn to_free_core() -> Self {
            Pinned
        }
    }
}

#[cfg(not(target_os = "linux"))]
pub use elsewhere::Pinned;
#[cfg(target_os = "linux")]
pub use linux::Pinned;
