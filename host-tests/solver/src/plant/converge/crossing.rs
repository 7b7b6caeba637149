//! When the first guard falls, found by integrating to ever closer times.

use super::NotProven;
use super::pass::{Hybrid, Pass};

/// A guard below this share of its size has fallen.
const FALLEN: f64 = 1e-12;

/// The first guard to fall within `left` seconds, and after how long. `ahead` is the state at the end.
pub(super) fn first_change<H: Hybrid>(
    pass: &Pass,
    machine: &H,
    y: &[f64],
    ahead: &[f64],
    now: f64,
    left: f64,
) -> Result<Option<(f64, H::Change)>, NotProven> {
    let (before, after) = (machine.guards(now, y), machine.guards(now + left, ahead));
    let mut first: Option<(f64, H::Change)> = None;
    for (index, (start, end)) in before.iter().zip(&after).enumerate() {
        let fallen = -FALLEN * start.1.max(end.1);
        let watch = Watch { pass, machine, y, now, left, index, fallen };
        let Some((a, b)) = watch.bracket(start.0, end.0, ahead)? else {
            continue;
        };
        if first.is_some_and(|(earliest, _)| a >= earliest) {
            continue;
        }
        let at = watch.close_in(a, b)?;
        if first.is_none_or(|(earliest, _)| at < earliest) {
            first = Some((at, start.2));
        }
    }
    Ok(first)
}

/// One guard over one piece.
struct Watch<'a, H> {
    pass: &'a Pass,
    machine: &'a H,
    y: &'a [f64],
    now: f64,
    left: f64,
    index: usize,
    /// Value below which the guard has fallen, not above zero.
    fallen: f64,
}

impl<H: Hybrid> Watch<'_, H> {
    fn value(&self, after: f64) -> Result<f64, NotProven> {
        let there = self.pass.integrate(self.machine, self.y, self.now, after)?;
        Ok(self.machine.guards(self.now + after, &there)[self.index].0)
    }

    /// Change of the guard over a thousandth of the piece, along the tangent.
    fn slope(&self, y: &[f64], after: f64) -> f64 {
        let t = self.now + after;
        let mut rate = vec![0.0; y.len()];
        self.machine.rate(t, y, &mut rate);
        let moved: Vec<f64> = y.iter().zip(&rate).map(|(y, r)| y + r * 1e-3 * self.left).collect();
        self.machine.guards(t, &moved)[self.index].0 - self.machine.guards(t, y)[self.index].0
    }

    /// An interval in which the guard goes from standing to fallen; none if it stands throughout.
    fn bracket(&self, start: f64, end: f64, ahead: &[f64]) -> Result<Option<(f64, f64)>, NotProven> {
        if start < self.fallen {
            return Ok(Some((0.0, 0.0)));
        }
        let stands = start > -self.fallen;
        let falling = self.slope(self.y, 0.0) < 0.0;
        if end < self.fallen {
            let from = if stands || falling { 0.0 } else { self.last_above()? };
            let to = if stands || !falling { self.left } else { 0.0 };
            return Ok(Some((from, to)));
        }
        if falling && self.slope(ahead, self.left) > 0.0 {
            let bottom = self.bottom()?;
            let dips = self.value(bottom)? < self.fallen;
            return Ok(dips.then_some((0.0, if stands { bottom } else { 0.0 })));
        }
        Ok(None)
    }

    /// Of a guard that leaves zero upwards and comes back: the last of some samples above zero.
    fn last_above(&self) -> Result<f64, NotProven> {
        for sample in (1..16).rev() {
            let at = self.left * f64::from(sample) / 16.0;
            if self.value(at)? > 0.0 {
                return Ok(at);
            }
        }
        Ok(0.0)
    }

    /// Where a guard that falls first and rises last is lowest, by halving on its slope.
    fn bottom(&self) -> Result<f64, NotProven> {
        let (mut a, mut b) = (0.0, self.left);
        // at the bottom an error of 1e-7 of the piece changes the guard by 1e-14 of its fall
        while b - a > 1e-7 * self.left {
            let middle = 0.5 * (a + b);
            let there = self.pass.integrate(self.machine, self.y, self.now, middle)?;
            if self.slope(&there, middle) < 0.0 { a = middle } else { b = middle }
        }
        Ok(b)
    }

    /// The fallen end of the bracket, halved until it is shut.
    fn close_in(&self, mut a: f64, mut b: f64) -> Result<f64, NotProven> {
        while b - a > self.pass.close {
            let middle = 0.5 * (a + b);
            if middle <= a || middle >= b {
                break;
            }
            if self.value(middle)? < 0.0 { b = middle } else { a = middle }
        }
        Ok(b)
    }
}
