//! Dampers and absorbers against direct solutions of their equations.

use std::f64::consts::{FRAC_PI_2, PI};

use driveline::machine::{
    CentrifugalPendulum, Chain, Damper, Damping, FrictionDamper, Inertia, Length, Mass, Resonance, Stiffness,
};
use nalgebra::{Complex, Matrix2, Vector2};

use crate::references::close;

const MAIN: Resonance = Resonance { inertia: 2.0, frequency: 60.0 };

/// Angles of mass and ring at a unit torque on the mass, by the two equations of motion.
fn direct(damper: &Damper, frequency: f64) -> Vector2<Complex<f64>> {
    let s = Complex::new(0.0, frequency);
    let coupling = damper.damping * s + damper.stiffness;
    let k = MAIN.inertia * MAIN.frequency * MAIN.frequency;
    let matrix =
        Matrix2::new(MAIN.inertia * s * s + k + coupling, -coupling, -coupling, damper.inertia * s * s + coupling);
    matrix.lu().solve(&Vector2::new(Complex::from(1.0), Complex::from(0.0))).expect("damped or off resonance")
}

/// Amplitude of the mass over its static angle.
fn amplitude(damper: &Damper, frequency: f64) -> f64 {
    direct(damper, frequency)[0].norm() * MAIN.inertia * MAIN.frequency * MAIN.frequency
}

#[test]
fn the_tuned_damper_has_two_fixed_points_of_one_height() {
    for mu in [0.01, 0.1, 0.5] {
        let best = MAIN.tuned_damper(Inertia(mu * MAIN.inertia));
        let height = (1.0 + 2.0 / mu).sqrt();
        close(Resonance::tuned_amplitude(mu), height, 1e-15);
        // of the same amplitude whatever the damping
        let fixed = [-1.0, 1.0].map(|side| {
            let apart = side * (mu / (2.0 + mu)).sqrt();
            MAIN.frequency * ((1.0 + apart) / (1.0 + mu)).sqrt()
        });
        for frequency in fixed {
            for factor in [0.1, 1.0, 10.0] {
                let damper = Damper { damping: factor * best.damping, ..best };
                // sums that cancel to a hundredth, each rounded
                close(amplitude(&damper, frequency), height, 1e-9);
                close(MAIN.amplitude(&damper, frequency), height, 1e-9);
            }
        }
        // level in either point where (d/(2 J_d omega))^2 is mu (3 -+ sqrt(mu/(mu + 2)))/(8 (1 + mu)^3), which the
        // slopes confirm; the best is the mean of the squares
        let apart = (mu / (mu + 2.0)).sqrt();
        let squares = [-1.0, 1.0].map(|side| mu * (3.0 + side * apart) / (8.0 * (1.0 + mu).powi(3)));
        for (frequency, square) in fixed.into_iter().zip(squares) {
            let level = Damper { damping: 2.0 * best.inertia * MAIN.frequency * square.sqrt(), ..best };
            let h = 1e-5;
            let slope = |damper: &Damper| {
                (amplitude(damper, frequency * (1.0 + h)) - amplitude(damper, frequency * (1.0 - h))) / (2.0 * h)
            };
            // a third derivative of some mu^-2 times h^2/6, and rounding over h
            assert!(
                slope(&level).abs() < 1e-4 * slope(&Damper { damping: 0.5 * level.damping, ..level }).abs(),
                "{mu}"
            );
        }
        let ratio = best.damping / (2.0 * best.inertia * MAIN.frequency);
        close(ratio * ratio, 0.5 * (squares[0] + squares[1]), 1e-9);
        close(best.stiffness, best.inertia * (MAIN.frequency / (1.0 + mu)).powi(2), 1e-9);
    }
}

#[test]
fn the_viscous_damper_has_one_fixed_point() {
    for mu in [0.05, 0.4, 1.5] {
        let best = MAIN.viscous_damper(Inertia(mu * MAIN.inertia));
        let fixed = MAIN.frequency * (2.0_f64 / (2.0 + mu)).sqrt();
        for factor in [0.05, 1.0, 20.0] {
            let damper = Damper { damping: factor * best.damping, ..best };
            // sums that cancel to a fortieth, each rounded
            close(amplitude(&damper, fixed), (2.0 + mu) / mu, 1e-9);
            close(MAIN.amplitude(&damper, fixed), Resonance::viscous_amplitude(mu), 1e-9);
        }
        // with the best damping the highest: level there, lower a thousandth beside
        for beside in [0.999, 1.001] {
            assert!(amplitude(&best, beside * fixed) < (2.0 + mu) / mu, "{mu}");
        }
        let (h, height) = (1e-5, (2.0 + mu) / mu);
        let slope = (amplitude(&best, fixed * (1.0 + h)) - amplitude(&best, fixed * (1.0 - h))) / (2.0 * h);
        // a third derivative of some height^3 times h^2/6, and rounding over h
        assert!(slope.abs() < 1e-8 * height.powi(3), "{mu}: {slope}");
    }
}

#[test]
fn an_absorber_keeps_the_mass_still() {
    let damper = Damper::absorber(Inertia(0.3), 47.0);
    let [mass, ring] = direct(&damper, 47.0).data.0[0];
    // the ring alone answers, with the torque in its spring
    assert!(mass.norm() < 1e-18 && (ring.norm() - 1.0 / (0.3 * 47.0 * 47.0)).abs() < 1e-12, "{mass} {ring}");
    assert_eq!(MAIN.amplitude(&damper, 47.0), 0.0);
    // the new resonances with an absorber of the main frequency: 1 + mu/2 -+ sqrt(mu + mu^2/4)
    let mu: f64 = 0.15;
    let same = Damper::absorber(Inertia(mu * MAIN.inertia), MAIN.frequency);
    for side in [-1.0, 1.0] {
        let square = 1.0 + 0.5 * mu + side * (mu + 0.25 * mu * mu).sqrt();
        // the denominator cancels to rounding
        assert!(MAIN.amplitude(&same, MAIN.frequency * square.sqrt()) > 1e12);
    }
}

#[test]
fn a_mode_of_a_chain_as_one_mass_and_one_spring() {
    let chain = Chain::motor(Inertia(2.0)).shaft(Stiffness(4.0e4), Damping(0.0)).rotor(Inertia(3.0));
    let main = Resonance::of(&chain.modes().resonances()[0], 1);
    // two masses: shape (J2, -J1) of mass J1 J2 (J1 + J2), so that the second has J2 (J1 + J2)/J1
    close(main.inertia, 3.0 * 5.0 / 2.0, 1e-14);
    close(main.frequency, f64::sqrt(4.0e4 * 5.0 / 6.0), 1e-14);
    assert_eq!(Resonance::of(&chain.modes().resonances()[0], 2).inertia, f64::INFINITY);
}

#[test]
fn the_friction_damper_takes_the_work_of_its_ring() {
    let (inertia, frequency, swing) = (0.2, 60.0, 0.01);
    let best = FrictionDamper::best(Inertia(inertia), swing, frequency);
    // ring and hub over half a period: the ring gains speed evenly, from minus to plus half of it, and meets the hub's
    // speed at the end; the work is the torque times the relative angle
    let work = |torque: f64| {
        let gained = torque / inertia * PI / frequency;
        let end = (0.5 * gained / (swing * frequency)).acos();
        let steps = 20_000;
        let relative: f64 = (0..steps)
            .map(|j| {
                let share = (f64::from(j) + 0.5) / f64::from(steps);
                swing * frequency * (end - PI * (1.0 - share)).cos() - (share - 0.5) * gained
            })
            .sum();
        let relative = relative * PI / (frequency * f64::from(steps));
        2.0 * torque * relative.abs()
    };
    for factor in [0.3, 1.0, 1.15] {
        let damper = FrictionDamper { torque: factor * best.torque, ..best };
        // midpoints: pi^2/(24 n^2), 1e-9
        close(damper.energy(swing, frequency), work(damper.torque), 1e-8);
    }
    close(best.energy(swing, frequency), 4.0 / PI * inertia * (frequency * swing).powi(2), 1e-9);
    for beside in [0.99, 1.01] {
        let other = FrictionDamper { torque: beside * best.torque, ..best };
        assert!(other.energy(swing, frequency) < best.energy(swing, frequency));
    }
    assert!(FrictionDamper { torque: 2.0 * best.torque, ..best }.energy(swing, frequency).is_nan());
    // at the natural frequency the torque supplies pi torque phi
    let (mu, torque) = (0.1, 30.0);
    let damper = MAIN.friction_damper(Inertia(mu * MAIN.inertia), torque);
    let phi = PI * PI / (4.0 * mu) * torque / (MAIN.inertia * MAIN.frequency * MAIN.frequency);
    close(damper.energy(phi, MAIN.frequency), PI * torque * phi, 1e-9);
    close(Resonance::friction_amplitude(mu), PI * PI / (4.0 * mu), 1e-9);
    close(damper.torque, FRAC_PI_2.recip() / f64::sqrt(2.0) * mu * MAIN.inertia * MAIN.frequency.powi(2) * phi, 1e-9);
}

#[test]
fn the_pendulum_follows_its_order() {
    let pendulum = CentrifugalPendulum::for_order(Mass(1.2), Length(0.11), 2.5);
    close(pendulum.order(), 2.5, 1e-15);
    close(pendulum.length, 0.11 / 6.25, 1e-15);
    // of the linear equations: m (R + L)^2 e'' + m L (R + L) p'' = torque, (R + L) e'' + L p'' + R Omega^2 p = 0
    let (r, l, speed) = (0.11, pendulum.length, 90.0);
    for order in [0.5, 1.5, 2.4, 3.0] {
        let square = -(order * speed) * (order * speed);
        let matrix = Matrix2::new(
            1.2 * (r + l) * (r + l) * square,
            1.2 * l * (r + l) * square,
            (r + l) * square,
            l * square + r * speed * speed,
        );
        let [angle, _] = matrix.lu().solve(&Vector2::new(1.0, 0.0)).unwrap().data.0[0];
        // near its order the pendulum cancels to a tenth
        close(pendulum.inertia(order), 1.0 / (angle * square), 1e-9);
    }
    // 1.2 kg balance 40 N m; the torque of the mass's centrifugal force on the lever R sin p
    close(pendulum.swing(40.0, speed), 40.0 / (1.2 * (r + l) * speed * speed * r), 1e-14);
}

#[test]
fn amplitudes_are_those_of_the_equations() {
    let ring = Inertia(0.1 * MAIN.inertia);
    let absorber = Damper::absorber(ring, 0.9 * MAIN.frequency);
    for damper in [MAIN.tuned_damper(ring), MAIN.viscous_damper(ring), absorber] {
        for ratio in [0.5, 0.8, 0.97, 1.1, 1.7] {
            let frequency = ratio * MAIN.frequency;
            // sums that cancel to a hundredth, each rounded
            close(amplitude(&damper, frequency), MAIN.amplitude(&damper, frequency), 1e-12);
        }
    }
}
