//! Constants that change between two ticks: the estimate and the next torque are the same under both.

use driveline::drive::{Config, Drive, Limits};
use driveline::governor::{
    ActiveDamping, ActiveDampingConfig, CycleAverage, DampingLag, Droop, DroopConfig, FeedForward, FeedForwardConfig,
    Gains, Governor, LagConfig, SetpointLag, SpeedGovernor, SpeedLoop, SpeedLoopConfig, SymmetricLimit,
    SymmetricLimitConfig,
};
use driveline::number::{Coefficient, Fixed, Number, StateOf};
use driveline::observer::{GearFriction, GearedConfig, GearedObserver, Observer, TwoMassConfig, TwoMassObserver};
use driveline::sample::{Estimate, Sample};

use super::governor::plain;

/// Shares and stiffness that a switch changes; the compliance is one over the stiffness.
fn two_mass(share: [f64; 2], stiffness: f64) -> TwoMassConfig<f64> {
    TwoMassConfig {
        forcing: [1.0, 0.0],
        twist: [0.0, 0.0, 1.0],
        twist_rate: [0.0, 0.0, 0.5],
        acceleration: 1.0,
        turn: [0.0; 2],
        correction: [0.0; 4],
        angle_correction: 0.0,
        speed: 1.0,
        share,
        shaft: [stiffness, 0.5],
        compliance: 1.0 / stiffness,
    }
}

/// A rate of 4 moves the motor's speed by its share of it, and the mean speed takes that over.
#[test]
fn a_switch_of_two_masses_leaves_speed_and_shaft_torque() {
    let (from, to) = (two_mass([0.25, -0.75], 2.0), two_mass([0.75, -0.25], 8.0));
    let geared =
        |observer| GearedConfig { observer, friction: GearFriction::default(), stiction_gain: 0.0, deadband: 0.0 };
    let mut observer = GearedObserver::<TwoMassObserver<f64>>::steady(&geared(from), 0, 0.0, 100.0);
    observer.step(&geared(from), 0, 8.0);
    let before = observer.estimate(&geared(from));
    // mean speed 108, rate 4, twist 8
    assert_eq!((before.motor_speed, before.shaft_torque), (109.0, 18.0));
    observer.switch(&geared(from), &geared(to));
    let after = observer.estimate(&geared(to));
    assert_eq!((after.motor_speed, after.shaft_torque), (109.0, 18.0));
    // the load turns by the rate slower than the motor
    assert_eq!((before.load_speed, after.load_speed), (105.0, 105.0));
}

/// A lag that holds the setpoint 8 behind the ramp, and one of the damping that follows at once.
#[test]
fn a_switch_of_a_speed_loop_with_lags_is_bumpless() {
    type Lagged = SpeedLoop<(SetpointLag<f64>, DampingLag<f64>), f64>;
    let config = |proportional, damping| SpeedLoopConfig {
        proportional,
        damping,
        reset: 0.0,
        torque_limit: 1000.0,
        ramp: 4.0,
        filter: ((), LagConfig { share: 1.0 }),
    };
    let (from, to) = (config(2.0, -3.0), config(5.0, 1.0));
    let at = |speed| Estimate { motor_speed: speed, shaft_torque: 0.0, load_speed: speed - 2.0, load_torque: 0.0 };
    let mut governor = Lagged::default();
    governor.start(&from, &at(10.0), 6.0);
    governor.set_setpoint(18.0);
    // the loop's setpoint stays at 10: error -1, twist rate 2
    assert_eq!([(); 3].map(|()| governor.command(&from, &at(11.0))), [6.0 - 2.0 - 6.0; 3]);
    governor.switch(&from, &to, &at(11.0));
    assert_eq!(governor.command(&to, &at(11.0)), -2.0);
    // and from there by the new gain
    assert_eq!(governor.command(&to, &at(12.0)), -7.0);
}

/// Without filters, through a drive; a lost angle then leaves neither torque nor setpoint.
#[test]
fn a_switch_of_a_drive_is_bumpless() {
    type Plain = Drive<f64, TwoMassObserver, SpeedLoop>;
    let config = |proportional, damping, share, stiffness| Config {
        limits: Limits { torque: 1e3, setpoint: 1e3, innovation: 1e3, frozen_turn: 1e3, max_coast: 3 },
        observer: two_mass(share, stiffness),
        fluctuation: (),
        governor: SpeedLoopConfig { proportional, damping, reset: 0.0, torque_limit: 1e3, ramp: 8.0, filter: () },
        balancer: (),
    };
    let (from, to) = (config(2.0, -3.0, [0.25, -0.75], 2.0), config(5.0, 1.0, [0.75, -0.25], 8.0));
    let mut drive = Plain::new(&from, 0);
    // mean speed 8, rate 4: the motor at 9, the load at 5; the ramp is at 8
    let first = drive.tick(&from, &Sample { angle: 0, torque: 8.0, setpoint: 8.0 });
    assert_eq!(first.torque, -2.0 - 12.0);
    let (before, mut switched) = (drive.estimate(&from), drive);
    switched.switch(&from, &to);
    let after = switched.estimate(&to);
    assert_eq!((after.motor_speed, after.shaft_torque), (before.motor_speed, before.shaft_torque));
    assert_eq!(switched.governor_mut().command(&to.governor, &after), -14.0);
    let mut governor = *switched.governor();
    governor.angle_lost(&to.governor, &Estimate { motor_speed: 9.0, load_speed: 9.0, ..after });
    assert_eq!(governor.command(&to.governor, &Estimate { motor_speed: 9.0, load_speed: 9.0, ..after }), 5.0 * -8.0);
}

#[test]
fn a_switch_of_gain_droop_and_feed_forward_is_bumpless() {
    type Drooped = StateOf<SpeedGovernor<(Droop, ()), (FeedForward, ()), SymmetricLimit, (), CycleAverage>, f64>;
    let config = |proportional, droop, share| {
        let gains = Gains { proportional, reset: 0.0, ramp: 0.0 };
        let limit = SymmetricLimitConfig { torque: 100.0 };
        plain(gains, (DroopConfig { droop }, ()), (FeedForwardConfig { share }, ()), limit)
    };
    let (from, to) = (config(2.0, 0.25, 0.5), config(4.0, 0.5, 0.25));
    let at = |speed| Estimate { motor_speed: speed, shaft_torque: 0.0, load_speed: speed, load_torque: 8.0 };
    let mut governor = Drooped::default();
    governor.start(&from, &at(50.0), 20.0);
    // 3 too slow, by the filtered speed alone
    governor.set_steady_speed(Some(47.0));
    assert_eq!(governor.command(&from, &at(50.0)), 26.0);
    Governor::switch(&mut governor, &from, &to, &at(50.0));
    assert_eq!(governor.command(&to, &at(50.0)), 26.0);
    // without the filter's speed the estimate's counts, and a start forgets it
    governor.start(&from, &at(50.0), 20.0);
    assert_eq!(governor.command(&from, &at(50.0)), 20.0);
}

/// Torques after a switch at a limit of one base, `scale` being the factors of a gain and of a widened number.
fn switched<N: Number>(
    number: impl Fn(f64) -> N,
    factor: impl Fn(f64) -> N::Coefficient,
    scale: [f64; 2],
    [torque, load_torque, error, from, to]: [f64; 5],
) -> [f64; 16] {
    type Composed<N> = StateOf<SpeedGovernor<(), (FeedForward, ActiveDamping)>, N>;
    let [from, to] = [from, to].map(|gain| {
        let gains = Gains { proportional: factor(gain / scale[0]), reset: factor(0.25), ramp: number(1.0) };
        let forward = FeedForwardConfig { share: factor(1.0 / scale[1]) };
        let damping = ActiveDampingConfig { damping: factor(-1.0 / scale[0]) };
        plain(gains, (), (forward, damping), SymmetricLimitConfig { torque: number(1.0) })
    });
    let at = |speed: f64| Estimate {
        motor_speed: number(speed),
        shaft_torque: number(0.0),
        load_speed: number(2.0 * speed),
        load_torque: number(load_torque),
    };
    let mut governor = Composed::<N>::default();
    governor.start(&from, &at(0.0), number(torque));
    governor.command(&from, &at(-error));
    Governor::switch(&mut governor, &from, &to, &at(-error));
    // first as long as the integral takes to settle
    let shares = [-1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, 0.5, 0.5, 0.0, 0.0, -0.25, 0.125];
    shares.map(|share| governor.command(&to, &at(share * error)).to_real())
}

/// While no estimate is beyond its base and the compensation is within two, fixed point commands what `f64` commands,
/// however far integral and compensation go beyond the limit together.
#[test]
fn a_switch_in_saturation_is_the_same_in_every_number() {
    let values = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let gains = [0.5, 2.0, 8.0];
    for case in 0..125 * 9 {
        let of = |by: usize, base: usize| values[case / by % base];
        let (from, to) = (gains[case / 125 % 3], gains[case / 375]);
        let inputs = [of(1, 5), of(5, 5), of(25, 5), from, to];
        let float = switched::<f64>(|x| x, |x| x, [1.0; 2], inputs);
        let fixed = switched::<Fixed>(Fixed::from_f64, |x| Coefficient::from_f64(x).unwrap(), [32.0, 4.0], inputs);
        for (float, fixed) in float.into_iter().zip(fixed) {
            // sixteen ticks of roundings to 2^-23
            assert!((float - fixed).abs() < 1e-5, "{inputs:?}: {float} {fixed}");
        }
    }
}
