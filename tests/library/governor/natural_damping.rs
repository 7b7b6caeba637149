//! The governor's design with the slopes of prime mover and load, against closed forms and the full solver.

use driveline::design::{Actuator, Error, GovernorDesign, LoadFeedForward, NaturalDamping, Rate};
use driveline::machine::{Characteristic, Damping, Inertia, Line, Parabola, Speed, Stiffness, TwoMass};
use driveline_solver::plant::{Chain, Shaft};

use super::SET;
use super::design::chain_settles;

const LAG: f64 = 0.05;
const TICK: f64 = 1e-5;

/// One mass of 12.4 kg m2 as far as a governor below 20 rad/s can see: antiresonance 11,000 rad/s.
fn stiff() -> TwoMass {
    TwoMass::new(Inertia(4.4), Inertia(8.0), Stiffness(1.0e9), Damping(1.0e4))
}

fn design(natural: NaturalDamping) -> GovernorDesign {
    let actuator = Actuator { delay: 0.0, lag: LAG };
    let free = stiff().governor(Rate::every(TICK), actuator, 2.5, LoadFeedForward::NONE);
    free.with_natural_damping(&stiff(), natural)
}

/// The integral has the error of its own tick already: half a tick more of it.
fn proportional(design: &GovernorDesign) -> f64 {
    design.proportional + 0.5 * TICK * design.integral
}

/// `(k_p + k_i/s)/((J s + D)(1 + T s))` of one mass: gain and phase at a frequency, the phase below half a turn either
/// way from that of the double integrator.
fn rigid_loop(design: &GovernorDesign, damping: f64, frequency: f64) -> (f64, f64) {
    let (kp, ki) = (proportional(design), design.integral / frequency);
    let mass = (12.4 * frequency).atan2(damping);
    let size = kp.hypot(ki) / (12.4 * frequency).hypot(damping) / 1.0_f64.hypot(LAG * frequency);
    // The tick's hold and its wait, one and a half of it, are dead time.
    (size, -ki.atan2(kp) - mass - (LAG * frequency).atan() - 1.5 * TICK * frequency)
}

#[test]
fn margins_are_those_of_one_mass_with_damping() {
    let free = design(NaturalDamping::NONE);
    for damping in [0.01, 2.0, 40.0, 100.0, 400.0, 5e3, 5e4, -2.0, -40.0] {
        // At either mass it is the same to a governor that sees one.
        for natural in [NaturalDamping { motor: damping, load: 0.0 }, NaturalDamping { motor: 0.0, load: damping }] {
            let design = design(natural);
            assert_eq!((design.proportional, design.integral), (free.proportional, free.integral));
            let margins = design.margins(&stiff());
            let (mut low, mut high) = (1e-4, 100.0);
            for _ in 0..60 {
                let middle = f64::sqrt(low * high);
                if rigid_loop(&design, damping, middle).0 > 1.0 { low = middle } else { high = middle }
            }
            // The shaft's share is (8 rad/s over 11,000)^2, the tick's (8 rad/s 1e-5 s)^2: 1e-6.
            assert!((margins.crossover / low - 1.0).abs() < 1e-5, "{damping}: {} {low}", margins.crossover);
            let phase = core::f64::consts::PI + rigid_loop(&design, damping, low).1;
            assert!((margins.phase - phase).abs() < 1e-5, "{damping}: {} {phase}", margins.phase);
            let gained = margins.phase - free.margins(&stiff()).phase;
            assert!(gained * damping > 0.0, "{damping}: {gained}");
        }
    }
}

/// Routh: `T J s^3 + (J + T D) s^2 + (D + g k_p) s + g k_i` is stable where
/// `(J + T D)(D + g k_p) > T J g k_i`. A torque that rises with the speed needs a least gain.
#[test]
fn a_rising_torque_needs_the_gain_of_routh_s_criterion() {
    let (inertia, lag) = (12.4, LAG + 1.5 * TICK);
    for damping in [-5.0, -20.0, -60.0] {
        let design = design(NaturalDamping { motor: damping, load: 0.0 });
        let sum = inertia + lag * damping;
        let least = -damping * sum / (sum * proportional(&design) - lag * inertia * design.integral);
        let found = design.margins(&stiff()).gain_down;
        // The tick's dead time is added to the lag: their product is left out, 0.05 s 1.5e-5 s times (5 rad/s)^2.
        assert!((found / least - 1.0).abs() < 2e-5, "{damping}: {found} {least}");
    }
    // At the same gain Routh's limit of the damping, to 2 %: nearer the response passes -1 between two frequencies.
    let free = design(NaturalDamping::NONE);
    let stable =
        |damping: f64| (inertia + lag * damping) * (damping + proportional(&free)) > lag * inertia * free.integral;
    let (mut low, mut high) = (-free.proportional, 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stable(middle) { high = middle } else { low = middle }
    }
    let with = |motor| free.try_with_natural_damping(&stiff(), NaturalDamping { motor, load: 0.0 });
    assert!(with(0.98 * high).is_ok(), "{high}");
    assert_eq!(with(1.02 * high), Err(Error::DampingUnstable), "{high}");
    assert_eq!(with(f64::NAN), Err(Error::NaturalDamping));
}

/// The full solver's chain on a soft shaft, with viscous friction at either mass: stable just below the gain margin,
/// unstable just above it.
#[test]
fn gain_margins_with_damping_are_where_the_loop_turns_unstable() {
    let machine = SET;
    let actuator = Actuator { delay: 0.0165, lag: 0.02 };
    let free = machine.governor(Rate::every(5e-4), actuator, 2.5, LoadFeedForward::NONE);
    let limit = free.margins(&machine).gain_up;
    for (motor, load) in [(150.0, 0.0), (0.0, 150.0), (60.0, 90.0)] {
        let design = free.with_natural_damping(&machine, NaturalDamping { motor, load });
        let found = design.margins(&machine).gain_up;
        assert!(found > 1.05 * limit, "{found} {limit}");
        let settles = |gain: f64| {
            let shaft = Shaft::elastic(5.0e4).damping(66.0);
            let chain = Chain::motor(4.4).viscous(motor).shaft(shaft, 8.0).viscous(load);
            chain_settles(chain, [gain * design.proportional, gain * design.integral], 0.0, actuator, 8)
        };
        // 3 %, as without damping: the lag between samples, and what eight seconds show.
        assert!(settles(0.97 * found) && !settles(1.03 * found), "{motor} {load} {found}");
    }
}

/// An integral with droop R on a mass with damping D under a load: `-R/(1 + R D)` of it, by Euler's steps to the end.
#[test]
fn the_machine_s_own_damping_takes_its_share_of_the_droop() {
    let (droop, damping, load) = (2e-3, 40.0, 300.0);
    let design = design(NaturalDamping { motor: 15.0, load: 25.0 });
    let (mut speed, mut standing) = (0.0, 0.0);
    for _ in 0..2_000_000 {
        let error = -droop * standing - speed;
        standing += 1e-4 * design.integral * error;
        speed += 1e-4 * (standing + design.proportional * error - load - damping * speed) / 12.4;
    }
    // A rest of Euler's steps is where nothing moves: rounding alone is left after 200 s.
    assert!((speed + 2e-3 / 1.08 * load).abs() < 1e-12 * load, "{speed}");
}

/// A straight line, and a pump: twice 0.03 omega.
#[test]
fn damping_is_the_slope_of_both_characteristics() {
    let line = Characteristic::Line(Line { stall: 400.0, slope: 3.5 });
    let pump = Characteristic::Parabola(Parabola { constant: 100.0, linear: 0.0, square: 0.03 });
    for (speed, load) in [(60.0, 3.6), (160.0, 9.6)] {
        let found = NaturalDamping::of(&line, &pump, Speed(speed));
        assert!(found.motor == 3.5 && (found.load - load).abs() < 1e-13, "{speed}: {found:?}");
        assert!((found.sum() - 3.5 - load).abs() < 1e-12);
    }
}
