//! Values of a table: numbers, names, one of some words, and a plane by its name.

use crate::machine_file::{Diagnostic, Quantity, Table};

/// Range of a limit or of a weight for a hole.
pub(super) const ABOVE_ZERO: Quantity = Quantity { zero: false, ..Quantity::WEIGHT };

const NAMES: &str = "a list of names";

/// Numbers, none or as many as there must be.
pub(super) fn list(
    table: &mut Table<'_>,
    key: &'static str,
    count: usize,
    quantity: Quantity,
) -> Result<Vec<f64>, Diagnostic> {
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
pub(super) fn names(table: &mut Table<'_>, key: &'static str, most: usize) -> Result<Vec<String>, Diagnostic> {
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
pub(super) fn choice<T: Copy>(table: &mut Table<'_>, key: &'static str, words: &[(&str, T)]) -> Result<T, Diagnostic> {
    let expected = words.iter().map(|(word, _)| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ");
    let Some(word) = table.text_if(key, &expected)? else { return Ok(words[0].1) };
    match words.iter().find(|(known, _)| *known == word) {
        Some((_, value)) => Ok(*value),
        None => Err(table.wrong(key, expected)),
    }
}

/// A plane by its name.
pub(super) fn plane(table: &mut Table<'_>, planes: &[String]) -> Result<usize, Diagnostic> {
    let expected = planes.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ");
    let name = table.text("plane", &expected)?;
    planes.iter().position(|known| known == name).ok_or_else(|| table.wrong("plane", expected))
}
