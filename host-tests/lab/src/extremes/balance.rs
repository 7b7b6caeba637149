//! Balancing where its numbers are hard: planes that act alike, a rotor beside its resonance.

use driveline::balancing::{Action, Aim, Complex, InRun, InRunConfig, Influence};
use driveline_solver::noise::Noise;

use super::solver::said;
use super::{Cases, Found};

pub(super) fn add(all: &mut Cases) {
    all.subject("dependent planes", "weights, of the largest", "the weights that the vibration was made from");
    for decade in [0, -1, -2, -3, -4, -6, -8, -10, -12, -14, -15, -17] {
        all.case(format!("planes that differ by 1e{decade} of their effect"), || planes(10_f64.powi(decade)));
    }
    const ERROR: &str = "largest of: unbalance at the end, of that found; on the way, of 1.3 of it";
    all.subject("in-run beside a resonance", ERROR, "closed form of the oscillator");
    for speed in [0.5, 0.9, 0.97, 0.99, 0.997, 1.0, 1.003, 1.01, 1.03, 1.1, 2.0] {
        for damping in [0.02, 0.003] {
            all.case(format!("{speed} of the critical speed, damping ratio {damping}"), || in_run(speed, damping));
        }
    }
}

/// Two planes and four readings. The least independent share that is asked for is a thousandth of what the planes
/// differ by, so that no plane is left out by the usual rule of 1 %.
fn planes(apart: f64) -> Result<Found, String> {
    let first = [(1.0, 0.2), (0.4, 1.9), (0.8, -2.2), (0.3, 0.9)].map(|(size, at)| Complex::from_polar(size, at));
    let other = [(0.5, 2.9), (0.9, -0.4), (0.2, 0.3), (0.7, -1.2)].map(|(size, at)| Complex::from_polar(size, at));
    let second: [Complex<f64>; 4] =
        core::array::from_fn(|row| first[row] * Complex::new(0.8, 0.3) + other[row] * apart);
    let weights = [Complex::from_polar(2.0, 1.0), Complex::from_polar(3.0, -2.0)];
    let mut influence = Influence::<f64, 4, 2>::new(4, 2).map_err(said)?;
    influence.set(0, &first).map_err(said)?;
    influence.set(1, &second).map_err(said)?;
    let vibration: [Complex<f64>; 4] =
        core::array::from_fn(|row| -(first[row] * weights[0] + second[row] * weights[1]));
    let aim = Aim { independence: 1e-3 * apart, ..Aim::default() };
    let found = influence.correct(&vibration, &aim).map_err(said)?;
    if let Some(out) = found.left_out.first() {
        return Err(format!("plane {} is left out: {:.1e} of its effect is its own", out.plane + 1, out.own));
    }
    let off = |k: usize| (found.weights[k] - weights[k]).norm() / weights[1].norm();
    // the condition number is printed beside the weights: an error of that many roundings is said
    Ok(Found { error: off(0).max(off(1)), limit: 8.0 * f64::EPSILON * found.condition })
}

/// One head, two sensors, 300 rotors. The speed wanders by 0.1 % from reading to reading, which beside the resonance
/// turns and scales what a weight does.
fn in_run(speed: f64, damping: f64) -> Result<Found, String> {
    let config =
        InRunConfig { probe: 0.01, limits: [1.0], step: 2.0, bound: 1.3, target: 0.04, forgetting: 0.8, noise: 0.015 };
    let mut noise = Noise::new(44);
    let (mut worst, mut refused) = (0.0_f64, None);
    for _ in 0..300 {
        let needed = Complex::from_polar(0.05 + 0.45 * (1.0 + noise.uniform()), 3.1 * noise.uniform());
        let mut run = InRun::<f64, 2, 1>::new(config, 2, [Complex::new(0.0, 0.0)]).map_err(said)?;
        let mut placed = Complex::new(0.0, 0.0);
        // whatever the speed does to the vibration of the rotor as it was found
        let left = |placed: Complex<f64>| (placed - needed).norm() / needed.norm();
        let mut stopped = false;
        for _ in 0..40 {
            let ratio = speed * (1.0 + 1e-3 * noise.uniform());
            let square = ratio * ratio;
            let act = Complex::new(square, 0.0) / Complex::new(1.0 - square, 2.0 * damping * ratio);
            let sensors = [act, act * Complex::from_polar(0.6, 0.5)];
            let reading = sensors.map(|act| act * (placed - needed));
            worst = worst.max(left(placed) / 1.3);
            match run.advise(&reading, 0.0) {
                Action::Set([to]) => placed = to,
                Action::Hold => break,
                Action::Abort([to], why) => {
                    (placed, stopped, refused) = (to, true, Some(why));
                    break;
                }
            }
        }
        // the weights of an abort are the best so far
        worst = worst.max(left(placed) * if stopped { 1.0 / 1.3 } else { 1.0 });
    }
    match refused {
        Some(why) if worst <= 1.0 => Err(format!("some rotors: {why}")),
        _ => Ok(Found { error: worst, limit: 1.0 }),
    }
}
