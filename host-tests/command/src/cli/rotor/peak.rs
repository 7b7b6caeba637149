//! The largest vibration at a sensor.

use serde::Serialize;

use driveline_report::Table;
use driveline_report::format::{significant, turned};

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
