//! The balance quality grade before and after, of the rotor and at each bearing.

use driveline::balancing::{BalanceTolerance, Complex, Error, RigidUnbalance, degrees, two_planes};
use serde::Serialize;

use crate::machine_file::balance::{Along, BalanceFile};
use driveline_report::format::{significant, turned};
use driveline_report::{Fact, fact};

/// The grade before and after.
#[derive(Clone, Debug, Serialize)]
pub struct Grade {
    /// Permissible residual unbalance.
    pub permissible_g_mm: f64,
    /// Unbalance now.
    pub now_g_mm: f64,
    /// The grade that goes with it.
    pub now_grade: f64,
    /// Unbalance as predicted.
    pub predicted_g_mm: f64,
    /// The grade that goes with it.
    pub predicted_grade: f64,
    /// Whether what is predicted is within the tolerance: at each bearing, where it is split between them.
    pub passed: bool,
    /// At the bearings, where the file says where everything is along the rotor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bearings: Option<[Bearing; 2]>,
    /// Static and couple unbalance now, likewise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parts: Option<Parts>,
    /// Whether one plane is enough, where the file has width and diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_plane_suffices: Option<bool>,
}

/// The unbalance of the rigid rotor about its centre of mass.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Parts {
    pub static_g_mm: f64,
    pub static_degrees: f64,
    pub couple_g_mm2: f64,
    pub couple_degrees: f64,
}

/// A bearing's share.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Bearing {
    /// Permissible residual unbalance in the bearing's plane.
    pub permissible_g_mm: f64,
    /// Unbalance now, resolved into the bearings' planes, and its angle.
    pub now_g_mm: f64,
    /// Degrees.
    pub now_degrees: f64,
    /// Unbalance as predicted, likewise.
    pub predicted_g_mm: f64,
    /// Degrees.
    pub predicted_degrees: f64,
    /// Whether what is predicted is within the tolerance.
    pub passed: bool,
}

/// Unbalance now is what the weights would take away; what is left is what they are off by, each plane by its own size.
pub fn grade(file: &BalanceFile, wanted: &[Complex<f64>], placed: &[Complex<f64>]) -> Result<Option<Grade>, Error> {
    let Some(rotor) = &file.rotor else { return Ok(None) };
    let Some(unbalance) = file.weight_unit.unbalance(rotor.radius) else { return Ok(None) };
    let tolerance =
        BalanceTolerance { grade: rotor.grade, mass: rotor.mass, speed: rotor.rpm * std::f64::consts::TAU / 60.0 };
    let now: f64 = wanted.iter().map(|weight| weight.norm() * unbalance).sum();
    let left: f64 = wanted.iter().zip(placed).map(|(wanted, placed)| (wanted - placed).norm() * unbalance).sum();
    let (before, after) = (tolerance.judge(now)?, tolerance.judge(left)?);
    let bearings = match &rotor.along {
        Some(along) => Some(bearings(file, &tolerance, along, unbalance, wanted, placed)?),
        None => None,
    };
    Ok(Some(Grade {
        permissible_g_mm: tolerance.permissible()? * 1e6,
        now_g_mm: now * 1e6,
        now_grade: before.grade,
        predicted_g_mm: left * 1e6,
        predicted_grade: after.grade,
        passed: bearings.map_or(after.passed, |bearings| bearings.iter().all(|bearing| bearing.passed)),
        bearings,
        parts: rotor.along.as_ref().map(|along| parts(file, along, unbalance, wanted)).transpose()?,
        one_plane_suffices: rotor.one_plane,
    }))
}

/// The unbalance of the planes as that of the rigid rotor.
fn parts(file: &BalanceFile, along: &Along, unbalance: f64, wanted: &[Complex<f64>]) -> Result<Parts, Error> {
    // what the weights take away is opposite to them
    let planes = wanted.iter().zip(&along.planes).map(|(weight, at)| (-weight * unbalance, at - along.centre));
    let rigid = RigidUnbalance::of(planes)?;
    let [(resultant, static_degrees), (couple, couple_degrees)] =
        [rigid.resultant, rigid.couple].map(|part| degrees(file.angles.weight(part)));
    Ok(Parts { static_g_mm: resultant * 1e6, static_degrees, couple_g_mm2: couple * 1e9, couple_degrees })
}

/// The tolerance split between the bearings, and the planes' unbalances resolved into them.
fn bearings(
    file: &BalanceFile,
    tolerance: &BalanceTolerance<f64>,
    along: &Along,
    unbalance: f64,
    wanted: &[Complex<f64>],
    placed: &[Complex<f64>],
) -> Result<[Bearing; 2], Error> {
    let shares = tolerance.at_bearings(along.centre, along.span)?;
    let resolved = |of: &dyn Fn(usize) -> Complex<f64>| {
        two_planes(along.planes.iter().enumerate().map(|(plane, at)| (of(plane) * unbalance, *at)), 0.0, along.span)
    };
    let [now, left] = [resolved(&|plane| wanted[plane])?, resolved(&|plane| wanted[plane] - placed[plane])?];
    // what the weights take away is opposite to them
    let angle = |z: Complex<f64>| degrees(file.angles.weight(-z)).1;
    let bearing = |at: usize| Bearing {
        permissible_g_mm: shares[at] * 1e6,
        now_g_mm: now[at].norm() * 1e6,
        now_degrees: angle(now[at]),
        predicted_g_mm: left[at].norm() * 1e6,
        predicted_degrees: angle(left[at]),
        passed: left[at].norm() <= shares[at],
    };
    Ok([bearing(0), bearing(1)])
}

impl Grade {
    /// Its text.
    pub fn facts(&self) -> Vec<Fact> {
        let unbalance = |g_mm: f64, grade: f64| format!("{} g mm, G {}", significant(g_mm), significant(grade));
        let verdict = |passed: bool| if passed { "predicted within it" } else { "predicted above it" };
        let whole = if self.bearings.is_some() { "split between the bearings" } else { verdict(self.passed) };
        let mut facts = vec![
            fact("unbalance now", unbalance(self.now_g_mm, self.now_grade)),
            fact("unbalance predicted", unbalance(self.predicted_g_mm, self.predicted_grade)),
            fact("permissible", format!("{} g mm: {whole}", significant(self.permissible_g_mm))),
        ];
        for (name, bearing) in ["A", "B"].into_iter().zip(self.bearings.iter().flatten()) {
            let value = format!(
                "{} now, {} predicted, {} permissible: {}",
                angled(bearing.now_g_mm, "g mm", bearing.now_degrees),
                angled(bearing.predicted_g_mm, "g mm", bearing.predicted_degrees),
                significant(bearing.permissible_g_mm),
                verdict(bearing.passed)
            );
            facts.push(fact(format!("at bearing {name}"), value));
        }
        if let Some(Parts { static_g_mm, static_degrees, couple_g_mm2, couple_degrees }) = self.parts {
            facts.push(fact("static unbalance now", angled(static_g_mm, "g mm", static_degrees)));
            facts.push(fact("couple unbalance now", angled(couple_g_mm2, "g mm²", couple_degrees)));
        }
        if let Some(suffices) = self.one_plane_suffices {
            let value = if suffices {
                "one: width over diameter is at most 0.2"
            } else {
                "two: width over diameter is above 0.2"
            };
            facts.push(fact("planes of a rigid rotor", value.to_owned()));
        }
        facts
    }
}

/// A size with its angle; no angle of nothing.
fn angled(size: f64, unit: &str, angle: f64) -> String {
    let angle = if size > 0.0 { format!(" at {}°", turned(angle, 0)) } else { String::new() };
    format!("{} {unit}{angle}", significant(size))
}
