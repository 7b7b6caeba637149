//! Every observer on every scene.

use std::error::Error;

use driveline_firmware::Words;
use driveline_report::Table;
use driveline_report::format::percent;
use serde::Serialize;

use super::count::{CORES, Cost, Images, cost_cells, cost_headings};
use super::recording::Recording;
use super::replay::Replay;
use crate::drivetrains::SCENES;
use driveline_closed_loop::lockstep::Imperfections;
use driveline_closed_loop::units::Units;

/// Errors of an observer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// The corner or radius that it is tuned to (rad/s).
    pub tuned: Option<f64>,
    /// Root mean square error of the shaft torque, of its peak.
    pub shaft_torque: f64,
    /// The same of the load speed, of rated.
    pub load_speed: f64,
}

/// An observer on a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observer {
    pub name: String,
    /// Whether it is the library's, with the gains of its design or with Luenberger's.
    pub library: bool,
    /// On the scene's own runs.
    pub own: Accuracy,
    /// On runs of machines drawn from within the tolerances, other ones than those that it was tuned on.
    pub drawn: Accuracy,
    /// Cost by core.
    pub costs: Vec<Cost>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneComparison {
    /// Its name.
    pub scene: String,
    /// Ticks a second.
    pub rate_hz: u32,
    /// Ticks of its runs.
    pub ticks: usize,
    pub observers: Vec<Observer>,
}

/// All scenes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Comparison {
    pub scenes: Vec<SceneComparison>,
    /// Day and commit.
    pub measured: String,
}

/// An error that is smaller by this share is better.
const BETTER: f64 = 0.01;
/// Ticks that are counted in QEMU.
const COUNTED: usize = 1_000;
/// Machines drawn that what is swept is tuned on, and others that all are judged on.
const TUNING: u64 = 5;
const JUDGING: u64 = 10;
/// Corners of a sweep: two an octave.
const STEP: f64 = core::f64::consts::SQRT_2;

/// The names of the scenes that are compared.
pub fn scenes() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|(name, _)| *name)
}

impl SceneComparison {
    /// Runs a scene, each of its runs for so many seconds at most.
    pub fn run(
        scene: &str,
        seconds: f64,
        replay: &Replay,
        images: &Images,
        says: &dyn Fn(&str),
    ) -> Result<Self, Box<dyn Error>> {
        let (_, build) = SCENES.iter().find(|(name, _)| *name == scene).ok_or("no such scene")?;
        let machine = build()?;
        says(&format!("{scene}: closed loop"));
        let own = Recording::of(&machine, seconds, &Imperfections::default())?;
        let [tuning, judging] = [0..TUNING, TUNING..TUNING + JUDGING];
        let [tuning, judging] =
            [Recording::drawn(scene, *build, tuning, seconds)?, Recording::drawn(scene, *build, judging, seconds)?];
        let listed = replay.list()?;
        let place = listed.scenes.iter().position(|name| name == scene).ok_or("no observers for this scene")?;
        let mut observers = Vec::new();
        for (peer, name) in listed.peers.iter().enumerate() {
            says(&format!("{scene}: {name}"));
            let words = if name.ends_with("fixed") { Words::Fixed } else { Words::Single };
            let units = Units::new(words, machine.bases);
            let errors = |corner: f64, recording: &Recording| -> Result<Option<[f64; 2]>, Box<dyn Error>> {
                let estimates = replay.estimates([place, peer], corner as f32, recording, &units)?;
                Ok((!estimates.is_empty()).then(|| recording.errors(&estimates)))
            };
            let is_tuned = listed.tuned.contains(name);
            // From a turn in six seconds to the tick rate.
            let octaves = if is_tuned { f64::from(machine.chosen.1).log2() } else { 0.0 };
            let corners: Vec<f64> = (0..=(2.0 * octaves) as i32).map(|half| STEP.powi(half)).collect();
            // Tuned on the first, judged on the second.
            let accuracy = |tuned_on: &Recording, on: &Recording| -> Result<Option<Accuracy>, Box<dyn Error>> {
                let mut best: Option<(f64, f64)> = None;
                if is_tuned {
                    for &corner in &corners {
                        if let Some([error, _]) = errors(corner, tuned_on)?
                            && best.is_none_or(|(_, least)| error < least)
                        {
                            best = Some((corner, error));
                        }
                    }
                }
                let corner = best.map_or(1.0, |(corner, _)| corner);
                Ok(errors(corner, on)?.map(|[shaft_torque, load_speed]| Accuracy {
                    tuned: is_tuned.then_some(corner),
                    shaft_torque,
                    load_speed,
                }))
            };
            let Some(on_own) = accuracy(&own, &own)? else { continue };
            let Some(on_drawn) = accuracy(&tuning, &judging)? else { continue };
            let corner = on_own.tuned.unwrap_or(1.0);
            let library = name.starts_with("driveline");
            let mut costs = Vec::new();
            for core in CORES {
                // The library in the number that the core is for.
                if library && (words == Words::Single) != (core == "m4f") {
                    continue;
                }
                says(&format!("{scene}: {name} on {core}"));
                let stretch = own.stretch(COUNTED);
                costs.extend(images.cost(core, [place, peer], corner as f32, stretch, &units)?);
            }
            observers.push(Observer { name: name.clone(), library, own: on_own, drawn: on_drawn, costs });
        }
        // The first is none: what the frame costs.
        let frame = observers.remove(0);
        for cost in observers.iter_mut().flat_map(|observer| &mut observer.costs) {
            let nothing = frame.costs.iter().find(|frame| frame.core == cost.core).map_or(0, |frame| frame.median);
            cost.median = cost.median.saturating_sub(nothing);
            cost.worst = cost.worst.saturating_sub(nothing);
        }
        Ok(SceneComparison { scene: scene.to_owned(), rate_hz: machine.chosen.1, ticks: own.ticks.len(), observers })
    }

    pub fn on<'c>(&'c self, core: &'c str) -> impl Iterator<Item = (&'c Observer, &'c Cost)> {
        self.observers.iter().filter_map(move |observer| {
            observer.costs.iter().find(|cost| cost.core == core).map(|cost| (observer, cost))
        })
    }

    /// Names of the others that win on a core, by the shaft torque of the runs that are chosen.
    pub fn winners<'c>(&'c self, core: &'c str, of: fn(&Observer) -> Accuracy) -> Vec<&'c str> {
        self.others(core, |observer, rivals| {
            let better = |rival: &&Observer| of(observer).shaft_torque < (1.0 - BETTER) * of(rival).shaft_torque;
            !rivals.is_empty() && rivals.iter().all(better)
        })
    }

    /// Names of the others that take fewer instructions on a core than any observer of the library.
    pub fn cheaper<'c>(&'c self, core: &'c str) -> Vec<&'c str> {
        self.others(core, |_, rivals| rivals.is_empty())
    }

    /// Names of the others, by what is said of them beside the library's that take no more instructions.
    fn others<'c>(&'c self, core: &'c str, is: impl Fn(&Observer, &[&Observer]) -> bool) -> Vec<&'c str> {
        let mut names = Vec::new();
        for (observer, cost) in self.on(core).filter(|(observer, _)| !observer.library) {
            let rivals: Vec<&Observer> = self
                .on(core)
                .filter(|(rival, of)| rival.library && of.median <= cost.median)
                .map(|(rival, _)| rival)
                .collect();
            if is(observer, &rivals) {
                names.push(observer.name.as_str());
            }
        }
        names
    }

    /// A row an observer.
    pub fn table(&self) -> Table {
        let headings = ["observer", "tuned to", "shaft torque", "load speed", "tuned to", "drawn: torque", "speed"]
            .map(str::to_owned);
        let mut table = Table::new(headings.into_iter().chain(cost_headings()));
        for observer in &self.observers {
            let mut row = vec![observer.name.clone()];
            for accuracy in [observer.own, observer.drawn] {
                row.push(accuracy.tuned.map_or_else(String::new, |corner| format!("{corner:.0} rad/s")));
                row.extend([accuracy.shaft_torque, accuracy.load_speed].map(percent));
            }
            row.extend(cost_cells(&observer.costs));
            table.row(row);
        }
        table
    }
}
