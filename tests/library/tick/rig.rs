//! A drive of the hoist and the machine that it believes in: two masses of the full solver in closed loop.

use core::f64::consts::TAU;

pub use crate::hoist::DriveOf;
use crate::hoist::{Hoist, Variant};
use driveline::configure::Machine as _;
use driveline::drive::Drive;
use driveline::fault::Faults;
use driveline::machine::TwoMass;
use driveline::number::{Fixed, Number};
use driveline::sample::{Command, Estimate, Sample};
use driveline::settings::Bases;
use driveline_solver::plant::{Chain, Plant, Shaft};

/// The hoist's rated speed (rad/s) and largest torque (N m), its two masses, and its bases of fixed point.
pub const RATED_SPEED: f64 = Hoist::<10_000>::RATING.speed.0;
pub const TORQUE_LIMIT: f64 = Hoist::<10_000>::RATING.torque_limit.0;
pub const REDUCED: TwoMass = Hoist::<10_000>::TWO_MASS;
pub const BASES: Bases = Hoist::<10_000>::BASES;

/// Weight of the load at the motor (N m): 12 t under 9.80665 m/s2 on a drum of 0.8 m, two falls and a gear of 31.5.
pub const WEIGHT: f64 = 12_000.0 * 9.806_65 * 0.8 / (2.0 * 2.0 * 31.5);

/// A number with the hoist's bases.
pub trait Scaled: Number {
    /// Of a torque (N m).
    fn of_torque(torque: f64) -> Self;
    /// Of a speed (rad/s).
    fn of_speed(speed: f64) -> Self;
    /// As a torque (N m).
    fn torque(self) -> f64;
    /// As a speed (rad/s).
    fn speed(self) -> f64;
}

impl Scaled for f32 {
    fn of_torque(torque: f64) -> Self {
        torque as f32
    }
    fn of_speed(speed: f64) -> Self {
        speed as f32
    }
    fn torque(self) -> f64 {
        self.into()
    }
    fn speed(self) -> f64 {
        self.into()
    }
}

impl Scaled for Fixed {
    fn of_torque(torque: f64) -> Self {
        Fixed::from_f64(torque / BASES.torque)
    }
    fn of_speed(speed: f64) -> Self {
        Fixed::from_f64(speed / BASES.speed)
    }
    fn torque(self) -> f64 {
        self.to_f64() * BASES.torque
    }
    fn speed(self) -> f64 {
        self.to_f64() * BASES.speed
    }
}

/// A command with the estimates behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen<N> {
    pub torque: N,
    pub estimate: Estimate<N>,
    pub faults: Faults,
}

impl<N> Seen<N> {
    /// Of a command and the estimates that the drive had after it.
    pub fn new(Command { torque, faults }: Command<N>, estimate: Estimate<N>) -> Self {
        Seen { torque, estimate, faults }
    }
}

/// Calls a generic function once for every variant of the hoist at a rate.
macro_rules! for_every_variant {
    ($rate:literal, $test:ident) => {
        for_every_variant!($rate, $test, f32, driveline::number::Fixed);
    };
    ($rate:literal, $test:ident, $($number:ty),+) => {{
        use crate::hoist::{self, CutAtRope, Hoist, Of};
        $(
        $test::<Of<Hoist<$rate>, $number, hoist::Rigid>>();
        $test::<Of<CutAtRope<$rate>, $number, hoist::Exact>>();
        $test::<Of<Hoist<$rate>, $number, hoist::Exact>>();
        $test::<Of<Hoist<$rate>, $number, hoist::Reduced>>();
        )+
    }};
}
pub(crate) use for_every_variant;

/// A drive in closed loop with its machine.
pub struct Rig<V: Variant> {
    /// The machine.
    pub plant: Plant,
    /// The drive.
    pub drive: DriveOf<V>,
    /// Torque that the machine was given during the last tick (N m).
    pub applied: f64,
    /// Setpoint (rad/s).
    pub setpoint: f64,
}

impl<V: Variant> Clone for Rig<V> {
    fn clone(&self) -> Self {
        Rig { plant: self.plant.clone(), drive: self.drive, applied: self.applied, setpoint: self.setpoint }
    }
}

impl<V: Variant> Rig<V>
where
    V::Number: Scaled,
{
    /// At rest, without load, wanted to turn at rated speed.
    pub fn at_rest() -> Self {
        let shaft = Shaft::elastic(REDUCED.stiffness).damping(REDUCED.damping);
        let plant = Chain::motor(REDUCED.motor_inertia).efficiency(0.94).shaft(shaft, REDUCED.load_inertia).build();
        Rig { plant: plant.unwrap(), drive: Drive::new(V::CONFIG, 0), applied: 0.0, setpoint: RATED_SPEED }
    }

    /// Lifting at a steady speed (rad/s): three seconds cover the ramp of two and what settles after it.
    pub fn lifting(speed: f64) -> Self {
        let mut rig = Rig::at_rest();
        rig.setpoint = speed;
        for tick in 0..3 * V::RATE_HZ {
            if tick == V::RATE_HZ / 10 {
                rig.plant.set_load_torque(1, WEIGHT);
            }
            let command = rig.tick(|_| {});
            assert_eq!(command.faults, Faults::NONE, "{} in tick {tick}", V::NAME);
        }
        rig
    }

    /// What the sensors say: 8192 counts a turn, the torque as it was.
    pub fn sample(&self) -> Sample<V::Number> {
        let count = (self.plant.motor_angle() / TAU * 8192.0).floor() as i64;
        Sample {
            angle: (count << 19) as u32,
            torque: Scaled::of_torque(self.applied),
            setpoint: Scaled::of_speed(self.setpoint),
        }
    }

    /// One tick with a sample that `spoil` has had in its hands.
    pub fn tick(&mut self, spoil: impl FnOnce(&mut Sample<V::Number>)) -> Seen<V::Number> {
        let mut sample = self.sample();
        spoil(&mut sample);
        let command = Seen::new(self.drive.tick(V::CONFIG, &sample), self.drive.estimate(V::CONFIG));
        self.applied = command.torque.torque();
        self.plant.advance(self.applied, 1.0 / f64::from(V::RATE_HZ));
        check(V::NAME, V::CONFIG.governor.torque_limit, &command);
        command
    }

    /// Errors of the estimates before the next sample: motor speed, load speed (rad/s), shaft and load torque (N m).
    pub fn errors(&self, command: &Seen<V::Number>, before: &Plant) -> [f64; 4] {
        let estimate = &command.estimate;
        [
            estimate.motor_speed.speed() - before.speed(0),
            estimate.load_speed.speed() - before.speed(1),
            estimate.shaft_torque.torque() - before.shaft_torque(0),
            estimate.load_torque.torque() - before.load_torque(1),
        ]
    }

    /// Largest errors over some healthy ticks; every flag in them counts as a failure.
    pub fn healthy(&mut self, ticks: u32) -> [f64; 4] {
        let mut largest = [0.0_f64; 4];
        for tick in 0..ticks {
            let before = self.plant.clone();
            let command = self.tick(|_| {});
            assert_eq!(command.faults, Faults::NONE, "{} in healthy tick {tick}", V::NAME);
            for (largest, error) in largest.iter_mut().zip(self.errors(&command, &before)) {
                *largest = largest.max(error.abs());
            }
        }
        largest
    }
}

/// The promises that hold whatever the sample: everything finite, the torque within the governor's limit.
#[track_caller]
pub fn check<N: Scaled>(name: &str, limit: N, command: &Seen<N>) {
    let estimate = &command.estimate;
    for torque in [command.torque, estimate.shaft_torque, estimate.load_torque] {
        assert!(torque.torque().is_finite(), "{name}: {command:?}");
    }
    for speed in [estimate.motor_speed, estimate.load_speed] {
        assert!(speed.speed().is_finite(), "{name}: {command:?}");
    }
    assert!(!command.torque.exceeds(limit), "{name}: {command:?}");
}
