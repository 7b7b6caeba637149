//! Whether the parts of a machine stay in contact, from the record's time course.

use nalgebra::{Complex, DVector};
use rustfft::FftPlanner;

use super::estimate::{Estimate, Setting, slopes};
use super::model::{Motion, Torque};
use super::spectrum::Line;

/// Correlation of what two masses leave unexplained with the motion by a gap, from which there is one. Of sixty
/// machines that other programs simulated, those without have at most 0.3, those with one at least 0.5.
const LEAST: f64 = 0.4;
/// Torque of the shaft, over its rms, within which it changes sides.
const SIDE: f64 = 0.1;
/// Frequency up to which the torque of the shaft is taken, over the resonance: beyond it the motion's noise prevails.
const HIGHEST: f64 = 2.0;

/// Whether a gap opens or a rope goes slack: the shaft shifts by a constant where its torque changes its sign. The
/// motion by such shifts is a course of its own, most of it at frequencies that the torque does not carry. The motor's
/// acceleration shows the shaft's torque; what the machine's parameters explain is taken out of both. `lines` are all
/// lines of the record, the first one first, and `mean` its mean torque.
#[must_use]
pub fn opens(lines: &[Line], mean: f64, estimate: &Estimate, setting: Setting) -> bool {
    let Estimate { model, band, .. } = estimate;
    let factor = |s: Complex<f64>| {
        let held = (1.0 - (-s * setting.period).exp()) / (s * setting.period);
        let torque = if setting.torque == Torque::Held { held } else { 1.0.into() };
        match setting.motion {
            Motion::Angle => [torque, held],
            Motion::Speed => [torque, 1.0.into()],
            Motion::Acceleration => [torque, s],
        }
    };
    let torque = |line: &Line| {
        let s = Complex::new(0.0, line.frequency);
        let [torque, motion] = factor(s);
        let moves = (s * model.motor + model.friction[0]) * line.motion / motion;
        line.torque * torque * (-s * model.delay).exp() - moves
    };
    // one value of the time for each line and its conjugate
    let count = 2 * (lines.len() + 1);
    let mut course = vec![Complex::new(0.0, 0.0); count];
    for (line, value) in lines.iter().zip(course.iter_mut().skip(1)) {
        if line.frequency < HIGHEST * model.resonance() {
            *value = torque(line);
        }
    }
    let mut planner = FftPlanner::new();
    planner.plan_fft_inverse(count).process(&mut course);
    let rms = (course.iter().map(|value| value.re * value.re).sum::<f64>() / count as f64).sqrt();
    for value in &mut course {
        *value = ((value.re + mean) / (SIDE * rms)).tanh().into();
    }
    planner.plan_fft_forward(count).process(&mut course);
    let within: Vec<(Line, Complex<f64>)> = lines
        .iter()
        .zip(&course[1..])
        .filter(|(line, _)| line.frequency >= band[0] && line.frequency <= band[1])
        .map(|(line, side)| {
            let s = Complex::new(0.0, line.frequency);
            (*line, side * model.speed_by_shift(s) * factor(s)[1])
        })
        .collect();
    let lines: Vec<Line> = within.iter().map(|(line, _)| *line).collect();
    let (errors, slopes, deviations) = slopes(&lines, model, setting);
    let shifts = within.iter().zip(&deviations).flat_map(|((_, shift), by)| [shift.re / by, shift.im / by]);
    let explained = slopes.qr().q();
    let beside = |of: DVector<f64>| &of - &explained * (explained.transpose() * &of);
    let [left, shifts] = [errors, DVector::from_iterator(2 * lines.len(), shifts)].map(beside);
    left.dot(&shifts) > LEAST * left.norm() * shifts.norm()
}
