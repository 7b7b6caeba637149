//! The torsion-lateral gear pair between a motor and a load.

use driveline_solver::plant::modes::System;
use driveline_solver::plant::train::converge::{Recording, prove};
use driveline_solver::plant::train::{GearBody, GearPair, Harmonic, Signal, Variation};

/// A helical pair between a motor and a load; `support` makes bearings stiffer or softer.
fn pair(support: f64) -> GearPair {
    let supports = |k: f64| [k, k, 0.4 * k, 2e-3 * k, 2e-3 * k].map(|k| k * support);
    let body = |mass, inertia, base_radius: f64, k: f64| GearBody {
        mass,
        inertia,
        tilt_inertia: 0.6 * inertia,
        base_radius,
        pitch_radius: base_radius / 20.0_f64.to_radians().cos(),
        stiffness: supports(k),
        damping: [0.0; 5],
    };
    GearPair {
        motor: 0.05,
        input: (4.0e4, 0.0),
        pinion: body(1.8, 0.0021, 0.0395, 3.0e8),
        wheel: body(9.0, 0.065, 0.094, 4.0e8),
        output: (2.0e5, 0.0),
        load: 1.2,
        pressure_angle: 20.0_f64.to_radians(),
        base_helix: 14.0_f64.to_radians(),
        mesh_stiffness: 5.68e8,
        mesh_damping: 0.0,
        variation: None,
        gap: 0.0,
        torque: 250.0,
    }
}

#[test]
fn with_rigid_bearings_the_torsional_modes_of_the_geared_chain_are_left() {
    let stiff = 1e6;
    let pair = pair(stiff);
    let found = pair.train().modes().unwrap();
    assert_eq!(found.omega.len(), GearPair::COORDINATES);
    // the mesh in the pinion's angle: k (r_b cos beta_b)^2; the wheel's side by the square of the ratio
    let arm = pair.pinion.base_radius * pair.base_helix.cos();
    let ratio = pair.pinion.base_radius / pair.wheel.base_radius;
    let square = ratio * ratio;
    let chain = System::new(&[pair.motor, pair.pinion.inertia, square * pair.wheel.inertia, square * pair.load])
        .shaft(0, 1, pair.input.0, 0.0)
        .shaft(1, 2, pair.mesh_stiffness * arm * arm, 0.0)
        .shaft(2, 3, square * pair.output.0, 0.0)
        .frequencies()
        .unwrap();
    assert!(found.omega[0] < 1e-3 * chain[1], "{}", found.omega[0]);
    for (i, &expected) in chain.iter().enumerate().skip(1) {
        // what gives way in a bearing a million times as stiff as the mesh shifts a mode by a millionth of order
        assert!((found.omega[i] / expected - 1.0).abs() < 1e-5, "{} {expected}", found.omega[i]);
    }
    // the other ten are those of the wheels on their supports
    let alone = (pair.pinion.stiffness[0] / pair.pinion.mass).sqrt();
    assert!(found.omega[4] > 10.0 * chain[3] && found.omega.iter().any(|w| (w / alone - 1.0).abs() < 1e-5));
}

#[test]
fn soft_bearings_lower_the_mesh_mode() {
    let highest = |support: f64| pair(support).train().modes().unwrap();
    let (soft, stiff) = (highest(1.0), highest(1e6));
    // Rayleigh: taking stiffness away lowers every frequency, mode by mode
    for (a, b) in soft.omega.iter().zip(&stiff.omega).skip(1) {
        assert!(a < b, "{a} {b}");
    }
}

#[test]
fn under_a_steady_torque_every_bearing_carries_its_share_of_the_tooth_force() {
    let pair = pair(1.0);
    // the load is held, the motor's torque goes through
    let mut motion = pair.train().pretensioned(13).unwrap().build().unwrap();
    let normal = pair.torque / (pair.pinion.base_radius * pair.base_helix.cos());
    let share = |at: usize| pair.normal().iter().find(|term| term.0 == at).map_or(0.0, |term| term.1);
    let check = |motion: &driveline_solver::plant::train::Motion| {
        // solved in one step from entries of 1e4 to 1e12: rounding times that spread
        assert!((motion.force(GearPair::MESH) / normal - 1.0).abs() < 1e-7, "{}", motion.force(GearPair::MESH));
        for (first, link) in [(1, GearPair::SUPPORTS), (7, GearPair::SUPPORTS + 5)] {
            for i in 0..5 {
                let expected = -normal * share(first + i);
                assert!((motion.force(link + i) - expected).abs() < 1e-7 * normal, "{link} {i}");
            }
        }
    };
    check(&motion);
    motion.advance(0.01);
    check(&motion);
}

#[test]
fn a_step_of_torque_is_the_sum_of_the_modes() {
    let pair = pair(1.0);
    let modes = pair.train().modes().unwrap();
    let mut motion = pair.train().build().unwrap();
    let mut torque = [0.0; GearPair::COORDINATES];
    torque[0] = pair.torque;
    torque[13] = -pair.torque * pair.wheel.base_radius / pair.pinion.base_radius;
    let speed = |j: usize, t: f64| -> f64 {
        let modes = modes.omega.iter().zip(&modes.shapes).enumerate();
        modes
            .map(|(rank, (&omega, shape))| {
                let push: f64 = shape.iter().zip(&torque).map(|(q, torque)| q * torque).sum();
                // torques in balance leave the rigid turning alone
                shape[j] * push * if rank == 0 { t } else { (omega * t).sin() / omega }
            })
            .sum()
    };
    let (mut worst, mut peak) = ([0.0_f64; 14], [0.0_f64; 14]);
    for step in 1..=400 {
        let t = 2.5e-5 * f64::from(step);
        motion.advance(t - motion.time());
        for j in 0..14 {
            worst[j] = worst[j].max((motion.speed(j) - speed(j, t)).abs());
            peak[j] = peak[j].max(motion.speed(j).abs());
        }
    }
    // angles and ways have units of their own: each against the fastest of its kind
    let turns = |j: usize| matches!(j, 0 | 6 | 12 | 13);
    let top = |kind: bool| (0..14).filter(|&j| turns(j) == kind).map(|j| peak[j]).fold(0.0, f64::max);
    for (j, worst) in worst.iter().enumerate() {
        // eigenvalues spread over 1e4, whose rounding of 1e-16 turns the phase after a hundred swings by 1e-10
        assert!(*worst < 1e-8 * top(turns(j)), "{j}: {worst:e} of {:e}", top(turns(j)));
    }
}

#[test]
fn with_mesh_stiffness_errors_and_backlash_the_run_is_proven() {
    let swing = |order: f64, cosine: f64, sine: f64| Harmonic { order, cosine, sine };
    let mut pair = pair(1.0);
    pair.mesh_damping = 2500.0;
    for body in [&mut pair.pinion, &mut pair.wheel] {
        body.damping = body.stiffness.map(|k| 2e-6 * k);
    }
    pair.variation = Some(Variation::Harmonics {
        frequency: 1500.0,
        stiffness: vec![swing(1.0, 8.0e7, 0.0)],
        error: vec![swing(1.0, 0.0, 8e-6)],
    });
    pair.gap = 8e-5;
    let train = pair.train().pretensioned(13).unwrap();
    let mut motion = train.build().unwrap();
    motion.watch(Signal::Force(GearPair::MESH));
    let mut run = Recording::new(motion);
    for _ in 0..200 {
        run.advance(2e-5);
    }
    prove(&run).unwrap();
    let force = run.motion().extremes(Signal::Force(GearPair::MESH)).unwrap();
    // the mesh shakes: well above the static force, which is the start
    assert!(force.peak > 1.2 * pair.torque / pair.pinion.base_radius, "{force:?}");
}
