//! A weight, and what of it goes into which hole.

use driveline::balancing::{Complex, Error, Holes, degrees};
use serde::Serialize;

use super::fault::Fault;
use crate::machine_file::balance::PlaneHoles;
use driveline_report::chart::Arrow;
use driveline_report::format::{significant, turned};

/// Amplitude and phase.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Polar {
    /// Amplitude, or amount.
    pub amplitude: f64,
    /// Phase, or angle, from 0 to below 360.
    pub degrees: f64,
}

impl Polar {
    /// Of a complex number.
    pub fn of(z: Complex<f64>) -> Self {
        let (amplitude, degrees) = degrees(z);
        Polar { amplitude, degrees }
    }

    /// Amplitude and angle as they are written; no angle of nothing.
    pub fn told(self) -> [String; 2] {
        [significant(self.amplitude), if self.amplitude > 0.0 { turned(self.degrees, 1) } else { String::new() }]
    }
}

/// Weight in a hole, or removed from it.
#[derive(Clone, Debug, Serialize)]
pub struct Hole {
    /// Its number, from 1.
    pub hole: usize,
    /// Its angle.
    pub degrees: f64,
    /// Its weight.
    pub weight: f64,
}

/// Fits a weight into the holes of a plane: what they make together, and those that are used.
///
/// # Errors
/// Holes that cannot take it, at their place in the file.
pub fn fill(holes: &PlaneHoles, weight: Complex<f64>) -> Result<(Complex<f64>, Vec<Hole>), Fault> {
    let angles: Vec<f64> = holes.degrees.iter().map(|degrees| degrees.to_radians()).collect();
    let found = Holes { angles: &angles, weights: &holes.weights, method: holes.mode }.fit(weight);
    let found = found.map_err(|refusal| match refusal {
        Error::TooHeavy { .. } => Fault::Placed(holes.too_heavy.clone()),
        _ => Fault::Refused(refusal),
    })?;
    let used = found.holes.into_iter().filter(|(_, weight)| *weight > 0.0);
    let used = used.map(|(hole, weight)| Hole { hole: hole + 1, degrees: holes.degrees[hole], weight }).collect();
    Ok((found.sum, used))
}

/// Holes in words; nothing where there are none to choose from.
pub fn told(holes: Option<&[Hole]>) -> String {
    match holes {
        None => String::new(),
        Some([]) => "none: too light".to_owned(),
        Some(holes) => {
            let one = |hole: &Hole| {
                format!("{} in hole {} ({}°)", significant(hole.weight), hole.hole, significant(hole.degrees))
            };
            holes.iter().map(one).collect::<Vec<_>>().join(", ")
        }
    }
}

/// An arrow of a polar plot.
pub fn arrow(class: &'static str, name: &str, polar: Polar) -> Arrow {
    Arrow { class, name: name.to_owned(), amplitude: polar.amplitude, degrees: polar.degrees }
}

/// The arrows of a weight and of its holes.
pub fn arrows_of(weight: Polar, holes: Option<&[Hole]>) -> Vec<Arrow> {
    let mut arrows = vec![arrow("s0", "weight", weight)];
    for hole in holes.into_iter().flatten() {
        let polar = Polar { amplitude: hole.weight, degrees: hole.degrees };
        arrows.push(arrow("s3", &format!("hole {}", hole.hole), polar));
    }
    arrows
}
