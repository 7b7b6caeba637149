//! Why an observer misses an aim: what its squared error is made of.
//!
//! The run is done again on the host with exact sensors: an encoder of 2^31 counts and a torque that is known. The
//! reduction of the error is *noise*. The rest is split tick by tick: *gap* while a gap is open or a rope slack, and
//! for a period of the resonance after; of the rest, the *mode left out* is what swings faster than the geometric mean
//! of the resonance and the lowest mode that the reduction left out, and *lag* is the slower part, not yet followed. An
//! observer of one mass leaves the whole shaft out, which then cannot be separated from lag.
//!
//! Beside the measured shares stands what the design said at compile time: the predicted standard deviation, the mode
//! that was left out and the reduction's bound.

use core::f64::consts::TAU;

use driveline_firmware::scene::expected::Expected;
use driveline_firmware::scenes::find;
use serde::Serialize;

use super::Aim;
use crate::candidates::Candidate;
use driveline_closed_loop::figures::peaks;
use driveline_closed_loop::lockstep;
use driveline_closed_loop::lockstep::{Moment, Trace};
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::sensors::Encoder;
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;
use driveline_report::Variant;
use driveline_report::format::{percent, significant};

/// Quantity of a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// The shaft torque, of its peak.
    ShaftTorque,
    /// The load's speed, of rated.
    LoadSpeed,
}

impl Quantity {
    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ShaftTorque => "shaft torque",
            Self::LoadSpeed => "load speed",
        }
    }
}

/// A part of a squared error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Cause: noise, gap, mode left out, lag.
    pub name: String,
    /// How much of the whole.
    pub share: f64,
    /// Its measurement and its prediction.
    pub detail: String,
}

/// Why an aim is missed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reason {
    /// Missed requirements.
    pub quantity: Quantity,
    /// The rms error.
    pub error: f64,
    /// The aim.
    pub aim: f64,
    /// Shares of the squared error, the largest first.
    pub shares: Vec<Share>,
}

impl Reason {
    /// The sentence for the page.
    pub fn sentence(&self) -> String {
        let shares: Vec<String> = self
            .shares
            .iter()
            .map(|part| format!("{:.0} % {} ({})", 100.0 * part.share, part.name, part.detail))
            .collect();
        format!(
            "{}: {} rms, {} points above the aim of {}. Of the squared error: {}.",
            self.quantity.name(),
            percent(self.error),
            significant(100.0 * (self.error - self.aim)),
            percent(self.aim),
            shares.join("; ")
        )
    }
}

/// The reasons for which a variant that ran misses its aims; none where it keeps them.
///
/// # Errors
/// What kept the run on the host from being done.
pub fn reasons(
    machine: &Machine,
    candidate: &Candidate,
    aim: &Aim,
    variant: &Variant,
    real: &[Trace],
) -> Result<Vec<Reason>, String> {
    let missed = [
        (Quantity::ShaftTorque, variant.shaft_torque.rms, Some(aim.shaft_torque)),
        (Quantity::LoadSpeed, variant.load_speed.rms, aim.load_speed),
    ];
    let missed: Vec<_> = missed
        .into_iter()
        .filter_map(|(quantity, error, aim)| aim.filter(|aim| !(error <= *aim)).map(|aim| (quantity, error, aim)))
        .collect();
    if missed.is_empty() {
        return Ok(Vec::new());
    }
    let quiet = Machine { torque_noise: 0.0, encoder: Encoder::new(1 << 31), ..machine_with(machine) };
    let counted = || machine.scenarios.iter().filter(|scenario| scenario.counted);
    let row = find(candidate.variant).ok_or_else(|| format!("there is no variant `{}`", candidate.variant))?;
    let units = Units::new(row.words(), machine.bases);
    let mut traces = Vec::new();
    for scenario in counted() {
        let trace = lockstep::run(&quiet, scenario, &units, row.rate_hz, &mut OnHost(row.start()), |_| {});
        traces.push(trace.map_err(|error| error.to_string())?);
    }
    let expected = row.expected();
    let peak = peaks(real.iter().zip(&machine.scenarios).filter(|(_, scenario)| scenario.counted).map(|(t, _)| t))[0];
    let seen = Seen { quiet: &traces, expected, references: [peak, machine.rated_speed] };
    Ok(missed.into_iter().map(|(quantity, error, aim)| seen.reason(quantity, error, aim)).collect())
}

/// The machine again, with its sensors to be replaced.
fn machine_with(machine: &Machine) -> Machine {
    Machine {
        facts: Vec::new(),
        notes: Vec::new(),
        scenarios: Vec::new(),
        name: machine.name,
        summary: machine.summary,
        chosen: machine.chosen,
        encoder: machine.encoder,
        torque_noise: machine.torque_noise,
        load: machine.load,
        shaft_torque: machine.shaft_torque,
        load_torque: machine.load_torque,
        told_brake: machine.told_brake,
        told_friction: machine.told_friction,
        rated_speed: machine.rated_speed,
        bases: machine.bases,
    }
}

/// The runs with exact sensors, and what errors are fractions of.
struct Seen<'t> {
    quiet: &'t [Trace],
    expected: Option<Expected>,
    references: [f64; 2],
}

impl Seen<'_> {
    fn reason(&self, quantity: Quantity, error: f64, aim: f64) -> Reason {
        let k = quantity as usize;
        let reference = self.references[k];
        let machine = self.expected.and_then(|expected| expected.machine);
        let edge = machine.map(|machine| (machine.resonance() * machine.error.next_mode).sqrt());
        let settling = machine.map_or(0.0, |machine| TAU / machine.resonance());
        let (mut parts, mut ticks) = (Parts::default(), 0_usize);
        for trace in self.quiet {
            parts.add(&trace.moments, k, edge, settling);
            ticks += trace.moments.len();
        }
        let whole = error * error;
        let rms = |sum: f64| sum / ticks.max(1) as f64 / (reference * reference);
        let (gap, fast, slow) = (rms(parts.gap), rms(parts.fast), rms(parts.slow));
        let quiet = gap + fast + slow;
        // By chance a run without noise may err more; then noise has no share.
        let whole = whole.max(quiet);
        let mut shares = vec![Share {
            name: "noise".to_owned(),
            share: (whole - quiet) / whole,
            detail: self.noise(quantity, quiet.sqrt(), reference),
        }];
        let share =
            |name: &str, square: f64, detail: String| Share { name: name.to_owned(), share: square / whole, detail };
        if gap > 0.0 {
            let gap_of = machine.map_or(0.0, |machine| machine.gap);
            let detail = if gap_of > 0.0 {
                format!("{} mrad at the motor, open or just closed", significant(1e3 * gap_of))
            } else {
                "gap open, or just closed".to_owned()
            };
            shares.push(share("gap", gap, detail));
        }
        match machine {
            Some(machine) if machine.error.next_mode.is_finite() => {
                let left_out = format!(
                    "above {} Hz; the reduction leaves out {} Hz, which moves the motor by {} of the rigid motion, and \
                        bounds its error by {}",
                    significant(edge.unwrap_or(0.0) / TAU),
                    significant(machine.error.next_mode / TAU),
                    percent(machine.error.next_share),
                    percent(machine.error.worst)
                );
                shares.push(share("mode left out", fast, left_out));
                shares.push(share("lag", slow, "slower: not yet followed".to_owned()));
            }
            Some(_) => shares.push(share("lag", fast + slow, "no mode is left out".to_owned())),
            None => shares.push(share("shaft left out, and lag", fast + slow, "one mass has no shaft".to_owned())),
        }
        shares.sort_by(|a, b| b.share.total_cmp(&a.share));
        Reason { quantity, error, aim, shares }
    }

    fn noise(&self, quantity: Quantity, quiet: f64, reference: f64) -> String {
        let predicted = self.expected.and_then(|expected| match quantity {
            Quantity::ShaftTorque => expected.shaft_torque,
            Quantity::LoadSpeed => Some(expected.load_speed),
        });
        let design = predicted.map_or_else(
            || "the design predicts none".to_owned(),
            |deviation| format!("the design predicts {}", percent(deviation / reference)),
        );
        format!("with exact sensors {} rms is left; {design}", percent(quiet))
    }
}

/// Sums of squares of an error's parts.
#[derive(Default)]
struct Parts {
    gap: f64,
    fast: f64,
    slow: f64,
}

impl Parts {
    /// Adds a run's: `edge` (rad/s) parts fast from slow, and a gap counts for `settling` (s) after it has closed.
    fn add(&mut self, moments: &[Moment], k: usize, edge: Option<f64>, settling: f64) {
        let errors: Vec<f64> = moments.iter().map(|moment| moment.error()[k]).collect();
        let period = moments.get(1).map_or(0.0, |second| second.time - moments[0].time);
        let slow = match edge {
            Some(edge) if edge.is_finite() => smoothed(&errors, 1.0 - (-edge * period).exp()),
            _ => errors.clone(),
        };
        let mut closed = f64::NEG_INFINITY;
        for ((moment, error), slow) in moments.iter().zip(&errors).zip(&slow) {
            if moment.open {
                closed = moment.time;
            }
            let square = error * error;
            if moment.time - closed <= settling {
                self.gap += square;
                continue;
            }
            let (low, high) = (slow * slow, (error - slow) * (error - slow));
            let both = low + high;
            // The two do not add up to the whole tick by tick: each takes its part of it.
            let part = if both > 0.0 { high / both } else { 0.0 };
            self.fast += part * square;
            self.slow += (1.0 - part) * square;
        }
    }
}

/// A series smoothed forwards and backwards by a low-pass of first order, so that nothing is shifted.
fn smoothed(series: &[f64], gain: f64) -> Vec<f64> {
    let mut smooth = series.to_vec();
    let mut state = smooth.first().copied().unwrap_or(0.0);
    for value in &mut smooth {
        state += gain * (*value - state);
        *value = state;
    }
    for value in smooth.iter_mut().rev() {
        state += gain * (*value - state);
        *value = state;
    }
    smooth
}

#[cfg(test)]
mod tests {
    use crate::survey::reason::*;

    /// A run of a second at 1 kHz whose error of the shaft torque is given.
    fn moments(error: impl Fn(f64) -> f64, open: impl Fn(f64) -> bool) -> Vec<Moment> {
        let moment = |tick: i32| {
            let time = f64::from(tick) * 1e-3;
            Moment { time, estimate: [error(time), 0.0, 0.0], open: open(time), ..Moment::default() }
        };
        (0..1000).map(moment).collect()
    }

    #[test]
    fn what_is_slow_is_lag_and_what_is_fast_a_mode() {
        let edge = Some(TAU * 20.0);
        // A low-pass of first order run both ways passes 1/(1 + (f/f_c)^2): 0.99 at 2 Hz, 0.01 at 200 Hz.
        for (frequency, slow) in [(2.0, true), (200.0, false)] {
            let mut parts = Parts::default();
            parts.add(&moments(|time| (TAU * frequency * time).sin(), |_| false), 0, edge, 0.0);
            let share = if slow { parts.slow } else { parts.fast } / (parts.slow + parts.fast);
            assert!(share > 0.95, "{frequency}: {share}");
            // The whole is kept: 1000 ticks of a mean square of one half.
            assert!((parts.slow + parts.fast - 500.0).abs() < 1.0);
        }
    }

    #[test]
    fn an_open_gap_and_what_follows_is_the_gaps() {
        let mut parts = Parts::default();
        // Open from 0.2 s to 0.3 s, and 0.1 s of settling: a fifth of the run.
        parts.add(&moments(|_| 1.0, |time| (0.2..0.3).contains(&time)), 0, None, 0.1);
        assert!((parts.gap - 200.0).abs() <= 1.0 && (parts.slow - 800.0).abs() <= 1.0, "{} {}", parts.gap, parts.slow);
    }

    #[test]
    fn a_sentence_says_by_how_much_and_why() {
        let shares = vec![Share { name: "noise".into(), share: 0.75, detail: "as designed".into() }];
        let reason = Reason { quantity: Quantity::LoadSpeed, error: 0.004, aim: 0.003, shares };
        let sentence = reason.sentence();
        for part in ["load speed", "0.40 %", "0.100 points", "0.30 %", "75 % noise (as designed)"] {
            assert!(sentence.contains(part), "{sentence}");
        }
    }
}
