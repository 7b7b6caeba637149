//! Gears that lose power, each with a closed form.

use driveline_solver::noise::Noise;
use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{Coordinate, Friction, Link, Source, Train};
use driveline_solver::plant::{EventKind, LoadProgram};

/// Motor, load (kg m2), its weight (N m) and the shaft (N m/rad).
const MOTOR: f64 = 0.5;
const LOAD: f64 = 2.0;
const WEIGHT: f64 = 60.0;
const STIFFNESS: f64 = 900.0;

/// A load that falls over a worm, in steady acceleration from the start.
fn falling(link: Link, force: f64) -> Recording {
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR).speed(-0.1))
        .coordinate(Coordinate::new(LOAD).speed(-0.1).source(Source::Constant(-WEIGHT)))
        .link(link.elongated(force / STIFFNESS))
        .build()
        .unwrap();
    Recording::new(motion)
}

/// The load drives: of its force F the motor gets eta' F. With `J_1 a = eta' F` and `J_2 a = W - F` the acceleration is
/// `eta' W/(J_1 + eta' J_2)`.
#[test]
fn a_worm_has_its_own_efficiency_when_the_load_drives() {
    for back in [0.3, 0.8, 1.0] {
        let acceleration = back * WEIGHT / (MOTOR + back * LOAD);
        let link = Link::shaft(0, 1, STIFFNESS).efficiency(0.5).back_efficiency(back);
        let mut run = falling(link, WEIGHT - LOAD * acceleration);
        for _ in 0..100 {
            run.advance(0.01);
        }
        for coordinate in 0..2 {
            let (speed, expected) = (run.motion().speed(coordinate), -0.1 - acceleration);
            // the solver's roundings over a thousand stretches
            assert!((speed / expected - 1.0).abs() < 1e-11, "{back}: {speed} {expected}");
        }
        prove(&run).unwrap();
    }
}

/// A worm that locks itself: at `eta = 0.4` it has `eta' = 2 - 1/eta = -0.5`, and the motor stands still. The load
/// swings on the shaft that was slack, by `W/k (1 - cos(w t))`.
#[test]
fn a_self_locking_worm_holds_its_load() {
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR))
        .coordinate(Coordinate::new(LOAD).source(Source::Constant(-WEIGHT)))
        .link(Link::shaft(0, 1, STIFFNESS).efficiency(0.4).back_efficiency(-0.5))
        .build()
        .unwrap();
    let mut run = Recording::new(motion);
    let omega = (STIFFNESS / LOAD).sqrt();
    for step in 1..=100 {
        run.advance(0.01);
        let (expected, found) = (WEIGHT * (1.0 - (omega * 0.01 * f64::from(step)).cos()), run.motion().force(0));
        assert!((found - expected).abs() < 1e-10 * WEIGHT, "{step}: {found} {expected}");
        assert_eq!(run.motion().speed(0), 0.0, "{step}");
    }
    prove(&run).unwrap();
}

/// A lossy gear on a motor at rest is started by its torque, and proven: with `T` at the motor and nothing on the load,
/// both turn with `T/(J_1 + J_2/eta)` once the swing is taken off: their momentum weighted by the loss.
#[test]
fn a_lossy_gear_starts_from_rest() {
    let (torque, eta) = (10.0, 0.9);
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR).source(Source::Constant(torque)))
        .coordinate(Coordinate::new(LOAD))
        .link(Link::shaft(0, 1, STIFFNESS).efficiency(eta))
        .build()
        .unwrap();
    let mut run = Recording::new(motion);
    for _ in 0..50 {
        run.advance(0.01);
    }
    let motion = run.motion();
    // While the motor drives all the time, J_1 w_1 + J_2 w_2/eta = T t.
    let momentum = MOTOR * motion.speed(0) + LOAD * motion.speed(1) / eta;
    assert!((momentum / (torque * 0.5) - 1.0).abs() < 1e-11, "{momentum} {:?}", motion.events());
    prove(&run).unwrap();
}

/// Nothing moves and nothing pulls: a lossy gear at rest has no events.
#[test]
fn a_lossy_gear_at_rest_stays_there() {
    let motion = Train::new()
        .coordinate(Coordinate::new(MOTOR))
        .coordinate(Coordinate::new(LOAD))
        .link(Link::shaft(0, 1, STIFFNESS).efficiency(0.9))
        .build()
        .unwrap();
    let mut run = Recording::new(motion);
    run.advance(1.0);
    assert_eq!((run.motion().events().len(), run.motion().speed(0)), (0, 0.0));
    prove(&run).unwrap();
}

/// A motor behind an open gap, two lossy gears at rest and a load that pulls at a worm: of all forces that hold what
/// stands one is nothing, and rounding beside the others. It was taken for a slip, a thousand times in one step.
#[test]
fn a_lossy_gear_without_torque_rests_before_a_worm_that_holds() {
    let train = Train::new()
        .coordinate(Coordinate::new(0.123_511_865).source(Source::Constant(9.963_614)))
        .coordinate(Coordinate::new(0.388_107_614_542_295))
        .coordinate(Coordinate::new(7.138_967_971_294_607_5))
        .coordinate(Coordinate::new(0.289_061_928_140_530_17).source(Source::Constant(-33.436_595_546_257_1)))
        .link(Link::geared(0, 1, 1.67, 4233.0).damping(1.26).gap(0.007_87).efficiency(0.68))
        .link(Link::shaft(1, 2, 3_389.596_759_493_806_5).damping(0.715_782_117_412_273_6).efficiency(0.967))
        .link(
            Link::geared(2, 3, 2.749_199_974_861_346_7, 247.671_635_132_561_68)
                .damping(1.865_747_226_572_344)
                .efficiency(0.717_022_262_714_741_6)
                .back_efficiency(-0.198_344_014_098_950_42),
        )
        .friction(Friction::ground(3, 5.114_580_798_758_894).breakaway(6.242_363_768_273_733));
    let mut run = Recording::new(train.build().unwrap());
    (0..300).for_each(|_| run.advance(2e-3));
    prove(&run).unwrap();
}

/// The torque of a worm that holds passes through zero: within its rounding it lets nothing slip, where it used to slip
/// and stop without end.
#[test]
fn a_worm_holds_while_its_torque_turns_round() {
    let push = [30.622_988_148_394_175, 22.574_451_382_204_394, -48.909_123_241_399_33];
    let push: Vec<(f64, f64)> = push.iter().enumerate().map(|(i, &torque)| (0.1 * i as f64, torque)).collect();
    let train = Train::new()
        .coordinate(Coordinate::new(0.793_125_057_103_708_8).source(Source::Program(LoadProgram::steps(&push))))
        .coordinate(Coordinate::new(6.059_910_419_030_047))
        .coordinate(Coordinate::new(9.802_084_926_960_157))
        .coordinate(
            Coordinate::new(1.276_159_244_231_222_2)
                .speed(-2.753_333_514_177_484)
                .source(Source::Constant(13.447_605_598_692_46)),
        )
        .link(
            Link::geared(0, 1, 1.383_996_684_024_492_4, 125.635_411_360_637_53)
                .damping(0.800_927_224_009_084_3)
                .efficiency(0.849_154_304_119_648_4),
        )
        .link(
            Link::shaft(1, 2, 170.952_391_148_317_56)
                .damping(0.189_540_973_985_578_9)
                .gap(0.034_310_312_308_166_4)
                .efficiency(0.680_549_569_478_950_8),
        )
        .link(
            Link::shaft(2, 3, 8_042.885_604_239_457)
                .damping(0.787_541_303_787_739_7)
                .efficiency(0.710_292_367_930_640_4)
                .back_efficiency(-0.225_053_405_775_051_29),
        )
        .friction(Friction::ground(0, 1.403_953_782_516_311_8).breakaway(2.530_087_262_700_649))
        .friction(Friction::ground(1, 2.365_155_063_754_623_5).breakaway(3.462_855_766_107_738_4));
    let mut run = Recording::new(train.build().unwrap());
    (0..100).for_each(|_| run.advance(2e-3));
    assert!(run.motion().events().iter().all(|event| event.kind != EventKind::Unresolved));
    prove(&run).unwrap();
}

/// Gears, worms, backlash and brakes at random, from rest and from motion, pushed both ways: every run is proven.
#[test]
fn lossy_trains_at_random_are_proven() {
    let mut noise = Noise::new(7);
    for number in 0..60 {
        let mut u = || noise.uniform();
        let masses = 2 + (1.5 * (u() + 1.0)) as usize;
        let push: Vec<(f64, f64)> = (0..6).map(|i| (0.1 * f64::from(i), 60.0 * u())).collect();
        let push = if u() > 0.0 { LoadProgram::steps(&push) } else { LoadProgram::table(&push) };
        let mut train = Train::new().coordinate(Coordinate::new(10f64.powf(u())).source(Source::Program(push)));
        for before in 0..masses - 1 {
            let load = Coordinate::new(10f64.powf(u())).source(Source::Constant(40.0 * u()));
            train = train.coordinate(if u() > 0.5 { load.speed(5.0 * u()) } else { load });
            let ratio = if u() > 0.3 { 1.0 } else { 3.0 * u() + 0.01 };
            let eta = 0.8 + 0.19 * u();
            let back = if u() > 0.5 { eta - 0.5 - 0.5 * u() } else { eta };
            let gap = if u() > 0.4 { 0.02 * (1.1 + u()) } else { 0.0 };
            let link = Link::geared(before, before + 1, ratio, 10f64.powf(3.0 + u())).damping(1.0 + u());
            train = train.link(link.efficiency(eta).back_efficiency(back).gap(gap));
        }
        if u() > 0.0 {
            let kinetic = 5.0 * (u() + 1.0);
            train = train.friction(Friction::ground(masses - 1, kinetic).breakaway(kinetic * (1.5 + 0.5 * u())));
        }
        let mut run = Recording::new(train.build().unwrap());
        (0..300).for_each(|_| run.advance(2e-3));
        prove(&run).unwrap_or_else(|error| panic!("{number}: {error}"));
    }
}
