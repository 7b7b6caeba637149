//! The full solver of rotors against published and independent numbers, closed forms, and itself by other means.

mod campaign;
mod closed_forms;
mod rig;
mod run_up;
mod speeds;
