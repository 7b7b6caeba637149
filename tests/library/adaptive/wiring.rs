//! What a user could leave out or do in the wrong order with schedule and learners by hand, and cannot any more.

use driveline::drive::Composition;
use driveline::fault::Faults;
use driveline::learning::Learnt;
use driveline::observer::{GearedObserver, SemiImplicitObserver, TwoMassObserver};
use driveline::prelude::*;
use driveline_solver::noise::Noise;

use super::{GRAVITY, TRAVEL, Winch, WinchDrive};

type M = Winch<4_000>;
type D = WinchDrive<f32, SemiImplicitObserver, 4_000>;
static CONFIG: ConfigOf<D> = D::configure();

/// Friction per shaft torque of a gear: half of `1/eta - eta` [Huang 1987 tables 1-2 to 1-4].
fn friction(efficiency: f64) -> f64 {
    (1.0 / efficiency - efficiency) / (1.0 / efficiency + efficiency)
}

/// A motor on a given course, with the torque that a load of 7 t behind a gear of 0.93 takes.
struct Course {
    drive: D,
    angle: f64,
    speed: f64,
    tick: u32,
    /// Ticks between two calls of `background`.
    every: u32,
}

impl Course {
    fn new(every: u32) -> Self {
        Course { drive: D::new(&CONFIG, 0), angle: 0.0, speed: 0.0, tick: 0, every }
    }

    fn sample(&self, torque: f64) -> Sample<f32> {
        let angle = (self.angle / std::f64::consts::TAU).rem_euclid(1.0) * 4_294_967_296.0;
        Sample::si::<M>(angle as u64 as u32, torque as f32, self.speed as f32)
    }

    /// To a speed (rad/s), and 1.6 s there.
    fn to(&mut self, speed: f64) {
        let (efficiency, weight): (f64, f64) = (0.93, 7_000.0 * GRAVITY * TRAVEL);
        let mut steady = 0;
        while steady < 6_400 {
            let step = (speed - self.speed).clamp(-0.02, 0.02);
            steady += i32::from(step == 0.0);
            self.angle += (self.speed + 0.5 * step) / 4_000.0;
            self.speed += step;
            let carried = if self.speed > 0.0 { weight / efficiency } else { weight * efficiency };
            let command = self.drive.tick(&CONFIG, &self.sample(carried + 0.4 * step * 4_000.0));
            assert!(command.faults.is_none(), "{} rad/s: {}", self.speed, command.faults);
            self.tick += 1;
            if self.tick.is_multiple_of(self.every) {
                self.drive.background(&CONFIG, &Known::NOTHING);
            }
        }
    }

    /// Two pairs of up and down, and what comes between the two of a pair.
    fn pairs(&mut self, mut between: impl FnMut(&mut Self)) -> f64 {
        for _ in 0..3 {
            self.to(120.0);
            between(self);
            self.to(-120.0);
            between(self);
        }
        f64::from(self.drive.learnt().friction)
    }
}

/// The load may have changed behind a closed brake, while the drive was tripped, or in many ticks that did not run; a
/// torque that is not one tells nothing. By hand each learner had to be told.
#[test]
fn a_pair_of_windows_with_a_gap_between_teaches_nothing() {
    let told = friction(0.95);
    let [one, other] = [friction(0.93), told];
    for (name, between, expected) in [
        ("nothing", (|_| {}) as fn(&mut Course), one),
        (
            "the brake",
            |course| {
                course.to(0.0);
                let Sample { angle, torque, .. } = course.sample(100.0);
                course.drive.hold(&CONFIG, angle, torque);
            },
            other,
        ),
        ("a trip", |course| course.drive.engage(&CONFIG), other),
        (
            "a torque that is none",
            |course| {
                course.angle += course.speed / 4_000.0;
                let sample = Sample { torque: f32::NAN, ..course.sample(0.0) };
                course.drive.tick(&CONFIG, &sample);
            },
            other,
        ),
        (
            "no angle",
            |course| {
                course.angle += course.speed / 4_000.0;
                course.drive.coast(&CONFIG, course.sample(200.0).torque, course.speed as f32);
            },
            other,
        ),
        (
            "a tick that did not run and is made up",
            |course| {
                course.angle += 2.0 * course.speed / 4_000.0;
                course.drive.tick_after(&CONFIG, &course.sample(200.0), 1);
            },
            one,
        ),
        (
            "more ticks than are made up",
            |course| {
                course.angle += 10.0 * course.speed / 4_000.0;
                course.drive.tick_after(&CONFIG, &course.sample(200.0), 9);
            },
            other,
        ),
    ] {
        let found = Course::new(40).pairs(between);
        // half of the bound of agreement of two findings
        assert!((found - expected).abs() < 0.005, "{name}: {found} for {expected}");
    }
}

/// Each learner had to be called at its own steady rate. Below twenty times a second nothing is learnt.
#[test]
fn the_background_may_come_at_any_rate() {
    for (every, expected) in [(1, 0.93), (40, 0.93), (97, 0.93), (190, 0.93), (900, 0.95)] {
        let found = Course::new(every).pairs(|_| {});
        assert!((found - friction(expected)).abs() < 0.005, "{every} ticks: {found}");
    }
}

/// Never calling `background` was silent. A second after the last call each tick says so, at any rate and in a closed
/// brake, until the next call; ticks that did not run count.
#[test]
fn a_background_that_is_not_called_is_a_fault() {
    let sample = Sample::si::<M>(0, 0.0, 0.0);
    let mut drive = D::new(&CONFIG, 0);
    for _ in 0..2 {
        for tick in 0..150_000 {
            let faults =
                if tick % 3 == 0 { drive.hold(&CONFIG, 0, 0.0).faults } else { drive.tick(&CONFIG, &sample).faults };
            assert_eq!(faults.contains(Faults::BACKGROUND_MISSING), tick >= 4_000, "{tick}: {faults}");
        }
        drive.background(&CONFIG, &Known::NOTHING);
    }
    drive.tick_after(&CONFIG, &sample, 4_000);
    assert!(drive.tick(&CONFIG, &sample).faults.contains(Faults::BACKGROUND_MISSING));
    drive.background(&CONFIG, &Known::NOTHING);
    assert!(!drive.tick(&CONFIG, &sample).faults.contains(Faults::BACKGROUND_MISSING));
}

/// The constants of the schedule overwrote them. At the edge of the rope's range too.
#[test]
fn what_is_learnt_stays_when_the_gains_change() {
    let learnt = Learnt { friction: 0.08, torque: [0.03, 2.0], inertia: 0.1, eccentricity: [1_000, -2_000] };
    let mut drive = D::new(&CONFIG, 0);
    let mut plain = D::new(&CONFIG, 0);
    drive.restore(&CONFIG, &learnt);
    let sample = Sample::si::<M>(0, 0.0, 0.0);
    for (load, rope) in [(400.0, 6.0), (11_000.0, 20.0), (3_000.0, 9.0), (0.0, 100.0)] {
        let known = Known { rope: Some(rope), load: Some(load) };
        for drive in [&mut drive, &mut plain] {
            for _ in 0..1_000 {
                drive.tick(&CONFIG, &sample);
                drive.background(&CONFIG, &known);
            }
        }
        let [learned, design] = [&drive, &plain].map(|drive| drive.constants().observer);
        assert_eq!(learned.friction.share, 0.08);
        assert!((learned.observer.motor * 1.1 / design.observer.motor - 1.0).abs() < 1e-6, "{load} kg, {rope} m");
        assert_eq!((drive.rope(), drive.load()), (rope, f32::clamp(load, 400.0, 11_000.0)));
        assert_eq!(drive.constants().governor, plain.constants().governor);
    }
    // a gain and a ratio are stored less one
    let Learnt { friction, torque, inertia, eccentricity } = drive.learnt();
    assert_eq!((friction, torque[1], eccentricity), (learnt.friction, learnt.torque[1], learnt.eccentricity));
    assert!((torque[0] - learnt.torque[0]).abs() < 1e-7 && (inertia - learnt.inertia).abs() < 2e-7);
}

/// A record that was never written, or holds what cannot be, leaves the data sheet's values or the ends of the bounds.
#[test]
fn a_record_of_nonsense_leaves_the_design() {
    let mut drive = D::new(&CONFIG, 0);
    let fresh = drive.learnt();
    let nan = f32::NAN;
    for record in [Learnt::default(), Learnt { friction: nan, torque: [nan; 2], inertia: nan, eccentricity: [0; 2] }] {
        drive.restore(&CONFIG, &record);
        assert_eq!(drive.learnt(), fresh, "{record:?}");
    }
    let known = [Known { rope: Some(nan), load: Some(nan) }, Known { rope: Some(f32::INFINITY), load: Some(-1.0) }];
    for known in known {
        for _ in 0..500 {
            drive.tick(&CONFIG, &Sample::si::<M>(0, 0.0, 0.0));
            drive.background(&CONFIG, &known);
        }
        // the rope of the chain
        assert_eq!(drive.rope(), 8.0);
    }
}

/// The inertia of the exact step's constants against a design for the other motor, the gains apart. The step's
/// increments are of the first order: `(omega T)^2/12` of them at 28 rad/s and 0.25 ms.
#[test]
fn another_motor_changes_the_exact_step_as_its_design_does() {
    use driveline::adaptive::Adjust;
    use driveline::machine::Match;
    use driveline::observer::TwoMassConfig;
    use driveline::settings::Bases;
    let config = |motor: f64| {
        let mut two = M::CHAIN.reduce(Match::ResonanceAntiresonance);
        two.motor_inertia *= motor;
        TwoMassConfig::<f32>::new(&two.observer(M::RATE, M::ENCODER, M::DISTURBANCE), Bases::SI)
    };
    for motor in [0.8_f32, 1.25] {
        let (mut scaled, designed) = (config(1.0), config(motor.into()));
        scaled.scale_motor_inertia(motor);
        let pairs = [
            (scaled.forcing[0], designed.forcing[0]),
            (scaled.acceleration, designed.acceleration),
            (scaled.turn[1], designed.turn[1]),
            (scaled.share[0], designed.share[0]),
            (scaled.share[1], designed.share[1]),
            (scaled.twist[0], designed.twist[0]),
            (scaled.twist_rate[0], designed.twist_rate[0]),
            (scaled.twist_rate[1], designed.twist_rate[1]),
        ];
        for (k, (scaled, designed)) in pairs.into_iter().enumerate() {
            // the damping's part of n22 is of the first order in T
            let bound = if k == 7 { 1e-2 } else { 1e-4 };
            assert!((scaled / designed - 1.0).abs() < bound, "{motor}, {k}: {scaled} for {designed}");
        }
    }
}

/// Parts that are left out leave the drive's bits, whatever its samples.
#[test]
fn a_drive_without_schedule_and_learners_is_the_drive() {
    type Plain = Drive<Fixed, GearedObserver<TwoMassObserver>, SpeedLoop>;
    type Empty = Adaptive<M, Plain>;
    static PLAIN: ConfigOf<Plain> = Plain::configure::<M>();
    static EMPTY: ConfigOf<Empty> = Empty::configure();
    let (mut plain, mut empty, mut noise) = (Plain::new(&PLAIN, 0), Empty::new(&EMPTY, 0), Noise::new(3));
    let mut angle = 0.0;
    for tick in 0..20_000_u32 {
        angle += 1e-3 * (1.0 + 0.1 * noise.normal());
        let read = (angle * 4_294_967_296.0 / 6.3) as i64 as u32;
        let torque = if tick.is_multiple_of(997) { f32::NAN } else { 100.0 * noise.normal() as f32 };
        let sample = Sample::si::<M>(read, torque, 50.0);
        let (one, other) = if tick % 5_000 < 100 {
            (plain.hold(&PLAIN, read, sample.setpoint), empty.hold(&EMPTY, read, sample.setpoint))
        } else {
            (plain.tick(&PLAIN, &sample), empty.tick(&EMPTY, &sample))
        };
        assert_eq!((one, plain.estimate(&PLAIN)), (other, empty.estimate(&EMPTY)));
        empty.background(&EMPTY, &Known { rope: Some(3.0), load: Some(5.0) });
    }
    assert!(size_of::<Empty>() <= size_of::<Plain>() + size_of::<ConfigOf<Plain>>() + 32);
}
