//! The sets' firmware in QEMU against their full plants, and the class that each reaches.

use std::error::Error;

use driveline::design::Margins;
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::generator::{DIESEL, DieselSet, HasSet, RATED_SPEED, TURBINE, TurbineSet};
use serde::Serialize;

use super::faults::{FAULTS, Outcome, PASSING, WIRES, outcome};
use super::run::{Moment, Program, run};
use super::set::Kind;
use super::standard::{Figures, figures};
use super::trips::{CAUSES, Latched, latched};
use crate::candidates::{Candidate, candidates};
use driveline_closed_loop::ticks::Ticks;
use driveline_qemu::image::{Image, Program as Binary, build};
use driveline_qemu::link::Link;
use driveline_qemu::measure::Spread;

/// How a set was governed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// With the estimated load fed forward.
    FeedForward,
    /// Without.
    Plain,
}

/// The ways, as the panel's choice of constants counts them.
pub const WAYS: [Way; 2] = [Way::FeedForward, Way::Plain];

impl Way {
    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Way::FeedForward => "with feed-forward",
            Way::Plain => "without",
        }
    }
}

/// Result of one variant in one way.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// Diesel or turbine.
    pub set: &'static str,
    /// Number and core.
    pub variant: String,
    /// How it was governed.
    pub way: Way,
    /// Measurement.
    pub figures: Figures,
    /// The class of ISO 8528-5, for the diesel.
    pub class: Option<&'static str>,
    /// Whether NEMA SM 23 class D is met, for the turbine.
    pub class_d: Option<bool>,
    /// Whether it tripped.
    pub tripped: bool,
    /// Least and largest torque commanded, of rated.
    pub torque: [f64; 2],
    /// Instructions of the tick: least, median, most.
    pub instructions: Spread,
    /// Whether the host gives the same bits over the same inputs.
    pub bit_exact: bool,
    /// Gain margin upwards, phase margin (degrees) and modulus margin of the design.
    pub margins: [f64; 3],
    /// The run.
    #[serde(skip)]
    pub moments: Vec<Moment>,
}

/// Everything that the command says.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Verdicts {
    /// One for each variant and way.
    pub verdicts: Vec<Verdict>,
    /// Faults on each input, on the diesel: number and core, outcome.
    pub faults: Vec<(String, Outcome)>,
    /// Every trip brought about, on the diesel: number and core, outcome.
    pub trips: Vec<(String, Latched)>,
}

/// The loads of a set's run: time (s), share of rated power.
pub const fn loads(kind: Kind) -> &'static [(f64, f64)] {
    match kind {
        // A turbocharged engine's steps: half, then what its charge pressure allows.
        Kind::Diesel => &[(0.0, 0.0), (9.0, 0.5), (13.0, 0.8), (17.0, 1.0), (22.0, 0.0)],
        Kind::Turbine => &[(0.0, 0.0), (12.0, 0.25), (22.0, 0.5), (32.0, 0.75), (42.0, 1.0), (56.0, 0.0)],
    }
}

/// The run of a set in a way: the diesel is started from its starter's speed, the turbine found turning.
pub fn program(kind: Kind, way: Way) -> Program {
    let (speed, duration) = match kind {
        Kind::Diesel => (20.0, 27.0),
        Kind::Turbine => (RATED_SPEED, 112.0),
    };
    Program { speed, on: 0.5, constants: way as u32, loads: loads(kind).to_vec(), seizes: None, duration }
}

/// The margins of a set's design.
pub fn margins(kind: Kind, way: Way) -> Margins {
    let (designs, set) = match kind {
        Kind::Diesel => (&DieselSet::DESIGNS, &DIESEL),
        Kind::Turbine => (&TurbineSet::DESIGNS, &TURBINE),
    };
    designs.governors[way as usize].margins(&set.machine)
}

/// Ticks that are kept, to be compared with the host's.
struct Kept<T> {
    drive: T,
    words: Vec<(Input, Output)>,
}

impl<T: Ticks> Ticks for Kept<T> {
    fn tick(&mut self, input: &Input) -> std::io::Result<Output> {
        let output = self.drive.tick(input)?;
        self.words.push((*input, output));
        Ok(output)
    }
}

/// The kind of set that a variant's name says.
fn kind_of(candidate: &Candidate) -> Kind {
    if candidate.part(2) == Kind::Turbine.name() { Kind::Turbine } else { Kind::Diesel }
}

/// The variants that are run: each number on the core that it is for.
pub fn variants(filter: Option<&str>) -> Vec<Candidate> {
    candidates("generator", filter).into_iter().filter(Candidate::is_native).collect()
}

/// Text that a filter matches, for each variant: for a message.
pub fn names() -> Vec<String> {
    variants(None).iter().map(Candidate::key).collect()
}

/// Runs a variant in a way, in QEMU.
fn judge(candidate: &Candidate, image: &Image, way: Way) -> Result<Verdict, Box<dyn Error>> {
    let kind = kind_of(candidate);
    let program = program(kind, way);
    let mut kept = Kept { drive: Link::start(image)?, words: Vec::new() };
    let moments = run(kind, candidate.words(), &program, &mut kept, |_, _| {})?;
    kept.drive.finish()?;
    Ok(verdict(kind, candidate, way, moments, &kept.words))
}

fn verdict(kind: Kind, candidate: &Candidate, way: Way, moments: Vec<Moment>, words: &[(Input, Output)]) -> Verdict {
    let figures = figures(&moments, loads(kind), program(kind, way).duration);
    let tripped = moments.iter().any(|moment| moment.mode >= 16);
    let class = if tripped { None } else { figures.class() };
    let commands = || moments.iter().map(|moment| moment.command);
    let margins = margins(kind, way);
    Verdict {
        set: kind.name(),
        variant: format!("{}/{}", candidate.part(1), candidate.board.core),
        way,
        class: class.filter(|_| kind == Kind::Diesel),
        class_d: (kind == Kind::Turbine).then(|| !tripped && figures.meets_class_d()),
        figures,
        tripped,
        torque: [commands().fold(f64::INFINITY, f64::min), commands().fold(f64::NEG_INFINITY, f64::max)],
        instructions: Spread::of(moments.iter().map(|moment| moment.instructions).collect()),
        bit_exact: find(candidate.variant).is_some_and(|row| row.gives(words)),
        margins: [margins.gain_up, margins.phase.to_degrees(), margins.modulus],
        moments,
    }
}

/// Steps of a run, for its progress.
pub fn steps(variants: &[Candidate], faults: bool) -> u64 {
    variants.iter().map(|one| 2 + u64::from(faults && kind_of(one) == Kind::Diesel)).sum()
}

/// Runs every variant in both ways, and with `faults` the diesel's with every fault. `says` names what is under way,
/// `step` counts.
pub fn run_all(
    variants: &[Candidate],
    faults: bool,
    says: &dyn Fn(&str),
    step: &dyn Fn(),
) -> Result<Verdicts, Box<dyn Error>> {
    let mut all = Verdicts::default();
    for candidate in variants {
        let key = candidate.key();
        says(&format!("{key}: building"));
        let image = build(candidate.variant, candidate.board, Binary::ControlLoop, |_| {})?;
        for way in WAYS {
            says(&format!("{key}: load steps, {}, in QEMU", way.name()));
            all.verdicts.push(judge(candidate, &image, way)?);
            step();
        }
        if faults && kind_of(candidate) == Kind::Diesel {
            let name = format!("{}/{}", candidate.part(1), candidate.board.core);
            for wire in WIRES {
                for fault in FAULTS {
                    for lasting in [Some(PASSING), None] {
                        says(&format!("{key}: {wire:?} {fault:?} in QEMU"));
                        let mut link = Link::start(&image)?;
                        all.faults.push((name.clone(), outcome(candidate.words(), &mut link, wire, fault, lasting)?));
                        link.finish()?;
                    }
                }
            }
            for cause in &CAUSES {
                says(&format!("{key}: {} in QEMU", cause.what));
                let mut link = Link::start(&image)?;
                all.trips.push((name.clone(), latched(candidate.words(), &mut link, cause)?));
                link.finish()?;
            }
            step();
        }
    }
    Ok(all)
}
