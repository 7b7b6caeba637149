//! From the bins of a finished window to the waveform of the speed: slowness first, then its inverse.

use core::f64::consts::TAU;

use super::extremes::{Extreme, Fluctuations};
use super::series::{GRID, Order, Series, circle};
use super::{Bin, Edge, WaveformConfig};
use crate::scalar::sin_cos;

pub use super::series::MAX_ORDER;

/// A finished window, as it was taken from a [`super::Waveform`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Window<N, const BINS: usize> {
    pub(super) bins: [Bin; BINS],
    pub(super) torque: [N; BINS],
    pub(super) edges: [Edge; 4],
    pub(super) cycles: u32,
    pub(super) forward: bool,
}

/// What repeats in every cycle of a window, and what does not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ripple {
    /// Mean speed by time [rad/s]; negative backwards.
    pub mean: f64,
    /// Acceleration of the cycle's mean speed over the window [rad/s2]: the part that is not periodic, which a governor mends and a flywheel
    /// does not; 0 over a single cycle.
    pub acceleration: f64,
    /// The motor's speed over the angle of the cycle [rad/s], its trend taken off.
    pub speed: Series,
    /// Its extremes, and delta.
    pub motor: Fluctuations,
    /// Cycles that it is the mean of.
    pub cycles: u32,
    /// The slowness over its mean.
    pub(super) slowness: Series,
}

impl<N, const BINS: usize> Window<N, BINS> {
    /// The bins, the first one beginning where the cycle does.
    pub fn bins(&self) -> &[Bin; BINS] {
        &self.bins
    }

    /// The waveform of the motor's speed with the orders up to `highest`, which counts at most [`MAX_ORDER`] and a quarter of the bins.
    ///
    /// The integral of a function of the angle over time is, bin by bin, that of the parabola nearest to it. The parts of a tick at the two ends
    /// of the window are put right, and the trend of the slowness, a sawtooth over the cycle, is taken off, as that of a steady acceleration.
    ///
    /// Not for the tick: some thousand operations in `f64`, and sines.
    pub fn ripple(&self, config: &WaveformConfig, highest: usize) -> Ripple {
        let highest = highest.min(MAX_ORDER).min(BINS / 4);
        let [first, second, last_but_one, last] = self.edges;
        let ticks = last.since(&first);
        let cycles = f64::from(self.cycles.max(1));
        let sign = if self.forward { 1.0 } else { -1.0 };
        let mean = sign * cycles * config.cycle.angle / (ticks * config.cycle.period);

        let ramp = Ramp::of(ticks, second.since(&first), last.since(&last_but_one), self.cycles);
        let mut slowness = Series { mean: 1.0, ..Series::default() };
        for (n, order) in (1_u32..).zip(slowness.orders.iter_mut().take(highest)) {
            *order = self.integral(config, f64::from(n), sign);
            order.sin *= sign;
        }
        ramp.take_off(&mut slowness, ticks, highest);
        for order in &mut slowness.orders {
            order.sin *= sign;
        }
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
            Extreme { speed: mean / slowness.at(theta), angle: within / TAU * config.cycle.angle }
        };
        let motor = Fluctuations::of(extreme(most), extreme(least), mean);
        let radians = sign * config.cycle.angle / TAU;
        let acceleration = radians * ramp.acceleration / (config.cycle.period * config.cycle.period);
        Ripple { mean, acceleration, speed, motor, cycles: self.cycles, slowness }
    }

    /// Integral of cos(n theta) and sin(n theta) over the window's time, in ticks.
    fn integral(&self, config: &WaveformConfig, n: f64, sign: f64) -> Order {
        let width = TAU / BINS as f64;
        let h = n * width;
        // sin(n e) = n e (1 - h^2/40) and cos(n e) = constant + slope (n e)^2, the polynomials nearest over a bin.
        let sine = 1.0 - h * h / 40.0;
        let constant = 1.0 - h * h * h * h / 4480.0;
        let square = -0.5 + h * h / 112.0;
        let mut sum = Order::default();
        for (index, bin) in (0_u32..).zip(&self.bins) {
            let ticks = f64::from(bin.ticks);
            // The distances were rounded down: half a unit is missing, and in the squares what that makes of them.
            let first = f64::from(bin.first) / 1024.0 + 0.5 * ticks / 1024.0;
            let second = (f64::from(bin.second) + 64.0 * first - ticks / 3.0) / 4096.0;
            let even = constant * ticks + square * h * h * second;
            let odd = sine * h * first;
            let (s, c) = sin_cos(n * width * (f64::from(index) + 0.5));
            sum.cos += c * even - s * odd;
            sum.sin += s * even + c * odd;
        }
        // From the first end of a cycle to half a tick before the first tick, and from half a tick before the first that is not counted back
        // to the last end.
        let [first, _, _, last] = self.edges;
        for (edge, weight) in [(first, 1.0), (last, -1.0)] {
            let part = edge.fraction() - 0.5;
            let turned = TAU * f64::from(edge.turned) / 4_294_967_296.0 * (TAU / config.cycle.angle);
            let (s, c) = sin_cos(n * sign * 0.5 * part * turned);
            sum.cos += weight * part * c;
            sum.sin += weight * part * s;
        }
        sum
    }
}

/// How often the trend is taken off anew, with the ripple that is then known.
const ROUNDS: u32 = 4;

/// What a steady acceleration changes from one end of a window to the other, angles in 2 pi to the cycle and times in ticks.
///
/// The integral of the slowness sigma times e^(j n theta) over whole cycles is, by parts, `[sigma]/(j n) + [sigma']/n^2 + ...`: a trend shows in every order.
struct Ramp {
    /// Of the speed.
    acceleration: f64,
    /// Change of the slowness.
    slowness: f64,
    /// Change of the slowness's derivative by the angle.
    slope: f64,
}

impl Ramp {
    /// From the lengths of the window, of its first cycle and of its last: the mean speed of a cycle is that of its middle.
    fn of(ticks: f64, first: f64, last: f64, cycles: u32) -> Ramp {
        if cycles < 2 {
            return Ramp { acceleration: 0.0, slowness: 0.0, slope: 0.0 };
        }
        let acceleration = (TAU / last - TAU / first) / (ticks - 0.5 * (first + last));
        let from = 1.0 / (TAU / first - 0.5 * acceleration * first);
        let to = 1.0 / (TAU / last + 0.5 * acceleration * last);
        Ramp { acceleration, slowness: to - from, slope: acceleration * (from * from * from - to * to * to) }
    }

    /// Integral of the trend times e^(j k theta), without that of its mean.
    fn integral(&self, k: f64) -> (f64, f64) {
        (self.slope / (k * k), -self.slowness / k)
    }

    /// From the integrals of slowness times cos(n theta) and sin(n theta) over a window of so many ticks, in its direction of travel, to the orders of the
    /// ripple over its mean: the slowness is the trend times the ripple, so that each order of the ripple also shows in the others.
    fn take_off(&self, orders: &mut Series, ticks: f64, highest: usize) {
        let measured = *orders;
        *orders = Series { mean: 1.0, ..Series::default() };
        // The trend of a cycle is small beside its mean: each round is closer by their ratio.
        for _ in 0..ROUNDS {
            let known = *orders;
            // What each order n, and the mean, gets from the orders m and -m of the ripple; half of an order belongs to each.
            let leaked = |n: f64| {
                let mut sum = if n == 0.0 { (0.0, 0.0) } else { self.integral(n) };
                for (m, order) in (1_u32..).zip(known.orders.iter().take(highest)) {
                    let m = f64::from(m);
                    for (k, re, im) in [(n - m, order.cos, order.sin), (n + m, order.cos, -order.sin)] {
                        if k != 0.0 {
                            let (a, b) = self.integral(k);
                            sum.0 += 0.5 * (re * a - im * b);
                            sum.1 += 0.5 * (re * b + im * a);
                        }
                    }
                }
                sum
            };
            let whole = ticks - leaked(0.0).0;
            for ((n, out), order) in (1_u32..).zip(orders.orders.iter_mut().take(highest)).zip(&measured.orders) {
                let (cos, sin) = leaked(f64::from(n));
                *out = Order { cos: 2.0 * (order.cos - cos) / whole, sin: 2.0 * (order.sin - sin) / whole };
            }
        }
    }
}
