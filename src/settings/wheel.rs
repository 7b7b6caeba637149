//! Constants of a toothed wheel, from the angles of its teeth.

use super::Error;
use crate::math::ln;
use crate::wheel::{Cam, MOST, RATIOS, Tooth, ToothedWheelConfig, ratio_of};

const FEW: &str = "a wheel must have at least two teeth, and at most 10,000";
const PLACES: &str =
    "the places of a wheel must be its teeth and the missing ones, each missing one a place of its own";
const ORDER: &str = "the angles of the teeth must rise, from 0 to less than 360 degrees, by 0.02 degrees at least";
const REPEATS: &str = "the part of a wheel that repeats must have at most 128 teeth";
const TURNS: &str = "a cycle must be 1 turn of the wheel, or 2 to 8";
const CLOCK: &str = "the clock that the teeth are timed with must be positive and finite (Hz)";
const LEARN: &str = "a wheel is learnt from the edges of three turns at least, which must follow each other in time";
const UNSTEADY: &str = "the edges do not repeat from turn to turn within a tenth of a tooth's span: hold the speed, \
    and check the number of teeth";
const EDGES: &str = "the edges of a cam must be angles of its cycle, and their tolerance positive and less than half \
    of it (degrees)";
const SLOW: &str = "the lowest speed must be positive (rad/s), and a turn at it take at most 2^30 counts of the clock";

/// The teeth of a wheel: the angles of their edges, in turns, in the direction of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Teeth<const TEETH: usize> {
    /// The angles (turn), from 0 to less than 1, rising.
    pub angles: [f64; TEETH],
}

/// A wheel's cycle and the clock that its teeth are timed with.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothClock {
    /// Turns of the wheel to a cycle: 1, or 2 of a four-stroke engine.
    pub turns: u32,
    /// Clock (Hz).
    pub clock: f64,
    /// Lowest speed at which the angle is wanted (rad/s).
    pub lowest_speed: f64,
}

impl<const TEETH: usize> Teeth<TEETH> {
    /// Even places of which the last `missing` have no tooth: `Teeth::<58>::gap(60, 2)` is a 60-2 wheel. The angle is 0
    /// at the first tooth behind the gap. Without missing teeth the wheel needs an index.
    ///
    /// # Panics
    /// Where the teeth are not the places less the missing ones; in a constant at compile time.
    #[must_use]
    pub const fn gap(places: u32, missing: u32) -> Self {
        if places as usize != TEETH + missing as usize {
            panic!("{}", PLACES);
        }
        Self::places(places, &[])
    }

    /// Even places of which these, counted from 0 and rising, have no tooth: 36-2-1 with its single gap behind the 17th
    /// tooth is `Teeth::<33>::without(36, &[17, 34, 35])`.
    ///
    /// # Panics
    /// Where the teeth are not the places less the missing ones, or these do not rise; in a constant at compile time.
    #[must_use]
    pub const fn without(places: u32, missing: &[u32]) -> Self {
        if places as usize != TEETH + missing.len() {
            panic!("{}", PLACES);
        }
        Self::places(places, missing)
    }

    /// The first places that are not missing.
    const fn places(places: u32, missing: &[u32]) -> Self {
        if !rise(places, missing) {
            panic!("{}", PLACES);
        }
        let mut angles = [0.0; TEETH];
        let (mut tooth, mut place, mut gone) = (0, 0, 0);
        while tooth < TEETH {
            if gone < missing.len() && missing[gone] == place {
                gone += 1;
            } else {
                angles[tooth] = place as f64 / places as f64;
                tooth += 1;
            }
            place += 1;
        }
        Teeth { angles }
    }

    /// Even places with one tooth more at this angle (degree): `Teeth::<13>::extra(12, 10.0)` is a 12+1 wheel.
    ///
    /// # Panics
    /// Where the teeth are not the places and one; in a constant at compile time.
    #[must_use]
    pub const fn extra(places: u32, at: f64) -> Self {
        if places as usize + 1 != TEETH {
            panic!("{}", PLACES);
        }
        let mut angles = [0.0; TEETH];
        let (mut tooth, mut place) = (0, 0);
        let mut due = true;
        while tooth < TEETH {
            let even = place as f64 / places as f64;
            if due && at / 360.0 < even {
                angles[tooth] = at / 360.0;
                due = false;
            } else {
                angles[tooth] = even;
                place += 1;
            }
            tooth += 1;
        }
        Teeth { angles }
    }

    /// Teeth at these angles (degree).
    #[must_use]
    pub const fn degrees(mut angles: [f64; TEETH]) -> Self {
        each!(tooth, 0..TEETH, {
            angles[tooth] /= 360.0;
        });
        Teeth { angles }
    }
}

impl<const TEETH: usize> Teeth<TEETH> {
    /// Learns the teeth from edges' times (clock counts) over three turns or more at a steady speed, each turn taken by
    /// its own length. The angle is 0 at the tooth behind the largest span. A ripple while learning is learnt as a
    /// displacement of the teeth: let the machine coast, without fuel and without load.
    ///
    /// # Errors
    /// [`Error::Value`] for fewer than three turns, or edges that differ from turn to turn by a tenth of a span.
    pub fn learnt(times: &[u32]) -> Result<Self, Error> {
        let at = |index: usize| times.get(index).copied().unwrap_or(0);
        let turns = times.len().saturating_sub(1).checked_div(TEETH).unwrap_or(0);
        if turns < 3 || TEETH < 2 {
            return Err(Error::Value(LEARN));
        }
        let place = |turn: usize, tooth: usize| {
            let first = at(turn * TEETH);
            let length = at(turn * TEETH + TEETH).wrapping_sub(first);
            f64::from(at(turn * TEETH + tooth).wrapping_sub(first)) / f64::from(length.max(1))
        };
        let mut mean = [0.0; TEETH];
        for (tooth, mean) in mean.iter_mut().enumerate() {
            *mean = (0..turns).map(|turn| place(turn, tooth)).sum::<f64>() / turns as f64;
        }
        let span = |tooth: usize| match (mean.get(tooth), mean.get(tooth + 1)) {
            (Some(from), Some(to)) => to - from,
            (Some(from), None) => 1.0 - from,
            _ => 0.0,
        };
        let least = (0..TEETH).map(span).fold(1.0, f64::min);
        if !(least > 0.0) {
            return Err(Error::Value(LEARN));
        }
        let apart = |turn, tooth| (place(turn, tooth) - mean.get(tooth).copied().unwrap_or(0.0)).abs();
        if (0..turns).any(|turn| (0..TEETH).any(|tooth| !(apart(turn, tooth) < 0.1 * least))) {
            return Err(Error::Value(UNSTEADY));
        }
        let gap = (0..TEETH).max_by(|a, b| span(*a).total_cmp(&span(*b))).unwrap_or(0);
        let first = (gap + 1) % TEETH;
        let zero = mean.get(first).copied().unwrap_or(0.0);
        let mut angles = [0.0; TEETH];
        for (tooth, angle) in angles.iter_mut().enumerate() {
            let place = mean.get((first + tooth) % TEETH).copied().unwrap_or(0.0) - zero;
            *angle = if place < 0.0 { place + 1.0 } else { place };
        }
        Ok(Teeth { angles })
    }
}

impl<const EDGES: usize> Cam<EDGES> {
    /// The edges of a cam at these angles of the crank in a cycle of so many turns, and how far each may be from there
    /// (degree of the crank).
    ///
    /// # Panics
    /// Where an angle is not in the cycle, or the tolerance not below half of it; in a constant at compile time.
    #[must_use]
    pub const fn degrees(turns: u32, angles: [f64; EDGES], tolerance: f64) -> Self {
        let cycle = 360.0 * turns as f64;
        assert!(tolerance > 0.0 && tolerance < 0.5 * cycle, "{}", self::EDGES);
        let mut edges = [0; EDGES];
        each!(k, 0..EDGES, {
            assert!(angles[k] >= 0.0 && angles[k] < cycle, "{}", self::EDGES);
            edges[k] = (angles[k] / cycle * TURN) as u32;
        });
        Cam { edges, tolerance: (tolerance / cycle * TURN) as u32 }
    }
}

const TURN: f64 = 4_294_967_296.0;

impl<const TEETH: usize> ToothedWheelConfig<TEETH> {
    stops! {
        /// The constants of a wheel.
        pub const fn new(teeth: &Teeth<TEETH>, timing: ToothClock) -> Self = try_new
    }

    /// The constants of a wheel.
    ///
    /// # Errors
    /// [`Error::Value`] for fewer than two teeth, angles that do not rise, or more than 128 teeth of which no part
    /// repeats. Also for a cycle of no turns or more than 8, and a clock or a speed that is not positive.
    pub const fn try_new(teeth: &Teeth<TEETH>, timing: ToothClock) -> Result<Self, Error> {
        let ToothClock { turns, clock, lowest_speed } = timing;
        if TEETH < 2 || TEETH > 10_000 {
            return Err(Error::Value(FEW));
        }
        if turns < 1 || turns > 8 {
            return Err(Error::Value(TURNS));
        }
        if !(clock > 0.0 && clock.is_finite()) {
            return Err(Error::Value(CLOCK));
        }
        let slowest = core::f64::consts::TAU / lowest_speed * clock;
        if !(lowest_speed > 0.0 && slowest <= 1_073_741_824.0 && slowest >= 1.0) {
            return Err(Error::Value(SLOW));
        }
        let spans = get!(spans(&teeth.angles));
        let sector = sector(&spans);
        if sector > MOST {
            return Err(Error::Value(REPEATS));
        }
        let mut placed = [Tooth { angle: 0, span: 0, slack: 0, spans: 0 }; TEETH];
        each!(k, 0..TEETH, {
            let (span, next) = (spans[k], spans[(k + 1) % TEETH]);
            let angle = (teeth.angles[k] * TURN + 0.5) as u64 as u32;
            let last = (teeth.angles[(k + TEETH - 1) % TEETH] * TURN + 0.5) as u64 as u32;
            placed[k] = Tooth {
                angle,
                span: angle.wrapping_sub(last),
                slack: (0.5 * TURN * if span < next { span } else { next }) as u32,
                spans: (4096.0 / span + 0.5) as u32,
            };
        });
        let fitting = fitting(&spans, sector);
        let (sector, slowest) = (sector as u32, slowest as u32);
        Ok(ToothedWheelConfig { teeth: placed, sector, fitting, turns, slowest, period: 1.0 / clock })
    }
}

/// Whether the missing places rise and are among the places.
const fn rise(places: u32, missing: &[u32]) -> bool {
    each!(next, 0..missing.len(), {
        if missing[next] >= places || (next > 0 && missing[next] <= missing[next - 1]) {
            return false;
        }
    });
    true
}

/// From each tooth's predecessor to it (turn).
const fn spans<const TEETH: usize>(angles: &[f64; TEETH]) -> Result<[f64; TEETH], Error> {
    let mut spans = [0.0; TEETH];
    each!(k, 0..TEETH, {
        let last = if k == 0 { angles[TEETH - 1] - 1.0 } else { angles[k - 1] };
        spans[k] = angles[k] - last;
        if !(angles[k] >= 0.0 && angles[k] < 1.0 && spans[k] > 5e-5) {
            return Err(Error::Value(ORDER));
        }
    });
    Ok(spans)
}

/// Teeth of the smallest part that repeats.
const fn sector<const TEETH: usize>(spans: &[f64; TEETH]) -> usize {
    each!(part, 1..TEETH, {
        let mut k = 0;
        if TEETH.is_multiple_of(part) {
            while k < TEETH && (spans[k] - spans[(k + part) % TEETH]).abs() < 1e-6 {
                k += 1;
            }
            if k == TEETH {
                return part;
            }
        }
    });
    TEETH
}

/// How far the ratio of two intervals may be from that of their spans (octave): by 2.2, as each edge may be out of
/// place by a fifth of the interval, or one of them missing; and not more than 0.6 of the largest ratio of two spans,
/// by which a gap is known. A step of the ratios is added.
const fn tolerance<const TEETH: usize>(spans: &[f64; TEETH]) -> f64 {
    let (mut largest, mut k) = (0.0, 0);
    while k < TEETH {
        let ratio = (ln(spans[k] / spans[(k + TEETH - 1) % TEETH]) / core::f64::consts::LN_2).abs();
        if ratio > largest {
            largest = ratio;
        }
        k += 1;
    }
    let tolerance = if 0.6 * largest < 1.1 && largest > 0.01 { 0.6 * largest } else { 1.1 };
    tolerance + 0.125
}

/// For each ratio the teeth at which it may end.
const fn fitting<const TEETH: usize>(spans: &[f64; TEETH], sector: usize) -> [[u64; 2]; RATIOS] {
    let mut fitting = [[0; 2]; RATIOS];
    let tolerance = tolerance(spans);
    each!(k, 0..sector, {
        let nominal = ln(spans[k] / spans[(k + TEETH - 1) % TEETH]) / core::f64::consts::LN_2;
        each!(step, 0..RATIOS, {
            let away = ratio_of(step) - nominal;
            let beyond = (step == 0 && away > 0.0) || (step == RATIOS - 1 && away < 0.0);
            if away.abs() <= tolerance || beyond {
                fitting[step][k / 64] |= 1 << (k % 64);
            }
        });
    });
    fitting
}

#[cfg(test)]
mod tests;
