//! The library's toothed wheel over the times of its edges: speed and ripple, window by window, or the angle of each
//! tick.

use std::str::FromStr;

use driveline::fluctuation::{ToothErrors, ToothWindow};
use driveline::settings::{Error, Teeth, ToothClock};
use driveline::wheel::{CycleTimes, Synchronization, ToothedWheel, ToothedWheelConfig, WheelAngle};

use super::window::{Windowed, Windows, doubt};

/// Fastest clock that edges are timed with (Hz): a turn at the lowest speed takes a hundredth of its range.
const CLOCK: f64 = 1e7;

/// Clock that times of edges (s) were taken with (Hz): all of them are whole counts from the first on.
fn clock_of(edges: &[f64]) -> f64 {
    let first = edges.first().copied().unwrap_or(0.0);
    let counts = edges.iter().map(|edge| ((edge - first) * CLOCK).round() as u64);
    let shared = counts.fold(0, |mut a, mut b| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    });
    CLOCK / shared.max(1) as f64
}

/// Lowest speed of an angle (rad/s): 19 r/min, far below an engine's cranking.
const LOWEST: f64 = 2.0;

/// Angle of 2^-32 turn (rad).
const TURN_PART: f64 = std::f64::consts::TAU / 4_294_967_296.0;

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
            if let Some(twice) = missing.iter().enumerate().find(|(at, place)| missing[..*at].contains(place)) {
                return Err(format!("`{text}`: the place {} twice, expected each missing place once", twice.1));
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
    pub edges: usize,
    /// Teeth on a turn.
    pub teeth: usize,
    /// Those after which the place was known.
    pub known: usize,
    /// The last of them before the place was first lost (s); none where it was not.
    pub lost: Option<f64>,
    /// The windows; the last one may have fewer cycles.
    pub windows: Vec<Windowed>,
}

/// Calls a function that is generic in the teeth of a turn and of a cycle. Each number of teeth is a build of its own:
/// those of 8-1, 12-1, 12+1, 12-2, 24-1, 24-2, 36-1, 36-2, 36-2-1, 36-2-2-2, 60-1, 60-2 and of a few uneven teeth; at
/// two turns those of four-stroke engines.
macro_rules! by_teeth {
    ($wheel:expr, $turns:expr, $run:ident $arguments:tt) => {
        by_teeth! {
            @ $wheel, $turns, $run $arguments
            1: 3 3, 4 4, 7 7, 10 10, 11 11, 13 13, 22 22, 23 23, 30 30, 33 33, 34 34, 35 35, 58 58, 59 59;
            2: 4 8, 7 14, 11 22, 13 26, 23 46, 30 60, 33 66, 34 68, 35 70, 58 116;
        }
    };
    (@ $wheel:expr, $of:expr, $run:ident $arguments:tt $($turns:literal: $($teeth:literal $cycle:literal),*;)*) => {
        match ($wheel.0.len(), $of) {
            $($(($teeth, $turns) => $run::<$teeth, $cycle> $arguments.map_err(|error: Error| error.to_string()),)*
            (other, $turns) => {
                let (turns, known) = ($turns, [$(stringify!($teeth)),*].join(", "));
                let s = if turns == 1 { "" } else { "s" };
                Err(format!("{other} teeth, expected one of {known} with {turns} turn{s} to the cycle"))
            })*
            (_, turns) => Err(format!("{turns} turns to a cycle, expected 1 or 2")),
        }
    };
}

/// Runs the wheel over the times of its edges (s).
///
/// # Errors
/// A sentence: a wheel that the library refuses, or one whose number of teeth this command does not have.
pub fn turn(wheel: &Wheel, windows: Windows, edges: &[f64]) -> Result<Turned, String> {
    by_teeth!(wheel, windows.turns, run(wheel, windows, edges))
}

/// The motor's angle by a wheel.
#[derive(Clone, Debug)]
pub struct Followed {
    /// In each tick (2^-32 turn); none while it is not known.
    pub angles: Vec<Option<u32>>,
    /// Edges while it was known.
    pub edges: usize,
    /// Root mean square of the deviations that the wheel states (rad).
    pub deviation: f64,
}

impl Followed {
    /// Ticks with an angle.
    pub fn known(&self) -> usize {
        self.angles.iter().flatten().count()
    }

    /// Deviation of an angle whose error is another one in each tick (rad), as a design has it. The error of
    /// an edge lasts until the next one. The mean of many ticks has twice the deviation that the wheel states: that is
    /// of an angle smoothed over some edges, with a gain of a quarter for one.
    pub fn in_a_tick(&self) -> f64 {
        2.0 * self.deviation * (self.known() as f64 / self.edges.max(1) as f64).max(1.0).sqrt()
    }
}

/// The angle of the wheel at each of these times (s), from the edges up to there.
pub fn follow(wheel: &Wheel, edges: &[f64], ticks: &[f64]) -> Result<Followed, String> {
    by_teeth!(wheel, 1, angles(wheel, edges, ticks))
}

fn angles<const TEETH: usize, const CYCLE: usize>(
    wheel: &Wheel,
    edges: &[f64],
    ticks: &[f64],
) -> Result<Followed, Error> {
    let config = config::<TEETH>(wheel, 1, CLOCK)?;
    let first = ticks.first().copied().unwrap_or(0.0);
    let clock = |time: f64| ((time - first) * CLOCK) as i64 as u32;
    let mut wheel = ToothedWheel::<()>::default();
    let mut followed = Followed { angles: Vec::new(), edges: 0, deviation: 0.0 };
    let (mut edges, mut squares) = (edges.iter().peekable(), 0.0);
    for now in ticks {
        let mut passed = 0;
        while let Some(edge) = edges.next_if(|edge| *edge <= now) {
            wheel.tooth(&config, clock(*edge));
            passed += 1;
        }
        let angle = wheel.at(&config, clock(*now)).ok();
        if let Some(WheelAngle { deviation, .. }) = angle {
            followed.edges += passed;
            squares += f64::from(deviation).powi(2);
        }
        followed.angles.push(angle.map(|angle| angle.angle));
    }
    followed.deviation = (squares / followed.known().max(1) as f64).sqrt() * TURN_PART;
    Ok(followed)
}

fn config<const TEETH: usize>(wheel: &Wheel, turns: u32, clock: f64) -> Result<ToothedWheelConfig<TEETH>, Error> {
    let mut teeth = Teeth { angles: [0.0; TEETH] };
    teeth.angles.copy_from_slice(&wheel.0);
    ToothedWheelConfig::try_new(&teeth, ToothClock { turns, clock, lowest_speed: LOWEST })
}

fn run<const TEETH: usize, const CYCLE: usize>(
    wheel: &Wheel,
    Windows { turns, cycles, orders }: Windows,
    edges: &[f64],
) -> Result<Turned, Error> {
    let rate = clock_of(edges);
    let config = config::<TEETH>(wheel, turns, rate)?;
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
    let (mut known, mut lost, mut last, mut until) = (0, None, first, first);
    for &edge in edges {
        let was_known = wheel.synchronization() == Synchronization::Known;
        // the capture times out before its clock comes round
        if edge - last > std::f64::consts::TAU / LOWEST {
            wheel.lose();
        }
        wheel.tooth(&config, ((edge - first) * rate).round() as u64 as u32);
        let is_known = wheel.synchronization() == Synchronization::Known;
        known += usize::from(is_known);
        if was_known && !is_known && lost.is_none() {
            lost = Some(last);
        }
        last = edge;
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
    (turned.known, turned.lost) = (known, lost);
    Ok(turned)
}
