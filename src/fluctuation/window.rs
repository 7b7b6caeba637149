//! From the bins of a finished window to the waveform of the speed: slowness first, then its inverse.

mod ramp;

use core::f64::consts::TAU;

use super::deviation::{Left, deviation, sensitivity};
use super::extremes::Fluctuations;
use super::position::RADIANS;
use super::quality::{Quality, Unusable};
use super::series::{FourierSeries, Order, circle};
use super::{Bin, Edge, Summed, WaveformConfig};
use crate::number::Real;

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
pub struct Ripple<R = f64> {
    /// Mean speed by time (rad/s); negative backwards.
    pub mean: R,
    /// Acceleration of the cycle's mean speed over the window (rad/s2): the part that is not periodic, which a governor
    /// mends and a flywheel does not; 0 over a single cycle.
    pub acceleration: R,
    /// The motor's speed over the angle of the cycle (rad/s), its trend taken off.
    pub speed: FourierSeries<R>,
    /// Its extremes, and delta.
    pub motor: Fluctuations<R>,
    /// Cycles that it is the mean of.
    pub cycles: u32,
    /// How far it can be relied on.
    pub quality: Quality<R>,
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
    /// Not for the tick: some thousand operations, and sines.
    ///
    /// # Errors
    /// [`Unusable::Ticks`] where the motor turns so fast that the work at the end of a cycle, a slice in every other
    /// tick, comes late; [`Unusable::Trend`].
    pub fn ripple(&self, config: &WaveformConfig, highest: usize) -> Result<Ripple<N::Real>, Unusable> {
        let r = <N::Real as Real>::of;
        let (zero, one) = (N::Real::ZERO, N::Real::ONE);
        let (angle, period) = (r(config.cycle.angle), r(config.cycle.period));
        let highest = highest.min(MAX_ORDER).min(BINS / 4);
        let cycles = N::Real::count(self.cycles.max(1));
        let sign = if self.forward { one } else { -one };
        // back again while the end of a cycle was dealt with: the ticks there are not one way
        if self.edges.iter().any(|edge| sign * edge.speed.real() < zero) {
            return Err(Unusable::Trend);
        }
        // some orders more, which show the noise
        let fitted = (highest + NEXT).min(MAX_ORDER).min(BINS / 4);
        let mut counted = FourierSeries::default();
        for (n, order) in (1_u32..).zip(counted.orders.iter_mut().take(fitted)) {
            *order = self.counted(n);
            order.sin *= sign;
        }
        // The time from a cycle's end to the tick that noticed it, and the integrals over it, are known from the
        // waveform that they belong to.
        let [first, _, _, last] = self.edges;
        let whole = N::Real::count(last.tick.wrapping_sub(first.tick).max(1));
        let cycle = whole / cycles;
        let is_turn = config.cycle.length == 1 << 30 && config.cycle.last_segment == 3;
        let few = !(is_turn && self.cycles >= 8) && cycle * r(TAU) < r(Unusable::OF_A_TURN) * angle;
        if few || cycle < r(Unusable::TICKS) * (N::Real::count(config.cycle.last_segment) + one) {
            return Err(Unusable::Ticks);
        }
        let mut ticks = whole;
        let mut slowness = FourierSeries::constant(one);
        let mut beyond_highest = [Order::default(); MAX_ORDER];
        let mut ramp = Ramp { ends: [r(TAU) * cycles / whole; 2], ..Ramp::default() };
        for _ in 0..ROUNDS {
            let ends = self.ends(&slowness, ramp.ends, angle);
            ticks = ends.ticks;
            ramp = Ramp::of(ends.ticks, ends.opening, ends.closing, self.cycles);
            let mut integrals = counted;
            for (n, order) in (1_i32..).zip(integrals.orders.iter_mut().take(fitted)) {
                for (part, weight) in ends.parts.iter().zip([one, -one]) {
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
        let (mut coefficient, mut beyond) = (zero, zero);
        let orders = N::Real::count((fitted - highest).max(1) as u32);
        for (n, order) in (1_u32..).zip(&beyond_highest).take(fitted).skip(highest) {
            let square = order.square();
            coefficient += r(0.5 / TAU / TAU) * square / (N::Real::count(n * n) * orders);
            beyond += if n as usize <= highest + 2 { square } else { zero };
        }
        let rise = ramp.slowness * r(TAU) / ticks;
        if rise.abs() > r(Unusable::RISE) {
            return Err(Unusable::Trend);
        }
        let left = self.left(&slowness, highest);
        let quality = Quality { residue: left.rms() * angle, trend: rise, ..Quality::default() };
        let mean = sign * cycles * angle / (ticks * period);
        let acceleration = sign * angle * r(1.0 / TAU) / period * ramp.acceleration / period;
        let ripple = Ripple::of(slowness, mean, acceleration, angle, highest, self.cycles);
        let mut ripple = Ripple { quality, ..ripple };
        let at = [ripple.motor.max, ripple.motor.min].map(|extreme| extreme.angle * r(TAU) / angle);
        if fitted < highest + 4 {
            (coefficient, beyond) = (left.of_coefficient(left.variance()), left.beyond());
        } else {
            // Three deviations by few values are exceeded as seldom as by many (Student's distribution).
            coefficient *= one + r(2.0) / orders + r(8.0) / (orders * orders);
        }
        // Ticks that come back to the same angles have the same rounding in every cycle, which stands in a few orders.
        let again = ticks / cycles;
        coefficient *= one + r(3.0) / (one + r(0.5 * TAU) * cycles * (again - again.nearest()).abs());
        let beats = Self::beats(again, cycles, highest);
        let own = coefficient * sensitivity(&slowness, at, highest).square() + beats;
        ripple.motor.deviation = deviation(&slowness, at, [own, coefficient, beyond], highest);
        if ripple.turns_one_way() { Ok(ripple) } else { Err(Unusable::Trend) }
    }

    /// Variance of a delta by the beats of ticks and bins: a bin's moments leave the third power of the angle, which
    /// shows as the order by which the ticks to the cycle differ from a multiple of the bins. Ticks that go on within
    /// the bins from cycle to cycle smooth it. The factor is that of uniform motion, of 20,000 windows.
    fn beats(ticks: N::Real, cycles: N::Real, highest: usize) -> N::Real {
        let r = <N::Real as Real>::of;
        let bins = N::Real::count(BINS as u32);
        let (mut sum, each) = (N::Real::ZERO, ticks / bins);
        for n in (1_u32..).take(highest).map(N::Real::count) {
            let h = n * r(TAU) / bins;
            for beside in [-n, n] {
                let multiple = (ticks + beside) / bins;
                let apart = (multiple - multiple.nearest()).abs() * bins;
                let amplitude = r(0.0073) * h * h * h / (each * each) / (N::Real::ONE + r(0.5 * TAU) * cycles * apart);
                sum += r(2.0) * amplitude * amplitude;
            }
        }
        sum
    }

    /// The bins, in a number that the compiler does not know: a loop over them stays one.
    pub(super) fn kept(&self) -> &[Bin<N>] {
        core::hint::black_box(self.bins.as_slice())
    }

    /// Ticks counted up to the end of each bin, less those of the waveform.
    fn left(&self, slowness: &FourierSeries<N::Real>, highest: usize) -> Left<N::Real> {
        let total = self.kept().iter().fold(0_u32, |sum, bin| sum.wrapping_add(bin.ticks));
        let (mut counted, mut left) = (0_u32, Left::new(highest));
        for (index, bin) in (1_u32..).zip(self.kept()) {
            counted = counted.wrapping_add(bin.ticks);
            let place = N::Real::count(index) / N::Real::count(BINS as u32);
            // The integral of the slowness over the angle, but for a constant.
            let mut late = N::Real::ZERO;
            for (n, order) in (1_u32..).map(N::Real::count).zip(&slowness.orders) {
                let (s, c) = (n * N::Real::of(TAU) * place).sin_cos();
                late += (order.cos * s - order.sin * c) / n;
            }
            let share = N::Real::count(counted) / N::Real::count(total.max(1));
            left.add(place, share - place - late * N::Real::of(1.0 / TAU));
        }
        left
    }

    /// Sum of cos(n theta) and sin(n theta) over the ticks that were counted. Of many in a bin it is that of the
    /// polynomials nearest over the bin. A few are at the same angles in every cycle where it has a whole number of
    /// them: the sum is that of two angles with their mean and variance.
    fn counted(&self, n: u32) -> Order<N::Real> {
        let r = <N::Real as Real>::of;
        let h = N::Real::count(n) * r(TAU / BINS as f64);
        let square = h * h;
        // sin(n e) = n e (1 - h^2/40) and cos(n e) = constant + slope (n e)^2
        let sine = N::Real::ONE - square * r(1.0 / 40.0);
        let constant = N::Real::ONE - square * square * r(1.0 / 4480.0);
        let slope = r(-0.5) + square * r(1.0 / 112.0);
        let mut sum = Order::default();
        for (index, bin) in (0_u32..).zip(self.kept()).filter(|(_, bin)| bin.ticks > 0) {
            let ticks = N::Real::count(bin.ticks);
            // The distances were rounded down: half a unit is missing, with its effect on the squares.
            let first = N::Real::whole(bin.first) * r(1.0 / 1024.0) + r(0.5 / 1024.0) * ticks;
            let second = if bin.ticks > SQUARES {
                first * first / ticks + ticks * r(1.0 / 12.0)
            } else {
                (N::Real::count(bin.second) + r(256.0) * first - ticks * r(1.0 / 6.0)) * r(1.0 / 65_536.0)
            };
            let (even, odd) = if ticks > r(MANY) * N::Real::count(self.cycles) {
                (constant * ticks + slope * square * second, sine * h * first)
            } else {
                let mean = first / ticks;
                let (sin, cos) = (h * mean).sin_cos();
                let (_, apart) = (h * (second / ticks - mean * mean).max(N::Real::ZERO).sqrt()).sin_cos();
                (ticks * apart * cos, ticks * apart * sin)
            };
            let (s, c) = (h * (N::Real::count(index) + r(0.5))).sin_cos();
            sum.cos += c * even - s * odd;
            sum.sin += s * even + c * odd;
        }
        sum
    }

    /// The two ends of the window, by the ripple and the speeds without it there (2 pi to the cycle, over ticks).
    fn ends(&self, ripple: &FourierSeries<N::Real>, [from, to]: [N::Real; 2], angle: N::Real) -> Ends<N::Real> {
        let [first, second, last_but_one, last] = self.edges;
        let part = |edge: &Edge<N>, speed| Part {
            turned: N::Real::count(edge.beyond) * N::Real::of(RADIANS * TAU) / angle,
            speed,
        };
        let late = |edge: &Edge<N>, speed| part(edge, speed).integral(ripple, 0).0;
        let between = |early: &Edge<N>, late_edge: &Edge<N>, from, to| {
            N::Real::count(late_edge.tick.wrapping_sub(early.tick)) + (late(early, from) - late(late_edge, to))
        };
        // half a tick less
        let counted = |edge: &Edge<N>, speed| {
            let Part { turned, .. } = part(edge, speed);
            Part { turned: turned - N::Real::of(0.5) * speed / ripple.at(turned), speed }
        };
        Ends {
            ticks: between(&first, &last, from, to),
            opening: between(&first, &second, from, from),
            closing: between(&last_but_one, &last, to, to),
            parts: [counted(&first, from), counted(&last, to)],
        }
    }
}

impl<R: Real> Ripple<R> {
    /// Whether no speed of the cycle is against the mean: a stop within the window may fit orders that pass through
    /// infinity.
    pub(super) fn turns_one_way(&self) -> bool {
        [self.motor.min, self.motor.max].iter().all(|extreme| extreme.speed / self.mean > R::ZERO)
    }

    /// From the slowness over its mean.
    #[inline(never)]
    pub(super) fn of(
        slowness: FourierSeries<R>,
        mean: R,
        acceleration: R,
        angle: R,
        highest: usize,
        cycles: u32,
    ) -> Self {
        let circle = circle();
        let fast = slowness.grid(&circle).map(|slowness| mean / slowness);
        let speed = FourierSeries::of(&fast, &circle, highest);
        let motor = slowness.stationary_values(&fast, mean, angle, &|slowness| mean / slowness);
        Ripple { mean, acceleration, speed, motor, cycles, quality: Quality::default() }
    }
}

/// How long a window was, in ticks.
struct Ends<R> {
    /// The whole of it.
    ticks: R,
    /// Its first cycle.
    opening: R,
    /// Its last cycle.
    closing: R,
    /// From the first end of a cycle to half a tick before the first tick that was counted; from the last end to half a
    /// tick before the first that was not.
    parts: [Part<R>; 2],
}

/// From a cycle's end on.
struct Part<R> {
    /// How far the motor turned (2 pi to the cycle).
    turned: R,
    /// Its speed without the ripple (the same, over ticks).
    speed: R,
}

impl<R: Real> Part<R> {
    /// Integral of e^(j n theta) over the time (ticks).
    #[inline(never)]
    fn integral(&self, ripple: &FourierSeries<R>, n: i32) -> (R, R) {
        let order = |n: i32| {
            let k = R::whole(n);
            let (sin, cos) = (k * self.turned).sin_cos();
            if n == 0 { (self.turned, R::ZERO) } else { (sin / k, (R::ONE - cos) / k) }
        };
        let (re, im) = times_ripple(ripple, n, order);
        let (a, b) = order(n);
        ((a + re) / self.speed, (b + im) / self.speed)
    }

    /// Sum over the ticks of e^(j n theta) less its integral, up to here: the integral's
    /// antiderivative times `x/sin x` less 1, with x half of the order's turn in a tick.
    fn sampled(&self, ripple: &FourierSeries<R>, n: i32) -> (R, R) {
        let n = R::whole(n);
        let turn = n * self.speed / ripple.at(self.turned);
        let square = R::of(0.25) * turn * turn;
        let share =
            square * (R::of(1.0 / 6.0) + square * (R::of(7.0 / 360.0) + square * R::of(31.0 / 15_120.0))) / turn;
        let (sin, cos) = (n * self.turned).sin_cos();
        (share * sin, -share * cos)
    }
}

/// Integral of the ripple's orders times e^(j n theta), from that of e^(j k theta): half of an order belongs to each of
/// n - m and n + m.
fn times_ripple<R: Real>(ripple: &FourierSeries<R>, n: i32, integral: impl Fn(i32) -> (R, R)) -> (R, R) {
    let mut sum = (R::ZERO, R::ZERO);
    for (m, order) in (1_i32..).zip(ripple.orders.iter().take(ripple.highest())) {
        for (k, im) in [(n - m, order.sin), (n + m, -order.sin)] {
            let (a, b) = integral(k);
            sum.0 += R::of(0.5) * (order.cos * a - im * b);
            sum.1 += R::of(0.5) * (order.cos * b + im * a);
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
