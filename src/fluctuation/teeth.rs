//! Ripple from the times of a wheel's teeth.
//!
//! The lateness of each tooth against an even cycle is averaged over several cycles, each taken by its own length. It
//! is the ripple's integral plus the wheel's pitch errors: a tooth displaced by a tenth of a degree appears as a delta
//! of 1/500. So the errors are learnt while there is no ripple, as the machine coasts without fuel or load, and taken
//! off. The orders follow from the lateness by least squares, whatever the places of the teeth.

use core::f64::consts::TAU;

use super::deviation::{Left, deviation, sensitivity};
use super::quality::{Quality, Unusable};
use super::series::{FourierSeries, Order};
use super::{MAX_ORDER, Ripple};
use crate::math::{ln, sin_cos, sqrt};
use crate::wheel::{LOST, ToothCycle, ToothedWheelConfig};

/// The cycles of a wheel's teeth, `TEETH` of them to a cycle: 58 of a 60-2 wheel that turns once in it, 116 where it
/// turns twice.
///
/// ```
/// use driveline::fluctuation::ToothWindow;
/// use driveline::settings::{Teeth, ToothClock};
/// use driveline::wheel::{CycleTimes, ToothedWheel, ToothedWheelConfig};
/// // a 60-2 wheel at 100 turns a second, on a clock of 6 MHz: 1000 counts from tooth to tooth
/// const CONFIG: ToothedWheelConfig<58> =
///     ToothedWheelConfig::new(&Teeth::gap(60, 2), ToothClock { turns: 1, clock: 6e6, lowest_speed: 10.0 });
/// let (mut wheel, mut window) = (ToothedWheel::<CycleTimes<58>>::default(), ToothWindow::<58>::default());
/// for place in (0..60 * 20_u32).filter(|place| place % 60 < 58) {
///     wheel.tooth(&CONFIG, 1000 * place);
///     if let Some(cycle) = wheel.take() {
///         window.add(&CONFIG, &cycle);
///     }
/// }
/// let ripple = window.ripple(&CONFIG, &window.errors(&CONFIG), 4)?;
/// assert!((ripple.mean - 628.32).abs() < 0.01 && ripple.motor.delta < 1e-6);
/// # Ok::<(), driveline::fluctuation::Unusable>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothWindow<const TEETH: usize> {
    /// Sums of the lateness (cycle).
    late: [f32; TEETH],
    /// Sum of its squares over all teeth (cycle2).
    squares: f64,
    cycles: u32,
    /// Length of all cycles, of the first and of the last (s).
    whole: f64,
    opening: f64,
    closing: f64,
    /// Number of the last cycle.
    number: u32,
    missed: u32,
}

/// Delay of each tooth behind its place (rad), 2 pi to the cycle, less the first's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothErrors<const TEETH: usize>([f32; TEETH]);

impl<const TEETH: usize> ToothErrors<TEETH> {
    /// A perfect wheel.
    pub const NONE: Self = ToothErrors([0.0; TEETH]);

    /// The errors, tooth by tooth.
    pub fn radians(&self) -> &[f32; TEETH] {
        &self.0
    }
}

impl<const TEETH: usize> Default for ToothWindow<TEETH> {
    fn default() -> Self {
        ToothWindow {
            late: [0.0; TEETH],
            squares: 0.0,
            cycles: 0,
            whole: 0.0,
            opening: 0.0,
            closing: 0.0,
            number: 0,
            missed: 0,
        }
    }
}

/// Angle of a cycle's tooth (cycle).
fn place<const WHEEL: usize>(config: &ToothedWheelConfig<WHEEL>, tooth: usize) -> f64 {
    let (turn, in_turn) = (tooth / WHEEL.max(1), tooth % WHEEL.max(1));
    let angle = config.teeth.get(in_turn).map_or(0, |tooth| tooth.angle);
    (f64::from(turn as u32) + f64::from(angle) / 4_294_967_296.0) / f64::from(config.turns.max(1))
}

impl<const TEETH: usize> ToothWindow<TEETH> {
    /// Adds a cycle, in the main loop; the same one a second time is left out. One from after a lost place begins the
    /// window anew: it may have another phase. A tooth without an edge counts as late as its neighbours.
    pub fn add<const WHEEL: usize>(&mut self, config: &ToothedWheelConfig<WHEEL>, cycle: &ToothCycle<TEETH>) {
        let length = f64::from(cycle.length());
        if length <= 0.0 {
            return;
        }
        let steps = cycle.number().wrapping_sub(self.number);
        if self.cycles > 0 && steps == 0 {
            return;
        }
        // forwards the place was lost, backwards the wheel itself began anew
        if self.cycles > 0 && steps >= LOST {
            *self = ToothWindow::default();
        }
        let first = place(config, 0);
        let mut late = [None; TEETH];
        for (tooth, (late, since)) in late.iter_mut().zip(cycle.since_first()).enumerate() {
            *late = since.map(|since| (f64::from(since) / length - (place(config, tooth) - first)) as f32);
        }
        let (mut last, mut sum) = (0.0, 0.0);
        for tooth in 0..TEETH {
            let own = late.get(tooth).copied().flatten().unwrap_or_else(|| {
                let next = late.iter().skip(tooth).find_map(|late| *late).unwrap_or(0.0);
                0.5 * (last + next)
            });
            last = own;
            sum += f64::from(own) * f64::from(own);
            if let Some(late) = self.late.get_mut(tooth) {
                *late += own;
            }
        }
        self.squares += sum;
        let seconds = length * config.period;
        if self.cycles == 0 {
            self.opening = seconds;
        } else {
            self.missed = self.missed.saturating_add(steps.wrapping_sub(1));
        }
        self.number = cycle.number();
        self.closing = seconds;
        self.whole += seconds;
        self.cycles += 1;
    }

    /// Cycles so far.
    pub fn cycles(&self) -> u32 {
        self.cycles
    }

    /// Relative rise of the slowness over a cycle, and the acceleration of the mean speed of a cycle of so many turns
    /// (rad/s2).
    fn trend(&self, angle: f64) -> (f64, f64) {
        if self.cycles < 2 || self.opening <= 0.0 || self.closing <= 0.0 {
            return (0.0, 0.0);
        }
        // Cycles that were missed have passed all the same.
        let between = f64::from(self.cycles - 1) + f64::from(self.missed);
        let rise = (ln(self.closing) - ln(self.opening)) / between;
        let mean = self.whole / f64::from(self.cycles);
        (rise, (angle / self.closing - angle / self.opening) / (between * mean))
    }

    /// The mean lateness of each tooth (cycle), the trend taken off.
    fn lateness<const WHEEL: usize>(&self, config: &ToothedWheelConfig<WHEEL>, rise: f64) -> [f64; TEETH] {
        let mut mean = [0.0; TEETH];
        let first = place(config, 0);
        for (tooth, (mean, &late)) in mean.iter_mut().zip(&self.late).enumerate() {
            let x = place(config, tooth) - first;
            // The integral of rise (x - 1/2), and of the slope's own change under a steady acceleration.
            let bend = 0.5 * (x * x - x) * rise * (1.0 + 0.5 * rise * (2.0 * x - 1.0));
            *mean = f64::from(late) / f64::from(self.cycles.max(1)) - bend;
        }
        mean
    }

    /// The wheel's errors, from a window in which the machine had no ripple: it coasted, without fuel and without load.
    /// Over some 16 turns: fewer average less of the clock's rounding.
    pub fn errors<const WHEEL: usize>(&self, config: &ToothedWheelConfig<WHEEL>) -> ToothErrors<TEETH> {
        let (rise, _) = self.trend(1.0);
        let mut errors = [0.0; TEETH];
        for (error, late) in errors.iter_mut().zip(self.lateness(config, rise)) {
            *error = (late * TAU) as f32;
        }
        ToothErrors(errors)
    }

    /// The waveform of the wheel's speed with the orders up to `highest`, which counts at most [`MAX_ORDER`] and a
    /// quarter of the teeth.
    ///
    /// Take no more orders than the machine has: the clock's rounding, which a steady speed may repeat in every turn,
    /// shows in the n-th order n times.
    ///
    /// # Errors
    /// A window that cannot be used, with the cause.
    pub fn ripple<const WHEEL: usize>(
        &self,
        config: &ToothedWheelConfig<WHEEL>,
        errors: &ToothErrors<TEETH>,
        highest: usize,
    ) -> Result<Ripple, Unusable> {
        if self.cycles == 0 {
            return Err(Unusable::NoCycle);
        }
        let highest = highest.min(MAX_ORDER).min(TEETH / 4);
        let angle = TAU * f64::from(config.turns);
        let (rise, acceleration) = self.trend(angle);
        if rise.abs() > Unusable::RISE {
            return Err(Unusable::Trend);
        }
        let late = self.lateness(config, rise);
        let mut slowness = FourierSeries::constant(1.0);
        let mut fit = FourierSeries::default();
        let mut own = late;
        // The passage of a tooth's error depends on the slowness there.
        let rounds = if errors.0.iter().all(|error| *error == 0.0) { 1 } else { 3 };
        for _ in 0..rounds {
            for (tooth, (own, (&late, &error))) in own.iter_mut().zip(late.iter().zip(&errors.0)).enumerate() {
                *own = late - f64::from(error) / TAU * slowness.at(TAU * place(config, tooth));
            }
            fit = fitted(config, &own, &fit, highest);
            // Time over the cycle's is theta/2 pi and the lateness; its derivative is the slowness over its mean.
            slowness = fit.derivative();
            slowness.mean = 1.0;
            for order in &mut slowness.orders {
                *order = Order { cos: TAU * order.cos, sin: TAU * order.sin };
            }
        }
        let mut rest = Left::new(highest);
        for (tooth, &own) in own.iter().enumerate() {
            let left = own - fit.at(TAU * place(config, tooth));
            let slack = config.teeth.get(tooth % WHEEL.max(1)).map_or(0, |tooth| tooth.slack);
            if left.abs() * f64::from(config.turns) > f64::from(slack) / 4_294_967_296.0 * Unusable::TOOTH {
                return Err(Unusable::Teeth);
            }
            rest.add(place(config, tooth), left);
        }
        let teeth = TEETH.max(1) as f64;
        let mean_square: f64 = self.late.iter().map(|&late| f64::from(late) * f64::from(late)).sum::<f64>()
            / f64::from(self.cycles)
            / f64::from(self.cycles);
        let spread = self.squares / f64::from(self.cycles) - mean_square;
        let quality = Quality {
            residue: rest.rms() * angle,
            spread: if self.cycles > 1 { sqrt((spread / teeth).max(0.0)) * angle } else { 0.0 },
            trend: rise,
            missed: self.missed,
        };
        let speed = f64::from(self.cycles) * angle / self.whole;
        let mut ripple = Ripple { quality, ..Ripple::of(slowness, speed, acceleration, angle, highest, self.cycles) };
        // What the orders leave shows the error of a tooth: the clock's rounding, its pitch, higher orders. A rounding
        // that repeats in every cycle need not show there.
        let (cycles, spread) = (f64::from(self.cycles), (spread / teeth).max(0.0));
        let count = config.period * cycles / self.whole;
        let tooth = rest.variance().max((count * count / 12.0 - spread).max(0.0) + spread / cycles);
        let at = [ripple.motor.max, ripple.motor.min].map(|extreme| extreme.angle / f64::from(config.turns));
        let by = sensitivity(&slowness, at, highest);
        let own = tooth * product(&by, &solved::<WHEEL, TEETH>(config, by));
        let parts = [own, rest.of_coefficient(tooth), rest.beyond()];
        ripple.motor.deviation = deviation(&slowness, at, parts, highest);
        if ripple.turns_one_way() { Ok(ripple) } else { Err(Unusable::Trend) }
    }
}

/// Most steps of the least squares; each is closer by a factor that grows with the evenness of the teeth.
const STEPS: u32 = 40;

/// The mean and the orders of values at the teeth by least squares, from a first guess.
fn fitted<const WHEEL: usize, const TEETH: usize>(
    config: &ToothedWheelConfig<WHEEL>,
    values: &[f64; TEETH],
    guess: &FourierSeries,
    highest: usize,
) -> FourierSeries {
    let left = |tooth: usize, series: &FourierSeries| {
        let (sin, cos) = sin_cos(TAU * place(config, tooth));
        values.get(tooth).map_or(0.0, |value| value - series.along(cos, sin))
    };
    let found = solved::<WHEEL, TEETH>(config, summed::<WHEEL, TEETH>(config, highest, |tooth| left(tooth, guess)));
    combined(guess, 1.0, &found)
}

/// Sum of the teeth's values times 1, cos n theta and sin n theta.
fn summed<const WHEEL: usize, const TEETH: usize>(
    config: &ToothedWheelConfig<WHEEL>,
    highest: usize,
    value: impl Fn(usize) -> f64,
) -> FourierSeries {
    let mut sum = FourierSeries::default();
    for tooth in 0..TEETH {
        let (value, (sin, cos)) = (value(tooth), sin_cos(TAU * place(config, tooth)));
        sum.mean += value;
        let (mut c, mut s) = (1.0, 0.0);
        for order in sum.orders.iter_mut().take(highest) {
            (c, s) = (c * cos - s * sin, s * cos + c * sin);
            order.cos += value * c;
            order.sin += value * s;
        }
    }
    sum
}

/// Solves the normal equations for a right-hand side by conjugate gradients (Bjorck, Numerical Methods for Least
/// Squares Problems, 7.4.1).
fn solved<const WHEEL: usize, const TEETH: usize>(
    config: &ToothedWheelConfig<WHEEL>,
    right: FourierSeries,
) -> FourierSeries {
    let highest = right.highest();
    let (mut series, mut left, mut direction) = (FourierSeries::default(), right, right);
    let first = product(&left, &left);
    let mut size = first;
    for _ in 0..STEPS {
        // The orders are then right to 1e-9 of the largest.
        if size <= 1e-18 * first || size <= 1e-30 {
            break;
        }
        let along = summed::<WHEEL, TEETH>(config, highest, |tooth| {
            let (sin, cos) = sin_cos(TAU * place(config, tooth));
            direction.along(cos, sin)
        });
        let square = product(&direction, &along);
        if square <= 0.0 {
            break;
        }
        series = combined(&series, size / square, &direction);
        left = combined(&left, -size / square, &along);
        let last = size;
        size = product(&left, &left);
        direction = combined(&left, size / last, &direction);
    }
    series
}

fn product(a: &FourierSeries, b: &FourierSeries) -> f64 {
    a.mean * b.mean + a.orders.iter().zip(&b.orders).map(|(a, b)| a.cos * b.cos + a.sin * b.sin).sum::<f64>()
}

/// `a + share b`.
fn combined(a: &FourierSeries, share: f64, b: &FourierSeries) -> FourierSeries {
    let mut sum = *a;
    sum.mean += share * b.mean;
    for (sum, b) in sum.orders.iter_mut().zip(&b.orders) {
        *sum = Order { cos: sum.cos + share * b.cos, sin: sum.sin + share * b.sin };
    }
    sum
}

#[cfg(test)]
mod tests;
