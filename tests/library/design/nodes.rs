//! Vibrations with a node at the motor: no torque of the motor moves them, so they are no part of the loop.

use driveline::design::{Actuator, ClosedLoop, Disturbance, Encoder, Margins, Plant, Rate, SpeedLoopTuning};
use driveline::machine::{Chain, Damping, Efficiency, Inertia, Match, Modes, Ratio, Stiffness, Train, TwoMass};

/// Engine and pinions of the twin-screw ship of `machines/ship.toml` [Friswell et al. 2010, example 9.6.3], with a
/// hundredth of critical damping in the engine's shaft.
fn engine() -> Chain {
    Chain::motor(Inertia(3200.0)).shaft(Stiffness(4.272_566e6), Damping(800.0)).rotor(Inertia(400.0))
}

/// A screw, or `count` of them as one.
fn screw(count: f64) -> Chain {
    Chain::motor(Inertia(f64::MIN_POSITIVE))
        .gear(Ratio(1.6), Efficiency(1.0))
        .rotor(Inertia(800.0 * count))
        .shaft(Stiffness(7.450_764e6 * count), Damping(3000.0 * count))
        .rotor(Inertia(450.0 * count))
}

fn margins(two: &TwoMass, modes: &Modes) -> Margins {
    let rate = Rate::hz(2000);
    let disturbance = Disturbance { torque_accuracy: 500.0, load_torque_step: 2.0e4, within: 1.0 };
    let observer = two.observer(rate, Encoder::lines(2048), disturbance);
    let speed_loop = two.speed_loop(rate, SpeedLoopTuning::of(two));
    let closed = ClosedLoop::of(&observer, &speed_loop, Actuator::DIRECT).unwrap();
    closed.margins(&Plant::of_modes(two.total_inertia(), modes)).unwrap()
}

/// Two equal screws swing against one another with a node at the pinions: the motor sees them as one. The margins are
/// those of the merged machine to the rounding of two ways to the modes, 1e-14 of each frequency and 1e-8 of a
/// crossover's bisection.
#[test]
fn screws_that_swing_against_one_another_change_no_margin() {
    let twin = Train::of(engine()).branch(1, Ratio(1.0), screw(1.0)).branch(1, Ratio(1.0), screw(1.0));
    let merged = Train::of(engine()).branch(1, Ratio(1.0), screw(2.0));
    let (modes, fewer) = (twin.modes(), merged.modes());
    assert_eq!(modes.resonances().len(), fewer.resonances().len() + 1);
    assert!(modes.resonances().iter().any(|mode| mode.residue * twin.total_inertia() < 1e-20));
    let two = merged.reduce(Match::ResonanceAntiresonance);
    let (margins, expected) = (margins(&two, &modes), margins(&two, &fewer));
    println!("{margins:?}\n{expected:?}");
    for (found, expected) in [
        (margins.gain_up, expected.gain_up),
        (margins.phase, expected.phase),
        (margins.delay, expected.delay),
        (margins.modulus, expected.modulus),
    ] {
        assert!((found / expected - 1.0).abs() < 1e-6, "{margins:?} {expected:?}");
    }
}

/// A node with no damping at all has its poles on the unit circle, which counted as unstable.
#[test]
fn an_undamped_vibration_that_the_motor_does_not_feel_is_no_instability() {
    let undamped = Chain::motor(Inertia(f64::MIN_POSITIVE))
        .gear(Ratio(1.6), Efficiency(1.0))
        .rotor(Inertia(800.0))
        .shaft(Stiffness(7.450_764e6), Damping(0.0))
        .rotor(Inertia(450.0));
    // The damping in the engine's shaft damps every vibration that the motor feels.
    let twin = Train::of(engine()).branch(1, Ratio(1.0), undamped).branch(1, Ratio(1.0), undamped);
    let node = twin.modes().resonances().iter().find(|mode| mode.residue * twin.total_inertia() < 1e-20).copied();
    assert!(node.unwrap().damping < 1e-12, "{node:?}");
    let two = twin.reduce(Match::ResonanceAntiresonance);
    let found = margins(&two, &twin.modes());
    println!("{found:?}");
    assert!(found.gain_up > 1.0);
}

/// A second vibration of hardly any damping: its circle passes -1 between two frequencies that are 2e-4 apart. The
/// distance is that of a model in numpy (matrices of the chain, `expm`, the filter by `solve_discrete_are`), in steps of
/// a fiftieth of the way to the resonance and refined; the margins must agree with each other as well.
#[test]
fn a_narrow_vibration_is_not_passed_over() {
    let chain = Chain::motor(Inertia(18.043_720_429_844_353))
        .shaft(Stiffness(39_005.697_006_383_07), Damping(0.021_847_896_412_264_096))
        .rotor(Inertia(5.227_159_749_260_714))
        .shaft(Stiffness(199_533.736_972_840_94), Damping(0.302_283_275_314_516_43))
        .rotor(Inertia(19.224_912_030_620_423));
    let (two, rate) = (chain.reduce(Match::ResonanceAntiresonance), Rate::hz(16_000));
    let disturbance = Disturbance {
        torque_accuracy: 2.281_718_208_360_777_7,
        load_torque_step: 164.696_016_154_577_9,
        within: 0.179_810_729_986_653_34,
    };
    let observer = two.observer(rate, Encoder::lines(321), disturbance);
    let speed_loop = two.speed_loop(rate, SpeedLoopTuning::with_bandwidth(&two, 0.3));
    let actuator = Actuator { delay: 0.000_125, lag: 1.0 / (core::f64::consts::TAU * 800.0) };
    let closed = ClosedLoop::of(&observer, &speed_loop, actuator).unwrap();
    let found = closed.margins(&Plant::of_modes(chain.total_inertia(), &chain.modes())).unwrap();
    println!("{found:?}");
    assert!(
        found.modulus <= 1.0 - 1.0 / found.gain_up && found.modulus <= 2.0 * (0.5 * found.phase).sin(),
        "{found:?}"
    );
    // 2 %: the modal damping, and steps of a tenth at worst
    assert!((found.modulus / 0.085_054 - 1.0).abs() < 0.02, "{found:?}");
}
