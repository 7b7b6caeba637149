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
//! `slider_mass`, (`rod_mass`, `rod_inertia`, `rod_centre`), or `[coordinate.four_bar]` with `crank`, `coupler`,
//! `rocker`, `ground`, (`coupler_mass`, `coupler_centre`, `coupler_inertia`, `rocker_inertia`)), (`inertia_table`) |
//! | `[[link]]` | `name`, `stiffness`, and `between` with (`ratio`), or `ground`, or `terms` as `[[share, ...]]` in
//! the order of `of`; (`damping`, `gap`, `rope`, `efficiency`, `back_efficiency`, `elongation`, `static`) |
//! | `[link.spur]` | `frequency` Hz, `contact_ratio`, `double`, `single` N/m, (`error` m) |
//! | `[link.teeth]` | as `spur`, by the angle of the coordinate `of` with `count` teeth, instead of the frequency |
//! | `[link.harmonics]` | `frequency` Hz, (`stiffness`, `error`) as rows of order, cosine, sine |
//! | `[[friction]]` | `on` or `between`, `torque`, (`breakaway`, `surface`) |
//! | `[[torque]]` | `on`, `kind` and its keys: `constant` `torque`; `line` `stall` `slope`; `parabola` `a` `b` `c`;
//! `kloss` `breakdown` `slip` `synchronous`; `starting` `torque` `time` `power`; `steps` and `table` `points`;
//! `triangle`, `square`, `sawtooth up`, `sawtooth down`, `rectified` `height` `period` `terms`; `arc` `torque` `from`
//! `to` (`turns`); `stroke` `force` (`from` `to`); `orders` `harmonics` |
//! | `[start]` | `kind`: `rest`, `slack`, or `pretensioned` with `held` |
//! | `[run]` | `time` s, `step` s, a whole number of which is the time, (`cycle`, `cycle_turns`); `modes` does without
//! it |

use std::f64::consts::TAU;
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
use driveline_solver::plant::train::{
    Coordinate, Crank, FourBar, Friction, Harmonic, Link, Motion, Orders, Source as Torque, Train, Variation,
};
use driveline_solver::plant::train::{Teeth, Waveform};
use driveline_solver::plant::{LoadProgram, Place, PlantError};

/// Most lines that a run may have.
const LINES: f64 = 1e6;

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
    /// The coordinate whose steady cycle is wanted, and its turns.
    pub cycle: Option<(usize, u32)>,
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
    DeTable::parse(text).is_ok_and(|table| table.get_ref().iter().any(|(name, _)| name.get_ref() == "coordinate"))
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
    let mut file = Reading { names: Vec::new(), ways: Vec::new(), links: Vec::new(), static_force: Vec::new() };
    let (mut coordinates, mut links) = (Vec::new(), Vec::new());
    let (mut places, mut link_places) = (Vec::new(), Vec::new());
    // of elements, which become coordinates and links by their labels
    let (mut labels, mut element_places) = (Vec::new(), Vec::new());
    if root.has("element") {
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
            "damper",
        ]);
        file.static_force = vec![None; referred.links.len()];
        (file.names, coordinates) = referred.coordinates.into_iter().unzip();
        file.ways = vec![None; file.names.len()];
        (file.links, links) = referred.links.into_iter().unzip();
        for (on, torque) in machine.engine.iter().flat_map(Engine::sources) {
            coordinates[on] = coordinates[on].clone().source(torque);
        }
    } else {
        let tables = root.tables("coordinate")?;
        if let Some((place, _)) = tables.get(COORDINATES) {
            let (found, expected) = (format!("{} coordinates", tables.len()), format!("at most {COORDINATES}"));
            return Err(Diagnostic::at(source, place.clone(), "coordinate", found, expected));
        }
        for (place, table) in tables {
            coordinates.push(file.coordinate(table)?);
            places.push(place);
        }
    }
    let chained = links.len();
    for (place, table) in root.tables_if("link", "link")? {
        links.push(file.link(table)?);
        link_places.push(place);
    }
    for (_, table) in root.tables_if("torque", "torque")? {
        let (on, torque) = file.torque(table)?;
        coordinates[on] = coordinates[on].clone().source(torque);
    }
    let mut train = Train::new();
    for coordinate in coordinates {
        train = train.coordinate(coordinate);
    }
    for link in links {
        train = train.link(link);
    }
    for (_, table) in root.tables_if("friction", "friction")? {
        train = train.friction(file.friction(table)?);
    }
    // what the solver refuses is told at the table that it is about
    let refused = |error: PlantError, otherwise: std::ops::Range<usize>| {
        let place = match &error {
            PlantError::Parameter { place, .. } | PlantError::TimesNotIncreasing { place, .. } => match place {
                Place::Node(j) => places.get(*j).cloned(),
                Place::Shaft(l) => l.checked_sub(chained).and_then(|own| link_places.get(own)).cloned(),
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
    let (running, excitations) = excitations(&mut root)?;
    let (time, step, cycle) = if asked == Asked::Modes && !root.has("run") {
        (0.0, 0.0, None)
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
        run.finish()?;
        (time, step, cycle)
    };
    root.finish()?;
    let motion = train.clone().build().map_err(|error| refused(error, whole.clone()))?;
    let too_stiff = too_stiff(&motion, time).map(|(place, found, expected)| {
        let name = match place {
            Place::Node(j) => &file.names[j],
            Place::Shaft(l) => &file.links[l],
        };
        // a mass of several elements is called by all of them
        let element = labels.iter().position(|label| name.split(" + ").any(|one| one == label));
        let span = element.and_then(|at| element_places.get(at)).or(match place {
            Place::Node(j) => places.get(j),
            Place::Shaft(l) => l.checked_sub(chained).and_then(|own| link_places.get(own)),
        });
        Diagnostic::at(source, span.unwrap_or(&whole).clone(), name.clone(), found, expected)
    });
    let Reading { names, links, static_force, .. } = file;
    Ok(TrainFile {
        name: title,
        coordinates: names,
        links,
        static_force,
        train,
        motion,
        time,
        step,
        cycle,
        running,
        excitations,
        too_stiff,
    })
}

/// Where a train is too stiff for a run of so many seconds: the place, what was found and what was expected.
fn too_stiff(motion: &Motion, time: f64) -> Option<(Place, String, String)> {
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
const KINDS: &str = "\"constant\", \"line\", \"parabola\", \"kloss\", \"starting\", \"steps\", \"table\", \
                     \"triangle\", \
                     \"square\", \"sawtooth up\", \"sawtooth down\", \"rectified\", \"arc\", \"stroke\" or \"orders\"";

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
struct Reading {
    names: Vec<String>,
    /// Of each coordinate, the way of the slider (m) or the angle of the rocker (rad) by its own angle.
    ways: Vec<Option<Orders>>,
    links: Vec<String>,
    static_force: Vec<Option<f64>>,
}

impl Reading {
    fn coordinate(&mut self, mut table: Table<'_>) -> Result<Coordinate, Diagnostic> {
        let name = fresh(&mut table, &self.names)?;
        let mut coordinate = Coordinate::new(table.number("inertia", Quantity::INERTIA_OR_MASS)?)
            .speed(table.number_or("speed", Quantity::ANY, 0.0)?)
            .angle(table.number_or("angle", Quantity::ANY, 0.0)?)
            .viscous(table.number_or("viscous", Quantity::DAMPER, 0.0)?);
        let mut way = None;
        let mut law = Vec::new();
        if table.has("crank") && table.has("four_bar") {
            return Err(table.wrong("four_bar", "one of `crank` and `four_bar`"));
        }
        if let Some(mut crank) = table.table_if("crank")? {
            let radius = crank.number("radius", Quantity::DIAMETER)?;
            let rod = crank.number("rod", Quantity::DIAMETER)?;
            if rod <= radius {
                return Err(crank.wrong("rod", "more than the crank's radius"));
            }
            let one = Quantity { most: 1.0, ..Quantity::SIZE };
            coordinate = coordinate.crank(Crank {
                rod_mass: crank.number_or("rod_mass", Quantity::SIZE, 0.0)?,
                rod_inertia: crank.number_or("rod_inertia", Quantity::SIZE, 0.0)?,
                rod_centre: crank.number_or("rod_centre", one, 0.3)?,
                ..Crank::new(radius, rod, crank.number("slider_mass", Quantity::SIZE)?)
            });
            crank.finish()?;
            let reach = move |angle: f64| (rod * rod - (radius * angle.sin()).powi(2)).sqrt();
            way = Some(Orders::sampled(|angle| radius * angle.cos() + reach(angle)));
        } else if let Some(bars) = table.table_if("four_bar")? {
            let (inertia, rocker) = four_bar(bars)?;
            (law, way) = (inertia.0, Some(rocker));
        }
        if table.has("inertia_table") {
            let values = table.numbers("inertia_table", Quantity::SIZE)?;
            if values.len() < 3 || values.len() % 2 == 0 || values.len() > 1001 {
                return Err(table.wrong("inertia_table", "an odd number of values at even angles of a turn, 3 to 1001"));
            }
            law.extend(Orders::of(&values).0);
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
            Link::ground(self.named(&mut table, "ground")?, stiffness)
        } else if table.has("terms") {
            let expected = format!("shares of the elongation, each under {}", self.known());
            let place = |text: &str| self.names.iter().position(|known| known == text);
            let terms = table.shares("terms", Quantity::ANY, &expected, place)?;
            Link::new(&terms, stiffness)
        } else {
            let (one, other) = self.pair(&mut table)?;
            let ratio = table.number_or("ratio", Quantity::ANY, 1.0)?;
            if !Quantity::RATIO.allows(ratio.abs()) {
                let expected = "a number, 1e-6 to 1e6, negative where the two turn against each other";
                return Err(table.wrong("ratio", expected));
            }
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
        if let Some(mut spur) = table.table_if("spur")? {
            let ratio = Quantity { least: 1.0, most: 2.0, ..Quantity::RATIO };
            let contact = spur.number("contact_ratio", ratio)?;
            if contact <= 1.0 || contact >= 2.0 {
                return Err(spur.wrong("contact_ratio", "a number between 1 and 2"));
            }
            let frequency = spur.number("frequency", Quantity::FREQUENCY)?;
            let (double, single) = (spur.number("double", Quantity::SPRING)?, spur.number("single", Quantity::SPRING)?);
            let error = spur.number_or("error", Quantity::ANY, 0.0)?;
            link = link.varying(Variation::spur(contact, frequency, double, single, error));
            spur.finish()?;
        }
        if let Some(mut mesh) = table.table_if("teeth")? {
            let ratio = mesh.number("contact_ratio", Quantity { least: 1.0, most: 2.0, ..Quantity::RATIO })?;
            if ratio <= 1.0 || ratio >= 2.0 {
                return Err(mesh.wrong("contact_ratio", "a number between 1 and 2"));
            }
            link = link.varying(Variation::Teeth(Teeth {
                coordinate: self.named(&mut mesh, "of")?,
                count: mesh.number("count", Quantity { whole: true, least: 1.0, ..Quantity::ORDER })?,
                contact_ratio: ratio,
                double: mesh.number("double", Quantity::SPRING)?,
                single: mesh.number("single", Quantity::SPRING)?,
                error: mesh.number_or("error", Quantity::ANY, 0.0)?,
            }));
            mesh.finish()?;
        }
        if let Some(mut swing) = table.table_if("harmonics")? {
            let frequency = swing.number("frequency", Quantity::FREQUENCY)?;
            let stiffness = if swing.has("stiffness") { harmonics(&mut swing, "stiffness")? } else { Vec::new() };
            let error = if swing.has("error") { harmonics(&mut swing, "error")? } else { Vec::new() };
            link = link.varying(Variation::Harmonics { frequency, stiffness, error });
            swing.finish()?;
        }
        let held = if table.has("static") { Some(table.number("static", Quantity::ANY)?) } else { None };
        table.finish()?;
        self.links.push(name);
        self.static_force.push(held);
        Ok(link)
    }

    fn friction(&self, mut table: Table<'_>) -> Result<Friction, Diagnostic> {
        let torque = table.number("torque", Quantity::SIZE)?;
        let friction = if table.has("between") {
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

    fn torque(&self, mut table: Table<'_>) -> Result<(usize, Torque), Diagnostic> {
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
                let (from, to) = (table.number("from", turn)?, table.number("to", turn)?);
                if turns == 1 {
                    Torque::Arc { torque, from, to }
                } else {
                    let constant = Harmonic { order: 0.0, cosine: torque, sine: 0.0 };
                    Torque::Stroke { torque: Orders(vec![constant]), from, to, turns }
                }
            }
            "stroke" => {
                let force = any(&mut table, "force")?;
                let Some(way) = &self.ways[on] else {
                    return Err(table.wrong("on", "a coordinate with a `crank` or a `four_bar`"));
                };
                let torque = way.slope().times(force);
                if table.has("from") || table.has("to") {
                    let turn = Quantity { most: TAU, ..Quantity::SIZE };
                    let (from, to) = (table.number("from", turn)?, table.number("to", turn)?);
                    if to <= from {
                        return Err(table.wrong("to", "an angle beyond `from`: a stroke does not pass angle 0"));
                    }
                    Torque::Stroke { torque, from, to, turns: 1 }
                } else {
                    Torque::Orders(torque.0)
                }
            }
            "orders" => Torque::Orders(harmonics(&mut table, "harmonics")?),
            _ => return Err(table.wrong("kind", KINDS)),
        };
        table.finish()?;
        Ok((on, torque))
    }
}

/// The inertia (kg m2) of a four-bar by the angle of its crank, and the angle (rad) of its rocker.
fn four_bar(mut table: Table<'_>) -> Result<(Orders, Orders), Diagnostic> {
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
    let moved = [(mass, &x), (mass, &y), (coupler_inertia, &coupler), (rocker_inertia, &rocker)];
    let inertia = Orders::inertia(&moved);
    if [&rocker, &inertia].into_iter().flat_map(|orders| &orders.0).any(|harmonic| harmonic.cosine.is_nan()) {
        let expected = "bars that are not so near to lying in one line: their motion has more than 2,000 orders";
        return Err(table.wrong("crank", expected));
    }
    table.finish()?;
    Ok((inertia, rocker))
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
