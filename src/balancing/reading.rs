//! A reading: the phasor of a channel, with measures of its quality.

use core::fmt;

use crate::angle::{RotorAngleConfig, Synchronous};
use crate::math::single::sqrt;
use crate::number::Number;

/// Where a block of turns ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Edge<N: Synchronous, const CHANNELS: usize> {
    /// The sums at the rotor's zero.
    pub(crate) sums: [[N::Sum; 2]; CHANNELS],
    /// Ticks, the one with the zero in it included.
    pub(crate) ticks: u32,
    /// How far the rotor had come at the end of that tick [units of its turn].
    pub(crate) past: u32,
}

impl<N: Synchronous, const CHANNELS: usize> Default for Edge<N, CHANNELS> {
    fn default() -> Self {
        Edge { sums: [[N::Sum::default(); 2]; CHANNELS], ticks: 0, past: 0 }
    }
}

/// Amplitude and phase as a complex number: `v = Re(X e^{i order theta})`, with `theta` the rotor's angle.
///
/// The phase is how far the vibration leads the rotor's zero: the vibration is greatest where `theta = -phase`. In the
/// unit of the channel, or per unit of its base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Phasor {
    /// Real part.
    pub re: f32,
    /// Imaginary part.
    pub im: f32,
}

impl Phasor {
    /// This times another.
    pub fn times(self, by: Phasor) -> Phasor {
        Phasor { re: self.re * by.re - self.im * by.im, im: self.re * by.im + self.im * by.re }
    }

    /// This times a real number.
    pub fn scaled(self, by: f32) -> Phasor {
        Phasor { re: self.re * by, im: self.im * by }
    }

    /// This and another.
    pub fn plus(self, other: Phasor) -> Phasor {
        Phasor { re: self.re + other.re, im: self.im + other.im }
    }

    /// This less another, as a reading less its run-out.
    pub fn less(self, other: Phasor) -> Phasor {
        Phasor { re: self.re - other.re, im: self.im - other.im }
    }

    /// Square of the amplitude.
    pub fn square(self) -> f32 {
        self.re * self.re + self.im * self.im
    }

    /// Amplitude.
    pub fn amplitude(self) -> f32 {
        sqrt(self.square())
    }
}

#[cfg(feature = "balancing")]
impl From<Phasor> for nalgebra::Complex<f32> {
    fn from(phasor: Phasor) -> Self {
        nalgebra::Complex { re: phasor.re, im: phasor.im }
    }
}

#[cfg(feature = "balancing")]
impl From<Phasor> for nalgebra::Complex<f64> {
    fn from(phasor: Phasor) -> Self {
        nalgebra::Complex { re: phasor.re.into(), im: phasor.im.into() }
    }
}

/// Limits of a reading's unsteadiness, judged on the mean of its blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Steadiness {
    /// Difference of the fastest and the slowest block's speed, over the mean speed.
    pub speed: f32,
    /// Change of the phasor from the first block to the last along a straight line, over its amplitude, beyond what the
    /// blocks' remaining differences explain.
    pub drift: f32,
    /// Standard deviation of the phasor by the blocks' remaining differences, over its amplitude.
    pub scatter: f32,
    /// Smallest reference amplitude of drift and scatter (unit of the channel; in a [`PhasorsConfig`] in fixed point
    /// per unit of its base).
    pub floor: f32,
}

impl Steadiness {
    /// 1 % of speed, 3 % of drift and 20 % of the mean's standard deviation, of which a correction leaves a fifth; no
    /// floor.
    pub const USUAL: Self = Steadiness { speed: 0.01, drift: 0.03, scatter: 0.2, floor: 0.0 };
}

/// A phasor and how it came about.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// The phasor.
    pub phasor: Phasor,
    /// Variance of the phasor: the mean square of its error, as far as the blocks' scatter shows it
    /// (square of the channel's unit).
    pub variance: f32,
    /// Turns, times the order.
    pub turns: u32,
    /// Ticks on such a turn, on average.
    pub ticks: f32,
    /// Difference of the fastest and the slowest block's speed, over the mean speed.
    pub speed_spread: f32,
    /// Change of the phasor along a straight line over the reading, over the amplitude, beyond three times its standard
    /// deviation by the blocks' remaining differences.
    pub drift: f32,
    /// Root mean square of the blocks' remaining differences, over the amplitude.
    pub scatter: f32,
}

/// Why a reading cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
#[expect(missing_docs, reason = "the text of a variant says what its fields are")]
pub enum ReadingFault {
    /// The channel does not exist.
    NoChannel,
    /// Not enough turns yet: those that are measured, of those that are needed, times the order.
    Incomplete { turns: u32, of: u32 },
    /// The rotor turns backwards, or reverses; times that its zero passed the wrong way.
    Backwards { times: u32 },
    /// Fewer than eight ticks on a turn.
    TooFast,
    /// More ticks in a block than its sums bear.
    TooSlow,
    /// The sensor was at the end of its range, or its value is not a number.
    Clipped,
    /// Ticks without a sample, or with one that is not sound: a bus that failed, a sensor that stood still.
    Missing { samples: u32 },
    /// The speed moved; difference of the fastest and slowest block, over the mean.
    SpeedMoved { spread: f32 },
    /// The vibration moved along while the speed stood: a resonance is near, or the rotor is still getting warm. Its
    /// change over the reading, over the amplitude.
    Drifting { drift: f32 },
    /// The vibration fluctuates: noise, or a beat with another rotating part. Standard deviation of the mean by the
    /// blocks' differences, over the amplitude.
    Scattered { scatter: f32 },
}

impl fmt::Display for ReadingFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |part: f32| (part * 1000.0 + 0.5) as u32;
        let tenths = |f: &mut fmt::Formatter<'_>, part: f32| write!(f, "{}.{} %", share(part) / 10, share(part) % 10);
        match self {
            ReadingFault::NoChannel => f.write_str("there is no such channel"),
            ReadingFault::Incomplete { turns, of } => write!(f, "only {turns} of {of} turns are measured"),
            ReadingFault::Backwards { times } => write!(f, "the rotor passed its zero backwards {times} times"),
            ReadingFault::TooFast => {
                f.write_str("the rotor turns too fast for the tick: fewer than eight ticks on a turn")
            }
            ReadingFault::TooSlow => f.write_str("the rotor turns too slowly for the turns of a block: take fewer"),
            ReadingFault::Clipped => f.write_str("the sensor was at the end of its range, or gave NaN"),
            ReadingFault::Missing { samples } => write!(f, "samples were missing or not sound, {samples} of them"),
            ReadingFault::SpeedMoved { spread } => {
                f.write_str("the speed moved by ")?;
                tenths(f, *spread)
            }
            ReadingFault::Drifting { drift } => {
                f.write_str("the vibration moved along by ")?;
                tenths(f, *drift)?;
                f.write_str(" while the speed stood: a resonance is near, or the rotor is getting warm")
            }
            ReadingFault::Scattered { scatter } => {
                f.write_str("the vibration fluctuates: the mean is uncertain by ")?;
                tenths(f, *scatter)
            }
        }
    }
}

impl core::error::Error for ReadingFault {}

/// The constants of a measurement of `CHANNELS` channels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhasorsConfig<N: Number, const CHANNELS: usize> {
    /// From the motor to the rotor, times the order.
    pub(crate) turning: RotorAngleConfig,
    /// Whole turns, times the order, of a block.
    pub(crate) block: u32,
    /// The largest sample of each channel that is not clipped, just below the end of its range.
    pub(crate) limits: [N; CHANNELS],
    /// Limits of a reading's unsteadiness.
    pub(crate) steadiness: Steadiness,
}

/// Fewest ticks on a turn: the image of the rotor's own order is then the seventh.
const FEWEST_TICKS: f32 = 8.0;

impl Reading {
    /// From the edges of the blocks.
    pub(crate) fn between<N: Synchronous, const CHANNELS: usize>(
        edges: &[Edge<N, CHANNELS>],
        channel: usize,
        config: &PhasorsConfig<N, CHANNELS>,
    ) -> Result<Reading, ReadingFault> {
        let (Some(first), Some(last)) = (edges.first(), edges.last()) else {
            return Err(ReadingFault::Incomplete { turns: 0, of: config.block });
        };
        if channel >= CHANNELS {
            return Err(ReadingFault::NoChannel);
        }
        let blocks = edges.len().saturating_sub(1) as f32;
        let turns = config.block as f32;
        // The zero lies before the end of its tick by how far the rotor has come since, a tick's turn at most.
        let past = |edge: &Edge<N, CHANNELS>| edge.past as f32 / config.turning.turn as f32;
        let ticks = last.ticks.wrapping_sub(first.ticks) as f32;
        let step = turns * blocks / ticks;
        let at = |edge: &Edge<N, CHANNELS>| {
            let since = past(edge) / step;
            edge.ticks.wrapping_sub(first.ticks) as f32 - if since < 1.0 { since } else { 1.0 }
        };
        let ticks = (at(last) - at(first)) / (turns * blocks);
        if !(ticks >= FEWEST_TICKS) {
            return Err(ReadingFault::TooFast);
        }
        let held = held(1.0 / ticks);
        let phasor = |pair: &[Edge<N, CHANNELS>]| match pair {
            [first, last] => match (first.sums.get(channel), last.sums.get(channel)) {
                (Some(from), Some(to)) => {
                    let (cosine, sine) = (N::growth(to[0], from[0]), N::growth(to[1], from[1]));
                    let mean = Phasor { re: sine, im: cosine }.scaled(core::f32::consts::FRAC_1_PI / turns);
                    // The tick after the first zero has taken over the rest of its tick: by the slope there, a tick too
                    // late.
                    let late = 2.0 * core::f32::consts::TAU * past(first) * step / turns;
                    Phasor { re: mean.re + mean.im * late, im: mean.im }.times(held)
                }
                _ => Phasor::default(),
            },
            _ => Phasor::default(),
        };
        let lasted = |pair: &[Edge<N, CHANNELS>]| match pair {
            [from, to] => at(to) - at(from),
            _ => 0.0,
        };

        // mean and straight line over the blocks, whose places are counted from the middle
        let (mut sum, mut slope, mut places) = (Phasor::default(), Phasor::default(), 0.0);
        let (mut shortest, mut longest) = (f32::INFINITY, 0.0);
        for (index, pair) in edges.windows(2).enumerate() {
            let place = index as f32 - 0.5 * (blocks - 1.0);
            sum = sum.plus(phasor(pair));
            slope = slope.plus(phasor(pair).scaled(place));
            places += place * place;
            let lasted = lasted(pair);
            shortest = if lasted < shortest { lasted } else { shortest };
            longest = if lasted > longest { lasted } else { longest };
        }
        let mean = sum.scaled(1.0 / blocks);
        let slope = if places > 0.0 { slope.scaled(1.0 / places) } else { Phasor::default() };
        let mut squares = 0.0;
        for (index, pair) in edges.windows(2).enumerate() {
            let line = mean.plus(slope.scaled(index as f32 - 0.5 * (blocks - 1.0)));
            squares += phasor(pair).less(line).square();
        }
        // two phasors are spent on the line
        let variance = if blocks > 2.0 { squares / (blocks - 2.0) } else { 0.0 };
        let over = 1.0 / mean.amplitude();
        let drift = slope.amplitude() * (blocks - 1.0);
        // of a straight line through blocks that differ by chance
        let explained = if places > 0.0 { sqrt(variance / places) * (blocks - 1.0) } else { 0.0 };
        Ok(Reading {
            phasor: mean,
            variance: variance / blocks,
            turns: config.block.wrapping_mul(edges.len().saturating_sub(1) as u32),
            ticks,
            speed_spread: (longest - shortest) / (ticks * turns),
            drift: if drift > 3.0 * explained { (drift - 3.0 * explained) * over } else { 0.0 },
            scatter: sqrt(variance) * over,
        })
    }

    /// This reading, where it is within limits.
    pub(crate) fn accept(self, clipped: bool, steadiness: &Steadiness) -> Result<Reading, ReadingFault> {
        let amplitude = self.phasor.amplitude();
        let uncertain = sqrt(self.variance) / amplitude;
        let relative = if amplitude < steadiness.floor { amplitude / steadiness.floor } else { 1.0 };
        // a NaN is beyond every limit
        if clipped || !amplitude.is_finite() {
            Err(ReadingFault::Clipped)
        } else if !(self.speed_spread <= steadiness.speed) {
            Err(ReadingFault::SpeedMoved { spread: self.speed_spread })
        } else if !(uncertain * relative <= steadiness.scatter) && amplitude > 0.0 {
            Err(ReadingFault::Scattered { scatter: uncertain })
        } else if !(self.drift * relative <= steadiness.drift) && amplitude > 0.0 {
            Err(ReadingFault::Drifting { drift: self.drift })
        } else {
            Ok(self)
        }
    }
}

/// Correction factor for a sample held over the tick before it: `e^{-ix} x/sin x`, x half of the tick's turn.
fn held(turn: f32) -> Phasor {
    let x = core::f32::consts::PI * turn;
    let z = x * x;
    // Taylor's series; x is at most pi/8, where the terms left out are below 1e-7
    let sinc = 1.0 - z * (1.0 / 6.0 - z * (1.0 / 120.0 - z / 5040.0));
    let cosine = 1.0 - z * (0.5 - z * (1.0 / 24.0 - z / 720.0));
    Phasor { re: cosine / sinc, im: -x }
}

#[cfg(test)]
mod tests;
