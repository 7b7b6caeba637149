//! A lost angle that is found by two others, and torques that cannot be.

use super::{Config, Drive, Limits};
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::number::Part;
use crate::observer::{RigidConfig, RigidObserver};
use crate::sample::{Estimate, Sample};

/// 2^32 per turn and ticks as units of angle and time, an inertia of one: no encoder, gains of a third.
const CONFIG: Config<f64, RigidConfig<f64>> = Config {
    limits: Limits { torque: 10.0, setpoint: 1e6, innovation: 1000.0, frozen_turn: 10.0, max_coast: 3 },
    observer: RigidConfig {
        acceleration: 1.0,
        turn: 0.5,
        correction: [0.3, 0.0],
        angle_correction: -0.3,
        speed: 1.0,
        load_share: 0.5,
    },
    fluctuation: (),
    governor: (),
    balancer: (),
};

fn tick(drive: &mut Drive<f64, RigidObserver>, angle: u32) -> Faults {
    drive.tick(&CONFIG, &Sample { angle, torque: 0.0, setpoint: 0.0 }).faults
}

#[test]
fn two_angles_that_differ_by_more_give_the_speed() {
    let mut drive = Drive::new(&CONFIG, 0);
    let mut angle = 0;
    for _ in 0..5 {
        angle += 5000;
        tick(&mut drive, angle);
    }
    assert_eq!(tick(&mut drive, angle + 5000), Faults::ANGLE_JUMP | Faults::ANGLE_LOST);
    let command = drive.tick(&CONFIG, &Sample { angle: angle + 10_000, torque: 0.0, setpoint: 0.0 });
    assert_eq!((command.faults, drive.estimate(&CONFIG).motor_speed), (Faults::NONE, 5000.0));
}

#[test]
fn without_a_governor_the_last_plausible_torque_stands_in() {
    let mut drive = Drive::<f64, RigidObserver>::new(&CONFIG, 0);
    drive.tick(&CONFIG, &Sample { angle: 0, torque: 1.0, setpoint: 0.0 });
    for torque in [f64::NAN, f64::INFINITY, -10.1] {
        let command = drive.tick(&CONFIG, &Sample { angle: 0, torque, setpoint: 0.0 });
        assert_eq!((command.faults, drive.commanded), (Faults::TORQUE, 1.0));
    }
}

/// The last torque that a measurement was given.
#[derive(Clone, Copy, Debug, Default)]
struct Given(f64);

impl Part<f64> for Given {
    type State = Self;
}

impl Fluctuation<f64> for Given {
    type Config = ();

    fn measure(&mut self, _config: &(), _angle: u32, torque: f64, _estimate: &Estimate<f64>) {
        self.0 = torque;
    }

    fn disturb(&mut self) {}
}

/// A measurement takes the torque that the observer took, never the sample's where that is implausible.
#[test]
fn a_measurement_is_given_no_implausible_torque() {
    let mut drive = Drive::<f64, RigidObserver, (), Given>::new(&CONFIG, 0);
    for (torque, given) in [(2.0, 2.0), (10.0, 10.0), (10.1, 10.0), (f64::NAN, 10.0), (-3.0, -3.0), (-1e9, -3.0)] {
        drive.tick(&CONFIG, &Sample { angle: 0, torque, setpoint: 0.0 });
        assert_eq!(drive.fluctuation().0, given, "{torque}");
    }
}
