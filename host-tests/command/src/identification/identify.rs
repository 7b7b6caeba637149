//! From a recording or a table to a machine.

use super::cause::{instead, third};
use super::contact::opens;
use super::estimate::{Estimate, Setting, estimate};
use super::model::{Motion, Torque};
use super::refusal::{self, Refusal};
use super::spectrum::{Line, carriers, guess, lines, smoothed, tabulated};
use crate::machine_file::Diagnostic;
use crate::recording::{Quantity, Recording};

/// A machine that was identified.
#[derive(Clone, Debug)]
pub struct Identified {
    pub estimate: Estimate,
    /// How motion and torque were taken.
    pub setting: Setting,
    /// The lines that carry the torque, about the resonance.
    pub lines: Vec<Line>,
}

/// Lines below which there are not enough: two for each parameter.
const LINES: usize = 24;
/// Lines, and bands of them, below which there is no first guess.
const BANDS: usize = 8;

/// Why there is no machine: a fault of the recording, or a reason why it does not suffice.
#[derive(Debug, thiserror::Error)]
pub enum NotIdentified {
    /// A column is missing.
    #[error(transparent)]
    File(#[from] Diagnostic),
    /// The record does not suffice.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// The machine of a recording of torque and motion.
pub fn identify(recording: &Recording, torque_constant: Option<f64>) -> Result<Identified, NotIdentified> {
    let torque = recording.torque(torque_constant)?;
    let motions = [
        (Quantity::Angle, Motion::Angle),
        (Quantity::Speed, Motion::Speed),
        (Quantity::Acceleration, Motion::Acceleration),
    ];
    let there = motions.iter().find_map(|(quantity, motion)| Some((recording.signal(*quantity)?, *motion)));
    let Some((values, motion)) = there else {
        return Err(recording.fault(recording.found(), "a column of the motor's angle, speed or acceleration").into());
    };
    refusal::signals(recording, &torque)?;
    let all = lines(&torque, values, motion, recording.period);
    let Some(lowest) = all.first().map(|line| 3.0 * line.frequency) else {
        return Err(Refusal::Short(recording.len()).into());
    };
    let carrying = carriers(&all, [lowest, f64::INFINITY]);
    if carrying.len() < BANDS {
        return Err(Refusal::NotExcited(carrying.len()).into());
    }
    let responses = smoothed(&carrying, motion);
    if responses.len() < BANDS {
        return Err(Refusal::NotExcited(carrying.len().min(responses.len())).into());
    }
    let unrelated = || instead(Refusal::Unrelated, &carrying, motion, f64::INFINITY);
    let (start, fit) = guess(&responses).ok_or_else(unrelated)?;
    // below that friction alone acts, above it higher modes
    let between = [lowest.max(start.antiresonance() / 30.0), 5.0 * start.resonance()];
    let lines = carriers(&all, between);
    if lines.len() < LINES {
        return Err(Refusal::NotExcited(lines.len()).into());
    }
    let settings = [Torque::Smooth, Torque::Held].map(|torque| Setting { motion, torque, period: recording.period });
    let (estimate, setting) = estimate(&lines, start, &settings).ok_or_else(unrelated)?;
    let found = judged(Identified { estimate, setting, lines }, &carrying, fit.improvement)?;
    let mean = torque.iter().sum::<f64>() / torque.len() as f64;
    if opens(&all, mean, &found.estimate, setting) { Err(Refusal::Contact.into()) } else { Ok(found) }
}

/// What was identified, if it is of use and two masses explain it; `carriers` are all lines that carry torque.
fn judged(found: Identified, carriers: &[Line], improvement: f64) -> Result<Identified, NotIdentified> {
    let Identified { estimate, setting, lines } = &found;
    let refusal = match refusal::figures(estimate).map_err(|why| instead(why, carriers, setting.motion, improvement)) {
        Ok(()) => third(lines, estimate, *setting),
        Err(Refusal::Contact) => third(lines, estimate, *setting).or(Some(Refusal::Contact)),
        Err(refusal) => Some(refusal),
    };
    refusal.map_or(Ok(found), |refusal| Err(refusal.into()))
}

/// The machine of a table of a frequency response.
pub fn identify_response(
    recording: &Recording,
    motion: Motion,
    torque_constant: Option<f64>,
) -> Result<Identified, NotIdentified> {
    let lines = table(recording, motion, torque_constant)?;
    if lines.len() < LINES {
        return Err(Refusal::NotExcited(lines.len()).into());
    }
    let (start, fit) = guess(&tabulated(&lines, motion)).ok_or(Refusal::Unrelated)?;
    let setting = Setting { motion, torque: Torque::Sine, period: 1.0 };
    let (estimate, setting) = estimate(&lines, start, &[setting]).ok_or(Refusal::Unrelated)?;
    let carriers = lines.clone();
    judged(Identified { estimate, setting, lines }, &carriers, fit.improvement)
}

/// The rows of a table as lines of unit torque, in the order of their frequencies.
fn table(recording: &Recording, motion: Motion, torque_constant: Option<f64>) -> Result<Vec<Line>, Diagnostic> {
    let missing =
        || recording.fault(recording.found(), "frequency with magnitude and phase, or with real and imaginary");
    let frequencies = recording.signal(Quantity::Frequency).ok_or_else(missing)?;
    let pair = |one, other| Some((recording.signal(one)?, recording.signal(other)?));
    let polar = |(size, phase): (&f64, &f64)| nalgebra::Complex::from_polar(*size, *phase);
    let values: Vec<_> = match pair(Quantity::Magnitude, Quantity::Phase) {
        Some((sizes, phases)) => sizes.iter().zip(phases).map(polar).collect(),
        None => {
            let (re, im) = pair(Quantity::Real, Quantity::Imaginary).ok_or_else(missing)?;
            re.iter().zip(im).map(|(re, im)| nalgebra::Complex::new(*re, *im)).collect()
        }
    };
    let torque = nalgebra::Complex::new(torque_constant.unwrap_or(1.0), 0.0);
    // an angle's noise grows with the frequency when it is taken as a speed; here it is taken as it is
    let line = |(&frequency, &response)| Line { frequency, torque, motion: response, noise: 1.0 };
    let mut lines: Vec<Line> = frequencies.iter().zip(&values).map(line).collect();
    for (line, row) in lines.iter().zip(&recording.lines) {
        if !(line.frequency > 0.0) || line.motion.norm_sqr() == 0.0 {
            let found = format!("a frequency or a response of zero at line {row}");
            return Err(recording.fault(found, format!("frequencies above zero, and responses of the {motion}")));
        }
    }
    lines.sort_by(|one, other| one.frequency.total_cmp(&other.frequency));
    Ok(lines)
}
