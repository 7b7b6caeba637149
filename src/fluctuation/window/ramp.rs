//! The trend of a window: a steady acceleration from one end to the other.

use core::f64::consts::TAU;

use super::{FourierSeries, Order, times_ripple};
use crate::number::Real;

/// Change by a steady acceleration from one end of a window to the other, angles in 2 pi to the cycle and times in
/// ticks.
///
/// The integral of the slowness sigma times e^(j n theta) over whole cycles is, by parts,
/// `[sigma]/(j n) + [sigma']/n^2 + ...`: a trend shows in every order.
#[derive(Clone, Copy, Default)]
pub(in crate::fluctuation) struct Ramp<R> {
    /// Change of the speed.
    pub acceleration: R,
    /// Change of the slowness.
    pub slowness: R,
    /// Change of the slowness's derivative by the angle.
    pub slope: R,
    /// The speed at both ends.
    pub(super) ends: [R; 2],
}

impl<R: Real> Ramp<R> {
    /// From the lengths of the window, of its first cycle and of its last: the mean speed of a cycle is that of its
    /// middle.
    pub fn of(ticks: R, first: R, last: R, cycles: u32) -> Self {
        let turn = R::of(TAU);
        if cycles < 2 {
            return Ramp { ends: [turn / ticks; 2], ..Ramp::default() };
        }
        let half = R::of(0.5);
        let acceleration = (turn / last - turn / first) / (ticks - half * (first + last));
        let ends = [turn / first - half * acceleration * first, turn / last + half * acceleration * last];
        let [from, to] = ends.map(|speed| R::ONE / speed);
        Ramp { acceleration, slowness: to - from, slope: acceleration * (from * from * from - to * to * to), ends }
    }

    /// Integral of the trend times e^(j n theta), without that of its mean.
    #[inline(never)]
    pub(super) fn integral(&self, n: i32) -> (R, R) {
        let k = R::whole(n);
        if n == 0 { (R::ZERO, R::ZERO) } else { (self.slope / (k * k), -self.slowness / k) }
    }

    /// The orders of the ripple over its mean, in the direction of travel. `integrals` are those of slowness times
    /// cos(n theta) and sin(n theta) over a window of so many ticks; `known` is the ripple as it was before. The
    /// slowness is the trend times the ripple, so each order of the ripple also shows in the others.
    pub(super) fn taken_off(
        &self,
        known: &FourierSeries<R>,
        integrals: &FourierSeries<R>,
        ticks: R,
        highest: usize,
    ) -> FourierSeries<R> {
        // Contribution of the trend and of the ripple's orders to order n and the mean.
        let leaked = |n: i32| {
            let (own, sum) = (self.integral(n), times_ripple(known, n, |k| self.integral(k)));
            (own.0 + sum.0, own.1 + sum.1)
        };
        let whole = ticks - leaked(0).0;
        let mut ripple = FourierSeries::constant(R::ONE);
        for ((n, out), order) in (1_i32..).zip(ripple.orders.iter_mut().take(highest)).zip(&integrals.orders) {
            let (cos, sin) = leaked(n);
            *out = Order { cos: R::of(2.0) * (order.cos - cos) / whole, sin: R::of(2.0) * (order.sin - sin) / whole };
        }
        ripple
    }
}
