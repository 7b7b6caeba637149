//! `cargo driveline modes` of a train of any shape.

use std::f64::consts::TAU;

use serde::Serialize;

use super::campbell::{Critical, barred, barred_speeds, critical, critical_speeds, diagram};
use super::damped::{self, DampedVibration};
use super::figures::{campbell, shapes};
use super::tables::SHOWN;
use crate::cli::Failure;
use crate::machine_file::TrainFile;
use driveline_report::chart::Station;
use driveline_report::format::significant;
use driveline_report::{Section, Sheet, Table, fact};

/// The vibrations of a train, every part on its own shaft.
#[derive(Clone, Debug, Serialize)]
pub struct TrainVibration {
    /// The train's name.
    pub name: String,
    /// Its coordinates.
    pub coordinates: Vec<String>,
    /// Motions without strain: turning as a whole, or what no link holds.
    pub rigid_motions: usize,
    /// Natural vibrations, lowest first.
    pub resonances: Vec<TrainResonance>,
    /// Damped vibrations and decays, the slowest first; none of a train without damping.
    pub damped: Vec<DampedVibration>,
    /// Speeds of the first coordinate at which an excitation meets a natural frequency, the lowest first.
    pub critical: Vec<Critical>,
    /// Ranges of its speed that it must not dwell in (rad/s), rising and apart; none without a running range.
    pub barred: Vec<[f64; 2]>,
}

/// A natural vibration.
#[derive(Clone, Debug, Serialize)]
pub struct TrainResonance {
    /// Frequency (rad/s).
    pub frequency: f64,
    /// Frequency (Hz).
    pub hz: f64,
    /// Share of each coordinate in the kinetic energy, and the sign it moves with: comparable between angles and
    /// ways.
    pub energy: Vec<f64>,
}

impl TrainVibration {
    /// Of a train with every link in contact at its mean stiffness.
    pub fn of(file: &TrainFile) -> Result<Self, Failure> {
        let modes = file.train.modes().map_err(|error| Failure::failed(error.to_string()))?;
        let decays = file.train.decays(&modes).map_err(|error| Failure::failed(error.to_string()))?;
        let inertia = file.train.inertias();
        let elastic: Vec<usize> = (modes.rigid_motions()..modes.omega.len()).collect();
        let resonance = |&i: &usize| {
            let shape = &modes.shapes[i];
            let energy = shape.iter().zip(&inertia).map(|(q, j)| q.signum() * q * q * j).collect();
            TrainResonance { frequency: modes.omega[i], hz: modes.omega[i] / TAU, energy }
        };
        let frequencies: Vec<f64> = elastic.iter().map(|&i| modes.omega[i]).collect();
        let critical = critical_speeds(&frequencies, file.running.as_ref(), &file.excitations);
        Ok(Self {
            name: file.name.clone(),
            coordinates: file.coordinates.clone(),
            rigid_motions: modes.rigid_motions(),
            resonances: elastic.iter().map(resonance).collect(),
            damped: DampedVibration::all(&decays),
            barred: file.running.as_ref().map_or_else(Vec::new, |range| barred(&critical, range.greatest)),
            critical,
        })
    }

    /// Title, text and table of each part.
    pub fn tables(&self) -> Vec<Section> {
        let shown = if self.coordinates.len() <= SHOWN { &*self.coordinates } else { &[] };
        let headings = ["mode", "Hz", "rad/s"].map(String::from).into_iter().chain(shown.iter().cloned());
        let mut table = Table::new(headings);
        for (index, mode) in self.resonances.iter().enumerate() {
            let numbers = [mode.hz, mode.frequency].map(significant);
            let shape = mode.energy.iter().take(shown.len()).map(|share| format!("{:+.1} %", 100.0 * share));
            table.row([(index + 1).to_string()].into_iter().chain(numbers).chain(shape));
        }
        let text = format!(
            "Every link in contact at its mean stiffness; shares of the kinetic energy, signed as the parts move{}. \
             Motions without strain: {}.",
            if shown.is_empty() { " (of more than 24 coordinates with `--json`)" } else { "" },
            self.rigid_motions
        );
        let modes = Section::new("Frequencies and shapes", text, table);
        let speeds = critical(&self.critical).into_iter().chain(barred_speeds(&self.barred));
        let about =
            "About standstill, every link in contact at its mean stiffness; of the torques, falling lines damp.";
        [modes].into_iter().chain(damped::table(&self.damped, about)).chain(speeds).collect()
    }

    /// The page as HTML.
    pub fn page(&self, file: &TrainFile) -> String {
        let inertia = file.train.inertias();
        let total: f64 = inertia.iter().sum();
        let stations = self.coordinates.iter().zip(&inertia);
        let natural: Vec<f64> = self.resonances.iter().map(|mode| mode.hz).collect();
        let mut facts = vec![fact("coordinates", self.coordinates.len().to_string())];
        facts.push(fact("motions without strain", self.rigid_motions.to_string()));
        if let Some(first) = natural.first() {
            facts.push(fact("first resonance", format!("{} Hz", significant(*first))));
        }
        let stations: Vec<Station> =
            stations.map(|(name, j)| Station { name: name.clone(), share: j / total }).collect();
        let diagram = diagram(&natural, file.running.as_ref(), &file.excitations, &self.critical);
        let modes = self.resonances.iter().map(|mode| (mode.hz, &*mode.energy));
        let joined = file.train.joined();
        let pairs = joined.iter().flat_map(|link| link.windows(2));
        let links: Vec<[usize; 2]> = pairs.map(|pair| [pair[0], pair[1]]).collect();
        Sheet {
            name: self.name.clone(),
            kicker: "natural vibrations and reduction".to_owned(),
            summary: "Natural vibrations of the whole train, every part on its own shaft: shares of the kinetic \
                      energy."
                .to_owned(),
            facts,
            figures: shapes(&stations, &links, modes).into_iter().chain(diagram.map(campbell)).collect(),
            tables: self.tables(),
        }
        .page()
    }
}
