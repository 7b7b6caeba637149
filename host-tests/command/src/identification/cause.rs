//! Why two masses do not explain a record: what explains it instead.

use nalgebra::{Complex, Matrix3, Vector3};

use super::estimate::{Estimate, Setting, three};
use super::model::Motion;
use super::refusal::{LEAST, Refusal};
use super::spectrum::Line;

/// Torque in phase with the acceleration, weighted by torque and speed, below which the torque has the other sign. It is
/// one of a free inertia; friction, a swing or a dead time make it smaller, which turns the highest lines most.
const AGAINST: f64 = -0.1;
/// Share of the motion that a rigid machine may leave unexplained.
const RIGID: f64 = 0.1;
/// Share of what two masses leave unexplained that three may leave, to be the machine.
const LESS: f64 = 0.6;
/// Largest share of the torque that three masses may leave unexplained.
const UNEXPLAINED: f64 = 0.4;
/// Fall of minus twice the logarithm of the likelihood that makes three parameters more significant.
const LIKELIER: f64 = 3.0 * LEAST;
/// Power of a line's torque, of the strongest's, below which it says nothing here.
const FAINT: f64 = 1e-4;

/// A machine without a shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// Inertia (kg m2).
    pub inertia: f64,
    /// Viscous friction (N m s/rad).
    pub friction: f64,
}

/// What the record shows instead of two masses, where that can be told; else why two masses are refused. `improvement`
/// is the ratio of variances without the first guess' resonance and with it.
#[must_use]
pub fn instead(refusal: Refusal, carriers: &[Line], motion: Motion, improvement: f64) -> Refusal {
    let strongest = carriers.iter().map(|line| line.torque.norm_sqr()).fold(0.0, f64::max);
    let clear = carriers.iter().filter(|line| line.torque.norm_sqr() > FAINT * strongest);
    let pairs: Vec<Pair> = clear.map(|line| Pair::of(line, motion)).collect();
    if in_phase(&pairs) < AGAINST {
        return Refusal::Sign;
    }
    match rigid(&pairs) {
        Some((rigid, missed)) if improvement < LEAST && missed < RIGID => Refusal::Rigid { ratio: improvement, rigid },
        _ => refusal,
    }
}

/// A third mass that swings in the band, where three masses leave much less unexplained than two.
#[must_use]
pub fn third(lines: &[Line], two: &Estimate, setting: Setting) -> Option<Refusal> {
    let [two, three] = three(lines, two, setting)?;
    let [low, high] = three.model.resonances()?;
    let is_machine = three.model.third.is_some_and(|third| third.damping > 0.0);
    let is_within = two.band[0] <= low && high <= two.band[1];
    let is_likelier = two.unlikely - three.unlikely > LIKELIER;
    let is_nearer = three.unexplained < UNEXPLAINED.min(LESS * two.unexplained);
    (is_machine && is_within && is_likelier && is_nearer).then(|| Refusal::Third(Box::new(three.model)))
}

/// Torque and speed of a line, at its frequency.
struct Pair {
    s: Complex<f64>,
    torque: Complex<f64>,
    speed: Complex<f64>,
}

impl Pair {
    fn of(line: &Line, motion: Motion) -> Self {
        let s = Complex::new(0.0, line.frequency);
        let speed = if motion == Motion::Acceleration { line.motion / s } else { line.motion };
        Self { s, torque: line.torque, speed }
    }
}

fn in_phase(pairs: &[Pair]) -> f64 {
    let sums = pairs.iter().map(|Pair { s, torque, speed }| {
        let product = torque.conj() * s.unscale(s.norm()) * speed;
        [product.re, product.norm()]
    });
    let [with, all] = sums.fold([0.0; 2], |[with, all], [re, size]| [with + re, all + size]);
    with / all
}

/// The rigid machine that comes nearest to the speeds, and the share of them that it leaves. What the speed has gained
/// over the record stands in every line as one constant.
fn rigid(pairs: &[Pair]) -> Option<(Rigid, f64)> {
    let one = Complex::new(1.0, 0.0);
    let mut found = Vector3::new(1.0, 0.0, 0.0);
    let response = |found: &Vector3<f64>, s: &Complex<f64>| (s * found[0] + found[1]).inv();
    let given = |found: &Vector3<f64>, pair: &Pair| response(found, &pair.s) * (pair.torque - found[2]);
    // errors of the torque, each weighted by the response to it; the speed that the torque would give is the instrument,
    // which has no noise of the measured one
    for _ in 0..8 {
        let (mut information, mut slope) = (Matrix3::zeros(), Vector3::zeros());
        for pair in pairs {
            let Pair { s, torque, speed } = pair;
            let weight = response(&found, s).norm_sqr();
            let given = given(&found, pair);
            for (row, instrument) in [s * given, given, one].iter().enumerate() {
                for (column, other) in [s * speed, *speed, one].iter().enumerate() {
                    information[(row, column)] += weight * (instrument.conj() * other).re;
                }
                slope[row] += weight * (instrument.conj() * torque).re;
            }
        }
        found = information.lu().solve(&slope)?;
    }
    let left: f64 = pairs.iter().map(|pair| (pair.speed - given(&found, pair)).norm_sqr()).sum();
    let all: f64 = pairs.iter().map(|pair| pair.speed.norm_sqr()).sum();
    let rigid = Rigid { inertia: found[0], friction: found[1] };
    (rigid.inertia > 0.0).then(|| (rigid, (left / all).sqrt()))
}
