//! The second integration of a chain, from its recording.

use super::super::chain::Chain;
use super::super::solver::Plant;
use super::pass::{CLOSE, Pass, REACH};
use super::proof::NotProven;
use super::recording::{Recording, Step};
use super::textbook::{Change, Machine};

/// Runs the recording again; one sample per tick.
pub(super) fn rerun(run: &Recording) -> Result<Vec<Vec<f64>>, NotProven> {
    let plant = &run.start;
    let mut y = plant.x.clone();
    let mut machine = Machine::new(plant, &y);
    let mut pass = Pass::new(&scale(run, plant), REACH / fastest(&plant.chain), CLOSE);
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
                tick(&mut pass, &mut machine, &mut y, start, dt)?;
                start += dt;
                samples.push(sample(&machine, start, &y));
            }
            Step::Load { node, torque } => machine.load[node] = torque,
            Step::Brake { node, torque } => {
                machine.dry[node] = machine.chain.nodes[node].coulomb + torque;
                machine.judge(start, &y, node);
            }
            Step::Shaft { shaft, stiffness, damping } => {
                machine.wind(&mut y, shaft, stiffness, damping);
                pass.longest = pass.longest.min(REACH / fastest(&machine.chain));
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
    let twists =
        plant.chain.shafts.iter().enumerate().map(|(s, shaft)| or_one((peak(n + s) / shaft.stiffness).max(shaft.gap)));
    twists.chain(vec![top_speed; n]).chain([or_one(peak(2 * n - 1))]).collect()
}

/// Bound of the rates of the chain, 1/s, by Gershgorin's circles.
fn fastest(chain: &Chain) -> f64 {
    let shafts = &chain.shafts;
    let rates = chain.nodes.iter().enumerate().map(|(j, node)| {
        let near = [j.checked_sub(1), Some(j)].into_iter().flatten().filter_map(|s| shafts.get(s));
        let (k, d) = near.fold((0.0, node.viscous), |(k, d), shaft| (k + shaft.stiffness, d + shaft.damping));
        let loss = node.efficiency;
        (2.0 * k / (loss * node.inertia)).sqrt().max(2.0 * d / (loss * node.inertia))
    });
    rates.fold(0.0, f64::max)
}

fn tick(
    pass: &mut Pass<Change>,
    machine: &mut Machine,
    y: &mut Vec<f64>,
    start: f64,
    dt: f64,
) -> Result<(), NotProven> {
    let mut corners = vec![start, start + dt];
    let within = |t: &f64| *t > start && *t < start + dt;
    for node in &machine.chain.nodes {
        let mut from = start;
        while let Some(corner) = node.program.as_ref().and_then(|p| p.corner_after(from)).filter(within) {
            corners.push(corner);
            from = corner;
        }
    }
    corners.extend(machine.chain.law.corner_after(start).filter(within));
    corners.sort_by(f64::total_cmp);
    corners.windows(2).try_for_each(|pair| {
        pass.anew();
        pass.between(machine, y, pair[0], pair[1])
    })
}
