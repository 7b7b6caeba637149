//! The generator sets' plants against closed forms, finer steps and the second integrator.

use driveline_firmware::scenes::generator::{DIESEL_TORQUE, FIRING_DELAY, RATED_SPEED, TORQUE_DELAY};
use driveline_lab::generator::diesel::{CRANK, Diesel, ENGINE};
use driveline_lab::generator::set::{Kind, Set};
use driveline_lab::generator::turbine::Turbine;
use driveline_solver::plant::converge::{Recording, prove};
use driveline_solver::plant::train::{Coordinate, Link, Orders, Train};

/// An engine turned at rated speed whose rack goes from nothing to a torque at `at`: the sum of its cylinders' torques
/// in steps of 31.25 us, the compression taken off by an engine that burns nothing.
fn turned(torque: f64, at: f64, duration: f64) -> Vec<f64> {
    let dt = 1.0 / 32_000.0;
    let (mut fired, mut cold) = (Diesel::new(DIESEL_TORQUE, 1e-6), Diesel::new(DIESEL_TORQUE, 1e-6));
    let steps = (duration / dt) as usize;
    let sum = |torques: [f64; 6]| torques.iter().sum::<f64>();
    (0..steps)
        .map(|step| {
            let (time, angle) = (step as f64 * dt, RATED_SPEED * (step as f64 + 0.5) * dt);
            let command = if time < at { 0.0 } else { torque };
            sum(fired.advance(command, angle, dt)) - sum(cold.advance(0.0, angle, dt))
        })
        .collect()
}

/// Over whole cycles of 80 ms the torque's mean is the rack's, less the 3 % that its calibration is off, and its
/// smallest order is that of the firing: half-order components come of the 2 % by which the cylinders differ.
#[test]
fn the_engine_gives_the_torque_of_its_rack() {
    let torque = 0.6 * DIESEL_TORQUE;
    let course = turned(torque, 0.0, 8.0);
    let cycle = 2560;
    let last = &course[course.len() - 10 * cycle..];
    let mean = last.iter().sum::<f64>() / last.len() as f64;
    // Compression with the charge that only the fired engine has does no work over a cycle. The tables are of a quarter
    // of a degree.
    assert!((mean / (0.97 * torque) - 1.0).abs() < 2e-3, "{mean} {torque}");
    let order = |order: f64| {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (step, torque) in last.iter().enumerate() {
            let (s, c) = (order * RATED_SPEED * step as f64 / 32_000.0).sin_cos();
            (sine, cosine) = (sine + torque * s, cosine + torque * c);
        }
        2.0 * f64::hypot(sine, cosine) / last.len() as f64
    };
    // Six cylinders fire three times a turn: order 3 is of the size of the mean [Heywood 1988 §2], and the others of an
    // even engine are none.
    assert!(order(3.0) > 0.8 * mean && order(3.0) < 4.0 * mean, "{}", order(3.0) / mean);
    for small in [0.5, 1.0, 1.5, 2.0, 2.5] {
        assert!(order(small) < 0.05 * mean, "{small}: {}", order(small) / mean);
    }
}

/// On average over all phases of the jump, the torque of a rack comes as late as the observer is told; the
/// governor allows for more. Late is what an engine that has always had the fuel gives more.
#[test]
fn the_engine_is_as_late_as_the_observer_is_told() {
    let (torque, rate) = (0.5 * DIESEL_TORQUE, 32_000.0);
    let always = turned(torque, 0.0, 1.2);
    let mut lateness = 0.0;
    let jumps = 32;
    for jump in 0..jumps {
        // Over a cycle of 80 ms: every cylinder, whatever its fuel.
        let at = 0.32 + 0.08 * f64::from(jump) / f64::from(jumps);
        let course = turned(torque, at, at + 0.3);
        let missing: f64 = (0..course.len()).skip((at * rate) as usize).map(|step| always[step] - course[step]).sum();
        lateness += missing / rate / (0.97 * torque) / f64::from(jumps);
    }
    // The pulses' centre: to 0.5 ms, what a tick of the delay line resolves, since the charge differs a little between
    // the two engines.
    assert!((lateness - TORQUE_DELAY).abs() < 5e-4, "{lateness} {TORQUE_DELAY}");
    assert!(lateness < FIRING_DELAY);
}

/// Six throws in thirds of a turn leave every third order of the masses' torque, `-3/4 lambda - 9/32 lambda^3 -
/// 81/512 lambda^5` of `m r^2 omega^2` to each cylinder in order 3, the series of a massless rod \[derived\].
#[test]
fn the_masses_torque_has_the_orders_of_the_series() {
    let (count, dt) = (720, 1e-4);
    let mut engine = Diesel::new(DIESEL_TORQUE, 0.02);
    let mut sines = [0.0; 5];
    for step in 0..count {
        let angle = core::f64::consts::TAU * f64::from(step) / f64::from(count);
        let torque: f64 = engine.mass_torques(angle, [RATED_SPEED; 6], dt).iter().sum();
        for (order, sine) in sines.iter_mut().enumerate() {
            *sine += torque * (order as f64 * angle).sin() * 2.0 / f64::from(count);
        }
    }
    let (lambda, unit) = (0.32_f64, 6.0 * 4.0 * (0.083 * RATED_SPEED).powi(2));
    let third = -(0.75 * lambda + 9.0 / 32.0 * lambda.powi(3) + 81.0 / 512.0 * lambda.powi(5)) * unit;
    // The next term of the series is about a tenth of lambda^7, 3e-5 of the whole.
    assert!((sines[3] / third - 1.0).abs() < 2e-4, "{} {third}", sines[3]);
    for order in [1, 2, 4] {
        assert!(sines[order].abs() < 1e-12 * unit, "{order}: {}", sines[order]);
    }
}

/// The plant's chain under the masses' torques alone, against the solver's train whose throws have an inertia by their
/// angle: throws and flywheel of a set that nothing drives.
#[test]
fn the_masses_swing_the_crank_as_inertias_by_the_angle_do() {
    let free = |steps: u32| {
        let mut engine = Diesel::new(DIESEL_TORQUE, 0.02);
        let mut plant = Set::new(Kind::Diesel, RATED_SPEED).unwrap().plant().clone();
        let dt = 0.1 / f64::from(steps);
        for _ in 0..steps {
            let middle = plant.motor_angle() - plant.twist(0) + 0.5 * dt * plant.speed(1);
            let speeds = core::array::from_fn(|throw| plant.speed(throw + 1));
            for (throw, torque) in engine.mass_torques(middle, speeds, dt).into_iter().enumerate() {
                plant.set_load_torque(throw + 1, -torque);
            }
            plant.advance(0.0, dt);
        }
        [1, 4, 7].map(|node| plant.speed(node))
    };
    // As in the plant: 8 % of the rated torque is friction on the throws, whose 0.12 kg m2 have the masses' mean.
    let friction = 0.08 * DIESEL_TORQUE / (RATED_SPEED * 6.0);
    let mean = CRANK.mean_inertia().0;
    let mut train = Train::new().coordinate(Coordinate::new(0.2).speed(RATED_SPEED));
    for (throw, cylinder) in ENGINE.iter().enumerate() {
        let law = Orders::sampled(|angle| CRANK.inertia(angle - cylinder.firing).inertia);
        let own = if throw == 0 { 0.17 } else { 0.12 };
        train = train.coordinate(Coordinate::new(own - mean).speed(RATED_SPEED).viscous(friction).inertia_law(law));
    }
    train = train.coordinate(Coordinate::new(3.43).speed(RATED_SPEED));
    train = train.coordinate(Coordinate::new(8.0).speed(RATED_SPEED));
    let shafts = [(2.33e5, 141.0)].into_iter().chain([(4.0e6, 20.0); 6]).chain([(5.0e4, 66.0)]);
    for (from, (stiffness, damping)) in shafts.enumerate() {
        train = train.link(Link::shaft(from, from + 1, stiffness).damping(damping));
    }
    let mut train = train.build().unwrap();
    train.advance(0.1);
    let exact = [1, 4, 7].map(|node| train.speed(node));
    // As it is run, 19,200 steps a second. The masses alone swing the flywheel by 1e-3; what is left is the step's, and
    // the crank's twist of a few 1e-3 rad, which the torques leave out.
    for (speed, exact) in free(1920).into_iter().zip(exact) {
        assert!((speed - exact).abs() < 5e-6 * RATED_SPEED, "{speed} {exact}");
    }
}

/// A full charge is needed for full load: the first step is cut to what burns without it.
#[test]
fn a_turbocharged_engine_takes_no_full_load_at_once() {
    let course = turned(1.2 * DIESEL_TORQUE, 0.0, 8.0);
    let mean = |from: usize| course[from..from + 2560].iter().sum::<f64>() / 2560.0 / DIESEL_TORQUE;
    assert!(mean(2560) < 0.85 && mean(course.len() - 2560) > 1.1, "{} {}", mean(2560), mean(course.len() - 2560));
}

/// Two lags in series: the step response of the chest.
#[test]
fn the_turbine_is_two_lags() {
    let mut turbine = Turbine::new(1000.0, 100.0, [0.1, 0.25]);
    let dt = 1e-5;
    for step in 1..=100_000 {
        let torque = turbine.advance(800.0, 100.0, dt);
        if step % 10_000 == 0 {
            let t = f64::from(step) * dt;
            let exact = 800.0 * (1.0 - (0.25 * (-t / 0.25_f64).exp() - 0.1 * (-t / 0.1_f64).exp()) / 0.15);
            // The valve is held at its end value for each step of the chest: an error of dt/2 over the lag.
            assert!((torque - exact).abs() < 800.0 * 1e-4, "{t}: {torque} {exact}");
        }
    }
}

/// Finer steps change nothing that the figures show, and ever less: the generator's speed after a second without a
/// governor, half of it loaded.
#[test]
fn the_step_is_fine_enough() {
    let run = |kind: Kind, steps: u32| {
        let mut set = Set::new(kind, RATED_SPEED).unwrap();
        set.set_load(0.5);
        for _ in 0..steps {
            set.step(0.55 * kind.constants().rated_torque, 1.0 / f64::from(steps));
        }
        set.generator_speed() / RATED_SPEED
    };
    for kind in [Kind::Diesel, Kind::Turbine] {
        // As it is run: 19,200 steps a second.
        let [coarse, fine, finer] = [19_200, 38_400, 76_800].map(|steps| run(kind, steps));
        // A twentieth of the 0.1 % that precise power allows; a step of first order at least.
        assert!((coarse - finer).abs() < 5e-5, "{kind:?}: {coarse} {fine} {finer}");
        assert!((fine - finer).abs() < 0.75 * (coarse - fine).abs().max(1e-6), "{kind:?}: {coarse} {fine} {finer}");
    }
}

/// The chain under the torques that it is held at, proven by another integrator.
#[test]
fn the_chain_is_proven() {
    for kind in [Kind::Diesel, Kind::Turbine] {
        let mut set = Set::new(kind, RATED_SPEED).unwrap();
        let mut recording = Recording::new(set.plant().clone());
        set.set_load(0.5);
        let dt = 1.0 / 19_200.0;
        for _ in 0..400 {
            set.step(0.55 * kind.constants().rated_torque, dt);
            for &(node, torque) in set.held.iter().filter(|(node, _)| *node > 0) {
                recording.set_load_torque(node, -torque);
            }
            let first = set.held.iter().find(|(node, _)| *node == 0).map_or(0.0, |(_, torque)| *torque);
            recording.advance(first, dt);
        }
        // The recording is the run, to the bit.
        assert_eq!(recording.plant().speed(1).to_bits(), set.plant().speed(1).to_bits());
        prove(&recording).unwrap();
    }
}
