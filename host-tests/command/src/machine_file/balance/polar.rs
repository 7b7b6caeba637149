//! Amplitudes with their angles: readings and weights.

use driveline::balancing::{Complex, Entry};

use super::units::AngleConvention;
use crate::machine_file::{Diagnostic, Item, Quantity, Table};

const PAIR: &str = "a list of two numbers, [amplitude, phase in degrees]";

/// Pairs of amplitude and angle, as many as there must be.
pub(super) fn pairs(
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
        return Err(items[count].wrong(format!("only {count} pairs, one for each")));
    }
    let pair = |item: &Item<'_>| {
        let (amplitude, angle) = item.pair(Quantity::AMPLITUDE, Quantity::DEGREES, PAIR)?;
        Ok(counted(convention, entry.polar(amplitude, convention.degrees(angle))))
    };
    items.iter().map(pair).collect()
}

/// One weight: an amount and an angle.
pub(super) fn weight(
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
