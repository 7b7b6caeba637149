//! Single steps of in-run balancing of one or two planes, from states made by hand.

use super::*;
use crate::balancing::scalar::noise::Noise;

type One = InRun<f64, 1, 1>;
type Two = InRun<f64, 2, 2>;

const CONFIG: InRunConfig<f64, 1> =
    InRunConfig { probe: 1.0, limits: [100.0], step: 100.0, bound: 2.0, target: 0.1, forgetting: 1.0, noise: 0.01 };

const fn re(re: f64) -> Complex<f64> {
    Complex { re, im: 0.0 }
}

/// A run whose head began at zero with a reading of one, and stands there; its influence is known to a share, and
/// confirmed where that is below a fifth.
fn known(influence: f64, share: f64) -> One {
    let mut model = Influence::<f64, 1, 1>::new(1, 1).unwrap();
    model.set(0, &[re(influence)]).unwrap();
    let mut run = One::new(CONFIG, 1, [re(0.0)]).unwrap().with_model(&model, share).unwrap();
    run.estimate.restart(&[re(1.0)], 0.0);
    if share > 0.2 {
        run.estimate.doubt(1.0);
    }
    (run.start, run.level, run.first, run.best) = (Some(1.0), 1.0, 1.0, (1.0, [re(0.0)]));
    run
}

/// The same after a move to a weight.
fn moved(influence: f64, share: f64, weight: f64) -> One {
    let mut run = known(influence, share);
    run.installed(&[re(weight)]);
    run
}

/// The same with a reading taken in, of the vibration after the move; the level that it began with.
fn learnt(run: &mut One, reading: f64, noise: f64) -> f64 {
    run.learn(&[re(reading)], reading.abs(), 1.0, noise)
}

fn near(found: f64, expected: f64) -> bool {
    // some operations on numbers of the order of one
    (found - expected).abs() < 1e-14
}

/// The standard deviation of the reading's estimate.
fn deviation(run: &One) -> f64 {
    run.estimate.innovation(&[re(0.0)], 0.0).predicted
}

#[test]
fn home_is_the_best_where_it_is_better_beyond_doubt() {
    let home = |start: f64, best: f64, scatter: f64, level: f64| {
        let mut run = known(1.0, 0.1);
        (run.start, run.best, run.scatter, run.level) = (Some(start), (best, [re(7.0)]), scatter, level);
        run.home() == [re(7.0)]
    };
    // below seven tenths of the start
    assert!(home(1.0, 0.69, 0.0, 1.0) && !home(1.0, 0.7, 0.0, 1.0));
    // while the readings change by themselves by no more than 0.08 of the start: 0.05, 0.15 of 2, not 0.17 of 2
    assert!(home(1.0, 0.1, 0.1, 0.5) && home(2.0, 0.1, 0.1, 1.5) && !home(2.0, 0.1, 0.1, 1.7));
}

/// The influence of -0.5 foresees 0.5 after a weight of one, with a deviation of 0.05: what is beyond 0.2 of it is a
/// surprise. The move was wrong where that is more than half of the foreseen change, and the vibration not much less.
#[test]
fn a_surprise_is_a_wrong_influence_or_a_jump() {
    let after = |reading: f64, level: f64| {
        let mut run = moved(-0.5, 0.1, 1.0);
        (run.level, run.best) = (level, (0.6, [re(1.0)]));
        let start = learnt(&mut run, reading, 1e-6);
        (run, start)
    };
    for (reading, level, wrong) in [
        (1.0, 1.0, true),
        // by 0.22: more than four deviations, less than half of the change
        (0.72, 1.0, false),
        (0.72, 0.7, false),
        // by half of the change exactly
        (0.75, 0.7, false),
        // much less, or by exactly a tenth less, than before
        (0.0, 1.0, false),
        (0.9, 1.0, false),
    ] {
        let (run, _) = after(reading, level);
        assert_eq!(run.estimate.confirmed(), !wrong, "{reading} {level}");
        assert!(run.jumped && run.failures == 1 && run.stalled == 0, "{reading} {level}");
    }
    // wrong: Kalman's update, and its variance times the square of the surprise over its deviation
    let (run, start) = after(1.0, 1.0);
    let (prior, spread) = (0.0025, 0.0025 + 1.1e-6);
    let left: f64 = prior - prior * prior / spread;
    let expected = left.sqrt() * 0.5 / spread.sqrt();
    // the difference of 0.0025 and almost as much loses three digits
    assert!((run.estimate.deviation(0) / expected - 1.0).abs() < 1e-11, "{} {expected}", run.estimate.deviation(0));
    assert_eq!((start, run.best), (1.0, (1.0, [re(0.0)])));
    // what was best stays where this is below seven tenths of the start, or at them; and of what the weights that it
    // began with would have after a jump, one more than the reading
    for (reading, start, stays) in [(1.4, 1.9, false), (1.4, 2.0, true), (1.4, 2.1, true), (2.4, 9.0, false)] {
        let mut run = moved(-0.5, 0.1, 2.0);
        run.best = (0.6, [re(2.0)]);
        assert_eq!(run.learn(&[re(reading)], reading, start, 1e-6), start);
        assert_eq!(run.best, if stays { (0.6, [re(2.0)]) } else { (start, [re(0.0)]) });
    }
}

/// After a jump the start is what the weights that it began with would have now, and no less than the level over the
/// bound.
#[test]
fn a_jump_is_judged_from_where_it_began() {
    for (reading, start, best) in [
        // 0.72 now, 1.22 without the weight
        (0.72, 1.22, (0.72, [re(1.0)])),
        // nothing without it: half of 0.5 by the bound of two
        (-0.5, 0.25, (0.25, [re(0.0)])),
        (-0.25, 0.25, (0.25, [re(0.0)])),
    ] {
        let mut run = moved(-0.5, 0.1, 1.0);
        assert!(near(learnt(&mut run, reading, 1e-6), start), "{reading} {:?}", run.start);
        assert!(near(run.start.unwrap(), start) && near(run.best.0, best.0) && run.best.1 == best.1, "{:?}", run.best);
        // the estimate of the reading begins again with its own error
        assert!(near(deviation(&run), 1e-3) && run.estimate.confirmed());
    }
}

/// Before the influence is confirmed a surprise makes it less certain: Kalman's update, and the square of the surprise
/// over four of its deviations, four times.
#[test]
fn a_surprise_of_an_influence_that_is_not_confirmed() {
    let mut run = moved(-0.5, 0.3, 1.0);
    learnt(&mut run, 1.5, 1e-6);
    let (prior, spread) = (0.0225, 0.0225 + 1.1e-6);
    let left: f64 = prior - prior * prior / spread;
    let expected = 2.0 * left.sqrt() / (4.0 * spread.sqrt());
    // the difference of 0.0225 and almost as much loses four digits
    assert!((run.estimate.deviation(0) / expected - 1.0).abs() < 1e-10, "{} {expected}", run.estimate.deviation(0));
    assert_eq!((run.failures, run.jumped), (1, false));
}

/// A reading of known variance has that deviation, at whatever speed.
#[test]
fn a_reading_is_as_certain_as_it_says() {
    for (variance, expected) in [(0.0, 0.01), (1e-6, 0.01), (0.04, 0.2)] {
        let mut run = One::new(CONFIG, 1, [re(0.0)]).unwrap();
        run.advise(&[re(1.0)], variance);
        assert!(near(deviation(&run), expected), "{variance}");
    }
}

#[test]
fn what_is_best_has_been_confirmed() {
    let best = |influence: f64, share: f64, best: f64| {
        let mut run = moved(influence, share, 1.0);
        (run.best.0, run.stalled) = (best, 5);
        run.advise(&[re(1.0 + influence)], 0.0);
        (run.best, run.stalled)
    };
    assert_eq!(best(-0.5, 0.1, 1.0), ((0.5, [re(1.0)]), 0));
    // not better, or not confirmed
    assert_eq!(best(-0.5, 0.1, 0.5), ((0.5, [re(0.0)]), 6));
    assert_eq!(best(-0.5, 0.5, 1.0), ((1.0, [re(0.0)]), 5));
    // better, by a tenth of it or less
    assert_eq!(best(-0.1, 0.1, 1.0), ((0.9, [re(1.0)]), 6));
    assert_eq!(best(-0.05, 0.1, 1.0), ((0.95, [re(1.0)]), 6));
}

#[test]
fn moves_without_gain_are_counted() {
    for (stalled, expected) in [(0, None), (7, None), (8, Some(AbortReason::Stalled))] {
        let mut run = known(-0.5, 0.1);
        run.stalled = stalled;
        run.advise(&[re(1.0)], 0.0);
        assert_eq!((run.stalled, run.aborted), (stalled + 1, expected));
    }
}

#[test]
fn failures_are_counted() {
    for (failures, expected) in [(3, None), (4, Some(AbortReason::Unidentified)), (5, Some(AbortReason::Unidentified))]
    {
        let mut run = known(-0.5, 0.5);
        run.failures = failures;
        run.advise(&[re(1.0)], 0.0);
        assert_eq!(run.aborted, expected, "{failures}");
    }
}

/// At rest a level above the bound, which is twice the start, begins identification again; at the bound it does not.
#[test]
fn a_machine_that_jumps_at_rest_is_identified_again() {
    for (reading, probes) in [(2.0, 5), (2.5, 0)] {
        let mut run = known(-0.5, 0.5);
        run.probes = 5;
        // so that the probes of this reading count as none
        run.advise(&[re(reading)], 0.0);
        assert_eq!((run.probes, run.aborted), (probes, Some(AbortReason::Unidentified)), "{reading}");
        assert!((probes > 0) ^ near(deviation(&run), 0.01), "{reading} {}", deviation(&run));
    }
}

/// A run that has seen no reading is not a resumed one.
#[test]
fn nothing_is_resumed_before_the_first_reading() {
    for (first, resumed) in [(0.0, false), (1.0, true)] {
        let mut run = known(-0.5, 0.1);
        run.first = first;
        run.resume(&[re(0.0)]);
        assert_eq!(run.resumed, resumed);
    }
}

/// With nothing left to gain: weights that are better than those that it began with by more than twice the readings'
/// error stay, others go home.
#[test]
fn weights_that_are_no_better_are_not_left_there() {
    let after = |now: f64, weight: f64, noise: f64, step: f64| {
        let mut run = known(-0.5, 0.01);
        (run.weights, run.config.step, run.level) = ([re(weight)], step, now);
        run.estimate.restart(&[re(now)], 0.0);
        run.correct(1.0, noise)
    };
    // 1.05 without the weights, 0.15 and 0.05: by 0.1 of 0.12
    assert_eq!(after(0.05, 2.0, 0.06, 100.0), Action::Hold);
    assert_eq!(after(0.05, 0.2, 0.06, 100.0), Action::Set([re(0.0)]));
    // by twice the error exactly: 0.5 without the weights, and 0.25
    assert_eq!(after(0.25, 0.5, 0.125, 0.1), Action::Set([re(0.0)]));
    // at home they stay
    assert_eq!(after(0.05, 0.0, 0.06, 100.0), Action::Hold);
    // as measured: 0.79 and 0.81 of the start, with a step that gains 0.05
    assert_eq!(after(0.79, 1.0, 0.06, 0.1), Action::Hold);
    assert_eq!(after(0.81, 1.0, 0.06, 0.1), Action::Set([re(0.0)]));
    // steps of 0.3 and 0.5 lead to 0.85 and to 0.75: not enough to begin with
    assert_eq!(after(1.0, 0.0, 0.01, 0.3), Action::Hold);
    assert_eq!(after(1.0, 0.0, 0.01, 0.5), Action::Set([re(0.5)]));
}

/// Known to less than a half, a probe goes the way of the correction, from a half on ahead. An influence of 0.5 may be
/// that and four deviations; allowed are 1.86.
#[test]
fn the_way_of_a_probe() {
    for (share, expected) in [(0.5, 0.86 / (0.5 + 4.0 * 0.25)), (0.4, -0.86 / (0.5 + 4.0 * 0.2))] {
        let mut run = known(0.5, share);
        let Action::Set([to]) = run.correct(1.0, 0.01) else { panic!("{share}") };
        assert!(near(to.re, expected) && to.im == 0.0, "{share}: {to}");
    }
    // nothing wanted: no way either
    let mut run = known(0.5, 0.4);
    run.estimate.restart(&[re(0.0)], 0.0);
    run.level = 0.0;
    assert_eq!(run.correct(0.0, 0.0), Action::Set([re(0.0)]));
}

/// Two heads that do almost the same, known to a tenth.
fn alike(share: f64) -> Two {
    let mut model = Influence::<f64, 2, 2>::new(2, 2).unwrap();
    model.set(0, &[re(1.0), re(0.9)]).unwrap();
    model.set(1, &[re(0.9), re(1.0)]).unwrap();
    let config = InRunConfig {
        probe: 1.0,
        limits: [100.0; 2],
        step: 100.0,
        bound: 2.0,
        target: 0.1,
        forgetting: 1.0,
        noise: 0.01,
    };
    let mut run = Two::new(config, 2, [re(0.0); 2]).unwrap().with_model(&model, share).unwrap();
    run.estimate.restart(&[re(1.0), re(-1.0)], 0.0);
    (run.start, run.level, run.first, run.best) = (Some(1.0), 1.0, 1.0, (1.0, [re(0.0); 2]));
    run
}

/// Sixteen probes for each head.
#[test]
fn probes_are_counted() {
    for (probes, expected) in [(0, None), (31, None), (32, Some(AbortReason::Unidentified))] {
        let mut run = alike(0.5);
        run.probes = probes;
        run.correct(1.0, 0.01);
        assert_eq!((run.probes, run.aborted), (probes + 1, expected));
    }
}

/// The sentences of all four, each of its own.
#[test]
fn an_abort_has_its_sentence() {
    extern crate std;
    use std::string::ToString;
    for (reason, part) in [
        (AbortReason::Diverging, "rose above its bound"),
        (AbortReason::Stalled, "eight moves"),
        (AbortReason::NoReading, "missing or not a number"),
        (AbortReason::Unidentified, "no more than these change by themselves"),
    ] {
        assert!(reason.to_string().contains(part));
    }
}

/// Readings, variances and speeds of any size, in single precision, whose squares overflow: no weight is NaN or beyond
/// its limit, to the rounding of some sums.
#[test]
fn garbage_moves_no_head_beyond_its_limit() {
    let limits = [0.5_f32, 0.7];
    let config = InRunConfig { probe: 0.01, limits, step: 0.3, bound: 1.3, target: 0.05, forgetting: 0.8, noise: 0.01 };
    for seed in 0..2_000 {
        let mut noise = Noise::new(seed);
        let mut run = InRun::<f32, 3, 2>::new(config, 3, [zero(); 2]).unwrap();
        let mut any = || (noise.even() * 10_f64.powi((80.0 * noise.even()) as i32)) as f32;
        for _ in 0..40 {
            let reading: [Complex<f32>; 3] = core::array::from_fn(|_| Complex { re: any(), im: any() });
            let weights = match run.advise_at(&reading, any(), 77.0 + any()) {
                Action::Set(weights) => weights,
                Action::Abort(weights, _) => {
                    run.resume(&weights);
                    weights
                }
                Action::Hold => *run.weights(),
            };
            for (weight, limit) in weights.iter().zip(limits) {
                assert!(size(*weight) <= 1.001 * limit, "{seed}: {weight}");
            }
            run.installed(&weights);
        }
    }
}
