//! `cargo driveline cosim`: a drive in closed loop with a machine that is an FMU.

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use clap::Args;
use driveline::fault::Faults;
use driveline_report::chart::Line;
use driveline_report::format::{counted, significant};
use driveline_report::{Figure, Section, Sheet, Table, fact};
use serde::Serialize;

use super::progress::Progress;
use super::results::{Destination, all, check, field};
use super::{Failure, export, say, say_json};
use crate::cosim::closed_loop::{Change, Column, Names, Plan, Run, Stopped};
use crate::cosim::fmu::Fmu;

/// Lines of a plot; there are no more colours.
const DRAWN: usize = 6;
/// Points of a line in a plot.
const POINTS: usize = 4000;

/// Run a drive in closed loop with a machine that a simulation tool exported as an FMU.
///
/// The drive is that of a machine file, compiled as `export fmu` does, or an FMU that it wrote: the bits are those of
/// the controller's firmware. The machine is an FMU for co-simulation of FMI 2.0 or 3.0 with a library for this
/// computer. Its torque input takes the drive's torque, its angle or speed is measured; each is converted by the unit
/// that it declares.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline cosim hoist.toml hoist_plant.fmu --set 0.5:load_torque=1000
  cargo driveline cosim drive.toml Drivetrain.fmu --torque tau --speed w --setpoint 50 --time 5
  cargo driveline cosim controller.fmu machine.fmu --torque drive.tau --angle motor.phi --csv run.csv --json")]
pub struct Cosim {
    /// The drive: a machine file, or an FMU of `export fmu`
    drive: PathBuf,
    /// The machine: an FMU
    machine: PathBuf,
    #[command(flatten)]
    names: Names,
    /// A parameter of it, or an input from a time on (s), in its own unit
    #[arg(long, value_name = "[TIME:]NAME=VALUE", value_parser = change)]
    set: Vec<Change>,
    /// Speed setpoint of the motor (rad/s), from a time on (s); else half of the largest speed
    #[arg(long, value_name = "[TIME:]SPEED", value_parser = setpoint, allow_hyphen_values = true)]
    setpoint: Vec<(f64, f64)>,
    /// Length of the run (s)
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    time: f64,
    /// Counts of an encoder on a turn, to which the angle is rounded down; else the angle as it is
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    counts: Option<u32>,
    /// Write the run as a table, a line for every tick
    #[arg(long, value_name = "PATH")]
    csv: Option<PathBuf>,
    /// File of the page [default: report/NAME-cosim.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

fn finite(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| format!("`{text}` is no finite number"))
}

fn time(text: &str) -> Result<f64, String> {
    finite(text).and_then(|time| if time >= 0.0 { Ok(time) } else { Err(format!("{time} s is before the run")) })
}

fn setpoint(text: &str) -> Result<(f64, f64), String> {
    match text.split_once(':') {
        Some((from, speed)) => Ok((time(from)?, finite(speed)?)),
        None => Ok((0.0, finite(text)?)),
    }
}

fn change(text: &str) -> Result<Change, String> {
    let (variable, value) = text.rsplit_once('=').ok_or("expected NAME=VALUE or TIME:NAME=VALUE")?;
    let (from, name) = match variable.split_once(':') {
        Some((from, name)) => (Some(time(from)?), name),
        None => (None, variable),
    };
    Ok(Change { time: from, name: name.trim().to_owned(), value: finite(value)? })
}

/// A quantity's extremes, each at the beginning of a tick.
#[derive(Debug, Serialize)]
struct Extremes {
    name: String,
    unit: String,
    least: f64,
    least_time: f64,
    greatest: f64,
    greatest_time: f64,
    last: f64,
}

impl Extremes {
    fn of(column: &Column, times: &[f64]) -> Self {
        let pairs = || column.values.iter().zip(times);
        let first = (&f64::NAN, &0.0);
        let (least, least_time) = pairs().min_by(|a, b| a.0.total_cmp(b.0)).unwrap_or(first);
        let (greatest, greatest_time) = pairs().max_by(|a, b| a.0.total_cmp(b.0)).unwrap_or(first);
        Self {
            name: column.name.clone(),
            unit: column.unit.clone(),
            least: *least,
            least_time: *least_time,
            greatest: *greatest,
            greatest_time: *greatest_time,
            last: column.values.last().copied().unwrap_or(f64::NAN),
        }
    }
}

/// An estimate's error.
#[derive(Debug, Serialize)]
struct Error {
    name: &'static str,
    unit: &'static str,
    rms: f64,
    greatest: f64,
    greatest_time: f64,
}

/// A fault and in how many ticks it was raised.
#[derive(Debug, Serialize)]
struct Raised {
    name: &'static str,
    ticks: usize,
    first: f64,
}

/// The result, as `--json` prints it.
#[derive(Debug, Serialize)]
struct Summary {
    drive: String,
    machine: String,
    time: f64,
    ticks: usize,
    quantities_of_drive: Vec<Extremes>,
    quantities_of_machine: Vec<Extremes>,
    errors: Vec<Error>,
    faults: Vec<Raised>,
}

impl Summary {
    fn of(run: &Run, drive: &Fmu, machine: &Fmu, time: f64) -> Self {
        let extremes =
            |columns: &[Column]| columns.iter().map(|column| Extremes::of(column, &run.times)).collect::<Vec<_>>();
        let errors = run.errors.iter().map(|error| {
            let pairs = error.values.iter().zip(&run.times);
            let greatest = pairs.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
            let (greatest, greatest_time) = greatest.map_or((f64::NAN, 0.0), |(value, time)| (value.abs(), *time));
            let squares: f64 = error.values.iter().map(|value| value * value).sum();
            let rms = (squares / error.values.len() as f64).sqrt();
            Error { name: error.name, unit: error.unit, rms, greatest, greatest_time }
        });
        let raised = |(fault, name): (Faults, &'static str)| {
            let ticks = run.faults.iter().filter(|bits| *bits & fault.bits() != 0).count();
            let first = run.faults.iter().position(|bits| bits & fault.bits() != 0)?;
            Some(Raised { name, ticks, first: run.times[first] })
        };
        Self {
            drive: drive.description.model.clone(),
            machine: machine.description.model.clone(),
            time,
            ticks: run.times.len(),
            quantities_of_drive: extremes(&run.drive),
            quantities_of_machine: extremes(&run.machine),
            errors: errors.collect(),
            faults: Faults::NAMES.into_iter().filter_map(raised).collect(),
        }
    }

    fn faults(&self) -> String {
        let one = |Raised { name, ticks, first }: &Raised| {
            format!("{name} in {} from {} s on", counted(*ticks as u64, "tick"), significant(*first))
        };
        let all: Vec<String> = self.faults.iter().map(one).collect();
        if all.is_empty() { "none".to_owned() } else { all.join("; ") }
    }

    fn tables(&self) -> Vec<Section> {
        let extremes = |quantities: &[Extremes]| {
            let mut table = Table::new(["quantity", "unit", "least", "at s", "greatest", "at s", "at the end"]);
            for q in quantities {
                let numbers = [q.least, q.least_time, q.greatest, q.greatest_time, q.last].map(significant);
                table.row([q.name.clone(), q.unit.clone()].into_iter().chain(numbers));
            }
            table
        };
        let mut sections = vec![
            Section::new("Drive", "Torque to give and estimates, at the motor.", extremes(&self.quantities_of_drive)),
            Section::new("Machine", "Its outputs, at the ticks.", extremes(&self.quantities_of_machine)),
        ];
        if !self.errors.is_empty() {
            let mut table = Table::new(["estimate", "unit", "rms error", "greatest", "at s"]);
            for e in &self.errors {
                let numbers = [e.rms, e.greatest, e.greatest_time].map(significant);
                table.row([e.name.to_owned(), e.unit.to_owned()].into_iter().chain(numbers));
            }
            sections.push(Section::new("Errors", "Estimate less the machine's own, over all ticks.", table));
        }
        sections
    }
}

impl Cosim {
    /// Opens both, runs them and shows the run.
    ///
    /// # Errors
    /// A file that is no FMU, a variable that does not fit, an FMU that refuses a step.
    pub fn execute(&self) -> Result<(), Failure> {
        let name = self.machine.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let page = Destination::page_unless(self.json, self.html.as_deref(), &format!("{name}-cosim"));
        let csv = self.csv.as_deref().map(|path| Destination::chosen("table", path));
        check(&[&self.drive, &self.machine], csv.iter().chain(&page))?;
        let mut machine = Fmu::open(&self.machine).map_err(Failure::usage)?;
        let mut drive = self.drive()?;
        let largest = drive.description.scalar("speed_limit", "local").ok().and_then(|variable| variable.start);
        let setpoints = match (&*self.setpoint, largest) {
            ([], Some(largest)) => vec![(0.0, 0.5 * largest)],
            (given, _) => given.to_vec(),
        };
        let usual = || self.names.speed.is_none().then(|| "encoder_angle".to_owned());
        let plan = Plan {
            names: Names { angle: self.names.angle.clone().or_else(usual), ..self.names.clone() },
            setpoints,
            changes: self.set.clone(),
            time: self.time,
            counts: self.counts,
        };
        let progress = Progress::of(100);
        progress.says("running");
        let run = plan.run(&mut drive, &mut machine, |share| progress.at((100.0 * share) as u64));
        drop(progress);
        let run = run.map_err(|stopped| match stopped {
            Stopped::Unfit(sentence) => Failure::usage(sentence),
            Stopped::Failed(sentence) => Failure::failed(sentence),
        })?;
        let summary = Summary::of(&run, &drive, &machine, self.time);
        if self.json {
            say_json(&summary)?;
        } else {
            summary.tables().into_iter().for_each(say);
            say(format_args!("faults: {}", summary.faults()));
        }
        all([
            csv.map_or(Ok(()), |csv| csv.write_and_say(&table(&run), self.json)),
            page.map_or(Ok(()), |file| file.write_and_say(&self::page(&summary, &run), self.json)),
        ])
    }

    /// The drive: an FMU by its first bytes, else a machine file.
    fn drive(&self) -> Result<Fmu, Failure> {
        let mut head = [0; 4];
        let is_fmu =
            File::open(&self.drive).and_then(|mut file| file.read_exact(&mut head)).is_ok() && head == *b"PK\x03\x04";
        if is_fmu {
            return Fmu::open(&self.drive).map_err(Failure::usage);
        }
        let bytes = export::controller(Path::new(&self.drive))?;
        Fmu::read(Cursor::new(bytes)).map_err(Failure::failed)
    }
}

/// The run, a line for every tick, each number with all its digits.
fn table(run: &Run) -> String {
    let of = |whose: &str, columns: &[Column]| -> String {
        columns.iter().map(|column| format!(",{}", field(&format!("{whose}.{}", column.name)))).collect()
    };
    let mut text = format!("time{}{},faults\n", of("drive", &run.drive), of("machine", &run.machine));
    for (tick, time) in run.times.iter().enumerate() {
        let values = run.drive.iter().chain(&run.machine).map(|column| format!(",{:?}", column.values[tick]));
        text += &format!("{time:?}{},{}\n", values.collect::<String>(), run.faults[tick]);
    }
    text
}

fn page(summary: &Summary, run: &Run) -> String {
    let every = run.times.len().div_ceil(POINTS).max(1);
    let thinned = |values: &[f64]| -> Vec<f64> { values.iter().step_by(every).copied().collect() };
    let times = thinned(&run.times);
    let figure = |title: &str, columns: &[&Column], axis: &str| {
        let line = |(index, column): (usize, &&Column)| Line {
            name: column.name.clone(),
            class: format!("s{index}"),
            values: thinned(&column.values),
        };
        let drawn: Vec<Line> = columns.iter().take(DRAWN).enumerate().map(line).collect();
        let text = if every > 1 { format!("Every {every}th tick.") } else { String::new() };
        Figure::over_time(title, text, &times, &drawn, axis, &[])
    };
    let of = |unit: &str| -> Vec<&Column> { run.drive.iter().filter(|column| column.unit == unit).collect() };
    let machine: Vec<&Column> = run.machine.iter().collect();
    Sheet {
        name: format!("{} and {}", summary.drive, summary.machine),
        kicker: "co-simulation".to_owned(),
        summary: "A drive in closed loop with a machine that is an FMU; a step is a tick of the drive.".to_owned(),
        facts: vec![
            fact("length of the run", format!("{} s", significant(summary.time))),
            fact("ticks", summary.ticks.to_string()),
            fact("faults", summary.faults()),
        ],
        figures: vec![
            figure("Speeds of the drive", &of("rad/s"), "speed, rad/s"),
            figure("Torques of the drive", &of("N m"), "torque, N m"),
            figure("Machine", &machine, "outputs in their units"),
        ],
        tables: summary.tables(),
    }
    .page()
}

#[cfg(test)]
mod tests {
    use super::{change, setpoint};

    #[test]
    fn a_value_may_have_a_time_before_it() {
        let set = change("2:load.tau[1]=-3e2").unwrap();
        assert_eq!((set.time, &*set.name, set.value), (Some(2.0), "load.tau[1]", -300.0));
        assert_eq!(change("J=1").unwrap().time, None);
        assert_eq!((setpoint("0.5:-60"), setpoint("100")), (Ok((0.5, -60.0)), Ok((0.0, 100.0))));
        for wrong in ["J", "-1:J=2", "J=NaN", "x:J=2"] {
            assert!(change(wrong).is_err(), "{wrong}");
        }
    }
}
