//! Single ticks of the governors.

#[path = "../library/governor/plain.rs"]
mod plain;

use driveline::fault::Faults;
use driveline::governor::{
    AccelerationFeedback, AccelerationFeedbackConfig, ActiveDamping, ActiveDampingConfig, BacklashTakeUp,
    BacklashTakeUpConfig, Barred, BarredConfig, Compensation, Curve, CurveConfig, CurvePiece, CycleAverage, Droop,
    DroopConfig, FeedForward, FeedForwardConfig, Gains, Governor, HasRunSequence, InputShaper, InputShaperConfig,
    Limit, LoadSharing, LoadSharingConfig, MovingAverage, MovingAverageConfig, RunRequest, RunState, Sequencer,
    SequencerConfig, SetpointShape, Slew, SlewConfig, SpeedFilter, SpeedGovernor, SpeedGovernorConfig, SpeedLoop,
    SpeedLoopConfig, SpeedRange, SymmetricLimit, SymmetricLimitConfig, TransportDelay, TransportDelayConfig, Trip,
};
use driveline::number::{Coefficient, Fixed, StateOf, Weight};
use driveline::sample::Estimate;

pub use self::plain::plain;

const GAINS: Gains<f64> = Gains { proportional: 1.0, reset: 0.0, ramp: 10.0 };

fn at(speed: f64) -> Estimate<f64> {
    Estimate { motor_speed: speed, shaft_torque: 0.0, load_speed: speed, load_torque: 0.0 }
}

/// An integral within the limit leaves the next command as soon as an error asks for less.
#[test]
fn a_start_beyond_the_torque_limit_starts_at_the_limit() {
    let config = SpeedLoopConfig::<f64> {
        proportional: 1.0,
        damping: 0.0,
        reset: 0.0,
        torque_limit: 50.0,
        ramp: 0.0,
        filter: (),
    };
    for sign in [1.0, -1.0] {
        let mut governor = SpeedLoop::<(), f64>::default();
        let permitted = governor.permitted(&config, &at(0.0), sign * 1000.0);
        governor.start(&config, &at(0.0), permitted);
        assert_eq!(governor.command(&config, &at(sign * 10.0)), sign * 40.0);
    }
}

/// The law on paper: integral, proportional part and damping, with a machine that turns and whose shaft winds up.
#[test]
fn the_speed_loop_is_the_law_on_paper() {
    let config = SpeedLoopConfig::<f64> {
        proportional: 2.5,
        damping: -3.0,
        reset: 0.2,
        torque_limit: 1000.0,
        ramp: 4.0,
        filter: (),
    };
    let mut governor = SpeedLoop::<(), f64>::default();
    let turning = Estimate { load_speed: 9.0, ..at(11.0) };
    governor.start(&config, &at(10.0), 6.0);
    governor.set_setpoint(12.0);
    // a gain of 2 and an integral of 1/2 a tick; error 1, twist rate 2: 6 + 1/2 + 2 (1) - 3 (2)
    assert_eq!(governor.command(&config, &turning), 2.5);
    assert_eq!(governor.command(&config, &turning), 3.0);
    governor.set_setpoint(-30.0);
    // the ramp has come down to 8: error -3
    assert_eq!(governor.command(&config, &turning), 7.0 - 1.5 - 6.0 - 6.0);
}

/// The load's part and the droop are there from the first tick, and the torque is still the one that there was.
#[test]
fn a_start_with_droop_and_feed_forward_is_bumpless() {
    type Drooped = StateOf<SpeedGovernor<Droop, FeedForward>, f64>;
    let limit = SymmetricLimitConfig { torque: 100.0 };
    let config =
        plain(Gains { ramp: 0.0, ..GAINS }, DroopConfig { droop: 0.25 }, FeedForwardConfig { share: 0.5 }, limit);
    let loaded = Estimate { load_torque: 8.0, ..at(50.0) };
    let mut governor = Drooped::default();
    governor.start(&config, &loaded, 20.0);
    // half the load's 8 N m is fed forward; a quarter of 20 N m is the droop
    assert_eq!((governor.integral(), governor.ramped_setpoint()), (16.0, 55.0));
    assert_eq!(governor.command(&config, &loaded), 20.0);
    // 2 rad/s too slow are 2 N m, whatever the torque
    assert_eq!(governor.command(&config, &Estimate { load_torque: 8.0, ..at(48.0) }), 22.0);
}

type Slewed = StateOf<SpeedGovernor<(), (), Slew<SymmetricLimit>>, f64>;

#[test]
fn the_slew_starts_from_the_torque_that_there_is() {
    let limit = SlewConfig { step: 2.0, limit: SymmetricLimitConfig { torque: 100.0 } };
    let config = plain(GAINS, (), (), limit);
    let mut governor = Slewed::default();
    governor.start(&config, &at(0.0), 30.0);
    // with the machine 20 rad/s too fast the loop wants 10 N m; the slew allows 28, 26 ...
    assert_eq!(governor.command(&config, &at(20.0)), 28.0);
    assert_eq!(governor.command(&config, &at(20.0)), 26.0);
    governor.start(&config, &at(0.0), -30.0);
    assert_eq!(governor.command(&config, &at(-20.0)), -28.0);
}

/// On the driven flank the reach rises by 2 to 9; in the gap and on the other flank it falls by 1 to 3.
#[test]
fn the_reach_of_a_take_up_rises_on_the_driven_flank_alone() {
    let config = BacklashTakeUpConfig {
        torque: 3.0,
        braking: -0.25,
        step: 2.0,
        fall: -1.0,
        max_torque: 9.0,
        damping: -0.5,
        tracking: 0.125,
        limit: SymmetricLimitConfig { torque: 100.0 },
    };
    for side in [1.0, -1.0] {
        let mut limit = BacklashTakeUp::<SymmetricLimit, f64>::default();
        limit.start(side * 4.0);
        let mut allowed = |shaft_torque: f64, wanted: f64| {
            // a twist rate of 4
            let estimate = Estimate { shaft_torque: side * shaft_torque, load_speed: 46.0, ..at(50.0) };
            side * (limit.limit(&config, &estimate, side * wanted)
                - 4.0 * if shaft_torque == 0.0 { -0.25 } else { -0.5 })
        };
        let driven = [50.0; 3].map(|wanted| allowed(10.0, wanted));
        assert_eq!(driven, [6.0, 8.0, 9.0]);
        assert_eq!([allowed(0.0, 50.0), allowed(-10.0, 50.0)], [8.0, 7.0]);
        assert_eq!([50.0; 6].map(|wanted| allowed(0.0, wanted)), [6.0, 5.0, 4.0, 3.0, 3.0, 3.0]);
        assert_eq!([allowed(0.0, 1.0), allowed(0.0, -50.0)], [1.0, -3.0]);
        // 47 of 50 N m are withheld
        assert_eq!(limit.track(&config, 20.0, side * 50.0), 20.0 - side * 47.0 / 8.0);
    }
}

#[test]
fn a_barred_range_is_passed_quickly_and_no_setpoint_stands_in_it() {
    let config = BarredConfig { ranges: [SpeedRange { middle: 50.0, half: 10.0 }], quick: 5.0 };
    let goal = |setpoint, ramped| Barred::<1>.goal(&config, setpoint, ramped, 1.0);
    assert_eq!([goal(100.0, 30.0), goal(100.0, 45.0), goal(100.0, 70.0)], [(100.0, 1.0), (100.0, 5.0), (100.0, 1.0)]);
    assert_eq!([goal(55.0, 30.0), goal(45.0, 70.0)], [(40.0, 1.0), (60.0, 1.0)]);
}

type Sequenced = StateOf<SpeedGovernor<(), (), SymmetricLimit, Sequencer>, f64>;

const SEQUENCE: SequencerConfig<f64> = SequencerConfig {
    running: SpeedRange { middle: 100.0, half: 20.0 },
    allowed: SpeedRange { middle: 50.0, half: 100.0 },
    shaft_torque: 1000.0,
    standstill: 1.0,
    trip_delay: 2,
    underspeed_delay: 100,
    start: 1000,
};

const SEQUENCED: <Sequenced as Governor<f64>>::Config = SpeedGovernorConfig {
    gains: GAINS,
    shape: (),
    compensation: (),
    limit: SymmetricLimitConfig { torque: 100.0 },
    sequence: SEQUENCE,
    filter: (),
};

#[test]
fn braking_goes_to_standstill_and_forgets_no_setpoint() {
    let mut governor = Sequenced::default();
    governor.start(&SEQUENCED, &at(100.0), 0.0);
    governor.set_setpoint(100.0);
    governor.command(&SEQUENCED, &at(100.0));
    assert_eq!(governor.sequencer().state(), RunState::Running);
    assert!(governor.sequencer_mut().request(RunRequest::Stop));
    for ramped in [90.0, 80.0] {
        governor.command(&SEQUENCED, &at(ramped));
        assert_eq!(governor.ramped_setpoint(), ramped);
    }
    assert_eq!(governor.sequencer().state(), RunState::Braking);
    // started again on the way, without a further setpoint
    assert!(governor.sequencer_mut().request(RunRequest::Start));
    for ramped in [90.0, 100.0, 100.0] {
        governor.command(&SEQUENCED, &at(ramped));
        assert_eq!(governor.ramped_setpoint(), ramped);
    }
}

#[test]
fn with_a_lost_angle_the_setpoint_is_zero_until_there_is_another() {
    let limit = SymmetricLimitConfig { torque: 100.0 };
    let config = plain(GAINS, (), (), limit);
    let mut governor = <StateOf<SpeedGovernor, f64>>::default();
    governor.start(&config, &at(50.0), 0.0);
    governor.set_setpoint(100.0);
    governor.command(&config, &at(50.0));
    assert_eq!(governor.ramped_setpoint(), 60.0);
    governor.angle_lost(&config, &at(55.0));
    governor.command(&config, &at(55.0));
    assert_eq!(governor.ramped_setpoint(), 45.0);
}

/// The sum is renewed once a period from its own terms: an error in it lasts no longer than that.
#[test]
fn a_moving_average_does_not_drift() {
    const TICKS: usize = 16;
    let config = MovingAverageConfig::<Fixed, TICKS> { share: Coefficient::from_f64(1.0 / 16.0).unwrap() };
    let fixed = |bits| Estimate {
        motor_speed: Fixed::from_bits(bits),
        shaft_torque: Fixed::from_bits(0),
        load_speed: Fixed::from_bits(bits),
        load_torque: Fixed::from_bits(-bits),
    };
    let mut average = MovingAverage::<TICKS, Fixed>::default();
    // each term is cut to 6; a start at 100 is 4 above their sum, until the sum is renewed
    average.start(&config, &fixed(100));
    let speeds: Vec<i32> = (0..2 * TICKS).map(|_| average.filter(&config, &fixed(100)).motor_speed.to_bits()).collect();
    assert!(speeds[..TICKS - 1].iter().all(|&speed| speed == 100), "{speeds:?}");
    assert!(speeds[TICKS - 1..].iter().all(|&speed| speed == 96), "{speeds:?}");
    let load = average.filter(&config, &fixed(100)).load_torque.to_bits();
    // -100/16 cut downwards is -7
    assert_eq!(load, -112);
}

/// Deviations of 11 degrees, twice what an operand holds: each is cut to 2^26 units, times 2^5 and the gain of 2^-4.
#[test]
fn a_large_deviation_of_a_motor_is_damped_towards_the_mean() {
    let config = LoadSharingConfig::<Fixed> {
        share: Coefficient::ZERO,
        preload: Fixed::from_bits(0),
        equal_above: Fixed::ONE,
        bias_below: Fixed::ONE,
        step: Fixed::ONE,
        torque_limit: Fixed::ONE,
        damping: Coefficient::from_f64(-0.0625).unwrap(),
        lag: 31,
        max_deviation: i32::MAX,
    };
    let mut sharing = LoadSharing::<Fixed, 2>::default();
    sharing.hold(&[0, 0]);
    assert_eq!(sharing.mean_angle(&config, &[0, 1 << 28]), 1 << 27);
    let torques = sharing.torques(&config, Fixed::from_bits(0), Fixed::from_bits(0)).map(Fixed::to_bits);
    // a unit less in the operand, and the product cut downwards
    for (torque, expected) in torques.into_iter().zip([1 << 27, -(1 << 27)]) {
        assert!((torque - expected).abs() <= 3, "{torque}");
    }
}

/// A step of 8 in the speed and of -4 in the load's torque goes over four ticks.
#[test]
fn a_moving_average_takes_a_step_in_its_ticks() {
    let config = MovingAverageConfig::<f64, 4> { share: 0.25 };
    let mut average = MovingAverage::<4, f64>::default();
    average.start(&config, &Estimate { load_torque: 2.0, ..at(1.0) });
    let seen = [(); 5].map(|()| {
        let estimate = average.filter(&config, &Estimate { load_torque: -2.0, ..at(9.0) });
        (estimate.motor_speed, estimate.load_torque)
    });
    assert_eq!(seen, [(3.0, 1.0), (5.0, 0.0), (7.0, -1.0), (9.0, -2.0), (9.0, -2.0)]);
}

/// A shaper hands on what its governor alone knows: the speed without its ripple, and a trip.
#[test]
fn a_shaper_hands_on_the_steady_speed_and_a_trip() {
    type Inner = StateOf<SpeedGovernor<(), (), SymmetricLimit, Sequencer, CycleAverage>, f64>;
    let governor = SpeedGovernorConfig { filter: (), ..SEQUENCED };
    let config = InputShaperConfig { ramp: 1.0, slot: 10, share: 0.5, governor };
    let mut shaper = InputShaper::<Inner, 2, 3, f64>::default();
    assert_eq!(shaper.permitted(&config, &at(100.0), -101.0), -100.0);
    shaper.start(&config, &at(100.0), 0.0);
    shaper.set_setpoint(100.0);
    shaper.set_steady_speed(Some(93.0));
    assert_eq!(shaper.command(&config, &at(100.0)), 7.0);
    // bumpless: the integral takes over what twice the gain gives more
    let mut doubled = config;
    doubled.governor.gains.proportional = 2.0;
    let mut switched = shaper;
    switched.switch(&config, &doubled, &at(100.0));
    assert_eq!(switched.command(&doubled, &at(100.0)), 7.0);
    shaper.set_steady_speed(None);
    assert_eq!(shaper.command(&config, &at(100.0)), 0.0);
    shaper.angle_lost(&config, &at(100.0));
    assert_eq!(shaper.permitted(&config, &at(100.0), 5.0), 0.0, "the angle is lost: a tripped governor holds nothing");
}

/// A governor that notes what it is told, and has a fault.
#[derive(Default)]
struct Listener([f64; 4]);

impl Governor<f64> for Listener {
    type Config = ();

    const COMMANDS: bool = true;

    fn set_setpoint(&mut self, _setpoint: f64) {}

    fn set_response(&mut self, (): &(), torque: f64, innovation: f64) {
        (self.0[0], self.0[1]) = (torque, innovation);
    }

    fn set_turn_in_hold(&mut self, (): &(), turned: f64) {
        self.0[2] = turned;
    }

    fn is_to_judge(&self) -> bool {
        self.0[3] == 0.0
    }

    fn judge(&mut self, (): &(), estimate: &Estimate<f64>) {
        self.0[3] = estimate.motor_speed;
    }

    fn faults(&self) -> Faults {
        Faults::OVERSPEED
    }

    fn command(&mut self, (): &(), _estimate: &Estimate<f64>) -> f64 {
        self.0[0]
    }

    fn permitted(&self, (): &(), _estimate: &Estimate<f64>, torque: f64) -> f64 {
        torque
    }

    fn start(&mut self, (): &(), _estimate: &Estimate<f64>, _torque: f64) {}
}

/// A supervision within a shaper hears of the response and of a slipping brake, and is heard.
#[test]
fn a_shaper_hands_on_what_a_supervision_hears_and_says() {
    let config = InputShaperConfig { ramp: 1.0, slot: 10, share: 0.5, governor: () };
    let mut shaper = InputShaper::<Listener, 2, 3, f64>::default();
    shaper.set_response(&config, 5.0, 6.0);
    shaper.set_turn_in_hold(&config, 7.0);
    assert!(shaper.is_to_judge());
    shaper.judge(&config, &at(8.0));
    assert!(!shaper.is_to_judge());
    assert_eq!((shaper.governor().0, shaper.faults()), ([5.0, 6.0, 7.0, 8.0], Faults::OVERSPEED));
}

#[test]
fn a_weight_between_inverses_is_that_of_their_values() {
    // 1/(3/4 2 + 1/4 6) is 1/3, half way between 1/2 and 1/6
    assert_eq!(Weight::share(0.25).of_inverses(&2.0_f32, &6.0), Weight::share(0.5));
    assert_eq!(Weight::share(0.25).of_inverses(&-2.0_f64, &-6.0), Weight::share(0.5));
}

#[test]
fn a_torque_is_delayed_by_its_ticks() {
    for (ticks, expected) in [(0, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), (3, [0.0, 0.0, 0.0, 1.0, 2.0, 3.0])] {
        let mut delay = TransportDelay::<f64, 4>::new();
        let config = TransportDelayConfig { ticks };
        assert_eq!([1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|torque| delay.delayed(&config, torque)), expected);
    }
}

/// Two compensations, one after the other: 2 of the twist rate of 4, and a quarter of what accelerates the load.
#[test]
fn compensations_add_up() {
    type Both = (ActiveDamping, (AccelerationFeedback, FeedForward));
    let config = (
        ActiveDampingConfig { damping: -2.0 },
        (AccelerationFeedbackConfig { feedback: 0.25 }, FeedForwardConfig { share: 0.5 }),
    );
    let estimate = Estimate { motor_speed: 50.0, load_speed: 46.0, shaft_torque: 20.0, load_torque: 8.0 };
    let both = Both::default();
    assert_eq!(both.transient(&config, &estimate, 100.0), 100.0 - 8.0 + 3.0);
    assert_eq!(both.steady(&config, &estimate, 100.0), 104.0);
}

/// 100 N m to 50 rad/s, and 1 N m less for each rad/s beyond it.
#[test]
fn a_curve_falls_from_its_corner() {
    let pieces =
        [CurvePiece { speed: 0.0, torque: 100.0, slope: 0.0 }, CurvePiece { speed: 50.0, torque: 100.0, slope: -1.0 }];
    let config = CurveConfig::<f64, 2> { pieces, min: -10.0 };
    for (speed, torque) in [(0.0, 100.0), (49.0, 100.0), (50.0, 100.0), (60.0, 90.0), (-60.0, 90.0)] {
        assert_eq!(Curve::<2>.limit(&config, &at(speed), 1000.0), torque, "{speed}");
    }
    assert_eq!([-11.0, -9.0].map(|wanted| Curve::<2>.limit(&config, &at(60.0), wanted)), [-10.0, -9.0]);
}

/// Each trip has a name of its own.
#[test]
fn a_trip_is_told_by_its_name() {
    assert_eq!((Trip::Reverse.to_string(), Trip::Actuator.to_string()), ("reverse".into(), "actuator".into()));
}

/// Started and stopped before its first tick, it brakes from the speed that it has.
#[test]
fn a_machine_stopped_before_its_first_tick_begins_at_its_speed() {
    let mut governor = Sequenced::default();
    assert!(governor.sequencer_mut().request(RunRequest::Start) && governor.sequencer_mut().request(RunRequest::Stop));
    governor.command(&SEQUENCED, &at(50.0));
    assert_eq!(governor.ramped_setpoint(), 40.0);
}

#[test]
fn shapes_follow_one_another() {
    type Both = (Barred<1>, (Droop, ()));
    let barred = BarredConfig { ranges: [SpeedRange { middle: 50.0, half: 10.0 }], quick: 5.0 };
    let config = (barred, (DroopConfig { droop: 0.25 }, ()));
    assert_eq!(Both::default().goal(&config, 55.0, 30.0, 1.0), (40.0, 1.0));
    assert_eq!(Both::default().lower(&config, 40.0, 8.0), 38.0);
}

/// Bytes of a governor's state by its parts: integral, ramp and setpoint, and of a part what its file counts. A part
/// without a state of its own adds none, whether alone or beside another.
#[test]
fn a_part_that_is_left_out_has_no_state() {
    type With<S = (), F = (), L = SymmetricLimit, M = (), V = ()> = SpeedGovernor<S, F, L, M, V>;
    const PLAIN: usize = 3 * 4;
    for (part, bytes, state) in [
        ("none", size_of::<With>(), 0),
        ("droop and barred speeds", size_of::<With<(Droop, Barred<2>)>>(), 0),
        ("feed-forward", size_of::<With<(), FeedForward>>(), 0),
        ("damping and acceleration", size_of::<With<(), (ActiveDamping, AccelerationFeedback)>>(), 0),
        ("curve", size_of::<With<(), (), Curve<4>>>(), 0),
        // the last torque
        ("slew", size_of::<With<(), (), Slew<SymmetricLimit>>>(), 4),
        // the reach
        ("take-up", size_of::<With<(), (), BacklashTakeUp<SymmetricLimit>>>(), 4),
        // state and cause, two counters
        ("sequencer", size_of::<With<(), (), SymmetricLimit, Sequencer>>(), 4 + 2 * 4),
        // a ring of speeds and torques, two sums of them, a place
        ("moving average", size_of::<With<(), (), SymmetricLimit, (), MovingAverage<8>>>(), (2 * 8 + 4 + 1) * 4),
        // a speed or none
        ("cycle average", size_of::<With<(), (), SymmetricLimit, (), CycleAverage<f32>>>(), 2 * 4),
    ] {
        assert_eq!(bytes, PLAIN + state, "{part}");
    }
    // gains, ramp and limit
    assert_eq!(size_of::<<SpeedGovernor as Governor<f32>>::Config>(), 3 * 4 + 4);
}
