//! The survey cut into jobs.

use std::collections::VecDeque;
use std::error::Error;
use std::sync::{Mutex, PoisonError};

use driveline_firmware::board::{BOARDS, Facts};

use super::selection::{COMMISSIONING, GENERATOR};
use super::{Aim, Factor, Run, SceneFigures, Survey, Wanted};
use crate::balancing;
use crate::campaign::SCENES as CAMPAIGNS;
use crate::campaign::sample;
use crate::candidates::{Candidate, candidates};
use crate::cases::{self, Case};
use crate::commissioning;
use crate::commissioning::Verdict;
use crate::drivetrains::engine;
use crate::drivetrains::engine::Options;
use crate::drivetrains::{Build, SCENES};
use crate::generator::verdict::{self, Verdicts};
use cargo_driveline::campaign::drive::Drive;
use cargo_driveline::campaign::scenes::CampaignScene;
use driveline_closed_loop::departure::Departure;
use driveline_report::{Sample, Variant};

/// A job of one thread.
pub struct Job {
    /// The scene or the part that it belongs to.
    pub place: String,
    pub name: String,
    /// The core whose images it builds; empty for none.
    pub core: &'static str,
    /// How long it takes beside others, about, in thousands of ticks of a closed loop.
    pub weight: u64,
    /// Does it, with reports of the present step.
    pub work: Work,
}

/// The work of a job.
pub type Work = Box<dyn FnOnce(&dyn Fn(&str)) -> Result<Piece, String> + Send>;

/// Result of a job.
pub enum Piece {
    /// A variant of the scene of that name, and what is aimed at there.
    Run(String, Aim, Box<Run>),
    /// The chosen drive on a sample of machines.
    Sample(Box<Sample>),
    /// A generator set's verdicts.
    Generator(Verdicts),
    /// A machine that was commissioned.
    Commissioned(Box<Verdict>),
    /// A rotor of the scene of that name.
    Balanced(String, Box<balancing::Ran>),
    Cases(Vec<Case>),
}

/// The seed of balancing is the same in every run.
const SEED: u64 = 1;

/// Machines of a scene's sample.
const SAMPLED: u64 = 20;

/// The place of what belongs to no scene.
pub const CASES: &str = "cases";

/// The jobs for what is wanted, the longest of those that take one core for long first; and the survey that their
/// pieces belong in, with the scenes in their order. A scene whose plant cannot be made is among its failures.
///
/// With `quick` a scene runs for two seconds, unproven.
pub fn jobs(wanted: &Wanted, quick: bool) -> (Vec<Job>, Survey) {
    let (mut jobs, mut survey) = (Vec::new(), Survey { quick, part: !wanted.everything(), ..Survey::default() });
    if wanted.everything() {
        jobs.push(published());
    }
    if wanted.has(GENERATOR) {
        jobs.extend(verdict::variants(None).into_iter().map(generator));
    }
    if wanted.has(COMMISSIONING) {
        match commissioning::cases() {
            Ok(cases) => jobs.extend(cases.into_iter().map(|case| commissioned(case, quick))),
            Err(error) => {
                let (place, job) = (COMMISSIONING.to_owned(), "the plants".to_owned());
                survey.failures.push(super::Failure { place, job, reason: error.to_string() });
            }
        }
    }
    for scene in balancing::scenes().into_iter().filter(|scene| wanted.has(scene.name)) {
        survey.balanced.push((scene.name.to_owned(), Vec::new()));
        jobs.extend(scene.variants(None).into_iter().map(|(variant, board)| balanced(scene, variant, board)));
    }
    if !quick {
        jobs.extend(CAMPAIGNS.iter().filter(|scene| wanted.has(scene.name)).map(sampled));
    }
    for &(name, build) in SCENES.iter().filter(|(name, _)| wanted.has(name)) {
        let machine = match build() {
            Ok(machine) => machine,
            Err(error) => {
                let (place, job) = (name.to_owned(), "the plant".to_owned());
                survey.failures.push(super::Failure { place, job, reason: error.to_string() });
                continue;
            }
        };
        let seconds: f64 = machine.scenarios.iter().map(|scenario| scenario.duration).sum();
        survey.scenes.push(SceneFigures {
            name: name.to_owned(),
            summary: machine.summary.to_owned(),
            aim: Aim::TIGHT,
            runs: Vec::new(),
        });
        jobs.extend(
            candidates(name, None).into_iter().map(|candidate| drivetrain(name, build, candidate, seconds, quick)),
        );
    }
    (in_turn(jobs), survey)
}

/// The jobs in turn for one core and for another, in their order else: images of one core are built one after another,
/// those of two side by side.
fn in_turn(jobs: Vec<Job>) -> Vec<Job> {
    let mut queues: Vec<(&str, VecDeque<Job>)> = Vec::new();
    for job in jobs {
        match queues.iter_mut().find(|(core, _)| *core == job.core) {
            Some((_, queue)) => queue.push_back(job),
            None => queues.push((job.core, VecDeque::from([job]))),
        }
    }
    // Jobs without an image come first.
    let mut ordered = Vec::new();
    queues.iter_mut().filter(|(core, _)| core.is_empty()).for_each(|(_, queue)| ordered.extend(queue.drain(..)));
    while queues.iter().any(|(_, queue)| !queue.is_empty()) {
        ordered.extend(queues.iter_mut().filter_map(|(_, queue)| queue.pop_front()));
    }
    ordered
}

impl Survey {
    /// Puts a piece in its place.
    pub fn add(&mut self, piece: Piece) {
        match piece {
            Piece::Run(scene, aim, run) => {
                if let Some(scene) = self.scenes.iter_mut().find(|one| one.name == scene) {
                    // Through backlash where any variant went through it.
                    if aim == Aim::BACKLASH {
                        scene.aim = aim;
                    }
                    scene.runs.push(*run);
                    // jobs end in any order
                    let at = |run: &Run| {
                        let Variant { number, core, observer, rate_hz, .. } = &run.variant;
                        (observer.clone(), *rate_hz, number.clone(), core.clone())
                    };
                    scene.runs.sort_by_cached_key(at);
                }
            }
            Piece::Sample(sample) => {
                self.samples.push(*sample);
                let at = |sample: &Sample| self.scenes.iter().position(|scene| sample.is_of(&scene.name));
                self.samples.sort_by_key(at);
            }
            Piece::Generator(verdicts) => {
                let all = self.generator.get_or_insert_with(Verdicts::default);
                all.verdicts.extend(verdicts.verdicts);
                all.faults.extend(verdicts.faults);
                all.trips.extend(verdicts.trips);
            }
            Piece::Commissioned(verdict) => {
                self.commissioned.push(*verdict);
                self.commissioned.sort_by(|a, b| a.machine.cmp(&b.machine));
            }
            Piece::Balanced(scene, ran) => {
                if let Some((_, all)) = self.balanced.iter_mut().find(|(name, _)| *name == scene) {
                    all.push(*ran);
                }
            }
            Piece::Cases(cases) => self.cases.extend(cases),
        }
    }
}

fn sentence(error: Box<dyn Error>) -> String {
    error.to_string()
}

fn published() -> Job {
    let work = |says: &dyn Fn(&str)| {
        says("published and extreme cases");
        cases::all().map(Piece::Cases)
    };
    let name = "published and extreme cases".into();
    Job { place: CASES.into(), name, core: "", weight: 200, work: Box::new(work) }
}

fn generator(candidate: Candidate) -> Job {
    let work = move |says: &dyn Fn(&str)| {
        let verdicts = verdict::run_all(&[candidate], true, says, &|| {}).map_err(sentence)?;
        Ok(Piece::Generator(verdicts))
    };
    Job {
        place: GENERATOR.into(),
        name: candidate.key(),
        core: candidate.board.core,
        weight: 600,
        work: Box::new(work),
    }
}

/// In QEMU where that does not take long, else on the host; `quick`, all on the host.
fn commissioned(case: commissioning::Case, quick: bool) -> Job {
    let board = BOARDS.iter().find(|board| board.core == "m4f" && !quick && case.brief).copied();
    let name = case.name.clone();
    let work = move |says: &dyn Fn(&str)| {
        let says = |text: &str| says(&format!("commissioning the {}{text}", case.name));
        says("");
        let (course, target) = match board {
            Some(board) => {
                let built = |text: &str| says(&format!(": {text}"));
                let (course, target) =
                    commissioning::in_qemu(&case, board, SEED, built, |_, _| {}).map_err(sentence)?;
                (course, Some(target))
            }
            None => (commissioning::on_host(&case, SEED, |_, _| {}).map_err(sentence)?, None),
        };
        Ok(Piece::Commissioned(Box::new(commissioning::verdict(&case, &course, target))))
    };
    Job {
        place: COMMISSIONING.into(),
        name,
        core: board.map_or("", |board| board.core),
        weight: if board.is_some() { 1_500 } else { 100 },
        work: Box::new(work),
    }
}

/// The design's choice in `f32` on machines within the scene's tolerances.
fn sampled(scene: &'static CampaignScene) -> Job {
    let work = move |says: &dyn Fn(&str)| {
        says(&format!("{} within its tolerances", scene.name));
        let machine = scene.departing(&Departure::NONE).map_err(|error| error.to_string())?;
        let drive = Drive::named(scene, &machine, None)?;
        Ok(Piece::Sample(Box::new(sample(scene, &drive, SAMPLED, 1)?)))
    };
    Job { place: scene.name.into(), name: "tolerances".into(), core: "", weight: 400, work: Box::new(work) }
}

fn balanced(scene: balancing::Scene, variant: &'static str, board: Facts) -> Job {
    let work = move |says: &dyn Fn(&str)| {
        let ran = scene.in_qemu(variant, board, SEED, says).map_err(sentence)?;
        Ok(Piece::Balanced(scene.name.to_owned(), Box::new(ran)))
    };
    Job {
        place: scene.name.into(),
        name: format!("{variant} on {}", board.core),
        core: board.core,
        weight: 600,
        work: Box::new(work),
    }
}

/// Sizes of the images without a drive, by core: every variant's are reckoned from them.
static EMPTY: Mutex<Vec<(&str, (u64, u64))>> = Mutex::new(Vec::new());

fn empty(board: Facts, says: &dyn Fn(&str)) -> Result<(u64, u64), String> {
    // Under the lock, lest two threads build the same image.
    let mut known = EMPTY.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, sizes)) = known.iter().find(|(core, _)| *core == board.core) {
        return Ok(*sizes);
    }
    let sizes = engine::empty(board, says).map_err(sentence)?;
    known.push((board.core, sizes));
    Ok(sizes)
}

fn drivetrain(scene: &'static str, build: Build, candidate: Candidate, seconds: f64, quick: bool) -> Job {
    let work = move |says: &dyn Fn(&str)| {
        let machine = build().map_err(|error| error.to_string())?;
        let base = empty(candidate.board, says)?;
        let says = |text: &str| says(&format!("{scene} {text}"));
        let ran = engine::run(&machine, &candidate, base, Options { quick }, &says).map_err(sentence)?;
        let chosen = (candidate.part(2), candidate.rate_hz()) == machine.chosen;
        let aim = Aim::of(&machine, &ran.traces);
        let runs = ran.traces.iter().zip(&machine.scenarios);
        let factors = runs.map(|(trace, scenario)| Factor::of(&machine, scenario, &trace.moments)).collect();
        let run = Run { variant: ran.variant, chosen, factors };
        Ok(Piece::Run(scene.to_owned(), aim, Box::new(run)))
    };
    let ticks = seconds * f64::from(candidate.rate_hz());
    Job {
        place: scene.into(),
        name: candidate.key(),
        core: candidate.board.core,
        weight: 5 + (1e-3 * ticks) as u64,
        work: Box::new(work),
    }
}
