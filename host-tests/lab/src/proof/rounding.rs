//! How far an observer in fixed point may ever be from the same observer in real numbers.
//!
//! The step of an observer is linear, so its error obeys the step with the correction in it, driven by two
//! disturbances: the remainders of the tick's sums, and the rounding of each coefficient times the largest operand.
//! With `e' = A e + B n`, each `|n|` below its bound, every output stays below the sum of `|C A^k B|` times that bound:
//! the L1 norm of the impulse response, attained by the worst sequence. It holds for any input and any time, as long as
//! no sample is implausible and no state is beyond its base, which the drive reports.
//!
//! The sum ends where the rest is small, and the rest is bounded by `|A^N|` times the whole. The roundings of this
//! calculation itself count as a further disturbance of `A^k`, of six units in the last place of `|A| |A^k|`.

use std::fmt;

use driveline::number::{Coefficient, Fixed, INNOVATION_SHIFT, TURN_SHIFT};
use driveline::observer::{RigidConfig, SemiImplicitConfig, TwoMassConfig};
use driveline::settings::Bases;

use super::subject::Subject;

/// Symbols of a linear form: states, inputs, disturbances of a tick.
const SYMBOLS: usize = 40;
/// Units in the last place to the base.
const ONE: f64 = (1_u64 << 28) as f64;
/// Largest value of a word.
const WORD: f64 = (1_u64 << 31) as f64;

/// Ticks after which an error that has not decayed counts as one that does not.
const MOST_TICKS: u32 = 40_000_000;
/// Roundings of the sums over so many ticks.
const SLACK: f64 = 1.0 + 1e-8;

/// Which observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One mass.
    Rigid,
    /// Two masses, semi-implicit step.
    SemiImplicit,
    /// Two masses, exact step.
    Exact,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rigid => "one mass",
            Self::SemiImplicit => "semi-implicit",
            Self::Exact => "exact",
        })
    }
}

/// A linear form over the symbols of a tick, in units in the last place of what it stands for.
#[derive(Clone, Copy)]
struct Form {
    of: [f64; SYMBOLS],
    /// One unit in the last place, in SI units (angles: 2^-32 turn).
    unit: f64,
    /// A bound that is known otherwise.
    most: f64,
}

impl Form {
    fn plus(&self, factor: f64, other: &Self) -> Self {
        let mut of = self.of;
        of.iter_mut().zip(other.of).for_each(|(a, b)| *a += factor * b);
        Self { of, most: f64::INFINITY, ..*self }
    }
}

/// A coefficient in fixed point and in SI units, the operand and the factor of its `widened`.
type Term<'a> = (Coefficient, f64, &'a Form, f64);

/// The step of an observer, run once on symbols.
struct Step {
    states: usize,
    /// Smallest and largest value of each symbol.
    range: Vec<(f64, f64)>,
    /// Largest magnitude of a word or of an operand within the tick.
    largest: f64,
}

impl Step {
    /// With these units of the states, which reach `reach`, the residual last.
    fn new<const N: usize>(units: [f64; N], reach: f64, innovation: f64) -> (Self, [Form; N]) {
        let mut step = Self { states: N, range: vec![(-reach, reach); N - 1], largest: 0.0 };
        step.range.push((-innovation, innovation));
        let forms = std::array::from_fn(|k| step.form(k, units[k]));
        (step, forms)
    }

    fn form(&self, symbol: usize, unit: f64) -> Form {
        let mut of = [0.0; SYMBOLS];
        of[symbol] = 1.0;
        Form { of, unit, most: f64::INFINITY }
    }

    fn symbol(&mut self, range: (f64, f64), unit: f64) -> Form {
        self.range.push(range);
        self.form(self.range.len() - 1, unit)
    }

    /// Largest magnitude of a form.
    fn most(&mut self, form: &Form) -> f64 {
        let sum: f64 =
            form.of.iter().zip(&self.range).map(|(c, (low, high))| c.abs() * low.abs().max(high.abs())).sum();
        let most = sum.min(form.most);
        self.largest = self.largest.max(most);
        most
    }

    /// `start` and a sum of products, with a carry from the last sum and one to the next.
    fn accumulate(&mut self, start: &Form, carry: &mut Form, terms: &[Term<'_>]) -> Form {
        let mut sum = start.plus(1.0, carry);
        let mut doubt = 0.0;
        for &(fixed, real, operand, widened) in terms {
            let real = real * operand.unit / start.unit;
            let most = self.most(operand);
            self.largest = self.largest.max(widened * most);
            // and four roundings of the real coefficient
            doubt += most * ((fixed.to_f64() * widened - real).abs() + 4.0 * f64::EPSILON * real.abs());
            sum = sum.plus(real, operand);
        }
        *carry = self.symbol((0.0, 1.0), 1.0);
        let doubt = self.symbol((-doubt, doubt), 1.0);
        let sum = sum.plus(-1.0, carry).plus(1.0, &doubt);
        self.most(&sum);
        sum
    }

    /// A sum of products, truncated.
    fn truncated(&mut self, unit: f64, terms: &[Term<'_>]) -> Form {
        let zero = self.zero(unit);
        self.accumulate(&zero, &mut self.zero(1.0), terms)
    }

    /// A turn and its remainder.
    fn turn(&mut self, terms: &[Term<'_>]) -> [Form; 2] {
        let (zero, mut rest) = (self.zero(f64::from(1 << TURN_SHIFT)), self.zero(1.0));
        [self.accumulate(&zero, &mut rest, terms), rest]
    }

    fn zero(&self, unit: f64) -> Form {
        Form { of: [0.0; SYMBOLS], unit, most: f64::INFINITY }
    }

    /// The carry that a tick begins with: a half.
    fn carry(&mut self) -> Form {
        self.symbol((0.5, 0.5), 1.0)
    }

    /// Innovation and correction: the new states, the residual last.
    fn correct<const K: usize>(
        &mut self,
        carry: &mut Form,
        predicted: [&Form; K],
        (residual, [turn, rest], largest): (&Form, &[Form; 2], f64),
        gains: [(Coefficient, f64); K],
        angle_gain: (Coefficient, f64),
    ) -> Vec<Form> {
        let places = f64::from(1 << TURN_SHIFT);
        let cut = self.symbol((0.0, 1.0), 1.0);
        let innovation = residual.plus(-places, turn).plus(-places, rest).plus(1.0, &cut);
        let innovation = Form { most: largest, ..innovation };
        let shifted = f64::from(1 << INNOVATION_SHIFT);
        let mut new = Vec::new();
        for (from, (fixed, real)) in predicted.into_iter().zip(gains) {
            new.push(self.accumulate(from, carry, &[(fixed, real, &innovation, shifted)]));
        }
        new.push(self.accumulate(&innovation, carry, &[(angle_gain.0, angle_gain.1, &innovation, shifted)]));
        new
    }
}

/// Bounds of an observer in fixed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Of motor speed, shaft torque, load speed and load torque, fixed less real (SI units).
    pub error: [f64; 4],
    /// The part of it that coefficients make.
    pub coefficients: [f64; 4],
    /// Largest word of a tick over the largest that there is, from states within their bases, and from states that are
    /// reported and held at twice their bases: below 1 no sum wraps.
    pub largest: [f64; 2],
}

/// The error's step and outputs, for who looks for the worst roundings.
pub struct Linear {
    /// The error of a tick from that of the last: states, the residual last, in units in the last place.
    pub step: Square,
    /// Motor speed, shaft torque, load speed and load torque from the states.
    pub outputs: Square,
    /// One unit in the last place of each output (SI units).
    pub units: [f64; 4],
}

/// The error's step of an observer of these designs; `None` where its constants do not fit.
pub fn linear(subject: &Subject, kind: Kind) -> Option<Linear> {
    let (step, new, outputs) = traced(subject, kind, ONE)?;
    let states: Vec<usize> = (0..step.states).collect();
    let units = outputs.map(|form| form.unit);
    Some(Linear { step: columns(&new, &states), outputs: columns(&outputs, &states), units })
}

fn columns(forms: &[Form], from: &[usize]) -> Square {
    forms.iter().map(|form| from.iter().map(|&k| form.of[k]).collect()).collect()
}

fn traced(subject: &Subject, kind: Kind, reach: f64) -> Traced {
    let innovation = subject.screening.innovation * 4_294_967_296.0 / std::f64::consts::TAU;
    match kind {
        Kind::Rigid => rigid(subject, reach, innovation),
        Kind::SemiImplicit => semi_implicit(subject, reach, innovation),
        Kind::Exact => exact(subject, reach, innovation),
    }
}

/// The bounds of an observer of these designs; `None` where its constants do not fit or its error does not decay.
pub fn bounds(subject: &Subject, kind: Kind) -> Option<Bounds> {
    let (step, new, outputs) = traced(subject, kind, ONE)?;
    let largest = [step.largest / WORD, traced(subject, kind, 2.0 * ONE)?.0.largest / WORD];
    let [error, coefficients] = impulse_responses(&step, &new, &outputs)?;
    Some(Bounds { error, coefficients, largest })
}

type Traced = Option<(Step, Vec<Form>, [Form; 4])>;

fn exact(subject: &Subject, reach: f64, largest: f64) -> Traced {
    let design = subject.two_mass.as_ref()?;
    let bases = subject.bases;
    let c = TwoMassConfig::<Fixed>::try_new(design, bases).ok()?;
    let r = TwoMassConfig::<f64>::try_new(design, Bases::SI).ok()?;
    let Bases { torque, speed, twist, twist_rate, forcing } = bases;
    let [torque, speed, twist, twist_rate, forcing] =
        [torque, speed, twist, twist_rate, forcing].map(|base| base / ONE);
    let (mut s, [w, v, d, l, residual]) = Step::new([speed, twist_rate, twist, torque, 1.0], reach, largest);
    let motor = s.symbol(most_torque(subject), torque);
    let s = &mut s;
    let carry = &mut s.carry();
    let forced =
        s.truncated(forcing, &[(c.forcing[0], r.forcing[0], &motor, 1.0), (c.forcing[1], r.forcing[1], &l, 1.0)]);
    let pair = |k: [Coefficient; 3], q: [f64; 3]| [(k[0], q[0]), (k[1], q[1]), (k[2], q[2])];
    let by = |of: [(Coefficient, f64); 3]| {
        [(of[0].0, of[0].1, &d, 4.0), (of[1].0, of[1].1, &v, 4.0), (of[2].0, of[2].1, &forced, 4.0)]
    };
    let new_d = s.accumulate(&d, carry, &by(pair(c.twist, r.twist)));
    let new_v = s.accumulate(&v, carry, &by(pair(c.twist_rate, r.twist_rate)));
    let accelerating = motor.plus(-1.0, &l);
    let new_w = s.accumulate(&w, carry, &[(c.acceleration, r.acceleration, &accelerating, 1.0)]);
    let path = [w.plus(1.0, &new_w), new_d.plus(-1.0, &d)];
    let turn = s.turn(&[(c.turn[0], r.turn[0], &path[0], 1.0), (c.turn[1], r.turn[1], &path[1], 4.0)]);
    let gain = |k: usize| (c.correction[k], r.correction[k]);
    let gains = [gain(0), gain(1), gain(2), gain(3)];
    let new = s.correct(
        carry,
        [&new_w, &new_v, &new_d, &l],
        (&residual, &turn, largest),
        gains,
        (c.angle_correction, r.angle_correction),
    );
    let ends = [s.carry(), s.carry()];
    let motor_speed = s.accumulate(&w, &mut ends[0].clone(), &[(c.share[0], r.share[0], &v, 4.0)]);
    let shaft = s.truncated(torque, &[(c.shaft[0], r.shaft[0], &d, 4.0), (c.shaft[1], r.shaft[1], &v, 4.0)]);
    let load_speed = s.accumulate(&w, &mut ends[1].clone(), &[(c.share[1], r.share[1], &v, 4.0)]);
    let step = Step { states: s.states, range: s.range.clone(), largest: s.largest };
    Some((step, new, [motor_speed, shaft, load_speed, l]))
}

fn semi_implicit(subject: &Subject, reach: f64, largest: f64) -> Traced {
    let design = subject.two_mass.as_ref()?;
    let c = SemiImplicitConfig::<Fixed>::try_new(design, subject.bases).ok()?;
    let r = SemiImplicitConfig::<f64>::try_new(design, Bases::SI).ok()?;
    let [torque, speed] = [subject.bases.torque, subject.bases.speed].map(|base| base / ONE);
    let (mut s, [m, w, t, l, residual]) = Step::new([speed, speed, torque, torque, 1.0], reach, largest);
    let motor = s.symbol(most_torque(subject), torque);
    let carry = &mut s.carry();
    let new_m = s.accumulate(&m, carry, &[(c.motor, r.motor, &motor.plus(-1.0, &t), 1.0)]);
    let new_w = s.accumulate(&w, carry, &[(c.load, r.load, &t.plus(-1.0, &l), 1.0)]);
    let rates = [new_m.plus(-1.0, &new_w), m.plus(-1.0, &w)];
    let terms = [(c.shaft[0], r.shaft[0], &rates[0], 1.0), (c.shaft[1], r.shaft[1], &rates[1], 1.0)];
    let new_t = s.accumulate(&t, carry, &terms);
    let turn = s.turn(&[(c.turn, r.turn, &new_m, 1.0)]);
    let gain = |k: usize| (c.correction[k], r.correction[k]);
    let gains = [gain(0), gain(1), gain(2), gain(3)];
    let angle = (c.angle_correction, r.angle_correction);
    let new = s.correct(carry, [&new_m, &new_w, &new_t, &l], (&residual, &turn, largest), gains, angle);
    Some((s, new, [m, t, w, l]))
}

fn rigid(subject: &Subject, reach: f64, largest: f64) -> Traced {
    let c = RigidConfig::<Fixed>::try_new(&subject.rigid, subject.load_share, subject.bases).ok()?;
    let r = RigidConfig::<f64>::try_new(&subject.rigid, subject.load_share, Bases::SI).ok()?;
    let [torque, speed] = [subject.bases.torque, subject.bases.speed].map(|base| base / ONE);
    let (mut s, [w, l, a, residual]) = Step::new([speed, torque, torque, 1.0], reach, largest);
    let motor = s.symbol(most_torque(subject), torque);
    // no state, but kept from tick to tick
    s.range[2] = (-reach - s.range[4].1, reach + s.range[4].1);
    let carry = &mut s.carry();
    let accelerating = motor.plus(-1.0, &l);
    let new_w = s.accumulate(&w, carry, &[(c.acceleration, r.acceleration, &accelerating, 1.0)]);
    let turn = s.turn(&[(c.turn, r.turn, &w.plus(1.0, &new_w), 1.0)]);
    let gains = [(c.correction[0], r.correction[0]), (c.correction[1], r.correction[1])];
    let angle = (c.angle_correction, r.angle_correction);
    let mut new = s.correct(carry, [&new_w, &l], (&residual, &turn, largest), gains, angle);
    new.insert(2, accelerating);
    let end = &mut s.carry();
    let shaft = s.accumulate(&l, end, &[(c.load_share, r.load_share, &a, 4.0)]);
    Some((s, new, [w, shaft, w, l]))
}

/// The torque that a sample may have, in units in the last place.
fn most_torque(subject: &Subject) -> (f64, f64) {
    let most = subject.screening.torque / subject.bases.torque * ONE;
    (-most, most)
}

/// A matrix, by rows.
pub type Square = Vec<Vec<f64>>;

fn product(a: &Square, b: &Square) -> Square {
    a.iter().map(|row| (0..b[0].len()).map(|j| row.iter().zip(b).map(|(x, of)| x * of[j]).sum()).collect()).collect()
}

fn absolute(a: &Square) -> Square {
    a.iter().map(|row| row.iter().map(|x| x.abs()).collect()).collect()
}

/// The sums of all impulse responses, in SI units, and their part by coefficients.
fn impulse_responses(step: &Step, new: &[Form], outputs: &[Form; 4]) -> Option<[[f64; 4]; 2]> {
    let n = step.states;
    let noise: Vec<usize> = (n + 1..step.range.len()).collect();
    let states: Vec<usize> = (0..n).collect();
    let (a, b) = (columns(new, &states), columns(new, &noise));
    let (c, d) = (columns(outputs, &states), columns(outputs, &noise));
    let middle: Square = noise.iter().map(|&k| vec![0.5 * (step.range[k].0 + step.range[k].1)]).collect();
    let half: Vec<f64> = noise.iter().map(|&k| 0.5 * (step.range[k].1 - step.range[k].0)).collect();
    let mut power: Square = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut sum = vec![vec![0.0; n]; n];
    let (mut mean, mut offset) =
        (product(&d, &middle), product(&d, &middle).iter().map(|x| x[0].abs()).collect::<Vec<_>>());
    let mut size: Square = absolute(&d);
    let b_middle = product(&b, &middle);
    let mut ticks = 0;
    // until a power is small beside the sum
    while ticks < 64 || power.iter().zip(&sum).any(|(p, s)| p.iter().zip(s).any(|(p, s)| p.abs() > 1e-9 * s)) {
        if ticks == MOST_TICKS {
            return None;
        }
        let seen = product(&c, &power);
        for (i, row) in product(&seen, &b).iter().enumerate() {
            row.iter().enumerate().for_each(|(k, h)| size[i][k] += h.abs());
        }
        for (i, row) in product(&seen, &b_middle).iter().enumerate() {
            mean[i][0] += row[0];
            offset[i] = offset[i].max(mean[i][0].abs());
        }
        power.iter().zip(&mut sum).for_each(|(p, s)| p.iter().zip(s).for_each(|(p, s)| *s += p.abs()));
        power = product(&a, &power);
        ticks += 1;
    }
    // S <= sum + S (6 u |A| sum + |A^N|): what is missing counts as a disturbance of the states
    let rounded = product(&absolute(&a), &sum);
    let missing: Square = (0..n)
        .map(|i| (0..n).map(|j| power[i][j].abs() + 8.0 * f64::EPSILON * (rounded[i][j] + sum[i][j])).collect())
        .collect();
    let square = product(&missing, &missing);
    if !(0..n).all(|i| (0..n).all(|j| square[i][j] <= 0.5 * missing[i][j])) {
        return None;
    }
    let rest = product(&sum, &missing);
    let rest = product(&product(&absolute(&c), &rest), &absolute(&b));
    let mut bounds = [[0.0; 4]; 2];
    for i in 0..4 {
        let unit = outputs[i].unit;
        for (k, &symbol) in noise.iter().enumerate() {
            let (low, high) = step.range[symbol];
            // and the roundings of these sums
            let whole = (size[i][k] + 2.0 * rest[i][k]) * SLACK;
            bounds[0][i] += (whole * half[k] + 2.0 * rest[i][k] * middle[k][0].abs()) * unit;
            if low == -high {
                bounds[1][i] += whole * half[k] * unit;
            }
        }
        bounds[0][i] += offset[i] * unit * SLACK;
    }
    Some(bounds)
}
