//! Gear meshes: `data/gear_mesh.json`, a spur pair with rectangular mesh stiffness whose periodic motion is known to
//! 40 digits.

use driveline_lab::cases::gear_mesh::Pair;
use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{Coordinate, Link, Signal, Source, Teeth, Train, Variation};
use driveline_solver::plant::{Event, EventKind};

fn pair() -> Pair {
    driveline_lab::cases::gear_mesh::pair().unwrap()
}

#[test]
fn at_resonance_teeth_with_backlash_separate_and_meet_on_their_back() {
    let pair = pair();
    let run = |gap: f64| {
        let mut motion = pair.drive(3553.4, 5e-6, gap, 0.5 * gap + 1e-5, 0.0).unwrap();
        motion.watch(Signal::Force(0));
        motion.advance(0.1);
        (motion.events().to_vec(), motion.extremes(Signal::Force(0)).unwrap())
    };
    let contacts = |events: &[Event], side: i8| events.iter().filter(|e| e.new == side).count();
    let (events, narrow) = run(2e-6);
    assert!(events.iter().all(|event| event.kind == EventKind::Contact));
    assert!(contacts(&events, 1) > 50 && contacts(&events, -1) > 50, "{}", events.len());
    assert!(narrow.least < 0.0, "{narrow:?}");
    // a gap wider than the swing is never crossed: the teeth lose contact, but their backs stay free
    let (events, wide) = run(5e-4);
    assert!(contacts(&events, 0) > 50 && contacts(&events, -1) == 0, "{}", events.len());
    // only the damper pulls back, just before a flank is left: c v is 2 zeta = 0.14 of the swing's k x at most
    assert!(wide.least < 0.0 && wide.least > -0.14 * wide.peak, "{wide:?}");
}

/// A mass pressed on its flank by a constant force, which rebounds from a deeper start and returns as a body in free
/// fall.
fn rebound(amplitude: f64) -> (Vec<Event>, f64, f64) {
    let (mass, k, force, gap) = (2.0, 8.0e6, 400.0, 1e-4);
    let rest = force / k;
    let start = 0.5 * gap + rest * (1.0 + amplitude);
    let link = Link::ground(0, k).gap(gap).elongated(start);
    let mut motion =
        Train::new().coordinate(Coordinate::new(mass).source(Source::Constant(force))).link(link).build().unwrap();
    let omega = (k / mass).sqrt();
    // one tick of half a period and ten times the flight: everything happens within it
    motion.advance(0.9 * std::f64::consts::PI / omega + 0.5e-3);
    (motion.events().to_vec(), omega, rest)
}

#[test]
fn a_separation_of_half_a_millisecond_is_found() {
    // leaves with v = omega rest sqrt(a^2 - 1) and comes back after 2 v m/force = 2 sqrt(a^2 - 1)/omega
    let omega = 2000.0_f64;
    let amplitude = (0.25e-3_f64 * omega).hypot(1.0);
    let (events, _, _) = rebound(amplitude);
    assert_eq!(events.len(), 2, "{events:?}");
    let apart = events[1].time - events[0].time;
    // each end is located within 1e-14 s; the flight's length follows from the speed, to rounding
    assert!((apart - 0.5e-3).abs() < 1e-13, "{apart}");
}

#[test]
fn a_grazing_flank_is_left_or_kept_by_a_millionth_of_a_millionth() {
    let (events, omega, _) = rebound(1.0 + 1e-12);
    assert_eq!(events.len(), 2, "{events:?}");
    let apart = events[1].time - events[0].time;
    // 2 sqrt(2e-12)/omega = 1.4 ns; the depth of 1e-12 is known to the rounding of the elongation, 1e-16 of it
    let expected = 2.0 * 2e-12_f64.sqrt() / omega;
    assert!((apart - expected).abs() < 1e-3 * expected, "{apart:e} {expected:e}");
    let (events, _, _) = rebound(1.0 - 1e-12);
    assert!(events.is_empty(), "{events:?}");
}

#[test]
fn a_tooth_error_opens_the_mesh() {
    // at rest m x'' = F - k (x - e): the static elongation is F/k + e [derived from Tang 1994 (1.4)]
    let (force, k, error) = (400.0, 8.0e6, 3e-5);
    let variation = Variation::spur(1.5, 10.0, k, k, error);
    let link = Link::ground(0, k).varying(variation).elongated(force / k + error);
    let ground = Coordinate::new(2.0).source(Source::Constant(force));
    let mut motion = Train::new().coordinate(ground).link(link).build().unwrap();
    motion.watch(Signal::Speed(0));
    // in the first zone one of two pairs of half the stiffness carries the error: half of it counts, so the mass
    // moves; in the second all of it does
    motion.advance(0.05);
    let speed = motion.extremes(Signal::Speed(0)).unwrap();
    let omega = (k / 2.0_f64).sqrt();
    // a swing about F/k + e/2 with the amplitude e/2
    assert!((speed.peak - 0.5 * error * omega).abs() < 1e-12 * omega, "{speed:?}");
}

/// The pair of the case with a mesh that follows the pinion's angle.
fn by_angle(pair: &Pair, speed: f64, torque: f64, brake: f64, gap: f64, error: f64) -> Train {
    let teeth = Teeth {
        coordinate: 0,
        count: 21.0,
        contact_ratio: pair.contact_ratio,
        double: pair.k_double_pair_zone_N_m,
        single: pair.k_single_pair_zone_N_m,
        leaving: 0.5 * pair.k_double_pair_zone_N_m,
        errors: [error, 0.0],
    };
    let mesh = Link::mesh((0, pair.rb1_m), (1, pair.rb2_m), pair.k_mean_N_m)
        .damping(pair.c_Ns_m)
        .varying(Variation::Teeth(teeth))
        .gap(gap)
        .elongated(0.5 * gap + 1e-5);
    let ratio = pair.rb1_m / pair.rb2_m;
    Train::new()
        .coordinate(Coordinate::new(pair.J1_kg_m2).speed(speed).source(Source::Constant(torque)))
        .coordinate(Coordinate::new(pair.J2_kg_m2).speed(speed * ratio).source(Source::Constant(brake)))
        .link(mesh)
}

#[test]
fn a_mesh_by_angle_is_the_mesh_by_time_at_a_steady_speed() {
    let pair = pair();
    let speed = 200.0;
    // gears so heavy that the mesh cannot change their speed: what is left of the swing is a thousand-millionth of it
    let heavy = Pair { J1_kg_m2: 2.1e6, J2_kg_m2: 6.5e7, ..self::pair() };
    let brake = -heavy.T1_Nm * heavy.rb2_m / heavy.rb1_m;
    let mut angle = by_angle(&heavy, speed, heavy.T1_Nm, brake, 0.0, 4e-6).build().unwrap();
    let frequency = speed * 21.0 / std::f64::consts::TAU;
    let variation =
        Variation::spur(pair.contact_ratio, frequency, pair.k_double_pair_zone_N_m, pair.k_single_pair_zone_N_m, 4e-6);
    let mesh = Link::mesh((0, pair.rb1_m), (1, pair.rb2_m), pair.k_mean_N_m)
        .damping(pair.c_Ns_m)
        .varying(variation)
        .elongated(1e-5);
    let ratio = pair.rb1_m / pair.rb2_m;
    let mut time = Train::new()
        .coordinate(Coordinate::new(heavy.J1_kg_m2).speed(speed).source(Source::Constant(heavy.T1_Nm)))
        .coordinate(Coordinate::new(heavy.J2_kg_m2).speed(speed * ratio).source(Source::Constant(brake)))
        .link(mesh)
        .build()
        .unwrap();
    for _ in 0..300 {
        angle.advance(3.1e-5);
        time.advance(3.1e-5);
        // the edges differ by what the speed does, 1e-9 of it
        let (a, b) = (angle.force(0), time.force(0));
        assert!((a - b).abs() < 1e-6 * b.abs(), "{a} {b}");
    }
}

#[test]
fn a_run_up_and_a_reversal_through_the_teeth_are_proven() {
    let pair = pair();
    for (speed, torque, brake, ticks) in [(0.0, 250.0, -300.0, 500), (15.0, -200.0, 100.0, 300)] {
        let start = by_angle(&pair, speed, torque, brake, 1e-4, 6e-6).build().unwrap();
        let mut run = Recording::new(start);
        for _ in 0..ticks {
            run.advance(1e-4);
        }
        prove(&run).unwrap();
        let motion = run.motion();
        // more than a tooth has passed, and in the second run the pinion has turned back
        assert!(motion.angle(0).abs() > 0.3 && (speed == 0.0) == (motion.speed(0) > 0.0), "{}", motion.angle(0));
    }
}
