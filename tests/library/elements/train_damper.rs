//! Dampers on trains: the two masses of a machine with a ring against the equations of motion.

use driveline::machine::{
    CentrifugalPendulum, Chain, Damper, Damping, Error, Inertia, Length, Mass, Match, Ratio, Resonance, Stiffness,
    Train, TwoMass,
};
use nalgebra::Complex;

use crate::references::close;

const ONE: Ratio = Ratio(1.0);
const MOTOR: f64 = 2.0;
const LOAD: f64 = 3.0;
const SHAFT: f64 = 4.0e4;

/// 4 % of the inertia of motor and load.
const RING: f64 = 0.2;

fn bare() -> Train {
    Train::of(Chain::motor(Inertia(MOTOR)).shaft(Stiffness(SHAFT), Damping(0.0)).rotor(Inertia(LOAD)))
}

/// The best viscous damper of the ring on the load.
fn lanchester() -> Damper {
    Resonance::of(&bare().modes().resonances()[0], 1).viscous_damper(Inertia(RING))
}

fn with(damper: Damper) -> TwoMass {
    bare().damper(1, ONE, damper).reduce(Match::ResonanceAntiresonance)
}

/// The inertia that the motor sees of the equations of motion: motor, shaft, load, and the ring on its damper.
fn whole(damper: &Damper, omega: f64) -> Complex<f64> {
    let holds = Complex::new(damper.stiffness, damper.damping * omega);
    let ring = holds * damper.inertia / (holds - damper.inertia * omega * omega);
    let load = ring + LOAD;
    MOTOR + SHAFT * load / (SHAFT - load * omega * omega)
}

fn reduced(two: &TwoMass, omega: f64) -> Complex<f64> {
    let holds = Complex::new(two.stiffness, two.damping * omega);
    two.motor_inertia + holds * two.load_inertia / (holds - two.load_inertia * omega * omega)
}

/// Error of the motor's acceleration per torque up to a frequency, rms over rms.
fn error(damper: &Damper, two: &TwoMass, top: f64) -> f64 {
    let (mut off, mut all) = (0.0, 0.0);
    for n in 1..=4000 {
        let omega = top * f64::from(n) / 4000.0;
        let exact = whole(damper, omega).inv();
        off += (exact - reduced(two, omega).inv()).norm_sqr();
        all += exact.norm_sqr();
    }
    (off / all).sqrt()
}

/// The frequency at which the coupled share of the ring belongs to it: with `x = omega^2` and the share `d^2/(d^2 + J^2
/// x)` of the ring, `x = k/J_m + k/(J_l + J d^2/(d^2 + J^2 x))` is a quadratic equation.
#[test]
fn a_viscous_ring_takes_part_by_its_coupling() {
    for factor in [0.1, 1.0, 10.0] {
        let best = lanchester();
        let damper = Damper { damping: factor * best.damping, ..best };
        let (d, j) = (damper.damping.powi(2), RING * RING);
        let a = LOAD * j;
        let b = (LOAD + RING) * d - SHAFT / MOTOR * LOAD * j - SHAFT * j;
        let c = -(SHAFT / MOTOR * (LOAD + RING) + SHAFT) * d;
        let x = ((b * b - 4.0 * a * c).sqrt() - b) / (2.0 * a);
        let coupled = RING * d / (d + j * x);
        let two = with(damper);
        // four passes, each of which gains a factor of fifty or more
        close(two.resonance(), x.sqrt(), 1e-7);
        close(two.antiresonance(), (SHAFT / (LOAD + coupled)).sqrt(), 1e-7);
        close(two.total_inertia(), MOTOR + LOAD + RING, 1e-14);
        close(two.error.slipping, (RING - coupled) / two.total_inertia(), 1e-6);
        // the modal damping: the rest of d on the load, over what the load's share of the mode leaves
        let load = LOAD + coupled;
        let drag = damper.damping * j * x / (d + j * x);
        let modal = drag * MOTOR / (load * (MOTOR + load));
        close(two.damping, modal * two.reduced_inertia(), 1e-6);
    }
}

/// The best viscous ring of 4 % of the inertia, and one ten times as tight: the response of the whole machine, against
/// two masses that leave the ring out.
#[test]
fn two_masses_know_a_viscous_ring() {
    let left_out = bare().reduce(Match::ResonanceAntiresonance);
    for (factor, known, unknown) in [(1.0, 0.05, 0.6), (10.0, 0.008, 1.3)] {
        let best = lanchester();
        let damper = Damper { damping: factor * best.damping, ..best };
        // both have the damping of the mode, so that only the ring's inertia is left out
        let two = with(damper);
        let left_out = TwoMass { damping: two.damping, ..left_out };
        let top = 1.3 * two.resonance();
        let (found, other) = (error(&damper, &two, top), error(&damper, &left_out, top));
        // a fifth above 4.1 % and 0.64 %, beside 65 % and 137 % of a peak that the machine does not have
        println!("factor {factor}: {found:.4} with the ring, {other:.4} without");
        assert!(found < known && other > unknown, "{found}, {other}");
    }
}

/// Held ever tighter a ring is part of its mass, ever looser it is not there.
#[test]
fn a_viscous_ring_between_locked_and_free() {
    let best = lanchester();
    let locked = with(Damper { damping: 1e6 * best.damping, ..best });
    // what slips is the square of 1e-6
    close(locked.resonance(), (SHAFT * (1.0 / MOTOR + 1.0 / (LOAD + RING))).sqrt(), 1e-11);
    close(locked.load_inertia, LOAD + RING, 1e-11);
    let free = with(Damper { damping: 1e-6 * best.damping, ..best });
    close(free.resonance(), (SHAFT * (1.0 / MOTOR + 1.0 / LOAD)).sqrt(), 1e-11);
    close(free.error.slipping, RING / (MOTOR + LOAD + RING), 1e-11);
}

/// A ring on a spring is a mass of its own: the biquadratic equation of three masses, on a shaft twice as slow.
#[test]
fn a_ring_on_a_spring_is_a_mass() {
    let damper = Damper { inertia: 4.0 * RING, stiffness: 2.4e4, damping: 20.0 };
    let train = bare().damper(1, Ratio(2.0), damper);
    let (ring, spring) = (RING, 0.25 * damper.stiffness);
    // motor locked: (k + k_r - J x)(k_r - J_r x) = k_r^2
    let b = (SHAFT + spring) * ring + spring * LOAD;
    let root = (b * b - 4.0 * LOAD * ring * SHAFT * spring).sqrt();
    for (held, twice) in train.modes().antiresonances().iter().zip([b - root, b + root]) {
        close(*held, (twice / (2.0 * LOAD * ring)).sqrt(), 1e-13);
    }
    close(train.total_inertia(), MOTOR + LOAD + RING, 1e-15);
    assert_eq!(train.joints()[1].shaft.damping, 5.0);
    assert_eq!(train.reduce(Match::ResonanceAntiresonance).error.slipping, 0.0);
}

/// A pendulum is a ring whose spring grows with the square of the speed: the inertia that it adds at any order.
#[test]
fn a_pendulum_is_a_ring_at_each_speed() {
    let pendulum = CentrifugalPendulum::for_order(Mass(1.5), Length(0.12), 2.0);
    for speed in [10.0, 150.0] {
        for order in [0.5, 1.0, 1.9, 2.1, 6.0] {
            let [real, imaginary] = pendulum.ring(speed).dynamic_stiffness(order * speed);
            // the inertia's denominator loses a digit next to the order
            close(-real / (order * speed).powi(2), pendulum.inertia(order), 1e-13);
            assert_eq!(imaginary, 0.0);
        }
    }
}

#[test]
fn wrong_rings_are_refused() {
    let train = bare();
    let ring = |inertia, stiffness, damping| train.damper(1, ONE, Damper { inertia, stiffness, damping }).error();
    for (inertia, stiffness, damping) in
        [(0.0, 1.0, 1.0), (1.0, 0.0, 0.0), (1.0, -1.0, 3.0), (1.0, 3.0, -1.0), (1.0, f64::INFINITY, 0.0)]
    {
        assert_eq!(ring(inertia, stiffness, damping), Some(Error::DamperRing), "{inertia} {stiffness} {damping}");
    }
    assert_eq!(train.damper(2, ONE, lanchester()).error(), Some(Error::BranchNode));
    assert_eq!(train.damper(1, Ratio(0.0), lanchester()).error(), Some(Error::GearRatio));
    // A train without a shaft carries the whole ring.
    let rigid = Train::of(Chain::motor(Inertia(MOTOR))).damper(0, ONE, lanchester());
    assert_eq!(rigid.rigid().inertia, MOTOR + RING);
}
