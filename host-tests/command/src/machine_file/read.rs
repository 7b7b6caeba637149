//! From a path or a text to a machine.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use driveline::design::{ClosedLoop, SpeedLoopTuning};
use driveline::machine::{CAPACITY, Chain, Error, Ratio, Train};
use toml::Spanned;
use toml::de::DeTable;

use super::class::Class;
use super::damper::DamperRing;
use super::diagnostic::Diagnostic;
use super::engine::{Engine, Turning};
use super::excitation::excitations;
use super::factor::{Factor, Tolerance};
use super::quantity::Quantity;
use super::source::{Source, printable};
use super::station::{Line, Long, NOTHING, Station, begun, stations};
use super::table::Table;
use super::{Accuracy, Actuator, Branch, Control, Disturbance, Duty, Element, Encoder, Limits, MachineFile, Part};
use driveline_report::format::significant;

/// Largest machine file in bytes: a thousand times what the longest chain needs.
pub const LARGEST: u64 = 1 << 20;

/// Tables that a drive needs; `modes` and `simulate` do without.
const SETTINGS: [&str; 4] = ["encoder", "control", "disturbance", "limits"];

/// Range of a name.
const NAME: &str = "a name of 1 to 40 letters, digits, spaces, `-` and `_`, with a letter or digit among them";

/// Reads a machine from a file.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn read(path: &Path) -> Result<MachineFile, Diagnostic> {
    load(path, "a machine file", parse)
}

/// Reads a file of this kind with a parser that is given its name and its text.
pub(super) fn load<T>(
    path: &Path,
    what: &str,
    parse: fn(&str, &str) -> Result<T, Diagnostic>,
) -> Result<T, Diagnostic> {
    let (name, text) = text(path, what)?;
    parse(&name, &text)
}

/// Reads a file as text: its name as messages call it, and what stands in it. `what` is the kind of file that was
/// expected.
///
/// # Errors
/// A file that cannot be read, is too long, or is not text.
pub fn text(path: &Path, what: &str) -> Result<(String, String), Diagnostic> {
    let name = printable(&path.display().to_string(), 200);
    let file = |error: std::io::Error| Diagnostic::of_file(&name, format!("no readable file ({error})"), what);
    let mut bytes = Vec::new();
    // The limit holds for what has no length too, a device or a pipe.
    File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes)).map_err(file)?;
    if bytes.len() as u64 > LARGEST {
        return Err(Diagnostic::of_file(&name, "more than 1 MiB", format!("{what} of at most 1 MiB")));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok((name, text)),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let bytes = error.into_bytes();
            let text = String::from_utf8_lossy(&bytes);
            // Up to the first bad byte the lossy text is the same as the bytes.
            let source = Source { name: &name, text: &text };
            let found = format!("the byte 0x{:02x}, which is not UTF-8", bytes[at]);
            Err(Diagnostic::at(source, at..at + 1, "", found, "a text file in TOML"))
        }
    }
}

/// Reads a machine from a text; `name` is what messages call it.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn parse(name: &str, text: &str) -> Result<MachineFile, Diagnostic> {
    parse_up_to(name, text, CAPACITY, true)
}

/// Reads a machine from a text for its modes, with any number of masses. Encoder, control, disturbance and limits may be
/// left out: no drive is designed for it.
pub fn parse_for_modes(name: &str, text: &str) -> Result<MachineFile, Diagnostic> {
    parse_up_to(name, text, usize::MAX, false)
}

/// As [`parse_for_modes`], for a run: with as many masses as a chain holds.
pub(super) fn parse_for_run(name: &str, text: &str) -> Result<MachineFile, Diagnostic> {
    parse_up_to(name, text, CAPACITY, false)
}

fn parse_up_to(name: &str, text: &str, most: usize, for_drive: bool) -> Result<MachineFile, Diagnostic> {
    let source = Source { name, text };
    let document = document(source, "a machine: `name`, [[element]] tables and the settings")?;
    let mut root = Table::root(source, document.get_ref());

    let machine_name = named(source, &mut root)?;
    let (elements, chain, count) = elements(source, &mut root, "", &[], most)?;
    let (branches, train, masses) = branches(source, &mut root, (chain, count), &elements, most)?;
    let error = train.as_ref().map_or(chain.error(), |train| train.error());
    let long = error.and_then(|_| Long::of(&elements, &branches));
    let missing: Vec<&str> = SETTINGS.into_iter().filter(|key| !root.has(key)).collect();
    if for_drive && !missing.is_empty() {
        let (tables, plural) = (missing.join("], ["), if missing.len() > 1 { "tables" } else { "table" });
        let expected = format!("the {plural} [{tables}], as in the file of `cargo driveline example roll`");
        return Err(root.wrong(missing[0], expected));
    }
    // the largest speed ends the running range where the file has none
    let is_excited = (root.has("excitation") || root.has("engine")) && !root.has("running");
    let needed = |key| for_drive || (key == "limits" && is_excited);
    let none = Encoder { lines: 1, accuracy: Accuracy::NONE };
    let encoder = section_or(&mut root, "encoder", (!needed("encoder")).then_some(none), |table| {
        // `LINES` and `RATE` allow whole numbers within `u32` only.
        let lines = table.number("lines", Quantity::LINES)?;
        let accuracy = Accuracy {
            signal_periods: table.number_or("signal_periods", Quantity::LINES, lines)? as u32,
            interpolation: table.number_or("interpolation", Quantity::INTERPOLATION, 0.0)?,
            eccentricity: table.number_or("eccentricity", Quantity::ECCENTRICITY, 0.0)?,
            jitter: table.number_or("jitter", Quantity::RISE, 0.0)?,
        };
        Ok(Encoder { lines: lines as u32, accuracy })
    })?;
    let control = section_or(&mut root, "control", (!needed("control")).then_some(Control { rate_hz: 1 }), |table| {
        Ok(Control { rate_hz: table.number("rate_hz", Quantity::RATE)? as u32 })
    })?;
    let none = Disturbance { torque_accuracy: 1.0, torque_noise: None, load_torque_step: 1.0, within: 1.0 };
    let disturbance = section_or(&mut root, "disturbance", (!needed("disturbance")).then_some(none), |table| {
        Ok(Disturbance {
            torque_accuracy: table.number("torque_accuracy", Quantity::TORQUE)?,
            torque_noise: table.number_if("torque_noise", Quantity::TORQUE)?,
            load_torque_step: table.number("load_torque_step", Quantity::TORQUE)?,
            within: table.number("within", Quantity::TIME)?,
        })
    })?;
    let none = Limits { torque: 1.0, speed: 1.0, rated_torque: 1.0 };
    let limits = section_or(&mut root, "limits", (!needed("limits")).then_some(none), |table| {
        let torque = table.number("torque", Quantity::TORQUE)?;
        let speed = table.number("speed", Quantity::SPEED)?;
        let rated_torque = table.number_or("rated_torque", Quantity::TORQUE, 0.5 * torque)?;
        if rated_torque > torque {
            return Err(table.wrong("rated_torque", format!("at most `limits.torque`, {torque} N m")));
        }
        Ok(Limits { torque, speed, rated_torque })
    })?;
    let actuator = match root.table_if("actuator")? {
        Some(mut table) => {
            let delay = table.number_or("delay", Quantity::DELAY, 0.0)?;
            let rate = f64::from(control.rate_hz);
            // a millionth of a tick for rounding, as the design of the speed loop has it
            let most = ClosedLoop::MAX_DELAY_TICKS;
            if delay * rate > most + 1e-6 {
                let expected = format!("at most {most} ticks of `control.rate_hz`, {} s", significant(most / rate));
                return Err(table.wrong("delay", expected));
            }
            let bandwidth = table.number_if("bandwidth", Quantity::ACTUATOR_BANDWIDTH)?;
            table.finish()?;
            Actuator { delay, bandwidth }
        }
        None => Actuator::default(),
    };
    let (bandwidth, ramp) = match root.table_if("speed_loop")? {
        Some(mut table) => {
            let bandwidth = table.number_or("bandwidth", Quantity::BANDWIDTH, SpeedLoopTuning::USUAL.bandwidth)?;
            let ramp = table.number_if("ramp", Quantity::RAMP)?;
            table.finish()?;
            (bandwidth, ramp)
        }
        None => (SpeedLoopTuning::USUAL.bandwidth, None),
    };
    let lossy = chain.efficiency() < 1.0 || chain.back_efficiency() < 1.0;
    let gap = chain.shafts().iter().any(|shaft| shaft.gap > 0.0);
    let (class, tolerances) = tolerances(&mut root, encoder.accuracy, lossy, gap)?;
    let (running, mut excitations) = excitations(&mut root)?;
    let engine = root.table_if("engine")?.map(|table| Engine::read(table, &masses)).transpose()?;
    if let Some(engine) = &engine {
        excitations.push(engine.excitation());
    }
    let shafts = |own: usize| own - 1;
    let modes = branches.iter().map(|branch| shafts(branch.count)).sum::<usize>() + shafts(count);
    let dampers = DamperRing::read_all(&mut root, &masses, modes)?;
    // what a run of it needs is read by `read_train`
    root.pass(&["link", "torque", "friction", "start", "run"]);
    let duty = match root.table_if("duty")? {
        Some(mut table) => {
            let duty = Duty {
                change: table.number("change", Quantity::TORQUE)?,
                rise: table.number("rise", Quantity::RISE)?,
                every: table.number("every", Quantity::TIME)?,
            };
            table.finish()?;
            Some(duty)
        }
        None => None,
    };
    root.finish()?;
    Ok(MachineFile {
        name: machine_name,
        elements,
        encoder,
        control,
        disturbance,
        limits,
        actuator,
        bandwidth,
        ramp,
        class,
        tolerances,
        running,
        excitations,
        engine,
        dampers,
        duty,
        chain,
        branches,
        train,
        long,
    })
}

/// Reads the tolerances: those of the class with the file's in their place. An accuracy that the encoder states is the
/// largest error that it has.
fn tolerances(
    root: &mut Table<'_>,
    accuracy: Accuracy,
    lossy: bool,
    gap: bool,
) -> Result<(Class, Vec<Tolerance>), Diagnostic> {
    let mut table = root.table_if("tolerance")?;
    let class = match &mut table {
        Some(table) => {
            let names = Class::ALL.map(|(name, _)| name).join(", ");
            let text = table.text_if("class", &names)?;
            let found = text.map(|text| Class::ALL.into_iter().find(|(name, _)| *name == text));
            found.unwrap_or(Some(Class::ALL[0])).ok_or_else(|| table.wrong("class", format!("one of {names}")))?.1
        }
        None => Class::default(),
    };
    let mut all = class.machine(lossy, gap);
    let mut replace = |tolerance: Tolerance| match all.iter_mut().find(|known| known.factor == tolerance.factor) {
        Some(known) => *known = tolerance,
        None => all.push(tolerance),
    };
    for (factor, stated) in [
        (Factor::Interpolation, accuracy.interpolation),
        (Factor::Eccentricity, accuracy.eccentricity),
        (Factor::Jitter, accuracy.jitter),
    ] {
        if stated > 0.0 {
            replace(factor.about(stated));
        }
    }
    if let Some(mut table) = table {
        for &factor in Factor::ALL.iter().filter(|factor| **factor != Factor::Rope) {
            let (least, most) = factor.possible();
            let (by, unit) = (factor.about(0.1), factor.unit());
            let expected = format!(
                "a number, such as 0.1 for {} to {}, or a range [from, to], from {least} to {most} {unit}",
                by.low, by.high
            );
            let tolerance = match table.number_or_pair(factor.key(), &expected)? {
                None => continue,
                Some((by, None)) => factor.about(by),
                Some((low, Some(high))) => Tolerance::new(factor, low, high),
            };
            if !(tolerance.low <= tolerance.high && tolerance.low >= least && tolerance.high <= most) {
                return Err(table.wrong(factor.key(), expected));
            }
            let lacking = match factor {
                Factor::Efficiency if !lossy => Some("an element with `efficiency`, or no such tolerance"),
                Factor::Gap if !gap => Some("an element with `gap`, or no such tolerance"),
                _ => None,
            };
            if let Some(expected) = lacking {
                return Err(table.wrong(factor.key(), expected));
            }
            replace(tolerance);
        }
        table.finish()?;
    }
    Ok((class, all))
}

/// The TOML of a text that is not empty.
pub(super) fn document<'a>(source: Source<'a>, expected: &str) -> Result<Spanned<DeTable<'a>>, Diagnostic> {
    if source.text.trim().is_empty() {
        return Err(Diagnostic::of_file(source.name, "an empty file", expected));
    }
    DeTable::parse(source.text).map_err(|error| not_toml(source, &error))
}

/// The name that the file gives; where it gives none, that of the file itself without folder and extension, with `-`
/// for each character that no name has.
pub(super) fn named(source: Source, root: &mut Table) -> Result<String, Diagnostic> {
    let allowed = |c: char| c.is_ascii_alphanumeric() || " -_".contains(c);
    let name = match root.text_if("name", NAME)? {
        Some(name) => name.to_owned(),
        None => {
            let stem = Path::new(source.name).file_stem().unwrap_or_default().to_string_lossy();
            stem.chars().take(40).map(|c| if allowed(c) { c } else { '-' }).collect()
        }
    };
    let good = name.len() <= 40 && name.chars().all(allowed) && name.contains(char::is_alphanumeric);
    match (good, root.has("name")) {
        (true, _) => Ok(name),
        (false, true) => Err(root.wrong("name", NAME)),
        (false, false) => Err(root.wrong("name", format!("{NAME}, as the file's own name has none of these"))),
    }
}

/// Reads a table of settings, all of its keys.
pub(super) fn section<T>(
    root: &mut Table<'_>,
    key: &'static str,
    read: impl FnOnce(&mut Table<'_>) -> Result<T, Diagnostic>,
) -> Result<T, Diagnostic> {
    let mut table = root.table(key)?;
    let settings = read(&mut table)?;
    table.finish()?;
    Ok(settings)
}

/// Reads a table, or gives what stands for it where the file may do without.
fn section_or<T>(
    root: &mut Table<'_>,
    key: &'static str,
    without: Option<T>,
    read: impl FnOnce(&mut Table<'_>) -> Result<T, Diagnostic>,
) -> Result<T, Diagnostic> {
    match without {
        Some(without) if !root.has(key) => {
            root.pass(&[key]);
            Ok(without)
        }
        _ => section(root, key, read),
    }
}

/// Reads the elements and puts them together, so that what cannot follow is reported at its own place. The labels of
/// `before` are taken. Beside the elements their chain, which carries an error where it has more masses than it holds
/// but not more than `most`, and the number of masses.
fn elements(
    source: Source<'_>,
    table: &mut Table<'_>,
    heading: &str,
    before: &[Part],
    most: usize,
) -> Result<(Vec<Part>, Chain, usize), Diagnostic> {
    let branch = !before.is_empty();
    let mut parts: Vec<Part> = Vec::new();
    let mut chain: Option<Chain> = None;
    let mut line: Option<Line> = None;
    let room = |chain: &Chain| chain.error().filter(|error| *error != Error::TooManyMasses || most == CAPACITY);
    let mut last: Range<usize> = 0..0;
    let listed = if branch { table.tables_of("element", "part of the branch") } else { table.tables("element") };
    for (index, (span, mut table)) in listed?.into_iter().enumerate() {
        let at = |found: String, expected: &str| {
            Diagnostic::at(source, span.clone(), format!("{heading}element[{index}]"), found, expected)
        };
        let label = label(&mut table)?;
        let element = Element::read(table)?;
        let kind = element.kind();
        let longer = match (element, &mut line) {
            (Element::Motor { .. }, Some(_)) => {
                return Err(at("a second motor".to_owned(), "one motor only, as the first element"));
            }
            (Element::Motor { .. }, None) if branch => {
                return Err(at("a second motor".to_owned(), "one motor only, as the first element of the chain"));
            }
            (Element::Motor { .. }, None) => begun(element).map(|first| line = Some(first)),
            (element, None) if branch => begun(element).map(|first| line = Some(first)),
            (_, None) => return Err(at(format!("a {kind} before the motor"), "the motor as the first element")),
            (element, Some(line)) => line.follow(element),
        };
        let whole = longer.and_then(|()| match chain {
            Some(chain) => element.append(chain),
            None => begun(element).map(|first| first.end),
        });
        let whole = whole.and_then(|whole| room(&whole).map_or(Ok(whole), Err));
        chain = Some(whole.map_err(|error| {
            at(format!("a {kind} that cannot stand here ({error})"), "an element that can follow those before it")
        })?);
        let same = before.iter().chain(&parts).filter(|part| part.element.kind() == kind).count();
        let label = label.unwrap_or_else(|| if same == 0 { kind.to_owned() } else { format!("{kind} {}", same + 1) });
        parts.push(Part { label, element });
        last = span;
    }
    let key = format!("{heading}element[{}]", parts.len().saturating_sub(1));
    let (Some(chain), Some(line)) = (chain, line) else {
        return Err(Diagnostic::at(source, last, key, "no element", "the motor as the first element"));
    };
    let kind = parts.last().map_or("motor", |part| part.element.kind());
    let ended = |error: Error| {
        let found = format!("a chain that ends in a {kind} ({error})");
        Diagnostic::at(source, last, key, found, "a rotor, a lifted or a driven mass as the last element")
    };
    line.end.check().map_err(ended)?;
    Ok((parts, chain, line.masses.len()))
}

/// Reads the branches, each on a mass of the chain or of a branch before it.
fn branches(
    source: Source<'_>,
    root: &mut Table<'_>,
    (chain, count): (Chain, usize),
    main: &[Part],
    most: usize,
) -> Result<(Vec<Branch>, Option<Train>, Vec<Turning>), Diagnostic> {
    let mut branches: Vec<Branch> = Vec::new();
    // masses that can carry a branch
    let mut masses: Vec<Turning> = Vec::new();
    let turning = |part: &Part, station: &Station| {
        let turns = matches!(
            part.element,
            Element::Motor { .. }
                | Element::Rotor { .. }
                | Element::Crank(_)
                | Element::Mechanism { .. }
                | Element::Planetary { .. }
        );
        station.mass.filter(|_| turns).map(|mass| (part.label.clone(), mass, station.ratio))
    };
    masses.extend(main.iter().zip(&stations(main)).filter_map(|(part, station)| turning(part, station)));
    let mut parts = main.to_vec();
    let mut train: Option<Train> = None;
    let mut first = count;
    for (index, (span, mut table)) in root.tables_if("branch", "branch")?.into_iter().enumerate() {
        let known = masses.iter().map(|(label, ..)| format!("\"{label}\"")).collect::<Vec<_>>().join(", ");
        let expected = format!("the label of a mass that turns: {known}");
        let at = table.text("at", &expected)?.to_owned();
        let mut labelled = masses.iter().filter(|(label, ..)| *label == at);
        let Some(&(_, node, ratio)) = labelled.next() else {
            return Err(table.wrong("at", expected));
        };
        if labelled.next().is_some() {
            return Err(table.wrong("at", "a label that one mass alone has"));
        }
        let key = format!("branch[{index}]");
        let (elements, own, count) = elements(source, &mut table, &format!("{key}."), &parts, most)?;
        table.finish()?;
        if own.masses() == [NOTHING.0] {
            let expected = "a rotor, a lifted or a driven mass as its last element";
            return Err(Diagnostic::at(source, span, key, "a branch without a mass", expected));
        }
        let refused = |error: Error| {
            let found = format!("a branch that cannot stand here ({error})");
            Diagnostic::at(source, span.clone(), key.clone(), found, "a branch that the train has room for")
        };
        let before = match train {
            Some(train) => train,
            None => Train::of(chain),
        };
        let branched = before.branch(node, Ratio(ratio), own);
        let full = branched.error().filter(|error| *error != Error::TooManyMasses || most == CAPACITY);
        train = Some(full.map_or(Ok(branched), |error| Err(refused(error)))?);
        let branch = Branch { at, elements, chain: own, node, ratio, first, count };
        first += count - 1;
        let below = stations(&branch.elements);
        masses.extend(branch.elements.iter().zip(&below).filter_map(|(part, station)| {
            turning(part, station).map(|(label, mass, own)| (label, branch.mass(mass), ratio * own))
        }));
        parts.extend(branch.elements.iter().cloned());
        branches.push(branch);
    }
    Ok((branches, train, masses))
}

/// An element's label, if it has one.
fn label(table: &mut Table<'_>) -> Result<Option<String>, Diagnostic> {
    const LABEL: &str = "a label of 1 to 24 printable characters";
    let Some(label) = table.text_if("label", LABEL)? else { return Ok(None) };
    let printable = !label.trim().is_empty() && label.chars().count() <= 24 && !label.chars().any(char::is_control);
    if printable { Ok(Some(label.to_owned())) } else { Err(table.wrong("label", LABEL)) }
}

/// A fault of the TOML itself, with the key of its line where there is one.
pub fn not_toml(source: Source<'_>, error: &toml::de::Error) -> Diagnostic {
    let span = error.span().unwrap_or(0..0);
    let line = source.line(span.start);
    let key = line.split_once('=').map_or("", |(key, _)| key.trim());
    let key = if key.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c)) { key } else { "" };
    let rest = source.excerpt(span.start..source.text.len());
    // of a span without a length, the word there
    let word = rest.split_whitespace().next().unwrap_or_default();
    let found = Some(source.excerpt(span.clone())).filter(|found| !found.is_empty()).unwrap_or_else(|| word.to_owned());
    let found = if found.is_empty() { "nothing more".to_owned() } else { format!("`{}`", printable(&found, 40)) };
    let before = source.text.get(..span.start).unwrap_or_default();
    let mut digits = before.chars().rev().take(1).chain(rest.chars().skip(1).take(1));
    let is_word = before.trim_end().ends_with('=') && rest.starts_with(|c: char| c.is_alphanumeric() || c == '.');
    let expected = if rest.starts_with(',') && digits.all(|digit| digit.is_ascii_digit()) {
        "a number without commas, its decimal sign a point".to_owned()
    } else if is_word {
        // the parser guesses at a word: quotation marks round a number with its unit, `nan`, `false`
        "a number as 0.5 or 5e3 without its unit, a text in quotation marks, `true` or `false`".to_owned()
    } else {
        format!("TOML ({})", printable(error.message().lines().next().unwrap_or("").trim(), 160))
    };
    Diagnostic::at(source, span, printable(key, 40), found, expected)
}
