//! Readings of a balancing that an engineer typed in: a TOML file, read with every fault placed.
//!
//! ```toml
//! name = "fan"
//! unit = "mm/s"                                  # of the readings, as they are shown
//! planes = ["drive end", "free end"]
//! sensors = ["bearing A", "bearing B"]           # one for each reading of a run
//!
//! [baseline]
//! rpm = 1480                                     # or one for each reading
//! readings = [[7.2, 238], [13.5, 296]]           # amplitude, phase in degrees
//!
//! [[trial]]
//! plane = "drive end"
//! weight = [2.5, 0]                              # amount, angle in degrees
//! rpm = 1480
//! readings = [[4.9, 114], [9.2, 347]]
//! ```
//!
//! | key | what (all may be left out) |
//! |---|---|
//! | `weight_unit` | `"g"` (as without it), `"kg"`, `"g mm"`, `"kg m"`, `"oz"`, `"oz in"` or `"lb"` |
//! | `angle_unit` | `"degrees"` (as without it, but phases that look like radians are then refused) or `"radians"` |
//! | `phase_sense` | `"lead"` (as without it) or `"lag"`: the sense in which phases of readings are counted |
//! | `weight_sense` | `"with rotation"` (as without it) or `"against rotation"`: the sense in which angles of weights are counted |
//! | `[run_out]` | `readings` of a slow roll, which are taken off every other reading |
//! | `[[split]]` | `plane`, two `angles` that its weight is split between |
//! | `trials` | `"removed"` before the next run (as without it), or `"stay"` |
//! | `aim` | `"least squares"` (as without it) or `"min-max"` |
//! | `good` | the largest residual that is good enough |
//! | `independence` | the least share of a plane's effect that must be its own, 0.01 |
//! | `weighting` | a number for each reading, zero for one that is left out |
//! | `limits` | the largest weight of each plane, above zero, or `"none"` |
//! | `rpm` of a run | may be left out: all runs are then of one speed |
//! | `[[correction]]` | `weights` that were put on, an amount and an angle for each plane, then `rpm` and `readings` with them |
//! | `[[influence]]` | `plane` and `coefficients`, an amplitude and phase for each reading, instead of a trial run |
//! | `[[holes]]` | `plane`, `angles` or `count` (and `first`), `weights` to choose from, `removing = true` for drilling |
//! | `[rotor]` | `mass` (kg), `rpm` in service, `grade` (mm/s), `radius` (m) of the weights |
//! | `span`, `centre`, `planes_at` of `[rotor]` | along the rotor from bearing A (m): bearing B, the centre of mass, each plane; the grade is then split between the bearings |
//! | `width`, `diameter` of `[rotor]` | its width and diameter (m), which say whether one plane is enough |
//! | `machine` | `"hard-bearing"`: forces (N) in bearings A and B of a balancing machine, whose planes are separated by their places in `[rotor]` |
//! | `[amplitudes]` | of one plane, instead of `[baseline]`, without phases: `baseline`, `weight`, `runs` of an angle and an amplitude |
//!
//! A plane may have several `[[trial]]`: all of them count, by least squares. Where trial weights stay, `weight` is
//! what each run has more than the one before it.

use std::path::Path;

use driveline::balancing::{
    Aim, CORRECTIONS, Complex, CorrectionMethod, Entry, Error, FromAmplitudes, Influence, Objective, Plan, Procedure,
    Run, from_amplitudes, one_plane_suffices, two_planes,
};

use crate::machine_file::read::document;
use crate::machine_file::{Diagnostic, Item, Quantity, Source, Table, text};

/// Keys of the file that go with readings with phases.
const OF_PHASES: [&str; 13] = [
    "baseline",
    "sensors",
    "trial",
    "machine",
    "influence",
    "correction",
    "trials",
    "aim",
    "good",
    "independence",
    "weighting",
    "limits",
    "run_out",
];

/// Most readings of a run.
pub const ROWS: usize = 24;
/// Most planes.
pub const PLANES: usize = 8;
/// Most trial runs.
pub const TRIALS: usize = 32;

/// The procedure of a file.
pub type Field = Procedure<f64, ROWS, PLANES, TRIALS>;

/// A balancing as its file describes it.
#[derive(Clone, Debug)]
pub struct BalanceFile {
    /// Name.
    pub name: String,
    /// Unit of the readings.
    pub unit: String,
    /// Unit of the weights.
    pub weight_unit: WeightUnit,
    /// How angles are counted.
    pub angles: AngleConvention,
    /// Names of the planes.
    pub planes: Vec<String>,
    /// Names of the readings.
    pub sensors: Vec<String>,
    /// Measurement.
    pub measured: Measured,
    /// Holes of the planes that have some.
    pub holes: Vec<PlaneHoles>,
    /// Planes whose weight is split between two angles (degrees).
    pub splits: Vec<(usize, [f64; 2])>,
    /// The rotor, for its grade.
    pub rotor: Option<Rotor>,
}

/// Measurement.
#[derive(Clone, Debug)]
pub enum Measured {
    /// Amplitudes and phases.
    Phasors {
        /// The procedure, as far as the runs go.
        procedure: Box<Field>,
        /// The first run.
        baseline: Vec<Complex<f64>>,
        /// The last run.
        last: Vec<Complex<f64>>,
        /// Speed of each reading (rpm); empty where none is given.
        rpm: Vec<f64>,
        /// Weights on the rotor: corrections, and trial weights that stay.
        on: Vec<Complex<f64>>,
        /// Corrections that were put on.
        corrections: usize,
    },
    /// Amplitudes alone.
    Amplitudes {
        /// Without a trial weight.
        baseline: f64,
        /// The weight that follows.
        found: FromAmplitudes<f64>,
    },
    /// Not read yet.
    Nothing,
}

/// Unit of the weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightUnit {
    /// g.
    Gram,
    /// kg.
    Kilogram,
    /// g mm.
    GramMillimetre,
    /// kg m.
    KilogramMetre,
    /// Avoirdupois ounce.
    Ounce,
    /// oz in.
    OunceInch,
    /// lb.
    Pound,
}

/// How angles are counted in a file, and shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AngleConvention {
    /// Whether the unit is named; if not, phases that look like radians are refused.
    named: bool,
    /// Radians and not degrees.
    pub radians: bool,
    /// Phases of readings lag.
    lag: bool,
    /// Angles of weights are counted against the rotation.
    against: bool,
}

impl AngleConvention {
    /// An angle of the file in degrees.
    fn degrees(self, angle: f64) -> f64 {
        if self.radians { angle.to_degrees() } else { angle }
    }

    /// A reading from the file, or for it: its own inverse.
    pub fn reading(self, z: Complex<f64>) -> Complex<f64> {
        if self.lag { z.conj() } else { z }
    }

    /// A weight from the file, or for it.
    pub fn weight(self, z: Complex<f64>) -> Complex<f64> {
        if self.against { z.conj() } else { z }
    }

    fn check(self, entry: &Entry) -> Result<(), Error> {
        if self.named { Ok(()) } else { entry.check() }
    }
}

/// kg of an ounce, and m of an inch, both by definition.
const OUNCE: f64 = 0.028_349_523_125;
const INCH: f64 = 0.025_4;

impl WeightUnit {
    /// As it is written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gram => "g",
            Self::Kilogram => "kg",
            Self::GramMillimetre => "g mm",
            Self::KilogramMetre => "kg m",
            Self::Ounce => "oz",
            Self::OunceInch => "oz in",
            Self::Pound => "lb",
        }
    }

    /// Unbalance of a weight of one (kg m); none where that takes a radius which is not given.
    pub fn unbalance(self, radius: Option<f64>) -> Option<f64> {
        match self {
            Self::Gram => radius.map(|radius| radius * 1e-3),
            Self::Kilogram => radius,
            Self::GramMillimetre => Some(1e-6),
            Self::KilogramMetre => Some(1.0),
            Self::Ounce => radius.map(|radius| radius * OUNCE),
            Self::OunceInch => Some(OUNCE * INCH),
            Self::Pound => radius.map(|radius| radius * 16.0 * OUNCE),
        }
    }
}

/// The holes of a plane.
#[derive(Clone, Debug)]
pub struct PlaneHoles {
    /// The plane.
    pub plane: usize,
    /// Angles (degrees).
    pub degrees: Vec<f64>,
    /// Weights to choose from.
    pub weights: Vec<f64>,
    /// Whether weight is added or removed.
    pub mode: CorrectionMethod,
    /// Message where they cannot take the weight.
    pub too_heavy: Diagnostic,
}

/// The rotor.
#[derive(Clone, Debug)]
pub struct Rotor {
    /// Mass (kg).
    pub mass: f64,
    /// Highest service speed (rpm).
    pub rpm: f64,
    /// Balance quality grade (mm/s).
    pub grade: f64,
    /// Radius of the weights (m).
    pub radius: Option<f64>,
    /// Where everything is along the rotor.
    pub along: Option<Along>,
    /// Whether one plane is enough, by width over diameter.
    pub one_plane: Option<bool>,
}

/// Places along a rotor, from bearing A.
#[derive(Clone, Debug)]
pub struct Along {
    /// Bearing B (m).
    pub span: f64,
    /// Centre of mass (m).
    pub centre: f64,
    /// Each plane (m).
    pub planes: Vec<f64>,
}

/// Range of a limit or of a weight for a hole.
const ABOVE_ZERO: Quantity = Quantity { zero: false, ..Quantity::WEIGHT };
const PAIR: &str = "a list of two numbers, [amplitude, phase in degrees]";
const NAMES: &str = "a list of names";

/// Reads a balancing from a file.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn read(path: &Path) -> Result<BalanceFile, Diagnostic> {
    let (name, text) = text(path, "a file of balancing")?;
    parse(&name, &text)
}

/// Reads a balancing from a text; `name` is what messages call it.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn parse(name: &str, text: &str) -> Result<BalanceFile, Diagnostic> {
    let source = Source { name, text };
    let document = document(source, "a balancing: `name`, `planes`, [baseline] and [[trial]] tables")?;
    let mut root = Table::root(source, document.get_ref());
    let rotor_name = root.text("name", "the rotor's name")?.to_owned();
    let unit = root.text_if("unit", "the unit of the readings")?.unwrap_or("").to_owned();
    let weight_unit = choice(
        &mut root,
        "weight_unit",
        &[
            ("g", WeightUnit::Gram),
            ("kg", WeightUnit::Kilogram),
            ("g mm", WeightUnit::GramMillimetre),
            ("kg m", WeightUnit::KilogramMetre),
            ("oz", WeightUnit::Ounce),
            ("oz in", WeightUnit::OunceInch),
            ("lb", WeightUnit::Pound),
        ],
    )?;
    let convention = AngleConvention {
        named: root.has("angle_unit"),
        radians: choice(&mut root, "angle_unit", &[("degrees", false), ("radians", true)])?,
        lag: choice(&mut root, "phase_sense", &[("lead", false), ("lag", true)])?,
        against: choice(&mut root, "weight_sense", &[("with rotation", false), ("against rotation", true)])?,
    };
    let planes = names(&mut root, "planes", PLANES)?;
    let mut file = BalanceFile {
        name: rotor_name,
        unit,
        weight_unit,
        angles: convention,
        sensors: Vec::new(),
        measured: Measured::Nothing,
        holes: Vec::new(),
        splits: Vec::new(),
        rotor: None,
        planes,
    };
    for mut table in root.optional_tables("holes")? {
        let holes = holes(&mut table, &file.planes, convention)?;
        if file.holes.iter().any(|known| known.plane == holes.plane) {
            return Err(table.wrong("plane", "a plane that has no [[holes]] yet: one table for all holes of a plane"));
        }
        file.holes.push(holes);
        table.finish()?;
    }
    for mut table in root.optional_tables("split")? {
        let plane = plane(&mut table, &file.planes)?;
        let angles = list(&mut table, "angles", 2, Quantity::DEGREES)?;
        let apart = |a: f64, b: f64| (convention.degrees(a) - convention.degrees(b)).to_radians().sin().abs();
        let [a, b] = angles[..] else { return Err(table.wrong("angles", "a list of 2 numbers")) };
        // within half a degree of one line
        if apart(a, b) < 0.01 {
            return Err(table.wrong("angles", "two angles that are neither alike nor opposite"));
        }
        if file.splits.iter().any(|known| known.0 == plane) || file.holes.iter().any(|known| known.plane == plane) {
            return Err(table.wrong("plane", "a plane that has neither a [[split]] nor [[holes]] yet"));
        }
        file.splits.push((plane, [convention.degrees(a), convention.degrees(b)]));
        table.finish()?;
    }
    if root.has("rotor") {
        let mut table = root.table("rotor")?;
        let radius = if table.has("radius") { Some(table.number("radius", Quantity::DIAMETER)?) } else { None };
        if radius.is_none() && file.weight_unit.unbalance(None).is_none() {
            return Err(
                table.wrong("radius", format!("the radius of the weights, which are in {}", weight_unit.name()))
            );
        }
        file.rotor = Some(Rotor {
            along: along(&mut table, file.planes.len())?,
            one_plane: one_plane(&mut table)?,
            mass: table.number("mass", Quantity::MASS)?,
            rpm: table.number("rpm", Quantity::RPM)?,
            grade: table.number("grade", Quantity::GRADE)?,
            radius,
        });
        table.finish()?;
    }
    if root.has("amplitudes") {
        if file.planes.len() > 1 {
            return Err(root.wrong("planes", "one plane: amplitudes without phases cannot separate two"));
        }
        if !file.splits.is_empty() {
            return Err(root.wrong("split", "no [[split]] beside [amplitudes]: [[holes]] at the two angles"));
        }
        if let Some(key) = OF_PHASES.iter().find(|key| root.has(key)) {
            let expected = "only beside [baseline], whose readings have phases, not beside [amplitudes]";
            return Err(root.wrong(key, expected));
        }
        let mut table = root.table("amplitudes")?;
        let expected = "a list of two numbers, [angle in degrees, amplitude]";
        let runs = table.items("runs", expected)?;
        let run = |item: &Item<'_>| item.pair(Quantity::DEGREES, Quantity::AMPLITUDE, expected);
        let runs: Vec<(f64, f64)> = runs.iter().map(run).collect::<Result<_, _>>()?;
        let baseline = table.number("baseline", Quantity::AMPLITUDE)?;
        let weight = table.number("weight", Quantity::WEIGHT)?;
        let mut angles = Entry::new();
        for (degrees, _) in &runs {
            angles.polar(1.0, *degrees);
        }
        let radians: Vec<(f64, f64)> =
            runs.iter().map(|(angle, amplitude)| (convention.degrees(*angle).to_radians(), *amplitude)).collect();
        let found = convention.check(&angles).and_then(|()| from_amplitudes(baseline, weight, &radians));
        let found = found.map_err(|refusal| match refusal {
            Error::TrialWeightZero { .. } => table.wrong("weight", format!("a weight above zero ({refusal})")),
            Error::Reading { row: 0 } => table.wrong("baseline", "an amplitude above zero"),
            Error::PhasesInRadians => table.wrong("runs", format!("angles in degrees: {refusal}")),
            Error::ReadingMissing { .. } => table.wrong("runs", "three runs at different angles, or two"),
            Error::NoEffect { .. } => table.wrong("runs", format!("other amplitudes than the baseline's ({refusal})")),
            _ => table.wrong(
                "runs",
                "runs at different angles, not on one line through the shaft, with amplitudes consistent \
                 with one influence; \
                 repeat them, or take a larger trial weight",
            ),
        })?;
        file.measured = Measured::Amplitudes { baseline, found };
        table.finish()?;
    } else {
        file.sensors = names(&mut root, "sensors", ROWS)?;
        file.measured = phasors(&mut root, &file)?;
    }
    root.finish()?;
    Ok(file)
}

/// The runs, given to the procedure one by one.
fn phasors(root: &mut Table<'_>, file: &BalanceFile) -> Result<Measured, Diagnostic> {
    let (planes, rows, convention) = (file.planes.as_slice(), file.sensors.len(), file.angles);
    let mut aim = Aim::<f64, ROWS, PLANES> {
        objective: choice(root, "aim", &[("least squares", Objective::LeastSquares), ("min-max", Objective::MinMax)])?,
        independence: root.number_or("independence", Quantity::SHARE, 0.01)?,
        ..Aim::default()
    };
    let leave_trials = choice(root, "trials", &[("removed", false), ("stay", true)])?;
    let good = root.number_or("good", Quantity::AMPLITUDE, f64::MIN_POSITIVE)?;
    for (value, weighting) in list(root, "weighting", rows, Quantity::WEIGHT)?.into_iter().zip(&mut aim.weighting) {
        *weighting = value;
    }
    let readings = aim.weighting.iter().take(rows).filter(|weighting| **weighting > 0.0).count();
    if readings < planes.len() && readings < rows {
        let refusal = Error::MorePlanesThanReadings { planes: planes.len(), readings };
        return Err(root.wrong("weighting", format!("a reading above zero for each plane: {refusal}")));
    }
    for (value, limit) in limits(root, planes.len())?.into_iter().zip(&mut aim.limits) {
        *limit = value;
    }
    let plan = Plan { leave_trials, aim, ..Plan::usual(rows, planes.len(), good) };
    let mut procedure =
        Field::new(plan).map_err(|refusal| root.wrong("planes", format!("other settings: {refusal}")))?;
    let (mut entry, mut angles) = (Entry::new(), Entry::new());
    let mut common = Common { rows, convention, run_out: vec![Complex::new(0.0, 0.0); rows], baseline: None };
    let mut on = vec![Complex::new(0.0, 0.0); planes.len()];
    if root.has("run_out") {
        let mut table = root.table("run_out")?;
        common.run_out = pairs(&mut table, "readings", rows, &mut entry, convention, AngleConvention::reading)?;
        table.finish()?;
    }

    let mut table = root.table("baseline")?;
    let (run, baseline, rpm) = run(&mut table, &common, &mut entry)?;
    common.baseline = Some(rpm.clone());
    procedure.baseline(&run).map_err(|refusal| refused(&table, refusal))?;
    table.finish()?;
    let mut last = baseline.clone();

    let machine = choice(root, "machine", &[("none", false), ("hard-bearing", true)])?;
    if machine {
        if root.has("influence") {
            return Err(root.wrong("influence", "no [[influence]] beside `machine`: the places of the planes have it"));
        }
        let influence = hard_bearing(root, file, &rpm)?;
        procedure =
            procedure.with_coefficients(influence).map_err(|refusal| root.wrong("machine", refusal.to_string()))?;
    }
    let known = root.optional_tables("influence")?;
    if !known.is_empty() {
        let mut influence = Influence::<f64, ROWS, PLANES>::new(rows, planes.len())
            .map_err(|refusal| root.wrong("influence", refusal.to_string()))?;
        let mut phases = Entry::new();
        for mut table in known {
            let plane = plane(&mut table, planes)?;
            if influence.get(0, plane).is_some() {
                return Err(table.wrong("plane", "a plane that has no [[influence]] yet"));
            }
            let column = pairs(&mut table, "coefficients", rows, &mut phases, convention, AngleConvention::reading)?;
            convention
                .check(&phases)
                .map_err(|refusal| table.wrong("coefficients", format!("phases in degrees: {refusal}")))?;
            influence.set(plane, &column).map_err(|refusal| table.wrong("coefficients", refusal.to_string()))?;
            table.finish()?;
        }
        procedure = procedure
            .with_coefficients(influence)
            .map_err(|refusal| root.wrong("influence", format!("a table for each plane: {}", said(refusal, planes))))?;
    }
    let known = machine || root.has("influence");
    for (count, mut table) in root.optional_tables("trial")?.into_iter().enumerate() {
        let plane = plane(&mut table, planes)?;
        if known {
            return Err(
                table.wrong("plane", "no trial run beside [[influence]] or `machine`: one of them, for all planes")
            );
        }
        if count == TRIALS {
            return Err(table.wrong("plane", format!("no more than {TRIALS} trial runs")));
        }
        let weight = weight(&mut table, "weight", &mut angles, convention)?;
        convention
            .check(&angles)
            .map_err(|refusal| table.wrong("weight", format!("an angle in degrees: {refusal}")))?;
        let (run, readings, _) = self::run(&mut table, &common, &mut entry)?;
        // several of a plane all count: replacing one would lose an entry
        procedure.extra_trial(plane, weight, &run).map_err(|refusal| refused(&table, refusal))?;
        if leave_trials {
            last = readings;
            on[plane] += weight;
        }
        table.finish()?;
    }
    let mut corrections = 0;
    for mut table in root.optional_tables("correction")? {
        if corrections == CORRECTIONS {
            return Err(table.wrong("weights", format!("no more than {CORRECTIONS} corrections")));
        }
        let placed =
            pairs(&mut table, "weights", planes.len(), &mut Entry::new(), convention, AngleConvention::weight)?;
        for (on, weight) in on.iter_mut().zip(&placed) {
            *on += weight;
        }
        let mut all = [Complex::new(0.0, 0.0); PLANES];
        all[..placed.len()].copy_from_slice(&placed);
        procedure.installed(&all).map_err(|refusal| table.wrong("weights", said(refusal, planes)))?;
        let (run, readings, _) = self::run(&mut table, &common, &mut entry)?;
        procedure.verified(&run).map_err(|refusal| refused(&table, refusal))?;
        last = readings;
        corrections += 1;
        table.finish()?;
    }
    if let Err(refusal) = convention.check(&entry) {
        let mut table = root.table("baseline")?;
        let _ = table.has("readings");
        return Err(table.wrong("readings", format!("phases in degrees: {refusal}")));
    }
    if let Some(plane) = procedure.influence().ok().and_then(|influence| influence.unknown()) {
        let expected = format!("a [[trial]] of plane \"{}\": its influence is not known", planes[plane]);
        let key = if root.has("trial") { "trial" } else { "planes" };
        return Err(root.wrong(key, expected));
    }
    // readings without a solution are a fault of the file
    procedure.correction().map_err(|refusal| {
        let key = ["limits", "aim", "baseline"].into_iter().find(|key| root.has(key)).unwrap_or("planes");
        root.wrong(key, format!("readings with a solution: {}", said(refusal, planes)))
    })?;
    Ok(Measured::Phasors { procedure: Box::new(procedure), baseline, last, rpm, on, corrections })
}

/// Influence of the planes on the forces in the bearings of a balancing machine, by their places.
fn hard_bearing(root: &Table<'_>, file: &BalanceFile, rpm: &[f64]) -> Result<Influence<f64, ROWS, PLANES>, Diagnostic> {
    let expected = "[rotor] with `span`, `centre` and `planes_at`: the bearings' and planes' places";
    let places = file.rotor.as_ref().and_then(|rotor| Some((rotor.along.as_ref()?, rotor.radius)));
    let (along, radius) = places.ok_or_else(|| root.wrong("machine", expected))?;
    // a rotor without a radius has passed the check of its table
    let unbalance = file.weight_unit.unbalance(radius).ok_or_else(|| root.wrong("machine", expected))?;
    if !matches!(file.unit.as_str(), "" | "N") {
        return Err(root.wrong("unit", "\"N\": a hard-bearing machine measures forces"));
    }
    if file.sensors.len() != 2 {
        return Err(root.wrong("sensors", "two of them: the forces in bearing A and in bearing B"));
    }
    let bearings = bearings(&file.sensors).ok_or_else(|| {
        root.wrong("sensors", "one name with a capital \"A\" and one with \"B\", or neither: the first is A then")
    })?;
    let speeds = radians_per_second(rpm);
    if speeds.len() != 2 {
        return Err(root.wrong("baseline", "`rpm` in it: the forces of a hard-bearing machine go with its square"));
    }
    let mut influence =
        Influence::new(2, file.planes.len()).map_err(|refusal| root.wrong("planes", refusal.to_string()))?;
    for (plane, at) in along.planes.iter().enumerate() {
        let shares = two_planes([(Complex::new(unbalance, 0.0), *at)], 0.0, along.span)
            .map_err(|refusal| root.wrong("machine", refusal.to_string()))?;
        let column = [0, 1].map(|row| shares[bearings[row]] * speeds[row] * speeds[row]);
        influence.set(plane, &column).map_err(|refusal| root.wrong("machine", refusal.to_string()))?;
    }
    Ok(influence)
}

/// The bearing of each of two sensors, 0 for A: by a letter of the names, else in their order.
///
/// None where only one name has a bearing, both have the same, or one has both.
fn bearings(sensors: &[String]) -> Option<[usize; 2]> {
    let [first, second] = sensors else { return None };
    match (letters(first), letters(second)) {
        ([true, false], [false, true]) | ([false, false], [false, false]) => Some([0, 1]),
        ([false, true], [true, false]) => Some([1, 0]),
        _ => None,
    }
}

/// Whether a sensor's name has the letter of bearing A, and of B: a capital that ends a word, as in `B`, `B1` or
/// `bearingB`, or a small letter as a word. An `a` before another word is the article.
fn letters(name: &str) -> [bool; 2] {
    let words: Vec<&str> = name.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect();
    let ends_word = |letter: char| {
        let before = |word: &str| word.strip_suffix(letter).is_some_and(|rest| !rest.ends_with(char::is_uppercase));
        words.iter().any(|word| before(word))
    };
    [ends_word('A') || words.last() == Some(&"a"), ends_word('B') || words.contains(&"b")]
}

/// A refusal with the planes by their names.
fn said(refusal: Error, planes: &[String]) -> String {
    match refusal {
        Error::PlaneUnknown { plane } => match planes.get(plane) {
            Some(name) => format!("the influence of plane \"{name}\" is not known: make its trial run"),
            None => refusal.to_string(),
        },
        _ => refusal.to_string(),
    }
}

/// A refusal at the key that it is about.
fn refused(table: &Table<'_>, refusal: Error) -> Diagnostic {
    let (key, expected) = match refusal {
        Error::TrialWeightZero { .. } | Error::Weight { .. } => ("weight", "a weight above zero"),
        Error::SpeedDiffers { .. } => ("rpm", "the speed of the baseline, within 1 %"),
        Error::NoEffect { .. } => ("readings", "readings that the trial weight has changed"),
        _ => ("readings", "other readings"),
    };
    table.wrong(key, format!("{expected} ({refusal})"))
}

/// A run, its readings, and the speed of each (rpm).
type Typed = (Run<f64, ROWS>, Vec<Complex<f64>>, Vec<f64>);

/// What all runs of a file have in common.
struct Common {
    rows: usize,
    convention: AngleConvention,
    run_out: Vec<Complex<f64>>,
    /// Speeds of the baseline (rpm), empty without any; none before it is read.
    baseline: Option<Vec<f64>>,
}

/// Readings and their speeds: those of the baseline where none is given.
fn run(table: &mut Table<'_>, common: &Common, entry: &mut Entry) -> Result<Typed, Diagnostic> {
    let rows = common.rows;
    let mut readings = pairs(table, "readings", rows, entry, common.convention, AngleConvention::reading)?;
    for (reading, run_out) in readings.iter_mut().zip(&common.run_out) {
        *reading -= run_out;
    }
    if !table.has("rpm") {
        let rpm = common.baseline.clone().unwrap_or_default();
        // any speed will do where all runs are of the same
        let speeds = if rpm.is_empty() { vec![1.0; rows] } else { radians_per_second(&rpm) };
        let run = Run::new(&readings, &speeds).map_err(|refusal| refused(table, refusal))?;
        return Ok((run, readings, rpm));
    }
    if common.baseline.as_ref().is_some_and(Vec::is_empty) {
        return Err(table.wrong("rpm", "no speed, as the baseline has none: give it to both, or to none"));
    }
    // one speed for all, or one for each
    let rpm = match table.number("rpm", Quantity::RPM) {
        Ok(rpm) => vec![rpm; rows],
        Err(fault) => match table.items("rpm", "") {
            Ok(_) => list(table, "rpm", rows, Quantity::RPM)?,
            Err(_) => return Err(fault),
        },
    };
    let run = Run::new(&readings, &radians_per_second(&rpm)).map_err(|refusal| refused(table, refusal))?;
    Ok((run, readings, rpm))
}

fn radians_per_second(rpm: &[f64]) -> Vec<f64> {
    rpm.iter().map(|rpm| rpm * std::f64::consts::TAU / 60.0).collect()
}

/// Pairs of amplitude and angle, as many as there must be.
fn pairs(
    table: &mut Table<'_>,
    key: &'static str,
    count: usize,
    entry: &mut Entry,
    convention: AngleConvention,
    counted: fn(AngleConvention, Complex<f64>) -> Complex<f64>,
) -> Result<Vec<Complex<f64>>, Diagnostic> {
    let expected = format!("{count} pairs [amplitude, phase in degrees], one for each");
    let items = table.items(key, &expected)?;
    if items.len() < count {
        let missing = format!("{expected}: {} of them are missing", count - items.len());
        return Err(table.wrong(key, missing));
    }
    if items.len() > count {
        return Err(items[count].wrong(&format!("only {count} pairs, one for each")));
    }
    let pair = |item: &Item<'_>| {
        let (amplitude, angle) = item.pair(Quantity::AMPLITUDE, Quantity::DEGREES, PAIR)?;
        Ok(counted(convention, entry.polar(amplitude, convention.degrees(angle))))
    };
    items.iter().map(pair).collect()
}

/// One weight: an amount and an angle.
fn weight(
    table: &mut Table<'_>,
    key: &'static str,
    entry: &mut Entry,
    convention: AngleConvention,
) -> Result<Complex<f64>, Diagnostic> {
    let expected = "an amount and an angle in degrees, [2.5, 90]";
    let items = table.items(key, expected)?;
    let [amount, angle] = items.as_slice() else { return Err(table.wrong(key, expected)) };
    let (amount, angle) = (amount.number(Quantity::WEIGHT)?, angle.number(Quantity::DEGREES)?);
    Ok(convention.weight(entry.polar(amount, convention.degrees(angle))))
}

/// The largest weight of each plane; `"none"` for a plane without a limit.
fn limits(table: &mut Table<'_>, count: usize) -> Result<Vec<Option<f64>>, Diagnostic> {
    if !table.has("limits") {
        return Ok(Vec::new());
    }
    let expected = format!("a list of {count} numbers, or \"none\" for a plane without a limit");
    let items = table.items("limits", &expected)?;
    if items.len() != count {
        return Err(table.wrong("limits", format!("{expected}, and not {}", items.len())));
    }
    let limit = |item: &Item<'_>| match item.text(&expected) {
        Ok("none") => Ok(None),
        _ => item.number(ABOVE_ZERO).map(Some),
    };
    items.iter().map(limit).collect()
}

/// Numbers, none or as many as there must be.
fn list(table: &mut Table<'_>, key: &'static str, count: usize, quantity: Quantity) -> Result<Vec<f64>, Diagnostic> {
    if !table.has(key) {
        return Ok(Vec::new());
    }
    let expected = format!("a list of {count} numbers");
    let items = table.items(key, &expected)?;
    if items.len() != count {
        return Err(table.wrong(key, format!("{expected}, and not {}", items.len())));
    }
    items.iter().map(|item| item.number(quantity)).collect()
}

/// Names, one at least and none twice.
fn names(table: &mut Table<'_>, key: &'static str, most: usize) -> Result<Vec<String>, Diagnostic> {
    let items = table.items(key, NAMES)?;
    if items.is_empty() || items.len() > most {
        return Err(table.wrong(key, format!("{NAMES}, 1 to {most} of them")));
    }
    let mut names: Vec<String> = Vec::new();
    for item in &items {
        let name = item.text("a name")?;
        if name.trim().is_empty() || names.iter().any(|known| known == name) {
            return Err(item.wrong("a name of its own"));
        }
        names.push(name.to_owned());
    }
    Ok(names)
}

/// One of some words; the first where the key is left out.
fn choice<T: Copy>(table: &mut Table<'_>, key: &'static str, words: &[(&str, T)]) -> Result<T, Diagnostic> {
    let expected = words.iter().map(|(word, _)| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ");
    let Some(word) = table.text_if(key, &expected)? else { return Ok(words[0].1) };
    match words.iter().find(|(known, _)| *known == word) {
        Some((_, value)) => Ok(*value),
        None => Err(table.wrong(key, expected)),
    }
}

/// A plane by its name.
fn plane(table: &mut Table<'_>, planes: &[String]) -> Result<usize, Diagnostic> {
    let expected = planes.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ");
    let name = table.text("plane", &expected)?;
    planes.iter().position(|known| known == name).ok_or_else(|| table.wrong("plane", expected))
}

/// Places along the rotor, all of them or none.
fn along(table: &mut Table<'_>, planes: usize) -> Result<Option<Along>, Diagnostic> {
    if !["span", "centre", "planes_at"].into_iter().any(|key| table.has(key)) {
        return Ok(None);
    }
    let (span, centre) = (table.number("span", Quantity::LENGTH)?, table.number("centre", Quantity::PLACE)?);
    if !table.has("planes_at") {
        return Err(table.wrong("planes_at", format!("a list of {planes} places from bearing A")));
    }
    Ok(Some(Along { span, centre, planes: list(table, "planes_at", planes, Quantity::PLACE)? }))
}

/// Whether a rotor of this width and diameter is balanced in one plane.
fn one_plane(table: &mut Table<'_>) -> Result<Option<bool>, Diagnostic> {
    let given = (table.number_if("width", Quantity::LENGTH)?, table.number_if("diameter", Quantity::DIAMETER)?);
    if given == (None, None) {
        return Ok(None);
    }
    let (width, diameter) = (table.number("width", Quantity::LENGTH)?, table.number("diameter", Quantity::DIAMETER)?);
    one_plane_suffices(width, diameter).map(Some).map_err(|refusal| table.wrong("width", refusal.to_string()))
}

fn holes(table: &mut Table<'_>, planes: &[String], convention: AngleConvention) -> Result<PlaneHoles, Diagnostic> {
    let plane = plane(table, planes)?;
    let degrees = if table.has("angles") {
        table.instead_of("angles", &["count", "first"])?;
        let items = table.items("angles", "angles in degrees")?;
        let mut degrees: Vec<f64> = Vec::new();
        let mut entry = Entry::new();
        for item in &items {
            let angle = convention.degrees(item.number(Quantity::DEGREES)?);
            entry.polar(1.0, angle);
            if degrees.iter().any(|known| (known - angle).rem_euclid(360.0) == 0.0) {
                return Err(item.wrong("an angle of its own: a hole takes one weight"));
            }
            degrees.push(angle);
        }
        convention.check(&entry).map_err(|refusal| table.wrong("angles", format!("angles in degrees: {refusal}")))?;
        if degrees.is_empty() {
            return Err(table.wrong("angles", "one angle at least"));
        }
        degrees
    } else {
        let count = table.number("count", Quantity::COUNT)? as u32;
        let first = convention.degrees(table.number_or("first", Quantity::DEGREES, 0.0)?);
        (0..count).map(|hole| first + 360.0 * f64::from(hole) / f64::from(count)).collect()
    };
    let items = table.items("weights", "weights to choose from")?;
    let weights = items.iter().map(|item| item.number(ABOVE_ZERO)).collect::<Result<Vec<_>, _>>()?;
    if weights.is_empty() {
        return Err(table.wrong("weights", "one weight at least"));
    }
    let too_heavy = table.wrong("weights", format!("more: {}", Error::TooHeavy { plane }));
    let removing = match table.has("removing") {
        false => false,
        true => table.truth("removing")?,
    };
    Ok(PlaneHoles {
        plane,
        degrees,
        weights,
        too_heavy,
        mode: if removing { CorrectionMethod::Removing } else { CorrectionMethod::Adding },
    })
}
