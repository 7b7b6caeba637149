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
//! (`main`, `crank`, `wrist`)), or `[coordinate.four_bar]` with `crank`, `coupler`,
//! `rocker`, `ground`, (`coupler_mass`, `coupler_centre`, `coupler_inertia`, `rocker_inertia`,
//! `[coordinate.four_bar.pins]` with `coefficient` and (`main`, `crank`, `rocker`, `pivot`)), or
//! `[coordinate.toggle]` with the same and `link`, `direction`, `slider_mass`, or `[coordinate.cam]` with `lift`,
//! `mass`; each with (`friction`)), (`inertia_table`) |
//! | `[[spur_pair]]` | `name`, `mesh_stiffness`, (`mesh_damping`, `gap`), `[spur_pair.pinion]` and `[spur_pair.wheel]`
//! with `mass`, `inertia`, `base_radius`, `shaft_stiffness`, (`shaft_damping`), and two values each of `bearing_mass`,
//! `lever`, `stiffness_y`, `stiffness_x`, (`damping_y`, `damping_x`); a mesh as a link has it |
//! | `[[link]]` | `name`, `stiffness`, and `between` with (`ratio`), or `ground`, or `terms` as `[[share, ...]]` in
//! the order of `of`; (`damping`, `gap`, `rope`, `efficiency`, `back_efficiency`, `elongation`, `static`) |
//! | `[link.spur]` | `frequency` Hz, `contact_ratio`, `double`, `single` N/m, (`leaving` N/m, `error`, `next_error` m)
//! |
//! | `[link.teeth]` | as `spur`, by the angle of the coordinate `of` with `count` teeth, instead of the frequency |
//! | `[link.harmonics]` | `frequency` Hz, (`stiffness`, `error`) as rows of order, cosine, sine |
//! | `[[friction]]` | `on` or `between`, `torque`, (`breakaway`, `surface`) |
//! | `[[torque]]` | `on`, `kind` and its keys: `constant` `torque`; `line` `stall` `slope`; `parabola` `a` `b` `c`;
//! `kloss` `breakdown` `slip` `synchronous`; `shunt` and `series` `voltage` `resistance` `flux`; `combustion`
//! `combustion_type` `rated_torque` `rated_speed` `idle` `no_load`; `starting` `torque` `time` `power`; `steps` and
//! `table` `points`; `triangle`, `square`, `sawtooth up`, `sawtooth down`, `rectified` `height` `period` `terms`; `arc`
//! `torque` `from` `to` (`turns`); `stroke` `force` (`from` `to`); `orders` `harmonics` |
//! | `[start]` | `kind`: `rest`, `slack`, or `pretensioned` with `held` |
//! | `[run]` | `time` s, `step` s, a whole number of which is the time, (`cycle`, `cycle_turns`, `starting` with
//! `starting_speed`); `modes` does without it |

use std::f64::consts::{PI, TAU};
use std::path::Path;

use toml::de::DeTable;

use super::diagnostic::Diagnostic;
use super::element::signed_ratio;
use super::engine::Engine;
use super::excitation::{Excitation, Running, excitations};
use super::quantity::Quantity;
use super::read::{self, document, named, text};
use super::referred::referred;
use super::source::Source;
use super::table::Table;
use driveline_solver::plant::train::{
    Coordinate, Crank, FourBar, FourBarPins, Friction, Harmonic, Link, Motion, Orders, Pins, Source as Torque,
    SpurBearing, SpurPair, SpurWheel, StrokeLoad, Teeth, Toggle, Train, Variation, Waveform, rubbing,
};
use driveline_solver::plant::{LoadProgram, Place, PlantError};

/// Most lines that a run may have.
const LINES: f64 = 1e6;

/// Of a rod that is hardly longer than its crank.
const LONGER: &str = "more than the crank's radius by a thousandth of it: the slider's way has no series otherwise";

/// Most coordinates: their modes take time with the third power of their number.
const COORDINATES: usize = 200;

/// Product of the fastest rate of a train and the length of its run, at most: a minute's work for the second
/// integrator, whose roundings gather beyond it.
const STIFFEST: f64 = 1e6;

/// A train as its file describes it, ready to run.
#[derive(Debug, Clone)]
pub struct TrainFile {
    /// Its name.
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
    /// Its excitations.
    pub excitations: Vec<Excitation>,
    /// s.
    pub time: f64,
    /// s.
    pub step: f64,
    /// Coordinates whose mechanism rubs, which may only turn forwards.
    pub forwards: Vec<usize>,
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

impl TrainFile {
    /// The name as part of a file name: lower case, `-` for everything but letters and digits.
    pub fn slug(&self) -> String {
        let letter = |c: char| {
            if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }
        };
        self.name.chars().map(letter).collect()
    }
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
///
/// # Errors
/// As [`parse_train`].
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
        let machine = read::parse(name, text)?;
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
            let expected = "a shaft, belt or rope behind it that carries its losses, or an efficiency of 1";
            Diagnostic::at(source, place, label, "no shaft behind it", expected)
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
        let tables = if root.has("spur_pair") { root.tables_if("coordinate", "")? } else { root.tables("coordinate")? };
        if let Some((place, _)) = tables.get(COORDINATES) {
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
            if coordinates.len() > COORDINATES {
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
    for (at, pins, _) in &file.pins {
        let loads: Vec<StrokeLoad> = file.loads.iter().filter(|(on, _)| on == at).map(|(_, load)| *load).collect();
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
        without_dampers,
        cycle,
        starting,
        running,
        excitations,
        too_stiff,
    })
}

/// Where a train is too stiff for a run of so many seconds: the place, what was found and what was expected.
pub(crate) fn too_stiff(motion: &Motion, time: f64) -> Option<(Place, String, String)> {
    let over = motion.rate() * time / STIFFEST;
    if over <= 1.0 {
        return None;
    }
    let short = format!("a run of at most {:.1e} s", time / over);
    match motion.stiffest().filter(|part| 2.0 * part.rate >= motion.rate()) {
        Some(part) => {
            let (parameter, value, inertia) = (part.parameter, part.value, part.inertia);
            let share = if parameter == "stiffness" { over * over } else { over };
            Some((
                part.odd,
                format!("a {parameter} of {value:.1e} on an inertia of {inertia:.1e}, a rate of {:.1e} 1/s", part.rate),
                format!(
                    "a {parameter} of at most {:.1e}, an inertia of at least {:.1e}, or {short}",
                    value / share,
                    inertia * share
                ),
            ))
        }
        None => Some((Place::Node(0), format!("a train whose parts move at up to {:.1e} 1/s", motion.rate()), short)),
    }
}

const STARTS: &str = "\"rest\", \"slack\" or \"pretensioned\"";
const KINDS: &str = "\"constant\", \"line\", \"parabola\", \"kloss\", \"shunt\", \"series\", \
                     \"combustion\", \"starting\", \"steps\", \"table\", \"triangle\", \"square\", \
                     \"sawtooth up\", \"sawtooth down\", \"rectified\", \"arc\", \"stroke\" or \"orders\"";

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

/// The names read so far.
#[derive(Default)]
struct Reading {
    names: Vec<String>,
    /// Of each coordinate, its speed at the start; those of elements and of gear pairs rest.
    speeds: Vec<f64>,
    /// Of each coordinate, the way of the slider (m) or the angle of the rocker (rad) by its own angle.
    ways: Vec<Option<Orders>>,
    links: Vec<String>,
    static_force: Vec<Option<f64>>,
    /// Coordinates whose mechanism rubs.
    forwards: Vec<usize>,
    /// Coordinates whose mechanism has friction in its pins.
    pins: Vec<(usize, Joints, std::ops::Range<usize>)>,
    /// Forces on the slider of a coordinate's crank, or torques on the rocker of its four-bar.
    loads: Vec<(usize, StrokeLoad)>,
}

/// Pins with friction.
enum Joints {
    Crank(Pins),
    /// With the inertia of the rocker about its pivot, kg m2.
    FourBar(FourBar, f64, FourBarPins),
}

impl Reading {
    fn coordinate(&mut self, mut table: Table<'_>) -> Result<Coordinate, Diagnostic> {
        let name = fresh(&mut table, &self.names)?;
        let speed = table.number_or("speed", Quantity::ANY, 0.0)?;
        self.speeds.push(speed);
        let mut coordinate = Coordinate::new(table.number("inertia", Quantity::INERTIA_OR_MASS)?)
            .speed(speed)
            .angle(table.number_or("angle", Quantity::ANY, 0.0)?)
            .viscous(table.number_or("viscous", Quantity::DAMPER, 0.0)?);
        let (mut way, mut friction) = (None::<Orders>, 0.0);
        let mut law = Vec::new();
        let mechanisms = ["crank", "four_bar", "toggle", "cam"].into_iter().filter(|key| table.has(key));
        if let Some(second) = mechanisms.collect::<Vec<_>>().get(1) {
            return Err(table.wrong(second, "one of `crank`, `four_bar`, `toggle` and `cam`"));
        }
        if let Some(mut crank) = table.table_if("crank")? {
            let radius = crank.number("radius", Quantity::DIAMETER)?;
            let rod = crank.number("rod", Quantity::DIAMETER)?;
            if rod <= radius {
                return Err(crank.wrong("rod", "more than the crank's radius"));
            }
            let one = Quantity { most: 1.0, ..Quantity::SIZE };
            let drive = Crank {
                rod_mass: crank.number_or("rod_mass", Quantity::SIZE, 0.0)?,
                rod_inertia: crank.number_or("rod_inertia", Quantity::SIZE, 0.0)?,
                rod_centre: crank.number_or("rod_centre", one, 0.3)?,
                ..Crank::new(radius, rod, crank.number("slider_mass", Quantity::SIZE)?)
            };
            coordinate = coordinate.crank(drive);
            if let Some(mut pins) = crank.table_if("pins")? {
                let found = Pins {
                    coefficient: pins.number("coefficient", Quantity::FRICTION)?,
                    main: pins.number_or("main", Quantity::PIN, 0.0)?,
                    crank: pins.number_or("crank", Quantity::PIN, 0.0)?,
                    wrist: pins.number_or("wrist", Quantity::PIN, 0.0)?,
                };
                let place = pins.place();
                pins.finish()?;
                self.pins.push((self.names.len(), Joints::Crank(found), place));
            }
            friction = crank.number_or("friction", Quantity::SIZE, 0.0)?;
            if friction > 0.0 {
                // against the slider, which goes inwards first
                let on = |load, from, to| (self.names.len(), StrokeLoad { load, from, to });
                self.loads.extend([on(friction, 0.0, PI), on(-friction, PI, TAU)]);
            }
            let reach = move |angle: f64| (rod * rod - (radius * angle.sin()).powi(2)).sqrt();
            let slider = Orders::sampled(|angle| radius * angle.cos() + reach(angle));
            if slider.at(0.0).is_nan() {
                return Err(crank.wrong("rod", LONGER));
            }
            way = Some(slider);
            crank.finish()?;
        } else if let Some(mut four) = table.table_if("four_bar")? {
            let (bars, parts) = four_bar(&mut four)?;
            let rocker = Orders::sampled(|angle| bars.angles(angle)[1]);
            law = inertia(&four, "crank", &parts, &rocker)?;
            (way, friction) = (Some(rocker), four.number_or("friction", Quantity::SIZE, 0.0)?);
            if let Some(mut pins) = four.table_if("pins")? {
                let found = FourBarPins {
                    coefficient: pins.number("coefficient", Quantity::FRICTION)?,
                    main: pins.number_or("main", Quantity::PIN, 0.0)?,
                    crank: pins.number_or("crank", Quantity::PIN, 0.0)?,
                    rocker: pins.number_or("rocker", Quantity::PIN, 0.0)?,
                    pivot: pins.number_or("pivot", Quantity::PIN, 0.0)?,
                };
                let place = pins.place();
                pins.finish()?;
                let [.., (inertia, _)] = parts;
                self.pins.push((self.names.len(), Joints::FourBar(bars, inertia, found), place));
            }
            if friction > 0.0 {
                // against the rocker, which reverses at its dead centres
                let [stretched, folded] = bars.dead_centres();
                let against = -friction * bars.rates(0.5 * (stretched + folded))[1].signum();
                let on = |load, from, to| (self.names.len(), StrokeLoad { load, from, to });
                self.loads.extend([on(against, stretched, folded), on(-against, folded, stretched + TAU)]);
            }
            four.finish()?;
        } else if let Some(mut knee) = table.table_if("toggle")? {
            let (bars, parts) = four_bar(&mut knee)?;
            let link = knee.number("link", Quantity::DIAMETER)?;
            if link <= bars.rocker {
                return Err(knee.wrong("link", "more than the rocker"));
            }
            let direction = knee.number("direction", Quantity::DIRECTION)?;
            let toggle = Toggle { bars, link, direction };
            let slider = Orders::sampled(|angle| toggle.way(angle));
            let moved = (knee.number("slider_mass", Quantity::SIZE)?, slider.clone());
            let parts: Vec<(f64, Orders)> = parts.into_iter().chain([moved]).collect();
            law = inertia(&knee, "crank", &parts, &slider)?;
            (way, friction) = (Some(slider), knee.number_or("friction", Quantity::SIZE, 0.0)?);
            knee.finish()?;
        } else if let Some(mut cam) = table.table_if("cam")? {
            let follower = Orders::of(&even(&mut cam, "lift", Quantity::LIFT)?);
            let mass = cam.number("mass", Quantity::SIZE)?;
            law = inertia(&cam, "lift", &[(mass, follower.clone())], &follower)?;
            (way, friction) = (Some(follower), cam.number_or("friction", Quantity::SIZE, 0.0)?);
            cam.finish()?;
        }
        if let Some(way) = way.as_ref().filter(|_| friction > 0.0) {
            coordinate = rubbing(way, friction).into_iter().fold(coordinate, Coordinate::source);
            self.forwards.push(self.names.len());
        }
        if table.has("inertia_table") {
            law.extend(Orders::of(&even(&mut table, "inertia_table", Quantity::SIZE)?).0);
        }
        if !law.is_empty() {
            coordinate = coordinate.inertia_law(Orders(law));
        }
        table.finish()?;
        self.names.push(name);
        self.ways.push(way);
        Ok(coordinate)
    }

    /// The coordinate that a key names.
    fn named(&self, table: &mut Table<'_>, key: &'static str) -> Result<usize, Diagnostic> {
        let expected = self.known();
        let name = table.text(key, &expected)?;
        self.names.iter().position(|known| known == name).ok_or_else(|| table.wrong(key, expected))
    }

    fn known(&self) -> String {
        let quoted: Vec<String> = self.names.iter().map(|name| format!("\"{name}\"")).collect();
        format!("the name of a coordinate: {}", quoted.join(", "))
    }

    /// The two coordinates that `between` names.
    fn pair(&self, table: &mut Table<'_>) -> Result<(usize, usize), Diagnostic> {
        let expected = format!("two of them, as [\"{0}\", \"{0}\"]: {1}", "name", self.known());
        let texts = table.texts("between", 2, &expected)?;
        let place = |text: &str| self.names.iter().position(|known| known == text);
        match (place(texts[0]), place(texts[1])) {
            (Some(one), Some(other)) if one != other => Ok((one, other)),
            _ => Err(table.wrong("between", expected)),
        }
    }

    fn link(&mut self, mut table: Table<'_>) -> Result<Link, Diagnostic> {
        let name = fresh(&mut table, &self.links)?;
        let stiffness = table.number("stiffness", Quantity::SPRING)?;
        let mut link = if table.has("ground") {
            table.instead_of("ground", &["terms", "between", "ratio"])?;
            Link::ground(self.named(&mut table, "ground")?, stiffness)
        } else if table.has("terms") {
            table.instead_of("terms", &["between", "ratio"])?;
            let expected = format!("shares of the elongation, each under {}", self.known());
            let place = |text: &str| self.names.iter().position(|known| known == text);
            let terms = table.shares("terms", Quantity::ANY, &expected, place)?;
            Link::new(&terms, stiffness)
        } else {
            let (one, other) = self.pair(&mut table)?;
            let ratio = if table.has("ratio") { signed_ratio(&mut table)? } else { 1.0 };
            Link::geared(one, other, ratio, stiffness)
        };
        let efficiency = table.number_or("efficiency", Quantity::EFFICIENCY, 1.0)?;
        link = link
            .damping(table.number_or("damping", Quantity::DAMPER, 0.0)?)
            .gap(table.number_or("gap", Quantity::SIZE, 0.0)?)
            .efficiency(efficiency)
            .back_efficiency(table.number_or("back_efficiency", Quantity::BACK_EFFICIENCY, efficiency)?)
            .elongated(table.number_or("elongation", Quantity::ANY, 0.0)?);
        if table.flag_or("rope", false)? {
            link = link.rope();
        }
        if let Some(variation) = self.variation(&mut table)? {
            link = link.varying(variation);
        }
        let held = if table.has("static") { Some(table.number("static", Quantity::ANY)?) } else { None };
        table.finish()?;
        self.links.push(name);
        self.static_force.push(held);
        Ok(link)
    }

    /// How the stiffness of a mesh changes: `spur`, `teeth` or `harmonics`.
    fn variation(&self, table: &mut Table<'_>) -> Result<Option<Variation>, Diagnostic> {
        let given: Vec<_> = ["spur", "teeth", "harmonics"].into_iter().filter(|&key| table.has(key)).collect();
        if let [_, second, ..] = given[..] {
            return Err(table.wrong(second, "one of `spur`, `teeth` and `harmonics`"));
        }
        let mut found = None;
        if let Some(mut spur) = table.table_if("spur")? {
            let (contact, [double, leaving, single], errors) = pairs(&mut spur)?;
            let frequency = spur.number("frequency", Quantity::FREQUENCY)?;
            found = Some(Variation::pairs(contact, frequency, [double, leaving], single, errors));
            spur.finish()?;
        }
        if let Some(mut mesh) = table.table_if("teeth")? {
            let (contact_ratio, [double, leaving, single], errors) = pairs(&mut mesh)?;
            found = Some(Variation::Teeth(Teeth {
                coordinate: self.named(&mut mesh, "of")?,
                count: mesh.number("count", Quantity { whole: true, least: 1.0, ..Quantity::ORDER })?,
                contact_ratio,
                double,
                single,
                leaving,
                errors,
            }));
            mesh.finish()?;
        }
        if let Some(mut swing) = table.table_if("harmonics")? {
            let frequency = swing.number("frequency", Quantity::FREQUENCY)?;
            let stiffness = if swing.has("stiffness") { harmonics(&mut swing, "stiffness")? } else { Vec::new() };
            let error = if swing.has("error") { harmonics(&mut swing, "error")? } else { Vec::new() };
            found = Some(Variation::Harmonics { frequency, stiffness, error });
            swing.finish()?;
        }
        Ok(found)
    }

    /// A spur pair on shafts and bearings: its fourteen coordinates and thirteen links.
    fn spur_pair(&mut self, mut table: Table<'_>) -> Result<(Vec<Coordinate>, Vec<Link>), Diagnostic> {
        let name = fresh(&mut table, &self.links)?;
        let first = self.names.len();
        if let Some(taken) = self.names.iter().find(|other| {
            let own = |wheel: &str| other.strip_prefix(&format!("{name} {wheel}")).is_some();
            own("pinion") || own("wheel")
        }) {
            return Err(table.wrong("name", format!("a name that no coordinate has in its own: `{taken}`")));
        }
        for wheel in ["pinion", "wheel"] {
            let body = format!("{name} {wheel}");
            let bearings = [1, 2].map(|bearing| ["Y", "X"].map(|way| format!("{body} bearing {bearing} {way}")));
            self.names.extend([format!("{body} Y"), format!("{body} X"), body]);
            self.names.extend(bearings.into_iter().flatten());
        }
        self.ways.resize(self.names.len(), None);
        let [pinion, wheel] = ["pinion", "wheel"].map(|key| table.table(key).and_then(spur_wheel));
        let pair = SpurPair {
            pinion: pinion?,
            wheel: wheel?,
            mesh_stiffness: table.number("mesh_stiffness", Quantity::BEARING)?,
            mesh_damping: table.number_or("mesh_damping", Quantity::BEARING_DAMPING, 0.0)?,
            variation: self.variation(&mut table)?,
            gap: table.number_or("gap", Quantity::BORE, 0.0)?,
            torque: 0.0,
        };
        table.finish()?;
        self.links.push(name.clone());
        for wheel in ["pinion", "wheel"] {
            self.links.extend(["Y", "X"].map(|way| format!("{name} {wheel} shaft {way}")));
            let bearings =
                [1, 2].map(|bearing| ["Y", "X"].map(|way| format!("{name} {wheel} bearing {bearing} {way}")));
            self.links.extend(bearings.into_iter().flatten());
        }
        let (coordinates, links) = pair.parts(first);
        self.static_force.resize(self.static_force.len() + links.len(), None);
        Ok((coordinates, links))
    }

    fn friction(&self, mut table: Table<'_>) -> Result<Friction, Diagnostic> {
        let torque = table.number("torque", Quantity::SIZE)?;
        let friction = if table.has("between") {
            table.instead_of("between", &["on"])?;
            let (one, other) = self.pair(&mut table)?;
            Friction::between(one, other, torque)
        } else {
            Friction::ground(self.named(&mut table, "on")?, torque)
        };
        let breakaway = table.number_or("breakaway", Quantity::SIZE, torque)?;
        if breakaway < torque {
            return Err(table.wrong("breakaway", "at least the torque that slides"));
        }
        let surface = table.number_or("surface", Quantity::ANY, 0.0)?;
        table.finish()?;
        Ok(friction.breakaway(breakaway).surface(surface))
    }

    fn torque(&mut self, mut table: Table<'_>) -> Result<(usize, Torque), Diagnostic> {
        let on = self.named(&mut table, "on")?;
        let kind = table.text("kind", KINDS)?;
        let any = |table: &mut Table<'_>, key| table.number(key, Quantity::ANY);
        let torque = match kind {
            "constant" => Torque::Constant(any(&mut table, "torque")?),
            "line" => Torque::Line { stall: any(&mut table, "stall")?, slope: any(&mut table, "slope")? },
            "parabola" => Torque::Parabola(any(&mut table, "a")?, any(&mut table, "b")?, any(&mut table, "c")?),
            "kloss" => Torque::Kloss {
                breakdown: any(&mut table, "breakdown")?,
                slip: table.number("slip", Quantity::RATIO)?,
                synchronous: table.number("synchronous", Quantity::SPEED)?,
            },
            "shunt" | "series" => {
                let voltage = any(&mut table, "voltage")?;
                let resistance = table.number("resistance", Quantity::RESISTANCE)?;
                let flux = table.number("flux", Quantity::FLUX)?;
                if kind == "series" {
                    let (pole, start) = (-resistance / flux, self.speeds.get(on).copied().unwrap_or(0.0));
                    if start <= pole {
                        return Err(table.wrong(
                            "on",
                            format!(
                                "a coordinate that starts above {pole} rad/s, -resistance/flux, where the current has \
                                 no bound; this one starts at {start} rad/s"
                            ),
                        ));
                    }
                    Torque::Series { voltage, resistance, flux }
                } else {
                    Torque::Line { stall: flux * voltage / resistance, slope: flux * flux / resistance }
                }
            }
            "combustion" => combustion(&mut table)?,
            "starting" => Torque::Starting {
                torque: any(&mut table, "torque")?,
                time: table.number("time", Quantity::TIME)?,
                power: table.number("power", Quantity { least: 1.0, most: 2.0, whole: true, ..Quantity::RATIO })? as u8,
            },
            "steps" | "table" => {
                let rows = table.rows("points", 2, "rows of [time in s, torque], one after the other in time")?;
                let points: Vec<(f64, f64)> = rows.iter().map(|row| (row[0], row[1])).collect();
                if points.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
                    return Err(table.wrong("points", "times that come one after the other"));
                }
                Torque::Program(if kind == "steps" { LoadProgram::steps(&points) } else { LoadProgram::table(&points) })
            }
            "triangle" | "square" | "sawtooth up" | "sawtooth down" | "rectified" => {
                let height = any(&mut table, "height")?;
                let period = table.number("period", Quantity::TIME)?;
                let terms = table.number("terms", Quantity::TERMS)? as usize;
                Torque::Waveform(match kind {
                    "triangle" => Waveform::triangle(height, period, terms),
                    "square" => Waveform::square(height, period, terms),
                    "sawtooth up" => Waveform::sawtooth_up(height, period, terms),
                    "sawtooth down" => Waveform::sawtooth_down(height, period, terms),
                    _ => Waveform::rectified(height, period, terms),
                })
            }
            "arc" => {
                let torque = any(&mut table, "torque")?;
                let turns = table.number_or("turns", Quantity::TURNS, 1.0)? as u32;
                let turn = Quantity { most: TAU * f64::from(turns), ..Quantity::SIZE };
                let (from, to) = (table.number("from", turn)?, arc_end(&mut table, turn)?);
                if turns == 1 && to > from {
                    Torque::Arc { torque, from, to }
                } else {
                    let constant = Harmonic { order: 0.0, cosine: torque, sine: 0.0 };
                    let to = if to > from { to } else { to + turn.most };
                    Torque::Stroke { torque: Orders(vec![constant]), from, to, turns }
                }
            }
            "stroke" => {
                let force = any(&mut table, "force")?;
                let Some(way) = &self.ways[on] else {
                    return Err(table.wrong("on", "a coordinate with a `crank`, a `four_bar`, a `toggle` or a `cam`"));
                };
                let torque = way.slope().times(force);
                let mut acts = StrokeLoad { load: force, from: 0.0, to: TAU };
                let torque = if table.has("from") || table.has("to") {
                    let turn = Quantity { most: TAU, ..Quantity::SIZE };
                    let (from, to) = (table.number("from", turn)?, arc_end(&mut table, turn)?);
                    let to = if to > from { to } else { to + TAU };
                    (acts.from, acts.to) = (from, to);
                    Torque::Stroke { torque, from, to, turns: 1 }
                } else {
                    Torque::Orders(torque.0)
                };
                self.loads.push((on, acts));
                torque
            }
            "orders" => Torque::Orders(harmonics(&mut table, "harmonics")?),
            _ => return Err(table.wrong("kind", KINDS)),
        };
        table.finish()?;
        Ok((on, torque))
    }
}

const ENGINES: &str = "\"spark\", \"indirect injection\" or \"direct injection\"";

/// An engine at full load from idle to rated speed, and its governor from there to no load.
fn combustion(table: &mut Table<'_>) -> Result<Torque, Diagnostic> {
    // Leiderman's polynomial with the coefficients of Jazar, Vehicle Dynamics, ch. 4
    let [a, b, c] = match table.text("combustion_type", ENGINES)? {
        "spark" => [1.0, 1.0, 1.0],
        "indirect injection" => [0.6, 1.4, 1.0],
        "direct injection" => [0.87, 1.13, 1.0],
        _ => return Err(table.wrong("combustion_type", ENGINES)),
    };
    let torque = table.number("rated_torque", Quantity::TORQUE)?;
    let rated = table.number("rated_speed", Quantity::SPEED)?;
    let idle = table.number("idle", Quantity::SPEED)?;
    if idle >= rated {
        return Err(table.wrong("idle", "a speed below `rated_speed`"));
    }
    let no_load = table.number("no_load", Quantity::SPEED)?;
    if no_load <= rated {
        return Err(table.wrong("no_load", "a speed above `rated_speed`"));
    }
    let full = [torque * a, torque * b / rated, -torque * c / (rated * rated)];
    let slope = torque / (no_load - rated);
    let governed = [slope * no_load, -slope, 0.0];
    Ok(Torque::Pieces { ends: vec![idle, rated, no_load], torques: vec![full, governed] })
}

/// Where an arc ends, which is not where it begins; before it where it passes the angle zero.
fn arc_end(table: &mut Table<'_>, turn: Quantity) -> Result<f64, Diagnostic> {
    let (from, to) = (table.number("from", turn)?, table.number("to", turn)?);
    let differs = to != from && (to - from).abs() != turn.most;
    if differs { Ok(to) } else { Err(table.wrong("to", "another angle than `from`")) }
}

/// Values at even angles of a turn, the first at zero.
fn even(table: &mut Table<'_>, key: &'static str, quantity: Quantity) -> Result<Vec<f64>, Diagnostic> {
    let values = table.numbers(key, quantity)?;
    if values.len() < 3 || values.len() % 2 == 0 || values.len() > 1001 {
        return Err(table.wrong(key, "an odd number of values at even angles of a turn, 3 to 1001"));
    }
    Ok(values)
}

/// Contact ratio of a mesh; stiffness of both pairs, of the one that leaves, and of one pair alone; errors of one pair
/// and the next.
fn pairs(table: &mut Table<'_>) -> Result<(f64, [f64; 3], [f64; 2]), Diagnostic> {
    let contact = table.number("contact_ratio", Quantity { least: 1.0, most: 2.0, ..Quantity::RATIO })?;
    if contact <= 1.0 || contact >= 2.0 {
        return Err(table.wrong("contact_ratio", "a number between 1 and 2"));
    }
    let (double, single) = (table.number("double", Quantity::SPRING)?, table.number("single", Quantity::SPRING)?);
    let leaving = table.number_or("leaving", Quantity::SPRING, 0.5 * double)?;
    if leaving > double {
        return Err(table.wrong("leaving", "at most `double`, the stiffness of both pairs"));
    }
    let errors = [table.number_or("error", Quantity::ANY, 0.0)?, table.number_or("next_error", Quantity::ANY, 0.0)?];
    Ok((contact, [double, leaving, single], errors))
}

/// A wheel of a spur pair with its shaft and its bearings.
fn spur_wheel(mut table: Table<'_>) -> Result<SpurWheel, Diagnostic> {
    let two = |table: &mut Table<'_>, key: &'static str, quantity: Quantity| {
        let values = table.numbers(key, quantity)?;
        <[f64; 2]>::try_from(values).map_err(|_| table.wrong(key, "two numbers, one for each bearing"))
    };
    let two_or = |table: &mut Table<'_>, key: &'static str| {
        if table.has(key) { two(table, key, Quantity::BEARING_DAMPING) } else { Ok([0.0; 2]) }
    };
    let (masses, levers) =
        (two(&mut table, "bearing_mass", Quantity::MASS)?, two(&mut table, "lever", Quantity::LENGTH)?);
    let stiffness =
        [two(&mut table, "stiffness_y", Quantity::BEARING)?, two(&mut table, "stiffness_x", Quantity::BEARING)?];
    let damping = [two_or(&mut table, "damping_y")?, two_or(&mut table, "damping_x")?];
    let wheel = SpurWheel {
        mass: table.number("mass", Quantity::MASS)?,
        inertia: table.number("inertia", Quantity::INERTIA)?,
        base_radius: table.number("base_radius", Quantity::DIAMETER)?,
        shaft_stiffness: table.number("shaft_stiffness", Quantity::BEARING)?,
        shaft_damping: table.number_or("shaft_damping", Quantity::BEARING_DAMPING, 0.0)?,
        bearings: [0, 1].map(|bearing| SpurBearing {
            mass: masses[bearing],
            lever: levers[bearing],
            stiffness: stiffness.map(|both| both[bearing]),
            damping: damping.map(|both| both[bearing]),
        }),
    };
    table.finish()?;
    Ok(wheel)
}

/// The bars of a four-bar, and what moves with them: masses (kg) on ways (m), inertias (kg m2) on angles (rad).
fn four_bar(table: &mut Table<'_>) -> Result<(FourBar, [(f64, Orders); 4]), Diagnostic> {
    let bars = FourBar {
        crank: table.number("crank", Quantity::DIAMETER)?,
        coupler: table.number("coupler", Quantity::DIAMETER)?,
        rocker: table.number("rocker", Quantity::DIAMETER)?,
        ground: table.number("ground", Quantity::DIAMETER)?,
    };
    if !bars.is_crank_rocker() {
        let expected = "the shortest bar, which with the longest one is shorter than the other two together";
        return Err(table.wrong("crank", expected));
    }
    let mass = table.number_or("coupler_mass", Quantity::SIZE, 0.0)?;
    let centre = bars.coupler * table.number_or("coupler_centre", Quantity { most: 1.0, ..Quantity::SIZE }, 0.5)?;
    let coupler_inertia = table.number_or("coupler_inertia", Quantity::SIZE, 0.0)?;
    let rocker_inertia = table.number_or("rocker_inertia", Quantity::SIZE, 0.0)?;
    let [coupler, rocker] = [0, 1].map(|bar| Orders::sampled(|angle| bars.angles(angle)[bar]));
    let x = Orders::sampled(|angle| bars.crank * angle.cos() + centre * bars.angles(angle)[0].cos());
    let y = Orders::sampled(|angle| bars.crank * angle.sin() + centre * bars.angles(angle)[0].sin());
    Ok((bars, [(mass, x), (mass, y), (coupler_inertia, coupler), (rocker_inertia, rocker)]))
}

/// The inertia (kg m2) of a mechanism by the angle of its crank.
fn inertia(table: &Table<'_>, key: &str, parts: &[(f64, Orders)], way: &Orders) -> Result<Vec<Harmonic>, Diagnostic> {
    let moved: Vec<(f64, &Orders)> = parts.iter().map(|(mass, way)| (*mass, way)).collect();
    let inertia = Orders::inertia(&moved);
    if [way, &inertia].into_iter().flat_map(|orders| &orders.0).any(|harmonic| harmonic.cosine.is_nan()) {
        let expected = "bars that are not so near to lying in one line: their motion has more than 2,000 orders";
        return Err(table.wrong(key, expected));
    }
    Ok(inertia.0)
}

fn harmonics(table: &mut Table<'_>, key: &'static str) -> Result<Vec<Harmonic>, Diagnostic> {
    let rows = table.rows(key, 3, "rows of [order, cosine, sine]")?;
    Ok(rows.iter().map(|row| Harmonic { order: row[0], cosine: row[1], sine: row[2] }).collect())
}

/// A name that no table before it has.
fn fresh(table: &mut Table<'_>, taken: &[String]) -> Result<String, Diagnostic> {
    const NAME: &str = "a name of 1 to 24 printable characters that no other has";
    let name = table.text("name", NAME)?;
    let printable = !name.trim().is_empty() && name.chars().count() <= 24 && !name.chars().any(char::is_control);
    if printable && !taken.iter().any(|other| other == name) {
        Ok(name.to_owned())
    } else {
        Err(table.wrong("name", NAME))
    }
}
