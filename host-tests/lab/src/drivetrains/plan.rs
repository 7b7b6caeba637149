//! A scene's report, put together from its runs.

use std::error::Error;
use std::sync::mpsc::{self, Sender};
use std::thread;

use driveline_firmware::board::Facts;

use super::engine::{self, Options, Ran};
use super::{SCENES, facts};
use crate::candidates::{Candidate, candidates};
use driveline_closed_loop::scenario::Machine;
use driveline_qemu::clone::workspace;
use driveline_qemu::measure::budgets::Budgets;
use driveline_report::{Budget, Report};

/// A run that is ready to start.
pub struct Plan {
    machine: Machine,
    candidates: Vec<Candidate>,
    options: Options,
}

/// Which variants of a scene are run.
#[derive(Clone, Copy, Debug)]
pub enum Variants<'a> {
    /// The design's choice of observer and rate, in the number that each core is for.
    Chosen,
    /// All.
    All,
    /// Those whose number/core/observer/rate contains this.
    Containing(&'a str),
}

impl Plan {
    /// The run of some variants of a scene.
    pub fn of(scene: &str, variants: Variants<'_>, quick: bool) -> Result<Self, String> {
        let Some((_, machine)) = SCENES.iter().find(|(name, _)| *name == scene) else {
            let names: Vec<String> = SCENES.iter().map(|(name, _)| format!("`{name}`")).collect();
            return Err(format!("there is no drivetrain `{scene}`; there are {}", names.join(", ")));
        };
        let machine = machine().map_err(|error| format!("the plant of scene `{scene}`: {error}"))?;
        let candidates = match variants {
            Variants::All => candidates(scene, None),
            Variants::Chosen => {
                let chosen = |one: &Candidate| one.is_native() && (one.part(2), one.rate_hz()) == machine.chosen;
                candidates(scene, None).into_iter().filter(chosen).collect()
            }
            Variants::Containing(filter) => {
                let some = candidates(scene, Some(filter));
                if some.is_empty() {
                    let all = keys(scene);
                    return Err(format!("no variant of `{scene}` contains `{filter}`; there are {all}"));
                }
                some
            }
        };
        Ok(Plan { machine, candidates, options: Options { quick } })
    }

    /// The boards that it runs on.
    pub fn boards(&self) -> impl Iterator<Item = &Facts> {
        self.candidates.iter().map(|candidate| &candidate.board)
    }

    /// Steps of the run, for its progress.
    pub fn steps(&self) -> u64 {
        self.candidates.len() as u64
    }

    /// Runs it. `says` names what is under way, `step` counts.
    ///
    /// # Errors
    /// What kept a variant from being built, run or proven, with its name.
    pub fn run(&self, says: &dyn Fn(&str), step: &dyn Fn()) -> Result<Report, Box<dyn Error>> {
        let mut report = Report {
            scene: self.machine.name.into(),
            summary: self.machine.summary.into(),
            facts: self.machine.facts.clone(),
            notes: facts::notes(&self.machine, self.options.quick),
            ..Report::default()
        };
        let bases = self.bases(says)?;
        for candidate in &self.candidates {
            let base = bases.iter().find(|(core, _)| *core == candidate.board.core).ok_or("no empty image")?.1;
            let ran = engine::run(&self.machine, candidate, base, self.options, says)?;
            self.add(&mut report, candidate, &ran);
            step();
        }
        self.budgets(&mut report)?;
        Ok(report)
    }

    /// Flash and RAM of the image without a drive, for each core; a core beside the other.
    fn bases(&self, says: &dyn Fn(&str)) -> Result<Vec<(&'static str, (u64, u64))>, String> {
        let mut boards: Vec<Facts> = Vec::new();
        for board in self.boards() {
            if boards.iter().all(|known| known.core != board.core) {
                boards.push(*board);
            }
        }
        let (said, heard) = mpsc::channel();
        thread::scope(|scope| {
            let base = |board: Facts, said: Sender<String>| {
                // whoever listens has gone only where this scope ends by a panic
                let says = |text: &str| drop(said.send(text.to_owned()));
                let base = engine::empty(board, &says).map_err(|error| error.to_string())?;
                Ok((board.core, base))
            };
            let spawn = |board: Facts| {
                let said = said.clone();
                scope.spawn(move || base(board, said))
            };
            let threads: Vec<_> = boards.into_iter().map(spawn).collect();
            drop(said);
            heard.iter().for_each(|text| says(&text));
            let joined = threads.into_iter().map(|thread| thread.join());
            joined.map(|base| base.map_err(|_| "a board's thread panicked".to_owned())?).collect()
        })
    }

    /// A variant's figures, and its courses where they are worth a plot.
    fn add(&self, report: &mut Report, candidate: &Candidate, ran: &Ran) {
        report.variants.push(ran.variant.clone());
        let (chosen, rate_hz) = self.machine.chosen;
        if candidate.rate_hz() == rate_hz && candidate.part(2) != "cut" {
            let courses = engine::trajectories(&self.machine, ran);
            // The first is shown first: the design's choice.
            let at =
                if candidate.part(2) == chosen && candidate.part(1) == "f32" { 0 } else { report.trajectories.len() };
            report.trajectories.splice(at..at, courses);
        }
        if candidate.part(2) == chosen && candidate.rate_hz() == rate_hz {
            report.facts.extend(facts::of_sudden(&self.machine, &ran.variant, &ran.traces));
        }
    }

    /// Budgets against the measurements in closed loop.
    fn budgets(&self, report: &mut Report) -> Result<(), Box<dyn Error>> {
        let budgets = Budgets::read(&workspace()?.join("budgets.toml"))?;
        for (candidate, variant) in self.candidates.iter().zip(&report.variants) {
            let Some(budget) = budgets.of(candidate.variant, candidate.board.core).map(|budget| budget.limits()) else {
                continue;
            };
            let figures = [
                ("instructions at most", variant.instructions.max, budget.longest),
                ("stack", variant.stack_bytes, budget.stack),
            ];
            for (name, measured, limit) in figures {
                if let Some(limit) = limit {
                    let unit = if name == "stack" { "byte" } else { "" };
                    report.budgets.push(Budget {
                        name: format!("{name}, {}", variant.label()),
                        unit: unit.into(),
                        measured: measured as f64,
                        limit: limit as f64,
                    });
                }
            }
        }
        Ok(())
    }
}

/// The keys of a scene's variants, for a message.
fn keys(scene: &str) -> String {
    let keys: Vec<String> = candidates(scene, None).iter().map(Candidate::key).collect();
    keys.join(", ")
}
