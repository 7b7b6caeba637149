//! Critical speeds: where an excitation's order meets a natural frequency `[derived; heading: Pfützner 1980 ch. 1]`.

use std::f64::consts::TAU;

use driveline::design::{BarredSpeeds, USUAL_MARGIN};
use serde::Serialize;

use crate::machine_file::{Excitation, Running};
use driveline_report::chart::{Crossing, Ray, campbell};
use driveline_report::format::{percent, significant};
use driveline_report::{Section, Table};

/// A critical speed nearer to the running range than this share of it is flagged.
pub const NEAR: f64 = 0.1;

/// A speed of the motor at which an order of an excitation has a natural frequency.
#[derive(Clone, Debug, Serialize)]
pub struct Critical {
    /// Mode, from 1.
    pub mode: usize,
    /// Its frequency (Hz).
    pub hz: f64,
    /// The excitation.
    pub excitation: String,
    /// Its order.
    pub order: f64,
    /// Speed of the motor (rad/s): `ratio omega/order`.
    pub speed: f64,
    /// How far it lies outside the running range, as a share of the end that is nearer; negative inside; `null`
    /// without a range.
    pub margin: Option<f64>,
    /// Whether it lies in the running range or within 10 % of it.
    pub flagged: bool,
    /// Phasor sum of an engine's order over the shape, the largest amplitude 1; `null` of other excitations.
    pub phasor_sum: Option<f64>,
    /// Torque of one cylinder of this order (N m); `null` likewise.
    pub torque: Option<f64>,
    /// Largest torque of a shaft while the machine dwells there (N m at the motor); `null` likewise, or without
    /// damping.
    pub shaft_torque: Option<f64>,
}

/// All critical speeds of natural frequencies (rad/s), the lowest first.
pub fn critical_speeds(natural: &[f64], running: Option<&Running>, excitations: &[Excitation]) -> Vec<Critical> {
    let mut all = Vec::new();
    for (mode, &omega) in natural.iter().enumerate() {
        for excitation in excitations {
            for &order in &excitation.orders {
                let speed = excitation.ratio * omega / order;
                let margin = running.map(|range| {
                    let (below, above) =
                        ((range.least - speed) / range.least, (speed - range.greatest) / range.greatest);
                    below.max(above)
                });
                all.push(Critical {
                    mode: mode + 1,
                    hz: omega / TAU,
                    excitation: excitation.name.clone(),
                    order,
                    speed,
                    margin,
                    flagged: margin.is_some_and(|margin| margin <= NEAR),
                    phasor_sum: None,
                    torque: None,
                    shaft_torque: None,
                });
            }
        }
    }
    all.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    all
}

/// Phasor sum of an engine's order, the largest amplitude 1, below which its cylinders cancel.
const CANCELLED: f64 = 0.05;

/// Most barred ranges.
const RANGES: usize = 256;

/// The ranges about the critical speeds that begin below a speed (rad/s), joined where they meet. Orders of an engine
/// whose cylinders cancel bar nothing.
pub fn barred(speeds: &[Critical], up_to: f64) -> Vec<[f64; 2]> {
    let felt = speeds.iter().filter(|critical| critical.phasor_sum.is_none_or(|sum| sum >= CANCELLED));
    let speeds: Vec<f64> = felt.map(|critical| critical.speed).filter(|speed| *speed > 0.0).collect();
    BarredSpeeds::<RANGES>::try_new(&speeds, &[1.0], USUAL_MARGIN, up_to)
        .map_or_else(|_| Vec::new(), |barred| barred.ranges().to_vec())
}

/// The table of barred ranges; none without one.
pub fn barred_speeds(ranges: &[[f64; 2]]) -> Option<Section> {
    let mut table = Table::new(["from rad/s", "to rad/s", "from r/min", "to r/min"]);
    for [from, to] in ranges {
        table.row([*from, *to, from * 60.0 / TAU, to * 60.0 / TAU].map(significant));
    }
    let text = "Pass these quickly: 10 % either side of each critical speed that begins below the largest running \
                speed, orders whose cylinders cancel left out.";
    (!ranges.is_empty()).then(|| Section::new("Barred speeds", text, table))
}

/// The table of critical speeds; none where nothing excites.
pub fn critical(speeds: &[Critical]) -> Option<Section> {
    if speeds.is_empty() {
        return None;
    }
    let headings = ["excitation", "order", "mode", "Hz", "critical rad/s", "r/min", "off the range", "verdict"];
    let engine = speeds.iter().any(|critical| critical.phasor_sum.is_some());
    let excited = if engine { &["phasor sum", "cylinder N m", "shaft N m"][..] } else { &[] };
    let mut table = Table::new(headings.iter().chain(excited).copied());
    for critical in speeds {
        let verdict = match critical.margin {
            None => "no range given",
            Some(margin) if margin <= 0.0 => "IN THE RANGE",
            Some(_) if critical.flagged => "WITHIN 10 %",
            Some(_) => "clear",
        };
        let off = critical.margin.map_or_else(String::new, percent);
        let row = [
            critical.excitation.clone(),
            significant(critical.order),
            critical.mode.to_string(),
            significant(critical.hz),
            significant(critical.speed),
            significant(critical.speed * 60.0 / TAU),
            off,
            verdict.to_owned(),
        ];
        let of_engine = [critical.phasor_sum, critical.torque, critical.shaft_torque];
        let of_engine = of_engine.map(|value| value.map_or_else(String::new, shown));
        table.row(row.into_iter().chain(of_engine.into_iter().take(excited.len())));
    }
    let text = if engine {
        "Speeds of the motor at which an order meets a natural frequency, and how far they lie outside the running \
         range. Of the engine: its phasor sum, the torque of one cylinder, and the largest torque of a damped shaft, \
         at the motor, while the machine dwells there."
    } else {
        "Speeds of the motor at which an order meets a natural frequency, and how far they lie outside the running \
         range."
    };
    Some(Section::new("Critical speeds", text, table))
}

/// A number, and zero for what rounding leaves of a sum.
fn shown(value: f64) -> String {
    if value < 1e-9 { "0".to_owned() } else { significant(value) }
}

/// The Campbell diagram; none where nothing excites. Natural frequencies in Hz.
pub fn diagram(
    natural: &[f64],
    running: Option<&Running>,
    excitations: &[Excitation],
    speeds: &[Critical],
) -> Option<String> {
    if speeds.is_empty() {
        return None;
    }
    let rays: Vec<Ray> = excitations
        .iter()
        .flat_map(|excitation| {
            excitation.orders.iter().map(|order| Ray {
                name: format!("{} {}", excitation.name, significant(*order)),
                slope: order / (excitation.ratio * TAU),
            })
        })
        .collect();
    let crossing = |critical: &Critical| Crossing {
        speed: critical.speed,
        frequency: critical.hz,
        flagged: critical.flagged,
        title: format!(
            "{} {}: mode {} at {} rad/s",
            critical.excitation,
            significant(critical.order),
            critical.mode,
            significant(critical.speed)
        ),
    };
    let crossings: Vec<Crossing> = speeds.iter().map(crossing).collect();
    Some(campbell(natural, &rays, running.map(|range| (range.least, range.greatest)), &crossings))
}
