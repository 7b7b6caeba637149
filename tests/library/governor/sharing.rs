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

/// Equal droops, unequal sets: each carries the same share of its rated torque, and the speed is down by the droop of
/// that share.
#[test]
fn equal_droops_give_equal_shares() {
    for share in [0.25, 0.6, 1.0] {
        let rated = [1000.0, 2500.0];
        let (speed, torques) = settled(rated, [0.04, 0.04], share * 3500.0);
        // Settled to what a minute leaves of an exponential of seconds.
        assert!((speed / SPEED - (1.0 - 0.04 * share)).abs() < 1e-6, "{speed}");
        for (torque, rated) in torques.iter().zip(rated) {
            assert!((torque / rated - share).abs() < 1e-4, "{torque} of {rated}");
        }
    }
}

/// Unequal droops: shares as their inverses.
#[test]
fn unequal_droops_share_as_their_inverses() {
    let (_, [a, b]) = settled([1000.0, 1000.0], [0.02, 0.04], 900.0);
    assert!((a / b - 2.0).abs() < 1e-3, "{a} {b}");
}

/// One isochronous set beside one with droop keeps the speed and takes what the other leaves.
#[test]
fn an_isochronous_set_takes_the_rest() {
    let (speed, [a, b]) = settled([1000.0, 1000.0], [0.0, 0.04], 700.0);
    assert!((speed / SPEED - 1.0).abs() < 1e-6 && (a - 700.0).abs() < 0.5 && b.abs() < 0.5, "{speed} {a} {b}");
}
