//! Machines that work: no stop without a fault. `TICKS=2000000` in the environment runs so many ticks of each.

use driveline::configure::Configure;
use driveline::drive::ConfigOf;
use driveline::fault::Faults;
use driveline::sample::Sample;

use crate::machines::{Crane, Hoist, Mill, Set, Spindle, Tested, Winder};
use crate::run::{Drawn, Draws, Watched};

/// Ticks of a drawn machine at random setpoints, its load changing by steps that belong to its work; the first cause.
fn work<M: Tested>(config: &ConfigOf<Watched>, drawn: &Drawn, ticks: u32) -> (Faults, u32) {
    let duty = M::DUTY;
    let (mut plant, mut draws) = (M::plant(), drawn.draws);
    drawn.apply(&mut plant);
    let period = 1.0 / f64::from(M::RATE_HZ);
    let resolution = M::ENCODER.resolution().unwrap();
    let rated = M::RATING.torque.0;
    let lifted = duty.held > 0.0;
    let weight = duty.held * drawn.inertia[1];
    plant.rope = duty.rope;
    plant.load = weight;
    plant.rest(weight);
    let start = plant.angle[0];
    let mut drive = Watched::new(config, 0);
    let (mut setpoint, mut load, mut reported) = (0.0, weight, 0.0);
    let (mut until, mut changes) = (0, 0);
    for tick in 0..ticks {
        let hold = f64::from(tick) * period < 0.2;
        plant.brake = if hold { 4.0 * rated } else { 0.0 };
        if tick >= until && !hold {
            setpoint = duty.speed * (2.0 * draws.unit() - 1.0) * if draws.unit() < 0.2 { 0.0 } else { 1.0 };
            until = tick + ((0.5 + 4.0 * draws.unit()) / period) as u32;
        }
        if tick >= changes && !hold {
            let most = M::LOAD_STEP.torque;
            load = if lifted { weight + 0.5 * most * (draws.unit() - 0.5) } else { most * draws.unit() };
            changes = tick + ((0.3 + 2.0 * draws.unit()) / period) as u32;
        }
        // the work's load opposes the motion; a weight does not
        let goal = if lifted { load } else { load * (plant.speed[0] / (0.05 * duty.speed)).clamp(-1.0, 1.0) };
        let step = M::LOAD_STEP.torque * (period / M::LOAD_STEP.rise.max(period));
        plant.load += (goal - plant.load).clamp(-step, step);
        let count = ((plant.angle[0] - start) / resolution).floor();
        let angle = (count * resolution / core::f64::consts::TAU * 4_294_967_296.0).round() as i64 as u32;
        let command = if hold {
            drive.hold(config, angle, weight as f32)
        } else {
            drive.tick(config, &Sample { angle, torque: reported as f32, setpoint: setpoint as f32 })
        };
        let causes = command.faults & Faults::SUPERVISION;
        if !causes.is_none() {
            return (causes, tick);
        }
        let torque = f64::from(command.torque);
        reported = torque + drawn.noise * rated * draws.normal();
        plant.advance(torque * drawn.constant + drawn.offset * rated, period);
    }
    (Faults::NONE, ticks)
}

fn survey<M: Tested>(ticks: u32) -> u32
where
    Watched: Configure<M, f32, Config = ConfigOf<Watched>>,
{
    let config = Watched::configure::<M>();
    let mut random = Draws(11);
    let (mut total, mut trips) = (0, 0);
    let each = 20 * M::RATE_HZ;
    while total < ticks {
        let drawn = Drawn::of::<M>(&mut random);
        let (cause, ran) = work::<M>(&config, &drawn, each);
        total += ran;
        if !cause.is_none() {
            trips += 1;
            println!("{}: {cause} at {:.3} s of {drawn:?}", M::DUTY.name, f64::from(ran) / f64::from(M::RATE_HZ));
        }
    }
    println!("{}: {trips} stops in {total} ticks", M::DUTY.name);
    trips
}

#[test]
fn no_machine_within_its_tolerances_is_stopped() {
    let ticks = std::env::var("TICKS").map_or(100_000, |ticks| ticks.parse().unwrap());
    let trips = survey::<Hoist>(ticks)
        + survey::<Crane>(ticks)
        + survey::<Mill>(ticks)
        + survey::<Spindle>(ticks)
        + survey::<Set>(ticks)
        + survey::<Winder>(ticks);
    assert_eq!(trips, 0);
}
