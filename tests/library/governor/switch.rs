//! Bumpless transfer: changes of constants, state and setpoint.

use driveline::design::{Actuator, LoadFeedForward, Rate};
use driveline::governor::{
    Droop, DroopConfig, FeedForward, FeedForwardConfig, Gains, Governor, SpeedGovernor, SpeedGovernorConfig,
    SymmetricLimitConfig,
};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use driveline::number::StateOf;
use driveline::sample::Estimate;
use driveline::settings::{Bases, SpeedLoopSettings};
use proptest::prelude::*;

const MACHINE: TwoMass = TwoMass::new(Inertia(4.4), Inertia(8.0), Stiffness(5.0e4), Damping(66.0));

type Switched = StateOf<SpeedGovernor<Droop, FeedForward>, f64>;

fn config(span: f64, droop: f64, share: f64) -> <Switched as Governor<f64>>::Config {
    let actuator = Actuator { delay: 0.02, lag: 0.02 };
    let design = MACHINE.governor(Rate::hz(2000), actuator, span, LoadFeedForward::NONE);
    SpeedGovernorConfig {
        gains: Gains::<f64>::new(&design, SpeedLoopSettings { torque_limit: 3000.0, ramp: 40.0 }, Bases::SI),
        shape: DroopConfig::<f64>::new(droop, 157.0, 2500.0, design.integral * design.period, Bases::SI),
        compensation: FeedForwardConfig::<f64>::new(share, Bases::SI),
        limit: SymmetricLimitConfig::<f64>::new(3000.0, Bases::SI),
        sequence: (),
        filter: (),
    }
}

proptest! {
    /// Whatever the state and whichever of gains, droop and feed-forward change, the next torque is what it would have
    /// been, but for what one tick's ramp and integral make of it.
    #[test]
    fn the_constants_change_without_a_jolt(
        (span, droop, share) in (2.0..5.0_f64, 0.0..0.08_f64, 0.0..1.0_f64),
        (to_span, to_droop, to_share) in (2.0..5.0_f64, 0.0..0.08_f64, 0.0..1.0_f64),
        load in 0.0..2000.0_f64,
        error in -2.0..2.0_f64,
        ticks in 1..2000_usize,
    ) {
        let (from, to) = (config(span, droop, share), config(to_span, to_droop, to_share));
        let mut governor = Switched::default();
        let now = Estimate { motor_speed: 150.0, load_torque: load, ..Estimate::default() };
        governor.start(&from, &now, load);
        let now = Estimate { motor_speed: 150.0 + error, ..now };
        let mut last = 0.0;
        for _ in 0..ticks {
            governor.set_setpoint(150.0);
            last = governor.command(&from, &now);
        }
        let mut other = governor;
        governor.set_setpoint(150.0);
        let stayed = governor.command(&from, &now);
        other.switch(&from, &to, &now);
        other.set_setpoint(150.0);
        let switched = other.command(&to, &now);
        // A tick's ramp is 0.02 rad/s, of which the integral's tick and the droop's make less than another: 2 * 0.04
        // rad/s by the largest k_p, 150, and at the limit the torque must not move at all.
        prop_assert!((switched - stayed).abs() < 2.0 * 0.04 * 150.0, "{last} {stayed} {switched}");
    }
}
