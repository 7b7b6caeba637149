//! Random stiff trains: a right run is not refused, a wrong one is.

use super::tests::passed_off;
use super::{Proof, Recording, prove_in_pieces};
use crate::noise::Noise;
use crate::plant::train::{Coordinate, Crank, Friction, Harmonic, Link, Source, Train, Waveform};
use crate::plant::{EventKind, LoadProgram};

/// Even in the logarithm.
fn between(noise: &mut Noise, low: f64, high: f64) -> f64 {
    low * (high / low).powf(0.5 * (noise.uniform() + 1.0))
}

fn one_of(noise: &mut Noise, share: f64) -> bool {
    0.5 * (noise.uniform() + 1.0) < share
}

/// A chain with rates of a few to 1e4 rad/s: gaps, ropes, lossy gears, dry friction, pulses, pendulums, cranks. All of
/// it turns at `turning` rad/s besides its own motion, and damping is too large by `fault`.
fn train(noise: &mut Noise, turning: f64, fault: f64) -> Train {
    let masses = 2 + (1.5 * (noise.uniform() + 1.0)) as usize;
    let inertia: Vec<f64> = (0..masses).map(|_| between(noise, 0.05, 5.0)).collect();
    let cranked = one_of(noise, 0.25);
    let mut train = Train::new();
    for (at, inertia) in inertia.iter().enumerate() {
        let own = if one_of(noise, 0.5) { 5.0 * noise.uniform() } else { 0.0 };
        let mut coordinate = Coordinate::new(*inertia).speed(turning + own);
        coordinate = coordinate.viscous(between(noise, 0.01, 0.3) * (1.0 + fault));
        if at == 0 {
            let (torque, period) = (between(noise, 5.0, 60.0), between(noise, 0.03, 0.6));
            coordinate = coordinate.source(if one_of(noise, 0.4) {
                Source::Waveform(Waveform::square(torque, period, 5))
            } else if one_of(noise, 0.5) {
                Source::Waveform(Waveform::triangle(torque, period, 3))
            } else {
                Source::Constant(torque)
            });
        }
        if one_of(noise, 0.3) {
            let sine = -between(noise, 2.0, 60.0);
            coordinate = coordinate.source(Source::Orders(vec![Harmonic { order: 1.0, cosine: 0.0, sine }]));
        }
        if at + 1 == masses {
            let (begin, torque) = (between(noise, 0.05, 0.5), 40.0 * noise.uniform());
            let pulse = LoadProgram::steps(&[(0.0, 0.0), (begin, torque), (begin + 0.1, -0.3 * torque)]);
            coordinate = coordinate.source(Source::Program(pulse));
            if cranked {
                coordinate = coordinate.crank(Crank::new(between(noise, 0.04, 0.1), 0.3, between(noise, 1.0, 20.0)));
            }
        }
        train = train.coordinate(coordinate);
    }
    for at in 1..masses {
        let stiffness = between(noise, 300.0, 5e6);
        let mass = inertia[at - 1] * inertia[at] / (inertia[at - 1] + inertia[at]);
        let damping = 2.0 * between(noise, 1e-3, 0.1) * (stiffness * mass).sqrt() * (1.0 + fault);
        let mut link = Link::shaft(at - 1, at, stiffness).damping(damping);
        if one_of(noise, 0.4) {
            link = link.gap(between(noise, 1e-4, 2e-2));
        }
        if one_of(noise, 0.15) {
            link = link.rope();
        }
        if one_of(noise, 0.2) {
            link = link.efficiency(between(noise, 0.6, 0.98));
        }
        train = train.link(link);
    }
    let mut grounded = usize::from(train.links[0].is_lossy());
    for at in 0..masses {
        if one_of(noise, 0.3) {
            let torque = between(noise, 0.3, 6.0);
            train = train.friction(Friction::ground(at, torque).breakaway(1.3 * torque));
            grounded += usize::from(at < 2);
        }
    }
    // three that hold two masses would leave open which of them slips first
    if one_of(noise, 0.2) && !cranked && grounded == 0 {
        train = train.friction(Friction::between(0, 1, between(noise, 0.3, 6.0)));
    }
    train
}

/// The train of a number over a second, and the same with a fault; none without an event.
fn run(number: u64, turning: f64, fault: f64, dt: f64) -> Option<Recording> {
    let noise = Noise::new(0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(2 * number + 1));
    let of = |fault: f64| train(&mut noise.clone(), turning, fault);
    of(0.0).build().ok()?;
    let run = passed_off(of(fault), of(0.0), dt, (1.0 / dt).round() as usize);
    let events = run.motion().events();
    let is_resolved = events.iter().all(|event| event.kind != EventKind::Unresolved);
    (!events.is_empty() && is_resolved).then_some(run)
}

/// Runs of each test; of 364 at rest none was refused, 56 were proven in pieces; of 306 that turn none, 75.
const RUNS: u64 = 40;
/// Speeds that all turn at, rad/s: a rounding of them is a large share of a small elongation.
const TURNING: [f64; 2] = [0.0, 100.0];

#[test]
fn a_right_run_of_a_random_train_is_not_refused() {
    // the longer a tick, the more steps of the second integrator are in it
    for turning in TURNING {
        let ticks = [1e-3, 4e-3].into_iter().flat_map(|dt| (0..RUNS).map(move |number| (number, dt)));
        let runs: Vec<Recording> = ticks.filter_map(|(number, dt)| run(number, turning, 0.0, dt)).collect();
        let mut pieces = 0;
        for run in &runs {
            let proof = prove_in_pieces(run, |_| {});
            let proof = proof.unwrap_or_else(|error| panic!("{turning} {error}: {:#?}", run.run.start.train));
            pieces += usize::from(proof.sensitive.is_some());
        }
        // fewer have an event where all turn
        let least = if turning == 0.0 { 60 } else { 50 };
        assert!(runs.len() > least && pieces > 4, "{turning} {} {pieces}", runs.len());
    }
}

/// At 1000 rad/s a share of 1e-13 of a speed moves a stiff link by 1e-8 of its swing, and five of 302 right runs were
/// refused; this is one of them. Two still are.
#[test]
fn a_right_run_of_a_fast_stiff_train_is_not_refused() {
    let proof = prove_in_pieces(&run(11, 1000.0, 0.0, 1e-3).unwrap(), |_| {}).unwrap();
    assert!(proof.sensitive.is_none() && proof.largest() < 2e-9, "{proof:?}");
}

/// A millionth too much damping moves every run by more than the bound. A hundredth of that is within it or refused:
/// no run is called sensitive for it.
#[test]
fn a_wrong_run_of_a_random_train_is_refused() {
    let faults = [(1e-6, 0), (1e-8, RUNS as usize)];
    for (turning, (fault, within)) in TURNING.into_iter().flat_map(|turning| faults.map(|fault| (turning, fault))) {
        let runs = (0..RUNS).filter_map(|number| run(number, turning, fault, 1e-3));
        let proofs: Vec<Proof> = runs.filter_map(|run| prove_in_pieces(&run, |_| {}).ok()).collect();
        assert!(proofs.len() <= within, "{turning} {fault}: {proofs:?}");
        assert!(proofs.iter().all(|proof| proof.sensitive.is_none()), "{turning} {fault}: {proofs:?}");
    }
}
