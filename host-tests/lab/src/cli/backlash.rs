//! `cargo lab backlash`: comparison of approaches to an observer with a gap.

use std::path::PathBuf;

use clap::Args;

use crate::backlash::backlash_page;
use crate::backlash::{Case, Comparison};
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::{Failure, Progress, say, say_json};

/// Compare approaches to an observer with backlash, over random reversals of six machines with the full solver.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab backlash
  cargo lab backlash --seconds 20 --seed 7
  cargo lab backlash --bites 200
  cargo lab backlash --bites 200 --wander 0.25
  cargo lab backlash --json")]
pub struct Backlash {
    /// Seconds of each run, 1 to 1000
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=1000))]
    seconds: u32,
    /// Instead of these, COUNT runs of a mill that reverses and bites within 50 ms
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    bites: Option<u32>,
    /// Of the mill: how far the twist wanders in a period of the resonance, as a share of the gap [default: 0.08]
    #[arg(long, value_name = "SHARE", requires = "bites")]
    wander: Option<f64>,
    /// Of the mill: how far the load speed wanders, as a share of the gap times the resonance [default: 0.12]
    #[arg(long, value_name = "SHARE", requires = "bites")]
    speed_wander: Option<f64>,
    /// Of the mill: how far the load torque wanders meanwhile, as a share of the disturbance's [default: 0.45]
    #[arg(long, value_name = "SHARE", requires = "bites")]
    torque_wander: Option<f64>,
    /// Of the mill: how long its searching gains stand after the gap has closed, in periods [default: 0.42]
    #[arg(long, value_name = "PERIODS", requires = "bites")]
    hold: Option<f64>,
    /// Seed of the random runs
    #[arg(long, default_value_t = 31)]
    seed: u64,
    /// File of the page [default: report/backlash.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Backlash {
    /// Runs the comparison and shows it.
    ///
    /// # Errors
    /// A page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let file = Destination::page_unless(self.json, self.html.as_deref(), "backlash");
        check_writable(&[], &file)?;
        let mut mill = Case::mill();
        let tuning = &mut mill.tuning;
        tuning.wander = self.wander.unwrap_or(tuning.wander);
        tuning.speed_wander = self.speed_wander.unwrap_or(tuning.speed_wander);
        tuning.torque_wander = self.torque_wander.unwrap_or(tuning.torque_wander);
        tuning.hold = self.hold.unwrap_or(tuning.hold);
        mill.try_design().map_err(|error| Failure::usage(error.to_string()))?;
        let bar = Progress::of(self.bites.map_or(Comparison::COURSES as u64, u64::from));
        let progress = |course: &str| {
            bar.says(course);
            bar.step();
        };
        let seconds = f64::from(self.seconds);
        let comparison = match self.bites {
            Some(courses) => Comparison::bites(mill, courses, seconds, self.seed, progress),
            None => Comparison::run(seconds, self.seed, progress),
        }
        .map_err(|error| Failure::failed(error.to_string()))?;
        drop(bar);
        if self.json {
            say_json(&comparison)?;
        } else {
            say(comparison.table());
        }
        file.map_or(Ok(()), |file| file.write_and_say(&backlash_page(&comparison), self.json))
    }
}
