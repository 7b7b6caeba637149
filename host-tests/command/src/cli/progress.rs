//! Progress of long work, on standard error; silent where that is no terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar that counts steps and names the present one.
#[derive(Debug)]
pub struct Progress(ProgressBar);

impl Progress {
    /// A bar of so many steps.
    ///
    /// # Panics
    /// Never: the template is a constant that the tests show.
    pub fn of(steps: u64) -> Self {
        let style = ProgressStyle::with_template("{bar:32} {pos}/{len}  {elapsed}, {eta} left  {msg}")
            .expect("the template of the progress bar is well-formed");
        let bar = ProgressBar::new(steps).with_style(style);
        // Elapsed time moves on through a long step.
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// Names the present step.
    pub fn says(&self, step: &str) {
        self.0.set_message(step.to_owned());
    }

    /// One step done.
    pub fn step(&self) {
        self.0.inc(1);
    }

    /// So many steps done at once.
    pub fn steps(&self, steps: u64) {
        self.0.inc(steps);
    }

    /// So many steps done in all.
    pub fn at(&self, steps: u64) {
        self.0.set_position(steps);
    }

    /// A line above the bar.
    pub fn note(&self, line: &str) {
        self.0.suspend(|| eprintln!("{line}"));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::Progress;

    #[test]
    fn a_bar_counts() {
        let bar = Progress::of(2);
        bar.says("first");
        bar.step();
        assert_eq!(bar.0.position(), 1);
        bar.at(2);
        assert_eq!(bar.0.position(), 2);
    }
}
