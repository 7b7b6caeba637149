//! From the bins of a finished window to the waveform of the speed: slowness first, then its inverse.

use core::f64::consts::TAU;

use super::extremes::{Extreme, Fluctuations};
use super::position::RADIANS;
use super::quality::{Quality, Unusable};
use super::series::{GRID, Order, Series, circle};
use super::{Bin, Edge, Summed, WaveformConfig};
use crate::math::{sin_cos, sqrt};

pub use super::series::MAX_ORDER;

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
    /// slowness, a sawtooth over the cycle, is taken off, as that of a steady acceleration.
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
        let mut counted = Series::default();
        for (n, order) in (1_u32..).zip(counted.orders.iter_mut().take(highest)) {
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
        let mut ramp = Ramp { ends: [TAU * cycles / whole; 2], ..Ramp::default() };
        for _ in 0..ROUNDS {
            let ends = self.ends(&slowness, ramp.ends, config.cycle.angle);
            ticks = ends.ticks;
            ramp = Ramp::of(ends.ticks, ends.opening, ends.closing, self.cycles);
            let mut integrals = counted;
            for (n, order) in (1_u32..).zip(integrals.orders.iter_mut().take(highest)) {
                for (part, weight) in ends.parts.iter().zip([1.0, -1.0]) {
                    let n = f64::from(n);
                    let (cos, sin) = part.integral(&slowness, n);
                    let (beyond_cos, beyond_sin) = part.sampled(&slowness, n);
                    order.cos += weight * (cos + beyond_cos);
                    order.sin += weight * (sin + beyond_sin);
                }
            }
            slowness = ramp.taken_off(&slowness, &integrals, ticks, highest);
        }
        for order in &mut slowness.orders {
            order.sin *= sign;
        }
        let rise = ramp.slowness * TAU * cycles / ticks / f64::from(self.cycles.max(1));
        if rise.abs() > Unusable::RISE {
            return Err(Unusable::Trend);
        }
        let residue = self.residue(&slowness) * config.cycle.angle / TAU;
        let quality = Quality { residue, trend: rise, ..Quality::default() };
        let mean = sign * cycles * config.cycle.angle / (ticks * config.cycle.period);
        let per_tick = config.cycle.angle / TAU / config.cycle.period;
        let acceleration = sign * per_tick * ramp.acceleration / config.cycle.period;
        let ripple = Ripple::of(slowness, mean, acceleration, config.cycle.angle, highest, self.cycles);
        if ripple.turns_one_way() { Ok(Ripple { quality, ..ripple }) } else { Err(Unusable::Trend) }
    }

    /// Rms of the angle by which the ticks counted up to the end of each bin differ from the waveform (rad), 2 pi to
    /// the cycle.
    fn residue(&self, slowness: &Series) -> f64 {
        let total: f64 = self.bins.iter().map(|bin| f64::from(bin.ticks)).sum();
        let (mut counted, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for (index, bin) in (1_u32..).zip(&self.bins) {
            counted += f64::from(bin.ticks);
            let theta = TAU * f64::from(index) / BINS as f64;
            // The integral of the slowness over the angle, but for a constant.
            let mut late = 0.0;
            for (n, order) in (1_u32..).zip(&slowness.orders) {
                let n = f64::from(n);
                let (s, c) = sin_cos(n * theta);
                late += (order.cos * s - order.sin * c) / n;
            }
            let left = TAU * counted / total.max(1.0) - theta - late;
            sum += left;
            squares += left * left;
        }
        let mean = sum / BINS as f64;
        sqrt((squares / BINS as f64 - mean * mean).max(0.0))
    }

    /// Integral of cos(n theta) and sin(n theta) over the ticks that were counted.
    fn counted(&self, n: f64) -> Order {
        let width = TAU / BINS as f64;
        let h = n * width;
        // sin(n e) = n e (1 - h^2/40) and cos(n e) = constant + slope (n e)^2, the polynomials nearest over a bin.
        let sine = 1.0 - h * h / 40.0;
        let constant = 1.0 - h * h * h * h / 4480.0;
        let square = -0.5 + h * h / 112.0;
        let mut sum = Order::default();
        for (index, bin) in (0_u32..).zip(&self.bins) {
            let ticks = f64::from(bin.ticks);
            // The distances were rounded down: half a unit is missing, with its effect on the squares.
            let first = f64::from(bin.first) / 1024.0 + 0.5 * ticks / 1024.0;
            let second = (f64::from(bin.second) + 64.0 * first - ticks / 3.0) / 4096.0;
            let even = constant * ticks + square * h * h * second;
            let odd = sine * h * first;
            let (s, c) = sin_cos(n * width * (f64::from(index) + 0.5));
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

/// How often the trend and the ends are put right anew, by the ripple that is then known; each round is closer by the
/// ratio of trend and mean.
const ROUNDS: u32 = 4;

/// Change by a steady acceleration from one end of a window to the other, angles in 2 pi to the cycle and times in
/// ticks.
///
/// The integral of the slowness sigma times e^(j n theta) over whole cycles is, by parts,
/// `[sigma]/(j n) + [sigma']/n^2 + ...`: a trend shows in every order.
#[derive(Clone, Copy, Default)]
pub(super) struct Ramp {
    /// Of the speed.
    pub acceleration: f64,
    /// Change of the slowness.
    pub slowness: f64,
    /// Change of the slowness's derivative by the angle.
    pub slope: f64,
    /// The speed at both ends.
    ends: [f64; 2],
}

impl Ramp {
    /// From the lengths of the window, of its first cycle and of its last: the mean speed of a cycle is that of its
    /// middle.
    pub fn of(ticks: f64, first: f64, last: f64, cycles: u32) -> Ramp {
        if cycles < 2 {
            return Ramp { ends: [TAU / ticks; 2], ..Ramp::default() };
        }
        let acceleration = (TAU / last - TAU / first) / (ticks - 0.5 * (first + last));
        let ends = [TAU / first - 0.5 * acceleration * first, TAU / last + 0.5 * acceleration * last];
        let [from, to] = ends.map(|speed| 1.0 / speed);
        Ramp { acceleration, slowness: to - from, slope: acceleration * (from * from * from - to * to * to), ends }
    }

    /// Integral of the trend times e^(j k theta), without that of its mean.
    fn integral(&self, k: f64) -> (f64, f64) {
        if k == 0.0 { (0.0, 0.0) } else { (self.slope / (k * k), -self.slowness / k) }
    }

    /// The orders of the ripple over its mean, in the direction of travel. `integrals` are those of slowness times
    /// cos(n theta) and sin(n theta) over a window of so many ticks; `known` is the ripple as it was before. The
    /// slowness is the trend times the ripple, so each order of the ripple also shows in the others.
    fn taken_off(&self, known: &Series, integrals: &Series, ticks: f64, highest: usize) -> Series {
        // Contribution of the trend and of the ripple's orders to order n and the mean.
        let leaked = |n: f64| {
            let (own, sum) = (self.integral(n), times_ripple(known, n, |k| self.integral(k)));
            (own.0 + sum.0, own.1 + sum.1)
        };
        let whole = ticks - leaked(0.0).0;
        let mut ripple = Series { mean: 1.0, ..Series::default() };
        for ((n, out), order) in (1_u32..).zip(ripple.orders.iter_mut().take(highest)).zip(&integrals.orders) {
            let (cos, sin) = leaked(f64::from(n));
            *out = Order { cos: 2.0 * (order.cos - cos) / whole, sin: 2.0 * (order.sin - sin) / whole };
        }
        ripple
    }
}

#[cfg(test)]
mod tests {
    use super::super::CycleConfig;
    use super::*;

    /// A slowness of one with this first order.
    fn of(cos: f64, sin: f64) -> Series {
        let mut series = Series::constant(1.0);
        series.orders[0] = Order { cos, sin };
        series
    }

    fn ripple(cos: f64, sin: f64) -> Ripple {
        Ripple::of(of(cos, sin), 10.0, 0.0, TAU, 1, 1)
    }

    /// The antiderivative of `e^(j n theta)` over the ticks, times `x/sin x - 1`.
    #[test]
    fn ticks_are_beyond_their_integral_as_by_the_closed_form() {
        for (turned, speed, n) in [(0.4, 0.02, 1.0), (1.3, 0.2, 3.0), (2.0, 0.05, 9.0), (0.7, 0.6, 1.0)] {
            let (cos, sin) = Part { turned, speed }.sampled(&Series::constant(1.0), n);
            let x: f64 = 0.5 * n * speed;
            let share = (x / x.sin() - 1.0) / (n * speed);
            // the next term of x/sin x, and what some units in the last place of the sine leave of a small difference
            let left = (127.0 / 604_800.0 * x.powi(8) * 1.1 + 2e-15) / (n * speed);
            let (s, c) = (n * turned).sin_cos();
            assert!((cos - share * s).abs() < left && (sin + share * c).abs() < left, "{cos} {sin} {share}");
        }
        // the turn of a tick by the slowness there
        let slow = Part { turned: 0.0, speed: 0.2 }.sampled(&of(1.0, 0.0), 1.0);
        assert_eq!(slow, Part { turned: 0.0, speed: 0.1 }.sampled(&Series::constant(1.0), 1.0));
    }

    /// Ticks spread evenly over a bin: the mean of `cos(n e)` is `sin(h/2)/(h/2)`, with `h` the order's turn over it.
    #[test]
    fn a_bin_counts_its_ticks_as_the_integral_over_it() {
        let ticks = 12_000.0;
        let mut window =
            Window { bins: [Bin::<f32>::default(); 8], edges: [Edge::default(); 4], cycles: 1, forward: true };
        // the mean of the distances is zero, of their squares a twelfth; each was rounded down
        let bin = &mut window.bins[2];
        (bin.ticks, bin.first) = (12_000, -6_000);
        bin.second = (4096.0 * ticks / 12.0 + ticks / 3.0) as _;
        for n in [1.0, 2.0] {
            let h = n * TAU / 8.0;
            let found = window.counted(n);
            let expected = ticks * (0.5 * h).sin() / (0.5 * h);
            let (s, c) = (n * TAU / 8.0 * 2.5).sin_cos();
            // the polynomial's next term, h^6/322560
            let left = ticks * f64::powi(h, 6) / 3e5;
            assert!(
                (found.cos - expected * c).abs() < left && (found.sin - expected * s).abs() < left,
                "{n} {found:?}"
            );
        }
        // all of them at the bin's end, where the parabola and the cubic are farthest off: by h^3 (1/24 - 1/40)/2
        let bin = &mut window.bins[2];
        (bin.first, bin.second) =
            (512 * 12_000 - 6_000, (4096.0 * ticks / 4.0 + ticks / 3.0 - 64.0 * ticks / 2.0) as _);
        let found = window.counted(1.0);
        let (s, c) = (TAU / 8.0 * 3.0).sin_cos();
        let off = (found.cos / ticks - c).hypot(found.sin / ticks - s);
        assert!(off < f64::powi(TAU / 8.0, 3) / 120.0, "{off}");
    }

    fn config(turns: u32, torque: f64) -> WaveformConfig {
        let cycle = CycleConfig {
            length: 1 << 30,
            last_segment: 4 * turns - 1,
            whole: 0,
            part: 0,
            divisor: 1,
            angle: TAU * f64::from(turns),
            period: 0.01,
            speed: 1.0,
            torque,
        };
        WaveformConfig { cycle, cycles: 1, scale: 1 << 21, per_segment: 2 }
    }

    /// Ticks spread evenly over a bin.
    fn even(ticks: u32) -> Bin<f64> {
        let second = (4096.0 / 12.0 + 1.0 / 3.0) * f64::from(ticks);
        Bin { ticks, first: -(ticks as i32) / 2, second: second as u32, torque: 0.0 }
    }

    /// A steady motion of so many ticks, ends of cycles in whole ticks.
    fn steady(cycles: u32, ticks: u32, speed: f64) -> Window<f64, 8> {
        let edges =
            [0, ticks / cycles, ticks - ticks / cycles, ticks].map(|tick| Edge { tick, speed, ..Edge::default() });
        Window { bins: [even(ticks / 8); 8], edges, cycles, forward: speed >= 0.0 }
    }

    /// The lateness is the integral of the slowness, by hand; what is beyond it alternates from bin to bin. The angle
    /// that it is counted from does not matter.
    #[test]
    fn the_residue_is_what_the_orders_leave() {
        let mut slowness = Series::constant(1.0);
        slowness.orders[0] = Order { cos: 0.1, sin: 0.05 };
        slowness.orders[1] = Order { cos: -0.04, sin: 0.06 };
        let late = |theta: f64| {
            0.1 * theta.sin() - 0.05 * theta.cos() - 0.02 * (2.0 * theta).sin() - 0.03 * (2.0 * theta).cos()
        };
        let (total, apart) = (1e9, 0.01);
        let mut window = steady(1, 8, 1.0);
        let mut before = 0;
        for (index, bin) in (1_u32..).zip(&mut window.bins) {
            let theta = TAU * f64::from(index) / 8.0;
            // none of it at the cycle's end
            let left = if index % 2 == 0 { 0.0 } else { 2.0 * apart };
            let counted = ((theta + late(theta) - late(TAU) + left) / TAU * total) as u32;
            bin.ticks = counted - before;
            before = counted;
        }
        // a tick of 10^9
        assert!((window.residue(&slowness) - apart).abs() < TAU / total, "{}", window.residue(&slowness));
        // a hundredth of a cycle of two turns, in every other bin: the mean and half of it either way
        let mut window = steady(2, 8_000, 1.0);
        for pair in window.bins.chunks_mut(2) {
            (pair[0], pair[1]) = (even(920), even(1_080));
        }
        let ripple = window.ripple(&config(2, 1.0), 1).unwrap();
        // a bin's squares are cut to whole units, of 4,096 to a square bin
        assert!((ripple.quality.residue / (0.005 * 2.0 * TAU) - 1.0).abs() < 1e-3, "{ripple:?}");
    }

    /// A speed against the mean at any end; twelve ticks to a segment, and 72 to a turn in few cycles.
    #[test]
    fn windows_that_cannot_be_used() {
        for sign in [1.0, -1.0] {
            let ripple = steady(2, 8_000, sign).ripple(&config(1, 1.0), 1).unwrap();
            assert!((ripple.mean / (sign * TAU / 40.0) - 1.0).abs() < 1e-12, "{ripple:?}");
            for edge in 0..4 {
                for (speed, error) in [(0.0, None), (-1e-9 * sign, Some(Unusable::Trend))] {
                    let mut window = steady(2, 8_000, sign);
                    window.edges[edge].speed = speed;
                    assert_eq!(window.ripple(&config(1, 1.0), 1).err(), error, "{edge} {speed}");
                }
            }
        }
        for (turns, cycles, ticks, is_right) in [
            (1, 2, 144, true),
            (1, 2, 143, false),
            (1, 7, 504, true),
            (1, 7, 503, false),
            (1, 8, 384, true),
            (1, 8, 383, false),
            (2, 8, 1_152, true),
            (2, 8, 1_151, false),
        ] {
            let found = steady(cycles, ticks, 1.0).ripple(&config(turns, 1.0), 1);
            assert_eq!(found.err(), (!is_right).then_some(Unusable::Ticks), "{turns} {cycles} {ticks}");
        }
    }

    /// With `slowness` 2 and an order of `sin(theta)/2` the mean is longer by 1, and order 1 has -2 j by itself and
    /// -1/4 by half of the order at 2 theta. An order is twice its integral over the mean's.
    #[test]
    fn a_trend_shows_in_every_order() {
        let ramp = Ramp { slowness: 5.0, slope: 3.0, ..Ramp::default() };
        assert_eq!(
            [0.0, 1.0, 2.0, -2.0].map(|k| ramp.integral(k)),
            [(0.0, 0.0), (3.0, -5.0), (0.75, -2.5), (0.75, 2.5)]
        );
        let ramp = Ramp { slowness: 2.0, ..Ramp::default() };
        let found = ramp.taken_off(&of(0.0, 0.5), &of(4.75, 3.0), 9.0, 1);
        assert_eq!((found.mean, found.order(1)), (1.0, Order { cos: 1.0, sin: 1.0 }));
    }

    /// The mean of a sine over a bin is that of its ends' integral. A bin without a tick has the torque of the one
    /// before it, the first that of the last.
    #[test]
    fn the_torque_is_that_of_the_bins() {
        let mut window = steady(1, 8_000, 1.0);
        let width = TAU / 8.0;
        for (index, bin) in (0_u32..).zip(&mut window.bins) {
            let [from, to] = [index, index + 1].map(|index| width * f64::from(index));
            bin.torque = 1_000.0 * (5.0 + (to.sin() - from.sin() + 0.5 * (from.cos() - to.cos())) / width);
        }
        let found = window.motor_torque(&config(1, 2.0), 1);
        // some roundings
        let off = [found.mean - 10.0, found.order(1).cos - 2.0, found.order(1).sin - 1.0];
        assert!(off.iter().all(|off| off.abs() < 1e-13), "{found:?}");
        for (index, bin) in (0_u32..).zip(&mut window.bins) {
            let ticks = if index == 0 || index == 4 { 0 } else { 1_000 };
            (bin.ticks, bin.torque) = (ticks, f64::from(ticks * index));
        }
        // 7, 1, 2, 3, 3, 5, 6 and 7
        assert_eq!(window.motor_torque(&config(1, 2.0), 0).mean, 2.0 * 34.0 / 8.0);
    }

    #[test]
    fn a_speed_against_the_mean_is_seen() {
        let mut ripple = ripple(0.1, 0.0);
        assert!(ripple.turns_one_way());
        for (speed, mean, is_so) in [(0.0, 10.0, false), (-1.0, 10.0, false), (1.0, -10.0, false), (1.0, 10.0, true)] {
            (ripple.motor.min.speed, ripple.mean) = (speed, mean);
            ripple.motor.max.speed = mean;
            assert_eq!(ripple.turns_one_way(), is_so, "{speed} {mean}");
        }
    }

    /// The slowness is least a little before the cycle's end, or at its beginning.
    #[test]
    fn extremes_are_within_the_cycle() {
        for (phase, expected) in [(-0.001, TAU - 0.001), (0.001, 0.001), (0.0, 0.0)] {
            let (sin, cos) = f64::sin_cos(phase);
            let angle = ripple(-0.1 * cos, -0.1 * sin).motor.max.angle;
            // Newton's method ends within rounding of a turn
            assert!((angle - expected).abs() < 1e-14, "{phase}: {angle}");
        }
    }

    /// A flywheel where delta is more than permissible, a governor where the drift is more than so much of the mean.
    #[test]
    fn remedies_are_for_what_is_beyond_the_limits() {
        use crate::fluctuation::flywheel::Remedy;
        let mut ripple = ripple(0.1, 0.0);
        for (delta, acceleration, expected) in [
            (0.25, 2.5, Remedy::Nothing),
            (0.26, 2.5, Remedy::Flywheel),
            (0.25, -2.6, Remedy::Governor),
            (0.26, 2.6, Remedy::Both),
        ] {
            (ripple.motor.delta, ripple.acceleration, ripple.mean) = (delta, acceleration, -10.0);
            assert_eq!(ripple.remedy(0.25, 0.25), expected, "{delta} {acceleration}");
        }
    }
}
