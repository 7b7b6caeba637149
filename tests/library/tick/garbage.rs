//! Arbitrary bits in every word of the sample, for thousands of ticks: no panic (these tests run with overflow checks),
//! no NaN, no infinity, no torque beyond the limit; and when the garbage stops, the estimates are right again.

use crate::hoist::{CutAtRope, Exact, Hoist, Of, Reduced, Rigid, Variant};
use driveline::drive::{Config, Drive, Limits};
use driveline::fault::Faults;
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::number::{Fixed, Part, StateOf};
use driveline::observer::{GearedObserver, Observer, Stiction};
use driveline::sample::Sample;

use proptest::prelude::*;

use super::rig::{RATED_SPEED, Scaled, Seen, check};

/// Time in which the estimates are right again (s): the angle is lost after 20 ms and caught by two angles that differ;
/// what the restart leaves fades with a time constant of at most 89 ms, of which ten fit.
const RECOVERY: f64 = 0.9;

/// How each sample is made from random words.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Everything random.
    Noise,
    /// The angle goes on from the last one by the random word over 2^n: what passes the screening is driven hard.
    Walk(u32),
    /// The angle stands, torque and setpoint are random.
    Frozen,
    /// The angle moves steadily by the random word of the first tick over 2^n, full torque.
    Steady(u32),
}

fn kinds() -> impl Strategy<Value = Vec<(Kind, u32, u64)>> {
    let kind = prop_oneof![
        Just(Kind::Noise),
        (0..20_u32).prop_map(Kind::Walk),
        Just(Kind::Frozen),
        (0..20_u32).prop_map(Kind::Steady),
    ];
    prop::collection::vec((kind, 1..2_000_u32, any::<u64>()), 1..6)
}

/// splitmix64 [Steele, Lea and Flood 2014].
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ *state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// Plays the garbage, then a machine that turns steadily at half of rated speed under a torque of 500 N m.
fn plays<N: Scaled, O: Part<N, State: Observer<N>>>(
    name: &str,
    rate: u32,
    limits: Limits<N>,
    observer: <StateOf<O, N> as Observer<N>>::Config,
    governor: SpeedLoopConfig<N>,
    garbage: &[(Kind, u32, u64)],
) {
    let config = Config { limits, observer, fluctuation: (), governor, balancer: () };
    let mut drive = Drive::<N, O, SpeedLoop>::new(&config, 0);
    let mut angle = 0_u32;
    for &(kind, ticks, seed) in garbage {
        let mut state = seed;
        let first = next(&mut state) as i32;
        for _ in 0..ticks {
            let (words, walk) = (next(&mut state), next(&mut state));
            angle = match kind {
                Kind::Noise => walk as u32,
                Kind::Walk(places) => angle.wrapping_add((walk as i32 >> places) as u32),
                Kind::Frozen => angle,
                Kind::Steady(places) => angle.wrapping_add((first >> places) as u32),
            };
            let mut torque = N::from_word(words as u32);
            if matches!(kind, Kind::Steady(_)) {
                torque = if first < 0 { config.limits.torque } else { -config.limits.torque };
            }
            let sample = Sample { angle, torque, setpoint: N::from_word((words >> 32) as u32) };
            let command = Seen::new(drive.tick(&config, &sample), drive.estimate(&config));
            check(name, config.governor.torque_limit, &command);
            if walk % 997 == 0 {
                // Any torque may be held against the brake too.
                let held = drive.hold(&config, angle, N::from_word(words as u32));
                assert!(!held.torque.exceeds(config.limits.torque), "{name}: {held:?}");
            }
        }
    }
    let (speed, torque) = (0.5 * RATED_SPEED, 500.0);
    let turn = speed / f64::from(rate) / core::f64::consts::TAU * 4_294_967_296.0;
    let ticks = (RECOVERY * f64::from(rate)) as u32;
    for tick in 1..=ticks {
        let sample = Sample {
            angle: angle.wrapping_add((turn * f64::from(tick)) as u64 as u32),
            torque: N::of_torque(torque),
            setpoint: N::of_speed(speed),
        };
        let command = Seen::new(drive.tick(&config, &sample), drive.estimate(&config));
        check(name, config.governor.torque_limit, &command);
        if tick == ticks {
            let now = command.estimate;
            assert_eq!(command.faults, Faults::NONE, "{name} after {garbage:?}");
            // A hundredth of rated speed and of the torque.
            for error in [now.motor_speed.speed() - speed, now.load_speed.speed() - speed] {
                assert!(error.abs() < 0.01 * RATED_SPEED, "{name}: {now:?} after {garbage:?}");
            }
            // A gear of 94 % takes up to 6.4 % off, and holds what it took at a standstill.
            for torque in [now.shaft_torque.torque(), now.load_torque.torque()] {
                assert!(torque > 460.0 && torque < 505.0, "{name}: {now:?} after {garbage:?}");
            }
        }
    }
}

/// With the gear and without.
fn both<V, O>(garbage: &[(Kind, u32, u64)])
where
    V: Variant<Number: Scaled + Stiction, Observer = GearedObserver<O>>,
    O: Part<V::Number, State: Observer<V::Number, Config: Copy>>,
{
    let Config { limits, observer, governor, .. } = V::CONFIG;
    let geared = driveline::observer::GearedConfig { ..*observer };
    plays::<V::Number, GearedObserver<O>>(V::NAME, V::RATE_HZ, *limits, geared, *governor, garbage);
    let name = format!("{} without gear", V::NAME);
    plays::<V::Number, O>(&name, V::RATE_HZ, *limits, observer.observer, *governor, garbage);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn nothing_poisons_a_single(garbage in kinds()) {
        both::<Of<Hoist<10000>, f32, Rigid>, _>(&garbage);
        both::<Of<CutAtRope<10000>, f32, Exact>, _>(&garbage);
        both::<Of<Hoist<10000>, f32, Exact>, _>(&garbage);
        both::<Of<Hoist<10000>, f32, Reduced>, _>(&garbage);
    }

    #[test]
    fn nothing_poisons_a_fixed(garbage in kinds()) {
        both::<Of<Hoist<10000>, Fixed, Rigid>, _>(&garbage);
        both::<Of<CutAtRope<10000>, Fixed, Exact>, _>(&garbage);
        both::<Of<Hoist<10000>, Fixed, Exact>, _>(&garbage);
        both::<Of<Hoist<10000>, Fixed, Reduced>, _>(&garbage);
    }

    #[test]
    fn nothing_poisons_a_slow_drive(garbage in kinds()) {
        both::<Of<Hoist<1000>, f32, Rigid>, _>(&garbage);
        both::<Of<Hoist<1000>, f32, Exact>, _>(&garbage);
        both::<Of<Hoist<1000>, Fixed, Rigid>, _>(&garbage);
        both::<Of<Hoist<1000>, Fixed, Reduced>, _>(&garbage);
    }
}

/// The overflow checks that make the garbage tell are on.
#[test]
#[should_panic(expected = "overflow")]
fn overflow_is_checked() {
    let one = core::hint::black_box(1);
    core::hint::black_box(i32::MAX + one);
}
