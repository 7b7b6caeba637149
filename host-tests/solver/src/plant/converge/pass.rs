//! DOP853 over short pieces, events found by integrating up to them again and again.

use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::prelude::ExplicitRungeKutta;

use super::proof::NotProven;

/// Relative tolerance of the integrator; a run of 1e5 pieces may gather 1e-8 of it at the very worst.
const TOLERANCE: f64 = 1e-13;
/// A guard below this share of its size has fallen.
const FALLEN: f64 = 1e-12;
/// An event of a chain is found within this time, s.
pub(super) const CLOSE: f64 = 1e-15;
/// Product of the fastest rate and a piece, at most.
pub(in crate::plant) const REACH: f64 = 0.25;

/// Equations with events, as an ordinary integrator needs them.
pub(in crate::plant) trait Hybrid {
    /// Meaning of a guard that falls below zero.
    type Change: Copy;

    /// Rates of the state at a time.
    fn rate(&self, t: f64, y: &[f64], out: &mut [f64]);

    /// Guards that must stay above zero: value, size to measure its rounding by, and what its fall means.
    fn guards(&self, t: f64, y: &[f64]) -> Vec<(f64, f64, Self::Change)>;

    /// Does what a fallen guard stands for.
    fn change(&mut self, t: f64, y: &mut [f64], change: Self::Change);
}

/// The equations in multiples of the scale, for one error tolerance to fit all.
struct Scaled<'a, H> {
    machine: &'a H,
    scale: &'a [f64],
    /// Where the integrator's time zero lies, s.
    origin: f64,
}

impl<H: Hybrid> ODE<f64, Vec<f64>> for Scaled<'_, H> {
    fn diff(&self, t: f64, z: &Vec<f64>, dz: &mut Vec<f64>) {
        let y: Vec<f64> = z.iter().zip(self.scale).map(|(z, s)| z * s).collect();
        self.machine.rate(self.origin + t, &y, dz);
        dz.iter_mut().zip(self.scale).for_each(|(d, s)| *d /= s);
    }
}

/// How a piece is integrated.
pub(in crate::plant) struct Pass {
    /// Sizes of the states over the run, to measure errors by.
    pub scale: Vec<f64>,
    /// Longest piece, s.
    pub longest: f64,
    /// An event is found within this time, s.
    pub close: f64,
}

impl Pass {
    /// From corner to corner, in pieces.
    pub fn between<H: Hybrid>(&self, machine: &mut H, y: &mut Vec<f64>, from: f64, to: f64) -> Result<(), NotProven> {
        let pieces = ((to - from) / self.longest).ceil().max(1.0);
        let piece = (to - from) / pieces;
        for i in 0..pieces as usize {
            self.piece(machine, y, from + i as f64 * piece, piece)?;
        }
        Ok(())
    }

    fn piece<H: Hybrid>(&self, machine: &mut H, y: &mut Vec<f64>, t: f64, length: f64) -> Result<(), NotProven> {
        let (mut now, mut left) = (t, length);
        for _ in 0..1000 {
            let ahead = self.integrate(machine, y, now, left)?;
            let Some((after, change)) = first_change(self, machine, y, &ahead, now, left)? else {
                *y = ahead;
                return Ok(());
            };
            *y = self.integrate(machine, y, now, after)?;
            (now, left) = (now + after, left - after);
            machine.change(now, y, change);
        }
        Err(NotProven::Integrator { time: now, reason: "a thousand events in one piece".into() })
    }

    /// The state `length` seconds after `t`, with no event on the way.
    pub fn integrate<H: Hybrid>(&self, machine: &H, y: &[f64], t: f64, length: f64) -> Result<Vec<f64>, NotProven> {
        if length <= 0.0 {
            return Ok(y.to_vec());
        }
        let equations = Scaled { machine, scale: &self.scale, origin: t };
        let start: Vec<f64> = y.iter().zip(&self.scale).map(|(y, s)| y / s).collect();
        let failed = |reason: String| NotProven::Integrator { time: t, reason };
        let mut method = ExplicitRungeKutta::dop853().rtol(TOLERANCE).atol(TOLERANCE).h0(length);
        method.init(&equations, 0.0, length, &start).map_err(|e| failed(format!("{e:?}")))?;
        // the integrator refuses a step of less than 1e-14 of the one before
        while length - method.t() > 1e-14 * length {
            let h = method.h().min(length - method.t());
            method.set_h(h);
            method.step(&equations).map_err(|e| failed(format!("{e:?}")))?;
        }
        Ok(method.y().iter().zip(&self.scale).map(|(z, s)| z * s).collect())
    }
}

/// The first guard to fall within `left` seconds, and after how long. `ahead` is the state at the end.
fn first_change<H: Hybrid>(
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
