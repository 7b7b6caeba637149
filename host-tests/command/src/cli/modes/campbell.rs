//! Critical speeds: where an excitation's order meets a natural frequency `[Pfützner 1980 ch. 1]`.

use std::f64::consts::TAU;

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
    /// Its frequency \[Hz\].
    pub hz: f64,
    /// The excitation.
    pub excitation: String,
    /// Its order.
    pub order: f64,
    /// Speed of the motor \[rad/s\]: `ratio omega/order`.
    pub speed: f64,
    /// How far it lies outside the running range, as a share of the end that is nearer; negative inside; `null`
    /// without a range.
    pub margin: Option<f64>,
    /// Whether it lies in the running range or within 10 % of it.
    pub flagged: bool,
}

/// All critical speeds of natural frequencies \[rad/s\], the lowest first.
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
                });
            }
        }
    }
    all.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    all
}

/// The table of critical speeds; none where nothing excites.
pub fn critical(speeds: &[Critical]) -> Option<Section> {
    if speeds.is_empty() {
        return None;
    }
    let mut table =
        Table::new(["excitation", "order", "mode", "Hz", "critical rad/s", "r/min", "off the range", "verdict"]);
    for critical in speeds {
        let verdict = match critical.margin {
            None => "no range given",
            Some(margin) if margin <= 0.0 => "IN THE RANGE",
            Some(_) if critical.flagged => "WITHIN 10 %",
            Some(_) => "clear",
        };
        let off = critical.margin.map_or_else(String::new, percent);
        table.row([
            critical.excitation.clone(),
            significant(critical.order),
            critical.mode.to_string(),
            significant(critical.hz),
            significant(critical.speed),
            significant(critical.speed * 60.0 / TAU),
            off,
            verdict.to_owned(),
        ]);
    }
    let text = "Speeds of the motor at which an order meets a natural frequency, and how far they lie outside the \
                running range.";
    Some(Section::new("Critical speeds", text, table))
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
