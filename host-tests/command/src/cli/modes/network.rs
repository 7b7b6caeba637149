//! A machine as a network of inertias, springs and shafts with an inertia of their own.

use std::f64::consts::PI;

use driveline_solver::plant::vibration::{Network, Spring};

use crate::machine_file::station::stations;
use crate::machine_file::{Element, MachineFile, Part};

/// Slices of a tapered section, each of two even pieces. The error falls with the fourth power: 1e-10 of the first
/// five frequencies where the ends are as three to one.
const SLICES: usize = 512;

/// The masses of a machine without what shafts have of their own, and its shafts, at the motor; gaps are closed.
pub fn network(machine: &MachineFile) -> Network {
    let mut masses = machine.masses().to_vec();
    let joints = machine.joints();
    let mut own: Vec<Vec<Piece>> = vec![Vec::new(); joints.len()];
    let mut look = |parts: &[Part], before: f64, at: &dyn Fn(usize) -> usize| {
        for (part, station) in parts.iter().zip(stations(parts)) {
            let (ends, Some(shaft)) = (part.element.end_inertias(), station.shaft.map(at)) else { continue };
            if ends == [0.0; 2] {
                continue;
            }
            let square = (before * station.ratio).powi(2);
            let joint = joints[shaft];
            for (mass, end) in [joint.from, joint.to].into_iter().zip(ends) {
                let left = masses[mass] - end / square;
                // nothing but rounding is left of a joint of two shafts
                masses[mass] = if left > 1e-12 * masses[mass] { left } else { 0.0 };
            }
            own[shaft] = pieces(&part.element, joint.shaft.stiffness, square);
        }
    };
    look(&machine.elements, 1.0, &|shaft| shaft);
    for branch in &machine.branches {
        look(&branch.elements, branch.ratio, &|shaft| branch.shaft(shaft));
    }
    let mut network = Network::default();
    for (inertia, viscous) in masses.into_iter().zip(machine.viscous()) {
        network.coordinate(inertia, viscous);
    }
    for (joint, own) in joints.into_iter().zip(own) {
        let shaft = joint.shaft;
        let Some((last, others)) = own.split_last() else {
            network.link(Spring::shaft(joint.from, joint.to, shaft.stiffness).damping(shaft.damping));
            continue;
        };
        let mut from = joint.from;
        let put = |from: usize, to: usize, piece: &Piece, network: &mut Network| {
            // each twists by its share, and loses as much of it
            let damping = shaft.damping * (piece.stiffness / shaft.stiffness);
            network.link(Spring::shaft(from, to, piece.stiffness).damping(damping).inertia(piece.inertia));
        };
        for piece in others {
            let to = network.coordinate(0.0, 0.0);
            put(from, to, piece, &mut network);
            from = to;
        }
        put(from, joint.to, last, &mut network);
    }
    network
}

/// An even piece of a shaft, at the motor.
#[derive(Clone, Copy)]
struct Piece {
    stiffness: f64,
    inertia: f64,
}

/// The even pieces of a shaft of this stiffness at the motor. A taper is integrated by a commutator-free Magnus method
/// of the fourth order: a slice is two even pieces, by the section in its two Gauss points
/// [Blanes and Moan 2006, Appl. Numer. Math. 56(12)].
fn pieces(element: &Element, stiffness: f64, square: f64) -> Vec<Piece> {
    let [beginning, end] = element.end_inertias();
    let Element::Section { length, diameter, end: far, bore, modulus, density, .. } = *element else {
        return vec![Piece { stiffness, inertia: (beginning + end) / square }];
    };
    if diameter == far {
        return vec![Piece { stiffness, inertia: (beginning + end) / square }];
    }
    let step = length / SLICES as f64;
    let polar = |x: f64| {
        let outer = diameter + (far - diameter) * x / SLICES as f64;
        PI / 32.0 * (outer.powi(4) - bore.powi(4)) / square
    };
    let offset = 3f64.sqrt() / 6.0;
    let (large, small) = (0.25 + offset, 0.25 - offset);
    let slice = |j: usize| {
        let [a, b] = [0.5 - offset, 0.5 + offset].map(|x| polar(j as f64 + x));
        [(large, small), (small, large)].map(|(near, far)| Piece {
            stiffness: modulus / (step * (near / a + far / b)),
            inertia: density * step * (near * a + far * b),
        })
    };
    (0..SLICES).flat_map(slice).collect()
}
