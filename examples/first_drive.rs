//! The first drive, in `f32` and in fixed point, on a simulated machine: `cargo run --example first_drive`.

use driveline::configure::Units;
use driveline::prelude::*;

/// Motor, coupling and roll.
struct Roll;

impl Machine for Roll {
    const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
    const RATING: Rating = Rating { torque: 300.0, speed: 150.0, torque_limit: 550.0 };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
}

type RollDrive<N> = Drive<N, TwoMassObserver<N>, (), SpeedLoop<N>>;
static SINGLE: ConfigOf<RollDrive<f32>> = RollDrive::<f32>::configure::<Roll>();
static FIXED: ConfigOf<RollDrive<Fixed>> = RollDrive::<Fixed>::configure::<Roll>();

/// Two masses on a damped spring, and an encoder: what the drive does not see of the machine.
#[derive(Default)]
struct Plant {
    angle: [f64; 2],
    speed: [f64; 2],
}

impl Plant {
    /// A tick of the drive, in steps of 1 us: next to a resonance of 315 rad/s their error is a few parts in 10^4.
    fn advance(&mut self, torque: f64, load: f64) {
        const STEP: f64 = 1e-6;
        for _ in 0..100 {
            let twist = self.angle[0] - self.angle[1];
            let shaft = 2.0e4 * twist + 0.5 * (self.speed[0] - self.speed[1]);
            self.speed[0] += STEP * (torque - shaft) / 0.35;
            self.speed[1] += STEP * (shaft - load) / 0.48;
            self.angle[0] += STEP * self.speed[0];
            self.angle[1] += STEP * self.speed[1];
        }
    }

    /// Counts of a motor's encoder of 2048 lines, as a fraction of 2^32.
    fn counts(&self) -> u32 {
        let counts = (self.angle[0] / std::f64::consts::TAU * 8192.0).floor() as i64;
        (counts as u32) << 19
    }
}

/// Up to rated speed in two seconds, then a load of 200 N m at 3 s; gives the speeds and load torques, true and estimated, every half second.
fn run<N: Units>(config: &ConfigOf<RollDrive<N>>) -> Vec<[f64; 4]> {
    let (mut drive, mut plant, mut torque) = (RollDrive::<N>::new(config, 0), Plant::default(), 0.0);
    let mut rows = Vec::new();
    for tick in 1..=50_000 {
        let load = if tick > 30_000 { 200.0 } else { 0.0 };
        plant.advance(torque, load);
        // the torque of the tick that has just ended, and the set point
        let command = drive.tick(config, &Sample::si::<Roll>(plant.counts(), torque as f32, 150.0));
        assert!(command.faults.is_none(), "{} in tick {tick}", command.faults);
        torque = f64::from(command.torque_si::<Roll>());
        if tick % 5_000 == 0 {
            let estimate = drive.estimate(config).si::<Roll>();
            rows.push([plant.speed[1], f64::from(estimate.load_speed), load, f64::from(estimate.load_torque)]);
        }
    }
    rows
}

fn main() {
    for (number, rows) in [("f32", run(&SINGLE)), ("Fixed", run(&FIXED))] {
        println!("{number}: load speed (rad/s) and load torque (N m), true and estimated");
        for (k, [speed, estimated, load, torque]) in rows.iter().enumerate() {
            println!("{:4.1} s  {speed:8.2} {estimated:8.2}  {load:6.1} {torque:8.1}", 0.5 * (k + 1) as f64);
        }
    }
}

/// Both numbers reach the set point, hold it under the load, and find the load.
///
/// Speed: 0.3 % of rated, the project's aim for the load's speed. Torque: 2 % of the rated torque, its aim for torques; the estimate's
/// predicted standard deviation is well below either.
#[test]
fn both_numbers_hold_the_speed_and_find_the_load() {
    let (single, fixed) = (run(&SINGLE), run(&FIXED));
    for rows in [&single, &fixed] {
        // half a second after the ramp, and two after the load has come
        for k in [5, 9] {
            let [speed, estimated, load, torque] = rows[k];
            assert!((speed - 150.0).abs() < 0.003 * 150.0, "{rows:?}");
            assert!((estimated - speed).abs() < 0.003 * 150.0, "{rows:?}");
            assert!((torque - load).abs() < 0.02 * 300.0, "{rows:?}");
        }
    }
}
