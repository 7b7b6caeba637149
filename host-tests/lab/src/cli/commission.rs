//! `cargo lab commissioning`: the identification test, against its full plant.

use std::path::{Path, PathBuf};

use clap::Args;
use driveline::commissioning::{Error, TestConfig};
use driveline_firmware::board::BOARDS;

use crate::commissioning::{Case, Trial, Verdict, in_qemu, named, of_file, on_host, verdict};
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use cargo_driveline::machine_file::{Diagnostic, MachineFile, Source, parse, text};
use driveline_qemu::setup::Need;
use driveline_report::format::significant;

/// Commission a machine: run the test that identifies its inertias, resonance, damping, friction, gap and encoder
/// eccentricity against its full plant, and compare the result with the true values.
///
/// The machine is `hoist`, `mill` or `spindle` as in the scene `commission`, or a file of elements as for `design`. The
/// motor's torque has white noise in every tick: for a file its torque accuracy, for a scene 1 % of rated torque.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab commissioning mill
  cargo lab commissioning hoist --qemu
  cargo lab commissioning mill.toml --friction 0.05
  cargo lab commissioning spindle --json > spindle.json")]
pub struct Commission {
    /// `hoist`, `mill`, `spindle`, or a TOML file of elements from the motor to the load
    machine: String,
    /// Run the firmware in QEMU on the M4F, with the host beside it (not for a file)
    #[arg(long)]
    qemu: bool,
    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// For a file: speed of the test, of the largest speed [default: 0.2]
    #[arg(long, value_name = "SHARE")]
    speed: Option<f64>,
    /// For a file: travel either way (rad) [default: 10000]
    #[arg(long, value_name = "RAD")]
    travel: Option<f64>,
    /// For a file: dry friction of the load, of the largest torque [default: 0]
    #[arg(long, value_name = "SHARE")]
    friction: Option<f64>,
    /// For a file: rated torque, of the largest torque [default: 0.5]
    #[arg(long, value_name = "SHARE")]
    rated: Option<f64>,
    /// For a file: where the resonance is looked for (Hz) [default: 0.2 of the antiresonance to 2.5 of the resonance,
    /// at most a tenth of the rate]
    #[arg(long, value_name = "HZ", num_args = 2, value_names = ["LOW", "HIGH"])]
    band: Option<Vec<f64>>,
    /// File of the page [default: report/NAME-commissioning.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

/// Stages of a test, for its progress.
const STAGES: [&str; 7] = ["holding", "friction", "encoder", "backlash", "resonance", "done", "refused"];

impl Commission {
    /// Runs the test and shows what it found.
    ///
    /// # Errors
    /// No such machine, a setting out of range, what kept QEMU from running; with exit code 1 where the test refused.
    pub fn execute(&self) -> Result<(), Failure> {
        let case = self.case()?;
        let name = format!("{}-commissioning", case.name);
        let page = Destination::page_unless(self.json, self.html.as_deref(), &name);
        check_writable(&[Path::new(&self.machine)], &page)?;
        let progress = Progress::of(STAGES.len() as u64);
        let mut last = u32::MAX;
        let seen = |tick: u64, stage: u32| {
            if stage != last {
                last = stage;
                progress.step();
            }
            if tick.is_multiple_of(65_536) {
                let name = usize::try_from(stage).ok().and_then(|stage| STAGES.get(stage)).copied();
                let seconds = tick as f64 * case.settings.rate.period().unwrap_or(0.0);
                progress.says(&format!("{}: {}, {seconds:.0} s at the machine", case.name, name.unwrap_or_default()));
            }
        };
        let run = if self.qemu {
            let Some(board) = BOARDS.iter().find(|board| board.core == "m4f") else {
                return Err(Failure::failed("there is no board with an M4F"));
            };
            ready(&Need::to_run([board]))?;
            in_qemu(&case, *board, self.seed, |line| progress.says(line.trim()), seen)
                .map(|(course, target)| (course, Some(target)))
        } else {
            on_host(&case, self.seed, seen).map(|course| (course, None))
        };
        let (course, target) = run.map_err(|error| Failure::failed(format!("{}: {error}", case.name)))?;
        drop(progress);
        self.show(&verdict(&case, &course, target), page)
    }

    fn case(&self) -> Result<Case, Failure> {
        let options = [
            ("--speed", self.speed),
            ("--travel", self.travel),
            ("--friction", self.friction),
            ("--rated", self.rated),
            ("--band", self.band.as_ref().map(|_| 1.0)),
        ];
        if !self.machine.ends_with(".toml") {
            if let Some((option, _)) = options.iter().find(|(_, value)| value.is_some()) {
                return Err(Failure::usage(format!("{option} is for a file `NAME.toml`, not for `{}`", self.machine)));
            }
            return named(&self.machine).map_err(|error| Failure::usage(format!("{error}, or a file `NAME.toml`")));
        }
        if self.qemu {
            return Err(Failure::usage("--qemu is for the machines of the firmware, not for a file"));
        }
        for (option, value) in options {
            let Some(value) = value else { continue };
            if option == "--friction" && !(value >= 0.0 && value.is_finite()) {
                return Err(Failure::usage(format!("--friction must be zero or above and finite, not {value:?}")));
            }
            if option != "--friction" && !(value > 0.0 && value.is_finite()) {
                return Err(Failure::usage(format!("{option} must be above zero and finite, not {value:?}")));
            }
            if option != "--travel" && value > 1.0 {
                return Err(Failure::usage(format!("{option} is a share of the largest: at most 1, not {value:?}")));
            }
        }
        let path = PathBuf::from(&self.machine);
        let machine = read_chain(&path)?;
        let band = self.band.as_deref().and_then(|band| band.try_into().ok());
        let trial = Trial {
            speed: self.speed.unwrap_or(0.2),
            travel: self.travel.unwrap_or(1.0e4),
            friction: self.friction.unwrap_or(0.0),
            rated: self.rated.unwrap_or(0.5),
            band,
        };
        let case = of_file(&machine, trial).map_err(|error| Failure::usage(format!("{}: {error}", self.machine)))?;
        if let Err(reason) = TestConfig::try_new(&case.settings) {
            let Trial { speed, travel, rated, .. } = trial;
            if reason == Error::ShaftTorque {
                return Err(Failure::usage(format!("{}: {}", self.machine, too_heavy(&case, rated))));
            }
            let [low, high] = case.settings.band;
            let tried = format!("with --speed {speed:?} --travel {travel:?} --rated {rated:?} --band {low:?} {high:?}");
            return Err(Failure::usage(format!("{}: {reason}, {tried}", self.machine)));
        }
        Ok(case)
    }

    fn show(&self, verdict: &Verdict, page: Option<Destination>) -> Result<(), Failure> {
        if self.json {
            say_json(verdict)?;
        } else {
            say(verdict.table());
            for sentence in verdict.sentences() {
                say(sentence);
            }
        }
        page.map_or(Ok(()), |page| page.write_and_say(&verdict.page(), self.json))?;
        match verdict.refused {
            Some(reason) => Err(Failure::failed(format!("the test refused: {reason}"))),
            None => Ok(()),
        }
    }
}

/// Why the shaft may not carry what holds the load, and what helps: the shaft of a file has half of rated torque.
fn too_heavy(case: &Case, rated: f64) -> String {
    let (most, held) = (case.settings.shaft_torque, case.settings.held.abs());
    let needed = rated * held / most;
    let remedy = if needed < 1.0 {
        format!("give --rated above {}", significant(needed))
    } else {
        "a lighter load in the file is expected: no --rated up to 1 is enough".to_owned()
    };
    let [most, held] = [most, held].map(significant);
    format!(
        "the largest torque of the shaft, {most} N m with --rated {rated:?}, must be above the holding torque of the \
         load, {held} N m; {remedy}"
    )
}

/// A machine without branches: the plant of a test is a chain.
fn read_chain(path: &Path) -> Result<MachineFile, Failure> {
    let (name, text) = text(path, "a machine file")?;
    let machine = parse(&name, &text)?;
    let Some(branch) = machine.branches.first() else { return Ok(machine) };
    let source = Source { name: &name, text: &text };
    let place = text.find("[[branch]]").map_or(0..0, |at| at..at + "[[branch]]".len());
    let found = format!("a branch at \"{}\"", branch.at);
    Err(Diagnostic::at(source, place, "branch[0]", found, "a chain alone: the test has no branches").into())
}
