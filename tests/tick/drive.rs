//! The drive's own part: screening, the stand-in torque, the lost angle, and what the other parts are told.

use driveline::balancing::Balancer;
use driveline::drive::{Config, Drive, Limits};
use driveline::fault::Faults;
use driveline::fluctuation::Fluctuation;
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::number::Part;
use driveline::observer::{Observer, RigidObserver};
use driveline::sample::{Estimate, Sample};

use super::UNIT;

const LIMITS: Limits<f64> =
    Limits { torque: 10.0, setpoint: 1000.0, innovation: 100.0, frozen_turn: 2.0, max_coast: 3 };

/// Counts what a drive tells its fluctuation or its balancer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Told {
    measured: u32,
    disturbed: u32,
}

impl Part<f64> for Told {
    type State = Self;
}

impl Fluctuation<f64> for Told {
    type Config = ();

    fn measure(&mut self, (): &(), _angle: u32, _torque: f64, _estimate: &Estimate<f64>) {
        self.measured += 1;
    }

    fn disturb(&mut self) {
        self.disturbed += 1;
    }
}

impl Balancer<f64> for Told {
    type Config = ();
    type Vibration = f64;

    fn measure(&mut self, (): &(), _angle: u32, _vibration: &f64) {
        self.measured += 1;
    }

    fn missed(&mut self, _faults: Faults) {
        self.disturbed += 1;
    }
}

type Watched = Drive<f64, RigidObserver, (), Told, Told>;

const WATCHED: driveline::drive::ConfigOf<Watched> =
    Config { limits: LIMITS, observer: UNIT, fluctuation: (), governor: (), balancer: () };

/// Disturbances told by one action on a fresh drive, or on one that has lost its angle.
fn disturbed(lost: bool, action: impl FnOnce(&mut Watched)) -> u32 {
    let mut drive = Watched::new(&WATCHED, 0);
    for _ in 0..if lost { 4 } else { 0 } {
        drive.coast(&WATCHED, 0.0, 0.0);
    }
    assert_eq!(drive.is_lost(), lost);
    let before = drive.fluctuation().disturbed;
    action(&mut drive);
    drive.fluctuation().disturbed - before
}

#[test]
fn the_fluctuation_is_told_of_every_tick_without_an_angle() {
    let at = |angle| Sample { angle, torque: 0.0, setpoint: 0.0 };
    let tick = |angle| {
        move |drive: &mut Watched| {
            drive.tick(&WATCHED, &at(angle));
        }
    };
    let coast = |drive: &mut Watched| {
        drive.coast(&WATCHED, 0.0, 0.0);
    };
    let hold = |drive: &mut Watched| {
        drive.hold(&WATCHED, 0, 0.0);
    };
    let miss = |drive: &mut Watched| {
        drive.make_up(&WATCHED, 0.0, 1);
    };
    assert_eq!(disturbed(false, tick(0)), 0);
    assert_eq!(disturbed(false, tick(101)), 1, "an angle that jumps");
    assert_eq!(disturbed(false, coast), 1, "no angle");
    assert_eq!(disturbed(false, hold), 1, "the brake");
    assert_eq!(disturbed(false, miss), 1, "a missed tick");
    assert_eq!(disturbed(true, tick(0)), 1, "lost, and seen again");
    assert_eq!(disturbed(true, coast), 1, "lost, and still without an angle");
}

#[test]
fn fluctuation_and_balancer_measure_once_a_tick() {
    let mut drive = Watched::new(&WATCHED, 0);
    drive.tick(&WATCHED, &Sample { angle: 0, torque: 0.0, setpoint: 0.0 });
    drive.vibration(&WATCHED, &0.0);
    assert_eq!(*drive.fluctuation(), Told { measured: 1, disturbed: 0 });
    assert_eq!(*drive.balancer(), Told { measured: 1, disturbed: 0 });
    drive.vibration_missing(Faults::VIBRATION_CLIPPED);
    drive.make_up(&WATCHED, 0.0, 2);
    assert_eq!(*drive.balancer(), Told { measured: 1, disturbed: 2 });
}

/// Angles after the loss, `None` for a blind tick; whether the drive has its angle again after each.
fn search(angles: &[Option<u32>]) -> Vec<bool> {
    let mut drive = Watched::new(&WATCHED, 0);
    for _ in 0..4 {
        drive.coast(&WATCHED, 0.0, 0.0);
    }
    let one = |angle: &Option<u32>| {
        match *angle {
            Some(angle) => drive.tick(&WATCHED, &Sample { angle, torque: 0.0, setpoint: 0.0 }),
            None => drive.coast(&WATCHED, 0.0, 0.0),
        };
        !drive.is_lost()
    };
    angles.iter().map(one).collect()
}

/// A machine may run at up to twice the largest setpoint, 1,000 of 2^-32 turn a tick.
#[test]
fn a_lost_angle_is_found_up_to_twice_the_largest_setpoint() {
    for turned in [5, 999, 1001, 1500, 1999] {
        assert_eq!(search(&[Some(50_000), Some(50_000 + turned)]), [false, true], "{turned}");
        assert_eq!(search(&[Some(50_000), Some(50_000 - turned)]), [false, true], "-{turned}");
    }
    for turned in [2001, 5000] {
        assert_eq!(search(&[Some(50_000), Some(50_000 + turned)]), [false, false], "{turned}");
        assert_eq!(search(&[Some(50_000), Some(50_000 - turned)]), [false, false], "-{turned}");
    }
    // the angle after one that was too far is judged against that one
    assert_eq!(search(&[Some(50_000), Some(60_000), Some(60_100)]), [false, false, true]);
}

#[test]
fn a_blind_tick_begins_the_search_anew() {
    assert_eq!(search(&[Some(50_000), None, Some(50_100), Some(50_200)]), [false, false, false, true]);
    // and so does an angle that stands
    assert_eq!(search(&[Some(50_000), Some(50_000), Some(50_100), Some(50_200)]), [false, false, false, true]);
}

#[test]
fn faults_are_a_set() {
    let (one, two) = (Faults::TORQUE, Faults::SETPOINT);
    let both = one | two;
    assert_eq!((both | one, both & one, one & two), (both, one, Faults::NONE));
    assert!(both.contains(one) && both.contains(both) && !one.contains(both) && !one.contains(two));
    assert_eq!((one.with(two), both.with(one)), (both, both));
    assert_eq!((Faults::from_bits(both.bits()), both.bits() & one.bits(), Faults::NONE.bits()), (both, one.bits(), 0));
    // a bit that means nothing
    assert_eq!(Faults::from_bits(1 << 20 | one.bits()), one);
    assert_eq!((Faults::NONE.to_string(), both.to_string()), ("none".into(), "torque, setpoint".into()));
    assert_eq!(format!("{both:?}"), "Faults(torque, setpoint)");
    assert!(both.intersects(one) && one.intersects(both) && one.intersects(one) && !one.intersects(two));
}

/// Up to eight ticks that did not run are predicted, and after more the angle alone is taken: 5 rad/s turn by 5 a tick.
#[test]
fn ticks_that_did_not_run_are_predicted_before_the_next() {
    let at = |angle| Sample { angle, torque: 0.0, setpoint: 0.0 };
    let config = Config { limits: Limits { max_coast: 20, innovation: 3.0, ..LIMITS }, ..WATCHED };
    for (missed, turned, faults) in [
        (0, 5, Faults::NONE),
        (2, 15, Faults::TICK_MISSED),
        (8, 45, Faults::TICK_MISSED),
        (9, 50, Faults::TICK_MISSED | Faults::ANGLE_MISSING),
    ] {
        let mut drive = Watched::new(&config, 0);
        drive.observer_mut().restart(&config.observer, 0, 0.0, 5.0);
        assert_eq!(drive.tick_after(&config, &at(turned), missed).faults, faults, "{missed}");
        assert_eq!((drive.angle(), drive.estimate(&config).motor_speed), (turned, 5.0));
    }
}

/// Three ticks may pass without an angle, whether they ran or not; and a tick that did not run ends the search as well.
#[test]
fn missed_ticks_up_to_the_limit_keep_the_angle() {
    for (missed, lost) in [(1, false), (2, false), (3, false), (4, true), (1000, true)] {
        let mut drive = Watched::new(&WATCHED, 0);
        assert_eq!(drive.make_up(&WATCHED, 0.0, missed), Faults::TICK_MISSED);
        assert_eq!(drive.is_lost(), lost, "{missed}");
    }
    let mut drive = Watched::new(&WATCHED, 0);
    for lost in [false, false, false, true] {
        drive.coast(&WATCHED, 0.0, 0.0);
        assert_eq!(drive.is_lost(), lost);
    }
    let lost_at = |drive: &mut Watched, angle| {
        drive.tick(&WATCHED, &Sample { angle, torque: 0.0, setpoint: 0.0 });
        drive.is_lost()
    };
    assert!(lost_at(&mut drive, 50_000));
    drive.make_up(&WATCHED, 0.0, 1);
    // the search begins anew
    assert_eq!([lost_at(&mut drive, 50_100), lost_at(&mut drive, 50_200)], [true, false]);
    // one tick without an angle and one that did not run
    let mut drive = Watched::new(&WATCHED, 0);
    drive.coast(&WATCHED, 0.0, 0.0);
    drive.make_up(&WATCHED, 0.0, 1);
    assert!(!drive.is_lost());
}

#[test]
fn a_torque_that_cannot_be_is_told_of_while_the_angle_is_lost() {
    let mut drive = Watched::new(&WATCHED, 0);
    for _ in 0..4 {
        drive.coast(&WATCHED, 0.0, 0.0);
    }
    let lost = Faults::ANGLE_MISSING | Faults::ANGLE_LOST;
    assert_eq!(drive.coast(&WATCHED, 10.0, 0.0).faults, lost);
    assert_eq!(drive.coast(&WATCHED, -10.1, 0.0).faults, lost | Faults::TORQUE);
}

type Governed = Drive<f64, RigidObserver, SpeedLoop>;

const GOVERNED: driveline::drive::ConfigOf<Governed> = Config {
    limits: LIMITS,
    observer: UNIT,
    fluctuation: (),
    governor: SpeedLoopConfig { proportional: 0.5, damping: 0.0, reset: 0.0, torque_limit: 8.0, ramp: 4.0, filter: () },
    balancer: (),
};

/// Speed after one more tick with a torque that is not a number: the stand-in's, as the inertia is one.
fn stand_in(mut drive: Governed) -> f64 {
    let before = drive.estimate(&GOVERNED).motor_speed;
    let command = drive.coast(&GOVERNED, f64::NAN, 0.0);
    assert!(command.faults.contains(Faults::TORQUE));
    drive.estimate(&GOVERNED).motor_speed - before
}

#[test]
fn the_last_command_stands_in_for_a_torque_that_cannot_be() {
    let mut drive = Governed::new(&GOVERNED, 0);
    // the ramp's first step of 4 times the gain of a half
    let command = drive.tick(&GOVERNED, &Sample { angle: 0, torque: 0.0, setpoint: 100.0 });
    assert_eq!(command.torque, 2.0);
    assert_eq!(stand_in(drive), 2.0);
    let mut engaged = drive;
    engaged.engage(&GOVERNED);
    assert_eq!(stand_in(engaged), 0.0, "after `engage` nothing has been commanded");
    let mut held = drive;
    assert_eq!(held.hold(&GOVERNED, 0, 3.0).torque, 3.0);
    // the load carries the 3 N m, so that they accelerate nothing
    assert_eq!(stand_in(held), 0.0, "after `hold` its torque stands in");
    // the governor's limit of 8, within the sample's of 10
    assert_eq!([9.0, -9.0].map(|torque| held.hold(&GOVERNED, 0, torque).torque), [8.0, -8.0]);
    assert_eq!(held.estimate(&GOVERNED).load_torque, -8.0);
    held.hold(&GOVERNED, 0, 11.0);
    assert_eq!(held.estimate(&GOVERNED).load_torque, 0.0, "a torque beyond the limit holds with none");
}
