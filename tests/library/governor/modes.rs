//! Modes and trips: every transition, every reason, and that a trip commands no torque.

use driveline::design::{Actuator, LoadFeedForward, Rate};
use driveline::governor::{
    Gains, Governor, HasRunSequence, RunRequest, RunState, Sequencer, SequencerConfig, SpeedGovernor,
    SpeedGovernorConfig, SymmetricLimit, SymmetricLimitConfig, Trip,
};
use driveline::number::StateOf;
use driveline::sample::Estimate;
use driveline::settings::{Bases, SequencerSettings, SpeedLoopSettings};
use proptest::prelude::*;

use super::SET;

const PERIOD: f64 = 1e-2;
const LIMITS: SequencerSettings = SequencerSettings {
    overspeed: 110.0,
    underspeed: 80.0,
    reverse: 2.0,
    shaft_torque: 500.0,
    standstill: 1.0,
    trip_delay: 0.02,
    underspeed_delay: 0.5,
    start: 10.0,
};

type Supervised = StateOf<SpeedGovernor<(), (), SymmetricLimit, Sequencer>, f64>;

fn config() -> <Supervised as Governor<f64>>::Config {
    let actuator = Actuator { delay: 0.02, lag: 0.02 };
    let design = SET.governor(Rate::every(PERIOD), actuator, 3.0, LoadFeedForward::NONE);
    SpeedGovernorConfig {
        gains: Gains::<f64>::new(&design, SpeedLoopSettings { torque_limit: 400.0, ramp: 20.0 }, Bases::SI),
        shape: (),
        compensation: (),
        limit: SymmetricLimitConfig::<f64>::new(400.0, Bases::SI),
        sequence: SequencerConfig::<f64>::new(&LIMITS, PERIOD, Bases::SI),
        filter: (),
    }
}

fn at(motor_speed: f64, shaft_torque: f64) -> Estimate<f64> {
    Estimate { motor_speed, shaft_torque, load_speed: motor_speed, ..Estimate::default() }
}

fn mode(governor: &Supervised) -> RunState {
    governor.sequencer().state()
}

/// Ticks at a speed and shaft torque; the last command.
fn run(governor: &mut Supervised, speed: f64, shaft: f64, ticks: usize) -> f64 {
    let config = config();
    let mut torque = 0.0;
    for _ in 0..ticks {
        governor.set_setpoint(100.0);
        torque = governor.command(&config, &at(speed, shaft));
    }
    torque
}

fn running() -> Supervised {
    let mut governor = Supervised::default();
    assert!(governor.sequencer_mut().request(RunRequest::Start));
    run(&mut governor, 100.0, 0.0, 3);
    assert_eq!(mode(&governor), RunState::Running);
    governor
}

#[test]
fn a_life_without_trips() {
    let mut governor = Supervised::default();
    assert_eq!((mode(&governor), run(&mut governor, 0.0, 0.0, 10)), (RunState::Stopped, 0.0));
    assert!(governor.sequencer_mut().request(RunRequest::Start));
    assert!(run(&mut governor, 0.0, 0.0, 10) > 0.0);
    assert_eq!(mode(&governor), RunState::Starting);
    assert!(run(&mut governor, 79.0, 0.0, 10) != 0.0);
    assert_eq!(mode(&governor), RunState::Starting);
    run(&mut governor, 81.0, 0.0, 1);
    assert_eq!(mode(&governor), RunState::Running);
    assert!(governor.sequencer_mut().request(RunRequest::Stop));
    assert!(run(&mut governor, 81.0, 0.0, 300) < 0.0);
    assert_eq!(mode(&governor), RunState::Braking);
    assert!(governor.sequencer_mut().request(RunRequest::Start));
    assert_eq!(mode(&governor), RunState::Starting);
    assert!(governor.sequencer_mut().request(RunRequest::Stop));
    // Below the standstill limit it has stopped; underspeed does not count on the way.
    run(&mut governor, 10.0, 0.0, 1000);
    assert_eq!((run(&mut governor, 0.5, 0.0, 1), mode(&governor)), (0.0, RunState::Stopped));
}

/// Every reason, at the tick at which it is due: 2 ticks of 10 ms do not trip, the third does; of underspeed 50.
#[test]
fn every_trip_comes_when_it_is_due_and_stays() {
    for (speed, shaft, ticks, trip) in [
        (110.5, 0.0, 2, Trip::Overspeed),
        (-2.5, 0.0, 2, Trip::Reverse),
        (100.0, 501.0, 2, Trip::ShaftOverload),
        (100.0, -501.0, 2, Trip::ShaftOverload),
        (79.0, 0.0, 50, Trip::Underspeed),
        (f64::NAN, 0.0, 2, Trip::Reverse),
        (100.0, f64::NAN, 2, Trip::ShaftOverload),
    ] {
        let mut governor = running();
        run(&mut governor, speed, shaft, ticks);
        assert_eq!(mode(&governor), RunState::Running, "{trip}");
        assert_eq!((run(&mut governor, speed, shaft, 1), mode(&governor)), (0.0, RunState::Tripped(trip)));
        // Whatever comes then, the reason stands and no torque is commanded.
        for speed in [0.0, 100.0, 150.0, -50.0, 1.0] {
            assert_eq!((run(&mut governor, speed, 600.0, 5), mode(&governor)), (0.0, RunState::Tripped(trip)));
        }
        for refused in [RunRequest::Start, RunRequest::Stop, RunRequest::Trip] {
            assert!(!governor.sequencer_mut().request(refused));
        }
        assert_eq!(governor.permitted(&config(), &at(0.0, 0.0), 300.0), 0.0);
        governor.angle_lost(&config(), &at(0.0, 0.0));
        assert_eq!((run(&mut governor, 0.0, 0.0, 5), mode(&governor)), (0.0, RunState::Tripped(trip)));
        assert!(governor.sequencer_mut().request(RunRequest::Reset));
        assert_eq!((run(&mut governor, 0.0, 0.0, 5), mode(&governor)), (0.0, RunState::Stopped));
    }
}

#[test]
fn what_passes_does_not_trip() {
    let mut governor = running();
    for _ in 0..100 {
        // As many ticks outside as are allowed, as many within: what is counted up is counted down.
        run(&mut governor, 112.0, 0.0, 2);
        run(&mut governor, 100.0, 0.0, 2);
    }
    assert_eq!(mode(&governor), RunState::Running);
    // More outside than within adds up.
    for _ in 0..10 {
        run(&mut governor, 112.0, 0.0, 2);
        run(&mut governor, 100.0, 0.0, 1);
    }
    assert_eq!(mode(&governor), RunState::Tripped(Trip::Overspeed));
}

#[test]
fn a_start_that_takes_too_long_trips() {
    let mut governor = Supervised::default();
    governor.sequencer_mut().request(RunRequest::Start);
    run(&mut governor, 50.0, 0.0, 1000);
    assert_eq!(mode(&governor), RunState::Starting);
    assert_eq!((run(&mut governor, 50.0, 0.0, 1), mode(&governor)), (0.0, RunState::Tripped(Trip::NotStarted)));
    // Overspeed and reverse trip a start as well.
    for (speed, trip) in [(111.0, Trip::Overspeed), (-3.0, Trip::Reverse)] {
        let mut governor = Supervised::default();
        governor.sequencer_mut().request(RunRequest::Start);
        run(&mut governor, speed, 0.0, 3);
        assert_eq!(mode(&governor), RunState::Tripped(trip));
    }
}

#[test]
fn a_lost_angle_trips_what_turns() {
    let mut governor = running();
    governor.angle_lost(&config(), &at(100.0, 0.0));
    assert_eq!(mode(&governor), RunState::Tripped(Trip::SensorLoss));
    let mut governor = Supervised::default();
    governor.angle_lost(&config(), &at(0.0, 0.0));
    assert_eq!(mode(&governor), RunState::Stopped);
    assert!(running().sequencer_mut().request(RunRequest::Trip));
}

proptest! {
    /// Whatever is asked and estimated, in whatever order: a tick that ends stopped or tripped commands no torque, one
    /// that does not keeps within the limit, and a trip is left only by a reset.
    #[test]
    fn no_torque_without_leave(
        steps in prop::collection::vec((0..6_u8, -150.0..150.0_f64, -700.0..700.0_f64), 1..300)
    ) {
        let config = config();
        let mut governor = Supervised::default();
        for (ask, speed, shaft) in steps {
            let before = mode(&governor);
            let all = [RunRequest::Start, RunRequest::Stop, RunRequest::Reset, RunRequest::Trip];
            let request = all.get(usize::from(ask));
            if let Some(request) = request {
                governor.sequencer_mut().request(*request);
            }
            if matches!(before, RunState::Tripped(_)) && request != Some(&RunRequest::Reset) {
                prop_assert_eq!(mode(&governor), before);
            }
            governor.set_setpoint(100.0);
            let torque = governor.command(&config, &at(speed, shaft));
            if matches!(mode(&governor), RunState::Stopped | RunState::Tripped(_)) {
                prop_assert_eq!(torque, 0.0);
            }
            prop_assert!(torque.abs() <= 400.0);
        }
    }
}
