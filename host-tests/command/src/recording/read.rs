//! From a CSV file to the signals of a recording.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::angle::counted;
use super::column::{Column, Quantity, Unusable};
use super::decimal::{self, Commas, number};
use crate::machine_file::{Diagnostic, Source, printable};

/// Largest recording in bytes.
const LARGEST: u64 = 1 << 30;
/// Columns that a message lists, and characters of a heading in it.
const MOST_NAMES: usize = 20;
const LONGEST_NAME: usize = 60;
/// Remedy of a heading that two columns have.
const ONCE: &str = "each heading once; rename one of them";
/// Largest value in SI units, whose powers have room in a number.
const HIGHEST: f64 = 1e100;

/// What the user says of a recording beside its file.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Samples a second, where there is no column of time.
    pub rate: Option<f64>,
    /// Torque per current (N m/A).
    pub torque_constant: Option<f64>,
    /// Counts on a turn of the encoder.
    pub counts: Option<f64>,
    /// Columns by name: `quantity=heading` or `quantity=heading:unit`.
    pub columns: Vec<String>,
    /// The part that is used (s).
    pub window: [Option<f64>; 2],
    /// Rows come when something happens, not at a rate.
    pub uneven: bool,
}

/// Signals of a machine, sampled together.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Name of the file as the user typed it.
    pub name: String,
    /// Time between samples (s); none in a table of a frequency response.
    pub period: f64,
    /// The columns that are used.
    pub columns: Vec<Column>,
    /// Headings of those that are not.
    pub unused: Vec<String>,
    /// The line of the file that each row stands on.
    pub lines: Vec<u64>,
    signals: Vec<Vec<f64>>,
}

impl Recording {
    /// A signal in SI units.
    pub fn signal(&self, quantity: Quantity) -> Option<&[f64]> {
        let index = self.columns.iter().position(|column| column.quantity == quantity)?;
        self.signals.get(index).map(Vec::as_slice)
    }

    /// Samples.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// The torque of the motor, by its column or from the current.
    ///
    /// # Errors
    /// A sentence: neither is there, or nobody says what torque a current makes.
    pub fn torque(&self, constant: Option<f64>) -> Result<Vec<f64>, Diagnostic> {
        if let Some(torque) = self.signal(Quantity::Torque) {
            if constant.is_some() {
                let found = "--torque-constant beside a column of the torque";
                return Err(self.fault(found, "one of the two; --column torque=HEADING names the column"));
            }
            return Ok(torque.to_vec());
        }
        match (self.signal(Quantity::Current), constant) {
            (Some(current), Some(constant)) => Ok(current.iter().map(|current| constant * current).collect()),
            (Some(_), None) => {
                Err(self.fault("a current without the torque that it makes", "--torque-constant [N m/A]"))
            }
            (None, _) => {
                let expected = "a column of the motor's torque, such as `torque_Nm`, or of its current; --column \
                                torque=HEADING names another";
                Err(self.fault(self.found(), expected))
            }
        }
    }

    /// The columns in words.
    pub fn found(&self) -> String {
        let names = self.columns.iter().map(Column::to_string);
        let unused = self.unused.iter().map(|name| format!("`{}` (unknown)", printable(name, LONGEST_NAME)));
        let mut names: Vec<String> = names.chain(unused).collect();
        let more = names.len().saturating_sub(MOST_NAMES);
        names.truncate(MOST_NAMES);
        names.extend((more > 0).then(|| format!("{more} more")));
        format!("the columns {}", names.join(", "))
    }

    /// The rows at which a level has risen, or fallen, through the middle of its range, with how long before the row
    /// that was, as a part of the step: 0 where the level has two values only, as in a log of its changes. `None`
    /// without such a column.
    ///
    /// Of the level of teeth one sample of 500 at either end is left out of its range, for a spike. Beyond the middle
    /// on either side a level must come to a quarter of its swing there before, and to a hundredth of its range: the
    /// swing of a magnetic pickup grows with the speed. Where edges stay away, the swing before counts half as much
    /// after each time of eight edges.
    pub fn edges(&self, quantity: Quantity, falling: bool) -> Option<Vec<(usize, f64)>> {
        let level = self.signal(quantity)?;
        let sign = if falling { -1.0 } else { 1.0 };
        let mut sorted = level.to_vec();
        sorted.sort_by(f64::total_cmp);
        // teeth are at either level for much of the time, so that a few samples beyond are faults; a mark may be one
        let beyond = if quantity == Quantity::Teeth { sorted.len() / 500 } else { 0 };
        let least = sorted.get(beyond).copied().unwrap_or(f64::INFINITY);
        let most = sorted.iter().rev().nth(beyond).copied().unwrap_or(f64::NEG_INFINITY);
        let (middle, range) = (least + 0.5 * (most - least), most - least);
        let is_digital = level.iter().all(|value| *value == least || *value == most);
        let height = |row: usize| sign * (level[row] - middle);
        // of the halves below and above the middle: the largest distance from it in the last one and in the present one
        let (mut swing, mut now) = ([0.0_f64; 2], [0.0_f64; 2]);
        let (mut is_armed, mut crossed, mut edges) = (false, None, Vec::new());
        let (mut last, mut interval) = (0, level.len());
        for row in 0..level.len() {
            let at = height(row);
            if at > 0.0 && row > 0 && height(row - 1) <= 0.0 {
                crossed = Some((row, if is_digital { 0.0 } else { at / (at - height(row - 1)) }));
            }
            if row - last > 8 * interval {
                swing = swing.map(|swing| 0.5 * swing);
                last = row;
            }
            let side = usize::from(at > 0.0);
            now[side] = now[side].max(at.abs());
            let is_far = at.abs() > (0.25 * swing[side]).max(0.01 * range);
            if is_far && side == 0 && !is_armed {
                is_armed = true;
                swing[1] = now[1];
                now = [at.abs(), 0.0];
            }
            if is_far && side == 1 && is_armed {
                edges.extend(crossed);
                is_armed = false;
                swing[0] = now[0];
                now[1] = at;
                (interval, last) = (row - last, row);
            }
        }
        Some(edges)
    }

    /// A fault of the recording as a whole.
    pub fn fault(&self, found: impl Into<String>, expected: impl Into<String>) -> Diagnostic {
        Diagnostic::of_file(&self.name, found, expected)
    }
}

/// Reads a recording.
///
/// # Errors
/// The place, what is wrong there and what was expected: no text, a heading without a unit, a value that is no finite
/// number, a row with other columns, a time that does not rise or leaves a gap.
pub fn read_recording(path: &Path, asked: &Asked) -> Result<Recording, Diagnostic> {
    let name = printable(&path.display().to_string(), 200);
    let file = |error: std::io::Error| Diagnostic::of_file(&name, format!("no readable file ({error})"), "a CSV file");
    let (mut bytes, mut opened) = (Vec::new(), File::open(path).map_err(file)?.take(LARGEST + 1));
    let too_long = || Diagnostic::of_file(&name, "more than 1 GiB", "at most 1 GiB: a part of the recording");
    if opened.get_ref().metadata().map_err(file)?.len() > LARGEST {
        return Err(too_long());
    }
    // what is no recording is refused by its first lines, before the rest is read: it may have no end
    opened.by_ref().take(BEGINNING).read_to_end(&mut bytes).map_err(file)?;
    if bytes.iter().take(LEADING).any(|byte| *byte == 0) {
        return Err(encoded(&name, &bytes, 0, "UTF-16"));
    }
    let is_whole = (bytes.len() as u64) < BEGINNING;
    if let (false, Ok(text)) = (is_whole, std::str::from_utf8(whole_lines(&bytes))) {
        if text.is_empty() {
            let expected = "a first line that names each column by quantity and unit";
            return Err(Diagnostic::of_file(&name, "a line of more than 1 MiB", expected));
        }
        Head::of(Source { name: &name, text }, asked)?;
    }
    opened.read_to_end(&mut bytes).map_err(file)?;
    if bytes.len() as u64 > LARGEST {
        return Err(too_long());
    }
    match String::from_utf8(bytes) {
        Ok(text) => parse(&name, &text, asked),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            let bytes = error.into_bytes();
            Err(encoded(&name, &bytes, at, "ISO-8859-1"))
        }
    }
}

/// Bytes by which a file is known to be no recording.
const BEGINNING: u64 = 1 << 20;

fn whole_lines(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1)]
}

/// Bytes among which a text of two bytes a letter shows.
const LEADING: usize = 64;

/// A file in another encoding: the place where that shows, and how to convert it.
fn encoded(name: &str, bytes: &[u8], at: usize, encoding: &str) -> Diagnostic {
    let text = String::from_utf8_lossy(bytes);
    // up to the first bad byte the lossy text is the same as the bytes
    let source = Source { name, text: &text };
    let found = match encoding {
        "UTF-16" => "a text of two bytes a letter".to_owned(),
        _ => format!("the byte 0x{:02x}, which is not UTF-8", bytes[at]),
    };
    let expected = format!("a CSV file in UTF-8, as `iconv -f {encoding} -t UTF-8` makes it of {encoding}");
    let end = text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
    Diagnostic::at(source, at..end, "", found, expected)
}

/// A row's place in the text and its line.
fn row(source: Source<'_>, position: Option<&csv::Position>, column: usize, delimiter: char) -> std::ops::Range<usize> {
    let begin = position.map_or(0, |position| position.byte() as usize).min(source.text.len());
    // the reader's position is before the line ends and comments that it skips
    let mut start = begin;
    for line in source.text[begin..].split_inclusive('\n') {
        if !line.trim().is_empty() && !line.starts_with('#') {
            break;
        }
        start += line.len();
    }
    let line = source.text[start..].lines().next().unwrap_or_default();
    let mut at = start;
    for (index, field) in line.split(delimiter).enumerate() {
        if index == column {
            return at..at + field.len();
        }
        at += field.len() + delimiter.len_utf8();
    }
    start..start + line.len()
}

/// The first line of a table and what its columns are.
struct Head<'a> {
    reader: csv::Reader<&'a [u8]>,
    delimiter: char,
    headings: csv::StringRecord,
    columns: Vec<Column>,
    unused: Vec<String>,
}

impl<'a> Head<'a> {
    fn of(source: Source<'a>, asked: &Asked) -> Result<Self, Diagnostic> {
        let Source { name, text } = source;
        let head = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
        let delimiter = [';', '\t', ','].into_iter().find(|c| head.contains(*c)).unwrap_or(',');
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter as u8)
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .flexible(true)
            .from_reader(text.as_bytes());
        let broken = |error: csv::Error| Diagnostic::of_file(name, error.to_string(), "a table in CSV");
        let headings = reader.headers().map_err(broken)?.clone();
        let place = row(source, headings.position(), usize::MAX, delimiter);
        if headings.iter().all(|heading| number(heading, delimiter, &mut None).is_some()) {
            let expected =
                "a first line that names each column by quantity and unit, such as `time_s,torque_Nm,speed_rpm`";
            return Err(Diagnostic::at(source, place, "", "no headings", expected));
        }
        let (columns, unused) = columns(source, &headings, asked, delimiter)?;
        Ok(Self { reader, delimiter, headings, columns, unused })
    }
}

/// Reads a recording from a text.
///
/// # Errors
/// As [`read_recording`].
pub fn parse(name: &str, text: &str, asked: &Asked) -> Result<Recording, Diagnostic> {
    let source = Source { name, text };
    let Head { mut reader, delimiter, headings, columns, unused } = Head::of(source, asked)?;
    let broken = |error: csv::Error| Diagnostic::of_file(name, error.to_string(), "a table in CSV");
    let mut signals = vec![Vec::new(); columns.len()];
    let (mut lines, mut sign) = (Vec::new(), None);
    let mut commas: Vec<Commas> = columns.iter().map(|_| Commas::default()).collect();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let at = |column: usize| row(source, record.position(), column, delimiter);
        if record.len() != headings.len() {
            let (found, expected) = (record.len(), headings.len());
            let expected = format!("{expected}, as in the first line");
            return Err(Diagnostic::at(source, at(usize::MAX), "", format!("{found} columns"), expected));
        }
        // the times of the teeth are a column of their own length
        let is_tooth = |column: &Column| column.quantity == Quantity::ToothTime;
        let has = |tooth| columns.iter().any(|of| is_tooth(of) == tooth && !record[of.index].is_empty());
        let has_row = !has(true) || has(false);
        for ((column, signal), commas) in columns.iter().zip(&mut signals).zip(&mut commas) {
            let field = &record[column.index];
            if field.is_empty() && (is_tooth(column) || !has_row) {
                continue;
            }
            let number = number(field, delimiter, &mut sign).map(|raw| column.value(raw));
            let key = printable(&column.heading, 40);
            let Some(number) = number.filter(|value| value.is_finite()) else {
                let found = if field.is_empty() { "nothing".to_owned() } else { format!("`{}`", printable(field, 40)) };
                let expected = decimal::expected(field, sign);
                return Err(Diagnostic::at(source, at(column.index), key, found, expected));
            };
            if number.abs() > HIGHEST {
                let found = format!("`{}`", printable(field, 40));
                let expected = format!("at most {HIGHEST:e} in SI units; check the unit of the column");
                return Err(Diagnostic::at(source, at(column.index), key, found, expected));
            }
            commas.take(field, || at(column.index));
            signal.push(number);
        }
        if has_row {
            lines.push(record.position().map_or(0, csv::Position::line));
        }
    }
    for (column, commas) in columns.iter().zip(commas) {
        if let Some(place) = commas.doubtful() {
            let found = format!("`{}` beside whole numbers without a comma", &text[place.clone()]);
            let expected = "no comma between thousands; a decimal comma with more digits, or fewer";
            return Err(Diagnostic::at(source, place, printable(&column.heading, 40), found, expected));
        }
    }
    let mut recording = Recording { name: name.to_owned(), period: f64::NAN, columns, unused, lines, signals };
    if recording.signal(Quantity::Frequency).is_none() {
        cut(&mut recording, asked);
        for (column, signal) in recording.columns.iter().zip(&mut recording.signals) {
            if matches!(column.quantity, Quantity::Angle | Quantity::LoadAngle)
                && let Some(counted) = counted(signal)
            {
                *signal = counted;
            }
        }
        let teeth = recording.signal(Quantity::ToothTime).unwrap_or_default();
        if let Some(pair) = teeth.windows(2).find(|pair| pair[1] < pair[0]) {
            let found = format!("a time of a tooth that falls, {} s after {} s", pair[1], pair[0]);
            return Err(recording.fault(found, "the teeth in the order of their times"));
        }
        recording.period = if asked.uneven { rising(&recording, asked)? } else { period(&recording, asked)? };
    }
    Ok(recording)
}

/// The columns by the user's word, and the others by their headings.
fn columns(
    source: Source<'_>,
    headings: &csv::StringRecord,
    asked: &Asked,
    delimiter: char,
) -> Result<(Vec<Column>, Vec<String>), Diagnostic> {
    let place = |index: usize| row(source, headings.position(), index, delimiter);
    let (mut columns, mut unused): (Vec<Column>, Vec<String>) = (Vec::new(), Vec::new());
    let is_twice = |heading: &str| headings.iter().filter(|other| *other == heading).count() > 1;
    let twice = |heading: &str| format!("the heading `{}` twice", printable(heading, LONGEST_NAME));
    let mut named = Vec::new();
    for word in &asked.columns {
        let fault = |expected: String| Diagnostic::of_file(source.name, format!("--column {word}"), expected);
        let Some((quantity, heading)) = word.split_once('=') else {
            return Err(fault("QUANTITY=HEADING or QUANTITY=HEADING:UNIT".to_owned()));
        };
        let Some(quantity) = Quantity::named(quantity) else {
            return Err(fault("a quantity such as `torque`, `speed`, `angle` or `load-angle`".to_owned()));
        };
        let find = |heading: &str| headings.iter().position(|other| other == heading);
        let whole = find(heading).map(|index| (index, None));
        let parted = || heading.rsplit_once(':').and_then(|(heading, unit)| Some((find(heading)?, Some(unit))));
        let Some((index, unit)) = whole.or_else(parted) else {
            let names: Vec<String> = headings.iter().map(|name| format!("`{name}`")).collect();
            return Err(fault(format!("one of the headings {}", names.join(", "))));
        };
        if is_twice(&headings[index]) {
            return Err(Diagnostic::at(source, place(index), "", twice(&headings[index]), ONCE));
        }
        named.push((index, quantity, unit));
    }
    for (index, heading) in headings.iter().enumerate() {
        let said = named.iter().find(|(named, ..)| *named == index).map(|(_, quantity, unit)| (*quantity, *unit));
        match Column::of(index, heading, said, asked.counts) {
            Ok(column) => {
                let by_name = |column: &Column| named.iter().any(|(index, ..)| *index == column.index);
                let other = columns.iter().position(|other| other.quantity == column.quantity);
                match other.map(|at| (at, by_name(&columns[at]), by_name(&column))) {
                    None => columns.push(column),
                    Some((_, true, false)) => unused.push(column.heading),
                    Some((at, false, true)) => {
                        let other = std::mem::replace(&mut columns[at], column);
                        unused.push(other.heading);
                    }
                    Some((at, ..)) if columns[at].heading == heading => {
                        return Err(Diagnostic::at(source, place(index), "", twice(heading), ONCE));
                    }
                    Some((at, ..)) => {
                        let found = format!("a second column of {}, beside {}", column.quantity.name(), columns[at]);
                        let expected = format!("one; --column {}=HEADING names it", column.quantity.name());
                        return Err(Diagnostic::at(source, place(index), heading, found, expected));
                    }
                }
            }
            Err(Unusable::Unknown) => unused.push(heading.to_owned()),
            Err(Unusable::Fault(found, expected)) => {
                return Err(Diagnostic::at(source, place(index), "", found, expected));
            }
        }
    }
    let timed = columns.iter().find(|column| matches!(column.quantity, Quantity::Time | Quantity::Frequency));
    // times of teeth alone are on no clock of rows
    let teeth = columns.first().filter(|_| columns.iter().all(|column| column.quantity == Quantity::ToothTime));
    let timed = timed.or(teeth);
    if let Some(column) = timed.filter(|_| asked.rate.is_some()) {
        let found = format!("--rate beside a column of {}", column.quantity.name());
        let expected = "no --rate, which is for recordings without such a column";
        return Err(Diagnostic::at(source, place(column.index), printable(&column.heading, 40), found, expected));
    }
    if asked.counts.is_some() && !columns.iter().any(|column| column.counted) {
        let expected = "a column in counts, such as `angle_counts`; an angle in another unit needs no counts";
        return Err(Diagnostic::of_file(source.name, "--counts without a column in counts".to_owned(), expected));
    }
    Ok((columns, unused))
}

/// No time between samples, but times that do not fall: two edges may have one time, rounded. Without a column of time
/// the samples come at the rate.
fn rising(recording: &Recording, asked: &Asked) -> Result<f64, Diagnostic> {
    let Some(time) = recording.signal(Quantity::Time) else {
        let has_own = recording.signal(Quantity::ToothTime).is_some();
        return if has_own { Ok(f64::NAN) } else { period(recording, asked) };
    };
    match time.windows(2).position(|pair| !(pair[1] >= pair[0])) {
        Some(at) => {
            let found = format!("a time that falls, at line {}", recording.lines[at + 1]);
            Err(recording.fault(found, "rows in the order of their times"))
        }
        None => Ok(f64::NAN),
    }
}

/// The time between samples: by the column of time, which must be even, or by the rate.
fn period(recording: &Recording, asked: &Asked) -> Result<f64, Diagnostic> {
    let Some(time) = recording.signal(Quantity::Time) else {
        return match asked.rate {
            Some(rate) => Ok(1.0 / rate),
            None => {
                let has = |quantity| recording.signal(quantity).is_some();
                let lacks = has(Quantity::Current) && !has(Quantity::Torque) && asked.torque_constant.is_none();
                let constant = if lacks { ", and --torque-constant [N m/A] for the current" } else { "" };
                let expected = format!("a column of time, such as `time_s`, or --rate [samples/s]{constant}");
                Err(recording.fault(recording.found(), expected))
            }
        };
    };
    let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(&usual) = sorted.get(sorted.len() / 2) else {
        return Err(recording.fault("fewer than two rows", "a recording"));
    };
    for (step, line) in steps.iter().zip(recording.lines.iter().skip(1)) {
        if !(*step > 0.0) {
            let found = format!("a time that does not rise, at line {line}");
            return Err(recording.fault(found, "rows in the order of their times"));
        }
        if *step > 1.5 * usual {
            let found = format!("a gap of {step:.3e} s at line {line}, after steps of {usual:.3e} s");
            return Err(recording.fault(found, "even steps of time; --from and --to cut out a part without gaps"));
        }
    }
    let mean = (time[time.len() - 1] - time[0]) / steps.len() as f64;
    let uneven = (steps.iter().map(|step| (step - mean) * (step - mean)).sum::<f64>() / steps.len() as f64).sqrt();
    // a column rounded to the step has a third of it
    if uneven > 0.35 * mean {
        let found = format!("steps of time that spread by {:.0} %", 100.0 * uneven / mean);
        return Err(recording.fault(found, "samples at an even rate"));
    }
    Ok(mean)
}

/// Keeps the part between two times from the first row.
fn cut(recording: &mut Recording, asked: &Asked) {
    let count = recording.lines.len();
    let index = |time: f64| match (recording.signal(Quantity::Time), asked.rate) {
        (Some(times), _) => times.iter().position(|at| at - times[0] >= time - 1e-9).unwrap_or(count),
        (None, rate) => (time * rate.unwrap_or(0.0)).round().max(0.0) as usize,
    };
    let end = asked.window[1].map_or(count, index).min(count);
    let begin = asked.window[0].map_or(0, index).min(end);
    recording.lines = recording.lines[begin..end].to_vec();
    let first = recording.signal(Quantity::Time).or(recording.signal(Quantity::ToothTime));
    let first = first.and_then(|times| times.first().copied()).unwrap_or(0.0);
    let [from, to] = [asked.window[0].unwrap_or(f64::NEG_INFINITY), asked.window[1].unwrap_or(f64::INFINITY)];
    for (column, signal) in recording.columns.iter().zip(&mut recording.signals) {
        if column.quantity == Quantity::ToothTime {
            signal.retain(|time| (from..to).contains(&(time - first)));
        } else {
            *signal = signal[begin..end].to_vec();
        }
    }
}
