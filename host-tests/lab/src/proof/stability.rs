//! That a speed loop is stable for every machine within the tolerances, not at points of them.
//!
//! The poles of the sampled loop are the zeros of `p = D_m D + g N_m N`, machine and controller in `z - 1`. They move
//! continuously with inertias, stiffness, torque constant and lag. If one machine is stable and `p` has no zero on the
//! unit circle for any machine of the box, no pole of any of them has left the disc (zero exclusion [Ackermann 2002,
//! Robust Control, section 4.3]). The leading coefficient of `p` must not vanish, so that no pole comes from infinity.
//!
//! Circle and box are cut into cells until `p` over each is a disc without zero. The shaft's step comes by the mean
//! value theorem: with `y'' + 2 x y' + p y = 1` from rest, `|h| <= t` and `|h'| <= 1` hold for its impulse response h,
//! so that `y(1)` changes by at most 1/24 per p and 1/3 per x, and `y'(1)` by at most 1/6 and 1.

use std::fmt;

use driveline::design::{ClosedLoop, Controller, ExactStep, LoopObserver, Plant, Spread};
use driveline::machine::TwoMass;

use super::disc::Disc;
use super::subject::Subject;

/// Cells after which the search for a proof ends.
const MOST_CELLS: usize = 4_000_000;

/// What a cell ranges over: angle of a tick on the unit circle (rad), factors of motor and load inertia, square of the
/// resonance in a tick (rad2), factors of damping and torque, lag of the torque (s). By its resonance a machine close
/// to the circle is resolved in one of its quantities instead of in three.
type Cell = [(f64, f64); 7];

/// Outcome of a search for a proof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Proven, with so many cells.
    Proven(usize),
    /// Factors of motor inertia, load inertia, stiffness, damping, torque, the lag (s), and the ticks of delay with
    /// which the loop is unstable.
    Unstable([f64; 6], u32),
    /// Neither proven nor refuted: poles too close to the circle.
    Open,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Proven(cells) => write!(f, "stable, by {cells} cells"),
            Self::Unstable([motor, load, stiffness, damping, torque, lag], ticks) => write!(
                f,
                "unstable: motor inertia {motor:.3}, load inertia {load:.3}, stiffness {stiffness:.3}, damping \
                 {damping:.3}, torque {torque:.3} times, lag {lag:.2e} s, {ticks} ticks late"
            ),
            Self::Open => f.write_str("open: its poles come too close to the unit circle"),
        }
    }
}

/// The loop round the machines of a box, its torque later by whole ticks.
struct Looped<'a> {
    machine: TwoMass,
    period: f64,
    controller: &'a Controller,
    ticks: u32,
}

impl Looped<'_> {
    /// The characteristic polynomial over a cell.
    fn over(&self, cell: &Cell) -> Disc {
        let [angle, motor, load, p, damping, torque, lag] = *cell;
        let middle = 0.5 * (angle.0 + angle.1);
        let half = (0.5 * middle).sin();
        // z - 1 without cancellation; a chord is shorter than its arc
        let delta =
            Disc::new((-2.0 * half * half, middle.sin()), 0.5 * (angle.1 - angle.0) * (1.0 + 1e-12) + 1e-15 * middle);
        let scaled = |value: f64, (low, high): (f64, f64)| (value * low, value * high);
        let (per_reduced, t) = (self.per_reduced(motor, load), self.period);
        let (motor, load) = (scaled(self.machine.motor_inertia, motor), scaled(self.machine.load_inertia, load));
        let damping = scaled(self.machine.damping, damping);
        let x = (0.5 * t * damping.0 * per_reduced.0, 0.5 * t * damping.1 * per_reduced.1);
        let (p0, x0, dp, dx) = (0.5 * (p.0 + p.1), 0.5 * (x.0 + x.1), 0.5 * (p.1 - p.0), 0.5 * (x.1 - x.0));
        let step = ExactStep::from_rates(p0, 2.0 * x0, 1.0);
        let around = |value: f64, wide: f64| Disc::new((value, 0.0), wide * (1.0 + 1e-12) + 1e-14 * value.abs());
        let (g1, g2) = (around(step.g1, dp / 24.0 + dx / 3.0), around(step.g2, dp / 6.0 + dx));
        let (p, two_x) = (around(p0, dp), around(2.0 * x0, 2.0 * dx));
        let moved = p * g1 + two_x * g2;
        let turned = moved * g1 + g2 * g2;
        let square = delta * delta;
        let det = square + (moved + p * g1) * delta + p * turned;
        // times J_m: 1/J and J_l/(J J_m) as shares of the inertia
        let share = around(
            0.5 * (motor.0 / (motor.0 + load.1) + motor.1 / (motor.1 + load.0)),
            0.5 * (motor.1 / (motor.1 + load.0) - motor.0 / (motor.0 + load.1)),
        );
        let rest = around(1.0 - share.centre.0, share.radius);
        let glide = Disc::new((1.0, 0.0), 0.0) + 0.5 * delta;
        let numerator = share * glide * det + rest * square * (turned + g1 * delta);
        let per_motor = Disc::between(t * t / motor.1, t * t / motor.0);
        let [denominator, of_torque, of_angle] =
            [&self.controller.denominator, &self.controller.of_torque, &self.controller.of_angle]
                .map(|of| delta.polynomial(of));
        let later = (delta + Disc::new((1.0, 0.0), 0.0)).raised(self.ticks);
        // the torque's mean over a tick: a b + (1 - b) where b = lag/T (1 - e^(-T/lag)) falls with the lag
        let settled = (filled(lag.1, t), filled(lag.0, t));
        let (settled, mean) = (Disc::between(settled.0.0, settled.1.0), Disc::between(settled.0.1, settled.1.1));
        let acts = settled + mean * delta;
        let lags = settled + delta;
        let known =
            if lag.1 > 0.0 { lags * later * denominator + acts * of_torque } else { later * denominator + of_torque };
        let acts = if lag.1 > 0.0 { acts } else { Disc::new((1.0, 0.0), 0.0) };
        square * det * known + Disc::between(torque.0, torque.1) * per_motor * acts * numerator * of_angle
    }

    /// `1/J_m + 1/J_l` over a range of both factors.
    fn per_reduced(&self, motor: (f64, f64), load: (f64, f64)) -> (f64, f64) {
        let (m, l) = (self.machine.motor_inertia, self.machine.load_inertia);
        (1.0 / (m * motor.1) + 1.0 / (l * load.1), 1.0 / (m * motor.0) + 1.0 / (l * load.0))
    }

    /// Squares of the resonance in a tick over a range of inertias and stiffness.
    fn squares(&self, [motor, load, stiffness]: [(f64, f64); 3]) -> (f64, f64) {
        let (least, most) = self.per_reduced(motor, load);
        let whole = self.period * self.period * self.machine.stiffness;
        (whole * stiffness.0 * least * (1.0 - 1e-12), whole * stiffness.1 * most * (1.0 + 1e-12))
    }

    /// The factor of the stiffness in the middle of a cell.
    fn stiffness(&self, cell: &Cell) -> f64 {
        let middle = |(low, high): (f64, f64)| (0.5 * (low + high), 0.5 * (low + high));
        let (one, _) = self.squares([middle(cell[1]), middle(cell[2]), (1.0, 1.0)]);
        middle(cell[3]).0 / one
    }

    /// Whether the leading coefficient of `p` keeps its sign, for lags of the torque between these two.
    fn leads(&self, lag: (f64, f64)) -> bool {
        let Controller { denominator, of_torque, of_angle } = self.controller;
        let order = |of: &[f64; 9]| of.iter().rposition(|&c| c != 0.0).unwrap_or(0);
        let top = order(denominator);
        let least = |share: f64| denominator[top] + if self.ticks == 0 { share * of_torque[top] } else { 0.0 };
        let (slow, prompt) =
            if lag.1 > 0.0 { (filled(lag.1, self.period).1, filled(lag.0, self.period).1) } else { (1.0, 1.0) };
        order(of_angle) <= top && order(of_torque) <= top && least(slow) > 0.0 && least(prompt) > 0.0
    }

    /// Stability of one machine, by its poles.
    fn is_stable(&self, subject: &Subject, at: [f64; 6]) -> bool {
        let mut machine = self.machine;
        machine.motor_inertia *= at[0];
        machine.load_inertia *= at[1];
        machine.stiffness *= at[2];
        machine.damping *= at[3];
        let actuator = driveline::design::Actuator { delay: f64::from(self.ticks) * self.period, lag: at[5] };
        let design = subject.speed_loop.unwrap_or_else(|| unreachable!("a loop was closed"));
        let closed = subject.observer().close(&design, actuator);
        closed.is_ok_and(|closed: ClosedLoop| closed.is_stable(&Plant::of(&machine), at[4]))
    }
}

/// `1 - e^(-T/lag)`, and what of it acts in its own tick.
fn filled(lag: f64, period: f64) -> (f64, f64) {
    if lag == 0.0 {
        return (1.0, 1.0);
    }
    let settled = -(-period / lag).exp_m1();
    (settled, 1.0 - settled * lag / period)
}

impl Subject {
    /// The observer in the speed loop.
    pub fn observer(&self) -> LoopObserver<'_> {
        self.two_mass.as_ref().map_or(LoopObserver::Rigid(&self.rigid), LoopObserver::TwoMass)
    }

    /// The box of the tolerances: factors of motor inertia, load inertia, stiffness, damping and torque, the lag (s),
    /// and the least and most whole ticks of delay.
    pub fn tolerated(&self) -> ([(f64, f64); 6], [u32; 2]) {
        let of = |spread: Spread| (spread.min, spread.max);
        let (tolerance, period) = (&self.tolerance, self.rigid.period);
        let ticks = (self.actuator.delay / period - 1e-6).ceil().max(0.0) as u32;
        let lag = (self.actuator.lag, self.actuator.lag + tolerance.lag);
        let exact = of(Spread::NONE);
        let factors = [of(tolerance.motor_inertia), of(tolerance.load_inertia), of(tolerance.stiffness), exact];
        let [a, b, c, d] = factors;
        ([a, b, c, d, of(tolerance.torque), lag], [ticks, ticks + tolerance.late])
    }
}

/// Proves that a subject's speed loop is stable over a box, or finds a machine in it with which it is not. `None`
/// without a speed loop.
pub fn prove(subject: &Subject, (factors, ticks): ([(f64, f64); 6], [u32; 2])) -> Option<Outcome> {
    let design = subject.speed_loop?;
    let controller = subject.observer().controller(&design);
    let mut cells = 0;
    for ticks in ticks[0]..=ticks[1] {
        let looped = Looped { machine: subject.machine, period: subject.rigid.period, controller: &controller, ticks };
        let middle = factors.map(|(low, high)| 0.5 * (low + high));
        if !looped.leads(factors[5]) {
            return Some(Outcome::Open);
        }
        if !looped.is_stable(subject, middle) {
            return Some(Outcome::Unstable(middle, ticks));
        }
        let [a, b, c, d, e, f] = factors;
        let mut left: Vec<Cell> = vec![[(0.0, std::f64::consts::PI), a, b, looped.squares([a, b, c]), d, e, f]];
        while let Some(cell) = left.pop() {
            let (low, high) = looped.squares([cell[1], cell[2], c]);
            // no machine of the box is in it
            if cell[3].1 < low || cell[3].0 > high {
                continue;
            }
            if looped.over(&cell).excludes_zero() {
                cells += 1;
                continue;
            }
            if cells + left.len() > MOST_CELLS || cell[0].1 - cell[0].0 < 1e-9 {
                return Some(Outcome::Open);
            }
            // cut where the disc shrinks most
            let shrunk = |k: usize| {
                let mut thin = cell;
                let middle = 0.5 * (cell[k].0 + cell[k].1);
                thin[k] = (middle, middle);
                looped.over(&thin).radius
            };
            let cut = (0..7).filter(|&k| cell[k].1 > cell[k].0).min_by(|&i, &j| shrunk(i).total_cmp(&shrunk(j)))?;
            if cut > 0 && left.len().is_multiple_of(64) {
                let mut at: [f64; 6] = std::array::from_fn(|k| 0.5 * (cell[k + 1].0 + cell[k + 1].1));
                at[2] = looped.stiffness(&cell).clamp(c.0, c.1);
                if !looped.is_stable(subject, at) {
                    return Some(Outcome::Unstable(at, ticks));
                }
            }
            let middle = 0.5 * (cell[cut].0 + cell[cut].1);
            let (mut low, mut high) = (cell, cell);
            low[cut].1 = middle;
            high[cut].0 = middle;
            left.extend([low, high]);
        }
    }
    Some(Outcome::Proven(cells))
}
