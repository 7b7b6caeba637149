//! A balancing as its file describes it.

use driveline::balancing::{Complex, FromAmplitudes, Procedure};

use super::holes::PlaneHoles;
use super::rotor::Rotor;
use super::units::{AngleConvention, WeightUnit};

/// Most readings of a run.
pub const ROWS: usize = 24;
/// Most planes.
pub const PLANES: usize = 8;
/// Most trial runs.
pub const TRIALS: usize = 32;

/// The procedure of a file.
pub type Field = Procedure<f64, ROWS, PLANES, TRIALS>;

/// A balancing as its file describes it.
#[derive(Clone, Debug)]
pub struct BalanceFile {
    pub name: String,
    /// Unit of the readings.
    pub unit: String,
    pub weight_unit: WeightUnit,
    /// How angles are counted.
    pub angles: AngleConvention,
    /// Names of the planes.
    pub planes: Vec<String>,
    /// Names of the readings.
    pub sensors: Vec<String>,
    pub measured: Measured,
    /// Holes of the planes that have some.
    pub holes: Vec<PlaneHoles>,
    /// Planes whose weight is split between two angles (degrees).
    pub splits: Vec<(usize, [f64; 2])>,
    /// The rotor, for its grade.
    pub rotor: Option<Rotor>,
}

#[derive(Clone, Debug)]
pub enum Measured {
    /// Amplitudes and phases.
    Phasors {
        /// The procedure, as far as the runs go.
        procedure: Box<Field>,
        /// The first run.
        baseline: Vec<Complex<f64>>,
        /// The last run.
        last: Vec<Complex<f64>>,
        /// Speed of each reading (rpm); empty where none is given.
        rpm: Vec<f64>,
        /// Weights on the rotor: corrections, and trial weights that stay.
        on: Vec<Complex<f64>>,
        /// Corrections that were put on.
        corrections: usize,
        /// The largest change of a reading by the trial weights of each plane, over what it was.
        changes: Vec<Option<f64>>,
    },
    /// Amplitudes alone.
    Amplitudes {
        /// Without a trial weight.
        baseline: f64,
        /// The weight that follows.
        found: FromAmplitudes<f64>,
    },
    /// Not read yet.
    Nothing,
}
