//! In-run balancing of one plane by one reading, move by move: each weight is computed by hand from the rule that the
//! text states for it.

use driveline::balancing::{AbortReason, Action, Complex, Error, InRun, InRunConfig, Influence};

type One = InRun<f64, 1, 1>;

const CONFIG: InRunConfig<f64, 1> =
    InRunConfig { probe: 1.0, limits: [100.0], step: 100.0, bound: 1.5, target: 0.05, forgetting: 1.0, noise: 0.01 };

const fn re(re: f64) -> Complex<f64> {
    Complex { re, im: 0.0 }
}

/// A new run of a head that stands at `weight`.
fn begun(config: InRunConfig<f64, 1>, weight: f64) -> One {
    One::new(config, 1, [re(weight)]).unwrap()
}

fn set(action: Action<f64, 1>) -> Complex<f64> {
    match action {
        Action::Set([weight]) => weight,
        other => panic!("{other:?}"),
    }
}

/// Readings of 10 at rest: four of them, after which the head moves.
fn probed(mut run: One) -> (One, Complex<f64>) {
    let rest = run.weights()[0];
    for _ in 0..3 {
        assert_eq!(set(run.advise(&[re(10.0)], 0.0)), rest);
    }
    let to = set(run.advise(&[re(10.0)], 0.0));
    (run, to)
}

/// A weight of one changes the vibration by half of it at most; the largest influence is taken as 0.95 of that, 4.75.
/// The first move may raise the vibration to 0.93 of the bound, 13.95: by 3.95/4.75.
#[test]
fn the_probe() {
    let probe = 3.95 / 4.75;
    let (run, to) = probed(begun(CONFIG, 0.0));
    assert!((to - re(probe)).norm_sqr() < 1e-24, "{to}");
    assert_eq!(run.influence(0, 0), (re(0.0), 4.75 / 4.0));
    assert_eq!(run.level(), Some(1.0));
    // from where the head stands, and no farther than a step or the head's limit
    for (config, rest, expected) in [
        (CONFIG, 0.5, 0.5 + probe),
        (InRunConfig { step: 0.3, ..CONFIG }, 0.5, 0.8),
        (InRunConfig { limits: [0.9], ..CONFIG }, 0.5, 0.9),
        (InRunConfig { limits: [0.9], step: 0.3, ..CONFIG }, 0.5, 0.8),
        (InRunConfig { probe: 0.5, ..CONFIG }, 0.0, probe / 2.0),
        // 0.93 of 2 is 1.86: by 8.6 of an influence of 9.5
        (InRunConfig { bound: 2.0, ..CONFIG }, 0.0, 8.6 / 9.5),
    ] {
        let (_, to) = probed(begun(config, rest));
        assert!((to - re(expected)).norm_sqr() < 1e-24, "{config:?} {to}");
    }
}

/// The reading after the probe, of a machine with this influence, and the action.
fn after_probe(influence: Complex<f64>) -> (One, Complex<f64>, Action<f64, 1>) {
    let (mut run, probe) = probed(begun(CONFIG, 0.0));
    let reading = re(10.0) + influence * probe;
    let action = run.advise(&[reading], 0.0);
    (run, probe, action)
}

/// The variance of the reading at rest, of the noise 0.1 and a walk of a tenth of its square each time, by the scalar
/// filter; then the gain of the influence. The second move is on the other side of where it began, as far as the
/// influence of then allows.
#[test]
fn the_second_move_is_on_the_other_side() {
    let (run, probe, action) = after_probe(Complex { re: 1.0, im: 2.0 });
    let noise = 0.01;
    let mut variance = noise;
    for _ in 0..3 {
        let predicted = variance + 0.1 * noise;
        variance = predicted * noise / (predicted + noise);
    }
    let prior = (4.75 / 4.0_f64).powi(2);
    let cross = prior * probe.re;
    let spread = variance + prior * probe.re * probe.re + 0.1 * noise + noise;
    let change = Complex { re: 1.0, im: 2.0 } * probe;
    // the filtered reading at rest is 10, as all of them were
    let influence = change.scale(cross / spread);
    let deviation = (prior - cross * cross / spread).sqrt();
    let found = run.influence(0, 0);
    assert!((found.0 - influence).norm_sqr() < 1e-20 && (found.1 - deviation).abs() < 1e-10, "{found:?} {influence}");
    // 3.95 over the largest influence, in the other direction, and back to the start first
    let most = influence.norm_sqr().sqrt() + 4.0 * deviation;
    let to = set(action);
    assert!((to + re(3.95 / most)).norm_sqr() < 1e-16, "{to} {}", 3.95 / most);
    let level = (re(10.0) + change).norm_sqr().sqrt() / 10.0;
    // roundings of two squares, their sum and a root
    assert!((run.level().unwrap() - level).abs() < 4.0 * f64::EPSILON, "{:?} {level}", run.level());
}

/// An exact machine is balanced within a few moves, each of which stays within the bound. None goes farther from where it
/// began than 2.5 times what was read, or 0.6 of it over the relative uncertainty of the influence; nor than a head's
/// limit.
#[test]
fn an_exact_machine_is_balanced() {
    let (limited, aside) = (InRunConfig { limits: [9.0], ..CONFIG }, Complex { re: 0.5, im: -0.3 });
    for (config, rest, a) in [
        (CONFIG, re(0.0), re(1.5)),
        (CONFIG, re(0.0), re(-1.5)),
        (CONFIG, re(0.0), Complex { re: 0.6, im: -1.2 }),
        (CONFIG, re(0.0), Complex { re: 0.0, im: 1.8 }),
        (limited, aside, re(1.5)),
        (limited, aside, Complex { re: -0.9, im: 1.2 }),
        (limited, aside, Complex { re: 0.0, im: -1.8 }),
    ] {
        let mut run = One::new(config, 1, [rest]).unwrap();
        let (mut reach, mut moves) = (0.0_f64, 0);
        loop {
            let weight = run.weights()[0];
            reach = reach.max((weight - rest).norm_sqr().sqrt());
            let reading = re(10.0) + a * (weight - rest);
            assert!(reading.norm_sqr().sqrt() < 15.0, "{a}: {weight}");
            match run.advise(&[reading], 0.0) {
                Action::Set([to]) => {
                    let (influence, deviation) = run.influence(0, 0);
                    let growth = 2.5_f64.max(0.6 * influence.norm_sqr().sqrt() / deviation);
                    let far = (to - rest).norm_sqr().sqrt();
                    assert!(reach == 0.0 || far <= growth * reach * (1.0 + 1e-9), "{a}: {to}");
                    assert!(to.norm_sqr().sqrt() <= config.limits[0] + 1e-9);
                    moves += 1;
                    // three at rest, two probes, and corrections that grow 2.5-fold until they reach it
                    assert!(moves <= 12, "{a}: no end at {to}");
                }
                Action::Hold => {
                    assert!(reading.norm_sqr().sqrt() <= 0.5, "{a}: {reading}");
                    break;
                }
                other => panic!("{other:?}"),
            }
        }
    }
}

/// Without a reading: back to where it began, and the next reading is taken.
#[test]
fn a_reading_that_is_none() {
    let (mut run, _) = probed(begun(CONFIG, 0.5));
    for reading in [&[][..], &[re(f64::NAN)], &[re(f64::INFINITY)], &[Complex { re: 1.0, im: f64::NAN }]] {
        assert_eq!(run.advise(reading, 0.0), Action::Abort([re(0.5)], AbortReason::NoReading));
    }
    set(run.advise(&[re(10.5)], 0.0));
    // of two rows each counts
    let mut run = InRun::<f64, 3, 1>::new(CONFIG, 2, [re(0.0)]).unwrap();
    for (reading, is_right) in [
        ([re(1.0), re(1.0), re(f64::NAN)], true),
        ([re(1.0), re(f64::NAN), re(1.0)], false),
        ([re(f64::NAN), re(1.0), re(1.0)], false),
    ] {
        let none = Action::Abort([re(0.0)], AbortReason::NoReading);
        assert_eq!(run.advise(&reading, 0.0) != none, is_right);
    }
    assert_eq!(run.advise(&[re(1.0)], 0.0), Action::Abort([re(0.0)], AbortReason::NoReading));
}

/// A vibration above the bound right after the probe: that is more than the probe could do.
#[test]
fn a_vibration_above_its_bound() {
    let (mut run, _, action) = after_probe(re(8.0));
    assert_eq!(action, Action::Abort([re(0.0)], AbortReason::Diverging));
    // and it stays aborted
    assert_eq!(run.advise(&[re(1.0)], 0.0), Action::Abort([re(0.0)], AbortReason::Diverging));
    assert_eq!(run.advise_at(&[re(1.0)], 0.0, 50.0), Action::Abort([re(0.0)], AbortReason::Diverging));
    run.resume(&[re(0.0)]);
    set(run.advise(&[re(10.0)], 0.0));
    assert_eq!(run.level(), Some(1.0));
}

/// At the target it holds at once: 5 % of 10.
#[test]
fn within_the_target() {
    for (reading, holds) in [(0.49, true), (0.51, false)] {
        let (mut run, _, _) = after_probe(re(-1.5));
        let action = run.advise(&[re(reading)], 0.0);
        assert_eq!(action == Action::Hold, holds, "{reading} {action:?}");
    }
}

/// A reading as predicted is used at any speed; beyond 5 % of the speed before it an unexpected one is not, nor is one
/// without a speed. A first one that was off is forgotten, and a speed that stays is used. Nine in a row that are not
/// used stall it.
#[test]
fn readings_of_one_speed() {
    for (speed, reading, used) in [
        (52.49, 10.0, true),
        (47.51, 10.0, true),
        (60.0, 10.0, true),
        (60.0, 12.0, false),
        (40.0, 12.0, false),
        (f64::NAN, 12.0, false),
    ] {
        let mut run = begun(CONFIG, 0.5);
        set(run.advise_at(&[re(10.0)], 0.0, 50.0));
        // at rest three readings that are used make the next one move
        set(run.advise_at(&[re(10.0)], 0.0, 50.0));
        set(run.advise_at(&[re(reading)], 0.0, speed));
        let moves = set(run.advise_at(&[re(10.0)], 0.0, 50.0)) != re(0.5);
        assert_eq!(moves, used, "{speed} {reading}");
    }
    // a first one without a speed is none
    let mut run = begun(CONFIG, 0.5);
    set(run.advise_at(&[re(10.0)], 0.0, f64::NAN));
    set(run.advise_at(&[re(10.0)], 0.0, 50.0));
    assert_eq!(run.level(), Some(1.0));
    let mut run = begun(CONFIG, 0.5);
    set(run.advise_at(&[re(10.0)], 0.0, 50.0));
    assert!((0..5).any(|_| set(run.advise_at(&[re(10.7)], 0.0, 60.0)) != re(0.5)));
    let mut run = begun(CONFIG, 0.5);
    set(run.advise_at(&[re(10.0)], 0.0, 50.0));
    for speed in [60.0, 40.0].repeat(4) {
        assert_eq!(run.advise_at(&[re(12.0)], 0.0, speed), Action::Set([re(0.5)]));
    }
    assert_eq!(run.advise_at(&[re(12.0)], 0.0, 60.0), Action::Abort([re(0.5)], AbortReason::Stalled));
    assert_eq!(run.advise_at(&[re(12.0)], 0.0, 40.0), Action::Abort([re(0.5)], AbortReason::Stalled));
}

/// Each setting that cannot be is named by its place.
#[test]
fn settings_that_cannot_be() {
    type Change = fn(&mut InRunConfig<f64, 1>, f64);
    let changes: [Change; 7] = [
        |config, value| config.probe = value,
        |config, value| config.limits = [value],
        |config, value| config.step = value,
        |config, value| config.bound = value,
        |config, value| config.target = value,
        |config, value| config.forgetting = value,
        |config, value| config.noise = value,
    ];
    for (index, change) in changes.iter().enumerate() {
        let most = [f64::MAX, f64::MAX, f64::MAX, f64::MAX, 1.0 - 1e-9, 1.0, 1.0 - 1e-9][index];
        let least = if index == 3 { 1.0 } else { 0.0 };
        let beyond = if index > 3 { 1.0 + 1e-9 } else { f64::INFINITY };
        for (value, is_right) in
            [(most, true), (least + 1e-9, true), (least, false), (-1.0, false), (beyond, false), (f64::NAN, false)]
        {
            let mut config = CONFIG;
            change(&mut config, value);
            let made = One::new(config, 1, [re(0.0)]);
            assert_eq!(made.err(), (!is_right).then_some(Error::Setting { index }), "{index} {value}");
        }
    }
    for (index, value) in [(4, 1.0), (6, 1.0)] {
        let mut config = CONFIG;
        changes[index](&mut config, value);
        assert_eq!(One::new(config, 1, [re(0.0)]).err(), Some(Error::Setting { index }));
    }
    assert_eq!(One::new(CONFIG, 0, [re(0.0)]).err(), Some(Error::Size));
    assert_eq!(One::new(CONFIG, 2, [re(0.0)]).err(), Some(Error::Size));
    assert!(One::new(CONFIG, 1, [re(0.0)]).is_ok());
    let mut model = Influence::<f64, 1, 1>::new(1, 1).unwrap();
    assert_eq!(begun(CONFIG, 0.0).with_model(&model, 0.1).err(), Some(Error::PlaneUnknown { plane: 0 }));
    model.set(0, &[re(-2.0)]).unwrap();
    for share in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(begun(CONFIG, 0.0).with_model(&model, share).err(), Some(Error::Setting { index: 0 }));
    }
}

/// With a model known to a tenth the first reading brings the correction: the change of the least expected square is
/// `10/(2 (1 + 0.1^2))`, and four deviations of it, 0.4 of the change, leave the vibration below 10.
#[test]
fn a_model_corrects_at_once() {
    let mut model = Influence::<f64, 1, 1>::new(1, 1).unwrap();
    model.set(0, &[re(-2.0)]).unwrap();
    let run = || begun(CONFIG, 0.0).with_model(&model, 0.1).unwrap();
    let cautious = 10.0 / (2.0 * 1.01);
    let to = set(run().advise(&[re(10.0)], 0.0));
    assert!((to - re(cautious)).norm_sqr() < 1e-24, "{to}");
    // a machine as modelled is at its target then: what is left is a hundredth
    let mut exact = run();
    set(exact.advise(&[re(10.0)], 0.0));
    assert_eq!(exact.advise(&[re(10.0 - 2.0 * cautious)], 0.0), Action::Hold);
    // installed elsewhere: the next move is from there
    let mut other = run();
    set(other.advise(&[re(10.0)], 0.0));
    other.installed(&[re(2.0)]);
    assert_eq!(other.weights()[0], re(2.0));
    let next = set(other.advise(&[re(6.0)], 0.0));
    assert!((next - re(5.0)).norm_sqr().sqrt() < 0.05, "{next}");
}

/// A head that stands still while the reading changes by itself: 0.7 of the change over the larger reading is 0.08 from
/// 7/0.62 = 11.29 on, which is too much to begin.
#[test]
fn readings_that_change_by_themselves() {
    for (reading, goes_on) in [(11.28, true), (11.30, false)] {
        let mut run = begun(CONFIG, 0.5);
        set(run.advise(&[re(10.0)], 0.0));
        let action = run.advise(&[re(reading)], 0.0);
        let expected = if goes_on { Action::Set([re(0.5)]) } else { abandoned() };
        assert_eq!(action, expected, "{reading}");
    }
    // 10.5 after 10: 0.35/10.5 = 1/30. The variance of the reading is 0.01 and 0.001 of its walk, so 0.011/0.021 of the
    // change is taken over: 10.2619. Of the next change counts 0.7 again, its square with 0.35 beside 0.65 of the first
    // one's: 0.08 at 0.1274 of the reading, which is 12.544.
    for (reading, goes_on) in [(12.53, true), (12.56, false)] {
        let mut run = begun(CONFIG, 0.5);
        set(run.advise(&[re(10.0)], 0.0));
        set(run.advise(&[re(10.5)], 0.0));
        let action = run.advise(&[re(reading)], 0.0);
        let expected = if goes_on { Action::Set([re(0.5)]) } else { abandoned() };
        assert_eq!(action, expected, "{reading}");
    }
}

fn abandoned() -> Action<f64, 1> {
    Action::Abort([re(0.5)], AbortReason::Unidentified)
}

/// Begun again, the head stands still for five further readings. Where the largest safe move, 0.395 of the vibration,
/// is less than 2.5 errors of a reading, 1 % of the very first one's 10, it holds: below 0.633.
#[test]
fn begun_again() {
    let (aborted, _, action) = after_probe(re(8.0));
    assert!(matches!(action, Action::Abort(..)));
    let mut run = aborted;
    run.resume(&[re(0.3)]);
    for _ in 0..5 {
        assert_eq!(set(run.advise(&[re(10.0)], 0.0)), re(0.3));
    }
    let to = set(run.advise(&[re(10.0)], 0.0));
    // the influence was not confirmed, and is not known any more
    assert!((to - re(0.3 + 3.95 / 4.75)).norm_sqr() < 1e-20, "{to}");
    for (reading, holds) in [(0.51, true), (0.62, true), (0.65, false)] {
        let mut run = aborted;
        run.resume(&[re(0.3)]);
        set(run.advise(&[re(reading)], 0.0));
        let expected = if holds { Action::Hold } else { Action::Set([re(0.3)]) };
        assert_eq!(run.advise(&[re(reading)], 0.0), expected, "{reading}");
    }
    // a first run does not hold for that: its first reading is what it is judged by
    let mut run = begun(CONFIG, 0.3);
    set(run.advise(&[re(0.62)], 0.0));
    assert_eq!(set(run.advise(&[re(0.62)], 0.0)), re(0.3));
}
