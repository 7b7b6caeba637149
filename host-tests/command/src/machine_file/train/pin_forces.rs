//! Forces in the pins of a crank at an angle, at an even speed: Newton's laws of slider and rod [derived].

use std::f64::consts::TAU;

use driveline_solver::plant::train::{Crank, StrokeLoad};
use serde::Serialize;

/// Forces in the pins of a crank. The first component is along the slider's way, outwards; the second across it,
/// towards the crank pin at a quarter of a turn.
#[derive(Clone, Debug, Serialize)]
pub struct PinForces {
    /// Name of the coordinate.
    pub name: String,
    /// Angle of the crank (rad).
    pub angle: f64,
    /// Speed of the crank, even (rad/s).
    pub speed: f64,
    /// On the rod by the crank, and on the crank by its main bearing where the crank is balanced (N).
    pub crank: [f64; 2],
    /// On the slider by the rod (N).
    pub wrist: [f64; 2],
    /// On the slider by its guide, across its way (N).
    pub guide: f64,
}

impl PinForces {
    /// With the forces that act on the slider.
    pub(super) fn of(name: &str, crank: &Crank, [angle, speed]: [f64; 2], loads: &[StrokeLoad]) -> Self {
        let (Crank { radius, rod, rod_mass, .. }, (sine, cosine)) = (*crank, angle.sin_cos());
        let lambda = radius / rod;
        // sin, cos, first and second derivative of the angle by which the rod leans
        let lean = lambda * sine;
        let upright = (1.0 - lean * lean).sqrt();
        let rate = lambda * cosine / upright;
        let bend = (rate * rate * lean - lambda * sine) / upright;
        let square = speed * speed;
        let pin = [-square * radius * cosine, -square * radius * sine];
        let way = pin[0] - square * rod * (upright * rate * rate + lean * bend);
        let share = crank.rod_centre;
        let rod_force = [(1.0 - share) * pin[0] + share * way, (1.0 - share) * pin[1]].map(|a| rod_mass * a);
        let acts = |load: &&StrokeLoad| (angle - load.from).rem_euclid(TAU) < load.to - load.from;
        let outside: f64 = loads.iter().filter(acts).map(|load| load.load).sum();
        let along = crank.slider_mass * way - outside;
        let at_crank = along + rod_force[0];
        // moments about the rod's centre, whose ends are at -share and 1 - share of the rod
        let moment = -crank.rod_inertia * bend * square / rod;
        let across =
            -(moment + share * upright * rod_force[1] + share * lean * at_crank + (1.0 - share) * lean * along)
                / upright;
        Self {
            name: name.to_owned(),
            angle,
            speed,
            crank: [at_crank, across + rod_force[1]],
            wrist: [along, across],
            guide: -across,
        }
    }
}
