//! A piston engine: free forces and moments, and how strongly it excites each mode.

use driveline::machine::{Shaking, free_forces, free_moments, phasor_sum};
use driveline_solver::plant::vibration::Modes;
use nalgebra::Complex;
use serde::Serialize;

use super::campbell::Critical;
use super::response::Response;
use crate::machine_file::{Engine, MachineFile, engine};
use driveline_report::format::significant;
use driveline_report::{Section, Table};

/// Free forces and moments of an engine.
#[derive(Clone, Debug, Serialize)]
pub struct FreeForces {
    /// Speed of the crankshaft (rad/s).
    pub speed: f64,
    /// Firing angle of each cylinder (degrees).
    pub firing: Vec<f64>,
    /// Those that are not zero, up to the sixth.
    pub orders: [Order; 4],
    /// Largest force of the first order (N) with counterweights of half the reciprocating mass at every throw.
    pub counterweighted: f64,
}

/// Free force and moment of one order.
#[derive(Clone, Debug, Serialize)]
pub struct Order {
    /// Order.
    pub order: u32,
    /// Force that rotates with the crank (N).
    pub force_forward: f64,
    /// Force that rotates against it (N).
    pub force_backward: f64,
    /// Moment about the middle of the cylinders (N m), alike; `null` without positions.
    pub moment_forward: Option<f64>,
    /// Moment that rotates against the crank.
    pub moment_backward: Option<f64>,
    /// Unbalances of two shafts at `order` times the speed that balance the force, the first of which turns with the
    /// crank: kg m and degrees of their angle with the crank at zero.
    pub balance_shafts: [[f64; 2]; 2],
}

/// Free forces of a machine's engine at its highest speed; none without an engine.
pub fn free(machine: &MachineFile) -> Option<FreeForces> {
    let engine = machine.engine.as_ref()?;
    let speed = machine.running.as_ref().map_or(machine.limits.speed, |range| range.greatest) / engine.ratio;
    let units = engine.crank.force_orders::<7>(speed);
    let positions = engine.cylinders.iter().map(|cylinder| cylinder.position);
    let middle = positions.sum::<f64>() / engine.cylinders.len() as f64;
    let order = |order: u32, unit: f64| {
        // the rounding of a sum that is none, of forces of 1 and arms of a few metres
        let exact = |size: f64| if size < 1e-12 { 0.0 } else { unit.abs() * size };
        let parts = |shaking: Shaking| [shaking.forward, shaking.backward].map(|[x, y]| exact(f64::hypot(x, y)));
        let force = free_forces(&engine.cylinders, order);
        let [force_forward, force_backward] = parts(force);
        let shafts = force.balance_shafts(&engine.crank, order).unwrap_or_default();
        let largest = engine.crank.reciprocating_mass().0 * engine.crank.radius.0;
        let balance_shafts = shafts.map(|[x, y]| match f64::hypot(x, y) {
            size if size < 1e-12 * largest => [0.0; 2],
            size => [size, y.atan2(x).to_degrees()],
        });
        let moment = engine.placed.then(|| parts(free_moments(&engine.cylinders, order, middle)));
        let [moment_forward, moment_backward] = [0, 1].map(|part| moment.map(|moment| moment[part]));
        Order { order, force_forward, force_backward, moment_forward, moment_backward, balance_shafts }
    };
    let firing = engine.cylinders.iter().map(|cylinder| cylinder.firing.to_degrees()).collect();
    let counterweighted = units[1] * free_forces(&engine.cylinders, 1).counterweighted(0.5).largest();
    Some(FreeForces { speed, firing, orders: [1, 2, 4, 6].map(|k| order(k, units[k as usize])), counterweighted })
}

/// The table of free forces and moments.
pub fn table(free: &FreeForces) -> Section {
    let mut table = Table::new([
        "order",
        "force with the crank N",
        "against it N",
        "moment with the crank N m",
        "against it N m",
        "balance shaft with the crank",
        "against it",
    ]);
    for order in &free.orders {
        let moments = [order.moment_forward, order.moment_backward];
        table.row(
            [order.order.to_string(), significant(order.force_forward), significant(order.force_backward)]
                .into_iter()
                .chain(moments.map(|moment| moment.map_or_else(String::new, significant)))
                .chain(order.balance_shafts.map(|[size, angle]| match size {
                    0.0 => "none".to_owned(),
                    size => format!("{} kg m at {angle:.0}°", significant(size)),
                })),
        );
    }
    let text = format!(
        "Of the reciprocating masses at {} rad/s of the crankshaft: parts that rotate with the crank and against it, \
         at `order` times its speed. Their sum is the largest force. Counterweights balance the first part of the \
         first order: with half of each mass {} N are left. The others need balance shafts at `order` times the speed, \
         whose unbalances balance the force. The cylinders fire at {} degrees.",
        significant(free.speed),
        significant(free.counterweighted),
        free.firing.iter().map(|angle| ((angle * 100.0).round() / 100.0).to_string()).collect::<Vec<_>>().join(", ")
    );
    Section::new("Free forces and moments of the engine", text, table)
}

/// Adds to the engine's critical speeds what excites them.
pub fn excite(critical: &mut [Critical], engine: &Engine, modes: &Modes, response: &Response) {
    for critical in critical.iter_mut().filter(|critical| critical.excitation == engine::NAME) {
        let (omega, shape) = (modes.omega[critical.mode - 1], &modes.shapes[critical.mode - 1]);
        let throws: Vec<f64> = engine.at.iter().map(|&mass| shape[mass]).collect();
        let largest = shape.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let sum = phasor_sum(&engine.cylinders, &throws, critical.order);
        let torque = engine.torque(critical.order, critical.speed / engine.ratio).amplitude();
        critical.phasor_sum = Some(sum / largest);
        critical.torque = Some(torque);
        // damping alone limits the mode
        if modes.dissipation[critical.mode - 1] > 0.0 {
            let mut torques = vec![Complex::from(0.0); shape.len()];
            for (cylinder, &mass) in engine.cylinders.iter().zip(&engine.at) {
                torques[mass] += Complex::from_polar(torque / engine.ratio, -critical.order * cylinder.firing);
            }
            critical.shaft_torque = response.shaft_torque(omega, &torques);
        }
    }
}
