//! Machines that work: no stop without a fault while their shafts are not overloaded, within the tolerances and in every second one with what no tolerance
//! names. `TICKS=2000000` in the environment runs so many ticks of each.

use driveline::configure::Configure;
use driveline::drive::{ConfigOf, TickCount};
use driveline::fault::Faults;
use driveline::sample::Sample;

use crate::machines::{Crane, Hoist, Mill, Set, Spindle, Tested, Winder};
use crate::run::{Drawn, Draws, Watched, held, seen};

/// What no tolerance names.
#[derive(Clone, Copy, Debug)]
struct Outside {
    /// Damping of the shafts over the described one.
    damping: f64,
    /// Constant drag and cogging of the motor over rated torque; cogging of 24 periods a turn.
    drag: f64,
    cogging: f64,
    /// Amplitude of the encoder's error, once a turn (counts).
    eccentricity: f64,
    /// Share of the ticks that do not run.
    missed: f64,
}

impl Outside {
    const NONE: Self = Outside { damping: 1.0, drag: 0.0, cogging: 0.0, eccentricity: 0.0, missed: 0.0 };

    fn of(draws: &mut Draws) -> Self {
        Outside {
            damping: 10.0_f64.powf(-draws.unit()),
            drag: 0.05 * draws.unit(),
            cogging: 0.02 * draws.unit(),
            eccentricity: 2.0 * draws.unit(),
            missed: 0.002 * draws.unit(),
        }
    }
}

/// Ticks of a drawn machine at random setpoints, its load changing by steps that belong to its work; the first cause, and the
/// largest torque of the weak shaft until then over the torque limit.
fn work<M: Tested>(config: &ConfigOf<Watched>, drawn: &Drawn, outside: &Outside, ticks: u32) -> (Faults, u32, f64) {
    let duty = M::DUTY;
    let lifted = duty.held > 0.0;
    let weight = duty.held * drawn.inertia[1];
    let (mut plant, mut draws) = (held::<M>(drawn, weight), drawn.draws);
    plant.shafts.iter_mut().for_each(|[_, damping]| *damping *= outside.damping);
    let (mut count, mut torque) = (TickCount::default(), 0.0);
    let mut largest = 0.0_f64;
    let period = 1.0 / f64::from(M::RATE_HZ);
    let resolution = M::ENCODER.resolution().unwrap();
    let rated = M::RATING.torque.0;
    let start = plant.angle[0];
    let mut drive = Watched::new(config, 0);
    let (mut setpoint, mut load, mut reported) = (0.0, weight, 0.0);
    let (mut until, mut changes) = (0, 0);
    for tick in 0..ticks {
        let hold = f64::from(tick) * period < 0.2;
        plant.brake = if hold { 4.0 * rated } else { outside.drag * rated };
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
        if hold || draws.unit() >= outside.missed {
            let turned = plant.angle[0] - start + outside.eccentricity * resolution * plant.angle[0].sin();
            let angle = seen::<M>(turned);
            let missed = count.missed(tick as u16);
            let command = if hold {
                drive.hold(config, angle, weight as f32)
            } else {
                drive.tick_after(config, &Sample { angle, torque: reported as f32, setpoint: setpoint as f32 }, missed)
            };
            let causes = command.faults & Faults::SUPERVISION;
            if !causes.is_none() {
                return (causes, tick, largest / M::RATING.torque_limit.0);
            }
            torque = f64::from(command.torque);
        }
        reported = torque + drawn.noise * rated * draws.normal();
        let cogging = outside.cogging * rated * (24.0 * plant.angle[0]).sin();
        plant.advance(torque * drawn.constant + drawn.offset * rated + cogging, period);
        largest = largest.max(plant.torque(plant.weak).abs());
    }
    (Faults::NONE, ticks, largest / M::RATING.torque_limit.0)
}

fn survey<M: Tested>(ticks: u32) -> u32
where
    Watched: Configure<M, f32, Config = ConfigOf<Watched>>,
{
    let config = Watched::configure::<M>();
    let mut random = Draws(11);
    let (mut total, mut trips, mut overloads) = (0, 0, 0);
    let each = 10 * M::RATE_HZ;
    let mut outside = Outside::NONE;
    while total < ticks {
        let drawn = Drawn::of::<M>(&mut random);
        let (cause, ran, largest) = work::<M>(&config, &drawn, &outside, each);
        total += ran;
        if !cause.is_none() {
            // cogging in the resonance of a shaft with little damping overloads it: that stop is right
            *if largest > 1.0 { &mut overloads } else { &mut trips } += 1;
            let time = f64::from(ran) / f64::from(M::RATE_HZ);
            println!("{}: {cause} at {time:.3} s, {largest:.2}, {drawn:?} {outside:?}", M::DUTY.name);
        }
        outside = if outside.damping == 1.0 { Outside::of(&mut random) } else { Outside::NONE };
    }
    println!("{}: {trips} stops and {overloads} of an overloaded shaft in {total} ticks", M::DUTY.name);
    trips
}

#[test]
fn no_machine_without_a_fault_is_stopped() {
    let ticks = std::env::var("TICKS").map_or(200_000, |ticks| ticks.parse().unwrap());
    let trips = survey::<Hoist>(ticks)
        + survey::<Crane>(ticks)
        + survey::<Mill>(ticks)
        + survey::<Spindle>(ticks)
        + survey::<Set>(ticks)
        + survey::<Winder>(ticks);
    assert_eq!(trips, 0);
}
