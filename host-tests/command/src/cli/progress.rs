//! Progress of long work, on standard error: a bar, or a line now and then where that is no terminal.

use std::fmt::Write;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};

/// Time between two lines, and before the first: short work is silent.
const BETWEEN: Duration = Duration::from_secs(5);

/// A bar that counts steps and names the present one.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    /// When the last line was written.
    said: Mutex<Instant>,
}

impl Progress {
    /// A bar of so many steps.
    ///
    /// # Panics
    /// Never: the template is a constant that the tests show.
    pub fn of(steps: u64) -> Self {
        let style = ProgressStyle::with_template("{bar:32} {pos}/{len}  {elapsed}{left}  {msg}")
            .expect("the template of the progress bar is well-formed")
            .with_key("left", |state: &ProgressState, to: &mut dyn Write| {
                // nothing to estimate from before the first step is done; a line has no error to return
                let _ = to.write_str(&left(state.pos(), state.eta()));
            });
        Self::moving(ProgressBar::new(steps).with_style(style))
    }

    /// Work of which nobody knows how many steps it has.
    ///
    /// # Panics
    /// Never, as above.
    pub fn open() -> Self {
        let style = ProgressStyle::with_template("{spinner} {elapsed}  {msg}")
            .expect("the template of the progress line is well-formed");
        Self::moving(ProgressBar::new_spinner().with_style(style))
    }

    /// Does work that says nothing of itself, and names it now and then.
    pub fn during<T>(work: impl FnOnce() -> T, name: &str) -> T {
        let progress = &Self::open();
        progress.bar.set_message(name.to_owned());
        let (done, waits) = mpsc::channel::<()>();
        thread::scope(|scope| {
            scope.spawn(move || {
                while waits.recv_timeout(BETWEEN) == Err(RecvTimeoutError::Timeout) {
                    progress.says(name);
                }
            });
            let result = work();
            drop(done);
            result
        })
    }

    fn moving(bar: ProgressBar) -> Self {
        // Elapsed time moves on through a long step.
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar, said: Mutex::new(Instant::now()) }
    }

    /// Names the present step where there is no bar and a line is due; made only then.
    pub fn says_when_due(&self, step: impl FnOnce() -> String) {
        let due = || self.said.lock().unwrap_or_else(PoisonError::into_inner).elapsed() >= BETWEEN;
        if self.bar.is_hidden() && due() {
            self.says(&step());
        }
    }

    /// Names the present step.
    pub fn says(&self, step: &str) {
        if self.bar.is_hidden() {
            let mut said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
            if said.elapsed() >= BETWEEN {
                *said = Instant::now();
                eprintln!("{step}");
            }
        }
        self.bar.set_message(step.to_owned());
    }

    /// One step done.
    pub fn step(&self) {
        self.bar.inc(1);
    }

    /// So many steps done at once.
    pub fn steps(&self, steps: u64) {
        self.bar.inc(steps);
    }

    /// So many steps done in all.
    pub fn at(&self, steps: u64) {
        self.bar.set_position(steps);
    }
}

/// Remaining time in words; empty before the first step is done.
fn left(done: u64, eta: Duration) -> String {
    if done == 0 { String::new() } else { format!(", {} left", HumanDuration(eta)) }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Progress, left};

    /// The bar's rate is unknown until a step is done: its estimate is then 0 s.
    #[test]
    fn no_time_is_estimated_before_the_first_step_is_done() {
        assert_eq!(left(0, Duration::ZERO), "");
        assert_eq!(left(1, Duration::from_secs(120)), ", 2 minutes left");
    }

    #[test]
    fn a_bar_counts() {
        let bar = Progress::of(2);
        bar.says("first");
        bar.step();
        assert_eq!(bar.bar.position(), 1);
        bar.at(2);
        assert_eq!(bar.bar.position(), 2);
        Progress::open().says("once");
        assert_eq!(Progress::during(|| 7, "counting"), 7);
    }
}
