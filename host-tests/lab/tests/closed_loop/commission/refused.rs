//! What the data do not support is refused, with the reason.

use driveline::commissioning::{Commissioning, Error, Stage, TestConfig, TestSettings};
use driveline::design::{Encoder, Rate};
use driveline_firmware::scenes::commission::{SPINDLE, reason};
use driveline_lab::commissioning::{Case, Course, named, on_host};
use driveline_solver::plant::{Chain, Shaft};

fn run(case: &Case) -> Course {
    on_host(case, 1).unwrap()
}

/// The spindle with another plant.
fn spindle(chain: Chain) -> Case {
    Case { plant: chain.build().unwrap(), ..named("spindle").unwrap() }
}

fn refused(case: &Case) -> Option<Error> {
    let course = run(case);
    assert!(course.figures.is_none());
    // Bounded all the same: within half of rated.
    assert!(course.peak < 0.5 * case.rated_torque, "{}", course.peak);
    reason(course.reasons[0])
}

#[test]
fn a_shaft_that_the_servo_swings() {
    // The README's machine, with a damping ratio of 0.4 %: a band that begins at 0.4 of its antiresonance takes 0.5 %.
    let (inertia, load, stiffness, rated) = (0.35, 0.48, 2.0e4, 275.0);
    let case = |band| {
        let chain = Chain::motor(inertia).shaft(Shaft::elastic(stiffness).damping(0.5), load);
        let settings = TestSettings {
            rate: Rate::hz(10_000),
            encoder: Encoder::lines(2048),
            torque: 0.4 * rated,
            shaft_torque: 0.5 * rated,
            speed: 30.0,
            travel: 1.0e4,
            held: 0.0,
            inertia,
            band,
            torque_accuracy: 3.0,
            delay: 0.0,
        };
        let (eccentricity, counts, torque_noise) = ([0.0; 2], 8192, 3.0);
        Case { settings, eccentricity, counts, torque_noise, rated_torque: rated, ..spindle(chain) }
    };
    // The bound is half of rated; the watch sees this resonance at half of its size, and the encoder's counts add 12 %.
    // It sees more of it where more inertia is guessed.
    for guess in [1.0, 1.5, 2.0] {
        let mut case = case([13.0, 125.0]);
        case.settings.inertia *= guess;
        let course = run(&case);
        assert_eq!(reason(course.reasons[0]), Some(Error::Unsteady), "{guess}");
        assert!(course.peak < 1.2 * rated, "{guess}: {}", course.peak);
    }
    // from a fifth of the antiresonance on
    let low = run(&case([0.2 * (stiffness / load).sqrt() / core::f64::consts::TAU, 125.0]));
    assert!(low.figures.is_some() && low.peak < 0.5 * rated, "{}", low.peak);
}

#[test]
fn a_rigid_machine() {
    // Its resonance lies at 8 kHz: the response in the band, to 1 kHz, differs from a rigid one's by 1.6 % at most.
    let rigid = spindle(Chain::motor(0.012).shaft(Shaft::elastic(7.6e6).damping(3.0), 0.004));
    assert_eq!(refused(&rigid), Some(Error::Rigid));
}

#[test]
fn a_resonance_beyond_the_band() {
    // At 1.1 kHz, where the band ends at 1 kHz: seen, but not to be told.
    let beyond = spindle(Chain::motor(0.012).shaft(Shaft::elastic(1.433e5).damping(0.3), 0.004));
    let reason = refused(&beyond);
    assert!(matches!(reason, Some(Error::ResonanceOutside | Error::ResonanceUnclear | Error::Rigid)), "{reason:?}");
}

#[test]
fn too_little_torque() {
    let mut weak = named("spindle").unwrap();
    // A thousandth: 0.035 N m, where the torque itself is off by 0.7 N m in every tick.
    weak.settings.shaft_torque *= 1.0e-3;
    // So small a torque also means ramps of minutes, whose way is beyond any travel: which bound is met first is not
    // the point.
    assert!(refused(&weak).is_some());
}

#[test]
fn too_little_travel() {
    let mut short = named("hoist").unwrap();
    // 120 rad: room for the friction's test, none for a record of 20 s at 12 rad/s.
    short.settings.travel = 120.0;
    let reason = refused(&short);
    assert!(matches!(reason, Some(Error::Travel | Error::TravelTooShort | Error::TravelExceeded)), "{reason:?}");
}

#[test]
fn a_load_that_the_first_torque_does_not_hold() {
    let mut falling = named("hoist").unwrap();
    // The load falls with 340 N m more than its weight: three times the test's speed within a tenth of a second.
    falling.settings.held = -150.0;
    falling.settings.travel = 20.0;
    assert_eq!(refused(&falling), Some(Error::AngleJump));
}

#[test]
fn a_gap_below_the_resolution() {
    let mut tight = named("mill").unwrap();
    // 0.05 mrad, where a count is 0.19 mrad.
    let chain = Chain::motor(1.1e5)
        .shaft(Shaft::elastic(1.2e9).damping(3.0e5), 1.0e4)
        .shaft(Shaft::elastic(2.2e8).damping(1.0e5).gap(5.0e-5), 2.2e4)
        .coulomb(67.0e3);
    tight.plant = chain.build().unwrap();
    let course = run(&tight);
    assert!(course.figures.is_some());
    assert_eq!(reason(course.reasons[1]), Some(Error::GapBelowResolution));
}

#[test]
fn gaps_that_nothing_shows() {
    // A weight presses the hoist's shut; nothing holds the spindle's load.
    for (name, expected) in [("hoist", Error::Preloaded), ("spindle", Error::LoadNotHeld)] {
        let course = run(&named(name).unwrap());
        assert_eq!(reason(course.reasons[1]), Some(expected), "{name}");
    }
}

#[test]
fn an_encoder_that_jumps() {
    let config = TestConfig::try_new(&SPINDLE).unwrap();
    let mut test = Commissioning::<24>::new(&config);
    for _ in 0..100 {
        assert!(test.tick(&config, 7).abs() < 1.0e-3);
    }
    // A quarter turn in a tick would be 15,700 rad/s.
    assert_eq!(test.tick(&config, 1 << 30), 0.0);
    assert_eq!(test.stage(), Stage::Refused);
    assert_eq!(test.outcome(), Some(Err(Error::AngleJump)));
    // It stays refused, without torque.
    for tick in 0..1000_u32 {
        assert_eq!(test.tick(&config, tick << 20), 0.0);
    }
}

#[test]
fn a_first_reason_that_stands() {
    let config = TestConfig::try_new(&SPINDLE).unwrap();
    let mut test = Commissioning::<24>::new(&config);
    // A motor that stands still under any torque does not follow.
    while test.outcome().is_none() {
        test.tick(&config, 7);
    }
    assert_eq!(test.outcome(), Some(Err(Error::NotFollowed)));
    // What turns it then, as a load that falls before its brake is closed, is no other reason.
    for tick in 1..1000_u32 {
        assert_eq!(test.tick(&config, tick << 24), 0.0);
    }
    assert_eq!(test.outcome(), Some(Err(Error::NotFollowed)));
}

#[test]
fn settings_out_of_range() {
    let with = |change: &dyn Fn(&mut TestSettings)| {
        let mut settings = SPINDLE;
        change(&mut settings);
        TestConfig::try_new(&settings).unwrap_err()
    };
    assert_eq!(with(&|s| s.rate = Rate::hz(0)), Error::Rate);
    assert_eq!(with(&|s| s.encoder = Encoder::lines(0)), Error::EncoderLines);
    assert_eq!(with(&|s| s.encoder = Encoder::lines(1 << 30)), Error::EncoderCounts);
    assert_eq!(with(&|s| s.encoder = Encoder::lines(2048).eccentricity(-1e-3)), Error::EncoderAccuracy);
    assert_eq!(with(&|s| s.torque = -1.0), Error::Torque);
    assert_eq!(with(&|s| s.held = f64::NAN), Error::Held);
    assert_eq!(with(&|s| s.held = 40.0), Error::ShaftTorque);
    assert_eq!(with(&|s| s.speed = 0.0), Error::Speed);
    assert_eq!(with(&|s| s.travel = f64::INFINITY), Error::Travel);
    assert_eq!(with(&|s| s.inertia = 0.0), Error::Inertia);
    assert_eq!(with(&|s| s.band = [1_000.0, 200.0]), Error::Band);
    assert_eq!(with(&|s| s.band = [200.0, 1_001.0]), Error::Band);
    assert_eq!(with(&|s| s.torque_accuracy = 0.0), Error::TorqueAccuracy);
    assert_eq!(with(&|s| s.delay = -1.0), Error::Delay);
    // what `f64` holds and the tick's `f32` does not: infinite from the first tick on
    assert_eq!(with(&|s| (s.held, s.shaft_torque) = (1.0e39, 2.0e39)), Error::Held);
    assert_eq!(with(&|s| s.shaft_torque = 1.0e39), Error::ShaftTorque);
    assert_eq!(with(&|s| s.torque = 1.0e39), Error::Torque);
    assert_eq!(with(&|s| s.inertia = 1.0e-40), Error::Inertia);
    assert!(Error::ALL.iter().all(|reason| reason.message().len() > 20));
}
