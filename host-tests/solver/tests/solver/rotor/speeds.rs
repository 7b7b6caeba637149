//! Natural frequencies, critical speeds and the Campbell diagram.

use std::f64::consts::{PI, TAU};

use driveline_solver::rotor::{Bearing, Direction, Disc, FlexibleRotor, Material, Modal, RigidRotor, WhirlSense};

use super::rig::{BEARING, file, number, three_discs};

#[test]
fn natural_frequencies_at_rest_are_those_of_ross() {
    let file = file();
    let model = three_discs(BEARING).build().unwrap();
    let at_rest = model.campbell(&[0.0], 4).unwrap();
    let expected = file["rotor"]["ross_wn_at_rest_Hz"].as_array().unwrap();
    for (natural, expected) in at_rest.whirls[0].iter().zip(expected) {
        let hz = natural.undamped / TAU;
        // the file's own pairs, which are equal in truth, differ by 1e-10
        assert!((hz - number(expected)).abs() <= 1e-8 * hz, "{hz} Hz instead of {expected}");
    }
}

#[test]
fn forward_critical_speeds_are_those_of_the_file() {
    let file = file();
    // the file's are those without damping
    let model = three_discs(BEARING).build().unwrap();
    let forward: Vec<f64> =
        model.criticals(5000.0).iter().filter(|c| c.sense == WhirlSense::Forward).map(|c| c.speed / TAU).collect();
    for (found, expected) in
        forward.iter().zip(file["rotor"]["synchronous_forward_criticals_Hz_own_FE"].as_array().unwrap())
    {
        assert!((found - number(expected)).abs() <= 1e-6 * found, "{found} Hz instead of {expected}");
    }
}

#[test]
fn an_undamped_whirl_meets_the_speed_where_the_campbell_diagram_says() {
    let bearing = Bearing::anisotropic([4e6, 2e6], [0.0, 0.0]);
    let model = three_discs(bearing).build().unwrap();
    for critical in &model.criticals(5000.0)[..6] {
        let naturals = model.campbell(&[critical.speed], 8).unwrap();
        let nearest = naturals.whirls[0].iter().map(|n| (n.frequency / critical.speed - 1.0).abs());
        // two ways, one Hermitian and one not, in numbers of one size: rounding and the Schur form's 1e-13 of the
        // largest of some 3e5 rad/s
        assert!(nearest.fold(f64::INFINITY, f64::min) <= 1e-8, "{critical:?}");
        // and the vibration there is large: 1e-5 beside it, some 1e4 times as much as at twice the distance of a tenth
        let at = |speed: f64| model.influence(speed).unwrap().iter().map(|a| a.norm()).fold(0.0, f64::max);
        assert!(at(critical.speed * (1.0 + 1e-6)) > 1e3 * at(critical.speed * 1.01), "{critical:?}");
    }
}

#[test]
fn a_tilting_disc_whirls_as_the_closed_form_says() {
    // Pure tilt on symmetric supports: Id w^2 - Ip Omega w - k a^2 2 = 0 for the forward whirl, + for the backward one.
    let (mass, polar, diametral, stiffness, half) = (20.0, 0.5, 0.3, 1e6, 0.2);
    let model = RigidRotor::new(mass, polar, diametral)
        .bearing(-half, Bearing::isotropic(stiffness, 0.0))
        .bearing(half, Bearing::isotropic(stiffness, 0.0))
        .station(half)
        .sensor(half, Direction::X)
        .build()
        .unwrap();
    let speed: f64 = 300.0;
    let tilt = 2.0 * stiffness * half * half;
    let root = (polar * speed).hypot(2.0 * (diametral * tilt).sqrt());
    let (forward, backward) = ((polar * speed + root) / (2.0 * diametral), (root - polar * speed) / (2.0 * diametral));
    let bounce = (2.0 * stiffness / mass).sqrt();
    // bounce has no gyroscopic moment: it goes round either way at one frequency
    let mut expected = [
        (bounce, WhirlSense::Backward),
        (bounce, WhirlSense::Forward),
        (forward, WhirlSense::Forward),
        (backward, WhirlSense::Backward),
    ];
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found = model.campbell(&[speed], 4).unwrap();
    for (natural, (frequency, sense)) in found.whirls[0].iter().zip(expected) {
        // an eigenvalue of an 8 x 8 matrix: rounding
        assert!((natural.frequency / frequency - 1.0).abs() < 1e-12, "{natural:?} {frequency}");
        assert_eq!(natural.sense, sense, "{natural:?}");
    }
    // A disc with Ip > Id outruns its forward whirl: bounce forward and backward, and a backward tilt.
    let criticals = model.criticals(f64::INFINITY);
    assert_eq!(criticals.len(), 3, "{criticals:?}");
    let backward = (tilt / (diametral + polar)).sqrt();
    assert!(criticals.iter().any(|c| (c.speed / backward - 1.0).abs() < 1e-12 && c.sense == WhirlSense::Backward));
}

/// Damped frequency (rad/s) and damping ratio of the six lowest whirls, by all 40 eigenvalues of the dense first-order
/// equations in 30 digits (mpmath 1.4), the elements' matrices integrated from their shapes. Strong dampers have decays,
/// which are not counted.
#[test]
fn whirls_of_any_damper_are_those_of_thirty_digits() {
    let moderate = [
        (234.5996243809163, 0.03886488464875599),
        (249.96570944973436, 0.04139473990910805),
        (274.3965768605, 0.02939827123970187),
        (325.279114221921, 0.0924834202799512),
        (871.2089840906602, 0.10947376033728161),
        (1104.0666493173362, 0.18316763313111536),
    ];
    let strong = [
        (309.9091999369622, 0.005836664761674366),
        (328.1539431552593, 0.006848120069817295),
        (636.1523718469651, 0.017836835652761302),
        (637.9163385931657, 0.02783502464566481),
        (2078.908233941468, 0.008253411309167973),
        (2473.337154095526, 0.00809478571170753),
    ];
    let locked = [
        (309.86035804681, 0.00010680999711720918),
        (328.3138294199238, 0.00012579759139802577),
        (628.0318604429699, 0.0004099465531509192),
        (646.4585126567042, 0.0004263962560398094),
        (2078.2499415541497, 0.00015159236619795402),
        (2473.071045694436, 0.00014834067227829483),
    ];
    let soft = [
        (0.8773552567304187, 0.051500687442759),
        (2.7857348651568015, 0.07039320070703865),
        (3.896369985348118, 0.14730777625723557),
        (16.761189910373325, 0.06326174464727038),
        (590.5420798292032, 0.0025110691393635132),
        (764.0180432033703, 0.0028021006401575906),
    ];
    for (stiffness, damping, expected) in
        [(4e6, [3e3, 1e3], moderate), (4e6, [1e6, 2e5], strong), (4e6, [1e8, 1e7], locked), (4e2, [30.0, 10.0], soft)]
    {
        let bearing = Bearing::anisotropic([stiffness, 0.5 * stiffness], damping);
        let model = FlexibleRotor::uniform(4, 1.2, 0.05, Material::STEEL)
            .disc(1, Disc { mass: 24.0, polar: 0.25, diametral: 0.13 })
            .disc(4, Disc { mass: 9.0, polar: 0.05, diametral: 0.03 })
            .bearing(0, bearing)
            .bearing(3, bearing)
            .build()
            .unwrap();
        let found = model.campbell(&[400.0], 6).unwrap();
        for (natural, (frequency, ratio)) in found.whirls[0].iter().zip(expected) {
            // rounding of the entries, some units in the last place, by the condition of a pair of whirls
            assert!((natural.frequency / frequency - 1.0).abs() < 1e-11, "{damping:?}: {natural:?} {frequency}");
            assert!((natural.damping_ratio - ratio).abs() < 1e-11, "{damping:?}: {natural:?} {ratio}");
        }
    }
}

/// Both senses of a critical speed, in either order.
fn is_pair(senses: [WhirlSense; 2]) -> bool {
    senses.contains(&WhirlSense::Forward) && senses.contains(&WhirlSense::Backward)
}

/// On springs far softer than the shaft: `sqrt(2 k/m)`, and `sqrt(2 k a^2/(Id -+ Ip))` with `Id = m (l^2/12 + d^2/16)`
/// and `Ip = m d^2/8` of a cylinder.
#[test]
fn a_shaft_on_soft_springs_whirls_as_a_rigid_rotor() {
    let (length, diameter) = (2.0_f64, 0.06_f64);
    let mass = Material::STEEL.density * PI / 4.0 * diameter * diameter * length;
    for stiffness in [1.0, 100.0, 700.0] {
        let bearing = Bearing::isotropic(stiffness, 0.0);
        let shaft = FlexibleRotor::uniform(10, length, diameter, Material::STEEL).bearing(0, bearing);
        let rotor = (0..=10).fold(shaft.bearing(10, bearing), FlexibleRotor::station);
        let model = rotor.build().unwrap();
        // the shaft gives 5 l^3/(384 E I) under its own load, 1.6e-6 m for 2 N/m of the springs; and rounding of the
        // elements' 12 E I/l^3 = 2e8 N/m beside those springs
        let close = 2e-6 * stiffness + 2e8 * f64::EPSILON / stiffness;
        let criticals = model.criticals(1000.0);
        let bounce = (2.0 * stiffness / mass).sqrt();
        for critical in &criticals[..2] {
            assert!((critical.speed / bounce - 1.0).abs() < close, "{stiffness}: {critical:?}");
        }
        assert!(is_pair([0, 1].map(|k| criticals[k].sense)), "{stiffness}: {criticals:?}");
        for (critical, (sign, sense)) in
            criticals[2..4].iter().zip([(1.0, WhirlSense::Backward), (-1.0, WhirlSense::Forward)])
        {
            let inertia = mass * (length.powi(2) / 12.0 + (1.0 + 2.0 * sign) * diameter.powi(2) / 16.0);
            let tilt = (0.5 * stiffness * length.powi(2) / inertia).sqrt();
            assert!((critical.speed / tilt - 1.0).abs() < close, "{stiffness}: {critical:?} {tilt}");
            assert_eq!(critical.sense, sense);
        }
        // at rest, and far above the springs, the vibrations by Jacobi's rotations
        let at_rest = model.campbell(&[0.0], 8).unwrap();
        let frequencies = Modal::of(&model).unwrap().frequencies();
        for (natural, frequency) in at_rest.whirls[0].iter().zip(&frequencies[..8]) {
            assert!((natural.frequency / frequency - 1.0).abs() < close, "{stiffness}: {natural:?} {frequency}");
        }
        for (mode, (_, shape)) in model.forward_shapes(2).iter().enumerate() {
            for (node, at) in shape.iter().enumerate() {
                let straight = if mode == 0 { 1.0 } else { 1.0 - 0.2 * node as f64 };
                let expected = straight * if shape[0] < 0.0 { -1.0 } else { 1.0 };
                assert!((at - expected).abs() < close, "{stiffness} {mode} {node}: {at}");
            }
        }
    }
}

/// Bearings softer and softer, until rounding of the shaft's 12 E I/l^3 hides them: whirls are right, or refused.
#[test]
fn whirls_that_rounding_hides_are_refused() {
    let (length, diameter, mut refused) = (2.0_f64, 0.06_f64, 0);
    let mass = Material::STEEL.density * PI / 4.0 * diameter * diameter * length;
    for power in -20..=10 {
        let stiffness = 10_f64.powf(0.25 * f64::from(power));
        for damping in [0.0, 0.1] {
            let damping = damping * stiffness;
            let bearing = Bearing::isotropic(stiffness, damping);
            let shaft = FlexibleRotor::uniform(10, length, diameter, Material::STEEL).bearing(0, bearing);
            let model = shaft.bearing(10, bearing).build().unwrap();
            let Ok(found) = model.campbell(&[0.0], 8) else {
                refused += 1;
                continue;
            };
            // as above; damping takes the square of its ratio
            let ratio = damping / (2.0 * stiffness * mass).sqrt();
            let bounce = (2.0 * stiffness / mass).sqrt() * (1.0 - ratio * ratio).sqrt();
            for natural in &found.whirls[0][..2] {
                // a proof is one of 1e-6
                assert!((natural.frequency / bounce - 1.0).abs() < 1e-6 + 2e-6 * stiffness, "{stiffness}: {natural:?}");
            }
        }
    }
    assert!(refused > 0);
}

/// A disc on a shaft of next to no mass, whose vibrations at 3e7 rad/s are far above that of soft springs, 10 rad/s.
#[test]
fn a_shaft_of_little_mass_leaves_the_lowest_whirls_their_digits() {
    let light = Material { density: 1.0, ..Material::STEEL };
    let (length, diameter, stiffness) = (0.6_f64, 0.05_f64, 1000.0);
    for (pieces, inertia) in [(10, 1e-9), (10, 0.01), (64, 0.01)] {
        let bearing = Bearing::isotropic(stiffness, 0.0);
        let rotor = FlexibleRotor::uniform(pieces, length, diameter, light)
            .disc(pieces / 2, Disc { mass: 20.0, polar: inertia, diametral: inertia })
            .bearing(0, bearing)
            .bearing(pieces, bearing)
            .station(pieces / 2);
        let model = rotor.build().unwrap();
        let modal = Modal::of(&model).unwrap();
        // springs and shaft in series
        let bending = 48.0 * light.young * PI / 64.0 * diameter.powi(4) / length.powi(3);
        let together = (0.5 / stiffness + 1.0 / bending).recip();
        let mass = 20.0 + light.density * PI / 4.0 * diameter * diameter * length;
        let expected = (together / mass).sqrt();
        let criticals = model.criticals(50.0);
        assert!(is_pair([0, 1].map(|k| criticals[k].sense)), "{criticals:?}");
        let found = criticals[..2].iter().map(|critical| critical.speed);
        for speed in found.chain(modal.frequencies()[..2].iter().copied()) {
            // shear has 2 % of the bending's 1.4e-4; rounding is 1e-7, of 12 E I/l^3 = 1e12 N/m beside 2000 N/m
            assert!((speed / expected - 1.0).abs() < 3e-6, "{speed} {expected}");
        }
    }
}
