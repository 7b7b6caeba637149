//! Natural frequencies of published machines (`data/torsional_modes.json`). Those of chains with extreme ratios are held
//! in `machine_modes.rs`.

use driveline_solver::plant::train::{Coordinate, Link, Train};
use serde::Deserialize;

#[derive(Deserialize)]
struct Cases<T> {
    cases: Vec<T>,
}

#[derive(Deserialize)]
struct Case {
    id: String,
    disks: Vec<Disk>,
    shafts: Vec<ShaftData>,
    gears: Vec<GearData>,
    ground_springs: Vec<serde_json::Value>,
    independent_dof_nodes: Vec<usize>,
    n_zero_modes: usize,
    expected_omega_rad_s: Vec<f64>,
    expected_damped_eigenvalues_re_im_1_s: Option<Vec<(f64, f64)>>,
    rel_tol: f64,
    two_mass_reduction: Reduction,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Disk {
    J: f64,
    #[serde(default)]
    c: f64,
}

#[derive(Deserialize)]
struct ShaftData {
    i: usize,
    j: usize,
    k: f64,
    #[serde(default)]
    c: f64,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct GearData {
    parent: usize,
    node: usize,
    R_parent: f64,
    R: f64,
}

#[derive(Deserialize)]
struct Reduction {
    drive_node: usize,
    phi_drive_mass_normalised: f64,
}

fn cases() -> Vec<Case> {
    serde_json::from_str::<Cases<Case>>(include_str!("../../../../../tests/data/torsional_modes.json")).unwrap().cases
}

/// Of every node the coordinate that it follows through gears, and its angle per angle of that.
fn ties(case: &Case) -> Vec<(usize, f64)> {
    let tie = |mut node: usize| {
        let mut ratio = 1.0;
        while let Some(gear) = case.gears.iter().find(|gear| gear.node == node) {
            ratio *= -gear.R_parent / gear.R;
            node = gear.parent;
        }
        (case.independent_dof_nodes.iter().position(|&free| free == node).unwrap(), ratio)
    };
    (0..case.disks.len()).map(tie).collect()
}

fn train(case: &Case) -> Train {
    assert!(case.ground_springs.is_empty());
    let ties = ties(case);
    let mut sums = vec![(0.0, 0.0); case.independent_dof_nodes.len()];
    for (disk, &(at, ratio)) in case.disks.iter().zip(&ties) {
        sums[at] = (sums[at].0 + ratio * ratio * disk.J, sums[at].1 + ratio * ratio * disk.c);
    }
    let train = sums.iter().fold(Train::new(), |train, &(j, c)| train.coordinate(Coordinate::new(j).viscous(c)));
    case.shafts.iter().fold(train, |train, shaft| {
        let [(from, near), (to, far)] = [ties[shaft.i], ties[shaft.j]];
        let square = near * near;
        train.link(Link::geared(from, to, far / near, square * shaft.k).damping(square * shaft.c))
    })
}

fn largest_error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let relative = |(f, e): (&f64, &f64)| {
        if *e == 0.0 { f.abs() } else { (f / e - 1.0).abs() }
    };
    found.iter().zip(expected).map(relative).fold(0.0, f64::max)
}

#[test]
fn published_machines() {
    for case in cases() {
        let modes = train(&case).modes().unwrap();
        let error = largest_error(&modes.omega, &case.expected_omega_rad_s);
        println!("{}: relative error {error:.1e}", case.id);
        // the tolerance of the file; zeros must be exact
        assert!(error <= case.rel_tol, "{}", case.id);
        assert_eq!(modes.rigid_motions(), case.n_zero_modes, "{}", case.id);
        let (at, ratio) = ties(&case)[case.two_mass_reduction.drive_node];
        let drive = (ratio * modes.shapes[case.n_zero_modes][at]).abs();
        let expected = case.two_mass_reduction.phi_drive_mass_normalised.abs();
        // a shape is as good as the gap between eigenvalues lets it be: the tolerance of the file again
        assert!((drive / expected - 1.0).abs() <= case.rel_tol, "{} {drive} {expected}", case.id);
    }
}

#[test]
fn damped_eigenvalues_of_a_geared_drive_train() {
    let mut checked = 0;
    for case in cases() {
        let Some(expected) = &case.expected_damped_eigenvalues_re_im_1_s else {
            continue;
        };
        let train = train(&case);
        let found = train.decays(&train.modes().unwrap()).unwrap();
        let largest = expected.iter().map(|e| e.0.hypot(e.1)).fold(0.0, f64::max);
        // one of each pair; what neither swings nor decays is none
        for e in expected.iter().filter(|e| e.0.hypot(e.1) > 1e-12 * largest) {
            let near = found.iter().map(|f| (f.decay + e.0).hypot(f.omega - e.1.abs())).fold(f64::INFINITY, f64::min);
            // the file's tolerance, of the eigenvalue itself
            let size = e.0.hypot(e.1);
            assert!(near <= case.rel_tol * size + 1e-14 * largest, "{} {e:?} {near:e}", case.id);
            checked += 1;
        }
    }
    assert_eq!(checked, 7);
}
