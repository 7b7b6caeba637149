//! The full solver and the library's chains: ratios, vanishing gaps, meshes through their resonances, soft bearings.

use std::f64::consts::PI;
use std::fmt::Display;

use driveline::machine::{Chain, Damping, Inertia, Stiffness};
use driveline_solver::plant::train::{Coordinate, Link, Train};
use driveline_solver::rotor::{Bearing, Disc, FlexibleRotor, Material, Modal};
use serde_json::Value;

use super::{Cases, Found};
use crate::cases::gear_mesh;

const GIVEN: [&str; 2] = [
    include_str!("../../../../tests/data/extreme_chains.json"),
    include_str!("../../../../tests/data/torsional_modes_extreme.json"),
];

/// A refusal in its own words.
pub(super) fn said(error: impl Display) -> String {
    error.to_string()
}

pub(super) fn add(all: &mut Cases) {
    all.subject("chain", "frequencies, of each; library and full solver", "eigenvalues of 120 digits (mpmath)");
    for given in GIVEN {
        let cases: Value = serde_json::from_str(given).unwrap_or_default();
        for case in cases["cases"].as_array().into_iter().flatten() {
            let id = case["id"].as_str().unwrap_or_default();
            all.case(id.to_owned(), || chain(case));
        }
    }
    all.subject("vanishing gap", "twist after 100 impacts, of its largest", "closed form of the rattling pair");
    for stiffness in [1.0, 1e8] {
        for decade in [1, -1, -3, -6, -9, -12] {
            all.case(format!("gap 1e{decade} of the twist, {stiffness:e} N m/rad"), || gap(stiffness, decade));
        }
    }
    all.subject("mesh", "state, extremes and dynamic factors, of each", "periodic motion of 40 digits (mpmath)");
    for point in gear_mesh::pair().map(|pair| pair.points).unwrap_or_default() {
        all.case(format!("mesh frequency {} of the natural one", point.mesh_frequency_ratio), || {
            let pair = gear_mesh::pair()?;
            let off = |(_, [found, expected, scale]): &(_, [f64; 3])| (found - expected).abs() / scale;
            let error = pair.compared(&point)?.iter().map(off).fold(0.0, f64::max);
            Ok(Found { error, limit: pair.rel_tol })
        });
    }
    all.subject("rotor", "two lowest frequencies, of each", "closed form of the rigid rotor");
    for stiffness in [1e-3, 1.0, 1e3] {
        for ratio in [1.0, 1e2, 1e4, 1e6] {
            all.case(format!("bearings of {stiffness:e} N/m, discs 1 to {ratio:e}"), || rotor(stiffness, ratio));
        }
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    let number = |value: &Value| value.as_f64().or_else(|| value.as_str()?.parse().ok()).unwrap_or(f64::NAN);
    value.as_array().into_iter().flatten().map(number).collect()
}

/// Relative accuracy of every frequency, whatever the ratios: some 100 roundings.
fn chain(case: &Value) -> Result<Found, String> {
    let of = |keys: [&str; 2]| keys.iter().map(|key| numbers(&case[*key])).find(|all| !all.is_empty());
    let inertias = of(["J", "J_kg_m2"]).ok_or("no inertias")?;
    let shafts = of(["k", "k_Nm_rad"]).ok_or("no shafts")?;
    let expected = of(["resonances", "expected_omega_rad_s"]).ok_or("no frequencies")?;
    let expected: Vec<f64> = expected.into_iter().filter(|omega| *omega > 0.0).collect();
    let parts = || inertias[1..].iter().zip(&shafts);
    let library = parts().fold(Chain::motor(Inertia(inertias[0])), |chain, (j, k)| {
        chain.shaft(Stiffness(*k), Damping(0.0)).rotor(Inertia(*j))
    });
    let library: Vec<f64> = library.modes().resonances().iter().map(|mode| mode.frequency).collect();
    let rotors = inertias.iter().fold(Train::new(), |train, j| train.coordinate(Coordinate::new(*j)));
    let train = shafts.iter().enumerate().fold(rotors, |train, (i, k)| train.link(Link::shaft(i, i + 1, *k)));
    let full = train.modes().map_err(said)?.omega;
    let off = |found: &[f64]| {
        let each = found.iter().zip(&expected).map(|(found, expected)| (found / expected - 1.0).abs());
        if found.len() == expected.len() { each.fold(0.0, f64::max) } else { f64::NAN }
    };
    Ok(Found { error: off(&library).max(off(&full[1..])), limit: 1e-13 })
}

/// Two free masses without momentum, flung from the middle of their gap: half a sine in contact, then free flight. A
/// hundred impacts; the phase gathers a few roundings in each.
fn gap(stiffness: f64, decade: i32) -> Result<Found, String> {
    let [motor, load] = [1.0, 3.0];
    let omega = (stiffness * (motor + load) / (motor * load)).sqrt();
    let (swing, gap) = (1e-3, 1e-3 * 10_f64.powi(decade));
    let speed = swing * omega;
    let shares = [load / (motor + load), -motor / (motor + load)];
    let train = Train::new()
        .coordinate(Coordinate::new(motor).speed(shares[0] * speed))
        .coordinate(Coordinate::new(load).speed(shares[1] * speed));
    let mut run = train.link(Link::shaft(0, 1, stiffness).gap(gap)).build().map_err(said)?;
    let impact = PI / omega + gap / speed;
    let (mut worst, largest) = (0.0_f64, 0.5 * gap + swing);
    for k in 1..=400 {
        run.advance(0.251 * impact);
        let time = 0.251 * impact * f64::from(k) + 0.5 * gap / speed;
        // from the entry of the gap on
        let (count, rest) = ((time / impact).floor(), time.rem_euclid(impact));
        let side = if count % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let flight = (speed * rest - 0.5 * gap).min(0.5 * gap);
        let contact = swing * (omega * (rest - gap / speed)).max(0.0).sin();
        let twist = side * (flight + contact);
        worst = worst.max((run.angle(0) - run.angle(1) - twist).abs() / largest);
    }
    Ok(Found { error: worst, limit: 1e-10 })
}

/// A shaft with two discs on soft bearings: a rigid body on two springs. What the shaft yields is of the order of the
/// bearings' stiffness over the shaft's, 4e6 N/m; the rest is rounding.
fn rotor(stiffness: f64, ratio: f64) -> Result<Found, String> {
    let (length, diameter) = (1.2, 0.08);
    let disc = |mass: f64| Disc { mass, polar: 1e-9, diametral: 1e-9 };
    let (light, heavy) = (1.0, ratio);
    let model = FlexibleRotor::uniform(8, length, diameter, Material::STEEL)
        .disc(2, disc(light))
        .disc(5, disc(heavy))
        .bearing(0, Bearing::isotropic(stiffness, 0.0))
        .bearing(8, Bearing::isotropic(stiffness, 0.0))
        .station(4);
    let found = Modal::of(&model.build().map_err(said)?).map_err(said)?.frequencies();
    // masses at their places, the shaft as an even rod with its rotary inertia
    let area = PI / 4.0 * diameter * diameter;
    let shaft = Material::STEEL.density * area * length;
    let about = shaft * (length * length / 12.0 + diameter * diameter / 16.0);
    let bodies = [(light, 0.25 * length), (heavy, 0.625 * length), (shaft, 0.5 * length)];
    let mass: f64 = bodies.iter().map(|(m, _)| m).sum();
    let centre = bodies.iter().map(|(m, z)| m * z).sum::<f64>() / mass;
    let inertia = about + bodies.iter().map(|(m, z)| m * (z - centre).powi(2)).sum::<f64>();
    // stiffness by deflection and tilt about the centre of mass; both frequencies by sum and product
    let ends = [-centre, length - centre];
    let [a, b, c] = [0, 1, 2].map(|power| stiffness * ends.iter().map(|end| end.powi(power)).sum::<f64>());
    let (sum, product) = (a / mass + c / inertia, (stiffness * length).powi(2) / (mass * inertia));
    let root = ((a / mass - c / inertia).powi(2) + 4.0 * b * b / (mass * inertia)).sqrt();
    let upper = 0.5 * (sum + root);
    let expected = [(product / upper).sqrt(), upper.sqrt()];
    // each frequency once along x and once along y
    let off =
        [0, 1].map(|k| (found[2 * k] / expected[k] - 1.0).abs().max((found[2 * k + 1] / expected[k] - 1.0).abs()));
    let bends = 48.0 * Material::STEEL.young * PI / 64.0 * diameter.powi(4) / length.powi(3);
    Ok(Found { error: off[0].max(off[1]), limit: 1e-9 + 3.0 * stiffness / bends })
}
