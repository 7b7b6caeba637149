//! What goes wrong at the machine ends in a refusal with its reason, and stays within torque and travel on the way.

use core::f64::consts::TAU;
use std::io;

use driveline::commissioning::{Commissioning, Error, TestConfig, TestSettings};
use driveline_closed_loop::ticks::{OnHost, Ticks};
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::scenes::commission::{Commission, SPINDLE, reason};
use driveline_firmware::scenes::spindle::COUNTS;
use driveline_lab::commissioning::{Case, Course, named, on_host, run, verdict};
use driveline_solver::plant::{Chain, Plant, Shaft, Start};

/// Within the travel and half of rated torque, and torque on the motor only as much as was allowed.
fn bounded(case: &Case, course: &Course) {
    let settings = &case.settings;
    let name = &case.name;
    assert!(course.peak < 0.5 * case.rated_torque, "{name}: {} of rated", course.peak / case.rated_torque);
    for moment in &course.moments {
        // Six deviations of the noise: once in 500 million ticks.
        let most = settings.torque + 6.0 * case.torque_noise;
        assert!((moment.torque - settings.held).abs() <= most || moment.stage == 6, "{name}: {moment:?}");
        // A tick past the bound, at most.
        assert!(moment.angle.abs() < 1.01 * settings.travel || moment.stage == 6, "{name}: {moment:?}");
    }
}

fn refused(case: &Case, seed: u64) -> Option<Error> {
    let course = on_host(case, seed).unwrap();
    assert!(course.figures.is_none(), "{}", case.name);
    bounded(case, &course);
    reason(course.reasons[0])
}

fn with_plant(name: &str, plant: Plant) -> Case {
    Case { plant, ..named(name).unwrap() }
}

/// A load that friction holds against ten times the rated torque.
fn seized(name: &str) -> Case {
    let friction = 10.0 * named(name).unwrap().rated_torque;
    let chain = match name {
        "spindle" => Chain::motor(0.012).shaft(Shaft::elastic(7.6e4).damping(0.3), 0.004),
        _ => Chain::motor(1.1e5)
            .shaft(Shaft::elastic(1.2e9).damping(3.0e5), 1.0e4)
            .shaft(Shaft::elastic(2.2e8).damping(1.0e5).gap(0.010), 2.2e4),
    };
    with_plant(name, chain.coulomb(friction).start(Start::Rest).build().unwrap())
}

#[test]
fn a_load_that_is_seized() {
    for name in ["spindle", "mill"] {
        for seed in [1, 3, 5, 7] {
            assert_eq!(refused(&seized(name), seed), Some(Error::NotFollowed), "{name}");
        }
    }
}

#[test]
fn a_torque_that_cannot_move_the_machine() {
    let mut weak = named("mill").unwrap();
    // The bearings hold 5 % of rated.
    weak.settings.torque = 0.04 * weak.rated_torque;
    assert_eq!(refused(&weak, 1), Some(Error::NotFollowed));
}

/// An encoder that counts the other way.
struct Negated(OnHost<Commission>);

impl Ticks for Negated {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        self.0.tick(&Input { angle: input.angle.wrapping_neg(), ..*input })
    }
}

#[test]
fn an_encoder_that_counts_the_other_way() {
    for name in ["hoist", "mill", "spindle"] {
        let case = named(name).unwrap();
        let config: &'static TestConfig = Box::leak(Box::new(TestConfig::try_new(&case.settings).unwrap()));
        let course = run(&case, 1, &mut Negated(OnHost(Commission::of(config)))).unwrap();
        bounded(&case, &course);
        let told = reason(course.reasons[0]);
        assert!(matches!(told, Some(Error::NotFollowed | Error::AngleJump)), "{name}: {told:?}");
    }
}

#[test]
fn a_first_guess_of_the_inertia_that_is_off_by_two() {
    for name in ["hoist", "spindle"] {
        for factor in [0.5, 2.0] {
            let mut case = named(name).unwrap();
            case.settings.inertia *= factor;
            let course = on_host(&case, 1).unwrap();
            bounded(&case, &course);
            let verdict = verdict(&case, &course);
            assert!(verdict.meets(), "{name}, {factor}: {verdict:?}");
        }
    }
}

#[test]
fn a_first_guess_that_is_off_by_twenty() {
    for (name, factor) in [("hoist", 0.05), ("hoist", 20.0), ("spindle", 0.05), ("spindle", 20.0)] {
        let mut case = named(name).unwrap();
        case.settings.inertia *= factor;
        let course = on_host(&case, 1).unwrap();
        bounded(&case, &course);
        // Either a reason, or an answer that is right all the same.
        let verdict = verdict(&case, &course);
        assert!(verdict.refused.is_some() || verdict.meets(), "{name}, {factor}: {verdict:?}");
    }
}

#[test]
fn settings_that_are_no_numbers() {
    let fields: [fn(&mut TestSettings) -> &mut f64; 10] = [
        |s| &mut s.torque,
        |s| &mut s.shaft_torque,
        |s| &mut s.speed,
        |s| &mut s.travel,
        |s| &mut s.held,
        |s| &mut s.inertia,
        |s| &mut s.band[0],
        |s| &mut s.band[1],
        |s| &mut s.torque_accuracy,
        |s| &mut s.delay,
    ];
    for (place, field) in fields.into_iter().enumerate() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -f64::MAX] {
            let mut settings = SPINDLE;
            *field(&mut settings) = value;
            // A load may pull either way: -1 N m is held as well as 1.
            let allowed = place == 4 && value == -1.0;
            assert_eq!(TestConfig::try_new(&settings).is_ok(), allowed, "{place}, {value}");
        }
        // The largest and the least: a reason, or a test that gives no torque beyond its bounds.
        for value in [f64::MIN_POSITIVE, 1.0e-12, 1.0e12, f64::MAX] {
            let mut settings = SPINDLE;
            *field(&mut settings) = value;
            let Ok(config) = TestConfig::try_new(&settings) else { continue };
            let mut test = Commissioning::<24>::new(&config);
            for tick in 0..20_000_u32 {
                let torque = test.tick(&config, tick.wrapping_mul(40_000));
                let most = settings.torque.min(settings.shaft_torque) as f32;
                assert!((torque - settings.held as f32).abs() <= most || torque == 0.0, "{place}, {value}: {torque}");
                if let Some(job) = test.job() {
                    let findings = job.solve(&config);
                    test.accept(&config, findings);
                }
            }
        }
    }
}

/// What breaks while the test runs.
#[derive(Clone, Copy, Debug)]
enum Broken {
    /// The encoder gives the same angle for ever.
    Frozen,
    /// The encoder counts the other way.
    Reversed,
    /// The motor is stopped and held.
    Seized,
    /// The torque has no effect, friction brings the motor to rest.
    Cut,
}

/// A rigid spindle on which something breaks at a tick; the answer, and ticks from then on.
fn broken(config: &TestConfig, what: Broken, at: u32) -> (Option<Error>, u32) {
    let settings = config.settings();
    let (inertia, drag, period) = (0.016, 0.05, 1.0e-4);
    let (mut angle, mut speed, mut shown, mut offset) = (0.0_f64, 0.0_f64, 0_u32, 0_u32);
    let mut test = Commissioning::<24>::new(config);
    for tick in 0..at + 400_000 {
        let fault = (tick >= at).then_some(what);
        let count = (angle / TAU * f64::from(COUNTS)).floor() as i64 as u32;
        let read = count.wrapping_mul(u32::MAX / COUNTS + 1);
        if tick == at {
            offset = read.wrapping_mul(2);
        }
        shown = match fault {
            Some(Broken::Frozen) => shown,
            // The same where it breaks.
            Some(Broken::Reversed) => offset.wrapping_sub(read),
            _ => read,
        };
        let torque = test.tick(config, shown);
        assert!(torque.abs() <= settings.torque as f32, "{what:?} at {at}: {torque}");
        if let Some(job) = test.job() {
            let findings = job.solve(config);
            test.accept(config, findings);
        }
        if let Some(outcome) = test.outcome() {
            return (outcome.err(), tick.saturating_sub(at));
        }
        let pushed = if let Some(Broken::Cut) = fault { 0.0 } else { f64::from(torque) };
        speed += period / inertia * (pushed - drag * speed);
        if let Some(Broken::Seized) = fault {
            speed = 0.0;
        }
        angle += period * speed;
    }
    (None, u32::MAX)
}

#[test]
fn what_breaks_on_the_way() {
    let config = TestConfig::try_new(&SPINDLE).unwrap();
    // Through every stage: the test of this machine, which has no resonance, ends after 10 s.
    for at in (0..14).map(|k| 1 + 7_001 * k) {
        for what in [Broken::Frozen, Broken::Reversed, Broken::Seized, Broken::Cut] {
            let (reason, ticks) = broken(&config, what, at);
            assert_eq!(reason, Some(Error::NotFollowed), "{what:?} at {at}");
            // The lag is half of 17.5 N m over 0.012 kg m2 (209/s)^2: 17 mrad, which takes a tick at 200 rad/s and 600
            // for a reference that starts with 100 rad/s2, a quarter of the ramps'.
            assert!(ticks < 1_000, "{what:?} at {at}: {ticks}");
        }
    }
}
