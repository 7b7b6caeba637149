//! Errors over a sample of machines within their tolerances.

use serde::Serialize;

use crate::format::percent;
use crate::results::diverged_as_null;
use crate::table::Table;

/// An error of the nominal machine and over a sample of machines, as a fraction of a rated value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sampled {
    /// Of the machine that the drive was designed for, with ideal sensors and torque.
    #[serde(with = "diverged_as_null")]
    pub nominal: f64,
    /// Median over the sample.
    #[serde(with = "diverged_as_null")]
    pub median: f64,
    /// Nine machines of ten are not worse.
    #[serde(with = "diverged_as_null")]
    pub p90: f64,
}

/// A drive on a sample of machines.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sample {
    /// The variant, as `hoist/f32/reduced/10000`.
    pub variant: String,
    pub run: String,
    /// Machines: draws from 0 on.
    pub draws: u64,
    pub seed: u64,
    /// Machines on which the loop did not hold.
    pub unstable: u64,
    /// Rms error of the shaft torque, of rated torque.
    pub shaft_torque: Sampled,
    /// Rms error of the load's speed, of rated speed.
    pub load_speed: Sampled,
    /// Rms error of the load torque, of rated torque.
    pub load_torque: Sampled,
}

/// Title of the table of samples.
pub const SAMPLES: &str = "Machines within their tolerances";

/// Samples as a text and a table: nominal and real beside each other.
pub fn samples_table(samples: &[Sample]) -> (String, Table) {
    let quantities = ["shaft torque", "load speed", "load torque"];
    let columns = quantities.map(|name| [format!("{name}, nominal"), "median".to_owned(), "p90".to_owned()]);
    let ends = ["machines".to_owned(), "unstable".to_owned()];
    let mut table = Table::new(["variant".to_owned()].into_iter().chain(columns.into_iter().flatten()).chain(ends));
    for sample in samples {
        let errors = [sample.shaft_torque, sample.load_speed, sample.load_torque];
        let errors = errors.into_iter().flat_map(|error| [error.nominal, error.median, error.p90].map(percent));
        let ends = [sample.draws.to_string(), sample.unstable.to_string()];
        table.row([sample.variant.clone()].into_iter().chain(errors).chain(ends));
    }
    let text = samples.first().map_or_else(String::new, |sample| {
        format!(
            "A sample: machines 0 to {} of seed {}, drawn from within the tolerances of machine, motor, encoder and \
             inverter, on the host with the bits of the firmware. Rms errors, of rated torque and rated speed; the \
             nominal ones are of the same run. `cargo driveline campaign` draws more machines.",
            sample.draws.saturating_sub(1),
            sample.seed
        )
    });
    (text, table)
}

#[cfg(test)]
mod tests {
    use super::{Sample, Sampled, samples_table};

    /// Drawn out of the tolerances would be machines that are beyond them.
    #[test]
    fn machines_are_drawn_from_within_their_tolerances() {
        let error = Sampled { nominal: 0.01, median: 0.02, p90: 0.03 };
        let [shaft_torque, load_speed, load_torque] = [error; 3];
        let [variant, run] = ["hoist/f32/reduced/10000", "start"].map(String::from);
        let sample = Sample { variant, run, draws: 10, seed: 1, unstable: 0, shaft_torque, load_speed, load_torque };
        let (text, _) = samples_table(&[sample]);
        assert!(text.contains("drawn from within the tolerances") && !text.contains("out of"), "{text}");
    }
}
