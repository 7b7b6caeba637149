//! Runs of trains, each proven by the second integrator to 1e-8 of its peaks.

use driveline_solver::plant::train::converge::{BOUND, NotProven, Recording, prove, prove_in_pieces};
use driveline_solver::plant::train::{
    Coordinate, Crank, Friction, Harmonic, Link, Motion, Source, Train, Variation, Waveform,
};
use driveline_solver::plant::{EventKind, LoadProgram};

/// Runs for some ticks and proves it; gives the motion at the end.
fn proven(what: &str, motion: Motion, dt: f64, ticks: usize) -> Motion {
    let mut run = Recording::new(motion);
    for _ in 0..ticks {
        run.advance(dt);
    }
    let proof = prove(&run).unwrap_or_else(|error| panic!("{what}: {error}"));
    assert!(proof.largest() <= BOUND, "{what}");
    assert!(run.motion().events().iter().all(|event| event.kind != EventKind::Unresolved), "{what}");
    run.motion().clone()
}

#[test]
fn a_branched_train_with_backlash_in_one_branch() {
    let train = Train::new()
        .coordinate(Coordinate::new(12.0).source(Source::Starting { torque: 900.0, time: 0.3, power: 2 }))
        .coordinate(Coordinate::new(3.0).source(Source::Program(LoadProgram::steps(&[(0.05, -300.0), (0.2, 100.0)]))))
        .coordinate(Coordinate::new(2.0).viscous(0.5).source(Source::Constant(-50.0)))
        .coordinate(Coordinate::new(0.7))
        .link(Link::shaft(0, 1, 2.0e5).damping(40.0))
        .link(Link::geared(0, 2, 3.0, 1.0e5).damping(20.0).gap(0.01))
        .link(Link::shaft(0, 3, 4.0e4).damping(5.0));
    let motion = proven("branches", train.build().unwrap(), 1e-3, 400);
    assert!(motion.events().len() > 4, "{:?}", motion.events());
}

#[test]
fn a_closed_loop_of_two_trains_with_backlash_that_share_the_load() {
    // two motors on one ring gear, joined by a shaft as well
    let train = Train::new()
        .coordinate(Coordinate::new(1.0).source(Source::Line { stall: 120.0, slope: 1.0 }))
        .coordinate(Coordinate::new(1.1).source(Source::Line { stall: 110.0, slope: 0.9 }))
        .coordinate(Coordinate::new(40.0).source(Source::Waveform(Waveform::square(200.0, 0.2, 9))))
        .link(Link::geared(0, 2, 5.0, 3.0e4).damping(6.0).gap(0.02))
        .link(Link::geared(1, 2, 5.0, 3.0e4).damping(6.0).gap(0.02))
        .link(Link::shaft(0, 1, 900.0).damping(0.5));
    let motion = proven("loop", train.build().unwrap(), 2e-3, 200);
    assert!(motion.events().len() > 4, "{:?}", motion.events());
    // around the loop elongations add up to nothing: what is left is rounding
    let around = motion.elongation(0) - motion.elongation(1) - motion.elongation(2);
    assert!(around.abs() < 1e-13, "{around}");
}

/// Gears whose mesh is driven by errors larger than its load can hold together.
fn rattling(torque: f64, damping: f64) -> Motion {
    let swing = |order: f64, cosine: f64, sine: f64| Harmonic { order, cosine, sine };
    let variation = Variation::Harmonics {
        frequency: 1200.0,
        stiffness: vec![swing(1.0, 1.1e8, 2.0e7), swing(2.0, -3.0e7, 1.0e7)],
        error: vec![swing(1.0, 0.0, 6e-6), swing(0.1, 4e-6, 0.0)],
    };
    let train = Train::new()
        .coordinate(Coordinate::new(0.0021).source(Source::Constant(torque)))
        .coordinate(Coordinate::new(0.065).source(Source::Constant(-torque * 0.094 / 0.0395)))
        .link(Link::mesh((0, 0.0395), (1, 0.094), 5.0e8).damping(damping).varying(variation).gap(3e-6));
    train.build().unwrap()
}

#[test]
fn a_mesh_whose_stiffness_swings_with_errors_backlash_and_both_flanks() {
    let motion = proven("harmonic mesh", rattling(3.0, 500.0), 5e-5, 200);
    let on = |side: i8| motion.events().iter().filter(|event| event.new == side).count();
    assert!(on(1) > 5 && on(-1) > 5, "{:?}", motion.events().len());
}

#[test]
fn a_mesh_with_rectangular_stiffness_and_pitch_errors_that_separates() {
    let variation = Variation::spur(1.6, 3000.0, 6.8e8, 4.0e8, 8e-6);
    let train = Train::new()
        .coordinate(Coordinate::new(0.0021).source(Source::Constant(120.0)))
        .coordinate(Coordinate::new(0.065).source(Source::Constant(-120.0 * 0.094 / 0.0395)))
        .link(Link::mesh((0, 0.0395), (1, 0.094), 5.68e8).damping(2500.0).varying(variation).gap(1e-4));
    let motion = proven("rectangular mesh", train.build().unwrap(), 2.3e-5, 400);
    assert!(motion.events().len() > 10, "{}", motion.events().len());
}

#[test]
fn a_press_with_crank_flywheel_belt_and_punching_arc() {
    let crank = Crank { rod_mass: 25.0, rod_inertia: 0.6, ..Crank::new(0.08, 0.45, 180.0) };
    let motor = Source::Kloss { breakdown: 90.0, slip: 0.2, synchronous: 157.0 };
    let train = Train::new()
        .coordinate(Coordinate::new(0.05).speed(150.0).source(motor))
        .coordinate(Coordinate::new(8.0).speed(25.0))
        .coordinate(Coordinate::new(1.5).speed(25.0).crank(crank).source(Source::Arc {
            torque: -900.0,
            from: 2.4,
            to: 3.1,
        }))
        .link(Link::geared(0, 1, 6.0, 400.0).damping(0.6))
        .link(Link::shaft(1, 2, 6.0e4).damping(30.0));
    let motion = proven("press", train.build().unwrap(), 2e-3, 400);
    assert!(motion.angle(2) > 2.0 * std::f64::consts::TAU);
}

#[test]
fn an_engine_with_orders_and_a_parabola_as_its_load() {
    let order = |order: f64, cosine: f64, sine: f64| Harmonic { order, cosine, sine };
    let gas = vec![order(0.5, 30.0, 60.0), order(1.0, -20.0, 80.0), order(1.5, 0.0, 40.0), order(2.0, 10.0, 25.0)];
    let train = Train::new()
        .coordinate(Coordinate::new(0.3).speed(60.0).source(Source::Constant(120.0)).source(Source::Orders(gas)))
        .coordinate(Coordinate::new(2.0).speed(60.0).source(Source::Parabola(-5.0, -0.1, -0.03)))
        .link(Link::shaft(0, 1, 2.0e4).damping(8.0).elongated(0.004));
    proven("engine", train.build().unwrap(), 1e-3, 500);
}

#[test]
fn a_block_that_sticks_and_slips_on_a_belt_with_another_behind_it() {
    let train = Train::new()
        .coordinate(Coordinate::new(1.0))
        .coordinate(Coordinate::new(0.6))
        .link(Link::ground(0, 400.0))
        .link(Link::shaft(0, 1, 900.0).damping(0.4))
        .friction(Friction::ground(0, 3.0).breakaway(5.0).surface(0.1))
        .friction(Friction::between(0, 1, 0.3));
    let motion = proven("stick-slip", train.build().unwrap(), 2e-3, 500);
    let count = |kind: EventKind| motion.events().iter().filter(|event| event.kind == kind).count();
    assert!(count(EventKind::Slip) > 2 && count(EventKind::Stop) > 2, "{:?}", motion.events());
}

#[test]
fn a_lossy_gear_that_drives_holds_and_is_driven_back() {
    let load = LoadProgram::table(&[(0.0, -40.0), (0.2, -40.0), (0.3, 90.0), (0.5, -150.0)]);
    let motor = LoadProgram::steps(&[(0.0, 60.0), (0.15, 5.0), (0.25, -20.0)]);
    let train = Train::new()
        .coordinate(Coordinate::new(0.4).source(Source::Program(motor)))
        .coordinate(Coordinate::new(2.0).source(Source::Program(load)))
        .link(Link::geared(0, 1, 2.0, 900.0).damping(0.8).efficiency(0.7))
        .friction(Friction::ground(1, 6.0));
    let motion = proven("lossy", train.build().unwrap(), 1e-3, 600);
    let kinds = [EventKind::Stop, EventKind::Flow, EventKind::Slip];
    assert!(kinds.iter().all(|kind| motion.events().iter().any(|e| e.kind == *kind)), "{:?}", motion.events());
}

#[test]
fn a_run_that_chaos_takes_apart_is_refused_as_a_whole_and_proven_in_pieces() {
    // lightly damped rattling: a difference in the last digit grows with every impact until the two runs have nothing
    // in common
    let mut run = Recording::new(rattling(5.0, 20.0));
    for _ in 0..2000 {
        run.advance(5e-5);
    }
    let refused = prove(&run);
    assert!(matches!(refused, Err(NotProven::Deviates { .. })), "{refused:?}");
    let proof = prove_in_pieces(&run, |_| {}).unwrap();
    let sensitive = proof.sensitive.unwrap();
    assert!(proof.largest() <= BOUND);
    // a rounding of 1e-16 grows beyond 1e-8, and does so again and again
    assert!(sensitive.restarts > 1 && sensitive.from < 0.1 && sensitive.shortest > 0.0, "{sensitive:?}");
    assert_eq!(prove(&Recording::new(rattling(5.0, 20.0))), Err(NotProven::Empty));
}

/// Ropes, a gap and two meshes: after each of its events the second integrator begins anew, by steps that are shorter
/// and have errors as the others. With none of them counted the first tick of a piece was 1.45e-12 off for 1.38e-12.
#[test]
fn steps_after_events_are_counted() {
    let harmonic = |order, cosine, sine| Harmonic { order, cosine, sine };
    let zones = {
        let double = 501_604.102_626_666;
        let [single, leaving] = [454_909.848_082_175_1, 286_823.495_694_816_1];
        let errors = [-3.891_922_548_510_676e-7, 1.059_203_986_644_361_1e-7];
        Variation::pairs(1.449_060_209_406_199_3, 52.849_539_684_041_54, [double, leaving], single, errors)
    };
    let swings = Variation::Harmonics {
        frequency: 21.638_515_908_898_984,
        stiffness: vec![
            harmonic(1.0, -53.134_452_525_319_645, -87.790_544_983_995_49),
            harmonic(2.0, -76.402_898_383_910_68, -73.740_535_345_730_01),
        ],
        error: vec![
            harmonic(1.0, -0.002_228_636_307_436_201_5, 0.002_176_733_344_767_637),
            harmonic(2.0, -0.000_484_220_831_143_388_86, -0.000_183_616_218_292_421_8),
        ],
    };
    let mass = |inertia, speed| Coordinate::new(inertia).speed(speed);
    let speed = 0.565_412_195_560_411_6;
    let train = Train::new()
        .coordinate(mass(2.109_954_550_633_347_5, speed).source(Source::Constant(6.403_784_493_888_728)))
        .coordinate(mass(0.116_791_464_107_890_93, speed))
        .coordinate(mass(0.847_824_521_446_446_7, speed).viscous(0.029_990_762_918_557_286))
        .coordinate(mass(0.201_611_182_382_822_4, speed).viscous(0.009_753_364_793_011_933))
        .coordinate(
            mass(0.146_928_342_355_061_89, 0.822_762_109_685_217_3).source(Source::Constant(-3.079_788_674_691_553)),
        )
        .friction(Friction::ground(3, 0.354_582_834_927_136).breakaway(0.460_957_685_405_276_8))
        .link(Link::shaft(0, 1, 337.146_247_620_931_55).damping(0.043_721_797_914_857_11).rope())
        .link(Link::shaft(1, 2, 501_604.102_626_666).rope().varying(zones))
        .link(Link::shaft(2, 3, 240.059_567_323_570_6).damping(2.241_133_409_739_691_6).gap(0.045_434_406_499_292_47))
        .link(
            Link::geared(3, 4, 0.687_212_243_860_785, 1_571.024_072_815_878)
                .damping(0.078_076_077_391_755_46)
                .varying(swings),
        );
    let mut run = Recording::new(train.build().unwrap());
    for _ in 0..195 {
        run.advance(0.005_528_54);
    }
    let proof = prove_in_pieces(&run, |_| {}).unwrap();
    assert!(proof.largest() <= BOUND && run.motion().events().len() > 100, "{proof:?}");
}

/// The gear pair of the command's example, for a second: 7,000 separations and contacts. The angles of its wheels come
/// back to where they were, and gather the roundings of speeds ten thousand times as large.
#[test]
fn a_second_of_a_gear_pair_at_its_resonance_is_proven() {
    let variation = Variation::spur(1.6, 3_553.363_987_966_344_7, 6.8e8, 4.0e8, 0.0);
    let mesh = Link::mesh((0, 0.039_467_090_073_008_15), (1, 0.093_969_262_078_590_84), 5.68e8);
    let train = Train::new()
        .coordinate(Coordinate::new(0.0021).source(Source::Constant(250.0)))
        .coordinate(Coordinate::new(0.065).source(Source::Constant(-250.0 * 50.0 / 21.0)))
        .link(mesh.damping(3_561.695_654_463_696).gap(1.6e-4).elongated(9.1e-5).varying(variation));
    let motion = proven("gear pair", train.build().unwrap(), 1e-5, 100_000);
    assert!(motion.events().len() > 7000, "{}", motion.events().len());
}

/// A mass swings by `-cos t` beside a stop that it misses or meets by a billionth of its swing, over a tick of a whole
/// period: met at `acos(-reach)`, or never.
#[test]
fn a_stop_that_is_grazed_is_met_or_missed() {
    for (reach, met) in [(1.0 - 1e-9, true), (1.0 + 1e-9, false)] {
        let train = Train::new()
            .coordinate(Coordinate::new(1.0))
            .link(Link::ground(0, 1.0).elongated(-1.0))
            .link(Link::ground(0, 50.0).rope().gap(reach).elongated(-1.0));
        let mut run = Recording::new(train.build().unwrap());
        run.advance(6.0);
        let contact = run.motion().events().iter().find(|event| event.new == 1);
        assert_eq!(contact.is_some(), met, "{reach}: {:?}", run.motion().events());
        if let Some(contact) = contact {
            // the speed there is 4.5e-5: a rounding of the place moves the time by 1e-11
            assert!((contact.time - (-reach).acos()).abs() < 1e-10, "{contact:?}");
        }
        prove(&run).unwrap();
    }
}

/// A step of the torque at 1.5 ms, between ticks of 0.3 ms of which the fifth ends one rounding before it.
#[test]
fn a_corner_one_rounding_after_a_tick_is_taken() {
    let steps = Source::Program(LoadProgram::steps(&[(0.0, 1.0), (0.0015, 5.0)]));
    let train = Train::new().coordinate(Coordinate::new(1.0).source(steps));
    let motion = proven("corner", train.build().unwrap(), 3e-4, 100);
    // 1.5 ms at 1 N m, then 28.5 ms at 5 N m, to some roundings
    assert!((motion.speed(0) - 0.144).abs() < 1e-14, "{}", motion.speed(0));
}

/// A clutch that slips for moments, by the orders of an engine alone: no link and no time sets a rate.
fn clutch(orders: &[Harmonic]) -> Motion {
    let engine = Coordinate::new(1.0).speed(100.0).source(Source::Orders(orders.to_vec()));
    let train = Train::new().coordinate(engine).coordinate(Coordinate::new(2.0).speed(100.0));
    train.friction(Friction::between(0, 1, 20.0).breakaway(40.0)).build().unwrap()
}

#[test]
fn a_clutch_that_orders_of_an_angle_tear_loose_for_moments_is_proven_whatever_the_tick() {
    let order = |order: f64, cosine: f64, sine: f64| Harmonic { order, cosine, sine };
    let two = [order(2.0, 58.0, 0.0), order(4.0, 0.0, 30.0)];
    for (orders, step) in [(&two[..], 1e-2), (&two[..], 2e-2), (&[order(4.0, 62.0, 0.0)], 2e-3)] {
        let motion = proven("clutch", clutch(orders), step, (1.0 / step) as usize);
        assert!(motion.events().len() > 20, "{}", motion.events().len());
    }
}
