//! Torques on a coordinate, positive in its positive direction: of time, of speed, of angle.

use std::f64::consts::{PI, TAU};

use super::super::error::{PlantError, finite, in_range, positive};
use super::super::event::Place;
use super::super::excitation::LoadProgram;
use super::linkage::Orders;
use super::mesh::Harmonic;
use super::series::{Series, Turn, ZERO, add_harmonic, product, quotient};

/// A torque, N m, or a force, N, where the coordinate is a way.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    Constant(f64),
    /// Steps or straight lines against time.
    Program(LoadProgram),
    /// `torque (1 - (t/time)^power)` until `time` (s), zero afterwards; `power` 1 or 2 `[Huang 1987 §2.2]`.
    Starting {
        /// At time zero.
        torque: f64,
        /// Starting time, s, above zero.
        time: f64,
        /// 1 or 2.
        power: u8,
    },
    /// A periodic torque against time as its Fourier series.
    Waveform(Waveform),
    /// `stall - slope w` `[Wang 1989 (1-6)]`.
    Line {
        /// At standstill.
        stall: f64,
        /// Fall with speed, N m s/rad.
        slope: f64,
    },
    /// `a + b w + c w^2` `[Wang 1989 (1-7)]`.
    Parabola(f64, f64, f64),
    /// An induction motor by Kloss's formula `2 tau_A s s_A/(s^2 + s_A^2)`, `s = 1 - w/w_0`.
    Kloss {
        /// Greatest torque `tau_A`.
        breakdown: f64,
        /// The slip `s_A` there, above zero.
        slip: f64,
        /// Synchronous speed `w_0`, rad/s, above zero.
        synchronous: f64,
    },
    /// A series motor `c (U/(R + c w))^2` `[derived; shape: Wang 1989 §1-2]`, at speeds above `-R/c`.
    Series {
        /// Voltage `U`, V.
        voltage: f64,
        /// Resistance `R` of the whole circuit, ohm, zero or above.
        resistance: f64,
        /// Torque over the square of the current `c`, H, above zero.
        flux: f64,
    },
    /// A characteristic in pieces `a + b w + c w^2`, one between each two of its ends, nothing outside them.
    Pieces {
        /// Ends, rad/s, rising.
        ends: Vec<f64>,
        /// `a`, `b`, `c` from each end to the next.
        torques: Vec<[f64; 3]>,
    },
    /// Over an arc of every turn, rad from zero to two pi, `from` below `to`.
    Arc {
        /// On the arc.
        torque: f64,
        /// Where it begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// Orders of the coordinate's own angle over an arc of so many turns, rad, `from` below `to`: a force over a part
    /// of a stroke, times the slope of its way; or a torque over an arc of a cycle of two turns.
    Stroke {
        /// On the arc; a constant is order zero.
        torque: Orders,
        /// Where it begins, from zero.
        from: f64,
        /// Where it ends; beyond the end of the turns by less than `from` where it passes the angle zero.
        to: f64,
        /// Turns of a cycle, 1 or more.
        turns: u32,
    },
    /// Orders of the coordinate's own angle: the gas torque of an engine `[Pfützner 1980 (1.2a) to (1.2c)]`.
    Orders(Vec<Harmonic>),
}

/// A periodic torque `mean + sum`.
#[derive(Debug, Clone, PartialEq)]
pub struct Waveform {
    /// s, above zero.
    pub period: f64,
    /// Mean torque.
    pub mean: f64,
    /// Harmonics of the period.
    pub harmonics: Vec<Harmonic>,
}

impl Waveform {
    fn new(period: f64, mean: f64, terms: usize, of: impl Fn(f64) -> (f64, f64)) -> Self {
        let harmonic = |order: usize| {
            let (cosine, sine) = of(order as f64);
            Harmonic { order: order as f64, cosine, sine }
        };
        let harmonics = (1..=terms).map(harmonic).filter(|h| h.cosine != 0.0 || h.sine != 0.0);
        Self { period, mean, harmonics: harmonics.collect() }
    }

    /// A triangle between `-amplitude` and `amplitude`, zero and rising at time zero.
    #[must_use]
    pub fn triangle(amplitude: f64, period: f64, terms: usize) -> Self {
        let sign = |n: f64| if n % 4.0 == 1.0 { 1.0 } else { -1.0 };
        let of = |n: f64| (0.0, if n % 2.0 == 1.0 { sign(n) * 8.0 * amplitude / (PI * n).powi(2) } else { 0.0 });
        Self::new(period, 0.0, terms, of)
    }

    /// A square: `amplitude` over the first half of the period, `-amplitude` over the second.
    #[must_use]
    pub fn square(amplitude: f64, period: f64, terms: usize) -> Self {
        Self::new(period, 0.0, terms, |n| (0.0, if n % 2.0 == 1.0 { 4.0 * amplitude / (PI * n) } else { 0.0 }))
    }

    /// A sawtooth that rises from zero to `height` over the period and falls at its end.
    #[must_use]
    pub fn sawtooth_up(height: f64, period: f64, terms: usize) -> Self {
        Self::new(period, 0.5 * height, terms, |n| (0.0, -height / (PI * n)))
    }

    /// A sawtooth that jumps to `height` at the start of the period and falls to zero over it.
    #[must_use]
    pub fn sawtooth_down(height: f64, period: f64, terms: usize) -> Self {
        Self::new(period, 0.5 * height, terms, |n| (0.0, height / (PI * n)))
    }

    /// A sawtooth from `-amplitude` to `amplitude`, zero and rising at time zero.
    #[must_use]
    pub fn sawtooth(amplitude: f64, period: f64, terms: usize) -> Self {
        let sign = |n: f64| if n % 2.0 == 1.0 { 1.0 } else { -1.0 };
        Self::new(period, 0.0, terms, |n| (0.0, sign(n) * 2.0 * amplitude / (PI * n)))
    }

    /// Pulses of `height` that last `width` (s), less than the period, one about time zero.
    #[must_use]
    pub fn pulses(height: f64, width: f64, period: f64, terms: usize) -> Self {
        let share = width / period;
        Self::new(period, share * height, terms, |n| (2.0 * height / (PI * n) * (PI * n * share).sin(), 0.0))
    }

    /// `height |sin(pi t/period)|`: a train of rectified half waves, one to the period.
    #[must_use]
    pub fn rectified(height: f64, period: f64, terms: usize) -> Self {
        Self::new(period, 2.0 * height / PI, terms, |n| (-4.0 * height / (PI * (4.0 * n * n - 1.0)), 0.0))
    }

    /// Value at a time, s.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        let turn = |h: &Harmonic| {
            let (sine, cosine) = (TAU * h.order * time / self.period).sin_cos();
            h.cosine * cosine + h.sine * sine
        };
        self.mean + self.harmonics.iter().map(turn).sum::<f64>()
    }
}

/// The series that a source needs over a stretch.
#[derive(Debug, Clone)]
pub(super) enum Work {
    Nothing,
    Quotient(Box<[Series; 3]>),
    Turns(Vec<Turn>),
    /// The piece that the speed lies in.
    Piece([f64; 3]),
}

impl Source {
    /// The part that depends on time alone, from `t` on over the length `h`.
    pub(super) fn add_over(&self, into: &mut Series, t: f64, h: f64, on_arc: bool) {
        match self {
            Self::Constant(torque) => into[0] += torque,
            Self::Program(program) => {
                let (torque, rate) = program.at(t);
                into[0] += torque;
                into[1] += rate * h;
            }
            Self::Starting { torque, time, power } if t < *time => {
                let (now, step) = (t / time, h / time);
                if *power == 1 {
                    into[0] += torque * (1.0 - now);
                    into[1] -= torque * step;
                } else {
                    into[0] += torque * (1.0 - now * now);
                    into[1] -= 2.0 * torque * now * step;
                    into[2] -= torque * step * step;
                }
            }
            Self::Waveform(wave) => {
                into[0] += wave.mean;
                for harmonic in &wave.harmonics {
                    let omega = TAU * harmonic.order / wave.period;
                    add_harmonic(into, (harmonic.cosine, harmonic.sine), omega, t, h);
                }
            }
            Self::Arc { torque, .. } if on_arc => into[0] += torque,
            _ => {}
        }
    }

    /// Start, end and period of an arc, rad.
    pub(super) fn arc(&self) -> Option<(f64, f64, f64)> {
        match self {
            Self::Arc { from, to, .. } => Some((*from, *to, TAU)),
            Self::Stroke { from, to, turns, .. } => Some((*from, *to, TAU * f64::from(*turns))),
            _ => None,
        }
    }

    /// Speeds, rad/s, at which it changes.
    pub(super) fn ends(&self) -> Option<&[f64]> {
        if let Self::Pieces { ends, .. } = self { Some(ends) } else { None }
    }

    /// With how many ends of its arcs or pieces have been passed.
    pub(super) fn work(&self, passed: i64) -> Work {
        let turns = |orders: &[Harmonic]| Work::Turns(orders.iter().map(|h| Turn::new(h.order)).collect());
        match self {
            Self::Kloss { .. } | Self::Series { .. } => Work::Quotient(Box::new([ZERO; 3])),
            Self::Pieces { torques, .. } => {
                let piece = usize::try_from(passed - 1).ok().and_then(|piece| torques.get(piece));
                piece.map_or(Work::Nothing, |torque| Work::Piece(*torque))
            }
            Self::Orders(orders) => turns(orders),
            Self::Stroke { torque, .. } if passed.rem_euclid(2) == 1 => turns(&torque.0),
            _ => Work::Nothing,
        }
    }

    /// Coefficient `k` of what depends on the motion.
    pub(super) fn follow(&self, work: &mut Work, angle: &Series, speed: &Series, k: usize) -> f64 {
        let one = if k == 0 { 1.0 } else { 0.0 };
        match (self, work) {
            (Self::Line { stall, slope }, _) => stall * one - slope * speed[k],
            (Self::Parabola(a, b, c), _) => a * one + b * speed[k] + c * product(speed, speed, k),
            (Self::Kloss { breakdown, slip: at, synchronous }, Work::Quotient(work)) => {
                let [slip, over, ratio] = &mut **work;
                slip[k] = one - speed[k] / synchronous;
                over[k] = at * at * one + product(slip, slip, k);
                ratio[k] = quotient(slip, over, ratio, k);
                2.0 * breakdown * at * ratio[k]
            }
            (Self::Series { voltage, resistance, flux }, Work::Quotient(work)) => {
                let [supply, over, current] = &mut **work;
                supply[k] = voltage * one;
                over[k] = resistance * one + flux * speed[k];
                current[k] = quotient(supply, over, current, k);
                flux * product(current, current, k)
            }
            (Self::Pieces { .. }, Work::Piece([a, b, c])) => *a * one + *b * speed[k] + *c * product(speed, speed, k),
            (Self::Orders(orders) | Self::Stroke { torque: Orders(orders), .. }, Work::Turns(turns)) => {
                let mut sum = 0.0;
                for (harmonic, turn) in orders.iter().zip(turns) {
                    turn.extend(angle, k);
                    sum += harmonic.cosine * turn.cosine[k] + harmonic.sine * turn.sine[k];
                }
                sum
            }
            _ => 0.0,
        }
    }

    /// The next corner after `time`, s.
    pub(super) fn corner_after(&self, time: f64) -> Option<f64> {
        match self {
            Self::Program(program) => program.corner_after(time),
            Self::Starting { time: end, .. } if *end > time => Some(*end),
            _ => None,
        }
    }

    /// The fastest rate, 1/s, at which it swings with time.
    pub(super) fn rate(&self) -> f64 {
        match self {
            Self::Waveform(wave) => {
                wave.harmonics.iter().map(|h| TAU * h.order.abs() / wave.period).fold(0.0, f64::max)
            }
            _ => 0.0,
        }
    }

    pub(in crate::plant) fn validate(&self, place: Place) -> Result<(), PlantError> {
        let all = |values: &[f64]| values.iter().try_for_each(|&value| finite("torque of a source", place, value));
        let harmonics = |list: &[Harmonic]| list.iter().try_for_each(|h| all(&[h.order, h.cosine, h.sine]));
        match self {
            Self::Constant(torque) => all(&[*torque]),
            Self::Program(program) => program.validate(place),
            Self::Starting { torque, time, power } => {
                positive("starting time", place, *time)?;
                in_range("power of the starting law", place, f64::from(*power), matches!(power, 1 | 2), "1 or 2")?;
                all(&[*torque])
            }
            Self::Waveform(wave) => {
                positive("period", place, wave.period)?;
                finite("mean torque", place, wave.mean)?;
                harmonics(&wave.harmonics)
            }
            Self::Line { stall, slope } => all(&[*stall, *slope]),
            Self::Parabola(a, b, c) => all(&[*a, *b, *c]),
            Self::Kloss { breakdown, slip, synchronous } => {
                positive("breakdown slip", place, *slip)?;
                positive("synchronous speed", place, *synchronous)?;
                all(&[*breakdown])
            }
            Self::Series { voltage, resistance, flux } => {
                positive("flux", place, *flux)?;
                in_range("resistance", place, *resistance, *resistance >= 0.0, "zero or above")?;
                all(&[*voltage, *resistance])
            }
            Self::Pieces { ends, torques } => {
                for pair in ends.windows(2) {
                    in_range("end of a piece", place, pair[1], pair[1] > pair[0], "above the end before it")?;
                }
                let count = torques.len() as f64;
                in_range("pieces", place, count, torques.len() + 1 == ends.len(), "one less than the ends")?;
                all(ends)?;
                torques.iter().try_for_each(|torque| all(torque))
            }
            Self::Arc { torque, from, to } => {
                in_range("start of an arc", place, *from, (0.0..TAU).contains(from), "from 0 to less than 2 pi")?;
                in_range("end of an arc", place, *to, to > from && *to < TAU, "after its start, below 2 pi")?;
                all(&[*torque])
            }
            Self::Stroke { torque, from, to, turns } => {
                let end = TAU * f64::from(*turns);
                in_range("start of an arc", place, *from, (0.0..end).contains(from), "from 0 to less than its turns")?;
                let within = to > from && *to < from + end;
                in_range("end of an arc", place, *to, within, "after its start, by less than its turns")?;
                harmonics(&torque.0)
            }
            Self::Orders(orders) => harmonics(orders),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::plant::train::source::*;

    #[test]
    fn the_waveforms_converge_to_their_shapes() {
        // away from the jumps the rest of a series is about its first term left out, 4 A/(pi n) with A = 2 for the
        // square
        let near = |wave: &Waveform, time: f64, expected: f64| {
            assert!((wave.at(time) - expected).abs() < 6.4e-4, "{time}: {} {expected}", wave.at(time));
        };
        let n = 4000;
        near(&Waveform::triangle(2.0, 4.0, n), 0.5, 1.0);
        near(&Waveform::triangle(2.0, 4.0, n), 1.0, 2.0);
        near(&Waveform::triangle(2.0, 4.0, n), 3.5, -1.0);
        near(&Waveform::square(2.0, 4.0, n), 1.0, 2.0);
        near(&Waveform::square(2.0, 4.0, n), 3.0, -2.0);
        near(&Waveform::sawtooth_up(3.0, 3.0, n), 1.0, 1.0);
        near(&Waveform::sawtooth_down(3.0, 3.0, n), 1.0, 2.0);
        near(&Waveform::sawtooth(2.0, 4.0, n), 1.0, 1.0);
        near(&Waveform::sawtooth(2.0, 4.0, n), 3.0, -1.0);
        near(&Waveform::pulses(2.0, 1.0, 4.0, n), 0.0, 2.0);
        near(&Waveform::pulses(2.0, 1.0, 4.0, n), 3.75, 2.0);
        near(&Waveform::pulses(2.0, 1.0, 4.0, n), 2.0, 0.0);
        near(&Waveform::rectified(3.0, 3.0, n), 1.5, 3.0);
        near(&Waveform::rectified(3.0, 3.0, n), 0.5, 1.5);
    }
}
