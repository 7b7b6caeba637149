//! The forces in the bearings of a balancing machine.

use driveline::balancing::{Complex, Influence, two_planes};

use super::file::{BalanceFile, PLANES, ROWS};
use super::run::radians_per_second;
use crate::machine_file::{Diagnostic, Table};

/// Influence of the planes on the forces in the bearings of a balancing machine, by their places.
pub(super) fn hard_bearing(
    root: &Table<'_>,
    file: &BalanceFile,
    rpm: &[f64],
) -> Result<Influence<f64, ROWS, PLANES>, Diagnostic> {
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
