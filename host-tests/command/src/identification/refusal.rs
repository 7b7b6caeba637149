//! Reasons why a recording cannot give a machine.

use std::f64::consts::TAU;

use driveline::commissioning::Figure;

use super::cause::Rigid;
use super::estimate::Estimate;
use super::model::Model;
use crate::recording::{Quantity, Recording};

/// Samples below which there is nothing to identify.
const FEWEST: usize = 200;
/// Share of samples at an extreme, in runs, from which a signal counts as clipped.
const CLIPPED: f64 = 2e-3;
/// Share by which speed and difference of the angle may differ.
const AGREE: f64 = 0.1;

/// Why a recording gives no machine.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// Hardly any samples.
    #[error("{0} samples are too few: at least {FEWEST} are expected, over ten periods of the resonance")]
    Short(usize),
    /// A signal does not move.
    #[error("the {0} is constant: a record with a torque that changes, and the motion that follows, is expected")]
    Constant(&'static str),
    /// A signal stops at its extremes.
    #[error("the {0} is clipped at {1:.4}, {2} samples from line {3} on: a wider range of the sensor is expected")]
    Clipped(&'static str, f64, usize, u64),
    /// Two columns of one motion contradict each other.
    #[error("speed is {0:.4} times the change of the angle: one of the two units is wrong")]
    Units(f64),
    /// Too few lines carry torque.
    #[error(
        "the torque excites {0} frequencies at most: a multisine, a chirp, pseudo-random steps or a run-up past the \
         resonance is expected"
    )]
    NotExcited(usize),
    /// Nothing fits.
    #[error(
        "torque and motion do not belong to one machine: check the sign of the torque, the units, and whether both are \
         of the same time"
    )]
    Unrelated,
    #[error(
        "no resonance shows: a rigid machine of {:.4e} kg m² and {:.2e} N m s/rad explains the record as well (variance ratio \
         {ratio:.1}, {LEAST:.0} are expected); excite it more, or at higher frequencies",
        rigid.inertia,
        rigid.friction
    )]
    Rigid {
        /// Of the variances without the resonance and with it.
        ratio: f64,
        rigid: Rigid,
    },
    /// A machine is driven by what it should drive.
    #[error("the torque slows down where the motion speeds up: torque or motion has the other sign")]
    Sign,
    /// Three masses.
    #[error(
        "{}: describe them as elements of a machine file, or record less of the band for the two masses of the first \
         resonance", three_masses(.0)
    )]
    Third(Box<Model>),
    /// No linear machine.
    #[error(
        "no machine whose parts stay in contact explains the record: a gap (backlash) opens, a rope or shaft goes slack, \
         or a torque that was not recorded acts; record under a larger mean torque, and if that does not help, check \
         the units and whether torque and motion are of the same time"
    )]
    Contact,
    /// The estimate is too vague.
    #[error(
        "the record does not determine the {0}: its standard deviation is {1:.1} % (condition of the information \
         {2:.0}); excite more about resonance and antiresonance, or record longer"
    )]
    Vague(&'static str, f64, f64),
    /// A frequency lies where nothing was measured.
    #[error(
        "the {0} of the fit, {1:.4} Hz, lies outside the lines that were used, {2:.4} to {3:.4} Hz: excite the machine \
         below and above it, and sample fast enough"
    )]
    Outside(&'static str, f64, f64, f64),
}

fn three_masses(model: &Model) -> String {
    let ([low, high], Some(third)) = (model.resonances().unwrap_or_default(), model.third) else {
        return String::new();
    };
    format!(
        "a third mass swings in the band: {:.4e}, {:.4e} and {:.4e} kg m² on shafts of {:.4e} and {:.4e} N m/rad, with \
         resonances at {:.4} and {:.4} Hz, leave much less unexplained than two",
        model.motor,
        model.load,
        third.inertia,
        model.stiffness,
        third.stiffness,
        low / TAU,
        high / TAU
    )
}

/// Ratio of variances from which a resonance is significant, as in commissioning.
pub const LEAST: f64 = 12.0;
/// Largest share of the torque that may be left unexplained, unless noise alone explains it: a coarse encoder's.
const UNEXPLAINED: f64 = 0.4;
/// Largest share of the response that noise does not explain. The friction and cogging of a real bench are 0.09, noise on
/// two masses stays below 0.005.
const MISFIT: f64 = 0.12;
/// Misfit above which a vague figure is the machine's fault: more excitation or a longer record would not help.
const OWN: f64 = 0.05;

/// Signals that can tell nothing.
pub fn signals(recording: &Recording, torque: &[f64]) -> Result<(), Refusal> {
    if recording.len() < FEWEST {
        return Err(Refusal::Short(recording.len()));
    }
    let moved = [Quantity::Angle, Quantity::Speed, Quantity::Acceleration];
    let signals = moved.iter().filter_map(|quantity| Some((quantity.name(), recording.signal(*quantity)?)));
    for (name, signal) in [("torque", torque)].into_iter().chain(signals) {
        let (low, high) = extremes(signal);
        if !(high - low > 1e-12 * high.abs().max(low.abs())) {
            return Err(Refusal::Constant(name));
        }
        // an angle that stops at its end is a machine that stands still
        if name != "angle" {
            for extreme in [low, high] {
                clipped(name, signal, extreme, high - low, &recording.lines)?;
            }
        }
    }
    match (recording.signal(Quantity::Angle), recording.signal(Quantity::Speed)) {
        (Some(angle), Some(speed)) => agree(angle, speed, recording.period),
        _ => Ok(()),
    }
}

fn extremes(signal: &[f64]) -> (f64, f64) {
    signal.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

/// A signal that stays at an extreme while it has many other values: steps between a few levels are a command.
fn clipped(name: &'static str, signal: &[f64], extreme: f64, range: f64, lines: &[u64]) -> Result<(), Refusal> {
    let there = |value: &f64| (value - extreme).abs() < 1e-9 * range;
    let runs = signal.windows(3).filter(|three| three.iter().all(there)).count();
    let moving = signal.windows(2).filter(|pair| pair[0] != pair[1] && !pair.iter().any(there)).count();
    let is_smooth = moving > signal.len() / 2;
    if is_smooth && runs as f64 > CLIPPED * signal.len() as f64 {
        let first = signal.windows(3).position(|three| three.iter().all(there)).unwrap_or(0);
        let line = lines.get(first).copied().unwrap_or(0);
        let count = signal.iter().filter(|value| there(value)).count();
        return Err(Refusal::Clipped(name, extreme, count, line));
    }
    Ok(())
}

/// The slope of the speed over the angle's differences.
fn agree(angle: &[f64], speed: &[f64], period: f64) -> Result<(), Refusal> {
    let pairs = angle.windows(3).zip(speed.iter().skip(1)).map(|(three, speed)| (three[2] - three[0], speed));
    let (cross, square) = pairs.fold((0.0, 0.0), |(cross, square), (turned, speed)| {
        let rate = turned / (2.0 * period);
        (cross + rate * speed, square + rate * rate)
    });
    let ratio = cross / square;
    if (ratio - 1.0).abs() < AGREE { Ok(()) } else { Err(Refusal::Units(ratio)) }
}

/// Deviations by which a friction must be below zero to be no machine's.
const BELOW: f64 = 5.0;

/// Figures that are too vague, or no machine's.
pub fn figures(estimate: &Estimate) -> Result<(), Refusal> {
    let Estimate { model, figures, unexplained, misfit, condition, band, .. } = estimate;
    // a swing that grows or is none, a dead time of a quarter of the resonance's period, or what two masses do not
    // explain
    let is_machine = (-0.01..1.0).contains(&model.damping_ratio()) && model.delay.abs() * model.resonance() < 1.5;
    if !(is_machine && (*unexplained < UNEXPLAINED || *misfit < OWN) && *misfit < MISFIT) {
        return Err(Refusal::Contact);
    }
    let named = [
        ("resonance", figures.resonance, 0.03),
        ("antiresonance", figures.antiresonance, 0.05),
        ("inertia on the motor's side", figures.motor_inertia, 0.1),
        ("inertia on the load's side", figures.load_inertia, 0.1),
    ];
    for (name, figure, most) in named {
        if !(figure.relative() < most) {
            if *misfit > OWN || *unexplained >= UNEXPLAINED {
                return Err(Refusal::Contact);
            }
            return Err(Refusal::Vague(name, 100.0 * figure.relative(), *condition));
        }
    }
    for (name, figure) in [("resonance", figures.resonance), ("antiresonance", figures.antiresonance)] {
        if !(band[0]..=band[1]).contains(&figure.value) {
            return Err(Refusal::Outside(name, figure.value / TAU, band[0] / TAU, band[1] / TAU));
        }
    }
    let drives = |friction: Figure| friction.value < -BELOW * friction.standard_deviation;
    if drives(figures.motor_friction) || drives(figures.load_friction) {
        return Err(Refusal::Contact);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two levels, new in every sample: two of three samples change, and some runs are long. A sine that is cut is
    /// clipped.
    #[test]
    fn a_command_of_two_levels_is_not_clipped() {
        let levels = [1.0, 1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0].repeat(100);
        assert_eq!(clipped("torque", &levels, 1.0, 2.0, &[]), Ok(()));
        let cut: Vec<f64> = (0..1200).map(|k| (0.1 * f64::from(k)).sin().min(0.9)).collect();
        assert!(clipped("torque", &cut, 0.9, 1.9, &[]).is_err());
    }
}
