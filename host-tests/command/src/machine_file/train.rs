//! Trains of any shape from a file: coordinates, links between them, friction, torques, and a run.
//!
//! ```toml
//! name = "two motors on one ring"
//!
//! [[coordinate]]           # an angle (rad) or a way (m)
//! name = "motor"
//! inertia = 1.0            # kg m2, or kg
//! speed = 0.0              # rad/s at the start; `angle` and `viscous` may be given too
//!
//! [[coordinate]]
//! name = "ring"
//! inertia = 40.0
//!
//! [[link]]
//! name = "pinion"
//! between = ["motor", "ring"]
//! ratio = 5.0              # speed of the first over speed of the second, 1 where it is left out; negative for an
//!                          # external gear
//! stiffness = 3.0e4        # N m/rad
//! damping = 6.0            # N m s/rad
//! gap = 0.02               # rad, the whole backlash
//!
//! [[torque]]
//! on = "motor"             # positive torques drive forwards
//! kind = "line"
//! stall = 120.0
//! slope = 1.0
//!
//! [run]
//! time = 0.5               # s
//! step = 1e-3              # s, between the lines of the result
//! ```
//!
//! A file of elements (see [`super`]) with `[run]`, and where wanted `[[link]]`, `[[torque]]`, `[[friction]]` and
//! `[start]`, is a train as well: its masses, referred to the motor and named by their labels, are the coordinates; a
//! weight pulls on the last of them.
//!
//! | table | keys (those in brackets may be left out) |
//! |---|---|
//! | `[[coordinate]]` | `name`, `inertia`, (`speed`, `angle`, `viscous`), (`[coordinate.crank]` with `radius`, `rod`,
//! `slider_mass`, (`rod_mass`, `rod_inertia`, `rod_centre`, `[coordinate.crank.pins]` with `coefficient` and the radii
//! (`main`, `crank`, `wrist`), `pins_at`), or `[coordinate.four_bar]` with `crank`, `coupler`,
//! `rocker`, `ground`, (`coupler_mass`, `coupler_centre`, `coupler_inertia`, `rocker_inertia`,
//! `[coordinate.four_bar.pins]` with `coefficient` and (`main`, `crank`, `rocker`, `pivot`)), or
//! `[coordinate.toggle]` with the same and `link`, `direction`, `slider_mass`, or `[coordinate.cam]` with `lift`,
//! `mass`; each with (`friction`)), (`inertia_table`) |
//! | `[[spur_pair]]` | `name`, `mesh_stiffness`, (`mesh_damping`, `gap`), `[spur_pair.pinion]` and `[spur_pair.wheel]`
//! with `mass`, `inertia`, `base_radius`, `shaft_stiffness`, (`shaft_damping`), and two values each of `bearing_mass`,
//! `lever`, `stiffness_y`, `stiffness_x`, (`damping_y`, `damping_x`); a mesh as a link has it |
//! | `[[link]]` | `name`, `stiffness`, and `between` with (`ratio`), or `ground`, or `terms` as `[[share, ...]]` in
//! the order of `of`; (`damping`, `gap`, `rope`, `efficiency`, `back_efficiency`, `elongation`, `static`) |
//! | `[link.spur]` | `frequency` Hz, `contact_ratio`, `double`, `single` N/m or `face_width` m, `tooth_numbers`,
//! (`shift`), (`leaving` N/m, `error`, `next_error` m) |
//! | `[link.teeth]` | as `spur`, by the angle of the coordinate `of` with `count` teeth, instead of the frequency |
//! | `[link.harmonics]` | `frequency` Hz, (`stiffness`, `error`) as rows of order, cosine, sine |
//! | `[[friction]]` | `on` or `between`, `torque`, (`breakaway`, `surface`) |
//! | `[[torque]]` | `on`, `kind` and its keys: `constant` `torque`; `line` `stall` `slope`; `parabola` `a` `b` `c`;
//! `kloss` `breakdown` `slip` `synchronous`; `shunt` and `series` `voltage` `resistance` `flux`; `combustion`
//! `combustion_type` `rated_torque` `rated_speed` `idle` `no_load`; `starting` `torque` `time` `power`; `steps` and
//! `table` `points`; `triangle`, `square`, `sawtooth`, `sawtooth up`, `sawtooth down`, `rectified` `height` `period`
//! `terms`, `pulses` with `width`; `arc` `torque` `from` `to` (`turns`); `stroke` `force` (`from` `to`); `orders` `harmonics` |
//! | `[start]` | `kind`: `rest`, `slack`, or `pretensioned` with `held` |
//! | `[run]` | `time` s, `step` s, a whole number of which is the time, (`cycle`, `cycle_turns`, `starting` with
//! `starting_speed`); `modes` does without it |

mod coordinate;
mod friction;
mod link;
mod mechanism;
mod pin_forces;
mod reading;
mod spur_pair;
mod stiffness;
mod torque;

use std::path::Path;

use toml::de::DeTable;

use super::diagnostic::Diagnostic;
use super::engine::Engine;
use super::excitation::{Excitation, Running, excitations};
use super::quantity::Quantity;
use super::read::{self, document, named, text};
use super::referred::referred;
use super::source::Source;
use super::table::Table;
use driveline_solver::plant::train::{Crank, Motion, StrokeLoad, Train};
use driveline_solver::plant::{Place, PlantError};
pub(super) use mechanism::mean_inertia;
pub use pin_forces::PinForces;
use reading::{Joints, Reading};
pub(crate) use stiffness::too_stiff;

/// Most lines that a run may have.
const LINES: f64 = 1e6;

/// Most coordinates of a run, whose steps take a time with the square of their number; modes have no limit.
const COORDINATES: usize = 200;

/// A train as its file describes it, ready to run.
#[derive(Debug, Clone)]
pub struct TrainFile {
    pub name: String,
    /// Names of the coordinates.
    pub coordinates: Vec<String>,
    /// Names of the links.
    pub links: Vec<String>,
    /// Whether all coordinates are angles, as those of elements are; others may be ways.
    pub turns: bool,
    /// Static force of each link where the file gives one.
    pub static_force: Vec<Option<f64>>,
    /// What it is made of.
    pub train: Train,
    /// The train at its start.
    pub motion: Motion,
    /// The speeds of the first coordinate that it runs at, where the file says so.
    pub running: Option<Running>,
    pub excitations: Vec<Excitation>,
    /// s.
    pub time: f64,
    /// s.
    pub step: f64,
    /// Coordinates whose mechanism rubs, which may only turn forwards.
    pub forwards: Vec<usize>,
    /// Forces in the pins of its cranks at the angles that the file names.
    pub pin_forces: Vec<PinForces>,
    /// The same machine without its dampers, where it has some.
    pub without_dampers: Option<Box<Self>>,
    /// The coordinate whose steady cycle is wanted, and its turns.
    pub cycle: Option<(usize, u32)>,
    /// The coordinate whose starting time is wanted, and the speed that it reaches (rad/s or m/s).
    pub starting: Option<(usize, f64)>,
    /// Why a run of this length cannot be solved, where the train is too stiff for it; its modes can be found all the
    /// same.
    pub too_stiff: Option<Diagnostic>,
}

/// Whether a text holds coordinates and links, and not elements. A text that is not TOML holds neither.
pub fn is_train(text: &str) -> bool {
    let is_own = |name: &str| name == "coordinate" || name == "spur_pair";
    DeTable::parse(text).is_ok_and(|table| table.get_ref().iter().any(|(name, _)| is_own(name.get_ref())))
}

/// Reads a train from a file.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn read_train(path: &Path) -> Result<TrainFile, Diagnostic> {
    let (name, text) = text(path, "a machine file")?;
    parse_train(&name, &text)
}

/// Reads a train from a text for its modes, which need no `[run]`.
pub fn parse_train_for_modes(name: &str, text: &str) -> Result<TrainFile, Diagnostic> {
    parse(name, text, Asked::Modes)
}

/// What a file is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Run,
    /// The run without the dampers of its elements.
    Undamped,
    Modes,
}

/// Reads a train from a text; `name` is what messages call it.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn parse_train(name: &str, text: &str) -> Result<TrainFile, Diagnostic> {
    parse(name, text, Asked::Run)
}

fn parse(name: &str, text: &str, asked: Asked) -> Result<TrainFile, Diagnostic> {
    let source = Source { name, text };
    let parsed = document(source, "a train: `name`, [[coordinate]], [[link]] and [[torque]] tables, and [run]")?;
    let table: &DeTable<'_> = parsed.get_ref();
    let mut root = Table::root(source, table);
    let title = named(source, &mut root)?;
    let mut file = Reading::default();
    let (mut dampers, mut damper_places, mut friction_places) = (Vec::new(), Vec::new(), Vec::new());
    let (mut coordinates, mut links) = (Vec::new(), Vec::new());
    let (mut places, mut link_places) = (Vec::new(), Vec::new());
    // of elements, which become coordinates and links by their labels
    let (mut labels, mut element_places) = (Vec::new(), Vec::new());
    if root.has("element") {
        root.instead_of("element", &["coordinate", "spur_pair"])?;
        let machine = read::parse_for_run(name, text)?;
        let branched = machine.branches.iter().flat_map(|branch| &branch.elements);
        labels = machine.elements.iter().chain(branched).map(|part| part.label.clone()).collect();
        let mut tables = root.tables("element")?;
        for (_, mut branch) in root.tables_if("branch", "branch")? {
            tables.extend(branch.tables("element")?);
        }
        element_places = tables.into_iter().map(|(place, _)| place).collect();
        let referred = referred(&machine).map_err(|label| {
            let element = labels.iter().position(|one| *one == label);
            let place = element.and_then(|at| element_places.get(at)).cloned().unwrap_or(0..0);
            let expected = "a shaft, belt or rope beside it that carries its losses, or an efficiency of 1";
            Diagnostic::at(source, place, label, "no shaft before or behind it", expected)
        })?;
        for (place, _) in root.tables_if("damper", "damper")? {
            damper_places.push(place);
        }
        root.pass(&[
            "encoder",
            "control",
            "disturbance",
            "limits",
            "duty",
            "actuator",
            "speed_loop",
            "tolerance",
            "engine",
        ]);
        file.static_force = vec![None; referred.links.len()];
        (file.names, coordinates) = referred.coordinates.into_iter().unzip();
        file.ways = vec![None; file.names.len()];
        (file.links, links) = referred.links.into_iter().unzip();
        for (on, torque) in machine.engine.iter().flat_map(Engine::sources) {
            coordinates[on] = coordinates[on].clone().source(torque);
        }
        for (on, law) in machine.engine.iter().flat_map(Engine::laws) {
            coordinates[on] = coordinates[on].clone().inertia_law(law);
        }
        if asked != Asked::Undamped {
            dampers = machine.damper_parts(coordinates.len());
        }
    } else {
        let most = if asked == Asked::Modes { usize::MAX } else { COORDINATES };
        let tables = if root.has("spur_pair") { root.tables_if("coordinate", "")? } else { root.tables("coordinate")? };
        if let Some((place, _)) = tables.get(most) {
            let (found, expected) = (format!("{} coordinates", tables.len()), format!("at most {COORDINATES}"));
            return Err(Diagnostic::at(source, place.clone(), "coordinate", found, expected));
        }
        for (place, table) in tables {
            coordinates.push(file.coordinate(table)?);
            places.push(place);
        }
        for (place, table) in root.tables_if("spur_pair", "spur pair")? {
            let (own, held) = file.spur_pair(table)?;
            places.extend(std::iter::repeat_n(place.clone(), own.len()));
            link_places.extend(std::iter::repeat_n(place.clone(), held.len()));
            coordinates.extend(own);
            links.extend(held);
            if coordinates.len() > most {
                let (found, expected) =
                    (format!("{} coordinates", coordinates.len()), format!("at most {COORDINATES}"));
                return Err(Diagnostic::at(source, place, "spur_pair", found, expected));
            }
        }
    }
    let chained = links.len() - link_places.len();
    for (place, table) in root.tables_if("link", "link")? {
        links.push(file.link(table)?);
        link_places.push(place);
    }
    for (_, table) in root.tables_if("torque", "torque")? {
        let (on, torque) = file.torque(table)?;
        coordinates[on] = coordinates[on].clone().source(torque);
    }
    let loads = |at: usize| -> Vec<StrokeLoad> {
        file.loads.iter().filter(|(on, _)| *on == at).map(|(_, load)| *load).collect()
    };
    let of = |(at, crank, angle): &(usize, Crank, f64)| {
        PinForces::of(&file.names[*at], crank, [*angle, file.speeds[*at]], &loads(*at))
    };
    let pin_forces = file.pins_at.iter().map(of).collect();
    for (at, pins, _) in &file.pins {
        let loads = loads(*at);
        let coordinate = coordinates[*at].clone();
        coordinates[*at] = match pins {
            Joints::Crank(pins) => coordinate.pins(*pins, &loads),
            Joints::FourBar(bars, inertia, pins) => coordinate.four_bar_pins(*bars, *inertia, *pins, &loads),
        };
        // the friction on its guide may have named it already
        if coordinates[*at].has_loaded_pins() && !file.forwards.contains(at) {
            file.forwards.push(*at);
        }
    }
    if let Some(&at) = file.forwards.iter().find(|&&at| file.speeds.get(at).is_some_and(|speed| *speed < 0.0)) {
        let place = places.get(at).cloned().unwrap_or(0..0);
        let found = format!("{} of \"{}\", whose friction is that of forward motion", file.speeds[at], file.names[at]);
        let expected = "zero or above, or neither `friction` nor `pins`";
        return Err(Diagnostic::at(source, place, "speed", found, expected));
    }
    let mut train = Train::new();
    for coordinate in coordinates {
        train = train.coordinate(coordinate);
    }
    for link in links {
        train = train.link(link);
    }
    for (place, table) in root.tables_if("friction", "friction")? {
        train = train.friction(file.friction(table)?);
        friction_places.push(place);
    }
    // no other table can name them
    let is_damped = !dampers.is_empty();
    for (part, place) in dampers.into_iter().zip(damper_places) {
        train = train.coordinate(part.ring);
        if part.friction.is_some() {
            friction_places.push(place);
        }
        file.names.push(part.name.clone());
        if let Some(link) = part.link {
            train = train.link(link);
            file.links.push(part.name);
            file.static_force.push(None);
        }
        train = part.friction.into_iter().fold(train, Train::friction);
    }
    if let Some((friction, at)) = train.rubbing_crank() {
        let place = friction_places.get(friction).cloned().unwrap_or(0..0);
        let found =
            format!("dry friction against what moves on \"{}\", whose inertia changes with its angle", file.names[at]);
        let expected = "friction against the ground at rest, or on another mass, behind a shaft";
        return Err(Diagnostic::at(source, place, "", found, expected));
    }
    // a mass of several elements is called by all of them
    let element_of = |name: &str| {
        let element = labels.iter().position(|label| name.split(" + ").any(|one| one == label));
        element.and_then(|at| element_places.get(at)).cloned()
    };
    // what the solver refuses is told at the table that it is about
    let refused = |error: PlantError, otherwise: std::ops::Range<usize>| {
        let place = match &error {
            PlantError::Parameter { place, .. } | PlantError::TimesNotIncreasing { place, .. } => match place {
                Place::Node(j) => places.get(*j).cloned().or_else(|| element_of(file.names.get(*j)?)),
                Place::Shaft(l) => {
                    let own = l.checked_sub(chained).and_then(|own| link_places.get(own));
                    own.cloned().or_else(|| element_of(file.links.get(*l)?))
                }
                Place::Pins(j) => file.pins.iter().find(|(at, ..)| at == j).map(|(.., place)| place.clone()),
            },
            PlantError::Count { .. } => None,
        };
        let (found, expected) = said(&error);
        Diagnostic::at(source, place.unwrap_or(otherwise), "", found, expected)
    };
    let whole = places.first().cloned().unwrap_or(0..0);
    if let Some(mut start) = root.table_if("start")? {
        train = match start.text("kind", STARTS)? {
            "rest" => train,
            "slack" => train.slack(),
            "pretensioned" => {
                let held = file.named(&mut start, "held")?;
                train.pretensioned(held).map_err(|error| refused(error, whole.clone()))?
            }
            _ => return Err(start.wrong("kind", STARTS)),
        };
        start.finish()?;
    }
    let motion = train.clone().build().map_err(|error| refused(error, whole.clone()))?;
    let (running, excitations) = excitations(&mut root)?;
    let (time, step, cycle, starting) = if asked == Asked::Modes && !root.has("run") {
        (0.0, 0.0, None, None)
    } else {
        let mut run = root.table("run")?;
        let time = run.number("time", Quantity::TIME)?;
        let step = run.number("step", Quantity::TIME)?;
        if !(step <= time && time / step <= LINES) {
            return Err(run.wrong("step", "a time no longer than the run, and at least a millionth of it"));
        }
        // two numbers of a file that stand for a whole ratio differ from it by their roundings
        let lines = (time / step).round();
        if (time / step - lines).abs() > 1e-9 * lines {
            let near = time / lines;
            return Err(run.wrong("step", format!("a time that divides the run into whole steps, such as {near}")));
        }
        let turns = run.number_or("cycle_turns", Quantity::TURNS, 1.0)? as u32;
        let cycle = if run.has("cycle") { Some((file.named(&mut run, "cycle")?, turns)) } else { None };
        let starting = if run.has("starting") {
            let (at, speed) =
                (file.named(&mut run, "starting")?, run.number("starting_speed", Quantity::EITHER_SPEED)?);
            if speed == motion.speed(at) {
                return Err(run.wrong("starting_speed", "a speed other than that of the coordinate at the start"));
            }
            Some((at, speed))
        } else if run.number_if("starting_speed", Quantity::EITHER_SPEED)?.is_some() {
            return Err(run.wrong("starting_speed", "`starting`, the coordinate that must reach this speed"));
        } else {
            None
        };
        run.finish()?;
        (time, step, cycle, starting)
    };
    root.finish()?;
    let too_stiff = too_stiff(&motion, time).map(|(place, found, expected)| {
        let name = match place {
            Place::Node(j) | Place::Pins(j) => &file.names[j],
            Place::Shaft(l) => &file.links[l],
        };
        let own = match place {
            Place::Node(j) | Place::Pins(j) => places.get(j),
            Place::Shaft(l) => l.checked_sub(chained).and_then(|own| link_places.get(own)),
        };
        let span = element_of(name).or(own.cloned()).unwrap_or_else(|| whole.clone());
        Diagnostic::at(source, span, name.clone(), found, expected)
    });
    let without_dampers = if is_damped { Some(Box::new(parse(name, text, Asked::Undamped)?)) } else { None };
    let Reading { names, links, static_force, forwards, .. } = file;
    Ok(TrainFile {
        name: title,
        coordinates: names,
        links,
        turns: !labels.is_empty(),
        static_force,
        train,
        motion,
        time,
        step,
        forwards,
        pin_forces,
        without_dampers,
        cycle,
        starting,
        running,
        excitations,
        too_stiff,
    })
}

const STARTS: &str = "\"rest\", \"slack\" or \"pretensioned\"";

/// A refusal of the solver as what was found and what was expected.
fn said(error: &PlantError) -> (String, String) {
    match error {
        PlantError::Parameter { name, value, expected, .. } => (format!("{name} {value}"), (*expected).to_owned()),
        PlantError::Count { name, found, expected } => (format!("{name} {found}"), expected.to_string()),
        PlantError::TimesNotIncreasing { time, .. } => {
            (format!("the time {time} s"), "times that come one after the other".to_owned())
        }
    }
}
