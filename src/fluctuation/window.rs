//! From the bins of a finished window to the waveform of the speed: slowness first, then its inverse.

mod ramp;

use core::f64::consts::TAU;

use super::deviation::{Left, deviation, sensitivity};
use super::extremes::{Extreme, Fluctuations};
use super::position::RADIANS;
use super::quality::{Quality, Unusable};
use super::series::{GRID, Order, Series, circle};
use super::{Bin, Edge, Summed, WaveformConfig};
use crate::math::{nearest, sin_cos, sqrt};

pub use super::series::MAX_ORDER;
pub(super) use ramp::Ramp;

/// A finished window, as it was taken from a [`super::Waveform`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Window<N: Summed, const BINS: usize> {
    pub(super) bins: [Bin<N>; BINS],
    pub(super) edges: [Edge<N>; 4],
    pub(super) cycles: u32,
    pub(super) forward: bool,
}

/// Periodic part (ripple) and trend of a window.
///
/// ```
#[doc = include_str!("ripple.txt")]
/// const CONFIG: WaveformConfig = WaveformConfig::new::<64>(CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI), 16);
/// let mut waveform = Waveform::<64, f64>::default();
/// let window = turning().find_map(|(angle, _)| {
///     waveform.measure(&CONFIG, angle, 0.0, &Estimate::default());
///     waveform.take()
/// });
/// let ripple = window.ok_or("it turns on and on")?.ripple(&CONFIG, 4)?;
/// assert!((ripple.speed.order(1).amplitude() - 0.02 * 150.0).abs() < 0.01);
/// // 4 % from peak to peak at a steady mean: a flywheel for 1 %
/// assert_eq!(ripple.remedy(0.01, 0.01), Remedy::Flywheel);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ripple {
    /// Mean speed by time (rad/s); negative backwards.
    pub mean: f64,
    /// Acceleration of the cycle's mean speed over the window (rad/s2): the part that is not periodic, which a governor
    /// mends and a flywheel does not; 0 over a single cycle.
    pub acceleration: f64,
    /// The motor's speed over the angle of the cycle (rad/s), its trend taken off.
    pub speed: Series,
    /// Its extremes, and delta.
    pub motor: Fluctuations,
    /// Cycles that it is the mean of.
    pub cycles: u32,
    /// How far it can be relied on.
    pub quality: Quality,
}

impl<N: Summed, const BINS: usize> Window<N, BINS> {
    /// The bins, the first one beginning where the cycle does.
    pub fn bins(&self) -> &[Bin<N>; BINS] {
        &self.bins
    }

    /// The waveform of the motor's speed with the orders up to `highest`, which counts at most [`MAX_ORDER`] and a
    /// quarter of the bins.
    ///
    /// The integral of a function of the angle over time is, bin by bin, that of the parabola nearest to it. At the two
    /// ends of the window the parts between a cycle's end and the first tick counted are put right. The trend of the
    /// slowness, a sawtooth over the cycle, is taken off, as that of a steady acceleration. Where the cycle has nearly
    /// a whole number of ticks, fewer than some five to a bin, the eighth order of 64 bins may be off by 2e-3: take
    /// more bins, or fewer orders.
    ///
    /// Not for the tick: some thousand operations in `f64`, and sines.
    ///
    /// # Errors
    /// [`Unusable::Ticks`] where the motor turns so fast that the work at the end of a cycle, a slice in every other
    /// tick, comes late; [`Unusable::Trend`].
    pub fn ripple(&self, config: &WaveformConfig, highest: usize) -> Result<Ripple, Unusable> {
        let highest = highest.min(MAX_ORDER).min(BINS / 4);
        let cycles = f64::from(self.cycles.max(1));
        let sign = if self.forward { 1.0 } else { -1.0 };
        // back again while the end of a cycle was dealt with: the ticks there are not one way
        if self.edges.iter().any(|edge| sign * edge.speed.to_real() < 0.0) {
            return Err(Unusable::Trend);
        }
        // some orders more, which show the noise
        let fitted = (highest + NEXT).min(MAX_ORDER).min(BINS / 4);
        let mut counted = Series::default();
        for (n, order) in (1_u32..).zip(counted.orders.iter_mut().take(fitted)) {
            *order = self.counted(f64::from(n));
            order.sin *= sign;
        }
        // The time from a cycle's end to the tick that noticed it, and the integrals over it, are known from the
        // waveform that they belong to.
        let [first, _, _, last] = self.edges;
        let whole = f64::from(last.tick.wrapping_sub(first.tick).max(1));
        let cycle = whole / cycles;
        let is_turn = (config.cycle.angle - TAU).abs() < 1e-9;
        let few = !(is_turn && self.cycles >= 8) && cycle * TAU < Unusable::OF_A_TURN * config.cycle.angle;
        if few || cycle < Unusable::TICKS * (f64::from(config.cycle.last_segment) + 1.0) {
            return Err(Unusable::Ticks);
        }
        let mut ticks = whole;
        let mut slowness = Series { mean: 1.0, ..Series::default() };
        let mut beyond_highest = [Order::default(); MAX_ORDER];
        let mut ramp = Ramp { ends: [TAU * cycles / whole; 2], ..Ramp::default() };
        for _ in 0..ROUNDS {
            let ends = self.ends(&slowness, ramp.ends, config.cycle.angle);
            ticks = ends.ticks;
            ramp = Ramp::of(ends.ticks, ends.opening, ends.closing, self.cycles);
            let mut integrals = counted;
            for (n, order) in (1_u32..).zip(integrals.orders.iter_mut().take(fitted)) {
                for (part, weight) in ends.parts.iter().zip([1.0, -1.0]) {
                    let n = f64::from(n);
                    let (cos, sin) = part.integral(&slowness, n);
                    let (beyond_cos, beyond_sin) = part.sampled(&slowness, n);
                    order.cos += weight * (cos + beyond_cos);
                    order.sin += weight * (sin + beyond_sin);
                }
            }
            slowness = ramp.taken_off(&slowness, &integrals, ticks, fitted);
            for (order, kept) in slowness.orders.iter_mut().zip(&mut beyond_highest).skip(highest) {
                *kept = core::mem::take(order);
            }
        }
        for order in &mut slowness.orders {
            order.sin *= sign;
        }
        let (mut coefficient, mut beyond) = (0.0, 0.0);
        let orders = (fitted - highest).max(1) as f64;
        for (n, order) in (1_u32..).zip(&beyond_highest).take(fitted).skip(highest) {
            let square = order.cos * order.cos + order.sin * order.sin;
            coefficient += 0.5 * square / (TAU * TAU * f64::from(n * n)) / orders;
            beyond += if n as usize <= highest + 2 { square } else { 0.0 };
        }
        let rise = ramp.slowness * TAU * cycles / ticks / f64::from(self.cycles.max(1));
        if rise.abs() > Unusable::RISE {
            return Err(Unusable::Trend);
        }
        let left = self.left(&slowness, highest);
        let quality = Quality { residue: left.rms() * config.cycle.angle, trend: rise, ..Quality::default() };
        let mean = sign * cycles * config.cycle.angle / (ticks * config.cycle.period);
        let per_tick = config.cycle.angle / TAU / config.cycle.period;
        let acceleration = sign * per_tick * ramp.acceleration / config.cycle.period;
        let ripple = Ripple::of(slowness, mean, acceleration, config.cycle.angle, highest, self.cycles);
        let mut ripple = Ripple { quality, ..ripple };
        let at = [ripple.motor.max, ripple.motor.min].map(|extreme| extreme.angle * TAU / config.cycle.angle);
        if fitted < highest + 4 {
            (coefficient, beyond) = (left.of_coefficient(left.variance()), left.beyond());
        } else {
            // Three deviations by few values are exceeded as seldom as by many (Student's distribution).
            coefficient *= 1.0 + 2.0 / orders + 8.0 / (orders * orders);
        }
        // Ticks that come back to the same angles have the same rounding in every cycle, which stands in a few orders.
        let again = ticks / cycles;
        coefficient *= 1.0 + 3.0 / (1.0 + 0.5 * TAU * cycles * (again - nearest(again)).abs());
        let beats = Self::beats(again, cycles, highest);
        let own = coefficient * sensitivity(&slowness, at, highest).square() + beats;
        ripple.motor.deviation = deviation(&slowness, at, [own, coefficient, beyond], highest);
        if ripple.turns_one_way() { Ok(ripple) } else { Err(Unusable::Trend) }
    }

    /// Variance of a delta by the beats of ticks and bins: a bin's moments leave the third power of the angle, which
    /// shows as the order by which the ticks to the cycle differ from a multiple of the bins. Ticks that go on within
    /// the bins from cycle to cycle smooth it. The factor is that of uniform motion, of 20,000 windows.
    fn beats(ticks: f64, cycles: f64, highest: usize) -> f64 {
        let (mut sum, each) = (0.0, ticks / BINS as f64);
        for n in (1_u32..).take(highest).map(f64::from) {
            let h = n * TAU / BINS as f64;
            for beside in [-n, n] {
                let multiple = (ticks + beside) / BINS as f64;
                let apart = (multiple - nearest(multiple)).abs() * BINS as f64;
                let amplitude = 0.0073 * h * h * h / (each * each) / (1.0 + 0.5 * TAU * cycles * apart);
                sum += 2.0 * amplitude * amplitude;
            }
        }
        sum
    }

    /// By how much the ticks counted up to the end of each bin differ from the waveform.
    fn left(&self, slowness: &Series, highest: usize) -> Left {
        let total: f64 = self.bins.iter().map(|bin| f64::from(bin.ticks)).sum();
        let (mut counted, mut left) = (0.0, Left::new(highest));
        for (index, bin) in (1_u32..).zip(&self.bins) {
            counted += f64::from(bin.ticks);
            let place = f64::from(index) / BINS as f64;
            // The integral of the slowness over the angle, but for a constant.
            let mut late = 0.0;
            for (n, order) in (1_u32..).zip(&slowness.orders) {
                let n = f64::from(n);
                let (s, c) = sin_cos(n * TAU * place);
                late += (order.cos * s - order.sin * c) / n;
            }
            left.add(place, counted / total.max(1.0) - place - late / TAU);
        }
        left
    }

    /// Sum of cos(n theta) and sin(n theta) over the ticks that were counted. Of many in a bin it is that of the
    /// polynomials nearest over the bin. A few are at the same angles in every cycle where it has a whole number of
    /// them: the sum is that of two angles with their mean and variance.
    fn counted(&self, n: f64) -> Order {
        let h = n * TAU / BINS as f64;
        // sin(n e) = n e (1 - h^2/40) and cos(n e) = constant + slope (n e)^2
        let sine = 1.0 - h * h / 40.0;
        let constant = 1.0 - h * h * h * h / 4480.0;
        let square = -0.5 + h * h / 112.0;
        let mut sum = Order::default();
        for (index, bin) in (0_u32..).zip(&self.bins).filter(|(_, bin)| bin.ticks > 0) {
            let ticks = f64::from(bin.ticks);
            // The distances were rounded down: half a unit is missing, with its effect on the squares.
            let first = f64::from(bin.first) / 1024.0 + 0.5 * ticks / 1024.0;
            let second = if bin.ticks > SQUARES {
                first * first / ticks + ticks / 12.0
            } else {
                (f64::from(bin.second) + 256.0 * first - ticks / 6.0) / 65_536.0
            };
            let (even, odd) = if ticks > MANY * f64::from(self.cycles) {
                (constant * ticks + square * h * h * second, sine * h * first)
            } else {
                let mean = first / ticks;
                let (sin, cos) = sin_cos(h * mean);
                let (_, apart) = sin_cos(h * sqrt((second / ticks - mean * mean).max(0.0)));
                (ticks * apart * cos, ticks * apart * sin)
            };
            let (s, c) = sin_cos(h * (f64::from(index) + 0.5));
            sum.cos += c * even - s * odd;
            sum.sin += s * even + c * odd;
        }
        sum
    }

    /// The two ends of the window, by the ripple and the speeds without it there (2 pi to the cycle, over ticks).
    fn ends(&self, ripple: &Series, [from, to]: [f64; 2], angle: f64) -> Ends {
        let [first, second, last_but_one, last] = self.edges;
        let part = |edge: &Edge<N>, speed| Part { turned: f64::from(edge.beyond) * RADIANS * TAU / angle, speed };
        let late = |edge: &Edge<N>, speed| part(edge, speed).integral(ripple, 0.0).0;
        let between = |early: &Edge<N>, late_edge: &Edge<N>, from: f64, to: f64| {
            f64::from(late_edge.tick.wrapping_sub(early.tick)) + (late(early, from) - late(late_edge, to))
        };
        // half a tick less
        let counted = |edge: &Edge<N>, speed| {
            let Part { turned, .. } = part(edge, speed);
            Part { turned: turned - 0.5 * speed / ripple.at(turned), speed }
        };
        Ends {
            ticks: between(&first, &last, from, to),
            opening: between(&first, &second, from, from),
            closing: between(&last_but_one, &last, to, to),
            parts: [counted(&first, from), counted(&last, to)],
        }
    }
}

impl Ripple {
    /// Whether no speed of the cycle is against the mean: a stop within the window may fit orders that pass through
    /// infinity.
    pub(super) fn turns_one_way(&self) -> bool {
        [self.motor.min, self.motor.max].iter().all(|extreme| extreme.speed / self.mean > 0.0)
    }

    /// From the slowness over its mean.
    pub(super) fn of(
        slowness: Series,
        mean: f64,
        acceleration: f64,
        angle: f64,
        highest: usize,
        cycles: u32,
    ) -> Ripple {
        let circle = circle();
        let fast = slowness.grid(&circle).map(|slowness| mean / slowness);
        let speed = Series::of(&fast, &circle, highest);
        let (mut least, mut most) = ((0, f64::INFINITY), (0, f64::NEG_INFINITY));
        for (index, &value) in (0_u32..).zip(&fast) {
            if value < least.1 {
                least = (index, value);
            }
            if value > most.1 {
                most = (index, value);
            }
        }
        let extreme = |(index, _): (u32, f64)| {
            let theta = slowness.stationary(TAU * f64::from(index) / GRID as f64);
            let within = if theta < 0.0 { theta + TAU } else { theta };
            Extreme { speed: mean / slowness.at(theta), angle: within / TAU * angle }
        };
        let motor = Fluctuations::of(extreme(most), extreme(least), mean);
        Ripple { mean, acceleration, speed, motor, cycles, quality: Quality::default() }
    }
}

/// How long a window was, in ticks.
struct Ends {
    /// The whole of it.
    ticks: f64,
    /// Its first cycle.
    opening: f64,
    /// Its last cycle.
    closing: f64,
    /// From the first end of a cycle to half a tick before the first tick that was counted; from the last end to half a
    /// tick before the first that was not.
    parts: [Part; 2],
}

/// From a cycle's end on.
struct Part {
    /// How far the motor turned (2 pi to the cycle).
    turned: f64,
    /// Its speed without the ripple (the same, over ticks).
    speed: f64,
}

impl Part {
    /// Integral of e^(j n theta) over the time (ticks).
    fn integral(&self, ripple: &Series, n: f64) -> (f64, f64) {
        let order = |k: f64| {
            let (sin, cos) = sin_cos(k * self.turned);
            if k == 0.0 { (self.turned, 0.0) } else { (sin / k, (1.0 - cos) / k) }
        };
        let (re, im) = times_ripple(ripple, n, order);
        let (a, b) = order(n);
        ((a + re) / self.speed, (b + im) / self.speed)
    }

    /// By how much the sum over the ticks of e^(j n theta) is beyond its integral, up to here: the integral's
    /// antiderivative times `x/sin x` less 1, with x half of the order's turn in a tick.
    fn sampled(&self, ripple: &Series, n: f64) -> (f64, f64) {
        let turn = n * self.speed / ripple.at(self.turned);
        let square = 0.25 * turn * turn;
        let share = square * (1.0 / 6.0 + square * (7.0 / 360.0 + square * 31.0 / 15_120.0)) / turn;
        let (sin, cos) = sin_cos(n * self.turned);
        (share * sin, -share * cos)
    }
}

/// Integral of the ripple's orders times e^(j n theta), from that of e^(j k theta): half of an order belongs to each of
/// n - m and n + m.
fn times_ripple(ripple: &Series, n: f64, integral: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
    let mut sum = (0.0, 0.0);
    for (m, order) in (1_u32..).zip(ripple.orders.iter().take(ripple.highest())) {
        let m = f64::from(m);
        for (k, re, im) in [(n - m, order.cos, order.sin), (n + m, order.cos, -order.sin)] {
            let (a, b) = integral(k);
            sum.0 += 0.5 * (re * a - im * b);
            sum.1 += 0.5 * (re * b + im * a);
        }
    }
    sum
}

/// Ticks of a cycle in a bin from which on their places count as spread evenly.
const MANY: f64 = 16.0;
/// Ticks in a bin whose squares of 2^14 have room in its sum; of more a spread as even is taken.
const SQUARES: u32 = 1 << 18;

/// Orders beyond the highest that show the noise of the others.
const NEXT: usize = 8;

/// How often the trend and the ends are put right anew, by the ripple that is then known; each round is closer by the
/// ratio of trend and mean.
const ROUNDS: u32 = 4;

#[cfg(test)]
mod tests;
