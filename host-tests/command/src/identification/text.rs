//! The identified machine as a table and as a machine file.

use std::f64::consts::TAU;
use std::fmt::Write;

use driveline::commissioning::Figure;
use driveline_report::Table;
use driveline_report::format::{percent, significant};

use super::identify::Identified;
use crate::recording::{Quantity, Recording};

/// Names, units and figures of the result, each with the factor to its unit.
pub fn figures(identified: &Identified) -> [(&'static str, &'static str, Figure); 10] {
    let figures = &identified.estimate.figures;
    let scaled = |figure: Figure, by: f64| Figure {
        value: by * figure.value,
        standard_deviation: by * figure.standard_deviation,
    };
    [
        ("motor inertia", "kg m²", figures.motor_inertia),
        ("load inertia", "kg m²", figures.load_inertia),
        ("stiffness", "N m/rad", figures.stiffness),
        ("damping of the shaft", "N m s/rad", figures.damping),
        ("friction of the motor", "N m s/rad", figures.motor_friction),
        ("friction of the load", "N m s/rad", figures.load_friction),
        ("resonance", "Hz", scaled(figures.resonance, 1.0 / TAU)),
        ("antiresonance", "Hz", scaled(figures.antiresonance, 1.0 / TAU)),
        ("damping ratio", "", figures.damping_ratio),
        ("dead time", "ms", scaled(figures.delay, 1e3)),
    ]
}

/// The figures as a table.
pub fn table(identified: &Identified) -> Table {
    let mut table = Table::new(["quantity", "value", "standard deviation", "of it", "unit"]);
    for (name, unit, figure) in figures(identified) {
        let Figure { value, standard_deviation } = figure;
        // two digits of the deviation are what a value is worth
        let digits = (1.0 - standard_deviation.abs().max(1e-300).log10().floor()).clamp(0.0, 9.0) as usize;
        let value = if value.abs() < 1e-2 { format!("{value:.4e}") } else { format!("{value:.digits$}") };
        let share = percent(figure.relative());
        table.row([name.to_owned(), value, significant(standard_deviation), share, unit.to_owned()]);
    }
    table
}

/// What a machine file needs beside the machine: from the recording, or from the user.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    pub encoder_lines: u32,
    /// Ticks a second.
    pub rate_hz: u32,
    /// Rms error of the motor's torque (N m).
    pub torque_accuracy: f64,
    /// Change of the load torque within a second (N m).
    pub load_torque_step: f64,
    /// Largest torque (N m).
    pub torque: f64,
    /// Largest speed (rad/s).
    pub speed: f64,
}

impl Drive {
    /// From the recording: what of the torque is unexplained, what friction of the load the observer has no state for,
    /// and the largest torque and speed.
    pub fn of(identified: &Identified, recording: &Recording, torque: &[f64]) -> Self {
        let rms = |signal: &[f64]| {
            let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
            (signal.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / signal.len().max(1) as f64)
                .sqrt()
        };
        let largest = |signal: &[f64]| signal.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let speed: Vec<f64> = match (recording.signal(Quantity::Speed), recording.signal(Quantity::Angle)) {
            (Some(speed), _) => speed.to_vec(),
            (_, Some(angle)) => angle.windows(2).map(|pair| (pair[1] - pair[0]) / recording.period).collect(),
            _ => Vec::new(),
        };
        let two = |value: f64| {
            let unit = 10_f64.powf(value.abs().max(1e-9).log10().floor() - 1.0);
            (value / unit).round() * unit
        };
        Self {
            encoder_lines: recording.signal(Quantity::Angle).and_then(encoder_lines).unwrap_or(2048),
            rate_hz: (1.0 / recording.period).round() as u32,
            torque_accuracy: two(identified.estimate.unexplained * rms(torque)).max(1e-9),
            load_torque_step: two(0.5 * rms(torque)).max(1e-9),
            torque: two(1.2 * largest(torque)).max(1e-9),
            speed: two(1.2 * largest(&speed)).max(1e-9),
        }
    }
}

/// Lines of the encoder behind an angle (rad): a line has four counts, and the smallest steps are of one count. The
/// file rounds each of them, up or down, and their mean is right: where it is so uncertain, a power of two that near is
/// meant, 20 % off at most.
fn encoder_lines(angle: &[f64]) -> Option<u32> {
    let steps = angle.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 1e-9);
    let mut steps: Vec<f64> = steps.collect();
    steps.sort_by(f64::total_cmp);
    let smallest = *steps.first()?;
    // two counts are twice as much
    let cluster = &steps[..steps.partition_point(|step| *step < 1.5 * smallest)];
    let count = cluster.iter().sum::<f64>() / cluster.len() as f64;
    let rounding = (0.5 * (cluster.last()? - smallest) / count).min(0.2);
    let lines = TAU / (4.0 * count);
    let power = lines.log2().round().exp2();
    let lines = if (lines / power - 1.0).abs() <= rounding { power } else { lines.round() };
    Some(lines.clamp(64.0, f64::from(1 << 22)) as u32)
}

/// The machine as a file that `design` and `replay` take.
pub fn machine_file(name: &str, identified: &Identified, drive: &Drive) -> String {
    let model = &identified.estimate.model;
    let deviation = |figure: Figure| significant(figure.standard_deviation);
    let figures = &identified.estimate.figures;
    let mut text = String::new();
    // writing to a string cannot fail
    let _ = write!(
        text,
        "# Identified from a recording: resonance {:.3} Hz, antiresonance {:.3} Hz,
# friction of motor and load {} and {} N m s/rad, dead time of the torque {} s.
# The shaft's damping is that of the resonance, friction included: the observer has no friction.
name = \"{name}\"

[[element]]
kind = \"motor\"
inertia = {:e}    # kg m2, standard deviation {}

[[element]]
kind = \"shaft\"
stiffness = {:e}    # N m/rad, standard deviation {}
damping = {:e}    # N m s/rad, standard deviation {}

[[element]]
kind = \"rotor\"
label = \"load\"
inertia = {:e}    # kg m2, standard deviation {}

[encoder]
lines = {}    # from the smallest steps of the angle, 2048 without one

[control]
rate_hz = {}

[disturbance]
torque_accuracy = {:e}    # N m, the rms torque that two masses leave unexplained
load_torque_step = {:e}    # N m, half of the rms torque ...
within = 1.0    # s

[limits]
torque = {:e}    # N m, 1.2 times the largest of the recording
speed = {:e}    # rad/s, likewise
",
        figures.resonance.value / TAU,
        figures.antiresonance.value / TAU,
        significant(model.friction[0]),
        significant(model.friction[1]),
        significant(model.delay),
        rounded(model.motor),
        deviation(figures.motor_inertia),
        rounded(model.stiffness),
        deviation(figures.stiffness),
        rounded(model.swing_damping().max(0.0)),
        deviation(figures.swing_damping),
        rounded(model.load),
        deviation(figures.load_inertia),
        drive.encoder_lines,
        drive.rate_hz,
        drive.torque_accuracy,
        drive.load_torque_step,
        drive.torque,
        drive.speed,
    );
    text
}

/// A number to six digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::encoder_lines;

    /// An angle that creeps on in whole counts, zero to two of them a sample, as a file with this unit has it.
    fn creeping(counts: f64, unit: f64) -> Vec<f64> {
        let count = |sample: u32| (0.37 * f64::from(sample)).floor() + (0.9 * f64::from(sample)).floor();
        (0..1000).map(|sample| (count(sample) * TAU / counts / unit).round() * unit).collect()
    }

    #[test]
    fn the_encoder_is_that_whose_counts_a_file_has_rounded() {
        // 2^20 counts of 6 urad, to the microradian: 5 urad at least, which were 314,159 lines
        assert_eq!(encoder_lines(&creeping(1_048_576.0, 1e-6)), Some(262_144));
        // 4000 counts are 1000 lines: the rounding of 1571 urad is no reason to take 1024
        assert_eq!(encoder_lines(&creeping(4000.0, 1e-6)), Some(1000));
        assert_eq!(encoder_lines(&[0.0; 10]), None);
    }
}
