//! The second integration: DOP853 over short pieces, events found by integrating up to them again and again.

use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::prelude::ExplicitRungeKutta;

use super::machine::{Change, Machine};
use super::recording::{Recording, Step};
use super::{super::solver::Plant, NotProven};

/// Relative tolerance of the integrator; a run of 1e5 pieces may gather 1e-8 of it at the very worst.
const TOLERANCE: f64 = 1e-13;
/// A guard below this share of its size has fallen.
const FALLEN: f64 = 1e-12;
/// Product of the fastest rate and a piece, at most.
const REACH: f64 = 0.25;

/// Runs the recording again; one sample per tick.
pub(super) fn rerun(run: &Recording) -> Result<Vec<Vec<f64>>, NotProven> {
    let plant = &run.start;
    let mut y = plant.x.clone();
    let mut machine = Machine::new(plant, &y);
    let mut pass = Pass {
        scale: scale(run, plant),
        longest: REACH / fastest(plant),
    };
    let mut samples = Vec::new();
    let mut start = plant.time();
    let mut fresh = true;
    for step in &run.steps {
        match *step {
            Step::Advance { torque, dt } => {
                machine.motor_torque = torque;
                if std::mem::take(&mut fresh) {
                    (0..plant.nodes()).for_each(|j| machine.judge(start, &y, j));
                }
                pass.tick(&mut machine, &mut y, start, dt)?;
                start += dt;
                samples.push(sample(&machine, start, &y));
            }
            Step::Load { node, torque } => machine.load[node] = torque,
            Step::Brake { node, torque } => {
                machine.dry[node] = machine.chain.nodes[node].coulomb + torque;
                machine.judge(start, &y, node);
            }
        }
    }
    Ok(samples)
}

fn sample(machine: &Machine, t: f64, y: &[f64]) -> Vec<f64> {
    let n = machine.chain.nodes.len();
    let torques = (0..n - 1).map(|s| machine.reaction(t, y, s));
    let speeds = (0..n).map(|j| machine.speed(y, j));
    speeds.chain(torques).chain([y[2 * n - 1]]).collect()
}

/// Sizes of the states over the run, to measure errors by.
fn scale(run: &Recording, plant: &Plant) -> Vec<f64> {
    let n = plant.nodes();
    let peak = |i: usize| run.samples.iter().map(|s| s[i].abs()).fold(0.0, f64::max);
    let or_one = |size: f64| if size > 0.0 { size } else { 1.0 };
    let top_speed = or_one((0..n).map(peak).fold(0.0, f64::max));
    let twists = plant
        .chain
        .shafts
        .iter()
        .enumerate()
        .map(|(s, shaft)| or_one((peak(n + s) / shaft.stiffness).max(shaft.gap)));
    twists
        .chain(vec![top_speed; n])
        .chain([or_one(peak(2 * n - 1))])
        .collect()
}

/// Bound of the rates of the chain, 1/s, by Gershgorin's circles.
fn fastest(plant: &Plant) -> f64 {
    let shafts = &plant.chain.shafts;
    let rates = plant.chain.nodes.iter().enumerate().map(|(j, node)| {
        let near = [j.checked_sub(1), Some(j)]
            .into_iter()
            .flatten()
            .filter_map(|s| shafts.get(s));
        let (k, d) = near.fold((0.0, node.viscous), |(k, d), shaft| {
            (k + shaft.stiffness, d + shaft.damping)
        });
        let loss = node.efficiency;
        (2.0 * k / (loss * node.inertia))
            .sqrt()
            .max(2.0 * d / (loss * node.inertia))
    });
    rates.fold(0.0, f64::max)
}

/// The equations in multiples of the scale, for one error tolerance to fit all.
struct Scaled<'a, 'b> {
    machine: &'a Machine<'b>,
    scale: &'a [f64],
    /// Where the integrator's time zero lies, s.
    origin: f64,
}

impl ODE<f64, Vec<f64>> for Scaled<'_, '_> {
    fn diff(&self, t: f64, z: &Vec<f64>, dz: &mut Vec<f64>) {
        let y: Vec<f64> = z.iter().zip(self.scale).map(|(z, s)| z * s).collect();
        self.machine.rate(self.origin + t, &y, dz);
        dz.iter_mut().zip(self.scale).for_each(|(d, s)| *d /= s);
    }
}

struct Pass {
    scale: Vec<f64>,
    longest: f64,
}

impl Pass {
    fn tick(
        &mut self,
        machine: &mut Machine,
        y: &mut Vec<f64>,
        start: f64,
        dt: f64,
    ) -> Result<(), NotProven> {
        let mut corners = vec![start, start + dt];
        let within = |t: &f64| *t > start && *t < start + dt;
        for node in &machine.chain.nodes {
            let mut from = start;
            while let Some(corner) = node
                .program
                .as_ref()
                .and_then(|p| p.corner_after(from))
                .filter(within)
            {
                corners.push(corner);
                from = corner;
            }
        }
        corners.extend(machine.chain.law.corner_after(start).filter(within));
        corners.sort_by(f64::total_cmp);
        for pair in corners.windows(2) {
            let pieces = ((pair[1] - pair[0]) / self.longest).ceil().max(1.0);
            for i in 0..pieces as usize {
                let piece = (pair[1] - pair[0]) / pieces;
                self.piece(machine, y, pair[0] + i as f64 * piece, piece)?;
            }
        }
        Ok(())
    }

    fn piece(
        &self,
        machine: &mut Machine,
        y: &mut Vec<f64>,
        t: f64,
        length: f64,
    ) -> Result<(), NotProven> {
        let (mut now, mut left) = (t, length);
        for _ in 0..1000 {
            let ahead = self.integrate(machine, y, now, left)?;
            let Some((after, change)) = self.first_change(machine, y, &ahead, now, left)? else {
                *y = ahead;
                return Ok(());
            };
            *y = self.integrate(machine, y, now, after)?;
            (now, left) = (now + after, left - after);
            machine.change(now, y, change);
        }
        Err(NotProven::Integrator {
            time: now,
            reason: "a thousand events in one piece".into(),
        })
    }

    fn integrate(
        &self,
        machine: &Machine,
        y: &[f64],
        t: f64,
        length: f64,
    ) -> Result<Vec<f64>, NotProven> {
        if length <= 0.0 {
            return Ok(y.to_vec());
        }
        let equations = Scaled {
            machine,
            scale: &self.scale,
            origin: t,
        };
        let start: Vec<f64> = y.iter().zip(&self.scale).map(|(y, s)| y / s).collect();
        let failed = |reason: String| NotProven::Integrator { time: t, reason };
        let mut method = ExplicitRungeKutta::dop853()
            .rtol(TOLERANCE)
            .atol(TOLERANCE)
            .h0(length);
        method
            .init(&equations, 0.0, length, &start)
            .map_err(|e| failed(format!("{e:?}")))?;
        while method.t() < length {
            let h = method.h().min(length - method.t());
            method.set_h(h);
            method
                .step(&equations)
                .map_err(|e| failed(format!("{e:?}")))?;
        }
        Ok(method
            .y()
            .iter()
            .zip(&self.scale)
            .map(|(z, s)| z * s)
            .collect())
    }

    /// The first guard to fall within `left` seconds, and after how long.
    fn first_change(
        &self,
        machine: &Machine,
        y: &[f64],
        ahead: &[f64],
        now: f64,
        left: f64,
    ) -> Result<Option<(f64, Change)>, NotProven> {
        let (before, after) = (machine.guards(now, y), machine.guards(now + left, ahead));
        let mut first: Option<(f64, Change)> = None;
        for (i, (&(from, size, change), &(to, end_size, _))) in
            before.iter().zip(&after).enumerate()
        {
            let fallen = FALLEN * size.max(end_size);
            let guard = |after: f64| -> Result<f64, NotProven> {
                let there = self.integrate(machine, y, now, after)?;
                Ok(machine.guards(now + after, &there)[i].0)
            };
            let slope = |y: &[f64], t: f64| {
                let mut rate = vec![0.0; y.len()];
                machine.rate(t, y, &mut rate);
                let moved: Vec<f64> = y
                    .iter()
                    .zip(&rate)
                    .map(|(y, r)| y + r * 1e-3 * left)
                    .collect();
                machine.guards(t, &moved)[i].0 - machine.guards(t, y)[i].0
            };
            let falling = slope(y, now) < 0.0;
            let bracket = if from < -fallen || (from <= fallen && falling && to < -fallen) {
                Some((0.0, 0.0))
            } else if to < -fallen && from > fallen {
                Some((0.0, left))
            } else if to < -fallen {
                // leaves zero upwards and comes back: from the last sample above zero
                let mut above = 0.0;
                for k in (1..16).rev() {
                    let at = left * f64::from(k) / 16.0;
                    if guard(at)? > 0.0 {
                        above = at;
                        break;
                    }
                }
                Some((above, left))
            } else if falling && from > fallen && slope(ahead, now + left) > 0.0 {
                // a dip: down to its bottom by halving on the slope
                let (mut a, mut b) = (0.0, left);
                while b - a > 1e-7 * left {
                    let middle = 0.5 * (a + b);
                    let there = self.integrate(machine, y, now, middle)?;
                    if slope(&there, now + middle) < 0.0 {
                        a = middle
                    } else {
                        b = middle
                    }
                }
                (guard(b)? < -fallen).then_some((0.0, b))
            } else {
                None
            };
            let Some((mut a, mut b)) = bracket else {
                continue;
            };
            if first.is_some_and(|(earliest, _)| a >= earliest) {
                continue;
            }
            while b - a > 1e-15 {
                let middle = 0.5 * (a + b);
                if middle <= a || middle >= b {
                    break;
                }
                if guard(middle)? < 0.0 {
                    b = middle
                } else {
                    a = middle
                }
            }
            if first.is_none_or(|(earliest, _)| b < earliest) {
                first = Some((b, change));
            }
        }
        Ok(first)
    }
}
