//! Two masses of trains with nearly equal branches, and of random ones, against the motor's response by recursion.

use driveline::machine::{Chain, Damping, Inertia, Match, Ratio, Stiffness, Train, TwoMass};
use nalgebra::Complex;

use crate::machine::chain;
use crate::noise::Noise;
use crate::references::close;

const ONE: Ratio = Ratio(1.0);

/// Loss factor of every spring: 2 % of critical damping at each resonance, which keeps the peaks finite.
const LOSS: Complex<f64> = Complex { re: 1.0, im: 0.04 };

/// Inertia that turns at the other end of a spring, at a frequency: `k X/(k - omega^2 X)`.
fn through(stiffness: f64, inertia: Complex<f64>, omega: f64) -> Complex<f64> {
    let k = LOSS * stiffness;
    k * inertia / (k - inertia * omega * omega)
}

/// The motor's acceleration per torque, times the total inertia: from the ends of the tree to the motor, mass by mass.
fn response(train: &Train, omega: f64) -> Complex<f64> {
    let mut seen: Vec<Complex<f64>> = train.masses().iter().map(|&j| Complex::new(j, 0.0)).collect();
    for joint in train.joints().iter().rev() {
        let beyond = through(joint.shaft.stiffness, seen[joint.to], omega);
        seen[joint.from] += beyond;
    }
    train.total_inertia() / seen[0]
}

fn reduced(two: &TwoMass, omega: f64) -> Complex<f64> {
    let load = through(two.stiffness, Complex::new(two.load_inertia, 0.0), omega);
    two.total_inertia() / (two.motor_inertia + load)
}

/// Error of two masses up to a frequency, rms over the rms of the response.
fn error(train: &Train, two: &TwoMass, top: f64) -> f64 {
    let (mut off, mut all) = (0.0, 0.0);
    for n in 1..=2000 {
        let omega = top * f64::from(n) / 2000.0;
        let whole = response(train, omega);
        off += (whole - reduced(two, omega)).norm_sqr();
        all += whole.norm_sqr();
    }
    (off / all).sqrt()
}

/// The two masses with the first resonance that moves the motor at all, and the antiresonance below it.
fn of_first_mode(train: &Train) -> TwoMass {
    let (modes, total) = (train.modes(), train.total_inertia());
    let seen = |residue: f64| residue * total >= 1e-6;
    let first = modes.resonances().iter().position(|mode| seen(mode.residue)).unwrap();
    let (resonance, held) = (modes.resonances()[first].frequency, modes.antiresonances()[first]);
    let motor = total * (held / resonance).powi(2);
    let load = total - motor;
    TwoMass::new(Inertia(motor), Inertia(load), Stiffness(held * held * load), Damping(0.0))
}

/// A stand whose spindles differ by a quarter, their rolls by a twentieth: the rolls' swing against each other comes
/// first, and has a twentieth of the main mode's share at the motor.
#[test]
fn unequal_spindles() {
    let (k, j) = ([1.1e8, 1.4e8], [1.52e4, 1.44e4]);
    let spindle = |side: usize| chain(&[500.0, j[side]], &k[side..=side]);
    let train = Train::of(chain(&[3.0e4, 2.0e3], &[4.0e9])).branch(1, ONE, spindle(0)).branch(1, ONE, spindle(1));
    let two = train.reduce(Match::ResonanceAntiresonance);
    // Each shaft passes on the share of the torque that the inertia beyond it takes.
    let total = 3.3e4 + j[0] + j[1];
    let share = |beyond: f64, k: f64| (beyond / total).powi(2) / k;
    let compliance = share(total - 3.0e4, 4.0e9) + share(j[0], k[0]) + share(j[1], k[1]);
    let found = share(two.load_inertia, two.stiffness) / compliance - 1.0;
    close(1.0 + found, 1.0 + two.error.compliance, 1e-13);
    // The first mode alone would give a third of it; the modes left out are worth a twentieth.
    let first = of_first_mode(&train);
    assert!(share(first.load_inertia, first.stiffness) / compliance < 0.35);
    assert!(found.abs() < 0.05, "{found}");
    // The resonance is the highest peak of the response below the coupling's, and the one left out lies below it.
    let grid = (600..1600).map(|n| 0.1 * f64::from(n));
    let peak = grid.max_by(|a, b| response(&train, *a).norm().total_cmp(&response(&train, *b).norm())).unwrap();
    // the grid's step, and the shift of a peak of acceleration, the loss factor squared
    assert!((two.resonance() - peak).abs() < 0.1 + 0.0016 * peak, "{peak}");
    assert!(two.error.next_mode < 0.8 * two.resonance() && two.error.next_share < 0.05);
    assert!(error(&train, &two, 150.0) < 0.1 && error(&train, &first, 150.0) > 0.9);
}

/// Branches that differ a little, towards those that are equal: two masses come as near as the square of the
/// difference, since to first order the swing against each other takes nothing from the motor.
#[test]
fn nearly_equal_branches_join() {
    for difference in [1e-6_f64, 1e-4, 1e-2, 0.1] {
        let wheel = |sign: f64| chain(&[0.01, 0.5], &[2.0e4 * (1.0 + sign * difference)]);
        let train = Train::of(Chain::motor(Inertia(0.3))).branch(0, ONE, wheel(1.0)).branch(0, ONE, wheel(-1.0));
        let two = train.reduce(Match::ResonanceAntiresonance);
        // twice the square, and the digits that the inertia keeps of the difference of two frequencies
        let tolerance = 2.0 * difference * difference + 1e-12;
        close(two.motor_inertia, 0.32, tolerance);
        close(two.load_inertia, 1.0, tolerance);
        close(two.stiffness, 4.0e4, tolerance);
    }
}

/// Machines at random.
struct Random(Noise);

impl Random {
    fn inertias(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.0.between(0.05, 2.0)).collect()
    }

    fn stiffnesses(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.0.between(1e3, 1e5)).collect()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.0.even() * count as f64) as usize
    }

    fn chain(&mut self) -> Train {
        let masses = 3 + self.below(4);
        Train::of(chain(&self.inertias(masses), &self.stiffnesses(masses - 1)))
    }

    /// Two or three branches: at any mass and of any size, or at the last one and alike within 15 %.
    fn branched(&mut self, alike: bool) -> Train {
        let masses = 1 + self.below(3);
        let mut train = Train::of(chain(&self.inertias(masses), &self.stiffnesses(masses - 1)));
        let (j, k) = (self.0.between(0.05, 2.0), self.0.between(1e3, 1e5));
        for _ in 0..2 + self.below(2) {
            let mut near = |value: f64| value * (0.85 + 0.3 * self.0.even());
            let (at, j, k) = if alike {
                (masses - 1, near(j), near(k))
            } else {
                (self.below(masses), self.0.between(0.05, 2.0), self.0.between(1e3, 1e5))
            };
            train = train.branch(at, ONE, chain(&[1e-3, j], &[k]));
        }
        train
    }
}

/// 600 random machines: the mode of the largest compliance against the first one. Means over the machines of the rms
/// error up to the second antiresonance, by the first mode and by the main one: 0.64 and 0.35, 1.11 and 0.12, 0.66 and
/// 0.37.
#[test]
fn main_mode_of_random_trains() {
    let mut random = Random(Noise::new(1));
    // Limits are a tenth above the means, which are of these machines.
    for (name, limit, gain) in [("chains", 0.38, 1.5), ("alike", 0.14, 8.0), ("branched", 0.41, 1.5)] {
        let (mut old, mut new, mut worst) = (0.0, 0.0, 0.0_f64);
        for _ in 0..200 {
            let train = match name {
                "chains" => random.chain(),
                _ => random.branched(name == "alike"),
            };
            let top = train.modes().antiresonances()[1];
            let found = error(&train, &train.reduce(Match::ResonanceAntiresonance), top);
            old += error(&train, &of_first_mode(&train), top) / 200.0;
            new += found / 200.0;
            worst = worst.max(found);
        }
        println!("{name}: {old:.3} by the first mode, {new:.3}, at worst {worst:.2}");
        assert!(new < limit && old > gain * new, "{name}: {new}, {old}");
        // A machine whose response in the band is another mode's: as wrong as no vibration at all, but no more.
        assert!(worst < 1.2, "{name}: {worst}");
    }
}
