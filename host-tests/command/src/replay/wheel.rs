//! The library's toothed wheel over the times of its edges: speed and ripple, window by window.

use std::str::FromStr;

use driveline::fluctuation::{ToothErrors, ToothWindow};
use driveline::settings::{Error, Teeth, ToothClock};
use driveline::wheel::{CycleTimes, Stage, ToothedWheel, ToothedWheelConfig};

use super::window::{Windowed, Windows, doubt};

/// Clock that the edges are timed with (Hz): a turn at the lowest speed takes a hundredth of its range.
const CLOCK: f64 = 1e7;

/// Lowest speed of an angle (rad/s): 19 r/min, far below an engine's cranking.
const LOWEST: f64 = 2.0;

/// Angles of a wheel's teeth (turn).
#[derive(Clone, Debug, PartialEq)]
pub struct Wheel(Vec<f64>);

impl FromStr for Wheel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            format!(
                "`{text}`: expected a wheel such as `60-2`, `36:10,11,22,23,34,35` (36 places, the missing ones from \
                 0), `12+1@340` (12 teeth and one at 340 degrees) or `0,70,180,250` (the angles in degrees)"
            )
        };
        let number = |text: &str| text.trim().parse::<u32>().ok().filter(|number| *number <= 10_000);
        let degrees = |text: &str| text.trim().parse::<f64>().ok().filter(|angle| (0.0..360.0).contains(angle));
        let even = |places: u32, missing: &[u32]| {
            let teeth = (0..places).filter(|place| !missing.contains(place));
            teeth.map(|place| f64::from(place) / f64::from(places)).collect::<Vec<_>>()
        };
        let angles = if let Some((places, missing)) = text.split_once('-') {
            let (places, missing) = number(places).zip(number(missing)).ok_or_else(expected)?;
            even(places, &(places.saturating_sub(missing)..places).collect::<Vec<_>>())
        } else if let Some((places, missing)) = text.split_once(':') {
            let missing = missing.split(',').map(number).collect::<Option<Vec<_>>>();
            let (places, missing) = number(places).zip(missing).ok_or_else(expected)?;
            if missing.iter().any(|place| *place >= places) {
                return Err(format!("`{text}`: expected places from 0 to {}", places.saturating_sub(1)));
            }
            even(places, &missing)
        } else if let Some((places, extra)) = text.split_once("+1@") {
            let (places, extra) = number(places).zip(degrees(extra)).ok_or_else(expected)?;
            let mut angles = even(places, &[]);
            angles.push(extra / 360.0);
            angles.sort_by(f64::total_cmp);
            angles
        } else {
            let angles = text.split(',').map(degrees).collect::<Option<Vec<_>>>().ok_or_else(expected)?;
            angles.into_iter().map(|angle| angle / 360.0).collect()
        };
        if angles.len() < 2 {
            return Err(expected());
        }
        let mut spans = angles.windows(2).map(|pair| pair[1] - pair[0]);
        let last = angles.first().zip(angles.last()).map_or(0.0, |(first, last)| 1.0 + first - last);
        // as even as the places are calculated
        if spans.all(|span| (span - last).abs() < 1e-9) {
            return Err(format!("`{text}`: expected a gap or a tooth more: among even teeth no place can be told"));
        }
        Ok(Wheel(angles))
    }
}

/// What came of the edges.
#[derive(Clone, Debug, Default)]
pub struct Turned {
    /// Edges.
    pub edges: usize,
    /// Teeth on a turn.
    pub teeth: usize,
    /// Those after which the place was known.
    pub known: usize,
    /// The windows; the last one may have fewer cycles.
    pub windows: Vec<Windowed>,
}

/// Runs the wheel over the times of its edges (s).
///
/// # Errors
/// A sentence: a wheel that the library refuses, or one whose number of teeth this command does not have.
pub fn turn(wheel: &Wheel, windows: Windows, edges: &[f64]) -> Result<Turned, String> {
    /// A wheel's number of teeth is a constant of the library's types, each a build of its own: those of 8-1, 12-1,
    /// 12+1, 12-2, 24-1, 24-2, 36-1, 36-2, 36-2-1, 36-2-2-2, 60-1, 60-2 and of a few uneven teeth; at two turns those
    /// of four-stroke engines.
    macro_rules! by_teeth {
        ($($turns:literal: $($teeth:literal $cycle:literal),*;)*) => {
            match (wheel.0.len(), windows.turns) {
                $($(($teeth, $turns) => run::<$teeth, $cycle>(wheel, windows, edges).map_err(|e| e.to_string()),)*
                (other, $turns) => {
                    let (turns, known) = ($turns, [$(stringify!($teeth)),*].join(", "));
                    let s = if turns == 1 { "" } else { "s" };
                    Err(format!("{other} teeth, expected one of {known} with {turns} turn{s} to the cycle"))
                })*
                (_, turns) => Err(format!("{turns} turns to a cycle, expected 1 or 2")),
            }
        };
    }
    by_teeth! {
        1: 3 3, 4 4, 7 7, 10 10, 11 11, 13 13, 22 22, 23 23, 30 30, 33 33, 34 34, 35 35, 58 58, 59 59;
        2: 4 8, 7 14, 11 22, 13 26, 23 46, 30 60, 33 66, 34 68, 35 70, 58 116;
    }
}

fn run<const TEETH: usize, const CYCLE: usize>(
    wheel: &Wheel,
    Windows { turns, cycles, orders }: Windows,
    edges: &[f64],
) -> Result<Turned, Error> {
    let mut teeth = Teeth { angles: [0.0; TEETH] };
    teeth.angles.copy_from_slice(&wheel.0);
    let config = ToothedWheelConfig::try_new(&teeth, ToothClock { turns, clock: CLOCK, lowest_speed: LOWEST })?;
    let first = edges.first().copied().unwrap_or(0.0);
    let mut turned = Turned { edges: edges.len(), teeth: TEETH, ..Turned::default() };
    let mut wheel = ToothedWheel::<CycleTimes<CYCLE>>::default();
    let mut window = ToothWindow::default();
    let mut close = |window: &mut ToothWindow<CYCLE>, until: f64| {
        let ripple = window.ripple(&config, &ToothErrors::NONE, orders);
        let doubt = ripple.as_ref().ok().and_then(|ripple| doubt(ripple, turns));
        turned.windows.push(Windowed { until, cycles: window.cycles(), ripple, doubt });
        *window = ToothWindow::default();
    };
    let (mut known, mut last, mut until) = (0, first, first);
    for &edge in edges {
        // the capture times out before its clock comes round
        if edge - last > std::f64::consts::TAU / LOWEST {
            wheel.lose();
        }
        last = edge;
        wheel.tooth(&config, ((edge - first) * CLOCK) as u64 as u32);
        known += usize::from(wheel.stage() == Stage::Known);
        if let Some(cycle) = wheel.take() {
            let mut before = window;
            window.add(&config, &cycle);
            // it began anew after a lost place: what came before is a window of its own
            if window.cycles() <= before.cycles() {
                close(&mut before, until);
            }
            until = edge;
        }
        if window.cycles() == cycles {
            close(&mut window, until);
        }
    }
    if window.cycles() > 0 {
        close(&mut window, until);
    }
    turned.known = known;
    Ok(turned)
}
