//! Rates and observers side by side: the errors predicted over the tolerances against instructions a second.

use driveline_report::Table;
use driveline_report::format::{percent, rate, significant};
use serde::Serialize;

use crate::machine_file::MachineFile;

/// Instructions at most of a tick with observer and speed loop: M4F in `f32`, M3 in fixed point. Those of
/// `budgets.toml`, which a test of the book compares.
pub const INSTRUCTIONS: [(&str, [u32; 2]); 3] =
    [("rigid", [117, 117]), ("semi-implicit", [129, 140]), ("exact", [151, 191])];

/// Clock of an M4F (Hz), and least and most cycles of an instruction there: the intervals of the hoist's images over
/// their bounds, in `doc/makers/worst-case.md`.
pub const M4F: (f64, [f64; 2]) = (168e6, [1.58, 1.80]);

/// Rates that are tried, of the file's.
const SHARES: [f64; 7] = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0];

/// An observer at a rate.
#[derive(Clone, Debug, Serialize)]
pub struct Choice {
    /// Ticks a second.
    pub rate_hz: u32,
    /// `rigid`, `semi-implicit` or `exact`; `two-mass` where it is refused.
    pub observer: &'static str,
    /// Errors of shaft torque, load speed and load torque over the tolerances; `null` where it is refused.
    pub errors: Option<[f64; 3]>,
    /// Medians of the same on drawn machines, in closed loop with the full solver; `null` where none are drawn.
    pub drawn: Option<[f64; 3]>,
    /// Instructions a second, M4F in `f32` and M3 in fixed point.
    pub instructions: Option<[f64; 2]>,
    /// What its speed loop lacks, or why there is no such observer.
    pub lacks: Option<String>,
    /// Whether no other with all margins has smaller errors of shaft torque and load speed for less: drawn ones, where
    /// machines are drawn.
    pub on_front: bool,
}

/// Both observers at every rate, those with all margins also on machines that `draw` draws; none of a machine without a
/// shaft.
pub fn choices(machine: &MachineFile, draw: impl FnOnce(&mut [Choice])) -> Vec<Choice> {
    let Some(two) = machine.two_masses() else { return Vec::new() };
    let own = f64::from(machine.control.rate_hz);
    let rates = SHARES.iter().map(|share| (share * own).round()).filter(|rate| (10.0..=200e3).contains(rate));
    let mut choices: Vec<Choice> = rates
        .flat_map(|rate| machine.at_rate(&two, rate as u32).map(|found| (rate, found)))
        .map(|(rate, (observer, found))| {
            let counts = INSTRUCTIONS.iter().find(|(name, _)| *name == observer);
            let a_second = |(_, counts): &(_, [u32; 2])| counts.map(|count| f64::from(count) * rate);
            let (errors, lacks) = match found {
                Ok((errors, lack)) => (Some(errors), lack.map(str::to_owned)),
                Err(error) => (None, Some(error)),
            };
            let instructions = counts.filter(|_| errors.is_some()).map(a_second);
            Choice { rate_hz: rate as u32, observer, errors, drawn: None, instructions, lacks, on_front: false }
        })
        .collect();
    draw(&mut choices);
    let figures = |choice: &Choice| {
        let ([torque, speed, _], [cost, _]) = choice.drawn.or(choice.errors).zip(choice.instructions)?;
        choice.lacks.is_none().then_some([torque, speed, cost])
    };
    let all: Vec<_> = choices.iter().filter_map(figures).collect();
    let beats = |one: &[f64; 3], other: &[f64; 3]| one != other && one.iter().zip(other).all(|(a, b)| a <= b);
    for choice in &mut choices {
        choice.on_front = figures(choice).is_some_and(|own| !all.iter().any(|other| beats(other, &own)));
    }
    choices
}

/// The table.
pub fn text(choices: &[Choice], draws: u64) -> String {
    if choices.is_empty() {
        return "no rates are compared: the machine has no shaft".to_owned();
    }
    let mut heads = vec!["rate", "observer", "shaft torque", "load speed", "load torque"];
    if draws > 0 {
        heads.extend(["shaft torque, drawn", "load speed, drawn", "load torque, drawn", "µs a tick, M4F"]);
    }
    let mut table = Table::new(heads.into_iter().chain(["million a second, M4F f32", "M3 fixed", ""]));
    for choice in choices {
        let three = |errors: Option<[f64; 3]>| errors.map_or([const { String::new() }; 3], |e| e.map(percent));
        let costs =
            choice.instructions.map_or([const { String::new() }; 2], |costs| costs.map(|n| significant(1e-6 * n)));
        let last = match &choice.lacks {
            Some(lacks) => lacks.clone(),
            None if choice.on_front => "front".to_owned(),
            None => String::new(),
        };
        let name = if choice.observer == "rigid" { "one mass" } else { choice.observer };
        let mut cells = vec![rate(choice.rate_hz), name.to_owned()];
        cells.extend(three(choice.errors));
        if draws > 0 {
            cells.extend(three(choice.drawn));
            cells.push(choice.instructions.map_or_else(String::new, |[a_second, _]| {
                let a_tick = a_second / f64::from(choice.rate_hz);
                let (clock, cycles) = M4F;
                cycles.map(|cycles| significant(1e6 * cycles * a_tick / clock)).join(" to ")
            }));
        }
        table.row(cells.into_iter().chain(costs).chain([last]));
    }
    let drawn = match draws {
        0 => String::new(),
        _ => format!(
            "\ndrawn: medians of the same over {draws} machines, in closed loop with the full solver; \
             microseconds at 168 MHz, by intervals of cycles"
        ),
    };
    format!(
        "{table}front: no other choice with all margins has smaller errors of shaft torque and load speed for less\n\
         errors over tolerances, rms; the torque's noise has the same density at every rate; instructions at most, counted\
         {drawn}"
    )
}
