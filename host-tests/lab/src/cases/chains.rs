//! Natural frequencies of chains whose inertias and stiffnesses differ by up to 1e15, against 40-digit arithmetic
//! (`torsional_modes_extreme.json`, `extreme_chains.json`).

use driveline::machine::{Chain, Damping, Inertia, Modes, Stiffness};
use serde_json::Value;

use super::{Case, larger};
use driveline_solver::plant::modes::System;

const EXTREME: &str = include_str!("../../../../tests/data/torsional_modes_extreme.json");
const EVERY_ORDER: &str = include_str!("../../../../tests/data/extreme_chains.json");

/// High relative accuracy: what the first file allows, and the same of the second.
const ALLOWED: f64 = 1e-13;

/// Numbers of a file, which writes those of many digits as texts.
fn numbers(value: &Value) -> Result<Vec<f64>, String> {
    let number = |value: &Value| value.as_f64().or_else(|| value.as_str()?.parse().ok());
    let list = value.as_array().ok_or_else(|| format!("{value} is no list"))?;
    list.iter().map(|value| number(value).ok_or_else(|| format!("{value} is no number"))).collect()
}

fn cases(text: &str) -> Result<Vec<Value>, String> {
    let mut file: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    match file["cases"].take() {
        Value::Array(cases) => Ok(cases),
        other => Err(format!("`cases` is {other}")),
    }
}

/// A chain of discs and undamped shafts, as the library has it.
fn chain(inertia: &[f64], stiffness: &[f64]) -> Chain {
    let mut chain = Chain::motor(Inertia(inertia[0]));
    for (j, k) in inertia[1..].iter().zip(stiffness) {
        chain = chain.shaft(Stiffness(*k), Damping(0.0)).rotor(Inertia(*j));
    }
    chain
}

/// The same for the full solver.
fn system(inertia: &[f64], stiffness: &[f64]) -> System {
    let shafts = stiffness.iter().enumerate();
    shafts.fold(System::new(inertia), |system, (i, k)| system.shaft(i, i + 1, *k, 0.0))
}

/// Largest relative error; without bound where their numbers differ.
fn worst(found: impl ExactSizeIterator<Item = f64>, expected: &[f64]) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    found.zip(expected).map(|(found, expected)| (found / expected - 1.0).abs()).fold(0.0, larger)
}

fn resonances(modes: &Modes) -> Vec<f64> {
    modes.resonances().iter().map(|mode| mode.frequency).collect()
}

/// Every chain, by the library's own solver; the first file's also by the full solver's Jacobi method.
pub fn all() -> Result<Vec<Case>, String> {
    let mut all = Vec::new();
    let mut add = |name: &Value, compared, found, allowed| {
        let name = name.as_str().map_or_else(|| name.to_string(), str::to_owned);
        all.push(Case { group: "chains with extreme ratios", name, compared, found, allowed });
    };
    for case in cases(EXTREME)? {
        let (inertia, stiffness) = (numbers(&case["J_kg_m2"])?, numbers(&case["k_Nm_rad"])?);
        let expected = numbers(&case["expected_omega_rad_s"])?;
        let allowed = case["rel_tol_high_relative_accuracy_f64"].as_f64().unwrap_or(ALLOWED);
        let modes = resonances(&chain(&inertia, &stiffness).modes());
        // The first of the file is the rigid turning, which is no mode of the library's.
        let library = worst(modes.into_iter(), &expected[1..]);
        add(&case["id"], "frequencies by the library", library, allowed);
        let jacobi = system(&inertia, &stiffness).frequencies().map_err(|error| error.to_string())?;
        let full = if jacobi.first() == Some(&0.0) {
            worst(jacobi[1..].iter().copied(), &expected[1..])
        } else {
            f64::INFINITY
        };
        add(&case["id"], "frequencies by the full solver", full, allowed);
    }
    for case in cases(EVERY_ORDER)? {
        let modes = chain(&numbers(&case["J"])?, &numbers(&case["k"])?).modes();
        let free = worst(resonances(&modes).into_iter(), &numbers(&case["resonances"])?);
        let held = worst(modes.antiresonances().iter().copied(), &numbers(&case["antiresonances"])?);
        add(&case["id"], "frequencies and antiresonances by the library", larger(free, held), ALLOWED);
    }
    Ok(all)
}
