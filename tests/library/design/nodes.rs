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
