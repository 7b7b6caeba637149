//! Natural frequencies of published machines (`data/torsional_modes.json`), each by every way that applies. Those of
//! chains with extreme ratios are held in `machine_modes.rs`.

use driveline_solver::plant::modes::System;
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

fn system(case: &Case) -> System {
    assert!(case.ground_springs.is_empty());
    let inertia: Vec<f64> = case.disks.iter().map(|d| d.J).collect();
    let damping: Vec<f64> = case.disks.iter().map(|d| d.c).collect();
    let mut system = System::new(&inertia).disc_damping(&damping);
    for s in &case.shafts {
        system = system.shaft(s.i, s.j, s.k, s.c);
    }
    for g in &case.gears {
        system = system.gear(g.parent, g.node, g.R_parent, g.R);
    }
    system
}

fn largest_error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let relative = |(f, e): (&f64, &f64)| {
        if *e == 0.0 { f.abs() } else { (f / e - 1.0).abs() }
    };
    found.iter().zip(expected).map(relative).fold(0.0, f64::max)
}

#[test]
fn published_machines_by_eigenvalues_and_by_jacobi() {
    for case in cases() {
        let system = system(&case);
        let modes = system.modes().unwrap();
        let eigen = largest_error(&modes.omega, &case.expected_omega_rad_s);
        let jacobi = largest_error(&system.frequencies().unwrap(), &case.expected_omega_rad_s);
        println!("{}: relative error {eigen:.1e} by eigenvalues, {jacobi:.1e} by Jacobi", case.id);
        // the tolerance of the file; zeros must be exact
        assert!(eigen <= case.rel_tol && jacobi <= case.rel_tol, "{}", case.id);
        assert_eq!(modes.free_nodes, case.independent_dof_nodes, "{}", case.id);
        let zeros = modes.omega.iter().filter(|omega| **omega == 0.0).count();
        assert_eq!(zeros, case.n_zero_modes, "{}", case.id);
        let drive = modes.shapes[case.n_zero_modes][case.two_mass_reduction.drive_node].abs();
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
        let found = system(&case).damped_eigenvalues().unwrap();
        assert_eq!(found.len(), expected.len());
        let largest = expected.iter().map(|e| e.0.hypot(e.1)).fold(0.0, f64::max);
        for e in expected {
            let near = found.iter().map(|f| (f.0 - e.0).hypot(f.1 - e.1)).fold(f64::INFINITY, f64::min);
            // the file's tolerance, of the eigenvalue itself; the zero of the rigid angle to rounding of the largest
            let size = e.0.hypot(e.1);
            assert!(near <= case.rel_tol * size + 1e-14 * largest, "{} {e:?} {near:e}", case.id);
            checked += 1;
        }
    }
    assert_eq!(checked, 8);
}

#[test]
fn a_spring_to_the_ground_takes_the_rigid_motion_away() {
    // one disc on a spring and damper: s = -c/2J +- i sqrt(k/J - (c/2J)^2)
    let system = System::new(&[2.0]).ground(0, 50.0, 4.0);
    assert!((system.frequencies().unwrap()[0] - 5.0).abs() < 1e-14);
    assert!((system.modes().unwrap().omega[0] - 5.0).abs() < 1e-14);
    let (re, im) = system.damped_eigenvalues().unwrap()[0];
    // two by two: rounding only
    assert!((re + 1.0).abs() < 1e-13 && (im - 24.0_f64.sqrt()).abs() < 1e-13, "{re} {im}");
}

#[test]
fn a_branch_closed_to_a_ring_has_the_frequencies_of_a_ring() {
    // three equal discs in a ring: 0 and twice sqrt(3 k / J) [derived; heading: Pfützner 1980 ch. 1]
    let system = System::new(&[2.0; 3]).shaft(0, 1, 8.0, 0.0).shaft(1, 2, 8.0, 0.0).shaft(2, 0, 8.0, 0.0);
    let expected = [0.0, 12.0_f64.sqrt(), 12.0_f64.sqrt()];
    // three by three: rounding only
    assert!(largest_error(&system.frequencies().unwrap(), &expected) < 1e-14);
    assert!(largest_error(&system.modes().unwrap().omega, &expected) < 1e-14);
}

#[test]
fn bad_systems_are_refused_by_name() {
    let says = |system: System| system.modes().unwrap_err().to_string();
    assert!(says(System::new(&[1.0, -1.0]).shaft(0, 1, 1.0, 0.0)).contains("inertia of node 1 is -1"));
    assert!(says(System::new(&[1.0, 1.0]).shaft(0, 1, f64::NAN, 0.0)).contains("stiffness of shaft 0 is NaN"));
    assert!(says(System::new(&[1.0, 1.0]).shaft(0, 2, 1.0, 0.0)).contains("node 2"));
    assert!(says(System::new(&[1.0, 1.0]).gear(0, 1, 1.0, 0.0)).contains("gear radius of node 1 is 0"));
    assert!(says(System::new(&[1.0, 1.0]).gear(0, 1, 1.0, 1.0).gear(1, 0, 1.0, 1.0)).contains("more than once"));
    assert!(says(System::new(&[0.0, 1.0]).shaft(0, 1, 1.0, 0.0)).contains("inertia with that of its gears"));
    assert!(says(System::new(&[1.0, 1.0]).disc_damping(&[1.0])).contains("disc damping: 1 given, expected 2"));
}
