//! Constants against their formulas, in SI units and per unit of bases that are no round numbers; and each limit of
//! what is accepted, from both sides.
//!
//! Fixed point has 2^28 to the base and 2^32 to a coefficient's one. A coefficient that is stated over four is widened
//! after the product; a gain is shifted up by five places, as an innovation is before its gains, a turn down by six,
//! and the factor from a turn to a speed up by sixteen (`number`).

use core::f64::consts::TAU;

use driveline::design::{
    Actuator, BacklashTakeUpDesign, BacklashTuning, BarredSpeeds, Disturbance, Encoder, ExactStep, GovernorDesign,
    InputShaperDesign, NaturalDamping, PlacedObserver, Rate, RigidDesign, SpeedLoopDesign, TorqueCurve,
};
use driveline::drive::Limits;
use driveline::governor::*;
use driveline::machine::{Damping, Gap, Inertia, Rigid, Stiffness, TwoMass};
use driveline::number::{Coefficient, Fixed};
use driveline::observer::{BacklashConfig, RigidConfig, SemiImplicitConfig, TwoMassConfig};
use driveline::settings::*;

use super::accepts;

/// 2^-32 turns of a radian, and what a base is of the last place.
const ANGLE: f64 = 4_294_967_296.0 / TAU;
const UNIT: f64 = 268_435_456.0;

/// No round numbers.
const BASES: Bases = Bases { torque: 310.0, speed: 170.0, twist: 0.031, twist_rate: 13.0, forcing: 2_700.0 };
const PERIOD: f64 = 1e-4;

/// Bases that the observers' coefficients of the machine below are within.
const SLOW: Bases = Bases { speed: 57.0, twist: 0.027, ..BASES };

/// A coefficient to half a unit in the last place.
fn coefficient(found: Coefficient, expected: f64) {
    assert!((found.to_f64() - expected).abs() <= 0.5001 / 4_294_967_296.0, "{} {expected}", found.to_f64());
}

fn number(found: Fixed, expected: f64) {
    assert!((found.to_f64() - expected).abs() <= 0.5001 / UNIT, "{} {expected}", found.to_f64());
}

/// A double to some of its last places.
fn double(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{found} {expected}");
}

/// A factor in SI units, and over the bases.
#[track_caller]
fn check(si: f64, fixed: Coefficient, value: f64, per_unit: f64) {
    double(si, value);
    coefficient(fixed, value * per_unit);
}

const NO_SHARE: [f64; 3] = [-1e-9, 1.0 + 1e-9, f64::NAN];
/// What is no torque, no speed and no time.
const NONE: [f64; 4] = [0.0, -1.0, f64::INFINITY, f64::NAN];

fn machine() -> TwoMass {
    TwoMass::new(Inertia(0.35), Inertia(0.48), Stiffness(2.0e4), Damping(0.5))
}

fn placed(machine: TwoMass, gains: [f64; 5]) -> PlacedObserver {
    let step = ExactStep::new(&machine, PERIOD);
    PlacedObserver { period: PERIOD, machine, step, gains, poles: [(0.0, 0.0); 5] }
}

#[test]
fn the_constants_of_two_masses() {
    let design = placed(machine(), [0.21, 3.0, 2e-4, 1.5, 40.0]);
    let (step, motor, load) = (design.step, 0.35 / 0.83, 0.48 / 0.83);
    let Bases { torque, speed, twist, twist_rate: rate, forcing } = SLOW;
    let (si, fixed) = (
        TwoMassConfig::<f64>::try_of_placed(&design, SLOW).unwrap(),
        TwoMassConfig::<Fixed>::try_of_placed(&design, SLOW).unwrap(),
    );
    check(si.forcing[0], fixed.forcing[0], 1.0 / 0.35, torque / forcing);
    check(si.forcing[1], fixed.forcing[1], 1.0 / 0.48, torque / forcing);
    check(si.twist[2], fixed.twist[2], step.g1, forcing / twist / 4.0);
    check(si.twist_rate[2], fixed.twist_rate[2], step.g2, forcing / rate / 4.0);
    check(si.acceleration, fixed.acceleration, PERIOD / 0.83, torque / speed);
    let turn = 1.0 / (64.0 * UNIT);
    check(si.turn[0], fixed.turn[0], 0.5 * PERIOD * ANGLE, speed * turn);
    check(si.turn[1], fixed.turn[1], load * ANGLE, twist * turn / 4.0);
    let gain = UNIT / 32.0;
    check(si.correction[0], fixed.correction[0], (motor * 3.0 + load * 1.5) / ANGLE, gain / speed);
    check(si.correction[1], fixed.correction[1], (3.0 - 1.5) / ANGLE, gain / rate);
    check(si.correction[2], fixed.correction[2], 2e-4 / ANGLE, gain / twist);
    check(si.correction[3], fixed.correction[3], 40.0 / ANGLE, gain / torque);
    check(si.angle_correction, fixed.angle_correction, -0.21, 1.0 / 32.0);
    check(si.speed, fixed.speed, 1.0 / (ANGLE * PERIOD), UNIT / speed / 65_536.0);
    check(si.share[0], fixed.share[0], load, rate / speed / 4.0);
    check(si.share[1], fixed.share[1], -motor, rate / speed / 4.0);
    check(si.shaft[0], fixed.shaft[0], 2.0e4, twist / torque / 4.0);
    check(si.shaft[1], fixed.shaft[1], 0.5, rate / torque / 4.0);
    check(si.compliance, fixed.compliance, 1.0 / 2.0e4, torque / twist / 4.0);
    // the free pair may be a unit in the last place off, so that it does not grow
    let pair = [fixed.twist[0], fixed.twist[1], fixed.twist_rate[0], fixed.twist_rate[1]].map(Coefficient::to_f64);
    let exact = [step.n11, step.n12 * rate / twist, step.n21 * twist / rate, step.n22].map(|n| n / 4.0);
    for (found, expected) in pair.iter().zip(exact) {
        assert!((found - expected).abs() <= 1.5001 / 4_294_967_296.0, "{found} {expected}");
    }
    let growth = |[a, b, c, d]: [f64; 4]| a + d + 4.0 * (a * d - b * c);
    assert!(growth(pair) <= growth(exact) && growth(exact) - growth(pair) < 1e-9);
    assert_eq!(
        [si.twist[0], si.twist[1], si.twist_rate[0], si.twist_rate[1]],
        [step.n11, step.n12, step.n21, step.n22]
    );
}

/// Rounded to `f32`, a pair without damping neither grows nor loses more than it must: of the 81 neighbours of the
/// nearest coefficients none has a square of its size, less one, between that of the one taken and the exact one. Two
/// real poles are rounded to the nearest.
#[test]
fn a_free_pair_is_rounded_so_that_it_does_not_grow() {
    let of = |stiffness: f64, damping: f64| {
        let machine = TwoMass::new(Inertia(0.35), Inertia(0.48), Stiffness(stiffness), Damping(damping));
        let design = placed(machine, [0.0; 5]);
        let (config, step) = (TwoMassConfig::<f32>::try_of_placed(&design, BASES).unwrap(), design.step);
        let found = [config.twist[0], config.twist[1], config.twist_rate[0], config.twist_rate[1]];
        (found, [step.n11, step.n12, step.n21, step.n22])
    };
    // determinant of 1 + N, less one
    let growth = |[a, b, c, d]: [f64; 4]| a + d + (a * d - b * c);
    for k in 0..60 {
        for damping in [0.0, 0.01] {
            let (found, exact) = of(1e3 * 1.2_f64.powi(k), damping);
            let (taken, limit) = (growth(found.map(f64::from)), growth(exact));
            assert!(taken <= limit, "{k}: {taken:e} {limit:e}");
            let next = |value: f32, steps: i32| {
                let unit = f32::from_bits(value.abs().to_bits() + 1) - value.abs();
                f64::from(value) + f64::from(steps) * f64::from(unit)
            };
            for near in 0..81 {
                let steps = [near % 3, near / 3 % 3, near / 9 % 3, near / 27].map(|step| step - 1);
                let tried = core::array::from_fn(|i| next(exact[i] as f32, steps[i]));
                let other = growth(tried);
                assert!(other <= taken || other > limit, "{k}: {other:e} between {taken:e} and {limit:e}");
            }
            for (found, exact) in found.iter().zip(exact) {
                let rounded = exact as f32;
                assert!((-1..=1).any(|steps| f64::from(*found) == next(rounded, steps)), "{found} {exact}");
            }
        }
    }
    for damping in [200.0, 800.0, 3_000.0] {
        let (found, exact) = of(1e3, damping);
        assert_eq!(found, exact.map(|exact| exact as f32), "{damping}");
    }
}

#[test]
fn the_constants_of_a_semi_implicit_step() {
    let design = placed(machine(), [0.21, 3.0, 2e-4, 1.5, 40.0]);
    let Bases { torque, speed, .. } = SLOW;
    let (si, fixed) = (
        SemiImplicitConfig::<f64>::try_of_placed(&design, SLOW).unwrap(),
        SemiImplicitConfig::<Fixed>::try_of_placed(&design, SLOW).unwrap(),
    );
    check(si.motor, fixed.motor, PERIOD / 0.35, torque / speed);
    check(si.load, fixed.load, PERIOD / 0.48, torque / speed);
    // the spring grows by k T v, the damper's part by d v less d v before
    check(si.shaft[0], fixed.shaft[0], 2.0e4 * PERIOD + 0.5, speed / torque);
    check(si.shaft[1], fixed.shaft[1], -0.5, speed / torque);
    check(si.turn, fixed.turn, PERIOD * ANGLE, speed / (64.0 * UNIT));
    let gain = UNIT / 32.0;
    check(si.correction[0], fixed.correction[0], 3.0 / ANGLE, gain / speed);
    check(si.correction[1], fixed.correction[1], 1.5 / ANGLE, gain / speed);
    check(si.correction[2], fixed.correction[2], (2.0e4 * 2e-4 + 0.5 * 1.5) / ANGLE, gain / torque);
    check(si.correction[3], fixed.correction[3], 40.0 / ANGLE, gain / torque);
    check(si.angle_correction, fixed.angle_correction, -0.21, 1.0 / 32.0);
    check(si.speed, fixed.speed, 1.0 / (ANGLE * PERIOD), UNIT / speed / 65_536.0);
}

#[test]
fn the_constants_of_a_rigid_machine() {
    let machine = Rigid { inertia: 0.83, gravity_torque: 0.0 };
    let design = RigidDesign {
        period: PERIOD,
        machine,
        transition: driveline::design::Matrix([[0.0; 3]; 3]),
        input: [0.0; 3],
        gains: [0.21, 3.0, 40.0],
        poles: [(0.0, 0.0); 3],
        spectral_radius: 0.0,
        standard_deviation: [0.0; 3],
        innovation: 0.0,
    };
    let Bases { torque, speed, .. } = BASES;
    let (si, fixed) = (
        RigidConfig::<f64>::try_new(&design, 0.6, BASES).unwrap(),
        RigidConfig::<Fixed>::try_new(&design, 0.6, BASES).unwrap(),
    );
    check(si.acceleration, fixed.acceleration, PERIOD / 0.83, torque / speed);
    check(si.turn, fixed.turn, 0.5 * PERIOD * ANGLE, speed / (64.0 * UNIT));
    check(si.correction[0], fixed.correction[0], 3.0 / ANGLE, UNIT / 32.0 / speed);
    check(si.correction[1], fixed.correction[1], 40.0 / ANGLE, UNIT / 32.0 / torque);
    check(si.angle_correction, fixed.angle_correction, -0.21, 1.0 / 32.0);
    check(si.speed, fixed.speed, 1.0 / (ANGLE * PERIOD), UNIT / speed / 65_536.0);
    check(si.load_share, fixed.load_share, 0.6, 0.25);
    accepts(&[0.0, 1.0], &NO_SHARE, |share| RigidConfig::<f32>::try_new(&design, share, BASES));
}

/// Bases of a machine: [`Bases::new`] by its rules, for each of the three that may decide the twist rate's.
#[test]
fn the_bases_of_a_machine() {
    let machine = machine();
    let bases = Bases::new(&machine, 300.0, 150.0);
    let twist = 1.9 * 300.0 / 2.0e4;
    double(bases.twist, twist);
    // sqrt(k (1/Jm + 1/Jl)) = 314.3 rad/s
    let resonance = (2.0e4 * (1.0 / 0.35 + 1.0 / 0.48_f64)).sqrt();
    double(bases.twist_rate, resonance * twist);
    // the lighter mass's coefficient is 0.49
    double(bases.forcing, 300.0 / (0.49 * 0.35));
    double(
        Bases::new(&TwoMass::new(Inertia(0.5), Inertia(0.48), Stiffness(2.0e4), Damping(0.5)), 300.0, 150.0).forcing,
        300.0 / (0.49 * 0.48),
    );
    // a damper whose torque would be beyond 1.9 of the base
    double(
        Bases::new(&TwoMass::new(Inertia(0.35), Inertia(0.48), Stiffness(2.0e4), Damping(70.0)), 300.0, 150.0)
            .twist_rate,
        1.9 * 300.0 / 70.0,
    );
    // and a rate beyond twice the base of the speed
    assert_eq!(Bases::new(&machine, 300.0, 4.0).twist_rate, 8.0);
    let rigid = Bases::rigid(3.0, 2.0);
    assert_eq!((rigid.torque, rigid.speed, rigid.twist, rigid.twist_rate, rigid.forcing), (3.0, 2.0, 1.0, 1.0, 1.0));
    for value in NONE {
        for bases in [
            Bases { torque: value, ..BASES },
            Bases { speed: value, ..BASES },
            Bases { twist: value, ..BASES },
            Bases { twist_rate: value, ..BASES },
            Bases { forcing: value, ..BASES },
        ] {
            assert!(DroopConfig::<Fixed>::try_new(0.03, 150.0, 300.0, 1.0, bases).is_err(), "{bases:?}");
        }
    }
}

fn speed_loop(proportional: f64, integral: f64, damping: f64) -> SpeedLoopDesign {
    SpeedLoopDesign {
        period: PERIOD,
        proportional,
        integral,
        damping,
        damping_lag: 0.0,
        speed_lag: 0.0,
        bandwidth: 0.0,
        shaft_frequency: 0.0,
        spectral_radius: 0.0,
    }
}

#[test]
fn the_constants_of_a_speed_loop() {
    let design = speed_loop(4.0, 50.0, 3.0);
    let settings = SpeedLoopSettings { torque_limit: 300.0, ramp: 70.0 };
    let si = SpeedLoopConfig::<f64>::try_new(&design, settings, BASES).unwrap();
    let fixed = SpeedLoopConfig::<Fixed>::try_new(&design, settings, BASES).unwrap();
    let gain = BASES.speed / BASES.torque / 32.0;
    for (si, fixed, value, per_unit) in [
        (si.proportional, fixed.proportional, 4.0 + 50.0 * PERIOD, gain),
        (si.damping, fixed.damping, -3.0, gain),
        (si.reset, fixed.reset, 50.0 * PERIOD / (4.0 + 50.0 * PERIOD), 1.0),
    ] {
        check(si, fixed, value, per_unit);
    }
    assert_eq!((si.torque_limit, si.ramp), (300.0, 70.0 * PERIOD));
    number(fixed.torque_limit, 300.0 / BASES.torque);
    number(fixed.ramp, 70.0 * PERIOD / BASES.speed);
    // the gain of a tick within 16 per unit, the integral's part within half of it, the damping within the base of the
    // torque at the base of the twist rate
    let unit = BASES.torque / BASES.speed;
    for (share, is_right) in [(0.999, true), (1.001, false)] {
        for [proportional, integral, damping] in [
            [share * 16.0, 0.0, 0.0],
            [9.0, share * 16.0 - 9.0, 0.0],
            [1.0, share, 0.0],
            [1.0, 0.1, share * BASES.speed / BASES.twist_rate],
            [1.0, 0.1, -share * BASES.speed / BASES.twist_rate],
        ] {
            let design = speed_loop(proportional * unit, integral * unit / PERIOD, damping * unit);
            let tried = SpeedLoopConfig::<Fixed>::try_new(&design, settings, BASES);
            assert_eq!(tried.is_ok(), is_right, "{share} {design:?} {tried:?}");
            assert!(SpeedLoopConfig::<f32>::try_new(&design, settings, BASES).is_ok());
        }
    }
    for value in [0.0, -1.0, f64::INFINITY, f64::NAN, 1e43, 1e-50] {
        let torque = SpeedLoopSettings { torque_limit: value, ..settings };
        let wrong = [torque, SpeedLoopSettings { ramp: value, ..settings }];
        accepts(&[], &wrong, |settings| SpeedLoopConfig::<f32>::try_new(&design, settings, BASES));
        accepts(&[], &wrong, |settings| SpeedLoopConfig::<f64>::try_new(&design, settings, BASES));
        accepts(&[], &wrong, |settings| SpeedLoopConfig::<Fixed>::try_new(&design, settings, BASES));
    }
    accepts(&[BASES.torque], &[1.0001 * BASES.torque], |torque_limit| {
        SpeedLoopConfig::<Fixed>::try_new(&design, SpeedLoopSettings { torque_limit, ..settings }, BASES)
    });
}

/// In a tick the integral may take up four units of 2^-32 turn: half a unit of the turn's factor, at the base of the
/// speed. More than 1 % of the torque limit in 400 ticks is refused, and so is a limit below 1/8192 of the base; each
/// remedy of the sentences is accepted.
#[test]
fn a_loop_whose_roundings_move_the_torque_is_refused() {
    let tried = |bandwidth: f64, integral: f64, limit: f64, torque: f64| {
        let design = speed_loop(16.0 * bandwidth, integral * bandwidth * bandwidth, 0.0);
        let settings = SpeedLoopSettings { torque_limit: limit, ramp: 70.0 };
        assert!(SpeedLoopConfig::<f32>::try_new(&design, settings, BASES).is_ok());
        SpeedLoopConfig::<Fixed>::try_new(&design, settings, Bases { torque, ..BASES }).map_err(Error::message)
    };
    let (base, integral) = (BASES.torque, 30_000.0);
    let limit = 100.0 * 400.0 * integral * 4.0 / ANGLE;
    assert!(limit > base / 8192.0);
    assert_eq!(tried(1.0, integral, 1.001 * limit, base).map(|_| ()), Ok(()));
    let refused = tried(1.0, integral, 0.999 * limit, base).unwrap_err();
    assert!(refused.contains("1 % of the torque limit in 400 ticks: lower the bandwidth"), "{refused}");
    assert!(tried(0.99, integral, 0.999 * limit, base).is_ok());
    assert!(tried(1.0, 1.0, 1.001 * base / 8192.0, base).is_ok());
    let refused = tried(1.0, 1.0, 0.999 * base / 8192.0, base).unwrap_err();
    assert!(refused.contains("at least 1/8192 of it: lower the base"), "{refused}");
    assert!(tried(1.0, 1.0, 0.999 * base / 8192.0, 0.99 * base).is_ok());
    // a composed governor's gains know its limit as well
    let gains = |share: f64, torque: f64| {
        let settings = SpeedLoopSettings { torque_limit: share * limit, ramp: 7.0 };
        Gains::<Fixed>::try_of_speed_loop(&speed_loop(16.0, integral, 0.0), settings, Bases { torque, ..BASES })
    };
    for base in [base, 100.0 * base] {
        assert!(gains(1.001, base).is_ok(), "{:?}", gains(1.001, base));
        assert_eq!(
            gains(0.999, base).unwrap_err().message(),
            tried(1.0, integral, 0.999 * limit, BASES.torque).unwrap_err()
        );
    }
    accepts(&[], &NONE, |torque_limit| {
        let settings = SpeedLoopSettings { torque_limit, ramp: 7.0 };
        Gains::<f64>::try_of_speed_loop(&speed_loop(1.0, 1.0, 0.0), settings, BASES)
    });
    accepts(&[1.001], &[0.999], |share| SymmetricLimitConfig::<Fixed>::try_new(share * base / 8192.0, BASES));
}

fn governor(proportional: f64, integral: f64, acceleration: f64) -> GovernorDesign {
    GovernorDesign {
        period: PERIOD,
        proportional,
        integral,
        equivalent_delay: 0.0,
        share: 0.0,
        acceleration,
        actuator: Actuator::DIRECT,
        lag: 0.0,
        natural: NaturalDamping::NONE,
    }
}

const fn with_ramp(ramp: f64) -> SpeedLoopSettings {
    SpeedLoopSettings { torque_limit: 300.0, ramp }
}

#[test]
fn the_constants_of_a_governor() {
    let gain = BASES.speed / BASES.torque / 32.0;
    let design = governor(4.0, 50.0, 0.3);
    let si = Gains::<f64>::try_new(&design, with_ramp(70.0), BASES).unwrap();
    let fixed = Gains::<Fixed>::try_new(&design, with_ramp(70.0), BASES).unwrap();
    for (si, fixed, value, per_unit) in [
        (si.proportional, fixed.proportional, 4.0 + 50.0 * PERIOD, gain),
        (si.reset, fixed.reset, 50.0 * PERIOD / (4.0 + 50.0 * PERIOD), 1.0),
    ] {
        check(si, fixed, value, per_unit);
    }
    assert_eq!(si.ramp, 70.0 * PERIOD);
    number(fixed.ramp, 70.0 * PERIOD / BASES.speed);
    // the gain of a tick within 16 per unit, the integral's part within 1/2 of it
    let unit = BASES.torque / BASES.speed;
    for (share, is_right) in [(0.999, true), (1.001, false)] {
        for [proportional, integral] in [[share * 16.0, 0.0], [9.0, share * 16.0 - 9.0], [1.0, share]] {
            let design = governor(proportional * unit, integral * unit / PERIOD, 0.3);
            assert_eq!(
                Gains::<Fixed>::try_new(&design, with_ramp(70.0), BASES).is_ok(),
                is_right,
                "{share} {design:?}"
            );
            assert!(Gains::<f32>::try_new(&design, with_ramp(70.0), BASES).is_ok());
        }
    }
    let of_loop = Gains::<f64>::try_of_speed_loop(&speed_loop(4.0, 50.0, 3.0), with_ramp(70.0), BASES).unwrap();
    assert_eq!(of_loop, si);
    accepts(&[], &[0.0, -1.0, f64::NAN, f64::INFINITY, 1e39], |proportional| {
        Gains::<f32>::try_new(&governor(proportional, 50.0, 0.3), with_ramp(70.0), BASES)
    });
    accepts(&[], &[-1.0, f64::NAN, f64::INFINITY], |integral| {
        Gains::<f64>::try_new(&governor(4.0, integral, 0.3), with_ramp(70.0), BASES)
    });
    // a unit in the last place of the base in a tick, and the least `f32`
    let place = BASES.speed / UNIT / PERIOD;
    let least = f64::from(f32::MIN_POSITIVE) / PERIOD;
    let none = [0.0, -70.0, f64::NAN, f64::INFINITY, 1e43];
    let [single, fixed] = [[&none[..], &[0.999 * least]].concat(), [&none[..], &[0.999 * place]].concat()];
    accepts(&[1.001 * place, 0.999 * place, 1.001 * least], &single, |ramp| {
        Gains::<f32>::try_new(&design, with_ramp(ramp), BASES)
    });
    accepts(&[1.001 * place], &fixed, |ramp| Gains::<Fixed>::try_new(&design, with_ramp(ramp), BASES));
}

#[test]
fn the_constants_of_a_governors_parts() {
    // 3 % of 150 rad/s at 300 N m
    let si = DroopConfig::<f64>::try_new(0.03, 150.0, 300.0, 1.0, BASES).unwrap();
    let fixed = DroopConfig::<Fixed>::try_new(0.03, 150.0, 300.0, 1.0, BASES).unwrap();
    double(si.droop, 0.015);
    coefficient(fixed.droop, 0.015 * BASES.torque / BASES.speed);
    assert!(DroopConfig::<f64>::try_new(0.0, 150.0, 300.0, 1e9, BASES).is_ok());
    // the integral alone decays by 1 - 0.015 k_i T a tick
    accepts(&[0.0, 16.6], &[16.7, -1e-9, f64::NAN], |integral| {
        DroopConfig::<f32>::try_new(0.03, 150.0, 300.0, integral, BASES)
    });
    let wrong = [
        [-0.01, 150.0, 300.0],
        [0.01, 0.0, 300.0],
        [0.01, -150.0, -300.0],
        [0.0, 150.0, 0.0],
        [0.01, 150.0, 0.0],
        [-0.01, 150.0, -300.0],
        [f64::NAN, 150.0, 300.0],
        [f64::INFINITY, 150.0, 300.0],
    ];
    accepts(&[], &wrong, |[droop, speed, torque]| DroopConfig::<f32>::try_new(droop, speed, torque, 1.0, BASES));
    let si = FeedForwardConfig::<f64>::try_new(0.7, BASES).unwrap();
    assert_eq!(si.share, 0.7);
    coefficient(FeedForwardConfig::<Fixed>::try_new(0.7, BASES).unwrap().share, 0.175);
    accepts(&[0.0, 1.0], &NO_SHARE, |share| FeedForwardConfig::<f64>::try_new(share, BASES));
    let si = AccelerationFeedbackConfig::<f64>::try_new(&governor(4.0, 50.0, 0.7), BASES).unwrap();
    assert_eq!(si.feedback, -0.7);
    let fixed = AccelerationFeedbackConfig::<Fixed>::try_new(&governor(4.0, 50.0, 0.7), BASES).unwrap();
    coefficient(fixed.feedback, -0.175);
    accepts(&[0.0], &[-1e-9, 1e39, f64::NAN], |feedback| {
        AccelerationFeedbackConfig::<f32>::try_new(&governor(4.0, 50.0, feedback), BASES)
    });
    let si = ActiveDampingConfig::<f64>::try_new(&speed_loop(4.0, 50.0, 3.0), BASES).unwrap();
    assert_eq!(si.damping, -3.0);
    let fixed = ActiveDampingConfig::<Fixed>::try_new(&speed_loop(4.0, 50.0, 3.0), BASES).unwrap();
    coefficient(fixed.damping, -3.0 * BASES.speed / BASES.torque / 32.0);
    assert!(ActiveDampingConfig::<f32>::try_new(&speed_loop(4.0, 50.0, f64::NAN), BASES).is_err());
    assert_eq!(SymmetricLimitConfig::<f64>::try_new(300.0, BASES).unwrap().torque, 300.0);
    number(SymmetricLimitConfig::<Fixed>::try_new(300.0, BASES).unwrap().torque, 300.0 / BASES.torque);
    let range = TorqueRangeConfig::<f64>::try_new(-40.0, 300.0, BASES).unwrap();
    assert_eq!((range.min, range.max), (-40.0, 300.0));
    let range = TorqueRangeConfig::<Fixed>::try_new(-40.0, 300.0, BASES).unwrap();
    number(range.min, -40.0 / BASES.torque);
    number(range.max, 300.0 / BASES.torque);
    let wrong = [[1e-9, 1.0], [-1.0, 0.0], [-1e39, 1.0], [-1.0, 1e39], [f64::NAN, 1.0], [-1.0, f64::NAN]];
    accepts(&[[0.0, 1.0], [-1.0, 1e-9]], &wrong, |[min, max]| TorqueRangeConfig::<f32>::try_new(min, max, BASES));
    let (most, beyond) = (BASES.torque, 1.0001 * BASES.torque);
    accepts(&[most], &[beyond], |most| TorqueRangeConfig::<Fixed>::try_new(-most, 0.1 * BASES.torque, BASES));
    accepts(&[most], &[beyond], |most| SymmetricLimitConfig::<Fixed>::try_new(most, BASES));
    for (delay, ticks) in [(0.0, Some(0)), (1.49e-4, Some(1)), (1.51e-4, Some(2)), (3.49e-4, Some(3))] {
        assert_eq!(TransportDelayConfig::<4>::try_new(delay, PERIOD).map(|delay| delay.ticks).ok(), ticks);
    }
    let wrong = [[3.51e-4, PERIOD], [-1e-9, PERIOD], [1e-4, 0.0], [-1e-4, -1e-4], [f64::NAN, 1.0]];
    accepts(&[], &wrong, |[delay, period]| TransportDelayConfig::<4>::try_new(delay, period));
    assert_eq!(MovingAverageConfig::<f64, 8>::of_ticks().share, 0.125);
    assert_eq!(MovingAverageConfig::<f32, 8>::of_ticks().share, 0.125);
    assert_eq!(MovingAverageConfig::<Fixed, 8>::of_ticks().share.to_f64(), 0.125);
}

#[test]
fn the_constants_of_a_sequencer() {
    let settings = SequencerSettings {
        overspeed: 180.0,
        underspeed: 120.0,
        reverse: 10.0,
        shaft_torque: 500.0,
        standstill: 2.0,
        trip_delay: 2.49e-4,
        underspeed_delay: 3.51e-4,
        start: 9.0,
    };
    let si = SequencerConfig::<f64>::try_new(&settings, PERIOD, BASES).unwrap();
    assert_eq!((si.running.middle, si.running.half), (150.0, 30.0));
    assert_eq!((si.allowed.middle, si.allowed.half), (85.0, 95.0));
    assert_eq!((si.shaft_torque, si.standstill), (500.0, 2.0));
    assert_eq!((si.trip_delay, si.underspeed_delay, si.start), (2, 4, 90_000));
    let fixed = SequencerConfig::<Fixed>::try_new(&settings, PERIOD, BASES).unwrap();
    for (found, expected) in [
        (fixed.running.middle, 150.0 / BASES.speed),
        (fixed.running.half, 30.0 / BASES.speed),
        (fixed.allowed.middle, 85.0 / BASES.speed),
        (fixed.allowed.half, 95.0 / BASES.speed),
        (fixed.shaft_torque, 500.0 / BASES.torque),
        (fixed.standstill, 2.0 / BASES.speed),
    ] {
        number(found, expected);
    }
    // both ways
    let both = SequencerSettings { underspeed: -1.0, reverse: 180.0, ..settings };
    let si = SequencerConfig::<f64>::try_new(&both, PERIOD, BASES).unwrap();
    assert_eq!((si.running.middle, si.running.half, si.allowed.middle, si.allowed.half), (0.0, 180.0, 0.0, 180.0));
    let tried = |change: &dyn Fn(&mut SequencerSettings)| {
        let mut settings = settings;
        change(&mut settings);
        SequencerConfig::<f64>::try_new(&settings, PERIOD, BASES).is_ok()
    };
    for (change, is_right) in [
        ((|s| s.standstill = 0.0) as fn(&mut SequencerSettings), false),
        (|s| s.standstill = 119.0, true),
        (|s| s.standstill = 120.0, false),
        (|s| s.underspeed = 179.0, true),
        (|s| s.underspeed = 180.0, false),
        (|s| s.underspeed = 0.0, false),
        (|s| s.underspeed = -0.1, true),
        (|s| (s.underspeed, s.standstill) = (-0.1, 179.0), true),
        (|s| (s.underspeed, s.standstill) = (-0.1, 180.0), false),
        (|s| s.reverse = 0.0, true),
        (|s| s.reverse = -0.1, false),
        (|s| s.shaft_torque = 0.0, false),
        (|s| s.shaft_torque = f64::INFINITY, false),
        (|s| s.overspeed = f64::INFINITY, false),
        (|s| s.reverse = f64::INFINITY, false),
        (|s| s.underspeed = f64::NEG_INFINITY, false),
        (|s| s.trip_delay = -1e-9, false),
        (|s| s.trip_delay = 0.0, true),
        (|s| s.start = 2_147_483_646.9 * PERIOD, true),
        (|s| s.start = 2_147_483_647.9 * PERIOD, false),
        (|s| s.underspeed_delay = f64::NAN, false),
    ] {
        assert_eq!(tried(&change), is_right);
    }
}

#[test]
fn the_constants_of_shapes() {
    let barred = BarredSpeeds::<1>::new(&[100.0], &[1.0], 0.1, 200.0);
    let si = BarredConfig::<f64, 1>::try_new(&barred, 70.0, PERIOD, BASES).unwrap();
    let [[low, high]] = [barred.ranges()[0]];
    double(si.ranges[0].middle, 0.5 * (low + high));
    double(si.ranges[0].half, 0.5 * (high - low));
    double(si.quick, 70.0 * PERIOD);
    let fixed = BarredConfig::<Fixed, 1>::try_new(&barred, 70.0, PERIOD, BASES).unwrap();
    number(fixed.ranges[0].middle, 0.5 * (low + high) / BASES.speed);
    number(fixed.ranges[0].half, 0.5 * (high - low) / BASES.speed);
    number(fixed.quick, 70.0 * PERIOD / BASES.speed);
    assert!(
        BarredConfig::<f64, 2>::try_new(&BarredSpeeds::new(&[100.0], &[1.0], 0.1, 200.0), 70.0, PERIOD, BASES).is_err()
    );
    accepts(&[], &[0.0, -70.0, f64::NAN, 1e43], |ramp| BarredConfig::<f32, 1>::try_new(&barred, ramp, PERIOD, BASES));
    accepts(&[1.001], &[0.999], |places| {
        BarredConfig::<Fixed, 1>::try_new(&barred, places / UNIT * BASES.speed / PERIOD, PERIOD, BASES)
    });
    accepts(&[1.001], &[0.999], |places| {
        SlewConfig::<Fixed, ()>::try_new(places / UNIT * BASES.torque / PERIOD, (), PERIOD, BASES)
    });

    let curve = TorqueCurve::through([[0.0, 100.0], [50.0, 250.0], [90.0, 200.0]]);
    let si = CurveConfig::<f64, 3>::try_new(&curve, -20.0, BASES).unwrap();
    let fixed = CurveConfig::<Fixed, 3>::try_new(&curve, -20.0, BASES).unwrap();
    for (k, [speed, torque, slope]) in
        [[0.0, 100.0, 3.0], [50.0, 250.0, -1.25], [90.0, 200.0, 0.0]].into_iter().enumerate()
    {
        let piece = si.pieces[k];
        assert_eq!([piece.speed, piece.torque, piece.slope], [speed, torque, slope]);
        number(fixed.pieces[k].speed, speed / BASES.speed);
        number(fixed.pieces[k].torque, torque / BASES.torque);
        coefficient(fixed.pieces[k].slope, slope * BASES.speed / BASES.torque / 4.0);
    }
    assert_eq!(si.min, -20.0);
    number(fixed.min, -20.0 / BASES.torque);
    accepts(&[0.0], &[1e-9, f64::NAN, f64::NEG_INFINITY], |min| CurveConfig::<f64, 3>::try_new(&curve, min, BASES));

    let si = SlewConfig::<f64, ()>::try_new(5_000.0, (), PERIOD, BASES).unwrap();
    double(si.step, 0.5);
    number(SlewConfig::<Fixed, ()>::try_new(5_000.0, (), PERIOD, BASES).unwrap().step, 0.5 / BASES.torque);
    accepts(&[], &[0.0, -1.0, f64::NAN, 1e43], |rate| SlewConfig::<f32, ()>::try_new(rate, (), PERIOD, BASES));

    let design = InputShaperDesign { delay: 0.8, share: 0.4 };
    let si = InputShaperConfig::<f64, ()>::try_new(&design, 16, 70.0, (), PERIOD, BASES).unwrap();
    assert_eq!((si.slot, si.share, si.ramp), (500, 0.4, 70.0 * PERIOD));
    let fixed = InputShaperConfig::<Fixed, ()>::try_new(&design, 16, 70.0, (), PERIOD, BASES).unwrap();
    coefficient(fixed.share, 0.4);
    number(fixed.ramp, 70.0 * PERIOD / BASES.speed);
    let (right, wrong) = ([0.5, 1e-6], [0.5001, 0.0, f64::NAN]);
    let of = |share| InputShaperDesign { share, ..design };
    accepts(&right, &wrong, |s| InputShaperConfig::<f64, ()>::try_new(&of(s), 16, 70.0, (), PERIOD, BASES));
    accepts(&right, &wrong, |s| InputShaperConfig::<Fixed, ()>::try_new(&of(s), 16, 70.0, (), PERIOD, BASES));
}

#[test]
fn the_constants_of_a_load_sharing() {
    let settings = LoadSharingSettings {
        motors: 4,
        preload: 30.0,
        equal_above: 60.0,
        bias_below: 40.0,
        slew: 900.0,
        torque_limit: 400.0,
        damping: 2.5,
        lag: 0.0017,
        max_deviation: 0.2,
    };
    let si = LoadSharingConfig::<f64>::try_new(&settings, PERIOD, BASES).unwrap();
    assert_eq!((si.share, si.preload, si.equal_above, si.bias_below), (0.25, 30.0, 60.0, 40.0));
    double(si.step, 0.09);
    // 17 ticks are next to 16 by ratio
    assert_eq!((si.torque_limit, si.lag, si.max_deviation), (400.0, 4, (0.2 * ANGLE) as i32));
    let damping = -2.5 / (16.0 * PERIOD) / ANGLE;
    double(si.damping, damping);
    let fixed = LoadSharingConfig::<Fixed>::try_new(&settings, PERIOD, BASES).unwrap();
    coefficient(fixed.share, 0.25 / 4.0);
    coefficient(fixed.damping, damping * UNIT / BASES.torque / 32.0);
    for (found, expected) in [
        (fixed.preload, 30.0),
        (fixed.equal_above, 60.0),
        (fixed.bias_below, 40.0),
        (fixed.step, 0.09),
        (fixed.torque_limit, 400.0),
    ] {
        number(found, expected / BASES.torque);
    }
    for (ticks, lag) in
        [(1.0, 0), (1.41, 0), (1.42, 1), (2.82, 1), (2.83, 2), (46_340.0, 15), (46_342.0, 16), (65_536.0, 16)]
    {
        let settings = LoadSharingSettings { lag: ticks, ..settings };
        assert_eq!(LoadSharingConfig::<f64>::try_new(&settings, 1.0, BASES).unwrap().lag, lag, "{ticks}");
    }
    let tried = |change: fn(&mut LoadSharingSettings)| {
        let mut settings = settings;
        change(&mut settings);
        LoadSharingConfig::<f64>::try_new(&settings, PERIOD, BASES).is_ok()
    };
    for (change, is_right) in [
        ((|s| s.motors = 2) as fn(&mut LoadSharingSettings), true),
        (|s| s.motors = 0, false),
        (|s| s.motors = 3, false),
        (|s| (s.motors, s.max_deviation) = (32, 0.09), true),
        (|s| (s.motors, s.max_deviation) = (34, 0.09), false),
        (|s| s.bias_below = 0.0, false),
        (|s| s.bias_below = 60.0, false),
        (|s| s.bias_below = 59.9, true),
        (|s| s.torque_limit = 150.0, true),
        (|s| s.torque_limit = 149.9, false),
        (|s| s.preload = 0.0, false),
        (|s| s.preload = -1.0, false),
        (|s| s.slew = 0.0, false),
        (|s| s.damping = 0.0, true),
        (|s| s.damping = -1e-9, false),
        (|s| s.damping = f64::NAN, false),
        (|s| s.lag = 0.99e-4, false),
        (|s| s.lag = 6.5537, false),
        (|s| s.lag = f64::NAN, false),
        // a count of 2^-32 turn, and half a turn among four
        (|s| s.max_deviation = 1.001 / ANGLE, true),
        (|s| s.max_deviation = 0.999 / ANGLE, false),
        (|s| s.max_deviation = 0.999 * TAU / 8.0, true),
        (|s| s.max_deviation = 1.001 * TAU / 8.0, false),
    ] {
        assert_eq!(tried(change), is_right);
    }
}

#[test]
fn the_constants_of_screening_and_monitor() {
    let screening = Screening { torque: 400.0, setpoint: 160.0, innovation: 0.01, frozen_turn: 0.02, max_coast: 7 };
    let si = Limits::<f64>::try_new(&screening, BASES).unwrap();
    assert_eq!((si.torque, si.setpoint, si.max_coast), (400.0, 160.0, 7));
    double(si.innovation, 0.01 * ANGLE);
    double(si.frozen_turn, 0.02 * ANGLE);
    let fixed = Limits::<Fixed>::try_new(&screening, BASES).unwrap();
    number(fixed.torque, 400.0 / BASES.torque);
    number(fixed.setpoint, 160.0 / BASES.speed);
    assert_eq!(fixed.innovation.to_bits(), (0.01 * ANGLE) as i32);
    assert_eq!(fixed.frozen_turn.to_bits(), (0.02 * ANGLE) as i32 >> 6);
    // 2^26 - 1 counts of 2^-32 turn
    for (counts, is_right) in [(67_108_862.5, true), (67_108_863.5, false)] {
        let innovation = Screening { innovation: counts / ANGLE, ..screening };
        let frozen = Screening { frozen_turn: counts / ANGLE, ..screening };
        for screening in [innovation, frozen] {
            assert_eq!(Limits::<Fixed>::try_new(&screening, BASES).is_ok(), is_right, "{counts}");
            assert!(Limits::<f32>::try_new(&screening, BASES).is_ok());
        }
    }
    let (of, wrong) = (|frozen_turn| Screening { frozen_turn, ..screening }, [-1e-9, f64::NAN, f64::INFINITY]);
    accepts(&[0.0], &wrong, |turn| Limits::<f64>::try_new(&of(turn), BASES));
    accepts(&[0.0], &wrong, |turn| Limits::<Fixed>::try_new(&of(turn), BASES));
    // 1e43 is beyond `f32`
    accepts(&[], &[1e43], |turn| Limits::<f32>::try_new(&of(turn), BASES));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e43] {
        for screening in [
            Screening { torque: value, ..screening },
            Screening { setpoint: value, ..screening },
            Screening { innovation: value, ..screening },
        ] {
            assert!(Limits::<f32>::try_new(&screening, BASES).is_err(), "{screening:?}");
            assert!(Limits::<Fixed>::try_new(&screening, BASES).is_err(), "{screening:?}");
        }
    }

    let settings = ActuatorMonitorSettings { tolerance: 15.0, max_torque: 350.0, timeout: 0.25 };
    let si = ActuatorMonitorConfig::<f64, 2>::try_new(&[1e-4, 3e-4], &settings, PERIOD, BASES).unwrap();
    // 1 - 1/e, and 1 - e^(-1/3)
    double(si.share[0], 0.632_120_558_828_557_7);
    double(si.share[1], 0.283_468_689_426_210_74);
    assert_eq!((si.tolerance, si.max_torque, si.timeout), (15.0, 350.0, 2_500));
    let fixed = ActuatorMonitorConfig::<Fixed, 1>::try_new(&[3e-4], &settings, PERIOD, BASES).unwrap();
    coefficient(fixed.share[0], 0.283_468_689_426_210_74);
    number(fixed.tolerance, 15.0 / BASES.torque);
    number(fixed.max_torque, 350.0 / BASES.torque);
    type Monitor<N> = ActuatorMonitorConfig<N, 1>;
    accepts(&[], &NONE, |lag| Monitor::<f32>::try_new(&[lag], &settings, PERIOD, BASES));
    let wrong = [
        [350.0, 350.0],
        [0.0, 350.0],
        [-1.0, 350.0],
        [1e-46, 350.0],
        [1e39, 1e40],
        [f64::NAN, 350.0],
        [15.0, f64::INFINITY],
    ];
    accepts(&[[349.0, 350.0]], &wrong, |[tolerance, max_torque]| {
        let settings = ActuatorMonitorSettings { tolerance, max_torque, ..settings };
        Monitor::<f32>::try_new(&[1e-3], &settings, PERIOD, BASES)
    });
    accepts(&[], &[-1.0], |timeout| {
        Monitor::<f32>::try_new(&[1e-3], &ActuatorMonitorSettings { timeout, ..settings }, PERIOD, BASES)
    });
    // in fixed point a lag of 1.44 ticks covers half its way in one
    accepts(&[1.45], &[1.44], |ticks| Monitor::<Fixed>::try_new(&[ticks * PERIOD], &settings, PERIOD, BASES));
    accepts(&[1.001], &[0.999], |places| {
        let settings = ActuatorMonitorSettings { tolerance: places / UNIT * BASES.torque, ..settings };
        Monitor::<Fixed>::try_new(&[1e-3], &settings, PERIOD, BASES)
    });
}

/// Torques over the base, a rate times the period, what damps with its sign and per unit of the bases, and 1/k_p.
#[test]
fn the_constants_of_a_backlash_take_up() {
    let design = BacklashTakeUpDesign {
        period: PERIOD,
        approach_speed: 0.3,
        torque: 11.0,
        braking: 27.0,
        slew: 4_100.0,
        fall: 9_300.0,
        max_torque: 290.0,
        damping: 23.0,
    };
    let limit = SymmetricLimitConfig { torque: 1.0 };
    let si = BacklashTakeUpConfig::<f64, _>::try_new(&design, 17.0, limit, Bases::SI).unwrap();
    let fixed = BacklashTakeUpConfig::<Fixed, _>::try_new(&design, 17.0, limit, BASES).unwrap();
    let Bases { torque, speed, .. } = BASES;
    for (si, fixed, expected) in [
        (si.torque, fixed.torque, 11.0),
        (si.step, fixed.step, 0.41),
        (si.fall, fixed.fall, -0.93),
        (si.max_torque, fixed.max_torque, 290.0),
    ] {
        double(si, expected);
        number(fixed, expected / torque);
    }
    double(si.braking, -27.0);
    double(si.damping, -23.0);
    double(si.tracking, 1.0 / 17.0);
    coefficient(fixed.braking, -27.0 * speed / torque / 32.0);
    coefficient(fixed.damping, -23.0 * speed / torque / 32.0);
    coefficient(fixed.tracking, torque / (17.0 * speed) / 4.0);
}

/// In contact the constants of two masses; the damper's law that a tick begins or ends with, the step of free flight,
/// and the searching gains.
#[test]
fn the_constants_of_a_backlash_observer() {
    let machine = TwoMass::new(Inertia(0.35), Inertia(0.48), Stiffness(2.0e4), Damping(40.0)).with_gap(Gap(0.004));
    let disturbance = Disturbance { torque_accuracy: 1.0, load_torque_step: 10.0, within: 0.05 };
    let mut design = machine.backlash_observer(
        Rate::hz(10_000),
        Encoder::lines(2048),
        disturbance,
        BacklashTuning { wander: 0.5, hold: 1.0, ..BacklashTuning::USUAL },
    );
    design.searching = [0.31, 5.0, 3e-4, 2.0, 60.0];
    let bases = Bases::new(&machine, 310.0, 57.0);
    let (si, fixed) = (
        BacklashConfig::<f64>::try_new(&design, bases).unwrap(),
        BacklashConfig::<Fixed>::try_new(&design, bases).unwrap(),
    );
    let Bases { torque, speed, twist, twist_rate: rate, forcing } = bases;
    // d/J of the two masses in series
    let damper = 40.0 * (1.0 / 0.35 + 1.0 / 0.48);
    let step = design.contact.step;
    let rest = -step.n22 / PERIOD - damper;
    let late = 1.0 - step.n12 / PERIOD;
    number(fixed.half_gap, 0.002 / twist);
    for (index, value, per_unit) in [(0, damper, twist / rate / 4.0), (1, rest, twist / rate / 4.0), (2, late, 0.25)] {
        check(si.contact.leaving[index], fixed.contact.leaving[index], value, per_unit);
        check(si.free.meeting[index], fixed.free.meeting[index], -value, per_unit);
    }
    // without a shaft the twist rate stays: the twist moves by T v + T^2/2 s
    check(si.free.twist[0], fixed.free.twist[0], PERIOD, rate / twist / 4.0);
    check(si.free.twist[1], fixed.free.twist[1], 0.5 * PERIOD * PERIOD, forcing / twist / 4.0);
    check(si.free.twist_rate, fixed.free.twist_rate, PERIOD, forcing / rate / 4.0);
    let (motor, load, gain) = (0.35 / 0.83, 0.48 / 0.83, UNIT / 32.0);
    let (si, fixed) = (si.searching, fixed.searching);
    check(si.states[0], fixed.states[0], (motor * 5.0 + load * 2.0) / ANGLE, gain / speed);
    check(si.states[1], fixed.states[1], (5.0 - 2.0) / ANGLE, gain / rate);
    check(si.states[2], fixed.states[2], 3e-4 / ANGLE, gain / twist);
    check(si.states[3], fixed.states[3], 60.0 / ANGLE, gain / torque);
    check(si.angle, fixed.angle, -0.31, 1.0 / 32.0);
}
