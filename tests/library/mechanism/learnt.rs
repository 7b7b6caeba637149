//! Mechanisms learnt from a run at two speeds.

use std::f64::consts::TAU;

use driveline::learning::MechanismFit;
use driveline::machine::MECHANISM_POINTS;
use driveline_solver::noise::Noise;

use super::rig::{LAWS, Machine, RATIO, between, draw};

const RATE_HZ: f64 = 4_000.0;
/// Ticks on either side over which the speed is the slope of a cubic through the angles.
const SPAN: usize = 10;
/// Sixteen orders.
const P: usize = 67;

/// Slope in a tick of the cubic that fits best: `(S6 t - S4 t^3)/(S2 S6 - S4^2)`, Sn the sums of `t^n`.
fn slope(angles: &[f64]) -> f64 {
    let times = || (0..angles.len()).map(|k| k as f64 - SPAN as f64);
    let sum = |power: i32| times().map(|t| t.powi(power)).sum::<f64>();
    let (s2, s4, s6) = (sum(2), sum(4), sum(6));
    let weights = times().map(|t| (s6 * t - s4 * t.powi(3)) / (s2 * s6 - s4 * s4));
    weights.zip(angles).map(|(weight, angle)| weight * (angle - angles[0])).sum()
}

/// Largest error of inertia at the motor, of the largest inertia of the mechanism there, and of the weight's torque, of
/// its largest.
fn errors(law: &str, noise: &mut Noise) -> [f64; 2] {
    let drawn = draw(law, noise);
    let plain = Machine::new(&drawn, 1.0, 0.0);
    let leverage = drawn.mechanism.points.iter().map(|p| p.leverage.abs()).fold(0.0, f64::max);
    let weight = between(noise, 0.5, 1.5) * plain.most_taken(60.0) * RATIO / leverage;
    let mut machine = Machine::new(&drawn, between(noise, 2.0, 4.0), weight);
    machine.viscous = between(noise, 0.0, 0.2) * machine.most_taken(60.0) / 60.0;
    let strong = 3.0 * machine.most_taken(120.0);
    let (mut fit, mut seen, mut works) = (MechanismFit::<P>::default(), Vec::new(), Vec::new());
    let (mut work, mut integral) = (0.0, 0.0);
    machine.speed = 60.0;
    for tick in 0..(12.0 * RATE_HZ) as u32 {
        // two seconds at each speed
        let setpoint = if (f64::from(tick) / (2.0 * RATE_HZ)) as u32 & 1 == 0 { 60.0 } else { 120.0 };
        // soft control at a mean torque that the motor reports with 1 % of noise
        let error = setpoint - machine.speed;
        let gain = 4.0 * machine.constant;
        integral += 2.0 * gain / RATE_HZ * error;
        let torque = (gain * error + integral).clamp(-strong, strong);
        let before = machine.angle;
        machine.tick(torque, 1.0 / RATE_HZ);
        let reported = torque + 0.01 * strong / 3.0 * noise.normal();
        work += reported * (machine.angle - before);
        seen.push((machine.angle / TAU * 131_072.0).round() / 131_072.0 * TAU);
        works.push(work);
    }
    // ends of segments: a sixty-fourth of a turn of the crank apart or a little more
    let speed = |k: usize| slope(&seen[k - SPAN..=k + SPAN]) * RATE_HZ / RATIO;
    let mut last = SPAN;
    for k in SPAN..seen.len() - SPAN {
        if seen[k] - seen[last] >= RATIO * TAU / 64.0 {
            // sharp toggles and cams turn it back on their way to the other speed
            if seen[last..=k].is_sorted() {
                fit.segment([last, k].map(|k| seen[k] / RATIO), [last, k].map(speed), works[k] - works[last]);
            }
            last = k;
        }
    }
    let learnt = fit.mechanism().expect("two speeds determine it");
    let (mut off, mut most) = ([0.0_f64; 2], [0.0_f64; 2]);
    for (j, point) in learnt.mechanism.points.iter().enumerate() {
        let [inertia, _, weight] = machine.at(RATIO * TAU * j as f64 / MECHANISM_POINTS as f64);
        off[0] = off[0].max((point.inertia / 100.0 - inertia).abs());
        off[1] = off[1].max((point.leverage / RATIO - weight).abs());
        most = [most[0].max(inertia), most[1].max(weight.abs())];
    }
    [off[0] / most[0], off[1] / most[1]]
}

/// 100 drawn mechanisms, 20 of each law, with the encoder's counts and 1 % of noise of the torque.
#[test]
fn mechanisms_are_learnt_from_a_run_at_two_speeds() {
    let mut noise = Noise::new(46);
    for law in LAWS {
        let all: Vec<_> = (0..20).map(|_| errors(law, &mut noise)).collect();
        let worst = [0, 1].map(|of| all.iter().map(|off| off[of]).fold(0.0, f64::max));
        println!("{law}: inertia {:.4}, weight {:.4}", worst[0], worst[1]);
        assert!(worst[0] < 0.01, "{law}: {worst:?}");
    }
}

#[test]
fn one_speed_does_not_determine_a_mechanism() {
    let mut fit = MechanismFit::<7>::default();
    for k in 0..200 {
        fit.segment([k, k + 1].map(|k| 0.1 * f64::from(k)), [5.0; 2], 1.0);
    }
    assert_eq!(fit.mechanism(), None);
}
