//! Sets that turn together share the load by their droop.

use driveline::design::{Actuator, GovernorDesign, LoadFeedForward, Rate};
use driveline::governor::{Droop, DroopConfig, Gains, Governor, SpeedGovernor, TorqueRange, TorqueRangeConfig};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use driveline::number::StateOf;
use driveline::sample::Estimate;
use driveline::settings::{Bases, SpeedLoopSettings};
use driveline_solver::plant::{Chain, Shaft, Start};

use super::plain;

const PERIOD: f64 = 1e-3;
const SPEED: f64 = 157.0;

/// Two sets, synchronised: an electrical shaft of 2 Hz with a damper's winding between them, and the bus's load on the
/// second. Their actuators lag by 50 ms. Returns speed and torques after a minute.
fn settled(rated: [f64; 2], droop: [f64; 2], load: f64) -> (f64, [f64; 2]) {
    let inertia = rated.map(|torque| torque / 200.0);
    let design: [GovernorDesign; 2] = inertia.map(|inertia| {
        let machine = TwoMass::new(Inertia(0.4 * inertia), Inertia(0.6 * inertia), Stiffness(1e5), Damping(50.0));
        machine.governor(Rate::every(PERIOD), Actuator { delay: 0.0, lag: 0.05 }, 3.0, LoadFeedForward::NONE)
    });
    let config = [0, 1].map(|k: usize| {
        let settings = SpeedLoopSettings { torque_limit: 1.1 * rated[k], ramp: 40.0 };
        plain(
            Gains::<f64>::new(&design[k], settings, Bases::SI),
            DroopConfig::<f64>::new(droop[k], SPEED, rated[k], design[k].integral * PERIOD, Bases::SI),
            (),
            TorqueRangeConfig::<f64>::new(0.0, 1.1 * rated[k], Bases::SI),
        )
    });
    let reduced = inertia[0] * inertia[1] / (inertia[0] + inertia[1]);
    let stiffness = reduced * (2.0 * core::f64::consts::TAU).powi(2);
    let shaft = Shaft::elastic(stiffness).damping(0.3 * (stiffness * reduced).sqrt());
    let start = Start::Given { twists: vec![0.0], speeds: vec![SPEED; 2] };
    let mut plant = Chain::motor(inertia[0]).shaft(shaft, inertia[1]).start(start).build().unwrap();
    let mut governors = [<StateOf<SpeedGovernor<Droop, (), TorqueRange>, f64>>::default(); 2];
    let mut acting = [0.0; 2];
    for (governor, config) in governors.iter_mut().zip(&config) {
        governor.start(config, &Estimate { motor_speed: SPEED, ..Estimate::default() }, 0.0);
    }
    for _ in 0..60_000 {
        for k in 0..2 {
            governors[k].set_setpoint(SPEED);
            let now = Estimate { motor_speed: plant.speed(k), ..Estimate::default() };
            let command = governors[k].command(&config[k], &now);
            acting[k] += (command - acting[k]) * (1.0 - (-PERIOD / 0.05_f64).exp());
        }
        plant.set_load_torque(1, load - acting[1]);
        plant.advance(acting[0], PERIOD);
    }
    (plant.speed(0), acting)
}

/// Sets share the load as their rated torques over their droops, and the speed is down by the droop of that share:
/// unequal sets of equal droops, equal sets of unequal ones, and an isochronous set, which takes what the other leaves.
#[test]
fn droops_share_the_load() {
    for (rated, droop, load, down, shares) in [
        ([1000.0, 2500.0], [0.04, 0.04], 875.0, 0.01, [0.25; 2]),
        ([1000.0, 2500.0], [0.04, 0.04], 2100.0, 0.024, [0.6; 2]),
        ([1000.0, 2500.0], [0.04, 0.04], 3500.0, 0.04, [1.0; 2]),
        ([1000.0, 1000.0], [0.02, 0.04], 900.0, 0.012, [0.6, 0.3]),
        ([1000.0, 1000.0], [0.0, 0.04], 700.0, 0.0, [0.7, 0.0]),
    ] {
        let (speed, torques) = settled(rated, droop, load);
        // Settled to what a minute leaves of an exponential of seconds.
        assert!((speed / SPEED - (1.0 - down)).abs() < 1e-6, "{speed}");
        for ((torque, rated), share) in torques.iter().zip(rated).zip(shares) {
            assert!((torque / rated - share).abs() < 1e-4, "{torque} of {rated}");
        }
    }
}
