//! Arguments of the commands that read a recording.

use clap::Args;

use super::Failure;
use crate::recording::Asked;

/// How a recording is read.
#[derive(Debug, Args)]
pub struct Recorded {
    /// Samples a second, where no column holds the time
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Torque per current of the motor (N m/A)
    #[arg(long, value_name = "NM_PER_A")]
    pub torque_constant: Option<f64>,
    /// Counts on a turn, for angles in counts
    #[arg(long, value_name = "COUNTS")]
    counts: Option<f64>,
    /// Name a column: QUANTITY=HEADING or QUANTITY=HEADING:UNIT, as `torque=AI3:Nm`
    #[arg(long = "column", value_name = "NAME")]
    columns: Vec<String>,
    /// Begin at this time from the first row (s)
    #[arg(long, value_name = "S")]
    from: Option<f64>,
    /// End at this time from the first row (s)
    #[arg(long, value_name = "S")]
    to: Option<f64>,
}

impl Recorded {
    /// As the reader takes them.
    pub fn asked(&self) -> Result<Asked, Failure> {
        let positive = [
            ("--rate", self.rate),
            ("--torque-constant", self.torque_constant),
            ("--counts", self.counts),
            ("--to", self.to),
        ];
        for (option, value) in positive {
            if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
                return Err(Failure::usage(format!("{option} must be above zero and finite, not {value:?}")));
            }
        }
        if let Some(value) = self.from.filter(|value| !(*value >= 0.0 && value.is_finite())) {
            return Err(Failure::usage(format!("--from must be zero or above and finite, not {value:?}")));
        }
        if let Some((from, to)) = self.from.zip(self.to).filter(|(from, to)| from >= to) {
            return Err(Failure::usage(format!("--from {from:?} must be before --to {to:?}")));
        }
        Ok(Asked {
            rate: self.rate,
            torque_constant: self.torque_constant,
            counts: self.counts,
            columns: self.columns.clone(),
            window: [self.from, self.to],
            uneven: false,
        })
    }
}
