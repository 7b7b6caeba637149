//! Chains thrown together at random, each run proved by the second integrator: what no one thought of a case for.

use driveline_solver::plant::converge::{Recording, prove};
use driveline_solver::plant::{Chain, Shaft, Start};

/// A generator of 64 bits (Marsaglia's xorshift), seeded, so that every run is the same.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly on a logarithmic scale.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.roll())
    }

    fn often(&mut self, share: f64) -> bool {
        self.roll() < share
    }
}

/// A shaft, and the sign of what it may carry: above zero a rope's, that of its twist in a gap, or either.
fn shaft(dice: &mut Dice) -> (Shaft, fn(f64) -> f64) {
    let stiffness = dice.between(200.0, 5.0e4);
    let is_rope = dice.often(0.25);
    let mut shaft = if is_rope { Shaft::rope(stiffness) } else { Shaft::elastic(stiffness) };
    let mut sign: fn(f64) -> f64 = if is_rope { |_| 1.0 } else { |_| 0.0 };
    if dice.often(0.6) {
        shaft = shaft.damping(dice.between(0.05, 3.0));
    }
    if dice.often(0.6) {
        shaft = shaft.gap(dice.between(1e-3, 0.1));
        sign = if is_rope { sign } else { f64::signum };
    }
    (shaft, sign)
}

fn chain(dice: &mut Dice) -> (Chain, Vec<fn(f64) -> f64>) {
    let mut signs = Vec::new();
    let mut chain = Chain::motor(dice.between(0.1, 2.0));
    let shafts = 1 + (dice.roll() * 3.0) as usize;
    for s in 0..=shafts {
        if dice.often(0.4) {
            chain = chain.viscous(dice.between(1e-3, 0.5));
        }
        if dice.often(0.4) {
            chain = chain.coulomb(dice.between(0.5, 60.0));
        }
        if dice.often(0.4) {
            chain = chain.load(dice.between(1.0, 80.0) * if dice.often(0.7) { 1.0 } else { -1.0 });
        }
        if s < shafts {
            if dice.often(0.3) {
                chain = chain.efficiency(dice.between(0.6, 0.99)).back_efficiency(dice.between(0.4, 0.99));
            }
            let ((link, sign), inertia) = (shaft(dice), dice.between(0.05, 2.0));
            signs.push(sign);
            chain = chain.shaft(link, inertia);
        }
    }
    (if dice.often(0.5) { chain.start(Start::Slack) } else { chain }, signs)
}

#[test]
fn chains_at_random_prove_their_convergence() {
    let (mut events, mut largest) = (0, 0.0_f64);
    for seed in 1..=200_u64 {
        let mut dice = Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let (chain, signs) = chain(&mut dice);
        let mut run = Recording::new(chain.clone().build().unwrap());
        let node = (dice.roll() * chain.nodes() as f64) as usize;
        let dt = dice.between(1e-4, 2e-3);
        let mut torque = 0.0;
        // a rattling chain is chaotic: after a hundred impacts 1e-14 s in one of them has grown to 1e-8 of peak, so
        // runs are kept to some fifty
        for tick in 0..300 {
            if tick % 40 == 0 {
                torque = 400.0 * dice.roll() - 150.0;
            }
            match tick {
                150 => run.set_brake(node, 200.0),
                200 => run.set_brake(node, 0.0),
                250 => run.set_load_torque(node, 60.0 * dice.roll()),
                _ => {}
            }
            run.advance(torque, dt);
            // a flank never pulls, a rope never pushes
            for (s, sign) in signs.iter().enumerate() {
                let (carried, twist) = (run.plant().torque_behind_gear(s), run.plant().twist(s));
                assert!(carried * sign(twist) >= -1e-9, "seed {seed}, tick {tick}: {carried} at {twist}: {chain:#?}");
            }
        }
        events += run.plant().events().len();
        match prove(&run) {
            Ok(proof) => largest = largest.max(proof.largest()),
            Err(refused) => panic!("seed {seed}: {refused}\n{chain:#?}"),
        }
    }
    println!("200 chains, {events} events: at most {largest:.1e} of peak apart");
}
