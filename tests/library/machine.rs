//! Machines and the elementary functions of their constants.

mod chain;
mod scalar;

use driveline::machine::{Chain, Damping, Efficiency, Inertia, Mass, Planetary, Stiffness};
use serde_json::Value;

/// Masses in a row, the motor first, and the shafts between them.
pub fn chain(inertia: &[f64], stiffness: &[f64]) -> Chain {
    damped_chain(inertia, stiffness, 0.0)
}

/// The same with a damping of so many seconds times the stiffness.
pub fn damped_chain(inertia: &[f64], stiffness: &[f64], damping: f64) -> Chain {
    let motor = Chain::motor(Inertia(inertia[0]));
    let rotors = inertia[1..].iter().zip(stiffness);
    rotors.fold(motor, |chain, (&j, &k)| chain.shaft(Stiffness(k), Damping(damping * k)).rotor(Inertia(j)))
}

/// The planetary set of [Wang 1989 example 1-4].
pub fn planetary(case: &Value) -> Planetary {
    let at = |key: &str| case[key].as_f64().unwrap();
    Planetary {
        sun_teeth: at("z_sun") as u32,
        ring_teeth: at("z_ring") as u32,
        module: at("module_m"),
        planets: at("planets") as u32,
        sun: Inertia(at("J_sun")),
        planet: Inertia(at("J_planet_own_axis")),
        planet_mass: Mass(at("m_planet")),
        carrier: Inertia(at("J_carrier")),
        efficiency: Efficiency(0.97),
    }
}
