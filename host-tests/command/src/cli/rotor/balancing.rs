//! Modal balancing of a rotor whose unbalance is known: weights, and the unbalance of modes and of the rigid rotor.

use driveline::balancing::{Aim, Error, Influence, RigidUnbalance};
use nalgebra::Complex;
use serde::Serialize;

use super::peak::{Peak, peaks, rpm};
use crate::machine_file::balance::PLANES;
use crate::machine_file::{Balancing, RotorFile};
use driveline_report::format::significant;
use driveline_report::{Section, Table};
use driveline_solver::rotor::Polar;

/// Smallest share of a plane's effect that must be its own: what is lost beside it is a millionth of the weights.
const INDEPENDENCE: f64 = 1e-6;

/// Weights, and what they balance.
#[derive(Debug, Serialize)]
pub struct Balanced {
    /// Centre of mass, m.
    centre: f64,
    weights: Vec<Weight>,
    /// Unbalance of the rigid rotor and of each mode, before and after.
    unbalances: Vec<Unbalance>,
    /// Largest vibration of each sensor with the weights.
    pub peaks: Vec<Peak>,
}

/// A weight.
#[derive(Debug, Serialize)]
struct Weight {
    node: usize,
    /// Unbalance, kg m.
    amount: f64,
    /// Degrees.
    angle: f64,
}

/// An unbalance before and after.
#[derive(Debug, Serialize)]
struct Unbalance {
    /// `static`, `couple`, or `mode` with its critical speed.
    of: &'static str,
    /// Critical speed of a mode, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<f64>,
    /// kg m; kg m2 of the couple. A mode's shape is 1 where it is largest.
    before: f64,
    /// Degrees.
    angle: f64,
    after: f64,
}

/// A shape that bends by less than this, where it is 1 at its largest, is one of the rigid rotor: no plane has more of
/// an effect on it apart from static and couple.
const BENT: f64 = 1e-4;

/// Whether a mode leaves the shaft straight: beside the line through its ends nothing is left.
fn is_straight(shape: &[f64], rotor: &RotorFile) -> bool {
    let (Some(first), Some(last)) = (rotor.places.first(), rotor.places.last()) else { return false };
    let slope = (shape[shape.len() - 1] - shape[0]) / (last - first);
    shape.iter().zip(&rotor.places).all(|(at, place)| (at - shape[0] - slope * (place - first)).abs() < BENT)
}

impl Balanced {
    /// The weights, and the unbalance of every node with them (kg m).
    pub fn of(rotor: &RotorFile, plan: &Balancing) -> Result<(Self, Vec<Complex<f64>>), String> {
        let said = |error: Error| error.to_string();
        if plan.planes.len() > plan.modes.len()
            && let Some((speed, _)) = plan.modes.iter().find(|(_, shape)| is_straight(shape, rotor))
        {
            return Err(format!(
                "the mode at {:.0} r/min is that of a rigid rotor on soft bearings, which static and couple balance \
                 already: no node can balance it apart from them; expected fewer `modes`, 0 for a rotor that stays \
                 rigid, or stiffer bearings",
                rpm(*speed)
            ));
        }
        let places: Vec<f64> = plan.planes.iter().map(|&node| rotor.places[node] - rotor.centre).collect();
        let at_planes: Vec<Vec<f64>> =
            plan.modes.iter().map(|(_, shape)| plan.planes.iter().map(|&node| shape[node]).collect()).collect();
        let shapes: Vec<&[f64]> = at_planes.iter().map(Vec::as_slice).collect();
        let influence = Influence::<f64, PLANES, PLANES>::modal(&shapes, &places).map_err(said)?;
        let rigid = |unbalance: &[Complex<f64>]| {
            let along = unbalance.iter().zip(&rotor.places).map(|(unbalance, at)| (*unbalance, at - rotor.centre));
            RigidUnbalance::of(along)
        };
        let modal = |unbalance: &[Complex<f64>], shape: &[f64]| -> Complex<f64> {
            unbalance.iter().zip(shape).map(|(unbalance, phi)| unbalance * *phi).sum()
        };
        let before = rotor.unbalances();
        let found = rigid(&before).map_err(said)?;
        let mut conditions: Vec<Complex<f64>> = plan.modes.iter().map(|(_, shape)| modal(&before, shape)).collect();
        let mut aim = Aim { independence: INDEPENDENCE, ..Aim::default() };
        if plan.planes.len() > plan.modes.len() {
            conditions.extend([found.resultant, found.couple]);
            let far = places.iter().fold(0.0_f64, |far, place| far.max(place.abs()));
            // the static unbalance and the modes have shapes of one
            aim.weighting[conditions.len() - 1] = 1.0 / far;
        }
        let correction = influence.correct(&conditions, &aim).map_err(said)?;
        if let Some(out) = correction.left_out.first() {
            let node = plan.planes[out.plane];
            return Err(format!(
                "plane {node} is not independent of the other planes: expected another node, or fewer `modes`"
            ));
        }
        let mut after = before.clone();
        for (&node, weight) in plan.planes.iter().zip(&correction.weights) {
            after[node] += weight;
        }
        let left = rigid(&after).map_err(said)?;
        let row = |of, speed, before: Complex<f64>, after: Complex<f64>| {
            let (size, angle) = Polar::of(before);
            Unbalance { of, speed, before: size, angle, after: after.norm() }
        };
        let mut unbalances =
            vec![row("static", None, found.resultant, left.resultant), row("couple", None, found.couple, left.couple)];
        for (speed, shape) in &plan.modes {
            unbalances.push(row("mode", Some(*speed), modal(&before, shape), modal(&after, shape)));
        }
        let weight = |(&node, weight): (&usize, &Complex<f64>)| {
            let (amount, angle) = Polar::of(*weight);
            Weight { node, amount, angle }
        };
        let weights = plan.planes.iter().zip(&correction.weights).map(weight).collect();
        Ok((Self { centre: rotor.centre, weights, unbalances, peaks: Vec::new() }, after))
    }

    /// The tables, for the terminal and the page alike.
    pub fn tables(&self) -> Vec<Section> {
        let mut weights = Table::new(["node", "add g mm", "at °"]);
        for weight in &self.weights {
            let numbers = [significant(weight.amount * 1e6), format!("{:.1}", weight.angle)];
            weights.row([weight.node.to_string()].into_iter().chain(numbers));
        }
        let mut unbalances = Table::new(["unbalance", "now", "at °", "with the weights", "unit"]);
        for unbalance in &self.unbalances {
            let name = match unbalance.speed {
                Some(speed) => format!("{} at {:.0} r/min", unbalance.of, rpm(speed)),
                None => unbalance.of.to_owned(),
            };
            // rounding of the larger unbalance counts as zero
            let after = if unbalance.after < 1e-9 * unbalance.before { 0.0 } else { unbalance.after };
            let (scale, unit) = if unbalance.of == "couple" { (1e9, "g mm²") } else { (1e6, "g mm") };
            let numbers = [significant(unbalance.before * scale), format!("{:.1}", unbalance.angle)];
            let row = [name].into_iter().chain(numbers);
            unbalances.row(row.chain([significant(after * scale), unit.to_owned()]));
        }
        let about = format!(
            "Of the rigid rotor, about its centre of mass at {} m, and of each mode by its shape, largest at 1.",
            significant(self.centre)
        );
        let mut all = vec![
            Section::new("Balancing weights", "Modal balancing of the unbalance of the file.", weights),
            Section::new("Unbalance", about, unbalances),
        ];
        if !self.peaks.is_empty() {
            let text = "Amplitude of the displacement, up to the highest speed.";
            all.push(Section::new("Vibration with the weights", text, peaks(&self.peaks)));
        }
        all
    }
}
