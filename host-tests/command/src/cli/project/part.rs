//! The optional parts of a drive, as the command line names them.

use clap::{Args, ValueEnum};

use crate::cli::Failure;

/// An optional part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// Extremes of the speed over each turn of the motor
    Fluctuation,
    /// Vibration at the motor's speed, from two sensors, for balancing
    Phasors,
}

/// Options of the optional parts.
#[derive(Debug, Default, Args)]
pub struct PartOptions {
    /// Optional parts, separated by commas
    #[arg(long, value_name = "PART,...", value_delimiter = ',')]
    pub parts: Vec<Part>,
    /// End of the range of a vibration sensor, where a sample is clipped, in its unit; for `phasors`
    #[arg(long, value_name = "VALUE")]
    pub vibration_limit: Option<f64>,
}

impl PartOptions {
    /// Whether a part is asked for.
    pub fn has(&self, part: Part) -> bool {
        self.parts.contains(&part)
    }

    /// The limit of the vibration where it is measured.
    ///
    /// # Errors
    /// Phasors without a limit, a limit without phasors, a limit that is not positive.
    pub fn vibration_limit(&self) -> Result<Option<f64>, Failure> {
        match (self.has(Part::Phasors), self.vibration_limit) {
            (true, Some(limit)) if limit > 0.0 && limit.is_finite() => Ok(Some(limit)),
            (true, Some(limit)) => {
                Err(Failure::usage(format!("--vibration-limit is {limit}, expected a value above 0")))
            }
            (true, None) => {
                Err(Failure::usage("the part `phasors` needs --vibration-limit, the end of the sensors' range"))
            }
            (false, Some(_)) => Err(Failure::usage("--vibration-limit is for the part `phasors`: add --parts phasors")),
            (false, None) => Ok(None),
        }
    }
}
