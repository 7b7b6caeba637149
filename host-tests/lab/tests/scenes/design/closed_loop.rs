//! The speed loop with its observer in it: against the loop in states whose powers decay, and against the library's own
//! observer and governor on the full solver's plant, the torque raised until it oscillates.

use std::collections::VecDeque;

use driveline::configure::Machine;
use driveline::design::{Actuator, ClosedLoop, Error, Plant, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::governor::{DampingLag, Governor, LagConfig, SpeedLag, SpeedLoop, SpeedLoopConfig};
use driveline::machine::{Chain, TwoMass};
use driveline::observer::{self, Observer, RigidConfig, TwoMassConfig};
use driveline::sample::Estimate;
use driveline::settings::{Bases, SpeedLoopSettings};
use driveline_firmware::scenes::blooming_mill::BloomingMill;
use driveline_firmware::scenes::crane_travel::CraneTravel;
use driveline_firmware::scenes::hoist::Hoist;
use driveline_firmware::scenes::spindle::Spindle;
use driveline_firmware::scenes::strip_mill::StripMill;
use driveline_lab::proof::subject::Subject;
use driveline_solver::plant;

use crate::proof::is_stable;

/// The hoist as its observers know it, whatever their rate.
type Known = Hoist<10_000>;

/// Other machines than the observer's model, at three rates, prompt and late: at the margin's edge the loop stops being
/// stable.
#[test]
fn gain_margins_and_ranges_are_where_a_pole_leaves_the_circle() {
    let mut edges = 0;
    for (name, rate, tuning) in
        [("hoist, 1 kHz", 1_000, 0.1), ("hoist, 4 kHz", 4_000, 0.2), ("hoist, 10 kHz", 10_000, 0.4)]
    {
        let known = Known::TWO_MASS;
        let observer = known.observer(Rate::hz(rate), Known::ENCODER, Known::DISTURBANCE);
        let speed_loop =
            known.speed_loop(Rate::hz(rate), SpeedLoopTuning { shaft_damping: tuning, ..SpeedLoopTuning::USUAL });
        let (_, subject) = Subject::all().into_iter().find(|(of, _)| *of == name).unwrap();
        let subject = Subject { two_mass: Some(observer), speed_loop: Some(speed_loop), ..subject };
        for (ticks, lag) in [(0.0, 0.0), (1.0, 3.2e-4), (3.0, 0.0)] {
            let actuator = Actuator { delay: ticks / f64::from(rate), lag };
            let closed = ClosedLoop::of(&observer, &speed_loop, actuator).unwrap();
            for [motor, load, stiffness] in [[1.0, 1.0, 1.0], [1.1, 0.3, 1.5], [0.95, 2.0, 0.6]] {
                let machine = TwoMass {
                    motor_inertia: known.motor_inertia * motor,
                    load_inertia: known.load_inertia * load,
                    stiffness: known.stiffness * stiffness,
                    ..known
                };
                let stable = |machine: &TwoMass, gain| is_stable(&subject, machine, gain, lag, ticks as usize);
                let Ok(margins) = closed.margins(&Plant::of(&machine)) else {
                    assert!(!stable(&machine, 1.0));
                    continue;
                };
                // A thousandth of the gain moves the critical pole by 1e-6 at the least, which a million ticks show.
                for (edge, way) in [(margins.gain_up, 1.001), (margins.gain_down, 1.0 / 1.001)] {
                    if edge.is_finite() && edge > 0.0 {
                        assert!(
                            stable(&machine, edge / way) && !stable(&machine, edge * way),
                            "{rate} {actuator:?} {margins:?}"
                        );
                        edges += 1;
                    }
                }
                let ranges = closed.ranges(&machine);
                let vary: [(fn(&mut TwoMass) -> &mut f64, [f64; 2]); 3] = [
                    (|m| &mut m.motor_inertia, ranges.motor_inertia),
                    (|m| &mut m.load_inertia, ranges.load_inertia),
                    (|m| &mut m.stiffness, ranges.stiffness),
                ];
                for (field, [down, up]) in vary {
                    for (edge, way) in [(down, 1.0 / 1.001), (up, 1.001)] {
                        if edge > 0.0 && edge.is_finite() {
                            let with = |factor: f64| {
                                let mut other = machine;
                                *field(&mut other) *= factor;
                                stable(&other, 1.0)
                            };
                            assert!(with(edge / way) && !with(edge * way), "{rate} {actuator:?} {ranges:?}");
                            edges += 1;
                        }
                    }
                }
                // Both other margins bound the distance from -1 [Astrom and Murray, Feedback Systems, §10.3]; the
                // sweep's grid finds the distance within 1 %.
                assert!(margins.modulus <= 1.01 * (1.0 - 1.0 / margins.gain_up), "{margins:?}");
                assert!(margins.modulus <= 1.01 * 2.0 * (0.5 * margins.phase).sin(), "{margins:?}");
            }
        }
    }
    assert!(edges > 40, "{edges}");
}

/// A loop of the scenes: chain, observer, speed loop, seconds to wait.
struct Scene(&'static str, Chain, TwoMassDesign, SpeedLoopDesign, f64);

impl Scene {
    fn of<M: Machine>(name: &'static str, seconds: f64) -> Self {
        Scene(name, M::CHAIN, M::OBSERVER, M::SPEED_LOOP, seconds)
    }
}

fn scenes() -> [Scene; 7] {
    let damped = BloomingMill::TWO_MASS.speed_loop(BloomingMill::RATE, BloomingMill::TUNING);
    let rolled_off = Spindle::SPEED_LOOP.with_speed_lag(0.2 / Spindle::SPEED_LOOP.bandwidth);
    [
        Scene::of::<Hoist<1_000>>("hoist at 1 kHz", 20.0),
        Scene::of::<Hoist<10_000>>("hoist at 10 kHz", 6.0),
        Scene::of::<StripMill>("strip mill", 4.0),
        Scene::of::<Spindle>("spindle", 0.5),
        Scene("spindle, speed lagged", Spindle::CHAIN, Spindle::OBSERVER, rolled_off, 0.5),
        Scene("blooming mill, no gap", BloomingMill::CHAIN, BloomingMill::OBSERVER, damped, 6.0),
        Scene::of::<CraneTravel>("crane travel", 300.0),
    ]
}

/// Whether the drive holds the full plant still after a small speed, its torque times `gain`; the torque it is told is
/// its own command, `late` ticks late.
fn settles<O: Observer<f64>>(scene: &Scene, known: &O::Config, gain: f64, late: usize) -> bool {
    let Scene(_, chain, TwoMassDesign { period, .. }, speed_loop, seconds) = scene;
    let masses = chain.masses();
    let mut body = plant::Chain::motor(masses[0]);
    for (shaft, &mass) in chain.shafts().iter().zip(&masses[1..]) {
        body = body.shaft(plant::Shaft::elastic(shaft.stiffness).damping(shaft.damping), mass);
    }
    let start = plant::Start::Given { twists: vec![0.0; masses.len() - 1], speeds: vec![1.0; masses.len()] };
    let mut body = body.start(start).build().unwrap();
    let law = SpeedLoopConfig::<f64>::new(speed_loop, SpeedLoopSettings { torque_limit: 1e30, ramp: 1e30 }, Bases::SI);
    let mut eye = O::at_rest(known, 0, 0.0);
    let mut command: Box<dyn FnMut(&Estimate<f64>) -> f64> = if speed_loop.damping_lag > 0.0 {
        let law = law.with_filter(LagConfig::<f64>::new(speed_loop.damping_lag, *period, Bases::SI));
        let mut governor = SpeedLoop::<DampingLag<f64>, f64>::default();
        Box::new(move |estimate| governor.command(&law, estimate))
    } else if speed_loop.speed_lag > 0.0 {
        let law = law.with_filter(LagConfig::<f64>::new(speed_loop.speed_lag, *period, Bases::SI));
        let mut governor = SpeedLoop::<SpeedLag<f64>, f64>::default();
        Box::new(move |estimate| governor.command(&law, estimate))
    } else {
        let mut governor = SpeedLoop::<(), f64>::default();
        Box::new(move |estimate| governor.command(&law, estimate))
    };
    let mut acting = VecDeque::from(vec![0.0; late]);
    let ticks = (seconds / period) as usize;
    let (mut torque, mut swings) = (0.0, [0.0_f64; 10]);
    for tick in 0..ticks {
        let angle = (body.motor_angle() / std::f64::consts::TAU * 2.0_f64.powi(32)).round() as i64 as u32;
        eye.step(known, angle, torque);
        acting.push_back(command(&eye.estimate(known)));
        torque = acting.pop_front().unwrap();
        body.advance(gain * torque, *period);
        let swing = &mut swings[10 * tick / ticks];
        *swing = swing.max(body.motor_speed().abs());
        // A hundred times the start; half a turn in a tick, beyond which the angle is ambiguous, is far above that.
        if *swing > 100.0 {
            return false;
        }
    }
    // The angle's resolution of 1.5e-9 rad keeps a stable loop moving by less than that at its crossover.
    swings[9] < swings[4] || swings[9] < 1e-4
}

/// The printed gain margin within 5 % of that of the full plant under the library's own observer and governor, prompt
/// and a tick late.
#[test]
fn gain_margins_are_those_of_the_full_plant() {
    for scene in scenes() {
        for late in [0, 1] {
            let Scene(name, chain, observer, speed_loop, _) = &scene;
            let actuator = Actuator { delay: late as f64 * observer.period, lag: 0.0 };
            let margins = ClosedLoop::of(observer, speed_loop, actuator)
                .unwrap()
                .margins(&Plant::of_modes(chain.total_inertia(), &chain.modes()))
                .unwrap();
            println!("{name}, {late} late: {margins:?}");
            let known = TwoMassConfig::<f64>::new(observer, Bases::SI);
            let settles = |gain| settles::<observer::TwoMassObserver<f64>>(&scene, &known, gain, late);
            // infinity stands where a hundred times the gain is borne
            if margins.gain_up.is_infinite() {
                assert!(settles(100.0), "{name}, {late} late: {margins:?}");
                continue;
            }
            assert!(settles(0.95 * margins.gain_up), "{name}, {late} late: {margins:?}");
            assert!(!settles(1.05 * margins.gain_up), "{name}, {late} late: {margins:?}");
        }
    }
}

/// The same with the observer of one mass, at three rates. It takes the rope's swing for the load's doing, and damps
/// nothing.
#[test]
fn gain_margins_with_one_mass_are_those_of_the_full_plant() {
    for rate in [1_000, 4_000, 10_000] {
        let rigid = Known::CHAIN.rigid().observer(Rate::hz(rate), Known::ENCODER, Known::DISTURBANCE);
        let observer = Known::TWO_MASS.observer(Rate::hz(rate), Known::ENCODER, Known::DISTURBANCE);
        let speed_loop = Known::TWO_MASS.speed_loop(Rate::hz(rate), Known::TUNING);
        let scene = Scene("rigid", Known::CHAIN, observer, speed_loop, 6.0);
        let closed = ClosedLoop::of_rigid(&rigid, &speed_loop, Actuator::DIRECT).unwrap();
        let margins = closed.margins(&Plant::of_modes(Known::CHAIN.total_inertia(), &Known::CHAIN.modes())).unwrap();
        println!("{rate}: {margins:?}");
        let known = RigidConfig::<f64>::new(&rigid, Known::LOAD_SHARE, Bases::SI);
        let settles = |gain| settles::<observer::RigidObserver<f64>>(&scene, &known, gain, 0);
        assert!(settles(0.95 * margins.gain_up) && !settles(1.05 * margins.gain_up), "{rate}: {margins:?}");
    }
}

#[test]
fn a_loop_of_two_rates_or_far_too_late_is_refused() {
    let (observer, speed_loop) = (Hoist::<1_000>::OBSERVER, Hoist::<1_000>::SPEED_LOOP);
    let refused = |speed_loop, actuator| ClosedLoop::of(&observer, &speed_loop, actuator).err();
    assert_eq!(refused(speed_loop, Actuator { delay: 0.012, lag: 0.0 }), None);
    assert_eq!(refused(speed_loop, Actuator { delay: 0.0121, lag: 0.0 }), Some(Error::Actuator));
    assert_eq!(refused(speed_loop, Actuator { delay: 0.0, lag: f64::NAN }), Some(Error::Actuator));
    assert_eq!(refused(Hoist::<4_000>::SPEED_LOOP, Actuator::DIRECT), Some(Error::Period));
}
