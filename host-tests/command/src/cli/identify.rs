//! `cargo driveline identify`: a machine from a recording.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::recorded::Recorded;
use super::results::{Destination, all, check};
use super::{Failure, Progress, say, say_json};
use crate::identification::{
    Drive, Identified, Motion, NotIdentified, Torque, identify, identify_response, machine_file, page, table,
};
use crate::recording::{Quantity, Recording, read_recording};
use driveline_report::format::percent;

/// Identify a machine from a recording of torque and motion, or from a table of its frequency response.
///
/// Columns are found by quantity and unit: `time_s`, `torque_Nm` or `current_A`, and `angle_rad`, `speed_rpm` or
/// `acceleration [rad/s2]` of the motor; or `frequency_Hz` with `magnitude` and `phase_deg`, or `real` and `imaginary`.
/// Prints inertias, stiffness, damping, friction, resonances and dead time with standard deviations, or the reason why
/// the record does not suffice.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example bench-log > bench.csv
  cargo driveline identify bench.csv --rate 2500 --torque-constant 0.564 --to 5 --toml bench.toml
  cargo driveline identify response.csv --response speed --json")]
pub struct Identify {
    /// The recording or the table: a CSV file
    file: PathBuf,
    #[command(flatten)]
    recorded: Recorded,
    /// For a table of a response: the motion per torque that it holds
    #[arg(long, value_name = "MOTION", value_parser = motion)]
    response: Option<Motion>,
    /// Write the machine as a file for `design` and `replay`
    #[arg(long, value_name = "PATH")]
    toml: Option<PathBuf>,
    /// File of the page [default: report/NAME-identification.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Identify {
    /// Reads the recording, fits the machine and shows it.
    ///
    /// # Errors
    /// A fault of the file; with exit code 1 a record that does not suffice.
    pub fn execute(&self) -> Result<(), Failure> {
        let asked = self.recorded.asked()?;
        if self.toml.is_some() && self.response.is_some() {
            let sentence = "--toml needs a recording over time: the table of --response has no rate and no limits";
            return Err(Failure::usage(sentence));
        }
        let name = slug(&self.file);
        let sheet = Destination::page_unless(self.json, self.html.as_deref(), &format!("{name}-identification"));
        let toml = self.toml.as_deref().map(|path| Destination::chosen("machine", path));
        check(&[&self.file], toml.iter().chain(&sheet))?;
        let progress = Progress::of(2);
        progress.says("reading");
        let recording = read_recording(&self.file, &asked)?;
        progress.step();
        progress.says("fitting");
        let constant = self.recorded.torque_constant;
        let (identified, torque) = match (recording.signal(Quantity::Frequency), self.response) {
            (Some(_), Some(motion)) => (identify_response(&recording, motion, constant), Vec::new()),
            (Some(_), None) => {
                let found = "a frequency response without the motion per torque that it is of";
                return Err(recording.fault(found, "--response angle, speed or acceleration").into());
            }
            (None, Some(_)) => {
                return Err(recording.fault(recording.found(), "a column of frequency, for --response").into());
            }
            (None, None) => (identify(&recording, constant), recording.torque(constant)?),
        };
        drop(progress);
        let identified = identified.map_err(|error| match error {
            NotIdentified::File(diagnostic) => diagnostic.into(),
            NotIdentified::Refused(refusal) => {
                Failure::failed(format!("{}: no machine is identified: {refusal}", recording.name))
            }
        })?;
        self.show(&recording, &identified)?;
        let machine = || machine_file(&name, &identified, &Drive::of(&identified, &recording, &torque));
        all([
            toml.map_or(Ok(()), |toml| toml.write_and_say(&machine(), self.json)),
            sheet.map_or(Ok(()), |sheet| sheet.write_and_say(&page(&name, &identified), self.json)),
        ])
    }

    fn show(&self, recording: &Recording, identified: &Identified) -> Result<(), Failure> {
        let estimate = &identified.estimate;
        if self.json {
            let figure = |figure: driveline::commissioning::Figure| {
                let driveline::commissioning::Figure { value, standard_deviation } = figure;
                json!({ "value": value, "standard_deviation": standard_deviation })
            };
            let figures = &estimate.figures;
            return say_json(&json!({
                "file": recording.name,
                "motor_inertia": figure(figures.motor_inertia),
                "load_inertia": figure(figures.load_inertia),
                "stiffness": figure(figures.stiffness),
                "damping": figure(figures.damping),
                "motor_friction": figure(figures.motor_friction),
                "load_friction": figure(figures.load_friction),
                "resonance": figure(figures.resonance),
                "antiresonance": figure(figures.antiresonance),
                "damping_ratio": figure(figures.damping_ratio),
                "dead_time": figure(figures.delay),
                "unexplained": estimate.unexplained,
                "condition": estimate.condition,
                "lines": estimate.lines,
            }));
        }
        say(table(identified));
        let held = match identified.setting.torque {
            Torque::Held => "; the torque is held from each sample to the next",
            Torque::Smooth => "; the torque runs smoothly from sample to sample",
            Torque::Sine => "",
        };
        let unexplained = percent(estimate.unexplained);
        say(format_args!("{} lines of the spectrum; {unexplained} of the torque is unexplained{held}", estimate.lines));
        Ok(())
    }
}

/// A motion by its name.
fn motion(name: &str) -> Result<Motion, String> {
    let all = [Motion::Angle, Motion::Speed, Motion::Acceleration];
    let known = all.into_iter().find(|motion| motion.to_string() == name);
    known.ok_or_else(|| "`angle`, `speed` or `acceleration` is expected".to_owned())
}

/// A file's name as part of another: without its ending, letters and digits only.
pub fn slug(path: &std::path::Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let plain: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(40).collect();
    if plain.chars().any(|c| c != '-') { plain } else { "recording".to_owned() }
}
