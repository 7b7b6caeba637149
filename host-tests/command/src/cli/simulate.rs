//! `cargo driveline simulate`: a run of any train by the full solver.

mod result;
mod starting_time;
mod swing;

use std::path::PathBuf;

use clap::Args;

use super::results::{Destination, all, check};
use super::{Failure, Progress, say, say_json};
use crate::machine_file::{TrainFile, read_train, slug};
use driveline_report::chart::Line;
use driveline_report::format::significant;
use driveline_report::{Figure, Section, Sheet, Table, fact};
use result::{Pieces, Simulation};

/// Lines of the events' table.
const EVENTS: usize = 40;
/// Lines of a plot; there are no more colours.
const DRAWN: usize = 6;

/// Run a machine of any shape by the full solver: forces, speeds, events, dynamic factors.
///
/// The file names coordinates and the links between them, or elements from the motor to the load; torques, friction,
/// the start and the run. Every run is done again by a second integrator; one that does not agree to 1e-8 of its
/// peaks is refused. A run in which roundings grow beyond that is proven in pieces, and says so.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example gear-pair > gear-pair.toml
  cargo driveline simulate gear-pair.toml
  cargo driveline simulate hoist-start.toml --csv start.csv
  cargo driveline simulate my.toml --html my.html --json")]
pub struct Simulate {
    /// The train and its run: a TOML file
    file: PathBuf,
    /// File of the page [default: report/NAME-simulation.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Write the run as a table, a line for every step
    #[arg(long, value_name = "PATH")]
    csv: Option<PathBuf>,
    /// Show a run that no second integrator has confirmed
    #[arg(long)]
    unproven: bool,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Simulate {
    /// Reads the train, runs it and shows the run.
    ///
    /// # Errors
    /// A file with a fault; a run that is not proven; a result that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let file = read_train(&self.file)?;
        let name = format!("{}-simulation", slug(&file.name));
        let sheet = Destination::page_unless(self.json, self.html.as_deref(), &name);
        let csv = self.csv.as_deref().map(|path| Destination::chosen("table", path));
        check(&[&self.file], csv.iter().chain(&sheet))?;
        let solve = || Simulation::of(&file, !self.unproven);
        let simulation = Progress::during(solve, &format!("{}: solving {} s", file.name, significant(file.time)))?;
        if let (Some(reason), false) = (&simulation.not_proven, self.unproven) {
            return Err(Failure::failed(format!(
                "{}: the run is refused: {reason}; `--unproven` shows it all the same",
                self.file.display()
            )));
        }
        if self.json {
            say_json(&simulation)?;
        } else {
            tables(&simulation).into_iter().for_each(say);
            say(proof(&simulation).join("\n"));
        }
        all([
            csv.map_or(Ok(()), |csv| csv.write_and_say(&simulation.csv(), self.json)),
            sheet.map_or(Ok(()), |sheet| sheet.write_and_say(&page(&file, &simulation), self.json)),
        ])
    }
}

/// A line, a second one of a run that is proven in pieces, and one of its steady cycle.
fn proof(simulation: &Simulation) -> Vec<String> {
    let cycle = simulation.cycle.as_ref().map(|cycle| match (cycle.proof, &cycle.not_proven) {
        (Some((residual, integrator)), _) => format!(
            "cycle proven: it comes back to {residual:.1e} of the peaks, a second integrator deviates by \
             {integrator:.1e}"
        ),
        (None, reason) => format!("cycle not proven: {}", reason.as_deref().unwrap_or("unknown")),
    });
    let mut lines = match (simulation.proof, &simulation.not_proven) {
        (Some((integrator, tightened)), _) => {
            let closer = tightened.map_or_else(
                || "no events".to_owned(),
                |tightened| format!("ten times closer events by {tightened:.1e}"),
            );
            let mut lines =
                vec![format!("proven: a second integrator deviates by {integrator:.1e} of the peaks, {closer}")];
            if let Some(Pieces { from, pieces, shortest }) = simulation.sensitive {
                lines.push(format!(
                    "sensitive: proven from the start up to {} s, then in {pieces} pieces; roundings grow beyond 1e-8 \
                     within {} s. The extremes are those of one possible run.",
                    significant(from),
                    significant(shortest)
                ));
            }
            lines
        }
        (None, reason) => vec![format!("not proven: {}", reason.as_deref().unwrap_or("unknown"))],
    };
    lines.extend(cycle);
    lines
}

fn tables(simulation: &Simulation) -> Vec<Section> {
    // a file of coordinates does not say which of them are ways
    let [torque, angle, speed] =
        if simulation.turns { ["N m", "rad", "rad/s"] } else { ["N m or N", "rad or m", "rad/s or m/s"] };
    let of = |what: &str, unit: &str| format!("{what} {unit}");
    let mut forces = Table::new([
        "link".to_owned(),
        of("least", torque),
        "at s".to_owned(),
        of("greatest", torque),
        "at s".to_owned(),
        of("static", torque),
        "K".to_owned(),
        "elastic K".to_owned(),
        of("least", angle),
        of("greatest", angle),
        "contacts".to_owned(),
    ]);
    for link in &simulation.links {
        let numbers = [link.least, link.least_time, link.greatest, link.greatest_time, link.static_force];
        let factor = |factor: Option<f64>| factor.map_or_else(|| "none".to_owned(), significant);
        let factors = [factor(link.dynamic_factor), factor(link.elastic_factor)];
        let elongations = [link.least_elongation, link.greatest_elongation].map(significant);
        let rest = factors.into_iter().chain(elongations).chain([link.contacts.to_string()]);
        forces.row([link.name.clone()].into_iter().chain(numbers.map(significant)).chain(rest));
    }
    let mut speeds =
        Table::new(["coordinate".to_owned(), of("least", speed), of("greatest", speed), of("at the end", speed)]);
    for coordinate in &simulation.coordinates {
        let numbers = [coordinate.least, coordinate.greatest, coordinate.last];
        speeds.row([coordinate.name.clone()].into_iter().chain(numbers.map(significant)));
    }
    let text = "Torques of links between angles in N m and elongations in rad; along a line of action or a way, \
                forces in N and elongations in m. The dynamic factor K is the greatest size over the static force: \
                that of the file, or the mean of the second half of the run; elastic, of the spring without its \
                damper. Extremes are found between the lines of the run, not on them.";
    let mut all = vec![Section::new("Speeds", if simulation.turns { "" } else { "Of ways in m/s." }, speeds)];
    if !simulation.links.is_empty() {
        all.insert(0, Section::new("Forces", text, forces));
    }
    if !simulation.frictions.is_empty() {
        let slid = if simulation.turns { "rad" } else { "rad or m" };
        let mut heat = Table::new(["friction".to_owned(), of("slid", slid), of("heat", "J"), of("power", "W")]);
        for friction in &simulation.frictions {
            let numbers = [friction.slid, friction.heat, friction.power].map(significant);
            heat.row([friction.name.clone()].into_iter().chain(numbers));
        }
        let text = "Torque times the way to and fro, as the lines of the run show it; power, the most over a line.";
        all.push(Section::new("Dry friction", text, heat));
    }
    if !simulation.pin_forces.is_empty() {
        let mut pins = Table::new(["crank", "at rad", "crank pin N", "across N", "wrist pin N", "across N", "guide N"]);
        for of in &simulation.pin_forces {
            let numbers = [of.angle, of.crank[0], of.crank[1], of.wrist[0], of.wrist[1], of.guide].map(significant);
            pins.row([of.name.clone()].into_iter().chain(numbers));
        }
        let text = "On the rod by the crank, on the slider by rod and guide, at the speed of the start, taken as even; \
                    along the slider's way and across it.";
        all.push(Section::new("Forces in the pins", text, pins));
    }
    if let Some(cycle) = &simulation.cycle {
        let mut steady = Table::new([
            "coordinate".to_owned(),
            "delta".to_owned(),
            of("least", speed),
            of("greatest", speed),
            of("mean", speed),
            "time s".to_owned(),
        ]);
        let numbers = [cycle.delta, cycle.least, cycle.greatest, cycle.mean, cycle.time].map(significant);
        steady.row([cycle.name.clone()].into_iter().chain(numbers));
        let text = format!("Repeats after {} cycles from the end of the run.", cycle.cycles);
        all.push(Section::new("Steady cycle", text, steady));
        all.push(cycle.swing.table(cycle.delta));
    }
    if let Some(starting) = &simulation.starting {
        let mut table =
            Table::new(["coordinate".to_owned(), of("speed", speed), "time s".to_owned(), "rigid s".to_owned()]);
        let time = |time: Option<f64>| time.map_or_else(|| "none".to_owned(), significant);
        table.row([starting.name.clone(), significant(starting.speed), time(starting.time), time(starting.rigid)]);
        let text = "Until the speed is first reached; rigid, in closed form of a machine without twist or gap.";
        all.push(Section::new("Starting time", text, table));
    }
    if let Some(bare) = &simulation.without_dampers {
        let mut table = Table::new([
            "link".to_owned(),
            of("without least", torque),
            of("greatest", torque),
            of("with least", torque),
            of("greatest", torque),
        ]);
        for (bare, damped) in bare.links.iter().zip(&simulation.links) {
            let numbers = [bare.least, bare.greatest, damped.least, damped.greatest].map(significant);
            table.row([bare.name.clone()].into_iter().chain(numbers));
        }
        let text = "The same run without the dampers and with them, proven alike.";
        all.push(Section::new("Dampers", text, table));
    }
    if !simulation.events.is_empty() {
        let mut events = Table::new(["time s", "what", "where"]);
        for event in simulation.events.iter().take(EVENTS) {
            events.row([format!("{:.6}", event.time), event.what.clone(), event.place.clone()]);
        }
        let (count, shown) = (simulation.events.len(), simulation.events.len().min(EVENTS));
        all.push(Section::new("Events", format!("The first {shown} of {count}."), events));
    }
    all
}

fn page(file: &TrainFile, simulation: &Simulation) -> String {
    let lines = |names: &[String], rows: &[Vec<f64>]| -> Vec<Line> {
        let line = |(index, (name, row)): (usize, (&String, &Vec<f64>))| Line {
            name: name.clone(),
            class: format!("s{index}"),
            values: row.clone(),
        };
        names.iter().zip(rows).take(DRAWN).enumerate().map(line).collect()
    };
    let marks: Vec<f64> = simulation.events.iter().map(|event| event.time).collect();
    let figure = |title: &str, names: &[String], axis: &str, rows: &[Vec<f64>]| {
        let count = names.len();
        let text = if count > DRAWN { format!("The first {DRAWN} of {count}.") } else { String::new() };
        Figure::over_time(title, text, &simulation.times, &lines(names, rows), axis, &marks)
    };
    let mut figures = Vec::new();
    if !file.links.is_empty() {
        figures.push(figure("Forces", &file.links, "torque, N m (force, N)", &simulation.forces));
    }
    figures.push(figure("Speeds", &file.coordinates, "speed, rad/s (m/s)", &simulation.speeds));
    let mut facts = vec![
        fact("length of the run", format!("{} s", significant(simulation.time))),
        fact("events", simulation.events.len().to_string()),
        fact("proof", proof(simulation).join("; ")),
    ];
    let factor = |l: &result::Carried| l.dynamic_factor.map(|k| (l.name.clone(), k));
    if let Some((name, k)) = simulation.links.iter().filter_map(factor).max_by(|a, b| a.1.total_cmp(&b.1)) {
        facts.push(fact("greatest dynamic factor", format!("{} ({name})", significant(k))));
    }
    Sheet {
        name: file.name.clone(),
        kicker: "simulation by the full solver".to_owned(),
        summary:
            "A run of the machine by the full solver: exact between its events, and done again by a second integrator."
                .to_owned(),
        facts,
        figures,
        tables: tables(simulation),
    }
    .page()
}
