//! From a path or a text to a machine.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use driveline::machine::{Chain, Inertia};
use toml::Spanned;
use toml::de::DeTable;

use super::diagnostic::Diagnostic;
use super::excitation::excitations;
use super::quantity::Quantity;
use super::source::{Source, printable};
use super::table::Table;
use super::{Control, Disturbance, Duty, Element, Encoder, Limits, MachineFile, Part};

/// Largest machine file in bytes: a thousand times what the longest chain needs.
pub const LARGEST: u64 = 1 << 20;

/// What a name may be.
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

/// Reads a file as text: its name as messages call it, and what stands in it. `what` is the kind of file that was expected.
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
    let source = Source { name, text };
    let document = document(source, "a machine: `name`, [[element]] tables and the settings")?;
    let mut root = Table::root(source, document.get_ref());

    let machine_name = named(&mut root)?;
    let (elements, chain) = elements(source, &mut root)?;
    let encoder = section(&mut root, "encoder", |table| {
        // `LINES` and `RATE` allow whole numbers within `u32` only.
        Ok(Encoder { lines: table.number("lines", Quantity::LINES)? as u32 })
    })?;
    let control = section(&mut root, "control", |table| {
        Ok(Control { rate_hz: table.number("rate_hz", Quantity::RATE)? as u32 })
    })?;
    let disturbance = section(&mut root, "disturbance", |table| {
        Ok(Disturbance {
            torque_accuracy: table.number("torque_accuracy", Quantity::TORQUE)?,
            load_torque_step: table.number("load_torque_step", Quantity::TORQUE)?,
            within: table.number("within", Quantity::TIME)?,
        })
    })?;
    let limits = section(&mut root, "limits", |table| {
        Ok(Limits { torque: table.number("torque", Quantity::TORQUE)?, speed: table.number("speed", Quantity::SPEED)? })
    })?;
    let (running, excitations) = excitations(&mut root)?;
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
        name: machine_name.to_owned(),
        elements,
        encoder,
        control,
        disturbance,
        limits,
        running,
        excitations,
        duty,
        chain,
    })
}

/// The TOML of a text that is not empty.
pub(super) fn document<'a>(source: Source<'a>, expected: &str) -> Result<Spanned<DeTable<'a>>, Diagnostic> {
    if source.text.trim().is_empty() {
        return Err(Diagnostic::of_file(source.name, "an empty file", expected));
    }
    DeTable::parse(source.text).map_err(|error| not_toml(source, &error))
}

/// The name that the file gives.
pub(super) fn named<'a>(root: &mut Table<'a>) -> Result<&'a str, Diagnostic> {
    let name = root.text("name", NAME)?;
    let allowed = |c: char| c.is_ascii_alphanumeric() || " -_".contains(c);
    let good = name.len() <= 40 && name.chars().all(allowed) && name.contains(char::is_alphanumeric);
    if good { Ok(name) } else { Err(root.wrong("name", NAME)) }
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

/// Reads the elements and puts them together, so that what cannot follow is reported at its own place.
fn elements(source: Source<'_>, root: &mut Table<'_>) -> Result<(Vec<Part>, Chain), Diagnostic> {
    let mut parts: Vec<Part> = Vec::new();
    let mut chain: Option<Chain> = None;
    let mut last: Range<usize> = 0..0;
    for (index, (span, mut table)) in root.tables("element")?.into_iter().enumerate() {
        let at = |found: String, expected: &str| {
            Diagnostic::at(source, span.clone(), format!("element[{index}]"), found, expected)
        };
        let label = label(&mut table)?;
        let element = Element::read(table)?;
        let kind = element.kind();
        let longer = match (element, chain) {
            (Element::Motor { .. }, Some(_)) => {
                return Err(at("a second motor".to_owned(), "one motor only, as the first element"));
            }
            (Element::Motor { inertia }, None) => Chain::try_motor(Inertia(inertia)),
            (_, None) => return Err(at(format!("a {kind} before the motor"), "the motor as the first element")),
            (element, Some(chain)) => element.follow(chain),
        };
        let refused = |error: driveline::machine::Error| {
            at(format!("a {kind} that cannot stand here ({error})"), "an element that can follow those before it")
        };
        chain = Some(longer.map_err(refused)?);
        let same = parts.iter().filter(|part| part.element.kind() == kind).count();
        let label = label.unwrap_or_else(|| if same == 0 { kind.to_owned() } else { format!("{kind} {}", same + 1) });
        parts.push(Part { label, element });
        last = span;
    }
    let key = format!("element[{}]", parts.len().saturating_sub(1));
    let Some(chain) = chain else {
        return Err(Diagnostic::at(source, last, key, "no element", "the motor as the first element"));
    };
    let kind = parts.last().map_or("motor", |part| part.element.kind());
    let ended = |error: driveline::machine::Error| {
        let found = format!("a chain that ends in a {kind} ({error})");
        Diagnostic::at(source, last, key, found, "a rotor, a lifted or a driven mass as the last element")
    };
    chain.check().map_err(ended)?;
    Ok((parts, chain))
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
    let found = source.excerpt(span.clone());
    let found = if found.is_empty() { "nothing more".to_owned() } else { format!("`{}`", printable(&found, 40)) };
    let reason = error.message().lines().next().unwrap_or("").trim();
    Diagnostic::at(source, span, printable(key, 40), found, format!("TOML ({})", printable(reason, 160)))
}
