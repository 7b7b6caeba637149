//! The largest vibration at a sensor.

use nalgebra::Complex;
use serde::Serialize;

use driveline_report::Table;
use driveline_report::format::{significant, turned};
use driveline_solver::rotor::RotorError;

/// The largest vibration of a sensor up to the highest speed.
#[derive(Debug, Serialize)]
pub struct Peak {
    /// Where the sensor is.
    pub node: usize,
    /// Angle from x, degrees.
    pub angle: f64,
    /// Speed, rad/s.
    pub speed: f64,
    /// Amplitude, m; infinite (`null` in JSON) at a resonance of an undamped rotor.
    pub amplitude: f64,
    /// Angle by which it leads the rotor's zero, degrees.
    pub phase: f64,
}

/// Share of the largest vibration so far from which another maximum may turn out to be larger between its speeds.
const NEARLY: f64 = 0.8;
/// Width of the interval that a maximum is enclosed in, over that of the speeds beside it: it is flat there.
const ENCLOSED: f64 = 1e-6;

/// Speed (rad/s) and vibration of a sensor where it is largest: every maximum of rising speeds that comes near to the
/// largest is enclosed by the golden section.
pub fn highest(
    all: &[(f64, Vec<Complex<f64>>)],
    sensor: usize,
    at: impl Fn(f64) -> Result<Vec<Complex<f64>>, RotorError>,
) -> Result<(f64, Complex<f64>), RotorError> {
    let size = |k: usize| all[k].1[sensor].norm();
    let largest = (0..all.len()).map(size).fold(0.0, f64::max);
    let mut best = (0.0, Complex::new(0.0, 0.0));
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for k in (0..all.len()).filter(|&k| size(k) >= NEARLY * largest) {
        let sides = [k.saturating_sub(1), (k + 1).min(all.len() - 1)];
        if sides.iter().any(|&side| size(side) > size(k)) {
            continue;
        }
        let solved = |speed: f64| Ok::<_, RotorError>((speed, at(speed)?[sensor]));
        let mut now = (all[k].0, all[k].1[sensor]);
        let [mut low, mut high] = sides.map(|side| all[side].0);
        let width = ENCLOSED * (high - low);
        while high - low > width.max(4.0 * f64::EPSILON * high) {
            // beyond the better one in the wider part
            let right = high - now.0 > now.0 - low;
            let share = 1.0 - golden;
            let next = solved(now.0 + share * if right { high - now.0 } else { low - now.0 })?;
            let better = next.1.norm() > now.1.norm();
            match (right, better) {
                (true, true) => low = now.0,
                (true, false) => high = next.0,
                (false, true) => high = now.0,
                (false, false) => low = next.0,
            }
            if better {
                now = next;
            }
        }
        if now.1.norm() > best.1.norm() || best.0 == 0.0 {
            best = now;
        }
    }
    Ok(best)
}

/// Speed in turns a minute, of rad/s.
pub fn rpm(speed: f64) -> f64 {
    speed * 30.0 / std::f64::consts::PI
}

/// The table of all sensors.
pub fn peaks(all: &[Peak]) -> Table {
    let mut peaks = Table::new(["sensor", "largest µm", "at r/min", "leads by °"]);
    for peak in all {
        peaks.row([
            format!("node {}, {}°", peak.node, significant(peak.angle)),
            if peak.amplitude.is_finite() { significant(peak.amplitude * 1e6) } else { "undamped".to_owned() },
            format!("{:.0}", rpm(peak.speed)),
            // it turns over at a resonance
            if peak.amplitude.is_finite() { turned(peak.phase, 1) } else { String::new() },
        ]);
    }
    peaks
}
