//! Search for the values of a machine file that make a figure least over the drawn machines.
//!
//! Each point is a campaign of the same draws, so that two points differ by their values alone. The points of a grid
//! over all ranges come first; from the best one a compass search [Kolda, Lewis and Torczon 2003] halves its steps
//! down to a five-hundredth of the ranges. Ranges are spaced by ratio.

use serde::Serialize;
use toml::de::{DeTable, DeValue};

use super::figure::{Figure, Outcome};
use super::statistics::quantile;

/// Share of the machines whose figure counts: the worst of them.
pub const SHARE: f64 = 0.95;

/// Points of the grid along each of one, two or three keys.
const GRID: [usize; 3] = [9, 6, 4];

/// Share of a range below which steps are not halved any more.
const LEAST_STEP: f64 = 0.002;

/// A key of a machine file and the range that it may have.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tuned {
    /// The key, as `disturbance.within`, `element[2].stiffness` or `load.mass`.
    pub key: String,
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
}

impl Tuned {
    /// `KEY=LOW..HIGH`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = || {
            format!(
                "--tune {text}: expected KEY=LOW..HIGH with 0 < LOW < HIGH, as disturbance.within=1..100, \
                 element[2].stiffness=1e4..1e5 or LABEL.mass=100..200"
            )
        };
        let (key, range) = text.split_once('=').ok_or_else(expected)?;
        let (low, high) = range.split_once("..").ok_or_else(expected)?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
        match (number(low), number(high)) {
            (Some(low), Some(high)) if 0.0 < low && low < high => Ok(Self { key: key.trim().to_owned(), low, high }),
            _ => Err(expected()),
        }
    }

    /// The value at a share of the range, by ratio.
    fn at(&self, share: f64) -> f64 {
        let value = self.low * (self.high / self.low).powf(share);
        // as many digits as steps of a five-hundredth of a range can tell apart
        format!("{value:.3e}").parse().unwrap_or(value).clamp(self.low, self.high)
    }
}

/// A machine file whose numbers are replaced where they stand: comments and everything else stay.
#[derive(Clone, Debug)]
pub struct Text {
    text: String,
    /// Where the tuned numbers stand, what they are, and whether they are whole.
    places: Vec<(std::ops::Range<usize>, f64, bool)>,
}

impl Text {
    /// A file's text in which these keys stand with a number.
    ///
    /// # Errors
    /// A sentence: a key that is not in the file or has no number, with those that there are.
    pub fn of(name: &str, text: String, tuned: &[Tuned]) -> Result<Self, String> {
        let document = DeTable::parse(&text).map_err(|error| format!("{name}: {}", error.message()))?;
        let numbers = numbers(document.get_ref());
        let place = |tuned: &Tuned| {
            let found: Vec<_> = numbers.iter().filter(|(names, ..)| names.contains(&tuned.key)).collect();
            match found.as_slice() {
                [(_, span, value, is_whole)] => Ok((span.clone(), *value, *is_whole)),
                [] => {
                    let known: Vec<&str> = numbers.iter().map(|(names, ..)| names[0].as_str()).collect();
                    Err(format!(
                        "--tune {}: {name} has no such key with a number: write the key with its default into the file first; \
                         it has {}",
                        tuned.key,
                        known.join(", ")
                    ))
                }
                _ => {
                    Err(format!("--tune {}: it stands more than once; expected element[NUMBER].KEY, from 0", tuned.key))
                }
            }
        };
        let places = tuned.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let twice = |k: usize| places[..k].iter().any(|(span, ..)| *span == places[k].0);
        if let Some(k) = (0..places.len()).find(|&k| twice(k)) {
            return Err(format!("--tune {}: expected it once", tuned[k].key));
        }
        Ok(Self { text, places })
    }

    /// The values that stand in the file.
    pub fn values(&self) -> Vec<f64> {
        self.places.iter().map(|(_, value, _)| *value).collect()
    }

    /// The text with other values; what is whole in the file stays so.
    pub fn with(&self, values: &[f64]) -> String {
        let mut replaced: Vec<_> = self.places.iter().zip(values).collect();
        replaced.sort_by_key(|((span, ..), _)| std::cmp::Reverse(span.start));
        let mut text = self.text.clone();
        for ((span, _, is_whole), value) in replaced {
            let number = if *is_whole { format!("{value:.0}") } else { format!("{value:?}") };
            text.replace_range(span.clone(), &number);
        }
        text
    }
}

/// A number of a file: its names, its place, its value, and whether it is whole.
type Number = (Vec<String>, std::ops::Range<usize>, f64, bool);

/// The numbers of a file: by section, by the number of an element, and by its label.
fn numbers(root: &DeTable<'_>) -> Vec<Number> {
    let mut found = Vec::new();
    for (section, value) in root {
        let section = section.get_ref();
        match value.get_ref() {
            DeValue::Table(table) => gather(&mut found, &[section.to_string()], table),
            DeValue::Array(tables) => {
                for (index, table) in tables.iter().enumerate() {
                    let Some(table) = table.get_ref().as_table() else { continue };
                    let label = table.iter().find(|(key, _)| key.get_ref() == "label");
                    let label = label.and_then(|(_, label)| label.get_ref().as_str().map(str::to_owned));
                    let paths: Vec<_> = std::iter::once(format!("{section}[{index}]")).chain(label).collect();
                    gather(&mut found, &paths, table);
                }
            }
            _ => {}
        }
    }
    found
}

fn gather(found: &mut Vec<Number>, paths: &[String], table: &DeTable<'_>) {
    for (key, value) in table {
        let number = match value.get_ref() {
            DeValue::Integer(number) => number.as_str().replace('_', "").parse().ok(),
            DeValue::Float(number) => number.as_str().replace('_', "").parse().ok(),
            _ => None,
        };
        if let Some(number) = number {
            let names = paths.iter().map(|path| format!("{path}.{}", key.get_ref())).collect();
            found.push((names, value.span(), number, matches!(value.get_ref(), DeValue::Integer(_))));
        }
    }
}

/// A point that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tried {
    /// The values, in the order of the keys.
    pub values: Vec<f64>,
    /// What is to be least: the geometric mean of the figures that 95 % of the machines do not exceed. None of a point
    /// that is refused.
    pub objective: Option<f64>,
    /// Why it is refused.
    pub refused: Option<String>,
}

/// What is to be least at a point: the geometric mean of the figures that [`SHARE`] of the machines do not exceed.
///
/// # Errors
/// A sentence: an unstable machine, or one of several figures that is not positive.
pub fn objective(figures: &[Figure], outcomes: &[Outcome]) -> Result<f64, String> {
    let unstable = outcomes.iter().filter(|outcome| outcome.is_unstable()).count();
    if unstable > 0 {
        return Err(format!("{unstable} of {} machines are unstable", outcomes.len()));
    }
    let each: Vec<f64> = figures.iter().map(|&figure| of_share(figure, outcomes, SHARE)).collect();
    match each.as_slice() {
        [one] => Ok(*one),
        all if all.iter().all(|value| *value > 0.0) => {
            Ok((all.iter().map(|value| value.ln()).sum::<f64>() / all.len() as f64).exp())
        }
        _ => Err("a figure of several that are least together is not positive".to_owned()),
    }
}

/// The value of a figure that a share of the machines do not exceed.
pub fn of_share(figure: Figure, outcomes: &[Outcome], share: f64) -> f64 {
    let mut values: Vec<f64> = outcomes.iter().map(|outcome| outcome.of(figure)).collect();
    values.sort_by(f64::total_cmp);
    quantile(&values, share)
}

/// Searches the ranges; `try_out` gives what is to be least at these values. Gives all points, the best one first: of
/// equal ones that which was tried first.
pub fn search(
    tuned: &[Tuned],
    mut try_out: impl FnMut(&[f64]) -> Result<Result<f64, String>, String>,
) -> Result<Vec<Tried>, String> {
    let mut all: Vec<Tried> = Vec::new();
    let mut at = |shares: &[f64]| -> Result<f64, String> {
        let values: Vec<f64> = tuned.iter().zip(shares).map(|(tuned, share)| tuned.at(*share)).collect();
        let objective = match all.iter().find(|known| known.values == values) {
            Some(known) => known.objective,
            None => {
                let found = try_out(&values)?;
                let (objective, refused) = (found.as_ref().ok().copied(), found.err());
                all.push(Tried { values, objective, refused });
                objective
            }
        };
        Ok(objective.unwrap_or(f64::INFINITY))
    };
    let points = GRID[tuned.len().clamp(1, GRID.len()) - 1];
    let spacing = 1.0 / (points - 1) as f64;
    let mut best = (f64::INFINITY, vec![0.5; tuned.len()]);
    for index in 0..points.pow(tuned.len() as u32) {
        let digit = |k: usize| (index / points.pow(k as u32) % points) as f64 * spacing;
        let shares: Vec<f64> = (0..tuned.len()).map(digit).collect();
        let found = at(&shares)?;
        if found < best.0 {
            best = (found, shares);
        }
    }
    let mut step = 0.5 * spacing;
    while best.0.is_finite() && step >= LEAST_STEP {
        let mut moved = false;
        for k in 0..tuned.len() {
            for way in [-step, step] {
                let mut shares = best.1.clone();
                shares[k] = (shares[k] + way).clamp(0.0, 1.0);
                let found = at(&shares)?;
                if found < best.0 {
                    best = (found, shares);
                    moved = true;
                }
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    let of = |tried: &Tried| tried.objective.unwrap_or(f64::INFINITY);
    all.sort_by(|a, b| of(a).total_cmp(&of(b)));
    Ok(all)
}
