//! The trend of a window: a steady acceleration from one end to the other.

use core::f64::consts::TAU;

use super::{Order, Series, times_ripple};

/// Change by a steady acceleration from one end of a window to the other, angles in 2 pi to the cycle and times in
/// ticks.
///
/// The integral of the slowness sigma times e^(j n theta) over whole cycles is, by parts,
/// `[sigma]/(j n) + [sigma']/n^2 + ...`: a trend shows in every order.
#[derive(Clone, Copy, Default)]
pub(in crate::fluctuation) struct Ramp {
    /// Of the speed.
    pub acceleration: f64,
    /// Change of the slowness.
    pub slowness: f64,
    /// Change of the slowness's derivative by the angle.
    pub slope: f64,
    /// The speed at both ends.
    pub(super) ends: [f64; 2],
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
    pub(super) fn integral(&self, k: f64) -> (f64, f64) {
        if k == 0.0 { (0.0, 0.0) } else { (self.slope / (k * k), -self.slowness / k) }
    }

    /// The orders of the ripple over its mean, in the direction of travel. `integrals` are those of slowness times
    /// cos(n theta) and sin(n theta) over a window of so many ticks; `known` is the ripple as it was before. The
    /// slowness is the trend times the ripple, so each order of the ripple also shows in the others.
    pub(super) fn taken_off(&self, known: &Series, integrals: &Series, ticks: f64, highest: usize) -> Series {
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
