//! DOP853 from event to event; events found by integrating up to them again.

use differential_equations::error::Error;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};

use super::proof::NotProven;

/// Tolerance of the integrator, of the sizes of the states; a run of 1e5 steps may gather 1e-8 of it at the very worst.
const TOLERANCE: f64 = 1e-13;
/// The same of a state itself: its rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// A guard below this share of its size has fallen.
const FALLEN: f64 = 1e-12;
/// Share of a step over which rates of guards are taken; the rounding of a guard is a 1e-13th of its size then.
const SPAN: f64 = 1e-3;
/// Product of the fastest rate and a step, at most: no guard turns twice in less than a radian of it.
pub(in crate::plant) const REACH: f64 = 1.0;
/// Events within one longest step after which a run is given up.
const MOST_EVENTS: usize = 1000;

/// Equations with events, as an ordinary integrator needs them.
pub(in crate::plant) trait Hybrid {
    /// Meaning of a guard that falls below zero.
    type Change: Copy;

    /// Rates of the state at a time.
    fn rate(&self, t: f64, y: &[f64], out: &mut [f64]);

    /// Guards that must stay above zero: value, size to measure its rounding by, and what its fall means.
    fn guards(&self, t: f64, y: &[f64]) -> Vec<(f64, f64, Self::Change)>;

    /// The fastest rate, 1/s, at which anything swings with what turns, as fast as it turns now.
    fn turning(&self, y: &[f64]) -> f64;

    /// Does what a fallen guard stands for.
    fn change(&mut self, t: f64, y: &mut [f64], change: Self::Change);
}

/// The equations from a time on, s.
struct Onward<'a, H> {
    machine: &'a H,
    origin: f64,
}

impl<H: Hybrid> ODE<f64, Vec<f64>> for Onward<'_, H> {
    fn diff(&self, t: f64, y: &Vec<f64>, dy: &mut Vec<f64>) {
        self.machine.rate(self.origin + t, y, dy);
    }
}

type Dop853 = ExplicitRungeKutta<Ordinary, DormandPrince, f64, Vec<f64>, 8, 12, 16>;

/// How a run is integrated.
pub(in crate::plant) struct Pass<C> {
    /// Errors that a step may have, per state.
    tolerance: Vec<f64>,
    /// Longest step at rest, s; shorter the faster what turns does.
    pub longest: f64,
    /// An event is found within this time, s.
    close: f64,
    /// The step that the integrator would take next, s.
    step: f64,
    /// Steps taken, those up to an event included.
    pub taken: u64,
    live: Option<Live<C>>,
}

/// The integrator between two calls, with the time of its origin, s.
struct Live<C> {
    method: Dop853,
    origin: f64,
    /// Its last step, s.
    last: f64,
    look: Look<C>,
}

impl<C: Copy> Pass<C> {
    /// With the sizes of the states over the run, to measure errors by.
    pub fn new(scale: &[f64], longest: f64, close: f64) -> Self {
        let tolerance = scale.iter().map(|size| TOLERANCE * size).collect();
        Self { tolerance, longest, close, step: longest, taken: 0, live: None }
    }

    /// Begins anew: state or equations are not those of the last call's end.
    pub fn anew(&mut self) {
        self.live = None;
    }

    /// The step that is wanted from a state on, s.
    fn wanted<H: Hybrid<Change = C>>(&self, machine: &H, y: &[f64]) -> f64 {
        self.step.min(REACH / (REACH / self.longest + machine.turning(y)))
    }

    /// From corner to corner, through all events between them; on from the last call, unless begun anew.
    pub fn between<H: Hybrid<Change = C>>(
        &mut self,
        machine: &mut H,
        y: &mut Vec<f64>,
        from: f64,
        to: f64,
    ) -> Result<(), NotProven> {
        let (mut now, mut since, mut events) = (from, from, 0);
        while let Some((after, change)) = self.smooth(machine, y, now, to)? {
            now = after;
            machine.change(now, y, change);
            self.anew();
            events += 1;
            if now - since > self.longest {
                (since, events) = (now, 0);
            }
            if events == MOST_EVENTS {
                return Err(NotProven::Integrator { time: now, reason: "a thousand events in one step".into() });
            }
        }
        Ok(())
    }

    fn begin<H: Hybrid<Change = C>>(&self, machine: &H, y: &Vec<f64>, t: f64, h: f64) -> Result<Dop853, NotProven> {
        let tolerance = self.tolerance.clone();
        let mut method = ExplicitRungeKutta::dop853().rtol(ROUNDING).atol(tolerance).max_steps(usize::MAX).h0(h);
        let begun = method.init(&Onward { machine, origin: t }, 0.0, f64::MAX, y);
        begun.map_err(|e| NotProven::Integrator { time: t, reason: format!("{e:?}") })?;
        Ok(method)
    }

    /// On to the time `to` or up to the first change, and when that is.
    fn smooth<H: Hybrid<Change = C>>(
        &mut self,
        machine: &H,
        y: &mut Vec<f64>,
        t: f64,
        to: f64,
    ) -> Result<Option<(f64, C)>, NotProven> {
        if to <= t {
            return Ok(None);
        }
        // the integrator refuses a step of less than 1e-14 of the one before, such as to a corner next to a tick's end
        let mut live = match self.live.take().filter(|live| to - t > 1e-12 * live.last) {
            Some(live) => live,
            None => Live {
                method: self.begin(machine, y, t, self.step)?,
                origin: t,
                last: 0.0,
                look: Look::of(machine, t, y, SPAN * self.wanted(machine, y).min(to - t)),
            },
        };
        let (method, origin) = (&mut live.method, live.origin);
        while to - (origin + method.t()) > 1e-14 * (to - t) {
            let now = origin + method.t();
            let whole = to - now;
            let wanted = self.wanted(machine, method.y());
            method.set_h(wanted.min(whole));
            let before = method.t();
            let taken = method.step(&Onward { machine, origin });
            taken.map_err(|e| NotProven::Integrator { time: now, reason: format!("{e:?}") })?;
            if method.t() == before {
                self.step = method.h();
                continue;
            }
            live.last = method.t() - before;
            self.taken += 1;
            // a step that the end cut short says nothing of a shorter one
            self.step = if wanted <= whole { method.h() } else { self.step.max(method.h()) };
            if !live.look.guards.is_empty() {
                let left = live.last;
                let look = Look::of(machine, origin + method.t(), method.y(), SPAN * left);
                let watch = Watch { pass: self, machine, y, now, left };
                if let Some((at, change)) = watch.first_change(&live.look, &look, method)? {
                    let (there, steps) = self.integrate(machine, y, now, at)?;
                    (*y, self.taken) = (there, self.taken + steps);
                    return Ok(Some((now + at, change)));
                }
                live.look = look;
            }
            y.clone_from(method.y());
        }
        self.live = Some(live);
        Ok(None)
    }

    /// The state `length` seconds after `t`, with no event on the way, and the steps up to it.
    fn integrate<H: Hybrid<Change = C>>(
        &self,
        machine: &H,
        y: &Vec<f64>,
        t: f64,
        length: f64,
    ) -> Result<(Vec<f64>, u64), NotProven> {
        if length <= 0.0 {
            return Ok((y.clone(), 0));
        }
        let (mut method, mut steps) = (self.begin(machine, y, t, length)?, 0);
        while length - method.t() > 1e-14 * length {
            let h = method.h().min(length - method.t());
            method.set_h(h);
            let taken = method.step(&Onward { machine, origin: t });
            taken.map_err(|e| NotProven::Integrator { time: t, reason: format!("{e:?}") })?;
            steps += 1;
        }
        Ok((method.y().clone(), steps))
    }
}

/// The guards at a time, and their rates.
struct Look<C> {
    guards: Vec<(f64, f64, C)>,
    slopes: Vec<f64>,
}

impl<C: Copy> Look<C> {
    /// The rates by a secant over the time `span`, s, along the tangent of the state.
    fn of<H: Hybrid<Change = C>>(machine: &H, t: f64, y: &[f64], span: f64) -> Self {
        let guards = machine.guards(t, y);
        if guards.is_empty() {
            return Self { guards, slopes: Vec::new() };
        }
        let mut moved = vec![0.0; y.len()];
        machine.rate(t, y, &mut moved);
        moved.iter_mut().zip(y).for_each(|(rate, y)| *rate = y + *rate * span);
        let ahead = machine.guards(t + span, &moved);
        let slopes = ahead.iter().zip(&guards).map(|(ahead, guard)| (ahead.0 - guard.0) / span).collect();
        Self { guards, slopes }
    }
}

/// The guards over one step.
struct Watch<'a, H: Hybrid> {
    pass: &'a Pass<H::Change>,
    machine: &'a H,
    y: &'a Vec<f64>,
    now: f64,
    left: f64,
}

impl<H: Hybrid> Watch<'_, H> {
    /// The first guard to fall, and after how long.
    fn first_change(
        &self,
        before: &Look<H::Change>,
        after: &Look<H::Change>,
        step: &mut Dop853,
    ) -> Result<Option<(f64, H::Change)>, NotProven> {
        let mut first: Option<(f64, H::Change)> = None;
        for (index, (start, end)) in before.guards.iter().zip(&after.guards).enumerate() {
            let fallen = -FALLEN * start.1.max(end.1);
            let slopes = [before.slopes[index], after.slopes[index]];
            let Some(bracket) = self.bracket(index, fallen, [start.0, end.0], slopes)? else { continue };
            if first.is_some_and(|(earliest, _)| bracket[0].0 >= earliest) {
                continue;
            }
            let at = self.close_in(index, bracket, step)?;
            if first.is_none_or(|(earliest, _)| at < earliest) {
                first = Some((at, start.2));
            }
        }
        Ok(first)
    }

    fn value(&self, index: usize, after: f64) -> Result<f64, NotProven> {
        let (there, _) = self.pass.integrate(self.machine, self.y, self.now, after)?;
        Ok(self.machine.guards(self.now + after, &there)[index].0)
    }

    fn slope(&self, index: usize, after: f64) -> Result<f64, NotProven> {
        let (there, _) = self.pass.integrate(self.machine, self.y, self.now, after)?;
        Ok(Look::of(self.machine, self.now + after, &there, SPAN * self.left).slopes[index])
    }

    /// An interval in which the guard goes from standing to fallen, with its values; none if it stands throughout.
    /// Below `fallen`, which is not above zero, it has fallen.
    fn bracket(
        &self,
        index: usize,
        fallen: f64,
        [start, end]: [f64; 2],
        slopes: [f64; 2],
    ) -> Result<Option<[(f64, f64); 2]>, NotProven> {
        let now = (0.0, start);
        if start < fallen {
            return Ok(Some([now, now]));
        }
        let stands = start > -fallen;
        let falling = slopes[0] < 0.0;
        if end < fallen {
            let from = if stands || falling { now } else { self.last_above(index)? };
            let to = if stands || !falling { (self.left, end) } else { now };
            return Ok(Some([from, to]));
        }
        if falling && slopes[1] > 0.0 {
            // where the tangents at both ends meet a convex guard lies above them
            let [down, up] = slopes.map(|slope| slope * self.left);
            let meet = (start * up - end * down + down * up) / (up - down);
            if stands && meet > 0.5 * start.min(end) {
                return Ok(None);
            }
            let bottom = self.bottom(index, slopes)?;
            let lowest = self.value(index, bottom)?;
            return Ok((lowest < fallen).then_some([now, if stands { (bottom, lowest) } else { now }]));
        }
        Ok(None)
    }

    /// Of a guard that leaves zero upwards and comes back: the last of some samples above zero.
    fn last_above(&self, index: usize) -> Result<(f64, f64), NotProven> {
        for sample in (1..16).rev() {
            let at = self.left * f64::from(sample) / 16.0;
            let value = self.value(index, at)?;
            if value > 0.0 {
                return Ok((at, value));
            }
        }
        Ok((0.0, 0.0))
    }

    /// Where a guard that falls first and rises last is lowest.
    fn bottom(&self, index: usize, slopes: [f64; 2]) -> Result<f64, NotProven> {
        // at the bottom an error of 1e-7 of the step changes the guard by 1e-14 of its fall
        let rising = |at| self.slope(index, at).map(|slope| -slope);
        falls([(0.0, -slopes[0]), (self.left, -slopes[1])], 1e-7 * self.left, rising)
    }

    /// The fallen end of the bracket when it is shut: sought by the interpolation of the step, and from there by one
    /// step of Newton's with an integration up to it; where that is no small step, by integrations alone.
    fn close_in(&self, index: usize, bracket: [(f64, f64); 2], step: &mut Dop853) -> Result<f64, NotProven> {
        let (close, begun) = (self.pass.close, step.t() - self.left);
        if bracket[1].0 - bracket[0].0 <= close {
            return Ok(bracket[1].0);
        }
        let near = falls(bracket, 1e-9 * self.left, |at| {
            let there = step.interpolate((begun + at).min(step.t()))?;
            Ok::<f64, Error<f64, Vec<f64>>>(self.machine.guards(self.now + at, &there)[index].0)
        });
        if let Ok(near) = near {
            let (there, _) = self.pass.integrate(self.machine, self.y, self.now, near)?;
            let look = Look::of(self.machine, self.now + near, &there, 1e-6 * self.left);
            let (guard, slope) = (look.guards[index], -look.slopes[index]);
            let off = guard.0 / slope;
            let at = near + off + 0.5 * close;
            // the square of this is far below what is wanted, and so is its product with the secant's span
            if off.abs() < 1e-7 * self.left && (bracket[0].0..=bracket[1].0).contains(&at) {
                // half of what is wanted lies beyond zero; a guard of some sums is right to some roundings
                let rest = self.value(index, at)?;
                if rest.abs() <= 1.5 * close * slope + 16.0 * f64::EPSILON * guard.1 {
                    return Ok(at);
                }
            }
        }
        falls(bracket, close, |at| self.value(index, at))
    }
}

/// Where a function falls below zero between two places, given with its values there: the far end of an interval of at
/// most `close`. By false position after Illinois, halved every fourth time.
fn falls<E>(
    [(mut a, mut at_a), (mut b, mut at_b)]: [(f64, f64); 2],
    close: f64,
    mut of: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    // whether `b` was the last to move, and how often
    let (mut near, mut round) = (true, 0);
    while b - a > close {
        // half of what is wanted beyond the guess, on the side of the end that is still far
        let guess = b - at_b * (b - a) / (at_b - at_a) + if near { -0.5 * close } else { 0.5 * close };
        round += 1;
        let at = if round % 4 > 0 && guess > a && guess < b { guess } else { 0.5 * (a + b) };
        if at <= a || at >= b {
            break;
        }
        let found = of(at)?;
        let falls = found < 0.0;
        if falls {
            (b, at_b) = (at, found);
            at_a *= if near { 0.5 } else { 1.0 };
        } else {
            (a, at_a) = (at, found);
            at_b *= if near { 1.0 } else { 0.5 };
        }
        near = falls;
    }
    Ok(b)
}
