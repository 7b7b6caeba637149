//! How long a step takes: wall time, and processor time with that of all children.

use std::fs;
use std::time::Instant;

use serde::Serialize;

/// The beginning of a step.
pub struct Clock {
    began: Instant,
    processor: Option<f64>,
}

/// What a step took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Took {
    /// Wall time, seconds.
    pub seconds: f64,
    /// Time of all processors, of this program and of the children that have ended, seconds; none where the system
    /// does not say.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub processor_seconds: Option<f64>,
}

impl Clock {
    /// Begins.
    pub fn start() -> Self {
        Self { began: Instant::now(), processor: processor() }
    }

    /// What has been taken since.
    pub fn took(&self) -> Took {
        let rounded = |seconds: f64| (seconds * 1e3).round() / 1e3;
        let processor = processor().zip(self.processor).map(|(now, then)| rounded(now - then));
        Took { seconds: rounded(self.began.elapsed().as_secs_f64()), processor_seconds: processor }
    }
}

/// utime, stime, cutime and cstime, the 14th to 17th field; the second is a name in parentheses [proc_pid_stat(5)].
fn processor() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    let times = stat.rsplit_once(')')?.1.split_whitespace().skip(11).take(4).map(str::parse::<u64>);
    let ticks: u64 = times.sum::<Result<_, _>>().ok()?;
    Some(ticks as f64 / rustix::param::clock_ticks_per_second() as f64)
}
