//! Why a scene could not be balanced.

use driveline_solver::plant::PlantError;
use driveline_solver::rotor::RotorError;

/// Why a scene could not be balanced.
#[derive(Debug, thiserror::Error)]
pub enum BalancingError {
    /// The link to the firmware broke.
    #[error(transparent)]
    Link(#[from] std::io::Error),
    /// The drivetrain is described wrongly.
    #[error(transparent)]
    Drivetrain(#[from] PlantError),
    /// The rotor is described wrongly.
    #[error(transparent)]
    Rotor(#[from] RotorError),
    /// The panel refused.
    #[error("the panel refused {key:?} with {answer}")]
    Refused {
        /// The request.
        key: driveline_firmware::scene::panel_keys::Key,
        /// The answer.
        answer: u32,
    },
    /// The speed was not reached.
    #[error("the drive did not come to {speed} rad/s within {time} s: it turns at {reached} rad/s")]
    NotReached {
        /// The requested speed.
        speed: f64,
        /// How long it was waited for.
        time: f64,
        /// The speed at the end.
        reached: f64,
    },
    /// No reading was good.
    #[error("no reading at {speed} rad/s was good: {doubts}")]
    NoReading {
        /// The speed.
        speed: f64,
        /// The panel's answer to each.
        doubts: String,
    },
    /// No window of turns was finished.
    #[error("no waveform of the speed within {time} s")]
    NoWaveform {
        /// How long it was waited for.
        time: f64,
    },
}
