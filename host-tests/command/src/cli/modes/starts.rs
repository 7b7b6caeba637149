//! Dynamic factors of starts and pulses of a machine, of its two masses with the first mode, undamped.

use std::f64::consts::{PI, TAU};

use driveline::machine::{Match, StartingLaw, Torque, TwoMass};
use driveline_report::format::significant;
use driveline_report::{Section, Table};
use serde::Serialize;

use crate::machine_file::MachineFile;

/// Durations of a start, in periods of the vibration.
const PERIODS: [f64; 6] = [0.25, 0.5, 1.0, 1.5, 2.5, 5.0];

/// Allowed factors that have a slew.
const ALLOWED: [f64; 3] = [1.1, 1.2, 1.5];

/// Largest torque of the shaft over that of a slow change, for each way to start.
#[derive(Clone, Debug, Serialize)]
pub struct Starts {
    /// Frequency of the vibration (rad/s).
    pub resonance: f64,
    /// Factors against the duration.
    pub factors: Vec<Factors>,
    /// Torque per time (N m/s) of a change by the torque limit, for an allowed factor.
    pub slew: Vec<[f64; 2]>,
    /// Torque that the shaft turns to (N m) where the motor reverses from its limit to the other one at once.
    pub reversal: f64,
}

/// Factors of starts of one duration.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Factors {
    /// Duration (s).
    pub time: f64,
    /// Torque that rises evenly and stays.
    pub ramp: f64,
    /// Constant torque that ends.
    pub pulse: f64,
    /// Half a sine, of its peak.
    pub half_sine: f64,
    /// Triangle with its peak in the middle, of that.
    pub triangle: f64,
    /// `1 - t/T`, of the torque at the start.
    pub soft: f64,
    /// `1 - t^2/T^2`.
    pub medium: f64,
}

/// Of a machine that two masses can stand for.
pub fn starts(machine: &MachineFile) -> Option<Starts> {
    let two = machine.reduce(Match::ResonanceAntiresonance).ok().filter(|_| machine.long.is_none())?;
    let (period, limit) = (TAU / two.resonance(), machine.limits.torque);
    let at = |periods: f64| {
        let time = periods * period;
        Factors {
            time,
            ramp: two.ramp_factor(time),
            pulse: two.pulse_factor(time),
            half_sine: half_sine(TAU * periods),
            triangle: triangle(TAU * periods),
            soft: two.law_factor(&StartingLaw::Soft { torque: limit, time }),
            medium: two.law_factor(&StartingLaw::Medium { torque: limit, time }),
        }
    };
    Some(Starts {
        resonance: two.resonance(),
        factors: PERIODS.map(at).to_vec(),
        slew: ALLOWED.map(|factor| [factor, two.slew_for_factor(Torque(limit), factor)]).to_vec(),
        reversal: reversal(&two, limit),
    })
}

/// The largest swing of a vibration at 1 rad/s under half a sine of height 1 that lasts for `a` (s) `[derived]`: during
/// it `(sin pt - p sin t)/(1 - p^2)`, p = pi/a, with peaks of `sin pt/(1 - p)` at 2 pi k/(1 + p) and of
/// `sin pt/(1 + p)` at 2 pi k/(1 - p); after it `2 p cos(a/2)/(1 - p^2)`.
fn half_sine(a: f64) -> f64 {
    let p = PI / a;
    let left = if (p - 1.0).abs() < 1e-6 { 0.5 * PI } else { (2.0 * p * (0.5 * a).cos() / (1.0 - p * p)).abs() };
    let peaks = |sum: f64, over: f64| {
        let times = (1..).map(move |k| TAU * f64::from(k) / sum).take_while(|time| *time < a);
        times.map(move |time| (p * time).sin() / over).fold(0.0, f64::max)
    };
    if p < 1.0 - 1e-6 { left.max(peaks(1.0 + p, 1.0 - p)).max(peaks(1.0 - p, 1.0 + p)) } else { left }
}

/// The same of a triangle with its peak in the middle `[derived]`: up to it `2 (t - sin t)/a`, which rises; from h = a/2
/// on less twice the same from there, with extremes where `2 cos(t - h) - cos t = 1`; after it `8 sin^2(a/4)/a`.
fn triangle(a: f64) -> f64 {
    let half = 0.5 * a;
    let ramp = |t: f64| t - t.sin();
    let at = |t: f64| (2.0 / a * (ramp(t) - 2.0 * ramp(t - half))).abs();
    let (cosine, sine) = (2.0 * half.cos() - 1.0, 2.0 * half.sin());
    let (middle, aside) = (sine.atan2(cosine), (1.0 / cosine.hypot(sine)).min(1.0).acos());
    let turns = (a / TAU).ceil() as i32;
    let zeros = (-1..=turns).flat_map(|k| [middle - aside, middle + aside].map(|t| t + TAU * f64::from(k)));
    let during = zeros.filter(|t| (half..a).contains(t)).map(at).fold(at(half), f64::max);
    during.max(8.0 * (0.25 * a).sin().powi(2) / a)
}

fn reversal(two: &TwoMass, limit: f64) -> f64 {
    let before = two.accelerating_torque(Torque(limit), Torque(0.0));
    two.reversal_torque(before, Torque(-limit), Torque(0.0)).0
}

/// The table of the factors.
pub fn table(starts: &Starts) -> Section {
    let headings = ["within s", "even rise", "pulse", "half sine", "triangle", "soft, 1 - t/T", "medium, 1 - t²/T²"];
    let mut table = Table::new(headings);
    for row in &starts.factors {
        let factors = [row.time, row.ramp, row.pulse, row.half_sine, row.triangle, row.soft, row.medium];
        table.row(factors.map(significant));
    }
    let slew: Vec<_> =
        starts.slew.iter().map(|&[factor, slew]| format!("{} for {factor}", significant(slew))).collect();
    let text = format!(
        "Largest shaft torque over that of a slow change, of two masses at {} Hz without damping; a step has 2. Slew of \
         a change by the torque limit (`limits.torque`; 1 N m without it), N m/s for an allowed factor: {}. A reversal \
         at that limit turns the shaft to {} N m.",
        significant(starts.resonance / TAU),
        slew.join(", "),
        significant(starts.reversal)
    );
    Section::new("Dynamic factors of starts and pulses", text, table)
}
