//! Every observer on every scene.

use std::error::Error;

use driveline_firmware::Words;
use driveline_firmware::scenes::converter_ring;
use driveline_report::Table;
use driveline_report::format::{grouped, percent};
use serde::Serialize;

use super::count::{Cost, Images};
use super::recording::Recording;
use super::replay::Replay;
use crate::closed_loop::units::Units;
use crate::drivetrains::SCENES;

/// An observer on a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observer {
    /// Its name.
    pub name: String,
    /// Whether it is the library's.
    pub library: bool,
    /// The corner or radius that it is tuned to (rad/s).
    pub tuned: Option<f64>,
    /// Root mean square error of the shaft torque, of its peak.
    pub shaft_torque: f64,
    /// The same of the load speed, of rated.
    pub load_speed: f64,
    /// Cost by core.
    pub costs: Vec<Cost>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneComparison {
    /// Its name.
    pub scene: String,
    /// Ticks a second.
    pub rate_hz: u32,
    /// Ticks of its runs.
    pub ticks: usize,
    /// The observers.
    pub observers: Vec<Observer>,
}

/// All scenes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Comparison {
    /// The scenes.
    pub scenes: Vec<SceneComparison>,
}

/// The cores.
pub const CORES: [&str; 2] = ["m4f", "m3"];
/// An error that is smaller by this share is better.
const BETTER: f64 = 0.01;
/// Ticks that are counted in QEMU.
const COUNTED: usize = 1_000;
/// Corners of a sweep: two an octave.
const STEP: f64 = core::f64::consts::SQRT_2;

/// The names of the scenes. The converter's ring is none of them: its four angles are no signal of one observer.
pub fn scenes() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|(name, _)| *name).filter(|name| *name != converter_ring::SCENE)
}

impl SceneComparison {
    /// Runs a scene, each of its runs for so many seconds at most.
    ///
    /// # Errors
    /// A run, the program or an image that failed.
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
        let recording = Recording::of(&machine, seconds)?;
        let listed = replay.list()?;
        let place = listed.scenes.iter().position(|name| name == scene).ok_or("no observers for this scene")?;
        let mut observers = Vec::new();
        for (peer, name) in listed.peers.iter().enumerate() {
            says(&format!("{scene}: {name}"));
            let words = if name.ends_with("fixed") { Words::Fixed } else { Words::Single };
            let units = Units::new(words, machine.bases);
            let errors = |corner: f64| -> Result<Option<[f64; 2]>, Box<dyn Error>> {
                let estimates = replay.estimates([place, peer], corner as f32, &recording, &units)?;
                Ok((!estimates.is_empty()).then(|| recording.errors(&estimates)))
            };
            let is_tuned = listed.tuned.contains(name);
            // From a turn in six seconds to a fifth of the tick rate.
            let mut corner = 1.0;
            let mut best: Option<(f64, [f64; 2])> = None;
            loop {
                if let Some(errors) = errors(corner)?
                    && best.is_none_or(|(_, [least, _])| errors[0] < least)
                {
                    best = Some((corner, errors));
                }
                corner *= STEP;
                if !is_tuned || corner > f64::from(machine.chosen.1) {
                    break;
                }
            }
            let Some((corner, [shaft_torque, load_speed])) = best else { continue };
            let library = name.starts_with("driveline");
            let mut costs = Vec::new();
            for core in CORES {
                // The library in the number that the core is for.
                if library && (words == Words::Single) != (core == "m4f") {
                    continue;
                }
                says(&format!("{scene}: {name} on {core}"));
                let stretch = recording.stretch(COUNTED);
                costs.extend(images.cost(core, [place, peer], corner as f32, stretch, &units)?);
            }
            observers.push(Observer {
                name: name.clone(),
                library,
                tuned: is_tuned.then_some(corner),
                shaft_torque,
                load_speed,
                costs,
            });
        }
        // The first is none: what the frame costs.
        let frame = observers.remove(0);
        for cost in observers.iter_mut().flat_map(|observer| &mut observer.costs) {
            let nothing = frame.costs.iter().find(|frame| frame.core == cost.core).map_or(0, |frame| frame.median);
            cost.median = cost.median.saturating_sub(nothing);
            cost.worst = cost.worst.saturating_sub(nothing);
        }
        Ok(SceneComparison {
            scene: scene.to_owned(),
            rate_hz: machine.chosen.1,
            ticks: recording.ticks.len(),
            observers,
        })
    }

    /// The observers on a core with their costs.
    pub fn on<'c>(&'c self, core: &'c str) -> impl Iterator<Item = (&'c Observer, &'c Cost)> {
        self.observers.iter().filter_map(move |observer| {
            observer.costs.iter().find(|cost| cost.core == core).map(|cost| (observer, cost))
        })
    }

    /// Names of the others that win on a core, by the shaft torque.
    pub fn winners<'c>(&'c self, core: &'c str) -> Vec<&'c str> {
        self.others(core, |observer, rivals| {
            !rivals.is_empty() && rivals.iter().all(|rival| observer.shaft_torque < (1.0 - BETTER) * rival.shaft_torque)
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
        let mut table = Table::new([
            "observer",
            "tuned to",
            "shaft torque",
            "load speed",
            "m4f",
            "worst",
            "code",
            "stack",
            "state",
            "m3",
            "worst",
            "code",
            "stack",
            "state",
        ]);
        for observer in &self.observers {
            let tuned = observer.tuned.map_or_else(String::new, |corner| format!("{corner:.0} rad/s"));
            let errors = [observer.shaft_torque, observer.load_speed].map(percent);
            let mut row = vec![observer.name.clone(), tuned];
            row.extend(errors);
            for core in CORES {
                row.extend(match observer.costs.iter().find(|cost| cost.core == core) {
                    Some(cost) => [
                        i64::from(cost.median),
                        i64::from(cost.worst),
                        cost.code as i64,
                        i64::from(cost.stack),
                        i64::from(cost.state),
                    ]
                    .map(grouped),
                    None => Default::default(),
                });
            }
            table.row(row);
        }
        table
    }
}
