//! The pages on files: every complete file parses, and every key has the reader's unit, range and default.
//!
//! The reader itself is the reference: an unknown key makes it list the known ones, an empty list makes it name the
//! range.

use std::collections::BTreeSet;
use std::fs;

use cargo_driveline::machine_file::{Diagnostic, balance, parse, parse_rotor, parse_train};
use toml::{Table, Value};

use super::pages::{Page, Section, all, root};

/// A reader: what a text comes to, as text, or its fault.
type Reader = fn(&str) -> Result<String, Diagnostic>;

/// The readers by the word after the fence.
const READERS: [(&str, &str, Reader); 4] = [
    ("toml,machine", "doc/machine-files.md", |text| parse("listing", text).map(|file| format!("{file:?}"))),
    ("toml,train", "doc/train-files.md", |text| parse_train("listing", text).map(|file| format!("{file:?}"))),
    ("toml,rotor", "doc/rotor-files.md", |text| parse_rotor("listing", text).map(|file| format!("{file:?}"))),
    ("toml,balancing", "doc/balancing-files.md", |text| {
        balance::parse("listing", text).map(|file| format!("{file:?}"))
    }),
];

#[test]
fn every_listing_is_read() {
    for page in all() {
        for (info, text) in page.fences.iter().filter(|(info, _)| info.starts_with("toml")) {
            let path = page.path.display();
            match READERS.iter().find(|(word, ..)| word == info) {
                Some((_, _, read)) => {
                    if let Err(fault) = read(text) {
                        panic!("{path}, {info}:\n{}", fault.explained());
                    }
                }
                None => {
                    // what a walk types into a file is read by its commands
                    let is_toml =
                        info == "toml" || ["toml,file=", "toml,edit="].iter().any(|typed| info.starts_with(typed));
                    assert!(is_toml && text.parse::<Table>().is_ok(), "{path}, {info}:\n{text}");
                }
            }
        }
    }
}

#[test]
fn every_key_has_its_unit_range_and_default() {
    let mut wrong = Vec::new();
    for (word, path, read) in READERS {
        let page = Page::read(path);
        let shown = page.fences.iter().filter(|(info, _)| info == word).map(|(_, text)| text.clone());
        let listings: Vec<Table> = shown.chain(examples(word)).map(|text| text.parse().unwrap()).collect();
        for section in page.sections.iter().filter(|section| !section.rows.is_empty()) {
            if let Some(at) = Place::of(section) {
                let said = check(section, &at, &listings, read);
                wrong.extend(said.into_iter().map(|said| format!("{path}, {}: {said}", section.title)));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The complete machines and trains that the tool carries.
fn examples(word: &str) -> Vec<String> {
    let folder = match word {
        "toml,machine" => "machines",
        "toml,train" => "trains",
        _ => return Vec::new(),
    };
    let files = fs::read_dir(root().join("host-tests/command").join(folder)).unwrap();
    files.map(|file| fs::read_to_string(file.unwrap().path()).unwrap()).collect()
}

/// Where the keys of a section stand: the table's name in parts, and the kinds that have them.
struct Place {
    table: Vec<String>,
    kinds: Vec<String>,
}

impl Place {
    fn of(section: &Section) -> Option<Self> {
        if section.title == "The file itself" {
            return Some(Self { table: Vec::new(), kinds: Vec::new() });
        }
        let (heading, kinds) = section.code.split_first()?;
        let table = heading.strip_prefix('[')?.trim_matches(['[', ']']).split('.').map(str::to_owned).collect();
        Some(Self { table, kinds: kinds.to_vec() })
    }

    fn find<'t>(&self, file: &'t mut Table, kind: Option<&str>) -> Vec<&'t mut Table> {
        let mut tables: Vec<&mut Table> = vec![file];
        for part in &self.table {
            tables = tables
                .into_iter()
                .filter_map(|table| table.get_mut(part))
                .flat_map(|value| match value {
                    Value::Table(table) => vec![table],
                    Value::Array(list) => list.iter_mut().filter_map(Value::as_table_mut).collect(),
                    _ => Vec::new(),
                })
                .collect();
        }
        let of_kind =
            |table: &&mut Table| kind.is_none_or(|kind| table.get("kind").and_then(Value::as_str) == Some(kind));
        tables.into_iter().filter(of_kind).collect()
    }
}

/// What is wrong with a section's rows.
fn check(section: &Section, at: &Place, listings: &[Table], read: Reader) -> Vec<String> {
    let mut wrong = Vec::new();
    let kinds: Vec<Option<&str>> =
        if at.kinds.is_empty() { vec![None] } else { at.kinds.iter().map(|kind| Some(kind.as_str())).collect() };
    let mut keys: BTreeSet<String> = section.rows.iter().map(|row| row[0].trim_matches('`').to_owned()).collect();
    // said once for all elements and torques
    if !at.kinds.is_empty() {
        keys.insert("kind".to_owned());
    }
    if at.table == ["element"] && !at.kinds.is_empty() {
        keys.insert("label".to_owned());
    }
    // link, torque, friction, start and run are another page's
    let elsewhere: &[&str] = if at.table.is_empty() {
        &[
            "link",
            "torque",
            "friction",
            "start",
            "run",
            "element",
            "engine",
            "damper",
            "branch",
            "encoder",
            "control",
            "disturbance",
            "limits",
            "duty",
            "actuator",
            "speed_loop",
            "tolerance",
        ]
    } else {
        &[]
    };
    for kind in kinds {
        let places = |file: &Table| at.find(&mut file.clone(), kind).len();
        let shown: Vec<(&Table, usize)> =
            listings.iter().flat_map(|file| (0..places(file)).map(move |place| (file, place))).collect();
        if shown.is_empty() {
            wrong.push(format!("no listing shows it ({kind:?})"));
        }
        let mut known = BTreeSet::new();
        for (file, place) in shown {
            let edited = |edit: &dyn Fn(&mut Table)| {
                let mut file = file.clone();
                edit(at.find(&mut file, kind).remove(place));
                read(&toml::to_string(&file).expect("a table is TOML"))
            };
            let fault = edited(&|table| drop(table.insert("no_such_key".into(), Value::Integer(1)))).unwrap_err();
            known.extend(
                fault.expected.trim_start_matches("only ").split(", ").map(|key| key.trim_matches('`').to_owned()),
            );
            for row in &section.rows {
                let [key, unit, range, default, _] = row.as_slice() else {
                    wrong.push(format!("a row of {} columns", row.len()));
                    continue;
                };
                let key = key.trim_matches('`');
                let without = edited(&|table| drop(table.remove(key)));
                let required = without.as_ref().is_err_and(|fault| fault.found == "nothing");
                if (default == "required") != required && !default.starts_with("one of") && !default.contains("with") {
                    wrong.push(format!("`{key}` is {}required", if required { "" } else { "not " }));
                }
                if let Some(number) = number(default) {
                    let given = edited(&|table| drop(table.insert(key.into(), Value::Float(number))));
                    if told(&given).is_some_and(|given| told(&without).is_some_and(|without| given != without)) {
                        wrong.push(format!("`{key}` has another default than {default}"));
                    }
                }
                if let Some(expected) = phrase(unit, range) {
                    let fault = edited(&|table| drop(table.insert(key.into(), Value::Array(Vec::new()))));
                    match fault {
                        Err(fault) if fault.expected.ends_with(&expected) => {}
                        Err(fault) if fault.expected.starts_with("only ") => {} // not of this listing's form
                        other => wrong.push(format!("`{key}`: {other:?}, not {expected:?}")),
                    }
                }
            }
        }
        for key in known.difference(&keys).filter(|key| !elsewhere.contains(&key.as_str())) {
            wrong.push(format!("`{key}` is missing"));
        }
        for key in keys.difference(&known) {
            wrong.push(format!("`{key}` is unknown to the reader"));
        }
    }
    wrong
}

/// A default that is a number.
fn number(cell: &str) -> Option<f64> {
    cell.strip_prefix('`')?.strip_suffix('`')?.parse().ok()
}

/// What a file came to, where that can be compared: an unknown key is of another form of the table, and a fault that
/// is kept for later has lines that an edit moves.
fn told(read: &Result<String, Diagnostic>) -> Option<&str> {
    match read {
        Ok(text) => Some(text).filter(|text| !text.contains("Diagnostic(")).map(String::as_str),
        Err(fault) => Some(fault.expected.as_str()).filter(|expected| !expected.starts_with("only ")),
    }
}

/// The reader's phrase for a range, as `a number, 0.001 to 1 kg`; none for what is said in words.
fn phrase(unit: &str, range: &str) -> Option<String> {
    let (kind, numbers) = match range.strip_prefix("whole, ") {
        Some(numbers) => ("a whole number", numbers),
        None => ("a number", range.strip_prefix("list, ").unwrap_or(range)),
    };
    let (least, most) = numbers.trim_start_matches("zero or ").split_once(" to ")?;
    if least.parse::<f64>().is_err() || most.trim_start_matches("2^").parse::<f64>().is_err() {
        return None; // said in words
    }
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    Some(format!("{kind}, {numbers}{unit}"))
}
