//! A TOML table read key by key, so that every fault has its place and its key.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::diagnostic::Diagnostic;
use super::quantity::Quantity;
use super::source::{Source, printable};

/// Longest value that a message repeats, in characters.
const REPEATED: usize = 40;

/// A table being read: the keys requested so far, and its place.
pub struct Table<'a> {
    source: Source<'a>,
    table: &'a DeTable<'a>,
    /// Where a missing key is reported.
    place: Range<usize>,
    /// Path of the table, as `element[2]`; empty for the file itself.
    path: String,
    asked: Vec<&'static str>,
}

impl<'a> Table<'a> {
    /// The file's outermost table.
    pub fn root(source: Source<'a>, table: &'a DeTable<'a>) -> Self {
        Self { source, table, place: 0..0, path: String::new(), asked: Vec::new() }
    }

    /// Its place in the file.
    pub fn place(&self) -> Range<usize> {
        self.place.clone()
    }

    fn name(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    fn find(&self, key: &str) -> Option<Item<'a>> {
        let (_, value) = self.table.iter().find(|(name, _)| name.get_ref() == key)?;
        Some(Item { source: self.source, path: self.name(key), value })
    }

    fn get(&mut self, key: &'static str) -> Option<Item<'a>> {
        self.asked.push(key);
        self.find(key)
    }

    fn missing(&self, key: &str, expected: impl std::fmt::Display) -> Diagnostic {
        Diagnostic::at(self.source, self.place.clone(), self.name(key), "nothing", format!("`{key}`: {expected}"))
    }

    /// The diagnostic for a key's value that is not what was expected.
    pub fn wrong(&self, key: &str, expected: impl Into<String>) -> Diagnostic {
        match self.find(key) {
            Some(item) => item.wrong(expected),
            None => self.missing(key, expected.into()),
        }
    }

    /// A number that must be there.
    pub fn number(&mut self, key: &'static str, quantity: Quantity) -> Result<f64, Diagnostic> {
        self.number_if(key, quantity)?.ok_or_else(|| self.missing(key, quantity))
    }

    /// A number with a default where the key is missing.
    pub fn number_or(&mut self, key: &'static str, quantity: Quantity, default: f64) -> Result<f64, Diagnostic> {
        Ok(self.number_if(key, quantity)?.unwrap_or(default))
    }

    /// A number that may be left out.
    pub fn number_if(&mut self, key: &'static str, quantity: Quantity) -> Result<Option<f64>, Diagnostic> {
        self.get(key).map(|item| item.number(quantity)).transpose()
    }

    /// A number, or a list of two, where the key is there.
    pub fn number_or_pair(
        &mut self,
        key: &'static str,
        expected: &str,
    ) -> Result<Option<(f64, Option<f64>)>, Diagnostic> {
        let Some(item) = self.get(key) else { return Ok(None) };
        let one = |value: &DeValue<'_>| number(value).filter(|number| number.is_finite());
        let pair = item.value.get_ref().as_array().filter(|list| list.len() == 2);
        let read = match pair {
            Some(list) => one(list[0].get_ref()).zip(one(list[1].get_ref())).map(|(low, high)| (low, Some(high))),
            None => one(item.value.get_ref()).map(|number| (number, None)),
        };
        read.map(Some).ok_or_else(|| item.wrong(expected))
    }

    /// A table that may be left out.
    pub fn table_if(&mut self, key: &'static str) -> Result<Option<Table<'a>>, Diagnostic> {
        self.get(key).map(|item| item.table(&format!("a table [{key}]"))).transpose()
    }

    /// A list of tables that may be left out.
    pub fn tables_if(&mut self, key: &'static str, of: &str) -> Result<Vec<(Range<usize>, Table<'a>)>, Diagnostic> {
        if self.has(key) { self.tables_of(key, of) } else { Ok(Vec::new()) }
    }

    /// A text that must be there.
    pub fn text(&mut self, key: &'static str, expected: &str) -> Result<&'a str, Diagnostic> {
        self.text_if(key, expected)?.ok_or_else(|| self.missing(key, expected))
    }

    /// A text that may be left out.
    pub fn text_if(&mut self, key: &'static str, expected: &str) -> Result<Option<&'a str>, Diagnostic> {
        self.get(key).map(|item| item.text(expected)).transpose()
    }

    /// A table that must be there.
    pub fn table(&mut self, key: &'static str) -> Result<Table<'a>, Diagnostic> {
        self.table_if(key)?.ok_or_else(|| self.missing(key, format!("a table [{key}]")))
    }

    /// A list of tables that must be there: each with the span of its heading.
    pub fn tables(&mut self, key: &'static str) -> Result<Vec<(Range<usize>, Table<'a>)>, Diagnostic> {
        self.tables_of(key, "part of the machine, the motor first")
    }

    /// A list of tables that must be there, one for each of something.
    pub fn tables_of(&mut self, key: &'static str, of: &str) -> Result<Vec<(Range<usize>, Table<'a>)>, Diagnostic> {
        let expected = format!("one table [[{key}]] for each {of}");
        let placed = |table: Table<'a>| (table.place(), table);
        self.filled(key, &expected)?.into_iter().map(|item| item.table(&expected).map(placed)).collect()
    }

    /// Whether a key is there; it counts as requested.
    pub fn has(&mut self, key: &'static str) -> bool {
        self.get(key).is_some()
    }

    /// A key that is there leaves no place for others, which say the same in another way.
    pub fn instead_of(&self, key: &str, others: &[&str]) -> Result<(), Diagnostic> {
        let there = |(name, value): (&Spanned<DeString<'_>>, &Spanned<DeValue<'_>>)| {
            let other = others.iter().find(|other| name.get_ref() == **other)?;
            let found = format!("`{key}` beside it");
            Some(Diagnostic::at(self.source, value.span(), self.name(other), found, "only one of the two"))
        };
        self.table.iter().find_map(there).map_or(Ok(()), Err)
    }

    /// Lets keys stand that somebody else reads.
    pub fn pass(&mut self, keys: &[&'static str]) {
        self.asked.extend(keys);
    }

    /// A truth with a default where the key is missing.
    pub fn flag_or(&mut self, key: &'static str, default: bool) -> Result<bool, Diagnostic> {
        let Some(item) = self.get(key) else { return Ok(default) };
        item.value.get_ref().as_bool().ok_or_else(|| item.wrong("true or false"))
    }

    /// A list of exactly `count` texts.
    pub fn texts(&mut self, key: &'static str, count: usize, expected: &str) -> Result<Vec<&'a str>, Diagnostic> {
        let items = self.items(key, expected)?;
        let texts: Option<Vec<_>> = items.iter().map(|item| item.value.get_ref().as_str()).collect();
        texts.filter(|texts| texts.len() == count).ok_or_else(|| self.wrong(key, expected))
    }

    /// A list of rows of `width` numbers each.
    ///
    /// # Errors
    /// Missing, empty, or a row that is not of so many finite numbers: placed at that row.
    pub fn rows(&mut self, key: &'static str, width: usize, expected: &str) -> Result<Vec<Vec<f64>>, Diagnostic> {
        let read = |item: Item<'a>| {
            let row = item.value.get_ref().as_array().filter(|row| row.len() == width);
            let numbers: Option<Vec<f64>> =
                row.and_then(|row| row.iter().map(|v| number(v.get_ref()).filter(|n| n.is_finite())).collect());
            numbers.ok_or_else(|| item.wrong(expected))
        };
        self.filled(key, expected)?.into_iter().map(read).collect()
    }

    /// Two numbers.
    pub fn pair(&mut self, key: &'static str, quantity: Quantity) -> Result<[f64; 2], Diagnostic> {
        let numbers = self.numbers(key, quantity)?;
        numbers.try_into().map_err(|_| self.wrong(key, format!("two numbers, each {quantity}")))
    }

    /// A list of numbers, each of a quantity.
    ///
    /// # Errors
    /// Missing, empty, or a number that is not of the quantity's range: placed at that number.
    pub fn numbers(&mut self, key: &'static str, quantity: Quantity) -> Result<Vec<f64>, Diagnostic> {
        let items = self.filled(key, &format!("a list of numbers, each {quantity}"))?;
        items.iter().map(|item| item.number(quantity)).collect()
    }

    /// A table of numbers, each under a name that `known` finds the place of.
    ///
    /// # Errors
    /// Missing, empty, not a table, a name that is not known, or a number out of range: placed at it.
    pub fn shares(
        &mut self,
        key: &'static str,
        quantity: Quantity,
        expected: &str,
        known: impl Fn(&str) -> Option<usize>,
    ) -> Result<Vec<(usize, f64)>, Diagnostic> {
        let Some(shares) = self.get(key) else { return Err(self.missing(key, expected)) };
        let table = shares.value.get_ref().as_table().filter(|table| !table.is_empty());
        let read = |(name, value): (&Spanned<DeString<'a>>, &'a Spanned<DeValue<'a>>)| {
            let path = format!("{}.{}", shares.path, printable(name.get_ref(), REPEATED));
            let Some(at) = known(name.get_ref()) else {
                return Err(Diagnostic::at(self.source, name.span(), path, "an unknown name", expected));
            };
            let share = number(value.get_ref()).filter(|&n| quantity.allows(n) && n != 0.0);
            let item = Item { source: self.source, path, value };
            share.map(|share| (at, share)).ok_or_else(|| item.wrong(format!("{quantity}, not zero")))
        };
        table.ok_or_else(|| shares.wrong(expected))?.iter().map(read).collect()
    }

    /// A list of values that must be there, each with its place.
    pub fn items(&mut self, key: &'static str, expected: &str) -> Result<Vec<Item<'a>>, Diagnostic> {
        let Some(Item { source, path, value }) = self.get(key) else { return Err(self.missing(key, expected)) };
        let list = value.get_ref().as_array().ok_or_else(|| self.wrong(key, expected))?;
        let item = |(index, value)| Item { source, path: format!("{path}[{index}]"), value };
        Ok(list.iter().enumerate().map(item).collect())
    }

    /// The same, of one value at least.
    fn filled(&mut self, key: &'static str, expected: &str) -> Result<Vec<Item<'a>>, Diagnostic> {
        let items = self.items(key, expected)?;
        if items.is_empty() { Err(self.wrong(key, expected)) } else { Ok(items) }
    }

    /// A list of tables that may be left out.
    pub fn optional_tables(&mut self, key: &'static str) -> Result<Vec<Table<'a>>, Diagnostic> {
        let expected = format!("tables [[{key}]]");
        let items = if self.has(key) { self.items(key, &expected)? } else { Vec::new() };
        items.into_iter().map(|item| item.table(&expected)).collect()
    }

    /// Ends the reading: an unknown key is a fault.
    pub fn finish(self) -> Result<(), Diagnostic> {
        let unknown = |name: &&Spanned<DeString<'_>>| !self.asked.contains(&name.get_ref().as_ref());
        let Some(first) = self.table.keys().filter(unknown).min_by_key(|name| name.span().start) else {
            return Ok(());
        };
        let key = printable(first.get_ref(), REPEATED);
        // a key may have been requested more than once
        let mut known: Vec<String> = Vec::new();
        for key in self.asked.iter().map(|key| format!("`{key}`")) {
            if !known.contains(&key) {
                known.push(key);
            }
        }
        // TOML takes what follows a heading for a key of its table
        let stray =
            if key == "name" && !self.path.is_empty() { "; the file's own `name` is its first line" } else { "" };
        let expected = format!("only {}{stray}", known.join(", "));
        Err(Diagnostic::at(self.source, first.span(), self.name(&key), "an unknown key", expected))
    }
}

/// A value of a list, and where it stands.
pub struct Item<'a> {
    source: Source<'a>,
    path: String,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Item<'a> {
    /// The diagnostic for a value that is not what was expected.
    pub fn wrong(&self, expected: impl Into<String>) -> Diagnostic {
        Diagnostic::at(self.source, self.value.span(), self.path.clone(), describe(self.value.get_ref()), expected)
    }

    /// The value as a number.
    pub fn number(&self, quantity: Quantity) -> Result<f64, Diagnostic> {
        number(self.value.get_ref())
            .filter(|&number| quantity.allows(number))
            .ok_or_else(|| self.wrong(quantity.to_string()))
    }

    /// The value as a table.
    fn table(self, expected: &str) -> Result<Table<'a>, Diagnostic> {
        let table = self.value.get_ref().as_table().ok_or_else(|| self.wrong(expected))?;
        Ok(Table { source: self.source, table, place: self.value.span(), path: self.path, asked: Vec::new() })
    }

    /// The value as a text.
    pub fn text(&self, expected: &str) -> Result<&'a str, Diagnostic> {
        self.value.get_ref().as_str().ok_or_else(|| self.wrong(expected))
    }

    /// The value as a pair of numbers.
    pub fn pair(&self, first: Quantity, second: Quantity, expected: &str) -> Result<(f64, f64), Diagnostic> {
        let list =
            self.value.get_ref().as_array().filter(|list| list.len() == 2).ok_or_else(|| self.wrong(expected))?;
        let at = |index: usize, quantity: Quantity| {
            let value = &list[index];
            Item { source: self.source, path: format!("{}[{index}]", self.path), value }.number(quantity)
        };
        Ok((at(0, first)?, at(1, second)?))
    }
}

/// A TOML integer or float as `f64`; out of range is infinite.
fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Integer(integer) => {
            Some(i128::from_str_radix(integer.as_str(), integer.radix()).map_or(f64::INFINITY, |whole| whole as f64))
        }
        _ => None,
    }
}

/// A value in the words of a message.
fn describe(value: &DeValue<'_>) -> String {
    match value {
        DeValue::Integer(integer) => printable(&integer.to_string(), REPEATED),
        DeValue::Float(float) => printable(float.as_str(), REPEATED),
        DeValue::String(text) => format!("the text \"{}\"", printable(text, REPEATED)),
        DeValue::Boolean(truth) => truth.to_string(),
        DeValue::Datetime(date) => format!("the date {date}"),
        DeValue::Array(list) if list.is_empty() => "an empty list".to_owned(),
        DeValue::Array(_) => "a list".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
