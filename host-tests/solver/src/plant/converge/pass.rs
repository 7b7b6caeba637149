//! DOP853 over short pieces, events found by integrating up to them again and again.

use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::prelude::ExplicitRungeKutta;

use super::NotProven;
use super::crossing::first_change;

/// Relative tolerance of the integrator; a run of 1e5 pieces may gather 1e-8 of it at the very worst.
const TOLERANCE: f64 = 1e-13;
/// An event of a chain is found within this time, s.
pub(super) const CLOSE: f64 = 1e-15;
/// Product of the fastest rate and a piece, at most.
pub(in crate::plant) const REACH: f64 = 0.25;

/// Equations with events, as an ordinary integrator needs them.
pub(in crate::plant) trait Hybrid {
    /// What a guard that falls below zero stands for.
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
