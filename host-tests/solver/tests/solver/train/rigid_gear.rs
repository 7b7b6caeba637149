//! A lossy gear with no shaft behind it, against closed forms, its law in runs at random, and the second integrator.

use driveline_solver::noise::Noise;
use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{Coordinate, Friction, Link, Motion, RigidGear, Source, Train};
use driveline_solver::plant::{LoadProgram, PlantError};

/// A motor, a coupling, and a load behind a rigid gear.
#[derive(Clone, Debug)]
struct Geared {
    motor: f64,
    whole: f64,
    gear: RigidGear,
    stiffness: f64,
    damping: f64,
    load: f64,
    dry: f64,
}

impl Geared {
    /// The motor's torque is a program; the coupling carries `carried` at the start.
    fn motion(&self, program: &[(f64, f64)], carried: f64) -> Motion {
        let motor = Coordinate::new(self.motor).source(Source::Program(LoadProgram::table(program)));
        let load = Coordinate::new(self.whole).gear(self.gear).source(Source::Constant(-self.load));
        let coupling = Link::shaft(0, 1, self.stiffness).damping(self.damping).elongated(carried / self.stiffness);
        let train = Train::new().coordinate(motor).coordinate(load).link(coupling);
        let train = if self.dry > 0.0 { train.friction(Friction::ground(1, self.dry)) } else { train };
        train.build().unwrap()
    }

    /// Acceleration of the gear under the coupling's torque, at a speed: of the two losses the one that its own power
    /// agrees with. At rest the force that lifts or lowers decides.
    fn speeding(&self, front: f64, speed: f64) -> f64 {
        let behind = self.whole - self.gear.front;
        let slide = |way: f64| {
            let load = self.load + way * self.dry;
            [1.0 / self.gear.efficiency, self.gear.back_efficiency].into_iter().enumerate().find_map(
                |(driven, loss)| {
                    let speeding = (front - loss * load) / (self.gear.front + loss * behind);
                    let through = behind * speeding + load;
                    ((through * way > 0.0) == (driven == 0)).then_some(speeding)
                },
            )
        };
        if speed != 0.0 {
            return slide(speed.signum()).unwrap_or(f64::NAN);
        }
        let starts = |way: f64| slide(way).filter(|speeding| speeding * way > 0.0);
        starts(1.0).or_else(|| starts(-1.0)).unwrap_or(0.0)
    }
}

const WORM: RigidGear = RigidGear { front: 0.02, efficiency: 0.45, back_efficiency: -0.05 };

#[test]
fn a_gear_that_locks_itself_holds_its_load_and_lowers_it_only_when_driven() {
    let of = |load: f64| Geared { motor: 0.1, whole: 0.3, gear: WORM, stiffness: 500.0, damping: 1.0, load, dry: 0.0 };
    let mut left = of(80.0).motion(&[(0.0, 0.0)], 0.0);
    left.advance(5.0);
    assert_eq!((left.speed(1), left.angle(1)), (0.0, 0.0));
    // 80/0.45 = 177.8 N m lift it, -0.05 * 80 = -4 N m lower it; ramps of 1 N m/s, too slow for the motor to swing
    for (end, expected) in [(400.0, 80.0 / 0.45), (-40.0, -4.0)] {
        let mut ramp = of(80.0).motion(&[(0.0, 0.0), (400.0, end)], 0.0);
        while ramp.speed(1) == 0.0 && ramp.time() < 399.0 {
            ramp.advance(0.01);
        }
        // one tick of the ramp, and what the motor swings about it
        assert!((ramp.force(0) - expected).abs() < 0.05, "{} for {expected}", ramp.force(0));
        ramp.advance(0.1);
        assert!(ramp.speed(1) * end > 0.0);
    }
}

/// Friction is left out of a pretensioned start: the coupling carries the load, whatever the gear would hold.
#[test]
fn a_pretensioned_coupling_carries_the_load() {
    for back_efficiency in [0.6, -0.05] {
        let gear = RigidGear { back_efficiency, ..WORM };
        let load = Coordinate::new(0.3).gear(gear).source(Source::Constant(-80.0));
        let train = Train::new().coordinate(Coordinate::new(0.1)).coordinate(load).link(Link::shaft(0, 1, 500.0));
        let motion = train.pretensioned(0).unwrap().build().unwrap();
        // some roundings of 80/500
        assert!((motion.elongation(0) - 0.16).abs() < 1e-14, "{back_efficiency}: {}", motion.elongation(0));
    }
}

#[test]
fn a_lifted_load_speeds_up_by_the_referred_inertia() {
    // the coupling turns with the motor after its swing has gone: J = 0.1 + 0.02 + 0.28/0.45
    let drive = Geared { motor: 0.1, whole: 0.3, gear: WORM, stiffness: 5e4, damping: 60.0, load: 80.0, dry: 20.0 };
    let mut run = drive.motion(&[(0.0, 300.0)], 0.0);
    run.advance(1.0);
    let before = run.speed(1);
    run.advance(1.0);
    let expected = (300.0 - 100.0 / 0.45) / (0.12 + 0.28 / 0.45);
    assert!(((run.speed(1) - before) / expected - 1.0).abs() < 1e-9, "{} for {expected}", run.speed(1) - before);
}

fn random(seed: u64) -> (Geared, Vec<(f64, f64)>) {
    let mut dice = Noise::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let mut between = move |low: f64, high: f64| low * (high / low).powf(0.5 + 0.5 * dice.uniform());
    let whole = between(0.05, 1.0);
    let front = whole * between(0.02, 0.9);
    let efficiency = between(0.3, 1.0);
    // a gear that locks, as far as its front's inertia allows, or any other
    let locks = -0.8 * front / (whole - front);
    let back_efficiency = if between(1.0, 3.0) > 2.0 { between(0.05, 1.0) } else { locks * between(0.01, 1.0) };
    let load = between(5.0, 100.0) * if between(1.0, 3.0) > 1.4 { 1.0 } else { -1.0 };
    let program = (0..6).map(|k| (f64::from(k) * 0.1, between(1.0, 300.0) - 120.0)).collect();
    let drive = Geared {
        motor: between(0.02, 0.5),
        whole,
        gear: RigidGear { front, efficiency, back_efficiency },
        stiffness: between(100.0, 5000.0),
        damping: between(0.05, 5.0),
        load,
        dry: if between(1.0, 3.0) > 2.0 { between(1.0, 40.0) } else { 0.0 },
    };
    (drive, program)
}

#[test]
fn gears_at_random_keep_their_law_and_agree_with_the_second_integrator() {
    let mut held = 0;
    for seed in 1..=60 {
        let (drive, program) = random(seed);
        let mut run = Recording::new(drive.motion(&program, drive.load.max(0.0)));
        let (dt, mut most) = (2e-4, drive.load.abs());
        for tick in 0..2500 {
            let state = |motion: &Motion| (motion.force(0), motion.speed(1), motion.events().len());
            let (front, speed, events) = state(run.motion());
            run.advance(dt);
            let (after, next, fired) = state(run.motion());
            // both ends of a tick without an event: the mean of both accelerations, but for the square of a tick
            if tick == 0 || fired > events || speed * next < 0.0 || (speed == 0.0) != (next == 0.0) {
                continue;
            }
            held += usize::from(speed == 0.0);
            let law = 0.5 * (drive.speeding(front, speed) + drive.speeding(after, next));
            // the mean is off by (364 rad/s * dt)^2/12 of the largest swing
            most = most.max(front.abs()).max(after.abs());
            assert!(
                ((next - speed) / dt - law).abs() < 1e-3 * most / drive.gear.front,
                "{seed}, tick {tick}: {drive:#?}"
            );
        }
        let proof = prove(&run).unwrap_or_else(|refused| panic!("seed {seed}: {refused}\n{drive:#?}"));
        assert!(proof.largest() < 1e-8);
    }
    assert!(held > 1000, "{held}");
}

#[test]
fn a_gear_that_would_jam_while_it_turns_is_refused() {
    let of = |back_efficiency| {
        let gear = RigidGear { front: 0.1, efficiency: 0.4, back_efficiency };
        Train::new().coordinate(Coordinate::new(0.3).gear(gear)).build()
    };
    // 0.1 - 0.5 * 0.2 = 0 is the limit
    assert!(matches!(of(-0.51), Err(PlantError::Parameter { name: "efficiency when overhauling", .. })));
    assert!(of(-0.49).is_ok());
}
